/* What one batch of particles adds to forces and stiffness of the nodes: its law has run, its nominal stress
 * and its tangent are pushed forward (transfer/stiffness.c) and spread over the nodes of their stencils. */
#ifndef MPMI_PARTICLE_STIFFNESS_H
#define MPMI_PARTICLE_STIFFNESS_H

#include "implicit/balance.h"

/* Spreads the external forces of a set; with a nominal stress the internal ones. */
mpmi_force_scatter mpmi_force_scatter_of(const mpmi_settings *settings, const mpmi_member *member,
                                         double *tile);
/* Active node at each place of the tile of a block, or -1. */
void mpmi_tile_of_unknowns(const mpmi_balance *s, int64_t block, int32_t *to);
/* Adds the internal forces of a batch to the tile of its task. */
void mpmi_add_forces(mpmi_balance *s, mpmi_batch *b);
/* Adds its stiffness to the matrix. */
void mpmi_add_stiffness(mpmi_balance *s, mpmi_batch *b);

#endif
