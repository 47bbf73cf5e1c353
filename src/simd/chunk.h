/* How many particles kernels take at a time. Longer chunks would push a block's nodes out of the first-level
 * cache; a chunk fills whole registers of every instruction set. */
#ifndef MPMI_CHUNK_H
#define MPMI_CHUNK_H

#include <stdint.h>

#include "simd/isa.h"

enum { MPMI_CHUNK = 16 };

/* Arrays of particles hold whole chunks, so that this is n; saying so lets the compiler drop remainders. */
MPMI_INLINE int64_t mpmi_whole_chunks(int64_t n) {
  return n & ~(int64_t)(MPMI_CHUNK - 1);
}

#endif
