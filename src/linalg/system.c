/* A solver has its memory here, and every method asks here whether its solution is good enough. */
#include "linalg/system.h"
#include "context/transport.h"

/* Where the terms of A x are more than this many times as large as b, what rounding leaves of them is no
 * solution. Slender beams reach 3, bodies that nothing holds reach hundreds. */
static const double MOST_ROUNDING = 32.0;

mpm_status mpmi_solver_create(mpm_context *context, mpmi_solver **out) {
  mpmi_solver *solver = mpmi_alloc_zeroed(context, sizeof *solver);
  *out = solver;
  if (!solver) return MPM_E_NOMEM;
  solver->context = context;
  mpmi_factor_init(&solver->factor, context);
  mpmi_multigrid_init(&solver->multigrid, context);
  mpmi_operator_init(&solver->lent, context);
  return MPM_OK;
}

void mpmi_solver_destroy(mpmi_solver *solver) {
  if (!solver) return;
  mpm_context *context = solver->context;
  mpmi_factor_free(&solver->factor);
  mpmi_multigrid_free(&solver->multigrid);
  mpmi_operator_free(&solver->lent);
  MPMI_FREE_ARRAY(context, solver->work, solver->work_capacity);
  MPMI_FREE_ARRAY(context, solver->diagonal, solver->diagonal_capacity);
  MPMI_FREE_ARRAY(context, solver->inner, solver->inner_capacity);
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
  *good = norm <= rounding &&
          rounding < MOST_ROUNDING * s->b_norm; /* beyond that the terms cancel and say nothing */
  return status;
}

mpm_status mpmi_system_together(const mpmi_system *s, mpm_status status) {
  return s->A->shared ? mpmi_agree(s->context, status) : status;
}

mpm_status mpmi_system_together_at(const mpmi_system *s, mpm_status status, int64_t row) {
  int32_t part;
  if (!s->A->shared) return status;
  const mpm_status lost = mpmi_rows_first(s->A->shared, status > 0 ? row : -1, &part);
  if (lost || part < 0) return lost ? lost : mpmi_agree(s->context, status);
  int64_t node = part == s->context->transport.part ? s->report->node : INT64_MIN;
  const mpm_status told = mpmi_reduce_parts(s->context, MPM_REDUCE_MAX, 1, &node);
  s->report->node = node;
  return told ? told : mpmi_take_over(s->context, part, status);
}

mpm_status mpmi_system_fail_at(const mpmi_system *s, mpm_status status, int64_t row, const char *what) {
  const double *x = s->A->position + 3 * row;
  s->report->node = s->A->number[row];
  return mpmi_fail(s->context, status, "%s at node %lld (%g, %g, %g)", what, (long long)s->A->number[row],
                   x[0], x[1], x[2]);
}

mpm_status mpmi_system_not_converged(const mpmi_system *s, const char *method) {
  return mpmi_fail(s->context, MPM_NOT_CONVERGED,
                   "%s: after %lld iterations the residual is %g of the right-hand side, wanted is %g%s",
                   method, (long long)s->report->iterations, s->reached / s->b_norm, s->wanted / s->b_norm,
                   mpmi_has_transport(s->context) ? "; MPM_SOLVER_HOST may have a better preconditioner"
                                                  : "");
}
