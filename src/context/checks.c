#include "context/checks.h"

#include <math.h>

mpm_status mpmi_check_switch(mpm_context *c, const char *name, int32_t value) {
  if (value == 0 || value == 1) return MPM_OK;
  return mpmi_fail(c, MPM_E_ARG, "%s is %d: it must be 0 or 1", name, (int)value);
}

mpm_status mpmi_check_count(mpm_context *c, const char *name, int64_t value) {
  if (value >= 0) return MPM_OK;
  return mpmi_fail(c, MPM_E_ARG, "%s is %lld: it must be >= 0", name, (long long)value);
}

mpm_status mpmi_check_magnitude(mpm_context *c, const char *name, double value) {
  if (value >= 0.0 && isfinite(value)) return MPM_OK;
  return mpmi_fail(c, MPM_E_ARG, "%s is %g: it must be finite and >= 0", name, value);
}

mpm_status mpmi_check_vector(mpm_context *c, const char *name, const double *value, int32_t count) {
  for (int32_t k = 0; k < count; ++k)
    if (!isfinite(value[k]))
      return mpmi_fail(c, MPM_E_ARG, "%s[%d] is %g: it must be finite", name, (int)k, value[k]);
  return MPM_OK;
}

mpm_status mpmi_check_choice(mpm_context *c, const char *name, int32_t value, const char *range,
                             int32_t last) {
  if (value >= 0 && value <= last) return MPM_OK;
  return mpmi_fail(c, MPM_E_ARG, "%s is %d: it must be an %s", name, (int)value, range);
}
