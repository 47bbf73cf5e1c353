/* Quadratic B-spline on an open knot vector: functions c, c + 1, c + 2 in cell c. */
#include "transfer/open_bspline.h"

MPMI_INLINE void open_bspline2_axis(const mpmi_axis *a, int64_t n, const mpmi_chunk *at, int32_t gradient,
                                    const mpmi_stencils *out) {
  const double inverse = a->inverse_spacing;
  double(*w)[MPMI_CHUNK] = out->w, (*g)[MPMI_CHUNK] = out->g, (*d)[MPMI_CHUNK] = out->distance;
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    const double xi = (at->x[p] - a->origin) * inverse, cell = mpmi_cell(a, xi);
    const mpmi_knots t = mpmi_knots_of(a, cell, xi);
    const double linear[2] = {t.above[0], t.below[0]};
    double q[2], N[3];
    mpmi_raise(2, &t, linear, q, N);
    for (int32_t k = 0; k < 3; ++k) w[k][p] = N[k];
    d[0][p] = -0.5 * (t.below[1] + t.below[0]);
    d[1][p] = 0.5 * (t.above[0] - t.below[0]);
    d[2][p] = 0.5 * (t.above[0] + t.above[1]);
    if (gradient) {
      g[0][p] = -2.0 * inverse * q[0];
      g[1][p] = 2.0 * inverse * (q[0] - q[1]);
      g[2][p] = 2.0 * inverse * q[1];
    }
    out->first[p] = d[0][p];
    out->place[p] = cell - a->tile_base;
  }
  mpmi_into_tile(a, n, out->place);
}

MPMI_BASIS(open_bspline2, 3, UNEVEN)
