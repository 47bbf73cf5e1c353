/* Boxes of nodes between a tile and the nodes of a block. */
#ifndef MPMI_BOX_H
#define MPMI_BOX_H

#include "grid/blocks.h"

/* A box of nodes in a tile and in the nodes of one block; strides of the two outer axes in nodes. */
typedef struct mpmi_box {
  double *tile, *nodes;
  double *masses; /* of a flat tile */
  int32_t count[3], tile_stride[2], node_stride[2];
} mpmi_box;
/* Adds the tile to the nodes and clears it; both have `values` per node. */
typedef void (*mpmi_add_box_fn)(int32_t values, const mpmi_box *box);
/* The same of a flat tile (transfer/scatter.h), to nodes of eight values. */
typedef void (*mpmi_add_flat_box_fn)(const mpmi_box *box);
/* Prefetches the nodes. */
typedef void (*mpmi_fetch_box_fn)(int32_t values, const mpmi_box *box);
/* What a tile takes of nodes: the first value, the first four, of eight the first two of either half, or all
 * eight. */
enum { MPMI_TAKE_FIRST, MPMI_TAKE_HALF, MPMI_TAKE_PAIRS, MPMI_TAKE_ALL };
static inline int32_t mpmi_taken_values(int32_t what) {
  return what == MPMI_TAKE_FIRST ? 1 : what == MPMI_TAKE_ALL ? 8 : 4;
}
/* Copies nodes, which have 4 or 8 values, into the tile. */
typedef void (*mpmi_load_box_fn)(int32_t what, int32_t node_values, const mpmi_box *box);

#endif
