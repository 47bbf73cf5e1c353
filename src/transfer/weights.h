/* Weights of the basis functions at particles, a chunk of them at a time, as seen from one block. */
#ifndef MPMI_WEIGHTS_H
#define MPMI_WEIGHTS_H

#include "grid/blocks.h"
#include "simd/chunk.h"

enum { MPMI_MAX_WIDTH = 4 };
#define MPMI_TILE_EDGE(dim, width) (MPMI_BLOCK_EDGE(dim) + 2 * MPMI_RING + (width)-1)

/* One axis of the basis as seen from one block. */
typedef struct mpmi_axis {
  double origin, spacing, inverse_spacing;
  double last_cell;              /* takes the particles on the upper face too */
  double first_knot, last_knot;  /* in cells: open knot vectors are repeated there; else far away */
  double domain;                 /* edge of the particle domains in cells, where particles have none */
  double period, inverse_period; /* in cells; 0 when the axis is not periodic */
  double tile_base;              /* node at the corner of the tile */
  double middle; /* of the valid first nodes, relative to tile_base: picks the periodic image */
  int32_t still; /* particles stay where they were put: total Lagrangian */
} mpmi_axis;

/* Where particles are, each array at slot 0, and for GIMP the edges of their domains: size, or NULL for one
 * size for all, times |stretch|, or NULL for 1. */
typedef struct mpmi_points {
  const double *x[3], *size[3], *stretch[3];
} mpmi_points;

/* Weights of a chunk along each axis: w basis; g second weight of the first-order terms: the gradient, or u /
 * D in the MLS form; u = w (x_i - x_p), with inverse_moment = 1 / sum w (x_i - x_p)^2, or 0 where that
 * vanishes. first: from the particle to the first node of its stencil, in cells. node: that node's place in
 * the tile. */
typedef struct mpmi_weights {
  _Alignas(64) double w[3][MPMI_MAX_WIDTH][MPMI_CHUNK];
  double g[3][MPMI_MAX_WIDTH][MPMI_CHUNK];
  double u[3][MPMI_MAX_WIDTH][MPMI_CHUNK];
  double inverse_moment[3][MPMI_CHUNK], first[3][MPMI_CHUNK];
  int32_t node[MPMI_CHUNK];
} mpmi_weights;

/* The node of a stencil, counted along an axis, about which moments are taken where nodes are a spacing
 * apart: distances are small integers then, and its own is none. */
#define MPMI_MIDDLE(width) ((width) > 2 ? 1 : 0)

/* h^2 / D of the MLS form: quadratic and cubic B-splines have D = h^2 / 4 and h^2 / 3 everywhere. */
#define MPMI_MLS_INVERSE(width) ((width) == 3 ? 4.0 : 3.0)

/* What a transfer needs beside w and first, and what it can do without: bits. */
enum {
  MPMI_NEED_GRADIENT = 1, /* g */
  MPMI_NEED_MOMENT = 2,   /* u and inverse_moment */
  MPMI_NEED_MLS = 4,      /* g, u and inverse_moment, with g = u / D */
  MPMI_NO_PLACE = 8,      /* do not find node: the particles may lie anywhere */
  MPMI_NO_FIRST = 16      /* beside gradients: first need not be kept, nor what mpmi_gradient() knows */
};

/* Computes the weights of n particles (MPMI_CHUNK of them) along all axes. Each basis has such a function for
 * each dim; everything else is common to all. */
typedef void (*mpmi_weights_fn)(const mpmi_axis *axis, int32_t need, const mpmi_points *points, int64_t begin,
                                int64_t n, mpmi_weights *out);

/* Returns 1 where all particles have the same gradients, which W need not have then: with two nodes on an
 * axis, on the linear basis. In 1-D it has them: there no weight of another axis masks that of a hole. */
MPMI_INLINE int32_t mpmi_gradients_alike(int32_t dim, int32_t width) {
  return dim > 1 && width == 2;
}
/* Returns the gradient along an axis at node k of a stencil. */
MPMI_INLINE double mpmi_gradient(int32_t dim, int32_t width, const mpmi_weights *W,
                                 const double *inverse_spacing, int32_t axis, int32_t k, int64_t p) {
  return !mpmi_gradients_alike(dim, width) ? W->g[axis][k][p]
         : k                               ? inverse_spacing[axis]
                                           : -inverse_spacing[axis];
}

#endif
