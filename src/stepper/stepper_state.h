/* What objects below the stepper need to know of it. */
#ifndef MPMI_STEPPER_STATE_H
#define MPMI_STEPPER_STATE_H

#include "context/context.h"

/* 1 between mpm_step_begin and mpm_step_end or mpm_step_abort, and while a step runs. */
int32_t mpmi_stepper_in_step(const struct mpm_stepper *stepper);

/* Present time of a stepper, for callbacks outside a step. */
double mpmi_stepper_time(const struct mpm_stepper *stepper);

#endif
