/* Friction walls: unilateral contacts of nodes on a wall's plane, and of ghosts with their mirrors. */
#include "stepper/boundary.h"

#include <math.h>

/* Changes a free node's velocity by a contact. */
static double push(const mpmi_boundary *f, int64_t slot, int32_t c, double by) {
  const mpmi_component_state before = mpmi_component_of(f, slot, c);
  double *node = mpmi_node_at(f, slot);
  node[c] += by;
  if (f->values == 8) node[4 + c] += by;
  return mpmi_book(f, slot, c, before);
}

/* A contact acts on the sum of the velocities of its nodes, which is what the wall's plane sees of them;
 * `compliance` is the change of that sum for a unit impulse on each node. */
typedef struct contact_nodes {
  int64_t slot[2];
  int32_t count, held[3]; /* held: components that prescribed particles hold */
  double mass[2], compliance;
} contact_nodes;

static double sum_of(const mpmi_boundary *f, const contact_nodes *n, int32_t c) {
  double sum = 0.0;
  for (int32_t i = 0; i < n->count; ++i) sum += mpmi_node_at(f, n->slot[i])[c];
  return sum;
}

static void give(const mpmi_boundary *f, const contact_nodes *n, int32_t face, int32_t c, double impulse) {
  for (int32_t i = 0; i < n->count; ++i) {
    const double booked = push(f, n->slot[i], c, impulse / n->mass[i]);
    if (f->books) f->s->impulse_in_step[face][c] += booked;
  }
}

static int32_t collect(const mpmi_boundary *f, const mpmi_contact *pair, contact_nodes *n) {
  *n = (contact_nodes){{pair->slot, pair->partner}, pair->partner < 0 ? 1 : 2, {0, 0, 0}, {0.0, 0.0}, 0.0};
  for (int32_t i = 0; i < n->count; ++i) {
    n->mass[i] = mpmi_moving_mass(f, n->slot[i]);
    if (n->mass[i] <= f->s->mass_cut) return 0;
    n->compliance += 1.0 / n->mass[i];
    for (int32_t c = 0; c < f->dim; ++c) {
      const int32_t held = mpmi_held_by(f, n->slot[i], c);
      if (held == MPMI_HELD_BY_HOST) return 0; /* that comes before walls, on all axes */
      n->held[c] |= held;
    }
  }
  return 1;
}

/* Pushes but never pulls; Coulomb: the tangential impulse stops sliding or is friction times the normal one.
 */
static void contact(const mpmi_boundary *f, mpmi_contact *pair) {
  const int32_t axis = pair->face / 2;
  contact_nodes n;
  pair->closed = pair->stuck = 0;
  if (!collect(f, pair, &n)) return;
  const double inward = pair->face % 2 ? -1.0 : 1.0;
  const double approach = -inward * sum_of(f, &n, axis);
  if (approach <= 0.0 || n.held[axis]) return;
  pair->closed = 1;
  const double normal = approach / n.compliance;
  give(f, &n, pair->face, axis, inward * normal);
  double slide[3] = {0.0, 0.0, 0.0}, squared = 0.0;
  for (int32_t c = 0; c < f->dim; ++c) {
    if (c == axis || n.held[c]) continue;
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
static void keep_contact(const mpmi_boundary *f, const mpmi_contact *pair) {
  contact_nodes n;
  if (!pair->closed || !collect(f, pair, &n)) return;
  for (int32_t c = 0; c < f->dim; ++c)
    if ((c == pair->face / 2 || pair->stuck) && !n.held[c])
      give(f, &n, pair->face, c, -sum_of(f, &n, c) / n.compliance);
}

void mpmi_contacts(const mpmi_boundary *f, int32_t again) {
  const mpmi_constraints *constraints = &f->s->constraints;
  for (int64_t i = 0; i < constraints->contact_count; ++i) {
    mpmi_contact *pair = &constraints->contact[i];
    if (again)
      keep_contact(f, pair);
    else
      contact(f, pair);
  }
}
