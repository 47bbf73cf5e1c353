/* Loads that grow with time in quasi-static steps, and what Newton's method makes of them. */
#ifndef LOADING_H
#define LOADING_H

#include "verify.h"

typedef struct load {
  double g, per_mass; /* per_mass: so that the weight does not depend on the density */
} load;
/* An acceleration callback: weight along axis y, all of it at t = 1. user: a load. */
mpm_status loading_weigh(void *user, const mpm_particle_batch *b, double *add);

/* The largest residual of the last step two iterations after one below `near`: bending and stretching come to
 * rest one after the other, so that a single iteration tells nothing of the order. */
double loading_tail(const verify_world *w, double near);

#endif
