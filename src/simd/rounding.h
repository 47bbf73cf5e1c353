/* Rounding to integers. What needs no instruction of its own, so that every instruction set can vectorise it,
 * is right for |x| < 2^51. */
#ifndef MPMI_ROUNDING_H
#define MPMI_ROUNDING_H

#include "simd/lanes.h"

/* 1.5 * 2^52: a sum with it keeps no digits behind the point. */
#define MPMI_ROUNDING_SHIFT 6755399441055744.0

/* The nearest integer, for |x| < 2^51. */
MPMI_INLINE double mpmi_round(double x) {
  return (x + MPMI_ROUNDING_SHIFT) - MPMI_ROUNDING_SHIFT;
}
MPMI_INLINE mpmi_lanes mpmi_lanes_round(mpmi_lanes v) {
  return (v + MPMI_ROUNDING_SHIFT) - MPMI_ROUNDING_SHIFT;
}

/* A number that is off by no more than this from half-way between two integers counts as lying there. */
#define MPMI_HAIR 1e-10

/* Of the two integers beside a number half-way between them these return the even one, whatever was
 * contracted on the way to the number, and else the nearest one; f is the number less the nearest one. */
MPMI_INLINE double mpmi_even_of(double nearest, double f) {
  const double half = 0.5 * nearest, away = f < 0.0 ? -f : f;
  if (away < 0.5 - MPMI_HAIR || half == mpmi_round(half)) return nearest;
  return nearest + (f < 0.0 ? -1.0 : 1.0);
}
MPMI_INLINE mpmi_lanes mpmi_lanes_even_of(mpmi_lanes nearest, mpmi_lanes f) {
  const mpmi_lanes zero = {0.0}, half = 0.5 * nearest;
  const mpmi_lanes beyond = nearest + mpmi_lanes_select(f < 0.0, zero - 1.0, zero + 1.0);
  const mpmi_mask stays = (mpmi_lanes_abs(f) < 0.5 - MPMI_HAIR) | (half == mpmi_lanes_round(half));
  return mpmi_lanes_select(stays, nearest, beyond);
}

/* x as a double of its own: where it is a product, no sum around it becomes a fused multiply-add. */
MPMI_INLINE double mpmi_rounded(double x) {
  volatile double rounded = x;
  return rounded;
}

MPMI_INLINE double mpmi_floor(double x) {
  double r = mpmi_round(x);
  return r > x ? r - 1.0 : r;
}
MPMI_INLINE mpmi_lanes mpmi_lanes_floor(mpmi_lanes v) {
#if defined(__AVX512F__) && MPMI_WIDTH == 8
  return _mm512_floor_pd(v);
#elif defined(__AVX2__) && MPMI_WIDTH == 4
  return _mm256_floor_pd(v);
#else
  const mpmi_lanes r = mpmi_lanes_round(v);
  return mpmi_lanes_select(r > v, r - 1.0, r);
#endif
}

#endif
