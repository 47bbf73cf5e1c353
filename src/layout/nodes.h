/* The nodes of one velocity field: what a step keeps for each slot of the layout's blocks.
 *
 * A node is reached through the accessors below, which alone know where its values stand. */
#ifndef MPMI_NODES_H
#define MPMI_NODES_H

#include "layout/sorted_layout.h"

/* Values of all nodes, 4 or 8 each: a vector and the mass; with 8 values another vector, and one unused. The
 * first vector is the momentum, and the velocity once it has been divided by the mass; the second is the
 * force, and the increment of the velocity. */
typedef struct mpmi_nodal {
  double *at;
  int32_t values;
  int64_t capacity; /* in doubles */
  /* The count of covers of the layout when all nodes that are not met (reached.h) were 0, or -1: they must be
   * cleared. */
  int64_t zero_elsewhere;
} mpmi_nodal;

static inline int32_t mpmi_zero_elsewhere(const mpmi_layout *layout, const mpmi_nodal *nodes) {
  return nodes->zero_elsewhere == layout->covers;
}

/* Makes room for so many values of each node; they are not cleared. */
mpm_status mpmi_nodal_reserve(mpm_context *c, mpmi_nodal *nodes, int64_t slots, int32_t values);
void mpmi_nodal_free(mpm_context *c, mpmi_nodal *nodes);

static inline double *mpmi_nodal_at(const mpmi_nodal *nodes, int64_t slot) {
  return nodes->at + slot * nodes->values;
}
static inline double *mpmi_momentum(const mpmi_nodal *nodes, int64_t slot) {
  return mpmi_nodal_at(nodes, slot);
}
static inline double *mpmi_velocity(const mpmi_nodal *nodes, int64_t slot) {
  return mpmi_nodal_at(nodes, slot);
}
static inline double *mpmi_mass(const mpmi_nodal *nodes, int64_t slot) {
  return mpmi_nodal_at(nodes, slot) + 3;
}
/* Returns 1 when there are 8 values, with the increment of the velocity. */
static inline int32_t mpmi_has_increments(const mpmi_nodal *nodes) {
  return nodes->values == 8;
}
static inline double *mpmi_increment(const mpmi_nodal *nodes, int64_t slot) {
  return mpmi_nodal_at(nodes, slot) + 4;
}

/* What walls and prescribed velocities gave to a node in the step, and by how much they changed the increment
 * of its velocity. */
typedef struct mpmi_impulse {
  double given[3], change[3];
} mpmi_impulse;

/* Sums over the prescribed particles around a node: momentum and mass by axis; then, in place of the
 * momentum, the impulse on them by mass. They go through tiles of 8 values. */
typedef struct mpmi_prescribed_sums {
  double momentum[3], mass[3], unused[2];
} mpmi_prescribed_sums;
_Static_assert(sizeof(mpmi_prescribed_sums) == 8 * sizeof(double), "goes through tiles");

/* Holds, for the prescribed particles of one set in one block, their impulse on the material and the work of
 * moving them. */
typedef struct mpmi_prescribed_part {
  double impulse[3], work;
} mpmi_prescribed_part;

/* Prescribed particles of a step (boundary/prescribed.h). */
typedef struct mpmi_prescription {
  int32_t any;                /* some set has them; only then is the rest there */
  mpmi_prescribed_sums *sums; /* [slots] */
  uint8_t *block;             /* [blocks] flags */
  mpmi_prescribed_part *part; /* [blocks][members] */
  int64_t sums_capacity, block_capacity, part_capacity;
} mpmi_prescription;

/* A node that is so light that it goes with others (boundary/light_nodes.c): its velocity before the forces
 * and its increment, and those of its leaders. */
typedef struct mpmi_light_node {
  int64_t slot;        /* its own; then that of the node to be led, or -1 */
  uint32_t lines;      /* the directions in which its leaders lie, as bits */
  int32_t count, lone; /* of leaders; lone: no line has its second node */
  int32_t acts;        /* it gives to them and goes with them now */
  int32_t kept;        /* components, as bits, that something else has set */
  int64_t first;       /* of its leaders */
  double part;         /* of what it gives: with this it goes as its leaders do after that */
  double before[3], gain[3], led_before[3], led_gain[3];
} mpmi_light_node;

/* A node that a light one goes with. The shares of all have the sum 1. */
typedef struct mpmi_leader {
  int64_t slot;
  double share;
  int32_t held; /* components that a wall holds, as bits */
} mpmi_leader;

/* A node that moves, where a surface prescribes something (boundary/surface_sites.c). The vector is the
 * velocity that it asks for, or the direction in which it sets the velocity to a value. */
typedef struct mpmi_surface_site {
  int64_t slot;
  int32_t surface, before; /* before: the site of another surface at the same node, or -1 */
  int32_t slides;          /* 1: there is such a direction */
  int32_t holds[3];        /* 1: it holds this component */
  double weight, largest, value, vector[3], normal[3], impulse[3]; /* largest: of the shape functions */
  /* Sums over markers with their arms from the node: arms, products of arms, and arms times the vector, and
   * the value; then of the last how these change along the surface. */
  double first[3], second[3][3], slope[4][3];
} mpmi_surface_site;
typedef struct mpmi_surface_sites {
  int64_t count, capacity, last_capacity;
  mpmi_surface_site *site;
  int32_t *last; /* [slots] the last site at a node, or -1 */
} mpmi_surface_sites;

/* State of a tie from folding to unfolding. */
typedef struct mpmi_tie_state {
  double mass;         /* of all its nodes */
  double net[3];       /* the same with the followers' signs, by component */
  double before[3];    /* what the master gave to particles before folding, by mass */
  double increment[3]; /* of the master's velocity before folding */
  double recorded[3];  /* impulse that is recorded already; in the end what the walls got beside */
  double mirrored[3];  /* what mirror images add to the forces of surfaces by turning them round */
} mpmi_tie_state;

/* State of a contact with a friction wall, as it was found with forces; projections without them keep to
 * it. */
typedef struct mpmi_contact_state {
  int32_t closed, stuck;
} mpmi_contact_state;

enum { MPMI_HELD_BY_HOST = 1, MPMI_HELD_BY_PARTICLES = 2, MPMI_HELD_BY_SURFACES = 3 };

typedef struct mpmi_nodes {
  mpmi_nodal solved;    /* the projection with forces, 4 or 8 values: what particles take from */
  mpmi_nodal projected; /* the other projections, 4 values */
  mpmi_nodal sums; /* 4 values: the corrections of XPIC and FMPM, or the cell sums of the locking remedy */
  int32_t has_impulses; /* 1: impulses on nodes must be remembered; else `impulse` is not there */
  mpmi_impulse *impulse;
  int64_t impulse_capacity;
  int32_t has_holders; /* 1: velocities may be prescribed; else `held` and `held_value` are not there */
  uint8_t (*held)[3];  /* who prescribes a component: MPMI_HELD_BY_..., or 0 for nobody */
  double (*held_value)[3];
  int64_t held_capacity;
  double (*hook_impulse)[3]; /* there only where there are hooks */
  int64_t hook_capacity;
  double (*damping_impulse)[3]; /* there only where nodes are damped */
  int64_t damping_capacity;
  mpmi_light_node *light; /* in the order of slots */
  int64_t light_count, light_capacity;
  mpmi_leader *leader; /* of one light node after the other */
  int64_t leader_capacity;
  mpmi_tie_state *tie_state; /* [ties] */
  int64_t tie_capacity;
  int64_t tie_states_of; /* the count of covers for which states of ties that are left alone are 0, or -1 */
  mpmi_contact_state *contact_state; /* [contacts] */
  int64_t contact_capacity;
  mpmi_prescription prescription;
  mpmi_surface_sites surface_sites;
  mpmi_contact_nodes contact; /* nodes where bodies meet */
  double shown_dt;            /* time over which forces changed the velocities that views show */
  int64_t shown;              /* version of the layout that views show, or -1: nothing */
} mpmi_nodes;

/* Returns the mass that moves with a free node: its own, or that of its tie once that is folded. */
static inline double mpmi_mass_moving(const mpmi_layout *layout, const mpmi_nodes *nodes,
                                      const mpmi_nodal *values, int64_t slot) {
  const int32_t tie = layout->constraints.tie_of[slot];
  return tie < 0 ? *mpmi_mass(values, slot) : nodes->tie_state[tie].mass;
}

/* Returns 1 where nodes may be given values that no stencil meets: by the host, or by implicit steps. */
static inline int32_t mpmi_gives_anywhere(const mpmi_settings *settings) {
  return settings->velocity_bc || mpmi_has_hooks(settings) || mpmi_is_implicit(settings);
}
/* Returns 1 where ties that no stencil meets are left alone: they have no mass, and nobody gives their nodes
 * a velocity or a force. */
int32_t mpmi_leaves_ties(const mpmi_layout *layout, const mpmi_settings *settings);

/* Returns 1 where obstacles want to know where the nodes of a total Lagrangian grid have come to. */
static inline int32_t mpmi_places_nodes(const mpmi_settings *settings, const mpmi_nodes *nodes) {
  return mpmi_is_total_lagrangian(settings->grid) && nodes->contact.surface_count > 0;
}

/* Returns who has the reaction of a component: the host, prescribed particles or surfaces; 0 for others. */
static inline int32_t mpmi_held_by(const mpmi_nodes *nodes, int64_t slot, int32_t c) {
  return nodes->has_holders ? nodes->held[slot][c] : 0;
}

/* Returns the same for who says how it moves. Across a wall that mirrors, prescribed particles and their
 * images hold a node on the plane where the wall does. */
static inline int32_t mpmi_moved_by(const mpmi_nodes *nodes, const mpmi_constraints *constraints,
                                    int64_t slot, int32_t c) {
  const int32_t held = mpmi_held_by(nodes, slot, c);
  return held == MPMI_HELD_BY_PARTICLES && mpmi_is_own_image(constraints, slot, c) ? 0 : held;
}

/* Makes room for a step in whole, or with `staged` in parts, once the prescribed particles are known. */
mpm_status mpmi_nodes_prepare(mpmi_nodes *nodes, const mpmi_settings *settings, const mpmi_layout *layout,
                              int32_t staged);
/* Returns the number of nodes that are heavier than the cut. */
int64_t mpmi_count_active(const mpmi_layout *layout, const mpmi_nodal *nodes);
/* Returns how many of them are this part's to count. */
int64_t mpmi_count_owned(const mpmi_layout *layout, const mpmi_nodal *nodes);
void mpmi_nodes_free(mpmi_nodes *nodes, mpm_context *context);

#endif
