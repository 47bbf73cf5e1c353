/* The step under way: made when a step starts and dropped when it ends. What stages learn that outlives the
 * step goes into the particles' second copies, or is taken from here when the step is committed. */
#ifndef MPMI_STEP_H
#define MPMI_STEP_H

#include "layout/workspace.h"

/* Seconds by stage, in the order of mpm_profile. */
enum {
  MPMI_TIME_SORT,
  MPMI_TIME_P2G,
  MPMI_TIME_GRID,
  MPMI_TIME_G2P,
  MPMI_TIME_LAW,
  MPMI_TIME_CALLBACKS,
  MPMI_TIME_TOTAL,
  MPMI_TIME_WEIGHTS,
  MPMI_TIME_ASSEMBLY,
  MPMI_TIME_FACTOR,
  MPMI_TIME_SOLVE,
  MPMI_TIMES
};
typedef struct mpmi_profile {
  double seconds[MPMI_TIMES];
  int32_t sampled; /* the host has asked once: law and weights are sampled, too */
} mpmi_profile;

enum { MPMI_IDLE, MPMI_RUNNING, MPMI_BEGUN, MPMI_SOLVED }; /* phases */

typedef struct mpmi_step {
  int32_t phase;  /* MPMI_IDLE: there is no step, and nothing else here counts */
  int32_t staged; /* in parts, with the host in between: nodes keep force apart from momentum */
  const mpmi_settings *settings;
  const mpmi_layout *layout;
  mpmi_workspace *work;
  mpmi_profile *profile; /* of all steps (profile.h) */
  double t, dt;
  double velocity_dt; /* over which forces change velocities: dt, or staggered the mean of two steps */
  mpmi_failure failure;
  double impulse_by_face[6][3]; /* on the walls */
  double host_work;             /* of prescribed velocities, prescribed particles and hooks */
  mpm_step_info info;           /* what the step reports, as far as it is known */
} mpmi_step;

void mpmi_failures_clear(mpmi_step *step);
/* Status of the step from the first failure among the tasks, with its sentence; MPM_OK when none. */
mpm_status mpmi_step_failure(mpmi_step *step);

#endif
