/* A column of water at the left end of a tank, that is let go: without tension, on walls without friction. */
#ifndef TANK_H
#define TANK_H

#include "verify.h"

#define TANK_G       9.81
#define TANK_DENSITY 1000.0

typedef struct tank {
  verify_world w;
  mpm_particles *water;
} tank;

/* Opens a tank, half as high again as the column, with the water at rest under its pressure, in 4 particles
 * per cell and so many cells per depth. Its speed of sound is 20 sqrt(g depth). */
void tank_open(tank *it, double width, double depth, double length, int cells);

enum { TANK_POINTS = 15 };
/* Martin and Moyce 1952, table 2, n^2 = 2: t sqrt(2 g / a) and front / a of a column of width a and depth
 * 2 a. */
extern const double tank_measured[TANK_POINTS][2];
/* Their a, in metres: 2.25 inches. */
#define TANK_A 0.05715

#endif
