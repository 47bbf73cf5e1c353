/* Who leads a light node: heavier ones beside it, along lines of nodes that have a second heavy one, and how
 * much of its motion is each one's (docs/theory.md, 7.1). */
#include "boundary/light_leaders.h"

#include <math.h>

/* Up to this share of mass a node goes with others where no line has its second node. */
#define LEAST_SHARE 1e-5

/* A node from which others are looked at. */
typedef struct spot {
  int64_t slot, block;
  double mass, share;
  int32_t at[3]; /* its place in the block */
} spot;

mpmi_light_search mpmi_light_search_of(const mpmi_bound *bound) {
  const mpmi_settings *settings = bound->step->settings;
  const int32_t edge = bound->step->layout->blocks.edge;
  mpmi_light_search s = {.bound = bound, .ties = mpmi_constraints_of(bound)->tie_count > 0};
  for (int32_t face = 0; face < 2 * bound->dim; ++face)
    if (mpmi_wall_kind_of(settings->wall[face].kind)->holds != MPMI_HOLDS_NOTHING)
      s.hold[s.hold_count++] = face;
  for (int32_t k = 0; k < bound->dim; ++k) s.periodic |= settings->grid->desc.periodic[k];
  for (int32_t axes = 1; axes <= bound->dim; ++axes) {
    s.first[axes] = s.first[axes - 1];
    for (int32_t i = 0; i < 27; ++i) {
      const int32_t by[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
      if ((by[0] != 0) + (by[1] != 0) + (by[2] != 0) != axes || (bound->dim < 2 && by[1]) ||
          (bound->dim < 3 && by[2]))
        continue;
      const int32_t d = s.first[axes]++;
      for (int32_t k = 0; k < 3; ++k) s.by[d][k] = by[k];
      for (int32_t k = 0; k < bound->dim; ++k) s.stride[d] = s.stride[d] * edge + by[k];
    }
  }
  return s;
}

/* ---- nodes beside, and masses -------------------------------------------------------------------------- */
/* Returns the node that moves for the one in a slot: itself, or the master of an image; -1 where there is
 * none or it is a mirror image. */
static int64_t mover_of(const mpmi_bound *bound, int64_t slot) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  if (slot < 0 || constraints->tie_of[slot] < 0 || mpmi_constraints_is_free(constraints, slot)) return slot;
  const mpmi_tie *tie = &constraints->tie[constraints->tie_of[slot]];
  for (int64_t i = tie->first; i < tie->first + tie->count; ++i)
    for (int32_t c = 0; c < bound->dim && constraints->follower[i].slot == slot; ++c)
      if (constraints->follower[i].sign[c] < 0.0) return -1;
  return tie->master;
}

static int64_t beside(const mpmi_light_search *s, const spot *of, int32_t d, int32_t steps) {
  const mpmi_blocks *b = &s->bound->step->layout->blocks;
  int32_t offset[3] = {0, 0, 0}, at[3], within = 1;
  for (int32_t k = 0; k < s->bound->dim; ++k) {
    offset[k] = steps * s->by[d][k];
    at[k] = of->at[k] + offset[k];
    within &= (uint32_t)at[k] < (uint32_t)b->edge;
  }
  int64_t near = within ? of->slot + steps * s->stride[d] : mpmi_blocks_near(b, of->block, at);
  if (near < 0 && s->periodic) near = mpmi_blocks_around(b, of->slot, offset);
  return s->ties ? mover_of(s->bound, near) : near;
}

int32_t mpmi_light_in_plane(const mpmi_bound *bound, int64_t slot, int32_t face) {
  const mpm_grid *grid = bound->step->settings->grid;
  int64_t index[3];
  if (grid->desc.periodic[face / 2]) return 0;
  mpmi_blocks_index(&bound->step->layout->blocks, slot, index);
  return index[face / 2] == mpmi_face_node(grid, face);
}

/* Returns the components of velocity, as bits, that the wall of a face holds at a node. */
static int32_t held_by(const mpmi_bound *bound, int64_t slot, int32_t face) {
  if (!mpmi_light_in_plane(bound, slot, face)) return 0;
  const int32_t holds = mpmi_wall_kind_of(bound->step->settings->wall[face].kind)->holds;
  return holds == MPMI_HOLDS_ALL ? 7 : 1 << face / 2;
}

int32_t mpmi_light_held(const mpmi_light_search *s, int64_t slot) {
  int32_t held = 0;
  for (int32_t i = 0; i < s->hold_count; ++i) held |= held_by(s->bound, slot, s->hold[i]);
  return held;
}

/* Returns the mass of a node with that of the mirror image behind walls, in whose planes a node has half of
 * it: a body on a plane of symmetry moves as one half of the whole. */
static double whole_mass(const mpmi_light_search *s, int64_t slot) {
  double mass = s->ties ? mpmi_moving_mass(s->bound, slot) : *mpmi_mass(s->bound->values, slot);
  for (int32_t i = 0; i < s->hold_count; ++i)
    if (held_by(s->bound, slot, s->hold[i])) mass *= 2.0;
  return mass;
}

/* ---- light or not -------------------------------------------------------------------------------------- */
/* Returns the share of the mass of a node beside, up to which one is light. A light material is no sliver of
 * the heavy one with which it is bonded. */
static double light_share(const mpmi_light_search *s, const spot *node) {
  const mpmi_layout *layout = s->bound->step->layout;
  const mpmi_densities *of = &layout->densities[layout->blocks.body[node->block]];
  return MPMI_LIGHT_SHARE * (of->least / of->most);
}

static spot spot_of(const mpmi_light_search *s, int64_t slot, double mass) {
  const mpmi_blocks *b = &s->bound->step->layout->blocks;
  spot of = {.slot = slot, .block = slot / b->nodes, .mass = mass};
  int32_t place = (int32_t)(slot - of.block * b->nodes);
  for (int32_t k = s->bound->dim - 1; k >= 0; --k) {
    of.at[k] = place % b->edge;
    place /= b->edge;
  }
  return of;
}

/* Returns 1 for a node that has hardly any mass beside a neighbour's. */
static int32_t is_light(const mpmi_light_search *s, int64_t slot, double mass) {
  if (mass > s->bound->step->layout->light_cut) return 0;
  spot of = spot_of(s, slot, mass);
  of.share = light_share(s, &of);
  for (int32_t d = 0; d < s->first[s->bound->dim]; ++d) {
    const int64_t near = beside(s, &of, d, 1);
    if (near >= 0 && mass <= of.share * whole_mass(s, near)) return 1;
  }
  return 0;
}

/* ---- lines --------------------------------------------------------------------------------------------- */
/* What is beside a node, direction by direction. */
typedef struct ring {
  int64_t slot[MPMI_DIRECTIONS];
  double mass[MPMI_DIRECTIONS];
} ring;

static void look_along(const mpmi_light_search *s, const spot *of, int32_t axes, ring *near) {
  for (int32_t d = s->first[axes - 1]; d < s->first[axes]; ++d) {
    near->slot[d] = beside(s, of, d, 1);
    near->mass[d] = near->slot[d] < 0 ? 0.0 : whole_mass(s, near->slot[d]);
  }
}

/* Returns, as bits, the lines along so many axes on which the next node is heavy and not light itself, and
 * with it, or not (lone), the one behind. Without it the force is moved aside, which turns the body: that is
 * left to nodes with hardly any. */
static uint32_t lines_along(const mpmi_light_search *s, const spot *of, int32_t axes, int32_t lone,
                            const ring *near) {
  const double share = lone ? fmin(LEAST_SHARE, of->share) : of->share;
  uint32_t lines = 0;
  for (int32_t d = s->first[axes - 1]; d < s->first[axes]; ++d) {
    if (!(of->mass <= share * near->mass[d]) || is_light(s, near->slot[d], near->mass[d])) continue;
    const int64_t far = beside(s, of, d, 2);
    const double mass = far < 0 || far == near->slot[d] ? 0.0 : whole_mass(s, far);
    if (lone != (of->mass <= share * mass && !is_light(s, far, mass))) lines |= (uint32_t)1 << d;
  }
  return lines;
}

/* Lines go along axes, and where there are none across the edges of a cell, then through its corners; without
 * a second node only where no line has one. A node that has a line is light. */
void mpmi_light_find_lines(const mpmi_light_search *s, mpmi_light_node *node) {
  node->lines = 0;
  node->count = 0;
  const double mass = whole_mass(s, node->slot);
  if (mass > s->bound->step->layout->light_cut) return;
  spot of = spot_of(s, node->slot, mass);
  of.share = light_share(s, &of);
  ring near;
  for (int32_t lone = 0; lone < 2; ++lone)
    for (int32_t axes = 1; axes <= s->bound->dim; ++axes) {
      if (!lone) look_along(s, &of, axes, &near);
      node->lines = lines_along(s, &of, axes, lone, &near);
      node->lone = lone;
      for (uint32_t lines = node->lines; lines; lines &= lines - 1) node->count += 2 - lone;
      if (node->count) return;
    }
}

/* Returns how much of a velocity the leaders of a node take on when it gives them its momentum: those in the
 * plane of a wall that holds have the mass of their mirror images, too, if the node is not in it. */
static double response(const mpmi_light_search *s, const mpmi_light_node *node, const mpmi_leader *leader) {
  double sum = 0.0;
  for (int32_t k = 0; k < node->count; ++k) {
    double mass = mpmi_moving_mass(s->bound, leader[k].slot);
    for (int32_t i = 0; i < s->hold_count; ++i)
      if (held_by(s->bound, leader[k].slot, s->hold[i]) && !held_by(s->bound, node->slot, s->hold[i]))
        mass *= 2.0;
    sum += leader[k].share * leader[k].share / mass;
  }
  return mpmi_moving_mass(s->bound, node->slot) * sum;
}

/* Lines count by the mass of the next node. */
void mpmi_light_fill(const mpmi_light_search *s, mpmi_light_node *node, mpmi_leader *leader) {
  const spot of = spot_of(s, node->slot, 0.0);
  double sum = 0.0;
  int32_t count = 0;
  for (int32_t d = 0; d < s->first[s->bound->dim]; ++d) {
    if (!(node->lines >> d & 1)) continue;
    const int64_t near = beside(s, &of, d, 1);
    const double mass = whole_mass(s, near);
    sum += mass;
    leader[count++] = (mpmi_leader){.slot = near, .share = node->lone ? mass : 2.0 * mass};
    if (!node->lone) leader[count++] = (mpmi_leader){.slot = beside(s, &of, d, 2), .share = -mass};
  }
  for (int32_t k = 0; k < count; ++k) {
    leader[k].share /= sum;
    leader[k].held = mpmi_light_held(s, leader[k].slot);
  }
  node->part = 1.0 / (1.0 + response(s, node, leader));
}
