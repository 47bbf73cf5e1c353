/* Unknowns of an implicit step: nodes that are active, the rows that they move with, and the pattern of the
 * matrix. All of it is frozen during the step. */
#include "stepper/newton.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Nodes along an axis that couple: of a stencil, or with the locking remedy of all stencils of a cell. */
static int32_t span_of(const mpm_stepper *s) {
  return s->grid->width + (s->desc.locking_remedy ? s->grid->centred : 0);
}

/* Steps from a node to those that it couples with: -(span - 1) ... span - 1 on each axis. */
static int32_t offsets_of(const mpm_stepper *s) {
  int32_t count = 1;
  for (int32_t k = 0; k < s->grid->dim; ++k) count *= 2 * span_of(s) - 1;
  return count;
}

/* Slot of the node at an offset from the one in a slot, or -1. */
static int64_t neighbour_slot(const mpmi_blocks *b, int64_t slot, const int32_t *offset) {
  const int32_t dim = b->grid->dim;
  const int64_t block = slot / b->nodes;
  int32_t place = (int32_t)(slot % b->nodes), at[3], n = 0, to = 0;
  for (int32_t k = dim - 1; k >= 0; --k) {
    at[k] = place % b->edge + offset[k];
    place /= b->edge;
  }
  for (int32_t k = 0; k < dim; ++k) {
    const int32_t side = at[k] < 0 ? 0 : at[k] >= b->edge ? 2 : 1;
    n = 3 * n + side;
    to = to * b->edge + at[k] - (side - 1) * b->edge;
  }
  const int32_t other = b->neighbour[block][n];
  return other == MPMI_NO_BLOCK ? -1 : (int64_t)other * b->nodes + to;
}

static void offset_of(const mpm_stepper *s, int32_t index, int32_t *offset) {
  const int32_t span = span_of(s), reach = 2 * span - 1;
  for (int32_t k = s->grid->dim - 1; k >= 0; --k) {
    offset[k] = index % reach - (span - 1);
    index /= reach;
  }
}

/* Nodes with stiffness, or in a dynamic step with inertia. Light ones stay in: leaving them out would hold
 * them. What is left out is rounding of weights that are zero. */
typedef struct cuts {
  double stiffness, mass;
} cuts;
static const double STIFFNESS_ROUNDING = 1e-26, MASS_ROUNDING = 1e-14;

static cuts find_cuts(const mpm_stepper *s) {
  const int64_t slots = s->blocks.count * s->blocks.nodes;
  cuts most = {0.0, 0.0};
  for (int64_t i = 0; i < slots; ++i) {
    most.stiffness = fmax(most.stiffness, s->newton->external[4 * i + 3]);
    most.mass = fmax(most.mass, s->node[8 * i + 3]);
  }
  return (cuts){STIFFNESS_ROUNDING * most.stiffness, MASS_ROUNDING * most.mass};
}

static int32_t is_active(const mpm_stepper *s, const cuts *cut, int64_t slot) {
  return s->newton->external[4 * slot + 3] > cut->stiffness ||
         (mpmi_is_dynamic(s) && s->node[8 * slot + 3] > cut->mass);
}

static int64_t master_of(const mpm_stepper *s, int64_t slot) {
  const int32_t orbit = s->constraints.orbit_of[slot];
  return orbit < 0 ? slot : s->constraints.orbit[orbit].master;
}

/* Marks active nodes and the masters that they move with; counts. */
static void mark(mpm_stepper *s, int64_t *active, int64_t *rows) {
  mpmi_newton *w = s->newton;
  const int64_t slots = s->blocks.count * s->blocks.nodes;
  const cuts cut = find_cuts(s);
  for (int64_t i = 0; i < slots; ++i) w->active_of[i] = -1;
  for (int64_t i = 0; i < slots; ++i)
    if (is_active(s, &cut, i)) w->active_of[i] = w->active_of[master_of(s, i)] = 0;
  /* images of what is active are too: a cell may be seen from either side of a seam */
  for (int64_t i = 0; i < slots; ++i)
    if (w->active_of[i] < 0 && w->active_of[master_of(s, i)] >= 0) w->active_of[i] = 0;
  *active = *rows = 0;
  for (int64_t i = 0; i < slots; ++i) {
    if (w->active_of[i] < 0) continue;
    ++*active;
    *rows += master_of(s, i) == i;
  }
}

static int32_t same_as_before(const mpm_stepper *s, int64_t active) {
  const mpmi_newton *w = s->newton;
  if (w->topology != s->topology || w->active_count != active) return 0;
  for (int64_t i = 0; i < active; ++i)
    if (w->active_of[w->active[i].slot] < 0) return 0;
  return 1;
}

/* Active nodes in the order of their slots; rows in that of their masters. */
static void number(mpm_stepper *s) {
  mpmi_newton *w = s->newton;
  const mpmi_constraints *c = &s->constraints;
  const int64_t slots = s->blocks.count * s->blocks.nodes;
  int64_t count = 0, rows = 0;
  for (int64_t i = 0; i < slots; ++i) {
    if (w->active_of[i] < 0) continue;
    w->active_of[i] = (int32_t)count;
    w->active[count++] =
        (mpmi_active_node){i, master_of(s, i) == i ? (int32_t)rows++ : -1, 1, {1.0, 1.0, 1.0}};
  }
  w->active_count = count;
  for (int64_t i = 0; i < c->orbit_count; ++i) {
    const mpmi_orbit *orbit = &c->orbit[i];
    if (w->active_of[orbit->master] < 0) continue;
    const int32_t row = w->active[w->active_of[orbit->master]].row;
    for (int64_t d = orbit->first; d < orbit->first + orbit->count; ++d) {
      const mpmi_dependant *dependant = &c->dependant[d];
      if (w->active_of[dependant->slot] < 0) continue;
      mpmi_active_node *node = &w->active[w->active_of[dependant->slot]];
      node->row = row;
      memcpy(node->sign, dependant->sign, sizeof node->sign);
      for (int32_t k = 0; k < s->grid->dim; ++k) node->plain &= node->sign[k] > 0.0;
    }
  }
}

/* Active nodes by row, each row's in the order of their slots. */
static void group(mpmi_newton *w, int64_t rows) {
  memset(w->members_start, 0, (size_t)(rows + 1) * sizeof *w->members_start);
  for (int64_t i = 0; i < w->active_count; ++i) ++w->members_start[w->active[i].row + 1];
  for (int64_t r = 0; r < rows; ++r) w->members_start[r + 1] += w->members_start[r];
  for (int64_t i = 0; i < w->active_count; ++i) w->members[w->members_start[w->active[i].row]++] = i;
  for (int64_t r = rows; r > 0; --r) w->members_start[r] = w->members_start[r - 1];
  w->members_start[0] = 0;
}

typedef struct pattern_job {
  mpm_stepper *s;
  int64_t rows;
} pattern_job;

/* Rows of the nodes around each active node, for now in the place of the entries. */
static void neighbours_task(void *data, int64_t k) {
  const pattern_job *job = data;
  mpm_stepper *s = job->s;
  mpmi_newton *w = s->newton;
  const int64_t tasks = s->tasks, from = w->active_count * k / tasks, to = w->active_count * (k + 1) / tasks;
  for (int32_t o = 0; o < w->offsets; ++o) {
    int32_t offset[3];
    offset_of(s, o, offset);
    for (int64_t i = from; i < to; ++i) {
      const int64_t slot = neighbour_slot(&s->blocks, w->active[i].slot, offset);
      const int32_t other = slot < 0 ? -1 : w->active_of[slot];
      w->place[i * w->offsets + o] = other < 0 ? -1 : w->active[other].row;
    }
  }
}

static int by_value(const void *a, const void *b) {
  const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
  return (x > y) - (x < y);
}

enum { MOST_OFFSETS = 343 };

/* Distinct columns of a row, ascending; an orbit of many images gives them member by member. */
static int32_t columns_of(const mpmi_newton *w, int64_t row, int32_t *out) {
  int32_t count = 0;
  for (int64_t m = w->members_start[row]; m < w->members_start[row + 1]; ++m) {
    const int32_t *rows = w->place + w->members[m] * w->offsets;
    for (int32_t o = 0; o < w->offsets; ++o)
      if (rows[o] >= 0) out[count++] = rows[o];
    qsort(out, (size_t)count, sizeof *out, by_value);
    int32_t kept = 0;
    for (int32_t i = 0; i < count; ++i)
      if (!kept || out[kept - 1] != out[i]) out[kept++] = out[i];
    count = kept;
  }
  return count;
}

static void count_task(void *data, int64_t k) {
  const pattern_job *job = data;
  mpmi_newton *w = job->s->newton;
  int32_t columns[2 * 8 * MOST_OFFSETS];
  for (int64_t r = job->rows * k / job->s->tasks; r < job->rows * (k + 1) / job->s->tasks; ++r)
    w->diagonal[r] = columns_of(w, r, columns);
}

static void fill_task(void *data, int64_t k) {
  const pattern_job *job = data;
  mpmi_newton *w = job->s->newton;
  mpmi_matrix *A = &w->matrix;
  int32_t columns[2 * 8 * MOST_OFFSETS];
  for (int64_t r = job->rows * k / job->s->tasks; r < job->rows * (k + 1) / job->s->tasks; ++r) {
    const int32_t count = columns_of(w, r, columns);
    int32_t *to = A->column + A->row_start[r];
    memcpy(to, columns, (size_t)count * sizeof *columns);
    for (int64_t m = w->members_start[r]; m < w->members_start[r + 1]; ++m) {
      int32_t *place = w->place + w->members[m] * w->offsets;
      for (int32_t o = 0; o < w->offsets; ++o) {
        if (place[o] < 0) continue;
        const int32_t *at = bsearch(&place[o], to, (size_t)count, sizeof *to, by_value);
        place[o] = (int32_t)(A->row_start[r] + (at - to));
      }
    }
    const int32_t own = (int32_t)r;
    const int32_t *at = bsearch(&own, to, (size_t)count, sizeof *to, by_value);
    w->diagonal[r] = A->row_start[r] + (at - to);
  }
}

/* Room for one more than there are, so that none has a place. */
static mpm_status reserve(mpm_stepper *s, int64_t active, int64_t rows) {
  mpmi_newton *w = s->newton;
  mpm_context *c = s->context;
  const int32_t dim = s->grid->dim;
  mpm_status status;
  if (active + 1 > w->members_capacity) {
    const int64_t wanted = active + active / 4 + 64;
    int64_t none = 0;
    mpmi_free(c, w->members, mpmi_bytes(w->members_capacity, sizeof *w->members));
    mpmi_free(c, w->members_start, mpmi_bytes(w->members_capacity + 1, sizeof *w->members_start));
    w->members = w->members_start = NULL;
    w->members_capacity = 0;
    if ((status = mpmi_reserve(c, (void **)&w->members, &none, wanted, sizeof *w->members))) return status;
    none = 0;
    w->members_capacity = wanted;
    if (!(w->members_start = mpmi_alloc(c, mpmi_bytes(wanted + 1, sizeof *w->members_start)))) {
      mpmi_free(c, w->members, mpmi_bytes(wanted, sizeof *w->members));
      w->members = NULL;
      w->members_capacity = 0;
      return MPM_E_NOMEM;
    }
  }
  if ((status =
           mpmi_reserve_roomy(c, (void **)&w->active, &w->active_capacity, active + 1, sizeof *w->active)) ||
      (status = mpmi_reserve_roomy(c, (void **)&w->place, &w->place_capacity, (active + 1) * w->offsets,
                                   sizeof *w->place)) ||
      (status = mpmi_reserve_roomy(c, (void **)&w->diagonal, &w->diagonal_capacity, rows + 1,
                                   sizeof *w->diagonal)) ||
      (status = mpmi_reserve_roomy(c, (void **)&w->mass, &w->mass_capacity, rows + 1, sizeof *w->mass)) ||
      (status = mpmi_reserve_roomy(c, (void **)&w->vector_memory, &w->vector_capacity,
                                   MPMI_VECTORS * (rows + 1) * dim, sizeof *w->vector_memory)))
    return status;
  for (int32_t v = 0; v < MPMI_VECTORS; ++v) w->vector[v] = w->vector_memory + v * rows * dim;
  return MPM_OK;
}

static mpm_status make_pattern(mpm_stepper *s, int64_t rows) {
  mpmi_newton *w = s->newton;
  mpmi_matrix *A = &w->matrix;
  pattern_job job = {s, rows};
  mpm_status status;
  group(w, rows);
  if ((status = mpmi_run_tasks(s, 0, s->tasks, neighbours_task, &job)) ||
      (status = mpmi_run_tasks(s, 0, s->tasks, count_task, &job)))
    return status;
  int64_t entries = 0;
  for (int64_t r = 0; r < rows; ++r) entries += w->diagonal[r];
  if (entries > INT32_MAX)
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "the matrix would have %lld blocks, more than 2147483647: use an explicit scheme",
                     (long long)entries);
  if ((status = mpmi_matrix_reserve(A, rows, entries, s->grid->dim))) return status;
  A->row_start[0] = 0;
  for (int64_t r = 0; r < rows; ++r) A->row_start[r + 1] = A->row_start[r] + w->diagonal[r];
  if ((status = mpmi_run_tasks(s, 0, s->tasks, fill_task, &job))) return status;
  for (int64_t i = 0; i < w->active_count; ++i) {
    const mpmi_active_node *node = &w->active[i];
    if (master_of(s, node->slot) != node->slot) continue;
    int64_t *index = A->index[node->row];
    index[0] = index[1] = index[2] = 0;
    mpmi_blocks_index(&s->blocks, node->slot, index);
    A->number[node->row] = mpmi_node_number(s->grid, index);
    for (int32_t k = 0; k < 3; ++k)
      A->position[3 * node->row + k] = k < s->grid->dim ? mpmi_node_position(s->grid, k, index[k]) : 0.0;
  }
  ++A->pattern_id;
  return MPM_OK;
}

/* Components that walls, the host or prescribed particles hold, and how far they move. */
static void hold(mpm_stepper *s, double dt) {
  mpmi_newton *w = s->newton;
  mpmi_matrix *A = &w->matrix;
  const int32_t dim = s->grid->dim;
  int32_t changed = 0;
  for (int64_t i = 0; i < w->active_count; ++i) {
    const int64_t slot = w->active[i].slot;
    if (master_of(s, slot) != slot) continue;
    const int32_t orbit = s->constraints.orbit_of[slot];
    for (int32_t c = 0; c < dim; ++c) {
      const int64_t at = (int64_t)w->active[i].row * dim + c;
      const int32_t by_host = s->holds && s->held[3 * slot + c];
      const int32_t on_wall = orbit >= 0 && s->constraints.orbit[orbit].zero[c];
      const uint8_t held = by_host ? MPMI_ROW_PRESCRIBED : on_wall ? MPMI_ROW_WALL : MPMI_ROW_FREE;
      changed |= held != A->held[at];
      A->held[at] = held;
      w->vector[MPMI_TARGET][at] = by_host ? dt * s->held_value[3 * slot + c] : 0.0;
    }
  }
  A->pattern_id += changed;
}

mpm_status mpmi_unknowns_find(mpm_stepper *s) {
  mpmi_newton *w = s->newton;
  int64_t active, rows;
  mpm_status status;
  if ((status = mpmi_reserve_roomy(s->context, (void **)&w->active_of, &w->map_capacity,
                                   s->blocks.count * s->blocks.nodes, sizeof *w->active_of)))
    return status;
  if (w->offsets != offsets_of(s)) w->topology = -1;
  w->offsets = offsets_of(s);
  mark(s, &active, &rows);
  if (active > INT32_MAX)
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "%lld nodes are active, more than 2147483647: use an explicit scheme",
                     (long long)active);
  if (same_as_before(s, active)) {
    for (int64_t i = 0; i < active; ++i) w->active_of[w->active[i].slot] = (int32_t)i;
  } else {
    w->topology = -1;
    if ((status = reserve(s, active, rows))) return status;
    number(s);
    if ((status = make_pattern(s, rows))) return status;
    memset(w->matrix.held, 0, (size_t)(rows * s->grid->dim));
    w->topology = s->topology;
  }
  hold(s, s->dt);
  return MPM_OK;
}

void mpmi_unknowns_fold(const mpm_stepper *s, const double *forces, double *vector) {
  const mpmi_newton *w = s->newton;
  const int32_t dim = s->grid->dim;
  memset(vector, 0, (size_t)(w->matrix.rows * dim) * sizeof *vector);
  for (int64_t i = 0; i < w->active_count; ++i) {
    const mpmi_active_node *node = &w->active[i];
    for (int32_t c = 0; c < dim; ++c)
      vector[(int64_t)node->row * dim + c] += node->sign[c] * forces[4 * node->slot + c];
  }
}
