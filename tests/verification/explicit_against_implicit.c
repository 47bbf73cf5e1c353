/* The billet of Guilkey & Weiss 2003, 5.1 (a quarter of 20 cm, bonded to a rigid platen, pressed to half its
 * height at a steady speed) by explicit and by implicit steps: the same answer, and the time that each takes.
 * Explicit steps are as many more as the speed is lower, implicit ones are not. */
#include "verify.h"

#include <time.h>

static const double mu = 6e6, kappa = 6e7, density = 10.0, L = 10.0, h = 0.5;

typedef struct outcome {
  double displacement, force, seconds;
  int64_t steps;
} outcome;

static mpm_status push(void *user, const mpm_particle_batch *b, double *add) {
  const double speed = *(const double *)user;
  for (int64_t i = 0; i < b->n; ++i) add[b->ld + i] -= speed;
  return MPM_OK;
}

static double now(void) {
  struct timespec t;
  timespec_get(&t, TIME_UTC);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The particle that starts nearest to the corner on the plane of symmetry. */
static int64_t corner_of(const double *x, int64_t n) {
  int64_t best = 0;
  for (int64_t i = 0; i < n; ++i)
    if (x[i] - x[n + i] > x[best] - x[n + best]) best = i;
  return best;
}

static outcome press(int32_t scheme, int32_t basis, int32_t per_cell, double speed) {
  verify_setup setup = verify_defaults(2, (int64_t)lround(22.0 / h), h);
  setup.grid.cells[1] = (int64_t)lround(12.0 / h);
  setup.grid.basis = basis;
  setup.stepper.scheme = scheme;
  verify_world w;
  verify_open(&w, &setup);
  const mpm_param rubber[] = {{"mu", mu}, {"kappa", kappa}, {"density", density}},
                  steel[] = {{"density", density}};
  mpm_particles *block = verify_set(&w, verify_material(&w, "neo_hookean_decoupled", rubber, 3));
  mpm_particles *platen = verify_set(&w, verify_material(&w, "rigid", steel, 1));
  verify_fill_box(&w, block, (const double[]){0.0, 0.0}, (const double[]){L, L}, per_cell);
  verify_fill_box(&w, platen, (const double[]){0.0, L}, (const double[]){2.0 * L, L + h}, per_cell);
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_motion(w.stepper, platen, push, &speed));
  const int64_t n = mpm_particles_count(block);
  double *x = verify_get(&w, block, "position", 2);
  const int64_t corner = corner_of(x, n);
  outcome is = {-x[corner], 0.0, -now(), 0};
  free(x);
  const double end = 0.5 * L / speed;
  if (scheme == MPM_NEWMARK) /* half a cell of the platen each */
    for (int k = 0; k < (int)lround(L / h); ++k) is.steps = verify_step(&w, 0.5 * h / speed).step;
  else
    is.steps = verify_advance(&w, 0.5, end).step;
  is.seconds += now();
  double force[2];
  verify_ok(&w, mpm_stepper_particles_reaction(w.stepper, platen, force));
  x = verify_get(&w, block, "position", 2);
  is.displacement += x[corner];
  is.force = -force[1];
  free(x);
  verify_close(&w);
  return is;
}

static outcome measure(int32_t scheme, int32_t basis, int32_t per_cell, double speed, FILE *csv) {
  const outcome is = press(scheme, basis, per_cell, speed);
  const char *name = scheme == MPM_MUSL ? "MUSL" : "Newmark";
  fprintf(csv, "%d,%d,%g,%s,%.5f,%.5e,%d,%.3f\n", (int)basis, (int)per_cell, speed, name, is.displacement,
          is.force, (int)is.steps, is.seconds);
  verify_progress("basis %d, %g cm/s, %s: %.4f cm, %d steps, %.2f s", (int)basis, speed, name,
                  is.displacement, (int)is.steps, is.seconds);
  return is;
}

int main(int argc, char **argv) {
  verify_begin("explicit_against_implicit", argc, argv);
  static const double speeds[3] = {50.0, 20.0, 10.0};
  FILE *csv = verify_csv("explicit_against_implicit");
  fprintf(csv, "basis,per_cell,speed,scheme,displacement,force,steps,seconds\n");
  char what[80];
  for (int i = 0; i < (verify_quick() ? 1 : 3); ++i) {
    const outcome slow = measure(MPM_MUSL, MPM_CPGIMP, 2, speeds[i], csv);
    const outcome fast = measure(MPM_NEWMARK, MPM_CPGIMP, 2, speeds[i], csv);
    snprintf(what, sizeof what, "cpGIMP, %g cm/s: displacement, implicit over explicit", speeds[i]);
    verify_gate(what, fast.displacement / slow.displacement, 0.97, 1.03, "judgement: the same problem");
    if (i > 0) continue;
    verify_gate("cpGIMP, 50 cm/s: displacement, implicit", fast.displacement, 7.25, 7.55,
                "Guilkey & Weiss 2003: 7.44");
    verify_expected_failure("cpGIMP, 50 cm/s: displacement, explicit", slow.displacement, 7.3, 7.5,
                            "a prototype",
                            "of another basis; 7.55, and 7.49 at 10 cm/s, where the block has less inertia");
  }
  if (!verify_quick()) {
    const outcome slow = measure(MPM_MUSL, MPM_LINEAR, 4, 10.0, csv);
    const outcome fast = measure(MPM_NEWMARK, MPM_LINEAR, 4, 10.0, csv);
    verify_expected_failure(
        "linear, 10 cm/s: displacement, implicit over explicit", fast.displacement / slow.displacement, 0.97,
        1.03, "judgement: the same problem",
        "the linear basis loses stress in each step, and explicit steps are 300 times as many");
  }
  fclose(csv);
  return verify_end();
}
