/* Four doubles that belong to one node or one particle, in whole registers of the instruction set. */
#ifndef MPMI_VECTOR4_H
#define MPMI_VECTOR4_H

#include "transfer/isa.h"

#if defined(__AVX__)
typedef double mpmi_v4 __attribute__((vector_size(32)));

MPMI_INLINE mpmi_v4 mpmi_zero4(void) {
  return (mpmi_v4){0.0, 0.0, 0.0, 0.0};
}
MPMI_INLINE mpmi_v4 mpmi_load4(const double *a) {
  mpmi_v4 r;
  __builtin_memcpy(&r, a, sizeof r);
  return r;
}
MPMI_INLINE void mpmi_store4(double *a, mpmi_v4 v) {
  __builtin_memcpy(a, &v, sizeof v);
}
MPMI_INLINE mpmi_v4 mpmi_scale4(double s, mpmi_v4 v) {
  return s * v;
}
MPMI_INLINE mpmi_v4 mpmi_add4(mpmi_v4 a, double s, mpmi_v4 v) {
  return a + s * v;
}
MPMI_INLINE void mpmi_transpose4(mpmi_v4 *a, mpmi_v4 *b, mpmi_v4 *c, mpmi_v4 *d) {
  mpmi_v4 ab_even = __builtin_shufflevector(*a, *b, 0, 4, 2, 6),
          ab_odd = __builtin_shufflevector(*a, *b, 1, 5, 3, 7);
  mpmi_v4 cd_even = __builtin_shufflevector(*c, *d, 0, 4, 2, 6),
          cd_odd = __builtin_shufflevector(*c, *d, 1, 5, 3, 7);
  *a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  *b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  *c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  *d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

#else
/* 128-bit registers: compilers split wider vectors badly, so they come in two halves. */
typedef double mpmi_v2 __attribute__((vector_size(16)));
typedef struct mpmi_v4 {
  mpmi_v2 low, high;
} mpmi_v4;

MPMI_INLINE mpmi_v4 mpmi_zero4(void) {
  return (mpmi_v4){{0.0, 0.0}, {0.0, 0.0}};
}
MPMI_INLINE mpmi_v4 mpmi_load4(const double *a) {
  mpmi_v4 r;
  __builtin_memcpy(&r.low, a, sizeof r.low);
  __builtin_memcpy(&r.high, a + 2, sizeof r.high);
  return r;
}
MPMI_INLINE void mpmi_store4(double *a, mpmi_v4 v) {
  __builtin_memcpy(a, &v.low, sizeof v.low);
  __builtin_memcpy(a + 2, &v.high, sizeof v.high);
}
MPMI_INLINE mpmi_v4 mpmi_scale4(double s, mpmi_v4 v) {
  return (mpmi_v4){s * v.low, s * v.high};
}
MPMI_INLINE mpmi_v4 mpmi_add4(mpmi_v4 a, double s, mpmi_v4 v) {
  return (mpmi_v4){a.low + s * v.low, a.high + s * v.high};
}
MPMI_INLINE void mpmi_transpose4(mpmi_v4 *a, mpmi_v4 *b, mpmi_v4 *c, mpmi_v4 *d) {
  const mpmi_v4 ta = *a, tb = *b, tc = *c, td = *d;
  a->low = __builtin_shufflevector(ta.low, tb.low, 0, 2);
  a->high = __builtin_shufflevector(tc.low, td.low, 0, 2);
  b->low = __builtin_shufflevector(ta.low, tb.low, 1, 3);
  b->high = __builtin_shufflevector(tc.low, td.low, 1, 3);
  c->low = __builtin_shufflevector(ta.high, tb.high, 0, 2);
  c->high = __builtin_shufflevector(tc.high, td.high, 0, 2);
  d->low = __builtin_shufflevector(ta.high, tb.high, 1, 3);
  d->high = __builtin_shufflevector(tc.high, td.high, 1, 3);
}
#endif

#endif
