/* Quadratic B-spline centred on the nodes (Steffen et al. 2008 eq. 19): the nearest node and its two
 * neighbours. */
#include "transfer/basis.h"

MPMI_INLINE void bspline2_axis(const mpmi_axis *a, int64_t n, const double *x, int32_t gradient,
                               double (*w)[MPMI_CHUNK], double (*g)[MPMI_CHUNK], double *first,
                               double *place) {
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
    double xi = (x[p] - a->origin) * a->inverse_spacing;
    double middle = mpmi_round(xi);
    double f = xi - middle; /* in [-1/2, 1/2] */
    w[0][p] = 0.5 * (0.5 - f) * (0.5 - f);
    w[1][p] = 0.75 - f * f;
    w[2][p] = 0.5 * (0.5 + f) * (0.5 + f);
    if (gradient) {
      g[0][p] = (f - 0.5) * a->inverse_spacing;
      g[1][p] = -2.0 * f * a->inverse_spacing;
      g[2][p] = (f + 0.5) * a->inverse_spacing;
    }
    first[p] = -1.0 - f;
    place[p] = mpmi_in_tile(a, middle - 1.0);
  }
}

MPMI_BASIS(bspline2, 3)
