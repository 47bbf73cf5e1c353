/* Bounds of the eigenvalues of b = F F^T = I + e over the directions that `dim` has, by the absolute row
 * sums. */
#ifndef MPMI_STRETCH_BOUNDS_H
#define MPMI_STRETCH_BOUNDS_H

#include <math.h>

#include "simd/tensor.h"
#include "simd/vector_math.h"

MPMI_INLINE double mpmi_largest_stretch_squared(int dim, mpmi_sym e) {
  if (dim == 1) return 1.0 + e.xx;
  double xy = fabs(e.xy);
  if (dim == 2) return 1.0 + (mpmi_max(e.xx, e.yy) + xy);
  double yz = fabs(e.yz), xz = fabs(e.xz);
  return 1.0 + mpmi_max(mpmi_max(e.xx + (xy + xz), e.yy + (xy + yz)), e.zz + (xz + yz));
}

/* At least 0, as b is positive. */
MPMI_INLINE double mpmi_smallest_stretch_squared(int dim, mpmi_sym e) {
  if (dim == 1) return 1.0 + e.xx;
  double xy = fabs(e.xy);
  if (dim == 2) return mpmi_max(1.0 + (mpmi_min(e.xx, e.yy) - xy), 0.0);
  double yz = fabs(e.yz), xz = fabs(e.xz);
  return mpmi_max(1.0 + mpmi_min(mpmi_min(e.xx - (xy + xz), e.yy - (xy + yz)), e.zz - (xz + yz)), 0.0);
}

#endif
