/* A sort of several parts: whose particles are whose, and which nodes are shared. */
#include "parallel/migration.h"

#include <string.h>

static const double second_weight = 1e7;

/* Gives the blocks of this part the time that it has taken, in proportion to their weights. Seconds are no
 * particles: it is done on all parts that have blocks, or on none. */
static mpm_status weigh_by_time(mpmi_parts *parts, int64_t count, int64_t *weight) {
  int64_t total = 0;
  for (int64_t i = 0; i < count; ++i) total += weight[i];
  int64_t is_unknown = !parts->is_cut || (total > 0 && !(parts->busy > 0.0));
  const mpm_status status = mpmi_reduce_parts(parts->context, MPM_REDUCE_MAX, 1, &is_unknown);
  if (status || is_unknown) return status;
  const double share = total > 0 ? second_weight * parts->busy / (double)total : 0.0;
  for (int64_t i = 0; i < count; ++i) weight[i] = 1 + (int64_t)(share * (double)weight[i]);
  return MPM_OK;
}

static mpm_status weigh(mpmi_parts *parts, const mpmi_blocks *blocks, const mpmi_moving_set *sets,
                        int32_t count, int64_t *weight) {
  for (int64_t i = 0; i < blocks->count; ++i) weight[i] = mpmi_block_weight(parts);
  for (int32_t m = 0; m < count; ++m) {
    const uint32_t *block = mpmi_sort_blocks_of_slots(sets[m].set);
    const int64_t *id = mpmi_i64(sets[m].set, MPMI_ID, 0);
    for (int64_t s = 0; s < sets[m].set->slots; ++s)
      if (id[s] >= 0) weight[block[s]] += MPMI_PARTICLE_WEIGHT;
  }
  const mpm_status status = parts->balance.measure ? weigh_by_time(parts, blocks->count, weight) : MPM_OK;
  return status ? status : mpmi_cut_blocks(parts, blocks, weight);
}

/* Lists the bodies of the sets. */
static mpm_status list_bodies(mpmi_parts *parts, const mpmi_moving_set *sets, int32_t count) {
  mpm_status status = MPM_OK;
  parts->body_count = 0;
  for (int32_t m = 0; m < count && !status; ++m) status = mpmi_parts_note_body(parts, sets[m].body);
  return status;
}

mpm_status mpmi_share_out(mpmi_parts *parts, mpmi_blocks *blocks, mpmi_moving_set *sets, int32_t count,
                          mpm_status status, mpm_status (*insert)(void *user), void *user) {
  mpm_context *c = parts->context;
  const size_t bytes = mpmi_bytes(blocks->count + 1, sizeof(int64_t));
  int64_t *weight = status ? NULL : mpmi_alloc(c, bytes), moved = 0;
  parts->is_stale = 1;
  if (!status && !weight) status = MPM_E_NOMEM;
  if (!status) status = list_bodies(parts, sets, count);
  status = mpmi_agree(c, status);
  if (!status) status = weigh(parts, blocks, sets, count, weight);
  mpmi_free(c, weight, bytes);
  if (!status) status = mpmi_move_align_fields(parts, sets, count);
  if (!status) status = mpmi_move_particles(parts, blocks, sets, count, &moved);
  if (status) return status;
  if (moved) status = insert(user);
  return mpmi_pattern_find(parts, blocks, status);
}

mpm_status mpmi_share_end(mpmi_parts *parts, const mpmi_blocks *blocks, const mpmi_moving_set *sets,
                          int32_t count, mpm_status status) {
  if (!status) status = mpmi_pattern_adopt(parts, blocks);
  status = mpmi_agree(parts->context, status);
  for (int32_t m = 0; m < count && status && sets; ++m) mpmi_sort_settle(sets[m].set, sets[m].sorting);
  if (status) return status;
  for (int32_t m = 0; m < count && !status; ++m) {
    int64_t heaviest = mpmi_ordered_bits(sets[m].set->mass_max);
    status = mpmi_reduce_parts(parts->context, MPM_REDUCE_MAX, 1, &heaviest);
    if (!status) sets[m].set->mass_max = mpmi_of_ordered_bits(heaviest);
  }
  if (!status) parts->is_stale = parts->is_empty; /* one part sorts, too, until it has blocks */
  return status;
}

mpm_status mpmi_share_nodes(mpmi_parts *parts, const mpmi_blocks *blocks, const mpmi_constraints *constraints,
                            int64_t version) {
  if (parts->version == version) return MPM_OK;
  mpm_status status = mpmi_pattern_nodes(parts, blocks, constraints);
  if (!status) status = mpmi_tiles_reserve(parts);
  if (!status) parts->version = version;
  return status;
}
