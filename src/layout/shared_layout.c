/* The sorted layout of several parts: whose particles are whose, and which nodes are shared. */
#include "layout/sorted_layout.h"
#include "layout/tile.h"
#include "parallel/migration.h"

#include <string.h>

/* A tile costs as much as so many particles. */
enum { BLOCK_WEIGHT = 60 };

static mpm_status weigh(mpmi_layout *layout, int64_t *weight) {
  const mpmi_blocks *blocks = &layout->next_blocks;
  for (int64_t i = 0; i < blocks->count; ++i) weight[i] = BLOCK_WEIGHT;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpm_particles *set = layout->member[m].set;
    const uint32_t *block = mpmi_sort_blocks_of_slots(set);
    const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
    for (int64_t s = 0; s < set->slots; ++s)
      if (id[s] >= 0) ++weight[block[s]];
  }
  return mpmi_cut_blocks(layout->parts, blocks, weight);
}

/* Moves particles to the parts that have their blocks. */
static mpm_status move(mpmi_layout *layout, int64_t *moved) {
  mpm_context *c = layout->parts->context;
  const int32_t count = layout->member_count;
  const size_t bytes = mpmi_bytes(count, sizeof(mpmi_moving_set));
  mpmi_moving_set *sets = mpmi_alloc(c, bytes);
  mpm_status status = mpmi_agree(c, sets ? MPM_OK : MPM_E_NOMEM);
  for (int32_t m = 0; m < count && !status; ++m)
    sets[m] = (mpmi_moving_set){layout->member[m].set, &layout->member[m].sorting, 0, 0, 0};
  if (!status) status = mpmi_move_align_fields(layout->parts, sets, count);
  if (!status) status = mpmi_move_particles(layout->parts, &layout->next_blocks, sets, count, moved);
  mpmi_free(c, sets, bytes);
  return status;
}

mpm_status mpmi_layout_share_out(mpmi_layout *layout, mpm_status status,
                                 mpm_status (*insert_blocks)(mpmi_layout *layout)) {
  mpmi_parts *parts = layout->parts;
  mpm_context *c = parts->context;
  const size_t bytes = mpmi_bytes(layout->next_blocks.count + 1, sizeof(int64_t));
  int64_t *weight = status ? NULL : mpmi_alloc(c, bytes), moved = 0;
  parts->is_stale = 1;
  if (!status && !weight) status = MPM_E_NOMEM;
  status = mpmi_agree(c, status);
  if (!status) status = weigh(layout, weight);
  mpmi_free(c, weight, bytes);
  if (!status) status = move(layout, &moved);
  if (status) return status;
  if (moved) status = insert_blocks(layout);
  return mpmi_pattern_find(parts, &layout->next_blocks, status);
}

mpm_status mpmi_layout_end_sort(mpmi_layout *layout, mpm_status status) {
  mpmi_parts *parts = layout->parts;
  if (!status) status = mpmi_pattern_adopt(parts, &layout->blocks);
  if ((status = mpmi_agree(parts->context, status))) return status;
  for (int32_t m = 0; m < layout->member_count && !status; ++m) {
    int64_t heaviest = mpmi_ordered_bits(layout->member[m].set->mass_max);
    status = mpmi_reduce_parts(parts->context, MPM_REDUCE_MAX, 1, &heaviest);
    if (!status) layout->member[m].set->mass_max = mpmi_of_ordered_bits(heaviest);
  }
  if (!status) parts->is_stale = 0;
  return status;
}

mpm_status mpmi_layout_share_nodes(mpmi_layout *layout, const mpmi_settings *settings) {
  mpmi_parts *parts = layout->parts;
  if (parts->version == layout->version) return MPM_OK;
  mpm_status status = mpmi_pattern_nodes(parts, &layout->blocks, &layout->constraints);
  if (!status) status = mpmi_tiles_reserve(parts, 8 * (int64_t)mpmi_tile_nodes(settings->grid));
  if (!status) parts->version = layout->version;
  return status;
}
