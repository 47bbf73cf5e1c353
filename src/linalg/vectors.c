/* Vectors are cut into chunks, and sums over them are formed in the order of the chunks. */
#include "linalg/vectors.h"

#include <math.h>

mpmi_chunks mpmi_chunks_of(int64_t items, int64_t unknowns) {
  mpmi_chunks chunks = {.items = items, .alone = unknowns < MPMI_ALONE_UNKNOWNS};
  chunks.size = (items + MPMI_MOST_CHUNKS - 1) / MPMI_MOST_CHUNKS;
  if (chunks.size < MPMI_LEAST_CHUNK) chunks.size = MPMI_LEAST_CHUNK;
  chunks.count = (items + chunks.size - 1) / chunks.size;
  return chunks;
}

mpm_status mpmi_run_chunks(mpm_context *context, const mpmi_chunks *chunks, mpm_task_fn task, void *data) {
  if (!chunks->alone) return mpmi_parallel_for(context, chunks->count, task, data);
  for (int64_t k = 0; k < chunks->count; ++k) task(data, k);
  return MPM_OK;
}

mpm_status mpmi_first_failure(const mpmi_chunk_failures *of, int64_t chunks, int64_t *item) {
  for (int64_t k = 0; k < chunks; ++k)
    if (of->status[k]) {
      *item = of->item[k];
      return of->status[k];
    }
  return MPM_OK;
}

double mpmi_sum_in_order(const double *part, int64_t count) {
  double sum = 0.0;
  for (int64_t k = 0; k < count; ++k) sum += part[k];
  return sum;
}

typedef struct dot_job {
  const double *a, *b;
  mpmi_chunks chunks;
  double part[MPMI_MOST_CHUNKS];
} dot_job;

static void dot_task(void *data, int64_t k) {
  dot_job *job = data;
  const double *a = job->a, *b = job->b;
  const int64_t end = mpmi_chunk_begin(&job->chunks, k + 1);
  double sum[4] = {0.0, 0.0, 0.0, 0.0}; /* one sum would wait for each addition, four do not */
  int64_t i = mpmi_chunk_begin(&job->chunks, k);
  for (; i + 4 <= end; i += 4)
    for (int32_t l = 0; l < 4; ++l) sum[l] += a[i + l] * b[i + l];
  for (; i < end; ++i) sum[0] += a[i] * b[i];
  job->part[k] = (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

mpm_status mpmi_dot(mpm_context *context, const double *a, const double *b, int64_t n, double *out) {
  dot_job job = {.a = a, .b = b, .chunks = mpmi_chunks_of(n, n)};
  const mpm_status status = mpmi_run_chunks(context, &job.chunks, dot_task, &job);
  *out = status ? 0.0 : mpmi_sum_in_order(job.part, job.chunks.count);
  return status;
}

mpm_status mpmi_norm(mpm_context *context, const double *a, int64_t n, double *out) {
  const mpm_status status = mpmi_dot(context, a, a, n, out);
  *out = sqrt(*out);
  return status;
}
