/* Elementary functions that the compiler can vectorise on every instruction set: no branches, no calls, and
 * integers used as bit patterns only. Arguments outside the domain give meaningless values but never trap. */
#ifndef MPMI_VECTOR_MATH_H
#define MPMI_VECTOR_MATH_H

#include <stdint.h>
#include <string.h>

#include "simd/rounding.h"

#define MPMI_ONE_BITS       UINT64_C(0x3ff0000000000000)
#define MPMI_SQRT_HALF_BITS UINT64_C(0x3fe6a09e667f3bcd)
#define MPMI_MANTISSA_BITS  UINT64_C(0x000fffffffffffff)

/* 42 bits of ln 2, so that their product with an exponent is exact, and the rest. */
#define MPMI_LN2_HIGH 0x1.62e42fefa3800p-1
#define MPMI_LN2_LOW  5.497923018708371e-14
#define MPMI_LOG2_E   1.4426950408889634

MPMI_INLINE uint64_t mpmi_bits_of(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

MPMI_INLINE double mpmi_from_bits(uint64_t bits) {
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

MPMI_INLINE double mpmi_max(double a, double b) {
  return a > b ? a : b;
}

MPMI_INLINE double mpmi_min(double a, double b) {
  return a < b ? a : b;
}

/* 2 artanh(s) / s - 2 for z = s^2 up to MPMI_LOG_SERIES_END: a minimax polynomial, of relative error 1.3e-18
 * with the 2. */
#define MPMI_LOG_SERIES_END 0.0295
MPMI_INLINE double mpmi_log_series(double z) {
  const double w = z * z;
  const double even = w * (0.3999999999941487 + w * (0.2222219857624919 + w * 0.15314053867034655));
  const double odd = z * (0.6666666666666734 +
                          w * (0.2857142874235307 + w * (0.18183564183964648 + w * 0.14795919028641485)));
  return even + odd;
}

/* k ln 2 + log(1 + f) for |f| < 0.42: with s = f / (2 + f), log(1 + f) = 2 artanh s = f - f^2/2 + s (f^2/2 +
 * R), R of mpmi_log_series(). */
MPMI_INLINE double mpmi_log_reduced(double k, double f) {
  double s = f / (2.0 + f);
  double half_square = 0.5 * f * f;
  return k * MPMI_LN2_HIGH -
         ((half_square - (s * (half_square + mpmi_log_series(s * s)) + k * MPMI_LN2_LOW)) - f);
}

/* x = 2^k (1 + f) with 1 + f in [sqrt(1/2), sqrt(2)). The biased exponent becomes a double by way of the bits
 * of 2^52 + exponent, because AVX2 cannot convert 64-bit integers. */
typedef struct mpmi_binade {
  double k, f;
} mpmi_binade;

MPMI_INLINE mpmi_binade mpmi_split_binade(double x) {
  mpmi_binade r;
  uint64_t shifted = mpmi_bits_of(x) + (MPMI_ONE_BITS - MPMI_SQRT_HALF_BITS);
  r.k = mpmi_from_bits((shifted >> 52) | UINT64_C(0x4330000000000000)) - (4503599627370496.0 + 1023.0);
  r.f = mpmi_from_bits((shifted & MPMI_MANTISSA_BITS) + MPMI_SQRT_HALF_BITS) - 1.0;
  return r;
}

/* Natural logarithm of a normal x > 0. */
MPMI_INLINE double mpmi_lane_log(double x) {
  mpmi_binade b = mpmi_split_binade(x);
  return mpmi_log_reduced(b.k, b.f);
}

/* log(1 + x) for x > -1. Only where k = 0 does it matter what rounding 1 + x loses. */
MPMI_INLINE double mpmi_lane_log1p(double x) {
  mpmi_binade b = mpmi_split_binade(1.0 + x);
  return mpmi_log_reduced(b.k, b.k == 0.0 ? x : b.f);
}

/* (exp(r) - 1 - r) / r^2 for |r| <= ln 2 / 2: a minimax polynomial, with which exp(r) - 1 has relative error
 * 1.4e-18. */
MPMI_INLINE double mpmi_exp_series(double r) {
  const double z = r * r, w = z * z;
  const double low = (0.5 + r * 0.1666666666666667) + z * (0.04166666666666667 + r * 0.008333333333326136);
  const double middle = (0.0013888888888883748 + r * 0.00019841269874820627) +
                        z * (2.4801587325547743e-05 + r * 2.7557255400206422e-06);
  const double high = (2.75572736431103e-07 + r * 2.5105217004720745e-08) + z * 2.0914686968086876e-09;
  return low + w * (middle + w * high);
}

/* exp(x) = 2^k (1 + rest) with x = k ln 2 + r, rest = exp(r) - 1. k is read off the last bits of the mantissa
 * of 1.5 * 2^52 + k. Not finite from x = 709.4 on; a lesser x than the lowest is taken for that. */
typedef struct mpmi_power {
  double two_to_k, rest;
} mpmi_power;

MPMI_INLINE mpmi_power mpmi_split_power_within(double within) {
  double shifted = within * MPMI_LOG2_E + MPMI_ROUNDING_SHIFT, k = shifted - MPMI_ROUNDING_SHIFT;
  double r = (within - k * MPMI_LN2_HIGH) - k * MPMI_LN2_LOW;
  return (mpmi_power){mpmi_from_bits((mpmi_bits_of(shifted) + UINT64_C(1023)) << 52),
                      r + r * r * mpmi_exp_series(r)};
}

MPMI_INLINE mpmi_power mpmi_split_power(double x, double lowest) {
  return mpmi_split_power_within(x < lowest ? lowest : x > 710.0 ? 710.0 : x); /* keeps a NaN */
}

/* exp(x) for -700 <= x <= 700. */
MPMI_INLINE double mpmi_lane_exp_within(double x) {
  mpmi_power p = mpmi_split_power_within(x);
  return p.two_to_k + p.two_to_k * p.rest;
}

/* exp(x) for x >= -700. */
MPMI_INLINE double mpmi_lane_exp(double x) {
  mpmi_power p = mpmi_split_power(x, -700.0);
  return p.two_to_k + p.two_to_k * p.rest;
}

/* exp(x) - 1. */
MPMI_INLINE double mpmi_lane_expm1(double x) {
  mpmi_power p = mpmi_split_power(x, -80.0);
  return p.two_to_k * p.rest + (p.two_to_k - 1.0);
}

#endif
