/* One V-cycle of geometric multigrid on the grid's nodes is a preconditioner. Each coarser level has the
 * nodes of every other grid line and the matrix P^T A P, where P interpolates linearly; so its stencil is
 * that of the finer level. The coarsest level is factored. Wide stencils have a second hierarchy, of
 * functions that change their sign from node to node.
 *
 *   multigrid.c   the hierarchies, and the cycle over their levels
 *   hierarchy.h   the levels from the matrix to the coarsest one
 *   level.h       one level; level.c: memory and tasks
 *   coarsen.c     nodes of the next level, interpolation, the pattern of its matrix
 *   galerkin.c    the numbers of its matrix
 *   lines.c       lines of unknowns that are solved for together, and their colours
 *   smoother.c    the copy of a matrix that is smoothed with, and the factors of its lines
 *   sweep.c       line Gauss-Seidel, compiled once for each instruction set
 *
 * P leaves held unknowns out. A coarse unknown is held where the fine one at its place is, or where all fine
 * ones that it would move are. Unknowns with a small diagonal stay in, because each level is scaled to a
 * diagonal of 1 before it is smoothed. */
#ifndef MPMI_MULTIGRID_H
#define MPMI_MULTIGRID_H

#include "linalg/hierarchy.h"

typedef struct mpmi_multigrid {
  mpm_context *context;
  const mpmi_sweeps *kernels;
  int64_t pattern_id; /* the pattern that the structure was made for */
  int32_t analysed;
  mpmi_hierarchy smooth, alternating; /* the first level is smoothed by `smooth` alone */
  double largest_scale;               /* the largest scale of the first level */
  mpmi_level_memory scratch;
} mpmi_multigrid;

void mpmi_multigrid_init(mpmi_multigrid *g, mpm_context *context);
void mpmi_multigrid_free(mpmi_multigrid *g);
/* Makes the levels and their numbers for an eliminated matrix. MPM_SINGULAR: a symmetric matrix is not
 * positive definite. MPM_NONFINITE: a diagonal entry is not finite. *row is the row of A that shows it, or
 * -1 if a coarser level does. */
mpm_status mpmi_multigrid_prepare(mpmi_multigrid *g, const mpmi_matrix *A, int64_t *row);
/* Sets z to what one cycle makes of A z = r. */
mpm_status mpmi_multigrid_cycle(mpmi_multigrid *g, const double *r, double *z);

#endif
