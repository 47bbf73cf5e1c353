/* Sparse matrices of small dense blocks: one block row per node, 1 to 3 unknowns each. Vectors hold the
 * unknowns of a node side by side. */
#ifndef MPMI_MATRIX_H
#define MPMI_MATRIX_H

#include "context/context.h"

typedef struct mpmi_matrix {
  mpm_context *context;
  int32_t block;                        /* 1, 2 or 3 unknowns per node */
  int32_t symmetric;                    /* value is symmetric: solvers may use it */
  int64_t rows;                         /* nodes = block rows */
  int64_t row_capacity, entry_capacity; /* of mpmi_matrix_reserve() */
  int64_t *row_start;                   /* [rows + 1], in blocks */
  int32_t *column;     /* [entries] ascending within a row, diagonal always present; pattern symmetric */
  double *value;       /* [entries][block * block], row-major: row of the block, column of the block */
  uint8_t *held;       /* [rows * block] 1: not an unknown */
  int64_t (*index)[3]; /* [rows] integer grid index of the node; unused axes 0 */
  int64_t *number;     /* [rows] reported node number (mpm_step_info.node) */
  double *position;    /* [rows][3] */
  int64_t period[3];   /* nodes along a periodic axis, else 0 */
  int64_t pattern_id;  /* changes whenever the pattern or held does */
} mpmi_matrix;

void mpmi_matrix_init(mpmi_matrix *A, mpm_context *context);
void mpmi_matrix_free(mpmi_matrix *A);
/* Room for so many; what was there is lost. Sets rows and block. Without memory the matrix is left empty. */
mpm_status mpmi_matrix_reserve(mpmi_matrix *A, int64_t rows, int64_t entries, int32_t block);
/* Rows and columns of held unknowns become those of the identity; what they did to the right-hand side is the
 * caller's to subtract before. */
mpm_status mpmi_matrix_eliminate(mpmi_matrix *A);

/* y = A x over all rows, held ones too (apply.c). */
mpm_status mpmi_matrix_apply(const mpmi_matrix *A, const double *x, double *y);
/* The same, and x . y. */
mpm_status mpmi_matrix_apply_dot(const mpmi_matrix *A, const double *x, double *y, double *dot);
/* r = b - A x, and its norm. */
mpm_status mpmi_matrix_residual(const mpmi_matrix *A, const double *b, const double *x, double *r,
                                double *norm);
/* What rounding may leave of a residual: a norm of |A| |x| + |b| times a few units of the last place. */
mpm_status mpmi_matrix_rounding(const mpmi_matrix *A, const double *b, const double *x, double *scratch,
                                double *norm);

/* The inverse of a block of n unknowns in place; 0 if there is none. */
int32_t mpmi_invert_block(int32_t n, double a[3][3]);

static inline int64_t mpmi_matrix_unknowns(const mpmi_matrix *A) {
  return A->rows * A->block;
}

#endif
