/* Boundary conditions on the velocities of nodes (Steffen et al. 2008, 3.4): velocity callback, prescribed
 * particles, walls, periodic images, and the host's hooks in between.
 *
 *   boundary.c          the stage: who acts when
 *   ties.c              folding nodes that are tied together, and unfolding them
 *   impulses.c          what a change of velocity gives to the particles, taken down as impulse
 *   held_nodes.c        components that the host or prescribed particles hold
 *   velocity_callback.c, prescribed_nodes.c   which these are
 *   friction_wall.c     unilateral contact with walls
 *   hooks.c             the host's own part in between
 *   node_batch.c        the nodes of a block as callbacks and hooks see them
 *
 * All of it works on the velocities that nodes would have if they were free. Ties are folded into their
 * masters first and unfolded last. */
#ifndef MPMI_BOUNDARY_H
#define MPMI_BOUNDARY_H

#include "layout/projection.h"
#include "layout/step.h"

/* Puts the conditions on the nodes of a projection; ties are unfolded at the end. share is the share of these
 * velocities that particles take; impulses are weighted by it. */
mpm_status mpmi_boundary_stage(mpmi_step *step, const mpmi_projection *projection, mpmi_nodes *nodes,
                               double share);
/* Finds who holds which nodes, in `held` and `held_value`; ties stay folded. Implicit steps use it. */
mpm_status mpmi_boundary_hold(mpmi_step *step, mpmi_nodes *nodes);

#endif
