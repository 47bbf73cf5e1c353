/* Calls whose work this version does not have; each says what to use instead. */
#include "stepper/stepper.h"

mpm_status mpm_stepper_set_linear_solver(mpm_stepper *s, mpm_solve_fn fn, void *user) {
  MPMI_ENTER(s, MPMI_STEPPER);
  (void)fn, (void)user;
  return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                   "implicit steps are not in this version: explicit schemes need no linear solver");
}

mpm_status mpm_stepper_residuals(const mpm_stepper *s, int32_t capacity, double *residual, int32_t *count) {
  MPMI_ENTER(s, MPMI_STEPPER);
  (void)capacity, (void)residual, (void)count;
  return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                   "implicit steps are not in this version: explicit schemes have no residuals");
}

/* An operator exists only inside a solve callback, which explicit steps never call: there is none to be
 * valid. */
mpm_status mpm_operator_get_info(const mpm_operator *matrix, mpm_operator_info *info) {
  (void)info;
  return matrix ? MPM_E_UNSUPPORTED : MPM_E_ARG;
}

mpm_status mpm_operator_apply(const mpm_operator *matrix, const double *x, double *y) {
  (void)x, (void)y;
  return matrix ? MPM_E_UNSUPPORTED : MPM_E_ARG;
}

mpm_status mpm_operator_csr(const mpm_operator *matrix, const int64_t **row_start, const int32_t **column,
                            const double **value) {
  (void)row_start, (void)column, (void)value;
  return matrix ? MPM_E_UNSUPPORTED : MPM_E_ARG;
}
