/* Where the time of steps goes. */
#ifndef MPMI_PROFILE_H
#define MPMI_PROFILE_H

#include "layout/step.h"

/* Adds the seconds since *from to a stage and restarts the clock. */
void mpmi_lap(mpmi_step *step, int32_t stage, double *from);
/* The law runs inside the tasks of a stage: its share of their time is moved from there. */
void mpmi_move_samples(mpmi_step *step, int32_t stage);
/* Now and then makes the weights of the slots [begin, end) once more, to know how long that takes. */
void mpmi_sample_weights(mpmi_step *step, int32_t task, const mpmi_axis *axis, int32_t need,
                         const mpmi_points *points, int64_t begin, int64_t end);

#endif
