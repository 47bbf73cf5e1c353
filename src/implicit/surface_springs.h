/* Springs of surfaces that prescribe velocities, in implicit steps. */
#ifndef MPMI_SURFACE_SPRINGS_H
#define MPMI_SURFACE_SPRINGS_H

#include "implicit/balance.h"

/* Finds out which markers have material around them; the nodes around them are known (collective). */
mpm_status mpmi_springs_find(mpmi_balance *balance);
/* Returns 1 where springs have no stiffness yet. */
int32_t mpmi_springs_lack_stiffness(const mpmi_balance *balance);
/* Gives it to them (collective). The law must have run since the step began. */
mpm_status mpmi_springs_begin(mpmi_balance *balance);
/* Puts the forces at the displacements as they are on the rows, in MPMI_SPRINGS. */
void mpmi_springs_pull(mpmi_balance *balance);
/* Adds what they stiffen to the matrix. */
void mpmi_springs_stiffen(mpmi_balance *balance);
/* Tells surfaces and markers what the springs did, before velocities in place of displacements are shown
 * (collective). */
mpm_status mpmi_springs_finish(mpmi_balance *balance);

#endif
