/* Unknowns of an implicit step: nodes that are active, the rows that they move with, who holds them. All of
 * it is frozen during the step. */
#include "stepper/newton.h"

#include <math.h>
#include <string.h>

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
  const int32_t tie = s->constraints.tie_of[slot];
  return tie < 0 ? slot : s->constraints.tie[tie].master;
}

/* Without inertia only stiffness and what is held can carry a force: that of rigid particles beyond both has
 * no balance. What is left of the weights of nodes that are not active is none. */
static const double FORCE_ROUNDING = 1e-10;
static mpm_status check_carried(mpm_stepper *s) {
  const mpmi_newton *w = s->newton;
  const int64_t slots = s->blocks.count * s->blocks.nodes;
  const int32_t dim = s->grid->dim;
  double most = 0.0;
  for (int64_t i = 0; i < slots; ++i)
    for (int32_t c = 0; c < dim; ++c) most = fmax(most, fabs(w->external[4 * i + c]));
  for (int64_t i = 0; i < slots; ++i)
    for (int32_t c = 0; c < dim && w->active_of[i] < 0; ++c) {
      const double force = w->external[4 * i + c];
      const int64_t master = master_of(s, i);
      const int32_t tie = s->constraints.tie_of[i];
      const int32_t held =
          (s->holds && s->held[3 * master + c]) || (tie >= 0 && s->constraints.tie[tie].zero[c]);
      if (held || fabs(force) <= FORCE_ROUNDING * most) continue;
      int64_t index[3] = {0, 0, 0};
      mpmi_blocks_index(&s->blocks, i, index);
      s->failure.node = mpmi_node_number(s->grid, index);
      return mpmi_fail(
          s->context, MPM_SINGULAR,
          "nothing carries the force %g on the rigid particles around node %lld, axis %d: prescribe "
          "their motion, or set quasi_static = 0",
          force, (long long)s->failure.node, (int)c);
    }
  return MPM_OK;
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
  for (int64_t i = 0; i < c->tie_count; ++i) {
    const mpmi_tie *tie = &c->tie[i];
    if (w->active_of[tie->master] < 0) continue;
    const int32_t row = w->active[w->active_of[tie->master]].row;
    for (int64_t d = tie->first; d < tie->first + tie->count; ++d) {
      const mpmi_follower *follower = &c->follower[d];
      if (w->active_of[follower->slot] < 0) continue;
      mpmi_active_node *node = &w->active[w->active_of[follower->slot]];
      node->row = row;
      memcpy(node->sign, follower->sign, sizeof node->sign);
      for (int32_t k = 0; k < s->grid->dim; ++k) node->plain &= node->sign[k] > 0.0;
    }
  }
}

/* Room for one more than there are, so that none has a place. */
static mpm_status reserve(mpm_stepper *s, int64_t active, int64_t rows) {
  mpmi_newton *w = s->newton;
  mpm_context *c = s->context;
  const int32_t dim = s->grid->dim;
  mpm_status status;
  if ((status =
           mpmi_reserve_roomy(c, (void **)&w->active, &w->active_capacity, active + 1, sizeof *w->active)) ||
      (status = mpmi_reserve_roomy(c, (void **)&w->members, &w->members_capacity, active + 1,
                                   sizeof *w->members)) ||
      (status = mpmi_reserve_roomy(c, (void **)&w->members_start, &w->members_start_capacity, rows + 1,
                                   sizeof *w->members_start)) ||
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

/* Numbers and positions of the nodes behind the rows: messages, solvers and the host ask for them. */
static void place_rows(mpm_stepper *s) {
  mpmi_newton *w = s->newton;
  mpmi_matrix *A = &w->matrix;
  for (int32_t k = 0; k < s->grid->dim; ++k)
    A->period[k] = s->grid->desc.periodic[k] ? s->grid->desc.cells[k] : 0;
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
    const int32_t tie = s->constraints.tie_of[slot];
    for (int32_t c = 0; c < dim; ++c) {
      const int64_t at = (int64_t)w->active[i].row * dim + c;
      const int32_t by_host = s->holds && s->held[3 * slot + c];
      const int32_t on_wall = tie >= 0 && s->constraints.tie[tie].zero[c];
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
  int32_t offsets = 1;
  for (int32_t k = 0; k < s->grid->dim; ++k) offsets *= 2 * mpmi_coupling_span(s) - 1;
  if (w->offsets != offsets) w->topology = -1;
  w->offsets = offsets;
  mark(s, &active, &rows);
  if (!mpmi_is_dynamic(s) && (status = check_carried(s))) return status;
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
    if ((status = mpmi_make_pattern(s, rows))) return status;
    place_rows(s);
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
