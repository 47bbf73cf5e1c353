/* Laws of the host, written as callbacks over batches of particles.
 *
 * 1. The neo-Hookean law of the library, written again: a block sheared and let go moves as with the
 *    built-in law.
 * 2. A visco-elastic law with one state variable, which the library does not have: an elastic spring beside
 *    a Maxwell element. A bar of it, plucked in its first mode, rings down as theory says. */
#include <mpm/mpm.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* ---- 1. neo-Hookean ------------------------------------------------------------------------------------ */

typedef struct neo_hookean {
  double lambda, mu, density;
} neo_hookean;

/* sigma = (lambda lnJ 1 + mu (F F^T - 1)) / J (Steffen et al. 2008, eq. 46) */
static mpm_status neo_hookean_stress(void *user, const mpm_material_batch *b) {
  const neo_hookean *law = user;
  static const int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
  for (int64_t p = 0; p < b->n; ++p) {
    double F[3][3], trace = 0.0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) F[i][j] = b->F[(3 * i + j) * b->ld + p];
    const double J = F[0][0] * (F[1][1] * F[2][2] - F[1][2] * F[2][1]) -
                     F[0][1] * (F[1][0] * F[2][2] - F[1][2] * F[2][0]) +
                     F[0][2] * (F[1][0] * F[2][1] - F[1][1] * F[2][0]);
    if (!(J > 0.0)) return MPM_CUT_DT; /* too far for this law: a smaller step may not get here */
    const double lnJ = log(J);
    for (int c = 0; c < 6; ++c) {
      const int i = row[c], j = column[c];
      const double B = F[i][0] * F[j][0] + F[i][1] * F[j][1] + F[i][2] * F[j][2];
      b->stress_new[c * b->ld + p] = i == j ? (law->lambda * lnJ + law->mu * (B - 1.0)) / J : law->mu * B / J;
      if (i == j) trace += B;
    }
    b->wave_speed[p] =
        sqrt((law->lambda + 2.0 * law->mu) / law->density); /* bounds the stable step: of F = 1 here */
    b->energy[p] = 0.5 * law->mu * (trace - 3.0) - law->mu * lnJ + 0.5 * law->lambda * lnJ * lnJ;
  }
  return MPM_OK;
}

enum { TWIN_STEPS = 200, TWIN_MAX = 1024 };
typedef struct twin {
  int64_t n;
  double position[2 * TWIN_MAX], stress[6 * TWIN_MAX], strain_energy;
} twin;

/* A block of 16 x 16 particles under an initial shear. Takes and destroys the material. */
static mpm_status shake_block(mpm_context *ctx, mpm_material *material, twin *out) {
  mpm_grid *grid;
  mpm_particles *block;
  mpm_stepper *stepper;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_step_info now = {.struct_size = sizeof now};
  const double lower[] = {0.4, 0.4}, upper[] = {0.8, 0.8};
  const int32_t per_cell[] = {2, 2};
  static double velocity[2 * TWIN_MAX];
  mpm_status status = mpm_grid_desc_init(&g, sizeof g);
  if (!status) status = mpm_stepper_desc_init(&s, sizeof s);
  g.dim = 2;
  g.cells[0] = g.cells[1] = 24;
  g.spacing[0] = g.spacing[1] = 0.05;
  if (!status) status = mpm_grid_create(ctx, &g, &grid);
  if (!status) status = mpm_particles_create(ctx, grid, material, &block);
  if (!status) status = mpm_particles_fill_box(block, lower, upper, per_cell, NULL, &out->n);
  if (!status) status = mpm_particles_get(block, "position", MPM_F64, 2, out->n, NULL, out->position);
  for (int64_t i = 0; i < out->n; ++i) {
    velocity[i] = 10.0 * (out->position[out->n + i] - 0.6);
    velocity[out->n + i] = 0.5 * sin(4.0 * pi * out->position[i]);
  }
  if (!status) status = mpm_particles_set(block, "velocity", MPM_F64, 2, out->n, NULL, velocity);
  if (!status) status = mpm_stepper_create(ctx, grid, &s, &stepper);
  if (!status) status = mpm_stepper_add(stepper, block);
  for (int k = 0; !status && k < TWIN_STEPS; ++k) status = mpm_step(stepper, 1e-3, &now);
  out->strain_energy = now.strain_energy;
  if (!status) status = mpm_particles_get(block, "position", MPM_F64, 2, out->n, NULL, out->position);
  if (!status) status = mpm_particles_get(block, "stress", MPM_F64, 6, out->n, NULL, out->stress);
  if (!status) status = mpm_stepper_destroy(stepper);
  if (!status) status = mpm_particles_destroy(block);
  if (!status) status = mpm_material_destroy(material);
  if (!status) status = mpm_grid_destroy(grid);
  return status;
}

static double largest_difference(int64_t n, const double *a, const double *b) {
  double most = 0.0, scale = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    most = fmax(most, fabs(a[i] - b[i]));
    scale = fmax(scale, fabs(a[i]));
  }
  return most / scale;
}

/* ---- 2. a spring beside a Maxwell element ------------------------------------------------------------- */

typedef struct viscoelastic {
  double stiffness, maxwell_stiffness, relaxation_time, density; /* moduli of uniaxial strain */
} viscoelastic;

/* In one dimension, with e = ln F: sigma = stiffness e + q, q' + q / tau = maxwell_stiffness e'. The state
 * variable is the stress q of the Maxwell element; its equation is integrated exactly for a strain rate that
 * is constant over the step. */
static mpm_status viscoelastic_stress(void *user, const mpm_material_batch *b) {
  const viscoelastic *law = user;
  const double x = b->dt / law->relaxation_time;
  const double kept = exp(-x),
               gained = x > 0.0 ? -expm1(-x) / x : 1.0; /* dt is 0 when asked for the present state */
  for (int64_t p = 0; p < b->n; ++p) {
    const double F = b->F[p], e = log(F), de = log(b->F_inc[p]);
    const double q = kept * b->state[p] + gained * law->maxwell_stiffness * de;
    b->state_new[p] = q;
    for (int c = 0; c < 6; ++c) b->stress_new[c * b->ld + p] = 0.0;
    b->stress_new[p] = law->stiffness * e + q;
    b->wave_speed[p] = sqrt((law->stiffness + law->maxwell_stiffness) / law->density);
    b->energy[p] = 0.5 * law->stiffness * e * e + 0.5 * q * q / law->maxwell_stiffness;
  }
  return MPM_OK;
}

/* The first mode of a bar of unit length, fixed at x = 0 and free at x = 1: a(t) sin(pi x / 2) with
 * density a'' = -(pi/2)^2 (stiffness a + q), q' = maxwell_stiffness a' - q / tau. y = a, a', q. */
static void mode_rate(const viscoelastic *law, const double y[3], double rate[3]) {
  rate[0] = y[1];
  rate[1] = -0.25 * pi * pi * (law->stiffness * y[0] + y[2]) / law->density;
  rate[2] = law->maxwell_stiffness * y[1] - y[2] / law->relaxation_time;
}

static void mode_step(const viscoelastic *law, double dt, double y[3]) { /* classical Runge-Kutta */
  double k[4][3], at[3];
  static const double share[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0, 2.0, 2.0, 1.0};
  for (int i = 0; i < 4; ++i) {
    for (int c = 0; c < 3; ++c) at[c] = y[c] + (i ? share[i] * dt * k[i - 1][c] : 0.0);
    mode_rate(law, at, k[i]);
  }
  for (int i = 0; i < 4; ++i)
    for (int c = 0; c < 3; ++c) y[c] += dt / 6.0 * weight[i] * k[i][c];
}

enum { CELLS = 50, PARTICLES = 2 * CELLS, BAR_STEPS = 6000 };

/* Rings the bar for 12 time units; *deviation: of the mean velocity, largest over time, against its start. */
static mpm_status ring_bar(mpm_context *ctx, viscoelastic *law, double *deviation) {
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *bar;
  mpm_stepper *stepper;
  mpm_grid_desc g;
  mpm_stepper_desc s;
  mpm_material_desc m;
  mpm_step_info now = {.struct_size = sizeof now};
  const double lower = 0.0, upper = 1.0, v0 = 1e-3, dt = 12.0 / BAR_STEPS;
  const int32_t per_cell = 2;
  double x[PARTICLES], v[PARTICLES];
  mpm_status status = mpm_grid_desc_init(&g, sizeof g);
  if (!status) status = mpm_stepper_desc_init(&s, sizeof s);
  if (!status) status = mpm_material_desc_init(&m, sizeof m);
  g.dim = 1;
  g.cells[0] = CELLS + 5; /* room for the free end */
  g.spacing[0] = 1.0 / CELLS;
  m.density = law->density;
  m.state_count = 1;
  m.stress = viscoelastic_stress;
  m.user = law;
  if (!status) status = mpm_grid_create(ctx, &g, &grid);
  if (!status) status = mpm_material_create_custom(ctx, &m, &material);
  if (!status) status = mpm_particles_create(ctx, grid, material, &bar);
  if (!status) status = mpm_particles_fill_box(bar, &lower, &upper, &per_cell, NULL, NULL);
  if (!status) status = mpm_particles_get(bar, "position", MPM_F64, 1, PARTICLES, NULL, x);
  if (status) return status;
  for (int i = 0; i < PARTICLES; ++i) v[i] = v0 * sin(0.5 * pi * x[i]);
  status = mpm_particles_set(bar, "velocity", MPM_F64, 1, PARTICLES, NULL, v);
  if (!status) status = mpm_stepper_create(ctx, grid, &s, &stepper);
  if (!status) status = mpm_stepper_add(stepper, bar);
  if (!status) status = mpm_stepper_set_wall(stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0);

  double mode[3] = {0.0, v0, 0.0};
  *deviation = 0.0;
  printf("    t   mean velocity      theory   (of its start)\n");
  for (int k = 1; !status && k <= BAR_STEPS; ++k) {
    status = mpm_step(stepper, dt, &now);
    mode_step(law, dt, mode);
    const double start = v0 * 2.0 / pi, mean = now.momentum[0] / law->density / start, theory = mode[1] / v0;
    *deviation = fmax(*deviation, fabs(mean - theory));
    if (k % (BAR_STEPS / 12) == 0) printf("%5.1f %15.5f %11.5f\n", now.t, mean, theory);
  }
  if (!status) status = mpm_stepper_destroy(stepper);
  if (!status) status = mpm_particles_destroy(bar);
  if (!status) status = mpm_material_destroy(material);
  if (!status) status = mpm_grid_destroy(grid);
  return status;
}

int main(void) {
  const double E = 1e4, nu = 0.3, density = 100.0;
  neo_hookean twin_law = {E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 * E / (1.0 + nu), density};
  viscoelastic slow = {1.0, 0.5, 2.0, 1.0};
  static twin built_in, own;
  double deviation;
  mpm_context *ctx = NULL;
  mpm_material *material;
  mpm_material_desc m;
  const mpm_param elastic[] = {{"E", E}, {"nu", nu}, {"density", density}};
  if (mpm_context_create(NULL, &ctx) || mpm_material_create(ctx, "neo_hookean", elastic, 3, &material) ||
      shake_block(ctx, material, &built_in) || mpm_material_desc_init(&m, sizeof m))
    goto failed;
  m.density = density;
  m.stress = neo_hookean_stress;
  m.user = &twin_law;
  if (mpm_material_create_custom(ctx, &m, &material) || shake_block(ctx, material, &own)) goto failed;

  const double apart = largest_difference(2 * own.n, built_in.position, own.position);
  printf("neo-Hookean, built in and own, after %d steps of a sheared block:\n", TWIN_STEPS);
  printf("  strain energy %.12g and %.12g\n", built_in.strain_energy, own.strain_energy);
  printf("  relative difference of positions %.0e, of stresses %.0e\n\n", apart,
         largest_difference(6 * own.n, built_in.stress, own.stress));

  printf("visco-elastic bar, ringing down in its first mode:\n");
  if (ring_bar(ctx, &slow, &deviation) || mpm_context_destroy(ctx)) goto failed;
  printf("\nresult: own neo-Hookean law differs from the built-in by %.0e, visco-elastic bar from theory by "
         "%.2f %%\n",
         apart, 100.0 * deviation);
  return 0;

failed:
  fprintf(stderr, "user_material: %s\n", mpm_last_error(ctx));
  return 1;
}
