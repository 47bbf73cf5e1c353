/* Direct solution: S A S = L D L^T, or L D U, with S that makes the diagonal 1 in size, without pivoting. The
 * matrix is cut by nested dissection into fronts, each of which is eliminated as a dense matrix and leaves an
 * update matrix to the front that encloses it. */
#ifndef MPMI_FACTOR_H
#define MPMI_FACTOR_H

#include "linalg/dense.h"
#include "linalg/dissection.h"

typedef struct mpmi_front {
  int32_t begin, end;   /* places of its nodes in the order of elimination */
  int32_t pivots, rows; /* unknowns eliminated here; unknowns that they couple to further on */
  int64_t first;        /* its first unknown in the order of elimination */
  int64_t panel;        /* place of its panel in the factor */
  int64_t row;          /* of its rows in the lists of rows */
  int64_t node_row;     /* and of the nodes of these */
  int32_t node_rows;
  int32_t parent, child, sibling; /* fronts, -1 none; children ascend */
  int32_t lowest;                 /* first front of those that it encloses; they end with itself */
  int32_t top;                    /* eliminated by itself, after the tasks */
  /* Places of its update matrix: while it is made, and until it is used. Of a symmetric one the lower
   * triangle is kept, column by column. */
  int64_t built, kept;
  double work; /* multiplications, with those of the fronts that it encloses */
} mpmi_front;

/* Fronts [begin, end) and what they enclose, eliminated by one thread. */
typedef struct mpmi_front_task {
  int32_t begin, end;
  int64_t scratch; /* place in the arena */
  int64_t failed;  /* unknown (in the order of elimination) with a tiny pivot, or -1 */
} mpmi_front_task;

typedef struct mpmi_factor {
  mpm_context *context;
  const mpmi_dense *kernels;
  /* Structure: kept while the pattern is the same. */
  int32_t analysed, symmetric;
  int64_t pattern_id;
  int32_t nodes, fronts, tasks;            /* nodes: those that have unknowns */
  int64_t unknowns, panels, rows, largest; /* largest: pivots and rows of a front */
  int32_t *order;                          /* [nodes] */
  int32_t *place;                          /* [rows of the matrix] place in the order, or -1 */
  int64_t *start;                          /* [nodes + 1] first unknown of a node in the order */
  mpmi_front *front;                       /* [fronts] */
  mpmi_front_task *task;                   /* [tasks] */
  int32_t *local;                          /* [entries] row of the front where the entry belongs, or -1 */
  int32_t *node_row;                       /* places of nodes, ascending in each front */
  int32_t *row;                            /* unknowns, likewise, in the order of elimination */
  int32_t *map;                            /* rows in the enclosing front */
  int64_t top_scratch, arena_size;
  /* Numbers. */
  double *lower, *upper;     /* panels */
  double *scale, *pivot, *y; /* [unknowns] in the order of elimination; y: of solutions */
  double *arena;             /* update matrices and scratch */
  int64_t negative;          /* pivots */
  int64_t skipped;           /* row of the first node with a pivot that is rounding of zero, or -1 */
  /* Memory. */
  char *slab;
  double *number;
  int64_t slab_capacity, local_capacity, node_row_capacity, row_capacity, map_capacity;
  int64_t number_capacity, panel_capacity[2], arena_capacity;
} mpmi_factor;

void mpmi_factor_init(mpmi_factor *f, mpm_context *context);
void mpmi_factor_free(mpmi_factor *f);

/* Finds order and structure, unless they are known for the pattern. (analyse.c) */
mpm_status mpmi_factor_analyse(mpmi_factor *f, const mpmi_matrix *A);
/* Which updates and scratch lie where, and which fronts are tasks. (fronts.c) */
void mpmi_factor_lay_out(mpmi_factor *f);
/* Unknowns whose pivot is rounding of zero are left out: they are 0 in solutions, and whether these are any
 * is for the residual to say. MPM_SINGULAR: *node is the row of the matrix with nothing in it, or with a
 * pivot that is not finite; MPM_NONFINITE: that with a value that is not finite. */
mpm_status mpmi_factor_numbers(mpmi_factor *f, const mpmi_matrix *A, int64_t *node);
/* What its numbers take in memory, once analysed. */
double mpmi_factor_bytes(const mpmi_factor *f);
/* Size of the smallest pivot of the scaled matrix, and the row of its node. */
double mpmi_factor_least_pivot(const mpmi_factor *f, int64_t *node);
/* Scales of the unknowns; statuses as above. (scales.c) */
mpm_status mpmi_factor_scales(mpmi_factor *f, const mpmi_matrix *A, int64_t *node);
/* x = A^-1 b; held unknowns become 0. (factor_solve.c) */
void mpmi_factor_solve(mpmi_factor *f, const mpmi_matrix *A, const double *b, double *x);

/* The unknowns of a node of the matrix: components that are not held. */
static inline int32_t mpmi_free_components(const mpmi_matrix *A, int64_t node, int32_t *component) {
  int32_t count = 0;
  for (int32_t c = 0; c < A->block; ++c)
    if (!A->held[node * A->block + c]) component[count++] = c;
  return count;
}

#endif
