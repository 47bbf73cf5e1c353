/* Sums of two doubles, high + low, where one would lose digits that the result needs. Exact in files that are
 * compiled without contraction; no fused multiply-add is asked for, which would be slow where it is
 * emulated. */
#ifndef MPMI_TWOFOLD_H
#define MPMI_TWOFOLD_H

#include "simd/isa.h"

typedef struct mpmi_twofold {
  double high, low;
} mpmi_twofold;

/* a + b for |a| >= |b|. */
MPMI_INLINE mpmi_twofold mpmi_ordered_sum(double a, double b) {
  const double high = a + b;
  return (mpmi_twofold){high, b - (high - a)};
}

/* a + b. */
MPMI_INLINE mpmi_twofold mpmi_exact_sum(double a, double b) {
  const double high = a + b, of_b = high - a;
  return (mpmi_twofold){high, (a - (high - of_b)) + (b - of_b)};
}

/* The upper 26 bits of a; 2^27 + 1 moves the others out. For |a| < 2^990. */
MPMI_INLINE double mpmi_upper_half(double a) {
  const double moved = 134217729.0 * a;
  return moved - (moved - a);
}

/* a b, from the products of halves, which are exact. */
MPMI_INLINE mpmi_twofold mpmi_exact_product(double a, double b) {
  const double high = a * b, a1 = mpmi_upper_half(a), b1 = mpmi_upper_half(b), a2 = a - a1, b2 = b - b1;
  return (mpmi_twofold){high, ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2};
}

/* a b to about 100 bits. */
MPMI_INLINE mpmi_twofold mpmi_twofold_product(mpmi_twofold a, mpmi_twofold b) {
  const mpmi_twofold p = mpmi_exact_product(a.high, b.high);
  return mpmi_ordered_sum(p.high, p.low + (a.high * b.low + a.low * b.high));
}

/* a / b to about 100 bits. */
MPMI_INLINE mpmi_twofold mpmi_twofold_quotient(mpmi_twofold a, mpmi_twofold b) {
  const double q = a.high / b.high;
  const mpmi_twofold back = mpmi_exact_product(q, b.high);
  return mpmi_ordered_sum(q, (((a.high - back.high) - back.low) + (a.low - q * b.low)) / b.high);
}

#endif
