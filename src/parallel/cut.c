/* Every part has the blocks of one range of Morton keys, so that all parts together have the order of one. */
#include "parallel/parts.h"

#include <string.h>

/* What the library does where the host has set no limit: the imbalance at which a cut is looked for; how many
 * of its steps it costs to move a particle, eight by the copies alone; and how much larger the imbalance must
 * be for a cut to be looked for before it is time. */
static const double usual_limit = 1.1, move_steps = 10.0, grows = 1.1;

int32_t mpmi_cut_owner(const mpmi_parts *parts, uint64_t key) {
  int32_t low = 0, high = mpmi_part_count(parts);
  while (high - low > 1) {
    const int32_t middle = (low + high) / 2;
    if (parts->first[middle] <= key)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/* Adds the weights of the blocks with keys below those of `bound`, which ascend, for each of them. */
static void weigh_below(const mpmi_blocks *blocks, const int64_t *weight, int64_t count,
                        const uint64_t *bound, int64_t *below) {
  memset(below, 0, (size_t)count * sizeof *below);
  for (int64_t i = 0; i < blocks->count; ++i) {
    int64_t low = 0, high = count; /* the first bound above the key */
    while (low < high) {
      const int64_t middle = (low + high) / 2;
      if (bound[middle] > blocks->key[i])
        high = middle;
      else
        low = middle + 1;
    }
    if (low < count) below[low] += weight[i];
  }
  for (int64_t r = 1; r < count; ++r) below[r] += below[r - 1];
}

/* Finds the ranges by bisection: part r + 1 begins at low[r], where the weight before it is r + 1 / parts of
 * the total. */
static mpm_status bisect(mpmi_parts *parts, const mpmi_blocks *blocks, const int64_t *weight, double total,
                         uint64_t top, uint64_t *low, uint64_t *high, uint64_t *middle) {
  const int32_t count = mpmi_part_count(parts);
  int64_t *below = parts->owner_count;
  for (int32_t r = 0; r < count - 1; ++r) low[r] = 0, high[r] = top;
  for (int32_t open = 1; open;) {
    open = 0;
    for (int32_t r = 0; r < count - 1; ++r) middle[r] = low[r] + (high[r] - low[r]) / 2;
    weigh_below(blocks, weight, count - 1, middle, below);
    const mpm_status status = mpmi_reduce_parts(parts->context, MPM_REDUCE_SUM, count - 1, below);
    if (status) return status;
    for (int32_t r = 0; r < count - 1; ++r) {
      if (high[r] - low[r] > 1) {
        if ((double)below[r] <= total * (r + 1) / count)
          low[r] = middle[r];
        else
          high[r] = middle[r];
      }
      open |= high[r] - low[r] > 1;
    }
  }
  return MPM_OK;
}

static void adopt(mpmi_parts *parts, const uint64_t *low) {
  const int32_t count = mpmi_part_count(parts);
  for (int32_t r = 1; r < count; ++r) parts->first[r] = low[r - 1];
  parts->first[0] = 0;
  parts->first[count] = UINT64_MAX;
}

/* Whether the steps since the last cut would have gained more with the next one than the particles cost that
 * it moves: what has been lost stands for what would be. If not, it is said after how many steps they would,
 * but no more than twice as many, because all may be different then. The parts have the ranges of the next
 * cut, `present` those of the last. */
static mpm_status pays(mpmi_parts *parts, const mpmi_blocks *blocks, const int64_t *weight,
                       const uint64_t *present, int64_t largest, int64_t steps, int32_t *so) {
  const int32_t count = mpmi_part_count(parts);
  int64_t *next = parts->owner_count, leaves = 0, largest_next = 0;
  memset(next, 0, (size_t)count * sizeof *next);
  for (int64_t i = 0; i < blocks->count; ++i) {
    const int32_t owner = mpmi_cut_owner(parts, blocks->key[i]);
    next[owner] += weight[i];
    if (blocks->key[i] < present[owner] || blocks->key[i] >= present[owner + 1]) leaves += weight[i];
  }
  mpm_status status = mpmi_reduce_parts(parts->context, MPM_REDUCE_SUM, count, next);
  if (!status) status = mpmi_reduce_parts(parts->context, MPM_REDUCE_MAX, 1, &leaves);
  for (int32_t r = 0; r < count; ++r) largest_next = next[r] > largest_next ? next[r] : largest_next;
  const double gain = (double)(largest - largest_next), cost = move_steps * (double)leaves;
  *so = gain * (double)steps > cost;
  parts->look_again = gain * 2.0 * (double)steps > cost ? (int64_t)(cost / gain) + 1 : 2 * steps;
  parts->refused = parts->info.imbalance;
  return status;
}

mpm_status mpmi_cut_blocks(mpmi_parts *parts, const mpmi_blocks *blocks, const int64_t *weight) {
  mpm_context *c = parts->context;
  const int64_t count = mpmi_part_count(parts);
  int64_t largest[3] = {0, 0, parts->steps}, total = 0; /* of the weights by part; of the keys; steps */
  mpm_status status;
  for (int64_t i = 0; i < blocks->count; ++i) {
    total += weight[i];
    if ((int64_t)blocks->key[i] > largest[1]) largest[1] = (int64_t)blocks->key[i];
  }
  largest[0] = total;
  if ((status = mpmi_reduce_parts(c, MPM_REDUCE_MAX, 3, largest)) ||
      (status = mpmi_reduce_parts(c, MPM_REDUCE_SUM, 1, &total)))
    return status;
  parts->is_empty = total == 0;
  parts->info.imbalance = total > 0 ? (double)largest[0] * (double)count / (double)total : 1.0;
  const int32_t is_usual = !(parts->balance.limit > 0.0);
  if (parts->is_cut && parts->info.imbalance <= (is_usual ? usual_limit : parts->balance.limit))
    return MPM_OK;
  if (parts->is_cut && is_usual && largest[2] < parts->look_again &&
      parts->info.imbalance < grows * parts->refused)
    return MPM_OK;
  const size_t bytes = mpmi_bytes(4 * count + 1, sizeof(uint64_t));
  uint64_t *low = mpmi_alloc(c, bytes), *present = low ? low + 3 * count : NULL;
  int32_t is_next = 1;
  if ((status = mpmi_agree(c, low ? MPM_OK : MPM_E_NOMEM))) {
    mpmi_free(c, low, bytes);
    return status;
  }
  status = bisect(parts, blocks, weight, (double)total, (uint64_t)largest[1] + 1, low, low + count,
                  low + 2 * count);
  if (!status) {
    memcpy(present, parts->first, ((size_t)count + 1) * sizeof *present);
    adopt(parts, low);
    if (parts->is_cut && is_usual)
      status = pays(parts, blocks, weight, present, largest[0], largest[2], &is_next);
    if (status || !is_next) memcpy(parts->first, present, ((size_t)count + 1) * sizeof *present);
  }
  mpmi_free(c, low, bytes);
  if (status || !is_next) return status;
  parts->is_cut = 1;
  ++parts->info.cuts;
  parts->steps = parts->look_again = 0;
  mpmi_time_reset(parts);
  return MPM_OK;
}
