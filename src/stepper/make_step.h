/* Steps, whole or in three parts with the host in between: preparation, the scheme's stages, and the end. */
#ifndef MPMI_MAKE_STEP_H
#define MPMI_MAKE_STEP_H

#include "stepper/stepper.h"

/* A whole step. On failure the particles are as before, and the info of the last step says why. */
mpm_status mpmi_make_step(mpm_stepper *s, double dt);

#endif
