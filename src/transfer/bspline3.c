/* Cubic B-spline centred on the nodes (the recursion of Steffen et al. 2008 eqs 22-23 with equal knots): the
 * two nodes of the cell that holds the particle and their outer neighbours. */
#include "transfer/basis.h"

MPMI_INLINE mpmi_lanes bspline3_lanes(const mpmi_axis *a, mpmi_lanes x, int32_t gradient, mpmi_lanes *w,
                                      mpmi_lanes *g, mpmi_lanes *first) {
  const double inverse = a->inverse_spacing;
  const mpmi_lanes xi = (x - a->origin) * inverse, cell = mpmi_lanes_cell(a, xi);
  const mpmi_lanes f = xi - cell, e = 1.0 - f, ff = f * f, ee = e * e;
  w[0] = 1.0 / 6.0 * ee * e;
  w[1] = 2.0 / 3.0 - ff * (1.0 - 0.5 * f);
  w[2] = 2.0 / 3.0 - ee * (1.0 - 0.5 * e);
  w[3] = 1.0 / 6.0 * ff * f;
  if (gradient) {
    g[0] = ee * (-0.5 * inverse);
    g[1] = f * (1.5 * f - 2.0) * inverse;
    g[2] = e * (2.0 - 1.5 * e) * inverse;
    g[3] = ff * (0.5 * inverse);
  }
  *first = -1.0 - f;
  return cell - (a->tile_base + 1.0);
}

MPMI_BASIS_LANES(bspline3, 4)
