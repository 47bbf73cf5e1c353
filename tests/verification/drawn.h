/* A bar that is drawn out: one quarter of a sheet 4 by 1 in plane strain, neo-Hookean, of density 1, whose
 * end nodes are pulled with the velocities of a uniform stretch. */
#ifndef DRAWN_H
#define DRAWN_H

#include "verify.h"

#define DRAWN_E      1000.0
#define DRAWN_NU     0.3
#define DRAWN_LENGTH 2.0
#define DRAWN_HEIGHT 0.5
#define DRAWN_LAST   4.0 /* stretch */

/* The pull: d/dt of the stretch, the spacing, and whether nodes stand where the material was. */
typedef struct drawn_pull {
  double rate, h;
  int32_t total;
} drawn_pull;

/* Opens a world with the bar, which moves as the pull has it unless it is at rest; `by` outlives it. */
mpm_particles *drawn_open(verify_world *w, const verify_setup *setup, drawn_pull *by, int32_t at_rest);
/* The force that holds the nodes of the end. */
double drawn_force(const verify_world *w);
/* The stretch across at which the stress across vanishes; *force: per thickness, of half the bar. */
double drawn_thinning(double stretch, double *force);

#endif
