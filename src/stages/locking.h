/* Remedy against volumetric locking (MPoint theory eqs 47-53, carried to the deformation gradient). The law
 * sees
 *
 *   F_inc' = f F_inc,  f^d = (1 + j') / (1 + j),  j = det F_inc - 1,  j' = sum V j / sum V over the cell
 *
 * and F' = r^(1/d) F, where the ratio r grows by f^d in each step; in plane strain only the axes of the plane
 * are scaled. F, the volume and the positions are those without the remedy. The cell of a particle is known
 * by the node of its lower corner: sums over cells go the way of nodal sums (layout/accumulate.h). */
#ifndef MPMI_LOCKING_H
#define MPMI_LOCKING_H

#include "layout/nodes.h"
#include "layout/step.h"
#include "particles/law_batch.h"

/* Cell averages of the dilation that these nodal velocities make, into the sums of the nodes, for the pass
 * that deforms. */
mpm_status mpmi_locking_stage(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from);

/* Scales the deformation that the law is about to see, and gives the particles their new ratio. cells: tile
 * of cell sums. */
void mpmi_locking_apply(const mpm_grid *grid, const double *cells, const mpmi_axis *axis, mpm_particles *set,
                        mpmi_law_batch *b, int64_t begin, int64_t n, double dt);

/* Place in the tile of the lower corner of the cells of n particles, at most a chunk. */
void mpmi_cell_places(const mpm_grid *grid, const mpmi_axis *axis, const mpmi_points *points, int64_t begin,
                      int64_t n, int32_t *place);

#endif
