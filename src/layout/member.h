/* A set of particles in a stepper: where its particles lie, and what acts on them. */
#ifndef MPMI_MEMBER_H
#define MPMI_MEMBER_H

#include "particles/sort.h"

typedef struct mpmi_member {
  mpm_particles *set;
  mpmi_arrangement now, next; /* slots by block: of the last sort; of the one being made */
  mpmi_sorting sorting;
  double *force; /* [dim][ld] external force beside gravity, or NULL */
  int64_t force_ld;
  double *wave_speed; /* [ld] where the law runs before the particles move, or NULL */
  int64_t wave_speed_ld;
  mpm_particle_fn motion; /* of prescribed particles, or NULL: they keep their velocity */
  void *motion_user;
  int32_t prescribed; /* 1: some of its particles are prescribed */
  double *mean;       /* [dim][ld] their mean velocities in a step where there is a motion, or NULL */
  int64_t mean_ld;
  double reaction[3]; /* impulse of its prescribed particles on the material in the last step */
} mpmi_member;

#endif
