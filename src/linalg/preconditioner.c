/* The diagonal preconditions CG, and its blocks by node precondition GMRES, or CG does. */
#include <math.h>
#include <string.h>

#include "linalg/methods.h"

static const double *diagonal_block(const mpmi_matrix *A, int64_t node) {
  int64_t e = A->row_start[node];
  while (A->column[e] != node) ++e;
  return A->value + e * A->block * A->block;
}

static mpm_status reserve_diagonal(const mpmi_system *s, int64_t count) {
  mpmi_solver *solver = s->solver;
  return mpmi_reserve(s->context, (void **)&solver->diagonal, &solver->diagonal_capacity, count,
                      sizeof *solver->diagonal);
}

mpm_status mpmi_inverse_diagonal(const mpmi_system *s, int64_t *node) {
  const mpmi_matrix *A = s->A;
  const mpm_status status = reserve_diagonal(s, s->n);
  if (status) return status;
  for (int64_t i = 0; i < A->rows; ++i) {
    const double *block = diagonal_block(A, i);
    for (int32_t c = 0; c < A->block; ++c) {
      const double value = mpmi_is_own_row(A, i) ? block[c * A->block + c] : 1.0;
      *node = i;
      if (!isfinite(value)) return MPM_NONFINITE;
      if (!(value > 0.0)) return MPM_SINGULAR;
      s->solver->diagonal[i * A->block + c] = 1.0 / value;
    }
  }
  return MPM_OK;
}

mpm_status mpmi_inverse_blocks(const mpmi_system *s, int64_t *node) {
  const mpmi_matrix *A = s->A;
  const int32_t n = A->block;
  const mpm_status status = reserve_diagonal(s, s->n * n);
  if (status) return status;
  for (int64_t i = 0; i < A->rows; ++i) {
    const double *block = diagonal_block(A, i);
    double a[3][3], sum = 0.0;
    for (int32_t r = 0; r < n; ++r)
      for (int32_t c = 0; c < n; ++c) sum += a[r][c] = block[r * n + c];
    *node = i;
    const int32_t own = mpmi_is_own_row(A, i);
    if (own && !isfinite(sum)) return MPM_NONFINITE;
    const int32_t regular = own && mpmi_invert_block(n, a);
    double *out = s->solver->diagonal + i * n * n;
    for (int32_t r = 0; r < n; ++r)
      for (int32_t c = 0; c < n; ++c) out[r * n + c] = regular ? a[r][c] : r == c ? 1.0 : 0.0;
  }
  return MPM_OK;
}

typedef struct times_job {
  const mpmi_system *s;
  const double *r;
  double *z;
  mpmi_ranges ranges;
} times_job;

static void times_task(void *data, int64_t k) {
  const times_job *job = data;
  const int32_t n = job->s->A->block;
  for (int64_t i = mpmi_range_begin(&job->ranges, k); i < mpmi_range_begin(&job->ranges, k + 1); ++i) {
    const double *block = job->s->solver->diagonal + i * n * n;
    for (int32_t r = 0; r < n; ++r) {
      double sum = 0.0;
      for (int32_t c = 0; c < n; ++c) sum += block[r * n + c] * job->r[i * n + c];
      job->z[i * n + r] = sum;
    }
  }
}

mpm_status mpmi_times_inverse_blocks(void *system, const double *r, double *z) {
  const mpmi_system *s = system;
  times_job job = {s, r, z, mpmi_ranges_of(s->A->rows, s->n)};
  return mpmi_run_ranges(s->context, &job.ranges, times_task, &job);
}

static const double INNER_WANTED = 1e-3;
enum { INNER_MOST = 1000 };

mpm_status mpmi_reserve_inner_cg(mpmi_system *s, int64_t *node) {
  mpmi_solver *solver = s->solver;
  const mpm_status status = mpmi_reserve(s->context, (void **)&solver->inner, &solver->inner_capacity,
                                         3 * s->n + 1, sizeof *solver->inner);
  return status ? status : mpmi_inverse_diagonal(s, node);
}

/* Where iterations lead nowhere, because the matrix is far from symmetric, z is what there is, and where not
 * one could be made it is r scaled by the diagonal. */
mpm_status mpmi_times_inner_cg(void *user, const double *r, double *z) {
  const mpmi_inner_cg *plan = user;
  mpmi_system *s = plan->system, inner = *s;
  mpmi_solve_report told = {.node = -1};
  const int64_t left = plan->limit - s->report->iterations;
  inner.b = r;
  inner.x = z;
  inner.b_norm = 1.0;
  inner.wanted = INNER_WANTED;
  inner.report = &told;
  inner.room = s->solver->inner;
  memset(z, 0, (size_t)s->n * sizeof *z);
  const mpm_status status = mpmi_cg(&inner, NULL, NULL, left < INNER_MOST ? left : INNER_MOST);
  s->report->iterations += told.iterations;
  if (status != MPM_NOT_CONVERGED && status != MPM_SINGULAR) return status;
  for (int64_t i = 0; i < s->n && !told.iterations; ++i) z[i] = s->solver->diagonal[i] * r[i];
  return MPM_OK;
}
