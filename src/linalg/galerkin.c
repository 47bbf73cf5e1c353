/* The matrix of a coarser level is P^T A P. It is made row by row: first a row of P^T A, then its product
 * with P. */
#include <string.h>

#include "linalg/level.h"
#include "simd/isa.h"

typedef struct galerkin_job {
  const mpmi_matrix *A;
  const mpmi_coarsening *P;
  mpmi_matrix *coarse;
  mpmi_ranges tasks;
  int64_t ints;     /* in the scratch of one task */
  int32_t *scratch; /* three lists for each task, see row_job */
  double *sums;
} galerkin_job;

typedef struct row_job {
  const galerkin_job *of;
  int32_t *place; /* [rows of A] place of a row in the sums, or -1 */
  int32_t *node;  /* [count] rows of A that have a place */
  int32_t *entry; /* [coarse rows] entry of a column in the row at hand */
  double *sums;   /* [count] blocks */
  int32_t count;
} row_job;

/* Adds a row of A, without the diagonal of held unknowns: it is 1 there, and P leaves them out. */
MPMI_INLINE void add_child(row_job *r, int32_t block, int64_t i, double weight) {
  const mpmi_matrix *A = r->of->A;
  for (int64_t e = A->row_start[i]; e < A->row_start[i + 1]; ++e) {
    const int32_t j = A->column[e];
    const double *value = A->value + e * block * block;
    if (r->place[j] < 0) {
      r->place[j] = r->count;
      r->node[r->count] = j;
      memset(r->sums + (int64_t)r->count * block * block, 0, (size_t)(block * block) * sizeof *r->sums);
      ++r->count;
    }
    double *to = r->sums + (int64_t)r->place[j] * block * block;
    for (int32_t v = 0; v < block * block; ++v) to[v] += weight * value[v];
    for (int32_t c = 0; c < block && j == i; ++c)
      if (A->held[i * block + c]) to[c * block + c] -= weight * value[c * block + c];
  }
}

MPMI_INLINE void make_row(row_job *r, int32_t block, int64_t row) {
  const mpmi_coarsening *P = r->of->P;
  mpmi_matrix *coarse = r->of->coarse;
  const int64_t first = coarse->row_start[row], end = coarse->row_start[row + 1];
  r->count = 0;
  for (int64_t c = P->child_start[row]; c < P->child_start[row + 1]; ++c) {
    const int64_t i = P->child[c];
    add_child(r, block, i, mpmi_parent_weight(P, r->of->A, i));
  }
  memset(coarse->value + first * block * block, 0,
         (size_t)((end - first) * block * block) * sizeof *coarse->value);
  for (int64_t e = first; e < end; ++e) r->entry[coarse->column[e]] = (int32_t)(e - first);
  for (int32_t n = 0; n < r->count; ++n) {
    const int32_t j = r->node[n];
    const double weight = mpmi_parent_weight(P, r->of->A, j), *from = r->sums + (int64_t)n * block * block;
    r->place[j] = -1;
    for (int64_t p = P->parent_start[j]; p < P->parent_start[j + 1]; ++p) {
      double *to = coarse->value + (first + r->entry[P->parent[p]]) * block * block;
      for (int32_t v = 0; v < block * block; ++v) to[v] += weight * from[v];
    }
  }
}

static void galerkin_task(void *data, int64_t k) {
  const galerkin_job *job = data;
  const int64_t rows = job->coarse->rows, nodes = job->P->most_nodes;
  const int32_t block = job->A->block;
  row_job r = {.of = job, .place = job->scratch + k * job->ints};
  r.node = r.place + job->A->rows;
  r.entry = r.node + nodes;
  r.sums = job->sums + k * nodes * block * block;
  memset(r.place, 0xff, (size_t)job->A->rows * sizeof *r.place);
  for (int64_t i = rows * k / job->tasks.count; i < rows * (k + 1) / job->tasks.count; ++i) {
    if (block == 3)
      make_row(&r, 3, i);
    else if (block == 2)
      make_row(&r, 2, i);
    else
      make_row(&r, 1, i);
  }
}

mpm_status mpmi_galerkin(mpmi_level_memory *w, const mpmi_matrix *A, const mpmi_coarsening *P,
                         mpmi_matrix *coarse) {
  galerkin_job job = {.A = A, .P = P, .coarse = coarse, .tasks = mpmi_level_memory_tasks(w, A)};
  const int64_t area = job.A->block * job.A->block;
  job.ints = job.A->rows + job.P->most_nodes + coarse->rows;
  const size_t sums = mpmi_bytes(job.tasks.count * job.P->most_nodes * area, sizeof *job.sums);
  mpm_status status =
      mpmi_level_memory_reserve(w, sums + mpmi_bytes(job.tasks.count * job.ints, sizeof *job.scratch));
  if (status) return status;
  job.sums = (double *)(void *)w->memory;
  job.scratch = (int32_t *)(void *)(w->memory + sums);
  status = mpmi_run_ranges(w->context, &job.tasks, galerkin_task, &job);
  return status ? status : mpmi_matrix_eliminate(coarse);
}
