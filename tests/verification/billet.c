/* The billet of Guilkey & Weiss 2003, 5.1: a square block of 20 cm, bonded between two rigid platens,
 * compressed to half its height in plane strain; a quarter of it. Reference: finite elements with 40 x 40
 * biquadratic elements; the frictionless variant is homogeneous and exact. (The paper gives 40 cm, which does
 * not fit its displacements.) */
#include "verify.h"

#include <string.h>

static const double mu = 6e6, kappa = 6e7, density = 10.0, L = 10.0;

typedef struct variant {
  const char *name;
  int32_t basis, per_cell;
  double h, step;             /* of the platen */
  double displacement, force; /* half way down; of a prototype of the same algorithm, 0: none */
} variant;

typedef struct outcome {
  double displacement, force, mean_iterations, patch_error;
  int32_t most_iterations;
} outcome;

static mpm_status push(void *user, const mpm_particle_batch *b, double *add) {
  const double speed = *(const double *)user;
  for (int64_t i = 0; i < b->n; ++i) add[b->ld + i] -= speed;
  return MPM_OK;
}

/* Stretch across the load at a stretch along it, where nothing acts across. */
static double lateral_stretch(double y) {
  double low = 1.0, high = 4.0;
  for (int k = 0; k < 200; ++k) {
    const double x = 0.5 * (low + high), J = x * y;
    const double t = kappa * log(J) + mu * pow(J, -2.0 / 3.0) * (x * x - (x * x + y * y + 1.0) / 3.0);
    if (t > 0.0)
      high = x;
    else
      low = x;
  }
  return 0.5 * (low + high);
}

/* Largest difference of a deformation gradient from the exact one. */
static double patch_error(const verify_world *w, mpm_particles *block, double y) {
  const int64_t n = mpm_particles_count(block);
  const double exact[9] = {lateral_stretch(y), 0.0, 0.0, 0.0, y, 0.0, 0.0, 0.0, 1.0};
  double *F = verify_get(w, block, "deformation_gradient", 9), worst = 0.0;
  for (int64_t i = 0; i < 9 * n; ++i) worst = fmax(worst, fabs(F[i] - exact[i / n]));
  free(F);
  return worst;
}

/* The particle that starts nearest to the corner on the plane of symmetry. */
static int64_t corner_of(const double *x, int64_t n) {
  int64_t best = 0;
  for (int64_t i = 0; i < n; ++i)
    if (x[i] - x[n + i] > x[best] - x[n + best]) best = i;
  return best;
}

/* speed 0: quasi-static, in units of steps. */
static outcome compress(const variant *v, double speed, int bonded, double compression, FILE *csv) {
  const int quasi_static = speed == 0.0;
  double dt = quasi_static ? 1.0 : v->step / speed, mean = v->step / dt;
  verify_setup setup = verify_defaults(2, 4, v->h);
  setup.grid.cells[0] = (int64_t)lround(22.0 / v->h);
  setup.grid.cells[1] = (int64_t)lround(12.0 / v->h);
  setup.grid.basis = v->basis;
  setup.stepper.scheme = MPM_NEWMARK;
  setup.stepper.quasi_static = quasi_static;
  verify_world w;
  verify_open(&w, &setup);
  const mpm_param rubber[] = {{"mu", mu}, {"kappa", kappa}, {"density", density}},
                  steel[] = {{"density", density}};
  mpm_particles *block = verify_set(&w, verify_material(&w, "neo_hookean_decoupled", rubber, 3));
  mpm_particles *platen = verify_set(&w, verify_material(&w, "rigid", steel, 1));
  verify_fill_box(&w, block, (const double[]){0.0, 0.0}, (const double[]){L, L}, v->per_cell);
  verify_fill_box(&w, platen, (const double[]){0.0, L}, (const double[]){2.0 * L, L + v->h}, v->per_cell);
  for (int32_t face = MPM_X_MIN; face <= MPM_Y_MIN; ++face)
    verify_ok(&w, mpm_stepper_set_wall(w.stepper, face, MPM_WALL_SLIP, 0.0));
  verify_ok(&w, mpm_stepper_set_motion(w.stepper, platen, push, &mean));
  if (!bonded) {
    const int64_t n = mpm_particles_count(platen);
    uint8_t *axes = calloc(2 * (size_t)n, 1);
    memset(axes + n, 1, (size_t)n);
    verify_ok(&w, mpm_particles_set(platen, "prescribed", MPM_U8, 2, n, NULL, axes));
    free(axes);
  }
  const int64_t n = mpm_particles_count(block);
  double *x0 = verify_get(&w, block, "position", 2);
  const int64_t corner = corner_of(x0, n);
  const int steps = (int)lround(compression * L / v->step);
  outcome is = {0.0, 0.0, 0.0, 0.0, 0};
  for (int k = 1; k <= steps; ++k) {
    const mpm_step_info info = verify_step(&w, dt);
    double force[2], *x = verify_get(&w, block, "position", 2);
    verify_ok(&w, mpm_stepper_particles_reaction(w.stepper, platen, force));
    is.displacement = x[corner] - x0[corner];
    is.force = -force[1];
    is.mean_iterations += (double)info.newton_iterations / steps;
    if (info.newton_iterations > is.most_iterations) is.most_iterations = info.newton_iterations;
    if (!bonded) is.patch_error = fmax(is.patch_error, patch_error(&w, block, 1.0 - k * v->step / L));
    if (csv)
      fprintf(csv, "%s,%.4f,%.6f,%.6e,%d,%.3e\n", v->name, k * v->step / L, is.displacement, is.force,
              (int)info.newton_iterations, info.residual);
    free(x);
  }
  free(x0);
  verify_close(&w);
  return is;
}

int main(int argc, char **argv) {
  verify_begin("billet", argc, argv);
  FILE *csv = verify_csv("billet");
  fprintf(csv, "variant,compression,displacement,force,iterations,residual\n");
  const variant list[] = {{"linear 4x4", MPM_LINEAR, 4, 0.5, 0.25, 7.377, 3.68e8},
                          {"linear 3x3", MPM_LINEAR, 3, 0.5, 0.25, 7.359, 3.62e8},
                          {"linear 2x2", MPM_LINEAR, 2, 0.5, 0.25, 7.209, 3.37e8},
                          {"cpGIMP 4x4", MPM_CPGIMP, 4, 0.5, 0.25, 7.445, 3.76e8},
                          {"cpGIMP 3x3", MPM_CPGIMP, 3, 0.5, 0.25, 7.437, 3.76e8},
                          {"cpGIMP 2x2", MPM_CPGIMP, 2, 0.5, 0.25, 7.413, 3.76e8},
                          {"uGIMP 4x4", MPM_GIMP, 4, 0.5, 0.25, 7.449, 3.77e8},
                          {"uGIMP 2x2", MPM_GIMP, 2, 0.5, 0.25, 7.455, 3.72e8},
                          {"quadratic 4x4", MPM_BSPLINE2, 4, 0.5, 0.25, 7.588, 3.97e8},
                          {"linear 4x4 fine", MPM_LINEAR, 4, 0.25, 0.125, 7.254, 3.52e8}};
  for (size_t i = 0; i < sizeof list / sizeof *list; ++i) {
    verify_progress("%s", list[i].name);
    const outcome is = compress(&list[i], 0.0, 1, 0.5, csv);
    printf("%-16s u_x %.4f (%.3f)  F %.4e (%.2e)  iterations %.2f / %d\n", list[i].name, is.displacement,
           list[i].displacement, is.force, list[i].force, is.mean_iterations, (int)is.most_iterations);
  }
  const variant patch = {"patch", MPM_CPGIMP, 2, 0.5, 0.5, 6.925774576, 3.50706446e8};
  const outcome is = compress(&patch, 0.0, 0, 0.5, csv);
  printf("patch: F error %.3e force %.8e\n", is.patch_error, is.force);
  fclose(csv);
  return verify_end();
}
