/* This file estimates from the pattern what each method would cost. */
#include "linalg/costs.h"

#include <math.h>

/* Counts the nodes along each axis; the longest comes first. */
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
  /* The factor spends its work on separators. They are half a stencil wide, and a long body has many of
   * them. One takes 7 times the cube of its size, and 20 of these multiplications take as long as one of a
   * product. */
  const double separator = (double)mpmi_matrix_unknowns(A) / extent[0] * half_stencil;
  const double factor = 7.0 * separator * separator * separator * extent[0] / extent[1];
  mpmi_costs c;
  c.cg = fmin(20.0 * extent[0], inertia > 0.0 ? 20.0 / sqrt(inertia) : (double)INFINITY);
  c.multigrid = 20.0 + 70.0 * half_stencil * half_stencil;
  c.factor = factor / (20.0 * entries * (double)(A->block * A->block));
  return c;
}
