#include "layout/reached.h"
#include "transfer/weights.h"

void mpmi_spans(const mpm_grid *grid, int32_t edge, mpmi_span *out) {
  const int32_t low = MPMI_RING + grid->below, high = MPMI_RING + grid->width - 1 - grid->below;
  out[0] = (mpmi_span){0, edge - low, low};
  out[1] = (mpmi_span){low, 0, edge};
  out[2] = (mpmi_span){low + edge, 0, high};
}

void mpmi_tiles_reach(mpmi_blocks *b, const int32_t *block, int64_t count) {
  static const mpmi_span flat = {0, 0, 1}; /* an axis that the grid does not have */
  mpmi_span spans[3];
  mpmi_spans(b->grid, b->edge, spans);
  for (int64_t i = 0; i < b->count; ++i) b->reached[i] = (mpmi_reached){{255, 255, 255}, {0, 0, 0}};
  for (int64_t i = 0; i < count; ++i)
    for (int32_t n = 0; n < b->neighbours; ++n) {
      mpmi_reached *r = &b->reached[b->neighbour[block[i]][n]];
      const mpmi_span *at[3] = {b->grid->dim == 3 ? &spans[n / 9] : &flat,
                                b->grid->dim >= 2 ? &spans[n / 3 % 3] : &flat, &spans[n % 3]};
      for (int32_t k = 0; k < 3; ++k) {
        const int32_t high = at[k]->block + at[k]->length;
        if (at[k]->block < r->low[k]) r->low[k] = (uint8_t)at[k]->block;
        if (high > r->high[k]) r->high[k] = (uint8_t)high;
      }
    }
}

void mpmi_reached_runs(const mpmi_blocks *b, int64_t begin, int64_t end, mpmi_run_fn fn, void *user) {
  const int32_t edge_y = b->grid->dim >= 2 ? b->edge : 1, edge_z = b->edge;
  int64_t slot = 0, run = 0;
  for (int64_t block = begin; block < end; ++block) {
    const mpmi_reached *r = &b->reached[block];
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
