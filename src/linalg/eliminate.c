/* The numbers of the factor are made here: fronts are put together and eliminated by the kernels of dense.c,
 * from the leaves to the root. */
#include "linalg/factor.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "linalg/vectors.h"

typedef struct factor_job {
  mpmi_factor *f;
  const mpmi_matrix *A;
  double tiny;
} factor_job;

/* ---- putting a front together -------------------------------------------------------------------------- */
/* Adds the entries of the matrix that belong to one node of the front: those with nodes of a higher place
 * in the order. */
static void add_node(const factor_job *job, const mpmi_front *front, int32_t at) {
  const mpmi_factor *f = job->f;
  const mpmi_matrix *A = job->A;
  const int32_t block = A->block, node = f->order[at];
  const int64_t ld = (int64_t)front->pivots + front->rows;
  int32_t mine[3], others[3];
  const int32_t count = mpmi_free_components(A, node, mine);
  for (int64_t e = A->row_start[node]; e < A->row_start[node + 1]; ++e) {
    if (f->local[e] < 0) continue;
    const int64_t other = A->column[e];
    const int32_t other_count = mpmi_free_components(A, other, others);
    const double *row = A->value + e * block * block;
    const double *column = f->symmetric ? NULL : A->value + mpmi_matrix_entry(A, other, node) * block * block;
    const double *scale = f->scale + f->start[at], *other_scale = f->scale + f->start[f->place[other]];
    for (int32_t k = 0; k < count; ++k) {
      const int64_t to = front->panel + (f->start[at] - front->first + k) * ld + f->local[e];
      for (int32_t l = 0; l < other_count; ++l) {
        const double both = scale[k] * other_scale[l];
        const double right = row[mine[k] * block + others[l]] * both;
        f->lower[to + l] = f->symmetric ? right : column[others[l] * block + mine[k]] * both;
        if (!f->symmetric) f->upper[to + l] = right;
      }
    }
  }
}

static void add_symmetric_update(const mpmi_factor *f, const mpmi_front *front, const mpmi_front *from) {
  const int64_t ld = (int64_t)front->pivots + front->rows, n = from->rows;
  const int32_t *map = f->map + from->row;
  const double *update = f->arena + from->kept;
  for (int64_t c = 0; c < n; ++c) {
    const int64_t column = map[c];
    double *to = column < front->pivots
                     ? f->lower + front->panel + column * ld
                     : f->arena + front->built + (column - front->pivots) * front->rows - front->pivots;
    for (int64_t r = c; r < n; ++r) to[map[r]] += *update++;
  }
}

static void add_general_update(const mpmi_factor *f, const mpmi_front *front, const mpmi_front *from) {
  const int64_t ld = (int64_t)front->pivots + front->rows, n = from->rows, pivots = front->pivots;
  const int32_t *map = f->map + from->row;
  const double *update = f->arena + from->kept;
  double *lower = f->lower + front->panel, *upper = f->upper + front->panel, *rest = f->arena + front->built;
  for (int64_t c = 0; c < n; ++c)
    for (int64_t r = 0; r < n; ++r) {
      const int64_t row = map[r], column = map[c];
      const double value = update[c * n + r];
      if (column < pivots && row >= column) lower[column * ld + row] += value;
      if (row < pivots && column >= row) upper[row * ld + column] += value;
      if (row >= pivots && column >= pivots) rest[(column - pivots) * front->rows + row - pivots] += value;
    }
}

static void put_together(const factor_job *job, const mpmi_front *front) {
  const mpmi_factor *f = job->f;
  const size_t panel = ((size_t)front->pivots + (size_t)front->rows) * (size_t)front->pivots;
  memset(f->lower + front->panel, 0, panel * sizeof *f->lower);
  if (!f->symmetric) memset(f->upper + front->panel, 0, panel * sizeof *f->upper);
  memset(f->arena + front->built, 0, (size_t)front->rows * (size_t)front->rows * sizeof *f->arena);
  for (int32_t at = front->begin; at < front->end; ++at) add_node(job, front, at);
  for (int32_t child = front->child; child >= 0; child = f->front[child].sibling)
    if (f->symmetric)
      add_symmetric_update(f, front, &f->front[child]);
    else
      add_general_update(f, front, &f->front[child]);
}

/* ---- eliminating it ------------------------------------------------------------------------------------ */
enum { SLIVERS_AT_ONCE = 4, STRIPS_AT_ONCE = 4 };
static const double worth_sharing = 1e6; /* multiplications of a panel; smaller ones stay in one thread */

typedef struct share {
  const mpmi_dense *kernels;
  const mpmi_dense_front *front;
  int64_t count;
} share;

static int64_t share_end(const share *s, int64_t k, int64_t size) {
  return (k + 1) * size < s->count ? (k + 1) * size : s->count;
}

static void solve_share(void *data, int64_t k) {
  const share *s = data;
  s->kernels->solve_slivers(s->front, k * SLIVERS_AT_ONCE, share_end(s, k, SLIVERS_AT_ONCE));
}

static void update_share(void *data, int64_t k) {
  const share *s = data;
  s->kernels->update_strips(s->front, k * STRIPS_AT_ONCE, share_end(s, k, STRIPS_AT_ONCE));
}

/* Solves for the rows below the panel and makes its update, in the calling thread or in all threads. */
static mpm_status finish_panel(const mpmi_factor *f, const mpmi_dense_front *front, int32_t shared) {
  share s = {f->kernels, front, front->slivers};
  const int64_t strips = mpmi_dense_strips(f->kernels, front);
  const double below = (double)(front->pivots + front->rows - front->first);
  if (!shared || below * below * (double)front->width < worth_sharing) {
    f->kernels->solve_slivers(front, 0, front->slivers);
    f->kernels->update_strips(front, 0, strips);
    return MPM_OK;
  }
  mpm_status status =
      mpmi_parallel_for(f->context, (s.count + SLIVERS_AT_ONCE - 1) / SLIVERS_AT_ONCE, solve_share, &s);
  s.count = strips;
  if (!status)
    status = mpmi_parallel_for(f->context, (s.count + STRIPS_AT_ONCE - 1) / STRIPS_AT_ONCE, update_share, &s);
  return status;
}

/* Moves the update to where it is kept, which is never above where it was made. */
static void keep_update(const mpmi_factor *f, const mpmi_front *front) {
  const double *from = f->arena + front->built;
  double *to = f->arena + front->kept;
  const int64_t n = front->rows;
  for (int64_t c = 0; c < n; ++c) {
    const int64_t first = f->symmetric ? c : 0;
    memmove(to, from + c * n + first, (size_t)(n - first) * sizeof *to);
    to += n - first;
  }
}

/* Eliminates the pivots of a front. *failed becomes the unknown with a pivot that is not finite, or -1. */
static mpm_status eliminate(const factor_job *job, const mpmi_front *front, double *scratch, int32_t shared,
                            int64_t *failed) {
  const mpmi_factor *f = job->f;
  mpmi_dense_front dense = {.lower = f->lower + front->panel,
                            .upper = (f->symmetric ? f->lower : f->upper) + front->panel,
                            .update = f->arena + front->built,
                            .pivot = f->pivot + front->first,
                            .scratch = scratch,
                            .pivots = front->pivots,
                            .rows = front->rows,
                            .tiny = job->tiny};
  for (int64_t first = 0; first < front->pivots; first += MPMI_PANEL) {
    mpmi_dense_panel(f->kernels, &dense, first);
    *failed = f->kernels->factor_block(&dense);
    if (*failed >= 0) {
      *failed += front->first;
      return MPM_OK;
    }
    const mpm_status status = finish_panel(f, &dense, shared);
    if (status) return status;
  }
  keep_update(f, front);
  return MPM_OK;
}

static void front_task(void *data, int64_t k) {
  const factor_job *job = data;
  mpmi_factor *f = job->f;
  mpmi_front_task *task = &f->task[k];
  task->failed = -1;
  for (int32_t i = task->begin; i < task->end && task->failed < 0; ++i) {
    put_together(job, &f->front[i]);
    eliminate(job, &f->front[i], f->arena + task->scratch, 0, &task->failed);
  }
}

static mpm_status eliminate_all(const factor_job *job, int64_t *failed) {
  mpmi_factor *f = job->f;
  *failed = -1;
  const mpmi_ranges tasks = {f->tasks, 1, f->tasks, f->unknowns < MPMI_ALONE_UNKNOWNS};
  mpm_status status = mpmi_run_ranges(f->context, &tasks, front_task, (void *)job);
  for (int32_t t = 0; t < f->tasks && !status && *failed < 0; ++t) *failed = f->task[t].failed;
  for (int32_t i = 0; i < f->fronts && !status && *failed < 0; ++i) {
    if (!f->front[i].top) continue;
    put_together(job, &f->front[i]);
    status = eliminate(job, &f->front[i], f->arena + f->top_scratch, 1, failed);
  }
  return status;
}

static mpm_status reserve_numbers(mpmi_factor *f) {
  mpm_status status = mpmi_reserve(f->context, (void **)&f->number, &f->number_capacity,
                                   3 * f->unknowns + f->largest, sizeof *f->number);
  if (!status)
    status = mpmi_reserve(f->context, (void **)&f->lower, &f->panel_capacity[0], f->panels, sizeof *f->lower);
  if (!status && !f->symmetric)
    status = mpmi_reserve(f->context, (void **)&f->upper, &f->panel_capacity[1], f->panels, sizeof *f->upper);
  if (!status)
    status =
        mpmi_reserve(f->context, (void **)&f->arena, &f->arena_capacity, f->arena_size, sizeof *f->arena);
  if (status) return status;
  f->scale = f->number;
  f->pivot = f->scale + f->unknowns;
  f->y = f->pivot + f->unknowns;
  return MPM_OK;
}

static int64_t node_of_unknown(const mpmi_factor *f, int64_t unknown) {
  int32_t low = 0, high = f->nodes - 1;
  while (low < high) {
    const int32_t middle = high - (high - low) / 2;
    if (f->start[middle] <= unknown)
      low = middle;
    else
      high = middle - 1;
  }
  return f->order[low];
}

/* Where a pivot should be zero, rounding leaves about the root of the number of unknowns, in units of the
 * last place. */
static double tiny_pivot(const mpmi_factor *f) {
  return 8.0 * DBL_EPSILON * (8.0 + sqrt((double)f->unknowns));
}

double mpmi_factor_least_pivot(const mpmi_factor *f, int64_t *node) {
  int64_t least = 0;
  for (int64_t u = 1; u < f->unknowns; ++u)
    if (fabs(f->pivot[u]) < fabs(f->pivot[least])) least = u;
  *node = node_of_unknown(f, least);
  return fabs(f->pivot[least]);
}

double mpmi_factor_bytes(const mpmi_factor *f) {
  return (double)sizeof(double) * ((double)f->panels * (f->symmetric ? 1.0 : 2.0) + (double)f->arena_size);
}

mpm_status mpmi_factor_numbers(mpmi_factor *f, const mpmi_matrix *A, int64_t *node) {
  const factor_job job = {f, A, tiny_pivot(f)};
  int64_t failed;
  mpm_status status = reserve_numbers(f);
  if (!status) status = mpmi_factor_scales(f, A, node);
  if (!status) status = eliminate_all(&job, &failed);
  if (status) return status;
  if (failed >= 0) {
    *node = node_of_unknown(f, failed);
    return MPM_SINGULAR;
  }
  f->negative = 0;
  f->skipped = -1;
  for (int64_t u = f->unknowns - 1; u >= 0; --u) {
    f->negative += f->pivot[u] < 0.0;
    if (f->pivot[u] == MPMI_NO_PIVOT) f->skipped = node_of_unknown(f, u);
  }
  return MPM_OK;
}
