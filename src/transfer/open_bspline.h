/* B-splines on an open knot vector (Steffen et al. 2008 section 3.2, eqs 22-23): knots are the nodes of the
 * grid, repeated at the faces so often that one function alone is 1 there. Cell c sees the knots c - 2 ... c
 * + 3, those beyond a face drawn onto it; the recursion over the degree, from the linear functions of the
 * cell, is written out. Coefficients stand at the Greville points, the means of a function's inner knots. */
#ifndef MPMI_OPEN_BSPLINE_H
#define MPMI_OPEN_BSPLINE_H

#include "transfer/basis.h"

/* Knots around a cell relative to the particle: below and above it, the nearest first. */
typedef struct mpmi_knots {
  double below[3], above[3];
} mpmi_knots;

MPMI_INLINE mpmi_knots mpmi_knots_of(const mpmi_axis *a, double cell, double xi) {
  mpmi_knots t;
  for (int32_t i = 0; i < 3; ++i) {
    double low = cell - i, high = cell + 1.0 + i;
    low = low < a->first_knot ? a->first_knot : low;
    high = high > a->last_knot ? a->last_knot : high;
    t.below[i] = xi - low;
    t.above[i] = high - xi;
  }
  return t;
}

/* One step of the recursion: the parts q_j = N_j / (width of its support) of degree d - 1, j = 0 ... d - 1,
 * give the d + 1 functions of degree d; their gradients are d (q_j-1 - q_j). */
MPMI_INLINE void mpmi_raise(int32_t degree, const mpmi_knots *t, const double *lower, double *q, double *N) {
  double carried = 0.0;
  for (int32_t j = 0; j < degree; ++j) {
    q[j] = lower[j] / (t->below[degree - 1 - j] + t->above[j]);
    N[j] = carried + t->above[j] * q[j];
    carried = t->below[degree - 1 - j] * q[j];
  }
  N[degree] = carried;
}

#endif
