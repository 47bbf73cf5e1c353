/* The direct solver factors S A S = L D L^T, or L D U, without pivoting; S makes the diagonal 1 in size.
 * The matrix is cut by nested dissection into fronts. Each front is eliminated as a dense matrix and
 * leaves an update matrix to the front that encloses it. */
#ifndef MPMI_FACTOR_H
#define MPMI_FACTOR_H

#include "linalg/dense.h"
#include "linalg/dissection.h"

typedef struct mpmi_front {
  int32_t begin, end;   /* places of its nodes in the order of elimination */
  int32_t pivots, rows; /* unknowns eliminated here, and later unknowns that they couple to */
  int64_t first;        /* its first unknown in the order of elimination */
  int64_t panel;        /* place of its panel in the factor */
  int64_t row;          /* place of its rows in `row` and `map` */
  int64_t node_row;     /* place of the nodes of its rows in `node_row` */
  int32_t node_rows;
  int32_t parent, child, sibling; /* fronts, or -1; the numbers of children ascend */
  int32_t lowest;                 /* it encloses the fronts from this one to itself */
  int32_t top;                    /* 1: eliminated after the tasks, by all threads together */
  /* The places of its update matrix in the arena: `built` while it is made, `kept` until it is used. Where
   * the matrix is symmetric the lower triangle is kept, column by column. */
  int64_t built, kept;
  double work; /* multiplications of this front and of those that it encloses */
} mpmi_front;

/* One thread eliminates the fronts [begin, end) and what they enclose. */
typedef struct mpmi_front_task {
  int32_t begin, end;
  int64_t scratch; /* place in the arena */
  int64_t failed;  /* unknown (in the order of elimination) with a pivot that is not finite, or -1 */
} mpmi_front_task;

typedef struct mpmi_factor {
  mpm_context *context;
  const mpmi_dense *kernels;
  /* The structure is kept while the pattern is the same. */
  int32_t analysed, symmetric;
  int64_t pattern_id;
  int32_t nodes, fronts, tasks;            /* nodes: only those that have unknowns */
  int64_t unknowns, panels, rows, largest; /* largest: the most pivots and rows that one front has */
  int32_t *order;                          /* [nodes] */
  int32_t *place;                          /* [rows of the matrix] place in the order, or -1 */
  int64_t *start;                          /* [nodes + 1] first unknown of a node in the order */
  mpmi_front *front;                       /* [fronts] */
  mpmi_front_task *task;                   /* [tasks] */
  int32_t *local;                          /* [entries] row of the front where the entry belongs, or -1 */
  int32_t *node_row;                       /* places of nodes, ascending in each front */
  int32_t *row;                            /* unknowns of these nodes, in the order of elimination */
  int32_t *map;                            /* the row of the enclosing front for each entry of `row` */
  int64_t top_scratch, arena_size;
  /* The numbers are made anew for each matrix. */
  double *lower, *upper;     /* panels */
  double *scale, *pivot, *y; /* [unknowns] in the order of elimination; y: scratch of solutions */
  double *arena;             /* update matrices and scratch */
  int64_t negative;          /* how many pivots are negative */
  int64_t skipped;           /* row of the first node with a pivot that is rounding of zero, or -1 */
  /* Lists above share these pieces of memory. */
  char *slab;
  double *number;
  int64_t slab_capacity, local_capacity, node_row_capacity, row_capacity, map_capacity;
  int64_t number_capacity, panel_capacity[2], arena_capacity;
} mpmi_factor;

void mpmi_factor_init(mpmi_factor *f, mpm_context *context);
void mpmi_factor_free(mpmi_factor *f);

/* Finds order and structure, unless they are known for the pattern (analyse.c). */
mpm_status mpmi_factor_analyse(mpmi_factor *f, const mpmi_matrix *A);
/* Decides where updates and scratch lie, and which fronts are tasks (fronts.c). */
void mpmi_factor_lay_out(mpmi_factor *f);
/* Makes the numbers of the factor (eliminate.c). An unknown whose pivot is rounding of zero is left out:
 * it is 0 in every answer of mpmi_factor_solve(), and the residual shows whether such an answer is a
 * solution. MPM_SINGULAR: *node is the row of the matrix that is empty or has a pivot that is not finite.
 * MPM_NONFINITE: *node is the row with a value that is not finite. */
mpm_status mpmi_factor_numbers(mpmi_factor *f, const mpmi_matrix *A, int64_t *node);
/* How many bytes its numbers take, once it is analysed. */
double mpmi_factor_bytes(const mpmi_factor *f);
/* Returns the size of the smallest pivot of the scaled matrix; *node is the row of its node. */
double mpmi_factor_least_pivot(const mpmi_factor *f, int64_t *node);
/* Finds the scales S of the unknowns, with the same statuses (scales.c). */
mpm_status mpmi_factor_scales(mpmi_factor *f, const mpmi_matrix *A, int64_t *node);
/* Sets x = A^-1 b; held unknowns become 0 (factor_solve.c). */
void mpmi_factor_solve(mpmi_factor *f, const mpmi_matrix *A, const double *b, double *x);

/* Lists the components of a node that are not held, which are its unknowns. */
static inline int32_t mpmi_free_components(const mpmi_matrix *A, int64_t node, int32_t *component) {
  int32_t count = 0;
  for (int32_t c = 0; c < A->block; ++c)
    if (!A->held[node * A->block + c]) component[count++] = c;
  return count;
}

#endif
