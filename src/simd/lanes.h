/* Particles side by side in one register of the instruction set: for loops that end in sums, maxima or flags,
 * which compilers do not vectorise without being told to reorder. A sum over lanes has one order, so that
 * results depend on the instruction set and on nothing else. */
#ifndef MPMI_LANES_H
#define MPMI_LANES_H

#include <stdint.h>
#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "simd/isa.h"

enum { MPMI_LANES = MPMI_WIDTH };
typedef double mpmi_lanes __attribute__((vector_size(MPMI_LANES * 8)));
typedef int64_t mpmi_mask __attribute__((vector_size(MPMI_LANES * 8)));

MPMI_INLINE mpmi_lanes mpmi_lanes_load(const double *a) {
  mpmi_lanes r;
  __builtin_memcpy(&r, a, sizeof r);
  return r;
}
MPMI_INLINE void mpmi_lanes_store(double *a, mpmi_lanes v) {
  __builtin_memcpy(a, &v, sizeof v);
}
/* v where the mask is set, else 0; also where v is not a number. */
MPMI_INLINE mpmi_lanes mpmi_lanes_where(mpmi_mask mask, mpmi_lanes v) {
  return (mpmi_lanes)((mpmi_mask)v & mask);
}
MPMI_INLINE mpmi_lanes mpmi_lanes_abs(mpmi_lanes v) {
  return (mpmi_lanes)((mpmi_mask)v & INT64_MAX);
}
/* a where the mask is set, else b. */
MPMI_INLINE mpmi_lanes mpmi_lanes_select(mpmi_mask mask, mpmi_lanes a, mpmi_lanes b) {
  return (mpmi_lanes)(((mpmi_mask)a & mask) | ((mpmi_mask)b & ~mask));
}
/* The larger and the smaller one; a when b is not a number. Compilers see the one instruction that this is on
 * x86 only where it is named. */
#if defined(__AVX512F__) && MPMI_WIDTH == 8
#define MPMI_LARGER(a, b)  _mm512_max_pd(b, a)
#define MPMI_SMALLER(a, b) _mm512_min_pd(b, a)
#elif defined(__AVX2__) && MPMI_WIDTH == 4
#define MPMI_LARGER(a, b)  _mm256_max_pd(b, a)
#define MPMI_SMALLER(a, b) _mm256_min_pd(b, a)
#elif defined(__SSE2__)
#define MPMI_LARGER(a, b)  _mm_max_pd(b, a)
#define MPMI_SMALLER(a, b) _mm_min_pd(b, a)
#else
#define MPMI_LARGER(a, b)  mpmi_lanes_select((b) > (a), b, a)
#define MPMI_SMALLER(a, b) mpmi_lanes_select((b) < (a), b, a)
#endif
MPMI_INLINE mpmi_lanes mpmi_lanes_max(mpmi_lanes a, mpmi_lanes b) {
  return MPMI_LARGER(a, b);
}
MPMI_INLINE mpmi_lanes mpmi_lanes_min(mpmi_lanes a, mpmi_lanes b) {
  return MPMI_SMALLER(a, b);
}
MPMI_INLINE void mpmi_lanes_store_int32(int32_t *a, mpmi_lanes v) {
  typedef int32_t integers __attribute__((vector_size(MPMI_LANES * 4)));
  const integers r = __builtin_convertvector(v, integers);
  __builtin_memcpy(a, &r, sizeof r);
}
MPMI_INLINE double mpmi_lanes_sum(mpmi_lanes v) {
  double sum = v[0];
  for (int32_t i = 1; i < MPMI_LANES; ++i) sum += v[i];
  return sum;
}
MPMI_INLINE double mpmi_lanes_largest(mpmi_lanes v) {
  double largest = v[0];
  for (int32_t i = 1; i < MPMI_LANES; ++i) largest = v[i] > largest ? v[i] : largest;
  return largest;
}
MPMI_INLINE double mpmi_lanes_smallest(mpmi_lanes v) {
  double smallest = v[0];
  for (int32_t i = 1; i < MPMI_LANES; ++i) smallest = v[i] < smallest ? v[i] : smallest;
  return smallest;
}
MPMI_INLINE mpmi_lanes mpmi_lanes_sqrt(mpmi_lanes v) {
  for (int32_t i = 0; i < MPMI_LANES; ++i) v[i] = __builtin_sqrt(v[i]);
  return v;
}
/* Returns the flag where a bit of the mask is set, else 0. */
#if defined(__AVX512F__) && MPMI_WIDTH == 8
#define MPMI_ANY(mask) (_mm512_test_epi64_mask((__m512i)(mask), (__m512i)(mask)) != 0)
#elif defined(__AVX2__) && MPMI_WIDTH == 4
#define MPMI_ANY(mask) (!_mm256_testz_si256((__m256i)(mask), (__m256i)(mask)))
#else
_Static_assert(MPMI_LANES == 2, "other registers have more lanes to look at");
#define MPMI_ANY(mask) (((mask)[0] | (mask)[1]) != 0)
#endif
MPMI_INLINE uint32_t mpmi_lanes_any(mpmi_mask mask, uint32_t flag) {
  return MPMI_ANY(mask) ? flag : 0u;
}

#endif
