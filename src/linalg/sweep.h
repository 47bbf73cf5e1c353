/* Block Gauss-Seidel smooths one level in single precision, because it only prepares an iteration in
 * double precision. The level is scaled, S A S, and its nodes are ordered by colour: nodes of one colour
 * do not couple and can be taken at the same time. A row has first the entries of nodes before it, then
 * those of nodes after it; blocks are kept by columns. Vectors have four places for the three unknowns of
 * a node; the last one holds nothing of meaning. */
#ifndef MPMI_SWEEP_H
#define MPMI_SWEEP_H

#include "linalg/matrix.h"

#define MPMI_PADDED(block) ((block) == 3 ? 4 : (block))

typedef struct mpmi_smoother {
  int32_t block, colours;
  int64_t rows;
  int64_t *colour_start;       /* [colours + 1] rows in the order of colours */
  int32_t *order, *place;      /* [rows] row of A by place; place by row of A */
  int64_t *row_start, *middle; /* [rows + 1] entries by place; middle: the first of nodes that come later */
  int32_t *column;             /* [entries] places */
  float *value, *inverse;      /* blocks of S A S off the diagonal; inverses of those on it */
  double *scale, *unscale;     /* [rows * block], by place: S and 1 / S, both 0 at held unknowns */
  float *rhs, *x, *residual;   /* by place, padded */
  char *slab;
  int64_t slab_capacity;
} mpmi_smoother;

/* A sweep takes the rows at the places [begin, end). */
typedef void (*mpmi_sweep_fn)(const mpmi_smoother *s, int64_t begin, int64_t end);
typedef struct mpmi_sweeps {
  mpmi_sweep_fn from_zero; /* solves for x from rhs and the rows before; x of the rows after is 0 */
  mpmi_sweep_fn residual;  /* the residual that this leaves, which only rows after can cause */
  mpmi_sweep_fn full;      /* solves for x from rhs and all other rows */
} mpmi_sweeps;
const mpmi_sweeps *mpmi_sweeps_of(int32_t isa);

/* These belong to smoother.c. The first makes the structure for a matrix; scratch: [2 rows]. The second
 * makes the numbers: MPM_SINGULAR or MPM_NONFINITE where the diagonal of *row is not > 0 or not finite. */
mpm_status mpmi_smoother_analyse(mpmi_smoother *s, const mpmi_matrix *A, int32_t *scratch);
mpm_status mpmi_smoother_numbers(mpmi_smoother *s, const mpmi_matrix *A, int64_t *row);
void mpmi_smoother_free(mpmi_smoother *s, mpm_context *context);

#endif
