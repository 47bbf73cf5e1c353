/* Node hooks: the host reads and changes nodal velocities and forces at a stage of the step.
 *
 * All stages run after the nodes have been updated and ties folded, because both are linear: there a node
 * has its updated velocity v~ and the increment dv, hence the projected velocity v = v~ - dv and the force m
 * dv / dt. A change of force is one of dv and v~; a change of v is one of v~; a change of v~ is an impulse,
 * one of both. It is laid on every node of the tie, as if the host had written there: so it is no reaction
 * of the constraint. */
#ifndef MPMI_HOOKS_H
#define MPMI_HOOKS_H

#include "boundary/impulses.h"

/* Around all hooks of a step; nothing happens where there are none. The end adds up their work. */
mpm_status mpmi_hooks_begin(mpmi_bound *bound);
mpm_status mpmi_hooks_end(mpmi_bound *bound);
/* Calls the hook of a stage, MPM_AFTER_P2G ..., if there is one. */
mpm_status mpmi_hooks_run(mpmi_bound *bound, int32_t stage);

#endif
