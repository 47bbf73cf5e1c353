#include "stepper/stepper.h"

#include <string.h>

/* Along an axis a tile spans parts of the lower neighbour, the block and the upper neighbour. */
typedef struct span {
  int32_t tile, block, length; /* first place in the tile, first place in the block, nodes */
} span;

static void spans_of(const mpm_grid *grid, int32_t edge, span *out) {
  const int32_t low = MPMI_RING + (grid->order == 2), high = MPMI_RING + grid->width - 1 - (grid->order == 2);
  out[0] = (span){0, edge - low, low};
  out[1] = (span){low, 0, edge};
  out[2] = (span){low + edge, 0, high};
}

/* Visits the rows of nodes (last axis contiguous) that tile and blocks share. */
typedef void (*row_fn)(double *tile, int32_t tile_values, double *nodes, int32_t node_values, int64_t count);

static void visit_rows(const mpm_stepper *s, int64_t block, double *nodes, int32_t node_values, double *tile,
                       int32_t tile_values, row_fn row) {
  const mpmi_blocks *b = &s->blocks;
  const int32_t dim = s->grid->dim, edge = b->edge, tile_edge = MPMI_TILE_EDGE(dim, s->grid->width);
  span spans[3];
  spans_of(s->grid, edge, spans);
  for (int32_t n = 0; n < b->neighbours; ++n) {
    const span *x = &spans[dim == 3 ? n / 9 : 1], *y = &spans[dim >= 2 ? n / 3 % 3 : 1], *z = &spans[n % 3];
    double *base = nodes + (int64_t)b->neighbour[block][n] * b->nodes * node_values;
    const int32_t rows_x = dim == 3 ? x->length : 1, rows_y = dim >= 2 ? y->length : 1;
    for (int32_t i = 0; i < rows_x; ++i)
      for (int32_t j = 0; j < rows_y; ++j) {
        int64_t in_tile = z->tile, in_block = z->block;
        if (dim >= 2) {
          in_tile += (int64_t)(y->tile + j) * tile_edge;
          in_block += (int64_t)(y->block + j) * edge;
        }
        if (dim == 3) {
          in_tile += (int64_t)(x->tile + i) * tile_edge * tile_edge;
          in_block += (int64_t)(x->block + i) * edge * edge;
        }
        row(tile + in_tile * tile_values, tile_values, base + in_block * node_values, node_values, z->length);
      }
  }
}

/* A tile of 4 values per node can be had from nodes with 8: the velocities without their changes. */
static void load_row(double *tile, int32_t tile_values, double *nodes, int32_t node_values, int64_t count) {
  if (tile_values == node_values) {
    memcpy(tile, nodes, (size_t)(count * tile_values) * sizeof *tile);
    return;
  }
  for (int64_t i = 0; i < count; ++i) memcpy(tile + 4 * i, nodes + i * node_values, 4 * sizeof *tile);
}

static void add_row(double *tile, int32_t tile_values, double *nodes, int32_t node_values, int64_t count) {
  (void)node_values;
  for (int64_t i = 0; i < count * tile_values; ++i) nodes[i] += tile[i];
}

void mpmi_tile_load(const mpm_stepper *s, int64_t block, const double *nodes, int32_t node_values,
                    int32_t tile_values, double *tile) {
  visit_rows(s, block, (double *)(uintptr_t)nodes, node_values, tile, tile_values, load_row);
}

void mpmi_tile_add(const mpm_stepper *s, int64_t block, double *nodes, int32_t values, const double *tile) {
  visit_rows(s, block, nodes, values, (double *)(uintptr_t)tile, values, add_row);
}

void mpmi_block_axes(const mpm_grid *grid, const int32_t *coord, mpmi_axis *axis) {
  const int32_t edge = MPMI_BLOCK_EDGE(grid->dim), wide = grid->order == 2;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double cells = (double)grid->desc.cells[k];
    const int32_t periodic = grid->desc.periodic[k] != 0;
    axis[k] = (mpmi_axis){.origin = grid->desc.origin[k],
                          .spacing = grid->desc.spacing[k],
                          .inverse_spacing = grid->inverse_spacing[k],
                          .base_low = wide ? -1.0 : 0.0,
                          .base_high = cells - 1.0,
                          .period = periodic ? cells : 0.0,
                          .inverse_period = periodic ? 1.0 / cells : 0.0,
                          .tile_base = (double)coord[k] * edge - MPMI_RING - wide,
                          .middle = 0.5 * (edge + 2 * MPMI_RING - 1)};
  }
}
