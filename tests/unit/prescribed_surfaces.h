/* Surfaces that prescribe how the material moves. */
#ifndef PRESCRIBED_SURFACES_H
#define PRESCRIBED_SURFACES_H

#include "surfaces.h"

static inline mpm_surface_desc prescribing(int32_t normal_only) {
  mpm_surface_desc d = load_desc();
  d.prescribes = normal_only ? MPM_PRESCRIBES_NORMAL : MPM_PRESCRIBES_VELOCITY;
  return d;
}

/* Returns the force of a surface on the material; the next call overwrites it. */
static inline const double *reaction_of(const world *w, const mpm_surface *s) {
  static double force[3];
  force[0] = force[1] = force[2] = 0.0;
  ck_ok(w, mpm_stepper_surface_reaction(w->stepper, s, force));
  return force;
}

/* Add the cases of prescribed_implicit.c and prescribed_corners.c. */
void add_prescribed_implicit(Suite *suite);
void add_prescribed_corners(Suite *suite);

#endif
