/* Saved states are little-endian on every machine: words on their way into a file, or out of one. */
#ifndef MPMI_BYTE_ORDER_H
#define MPMI_BYTE_ORDER_H

#include <stdint.h>

enum { MPMI_BIG_ENDIAN = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ };

static inline uint64_t mpmi_little_64(uint64_t x) {
  return MPMI_BIG_ENDIAN ? __builtin_bswap64(x) : x;
}

static inline uint32_t mpmi_little_32(uint32_t x) {
  return MPMI_BIG_ENDIAN ? __builtin_bswap32(x) : x;
}

#endif
