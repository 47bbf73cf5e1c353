/* One number of all that decides what a step does and exchanges. */
#ifndef MPMI_FINGERPRINT_H
#define MPMI_FINGERPRINT_H

#include "stepper/stepper.h"

int64_t mpmi_fingerprint(const mpm_stepper *s);

#endif
