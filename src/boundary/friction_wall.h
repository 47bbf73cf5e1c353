/* Friction walls: unilateral contacts of nodes on a wall's plane, and of ghosts with their mirrors. */
#ifndef MPMI_FRICTION_WALL_H
#define MPMI_FRICTION_WALL_H

#include "boundary/impulses.h"

/* keep: contacts stay closed or open as they were found, in a projection without forces. */
void mpmi_friction_walls(mpmi_bound *bound, int32_t keep);

#endif
