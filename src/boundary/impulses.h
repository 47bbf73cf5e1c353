/* Nodes between P2G and G2P as the parts of the boundary stage see them. Whatever changes a velocity changes
 * its increment by as much, so that the acceleration of a bound node is that of Steffen et al. 2008, eq. 30,
 * and mass times the change is the impulse that was given. */
#ifndef MPMI_IMPULSES_H
#define MPMI_IMPULSES_H

#include "layout/nodes.h"
#include "layout/step.h"

/* A velocity field on its way through the boundary stage. */
typedef struct mpmi_bound {
  mpmi_step *step;
  mpmi_nodes *nodes;
  const mpmi_nodal *values; /* of the projection */
  double flip;              /* share of the increment in what particles take */
  double share;             /* of the velocities in what particles take: impulses count as much */
  int32_t dim, records;     /* records: impulses count as reactions */
} mpmi_bound;

/* Who holds a component of a node, in held[][]. */
enum { MPMI_HELD_BY_HOST = 1, MPMI_HELD_BY_PARTICLES = 2 };

static inline const mpmi_constraints *mpmi_constraints_of(const mpmi_bound *bound) {
  return &bound->step->layout->constraints;
}

static inline double mpmi_increment_of(const mpmi_bound *bound, int64_t slot, int32_t c) {
  return mpmi_has_increments(bound->values) ? mpmi_increment(bound->values, slot)[c] : 0.0;
}

/* What particles take from a node's velocity per unit of its mass: the change with FLIP, the whole with the
 * others. The impulse of a boundary is how much more of it there is. */
static inline double mpmi_given(const mpmi_bound *bound, int64_t slot, int32_t c) {
  return bound->flip * mpmi_increment_of(bound, slot, c) +
         (1.0 - bound->flip) * mpmi_velocity(bound->values, slot)[c];
}

/* Mass that moves with a free node: its own, or that of its tie. */
static inline double mpmi_moving_mass(const mpmi_bound *bound, int64_t slot) {
  const int32_t tie = mpmi_constraints_of(bound)->tie_of[slot];
  return tie < 0 ? *mpmi_mass(bound->values, slot) : bound->nodes->tie_state[tie].mass;
}

/* Does a free node that moves take part? */
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
void mpmi_note_impulse(mpmi_bound *bound, int64_t slot, int32_t c, double impulse, double change);
/* Records what a free node gives to the particles more than before: the impulse is returned. */
double mpmi_record(mpmi_bound *bound, int64_t slot, int32_t c, mpmi_component before);
/* The same for a contact, which acts on the whole mass that moves with the node: what mirrored ghosts take of
 * it the other way round is the reaction of the wall that mirrors them. */
double mpmi_record_whole(mpmi_bound *bound, int64_t slot, int32_t c, mpmi_component before);

/* Adds the works by block, in the order of blocks, to the work of the step. */
void mpmi_add_block_work(mpmi_step *step);

#endif
