/* Cubic B-spline centred on the nodes (the recursion of Steffen et al. 2008 eqs 22-23 with equal knots): the
 * two nodes of the cell that holds the particle and their outer neighbours. */
#include "transfer/basis.h"

MPMI_INLINE void bspline3_axis(const mpmi_axis *a, int64_t n, const mpmi_chunk *at, int32_t gradient,
                               const mpmi_stencils *out) {
  const double inverse = a->inverse_spacing, corner = a->tile_base + 1.0;
  double(*w)[MPMI_CHUNK] = out->w, (*g)[MPMI_CHUNK] = out->g;
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    double xi = (at->x[p] - a->origin) * inverse, cell = mpmi_cell(a, xi);
    double f = xi - cell, e = 1.0 - f, ff = f * f, ee = e * e;
    w[0][p] = 1.0 / 6.0 * ee * e;
    w[1][p] = 2.0 / 3.0 - ff * (1.0 - 0.5 * f);
    w[2][p] = 2.0 / 3.0 - ee * (1.0 - 0.5 * e);
    w[3][p] = 1.0 / 6.0 * ff * f;
    if (gradient) {
      g[0][p] = ee * (-0.5 * inverse);
      g[1][p] = f * (1.5 * f - 2.0) * inverse;
      g[2][p] = e * (2.0 - 1.5 * e) * inverse;
      g[3][p] = ff * (0.5 * inverse);
    }
    out->first[p] = -1.0 - f;
    out->place[p] = cell - corner;
  }
  mpmi_into_tile(a, n, out->place);
}

MPMI_BASIS(bspline3, 4, EVEN)
