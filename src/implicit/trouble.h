/* What implicit steps that fail tell of the place and of what helps. */
#ifndef MPMI_TROUBLE_H
#define MPMI_TROUBLE_H

#include "implicit/balance.h"

/* Writes the sentence for an iteration that is not at its end in time, and notes node and particle. */
mpm_status mpmi_tell_not_converged(mpmi_balance *balance, int32_t touches_change);
/* Returns what the host is told where a smaller step may help, and what it is told within mpm_advance(). */
const char *mpmi_smaller_steps(const mpmi_balance *balance);
/* Adds to the sentence of a linear solver that failed at a node, or at none (-1), which particle is beside,
 * and returns its status. */
mpm_status mpmi_tell_unsolved(mpmi_balance *balance, mpm_status status, int64_t node);

#endif
