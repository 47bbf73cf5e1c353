/* Boundary conditions on nodal velocities (Steffen et al. 2008, 3.4): velocity callback, walls, periodic
 * images.
 *
 * They work on the velocities that all nodes would have if free. Whatever changes a velocity changes its
 * increment by as much, so that the acceleration of a bound node is that of eq. 30, and mass times the change
 * is the impulse that the boundary gave. Orbits are folded into their masters first and unfolded last
 * (grid/constraints.h). */
#include "stepper/stepper.h"

#include <math.h>
#include <string.h>

enum {
  NODE_BATCH = 256
}; /* at least the nodes of a block, so that batches do not depend on the cut of the work */

typedef struct field {
  mpm_stepper *s;
  double *nodes, dt, flip;
  int32_t values, dim, zero_acceleration,
      books; /* books: impulses count as reactions; only in the projection that has the forces */
} field;

/* Of an orbit: folded mass, signed mass by component, what the master gave to particles before folding,
 * impulse that is booked already. */
typedef struct orbit_state {
  double mass, net[3], before[3], increment[3], booked[3];
} orbit_state;
_Static_assert(sizeof(orbit_state) == MPMI_ORBIT_STATE * sizeof(double), "orbit state");

static orbit_state *state_of(const field *f, int64_t orbit) {
  return (orbit_state *)(void *)f->s->orbit_state + orbit;
}

static double *node_at(const field *f, int64_t slot) {
  return f->nodes + slot * f->values;
}

/* What particles take from a node's velocity per unit of its mass: the change with FLIP, the whole with the
 * others. The impulse of a boundary is how much more of it there is. */
static double given(const field *f, int64_t slot, int32_t c) {
  const double *node = node_at(f, slot);
  return f->flip * (f->values == 8 ? node[4 + c] : 0.0) + (1.0 - f->flip) * node[c];
}

static double increment(const field *f, int64_t slot, int32_t c) {
  return f->values == 8 ? node_at(f, slot)[4 + c] : 0.0;
}

/* Impulse of a boundary on a node, and by how much it changed the node's increment. */
static void note(const field *f, int64_t slot, int32_t c, double impulse, double change) {
  if (!f->books) return;
  f->s->impulse[6 * slot + c] += impulse;
  f->s->impulse[6 * slot + 3 + c] += change;
}

static int32_t is_held(const field *f, int64_t slot, int32_t c) {
  return f->s->velocity_bc && f->s->held[3 * slot + c];
}

static void hold(const field *f, int64_t slot, int32_t c, double value, double increment) {
  double *node = node_at(f, slot);
  node[c] = value;
  if (f->values == 8) node[4 + c] = increment;
}

/* Sets a component that the host prescribes; its increment is that of eq. 30, or 0 by option. */
static void prescribe(const field *f, int64_t slot, int32_t c, double value) {
  const double *node = node_at(f, slot);
  const double increment = f->values == 8 && !f->zero_acceleration ? node[4 + c] + value - node[c] : 0.0;
  hold(f, slot, c, value, increment);
}

/* Mass that moves with a free node: its own, or that of its orbit. */
static double moving_mass(const field *f, int64_t slot) {
  const int32_t orbit = f->s->constraints.orbit_of[slot];
  return orbit < 0 ? node_at(f, slot)[3] : state_of(f, orbit)->mass;
}

typedef struct component_state {
  double given, increment;
} component_state;

static component_state component(const field *f, int64_t slot, int32_t c) {
  return (component_state){given(f, slot, c), increment(f, slot, c)};
}

/* Takes note of what a free node gives to the particles more than before: the impulse is returned. */
static double book(const field *f, int64_t slot, int32_t c, component_state before) {
  const double more = given(f, slot, c) - before.given;
  const int32_t orbit = f->s->constraints.orbit_of[slot];
  if (orbit < 0) {
    const double impulse = node_at(f, slot)[3] * more;
    note(f, slot, c, impulse, increment(f, slot, c) - before.increment);
    return impulse;
  }
  orbit_state *state = state_of(f, orbit);
  state->booked[c] += state->net[c] * more;
  return state->net[c] * more;
}

/* Changes a free node's velocity by a contact. */
static double push(const field *f, int64_t slot, int32_t c, double by) {
  const component_state before = component(f, slot, c);
  double *node = node_at(f, slot);
  node[c] += by;
  if (f->values == 8) node[4 + c] += by;
  return book(f, slot, c, before);
}

/* The master gets the velocity that the whole orbit has, before the forces and after them. */
static void fold(const field *f) {
  const mpmi_constraints *constraints = &f->s->constraints;
  for (int64_t i = 0; i < constraints->orbit_count; ++i) {
    const mpmi_orbit *orbit = &constraints->orbit[i];
    double *master = node_at(f, orbit->master);
    orbit_state *state = state_of(f, i);
    double momentum[3], gained[3];
    state->mass = master[3];
    for (int32_t c = 0; c < f->dim; ++c) {
      state->net[c] = master[3];
      state->before[c] = given(f, orbit->master, c);
      state->increment[c] = increment(f, orbit->master, c);
      state->booked[c] = 0.0;
      momentum[c] = master[3] * master[c];
      gained[c] = f->values == 8 ? master[3] * master[4 + c] : 0.0;
    }
    for (int64_t d = orbit->first; d < orbit->first + orbit->count; ++d) {
      const mpmi_dependant *dependant = &constraints->dependant[d];
      const double *node = node_at(f, dependant->slot);
      state->mass += node[3];
      for (int32_t c = 0; c < f->dim; ++c) {
        const double signed_mass = dependant->sign[c] * node[3];
        state->net[c] += signed_mass;
        momentum[c] += signed_mass * node[c];
        if (f->values == 8) gained[c] += signed_mass * node[4 + c];
      }
    }
    const double inverse = state->mass > f->s->mass_cut ? 1.0 / state->mass : 0.0;
    for (int32_t c = 0; orbit->count && c < f->dim; ++c) {
      master[c] = momentum[c] * inverse;
      if (f->values == 8) master[4 + c] = gained[c] * inverse;
    }
  }
}

/* A node on the plane is its own mirror image: the projected velocity of the component is 0 as well, so that
 * there is no increment. Only so is half a symmetric body on a slip wall the same as the whole. */
static void hold_walls(const field *f) {
  const mpmi_constraints *constraints = &f->s->constraints;
  for (int64_t i = 0; i < constraints->orbit_count; ++i) {
    const mpmi_orbit *orbit = &constraints->orbit[i];
    for (int32_t c = 0; c < f->dim; ++c)
      if (orbit->zero[c] && !is_held(f, orbit->master, c)) hold(f, orbit->master, c, 0.0, 0.0);
  }
}

static void unfold(const field *f) {
  mpm_stepper *s = f->s;
  const mpmi_constraints *constraints = &s->constraints;
  for (int64_t i = 0; i < constraints->orbit_count; ++i) {
    const mpmi_orbit *orbit = &constraints->orbit[i];
    const orbit_state *state = state_of(f, i);
    const double *master = node_at(f, orbit->master);
    double total[3] = {0.0, 0.0, 0.0};
    for (int32_t c = 0; c < f->dim; ++c) {
      total[c] = master[3] * (given(f, orbit->master, c) - state->before[c]);
      note(f, orbit->master, c, total[c], increment(f, orbit->master, c) - state->increment[c]);
    }
    for (int64_t d = orbit->first; d < orbit->first + orbit->count; ++d) {
      const mpmi_dependant *dependant = &constraints->dependant[d];
      double *node = node_at(f, dependant->slot);
      for (int32_t c = 0; c < f->dim; ++c) {
        const component_state before = component(f, dependant->slot, c);
        node[c] = dependant->sign[c] * master[c];
        if (f->values == 8) node[4 + c] = dependant->sign[c] * master[4 + c];
        const double impulse = node[3] * (given(f, dependant->slot, c) - before.given);
        total[c] += impulse;
        note(f, dependant->slot, c, impulse, increment(f, dependant->slot, c) - before.increment);
      }
    }
    for (int32_t c = 0; c < f->dim; ++c)
      if (f->books && orbit->face[c] >= 0 && !is_held(f, orbit->master, c))
        s->impulse_in_step[orbit->face[c]][c] += total[c] - state->booked[c];
  }
}

/* A contact acts on the sum of the velocities of its nodes, which is what the wall's plane sees of them;
 * `compliance` is the change of that sum for a unit impulse on each node. */
typedef struct contact_nodes {
  int64_t slot[2];
  int32_t count;
  double mass[2], compliance;
} contact_nodes;

static double sum_of(const field *f, const contact_nodes *n, int32_t c) {
  double sum = 0.0;
  for (int32_t i = 0; i < n->count; ++i) sum += node_at(f, n->slot[i])[c];
  return sum;
}

static void give(const field *f, const contact_nodes *n, int32_t face, int32_t c, double impulse) {
  for (int32_t i = 0; i < n->count; ++i) {
    const double booked = push(f, n->slot[i], c, impulse / n->mass[i]);
    if (f->books) f->s->impulse_in_step[face][c] += booked;
  }
}

static int32_t collect(const field *f, const mpmi_contact *pair, contact_nodes *n) {
  *n = (contact_nodes){{pair->slot, pair->partner}, pair->partner < 0 ? 1 : 2, {0.0, 0.0}, 0.0};
  for (int32_t i = 0; i < n->count; ++i) {
    n->mass[i] = moving_mass(f, n->slot[i]);
    if (n->mass[i] <= f->s->mass_cut) return 0;
    n->compliance += 1.0 / n->mass[i];
    for (int32_t c = 0; c < f->dim; ++c)
      if (is_held(f, n->slot[i], c)) return 0; /* the host holds it: that comes before walls */
  }
  return 1;
}

/* Pushes but never pulls; Coulomb: the tangential impulse stops sliding or is friction times the normal one.
 */
static void contact(const field *f, mpmi_contact *pair) {
  const int32_t axis = pair->face / 2;
  contact_nodes n;
  pair->closed = pair->stuck = 0;
  if (!collect(f, pair, &n)) return;
  const double inward = pair->face % 2 ? -1.0 : 1.0;
  const double approach = -inward * sum_of(f, &n, axis);
  if (approach <= 0.0) return;
  pair->closed = 1;
  const double normal = approach / n.compliance;
  give(f, &n, pair->face, axis, inward * normal);
  double slide[3] = {0.0, 0.0, 0.0}, squared = 0.0;
  for (int32_t c = 0; c < f->dim; ++c) {
    if (c == axis) continue;
    slide[c] = sum_of(f, &n, c) / n.compliance;
    squared += slide[c] * slide[c];
  }
  const double stop = sqrt(squared), most = f->s->wall[pair->face].friction * normal;
  pair->stuck = most >= stop;
  if (most <= 0.0 || stop <= 0.0) return;
  const double share = pair->stuck ? 1.0 : most / stop;
  for (int32_t c = 0; c < f->dim; ++c)
    if (c != axis) give(f, &n, pair->face, c, -share * slide[c]);
}

/* The second projection of MUSL moves with the first: a contact that was closed stays so, one that was open
 * is free. */
static void keep_contact(const field *f, const mpmi_contact *pair) {
  contact_nodes n;
  if (!pair->closed || !collect(f, pair, &n)) return;
  for (int32_t c = 0; c < f->dim; ++c)
    if (c == pair->face / 2 || pair->stuck) give(f, &n, pair->face, c, -sum_of(f, &n, c) / n.compliance);
}

/* Free nodes of one block with mass, for the host. */
typedef struct node_list {
  int64_t n, slot[NODE_BATCH], index[3 * NODE_BATCH];
  double position[3 * NODE_BATCH], mass[NODE_BATCH], velocity[3 * NODE_BATCH];
  uint8_t prescribed[3 * NODE_BATCH];
} node_list;

static void list_block(const field *f, int64_t block, node_list *list) {
  const mpm_stepper *s = f->s;
  const mpmi_blocks *b = &s->blocks;
  list->n = 0;
  for (int64_t slot = block * b->nodes; slot < (block + 1) * b->nodes; ++slot) {
    if (!mpmi_constraints_is_free(&s->constraints, slot) || moving_mass(f, slot) <= s->mass_cut) continue;
    int64_t index[3];
    mpmi_blocks_index(b, slot, index);
    for (int32_t k = 0; k < f->dim; ++k) {
      list->index[k * NODE_BATCH + list->n] = index[k];
      list->position[k * NODE_BATCH + list->n] = mpmi_node_position(s->grid, k, index[k]);
    }
    list->mass[list->n] = moving_mass(f, slot);
    list->slot[list->n++] = slot;
  }
  memset(list->prescribed, 0, sizeof list->prescribed);
  memset(list->velocity, 0, sizeof list->velocity);
}

static void ask_host(const field *f, int64_t block, node_list *list, mpmi_failure *failure) {
  mpm_stepper *s = f->s;
  list_block(f, block, list);
  if (!list->n) return;
  const mpm_node_batch batch = {.struct_size = sizeof batch,
                                .dim = f->dim,
                                .n = list->n,
                                .ld = NODE_BATCH,
                                .t = s->t,
                                .dt = f->dt,
                                .index = list->index,
                                .position = list->position,
                                .mass = list->mass};
  const mpm_status status = s->velocity_bc(s->velocity_bc_user, &batch, list->prescribed, list->velocity);
  if (status) {
    mpmi_failure_take(
        failure, &(mpmi_failure){mpmi_callback_cause(status), status, -1, -1, -1, "the velocity callback"});
    return;
  }
  for (int64_t i = 0; i < list->n; ++i)
    for (int32_t c = 0; c < f->dim; ++c) {
      if (!list->prescribed[c * NODE_BATCH + i]) continue;
      const double value = list->velocity[c * NODE_BATCH + i];
      if (!isfinite(value)) {
        int64_t index[3];
        mpmi_blocks_index(&s->blocks, list->slot[i], index);
        mpmi_failure_take(failure, &(mpmi_failure){MPM_NONFINITE, 0, -1, -1, mpmi_node_number(s->grid, index),
                                                   "prescribed velocity not finite"});
        return;
      }
      s->held[3 * list->slot[i] + c] = 1;
      s->held_value[3 * list->slot[i] + c] = value;
    }
}

static void prescribe_task(void *data, int64_t k) {
  const field *f = data;
  const int64_t blocks = f->s->blocks.count, tasks = f->s->tasks;
  node_list list;
  for (int64_t b = blocks * k / tasks; b < blocks * (k + 1) / tasks; ++b)
    ask_host(f, b, &list, &f->s->scratch[k].failure);
}

/* Sets held components; the work is the host's impulse times its velocity. */
static void set_held(const field *f) {
  mpm_stepper *s = f->s;
  const int64_t slots = s->blocks.count * s->blocks.nodes;
  for (int64_t slot = 0; slot < slots; ++slot)
    for (int32_t c = 0; c < f->dim; ++c) {
      if (!s->held[3 * slot + c]) continue;
      const double value = s->held_value[3 * slot + c];
      const component_state before = component(f, slot, c);
      prescribe(f, slot, c, value);
      const double impulse = book(f, slot, c, before);
      if (f->books) s->prescribed_work += impulse * value;
    }
}

mpm_status mpmi_stage_boundary(mpm_stepper *s, int32_t projection, double dt) {
  const int32_t forces = projection == MPMI_PROJECT_FORCES, corrects = projection == MPMI_PROJECT_CORRECT;
  const field f = {.s = s,
                   .nodes = forces ? s->node : s->again,
                   .dt = dt,
                   .flip = s->values == 8 ? mpmi_flip_share(s) : 0.0,
                   .values = forces ? s->values : 4,
                   .dim = s->grid->dim,
                   .zero_acceleration = s->desc.boundary_zero_acceleration,
                   .books = forces && s->impulses};
  fold(&f);
  if (s->velocity_bc && !corrects) {
    if (mpmi_asks_host(s, projection)) {
      mpm_status status = mpmi_run_tasks(s, 1, s->tasks, prescribe_task, (void *)(uintptr_t)&f);
      if (status || (status = mpmi_stepper_failure(s))) return status;
    }
    set_held(&f);
  }
  hold_walls(&f);
  for (int64_t i = 0; i < s->constraints.contact_count && !corrects; ++i) {
    mpmi_contact *pair = &s->constraints.contact[i];
    if (projection == MPMI_PROJECT_AGAIN)
      keep_contact(&f, pair);
    else
      contact(&f, pair);
  }
  unfold(&f);
  return MPM_OK;
}
