/* XPIC(m) (Hammerquist & Nairn 2017): with S the interpolation to particles and S+ the mass-weighted
 * projection to nodes, the new velocity is  (I - (I - S S+)^m) v_p + dt S a.  Expanded, its first part is S
 * v^ with
 *
 *   v^ = m sum_r (-1)^(r+1) v_r,   v_1 = v_i,   v_r = (m - r + 1) / r S+ S v_r-1
 *
 * PIC has S v_i in its place (m = 1). What is gathered at the end of a step is S (v_i + dt a), so that S (v^
 * - v_i) remains: it is made here. The terms obey the boundary conditions that are linear: walls and images.
 */
#ifndef MPMI_XPIC_H
#define MPMI_XPIC_H

#include "layout/nodes.h"
#include "layout/step.h"

/* Leaves the corrections in the second copy of the particles' velocities. */
mpm_status mpmi_xpic_stage(mpmi_step *step, mpmi_nodes *nodes);

#endif
