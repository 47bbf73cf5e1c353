/* Small helpers shared by the kernel files; everything here is inlined. */
#ifndef MPMI_KERNEL_COMMON_H
#define MPMI_KERNEL_COMMON_H

#include "simd/rounding.h"
#include "simd/vector.h"
#include "transfer/kernels.h"

/* Brings the next chunk's share of particle p (0 ... 15) nearer, to the second-level cache: a chunk of a
 * stream is two lines, and asking for all of them at once would fill the queues. */
MPMI_INLINE void mpmi_prefetch(const mpmi_streams *streams, int64_t next, int64_t p) {
  enum { LINES = MPMI_CHUNK * (int32_t)sizeof(double) / 64, DOUBLES = 64 / (int32_t)sizeof(double) };
  for (int64_t i = p; i < LINES * streams->count; i += MPMI_CHUNK)
    __builtin_prefetch(streams->at[i / LINES] + next + DOUBLES * (i % LINES), 0, 2);
}

/* h^2 / D of the MLS form: quadratic and cubic B-splines have D = h^2 / 4 and h^2 / 3 everywhere. */
#define MPMI_MLS_INVERSE(width) ((width) == 3 ? 4.0 : 3.0)

/* n particles' four components, arrays a..d, to one vector per particle, `stride` doubles apart; and back (d
 * is dropped). */
MPMI_INLINE void mpmi_pack(int64_t n, const double *a, const double *b, const double *c, const double *d,
                           double *out, int32_t stride) {
  for (int64_t p = 0; p < mpmi_whole_chunks(n); p += MPMI_SIDE)
    mpmi_interleave(a + p, b + p, c + p, d + p, out + p * stride, stride);
}
/* Eight components, to eight values for each particle. */
MPMI_INLINE void mpmi_pack8(int64_t n, const double *const *in, double *out) {
  for (int64_t p = 0; p < mpmi_whole_chunks(n); p += MPMI_SIDE) mpmi_interleave8(in, p, out + 8 * p);
}
MPMI_INLINE void mpmi_unpack(int64_t n, const double *in, double *a, double *b, double *c) {
  for (int64_t p = 0; p < mpmi_whole_chunks(n); p += MPMI_SIDE)
    mpmi_separate(in + 4 * p, a + p, b + p, c + p);
}

#endif
