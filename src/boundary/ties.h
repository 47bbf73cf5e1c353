/* Nodes that are tied together (grid/constraints.h) move as one: folded into their masters while host, walls
 * and contacts act, and unfolded afterwards. */
#ifndef MPMI_TIES_H
#define MPMI_TIES_H

#include "boundary/impulses.h"

/* The master gets the velocity that the whole tie has, before the forces and after them. */
void mpmi_ties_fold(mpmi_bound *bound);
/* Sets the components that fixed and slip walls hold. */
void mpmi_ties_hold_walls(mpmi_bound *bound);
/* The followers get the master's velocity, with their signs; impulses and reactions are recorded. */
void mpmi_ties_unfold(mpmi_bound *bound);

#endif
