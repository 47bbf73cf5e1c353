/* Calls whose work this version does not have; each says what to use instead. */
#include "stepper/stepper.h"

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
