/* The host's callback that prescribes velocities of nodes. */
#ifndef MPMI_VELOCITY_CALLBACK_H
#define MPMI_VELOCITY_CALLBACK_H

#include "boundary/impulses.h"

/* Asks it for all free nodes that move; its answers go into held and held_value. */
mpm_status mpmi_ask_velocities(mpmi_bound *bound);

#endif
