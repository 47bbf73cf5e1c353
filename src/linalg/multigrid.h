/* Geometric multigrid on the grid's nodes: one V-cycle as a preconditioner. Each coarser level has the nodes
 * of every other grid line, the matrix P^T A P of linear interpolation P, and so the stencil of the finer
 * one; the coarsest is factored.
 *
 *   multigrid.c   the levels, and the cycle over them
 *   level.h       one level, and how it is made from the finer one:
 *   coarsen.c     its nodes, interpolation, the pattern of its matrix
 *   galerkin.c    the numbers of its matrix
 *   smoother.c    colours, and the copy of a matrix that is smoothed with
 *   sweep.c       block Gauss-Seidel, compiled once for each instruction set
 *
 * Held unknowns are out of P: a coarse one is held where the fine one at its place is, or all that it would
 * move are. Light unknowns stay in: each level is scaled to a diagonal of 1 before it is smoothed. */
#ifndef MPMI_MULTIGRID_H
#define MPMI_MULTIGRID_H

#include "linalg/factor.h"
#include "linalg/level.h"

enum { MPMI_MOST_LEVELS = 24 };

typedef struct mpmi_multigrid {
  mpm_context *context;
  const mpmi_sweeps *kernels;
  int64_t pattern_id; /* that the structure was made for */
  int32_t analysed, levels;
  mpmi_level level[MPMI_MOST_LEVELS];
  double largest_scale; /* of the first level */
  mpmi_factor coarsest;
  double *rhs, *x; /* of the coarsest */
  int64_t coarsest_capacity;
  mpmi_workspace scratch;
} mpmi_multigrid;

void mpmi_multigrid_init(mpmi_multigrid *g, mpm_context *context);
void mpmi_multigrid_free(mpmi_multigrid *g);
/* Levels and their numbers for an eliminated matrix. MPM_SINGULAR: a symmetric one is not positive definite;
 * MPM_NONFINITE: a diagonal entry is not finite; *row is that of A, or -1 if a coarser level shows it. */
mpm_status mpmi_multigrid_prepare(mpmi_multigrid *g, const mpmi_matrix *A, int64_t *row);
/* z = one cycle for A z = r. */
mpm_status mpmi_multigrid_cycle(mpmi_multigrid *g, const double *r, double *z);

#endif
