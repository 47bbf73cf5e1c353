/* The factor scales a matrix so that its diagonal is 1 in size. */
#include <math.h>

#include "linalg/factor.h"
#include "linalg/vectors.h"

/* A diagonal entry smaller than this share of the largest entry of its row does not measure the row. */
static const double no_measure = 1e-13;

typedef struct scale_job {
  mpmi_factor *f;
  const mpmi_matrix *A;
  mpmi_ranges ranges;
  mpmi_range_failures bad; /* nodes for which there is no scale */
} scale_job;

static mpm_status scale_node(const scale_job *job, int64_t node) {
  const mpmi_matrix *A = job->A;
  const int32_t block = A->block;
  double diagonal[3] = {0.0}, largest[3] = {0.0}, sum = 0.0;
  for (int64_t e = A->row_start[node]; e < A->row_start[node + 1]; ++e) {
    const double *value = A->value + e * block * block;
    for (int32_t r = 0; r < block; ++r)
      for (int32_t c = 0; c < block; ++c) {
        largest[r] = fmax(largest[r], fabs(value[r * block + c]));
        sum += value[r * block + c];
        if (A->column[e] == node && r == c) diagonal[r] = fabs(value[r * block + c]);
      }
  }
  if (!isfinite(sum)) return MPM_NONFINITE;
  int32_t component[3];
  const int32_t count = mpmi_free_components(A, node, component);
  double *scale = job->f->scale + job->f->start[job->f->place[node]];
  for (int32_t k = 0; k < count; ++k) {
    const int32_t c = component[k];
    const double size = diagonal[c] > no_measure * largest[c] ? diagonal[c] : largest[c];
    scale[k] = 1.0 / sqrt(size);
    if (!(size > 0.0) || !isfinite(scale[k])) return MPM_SINGULAR;
  }
  return MPM_OK;
}

static void scale_task(void *data, int64_t k) {
  scale_job *job = data;
  const int64_t end = mpmi_range_begin(&job->ranges, k + 1);
  job->bad.status[k] = MPM_OK;
  for (int64_t i = mpmi_range_begin(&job->ranges, k); i < end && !job->bad.status[k]; ++i) {
    if (job->f->place[i] < 0) continue;
    job->bad.status[k] = scale_node(job, i);
    job->bad.item[k] = i;
  }
}

mpm_status mpmi_factor_scales(mpmi_factor *f, const mpmi_matrix *A, int64_t *node) {
  scale_job job = {.f = f, .A = A, .ranges = mpmi_ranges_of(A->rows, mpmi_matrix_unknowns(A))};
  const mpm_status status = mpmi_run_ranges(f->context, &job.ranges, scale_task, &job);
  return status ? status : mpmi_first_failure(&job.bad, job.ranges.count, node);
}
