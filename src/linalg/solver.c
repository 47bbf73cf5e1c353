/* Which method solves a linear system, and what follows when it does not. */
#include <math.h>
#include <string.h>

#include "linalg/system.h"

enum { RESTART = 60, MOST_CYCLES = 50 };

mpm_status mpmi_solver_create(mpm_context *context, mpmi_solver **out) {
  mpmi_solver *solver = mpmi_alloc_zeroed(context, sizeof *solver);
  *out = solver;
  if (!solver) return MPM_E_NOMEM;
  solver->context = context;
  mpmi_factor_init(&solver->factor, context);
  mpmi_operator_init(&solver->lent, context);
  return MPM_OK;
}

void mpmi_solver_destroy(mpmi_solver *solver) {
  if (!solver) return;
  mpm_context *context = solver->context;
  mpmi_factor_free(&solver->factor);
  mpmi_operator_free(&solver->lent);
  mpmi_free(context, solver->work, mpmi_bytes(solver->work_capacity, sizeof *solver->work));
  mpmi_free(context, solver->diagonal, mpmi_bytes(solver->diagonal_capacity, sizeof *solver->diagonal));
  mpmi_free(context, solver, sizeof *solver);
}

mpm_status mpmi_system_work(const mpmi_system *s, int64_t vectors, int64_t more) {
  mpmi_solver *solver = s->solver;
  return mpmi_reserve(s->context, (void **)&solver->work, &solver->work_capacity, vectors * s->n + more,
                      sizeof *solver->work);
}

mpm_status mpmi_system_good(const mpmi_system *s, double norm, double *scratch, int32_t *good) {
  *good = norm <= s->wanted;
  if (*good || !(norm < s->b_norm)) return MPM_OK;
  double rounding;
  const mpm_status status = mpmi_matrix_rounding(s->A, s->b, s->x, scratch, &rounding);
  *good = norm <= rounding;
  return status;
}

mpm_status mpmi_system_fail_at(const mpmi_system *s, mpm_status status, int64_t row, const char *what) {
  const double *x = s->A->position + 3 * row;
  s->report->node = s->A->number[row];
  return mpmi_fail(s->context, status, "%s at node %lld (%g, %g, %g)", what, (long long)s->A->number[row],
                   x[0], x[1], x[2]);
}

mpm_status mpmi_system_not_converged(const mpmi_system *s, const char *method) {
  return mpmi_fail(s->context, MPM_NOT_CONVERGED,
                   "%s: after %lld iterations the residual is %g of the right-hand side, wanted is %g",
                   method, (long long)s->report->iterations, s->reached / s->b_norm, s->wanted / s->b_norm);
}

/* ---- what a method would cost ------------------------------------------------------------------------ */
/* Nodes along the axes, longest first. */
static void extents_of(const mpmi_matrix *A, double *extent) {
  for (int32_t k = 0; k < 3; ++k) {
    int64_t low = A->rows ? A->index[0][k] : 0, high = low;
    for (int64_t i = 1; i < A->rows; ++i) {
      if (A->index[i][k] < low) low = A->index[i][k];
      if (A->index[i][k] > high) high = A->index[i][k];
    }
    int32_t at = k;
    for (; at > 0 && extent[at - 1] < (double)(high - low + 1); --at) extent[at] = extent[at - 1];
    extent[at] = (double)(high - low + 1);
  }
}

/* Iterations grow with the number of nodes in a row; these are what CG needs for bodies of soft matter. */
static double cg_iterations(const double *extent) {
  return 20.0 * extent[0];
}

/* Whether the factor is cheaper. Its work is that of its separators, which are as wide as half a stencil, and
 * of which a long body has many. Measured: 7 times the cube of one, and 20 multiplications in the time of one
 * of the matrix times a vector. */
static int32_t factor_pays(const mpmi_matrix *A, const double *extent) {
  const double entries = (double)A->row_start[A->rows], rows = (double)A->rows;
  const double dim = 1.0 + (extent[1] > 1.0) + (extent[2] > 1.0);
  const double half_stencil = fmax(1.0, 0.5 * (pow(entries / rows, 1.0 / dim) - 1.0));
  const double separator = (double)mpmi_matrix_unknowns(A) / extent[0] * half_stencil;
  const double factor = 7.0 * separator * separator * separator * extent[0] / extent[1];
  return factor < 20.0 * cg_iterations(extent) * entries * (double)(A->block * A->block);
}

/* ---- methods ----------------------------------------------------------------------------------------- */
static mpm_status bad_diagonal(const mpmi_system *s, int64_t row) {
  return mpmi_system_fail_at(s, MPM_NONFINITE, row, "a diagonal entry of the linear system is not finite");
}

static mpm_status by_cg(mpmi_system *s, int64_t limit) {
  int64_t row = 0;
  const double started = mpmi_seconds();
  s->report->solver = MPM_SOLVER_CG;
  mpm_status status = mpmi_inverse_diagonal(s, &row);
  s->report->factor_seconds += mpmi_seconds() - started;
  if (status == MPM_SINGULAR) {
    s->report->indefinite = 1;
    return mpmi_system_fail_at(s, status, row, "conjugate gradients: a diagonal entry is not positive");
  }
  if (status == MPM_NONFINITE) return bad_diagonal(s, row);
  if (!status) status = mpmi_cg(s, limit);
  if (status == MPM_NOT_CONVERGED) return mpmi_system_not_converged(s, "conjugate gradients");
  if (status != MPM_SINGULAR) return status;
  s->report->indefinite = 1;
  return mpmi_fail(s->context, MPM_SINGULAR,
                   "conjugate gradients: the matrix is not positive definite: use MPM_SOLVER_LDLT or "
                   "MPM_SOLVER_AUTO");
}

static mpm_status by_gmres(mpmi_system *s, int64_t limit, int32_t impatient) {
  int64_t row = 0;
  const double started = mpmi_seconds();
  s->report->solver = MPM_SOLVER_GMRES;
  mpm_status status = mpmi_inverse_blocks(s, &row);
  s->report->factor_seconds += mpmi_seconds() - started;
  if (status == MPM_NONFINITE) return bad_diagonal(s, row);
  const mpmi_gmres_plan plan = {mpmi_times_inverse_blocks, s, RESTART, impatient, limit};
  if (!status) status = mpmi_gmres(s, &plan);
  return status == MPM_NOT_CONVERGED ? mpmi_system_not_converged(s, "GMRES") : status;
}

/* Where the factor is dear an iteration comes first; where that fails the factor has the last word. */
static mpm_status by_choice(mpmi_system *s, const mpmi_solve_job *job) {
  const int64_t limit = job->max_iterations;
  double extent[3];
  extents_of(s->A, extent);
  const int64_t usual = 500 + 3 * (int64_t)cg_iterations(extent);
  mpm_status status;
  switch (job->choice) {
  case MPM_SOLVER_HOST:
    return mpmi_solve_by_host(s, job);
  case MPM_SOLVER_CG:
    return by_cg(s, limit ? limit : 10 * usual);
  case MPM_SOLVER_LDLT:
    return mpmi_direct(s);
  case MPM_SOLVER_GMRES:
    return by_gmres(s, limit ? limit : RESTART * MOST_CYCLES, 0);
  default:
    if (factor_pays(s->A, extent)) return mpmi_direct(s);
    status = s->A->symmetric ? by_cg(s, limit ? limit : usual)
                             : by_gmres(s, limit ? limit : RESTART * MOST_CYCLES, 1);
    if (status <= 0) return status;
    s->context->error[0] = '\0'; /* not the last word */
    s->report->node = -1;
    return mpmi_direct(s);
  }
}

/* ---- the call ---------------------------------------------------------------------------------------- */
static mpm_status check_choice(mpm_context *context, const mpmi_solve_job *job) {
  const int32_t choice = job->choice;
  if (choice == MPM_SOLVER_MULTIGRID_CG)
    return mpmi_fail(context, MPM_E_UNSUPPORTED,
                     "MPM_SOLVER_MULTIGRID_CG is not in this version: use MPM_SOLVER_CG or MPM_SOLVER_LDLT");
  if (choice == MPM_SOLVER_HOST && !job->host)
    return mpmi_fail(context, MPM_E_STATE,
                     "MPM_SOLVER_HOST has no solver: call mpm_stepper_set_linear_solver first");
  if ((choice == MPM_SOLVER_CG || choice == MPM_SOLVER_LDLT) && !job->matrix->symmetric)
    return mpmi_fail(context, MPM_E_UNSUPPORTED,
                     "%s is for symmetric matrices, and this one is not: use MPM_SOLVER_GMRES or "
                     "MPM_SOLVER_AUTO",
                     choice == MPM_SOLVER_CG ? "MPM_SOLVER_CG" : "MPM_SOLVER_LDLT");
  if (choice != MPM_SOLVER_HOST && (choice < MPM_SOLVER_AUTO || choice > MPM_SOLVER_GMRES))
    return mpmi_fail(context, MPM_E_ARG, "linear_solver is %d, must be MPM_SOLVER_AUTO ... MPM_SOLVER_HOST",
                     (int)choice);
  return MPM_OK;
}

static mpm_status check_rhs(const mpmi_system *s) {
  for (int64_t i = 0; i < s->n; ++i)
    if (!isfinite(s->b[i]))
      return mpmi_system_fail_at(s, MPM_NONFINITE, i / s->A->block,
                                 "the right-hand side of the linear system is not finite");
  return mpmi_fail(s->context, MPM_NONFINITE, "the right-hand side of the linear system is too large");
}

/* Guesses that are worse than none are dropped. */
static mpm_status take_guess(mpmi_system *s) {
  int32_t any = 0;
  for (int64_t i = 0; i < s->n; ++i) {
    if (s->A->held[i]) s->x[i] = 0.0;
    any |= s->x[i] != 0.0;
  }
  mpm_status status = any ? mpmi_system_work(s, 1, 0) : MPM_OK;
  if (!any || status) return status;
  status = mpmi_matrix_residual(s->A, s->b, s->x, s->solver->work, &s->reached);
  if (!status && !(s->reached < s->b_norm)) memset(s->x, 0, (size_t)s->n * sizeof *s->x);
  return status;
}

static mpm_status solve(mpmi_solver *solver, const mpmi_solve_job *job, mpmi_solve_report *report) {
  mpmi_system s = {.solver = solver,
                   .context = solver->context,
                   .A = job->matrix,
                   .b = job->rhs,
                   .x = job->x,
                   .n = mpmi_matrix_unknowns(job->matrix),
                   .report = report};
  mpm_status status = check_choice(s.context, job);
  if (!status) status = mpmi_norm(s.context, s.b, s.n, &s.b_norm);
  if (status) return status;
  if (!isfinite(s.b_norm)) return check_rhs(&s);
  if (!(s.b_norm > 0.0)) {
    memset(s.x, 0, (size_t)s.n * sizeof *s.x);
    if (!job->choice) report->solver = s.A->symmetric ? MPM_SOLVER_LDLT : MPM_SOLVER_GMRES;
    return MPM_OK;
  }
  s.wanted = s.reached = job->tolerance * s.b_norm;
  status = take_guess(&s);
  return status ? status : by_choice(&s, job);
}

mpm_status mpmi_solve(mpmi_solver *solver, const mpmi_solve_job *job, mpmi_solve_report *report) {
  const double started = mpmi_seconds();
  memset(report, 0, sizeof *report);
  report->solver = job->choice;
  report->negative = report->node = -1;
  const mpm_status status = solve(solver, job, report);
  report->solve_seconds = mpmi_seconds() - started - report->factor_seconds;
  return status;
}
