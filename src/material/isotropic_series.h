/* ln V and V^-1 for V V = I + e of a small or moderate symmetric 3x3 tensor e, and exp(e), by power series:
 * what isotropic_function.h and principal_frame.h find for any e from its eigenvalues, with neither roots nor
 * divisions. Powers above the second follow from the lower ones by the theorem of Cayley and Hamilton,
 * e^3 = tr(e) e^2 - II e + det(e) I. */
#ifndef MPMI_ISOTROPIC_SERIES_H
#define MPMI_ISOTROPIC_SERIES_H

#include "simd/tensor.h"

/* The largest sum of squares of an e that is small, 1/64^2: such are nearly all increments of steps. And that
 * of one that is moderate, 1/8^2: such are elastic strains, but for those of rubber. What the series leave
 * out is then less than 2^-54 of their sums. */
#define MPMI_SMALL_SQUARE    0x1p-12
#define MPMI_MODERATE_SQUARE 0x1p-6

/* e^2, and the invariants tr(e), II = 1/2 (tr(e)^2 - tr(e^2)) and det(e). */
typedef struct mpmi_powers {
  mpmi_sym square;
  double first, second, third;
} mpmi_powers;

MPMI_INLINE mpmi_powers mpmi_powers_of(mpmi_sym e) {
  double xy = e.xy * e.xy, yz = e.yz * e.yz, xz = e.xz * e.xz;
  mpmi_powers p = {{e.xx * e.xx + xy + xz, e.yy * e.yy + xy + yz, e.zz * e.zz + xz + yz,
                    e.xy * (e.xx + e.yy) + e.xz * e.yz, e.yz * (e.yy + e.zz) + e.xy * e.xz,
                    e.xz * (e.xx + e.zz) + e.xy * e.yz},
                   e.xx + e.yy + e.zz,
                   (e.xx * e.yy - xy) + (e.yy * e.zz - yz) + (e.xx * e.zz - xz),
                   e.xx * (e.yy * e.zz - yz) - e.zz * xy + e.xz * (2.0 * e.xy * e.yz - e.yy * e.xz)};
  return p;
}

/* one I + linear e + square e^2. */
typedef struct mpmi_polynomial {
  double one, linear, square;
} mpmi_polynomial;

/* Returns p e + next I. */
MPMI_INLINE mpmi_polynomial mpmi_times(mpmi_polynomial p, double next, const mpmi_powers *of) {
  mpmi_polynomial q = {next + of->third * p.square, p.one - of->second * p.square,
                       p.linear + of->first * p.square};
  return q;
}

MPMI_INLINE mpmi_sym mpmi_polynomial_at(mpmi_polynomial p, mpmi_sym e, mpmi_sym square) {
  mpmi_sym f = {
      p.one + p.linear * e.xx + p.square * square.xx, p.one + p.linear * e.yy + p.square * square.yy,
      p.one + p.linear * e.zz + p.square * square.zz, p.linear * e.xy + p.square * square.xy,
      p.linear * e.yz + p.square * square.yz,         p.linear * e.xz + p.square * square.xz};
  return f;
}

/* Terms are written out: a loop over them would keep the compiler from taking particles side by side. */

/* ln V = 1/2 (e - e^2 / 2 + e^3 / 3 - ...): the terms below the seventh power, after p of the others. */
MPMI_INLINE mpmi_sym mpmi_log_stretch_from(mpmi_polynomial p, mpmi_sym e, const mpmi_powers *of) {
  p = mpmi_times(p, -1.0 / 12.0, of);
  p = mpmi_times(p, 1.0 / 10.0, of);
  p = mpmi_times(p, -1.0 / 8.0, of);
  p = mpmi_times(p, 1.0 / 6.0, of);
  p = mpmi_times(p, -1.0 / 4.0, of);
  p = mpmi_times(p, 1.0 / 2.0, of);
  return mpmi_polynomial_at(mpmi_times(p, 0.0, of), e, of->square);
}

/* To the ninth power, of a small e. */
MPMI_INLINE mpmi_sym mpmi_small_log_stretch(mpmi_sym e, const mpmi_powers *of) {
  mpmi_polynomial p = {1.0 / 14.0, -1.0 / 16.0, 1.0 / 18.0};
  return mpmi_log_stretch_from(p, e, of);
}

/* To the eighteenth, of a moderate one. */
MPMI_INLINE mpmi_sym mpmi_moderate_log_stretch(mpmi_sym e, const mpmi_powers *of) {
  mpmi_polynomial p = {-1.0 / 32.0, 1.0 / 34.0, -1.0 / 36.0};
  p = mpmi_times(p, 1.0 / 30.0, of);
  p = mpmi_times(p, -1.0 / 28.0, of);
  p = mpmi_times(p, 1.0 / 26.0, of);
  p = mpmi_times(p, -1.0 / 24.0, of);
  p = mpmi_times(p, 1.0 / 22.0, of);
  p = mpmi_times(p, -1.0 / 20.0, of);
  p = mpmi_times(p, 1.0 / 18.0, of);
  p = mpmi_times(p, -1.0 / 16.0, of);
  p = mpmi_times(p, 1.0 / 14.0, of);
  return mpmi_log_stretch_from(p, e, of);
}

/* V^-1 = I - e / 2 + 3 e^2 / 8 - ..., to the eighth power, of a small e. */
MPMI_INLINE mpmi_sym mpmi_small_inverse_stretch(mpmi_sym e, const mpmi_powers *of) {
  mpmi_polynomial p = {231.0 / 1024.0, -429.0 / 2048.0, 6435.0 / 32768.0};
  p = mpmi_times(p, -63.0 / 256.0, of);
  p = mpmi_times(p, 35.0 / 128.0, of);
  p = mpmi_times(p, -5.0 / 16.0, of);
  p = mpmi_times(p, 3.0 / 8.0, of);
  p = mpmi_times(p, -1.0 / 2.0, of);
  return mpmi_polynomial_at(mpmi_times(p, 1.0, of), e, of->square);
}

/* exp(e) - I = e + e^2 / 2 + e^3 / 6 + ..., to the tenth power, of a moderate e. */
MPMI_INLINE mpmi_sym mpmi_moderate_exp_minus_1(mpmi_sym e, const mpmi_powers *of) {
  mpmi_polynomial p = {1.0 / 40320.0, 1.0 / 362880.0, 1.0 / 3628800.0};
  p = mpmi_times(p, 1.0 / 5040.0, of);
  p = mpmi_times(p, 1.0 / 720.0, of);
  p = mpmi_times(p, 1.0 / 120.0, of);
  p = mpmi_times(p, 1.0 / 24.0, of);
  p = mpmi_times(p, 1.0 / 6.0, of);
  p = mpmi_times(p, 1.0 / 2.0, of);
  p = mpmi_times(p, 1.0, of);
  return mpmi_polynomial_at(mpmi_times(p, 0.0, of), e, of->square);
}

#endif
