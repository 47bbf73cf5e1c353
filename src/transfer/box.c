/* Boxes of nodes between the tile of a block and the nodes of that block or of a neighbour. */
#include "simd/vector.h"
#include "transfer/box.h"

/* Adds the tile to the nodes and clears it. */
MPMI_INLINE void add_box(int32_t values, const mpmi_box *box) {
  const int32_t all = values == 8 ? MPMI_BOTH : MPMI_LOW;
  const mpmi_node zero = mpmi_node_zero();
  for (int32_t i = 0; i < box->count[0]; ++i)
    for (int32_t j = 0; j < box->count[1]; ++j) {
      double *tile = box->tile + values * (i * box->tile_stride[0] + j * box->tile_stride[1]);
      double *nodes = box->nodes + values * (i * box->node_stride[0] + j * box->node_stride[1]);
      for (int32_t k = 0; k < box->count[2]; ++k) {
        const mpmi_node sum = mpmi_node_sum(all, mpmi_node_load(all, nodes + values * k),
                                            mpmi_node_load(all, tile + values * k));
        mpmi_node_store(all, nodes + values * k, sum);
        mpmi_node_store(all, tile + values * k, zero);
      }
    }
}

void KERNEL(add_flat_box)(const mpmi_box *box) {
  const mpmi_v4 zero = mpmi_zero4();
  for (int32_t i = 0; i < box->count[0]; ++i)
    for (int32_t j = 0; j < box->count[1]; ++j) {
      const int64_t row = i * box->tile_stride[0] + j * box->tile_stride[1];
      double *tile = box->tile + 4 * row, *masses = box->masses + row;
      double *nodes = box->nodes + 8 * (i * box->node_stride[0] + j * box->node_stride[1]);
      for (int32_t k = 0; k < box->count[2]; ++k, tile += 4, nodes += 8) {
        const mpmi_v4 flat = mpmi_load4(tile), mass = mpmi_set4(0.0, masses[k], 0.0, 0.0);
        mpmi_store4(nodes, mpmi_sum4(mpmi_load4(nodes), mpmi_pair4(flat, mass)));
        mpmi_store4(nodes + 4, mpmi_sum4(mpmi_load4(nodes + 4), mpmi_last_pair4(flat, zero)));
        mpmi_store4(tile, zero);
        masses[k] = 0.0;
      }
    }
}

/* Copies the nodes into the tile. */
MPMI_INLINE void load_box(int32_t what, int32_t node_values, const mpmi_box *box) {
  const int32_t values = what == MPMI_TAKE_ALL ? 8 : 4, all = values == 8 ? MPMI_BOTH : MPMI_LOW;
  for (int32_t i = 0; i < box->count[0]; ++i)
    for (int32_t j = 0; j < box->count[1]; ++j) {
      double *tile = box->tile + values * (i * box->tile_stride[0] + j * box->tile_stride[1]);
      const double *nodes = box->nodes + node_values * (i * box->node_stride[0] + j * box->node_stride[1]);
      for (int32_t k = 0; k < box->count[2]; ++k, tile += values, nodes += node_values)
        if (what == MPMI_TAKE_PAIRS)
          mpmi_store4(tile, mpmi_pair4(mpmi_load4(nodes), mpmi_load4(nodes + 4)));
        else
          mpmi_node_store(all, tile, mpmi_node_load(all, nodes));
    }
}

/* Copies one value of each node. */
MPMI_INLINE void load_value(int32_t node_values, const mpmi_box *box) {
  for (int32_t i = 0; i < box->count[0]; ++i)
    for (int32_t j = 0; j < box->count[1]; ++j) {
      double *tile = box->tile + i * box->tile_stride[0] + j * box->tile_stride[1];
      const double *nodes = box->nodes + node_values * (i * box->node_stride[0] + j * box->node_stride[1]);
      for (int32_t k = 0; k < box->count[2]; ++k) tile[k] = nodes[node_values * k];
    }
}

/* Asks for the nodes of a box, to the second-level cache. */
void KERNEL(fetch_box)(int32_t values, const mpmi_box *box) {
  enum { LINE = 64 / (int32_t)sizeof(double) };
  for (int32_t i = 0; i < box->count[0]; ++i)
    for (int32_t j = 0; j < box->count[1]; ++j) {
      const double *row = box->nodes + values * (i * box->node_stride[0] + j * box->node_stride[1]);
      for (int32_t k = 0; k < values * box->count[2]; k += LINE) __builtin_prefetch(row + k, 0, 2);
    }
}

void KERNEL(add_box)(int32_t values, const mpmi_box *box) {
  if (values == 8)
    add_box(8, box);
  else
    add_box(4, box);
}

void KERNEL(load_box)(int32_t what, int32_t node_values, const mpmi_box *box) {
  if (what == MPMI_TAKE_ALL)
    load_box(MPMI_TAKE_ALL, 8, box);
  else if (what == MPMI_TAKE_PAIRS)
    load_box(MPMI_TAKE_PAIRS, 8, box);
  else if (what == MPMI_TAKE_HALF)
    load_box(MPMI_TAKE_HALF, node_values, box);
  else
    load_value(node_values, box);
}
