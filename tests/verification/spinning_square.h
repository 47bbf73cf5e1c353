/* A square of edge 0.4, E = 1e5, nu = 0.3, density 1000, that spins freely about its centre, the origin, and
 * has no stress at the start. */
#ifndef SPINNING_SQUARE_H
#define SPINNING_SQUARE_H

#include "verify.h"

extern const double spinning_square_side;
double spinning_square_speed(void); /* of sound */

/* Opens the world on a grid about the origin with the square as its set. */
mpm_particles *spinning_square(verify_world *w, verify_setup *setup, double omega);

#endif
