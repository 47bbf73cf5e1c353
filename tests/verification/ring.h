/* A quarter of a thick ring in plane strain: particles in rings about the origin, symmetry planes at x = 0
 * and y = 0, and a pressure on the inner face. */
#ifndef RING_H
#define RING_H

#include "verify.h"

typedef struct ring {
  double a, b;           /* radii */
  int32_t layers, along; /* particles through the thickness, and along a quarter of a circle */
  mpm_particles *set;
  double pressure; /* at t = 1, on the inner face, as a dead load in proportion to t */
} ring;

/* Fills the set, whose particles are numbered from the inner layer outwards, and gives it walls and load. */
void ring_open(verify_world *w, ring *r);
double ring_radius(const ring *r, int32_t layer); /* of a layer, at first */
/* Means over a layer: outward displacement; radial and hoop stress. */
double ring_displacement(const verify_world *w, const ring *r, int32_t layer);
void ring_stress(const verify_world *w, const ring *r, int32_t layer, double *radial, double *hoop);

#endif
