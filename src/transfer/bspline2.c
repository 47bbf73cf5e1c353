/* Quadratic B-spline centred on the nodes (Steffen et al. 2008 eq. 21): the nearest node and its two
 * neighbours. */
#include "transfer/basis.h"

MPMI_INLINE void bspline2_axis(const mpmi_axis *a, int64_t n, const mpmi_chunk *at, int32_t gradient,
                               const mpmi_stencils *out) {
  const double origin = a->origin, inverse = a->inverse_spacing, corner = a->tile_base + 1.0;
  double(*w)[MPMI_CHUNK] = out->w, (*g)[MPMI_CHUNK] = out->g;
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    double xi = (at->x[p] - origin) * inverse;
    double middle = mpmi_round(xi);
    double f = xi - middle, below = 0.5 - f, above = 0.5 + f; /* f in [-1/2, 1/2] */
    w[0][p] = 0.5 * below * below;
    w[1][p] = 0.75 - f * f;
    w[2][p] = 0.5 * above * above;
    if (gradient) {
      g[0][p] = below * -inverse;
      g[1][p] = f * (-2.0 * inverse);
      g[2][p] = above * inverse;
    }
    out->first[p] = -1.0 - f;
    out->place[p] = middle - corner;
  }
  mpmi_into_tile(a, n, out->place);
}

MPMI_BASIS(bspline2, 3, EVEN)
