/* External forces on particles: f = m (g + b) + f_app (MPoint theory eq. 21). Gravity needs no storage and is
 * added in the scatter; everything else is collected here. */
#ifndef MPMI_FORCES_H
#define MPMI_FORCES_H

#include "layout/step.h"

/* At time t, into the members' forces. */
mpm_status mpmi_forces_stage(mpmi_step *step, double t);

#endif
