/* Which nodes of the blocks around it the tile of a block overlaps. Blocks without particles are there for
 * their neighbours' sake, and most of their nodes are in no tile: nothing is ever given to these. */
#ifndef MPMI_REACHED_H
#define MPMI_REACHED_H

#include "grid/blocks.h"

/* Along an axis a tile spans parts of the lower neighbour, the block and the upper neighbour. */
typedef struct mpmi_span {
  int32_t tile, block, length; /* first place in the tile, first place in the block, nodes */
} mpmi_span;
void mpmi_spans(const mpm_grid *grid, int32_t edge, mpmi_span *out);

/* Finds which nodes the tiles of these blocks overlap. */
void mpmi_tiles_reach(mpmi_blocks *b, const int32_t *block, int64_t count);
/* Goes through the nodes of blocks [begin, end) that tiles overlap, in runs of neighbouring slots. */
typedef void (*mpmi_run_fn)(void *user, int64_t slot, int64_t count);
void mpmi_reached_runs(const mpmi_blocks *b, int64_t begin, int64_t end, mpmi_run_fn fn, void *user);

#endif
