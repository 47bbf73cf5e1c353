/* Nodal storage is sparse: blocks of nodes exist where there is material, in Morton order. A block holds
 * edge^dim nodes (x slowest). A particle belongs to the block of its anchor (grid.h). Blocks with
 * particles have all 3^dim neighbours, so that a tile (block and halo) can be read and written without a
 * search.
 *
 * Each body has blocks of its own, and so nodes and velocities of its own. Where two bodies are near each
 * other, blocks of both stand side by side in the list. Neighbours and periodic images are of the same
 * body. */
#ifndef MPMI_BLOCKS_H
#define MPMI_BLOCKS_H

#include "grid/grid.h"

/* MPMI_BLOCK_EDGE is the edge of a block in nodes. A particle may drift MPMI_RING cells out of its block
 * before the next sort. */
#define MPMI_BLOCK_EDGE(dim) ((dim) == 1 ? 64 : (dim) == 2 ? 16 : 6)
enum { MPMI_RING = 1 };

/* Blocks of one colour have the same parity of coordinates on each axis: their tiles do not overlap. */
enum { MPMI_COLOURS = 8 };
static inline int32_t mpmi_colour_of(int32_t dim, const int32_t *coord) {
  int32_t colour = 0;
  for (int32_t k = 0; k < dim; ++k) colour = 2 * colour + (coord[k] & 1);
  return colour;
}

enum { MPMI_MAX_NEIGHBOURS = 27, MPMI_NO_BLOCK = -1, MPMI_MAX_BODIES = 4096 };

/* A box of nodes in a block or in a tile: low <= place < high, by axis; empty where low >= high. */
typedef struct mpmi_node_box {
  uint8_t low[3], high[3];
} mpmi_node_box;

/* Where the particles of a block may be, by axis, and the nodes of its tile that their stencils then meet.
 * Once one has |x - centre| > half, this is found anew; they are never beyond low and high, which are a hair
 * wider and end at the faces of the grid. On periodic axes the tile alone bounds them. */
typedef struct mpmi_cover {
  double centre[3], half[3], low[3], high[3];
  mpmi_node_box nodes;
} mpmi_cover;

typedef struct mpmi_blocks {
  const mpm_grid *grid;
  mpm_context *context;
  int32_t edge, nodes, neighbours; /* nodes = edge^dim, neighbours = 3^dim */
  int64_t count, capacity;
  uint64_t *key;                             /* [count] Morton key; (key, body) ascends once ordered */
  int32_t *body;                             /* [count] */
  int32_t (*coord)[3];                       /* [count] */
  int32_t (*neighbour)[MPMI_MAX_NEIGHBOURS]; /* [count], lowest corner first; MPMI_NO_BLOCK where absent */
  /* Of blocks with particles, and of any block the box of its nodes that are met; both are found before a
   * step (layout/reached.c). */
  mpmi_cover *cover;               /* [count] */
  mpmi_node_box *reached;          /* [count] */
  uint32_t *order, *order_scratch; /* [capacity] order: provisional -> final; else scratch */
  uint64_t *key_scratch;
  int32_t *body_scratch;
  int32_t (*coord_scratch)[3];
  int64_t table_size; /* hash table from key and body to block, a power of two */
  uint64_t *table_key;
  int32_t *table_block;
} mpmi_blocks;

void mpmi_blocks_init(mpmi_blocks *blocks, const mpm_grid *grid);
void mpmi_blocks_free(mpmi_blocks *blocks);
void mpmi_blocks_clear(mpmi_blocks *blocks);
/* Finds or adds a block of a body by its coordinates; *block is provisional until mpmi_blocks_order(). */
mpm_status mpmi_blocks_insert(mpmi_blocks *blocks, int32_t body, const int32_t *coord, int32_t *block);
/* Adds halo and periodic images to the blocks inserted so far, sorts all by Morton key and body and links
 * neighbours. Afterwards order[provisional] is the final index of a block. */
mpm_status mpmi_blocks_order(mpmi_blocks *blocks);
/* Returns the Morton key of the blocks at these coordinates. */
uint64_t mpmi_block_key(const mpm_grid *grid, const int32_t *coord);
/* Finds a block that has been inserted, or returns MPMI_NO_BLOCK. */
int32_t mpmi_blocks_find(const mpmi_blocks *blocks, int32_t body, const int32_t *coord);
/* Returns the anchor along an axis of a position that lies inside the grid. */
int32_t mpmi_anchor(const mpm_grid *grid, int32_t axis, double x);
/* Finds the block of a position that lies inside the grid. */
void mpmi_blocks_of_position(const mpm_grid *grid, const double *x, int64_t stride, int32_t edge,
                             int32_t *coord);
/* Returns the slot (block * nodes + place) of a body's node by its index, or -1 when its block does not
 * exist. */
int64_t mpmi_blocks_node(const mpmi_blocks *blocks, int32_t body, const int64_t *index);
/* Returns the slot of the node `at` steps from the first node of a block, in it or in a neighbour, or -1
 * when that block does not exist. */
int64_t mpmi_blocks_near(const mpmi_blocks *blocks, int64_t block, const int32_t *at);
/* Returns the slot of the node at an offset, of at most a block, from the one in a slot, or -1. */
int64_t mpmi_blocks_beside(const mpmi_blocks *blocks, int64_t slot, const int32_t *offset);
/* The same for a node that stands for its periodic images: where it has no such neighbour, that of an image
 * may be there. Returns its original then. */
int64_t mpmi_blocks_around(const mpmi_blocks *blocks, int64_t slot, const int32_t *offset);
/* Finds the index of the node in a slot. */
void mpmi_blocks_index(const mpmi_blocks *blocks, int64_t slot, int64_t *index);
/* Returns its number, by which messages name nodes; of a periodic image that of its original. */
int64_t mpmi_blocks_number(const mpmi_blocks *blocks, int64_t slot);

#endif
