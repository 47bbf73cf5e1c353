/* The host's solver borrows the system. Its answer is checked and not taken on trust. */
#include <math.h>

#include "linalg/methods.h"

/* A residual may be `allowance` times the tolerance, or `always_allowed`, because hosts measure residuals
 * in norms of their own. */
static const double allowance = 100.0, always_allowed = 1e-6;

static mpm_status call(const mpmi_system *s, const mpmi_solve_job *job, double *rhs, double *solution) {
  mpm_operator *op = &s->solver->lent;
  int64_t iterations = 0;
  mpmi_operator_compress(op, s->b, rhs);
  mpmi_operator_compress(op, s->x, solution);
  const mpm_status returned =
      mpmi_from_host(job->host(job->host_user, op, rhs, solution, job->tolerance, &iterations));
  s->report->callback_status = returned;
  if (returned)
    return mpmi_fail(s->context, returned > 0 ? MPM_CUT_DT : MPM_E_CALLBACK, "the linear solver returned %d",
                     (int)returned);
  if (iterations < 0)
    return mpmi_fail(s->context, MPM_E_CALLBACK, "the linear solver counted %lld iterations, must be >= 0",
                     (long long)iterations);
  s->report->iterations = iterations;
  for (int64_t r = 0; r < op->rows; ++r)
    if (!isfinite(solution[r]))
      return mpmi_system_fail_at(s, MPM_NONFINITE, op->unknown[r] / s->A->block,
                                 "the solution of the linear solver is not finite");
  mpmi_operator_expand(op, solution, s->x);
  return MPM_OK;
}

static mpm_status check(mpmi_system *s, double tolerance, double *scratch) {
  const double allowed = fmax(allowance * tolerance, always_allowed) * s->b_norm;
  const mpm_status status = mpmi_matrix_residual(s->A, s->b, s->x, scratch, &s->reached);
  if (status || s->reached <= allowed) return status;
  return mpmi_fail(s->context, MPM_NOT_CONVERGED,
                   "the linear solver left a residual of %g of the right-hand side, allowed is %g",
                   s->reached / s->b_norm, allowed / s->b_norm);
}

mpm_status mpmi_solve_by_host(mpmi_system *s, const mpmi_solve_job *job) {
  mpm_operator *op = &s->solver->lent;
  s->report->solver = MPM_SOLVER_HOST;
  mpm_status status = mpmi_system_work(s, 2, 0);
  if (!status) status = mpmi_operator_open(op, s->A, job->expects_positive);
  if (status) return status;
  double *rhs = s->solver->work, *solution = rhs + s->n;
  status = call(s, job, rhs, solution);
  mpmi_operator_close(op);
  return status ? status : check(s, job->tolerance, rhs);
}
