/* The background grid: a description only. Nodal storage belongs to the stepper (grid/blocks.h). */
#ifndef MPMI_GRID_H
#define MPMI_GRID_H

#include "context/context.h"

struct mpm_grid {
  uint32_t magic;
  int32_t children; /* sets and steppers on this grid */
  mpm_context *context;
  mpm_grid_desc desc;
  int32_t dim;
  int32_t order; /* of the basis: 1 linear, 2 quadratic */
  int32_t width; /* nodes of the stencil per axis: order + 1 */
  double upper[3], inverse_spacing[3];
  double h_min; /* smallest spacing */
};

/* Nodes are numbered so that node i of an axis lies at origin + i * spacing; a quadratic basis has one ghost
 * node beyond each face (-1 and cells + 1). Number of a node as reported in mpm_step_info.node. */
int64_t mpmi_node_number(const mpm_grid *grid, const int64_t *index);

/* Bounds test and periodic wrap of one position (strided by `stride`). Wraps periodic axes, adding the
 * periods crossed to image[] (may be NULL). Returns the first axis on which the position is not finite or
 * lies outside the bounds, or -1. A position on a bound is inside. */
int32_t mpmi_grid_place(const mpm_grid *grid, double *position, int64_t stride, int64_t *image,
                        int64_t image_stride);

#endif
