/* Light nodes: those that have hardly any mass beside a neighbour's. On the linear basis the gradient of a
 * node, and so its force, stays finite where a particle hardly touches it and its mass vanishes: force over
 * mass would be as large as the mass is small. A light node goes with heavier ones, by linear extrapolation
 * along lines of nodes, and gives them its force by the transposed rule (docs/theory.md, 7.1): a particle
 * that hardly reaches into a cell strains and pulls as if it had stayed in the cell beside. */
#include "boundary/bound.h"
#include "contact/contact.h"

#include <float.h>
#include <math.h>

/* The next two nodes on a line, for up to 12 lines. */
enum { MOST_LEADERS = 24 };

/* What nodes give leaders that they share is seen in the second round, without which slivers grow by USL. The
 * margin of parts, in mpmi_layout_create, is for so many. */
enum { ROUNDS = 2 };

/* Up to this share of mass a node goes with others where no line has its second node, and where it may touch
 * another body. */
#define LEAST_SHARE 1e-5

/* The nodes that a light one goes with. Their coefficients have the sum 1. */
typedef struct leaders {
  int32_t count, lone; /* lone: no line has its second node */
  int64_t slot[MOST_LEADERS];
  double share[MOST_LEADERS];
  int32_t held[MOST_LEADERS]; /* bits of the components that a wall holds */
} leaders;

/* Returns the node that moves for the one in a slot: itself, or the master of an image; -1 where there is
 * none or it is a mirror image. */
static int64_t mover_of(const mpmi_bound *bound, int64_t slot) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  if (slot < 0 || mpmi_constraints_is_free(constraints, slot)) return slot;
  const mpmi_tie *tie = &constraints->tie[constraints->tie_of[slot]];
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i)
    for (int32_t c = 0; c < bound->dim && constraints->follower[i].slot == slot; ++c)
      if (constraints->follower[i].sign[c] < 0.0) return -1;
  return tie->master;
}

static int64_t beside(const mpmi_bound *bound, int64_t slot, const int32_t *by, int32_t steps) {
  const int32_t offset[3] = {steps * by[0], steps * by[1], steps * by[2]};
  return mover_of(bound, mpmi_blocks_around(&bound->step->layout->blocks, slot, offset));
}

/* Sets one of the 27 directions in which nodes lie. Returns along how many axes it goes, or 0 where it leaves
 * the space of the grid. */
static int32_t direction_of(const mpmi_bound *bound, int32_t i, int32_t *by) {
  by[0] = i % 3 - 1, by[1] = i / 3 % 3 - 1, by[2] = i / 9 - 1;
  if ((bound->dim < 2 && by[1]) || (bound->dim < 3 && by[2])) return 0;
  return (by[0] != 0) + (by[1] != 0) + (by[2] != 0);
}

/* Returns 1 for a node in the plane of a face, where a wall is. */
static int32_t is_in_plane(const mpmi_bound *bound, int64_t slot, int32_t face) {
  const mpm_grid *grid = bound->step->settings->grid;
  int64_t index[3];
  if (grid->desc.periodic[face / 2]) return 0;
  mpmi_blocks_index(&bound->step->layout->blocks, slot, index);
  return index[face / 2] == mpmi_face_node(grid, face);
}

/* Returns the components of velocity, as bits, that a wall holds at a node. */
static int32_t held_by(const mpmi_bound *bound, int64_t slot, int32_t face) {
  const int32_t holds = mpmi_wall_kind_of(bound->step->settings->wall[face].kind)->holds;
  if (holds == MPMI_HOLDS_NOTHING || !is_in_plane(bound, slot, face)) return 0;
  return holds == MPMI_HOLDS_ALL ? 7 : 1 << face / 2;
}

/* Returns the mass of a node with that of the mirror image behind walls, in whose planes a node has half of
 * it: a body on a plane of symmetry moves as one half of the whole. */
static double whole_mass(const mpmi_bound *bound, int64_t slot) {
  double mass = mpmi_moving_mass(bound, slot);
  for (int32_t face = 0; face < 2 * bound->dim; ++face)
    if (held_by(bound, slot, face)) mass *= 2.0;
  return mass;
}

/* Returns 1 where contact may take the force on a node. */
static int32_t may_touch(const mpmi_bound *bound, int64_t slot) {
  const mpmi_contact_search search = {bound->step, bound->nodes, bound->values, &bound->nodes->contact};
  return bound->nodes->contact.site_count && mpmi_may_touch(&search, slot);
}

/* Returns the share of the mass of a node beside, up to which one is light. A light material is no sliver of
 * the heavy one with which it is bonded. Where bodies touch, a node pushes the other body while it has its
 * own force: there only those go with others that would be thrown, which are few where particles are strained
 * by velocities that they have given, unless their matrices hand the gradient of a node back. */
static double light_share(const mpmi_bound *bound, int64_t slot) {
  const mpmi_layout *layout = bound->step->layout;
  const mpmi_settings *settings = bound->step->settings;
  const int32_t throws = settings->desc.scheme == MPM_USL || mpmi_is_affine(settings);
  const mpmi_densities *of = &layout->densities[layout->blocks.body[slot / layout->blocks.nodes]];
  const double share = MPMI_LIGHT_SHARE * (of->least / of->most);
  return !throws && may_touch(bound, slot) ? fmin(LEAST_SHARE, share) : share;
}

static int32_t is_light(const mpmi_bound *bound, int64_t slot) {
  const double mass = whole_mass(bound, slot);
  if (mass > bound->step->layout->light_cut) return 0;
  const double share = light_share(bound, slot);
  for (int32_t i = 0; i < 27; ++i) {
    int32_t by[3];
    const int64_t near = direction_of(bound, i, by) ? beside(bound, slot, by, 1) : -1;
    if (near >= 0 && mass <= share * whole_mass(bound, near)) return 1;
  }
  return 0;
}

/* Returns 1 for a node that one of this mass may go with. */
static int32_t leads(const mpmi_bound *bound, int64_t slot, double mass, double share) {
  return slot >= 0 && mass <= share * whole_mass(bound, slot) && !is_light(bound, slot);
}

/* Adds the lines along so many axes on which the next node is heavy, and with it, or not, the one behind.
 * Without it the force is moved aside, which turns the body: that is left to nodes with hardly any. */
static void add_lines(const mpmi_bound *bound, int64_t slot, int32_t axes, leaders *found) {
  const double light = whole_mass(bound, slot);
  const double most = light_share(bound, slot), share = found->lone ? fmin(LEAST_SHARE, most) : most;
  double sum = 0.0;
  for (int32_t i = 0; i < 27; ++i) {
    int32_t by[3];
    if (direction_of(bound, i, by) != axes) continue;
    const int64_t near = beside(bound, slot, by, 1);
    if (!leads(bound, near, light, share)) continue;
    const int64_t far = beside(bound, slot, by, 2);
    if (found->lone != (far == near || !leads(bound, far, light, share))) continue;
    const double mass = whole_mass(bound, near);
    sum += mass;
    found->slot[found->count] = near;
    found->share[found->count++] = found->lone ? mass : 2.0 * mass;
    if (found->lone) continue;
    found->slot[found->count] = far;
    found->share[found->count++] = -mass;
  }
  for (int32_t k = 0; k < found->count; ++k) {
    found->share[k] /= sum;
    for (int32_t face = 0; face < 2 * bound->dim; ++face)
      found->held[k] |= held_by(bound, found->slot[k], face);
  }
}

/* Finds the lines from a light node: along axes, and where there are none across the edges of a cell, then
 * through its corners; without a second node only where no line has one. They count by the mass of the next
 * node. */
static leaders leaders_of(const mpmi_bound *bound, int64_t slot) {
  leaders found = {.count = 0};
  for (found.lone = 0; found.lone < 2; ++found.lone)
    for (int32_t axes = 1; axes <= bound->dim; ++axes) {
      add_lines(bound, slot, axes, &found);
      if (found.count) return found;
    }
  return found;
}

/* Gives momentum to the leaders of a node; gained: the part of it that counts among their increments. */
static void give(mpmi_bound *bound, const leaders *to, int32_t c, double momentum, double gained) {
  for (int32_t k = 0; k < to->count; ++k) {
    const double by = to->share[k] / mpmi_moving_mass(bound, to->slot[k]);
    mpmi_shift_node(bound, to->slot[k], c, by * momentum, by * gained);
  }
}

/* Returns a component of what the leaders of a node have of a vector: none where a wall will hold it. */
static double of_leaders(const mpmi_bound *bound, const leaders *of,
                         double *(*vector)(const mpmi_nodal *, int64_t), int32_t c) {
  double sum = 0.0;
  for (int32_t k = 0; k < of->count; ++k)
    if (!(of->held[k] >> c & 1)) sum += of->share[k] * vector(bound->values, of->slot[k])[c];
  return sum;
}

/* Returns how much of a velocity the leaders of a node take on when it gives them its momentum: those in the
 * plane of a wall that holds have the mass of their mirror images, too, if the node is not in it. */
static double response(const mpmi_bound *bound, const leaders *of, int64_t slot) {
  double sum = 0.0;
  for (int32_t k = 0; k < of->count; ++k) {
    double mass = mpmi_moving_mass(bound, of->slot[k]);
    for (int32_t face = 0; face < 2 * bound->dim; ++face)
      if (held_by(bound, of->slot[k], face) && !held_by(bound, slot, face)) mass *= 2.0;
    sum += of->share[k] * of->share[k] / mass;
  }
  return mpmi_moving_mass(bound, slot) * sum;
}

/* The list holds slots of nodes with mass. Returns the node that moves for one of them: itself if it is free,
 * its master if that has no mass and this image is the first that has; else -1, because another entry of the
 * list stands for the master. */
static int64_t listed_by(const mpmi_bound *bound, int64_t slot) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  if (mpmi_constraints_is_free(constraints, slot)) return slot;
  const mpmi_tie *tie = &constraints->tie[constraints->tie_of[slot]];
  int64_t first = tie->first;
  if (*mpmi_mass(bound->values, tie->master) > DBL_MIN) return -1;
  while (!(*mpmi_mass(bound->values, constraints->follower[first].slot) > DBL_MIN)) ++first;
  return constraints->follower[first].slot == slot ? tie->master : -1;
}

/* What is done to a light node and those that it goes with. */
typedef void (*light_fn)(mpmi_bound *bound, mpmi_light_node *node, const leaders *with);

static void over_light_nodes(mpmi_bound *bound, light_fn fn) {
  for (int64_t n = 0; n < bound->nodes->light_count; ++n) {
    mpmi_light_node *node = &bound->nodes->light[n];
    if (node->slot < 0) continue;
    const leaders with = leaders_of(bound, node->slot);
    fn(bound, node, &with);
  }
}

/* Returns 1 where a node goes with its own force into a wall that bears. */
static int32_t is_pressed(const mpmi_bound *bound, const mpmi_light_node *node, int32_t face) {
  const int32_t k = face / 2;
  if (mpmi_wall_kind_of(bound->step->settings->wall[face].kind)->rubs == MPMI_RUBS_NOT) return 0;
  return (face % 2 ? 1.0 : -1.0) * (node->before[k] + node->gain[k]) > 0.0 &&
         is_in_plane(bound, node->slot, face);
}

/* Returns the components, as bits, whose force a wall takes, so that leaders must not. */
static int32_t borne_of(const mpmi_bound *bound, const mpmi_light_node *node) {
  int32_t borne = 0;
  for (int32_t face = 0; face < 2 * bound->dim; ++face) {
    borne |= held_by(bound, node->slot, face);
    if (!is_pressed(bound, node, face)) continue;
    borne |= bound->step->settings->wall[face].friction > 0.0 ? 7 : 1 << face / 2;
  }
  return borne;
}

/* Without a line for its velocity a node keeps its own, and all where a wall bears it. */
static void look(mpmi_bound *bound, mpmi_light_node *node, const leaders *with) {
  const int32_t both = mpmi_has_increments(bound->values), borne = borne_of(bound, node);
  for (int32_t c = 0; c < bound->dim; ++c) {
    const double before = node->before[c], gain = node->gain[c];
    const double led = of_leaders(bound, with, mpmi_velocity, c);
    const double led_gain = both ? of_leaders(bound, with, mpmi_increment, c) : 0.0;
    node->led_gain[c] = borne >> c & 1 ? gain : led_gain;
    node->led_before[c] = borne >> c & 1 || with->lone ? before : led - led_gain;
  }
}

/* Gives the leaders so much of the momentum that a node has apart from them that it goes with them after
 * that, where no other gives to them, too. */
static void give_rest(mpmi_bound *bound, mpmi_light_node *node, const leaders *with) {
  const double mass = mpmi_moving_mass(bound, node->slot),
               part = 1.0 / (1.0 + response(bound, with, node->slot));
  for (int32_t c = 0; c < bound->dim; ++c) {
    const double before = part * (node->before[c] - node->led_before[c]);
    const double gain = part * (node->gain[c] - node->led_gain[c]);
    give(bound, with, c, mass * (before + gain), mass * gain);
    node->before[c] -= before;
    node->gain[c] -= gain;
  }
}

/* Sets v~ and dv of a light node, which had its own dv beside v until now. */
static void set(mpmi_bound *bound, int64_t slot, int32_t c, double velocity, double increment) {
  double *v = mpmi_velocity(bound->values, slot);
  const double own = mpmi_increment_of(bound, slot, c);
  mpmi_shift_node(bound, slot, c, velocity - (v[c] + own), increment - own);
  v[c] = velocity; /* without the rounding of the shift */
  if (mpmi_has_increments(bound->values)) mpmi_increment(bound->values, slot)[c] = increment;
}

/* A node that is not light after all, or that none leads, moves by its own force. */
static void go_alone(const mpmi_bound *bound, int64_t slot) {
  for (int32_t c = 0; c < bound->dim && mpmi_has_increments(bound->values); ++c)
    mpmi_velocity(bound->values, slot)[c] += mpmi_increment(bound->values, slot)[c];
}

/* Resolves a slot of the list to the node to be led, or -1. */
static int64_t to_be_led(const mpmi_bound *bound, int64_t listed) {
  const int64_t slot = listed_by(bound, listed);
  if (slot < 0 || mpmi_moving_mass(bound, slot) > bound->step->layout->light_cut) return -1;
  if (is_light(bound, slot) && leaders_of(bound, slot).count) return slot;
  go_alone(bound, slot);
  return -1;
}

static void begin(const mpmi_bound *bound, mpmi_light_node *node) {
  node->slot = to_be_led(bound, node->slot);
  for (int32_t c = 0; c < bound->dim && node->slot >= 0; ++c) {
    node->before[c] = mpmi_velocity(bound->values, node->slot)[c];
    node->gain[c] = mpmi_increment_of(bound, node->slot, c);
  }
}

static void follow(mpmi_bound *bound, const mpmi_light_node *node) {
  for (int32_t c = 0; c < bound->dim && node->slot >= 0; ++c)
    set(bound, node->slot, c, node->before[c] + node->gain[c], node->gain[c]);
}

/* All light nodes are looked at before any of them is changed: no result depends on their order. */
mpm_status mpmi_light_nodes_lead(mpmi_bound *bound) {
  const mpm_status status = bound->nodes->light_count ? mpmi_body_contacts_place(bound) : MPM_OK;
  if (status) return status;
  for (int64_t n = 0; n < bound->nodes->light_count; ++n) begin(bound, &bound->nodes->light[n]);
  for (int32_t round = 0; round < ROUNDS; ++round) {
    over_light_nodes(bound, look);
    over_light_nodes(bound, give_rest);
  }
  for (int64_t n = 0; n < bound->nodes->light_count; ++n) follow(bound, &bound->nodes->light[n]);
  return MPM_OK;
}
