/* The host's solver borrows the system. Its answer is checked and not taken on trust. */
#include <math.h>
#include <string.h>

#include "context/transport.h"
#include "linalg/methods.h"

/* A residual may be `allowance` times the tolerance, or `always_allowed`, because hosts measure residuals
 * in norms of their own. */
static const double allowance = 100.0, always_allowed = 1e-6;

/* Of several parts all have the answer of the first one that was refused, and the largest count of
 * iterations.
 */
static mpm_status answer_together(const mpmi_system *s, mpm_status status) {
  mpmi_solve_report *report = s->report;
  const int32_t parts = s->context->transport.parts, part = s->context->transport.part;
  int64_t word[] = {status ? parts - part : 0, report->iterations};
  if (!s->A->shared) return status;
  const mpm_status lost = mpmi_reduce_parts(s->context, MPM_REDUCE_MAX, 2, word);
  if (lost) return lost;
  report->iterations = word[1];
  if (!word[0]) return MPM_OK;
  const int32_t first = parts - (int32_t)word[0];
  int64_t returned = part == first ? report->callback_status : INT64_MIN;
  const mpm_status told = mpmi_reduce_parts(s->context, MPM_REDUCE_MAX, 1, &returned);
  report->callback_status = (int32_t)returned;
  return told ? told : mpmi_take_over(s->context, first, status);
}

static mpm_status call(const mpmi_system *s, const mpmi_solve_job *job, double *rhs, double *solution) {
  mpm_operator *op = &s->solver->lent;
  int64_t iterations = 0, row = -1;
  mpm_status status = MPM_OK;
  memset(rhs, 0, (size_t)(2 * s->n) * sizeof *rhs); /* what is owned by others has no values here */
  mpmi_operator_compress(op, s->b, rhs);
  mpmi_operator_compress(op, s->x, solution);
  const mpm_status returned =
      mpmi_from_host(job->host(job->host_user, op, rhs, solution, job->tolerance, &iterations));
  mpmi_operator_close(op);
  s->report->callback_status = returned;
  if (returned)
    status = mpmi_fail(s->context, returned > 0 ? MPM_CUT_DT : MPM_E_CALLBACK,
                       "the linear solver returned %d", (int)returned);
  else if (iterations < 0)
    status = mpmi_fail(s->context, MPM_E_CALLBACK, "the linear solver counted %lld iterations, must be >= 0",
                       (long long)iterations);
  else
    s->report->iterations = iterations;
  if ((status = answer_together(s, status))) return status;
  for (int64_t r = 0; r < op->own && !status; ++r)
    if (!isfinite(solution[r])) {
      row = op->unknown[r] / s->A->block;
      status = mpmi_system_fail_at(s, MPM_NONFINITE, row, "the solution of the linear solver is not finite");
    }
  if ((status = mpmi_system_together_at(s, status, row))) return status;
  mpmi_operator_expand(op, solution, s->x);
  return s->A->shared ? mpmi_rows_complete(s->A->shared, s->x) : MPM_OK;
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
  /* one number more, so that the vectors exist without rows */
  mpm_status status = mpmi_system_together(s, mpmi_system_work(s, 2, 1));
  if (!status) status = mpmi_operator_open(op, s->A, job->expects_positive);
  if (status) return status;
  double *rhs = s->solver->work, *solution = rhs + s->n;
  status = call(s, job, rhs, solution);
  return status ? status : check(s, job->tolerance, rhs);
}
