/* Dense arithmetic of one front: the elimination of its pivots, panel by panel, and the two triangular
 * solutions. Compiled once for each instruction set.
 *
 * A front has `pivots` unknowns to eliminate and `rows` others that they couple to. Its panel [pivots][ld],
 * ld = pivots + rows, holds the columns of L below the diagonal; `upper` holds U transposed in the same way
 * and is the same memory where the matrix is symmetric. What the elimination leaves to other fronts goes into
 * update [rows][rows], by columns; of a symmetric one the lower triangle counts. */
#ifndef MPMI_DENSE_H
#define MPMI_DENSE_H

#include "simd/isa.h"

#include <stdint.h>

enum { MPMI_PANEL = 32 };   /* pivots per panel */
#define MPMI_NO_PIVOT 1e200 /* in the place of one that is rounding of zero: its unknown becomes 0 */

typedef struct mpmi_dense_front {
  double *lower, *upper, *update;
  double *pivot; /* [pivots] out: D */
  double *scratch;
  int64_t pivots, rows;
  double tiny;           /* a pivot of that size or less is none */
  int64_t first, width;  /* of the panel under way */
  int64_t pivot_slivers; /* groups of rows below it: of pivots, */
  int64_t slivers;       /* and of all rows */
  double inverse[MPMI_PANEL];
  double lower_block[MPMI_PANEL * MPMI_PANEL]; /* [column][row] of the panel's unit triangles */
  double upper_block[MPMI_PANEL * MPMI_PANEL];
} mpmi_dense_front;

typedef struct mpmi_dense {
  /* Rows are taken in slivers of so many, columns of the update in strips. */
  int64_t sliver, strip;
  /* Factors the panel's own block; the number of the pivot that is not finite, or -1. */
  int64_t (*factor_block)(mpmi_dense_front *front);
  /* The rows below: slivers [begin, end). */
  void (*solve_slivers)(const mpmi_dense_front *front, int64_t begin, int64_t end);
  /* What they take from the columns to the right: strips [begin, end). */
  void (*update_strips)(const mpmi_dense_front *front, int64_t begin, int64_t end);
  /* y[pivots + rows]: y of the rows minus L times that of the pivots, which are solved for ... */
  void (*forward)(const double *panel, int64_t pivots, int64_t rows, double *y);
  /* ... and y of the pivots solved for with that of the rows known. */
  void (*backward)(const double *panel, int64_t pivots, int64_t rows, double *y);
} mpmi_dense;

const mpmi_dense *mpmi_dense_of(int32_t isa);
/* Doubles of scratch for a front. */
int64_t mpmi_dense_scratch(const mpmi_dense *kernels, int64_t pivots, int64_t rows, int32_t symmetric);
/* The panel from pivot `first` on: sets first, width and the numbers of slivers. */
void mpmi_dense_panel(const mpmi_dense *kernels, mpmi_dense_front *front, int64_t first);
int64_t mpmi_dense_strips(const mpmi_dense *kernels, const mpmi_dense_front *front);

#endif
