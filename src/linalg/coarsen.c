/* The next coarser level has the nodes of every other grid line, and interpolates linearly between them. */
#include <stdlib.h>
#include <string.h>

#include "context/arena.h"
#include "linalg/level.h"

enum { MOST_PARENTS = 8 };

static int64_t half_of(int64_t index) {
  return index >= 0 ? index / 2 : -((1 - index) / 2);
}

/* Finds where the coarse nodes around a node lie. A periodic axis with an odd number of nodes keeps its
 * last node. */
static int32_t parents_of(const mpmi_matrix *A, int64_t row, int64_t index[MOST_PARENTS][3]) {
  int32_t count = 1;
  for (int32_t k = 0; k < 3; ++k) {
    const int64_t low = half_of(A->index[row][k]), period = (A->period[k] + 1) / 2;
    const int32_t odd = A->index[row][k] != 2 * low;
    for (int32_t p = 0; p < count; ++p) {
      index[p][k] = low;
      if (!odd) continue;
      memcpy(index[count + p], index[p], sizeof index[p]);
      index[count + p][k] = low + 1 == period ? 0 : low + 1;
    }
    count <<= odd;
  }
  return count;
}

static int64_t count_parents(const mpmi_matrix *A) {
  int64_t count = 0;
  for (int64_t i = 0; i < A->rows; ++i) {
    int32_t odd = 0;
    for (int32_t k = 0; k < 3; ++k) odd += A->index[i][k] != 2 * half_of(A->index[i][k]);
    count += INT64_C(1) << odd;
  }
  return count;
}

/* A hash table finds coarse nodes by where they lie. */
typedef struct node_list {
  int64_t (*index)[3];
  int64_t count, slots; /* slots: a power of two */
  int32_t *table;       /* -1: free */
} node_list;

static int32_t find_or_add(node_list *n, const int64_t *index) {
  uint64_t hash = 0;
  for (int32_t k = 0; k < 3; ++k) hash = (hash ^ (uint64_t)index[k]) * UINT64_C(0x9e3779b97f4a7c15);
  hash ^= hash >> 29;
  for (uint64_t at = hash;; ++at) {
    int32_t *slot = &n->table[at & (uint64_t)(n->slots - 1)];
    if (*slot < 0) {
      memcpy(n->index[n->count], index, sizeof n->index[0]);
      return *slot = (int32_t)n->count++;
    }
    if (!memcmp(n->index[*slot], index, sizeof n->index[0])) return *slot;
  }
}

/* Finds the parents of all nodes, and numbers coarse nodes as they are met. */
static void find_parents(const mpmi_matrix *A, node_list *n, mpmi_coarsening *to) {
  int64_t count = 0;
  memset(n->table, 0xff, (size_t)n->slots * sizeof *n->table);
  for (int64_t i = 0; i < A->rows; ++i) {
    int64_t index[MOST_PARENTS][3];
    const int32_t parents = parents_of(A, i, index);
    to->parent_start[i] = count;
    for (int32_t p = 0; p < parents; ++p) to->parent[count++] = find_or_add(n, index[p]);
  }
  to->parent_start[A->rows] = count;
}

static void find_children(int64_t rows, int64_t coarse, mpmi_coarsening *to) {
  int64_t *start = to->child_start;
  memset(start, 0, (size_t)(coarse + 1) * sizeof *start);
  for (int64_t e = 0; e < to->parent_start[rows]; ++e) ++start[to->parent[e]];
  for (int64_t I = 0; I < coarse; ++I) start[I + 1] += start[I];
  for (int64_t i = rows - 1; i >= 0; --i)
    for (int64_t e = to->parent_start[i]; e < to->parent_start[i + 1]; ++e)
      to->child[--start[to->parent[e]]] = (int32_t)i;
}

/* ---- pattern ------------------------------------------------------------------------------------------- */
typedef struct pattern_job {
  const mpmi_matrix *A;
  const mpmi_coarsening *P;
  mpmi_matrix *coarse; /* NULL: the columns are only counted */
  int64_t rows;
  mpmi_ranges tasks;
  int64_t *count; /* [rows] columns */
  int64_t *most;  /* [tasks] */
  int32_t *seen;  /* [tasks][rows of A, then coarse rows] the coarse row that met a node last */
} pattern_job;

/* Lists or counts the columns of a coarse row: the parents of all nodes that couple with its children. */
static int64_t columns_of(const pattern_job *job, int64_t row, int32_t *seen, int32_t *out, int64_t *nodes) {
  const mpmi_matrix *A = job->A;
  const mpmi_coarsening *P = job->P;
  const int32_t stamp = (int32_t)row;
  int32_t *seen_coarse = seen + A->rows;
  int64_t count = 0;
  *nodes = 0;
  for (int64_t c = P->child_start[row]; c < P->child_start[row + 1]; ++c)
    for (int64_t e = A->row_start[P->child[c]]; e < A->row_start[P->child[c] + 1]; ++e) {
      const int32_t j = A->column[e];
      if (seen[j] == stamp) continue;
      seen[j] = stamp;
      ++*nodes;
      for (int64_t p = P->parent_start[j]; p < P->parent_start[j + 1]; ++p) {
        if (seen_coarse[P->parent[p]] == stamp) continue;
        seen_coarse[P->parent[p]] = stamp;
        if (out) out[count] = P->parent[p];
        ++count;
      }
    }
  return count;
}

static int ascending(const void *a, const void *b) {
  const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
  return (x > y) - (x < y);
}

static void pattern_task(void *data, int64_t k) {
  const pattern_job *job = data;
  const int64_t all = job->A->rows + job->rows;
  int32_t *seen = job->seen + k * all;
  memset(seen, 0xff, (size_t)all * sizeof *seen);
  job->most[k] = 0;
  for (int64_t i = job->rows * k / job->tasks.count; i < job->rows * (k + 1) / job->tasks.count; ++i) {
    int32_t *out = job->coarse ? job->coarse->column + job->coarse->row_start[i] : NULL;
    int64_t nodes;
    job->count[i] = columns_of(job, i, seen, out, &nodes);
    if (out) qsort(out, (size_t)job->count[i], sizeof *out, ascending);
    if (nodes > job->most[k]) job->most[k] = nodes;
  }
}

static mpm_status make_pattern(pattern_job *job, mpmi_matrix *coarse, int64_t (*index)[3],
                               mpmi_coarsening *to) {
  mpm_context *context = coarse->context;
  mpm_status status = mpmi_run_ranges(context, &job->tasks, pattern_task, job);
  if (status) return status;
  int64_t entries = 0;
  for (int64_t i = 0; i < job->rows; ++i) entries += job->count[i];
  if ((status = mpmi_matrix_reserve(coarse, job->rows, entries, job->A->block))) return status;
  coarse->row_start[0] = 0;
  for (int64_t i = 0; i < job->rows; ++i) coarse->row_start[i + 1] = coarse->row_start[i] + job->count[i];
  memcpy(coarse->index, index, (size_t)job->rows * sizeof *index);
  job->coarse = coarse;
  status = mpmi_run_ranges(context, &job->tasks, pattern_task, job);
  to->most_nodes = 0;
  for (int64_t k = 0; k < job->tasks.count; ++k)
    if (job->most[k] > to->most_nodes) to->most_nodes = job->most[k];
  return status;
}

/* ---- held unknowns ------------------------------------------------------------------------------------- */
static void hold(const mpmi_matrix *A, const mpmi_coarsening *P, mpmi_matrix *coarse) {
  for (int64_t I = 0; I < coarse->rows; ++I)
    for (int32_t c = 0; c < A->block; ++c) {
      uint8_t here = 0, all = 1;
      for (int64_t e = P->child_start[I]; e < P->child_start[I + 1]; ++e) {
        const int64_t i = P->child[e];
        const uint8_t held = A->held[i * A->block + c];
        all &= held != 0;
        if (P->parent_start[i + 1] - P->parent_start[i] == 1) here = held;
      }
      coarse->held[I * A->block + c] = all || here;
    }
}

static mpm_status reserve_slab(mpm_context *context, mpmi_coarsening *to, int64_t rows, int64_t parents) {
  mpmi_arena from = {NULL, 0};
  for (;;) {
    to->parent_start = mpmi_arena_take(&from, rows + 1, sizeof *to->parent_start);
    to->child_start = mpmi_arena_take(&from, parents + 1, sizeof *to->child_start);
    to->parent = mpmi_arena_take(&from, parents, sizeof *to->parent);
    to->child = mpmi_arena_take(&from, parents, sizeof *to->child);
    if (from.memory) return MPM_OK;
    const mpm_status status =
        mpmi_reserve(context, (void **)&to->slab, &to->slab_capacity, (int64_t)from.used, 1);
    if (status) return status;
    from = (mpmi_arena){to->slab, 0};
  }
}

mpm_status mpmi_coarsen(mpmi_level_memory *w, const mpmi_level *l, mpmi_level *next, mpmi_coarsening *to) {
  const mpmi_matrix *A = l->A;
  const int64_t parents = count_parents(A);
  node_list n = {.count = 0, .slots = 64};
  pattern_job job = {.A = A, .P = to, .tasks = mpmi_level_memory_tasks(w, A)};
  mpm_status status = reserve_slab(w->context, to, A->rows, parents);
  if (status) return status;
  while (n.slots < 2 * parents) n.slots *= 2;
  mpmi_arena from = {NULL, 0};
  for (;;) {
    n.index = mpmi_arena_take(&from, parents, sizeof *n.index);
    n.table = mpmi_arena_take(&from, n.slots, sizeof *n.table);
    job.count = mpmi_arena_take(&from, parents, sizeof *job.count);
    job.most = mpmi_arena_take(&from, job.tasks.count, sizeof *job.most);
    job.seen = mpmi_arena_take(&from, job.tasks.count * (A->rows + parents), sizeof *job.seen);
    if (from.memory) break;
    if ((status = mpmi_level_memory_reserve(w, from.used))) return status;
    from = (mpmi_arena){w->memory, 0};
  }
  find_parents(A, &n, to);
  job.rows = n.count;
  find_children(A->rows, n.count, to);
  if ((status = make_pattern(&job, &next->own, n.index, to))) return status;
  for (int32_t k = 0; k < 3; ++k) next->own.period[k] = (A->period[k] + 1) / 2;
  next->own.symmetric = A->symmetric;
  next->A = &next->own;
  hold(A, to, &next->own);
  return MPM_OK;
}
