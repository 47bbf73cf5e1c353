/* Component arrays of particles to one vector for each particle, and back. */
#ifndef MPMI_PACK_H
#define MPMI_PACK_H

#include "simd/chunk.h"
#include "simd/vector.h"

/* mpmi_interleave() turns four components, each of as many particles as a register holds, into four values
 * for each particle, and mpmi_interleave8() eight into eight; mpmi_separate() turns four values of each into
 * components. */
#if MPMI_WIDTH == 8
MPMI_INLINE void mpmi_interleave(const mpmi_lanes *in, double *out) {
  mpmi_lanes pair[2][2]; /* of two components, of the first and the last four particles */
  for (int32_t c = 0; c < 2; ++c) {
    pair[c][0] = MPMI_SHUFFLE(in[2 * c], in[2 * c + 1], 0, 8, 1, 9, 2, 10, 3, 11);
    pair[c][1] = MPMI_SHUFFLE(in[2 * c], in[2 * c + 1], 4, 12, 5, 13, 6, 14, 7, 15);
  }
  for (int32_t k = 0; k < 2; ++k) {
    mpmi_lanes_store(out + 16 * k, MPMI_SHUFFLE(pair[0][k], pair[1][k], 0, 1, 8, 9, 2, 3, 10, 11));
    mpmi_lanes_store(out + 16 * k + 8, MPMI_SHUFFLE(pair[0][k], pair[1][k], 4, 5, 12, 13, 6, 7, 14, 15));
  }
}
/* Those of one particle are written by one store, because a load of all of them would have to wait for two
 * stores to end. */
MPMI_INLINE void mpmi_interleave8(const mpmi_lanes *in, double *out) {
  mpmi_lanes pair[2][4]; /* of two components, of even and odd particles */
  for (int32_t c = 0; c < 4; ++c) {
    pair[0][c] = MPMI_SHUFFLE(in[2 * c], in[2 * c + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    pair[1][c] = MPMI_SHUFFLE(in[2 * c], in[2 * c + 1], 1, 9, 3, 11, 5, 13, 7, 15);
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
#elif MPMI_WIDTH == 4
MPMI_INLINE void mpmi_interleave_apart(const mpmi_lanes *in, double *out, int32_t stride) {
  mpmi_v4 a = in[0], b = in[1], c = in[2], d = in[3];
  mpmi_transpose4(&a, &b, &c, &d);
  mpmi_store4(out, a);
  mpmi_store4(out + stride, b);
  mpmi_store4(out + 2 * stride, c);
  mpmi_store4(out + 3 * stride, d);
}
MPMI_INLINE void mpmi_separate(const double *in, mpmi_lanes *out) {
  mpmi_v4 a = mpmi_load4(in), b = mpmi_load4(in + 4), c = mpmi_load4(in + 8), d = mpmi_load4(in + 12);
  mpmi_transpose4(&a, &b, &c, &d);
  out[0] = a, out[1] = b, out[2] = c, out[3] = d;
}
#else
MPMI_INLINE void mpmi_interleave_apart(const mpmi_lanes *in, double *out, int32_t stride) {
  mpmi_store4(out, (mpmi_v4){MPMI_SHUFFLE(in[0], in[1], 0, 2), MPMI_SHUFFLE(in[2], in[3], 0, 2)});
  mpmi_store4(out + stride, (mpmi_v4){MPMI_SHUFFLE(in[0], in[1], 1, 3), MPMI_SHUFFLE(in[2], in[3], 1, 3)});
}
MPMI_INLINE void mpmi_separate(const double *in, mpmi_lanes *out) {
  const mpmi_v4 a = mpmi_load4(in), b = mpmi_load4(in + 4);
  out[0] = MPMI_SHUFFLE(a.low, b.low, 0, 2);
  out[1] = MPMI_SHUFFLE(a.low, b.low, 1, 3);
  out[2] = MPMI_SHUFFLE(a.high, b.high, 0, 2);
  out[3] = MPMI_SHUFFLE(a.high, b.high, 1, 3);
}
#endif
#if MPMI_WIDTH < 8
MPMI_INLINE void mpmi_interleave(const mpmi_lanes *in, double *out) {
  mpmi_interleave_apart(in, out, 4);
}
MPMI_INLINE void mpmi_interleave8(const mpmi_lanes *in, double *out) {
  mpmi_interleave_apart(in, out, 8);
  mpmi_interleave_apart(in + 4, out + 4, 8);
}
#endif

/* Turns four component arrays of n particles into four values for each. */
MPMI_INLINE void mpmi_pack(int64_t n, const double *const *from, double *out) {
  for (int64_t p = 0; p < mpmi_whole_chunks(n); p += MPMI_LANES) {
    mpmi_lanes in[4];
    for (int32_t c = 0; c < 4; ++c) in[c] = mpmi_lanes_load(from[c] + p);
    mpmi_interleave(in, out + 4 * p);
  }
}

#endif
