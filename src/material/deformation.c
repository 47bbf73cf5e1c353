/* New deformation gradient and volume of particles, from the velocity gradient. */
#include <string.h>

#include "material/deformation.h"
#include "simd/chunk.h"
#include "simd/tensor.h"
#include "simd/vector_math.h"

/* Tells whether an entry of the full 3x3 tensor may differ from the identity: plane strain keeps its zz. */
MPMI_INLINE int32_t has_entry(int32_t dim, int32_t row, int32_t column) {
  return (row < dim && column < dim) || (dim == 2 && row == 2 && column == 2);
}

/* Finds the place of each entry of the full tensor among the stored ones, or -1. */
MPMI_INLINE void place_entries(int32_t dim, int32_t *place) {
  for (int32_t e = 0; e < 9; ++e)
    place[e] = has_entry(dim, e / 3, e % 3) ? mpmi_stored_entry(dim, e / 3, e % 3) : -1;
}

MPMI_INLINE void load_stored(int32_t dim, const double *const *F, int64_t s, mpmi_lanes *out) {
  for (int32_t c = 0; c < mpmi_stored_entries(dim); ++c) out[c] = mpmi_lanes_load(F[c] + s);
}

/* Computes volumes; returns the flags of those that are no volume. */
MPMI_INLINE uint32_t volume(int32_t dim, const double *const *F, const double *initial_volume, double *out,
                            int64_t n) {
  mpmi_deformed made = mpmi_nothing_deformed();
  for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_LANES) {
    mpmi_lanes stored[9];
    load_stored(dim, F, s, stored);
    mpmi_volume_lanes(dim, stored, initial_volume + s, out + s, &made);
  }
  return mpmi_deform_flags(&made);
}

MPMI_INLINE uint32_t volume_of(int32_t dim, const mpmi_deform *job, int64_t n) {
  const double *F[9];
  for (int32_t c = 0; c < 9; ++c) F[c] = job->F_new[c];
  return volume(dim, F, job->initial_volume, job->volume, n);
}

/* Writes F_inc = I + dt L. */
MPMI_INLINE void increment(int32_t dim, const mpmi_deform *job, int64_t n) {
  for (int32_t r = 0; r < dim; ++r)
    for (int32_t c = 0; c < dim; ++c) {
      const double *L = job->L + (3 * r + c) * job->ld;
      double *F_inc = job->F_inc + (3 * r + c) * job->ld;
      const double unit = r == c ? 1.0 : 0.0;
      MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) F_inc[p] = unit + job->dt * L[p];
    }
}

MPMI_INLINE uint32_t deform(int32_t dim, const mpmi_deform *job, int64_t n) {
  mpmi_deformed deformed = mpmi_nothing_deformed();
  for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_LANES) {
    mpmi_lanes L[3][3];
    for (int32_t r = 0; r < dim; ++r)
      for (int32_t c = 0; c < dim; ++c) L[r][c] = mpmi_lanes_load(job->L + (3 * r + c) * job->ld + s);
    mpmi_deform_lanes(dim, job, s, L, &deformed);
  }
  return mpmi_deform_flags(&deformed);
}

/* Finds the f > 0 of F_old = f I, or J^(1/3) where the host has set an F of another shape. */
MPMI_INLINE void stretch_of_volume(int32_t dim, const mpmi_deform *job, int64_t n, double *f) {
  const mpmi_lanes zero = {0.0};
  mpmi_mask any = {0};
  int32_t place[9];
  place_entries(dim, place);
  for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_LANES) {
    const mpmi_lanes first = mpmi_lanes_load(job->F_old[0] + s);
    mpmi_mask other = {0};
    for (int32_t e = 1; e < 9; ++e)
      if (place[e] >= 0) other |= mpmi_lanes_load(job->F_old[place[e]] + s) != (e % 4 ? zero : first);
    mpmi_lanes F[9];
    load_stored(dim, job->F_old, s, F);
    const mpmi_lanes minus_J = -mpmi_determinant(dim, F); /* negative: not yet a stretch */
    mpmi_lanes_store(f + s, mpmi_lanes_where(~other, first) + mpmi_lanes_where(other, minus_J));
    any |= other;
  }
  if (!mpmi_lanes_any(any, 1)) return;
  for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p)
    if (f[p] < 0.0) f[p] = 1.0 + mpmi_lane_expm1((1.0 / 3.0) * mpmi_lane_log(-f[p]));
}

/* Dilates: F = J^(1/3) I with J = det(I + dt L) J_old; in 1-D, where only F11 is stored, F11 = J. */
MPMI_INLINE uint32_t dilate(int32_t dim, const mpmi_deform *job, int64_t n) {
  const double dt = job->dt, *L = job->L;
  const int64_t ld = job->ld;
  const int32_t diagonals = dim == 1 ? 1 : 3;
  double *f = job->F;
  stretch_of_volume(dim, job, n, f);
  if (job->F_inc) increment(dim, job, n);
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    const double d = mpmi_det_minus_1(dim, mpmi_load_mat(dim, L, ld, p, 0.0, dt));
    const double grown = dim == 1 ? d : mpmi_lane_expm1((1.0 / 3.0) * mpmi_lane_log1p(d));
    /* an inverted increment gives an f that is not positive, and what is not finite stays so */
    f[p] = (d > -1.0 ? f[p] + f[p] * grown : 1.0 + d) + (d - d);
  }
  int32_t stored = 0;
  for (int32_t e = 0; e < 9; ++e) {
    if (!has_entry(dim, e / 3, e % 3)) continue;
    double *F = job->F_new[stored++];
    for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) F[p] = e % 4 ? 0.0 : f[p];
  }
  for (int32_t k = 1; k < diagonals; ++k) memcpy(job->F + 4 * k * ld, f, (size_t)n * sizeof *f);
  return volume_of(dim, job, n);
}

MPMI_INLINE uint32_t stay(int32_t dim, const mpmi_deform *job, int64_t n) {
  int32_t place[9];
  place_entries(dim, place);
  for (int32_t e = 0; e < 9; ++e) {
    if (place[e] < 0) continue;
    memcpy(job->F + e * job->ld, job->F_old[place[e]], (size_t)n * sizeof(double));
    memcpy(job->F_new[place[e]], job->F_old[place[e]], (size_t)n * sizeof(double));
  }
  return volume_of(dim, job, n);
}

#define BY_DIM(dim)                                                                                          \
  static uint32_t deform_##dim(const mpmi_deform *job, int64_t n) {                                          \
    return deform(dim, job, n);                                                                              \
  }                                                                                                          \
  static uint32_t dilate_##dim(const mpmi_deform *job, int64_t n) {                                          \
    return dilate(dim, job, n);                                                                              \
  }                                                                                                          \
  static uint32_t stay_##dim(const mpmi_deform *job, int64_t n) {                                            \
    return stay(dim, job, n);                                                                                \
  }                                                                                                          \
  static uint32_t volume_##dim(const double *const *F, const double *initial_volume, double *out,            \
                               int64_t n) {                                                                  \
    return volume(dim, F, initial_volume, out, n);                                                           \
  }
BY_DIM(1)
BY_DIM(2)
BY_DIM(3)

const mpmi_deformation KERNEL(deformation) = {
    .deform = {[MPMI_F_DEFORMS] = {NULL, deform_1, deform_2, deform_3},
               [MPMI_F_DILATES] = {NULL, dilate_1, dilate_2, dilate_3},
               [MPMI_F_STAYS] = {NULL, stay_1, stay_2, stay_3}},
    .volume = {NULL, volume_1, volume_2, volume_3},
};
