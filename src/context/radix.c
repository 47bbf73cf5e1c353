/* A stable radix sort from the least significant digit on. It compares nothing and uses no memory but the
 * caller's. */
#include <string.h>

#include "context/radix.h"

enum { DIGITS = 8, RADIX = 256 };

static unsigned digit(uint64_t key, int32_t d) {
  return (unsigned)(key >> 8 * d) & (RADIX - 1);
}

void mpmi_radix_sort(int64_t n, uint64_t *key, uint32_t *order, uint64_t *key_scratch,
                     uint32_t *order_scratch) {
  int64_t start[DIGITS][RADIX] = {{0}};
  for (int64_t i = 0; i < n; ++i) {
    order[i] = (uint32_t)i;
    for (int32_t d = 0; d < DIGITS; ++d) start[d][digit(key[i], d)]++;
  }
  uint64_t *from_key = key, *to_key = key_scratch;
  uint32_t *from_order = order, *to_order = order_scratch;
  for (int32_t d = 0; d < DIGITS; ++d) {
    if (n == 0 || start[d][digit(key[0], d)] == n) continue; /* all keys have this digit in common */
    int64_t sum = 0;
    for (int32_t k = 0; k < RADIX; ++k) {
      int64_t here = start[d][k];
      start[d][k] = sum;
      sum += here;
    }
    for (int64_t i = 0; i < n; ++i) {
      int64_t to = start[d][digit(from_key[i], d)]++;
      to_key[to] = from_key[i];
      to_order[to] = from_order[i];
    }
    uint64_t *keys = from_key;
    from_key = to_key;
    to_key = keys;
    uint32_t *orders = from_order;
    from_order = to_order;
    to_order = orders;
  }
  if (from_order != order) memcpy(order, from_order, (size_t)n * sizeof *order);
}
