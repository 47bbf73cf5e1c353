/* The basis as seen from a block, and where the particles of a set are: what the kernels are told of both. */
#ifndef MPMI_AXES_H
#define MPMI_AXES_H

#include "particles/particles.h"
#include "transfer/kernels.h"

/* Axes of the basis as seen from the block at `coord`. */
void mpmi_block_axes(const mpm_grid *grid, const int32_t *coord, mpmi_axis *axis);
/* Where the particles of a set are, and how large; copy: of position and deformation gradient. */
mpmi_points mpmi_points_of(const mpm_particles *set, int32_t copy);

#endif
