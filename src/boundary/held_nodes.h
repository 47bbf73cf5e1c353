/* Components of nodes that the host or prescribed particles hold. */
#ifndef MPMI_HELD_NODES_H
#define MPMI_HELD_NODES_H

#include "boundary/impulses.h"

/* Asks the host and the prescribed particles who holds what. */
mpm_status mpmi_held_find(mpmi_bound *bound);
/* Sets the components that are held, as they were found. */
mpm_status mpmi_held_set(mpmi_bound *bound);

#endif
