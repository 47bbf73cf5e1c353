/* Vectors are cut into ranges, and sums over them are formed in the order of the ranges. */
#include "linalg/vectors.h"

#include <math.h>

#include "context/reduce.h"

mpmi_ranges mpmi_ranges_of(int64_t items, int64_t unknowns) {
  mpmi_ranges ranges = {.items = items, .alone = unknowns < MPMI_ALONE_UNKNOWNS};
  ranges.size = (items + MPMI_MOST_RANGES - 1) / MPMI_MOST_RANGES;
  if (ranges.size < MPMI_LEAST_RANGE) ranges.size = MPMI_LEAST_RANGE;
  ranges.count = (items + ranges.size - 1) / ranges.size;
  return ranges;
}

mpm_status mpmi_run_ranges(mpm_context *context, const mpmi_ranges *ranges, mpm_task_fn task, void *data) {
  if (!ranges->alone) return mpmi_parallel_for(context, ranges->count, task, data);
  for (int64_t k = 0; k < ranges->count; ++k) task(data, k);
  return MPM_OK;
}

mpm_status mpmi_first_failure(const mpmi_range_failures *of, int64_t ranges, int64_t *item) {
  for (int64_t k = 0; k < ranges; ++k)
    if (of->status[k]) {
      *item = of->item[k];
      return of->status[k];
    }
  return MPM_OK;
}

typedef struct dot_job {
  const double *a, *b;
  mpmi_ranges ranges;
  double part[MPMI_MOST_RANGES];
} dot_job;

static void dot_task(void *data, int64_t k) {
  dot_job *job = data;
  const double *a = job->a, *b = job->b;
  const int64_t end = mpmi_range_begin(&job->ranges, k + 1);
  double sum[4] = {0.0, 0.0, 0.0, 0.0}; /* one sum would wait for each addition, four do not */
  int64_t i = mpmi_range_begin(&job->ranges, k);
  for (; i + 4 <= end; i += 4)
    for (int32_t l = 0; l < 4; ++l) sum[l] += a[i + l] * b[i + l];
  for (; i < end; ++i) sum[0] += a[i] * b[i];
  job->part[k] = (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

mpm_status mpmi_dot(mpm_context *context, const double *a, const double *b, int64_t n, double *out) {
  dot_job job = {.a = a, .b = b, .ranges = mpmi_ranges_of(n, n)};
  const mpm_status status = mpmi_run_ranges(context, &job.ranges, dot_task, &job);
  *out = status ? 0.0 : mpmi_reduce(MPMI_REDUCE_SUM, 0.0, job.part, 1, NULL, job.ranges.count);
  return status;
}

mpm_status mpmi_norm(mpm_context *context, const double *a, int64_t n, double *out) {
  const mpm_status status = mpmi_dot(context, a, a, n, out);
  *out = sqrt(*out);
  return status;
}
