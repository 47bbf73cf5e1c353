/* Friction walls: unilateral contacts of nodes on a wall's plane, and of ghosts with their mirrors. */
#include "boundary/bound.h"
#include "context/transport.h"
#include "parallel/parts.h"

#include <math.h>

/* A contact acts on the sum of the velocities of its nodes, which is what the wall's plane sees of them. Its
 * impulse is shared equally by those that move: a component that another wall holds does not. compliance is
 * the change of the sum for a unit impulse. */
typedef struct contact_nodes {
  int64_t slot[2];
  int32_t count, held[3]; /* held: components that prescribed particles hold */
  double inverse_mass[2][3], moving[3], compliance[3];
} contact_nodes;

static double sum_of(mpmi_bound *bound, const contact_nodes *n, int32_t c) {
  double sum = 0.0;
  for (int32_t i = 0; i < n->count; ++i) sum += mpmi_velocity(bound->values, n->slot[i])[c];
  return sum;
}

static void give(mpmi_bound *bound, const contact_nodes *n, int32_t face, int32_t c, double impulse) {
  const int32_t books = bound->records && mpmi_owns_node(bound->step->layout->parts, n->slot[0]);
  for (int32_t i = 0; i < n->count; ++i) {
    if (!(n->inverse_mass[i][c] > 0.0)) continue;
    const double given =
        mpmi_press_node(bound, n->slot[i], c, impulse / n->moving[c] * n->inverse_mass[i][c]);
    if (books) mpmi_exact_add(&bound->step->work->tally.sum[MPMI_TALLY_FACES + 3 * face + c], given);
  }
}

static int32_t on_wall(mpmi_bound *bound, int64_t slot, int32_t c) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  const int32_t tie = constraints->tie_of[slot];
  return tie >= 0 && constraints->tie[tie].zero[c];
}

static int32_t collect(mpmi_bound *bound, const mpmi_contact *pair, contact_nodes *n) {
  *n = (contact_nodes){.slot = {pair->slot, pair->partner}, .count = pair->partner < 0 ? 1 : 2};
  for (int32_t i = 0; i < n->count; ++i) {
    const double mass = mpmi_moving_mass(bound, n->slot[i]);
    if (mass <= bound->step->layout->mass_cut) return 0;
    for (int32_t c = 0; c < bound->dim; ++c) {
      const int32_t held = mpmi_held_by(bound->nodes, n->slot[i], c);
      if (held == MPMI_HELD_BY_HOST) return 0; /* that comes before walls, on all axes */
      n->held[c] |= held;
      if (on_wall(bound, n->slot[i], c)) continue;
      n->inverse_mass[i][c] = 1.0 / mass;
      n->moving[c] += 1.0;
    }
  }
  for (int32_t c = 0; c < bound->dim; ++c)
    if (n->moving[c] > 0.0) n->compliance[c] = (n->inverse_mass[0][c] + n->inverse_mass[1][c]) / n->moving[c];
  return 1;
}

/* Returns the impulse that would stop a component, 0 where no node can move. */
static double stopping(mpmi_bound *bound, const contact_nodes *n, int32_t c) {
  return n->held[c] || !(n->moving[c] > 0.0) ? 0.0 : -sum_of(bound, n, c) / n->compliance[c];
}

/* Lets a contact act. It pushes and never pulls; its tangential impulse stops sliding, up to friction times
 * the normal one. Returns the velocity that it stopped. */
static double contact(mpmi_bound *bound, const mpmi_contact *pair, mpmi_contact_state *state, int32_t first) {
  const int32_t axis = pair->face / 2;
  contact_nodes n;
  if (first) state->closed = state->stuck = 0;
  if (!collect(bound, pair, &n)) return 0.0;
  const double inward = pair->face % 2 ? -1.0 : 1.0, normal = inward * stopping(bound, &n, axis);
  if (normal <= 0.0) return 0.0;
  state->closed = 1;
  give(bound, &n, pair->face, axis, inward * normal);
  double stop[3] = {0.0, 0.0, 0.0}, squared = 0.0;
  for (int32_t c = 0; c < bound->dim; ++c) {
    if (c != axis) stop[c] = stopping(bound, &n, c);
    squared += stop[c] * stop[c];
  }
  const double size = sqrt(squared), most = bound->step->settings->wall[pair->face].friction * normal;
  state->stuck = most >= size;
  const double share = state->stuck ? 1.0 : most / size;
  for (int32_t c = 0; share > 0.0 && c < bound->dim; ++c)
    if (c != axis) give(bound, &n, pair->face, c, share * stop[c]);
  return normal * n.compliance[axis];
}

/* Lets a contact act in a projection without forces: one that was closed stays so, one that was open is free.
 * Returns the largest velocity that it stopped. */
static double keep_contact(mpmi_bound *bound, const mpmi_contact *pair, const mpmi_contact_state *state) {
  contact_nodes n;
  double stopped = 0.0;
  if (!state->closed || !collect(bound, pair, &n)) return 0.0;
  for (int32_t c = 0; c < bound->dim; ++c) {
    if (c != pair->face / 2 && !state->stuck) continue;
    const double stop = stopping(bound, &n, c);
    give(bound, &n, pair->face, c, stop);
    stopped = fmax(stopped, fabs(stop) * n.compliance[c]);
  }
  return stopped;
}

/* Contacts of different faces share nodes at edges, and where walls are close. They are swept face by face
 * until what is left is this share of the first sweep; each push takes energy, whatever the order. */
static const double settled = 1e-13;
enum { SWEEPS = 100 };

/* What a sweep has come to: the largest velocity that was stopped, and the faces with contacts. */
typedef struct wall_sweep {
  double most;
  int32_t first_face, last_face; /* -1: there are none */
} wall_sweep;

/* Of several parts each sweeps all contacts that it has, and only its own count: others may lack a node. */
static wall_sweep sweep_once(mpmi_bound *bound, int32_t keep, int32_t first) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  const int64_t count = constraints->contact_count;
  wall_sweep done = {0.0, -1, -1};
  if (count) {
    done.first_face = constraints->contact[0].face;
    done.last_face = constraints->contact[count - 1].face;
  }
  for (int64_t i = 0; i < count; ++i) {
    const mpmi_contact *pair = &constraints->contact[i];
    mpmi_contact_state *state = &bound->nodes->contact_state[i];
    const double stopped = keep ? keep_contact(bound, pair, state) : contact(bound, pair, state, first);
    if (mpmi_owns_node(bound->step->layout->parts, pair->slot)) done.most = fmax(done.most, stopped);
  }
  return done;
}

/* Makes what parts know by themselves what all of them know. */
static mpm_status know_of_all(mpmi_parts *parts, wall_sweep *done, mpmi_contact_round *round) {
  enum { FACES = 6 };
  int64_t word[MPMI_ACCORD_WORDS] = {0,
                                     mpmi_ordered_bits(done->most),
                                     done->first_face < 0 ? 0 : FACES - done->first_face,
                                     1 + done->last_face,
                                     round->touches,
                                     mpmi_ordered_bits(round->most)};
  const mpm_status status = mpmi_accord_settle(parts, word);
  if (status) return status;
  done->most = mpmi_of_ordered_bits(word[1]);
  done->first_face = word[2] ? FACES - (int32_t)word[2] : -1;
  done->last_face = (int32_t)word[3] - 1;
  round->touches = word[4] != 0;
  round->most = mpmi_of_ordered_bits(word[5]);
  return MPM_OK;
}

mpm_status mpmi_friction_walls(mpmi_bound *bound, int32_t keep, int32_t first_round,
                               mpmi_contact_round *round) {
  mpmi_parts *parts = bound->step->layout->parts;
  mpm_status status = MPM_OK;
  double first = 0.0;
  for (int32_t i = 0; i < SWEEPS; ++i) {
    wall_sweep done = sweep_once(bound, keep, first_round && !i);
    if (parts && (status = know_of_all(parts, &done, round))) return status;
    if (!i) {
      first = done.most;
      round->touches &= done.last_face >= 0;
    }
    /* contacts of one face share no node: one sweep is enough */
    if (!(done.most > settled * first) || done.first_face == done.last_face) break;
  }
  round->most = fmax(round->most, first);
  return MPM_OK;
}
