/* Clusters of particles (particles/clusters.h): 2^dim of them, one after the other, that have the same
 * stencil and are two along each axis, so that along an axis there are two sets of weights alone. A sum over
 * particles and nodes is then formed axis by axis: what one axis gives is common to all particles that differ
 * along the others. Only on total Lagrangian grids do particles stay like that. */
#ifndef MPMI_CLUSTER_H
#define MPMI_CLUSTER_H

#include "transfer/weights.h"

/* The particles of a cluster, and the first of them that has the coordinate at an end (0, 1) of an axis. */
#define MPMI_CLUSTER(dim)                   (1 << (dim))
#define MPMI_CLUSTER_END(dim, axis, at_end) ((at_end) << ((dim)-1 - (axis)))

/* Returns 1 when a pattern of bits is not the same at all particles that are alike along an axis. */
MPMI_INLINE int32_t mpmi_differs_along(int32_t dim, int32_t axis, const double *value) {
  uint64_t bits[8], differ = 0;
  __builtin_memcpy(bits, value, sizeof *bits << dim);
  for (int32_t p = 0; p < MPMI_CLUSTER(dim); ++p)
    differ |= bits[p] ^ bits[p & MPMI_CLUSTER_END(dim, axis, 1)];
  return differ != 0;
}

/* Returns 1 when the particles from p in a chunk and s in the set on are a cluster. */
MPMI_INLINE int32_t mpmi_is_cluster(int32_t dim, const mpmi_points *points, const mpmi_weights *W, int64_t s,
                                    int64_t p) {
  int32_t differ = 0;
  for (int32_t i = 1; i < MPMI_CLUSTER(dim); ++i) differ |= W->node[p + i] ^ W->node[p];
  for (int32_t k = 0; k < dim; ++k) {
    differ |= mpmi_differs_along(dim, k, points->x[k] + s);
    if (points->size[k]) differ |= mpmi_differs_along(dim, k, points->size[k] + s);
    differ |= points->stretch[k] != NULL;
  }
  return !differ;
}

#endif
