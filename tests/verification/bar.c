#include "bar.h"

typedef struct motion {
  double amplitude;
  int32_t cells; /* of the bar */
} motion;

static double displacement(const motion *m, double X, double t) {
  return m->amplitude * sin(2.0 * PI * X) * cos(bar_speed * PI * t);
}

static double stretch(const motion *m, double X, double t) {
  return 1.0 + 2.0 * m->amplitude * PI * cos(2.0 * PI * X) * cos(bar_speed * PI * t);
}

/* Eq. 49. */
static mpm_status body_force(void *user, const mpm_particle_batch *batch, double *add) {
  const motion *m = user;
  const double k = bar_speed * bar_speed * PI * PI;
  for (int64_t i = 0; i < batch->n; ++i) {
    const double X = batch->reference_position[i], F = stretch(m, X, batch->t);
    add[i] += k * displacement(m, X, batch->t) * (2.0 / (F * F) + 1.0);
  }
  return MPM_OK;
}

/* At rest are the nodes of the ends and all beyond. */
static mpm_status hold_nodes(void *user, const mpm_node_batch *batch, uint8_t *prescribed, double *velocity) {
  const double h = 1.0 / ((const motion *)user)->cells;
  for (int64_t i = 0; i < batch->n; ++i)
    if (batch->position[i] < 1e-9 * h || batch->position[i] > 1.0 - 1e-9 * h)
      prescribed[i] = 1, velocity[i] = 0.0;
  return MPM_OK;
}

/* The exact state, the velocity at -dt / 2. */
static void start(const verify_world *w, mpm_particles *set, const motion *m, double dt) {
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(w, set, "position", 1), *v = verify_array(n), *F = verify_array(9 * n);
  for (int64_t p = 0; p < n; ++p) {
    const double X = x[p];
    x[p] += displacement(m, X, 0.0);
    v[p] = m->amplitude * sin(2.0 * PI * X) * bar_speed * PI * sin(0.5 * bar_speed * PI * dt);
    F[p] = stretch(m, X, 0.0), F[4 * n + p] = F[8 * n + p] = 1.0;
  }
  verify_put(w, set, "position", 1, x);
  verify_put(w, set, "velocity", 1, v);
  verify_put(w, set, "deformation_gradient", 9, F);
  free(x), free(v), free(F);
}

double bar_error(const bar *how, int32_t cells, double amplitude, double dt, double t_end) {
  const double lower = 0.0, upper = 1.0;
  /* Overwritten ghosts let particles move through the ends: the grid goes on beyond them. */
  const int32_t margin = how->ends == BAR_OVERWRITTEN_NODES && !how->boundary_basis ? 4 : 0;
  motion m = {amplitude, cells};
  verify_setup setup = verify_defaults(1, cells + 2 * margin, 1.0 / cells);
  setup.grid.origin[0] = -(double)margin / cells;
  setup.grid.basis = how->basis;
  setup.grid.boundary_basis = how->boundary_basis;
  setup.grid.total_lagrangian = how->total;
  setup.grid.periodic[0] = how->ends == BAR_PERIODIC;
  if (how->smoothing > 0.0) setup.grid.smoothing = how->smoothing;
  if (how->scheme) setup.stepper.scheme = how->scheme;
  setup.stepper.projected_positions = how->projected;
  setup.stepper.boundary_zero_acceleration = how->zero_acceleration;
  setup.stepper.staggered = setup.stepper.reference_positions = 1;
  verify_world w;
  verify_open(&w, &setup);
  mpm_particles *set = verify_set(&w, verify_elastic(&w, "neo_hookean", bar_E, 0.0, 1.0));
  verify_ok(&w, mpm_particles_fill_box(set, &lower, &upper, &how->per_cell, NULL, NULL));
  verify_ok(&w, mpm_stepper_set_acceleration(w.stepper, body_force, &m));
  for (int32_t face = MPM_X_MIN; face <= MPM_X_MAX && how->ends == BAR_FIXED_WALLS; ++face)
    verify_ok(&w, mpm_stepper_set_wall(w.stepper, face, MPM_WALL_FIXED, 0.0));
  if (how->ends == BAR_OVERWRITTEN_NODES)
    verify_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, hold_nodes, &m));
  double *X = verify_get(&w, set, "position", 1);
  start(&w, set, &m, dt);

  const int32_t steps = (int32_t)lround(t_end / dt);
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < steps && status == MPM_OK; ++i) status = mpm_step(w.stepper, dt, NULL);
  if (status != MPM_INVERTED && status != MPM_NONFINITE && status != MPM_OFF_GRID) verify_ok(&w, status);

  double error = status ? HUGE_VAL : 0.0;
  double *x = verify_get(&w, set, "position", 1);
  for (int64_t p = 0; p < mpm_particles_count(set) && !status; ++p) {
    const double d = x[p] - X[p] - displacement(&m, X[p], steps * dt);
    error = fmax(error, fabs(d - rint(d))); /* positions are wrapped */
  }
  free(X), free(x);
  verify_close(&w);
  return error;
}
