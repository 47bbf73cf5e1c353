/* Which nodes the particles of a block meet: those of its tile that their stencils may touch, and so which
 * nodes of the blocks around it; and with one node of a tie all of them. Blocks without particles are there
 * for their neighbours' sake, and most of their nodes are met by none: nothing is ever given to these. */
#ifndef MPMI_REACHED_H
#define MPMI_REACHED_H

#include "layout/sorted_layout.h"

/* Along an axis a tile spans parts of the lower neighbour, the block and the upper neighbour. */
typedef struct mpmi_span {
  int32_t tile, block, length; /* first place in the tile, first place in the block, nodes */
} mpmi_span;

/* The spans of the nodes that the particles of a block meet, by axis and neighbour; an axis that the grid
 * does not have is one node wide. */
typedef struct mpmi_spans {
  mpmi_span at[3][3];
} mpmi_spans;
mpmi_spans mpmi_spans_of(const mpmi_blocks *b, int64_t block);
/* The same for wider stencils about the same anchors, in a tile of their width. */
mpmi_spans mpmi_spans_of_stencil(const mpmi_blocks *b, int64_t block, int32_t width, int32_t below);

/* Finds where the particles of each block are, and which nodes and ties they meet; that takes room for a list
 * of ties. A particle may drift so far, in cells, before the cover is found anew. */
#define MPMI_COVER_DRIFT 0.5
mpm_status mpmi_layout_cover(mpmi_layout *layout);
/* Sets the bounds of a block's whole tile: beyond them all particles are sorted anew. */
void mpmi_tile_bounds(const mpmi_blocks *b, int64_t block, double *centre, double *half);

/* Goes through the nodes of blocks [begin, end) that are met, in runs of neighbouring slots. */
typedef void (*mpmi_run_fn)(void *user, int64_t slot, int64_t count);
void mpmi_reached_runs(const mpmi_blocks *b, int64_t begin, int64_t end, mpmi_run_fn fn, void *user);

#endif
