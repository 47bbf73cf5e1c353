#include "implicit/newmark.h"
#include "implicit/active_set.h"
#include "implicit/beside.h"
#include "implicit/extension.h"
#include "implicit/surface_springs.h"
#include "boundary/boundary.h"
#include "boundary/prescribed.h"
#include "stages/stages.h"

#include <string.h>

/* A row is light with no more than this share of the mass of the heaviest beside it. */
static const double light_row = 1e-3;
/* Masses are alike that differ by no more than this share: rows of a regular lattice do so by rounding. */
static const double alike = 1e-9;

/* Computes means by row: sums mass and mass times value of its nodes, and divides. */
static void fold_means(const mpmi_balance *balance, double *mean) {
  mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  memset(mean, 0, (size_t)(newton->matrix.rows * dim) * sizeof *mean);
  memset(newton->mass, 0, (size_t)newton->matrix.rows * sizeof *newton->mass);
  for (int64_t i = 0; i < newton->active_count; ++i) {
    const mpmi_active_node *node = &newton->active[i];
    const double *of = mpmi_velocity(&balance->nodes->projected, node->slot);
    const double mass = *mpmi_mass(&balance->nodes->projected, node->slot);
    newton->mass[node->row] += mass;
    for (int32_t c = 0; c < dim; ++c) mean[(int64_t)node->row * dim + c] += node->sign[c] * mass * of[c];
  }
  for (int64_t i = 0; i < newton->matrix.rows * dim; ++i)
    mean[i] = newton->mass[i / dim] > 0.0 ? mean[i] / newton->mass[i / dim] : 0.0;
}

/* Makes a projection of velocities or accelerations. */
static mpm_status project(mpmi_balance *balance, int32_t projection, double *clock) {
  const mpmi_projection *of = &mpmi_projections[projection];
  mpm_status status = mpmi_p2g_stage(balance->step, of, balance->nodes);
  mpmi_lap(balance->step, MPMI_TIME_P2G, clock);
  if (!status) status = mpmi_node_update_stage(balance->step, of, balance->nodes);
  mpmi_lap(balance->step, MPMI_TIME_GRID, clock);
  return status;
}

/* Finds the nodes' masses and who holds nodes. */
static mpm_status find_nodes(mpmi_balance *balance, double *clock) {
  const int64_t slots = mpmi_slots(balance->layout);
  mpm_status status = project(balance, MPMI_PROJECT_STRAIN, clock);
  if (status) return status;
  if (slots)
    memset(balance->nodes->solved.at, 0, (size_t)(slots * balance->nodes->solved.values) * sizeof(double));
  for (int64_t i = 0; i < slots; ++i)
    *mpmi_mass(&balance->nodes->solved, i) = *mpmi_mass(&balance->nodes->projected, i);
  balance->step->info.active_nodes = mpmi_count_owned(balance->layout, &balance->nodes->solved);
  if (balance->layout->parts) balance->layout->parts->has_counted = 1;
  status = mpmi_boundary_hold(balance->step, balance->nodes);
  mpmi_lap(balance->step, MPMI_TIME_GRID, clock);
  return status;
}

static mpm_status find_external(mpmi_balance *balance, double t, double *clock) {
  mpm_status status = mpmi_forces_stage(balance->step, t);
  if (!status) status = mpmi_surfaces_load(balance->step, t);
  mpmi_lap(balance->step, MPMI_TIME_CALLBACKS, clock);
  if (!status) status = mpmi_external_forces(balance);
  mpmi_lap(balance->step, MPMI_TIME_P2G, clock);
  return status;
}

/* Computes the accelerations at the start of the step by row: M a0 = f_ext - f_int - a M v0, and 0 for held
 * components. */
static mpm_status balance_start(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  double *external = newton->vector[MPMI_EXTERNAL];
  const mpm_status status = mpmi_start_forces(balance);
  if (status) return status;
  mpmi_unknowns_fold(balance, &newton->external, external);
  for (int64_t at = 0; at < newton->matrix.rows * dim; ++at) {
    const double mass = newton->mass[at / dim], force = external[at] - newton->vector[MPMI_INTERNAL][at];
    newton->vector[MPMI_A0][at] =
        mpmi_is_held(newton->matrix.held[at]) || !(mass > 0.0)
            ? 0.0
            : force / mass - balance->settings->desc.mass_damping * newton->vector[MPMI_V0][at];
  }
  return MPM_OK;
}

/* Puts values by row on the projected nodes. */
static void spread(mpmi_balance *balance, const double *value) {
  const mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  for (int64_t i = 0; i < newton->active_count; ++i) {
    const mpmi_active_node *node = &newton->active[i];
    double *to = mpmi_velocity(&balance->nodes->projected, node->slot);
    for (int32_t c = 0; c < dim; ++c) to[c] = node->sign[c] * value[(int64_t)node->row * dim + c];
  }
}

static int32_t lacks_accelerations(const mpmi_balance *balance) {
  int32_t lacks = 0;
  for (int32_t m = 0; m < balance->layout->member_count; ++m)
    lacks |= (balance->layout->member[m].set->dirty & MPMI_DIRTY_ACCELERATION) != 0;
  return lacks && mpmi_is_dynamic(balance->settings);
}

/* Finds the accelerations of sets that lack them, from those of the nodes. */
static mpm_status find_accelerations(mpmi_balance *balance, double *clock) {
  spread(balance, balance->newton->vector[MPMI_A0]);
  const mpm_status status = mpmi_g2p_accelerations(balance->step, balance->nodes, &balance->nodes->projected);
  mpmi_lap(balance->step, MPMI_TIME_G2P, clock);
  return status;
}

/* Gives a force on a row to the heaviest beside it, to each of those alike its part: any one of them would
 * lie to a side. */
static void give_to_heaviest(const mpmi_balance *balance, int64_t at, double most, double force) {
  const mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim, c = (int32_t)(at % dim);
  const double above = most * (1.0 - alike);
  int64_t other;
  int32_t count = 0, next = 0;
  double sign;
  while (mpmi_next_beside(balance, at / dim, c, above, &next, &sign) >= 0) ++count;
  next = 0;
  while ((other = mpmi_next_beside(balance, at / dim, c, above, &next, &sign)) >= 0)
    if (!mpmi_is_held(newton->matrix.held[other * dim + c]))
      newton->vector[MPMI_A0][other * dim + c] += sign * force / (double)count / newton->mass[other];
}

/* Light rows, where f / m is rough, take the accelerations of the particles, and the rest of their force
 * goes to neighbours. Most rows are not light beside any other, and are not looked at by components. */
static void smooth_light_rows(mpmi_balance *balance, const double *of_particles) {
  const mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  double *start = newton->vector[MPMI_A0];
  for (int64_t row = 0; row < newton->matrix.rows; ++row) {
    const double whole = mpmi_whole_mass(balance, row);
    if (whole > light_row * mpmi_heaviest_beside(balance, row, -1)) continue;
    for (int32_t c = 0; c < dim; ++c) {
      const int64_t at = row * dim + c;
      if (mpmi_is_held(newton->matrix.held[at])) continue;
      const double most = mpmi_heaviest_beside(balance, row, c);
      if (!(most > 0.0) || whole > light_row * most) continue;
      give_to_heaviest(balance, at, most, newton->mass[row] * (start[at] - of_particles[at]));
      start[at] = of_particles[at];
    }
  }
}

/* Returns 1 where forces act that act wholly at the end of the step: those of contact and of surfaces that
 * prescribe. */
static int32_t pushes_at_end(const mpmi_balance *balance) {
  return balance->newton->touches || balance->newton->has_springs;
}

/* Brings the accelerations at the start of the step into the second copies and onto the nodes. Where bodies
 * touch, or surfaces prescribe, they are those of the balance: what balances a force of contact acts at the
 * node, and particles would carry it to others. */
static mpm_status prepare_accelerations(mpmi_balance *balance, int32_t unknown, double *clock) {
  const int32_t touches = pushes_at_end(balance);
  mpm_status status = MPM_OK;
  for (int32_t m = 0; m < balance->layout->member_count; ++m) {
    const mpm_particles *set = balance->layout->member[m].set;
    if ((set->dirty & MPMI_DIRTY_ACCELERATION) || !set->ld) continue; /* or nothing was ever added */
    for (int32_t c = 0; c < balance->settings->grid->dim; ++c)
      memcpy(mpmi_component_row(set, MPMI_ACCELERATION, 1, c),
             mpmi_component_row(set, MPMI_ACCELERATION, 0, c), (size_t)set->slots * sizeof(double));
  }
  if (unknown || touches) status = balance_start(balance);
  mpmi_lap(balance->step, MPMI_TIME_ASSEMBLY, clock);
  if (!status && unknown) status = find_accelerations(balance, clock);
  if (!status) status = project(balance, MPMI_PROJECT_ACCELERATION, clock);
  if (status) return status;
  fold_means(balance, balance->newton->vector[touches ? MPMI_TERMS : MPMI_A0]);
  if (touches) smooth_light_rows(balance, balance->newton->vector[MPMI_TERMS]);
  return MPM_OK;
}

/* Projects all that the balance needs. */
static mpm_status particles_to_grid(mpmi_balance *balance, double *clock) {
  const double dt = balance->step->dt;
  mpmi_newton *newton = balance->newton;
  const int32_t unknown = lacks_accelerations(balance);
  const int32_t at_start =
      unknown ||
      (mpmi_is_dynamic(balance->settings) &&
       (balance->nodes->contact.anywhere || mpmi_surfaces_prescribe(&balance->settings->surfaces)));
  const int64_t to_unknowns = 2 + balance->nodes->prescription.any +
                              mpmi_places_nodes(balance->settings, balance->nodes); /* exchanges */
  mpm_status status = mpmi_node_places_stage(balance->step, balance->nodes);
  if (!status) status = mpmi_prescribed_stage(balance->step);
  if (!status) status = mpmi_surfaces_aim(balance->step);
  mpmi_lap(balance->step, MPMI_TIME_CALLBACKS, clock);
  if (!status) status = find_nodes(balance, clock);
  if (!status) status = find_external(balance, at_start ? balance->step->t : balance->step->t + dt, clock);
  if ((status = mpmi_vote(balance, status, to_unknowns)) || (status = mpmi_unknowns_find(balance)) ||
      (status = mpmi_surface_loads_find(balance)))
    return status;
  fold_means(balance, newton->vector[MPMI_V0]);
  status = mpmi_active_set_find(balance);
  if (!status) status = mpmi_condense_mark(balance);
  mpmi_lap(balance->step, MPMI_TIME_GRID, clock);
  if (status) return status;
  memset(newton->vector[MPMI_A0], 0,
         (size_t)(newton->matrix.rows * balance->settings->grid->dim) * sizeof(double));
  if (mpmi_is_dynamic(balance->settings)) status = prepare_accelerations(balance, unknown, clock);
  if (!status && at_start) status = find_external(balance, balance->step->t + dt, clock);
  int64_t exchanges = at_start;
  if (mpmi_is_dynamic(balance->settings))
    exchanges += 1 + (unknown || pushes_at_end(balance) ? mpmi_force_exchanges(balance) : 0);
  if ((status = mpmi_vote(balance, status, exchanges))) return status;
  mpmi_unknowns_fold(balance, &newton->external, newton->vector[MPMI_EXTERNAL]);
  return MPM_OK;
}

/* Returns what contact and springs add to the acceleration of a row. */
static double contact_acceleration(const mpmi_balance *balance, int64_t at) {
  const mpmi_newton *newton = balance->newton;
  const double mass = newton->mass[at / balance->settings->grid->dim];
  return mpmi_is_held(newton->matrix.held[at]) || !(mass > 0.0)
             ? 0.0
             : (newton->vector[MPMI_CONTACT][at] + newton->vector[MPMI_SPRINGS][at]) / mass /
                   mpmi_contact_in_balance(balance);
}

/* Returns by how much the velocity of a row changes in a step with contact, whose impulse comes on top of
 * what the accelerations without it give. */
static double increment_in_contact(const mpmi_balance *balance, int64_t at) {
  const double dt = balance->step->dt, gamma = balance->settings->desc.newmark_gamma;
  const double by_contact = contact_acceleration(balance, at);
  const double after = mpmi_newmark_acceleration(balance, at) - by_contact;
  return dt * ((1.0 - gamma) * balance->newton->vector[MPMI_A0][at] + gamma * after +
               2.0 * balance->settings->desc.newmark_beta * by_contact);
}

/* Sets what particles take from the nodes: [u / dt, m, a1 dt], or in contact the whole increment of the
 * velocity in place of the last: by their own accelerations particles would drift away from the nodes. */
static void set_nodes(mpmi_balance *balance) {
  const double dt = balance->step->dt;
  const mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  balance->step->whole_increments = pushes_at_end(balance) && mpmi_is_dynamic(balance->settings);
  for (int64_t i = 0; i < newton->active_count; ++i) {
    const mpmi_active_node *node = &newton->active[i];
    double *v = mpmi_velocity(&balance->nodes->solved, node->slot);
    double *dv = mpmi_increment(&balance->nodes->solved, node->slot);
    for (int32_t c = 0; c < dim; ++c) {
      const int64_t at = (int64_t)node->row * dim + c;
      v[c] = node->sign[c] * (newton->vector[MPMI_U][at] / dt);
      dv[c] = 0.0;
      if (mpmi_is_dynamic(balance->settings))
        dv[c] =
            node->sign[c] * (balance->step->whole_increments ? increment_in_contact(balance, at)
                                                             : dt * mpmi_newmark_acceleration(balance, at));
    }
  }
}

/* Sums up the work of damping: its mean force over the step times the way of each row. */
static void sum_damping(mpmi_balance *balance) {
  const mpmi_newton *newton = balance->newton;
  const mpm_stepper_desc *desc = &balance->settings->desc;
  const int32_t dim = balance->settings->grid->dim;
  const double beyond = balance->step->dt * (2.0 * desc->newmark_beta - desc->newmark_gamma);
  if (!(desc->mass_damping > 0.0)) return;
  for (int64_t at = 0; at < newton->matrix.rows * dim; ++at) {
    const double end = mpmi_newmark_velocity(balance, at) + beyond * contact_acceleration(balance, at);
    const double mean = 0.5 * (newton->vector[MPMI_V0][at] + end);
    if (mpmi_is_own_row(&newton->matrix, at / dim))
      mpmi_exact_add(&balance->step->work->tally.sum[MPMI_TALLY_DAMPING],
                     newton->mass[at / dim] * mpmi_damping_acceleration(balance, at, mean) *
                         newton->vector[MPMI_U][at]);
  }
}

/* Lets the nodes show the velocity at the end of the step. */
static void show_velocities(mpmi_balance *balance) {
  const double dt = balance->step->dt;
  const mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  const double gamma = balance->settings->desc.newmark_gamma;
  for (int64_t i = 0; i < newton->active_count && mpmi_is_dynamic(balance->settings); ++i) {
    const mpmi_active_node *node = &newton->active[i];
    double *v = mpmi_velocity(&balance->nodes->solved, node->slot);
    const double *dv = mpmi_increment(&balance->nodes->solved, node->slot);
    for (int32_t c = 0; c < dim; ++c) {
      const int64_t at = (int64_t)node->row * dim + c;
      if (mpmi_is_held(newton->matrix.held[at])) continue; /* u / dt is what was prescribed */
      const double start = newton->vector[MPMI_V0][at],
                   mean = dt * (1.0 - gamma) * newton->vector[MPMI_A0][at];
      v[c] = balance->step->whole_increments ? node->sign[c] * start + dv[c]
                                             : node->sign[c] * (start + mean) + gamma * dv[c];
    }
  }
}

double mpmi_next_dt(int32_t iterations, double dt) {
  enum { FEW_ITERATIONS = 4 };
  return iterations <= FEW_ITERATIONS ? 2.0 * dt : dt;
}

/* Iterates; time that is neither factor nor solve is assembly. */
static mpm_status solve(mpmi_balance *balance, double *clock) {
  const mpm_status status = mpmi_newton_solve(balance);
  mpmi_lap(balance->step, MPMI_TIME_ASSEMBLY, clock);
  balance->step->profile->seconds[MPMI_TIME_FACTOR] += balance->factor_seconds;
  balance->step->profile->seconds[MPMI_TIME_SOLVE] += balance->solve_seconds;
  balance->step->profile->seconds[MPMI_TIME_ASSEMBLY] -= balance->factor_seconds + balance->solve_seconds;
  mpmi_move_samples(balance->step, MPMI_TIME_ASSEMBLY);
  return status;
}

/* Returns 1 where no part has particles. */
static int32_t has_nothing(const mpmi_layout *layout) {
  return layout->parts ? layout->parts->is_empty : layout->blocks.count == 0;
}

mpm_status mpmi_newmark_step(mpmi_balance *balance) {
  double clock = mpmi_seconds();
  mpm_status status = mpmi_balance_prepare(balance);
  if (balance->layout->parts) status = mpmi_vote(balance, status, 0);
  if (!status && has_nothing(balance->layout)) return MPM_OK;
  if (!status) status = particles_to_grid(balance, &clock);
  mpmi_lap(balance->step, MPMI_TIME_GRID, &clock);
  if (!status) status = solve(balance, &clock);
  if (status) return status;
  status = mpmi_active_set_finish(balance);
  if (status) return status;
  if ((status = mpmi_springs_finish(balance))) return status;
  set_nodes(balance);
  sum_damping(balance);
  status = mpmi_record_reactions(balance);
  mpmi_lap(balance->step, MPMI_TIME_GRID, &clock);
  if (!status) status = mpmi_g2p_move(balance->step, balance->nodes, &balance->nodes->solved);
  if (balance->settings->surfaces.count || balance->newton->touches) status = mpmi_vote(balance, status, 0);
  if (!status && balance->newton->touches) status = mpmi_active_set_look_back(balance);
  if (!status) status = mpmi_surfaces_move(balance->step, &balance->nodes->solved, 0);
  if (!status) show_velocities(balance);
  mpmi_lap(balance->step, MPMI_TIME_G2P, &clock);
  return status;
}
