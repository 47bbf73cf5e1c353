/* Component arrays of particles to one vector for each particle, and back. */
#ifndef MPMI_PACK_H
#define MPMI_PACK_H

#include "simd/chunk.h"
#include "simd/vector.h"

/* mpmi_interleave() turns four component arrays of MPMI_SIDE particles into vectors, `stride` doubles apart;
 * mpmi_separate() turns the vectors of four of MPMI_LANES particles into components. */
#if MPMI_WIDTH == 8
enum { MPMI_SIDE = 8 };
MPMI_INLINE void mpmi_store_halves(double *low, double *high, mpmi_lanes v) {
  mpmi_store4(low, mpmi_low_half(v));
  mpmi_store4(high, mpmi_high_half(v));
}
MPMI_INLINE void mpmi_interleave(const double *a, const double *b, const double *c, const double *d,
                                 double *out, int32_t stride) {
  const mpmi_lanes va = mpmi_lanes_load(a), vb = mpmi_lanes_load(b), vc = mpmi_lanes_load(c),
                   vd = mpmi_lanes_load(d);
  const mpmi_lanes ab_even = MPMI_SHUFFLE(va, vb, 0, 8, 2, 10, 4, 12, 6, 14),
                   ab_odd = MPMI_SHUFFLE(va, vb, 1, 9, 3, 11, 5, 13, 7, 15),
                   cd_even = MPMI_SHUFFLE(vc, vd, 0, 8, 2, 10, 4, 12, 6, 14),
                   cd_odd = MPMI_SHUFFLE(vc, vd, 1, 9, 3, 11, 5, 13, 7, 15);
  mpmi_store_halves(out, out + 2 * stride, MPMI_SHUFFLE(ab_even, cd_even, 0, 1, 8, 9, 2, 3, 10, 11));
  mpmi_store_halves(out + stride, out + 3 * stride, MPMI_SHUFFLE(ab_odd, cd_odd, 0, 1, 8, 9, 2, 3, 10, 11));
  mpmi_store_halves(out + 4 * stride, out + 6 * stride,
                    MPMI_SHUFFLE(ab_even, cd_even, 4, 5, 12, 13, 6, 7, 14, 15));
  mpmi_store_halves(out + 5 * stride, out + 7 * stride,
                    MPMI_SHUFFLE(ab_odd, cd_odd, 4, 5, 12, 13, 6, 7, 14, 15));
}
/* Turns eight components of eight particles into eight values for each. Those of one particle are written by
 * one store, because a load of all of them would have to wait for two stores to end. */
MPMI_INLINE void mpmi_interleave8(const double *const *in, int64_t p, double *out) {
  mpmi_lanes pair[2][4]; /* of two components, of even and odd particles */
  for (int32_t c = 0; c < 4; ++c) {
    const mpmi_lanes a = mpmi_lanes_load(in[2 * c] + p), b = mpmi_lanes_load(in[2 * c + 1] + p);
    pair[0][c] = MPMI_SHUFFLE(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    pair[1][c] = MPMI_SHUFFLE(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  }
  for (int32_t odd = 0; odd < 2; ++odd) {
    const mpmi_lanes low_04 = MPMI_SHUFFLE(pair[odd][0], pair[odd][1], 0, 1, 4, 5, 8, 9, 12, 13),
                     low_26 = MPMI_SHUFFLE(pair[odd][0], pair[odd][1], 2, 3, 6, 7, 10, 11, 14, 15),
                     high_04 = MPMI_SHUFFLE(pair[odd][2], pair[odd][3], 0, 1, 4, 5, 8, 9, 12, 13),
                     high_26 = MPMI_SHUFFLE(pair[odd][2], pair[odd][3], 2, 3, 6, 7, 10, 11, 14, 15);
    double *row = out + 8 * odd;
    mpmi_lanes_store(row, MPMI_SHUFFLE(low_04, high_04, 0, 1, 4, 5, 8, 9, 12, 13));
    mpmi_lanes_store(row + 16, MPMI_SHUFFLE(low_26, high_26, 0, 1, 4, 5, 8, 9, 12, 13));
    mpmi_lanes_store(row + 32, MPMI_SHUFFLE(low_04, high_04, 2, 3, 6, 7, 10, 11, 14, 15));
    mpmi_lanes_store(row + 48, MPMI_SHUFFLE(low_26, high_26, 2, 3, 6, 7, 10, 11, 14, 15));
  }
}
MPMI_INLINE void mpmi_separate(const double *in, mpmi_lanes *out) {
  const mpmi_lanes r01 = mpmi_lanes_load(in), r23 = mpmi_lanes_load(in + 8), r45 = mpmi_lanes_load(in + 16),
                   r67 = mpmi_lanes_load(in + 24);
  const mpmi_lanes ab_low = MPMI_SHUFFLE(r01, r23, 0, 4, 8, 12, 1, 5, 9, 13),
                   ab_high = MPMI_SHUFFLE(r45, r67, 0, 4, 8, 12, 1, 5, 9, 13),
                   c_low = MPMI_SHUFFLE(r01, r23, 2, 6, 10, 14, 3, 7, 11, 15),
                   c_high = MPMI_SHUFFLE(r45, r67, 2, 6, 10, 14, 3, 7, 11, 15);
  out[0] = MPMI_SHUFFLE(ab_low, ab_high, 0, 1, 2, 3, 8, 9, 10, 11);
  out[1] = MPMI_SHUFFLE(ab_low, ab_high, 4, 5, 6, 7, 12, 13, 14, 15);
  out[2] = MPMI_SHUFFLE(c_low, c_high, 0, 1, 2, 3, 8, 9, 10, 11);
  out[3] = MPMI_SHUFFLE(c_low, c_high, 4, 5, 6, 7, 12, 13, 14, 15);
}
#else
enum { MPMI_SIDE = 4 };

MPMI_INLINE void mpmi_interleave(const double *a, const double *b, const double *c, const double *d,
                                 double *out, int32_t stride) {
  mpmi_v4 va = mpmi_load4(a), vb = mpmi_load4(b), vc = mpmi_load4(c), vd = mpmi_load4(d);
  mpmi_transpose4(&va, &vb, &vc, &vd);
  mpmi_store4(out, va);
  mpmi_store4(out + stride, vb);
  mpmi_store4(out + 2 * stride, vc);
  mpmi_store4(out + 3 * stride, vd);
}
MPMI_INLINE void mpmi_interleave8(const double *const *in, int64_t p, double *out) {
  for (int32_t half = 0; half < 2; ++half)
    mpmi_interleave(in[4 * half] + p, in[4 * half + 1] + p, in[4 * half + 2] + p, in[4 * half + 3] + p,
                    out + 4 * half, 8);
}
#if MPMI_WIDTH == 4
MPMI_INLINE void mpmi_separate(const double *in, mpmi_lanes *out) {
  mpmi_v4 a = mpmi_load4(in), b = mpmi_load4(in + 4), c = mpmi_load4(in + 8), d = mpmi_load4(in + 12);
  mpmi_transpose4(&a, &b, &c, &d);
  out[0] = a, out[1] = b, out[2] = c, out[3] = d;
}
#else
MPMI_INLINE void mpmi_separate(const double *in, mpmi_lanes *out) {
  const mpmi_v4 a = mpmi_load4(in), b = mpmi_load4(in + 4);
  out[0] = MPMI_SHUFFLE(a.low, b.low, 0, 2);
  out[1] = MPMI_SHUFFLE(a.low, b.low, 1, 3);
  out[2] = MPMI_SHUFFLE(a.high, b.high, 0, 2);
  out[3] = MPMI_SHUFFLE(a.high, b.high, 1, 3);
}
#endif
#endif

/* Turns eight registers, of which each has a value for every lane, into eight values for each lane. */
MPMI_INLINE void mpmi_lanes_turn(const double *const *in, double *out) {
#if MPMI_WIDTH == 2
  for (int32_t c = 0; c < 8; ++c)
    for (int32_t l = 0; l < MPMI_LANES; ++l) out[8 * l + c] = in[c][l];
#else
  mpmi_interleave8(in, 0, out);
#endif
}

/* Turns four component arrays of n particles into one vector per particle, `stride` doubles apart. */
MPMI_INLINE void mpmi_pack(int64_t n, const double *a, const double *b, const double *c, const double *d,
                           double *out, int32_t stride) {
  for (int64_t p = 0; p < mpmi_whole_chunks(n); p += MPMI_SIDE)
    mpmi_interleave(a + p, b + p, c + p, d + p, out + p * stride, stride);
}
/* Turns eight component arrays into eight values for each particle. */
MPMI_INLINE void mpmi_pack8(int64_t n, const double *const *in, double *out) {
  for (int64_t p = 0; p < mpmi_whole_chunks(n); p += MPMI_SIDE) mpmi_interleave8(in, p, out + 8 * p);
}

#endif
