/* What the parts of the boundary stage share: the nodes as they are between P2G and G2P.
 *
 * Ties are folded into their masters (grid/constraints.h) while the host, prescribed particles, walls and
 * contacts change velocities. Whatever changes a velocity changes its increment by as much, so that the
 * acceleration of a bound node is that of Steffen et al. 2008, eq. 30, and mass times the change is the
 * impulse that was given. */
#ifndef MPMI_BOUNDARY_H
#define MPMI_BOUNDARY_H

#include "stepper/stepper.h"

typedef struct mpmi_boundary {
  mpm_stepper *s;
  double *nodes, dt, flip; /* flip: share of the increment in what particles take */
  double share;            /* of the velocities in what particles take: impulses count as much */
  int32_t values, dim, zero_acceleration, books; /* books: impulses count as reactions */
} mpmi_boundary;

/* Who holds a component of a node, in held[]. */
enum { MPMI_HELD_BY_HOST = 1, MPMI_HELD_BY_PARTICLES = 2 };

/* Of a tie: folded mass, signed mass by component, what the master gave to particles before folding,
 * impulse that is booked already. */
typedef struct mpmi_tie_state {
  double mass, net[3], before[3], increment[3], booked[3];
} mpmi_tie_state;
_Static_assert(sizeof(mpmi_tie_state) == MPMI_TIE_STATE * sizeof(double), "tie state");

static inline mpmi_tie_state *mpmi_tie_state_of(const mpmi_boundary *f, int64_t tie) {
  return (mpmi_tie_state *)(void *)f->s->tie_state + tie;
}

static inline double *mpmi_node_at(const mpmi_boundary *f, int64_t slot) {
  return f->nodes + slot * f->values;
}

static inline double mpmi_increment(const mpmi_boundary *f, int64_t slot, int32_t c) {
  return f->values == 8 ? mpmi_node_at(f, slot)[4 + c] : 0.0;
}

/* What particles take from a node's velocity per unit of its mass: the change with FLIP, the whole with the
 * others. The impulse of a boundary is how much more of it there is. */
static inline double mpmi_given(const mpmi_boundary *f, int64_t slot, int32_t c) {
  return f->flip * mpmi_increment(f, slot, c) + (1.0 - f->flip) * mpmi_node_at(f, slot)[c];
}

/* Mass that moves with a free node: its own, or that of its tie. */
static inline double mpmi_moving_mass(const mpmi_boundary *f, int64_t slot) {
  const int32_t tie = f->s->constraints.tie_of[slot];
  return tie < 0 ? mpmi_node_at(f, slot)[3] : mpmi_tie_state_of(f, tie)->mass;
}

/* Does a free node that moves take part? */
static inline int32_t mpmi_moves(const mpmi_boundary *f, int64_t slot) {
  return mpmi_constraints_is_free(&f->s->constraints, slot) && mpmi_moving_mass(f, slot) > f->s->mass_cut;
}

static inline int32_t mpmi_held_by(const mpmi_boundary *f, int64_t slot, int32_t c) {
  return f->s->holds ? f->s->held[3 * slot + c] : 0;
}

typedef struct mpmi_component_state {
  double given, increment;
} mpmi_component_state;

static inline mpmi_component_state mpmi_component_of(const mpmi_boundary *f, int64_t slot, int32_t c) {
  return (mpmi_component_state){mpmi_given(f, slot, c), mpmi_increment(f, slot, c)};
}

/* Takes note of what a free node gives to the particles more than before: the impulse is returned. */
double mpmi_book(const mpmi_boundary *f, int64_t slot, int32_t c, mpmi_component_state before);
/* The same for a contact, which acts on the whole mass that moves with the node: what mirrored ghosts take of
 * it the other way round is the reaction of the wall that mirrors them. */
double mpmi_book_whole(const mpmi_boundary *f, int64_t slot, int32_t c, mpmi_component_state before);

/* The blocks that task k of the stepper's tasks works on. */
static inline int64_t mpmi_first_block(const mpm_stepper *s, int64_t k) {
  return s->blocks.count * k / s->tasks;
}

/* contact.c: friction walls; again: as they were found before, in a projection without forces. */
void mpmi_contacts(const mpmi_boundary *f, int32_t again);

/* node_batch.c: asks the velocity callback. */
mpm_status mpmi_ask_velocities(const mpmi_boundary *f);

/* hooks.c: begin and end, with nothing between them where there are no hooks; end adds up their work. */
mpm_status mpmi_hooks_begin(mpm_stepper *s);
mpm_status mpmi_run_hook(const mpmi_boundary *f, int32_t stage);
mpm_status mpmi_hooks_end(const mpmi_boundary *f);
mpm_status mpmi_hooks_prepare(mpm_stepper *s);
void mpmi_hooks_free(mpm_stepper *s);

/* prescribed.c, prescribed_nodes.c: the nodes that prescribed particles hold; their share of the impulses. */
mpm_status mpmi_prescribed_prepare(mpm_stepper *s);
mpm_status mpmi_prescribed_hold(const mpmi_boundary *f);
mpm_status mpmi_prescribed_share(const mpmi_boundary *f);
void mpmi_prescribed_free(mpm_stepper *s);

/* Adds block_work to the work of the step, in the order of blocks. */
void mpmi_add_block_work(mpm_stepper *s);

#endif
