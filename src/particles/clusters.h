/* The order of particles that stay where they were put, those of total Lagrangian grids. A cluster is made of
 * 2, 4 or 8 particles, two along each axis, that have the same stencil and share their coordinates, and so
 * their weights, with each other: kernels form sums over its particles and nodes axis by axis, and look at
 * stencils and coordinates again before that (transfer/cluster.h). Fills make such particles. */
#ifndef MPMI_CLUSTERS_H
#define MPMI_CLUSTERS_H

#include "grid/blocks.h"
#include "particles/particles.h"

/* Puts the particles of clusters in front of the others of a block, cluster by cluster, the last axis
 * fastest; if there are any, the others follow stencil by stencil. source: the slots that the block's
 * particles are in, in order; room: as many more. */
void mpmi_clusters_first(const mpm_particles *set, int64_t count, uint32_t *source, uint32_t *room);

#endif
