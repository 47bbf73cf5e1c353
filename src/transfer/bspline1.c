/* Linear basis (Steffen et al. 2008 eq. 17): node i and i + 1 of the cell that holds the particle. A particle
 * on a node gives the node across its cell a weight far below rounding: the gradient there is 1 / h all the
 * same, and has to find the particle's velocity and not the rest of an empty node. */
#include "transfer/basis.h"

MPMI_INLINE mpmi_lanes bspline1_lanes(const mpmi_axis *a, mpmi_lanes x, int32_t gradient, mpmi_lanes *w,
                                      mpmi_lanes *g, mpmi_lanes *first) {
  const mpmi_lanes zero = {0.0}, xi = (x - a->origin) * a->inverse_spacing;
  const mpmi_lanes cell = mpmi_lanes_cell(a, xi), f = xi - cell;
  const mpmi_lanes least = zero + 0x1p-60;
  w[0] = mpmi_lanes_max(1.0 - f, least);
  w[1] = mpmi_lanes_max(f, least);
  if (gradient) {
    g[0] = zero - a->inverse_spacing;
    g[1] = zero + a->inverse_spacing;
  }
  *first = -f;
  return cell - a->tile_base;
}

MPMI_BASIS_LANES(bspline1, 2)
