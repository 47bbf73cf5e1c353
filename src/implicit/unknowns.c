/* Unknowns of an implicit step: nodes that are active, the rows that they move with, who holds them. All of
 * it is frozen during the step. */
#include "implicit/extension.h"

#include <math.h>
#include <string.h>

/* A node is active when it has stiffness, or in a dynamic step inertia; light ones too, because leaving them
 * out would hold them. Amounts below these cuts are rounding of weights that are zero. */
typedef struct cuts {
  double stiffness, mass, force;
} cuts;
static const double STIFFNESS_ROUNDING = 1e-26, MASS_ROUNDING = 1e-14, FORCE_ROUNDING = 1e-10;

static mpm_status find_cuts(const mpmi_balance *balance, cuts *to) {
  const int64_t slots = mpmi_slots(balance->layout);
  const int32_t dim = balance->settings->grid->dim, dynamic = mpmi_is_dynamic(balance->settings);
  double most[3] = {0.0, 0.0, 0.0};
  for (int64_t i = 0; i < slots; ++i) {
    most[0] = fmax(most[0], *mpmi_mass(&balance->newton->external, i));
    most[1] = fmax(most[1], *mpmi_mass(&balance->nodes->solved, i));
    for (int32_t c = 0; c < dim && !dynamic; ++c)
      most[2] = fmax(most[2], fabs(mpmi_momentum(&balance->newton->external, i)[c]));
  }
  const mpm_status status = mpmi_largest_of_parts(balance, 3, most);
  *to = (cuts){STIFFNESS_ROUNDING * most[0], MASS_ROUNDING * most[1], FORCE_ROUNDING * most[2]};
  return status;
}

static int32_t is_active(const mpmi_balance *balance, const cuts *cut, int64_t slot) {
  return *mpmi_mass(&balance->newton->external, slot) > cut->stiffness ||
         (mpmi_is_dynamic(balance->settings) && *mpmi_mass(&balance->nodes->solved, slot) > cut->mass);
}

/* Without inertia only stiffness or a held component can carry a force; a force on a node with neither has no
 * balance. Forces up to FORCE_ROUNDING of the largest are what rounding leaves of vanishing weights, and
 * count as none. */
static mpm_status check_carried(mpmi_balance *balance, const cuts *cut) {
  mpmi_newton *newton = balance->newton;
  const int64_t slots = mpmi_slots(balance->layout);
  const int32_t dim = balance->settings->grid->dim;
  for (int64_t i = 0; i < slots; ++i)
    for (int32_t c = 0; c < dim && newton->active_of[i] < 0; ++c) {
      const double force = mpmi_momentum(&newton->external, i)[c];
      const int32_t held = mpmi_holder_of(balance, mpmi_master_of(balance, i), c) != MPMI_ROW_FREE;
      newton->carries_loads |= held && fabs(force) > 0.0;
      if (held || fabs(force) <= cut->force) continue;
      balance->step->failure.node = mpmi_blocks_number(&balance->layout->blocks, i);
      return mpmi_fail(
          balance->settings->context, MPM_SINGULAR,
          "nothing carries the force %g on the rigid particles around node %lld, axis %d: prescribe "
          "their motion, or set quasi_static = 0",
          force, (long long)balance->step->failure.node, (int)c);
    }
  return MPM_OK;
}

/* Marks active nodes and the masters that they move with, and counts both. */
static void mark(mpmi_balance *balance, const cuts *cut, int64_t *active, int64_t *rows) {
  mpmi_newton *newton = balance->newton;
  const int64_t slots = mpmi_slots(balance->layout);
  for (int64_t i = 0; i < slots; ++i) newton->active_of[i] = -1;
  for (int64_t i = 0; i < slots; ++i)
    if (is_active(balance, cut, i)) newton->active_of[i] = newton->active_of[mpmi_master_of(balance, i)] = 0;
  /* images of what is active are too: a cell may be seen from either side of a seam */
  for (int64_t i = 0; i < slots; ++i)
    if (newton->active_of[i] < 0 && newton->active_of[mpmi_master_of(balance, i)] >= 0)
      newton->active_of[i] = 0;
  *active = *rows = 0;
  for (int64_t i = 0; i < slots; ++i) {
    if (newton->active_of[i] < 0) continue;
    ++*active;
    *rows += mpmi_master_of(balance, i) == i;
  }
}

static int32_t same_as_before(const mpmi_balance *balance, int64_t active) {
  const mpmi_newton *newton = balance->newton;
  if (newton->version != balance->layout->version || newton->active_count != active) return 0;
  for (int64_t i = 0; i < active; ++i)
    if (newton->active_of[newton->active[i].slot] < 0) return 0;
  return 1;
}

/* Numbers active nodes in the order of their slots, and rows in that of their masters. */
static void number(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  const mpmi_constraints *c = &balance->layout->constraints;
  const int64_t slots = mpmi_slots(balance->layout);
  int64_t count = 0, rows = 0;
  for (int64_t i = 0; i < slots; ++i) {
    if (newton->active_of[i] < 0) continue;
    newton->active_of[i] = (int32_t)count;
    newton->active[count++] =
        (mpmi_active_node){i, mpmi_master_of(balance, i) == i ? (int32_t)rows++ : -1, 1, {1.0, 1.0, 1.0}};
  }
  newton->active_count = count;
  for (int64_t i = 0; i < c->tie_count; ++i) {
    const mpmi_tie *tie = &c->tie[i];
    if (newton->active_of[tie->master] < 0) continue;
    const int32_t row = newton->active[newton->active_of[tie->master]].row;
    for (int64_t d = tie->first; d < tie->first + tie->count; ++d) {
      const mpmi_follower *follower = &c->follower[d];
      if (newton->active_of[follower->slot] < 0) continue;
      mpmi_active_node *node = &newton->active[newton->active_of[follower->slot]];
      node->row = row;
      memcpy(node->sign, follower->sign, sizeof node->sign);
      for (int32_t k = 0; k < balance->settings->grid->dim; ++k) node->plain &= node->sign[k] > 0.0;
    }
  }
}

/* Makes room for one more of each than needed, so that no array is empty. */
static mpm_status reserve(mpmi_balance *balance, int64_t active, int64_t rows) {
  mpmi_newton *newton = balance->newton;
  mpm_context *c = balance->settings->context;
  const int32_t dim = balance->settings->grid->dim;
  mpm_status status;
  if ((status = MPMI_RESERVE_MORE(c, newton->active, newton->active_capacity, active + 1)) ||
      (status = MPMI_RESERVE_MORE(c, newton->members, newton->members_capacity, active + 1)) ||
      (status = MPMI_RESERVE_MORE(c, newton->members_start, newton->members_start_capacity, rows + 1)) ||
      (status =
           MPMI_RESERVE_MORE(c, newton->place, newton->place_capacity, (active + 1) * newton->offsets)) ||
      (status = MPMI_RESERVE_MORE(c, newton->diagonal, newton->diagonal_capacity, rows + 1)) ||
      (status = MPMI_RESERVE_MORE(c, newton->mass, newton->mass_capacity, rows + 1)) ||
      (status = MPMI_RESERVE_MORE(c, newton->vector_memory, newton->vector_capacity,
                                  MPMI_VECTORS * (rows + 1) * dim)))
    return status;
  for (int32_t v = 0; v < MPMI_VECTORS; ++v) newton->vector[v] = newton->vector_memory + v * rows * dim;
  return MPM_OK;
}

/* Fills in numbers and positions of the nodes behind the rows: messages, solvers and the host ask for
 * them. */
static void place_rows(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  mpmi_matrix *A = &newton->matrix;
  for (int32_t k = 0; k < balance->settings->grid->dim; ++k)
    A->period[k] = balance->settings->grid->desc.periodic[k] ? balance->settings->grid->desc.cells[k] : 0;
  for (int64_t i = 0; i < newton->active_count; ++i) {
    const mpmi_active_node *node = &newton->active[i];
    if (mpmi_master_of(balance, node->slot) != node->slot) continue;
    int64_t *index = A->index[node->row];
    index[0] = index[1] = index[2] = 0;
    mpmi_blocks_index(&balance->layout->blocks, node->slot, index);
    A->number[node->row] = mpmi_node_number(balance->settings->grid, index);
    for (int32_t k = 0; k < 3; ++k)
      A->position[3 * node->row + k] =
          k < balance->settings->grid->dim ? mpmi_node_position(balance->settings->grid, k, index[k]) : 0.0;
  }
}

/* Finds the components that walls, the host or prescribed particles hold, and how far they move. */
static void hold(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  mpmi_matrix *A = &newton->matrix;
  const int32_t dim = balance->settings->grid->dim;
  int32_t changed = 0;
  for (int64_t i = 0; i < newton->active_count; ++i) {
    const int64_t slot = newton->active[i].slot;
    if (mpmi_master_of(balance, slot) != slot) continue;
    for (int32_t c = 0; c < dim; ++c) {
      const int64_t at = (int64_t)newton->active[i].row * dim + c;
      const uint8_t held = mpmi_holder_of(balance, slot, c);
      if (A->held[at] == MPMI_ROW_OUTER && held == MPMI_ROW_FREE) continue; /* contact decides */
      changed |= held != A->held[at];
      A->held[at] = held;
      newton->vector[MPMI_TARGET][at] =
          held == MPMI_ROW_PRESCRIBED ? balance->step->dt * balance->nodes->held_value[slot][c] : 0.0;
    }
  }
  A->pattern_id += changed;
}

/* Finds them on this part; tells whether anything is new. */
static mpm_status find_here(mpmi_balance *balance, const cuts *cut, int32_t *is_new) {
  mpmi_newton *newton = balance->newton;
  int64_t active, rows;
  mpm_status status;
  *is_new = 0;
  if ((status = MPMI_RESERVE_MORE(balance->settings->context, newton->active_of, newton->map_capacity,
                                  mpmi_slots(balance->layout))))
    return status;
  int32_t offsets = 1;
  for (int32_t k = 0; k < balance->settings->grid->dim; ++k)
    offsets *= 2 * mpmi_coupling_span(balance->settings) - 1;
  if (newton->offsets != offsets) newton->version = -1;
  newton->offsets = offsets;
  mark(balance, cut, &active, &rows);
  newton->carries_loads = 0;
  if (!mpmi_is_dynamic(balance->settings) && (status = check_carried(balance, cut))) return status;
  if (active > INT32_MAX)
    return mpmi_fail(balance->settings->context, MPM_E_UNSUPPORTED,
                     "%lld nodes are active, more than 2147483647: use an explicit scheme",
                     (long long)active);
  const int32_t changed = !same_as_before(balance, active);
  int32_t extended;
  newton->version = -1; /* unless all goes well */
  if (changed) {
    if ((status = reserve(balance, active, rows))) return status;
    number(balance);
  } else {
    for (int64_t i = 0; i < active; ++i) newton->active_of[newton->active[i].slot] = (int32_t)i;
  }
  if ((status = mpmi_extension_find(balance, rows, &extended))) return status;
  if (changed || extended) {
    if ((status = mpmi_shared_rows_find(balance, rows)) || (status = mpmi_make_pattern(balance, rows)))
      return status;
    place_rows(balance);
    memset(newton->matrix.held, 0, (size_t)(rows * balance->settings->grid->dim));
  }
  newton->version = balance->layout->version;
  *is_new = changed || extended;
  hold(balance);
  return MPM_OK;
}

mpm_status mpmi_unknowns_find(mpmi_balance *balance) {
  cuts cut;
  int32_t is_new;
  mpm_status status = find_cuts(balance, &cut);
  if (status) return status;
  status = find_here(balance, &cut, &is_new);
  return mpmi_shared_rows_agree(balance, is_new, status);
}

void mpmi_unknowns_fold(const mpmi_balance *balance, const mpmi_nodal *forces, double *vector) {
  const mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  memset(vector, 0, (size_t)(newton->matrix.rows * dim) * sizeof *vector);
  for (int64_t i = 0; i < newton->active_count; ++i) {
    const mpmi_active_node *node = &newton->active[i];
    for (int32_t c = 0; c < dim; ++c)
      vector[(int64_t)node->row * dim + c] += node->sign[c] * mpmi_momentum(forces, node->slot)[c];
  }
}
