/* Quadratic B-spline centred on the nodes (Steffen et al. 2008 eq. 21): the nearest node and its two
 * neighbours. */
#include "transfer/basis.h"

MPMI_INLINE mpmi_lanes bspline2_lanes(const mpmi_axis *a, mpmi_lanes x, int32_t gradient, mpmi_lanes *w,
                                      mpmi_lanes *g, mpmi_lanes *first) {
  const double inverse = a->inverse_spacing;
  const mpmi_lanes xi = (x - a->origin) * inverse;
  mpmi_lanes middle = mpmi_lanes_round(xi), f = xi - middle; /* in [-1/2, 1/2] */
  mpmi_lanes below = 0.5 - f, above = 0.5 + f;
  /* A particle in the middle of a cell goes with the even node, as others there do. Those that move are not
   * there for long. */
  if (a->still && mpmi_lanes_any(mpmi_lanes_abs(f) >= 0.5 - MPMI_HAIR, 1)) {
    const mpmi_lanes zero = {0.0}, even = mpmi_lanes_even_of(middle, f);
    f -= even - middle;
    middle = even;
    below = mpmi_lanes_select(0.5 - f > MPMI_LEAST_REACH, 0.5 - f, zero);
    above = mpmi_lanes_select(0.5 + f > MPMI_LEAST_REACH, 0.5 + f, zero);
  }
  w[0] = 0.5 * below * below;
  w[1] = 0.75 - f * f;
  w[2] = 0.5 * above * above;
  if (gradient) {
    g[0] = below * -inverse;
    g[1] = f * (-2.0 * inverse);
    g[2] = above * inverse;
  }
  *first = -1.0 - f;
  return middle - (a->tile_base + 1.0);
}

MPMI_BASIS_LANES(bspline2, 3)
