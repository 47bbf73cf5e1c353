/* Quadratic B-spline centred on the nodes (Steffen et al. 2008 eq. 19): the nearest node and its two
 * neighbours. */
#include "transfer/kernel_common.h"

void KERNEL(bspline2)(const mpmi_axis *axis, int64_t n, const double *x, int32_t gradient,
                      double (*w)[MPMI_CHUNK], double (*g)[MPMI_CHUNK], double *first, double *place) {
  const mpmi_axis a = *axis;
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
    double xi = (x[p] - a.origin) * a.inverse_spacing;
    double base = mpmi_round(xi) - 1.0;
    base = base < a.base_low ? a.base_low : base;
    base = base > a.base_high ? a.base_high : base;
    double f = xi - base - 1.0; /* offset from the middle node, in [-1/2, 1/2] */
    w[0][p] = 0.5 * (0.5 - f) * (0.5 - f);
    w[1][p] = 0.75 - f * f;
    w[2][p] = 0.5 * (0.5 + f) * (0.5 + f);
    first[p] = -1.0 - f;
    place[p] = mpmi_in_tile(&a, base);
  }
  if (gradient) MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
      double f = -1.0 - first[p];
      g[0][p] = (f - 0.5) * a.inverse_spacing;
      g[1][p] = -2.0 * f * a.inverse_spacing;
      g[2][p] = (f + 0.5) * a.inverse_spacing;
    }
}
