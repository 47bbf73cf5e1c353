/* Checks of single values that the host gives. Each refuses a bad one with MPM_E_ARG and a sentence that has
 * its name, its value and what it must be. */
#ifndef MPMI_CHECKS_H
#define MPMI_CHECKS_H

#include "context/context.h"

mpm_status mpmi_check_switch(mpm_context *context, const char *name, int32_t value);   /* 0 or 1 */
mpm_status mpmi_check_count(mpm_context *context, const char *name, int64_t value);    /* >= 0 */
mpm_status mpmi_check_magnitude(mpm_context *context, const char *name, double value); /* finite, >= 0 */
/* Checks that `count` components are finite. */
mpm_status mpmi_check_vector(mpm_context *context, const char *name, const double *value, int32_t count);
/* Checks that a value of an enumeration is 0 ... last; range names them. */
mpm_status mpmi_check_choice(mpm_context *context, const char *name, int32_t value, const char *range,
                             int32_t last);

#endif
