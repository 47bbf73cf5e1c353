/* What G2P needs of the remedy against volumetric locking: see locking.c. */
#ifndef MPMI_LOCKING_H
#define MPMI_LOCKING_H

#include "stepper/stepper.h"

/* Leaves det F_inc - 1 of each particle of a batch in the second copy of its dilation ratio. */
void mpmi_locking_measure(const mpm_stepper *s, mpm_particles *set, const double *L, int64_t ld,
                          int64_t begin, int64_t n, double dt);
/* Scales the deformation that the law is about to see, and gives the particles their new ratio. cells: tile
 * of cell sums. */
void mpmi_locking_apply(const mpm_stepper *s, const double *cells, const mpmi_axis *axis, mpm_particles *set,
                        mpmi_law_batch *b, int64_t begin, int64_t n, double dt);

/* Place in the tile of the lower corner of the cells of n particles, at most a chunk. */
void mpmi_cell_places(const mpm_grid *grid, const mpmi_axis *axis, const mpmi_points *points, int64_t begin,
                      int64_t n, int32_t *place);

#endif
