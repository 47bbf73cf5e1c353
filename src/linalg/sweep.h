/* Block Gauss-Seidel of one level, in single precision: it only prepares the way of an iteration in double.
 *
 * The level is scaled, S A S, and its nodes are ordered by colour: those of one colour do not couple, and may
 * be taken at the same time. Entries of a row are those of nodes before it, then those after it; blocks are
 * kept by columns. Vectors have four places for the three unknowns of a node: the last one holds nothing of
 * meaning. */
#ifndef MPMI_SWEEP_H
#define MPMI_SWEEP_H

#include "linalg/matrix.h"

#define MPMI_PADDED(block) ((block) == 3 ? 4 : (block))

typedef struct mpmi_smoother {
  int32_t block, colours;
  int64_t rows;
  int64_t *colour_start;       /* [colours + 1] rows in the order of colours */
  int32_t *order, *place;      /* [rows] row of A at a place, and back */
  int64_t *row_start, *middle; /* [rows + 1] entries by place; middle: the first of nodes that come later */
  int32_t *column;             /* [entries] places */
  float *value, *inverse;      /* blocks of S A S but the diagonal ones; of those the inverses */
  double *scale, *unscale;     /* [rows * block], by place: S and 1 / S, both 0 at held unknowns */
  float *rhs, *x, *residual;   /* by place, padded */
  char *slab;
  int64_t slab_capacity;
} mpmi_smoother;

/* Rows [begin, end) by place. */
typedef void (*mpmi_sweep_fn)(const mpmi_smoother *s, int64_t begin, int64_t end);
typedef struct mpmi_sweeps {
  mpmi_sweep_fn from_zero; /* x of rhs, with what comes before; x of what comes later is 0 */
  mpmi_sweep_fn residual;  /* what that leaves: of a row only what comes later */
  mpmi_sweep_fn full;      /* x of rhs with all others */
} mpmi_sweeps;
const mpmi_sweeps *mpmi_sweeps_of(int32_t isa);

/* smoother.c: structure of a matrix; scratch: [2 rows]. Numbers: MPM_SINGULAR, MPM_NONFINITE where the
 * diagonal at *row is not > 0 or not finite. */
mpm_status mpmi_smoother_analyse(mpmi_smoother *s, const mpmi_matrix *A, int32_t *scratch);
mpm_status mpmi_smoother_numbers(mpmi_smoother *s, const mpmi_matrix *A, int64_t *row);
void mpmi_smoother_free(mpmi_smoother *s, mpm_context *context);

#endif
