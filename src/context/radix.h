/* Stable sorting of integer keys. */
#ifndef MPMI_RADIX_H
#define MPMI_RADIX_H

#include <stdint.h>

/* Finds the stable ascending order of n keys: order[i] becomes the place of the i-th smallest. All arrays
 * have n entries; key and key_scratch are used up. */
void mpmi_radix_sort(int64_t n, uint64_t *key, uint32_t *order, uint64_t *key_scratch,
                     uint32_t *order_scratch);

#endif
