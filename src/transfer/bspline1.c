/* Linear basis (Steffen et al. 2008 eq. 17): node i and i + 1 of the cell that holds the particle. */
#include "transfer/basis.h"

MPMI_INLINE void bspline1_axis(const mpmi_axis *a, int64_t n, const mpmi_chunk *at, int32_t gradient,
                               const mpmi_stencils *out) {
  double(*w)[MPMI_CHUNK] = out->w, (*g)[MPMI_CHUNK] = out->g;
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    double xi = (at->x[p] - a->origin) * a->inverse_spacing, cell = mpmi_cell(a, xi), f = xi - cell;
    w[0][p] = 1.0 - f;
    w[1][p] = f;
    out->first[p] = -f;
    out->place[p] = cell - a->tile_base;
  }
  mpmi_into_tile(a, n, out->place);
  if (gradient) MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
      g[0][p] = -a->inverse_spacing;
      g[1][p] = a->inverse_spacing;
    }
}

MPMI_BASIS(bspline1, 2, EVEN)
