#include "implicit/newmark.h"
#include "boundary/boundary.h"
#include "boundary/prescribed.h"
#include "stages/stages.h"

#include <string.h>

/* Computes means by row: sums mass and mass times value of its nodes, and divides. */
static void fold_means(const mpmi_balance *s, double *mean) {
  mpmi_newton *newton = s->newton;
  const int32_t dim = s->settings->grid->dim;
  memset(mean, 0, (size_t)(newton->matrix.rows * dim) * sizeof *mean);
  memset(newton->mass, 0, (size_t)newton->matrix.rows * sizeof *newton->mass);
  for (int64_t i = 0; i < newton->active_count; ++i) {
    const mpmi_active_node *node = &newton->active[i];
    const double *of = mpmi_velocity(&s->nodes->projected, node->slot);
    const double mass = *mpmi_mass(&s->nodes->projected, node->slot);
    newton->mass[node->row] += mass;
    for (int32_t c = 0; c < dim; ++c) mean[(int64_t)node->row * dim + c] += node->sign[c] * mass * of[c];
  }
  for (int64_t i = 0; i < newton->matrix.rows * dim; ++i)
    mean[i] = newton->mass[i / dim] > 0.0 ? mean[i] / newton->mass[i / dim] : 0.0;
}

/* Makes a projection of velocities or accelerations. */
static mpm_status project(mpmi_balance *s, int32_t projection, double *clock) {
  const mpmi_projection *of = &mpmi_projections[projection];
  mpm_status status = mpmi_p2g_stage(s->step, of, s->nodes);
  mpmi_lap(s->step, MPMI_TIME_P2G, clock);
  if (!status) status = mpmi_node_update_stage(s->step, of, s->nodes);
  mpmi_lap(s->step, MPMI_TIME_GRID, clock);
  return status;
}

/* Finds the nodes' masses and who holds nodes. */
static mpm_status find_nodes(mpmi_balance *s, double *clock) {
  const int64_t slots = mpmi_slots(s->layout);
  mpm_status status = project(s, MPMI_PROJECT_STRAIN, clock);
  if (status) return status;
  memset(s->nodes->solved.at, 0, (size_t)(slots * s->nodes->solved.values) * sizeof(double));
  for (int64_t i = 0; i < slots; ++i) *mpmi_mass(&s->nodes->solved, i) = *mpmi_mass(&s->nodes->projected, i);
  s->step->info.active_nodes = mpmi_count_active(s->layout, &s->nodes->solved);
  status = mpmi_boundary_hold(s->step, s->nodes);
  mpmi_lap(s->step, MPMI_TIME_GRID, clock);
  return status;
}

static mpm_status find_external(mpmi_balance *s, double t, double *clock) {
  mpm_status status = mpmi_forces_stage(s->step, t);
  mpmi_lap(s->step, MPMI_TIME_CALLBACKS, clock);
  if (!status) status = mpmi_external_forces(s);
  mpmi_lap(s->step, MPMI_TIME_P2G, clock);
  return status;
}

/* Puts the accelerations at the start of the step on the nodes: M a0 = f_ext - f_int, and 0 for held
 * components. */
static mpm_status balance_start(mpmi_balance *s) {
  mpmi_newton *newton = s->newton;
  const int32_t dim = s->settings->grid->dim;
  double *u = newton->vector[MPMI_U], *external = newton->vector[MPMI_EXTERNAL];
  const int64_t n = newton->matrix.rows * dim;
  memset(u, 0, (size_t)n * sizeof *u);
  mpm_status status = mpmi_internal_forces(s, u);
  if (status) return status;
  mpmi_unknowns_fold(s, &newton->external, external);
  for (int64_t i = 0; i < newton->active_count; ++i) {
    const mpmi_active_node *node = &newton->active[i];
    double *to = mpmi_velocity(&s->nodes->projected, node->slot);
    for (int32_t c = 0; c < dim; ++c) {
      const int64_t at = (int64_t)node->row * dim + c;
      const double mass = newton->mass[node->row], force = external[at] - newton->vector[MPMI_INTERNAL][at];
      to[c] = newton->matrix.held[at] || !(mass > 0.0) ? 0.0 : node->sign[c] * (force / mass);
    }
  }
  return MPM_OK;
}

static int32_t lacks_accelerations(const mpmi_balance *s) {
  int32_t lacks = 0;
  for (int32_t m = 0; m < s->layout->member_count; ++m)
    lacks |= (s->layout->member[m].set->dirty & MPMI_DIRTY_ACCELERATION) != 0;
  return lacks && mpmi_is_dynamic(s->settings);
}

/* Finds the accelerations of sets that lack them, from those of the nodes. */
static mpm_status find_accelerations(mpmi_balance *s, double *clock) {
  mpm_status status = balance_start(s);
  mpmi_lap(s->step, MPMI_TIME_ASSEMBLY, clock);
  if (!status) status = mpmi_g2p_accelerations(s->step, s->nodes, &s->nodes->projected);
  mpmi_lap(s->step, MPMI_TIME_G2P, clock);
  return status;
}

/* Brings the accelerations at the start of the step into the second copies and onto the nodes. */
static mpm_status prepare_accelerations(mpmi_balance *s, int32_t unknown, double *clock) {
  for (int32_t m = 0; m < s->layout->member_count; ++m) {
    const mpm_particles *set = s->layout->member[m].set;
    if ((set->dirty & MPMI_DIRTY_ACCELERATION) || !set->ld) continue; /* or nothing was ever added */
    memcpy(mpmi_f64(set, MPMI_ACCELERATION, 1), mpmi_f64(set, MPMI_ACCELERATION, 0),
           (size_t)(s->settings->grid->dim * set->ld) * sizeof(double));
  }
  mpm_status status = unknown ? find_accelerations(s, clock) : MPM_OK;
  if (!status) status = project(s, MPMI_PROJECT_ACCELERATION, clock);
  if (!status) fold_means(s, s->newton->vector[MPMI_A0]);
  return status;
}

/* Projects all that the balance needs. */
static mpm_status particles_to_grid(mpmi_balance *s, double *clock) {
  const double dt = s->step->dt;
  mpmi_newton *newton = s->newton;
  const int32_t unknown = lacks_accelerations(s);
  mpm_status status = mpmi_prescribed_stage(s->step);
  mpmi_lap(s->step, MPMI_TIME_CALLBACKS, clock);
  if (status || (status = find_nodes(s, clock)) ||
      (status = find_external(s, unknown ? s->step->t : s->step->t + dt, clock)) ||
      (status = mpmi_unknowns_find(s)))
    return status;
  fold_means(s, newton->vector[MPMI_V0]);
  memset(newton->vector[MPMI_A0], 0, (size_t)(newton->matrix.rows * s->settings->grid->dim) * sizeof(double));
  if (mpmi_is_dynamic(s->settings) && (status = prepare_accelerations(s, unknown, clock))) return status;
  if (unknown && (status = find_external(s, s->step->t + dt, clock))) return status;
  mpmi_unknowns_fold(s, &newton->external, newton->vector[MPMI_EXTERNAL]);
  return MPM_OK;
}

/* Sets what particles take from the nodes: [u / dt, m, a1 dt]. */
static void set_nodes(mpmi_balance *s) {
  const double dt = s->step->dt;
  const mpmi_newton *newton = s->newton;
  const int32_t dim = s->settings->grid->dim;
  for (int64_t i = 0; i < newton->active_count; ++i) {
    const mpmi_active_node *node = &newton->active[i];
    double *v = mpmi_velocity(&s->nodes->solved, node->slot);
    double *dv = mpmi_increment(&s->nodes->solved, node->slot);
    for (int32_t c = 0; c < dim; ++c) {
      const int64_t at = (int64_t)node->row * dim + c;
      v[c] = node->sign[c] * (newton->vector[MPMI_U][at] / dt);
      dv[c] = mpmi_is_dynamic(s->settings) ? node->sign[c] * dt * mpmi_newmark_acceleration(s, at) : 0.0;
    }
  }
}

/* Lets the nodes show the velocity at the end of the step. */
static void show_velocities(mpmi_balance *s) {
  const double dt = s->step->dt;
  const mpmi_newton *newton = s->newton;
  const int32_t dim = s->settings->grid->dim;
  const double gamma = s->settings->desc.newmark_gamma;
  for (int64_t i = 0; i < newton->active_count && mpmi_is_dynamic(s->settings); ++i) {
    const mpmi_active_node *node = &newton->active[i];
    double *v = mpmi_velocity(&s->nodes->solved, node->slot);
    const double *dv = mpmi_increment(&s->nodes->solved, node->slot);
    for (int32_t c = 0; c < dim; ++c) {
      const int64_t at = (int64_t)node->row * dim + c;
      if (newton->matrix.held[at]) continue; /* u / dt is what was prescribed */
      v[c] =
          node->sign[c] * (newton->vector[MPMI_V0][at] + dt * (1.0 - gamma) * newton->vector[MPMI_A0][at]) +
          gamma * dv[c];
    }
  }
}

double mpmi_next_dt(int32_t iterations, double dt) {
  enum { FEW_ITERATIONS = 4 };
  return iterations <= FEW_ITERATIONS ? 2.0 * dt : dt;
}

/* Iterates; time that is neither factor nor solve is assembly. */
static mpm_status solve(mpmi_balance *s, double *clock) {
  const mpm_status status = mpmi_newton_solve(s);
  mpmi_lap(s->step, MPMI_TIME_ASSEMBLY, clock);
  s->step->profile->seconds[MPMI_TIME_FACTOR] += s->factor_seconds;
  s->step->profile->seconds[MPMI_TIME_SOLVE] += s->solve_seconds;
  s->step->profile->seconds[MPMI_TIME_ASSEMBLY] -= s->factor_seconds + s->solve_seconds;
  mpmi_move_samples(s->step, MPMI_TIME_ASSEMBLY);
  return status;
}

mpm_status mpmi_newmark_step(mpmi_balance *s) {
  double clock = mpmi_seconds();
  mpm_status status = mpmi_balance_prepare(s);
  if (!status && !s->layout->blocks.count) return MPM_OK; /* no particles */
  if (!status) status = particles_to_grid(s, &clock);
  mpmi_lap(s->step, MPMI_TIME_GRID, &clock);
  if (!status) status = solve(s, &clock);
  if (status) return status;
  set_nodes(s);
  status = mpmi_record_reactions(s);
  mpmi_lap(s->step, MPMI_TIME_GRID, &clock);
  if (!status) status = mpmi_g2p_move(s->step, s->nodes, &s->nodes->solved);
  if (!status) show_velocities(s);
  mpmi_lap(s->step, MPMI_TIME_G2P, &clock);
  return status;
}
