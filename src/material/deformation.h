/* What a step does to the deformation gradient and the volume of particles: kernels, one table of them for
 * each instruction set, and what they do for as many particles as a register holds:
 *
 *   F = (I + dt L) F_old     MPoint theory eq. 39, Steffen et al. 2008 eq. 8
 *   V = det F V0             MPoint theory eq. 40
 */
#ifndef MPMI_DEFORMATION_H
#define MPMI_DEFORMATION_H

#include <mpm/mpm.h>

#include "simd/flags.h"
#include "simd/lanes.h"

/* What a step does to F: it multiplies F by F_inc; it keeps the volume alone, F = J^(1/3) I (in 1-D F11 = J);
 * it leaves F as it is. */
enum { MPMI_F_DEFORMS, MPMI_F_DILATES, MPMI_F_STAYS, MPMI_F_KINDS };

/* Makes F_new from F_old and L, volume = det F_new * initial volume, and F_inc = I + dt L when asked for. */
typedef struct mpmi_deform {
  double dt;
  int64_t ld;
  int32_t total;          /* L is over reference positions: F_new = F_old + dt L; there is no F_inc then */
  const double *L;        /* [9][ld] */
  double *F, *F_inc;      /* [9][ld] out, full; either may be NULL where F deforms, F_inc always */
  const double *F_old[9]; /* the components that are stored */
  double *F_new[9];
  const double *initial_volume;
  double *volume;
} mpmi_deform;

/* Return MPMI_NOT_POSITIVE and MPMI_NONFINITE where a volume is no volume. The second makes volumes again
 * from stored components of F, with the same bits. */
typedef uint32_t (*mpmi_deform_fn)(const mpmi_deform *job, int64_t n);
typedef uint32_t (*mpmi_volume_fn)(const double *const *F, const double *initial_volume, double *volume,
                                   int64_t n);

/* What is known of volumes that were made: bad is 0 where all are finite, smallest the smallest det F. */
typedef struct mpmi_deformed {
  mpmi_lanes bad, smallest;
} mpmi_deformed;

MPMI_INLINE mpmi_deformed mpmi_nothing_deformed(void) {
  const mpmi_lanes zero = {0.0};
  return (mpmi_deformed){zero, zero + 1.0};
}

/* Returns the place of an entry of the full tensor among the stored ones: plane strain keeps its zz, too. */
MPMI_INLINE int32_t mpmi_stored_entry(int32_t dim, int32_t row, int32_t column) {
  return dim == 2 && row == 2 ? 4 : dim * row + column;
}

MPMI_INLINE int32_t mpmi_stored_entries(int32_t dim) {
  return dim == 2 ? 5 : dim * dim;
}

/* Returns det F of the stored components F[c]. */
MPMI_INLINE mpmi_lanes mpmi_determinant(int32_t dim, const mpmi_lanes *F) {
  if (dim == 1) return F[0];
  if (dim == 2) return (F[0] * F[3] - F[1] * F[2]) * F[4];
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
         F[2] * (F[3] * F[7] - F[4] * F[6]);
}

/* All volumes are made here, so that they can be made again with the same bits. */
MPMI_INLINE void mpmi_volume_lanes(int32_t dim, const mpmi_lanes *F, const double *initial_volume,
                                   double *volume, mpmi_deformed *t) {
  const mpmi_lanes J = mpmi_determinant(dim, F);
  t->bad += 0.0 * J;
  t->smallest = mpmi_lanes_min(t->smallest, J);
  mpmi_lanes_store(volume, J * mpmi_lanes_load(initial_volume));
}

/* Deforms the particles from slot s of the batch on; L[row][column]. */
MPMI_INLINE void mpmi_deform_lanes(int32_t dim, const mpmi_deform *job, int64_t s, mpmi_lanes (*L)[3],
                                   mpmi_deformed *t) {
  const double dt = job->dt;
  mpmi_lanes old[3][3], F[9];
  for (int32_t r = 0; r < dim; ++r)
    for (int32_t c = 0; c < dim; ++c)
      old[r][c] = mpmi_lanes_load(job->F_old[mpmi_stored_entry(dim, r, c)] + s);
  for (int32_t r = 0; r < dim && !job->total; ++r)
    for (int32_t c = 0; c < dim; ++c) {
      mpmi_lanes rate = {0.0};
      for (int32_t k = 0; k < dim; ++k) rate += L[r][k] * old[k][c];
      F[mpmi_stored_entry(dim, r, c)] = old[r][c] + dt * rate;
    }
  for (int32_t r = 0; r < dim && job->total; ++r)
    for (int32_t c = 0; c < dim; ++c) F[mpmi_stored_entry(dim, r, c)] = old[r][c] + dt * L[r][c];
  if (dim == 2) F[4] = mpmi_lanes_load(job->F_old[4] + s); /* plane strain keeps its zz */
  for (int32_t c = 0; c < mpmi_stored_entries(dim); ++c) mpmi_lanes_store(job->F_new[c] + s, F[c]);
  if (job->F) {
    for (int32_t r = 0; r < dim; ++r)
      for (int32_t c = 0; c < dim; ++c)
        mpmi_lanes_store(job->F + (3 * r + c) * job->ld + s, F[mpmi_stored_entry(dim, r, c)]);
    if (dim == 2) mpmi_lanes_store(job->F + 8 * job->ld + s, F[4]);
  }
  if (job->F_inc)
    for (int32_t r = 0; r < dim; ++r)
      for (int32_t c = 0; c < dim; ++c)
        mpmi_lanes_store(job->F_inc + (3 * r + c) * job->ld + s, (r == c ? 1.0 : 0.0) + dt * L[r][c]);
  mpmi_volume_lanes(dim, F, job->initial_volume + s, job->volume + s, t);
}

MPMI_INLINE uint32_t mpmi_deform_flags(const mpmi_deformed *t) {
  return (mpmi_lanes_sum(t->bad) == 0.0 ? 0u : (uint32_t)MPMI_NONFINITE) |
         (mpmi_lanes_smallest(t->smallest) > 0.0 ? 0u : (uint32_t)MPMI_NOT_POSITIVE);
}

typedef struct mpmi_deformation {
  mpmi_deform_fn deform[MPMI_F_KINDS][4]; /* by kinematics, dim */
  mpmi_volume_fn volume[4];               /* by dim */
} mpmi_deformation;

MPMI_DECLARE_TABLES(mpmi_deformation, mpmi_deformation);

static inline const mpmi_deformation *mpmi_deformation_of(int32_t isa) {
  return MPMI_TABLE_OF(isa, mpmi_deformation);
}

#endif
