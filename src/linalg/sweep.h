/* Line Gauss-Seidel smooths one level in single precision, because it only prepares an iteration in double
 * precision. A line is a component of the nodes along its own axis: x of a row of nodes along x, y of one
 * along y. Its unknowns are solved for together, since matter that hardly changes its volume ties them to
 * each other more than to anything beside. The level is scaled, S A S. Lines of one colour do not couple and
 * can be taken at the same time. Vectors have four places for the three unknowns of a node; the last one
 * holds nothing of meaning. */
#ifndef MPMI_SWEEP_H
#define MPMI_SWEEP_H

#include "linalg/matrix.h"

#define MPMI_PADDED(block) ((block) == 3 ? 4 : (block))

/* Unknowns of a line couple over so many places at most; where they reach farther, another line begins. */
enum { MPMI_MOST_BAND = 8 };

/* The lines of a level. Held unknowns are on none. */
typedef struct mpmi_lines {
  int64_t count, unknowns;
  int32_t colours;
  int64_t *colour_start; /* [colours + 1] lines in the order of colours */
  int64_t *start;        /* [count + 1] places in the order of lines */
  int32_t *unknown;      /* [unknowns] by place: block * row + component */
  int32_t *place;        /* [rows * block] place by unknown, or -1 */
  int32_t *band;         /* [count] over how many places unknowns of a line couple */
} mpmi_lines;

typedef struct mpmi_smoother {
  int32_t block;
  int64_t rows;
  mpmi_lines lines;
  int64_t *value_start, *factor_start; /* [lines] */
  const int64_t *row_start;            /* of the matrix, as column */
  const int32_t *column;
  float *value;  /* by place: the row of S A S without those entries that couple within the line */
  float *factor; /* by place: band multipliers, the inverse pivot, band entries of the upper factor over it */
  double *scale, *unscale;   /* [rows * block] S and 1 / S, both 0 at held unknowns */
  float *half;               /* by place: what a sweep has of a line on its way */
  float *rhs, *x, *residual; /* [rows], padded; 0 at held unknowns */
  char *slab, *lines_slab;
  int64_t slab_capacity, lines_capacity;
} mpmi_smoother;

/* A sweep takes the lines [begin, end). */
typedef void (*mpmi_sweep_fn)(const mpmi_smoother *s, int64_t begin, int64_t end);
typedef struct mpmi_sweeps {
  /* Solves for x on each line, from rhs less what is off the line; `residual` keeps this difference. */
  mpmi_sweep_fn solve;
  /* Makes the residual: that difference with the present x, less the one that was kept. */
  mpmi_sweep_fn residual;
} mpmi_sweeps;
const mpmi_sweeps *mpmi_sweeps_of(int32_t isa);

/* Finds the lines of a matrix, and colours them (lines.c). */
mpm_status mpmi_lines_find(mpmi_smoother *s, const mpmi_matrix *A);

/* These belong to smoother.c. The first makes the structure for a matrix. The second makes the numbers:
 * MPM_SINGULAR or MPM_NONFINITE where the diagonal of *row is not > 0 or not finite. */
mpm_status mpmi_smoother_analyse(mpmi_smoother *s, const mpmi_matrix *A);
mpm_status mpmi_smoother_numbers(mpmi_smoother *s, const mpmi_matrix *A, int64_t *row);
void mpmi_smoother_free(mpmi_smoother *s, mpm_context *context);

#endif
