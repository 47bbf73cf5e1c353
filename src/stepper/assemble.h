/* Of one batch of particles, for assembly.c: see assemble_batch.c. */
#ifndef MPMI_ASSEMBLE_H
#define MPMI_ASSEMBLE_H

#include "stepper/newton.h"

/* Of the tile that forces of one block are added up in. */
size_t mpmi_force_tile_bytes(const mpm_stepper *s);
/* Spreads the external forces of a set, or with a nominal stress the internal ones. */
mpmi_force_scatter mpmi_force_scatter_of(const mpm_stepper *s, const mpmi_member *member, double *tile);

#endif
