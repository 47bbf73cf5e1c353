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
