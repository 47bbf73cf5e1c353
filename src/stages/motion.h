/* Motion: velocity and position of particles from what a batch has gathered, MPoint theory eqs 34 to 37. */
#ifndef MPMI_MOTION_H
#define MPMI_MOTION_H

#include "stages/batch.h"

void mpmi_motion_bind(mpmi_batch *b);
void mpmi_motion_enter(mpmi_batch *b);
/* New velocities and positions of the batch; prescribed particles move as they must. */
void mpmi_motion_take(mpmi_batch *b);

#endif
