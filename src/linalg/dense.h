/* A front is eliminated as a dense matrix, panel by panel; after that come the two triangular solutions.
 * These kernels are compiled once for each instruction set. A front has `pivots` unknowns to eliminate and
 * `rows` others that they couple to. Its panel [pivots][ld], ld = pivots + rows, holds the columns of L
 * below the diagonal; `upper` holds U transposed in the same way, and is the same memory where the matrix
 * is symmetric. What the elimination leaves to other fronts goes into update [rows][rows], by columns;
 * only the lower triangle counts where the matrix is symmetric. */
#ifndef MPMI_DENSE_H
#define MPMI_DENSE_H

#include "simd/isa.h"

#include <stdint.h>

enum { MPMI_PANEL = 32 };   /* pivots per panel */
#define MPMI_NO_PIVOT 1e200 /* stands for a pivot that is rounding of zero: its unknown becomes 0 */

typedef struct mpmi_dense_front {
  double *lower, *upper, *update;
  double *pivot; /* [pivots] out: D */
  double *scratch;
  int64_t pivots, rows;
  double tiny;           /* a pivot of this size or less counts as zero */
  int64_t first, width;  /* the first pivot of the present panel, and how many it has */
  int64_t pivot_slivers; /* slivers below the panel with rows of pivots */
  int64_t slivers;       /* all slivers below the panel */
  double inverse[MPMI_PANEL];
  double lower_block[MPMI_PANEL * MPMI_PANEL]; /* [column][row] of the panel's unit triangles */
  double upper_block[MPMI_PANEL * MPMI_PANEL];
} mpmi_dense_front;

typedef struct mpmi_dense {
  /* The sizes of a sliver of rows and of a strip of the columns of the update. */
  int64_t sliver, strip;
  /* Factors the panel's own block. Returns the number of a pivot that is not finite, or -1. */
  int64_t (*factor_block)(mpmi_dense_front *front);
  /* Solves for the rows below the block, slivers [begin, end). */
  void (*solve_slivers)(const mpmi_dense_front *front, int64_t begin, int64_t end);
  /* Subtracts their product from the columns to the right, strips [begin, end). */
  void (*update_strips)(const mpmi_dense_front *front, int64_t begin, int64_t end);
  /* Solves with L for the pivots of y [pivots + rows], and subtracts their part from its rows. */
  void (*forward)(const double *panel, int64_t pivots, int64_t rows, double *y);
  /* Solves with L transposed, or U, for the pivots of y, whose rows are known. */
  void (*backward)(const double *panel, int64_t pivots, int64_t rows, double *y);
} mpmi_dense;

const mpmi_dense *mpmi_dense_of(int32_t isa);
/* How many doubles of scratch a front needs. */
int64_t mpmi_dense_scratch(const mpmi_dense *kernels, int64_t pivots, int64_t rows, int32_t symmetric);
/* Turns to the panel that begins at pivot `first`: sets first, width and the numbers of slivers. */
void mpmi_dense_panel(const mpmi_dense *kernels, mpmi_dense_front *front, int64_t first);
int64_t mpmi_dense_strips(const mpmi_dense *kernels, const mpmi_dense_front *front);
/* How many pieces of a size make up a count; the last piece may be shorter. */
static inline int64_t mpmi_dense_pieces(int64_t count, int64_t size) {
  return (count + size - 1) / size;
}

#endif
