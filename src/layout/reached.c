#include "layout/reached.h"
#include "simd/lanes.h"
#include "transfer/weights.h"

#include <math.h>

/* ---- spans -------------------------------------------------------------------------------------------- */
static mpmi_span cut(mpmi_span of, int32_t low, int32_t high) {
  const int32_t first = of.tile > low ? of.tile : low, end = of.tile + of.length;
  const int32_t last = end < high ? end : high;
  return (mpmi_span){first, of.block + first - of.tile, last > first ? last - first : 0};
}

mpmi_spans mpmi_spans_of(const mpmi_blocks *b, int64_t block) {
  return mpmi_spans_of_stencil(b, block, b->grid->width, b->grid->below);
}

mpmi_spans mpmi_spans_of_stencil(const mpmi_blocks *b, int64_t block, int32_t width, int32_t below) {
  const mpm_grid *grid = b->grid;
  const mpmi_node_box *box = &b->cover[block].nodes;
  const int32_t edge = b->edge, low = MPMI_RING + below, high = MPMI_RING + width - 1 - below,
                wider = width - grid->width;
  mpmi_spans spans;
  for (int32_t k = 0; k < 3; ++k) {
    const int32_t axis = k - (3 - grid->dim); /* the last axes are those of the grid */
    if (axis < 0) {
      spans.at[k][0] = (mpmi_span){0, 0, 1};
      continue;
    }
    spans.at[k][0] = cut((mpmi_span){0, edge - low, low}, box->low[axis], box->high[axis] + wider);
    spans.at[k][1] = cut((mpmi_span){low, 0, edge}, box->low[axis], box->high[axis] + wider);
    spans.at[k][2] = cut((mpmi_span){low + edge, 0, high}, box->low[axis], box->high[axis] + wider);
  }
  return spans;
}

/* ---- where particles are ------------------------------------------------------------------------------ */
void mpmi_tile_bounds(const mpmi_blocks *b, int64_t block, double *centre, double *half) {
  const mpm_grid *grid = b->grid;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double first = (double)b->coord[block][k] * b->edge;
    const double middle = first + 0.5 * (b->edge - grid->centred);
    centre[k] = grid->desc.origin[k] + grid->desc.spacing[k] * middle;
    half[k] = grid->desc.spacing[k] * (0.5 * b->edge + (double)MPMI_RING) * (1.0 - 1e-9);
  }
}

/* Widens [low, high] to the n positions x, whole chunks of them. */
static void widen(const double *x, int64_t n, double *low, double *high) {
  const mpmi_lanes zero = {0.0};
  mpmi_lanes least = zero + *low, most = zero + *high;
  for (int64_t p = 0; p < n; p += MPMI_LANES) {
    least = mpmi_lanes_min(least, mpmi_lanes_load(x + p));
    most = mpmi_lanes_max(most, mpmi_lanes_load(x + p));
  }
  *low = mpmi_lanes_smallest(least);
  *high = mpmi_lanes_largest(most);
}

/* Returns the place in the tile of the first node of a stencil. */
static int32_t first_place(const mpmi_blocks *b, int64_t block, int32_t k, double x) {
  const int32_t place = mpmi_anchor(b->grid, k, x) - b->coord[block][k] * b->edge + MPMI_RING;
  const int32_t last = b->edge + 2 * MPMI_RING - 1;
  return place < 0 ? 0 : place > last ? last : place;
}

/* Narrows the cover of a block along an axis to its particles and a drift: of reference positions, which stay
 * where they are, to what rounding may make of it. */
static void narrow(const mpmi_layout *layout, int64_t block, int32_t k, mpmi_cover *cover) {
  const mpmi_blocks *b = &layout->blocks;
  const mpm_grid *grid = b->grid;
  const double h = grid->desc.spacing[k], hair = 1e-6 * h;
  const double drift = mpmi_is_total_lagrangian(grid) ? hair : MPMI_COVER_DRIFT * h;
  const double tile_low = cover->centre[k] - cover->half[k], tile_high = cover->centre[k] + cover->half[k];
  double low = (double)INFINITY, high = (double)-INFINITY;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpm_particles *set = layout->member[m].set;
    const int64_t *start = layout->member[m].now.start;
    if (start[block + 1] > start[block])
      widen(mpmi_places(set, 0) + k * set->ld + start[block], start[block + 1] - start[block], &low, &high);
  }
  low = low - drift > tile_low ? low - drift : tile_low;
  high = high + drift < tile_high ? high + drift : tile_high;
  if (!(low < high))
    low = tile_low, high = tile_high; /* spoilt positions: they are reported where they count */
  cover->centre[k] = 0.5 * (low + high);
  cover->half[k] = 0.5 * (high - low) * (1.0 - 1e-9); /* never beyond the tile */
  cover->low[k] = low > grid->desc.origin[k] ? low : grid->desc.origin[k];
  cover->high[k] = high < grid->upper[k] ? high : grid->upper[k];
  cover->nodes.low[k] = (uint8_t)first_place(b, block, k, low - hair);
  cover->nodes.high[k] = (uint8_t)(first_place(b, block, k, high + hair) + grid->width);
}

static void find_cover(mpmi_layout *layout, int64_t block) {
  mpmi_blocks *b = &layout->blocks;
  mpmi_cover *cover = &b->cover[block];
  mpmi_tile_bounds(b, block, cover->centre, cover->half);
  for (int32_t k = 0; k < b->grid->dim; ++k) {
    if (!b->grid->desc.periodic[k]) {
      narrow(layout, block, k, cover);
      continue;
    }
    cover->low[k] = (double)-INFINITY;
    cover->high[k] = (double)INFINITY;
    cover->nodes.low[k] = 0;
    cover->nodes.high[k] = (uint8_t)MPMI_TILE_EDGE(b->grid->dim, b->grid->width);
  }
}

/* ---- which nodes they meet ---------------------------------------------------------------------------- */
static void reach_from(mpmi_blocks *b, int64_t block) {
  const mpmi_spans spans = mpmi_spans_of(b, block);
  for (int32_t n = 0; n < b->neighbours; ++n) {
    mpmi_node_box *r = &b->reached[b->neighbour[block][n]];
    const mpmi_span *at[3] = {&spans.at[0][n / 9], &spans.at[1][n / 3 % 3], &spans.at[2][n % 3]};
    if (!at[0]->length || !at[1]->length || !at[2]->length) continue;
    for (int32_t k = 0; k < 3; ++k) {
      const int32_t high = at[k]->block + at[k]->length;
      if (at[k]->block < r->low[k]) r->low[k] = (uint8_t)at[k]->block;
      if (high > r->high[k]) r->high[k] = (uint8_t)high;
    }
  }
}

/* The box of nodes that are met in the block of a node, and the place of that node in the block. */
typedef struct met_place {
  mpmi_node_box *box;
  int32_t at[3];
} met_place;

static met_place place_of(const mpmi_blocks *b, int64_t slot) {
  const int32_t edge_y = b->grid->dim >= 2 ? b->edge : 1, n = (int32_t)(slot % b->nodes);
  return (met_place){&b->reached[slot / b->nodes], {n / b->edge / edge_y, n / b->edge % edge_y, n % b->edge}};
}

static int32_t is_met(const mpmi_blocks *b, int64_t slot) {
  const met_place p = place_of(b, slot);
  int32_t met = 1;
  for (int32_t k = 0; k < 3; ++k) met &= p.at[k] >= p.box->low[k] && p.at[k] < p.box->high[k];
  return met;
}

static void meet(const mpmi_blocks *b, int64_t slot) {
  const met_place p = place_of(b, slot);
  for (int32_t k = 0; k < 3; ++k) {
    if (p.at[k] < p.box->low[k]) p.box->low[k] = (uint8_t)p.at[k];
    if (p.at[k] >= p.box->high[k]) p.box->high[k] = (uint8_t)(p.at[k] + 1);
  }
}

/* Lists the ties of which a node is met, and then counts all their nodes among those that are: masters have
 * what is given to followers, and the other way round. */
static void meet_ties(mpmi_layout *layout) {
  const mpmi_blocks *b = &layout->blocks;
  const mpmi_constraints *c = &layout->constraints;
  layout->met_count = 0;
  for (int64_t i = 0; i < c->tie_count; ++i) {
    const mpmi_tie *tie = &c->tie[i];
    int32_t met = is_met(b, tie->master);
    for (int64_t d = 0; d < tie->count && !met; ++d) met = is_met(b, c->follower[tie->first + d].slot);
    if (met) layout->met[layout->met_count++] = (int32_t)i;
  }
  for (int64_t i = 0; i < layout->met_count; ++i) {
    const mpmi_tie *tie = &c->tie[layout->met[i]];
    meet(b, tie->master);
    for (int64_t d = 0; d < tie->count; ++d) meet(b, c->follower[tie->first + d].slot);
  }
}

static mpmi_node_box whole_tile(const mpm_grid *grid) {
  mpmi_node_box box = {{0, 0, 0}, {1, 1, 1}};
  for (int32_t k = 0; k < grid->dim; ++k) box.high[k] = (uint8_t)MPMI_TILE_EDGE(grid->dim, grid->width);
  return box;
}

mpm_status mpmi_layout_cover(mpmi_layout *layout) {
  mpmi_blocks *b = &layout->blocks;
  const mpmi_worklist *list = &layout->worklist[0];
  const mpm_status status =
      MPMI_RESERVE_MORE(b->context, layout->met, layout->met_capacity, layout->constraints.tie_count);
  if (status) return status;
  for (int64_t i = 0; i < b->count; ++i) b->reached[i] = (mpmi_node_box){{255, 255, 255}, {0, 0, 0}};
  for (int64_t i = 0; i < list->count; ++i) {
    find_cover(layout, list->block[i]);
    reach_from(b, list->block[i]);
  }
  for (int64_t i = 0; layout->parts && i < layout->parts->ghost_count; ++i) {
    const int64_t ghost = layout->parts->ghost[i].block;
    b->cover[ghost].nodes = whole_tile(b->grid);
    reach_from(b, ghost);
  }
  meet_ties(layout);
  layout->cover_is_old = 0;
  ++layout->covers;
  return MPM_OK;
}

void mpmi_reached_runs(const mpmi_blocks *b, int64_t begin, int64_t end, mpmi_run_fn fn, void *user) {
  const int32_t edge_y = b->grid->dim >= 2 ? b->edge : 1, edge_z = b->edge;
  int64_t slot = 0, run = 0;
  for (int64_t block = begin; block < end; ++block) {
    const mpmi_node_box *r = &b->reached[block];
    const int64_t length = r->high[2] - r->low[2];
    for (int32_t x = r->low[0]; x < r->high[0]; ++x)
      for (int32_t y = r->low[1]; y < r->high[1]; ++y) {
        const int64_t first = block * b->nodes + ((int64_t)x * edge_y + y) * edge_z + r->low[2];
        if (run && first == slot + run) {
          run += length;
          continue;
        }
        if (run) fn(user, slot, run);
        slot = first, run = length;
      }
  }
  if (run) fn(user, slot, run);
}
