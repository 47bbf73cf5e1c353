#include "stepper/stepper.h"

mpm_status mpm_write_grid(mpm_stepper *stepper, const char *path, int32_t count, const char *const *fields) {
  (void)path, (void)count, (void)fields;
  MPMI_ENTER(stepper, MPMI_STEPPER);
  return mpmi_fail(stepper->context, MPM_E_UNSUPPORTED,
                   "mpm_write_grid() is not in this version: read nodal fields with mpm_grid_map()");
}
