/* Weights: B-splines by the recursion of Cox and de Boor over their knots, GIMP by integrating the hat
 * function over the domain of the particle piece by piece. */
#include "reference.h"

reference_axis reference_axis_of(const mpm_grid_desc *grid, int32_t axis) {
  return (reference_axis){grid->basis, grid->boundary_basis, grid->cells[axis], grid->origin[axis],
                          grid->spacing[axis]};
}

static int32_t degree_of(int32_t basis) {
  return basis == MPM_BSPLINE2 ? 2 : basis == MPM_BSPLINE3 ? 3 : 1;
}

int64_t reference_first(const reference_axis *a) {
  return a->basis == MPM_LINEAR || (a->basis == MPM_BSPLINE2 && a->boundary == MPM_BOUNDARY_OPEN_KNOT) ? 0
                                                                                                       : -1;
}

int64_t reference_last(const reference_axis *a) {
  return a->basis == MPM_LINEAR ? a->cells : a->cells + 1;
}

/* Knots of a function in cells, degree + 2 of them: open ones are those outside
 * the grid moved onto its faces. */
static void knots_of(const reference_axis *a, int64_t index, double *knot) {
  const int32_t degree = degree_of(a->basis), open = a->boundary == MPM_BOUNDARY_OPEN_KNOT;
  const double first = (double)index - (open && degree == 2 ? 2.0 : 0.5 * (degree + 1));
  for (int32_t j = 0; j < degree + 2; ++j)
    knot[j] = open ? fmin(fmax(first + j, 0.0), (double)a->cells) : first + j;
}

double reference_node(const reference_axis *a, int64_t index) {
  double knot[5], sum = 0.0;
  if (a->boundary != MPM_BOUNDARY_OPEN_KNOT) return a->origin + (double)index * a->spacing;
  const int32_t degree = degree_of(a->basis);
  knots_of(a, index, knot);
  for (int32_t j = 1; j <= degree; ++j) sum += knot[j];
  return a->origin + a->spacing * sum / degree;
}

static double ratio(double above, double below) {
  return below > 0.0 ? above / below : 0.0;
}

/* inside: a point between the same two knots as x, which says on which side of a knot x is. */
static double spline(const double *knot, int32_t degree, double x, double inside) {
  if (degree == 0) return knot[0] < inside && inside < knot[1] ? 1.0 : 0.0;
  return ratio(x - knot[0], knot[degree] - knot[0]) * spline(knot, degree - 1, x, inside) +
         ratio(knot[degree + 1] - x, knot[degree + 1] - knot[1]) * spline(knot + 1, degree - 1, x, inside);
}

/* Mean of the hat function at zero, and of its slope, over middle + edge * (-1/2 ... 1/2); in cells. */
static void mean_of_hat(double middle, double edge, double *w, double *g) {
  double at[5] = {-0.5, -0.5, -0.5, -0.5, 0.5};
  *w = *g = 0.0;
  for (int32_t k = 0; k < 3; ++k) at[k + 1] = fmin(fmax((k - 1 - middle) / edge, -0.5), 0.5);
  for (int32_t k = 0; k < 4; ++k) {
    const double length = at[k + 1] - at[k], x = middle + edge * 0.5 * (at[k] + at[k + 1]);
    if (fabs(x) >= 1.0) continue;
    *w += length * (1.0 - fabs(x));
    *g += length * (x > 0.0 ? -1.0 : 1.0);
  }
}

void reference_function(const reference_axis *a, int64_t index, double x, double edge, double *w, double *g) {
  const double xi = (x - a->origin) / a->spacing;
  if (is_gimp(a->basis)) {
    mean_of_hat(xi - (double)index, edge / a->spacing, w, g);
  } else {
    const int32_t degree = degree_of(a->basis);
    const int32_t halves = degree == 2 && a->boundary == MPM_BOUNDARY_GHOST; /* knots between the nodes */
    const double inside = halves ? floor(xi + 0.5) : fmin(floor(xi), (double)a->cells - 1.0) + 0.5;
    double knot[5];
    knots_of(a, index, knot);
    *w = spline(knot, degree, xi, inside);
    *g = degree * (ratio(spline(knot, degree - 1, xi, inside), knot[degree] - knot[0]) -
                   ratio(spline(knot + 1, degree - 1, xi, inside), knot[degree + 1] - knot[1]));
  }
  *g /= a->spacing;
}

double reference_edge(const mpm_grid_desc *grid, int32_t axis, double size, double F_ii) {
  const double h = grid->spacing[axis];
  if (grid->basis == MPM_UGIMP) return grid->smoothing * h;
  if (grid->basis == MPM_CPGIMP) return fmin(fmax(size * fabs(F_ii), 1e-6 * h), h);
  return size;
}

double reference_reach(const basis_option *b) {
  return is_gimp(b->basis) ? 1.5 : 0.5 * (degree_of(b->basis) + 1);
}
