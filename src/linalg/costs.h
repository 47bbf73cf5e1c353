/* The cost of each method is estimated, so that the cheapest can be taken. */
#ifndef MPMI_COSTS_H
#define MPMI_COSTS_H

#include "linalg/matrix.h"

/* Costs are in products of the matrix with a vector, measured on bodies of soft matter. Iterations of CG grow
 * with the number of nodes in a row, or with the step: inertia is its share of the diagonal. Cycles of
 * multigrid grow with the overlap of stencils, because nodes at the rim of a body then share few particles.
 */
typedef struct mpmi_costs {
  double cg, multigrid, factor;
} mpmi_costs;

mpmi_costs mpmi_costs_of(const mpmi_matrix *A, double inertia);

#endif
