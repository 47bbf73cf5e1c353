/* Some nodes are not free: periodic images, mirrored ghosts, nodes on a wall, contact pairs.
 *
 * Seen from the grid update every linear condition is the same thing: the velocity of a node that follows is
 * that of its master, component by component with a sign:
 *
 *   periodic image   v_image = v_master
 *
 *   slip wall        v_ghost = mirror image (normal component negated), v_wall,n = 0
 *
 *   fixed wall       v_ghost = -v_mirror, v_wall = 0
 *
 * A tie is a master with its followers; the signs of conditions on several axes multiply. Mass, momentum and
 * force of a tie are folded into the master, solved there, and copied back, which conserves what the
 * condition does not take away. Friction walls are contacts: of a node on the wall, or of a ghost and its
 * mirror where the stencil is wide. */
#ifndef MPMI_CONSTRAINTS_H
#define MPMI_CONSTRAINTS_H

#include "grid/blocks.h"
#include "grid/walls.h"

typedef struct mpmi_follower {
  int64_t slot;
  double sign[3];
} mpmi_follower;

typedef struct mpmi_tie {
  int64_t master;
  int64_t first, count; /* its followers are [first, first + count) */
  uint8_t zero[3];      /* 1: a wall holds the component at 0 */
  uint8_t across[3];    /* 1: it is the one across a wall on whose plane the master lies */
  int32_t face[3];      /* wall that takes the reaction of a component, or -1 */
} mpmi_tie;

/* A contact is a node on a friction wall, or a ghost and its mirror. */
typedef struct mpmi_contact {
  int64_t slot, partner; /* partner: the mirror, or -1 without one */
  int32_t face;
} mpmi_contact;

typedef struct mpmi_constraints {
  mpm_context *context;
  int64_t tie_count, tie_capacity;
  mpmi_tie *tie;
  int64_t follower_count, follower_capacity;
  mpmi_follower *follower;
  int64_t contact_count, contact_capacity;
  mpmi_contact *contact; /* ordered by face */
  int64_t map_capacity;
  int32_t *tie_of; /* [slots] tie of a master or follower, or -1 */
} mpmi_constraints;

void mpmi_constraints_init(mpmi_constraints *constraints, mpm_context *context);
void mpmi_constraints_free(mpmi_constraints *constraints);
/* Finds every constrained node of the blocks. On failure the contents are undefined, so build into a spare
 * and swap. */
mpm_status mpmi_constraints_build(mpmi_constraints *constraints, const mpmi_blocks *blocks,
                                  const mpmi_wall *wall);
/* Returns 1 when the node in a slot moves by itself and follows no other. */
int32_t mpmi_constraints_is_free(const mpmi_constraints *constraints, int64_t slot);
/* Returns 1 for the component of a node across a fixed or slip wall on whose plane it lies: there the node is
 * its own mirror image. */
static inline int32_t mpmi_is_own_image(const mpmi_constraints *constraints, int64_t slot, int32_t c) {
  const int32_t tie = constraints->tie_of[slot];
  return tie >= 0 && constraints->tie[tie].across[c];
}

#endif
