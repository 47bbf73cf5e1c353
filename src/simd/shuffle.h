/* Lanes of two vectors in another order: MPMI_SHUFFLE(a, b, k, ...) takes lane k of a, or of b from a's count
 * on. As many come out as a has. */
#ifndef MPMI_SHUFFLE_H
#define MPMI_SHUFFLE_H

#include <stdint.h>

#include "simd/isa.h"

#if defined(__clang__) || __GNUC__ >= 12
#define MPMI_SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)
#else
#define MPMI_SHUFFLE(a, b, ...)                                                                              \
  __builtin_shuffle(a, b, (int64_t __attribute__((vector_size(sizeof(a))))){__VA_ARGS__})
#endif

#endif
