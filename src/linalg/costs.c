/* What each method would cost, as far as can be said from the pattern. */
#include "linalg/costs.h"

#include <math.h>

/* Nodes along the axes, longest first. */
static void extents_of(const mpmi_matrix *A, double *extent) {
  for (int32_t k = 0; k < 3; ++k) {
    int64_t low = A->rows ? A->index[0][k] : 0, high = low;
    for (int64_t i = 1; i < A->rows; ++i) {
      if (A->index[i][k] < low) low = A->index[i][k];
      if (A->index[i][k] > high) high = A->index[i][k];
    }
    int32_t at = k;
    for (; at > 0 && extent[at - 1] < (double)(high - low + 1); --at) extent[at] = extent[at - 1];
    extent[at] = (double)(high - low + 1);
  }
}

mpmi_costs mpmi_costs_of(const mpmi_matrix *A, double inertia) {
  double extent[3];
  extents_of(A, extent);
  const double entries = (double)A->row_start[A->rows], rows = (double)A->rows;
  const double dim = 1.0 + (extent[1] > 1.0) + (extent[2] > 1.0);
  const double half_stencil = fmax(1.0, 0.5 * (pow(entries / rows, 1.0 / dim) - 1.0));
  /* work of the factor is that of its separators, as wide as half a stencil, of which a long body has many:
   * 7 times the cube of one, and 20 multiplications in the time of one of a product */
  const double separator = (double)mpmi_matrix_unknowns(A) / extent[0] * half_stencil;
  const double factor = 7.0 * separator * separator * separator * extent[0] / extent[1];
  mpmi_costs c;
  c.cg = fmin(20.0 * extent[0], inertia > 0.0 ? 20.0 / sqrt(inertia) : (double)INFINITY);
  c.multigrid = 20.0 + 70.0 * half_stencil * half_stencil;
  c.factor = factor / (20.0 * entries * (double)(A->block * A->block));
  return c;
}
