/* What kernels are told of a block: its tile, which is a private copy of its nodes and their halo, and the
 * axes of the basis as seen from it. */
#ifndef MPMI_TILE_H
#define MPMI_TILE_H

#include "context/slack.h"
#include "layout/nodes.h"
#include "layout/reached.h"

/* Returns the number of nodes of a tile. */
int32_t mpmi_tile_nodes(const mpm_grid *grid);
/* Says with how many values per node a tile that has room for 8 is used from now on: the rest is slack. */
static inline void mpmi_tile_use(const mpm_grid *grid, double *tile, int32_t values) {
  if (!MPMI_WATCHED) return;
  const size_t node = (size_t)mpmi_tile_nodes(grid) * sizeof(double);
  mpmi_slack(tile, 8 * node, (size_t)values * node);
}
/* Fills a tile with what it takes of each node (transfer/box.h). */
void mpmi_tile_load(const mpmi_kernels *kernels, const mpmi_blocks *b, int64_t block, const mpmi_nodal *nodes,
                    int32_t what, double *tile);
/* Prefetches the nodes that a block with these spans shares with its neighbours [begin, end), itself among
 * them. */
void mpmi_tile_fetch(const mpmi_kernels *kernels, const mpmi_blocks *b, int64_t block,
                     const mpmi_spans *spans, const mpmi_nodal *nodes, int32_t begin, int32_t end);
/* Adds the tile, which has as many values per node or is flat, to the nodes and leaves it clean. */
void mpmi_tile_add(const mpmi_kernels *kernels, const mpmi_blocks *b, int64_t block, const mpmi_nodal *nodes,
                   int32_t flat, double *tile);
/* Turns a flat tile into one of eight values per node, and leaves it clean. */
void mpmi_tile_raise(const mpm_grid *grid, double *flat, double *tile);

/* Describes the axes of the basis as seen from the block at `coord`. */
void mpmi_block_axes(const mpm_grid *grid, const int32_t *coord, mpmi_axis *axis);

#endif
