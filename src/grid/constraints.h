/* Nodes that are not free: periodic images, mirrored ghosts, nodes on a wall, contact pairs.
 *
 * Seen from the grid update every linear condition is the same thing: the velocity of a dependent node is
 * that of its master, component by component with a sign:
 *
 *   periodic image   v_image = v_master
 *
 *   slip wall        v_ghost = mirror image (normal component negated), v_wall,n = 0
 *
 *   fixed wall       v_ghost = -v_mirror, v_wall = 0
 *
 * An orbit is a master with its dependants; conditions on several axes multiply. Mass, momentum and force of
 * an orbit are folded into the master, solved there, and copied back, which conserves what the condition does
 * not take away. Friction walls are contacts between the nodes of a wall and, for wide stencils, pairs of
 * ghost and mirror. */
#ifndef MPMI_CONSTRAINTS_H
#define MPMI_CONSTRAINTS_H

#include "grid/blocks.h"

typedef struct mpmi_wall {
  int32_t kind;
  double friction;
} mpmi_wall;

typedef struct mpmi_dependant {
  int64_t slot;
  double sign[3];
} mpmi_dependant;

typedef struct mpmi_orbit {
  int64_t master;
  int64_t first, count; /* dependants */
  int32_t zero[3];      /* component held at 0 by a wall */
  int32_t face[3];      /* wall that takes the reaction of a component, or -1 */
} mpmi_orbit;

/* A node on a friction wall, or a ghost and its mirror. */
typedef struct mpmi_contact {
  int64_t slot, partner; /* partner -1: alone */
  int32_t face;
  int32_t closed, stuck; /* as found with forces; projections without them keep to it */
} mpmi_contact;

typedef struct mpmi_constraints {
  mpm_context *context;
  int64_t orbit_count, orbit_capacity;
  mpmi_orbit *orbit;
  int64_t dependant_count, dependant_capacity;
  mpmi_dependant *dependant;
  int64_t contact_count, contact_capacity;
  mpmi_contact *contact; /* face by face */
  int64_t map_capacity;
  int32_t *orbit_of; /* [slots]: orbit of a node, or -1; a dependant has that of its master */
} mpmi_constraints;

void mpmi_constraints_init(mpmi_constraints *constraints, mpm_context *context);
void mpmi_constraints_free(mpmi_constraints *constraints);
/* Finds every constrained node of the blocks. On failure the contents are undefined: build into a spare and
 * swap. */
mpm_status mpmi_constraints_build(mpmi_constraints *constraints, const mpmi_blocks *blocks,
                                  const mpmi_wall *wall);
/* 1 when the node in a slot moves by itself: not a dependant. */
int32_t mpmi_constraints_is_free(const mpmi_constraints *constraints, int64_t slot);

#endif
