/* Linear basis (Steffen et al. 2008 eq. 17): node i and i + 1 of the cell that holds the particle. */
#include "transfer/basis.h"

MPMI_INLINE void bspline1_axis(const mpmi_axis *a, int64_t n, const double *x, int32_t gradient,
                               double (*w)[MPMI_CHUNK], double (*g)[MPMI_CHUNK], double *first,
                               double *place) {
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
    double xi = (x[p] - a->origin) * a->inverse_spacing;
    double base = mpmi_floor(xi);
    base = base > a->last_cell ? a->last_cell : base; /* on the upper face */
    double f = xi - base;
    w[0][p] = 1.0 - f;
    w[1][p] = f;
    first[p] = -f;
    place[p] = base - a->tile_base;
  }
  mpmi_into_tile(a, n, place);
  if (gradient) MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
      g[0][p] = -a->inverse_spacing;
      g[1][p] = a->inverse_spacing;
    }
}

MPMI_BASIS(bspline1, 2)
