/* Every part has the blocks of one range of Morton keys, so that all parts together have the order of one. */
#include "parallel/parts.h"

#include <string.h>

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

/* Finds the ranges by bisection: part r begins where the weight before it is r / parts of the total. */
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
  for (int32_t r = 1; r < count; ++r) parts->first[r] = low[r - 1];
  parts->first[0] = 0;
  parts->first[count] = UINT64_MAX;
  return MPM_OK;
}

mpm_status mpmi_cut_blocks(mpmi_parts *parts, const mpmi_blocks *blocks, const int64_t *weight) {
  mpm_context *c = parts->context;
  const int64_t count = mpmi_part_count(parts);
  int64_t largest[2] = {0, 0}, total = 0; /* of the weights by part; of the keys */
  mpm_status status;
  for (int64_t i = 0; i < blocks->count; ++i) {
    total += weight[i];
    if ((int64_t)blocks->key[i] > largest[1]) largest[1] = (int64_t)blocks->key[i];
  }
  largest[0] = total;
  if ((status = mpmi_reduce_parts(c, MPM_REDUCE_MAX, 2, largest)) ||
      (status = mpmi_reduce_parts(c, MPM_REDUCE_SUM, 1, &total)))
    return status;
  parts->is_empty = total == 0;
  parts->info.imbalance = total > 0 ? (double)largest[0] * (double)count / (double)total : 1.0;
  if (parts->is_cut && parts->info.imbalance <= parts->balance.limit) return MPM_OK;
  const size_t bytes = mpmi_bytes(3 * count, sizeof(uint64_t));
  uint64_t *scratch = mpmi_alloc(c, bytes);
  if ((status = mpmi_agree(c, scratch ? MPM_OK : MPM_E_NOMEM))) {
    mpmi_free(c, scratch, bytes);
    return status;
  }
  status = bisect(parts, blocks, weight, (double)total, (uint64_t)largest[1] + 1, scratch, scratch + count,
                  scratch + 2 * count);
  mpmi_free(c, scratch, bytes);
  if (status) return status;
  parts->is_cut = 1;
  ++parts->info.cuts;
  mpmi_time_reset(parts);
  return MPM_OK;
}
