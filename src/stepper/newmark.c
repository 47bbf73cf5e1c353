/* One implicit step by Newmark's rule (Guilkey & Weiss 2003, eqs 14-16, for any beta and gamma), or
 * quasi-static without inertia:
 *
 *   particles -> nodes   M, v0 = sum w m v_p / M, a0 = sum w m a_p / M, external forces of the end of the
 * step
 *
 *   nodes                f_int(u) + M a1 = f_ext,  a1 = (u - dt v0 - dt^2 (1/2 - beta) a0) / (beta dt^2)
 *
 *   nodes -> particles   x_p += sum w u,  a_p' = sum w a1,  v_p += dt ((1 - gamma) a_p + gamma a_p') */
#include "stepper/newton.h"

#include <string.h>

/* Sums over the nodes of each row of mass and mass times value, nodes being [value mass]; then the quotient.
 */
static void fold_means(const mpm_stepper *s, const double *nodes, double *mean) {
  mpmi_newton *w = s->newton;
  const int32_t dim = s->grid->dim;
  memset(mean, 0, (size_t)(w->matrix.rows * dim) * sizeof *mean);
  memset(w->mass, 0, (size_t)w->matrix.rows * sizeof *w->mass);
  for (int64_t i = 0; i < w->active_count; ++i) {
    const mpmi_active_node *node = &w->active[i];
    const double *from = nodes + 4 * node->slot;
    w->mass[node->row] += from[3];
    for (int32_t c = 0; c < dim; ++c) mean[(int64_t)node->row * dim + c] += node->sign[c] * from[3] * from[c];
  }
  for (int64_t i = 0; i < w->matrix.rows * dim; ++i)
    mean[i] = w->mass[i / dim] > 0.0 ? mean[i] / w->mass[i / dim] : 0.0;
}

/* A projection of velocities or accelerations into `again`. */
static mpm_status project(mpm_stepper *s, int32_t projection, double *clock) {
  mpm_status status = mpmi_stage_p2g(s, projection);
  mpmi_lap(s, MPMI_TIME_P2G, clock);
  if (!status) status = mpmi_stage_nodes(s, projection);
  mpmi_lap(s, MPMI_TIME_GRID, clock);
  return status;
}

/* Masses of the nodes, and who holds them. */
static mpm_status find_nodes(mpm_stepper *s, double dt, double *clock) {
  const int64_t slots = s->blocks.count * s->blocks.nodes;
  mpm_status status = project(s, MPMI_PROJECT_STRAIN, clock);
  if (status) return status;
  s->last.active_nodes = 0;
  for (int64_t i = 0; i < slots; ++i) {
    memset(s->node + 8 * i, 0, 8 * sizeof *s->node);
    s->node[8 * i + 3] = s->again[4 * i + 3];
    s->last.active_nodes += s->node[8 * i + 3] > s->mass_cut;
  }
  status = mpmi_stage_hold(s, dt);
  mpmi_lap(s, MPMI_TIME_GRID, clock);
  return status;
}

static mpm_status find_external(mpm_stepper *s, double t, double dt, double *clock) {
  mpm_status status = mpmi_stage_forces(s, t, dt);
  mpmi_lap(s, MPMI_TIME_CALLBACKS, clock);
  if (!status) status = mpmi_external_forces(s);
  mpmi_lap(s, MPMI_TIME_P2G, clock);
  return status;
}

/* M a0 = f_ext - f_int at the start of the step; held components have none. */
static mpm_status balance_start(mpm_stepper *s, double dt) {
  mpmi_newton *w = s->newton;
  const int32_t dim = s->grid->dim;
  double *u = w->vector[MPMI_U], *external = w->vector[MPMI_EXTERNAL];
  const int64_t n = w->matrix.rows * dim;
  memset(u, 0, (size_t)n * sizeof *u);
  mpm_status status = mpmi_internal_forces(s, u, dt);
  if (status) return status;
  mpmi_unknowns_fold(s, w->external, external);
  for (int64_t i = 0; i < w->active_count; ++i) {
    const mpmi_active_node *node = &w->active[i];
    double *to = s->again + 4 * node->slot;
    for (int32_t c = 0; c < dim; ++c) {
      const int64_t at = (int64_t)node->row * dim + c;
      const double mass = w->mass[node->row], force = external[at] - w->vector[MPMI_INTERNAL][at];
      to[c] = w->matrix.held[at] || !(mass > 0.0) ? 0.0 : node->sign[c] * (force / mass);
    }
  }
  return MPM_OK;
}

static int32_t lacks_accelerations(const mpm_stepper *s) {
  int32_t lacks = 0;
  for (int32_t m = 0; m < s->member_count; ++m)
    lacks |= (s->member[m].set->dirty & MPMI_DIRTY_ACCELERATION) != 0;
  return lacks && mpmi_is_dynamic(s);
}

/* Of the sets that do not know their accelerations, from those of the nodes. */
static mpm_status find_accelerations(mpm_stepper *s, double dt, double *clock) {
  mpm_status status = balance_start(s, dt);
  mpmi_lap(s, MPMI_TIME_ASSEMBLY, clock);
  if (!status) status = mpmi_stage_g2p(s, MPMI_G2P_ACCELERATION, s->again, 4, dt);
  mpmi_lap(s, MPMI_TIME_G2P, clock);
  return status;
}

/* Accelerations at the start of the step into the second copy of the particles', and onto the nodes. */
static mpm_status prepare_accelerations(mpm_stepper *s, double dt, int32_t unknown, double *clock) {
  for (int32_t m = 0; m < s->member_count; ++m) {
    const mpm_particles *set = s->member[m].set;
    if ((set->dirty & MPMI_DIRTY_ACCELERATION) || !set->ld) continue; /* or nothing was ever added */
    memcpy(mpmi_f64(set, MPMI_ACCELERATION, 1), mpmi_f64(set, MPMI_ACCELERATION, 0),
           (size_t)(s->grid->dim * set->ld) * sizeof(double));
  }
  mpm_status status = unknown ? find_accelerations(s, dt, clock) : MPM_OK;
  if (!status) status = project(s, MPMI_PROJECT_ACCELERATION, clock);
  if (!status) fold_means(s, s->again, s->newton->vector[MPMI_A0]);
  return status;
}

/* Everything that the balance of the nodes needs to know. */
static mpm_status particles_to_grid(mpm_stepper *s, double dt, double *clock) {
  mpmi_newton *w = s->newton;
  const int32_t unknown = lacks_accelerations(s);
  mpm_status status = mpmi_stage_motion(s, dt);
  mpmi_lap(s, MPMI_TIME_CALLBACKS, clock);
  if (status || (status = find_nodes(s, dt, clock)) ||
      (status = find_external(s, unknown ? s->t : s->t + dt, dt, clock)) || (status = mpmi_unknowns_find(s)))
    return status;
  fold_means(s, s->again, w->vector[MPMI_V0]);
  memset(w->vector[MPMI_A0], 0, (size_t)(w->matrix.rows * s->grid->dim) * sizeof(double));
  if (mpmi_is_dynamic(s) && (status = prepare_accelerations(s, dt, unknown, clock))) return status;
  if (unknown && (status = find_external(s, s->t + dt, dt, clock))) return status;
  mpmi_unknowns_fold(s, w->external, w->vector[MPMI_EXTERNAL]);
  return MPM_OK;
}

/* What particles take from the nodes: [u / dt, m, a1 dt]. */
static void set_nodes(mpm_stepper *s, double dt) {
  const mpmi_newton *w = s->newton;
  const int32_t dim = s->grid->dim;
  for (int64_t i = 0; i < w->active_count; ++i) {
    const mpmi_active_node *node = &w->active[i];
    double *to = s->node + 8 * node->slot;
    for (int32_t c = 0; c < dim; ++c) {
      const int64_t at = (int64_t)node->row * dim + c;
      to[c] = node->sign[c] * (w->vector[MPMI_U][at] / dt);
      to[4 + c] = mpmi_is_dynamic(s) ? node->sign[c] * dt * mpmi_newmark_acceleration(s, dt, at) : 0.0;
    }
  }
}

/* Nodes show the velocity at the end of the step. */
static void show_velocities(mpm_stepper *s, double dt) {
  const mpmi_newton *w = s->newton;
  const int32_t dim = s->grid->dim;
  const double gamma = s->desc.newmark_gamma;
  for (int64_t i = 0; i < w->active_count && mpmi_is_dynamic(s); ++i) {
    const mpmi_active_node *node = &w->active[i];
    double *to = s->node + 8 * node->slot;
    for (int32_t c = 0; c < dim; ++c) {
      const int64_t at = (int64_t)node->row * dim + c;
      if (w->matrix.held[at]) continue; /* u / dt is what was prescribed */
      to[c] = node->sign[c] * (w->vector[MPMI_V0][at] + dt * (1.0 - gamma) * w->vector[MPMI_A0][at]) +
              gamma * to[4 + c];
    }
  }
}

double mpmi_next_dt(const mpm_stepper *s, double dt) {
  enum { FEW_ITERATIONS = 4 };
  return s->newton->iterations <= FEW_ITERATIONS ? 2.0 * dt : dt;
}

/* The iterations; what is neither factorisation nor solution is assembly. */
static mpm_status solve(mpm_stepper *s, double dt, double *clock) {
  const mpmi_newton *w = s->newton;
  const mpm_status status = mpmi_newton_solve(s, dt);
  mpmi_lap(s, MPMI_TIME_ASSEMBLY, clock);
  s->seconds[MPMI_TIME_FACTOR] += w->factor_seconds;
  s->seconds[MPMI_TIME_SOLVE] += w->solve_seconds;
  s->seconds[MPMI_TIME_ASSEMBLY] -= w->factor_seconds + w->solve_seconds;
  mpmi_book_samples(s, MPMI_TIME_ASSEMBLY);
  return status;
}

mpm_status mpmi_newmark_step(mpm_stepper *s, double dt) {
  double clock = mpmi_seconds();
  mpm_status status = mpmi_newton_prepare(s);
  if (!status && !s->blocks.count) return MPM_OK; /* no particles */
  if (!status) status = particles_to_grid(s, dt, &clock);
  mpmi_lap(s, MPMI_TIME_GRID, &clock);
  if (!status) status = solve(s, dt, &clock);
  if (status) return status;
  set_nodes(s, dt);
  status = mpmi_book_reactions(s, dt);
  mpmi_lap(s, MPMI_TIME_GRID, &clock);
  if (!status) status = mpmi_stage_g2p(s, MPMI_G2P_MOVE, s->node, s->values, dt);
  if (!status) show_velocities(s, dt);
  mpmi_lap(s, MPMI_TIME_G2P, &clock);
  return status;
}

mpm_status mpm_stepper_residuals(const mpm_stepper *s, int32_t capacity, double *residual, int32_t *count) {
  MPMI_ENTER(s, MPMI_STEPPER);
  if (!count) return mpmi_fail(s->context, MPM_E_ARG, "count is NULL");
  if (capacity < 0) return mpmi_fail(s->context, MPM_E_ARG, "capacity is %d: it must be >= 0", (int)capacity);
  if (capacity && !residual) return mpmi_fail(s->context, MPM_E_ARG, "residual is NULL");
  const int32_t known = s->newton && mpmi_is_implicit(s) ? s->newton->history_count : 0;
  for (int32_t i = 0; i < known && i < capacity; ++i) residual[i] = s->newton->history[i];
  *count = known;
  return MPM_OK;
}
