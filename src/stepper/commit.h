/* The end of a step: the second copies become the state, or are dropped. */
#ifndef MPMI_COMMIT_H
#define MPMI_COMMIT_H

#include "stepper/stepper.h"

/* Cannot fail. Adds the work of the host to the balance, and its own time to the report. */
void mpmi_commit(mpm_stepper *s);
/* Only volumes were overwritten: F is still there to make them again. */
void mpmi_roll_back(mpm_stepper *s);

#endif
