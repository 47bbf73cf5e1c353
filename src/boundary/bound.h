/* Nodes between P2G and G2P as the parts of the boundary stage see them. Whatever changes a velocity changes
 * its increment by as much, so that the acceleration of a bound node is that of Steffen et al. 2008, eq. 30,
 * and mass times the change is the impulse that was given. */
#ifndef MPMI_BOUND_H
#define MPMI_BOUND_H

#include "layout/nodes.h"
#include "layout/step.h"
#include "layout/tasks.h"

/* A velocity field on its way through the boundary stage. */
typedef struct mpmi_bound {
  mpmi_step *step;
  mpmi_nodes *nodes;
  const mpmi_nodal *values; /* the nodes of the projection */
  /* share of the increment that particles take (FLIP); of the velocity they take 1 - flip */
  double flip;
  /* weight of this projection's impulses: the share of its velocities that particles take */
  double share;
  int32_t dim, records; /* records: impulses count as reactions */
  int32_t loads;        /* surfaces have given forces to the nodes */
  const int32_t *met;   /* the ties that are taken, or NULL: all */
  int64_t tie_count;    /* how many */
} mpmi_bound;

static inline const mpmi_constraints *mpmi_constraints_of(const mpmi_bound *bound) {
  return &bound->step->layout->constraints;
}

/* Runs a task on what is bound, which calls no host. */
static inline mpm_status mpmi_run_bound(mpmi_bound *bound, mpm_task_fn task) {
  return mpmi_run_tasks(bound->step->settings, 0, bound->step->settings->tasks, task, bound);
}

static inline double mpmi_increment_of(const mpmi_bound *bound, int64_t slot, int32_t c) {
  return mpmi_has_increments(bound->values) ? mpmi_increment(bound->values, slot)[c] : 0.0;
}

/* Returns the momentum per mass that particles take from a node: its increment with FLIP, else its velocity.
 * A boundary's impulse is the change of this times the mass. */
static inline double mpmi_given(const mpmi_bound *bound, int64_t slot, int32_t c) {
  return bound->flip * mpmi_increment_of(bound, slot, c) +
         (1.0 - bound->flip) * mpmi_velocity(bound->values, slot)[c];
}

/* Returns the mass that moves with a free node: its own, or that of its tie. */
static inline double mpmi_moving_mass(const mpmi_bound *bound, int64_t slot) {
  return mpmi_mass_moving(bound->step->layout, bound->nodes, bound->values, slot);
}

/* Returns 1 when the node follows no other and is heavy enough to move. */
static inline int32_t mpmi_moves(const mpmi_bound *bound, int64_t slot) {
  return mpmi_constraints_is_free(mpmi_constraints_of(bound), slot) &&
         mpmi_moving_mass(bound, slot) > bound->step->layout->mass_cut;
}

/* A component of a node's velocity before something changes it. */
typedef struct mpmi_component {
  double given, increment;
} mpmi_component;

static inline mpmi_component mpmi_component_of(const mpmi_bound *bound, int64_t slot, int32_t c) {
  return (mpmi_component){mpmi_given(bound, slot, c), mpmi_increment_of(bound, slot, c)};
}

/* Notes the impulse of a boundary on a node, and by how much it changed the node's increment. */
static inline void mpmi_note_impulse(mpmi_bound *bound, int64_t slot, int32_t c, double impulse,
                                     double change) {
  if (!bound->records) return;
  bound->nodes->impulse[slot].given[c] += bound->share * impulse;
  bound->nodes->impulse[slot].change[c] += bound->share * change;
}
/* Records how much more a free node now gives to particles, and returns it: the impulse. */
double mpmi_record(mpmi_bound *bound, int64_t slot, int32_t c, mpmi_component before);
/* Returns the work of what has changed a component of a free node that goes with `velocity`. Mirror images go
 * the other way and take an impulse the other way: all mass of the tie counts. */
double mpmi_work_done(const mpmi_bound *bound, int64_t slot, int32_t c, mpmi_component before,
                      double velocity);
/* Changes a component of v~ and dv of a free node with its tie by what no boundary gives, and returns what
 * particles take of that, by mass. */
double mpmi_shift_node(mpmi_bound *bound, int64_t slot, int32_t c, double velocity, double increment);
/* Changes a component of a free node's velocity by an impulse that is no reaction of walls or prescribed
 * velocities: that of another body. */
void mpmi_push_node(mpmi_bound *bound, int64_t slot, int32_t c, double by);
/* Changes a component of a free node's velocity by a contact with a wall, and records and returns the
 * impulse. It acts on all the mass that moves with the node; what mirrored ghosts take the other way round is
 * the wall's reaction. */
double mpmi_press_node(mpmi_bound *bound, int64_t slot, int32_t c, double by);

/* ---- ties.c ------------------------------------------------------------------------------------------ */
/* Gives each master the velocity of its whole tie, before the forces and after them. */
mpm_status mpmi_ties_fold(mpmi_bound *bound);
/* Sets the components that fixed and slip walls hold. */
mpm_status mpmi_ties_hold_walls(mpmi_bound *bound);
/* Gives the followers their master's velocity, with their signs, and records impulses and reactions. */
mpm_status mpmi_ties_unfold(mpmi_bound *bound);

/* ---- light_nodes.c ----------------------------------------------------------------------------------- */
/* Lets light nodes go with heavier ones beside them, which take their forces. */
mpm_status mpmi_light_nodes_lead(mpmi_bound *bound);
/* Does so once more where bodies may touch: contact has changed those that lead, and those that go with
 * them. Parties of contact know then whether they lead. */
mpm_status mpmi_light_nodes_lead_again(mpmi_bound *bound);

/* ---- damping.c --------------------------------------------------------------------------------------- */
/* Changes the increments of what nothing holds by local and mass damping; does nothing without them. */
mpm_status mpmi_damp(mpmi_bound *bound);
/* Sums up the energy that this took, once all velocities of the main projection are known. */
mpm_status mpmi_damping_sum(mpmi_bound *bound);

/* ---- held_nodes.c ------------------------------------------------------------------------------------ */
/* Asks the host and the prescribed particles who holds what. */
mpm_status mpmi_held_find(mpmi_bound *bound);
/* Sets the components that are held, as they were found. */
mpm_status mpmi_held_set(mpmi_bound *bound);

/* ---- velocity_callback.c ----------------------------------------------------------------------------- */
/* Asks the host's velocity callback about all free nodes that move; its answers go into held and
 * held_value. */
mpm_status mpmi_ask_velocities(mpmi_bound *bound);

/* ---- prescribed_nodes.c ------------------------------------------------------------------------------ */
/* Finds the nodes that prescribed particles hold, and their velocities; what the host holds stays the
 * host's. */
mpm_status mpmi_prescribed_hold(mpmi_bound *bound);
/* Gives prescribed particles their share of the impulses on these nodes, in the parts of the prescription. */
mpm_status mpmi_prescribed_share(mpmi_bound *bound);

/* ---- body_contact.c ---------------------------------------------------------------------------------- */
/* Returns 1 when there are nodes at which bodies may touch. */
static inline int32_t mpmi_bodies_touch(const mpmi_bound *bound) {
  return bound->nodes->contact.touch_count > 0;
}
/* Finds where bodies may touch, and asks the host for coefficients of friction. */
mpm_status mpmi_body_contacts_find(mpmi_bound *bound);
/* Finds the gaps of the touches that are asked for them where particles have come to, so many cells away at
 * most. */
mpm_status mpmi_body_contacts_find_after(mpmi_bound *bound, double moved);
/* Rounds of contact: the first one of a projection, those that go on from there, and those that go on where
 * light nodes have given to their leaders after that; free obstacles are left as they are then. */
enum { MPMI_FIRST_ROUND, MPMI_NEXT_ROUND, MPMI_LAST_ROUND };
/* Lets bodies act on each other, or with keeps, in a projection without forces, keeps their contacts as they
 * were found. *most becomes the largest velocity that changed. */
mpm_status mpmi_body_contacts_act(mpmi_bound *bound, int32_t keeps, int32_t round, double *most);
/* Adds up what they did, for reports. */
void mpmi_body_contacts_sum(mpmi_bound *bound);

/* ---- coupled_meetings.c ------------------------------------------------------------------------------ */
/* Lists the meetings that free obstacles couple, in their order; those of other parts become the last of the
 * meetings, parties and touches, from which the caller takes them away again. */
mpm_status mpmi_coupled_gather(mpmi_bound *bound);

/* ---- friction_callback.c ----------------------------------------------------------------------------- */
/* Asks the host for the coefficients of friction of the touches that may close. */
mpm_status mpmi_ask_friction(mpmi_bound *bound);

/* ---- friction_wall.c --------------------------------------------------------------------------------- */
/* A round in which bodies act on each other, and then walls on nodes. */
typedef struct mpmi_contact_round {
  int32_t touches; /* bodies touch; then: somewhere, and nodes rub on walls */
  double most;     /* the largest velocity that has changed between bodies; then also that at walls */
} mpmi_contact_round;
/* Lets friction walls act on nodes. With keep, in a projection without forces, contacts stay as they were
 * found. Rounds after the first go on from there. Of several parts all do so (collective). */
mpm_status mpmi_friction_walls(mpmi_bound *bound, int32_t keep, int32_t first_round,
                               mpmi_contact_round *round);

/* ---- node_batch.c ------------------------------------------------------------------------------------ */
enum { MPMI_NODE_BATCH = 256 }; /* the most nodes that a block has */
_Static_assert(MPMI_BLOCK_EDGE(1) <= MPMI_NODE_BATCH, "1-D");
_Static_assert(MPMI_BLOCK_EDGE(2) * MPMI_BLOCK_EDGE(2) <= MPMI_NODE_BATCH, "2-D");
_Static_assert(MPMI_BLOCK_EDGE(3) * MPMI_BLOCK_EDGE(3) * MPMI_BLOCK_EDGE(3) <= MPMI_NODE_BATCH, "3-D");

typedef struct mpmi_node_list {
  int64_t n, slot[MPMI_NODE_BATCH], index[3 * MPMI_NODE_BATCH];
  double position[3 * MPMI_NODE_BATCH], mass[MPMI_NODE_BATCH];
  uint8_t owned[MPMI_NODE_BATCH];
  mpm_node_batch batch;
} mpmi_node_list;

/* Lists the nodes of a block that move, and returns how many there are. Masters stand for their ties, with
 * the mass of the whole tie. */
int64_t mpmi_list_nodes(const mpmi_bound *bound, int64_t block, mpmi_node_list *list);
/* Notes in `failure` that the host's value on node i is not finite. */
void mpmi_bad_node(const mpmi_bound *bound, const mpmi_node_list *list, int64_t i, const char *what,
                   mpmi_failure *failure);

/* ---- hooks.c ----------------------------------------------------------------------------------------- */
/* These enclose the hooks of a step and do nothing where there are none; the end adds up their work. */
mpm_status mpmi_hooks_begin(mpmi_bound *bound);
mpm_status mpmi_hooks_end(mpmi_bound *bound);
/* Calls the hook of a stage, MPM_AFTER_P2G ..., if there is one. */
mpm_status mpmi_hooks_run(mpmi_bound *bound, int32_t stage);

#endif
