/* Checksums and hashes mix 64-bit words with these functions. */
#ifndef MPMI_MIX_H
#define MPMI_MIX_H

#include <stdint.h>

#define MPMI_MIX_A UINT64_C(0x9e3779b97f4a7c15)
#define MPMI_MIX_B UINT64_C(0xbf58476d1ce4e5b9)
#define MPMI_MIX_C UINT64_C(0x94d049bb133111eb)

static inline uint64_t mpmi_rotate(uint64_t x, int32_t k) {
  return x << k | x >> (64 - k);
}

/* This is one to one, and every bit of the result depends on every bit of x. */
static inline uint64_t mpmi_avalanche(uint64_t x) {
  x = (x ^ x >> 30) * MPMI_MIX_B;
  x = (x ^ x >> 27) * MPMI_MIX_C;
  return x ^ x >> 31;
}

/* Takes one more word into a hash of several. */
static inline uint64_t mpmi_absorb(uint64_t h, uint64_t word) {
  h = (h ^ word) * MPMI_MIX_A;
  return h ^ h >> 29;
}

#endif
