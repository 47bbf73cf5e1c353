/* Cubic B-spline on an open knot vector: functions c - 1 ... c + 2 in cell c. */
#include "transfer/open_bspline.h"

MPMI_INLINE void open_bspline3_axis(const mpmi_axis *a, int64_t n, const mpmi_chunk *at, int32_t gradient,
                                    const mpmi_stencils *out) {
  const double inverse = a->inverse_spacing, corner = a->tile_base + 1.0;
  double(*w)[MPMI_CHUNK] = out->w, (*g)[MPMI_CHUNK] = out->g, (*d)[MPMI_CHUNK] = out->distance;
  /* too long for some compilers to vectorise: they are not asked to */
  for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    const double xi = (at->x[p] - a->origin) * inverse, cell = mpmi_cell(a, xi);
    const mpmi_knots t = mpmi_knots_of(a, cell, xi);
    const double linear[2] = {t.above[0], t.below[0]};
    double q[3], quadratic[3], N[4];
    mpmi_raise(2, &t, linear, q, quadratic);
    mpmi_raise(3, &t, quadratic, q, N);
    for (int32_t k = 0; k < 4; ++k) w[k][p] = N[k];
    d[0][p] = -1.0 / 3.0 * (t.below[2] + t.below[1] + t.below[0]);
    d[1][p] = 1.0 / 3.0 * (t.above[0] - t.below[0] - t.below[1]);
    d[2][p] = 1.0 / 3.0 * (t.above[1] + t.above[0] - t.below[0]);
    d[3][p] = 1.0 / 3.0 * (t.above[0] + t.above[1] + t.above[2]);
    if (gradient) {
      g[0][p] = -3.0 * inverse * q[0];
      g[1][p] = 3.0 * inverse * (q[0] - q[1]);
      g[2][p] = 3.0 * inverse * (q[1] - q[2]);
      g[3][p] = 3.0 * inverse * q[2];
    }
    out->first[p] = d[0][p];
    out->place[p] = cell - corner;
  }
  mpmi_into_tile(a, n, out->place);
}

MPMI_BASIS(open_bspline3, 4, UNEVEN)
