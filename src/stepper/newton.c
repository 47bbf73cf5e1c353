/* Newton's method for the displacements of one implicit step: Guilkey & Weiss 2003, eqs 11-13, for any beta
 * and gamma.
 *
 * The first increment carries the prescribed displacements on its right-hand side (tangent predictor): nodes
 * that are moved at once, with the rest at rest, turn cells inside out. Increments that do so all the same,
 * or that take the residual up, are halved. */
#include "stepper/newton.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* Halvings of an increment before it is given up, and before a larger residual is accepted. */
enum { MOST_HALVINGS = 12, RESIDUAL_HALVINGS = 4 };

typedef struct iteration {
  mpm_stepper *s;
  mpmi_newton *w;
  double dt;
  int64_t n;            /* rows * dim */
  double norm, scale;   /* of the residual; free components, all kinds of forces */
  double stiffness;     /* largest diagonal entry, without inertia */
  double inertia;       /* of the terms that M a is the difference of */
  double inertia_share; /* of the diagonal of the matrix */
  double du_largest, energy_first;
} iteration;

static double norm_of(const iteration *it, const double *v, int32_t free_only) {
  double sum = 0.0;
  for (int64_t i = 0; i < it->n; ++i)
    if (!free_only || !it->w->matrix.held[i]) sum += v[i] * v[i];
  return sqrt(sum);
}

/* Of an increment, by stiffness: a node at the rim of a body may move far and mean little. */
static double length_of(const iteration *it, const double *du) {
  double sum = 0.0;
  for (int64_t i = 0; i < it->n; ++i) sum += it->w->vector[MPMI_DIAGONAL][i] * du[i] * du[i];
  return sqrt(sum);
}

/* From the internal forces as they are. The scale knows reactions: they are internal forces of held
 * components. */
static void find_residual(iteration *it) {
  const mpm_stepper *s = it->s;
  mpmi_newton *w = it->w;
  const double *internal = w->vector[MPMI_INTERNAL], *external = w->vector[MPMI_EXTERNAL];
  double *residual = w->vector[MPMI_RESIDUAL], inertia = 0.0, terms = 0.0;
  const int32_t dim = s->grid->dim;
  for (int64_t i = 0; i < it->n; ++i) {
    double Ma = 0.0;
    if (mpmi_is_dynamic(s)) Ma = w->mass[i / dim] * mpmi_newmark_acceleration(s, it->dt, i);
    residual[i] = internal[i] + Ma - external[i];
    inertia += Ma * Ma;
    if (!mpmi_is_dynamic(s)) continue;
    const double reach = fabs(w->vector[MPMI_U][i]) + it->dt * fabs(w->vector[MPMI_V0][i]);
    const double term = w->mass[i / dim] * reach / (s->desc.newmark_beta * it->dt * it->dt);
    terms += term * term;
  }
  it->inertia = sqrt(terms);
  it->norm = norm_of(it, residual, 1);
  it->scale = fmax(sqrt(inertia), fmax(norm_of(it, internal, 0), norm_of(it, external, 0)));
}

static double relative(const iteration *it) {
  return it->scale > 0.0 ? it->norm / it->scale : 0.0;
}

/* Forces of displacements that are rounding of a cell, and rounding of inertia. */
static double noise(const iteration *it) {
  return 16.0 * DBL_EPSILON * (it->stiffness * it->s->grid->h_min * sqrt((double)it->n) + it->inertia);
}

static void note(iteration *it) {
  mpmi_newton *w = it->w;
  if (w->history_count < w->history_capacity) w->history[w->history_count++] = relative(it);
  it->s->last.residual = relative(it);
}

static mpm_status assemble(iteration *it) {
  mpm_stepper *s = it->s;
  mpmi_newton *w = it->w;
  mpmi_matrix *A = &w->matrix;
  const int32_t dim = s->grid->dim;
  const mpm_status status = mpmi_stiffness(s, w->vector[MPMI_U], it->dt);
  if (status) return status;
  const double by_mass = mpmi_is_dynamic(s) ? 1.0 / (s->desc.newmark_beta * it->dt * it->dt) : 0.0;
  double inertia = 0.0, total = 0.0;
  it->stiffness = 0.0;
  for (int64_t r = 0; r < A->rows; ++r)
    for (int32_t c = 0; c < dim; ++c) {
      double *diagonal = A->value + (w->diagonal[r] * dim + c) * dim + c;
      it->stiffness = fmax(it->stiffness, fabs(*diagonal));
      *diagonal += by_mass * w->mass[r];
      inertia += by_mass * w->mass[r];
      total += fabs(*diagonal);
      w->vector[MPMI_DIAGONAL][r * dim + c] = fabs(*diagonal);
    }
  it->inertia_share = total > 0.0 ? inertia / total : 0.0;
  return MPM_OK;
}

/* The right-hand side, with what is left of the prescribed displacements on it; 1 if there is any. */
static mpm_status find_rhs(iteration *it, int32_t *moves_held) {
  mpmi_newton *w = it->w;
  const uint8_t *held = w->matrix.held;
  double *rhs = w->vector[MPMI_RHS], *du = w->vector[MPMI_DU];
  *moves_held = 0;
  for (int64_t i = 0; i < it->n; ++i) {
    du[i] = held[i] ? w->vector[MPMI_TARGET][i] - w->vector[MPMI_U][i] : 0.0;
    *moves_held |= du[i] != 0.0;
  }
  memset(rhs, 0, (size_t)it->n * sizeof *rhs);
  if (*moves_held) {
    const mpm_status status = mpmi_matrix_apply(&w->matrix, du, rhs);
    if (status) return status;
  }
  for (int64_t i = 0; i < it->n; ++i) rhs[i] = held[i] ? 0.0 : -w->vector[MPMI_RESIDUAL][i] - rhs[i];
  return MPM_OK;
}

static mpm_status solve(iteration *it) {
  mpm_stepper *s = it->s;
  mpmi_newton *w = it->w;
  const double *du_held = w->vector[MPMI_DU];
  double *x = w->vector[MPMI_START];
  mpm_status status = mpmi_matrix_eliminate(&w->matrix);
  if (status) return status;
  memset(x, 0, (size_t)it->n * sizeof *x);
  /* no digits are wanted that the next iteration throws away, and enough to keep it quadratic */
  const double wanted = fmax(1e-10, fmin(1e-3, 0.1 * relative(it)));
  const mpmi_solve_job job = {.matrix = &w->matrix,
                              .rhs = w->vector[MPMI_RHS],
                              .x = x,
                              .choice = s->desc.linear_solver,
                              .tolerance = s->desc.linear_tolerance > 0.0 ? s->desc.linear_tolerance : wanted,
                              .max_iterations = s->desc.linear_max_iterations,
                              .host = s->solver,
                              .host_user = s->solver_user,
                              .expects_positive = w->matrix.symmetric,
                              .inertia = it->inertia_share};
  mpmi_solve_report report = {.node = -1};
  status = mpmi_solve(w->solver, &job, &report);
  w->factor_seconds += report.factor_seconds;
  w->solve_seconds += report.solve_seconds;
  w->linear_iterations += report.iterations;
  w->solver_used = report.solver;
  ++w->iterations;
  if (status) {
    s->failure.node = report.node;
    s->failure.callback_status = report.callback_status;
    return status;
  }
  for (int64_t i = 0; i < it->n; ++i) w->vector[MPMI_DU][i] = w->matrix.held[i] ? du_held[i] : x[i];
  return MPM_OK;
}

static double dot_free(const iteration *it, const double *a, const double *b) {
  double sum = 0.0;
  for (int64_t i = 0; i < it->n; ++i)
    if (!it->w->matrix.held[i]) sum += a[i] * b[i];
  return sum;
}

/* Statuses of a trial that a shorter increment may mend. */
static int32_t may_shrink(const mpm_stepper *s, mpm_status status) {
  return !s->failure.callback_status && (status == MPM_INVERTED || status == MPM_NONFINITE);
}

/* Takes as much of the increment as keeps det F positive and the residual in bounds. */
static mpm_status line_search(iteration *it, int32_t moves_held, double *taken) {
  mpmi_newton *w = it->w;
  double *u = w->vector[MPMI_U], *start = w->vector[MPMI_START];
  const double *du = w->vector[MPMI_DU];
  const double before = it->norm, slope = fabs(dot_free(it, du, w->vector[MPMI_RESIDUAL]));
  memcpy(start, u, (size_t)it->n * sizeof *u);
  *taken = 1.0;
  for (int32_t halvings = 0;; ++halvings, *taken *= 0.5) {
    for (int64_t i = 0; i < it->n; ++i) u[i] = start[i] + *taken * du[i];
    const mpm_status status = mpmi_internal_forces(it->s, u, it->dt);
    if (status && (!may_shrink(it->s, status) || halvings == MOST_HALVINGS)) return status;
    if (status) continue;
    find_residual(it);
    if (!isfinite(it->norm))
      return mpmi_fail(it->s->context, MPM_NONFINITE,
                       "the residual is not finite in the step from t = %g with "
                       "dt = %g",
                       it->s->t, it->dt);
    if (moves_held || halvings >= RESIDUAL_HALVINGS || it->norm <= before ||
        fabs(dot_free(it, du, w->vector[MPMI_RESIDUAL])) <= slope)
      return MPM_OK;
  }
}

/* Eq. 13, and a bound on the residual; the residual alone where it is rounding. */
static int32_t converged(iteration *it, double du, double energy) {
  const mpm_stepper_desc *d = &it->s->desc;
  it->du_largest = fmax(it->du_largest, du);
  if (it->norm <= noise(it)) return 1;
  return (it->norm <= d->newton_tolerance_residual * it->scale || it->norm <= d->newton_residual_floor) &&
         du <= d->newton_tolerance_displacement * it->du_largest &&
         energy <= d->newton_tolerance_energy * it->energy_first;
}

static mpm_status not_converged(const iteration *it) {
  const mpm_stepper *s = it->s;
  return mpmi_fail(
      s->context, MPM_NOT_CONVERGED,
      "Newton's method has a relative residual of %g after %d iterations in the step from t = %g "
      "with dt = %g: use a smaller dt, or mpm_advance",
      relative(it), (int)it->w->iterations, s->t, it->dt);
}

static mpm_status iterate(iteration *it) {
  mpmi_newton *w = it->w;
  for (;;) {
    int32_t moves_held;
    double taken;
    mpm_status status;
    if (w->iterations >= it->s->desc.newton_max_iterations) return not_converged(it);
    if ((status = assemble(it)) || (status = find_rhs(it, &moves_held))) return status;
    if (!moves_held && it->norm <= noise(it)) return MPM_OK;
    if ((status = solve(it))) return status;
    const double energy = fabs(dot_free(it, w->vector[MPMI_DU], w->vector[MPMI_RHS]));
    if (w->iterations == 1) it->energy_first = energy;
    if ((status = line_search(it, moves_held, &taken))) return status;
    note(it);
    if (taken == 1.0 && converged(it, length_of(it, w->vector[MPMI_DU]), energy)) return MPM_OK;
    it->du_largest = fmax(it->du_largest, taken * length_of(it, w->vector[MPMI_DU]));
  }
}

mpm_status mpmi_newton_solve(mpm_stepper *s, double dt) {
  mpmi_newton *w = s->newton;
  iteration it = {.s = s, .w = w, .dt = dt, .n = w->matrix.rows * s->grid->dim};
  memset(w->vector[MPMI_U], 0, (size_t)it.n * sizeof(double));
  mpm_status status = mpmi_internal_forces(s, w->vector[MPMI_U], dt);
  if (status) return status;
  find_residual(&it);
  note(&it);
  status = iterate(&it);
  s->last.newton_iterations = w->iterations;
  s->last.linear_solver = w->solver_used;
  s->last.linear_iterations = w->linear_iterations;
  return status;
}
