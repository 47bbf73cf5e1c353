/* Sparse matrices are made of small dense blocks: each node has one block row and 1 to 3 unknowns. Vectors
 * hold the unknowns of a node side by side. */
#ifndef MPMI_MATRIX_H
#define MPMI_MATRIX_H

#include "linalg/rows.h"

typedef struct mpmi_matrix {
  mpm_context *context;
  int32_t block;                        /* 1, 2 or 3 unknowns per node */
  int32_t symmetric;                    /* value is symmetric: solvers may use it */
  int64_t rows;                         /* nodes = block rows */
  int64_t row_capacity, entry_capacity; /* the room that mpmi_matrix_reserve() has made */
  int64_t *row_start;                   /* [rows + 1], in blocks */
  int32_t *column;     /* [entries] ascending within a row, diagonal always present; pattern symmetric */
  double *value;       /* [entries][block * block], row-major: row of the block, column of the block */
  uint8_t *held;       /* [rows * block] 1: not an unknown */
  int64_t (*index)[3]; /* [rows] integer grid index of the node; unused axes 0 */
  int64_t *number;     /* [rows] reported node number (mpm_step_info.node) */
  double *position;    /* [rows][3] */
  int64_t period[3];   /* nodes along a periodic axis, else 0 */
  int64_t pattern_id;  /* changes whenever the pattern or held does */
  /* Of several parts: whose rows these are; only own ones are complete, and products and norms are those of
   * them. NULL: all rows are here. */
  const mpmi_rows *shared;
} mpmi_matrix;

void mpmi_matrix_init(mpmi_matrix *A, mpm_context *context);
void mpmi_matrix_free(mpmi_matrix *A);
/* Makes room for so many rows and entries, and sets rows and block; what was there is lost. On failure the
 * matrix is left empty. */
mpm_status mpmi_matrix_reserve(mpmi_matrix *A, int64_t rows, int64_t entries, int32_t block);
/* Makes rows and columns of held unknowns those of the identity. The caller has subtracted their part from
 * the right-hand side before. */
mpm_status mpmi_matrix_eliminate(mpmi_matrix *A);

/* Sets y = A x over all rows, those of held unknowns too (apply.c). */
mpm_status mpmi_matrix_apply(const mpmi_matrix *A, const double *x, double *y);
/* Does the same, and sets *dot = x . y, unless something has failed before, which status says. With several
 * parts all calls that make a sum return the same status on all of them. */
mpm_status mpmi_matrix_apply_dot(const mpmi_matrix *A, const double *x, double *y, double *dot,
                                 mpm_status status);
/* Sets r = b - A x, and *norm to its norm. */
mpm_status mpmi_matrix_residual(const mpmi_matrix *A, const double *b, const double *x, double *r,
                                double *norm);
/* Sets *norm to what rounding may leave of a residual: the norm of |A| |x| + |b| times a few units of the
 * last place. */
mpm_status mpmi_matrix_rounding(const mpmi_matrix *A, const double *b, const double *x, double *scratch,
                                double *norm);

/* Inverts a block of n unknowns in place. Returns 0 if it has no inverse. */
int32_t mpmi_invert_block(int32_t n, double a[3][3]);

/* Returns the entry of a row that is in the pattern with this column. */
static inline int64_t mpmi_matrix_entry(const mpmi_matrix *A, int64_t row, int64_t column) {
  int64_t low = A->row_start[row], high = A->row_start[row + 1] - 1;
  while (low < high) {
    const int64_t middle = low + (high - low) / 2;
    if (A->column[middle] < column)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* Returns 1 for the rows that are complete here. */
static inline int32_t mpmi_is_own_row(const mpmi_matrix *A, int64_t row) {
  return !A->shared || A->shared->own[row];
}

static inline int64_t mpmi_matrix_unknowns(const mpmi_matrix *A) {
  return A->rows * A->block;
}

#endif
