/* What a stepper reports: the info of the state and of the last step, reactions, where the time went. */
#ifndef MPMI_REPORTS_H
#define MPMI_REPORTS_H

#include "stepper/stepper.h"

/* The info of the state and of a step: the last one, or the one under way. */
void mpmi_fill_info(const mpm_stepper *s, const mpm_step_info *last, mpm_step_info *info);
/* Gives the host the info of a call that ends with this status, which stays the status of the call unless
 * only the writing fails. info may be NULL. */
mpm_status mpmi_give_info(const mpm_stepper *s, mpm_status status, mpm_step_info *info);
/* The check that writing makes, for calls that must know before they do anything. */
mpm_status mpmi_check_info(const mpm_stepper *s, const mpm_step_info *info);

#endif
