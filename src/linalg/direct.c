/* The direct solver makes the factor, refines its solution, and lets GMRES go on with the factor as
 * preconditioner where that is not enough. */
#include <math.h>

#include "linalg/methods.h"

enum { REFINEMENTS = 3, FACTOR_RESTART = 30, FACTOR_CYCLES = 3 };

static mpm_status times_factor(void *system, const double *r, double *z) {
  const mpmi_system *s = system;
  mpmi_factor_solve(&s->solver->factor, s->A, r, z);
  return MPM_OK;
}

static mpm_status make_factor(const mpmi_system *s) {
  mpmi_factor *f = &s->solver->factor;
  int64_t row = 0;
  const double started = mpmi_seconds();
  mpm_status status = mpmi_factor_analyse(f, s->A);
  if (!status) status = mpmi_factor_numbers(f, s->A, &row);
  s->report->factor_seconds += mpmi_seconds() - started;
  if (status == MPM_SINGULAR)
    return mpmi_system_fail_at(s, status, row, "the linear system is singular: no pivot");
  if (status == MPM_NONFINITE)
    return mpmi_system_fail_at(s, status, row, "the linear system has a value that is not finite");
  return status;
}

/* Solves for x, and then for corrections of x from what is left of the right-hand side, as long as this
 * helps. */
static mpm_status refine(mpmi_system *s, int32_t *good) {
  mpmi_factor *f = &s->solver->factor;
  mpm_status status = mpmi_system_work(s, 2, 0);
  if (status) return status;
  double *r = s->solver->work, *change = r + s->n, before = (double)INFINITY;
  mpmi_factor_solve(f, s->A, s->b, s->x);
  for (int32_t round = 0;; ++round) {
    if ((status = mpmi_matrix_residual(s->A, s->b, s->x, r, &s->reached))) return status;
    if ((status = mpmi_system_good(s, s->reached, change, good)) || *good) return status;
    if (round == REFINEMENTS || !(s->reached < 0.5 * before)) return MPM_OK;
    before = s->reached;
    mpmi_factor_solve(f, s->A, r, change);
    for (int64_t i = 0; i < s->n; ++i) s->x[i] += change[i];
  }
}

/* Where the tolerance cannot be reached, the matrix counts as singular if its smallest pivot is small
 * although not rounding of zero, if the answer of the factor was worse than x = 0, or if this share of the
 * right-hand side is left: then the pivots are made of rounding. */
static const double SMALL_PIVOT = 1e-9, UNSOLVED = 0.1;
static mpm_status without_solution(const mpmi_system *s, int32_t useless) {
  int64_t row;
  const double pivot = mpmi_factor_least_pivot(&s->solver->factor, &row);
  if (pivot < SMALL_PIVOT || useless || s->reached > UNSOLVED * s->b_norm)
    return mpmi_system_fail_at(s, MPM_SINGULAR, row, "the linear system is singular: least pivot");
  return mpmi_system_not_converged(s, "the direct solver");
}

mpm_status mpmi_direct(mpmi_system *s) {
  mpm_status status = make_factor(s);
  if (status) return status;
  const mpmi_factor *f = &s->solver->factor;
  s->report->solver = MPM_SOLVER_GMRES;
  if (s->A->symmetric) {
    s->report->solver = MPM_SOLVER_LDLT;
    s->report->negative = f->negative;
    if (f->negative) s->report->indefinite = 1;
  }
  int32_t good = 0;
  if ((status = refine(s, &good)) || good) return status;
  if (f->skipped >= 0) s->report->negative = -1;
  if (f->skipped >= 0)
    return mpmi_system_fail_at(s, MPM_SINGULAR, f->skipped, "the linear system is singular: no pivot");
  const int32_t useless = !(s->reached < s->b_norm);
  if (useless)
    for (int64_t i = 0; i < s->n; ++i) s->x[i] = 0.0;
  const mpmi_gmres_plan plan = {.precondition = times_factor,
                                .user = s,
                                .restart = FACTOR_RESTART,
                                .limit = s->report->iterations + FACTOR_RESTART * FACTOR_CYCLES};
  status = mpmi_gmres(s, &plan);
  return status == MPM_NOT_CONVERGED ? without_solution(s, useless) : status;
}
