/* The nodes that prescribed particles hold, and what of the nodes' impulses is theirs: sums go from particles
 * to nodes and back block by block, as P2G and G2P do. */
#ifndef MPMI_PRESCRIBED_NODES_H
#define MPMI_PRESCRIBED_NODES_H

#include "boundary/impulses.h"

/* Finds the nodes that they hold, and their velocities; what the host holds stays the host's. */
mpm_status mpmi_prescribed_hold(mpmi_bound *bound);
/* Gives them their share of the impulses on these nodes, in the parts of the prescription. */
mpm_status mpmi_prescribed_share(mpmi_bound *bound);

#endif
