/* A quarter of a neo-Hookean block, 10 x 10 cm in cells of 1 cm, vibrates freely: symmetry planes
 * at x = 0 and y = 0, initial velocity 10 cm/s times sin(pi x / 2 L) along x. Gates: the
 * trapezoidal rule adds no energy however long the step; what is lost at short steps is the
 * remap's, and as much as a prototype lost. */
#include "verify.h"

static const double mu = 6e6, kappa = 6e7, density = 10.0, L = 10.0, speed = 10.0;

typedef struct outcome {
  double most, end; /* energy over that at the start */
  int32_t most_iterations;
} outcome;

static double wave_speed(void) {
  return sqrt((kappa + 4.0 / 3.0 * mu) / density);
}

/* Times are in units of 4 L / c, a period of the bar that is held at its sides. */
static outcome vibrate(int32_t basis, double h, double cfl, int steps, double gamma, FILE *csv) {
  const double dt = cfl * h / wave_speed();
  verify_setup setup = verify_defaults(2, (int64_t)lround(12.0 / h), h);
  setup.grid.basis = basis;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.newmark_beta = 0.25 * (0.5 + gamma) * (0.5 + gamma);
  setup.stepper.newmark_gamma = gamma;
  verify_world w;
  verify_open(&w, &setup);
  const mpm_param rubber[] = {{"mu", mu}, {"kappa", kappa}, {"density", density}};
  mpm_particles *block = verify_set(&w, verify_material(&w, "neo_hookean_decoupled", rubber, 3));
  verify_fill_box(&w, block, (const double[]){0.0, 0.0}, (const double[]){L, L}, 2);
  for (int32_t face = MPM_X_MIN; face <= MPM_Y_MIN; face += 2)
    verify_ok(&w, mpm_stepper_set_wall(w.stepper, face, MPM_WALL_SLIP, 0.0));
  const int64_t n = mpm_particles_count(block);
  double *x = verify_get(&w, block, "position", 2), *v = verify_array(2 * n);
  for (int64_t i = 0; i < n; ++i) v[i] = speed * sin(0.5 * PI * x[i] / L);
  verify_put(&w, block, "velocity", 2, v);
  free(x), free(v);
  const double start = verify_info(&w).kinetic_energy;
  outcome is = {1.0, 1.0, 0};
  for (int k = 1; k <= steps; ++k) {
    const mpm_step_info info = verify_step(&w, dt);
    is.end = (info.kinetic_energy + info.strain_energy) / start;
    is.most = fmax(is.most, is.end);
    if (info.newton_iterations > is.most_iterations) is.most_iterations = info.newton_iterations;
    if (csv)
      fprintf(csv, "%d,%g,%g,%g,%.6g,%.8f,%.8f,%d\n", (int)basis, h, cfl, gamma,
              info.t * wave_speed() / (4.0 * L), info.kinetic_energy / start, is.end,
              (int)info.newton_iterations);
  }
  verify_close(&w);
  return is;
}

int main(int argc, char **argv) {
  verify_begin("free_vibration_implicit", argc, argv);
  static const struct {
    double cfl;
    int steps;
  } list[] = {{1.0, 120}, {10.0, 12}, {100.0, 150}, {1000.0, 60}};
  FILE *csv = verify_csv("free_vibration_implicit");
  fprintf(csv, "basis,h,cfl,gamma,t,kinetic,energy,iterations\n");
  outcome is[4];
  char what[80];
  for (int i = 0; i < 4; ++i) {
    is[i] = vibrate(MPM_LINEAR, 1.0, list[i].cfl, list[i].steps, 0.5, csv);
    snprintf(what, sizeof what, "CFL %g, %d steps: largest energy / E0", list[i].cfl, list[i].steps);
    verify_gate(what, is[i].most, 0.0, 1.001, "the trapezoidal rule");
    snprintf(what, sizeof what, "CFL %g: most Newton iterations", list[i].cfl);
    verify_gate(what, is[i].most_iterations, 1.0, 5.0, "quadratic convergence");
  }
  const char *source = "a prototype of the same method, with a margin for what is not known of its set-up";
  verify_gate("CFL 1: energy / E0 after three periods", is[0].end, 0.925, 0.965, source);
  verify_gate("CFL 10: energy / E0 after three periods", is[1].end, 0.86, 0.9, source);
  const outcome fine = vibrate(MPM_LINEAR, 0.5, 1.0, 240, 0.5, csv);
  verify_gate("CFL 1, h = 1/2: loss of energy over that of h = 1", (1.0 - fine.end) / (1.0 - is[0].end), 0.0,
              0.8, "the loss is the transfer's, which falls with h");
  const outcome smooth = vibrate(MPM_BSPLINE2, 1.0, 1.0, 120, 0.5, csv);
  verify_gate("CFL 1, quadratic, 120 steps: largest energy / E0", smooth.most, 0.0, 1.001,
              "the trapezoidal rule");
  const outcome damped = vibrate(MPM_LINEAR, 1.0, 10.0, 12, 0.6, csv);
  verify_gate("CFL 10, gamma 0.6: energy over that of gamma 0.5", damped.end / is[1].end, 0.0, 0.95,
              "gamma above 1/2 damps");
  fclose(csv);
  return verify_end();
}
