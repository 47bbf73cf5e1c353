/* Tiles and the blocks around them: loads, adds and fetches box by box, by the kernels of transfer/box.c. */
#include "layout/tile.h"

#include <string.h>

int32_t mpmi_tile_nodes(const mpm_grid *grid) {
  int32_t count = 1;
  for (int32_t k = 0; k < grid->dim; ++k) count *= MPMI_TILE_EDGE(grid->dim, grid->width);
  return count;
}

/* Finds the box of nodes that the particles of a block meet in its neighbour n; returns 0 where there is
 * none. */
static int32_t find_box(const mpmi_blocks *b, const mpmi_spans *spans, int64_t block, int32_t n,
                        const mpmi_nodal *nodes, double *tile, int32_t tile_values, mpmi_box *box) {
  const mpmi_span *x = &spans->at[0][n / 9], *y = &spans->at[1][n / 3 % 3], *z = &spans->at[2][n % 3];
  if (!x->length || !y->length || !z->length) return 0;
  const int32_t edge = b->edge, tile_edge = MPMI_TILE_EDGE(b->grid->dim, b->grid->width);
  const int64_t in_tile = ((int64_t)x->tile * tile_edge + y->tile) * tile_edge + z->tile;
  const int64_t in_block =
      ((int64_t)b->neighbour[block][n] * b->nodes) + ((int64_t)x->block * edge + y->block) * edge + z->block;
  *box = (mpmi_box){.tile = tile + in_tile * tile_values,
                    .nodes = mpmi_nodal_at(nodes, in_block),
                    .count = {x->length, y->length, z->length},
                    .tile_stride = {tile_edge * tile_edge, tile_edge},
                    .node_stride = {edge * edge, edge}};
  return 1;
}

/* Nodes that all fit into the second-level cache need not be asked for. */
static int32_t are_near(const mpmi_blocks *b, const mpmi_nodal *nodes) {
  const int64_t near = 512 * 1024;
  return b->count * b->nodes * nodes->values * (int64_t)sizeof(double) <= near;
}

void mpmi_tile_fetch(const mpmi_kernels *kernels, const mpmi_blocks *b, int64_t block,
                     const mpmi_spans *spans, const mpmi_nodal *nodes, int32_t begin, int32_t end) {
  mpmi_box box;
  if (are_near(b, nodes)) return;
  for (int32_t n = begin; n < end; ++n)
    if (find_box(b, spans, block, n, nodes, nodes->at, 0, &box)) kernels->fetch_box(nodes->values, &box);
}

void mpmi_tile_load(const mpmi_kernels *kernels, const mpmi_blocks *b, int64_t block, const mpmi_nodal *nodes,
                    int32_t what, double *tile) {
  const mpmi_spans spans = mpmi_spans_of(b, block);
  mpmi_box box;
  for (int32_t n = 0; n < b->neighbours; ++n)
    if (find_box(b, &spans, block, n, nodes, tile, mpmi_taken_values(what), &box))
      kernels->load_box(what, nodes->values, &box);
}

void mpmi_tile_add(const mpmi_kernels *kernels, const mpmi_blocks *b, int64_t block, const mpmi_nodal *nodes,
                   int32_t flat, double *tile) {
  const mpmi_spans spans = mpmi_spans_of(b, block);
  mpmi_box box;
  for (int32_t n = 0; n < b->neighbours; ++n) {
    if (!find_box(b, &spans, block, n, nodes, tile, flat ? 4 : nodes->values, &box)) continue;
    if (!flat) {
      kernels->add_box(nodes->values, &box);
      continue;
    }
    box.masses = mpmi_flat_masses(b->grid->dim, b->grid->width, tile) + (box.tile - tile) / 4;
    kernels->add_flat_box(&box);
  }
}

void mpmi_tile_raise(const mpm_grid *grid, double *flat, double *tile) {
  const int32_t count = mpmi_tile_nodes(grid);
  double *masses = mpmi_flat_masses(grid->dim, grid->width, flat);
  for (int32_t i = 0; i < count; ++i) {
    const double *from = flat + 4 * i;
    memcpy(tile + 8 * i, (double[8]){from[0], from[1], 0.0, masses[i], from[2], from[3], 0.0, 0.0},
           8 * sizeof(double));
  }
  memset(flat, 0, (size_t)(MPMI_FLAT_VALUES * count) * sizeof(double));
}

/* Stands for a knot that is out of reach. */
#define FAR 1e300

void mpmi_block_axes(const mpm_grid *grid, const int32_t *coord, mpmi_axis *axis) {
  const int32_t edge = MPMI_BLOCK_EDGE(grid->dim);
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double cells = (double)grid->desc.cells[k];
    const int32_t periodic = grid->desc.periodic[k] != 0;
    axis[k] = (mpmi_axis){.origin = grid->desc.origin[k],
                          .spacing = grid->desc.spacing[k],
                          .inverse_spacing = grid->inverse_spacing[k],
                          .last_cell = cells - 1.0,
                          .first_knot = mpmi_is_open(grid, k) ? 0.0 : -FAR,
                          .last_knot = mpmi_is_open(grid, k) ? cells : FAR,
                          .domain = grid->desc.smoothing,
                          .period = periodic ? cells : 0.0,
                          .inverse_period = periodic ? 1.0 / cells : 0.0,
                          .tile_base = (double)coord[k] * edge - (double)MPMI_RING - grid->below,
                          .middle = 0.5 * (edge + 2 * MPMI_RING - 1),
                          .still = mpmi_is_total_lagrangian(grid)};
  }
}
