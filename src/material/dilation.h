/* What the locking remedy does to particles: kernels, one table of them for each instruction set. Arrays hold
 * whole chunks. */
#ifndef MPMI_DILATION_H
#define MPMI_DILATION_H

#include <mpm/mpm.h>

#include "simd/isa.h"

/* Measures j = det F_inc - 1 from L of [9][ld], or 0 where that is not finite. */
typedef void (*mpmi_measure_fn)(const double *L, int64_t ld, double dt, int64_t n, double *j);

/* Exchanges the volume change of particles for `mean`, j' of their cell, or leaves it where that is not a
 * number. */
typedef struct mpmi_exchange {
  double dt;
  int64_t ld;
  double *L, *F_inc; /* [9][ld]: L is changed, F_inc = I + dt L written */
  const double *mean, *old_ratio;
  double *ratio;
} mpmi_exchange;
typedef void (*mpmi_exchange_fn)(const mpmi_exchange *job, int64_t n);

/* Replaces F of [9][ld] by ratio^(1/dim) F in the axes that the grid has. */
typedef void (*mpmi_scale_fn)(double *F, int64_t ld, const double *ratio, int64_t n);

typedef struct mpmi_dilation {
  mpmi_measure_fn measure[4]; /* by dim */
  mpmi_exchange_fn exchange[4];
  mpmi_scale_fn scale[4];
} mpmi_dilation;

MPMI_DECLARE_TABLES(mpmi_dilation, mpmi_dilation);

static inline const mpmi_dilation *mpmi_dilation_of(int32_t isa) {
  return MPMI_TABLE_OF(isa, mpmi_dilation);
}

#endif
