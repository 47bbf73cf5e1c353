/* Quadratic B-spline centred on the nodes (Steffen et al. 2008 eq. 19): the nearest node and its two
 * neighbours. */
#include "transfer/kernel_common.h"

void KERNEL(bspline2)(const mpmi_axis *axis, int64_t n, const double *x, int32_t need,
                      double (*w)[MPMI_CHUNK], double (*g)[MPMI_CHUNK], double (*u)[MPMI_CHUNK],
                      double *moment, double *first) {
  const mpmi_axis a = *axis;
  const double d = 0.25 * a.spacing * a.spacing;
  const double second = need & MPMI_NEED_MLS ? a.spacing / d : 0.0;
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
    double xi = (x[p] - a.origin) * a.inverse_spacing;
    double base = mpmi_round(xi) - 1.0;
    base = base < a.base_low ? a.base_low : base;
    base = base > a.base_high ? a.base_high : base;
    double f = xi - base - 1.0; /* offset from the middle node, in [-1/2, 1/2] */
    w[0][p] = 0.5 * (0.5 - f) * (0.5 - f);
    w[1][p] = 0.75 - f * f;
    w[2][p] = 0.5 * (0.5 + f) * (0.5 + f);
    first[p] = mpmi_in_tile(&a, base);
    moment[p] = f;
  }
  if (need & MPMI_NEED_GRADIENT) MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
      double f = moment[p];
      g[0][p] = (f - 0.5) * a.inverse_spacing;
      g[1][p] = -2.0 * f * a.inverse_spacing;
      g[2][p] = (f + 0.5) * a.inverse_spacing;
    }
  if (need & MPMI_NEED_MLS) MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
      double f = moment[p];
      g[0][p] = w[0][p] * (-1.0 - f) * second;
      g[1][p] = -w[1][p] * f * second;
      g[2][p] = w[2][p] * (1.0 - f) * second;
    }
  if (need & MPMI_NEED_MOMENT) MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
      double f = moment[p];
      u[0][p] = w[0][p] * (-1.0 - f) * a.spacing;
      u[1][p] = -w[1][p] * f * a.spacing;
      u[2][p] = w[2][p] * (1.0 - f) * a.spacing;
      moment[p] = d;
    }
}
