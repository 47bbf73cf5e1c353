/* Products of a block matrix with a vector are made here: tasks take ranges of rows, and each size of the
 * blocks has a loop of its own. */
#include <float.h>
#include <math.h>

#include "context/reduce.h"
#include "linalg/matrix.h"
#include "linalg/vectors.h"
#include "simd/isa.h"

enum { PRODUCT, RESIDUAL, ROUNDING };

typedef struct apply_job {
  const mpmi_matrix *A;
  const double *b, *x;
  double *y;
  int32_t what;
  mpmi_ranges ranges;
  double part[MPMI_MOST_RANGES];
} apply_job;

MPMI_INLINE void row_times_vector(const mpmi_matrix *A, int32_t block, int32_t absolute, int64_t i,
                                  const double *x, double *sum) {
  const double *value = A->value + A->row_start[i] * block * block;
  for (int32_t r = 0; r < block; ++r) sum[r] = 0.0;
  for (int64_t e = A->row_start[i]; e < A->row_start[i + 1]; ++e, value += block * block) {
    const double *at = x + (int64_t)A->column[e] * block;
    for (int32_t r = 0; r < block; ++r) {
      double of_block = 0.0; /* a block adds up first, so that it waits for one addition only */
      for (int32_t c = 0; c < block; ++c) {
        const double term = value[r * block + c] * at[c];
        of_block += absolute ? fabs(term) : term;
      }
      sum[r] += of_block;
    }
  }
}

/* Returns x . y for a product and y . y for the others. */
MPMI_INLINE double apply_rows(const apply_job *job, int32_t block, int32_t what, int64_t begin, int64_t end) {
  double sum = 0.0;
  for (int64_t i = begin; i < end; ++i) {
    double row[3];
    row_times_vector(job->A, block, what == ROUNDING, i, job->x, row);
    for (int32_t r = 0; r < block; ++r) {
      const int64_t at = i * block + r;
      if (what == RESIDUAL) row[r] = job->b[at] - row[r];
      if (what == ROUNDING) row[r] += fabs(job->b[at]);
      job->y[at] = row[r];
      sum += row[r] * (what == PRODUCT ? job->x[at] : row[r]);
    }
  }
  return sum;
}

MPMI_INLINE double apply_blocks(const apply_job *job, int32_t what, int64_t begin, int64_t end) {
  if (job->A->block == 1) return apply_rows(job, 1, what, begin, end);
  if (job->A->block == 2) return apply_rows(job, 2, what, begin, end);
  return apply_rows(job, 3, what, begin, end);
}

static double apply_what(const apply_job *job, int64_t begin, int64_t end) {
  if (job->what == PRODUCT) return apply_blocks(job, PRODUCT, begin, end);
  if (job->what == RESIDUAL) return apply_blocks(job, RESIDUAL, begin, end);
  return apply_blocks(job, ROUNDING, begin, end);
}

static void apply_task(void *data, int64_t k) {
  apply_job *job = data;
  const int64_t begin = mpmi_range_begin(&job->ranges, k), end = mpmi_range_begin(&job->ranges, k + 1);
  const mpmi_rows *shared = job->A->shared;
  if (!shared) job->part[k] = apply_what(job, begin, end);
  for (int64_t i = begin; i < end && shared; ++i)
    if (shared->own[i]) apply_what(job, i, i + 1);
}

static mpm_status apply(const mpmi_matrix *A, int32_t what, const double *b, const double *x, double *y,
                        double *sum, mpm_status status) {
  apply_job job = {.A = A, .b = b, .x = x, .y = y, .what = what};
  job.ranges = mpmi_ranges_of(A->rows, mpmi_matrix_unknowns(A));
  if (!status) status = mpmi_run_ranges(A->context, &job.ranges, apply_task, &job);
  if (A->shared && sum)
    return mpmi_rows_sum(A->shared, MPMI_BY_ROWS, 1, &(mpmi_row_terms){.a = y, .b = what == PRODUCT ? x : y},
                         sum, status);
  if (sum) *sum = status ? 0.0 : mpmi_reduce(MPMI_REDUCE_SUM, 0.0, job.part, 1, NULL, job.ranges.count);
  return status;
}

mpm_status mpmi_matrix_apply(const mpmi_matrix *A, const double *x, double *y) {
  return apply(A, PRODUCT, NULL, x, y, NULL, MPM_OK);
}

mpm_status mpmi_matrix_apply_dot(const mpmi_matrix *A, const double *x, double *y, double *dot,
                                 mpm_status status) {
  return apply(A, PRODUCT, NULL, x, y, dot, status);
}

mpm_status mpmi_matrix_residual(const mpmi_matrix *A, const double *b, const double *x, double *r,
                                double *norm) {
  const mpm_status status = apply(A, RESIDUAL, b, x, r, norm, MPM_OK);
  *norm = sqrt(*norm);
  return status;
}

mpm_status mpmi_matrix_rounding(const mpmi_matrix *A, const double *b, const double *x, double *scratch,
                                double *norm) {
  const double units = 32.0;
  const mpm_status status = apply(A, ROUNDING, b, x, scratch, norm, MPM_OK);
  *norm = units * DBL_EPSILON * sqrt(*norm);
  return status;
}
