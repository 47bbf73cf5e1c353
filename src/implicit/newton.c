/* Newton's method for the displacements of one implicit step: Guilkey & Weiss 2003, eqs 11-13, for any beta
 * and gamma.
 *
 * The first increment carries the prescribed displacements on its right-hand side (tangent predictor): nodes
 * that are moved at once, with the rest at rest, turn cells inside out. Increments that do so all the same,
 * or that take the residual up, are halved. */
#include "implicit/active_set.h"
#include "implicit/extension.h"
#include "implicit/trouble.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* How often an increment is halved at most, and before a larger residual is accepted. */
enum { MOST_HALVINGS = 12, RESIDUAL_HALVINGS = 4 };

typedef struct iteration {
  mpmi_balance *balance;
  mpmi_newton *newton;
  int64_t n, all;       /* rows * dim, of this part and of all */
  double norm, scale;   /* norm of the residual, of free components; scale from all kinds of forces */
  double stiffness;     /* largest diagonal entry, without inertia */
  double inertia;       /* norm of the terms of M a before they cancel: its rounding grows with them */
  double inertia_share; /* share of inertia in the diagonal of the matrix */
  double du_largest, energy_first;
} iteration;

/* Returns the sum of all entries of MPMI_TERMS. */
static double sum_of(const iteration *it) {
  return mpmi_sum_rows(it->balance, it->newton->vector[MPMI_TERMS]);
}

/* Returns the dot product of the free components alone, or of all. */
static double dot_of(const iteration *it, const double *a, const double *b, int32_t free_only) {
  const uint8_t *held = it->newton->matrix.held;
  double *term = it->newton->vector[MPMI_TERMS];
  for (int64_t i = 0; i < it->n; ++i) term[i] = free_only && held[i] ? 0.0 : a[i] * b[i];
  return sum_of(it);
}

static double norm_of(const iteration *it, const double *v, int32_t free_only) {
  return sqrt(dot_of(it, v, v, free_only));
}

/* Returns the length of an increment, weighted by stiffness: a node at the rim of a body may move far and
 * mean little. */
static double length_of(const iteration *it, const double *du) {
  double *term = it->newton->vector[MPMI_TERMS];
  for (int64_t i = 0; i < it->n; ++i) term[i] = it->newton->vector[MPMI_DIAGONAL][i] * du[i] * du[i];
  return sqrt(sum_of(it));
}

/* Computes the residual of the internal forces as they are; returns the norm of the inertia. */
static double find_forces(iteration *it) {
  const mpmi_balance *balance = it->balance;
  mpmi_newton *newton = it->newton;
  const double *internal = newton->vector[MPMI_INTERNAL], *external = newton->vector[MPMI_EXTERNAL];
  double *residual = newton->vector[MPMI_RESIDUAL], *term = newton->vector[MPMI_TERMS];
  const int32_t dim = balance->settings->grid->dim, dynamic = mpmi_is_dynamic(balance->settings);
  for (int64_t i = 0; i < it->n; ++i) {
    const double Ma = dynamic ? newton->mass[i / dim] * mpmi_newmark_inertia(balance, i) : 0.0;
    residual[i] =
        internal[i] + Ma - external[i] - newton->vector[MPMI_CONTACT][i] - newton->vector[MPMI_SPRINGS][i];
    term[i] = Ma * Ma;
  }
  mpmi_condense_forces(balance, residual);
  return sqrt(sum_of(it));
}

/* Returns the norm of the terms of M a before they cancel: its rounding grows with them. */
static double inertia_terms(const iteration *it) {
  const mpmi_balance *balance = it->balance;
  const mpmi_newton *newton = it->newton;
  const int32_t dim = balance->settings->grid->dim;
  const double dt = balance->step->dt, beta = mpmi_damped_beta(balance);
  if (!mpmi_is_dynamic(balance->settings)) return 0.0;
  for (int64_t i = 0; i < it->n; ++i) {
    const double reach = fabs(newton->vector[MPMI_U][i]) + dt * fabs(newton->vector[MPMI_V0][i]);
    const double term = newton->mass[i / dim] * reach / (beta * dt * dt);
    newton->vector[MPMI_TERMS][i] = term * term;
  }
  return sqrt(sum_of(it));
}

/* Computes residual and scale; reactions are in the scale, as internal forces of held components. */
static void find_residual(iteration *it) {
  double *const *vector = it->newton->vector;
  const double inertia = find_forces(it);
  it->inertia = inertia_terms(it);
  it->norm = norm_of(it, vector[MPMI_RESIDUAL], 1);
  it->scale =
      fmax(inertia, fmax(norm_of(it, vector[MPMI_INTERNAL], 0), norm_of(it, vector[MPMI_EXTERNAL], 0)));
}

static double relative(const iteration *it) {
  return it->scale > 0.0 ? it->norm / it->scale : 0.0;
}

/* Returns what rounding may leave in the residual: the force of displacements that are rounding of a cell's
 * edge, and the rounding of the inertia terms. */
static double noise(const iteration *it) {
  return 16.0 * DBL_EPSILON *
         (it->stiffness * it->balance->settings->grid->h_min * sqrt((double)it->all) + it->inertia);
}

static void note(iteration *it) {
  mpmi_newton *newton = it->newton;
  if (newton->history_count < newton->history_capacity)
    newton->history[newton->history_count++] = relative(it);
  it->balance->step->info.residual = relative(it);
}

/* Puts the inertia onto the diagonal, and finds out how much each of the two weighs there. */
static void add_inertia(iteration *it) {
  const mpmi_balance *balance = it->balance;
  mpmi_newton *newton = it->newton;
  mpmi_matrix *A = &newton->matrix;
  double *term = newton->vector[MPMI_TERMS], *size = newton->vector[MPMI_DIAGONAL];
  const int32_t dim = balance->settings->grid->dim;
  const double beta = mpmi_damped_beta(balance), dt = balance->step->dt;
  const double damping = balance->settings->desc.mass_damping * balance->settings->desc.newmark_gamma;
  const double by_mass =
      mpmi_is_dynamic(balance->settings) ? 1.0 / (beta * dt * dt) + damping / (beta * dt) : 0.0;
  for (int64_t i = 0; i < it->n; ++i) {
    double *diagonal = A->value + (newton->diagonal[i / dim] * dim + i % dim) * dim + i % dim;
    term[i] = fabs(*diagonal);
    *diagonal += by_mass * newton->mass[i / dim];
    size[i] = fabs(*diagonal);
  }
  it->stiffness = mpmi_largest_in_rows(balance, term);
  for (int64_t i = 0; i < it->n; ++i) term[i] = by_mass * newton->mass[i / dim];
  const double inertia = sum_of(it);
  const double total = mpmi_sum_rows(balance, size);
  it->inertia_share = total > 0.0 ? inertia / total : 0.0;
}

static mpm_status assemble(iteration *it) {
  mpm_status status = mpmi_stiffness(it->balance, it->newton->vector[MPMI_U]);
  if (status) return status;
  add_inertia(it);
  if ((status = mpmi_active_set_stiffen(it->balance))) return status;
  mpmi_condense_matrix(it->balance);
  return MPM_OK;
}

/* Computes the right-hand side, with what is left of the prescribed displacements on it; tells whether there
 * is any. */
static mpm_status find_rhs(iteration *it, int32_t *moves_held) {
  mpmi_newton *newton = it->newton;
  const uint8_t *held = newton->matrix.held;
  double *rhs = newton->vector[MPMI_RHS], *du = newton->vector[MPMI_DU];
  *moves_held = 0;
  for (int64_t i = 0; i < it->n; ++i) {
    du[i] = mpmi_is_held(held[i]) ? newton->vector[MPMI_TARGET][i] - newton->vector[MPMI_U][i] : 0.0;
    *moves_held |= du[i] != 0.0;
  }
  memset(rhs, 0, (size_t)it->n * sizeof *rhs);
  double any = *moves_held;
  mpm_status status = mpmi_largest_of_parts(it->balance, 1, &any);
  *moves_held = any > 0.0;
  if (status) return status;
  if (*moves_held && (status = mpmi_vote(it->balance, mpmi_matrix_apply(&newton->matrix, du, rhs), 0)))
    return status;
  for (int64_t i = 0; i < it->n; ++i) rhs[i] = held[i] ? 0.0 : -newton->vector[MPMI_RESIDUAL][i] - rhs[i];
  mpmi_active_set_load(it->balance, rhs);
  return MPM_OK;
}

static mpm_status solve(iteration *it) {
  mpmi_balance *balance = it->balance;
  mpmi_newton *newton = it->newton;
  const double *du_held = newton->vector[MPMI_DU];
  double *x = newton->vector[MPMI_START];
  mpm_status status = mpmi_vote(balance, mpmi_matrix_eliminate(&newton->matrix), 0);
  if (status) return status;
  memset(x, 0, (size_t)it->n * sizeof *x);
  /* as many digits as keep the iteration quadratic, and none that the next one throws away; what contact
   * closes has stiffness, and its part of the right-hand side takes some of them */
  const double kept = newton->touches ? 1e-3 : 1.0;
  const double wanted = fmax(1e-10, kept * fmin(1e-3, 0.1 * relative(it)));
  const mpmi_solve_job job = {.matrix = &newton->matrix,
                              .rhs = newton->vector[MPMI_RHS],
                              .x = x,
                              .choice = balance->settings->desc.linear_solver,
                              .tolerance = balance->settings->desc.linear_tolerance > 0.0
                                               ? balance->settings->desc.linear_tolerance
                                               : wanted,
                              .max_iterations = balance->settings->desc.linear_max_iterations,
                              .host = balance->settings->solver,
                              .host_user = balance->settings->solver_user,
                              .expects_positive = newton->matrix.symmetric,
                              .inertia = it->inertia_share,
                              .several_fields = newton->several_fields};
  mpmi_solve_report report = {.node = -1};
  status = mpmi_solve(newton->solver, &job, &report);
  balance->factor_seconds += report.factor_seconds;
  balance->solve_seconds += report.solve_seconds;
  balance->linear_iterations += report.iterations;
  balance->solver_used = report.solver;
  balance->step->negative_pivots = report.negative;
  ++balance->iterations;
  if (status) {
    balance->step->failure.callback_status = report.callback_status;
    return mpmi_tell_unsolved(balance, status, report.node);
  }
  if (newton->shared && (status = mpmi_rows_complete(newton->shared, x))) return status;
  for (int64_t i = 0; i < it->n; ++i)
    newton->vector[MPMI_DU][i] = mpmi_is_held(newton->matrix.held[i]) ? du_held[i] : x[i];
  mpmi_condense_extend(balance, newton->vector[MPMI_DU]);
  return newton->shared ? mpmi_rows_complete(newton->shared, newton->vector[MPMI_DU]) : MPM_OK;
}

/* Returns 1 for statuses of a trial that a shorter increment may mend. */
static int32_t may_shrink(const mpmi_balance *balance, mpm_status status) {
  return !balance->step->failure.callback_status &&
         (status == MPM_INVERTED || status == MPM_NONFINITE || status == MPM_CUT_DT);
}

/* Takes as much of the increment as keeps det F positive and the residual in bounds. */
static mpm_status line_search(iteration *it, int32_t moves_held, double *taken) {
  mpmi_newton *newton = it->newton;
  double *u = newton->vector[MPMI_U], *start = newton->vector[MPMI_START];
  const double *du = newton->vector[MPMI_DU];
  /* what contact still lacks is on the right-hand side alone */
  const double lacks = newton->touches ? norm_of(it, newton->vector[MPMI_RHS], 1) : 0.0;
  const double before = fmax(it->norm, lacks), slope = fabs(dot_of(it, du, newton->vector[MPMI_RESIDUAL], 1));
  memcpy(start, u, (size_t)it->n * sizeof *u);
  mpmi_active_set_aim(it->balance, du);
  *taken = 1.0;
  for (int32_t halvings = 0;; ++halvings, *taken *= 0.5) {
    for (int64_t i = 0; i < it->n; ++i) u[i] = start[i] + *taken * du[i];
    const mpm_status status = mpmi_internal_forces(it->balance, u);
    if (status && (!may_shrink(it->balance, status) || halvings == MOST_HALVINGS)) return status;
    if (status) continue;
    mpmi_active_set_move(it->balance, *taken);
    find_residual(it);
    if (!isfinite(it->norm))
      return mpmi_fail(it->balance->settings->context, MPM_NONFINITE,
                       "the residual is not finite in the step from t = %g with "
                       "dt = %g",
                       it->balance->step->t, it->balance->step->dt);
    if (moves_held || halvings >= RESIDUAL_HALVINGS || it->norm <= before ||
        fabs(dot_of(it, du, newton->vector[MPMI_RESIDUAL], 1)) <= slope)
      return MPM_OK;
  }
}

/* Tells whether the bound of the residual holds. */
static int32_t balances(const iteration *it) {
  const mpm_stepper_desc *d = &it->balance->settings->desc;
  return it->norm <= d->newton_tolerance_residual * it->scale || it->norm <= d->newton_residual_floor;
}

/* Tells whether the bounds of eq. 13 and of the residual hold, or the residual is rounding. */
static int32_t converged(iteration *it, double du, double energy) {
  const mpm_stepper_desc *d = &it->balance->settings->desc;
  it->du_largest = fmax(it->du_largest, du);
  if (it->norm <= noise(it)) return 1;
  return balances(it) && du <= d->newton_tolerance_displacement * it->du_largest &&
         energy <= d->newton_tolerance_energy * it->energy_first;
}

/* Brings the set of closed touches up to date; tells whether it was so already and all of them are closed. */
static mpm_status settle_contact(iteration *it, int32_t *settled) {
  int32_t changed;
  *settled = 1;
  if (!it->newton->touches) return MPM_OK;
  const mpm_status status = mpmi_active_set_update(it->balance, &changed);
  if (status) return status;
  mpmi_active_set_fold(it->balance);
  find_residual(it);
  if (!changed && balances(it)) mpmi_active_set_harden(it->balance);
  *settled = !changed && mpmi_active_set_error(it->balance) <= 1.0;
  return MPM_OK;
}

/* Puts the counts so far into the info of the step. */
static void tell(const mpmi_balance *balance) {
  balance->step->info.newton_iterations = balance->iterations;
  balance->step->info.linear_solver = balance->solver_used;
  balance->step->info.linear_iterations = balance->linear_iterations;
}

/* Asks the host whether to go on; of several parts all go on, or none. */
static mpm_status ask_progress(const mpmi_balance *balance) {
  const mpm_status status = balance->step->ask_progress(balance->step->stepper);
  return balance->layout->parts && balance->layout->parts->asks ? mpmi_vote(balance, status, 0) : status;
}

static mpm_status iterate(iteration *it) {
  mpmi_newton *newton = it->newton;
  int32_t settled = 1, holds = 0;
  for (;;) {
    int32_t moves_held;
    double taken;
    mpm_status status;
    if (it->balance->iterations >= it->balance->settings->desc.newton_max_iterations)
      return mpmi_tell_not_converged(it->balance, !settled);
    if ((status = assemble(it)) || (status = find_rhs(it, &moves_held))) return status;
    if (!moves_held && it->norm <= noise(it) && mpmi_active_set_error(it->balance) <= 1.0) return MPM_OK;
    status = solve(it);
    if (status == MPM_SINGULAR && it->balance->iterations == 1 && newton->touches) {
      const mpm_status lost = mpmi_active_set_hold(it->balance, &holds);
      if (lost) return lost;
      if (holds) continue;
    }
    if (status) return status;
    const double energy = fabs(dot_of(it, newton->vector[MPMI_DU], newton->vector[MPMI_RHS], 1));
    if (!(it->energy_first > 0.0)) it->energy_first = energy;
    if ((status = line_search(it, moves_held, &taken))) return status;
    if ((status = settle_contact(it, &settled))) return status;
    note(it);
    tell(it->balance);
    if ((status = ask_progress(it->balance))) return status;
    if (taken == 1.0 && settled && converged(it, length_of(it, newton->vector[MPMI_DU]), energy))
      return MPM_OK;
    it->du_largest = fmax(it->du_largest, taken * length_of(it, newton->vector[MPMI_DU]));
  }
}

mpm_status mpmi_newton_solve(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  iteration it = {
      .balance = balance, .newton = newton, .n = newton->matrix.rows * balance->settings->grid->dim};
  it.all = newton->shared ? newton->shared->all * balance->settings->grid->dim : it.n;
  memset(newton->vector[MPMI_U], 0, (size_t)it.n * sizeof(double));
  mpm_status status = mpmi_internal_forces(balance, newton->vector[MPMI_U]);
  if (status) return status;
  find_residual(&it);
  note(&it);
  status = iterate(&it);
  tell(balance);
  return status;
}
