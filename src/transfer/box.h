/* Boxes of nodes between a tile and the nodes of a block. */
#ifndef MPMI_BOX_H
#define MPMI_BOX_H

#include "grid/blocks.h"

/* A box of nodes in a tile and in the nodes of one block; strides of the two outer axes in nodes. */
typedef struct mpmi_box {
  double *tile, *nodes;
  int32_t count[3], tile_stride[2], node_stride[2];
} mpmi_box;
/* Adds the tile to the nodes and clears it; both have `values` per node. */
typedef void (*mpmi_add_box_fn)(int32_t values, const mpmi_box *box);
/* Prefetches the nodes. */
typedef void (*mpmi_fetch_box_fn)(int32_t values, const mpmi_box *box);
/* Copies nodes into the tile: 8 values from 8, 4 from 4 or from the first half of 8, or the first alone. */
typedef void (*mpmi_load_box_fn)(int32_t values, int32_t node_values, const mpmi_box *box);

#endif
