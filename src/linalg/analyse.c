/* This file finds the structure of the factor: the rows of every front, and where the entries of the
 * matrix and the updates of other fronts go. */
#include <string.h>

#include "linalg/factor.h"

void mpmi_factor_init(mpmi_factor *f, mpm_context *context) {
  memset(f, 0, sizeof *f);
  f->context = context;
  f->kernels = mpmi_dense_of(context->isa);
}

void mpmi_factor_free(mpmi_factor *f) {
  mpm_context *context = f->context;
  mpmi_free(context, f->slab, (size_t)f->slab_capacity);
  MPMI_FREE_ARRAY(context, f->local, f->local_capacity);
  MPMI_FREE_ARRAY(context, f->node_row, f->node_row_capacity);
  MPMI_FREE_ARRAY(context, f->row, f->row_capacity);
  MPMI_FREE_ARRAY(context, f->map, f->map_capacity);
  MPMI_FREE_ARRAY(context, f->number, f->number_capacity);
  MPMI_FREE_ARRAY(context, f->lower, f->panel_capacity[0]);
  MPMI_FREE_ARRAY(context, f->upper, f->panel_capacity[1]);
  MPMI_FREE_ARRAY(context, f->arena, f->arena_capacity);
  mpmi_factor_init(f, context);
}

/* An analysis needs these lists only while it runs. */
typedef struct analysis {
  mpmi_factor *f;
  const mpmi_matrix *A;
  mpmi_dissection dissection;
  int32_t *seen;     /* [nodes] by place: number + 1 of the last front that has it among its rows */
  int32_t *local_of; /* [nodes] by place: its first row in the present front */
  int32_t waiting;   /* the last front without a parent; `sibling` chains the others */
} analysis;

/* All lists of one element per node share one piece of memory; the widest elements come first. */
static mpm_status place_lists(analysis *a) {
  mpmi_factor *f = a->f;
  const int64_t n = a->A->rows;
  const size_t per_node = sizeof *f->front + sizeof *f->task + sizeof *f->start + sizeof *a->dissection.part +
                          6 * sizeof(int32_t);
  const uint64_t bytes = mpmi_bytes(n + 1, per_node);
  const mpm_status status = mpmi_reserve(f->context, (void **)&f->slab, &f->slab_capacity,
                                         bytes < INT64_MAX ? (int64_t)bytes : INT64_MAX, 1);
  if (status) return status;
  char *at = f->slab;
#define TAKE(list) ((list) = (void *)at, at += (size_t)(n + 1) * sizeof *(list))
  TAKE(f->front), TAKE(f->task), TAKE(f->start), TAKE(a->dissection.part), TAKE(f->order), TAKE(f->place);
  TAKE(a->dissection.label), TAKE(a->dissection.spare), TAKE(a->seen), TAKE(a->local_of);
#undef TAKE
  return MPM_OK;
}

static void dissect_nodes(analysis *a) {
  mpmi_factor *f = a->f;
  const mpmi_matrix *A = a->A;
  int32_t component[3];
  f->nodes = 0;
  for (int64_t i = 0; i < A->rows; ++i) {
    a->dissection.label[i] = 0;
    f->place[i] = -1;
    if (mpmi_free_components(A, i, component)) f->order[f->nodes++] = (int32_t)i;
  }
  a->dissection.A = A;
  a->dissection.order = f->order;
  a->dissection.nodes = f->nodes;
  mpmi_dissect(&a->dissection);
  f->start[0] = 0;
  for (int32_t at = 0; at < f->nodes; ++at) {
    f->place[f->order[at]] = at;
    f->start[at + 1] = f->start[at] + mpmi_free_components(A, f->order[at], component);
    a->seen[at] = 0;
  }
  f->unknowns = f->start[f->nodes];
}

/* Makes room for more elements and keeps the first `used`. */
static mpm_status grow(mpm_context *context, int32_t **at, int64_t *capacity, int64_t used, int64_t wanted) {
  if (wanted <= *capacity) return MPM_OK;
  const int64_t larger = 2 * wanted;
  int32_t *memory = mpmi_alloc(context, mpmi_bytes(larger, sizeof *memory));
  if (!memory) return MPM_E_NOMEM;
  if (used) memcpy(memory, *at, (size_t)used * sizeof *memory);
  mpmi_free(context, *at, mpmi_bytes(*capacity, sizeof **at));
  *at = memory;
  *capacity = larger;
  return MPM_OK;
}

static void sift_down(int32_t *heap, int64_t at, int64_t count) {
  const int32_t value = heap[at];
  for (int64_t child = 2 * at + 1; child < count; at = child, child = 2 * at + 1) {
    if (child + 1 < count && heap[child + 1] > heap[child]) ++child;
    if (heap[child] <= value) break;
    heap[at] = heap[child];
  }
  heap[at] = value;
}

static void sort(int32_t *list, int64_t count) {
  for (int64_t at = count / 2 - 1; at >= 0; --at) sift_down(list, at, count);
  for (int64_t last = count - 1; last > 0; --last) {
    const int32_t largest = list[0];
    list[0] = list[last];
    list[last] = largest;
    sift_down(list, 0, last);
  }
}

/* Adds a node to the rows of the front, unless the front eliminates it or has it already. */
static mpm_status note_row(analysis *a, int32_t number, int32_t place) {
  mpmi_factor *f = a->f;
  mpmi_front *front = &f->front[number];
  if (place < front->end || a->seen[place] == number + 1) return MPM_OK;
  a->seen[place] = number + 1;
  const int64_t used = front->node_row + front->node_rows++;
  const mpm_status status = grow(f->context, &f->node_row, &f->node_row_capacity, used, used + 1);
  if (!status) f->node_row[used] = place;
  return status;
}

/* Finds the rows of a front: the nodes that its own nodes couple to, and the rows that the enclosed fronts
 * leave. */
static mpm_status find_rows(analysis *a, int32_t number, int32_t whole) {
  mpmi_factor *f = a->f;
  mpmi_front *front = &f->front[number];
  mpm_status status;
  for (int32_t at = front->begin; at < front->end; ++at)
    for (int64_t e = a->A->row_start[f->order[at]]; e < a->A->row_start[f->order[at] + 1]; ++e)
      if ((status = note_row(a, number, f->place[a->A->column[e]]))) return status;
  while (a->waiting >= 0 && f->front[a->waiting].begin >= whole) {
    const int32_t child = a->waiting;
    mpmi_front *of = &f->front[child];
    a->waiting = of->sibling;
    of->sibling = front->child;
    of->parent = number;
    front->child = child;
    front->lowest = of->lowest;
    for (int32_t r = 0; r < of->node_rows; ++r)
      if ((status = note_row(a, number, f->node_row[of->node_row + r]))) return status;
  }
  sort(f->node_row + front->node_row, front->node_rows);
  return MPM_OK;
}

/* Lists the unknowns of these nodes, and notes at which row of the front those of each node begin. */
static mpm_status list_unknowns(analysis *a, mpmi_front *front) {
  mpmi_factor *f = a->f;
  for (int32_t at = front->begin; at < front->end; ++at)
    a->local_of[at] = (int32_t)(f->start[at] - front->first);
  for (int32_t r = 0; r < front->node_rows; ++r) {
    const int32_t at = f->node_row[front->node_row + r];
    const int64_t used = front->row + front->rows;
    const mpm_status status = grow(f->context, &f->row, &f->row_capacity, used, used + 3);
    if (status) return status;
    a->local_of[at] = front->pivots + front->rows;
    for (int64_t u = f->start[at]; u < f->start[at + 1]; ++u) f->row[front->row + front->rows++] = (int32_t)u;
  }
  return MPM_OK;
}

/* Notes where the entries of the matrix and the updates of the enclosed fronts go. */
static void map_into(analysis *a, const mpmi_front *front) {
  mpmi_factor *f = a->f;
  const mpmi_matrix *A = a->A;
  for (int32_t at = front->begin; at < front->end; ++at)
    for (int64_t e = A->row_start[f->order[at]]; e < A->row_start[f->order[at] + 1]; ++e) {
      const int32_t other = f->place[A->column[e]];
      f->local[e] = other >= at ? a->local_of[other] : -1;
    }
  for (int32_t child = front->child; child >= 0; child = f->front[child].sibling) {
    const mpmi_front *of = &f->front[child];
    int32_t *map = f->map + of->row;
    for (int32_t r = 0; r < of->node_rows; ++r) {
      const int32_t at = f->node_row[of->node_row + r];
      for (int64_t u = f->start[at]; u < f->start[at + 1]; ++u)
        *map++ = a->local_of[at] + (int32_t)(u - f->start[at]);
    }
  }
}

static mpm_status add_front(analysis *a, const mpmi_part *part, int64_t node_row) {
  mpmi_factor *f = a->f;
  const int32_t number = f->fronts++;
  mpmi_front *front = &f->front[number];
  memset(front, 0, sizeof *front);
  front->begin = part->begin;
  front->end = part->end;
  front->first = f->start[part->begin];
  front->pivots = (int32_t)(f->start[part->end] - front->first);
  front->node_row = node_row;
  front->row = f->rows;
  front->parent = front->child = -1;
  front->lowest = number;
  mpm_status status = find_rows(a, number, part->whole);
  if (!status) status = list_unknowns(a, front);
  if (!status) status = grow(f->context, &f->map, &f->map_capacity, f->rows, front->row + front->rows);
  if (!status) map_into(a, front);
  front->sibling = a->waiting;
  a->waiting = number;
  f->rows += front->rows;
  return status;
}

mpm_status mpmi_factor_analyse(mpmi_factor *f, const mpmi_matrix *A) {
  if (f->analysed && f->pattern_id == A->pattern_id && f->symmetric == A->symmetric) return MPM_OK;
  analysis a = {.f = f, .A = A, .waiting = -1};
  f->analysed = 0;
  if (mpmi_matrix_unknowns(A) > INT32_MAX)
    return mpmi_fail(f->context, MPM_E_NOMEM, "out of memory: no direct solver for %lld unknowns",
                     (long long)mpmi_matrix_unknowns(A));
  mpm_status status = place_lists(&a);
  if (!status)
    status = mpmi_reserve(f->context, (void **)&f->local, &f->local_capacity, A->row_start[A->rows],
                          sizeof *f->local);
  /* A single front has no rows, but its empty lists still need an address. */
  if (!status) status = grow(f->context, &f->node_row, &f->node_row_capacity, 0, 1);
  if (!status) status = grow(f->context, &f->row, &f->row_capacity, 0, 1);
  if (!status) status = grow(f->context, &f->map, &f->map_capacity, 0, 1);
  if (status) return status;
  dissect_nodes(&a);
  f->fronts = 0;
  f->rows = 0;
  int64_t node_rows = 0;
  for (int32_t p = 0; p < a.dissection.parts; ++p) {
    if ((status = add_front(&a, &a.dissection.part[p], node_rows))) return status;
    node_rows += f->front[p].node_rows;
  }
  for (int32_t last = a.waiting; last >= 0;) { /* nothing encloses these fronts */
    const int32_t next = f->front[last].sibling;
    f->front[last].sibling = -1;
    last = next;
  }
  f->symmetric = A->symmetric;
  f->pattern_id = A->pattern_id;
  mpmi_factor_lay_out(f);
  f->analysed = 1;
  return MPM_OK;
}
