/* What a step does to the deformation gradient and the volume of particles: kernels, one table of them for
 * each instruction set. */
#ifndef MPMI_DEFORMATION_H
#define MPMI_DEFORMATION_H

#include <mpm/mpm.h>

#include "simd/isa.h"

/* What a step does to F: it multiplies F by F_inc; it keeps the volume alone, F = J^(1/3) I (in 1-D F11 = J);
 * it leaves F as it is. */
enum { MPMI_F_DEFORMS, MPMI_F_DILATES, MPMI_F_STAYS, MPMI_F_KINDS };

/* Makes F_new from F_old and L, volume = det F_new * initial volume, and F_inc = I + dt L when asked for. */
typedef struct mpmi_deform {
  double dt;
  int64_t ld;
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

typedef struct mpmi_deformation {
  mpmi_deform_fn deform[MPMI_F_KINDS][4]; /* by kinematics, dim */
  mpmi_volume_fn volume[4];               /* by dim */
} mpmi_deformation;

MPMI_DECLARE_TABLES(mpmi_deformation, mpmi_deformation);

static inline const mpmi_deformation *mpmi_deformation_of(int32_t isa) {
  return MPMI_TABLE_OF(isa, mpmi_deformation);
}

#endif
