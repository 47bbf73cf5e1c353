/* Geometric multigrid on the grid's nodes: one V-cycle as a preconditioner. Each coarser level has the nodes
 * of every other grid line, the matrix P^T A P of linear interpolation P, and so the stencil of the finer
 * one; the coarsest is factored.
 *
 *   multigrid.c   the levels, and the cycle over them
 *   coarsen.c     nodes of the next level, interpolation, pattern of its matrix
 *   galerkin.c    its numbers
 *   smoother.c    colours, and the copy of a matrix that is smoothed with
 *   sweep.c       block Gauss-Seidel, compiled once for each instruction set
 *
 * Held unknowns are out of P: a coarse one is held where the fine one at its place is, or all that it would
 * move are. Light unknowns stay in: each level is scaled to a diagonal of 1 before it is smoothed. */
#ifndef MPMI_MULTIGRID_H
#define MPMI_MULTIGRID_H

#include "linalg/factor.h"
#include "linalg/sweep.h"
#include "linalg/vectors.h"

enum { MPMI_MOST_LEVELS = 24 };

/* Nodes of a level and those of the next. */
typedef struct mpmi_coarsening {
  int64_t *parent_start; /* [rows + 1] */
  int32_t *parent;       /* coarse nodes that a node lies between; each has the weight 1 / their number */
  int64_t *child_start;  /* [coarse rows + 1] */
  int32_t *child;        /* nodes that a coarse one is a parent of */
  int64_t most_nodes;    /* that couple with the children of a node */
  char *slab;
  int64_t slab_capacity;
} mpmi_coarsening;

typedef struct mpmi_level {
  const mpmi_matrix *A; /* of the system, or own */
  mpmi_matrix own;
  mpmi_coarsening next; /* but for the coarsest */
  mpmi_smoother smoother;
} mpmi_level;

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
  char *scratch;
  int64_t scratch_capacity;
} mpmi_multigrid;

void mpmi_multigrid_init(mpmi_multigrid *g, mpm_context *context);
void mpmi_multigrid_free(mpmi_multigrid *g);
/* Levels and their numbers for an eliminated matrix. MPM_SINGULAR: a symmetric one is not positive definite;
 * MPM_NONFINITE: a diagonal entry is not finite; *row is that of A, or -1 if a coarser level shows it. */
mpm_status mpmi_multigrid_prepare(mpmi_multigrid *g, const mpmi_matrix *A, int64_t *row);
/* z = one cycle for A z = r. */
mpm_status mpmi_multigrid_cycle(mpmi_multigrid *g, const double *r, double *z);

/* Tasks with scratch of their own: as many as run at once, one where threads are not worth waking. */
static inline mpmi_chunks mpmi_multigrid_tasks(const mpmi_multigrid *g, const mpmi_matrix *A) {
  const int32_t alone = mpmi_matrix_unknowns(A) < MPMI_ALONE_UNKNOWNS;
  const int64_t count = alone ? 1 : g->context->concurrency;
  return (mpmi_chunks){.items = count, .size = 1, .count = count, .alone = alone};
}

/* coarsen.c: the next level of l; its own matrix gets pattern and held unknowns. */
mpm_status mpmi_coarsen(mpmi_multigrid *g, const mpmi_level *l, mpmi_level *next, mpmi_coarsening *to);
/* galerkin.c */
mpm_status mpmi_galerkin(mpmi_multigrid *g, const mpmi_level *fine, mpmi_level *coarse);
/* Scratch for so many bytes, that lasts until the next call. */
mpm_status mpmi_multigrid_scratch(mpmi_multigrid *g, size_t bytes);

#endif
