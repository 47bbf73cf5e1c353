/* Explicit steps in three parts, with the host in between where it wants: particles to nodes, the nodes' own
 * part, nodes to particles. USL, USF and MUSL are an order of stages (table in docs/theory.md). */
#ifndef MPMI_EXPLICIT_H
#define MPMI_EXPLICIT_H

#include "layout/nodes.h"
#include "layout/step.h"

/* Particles to nodes, and forces. */
mpm_status mpmi_explicit_begin(mpmi_step *step, mpmi_nodes *nodes);
/* Velocities, walls, prescribed velocities. */
mpm_status mpmi_explicit_grid(mpmi_step *step, mpmi_nodes *nodes);
/* USL: everything from the updated nodal velocity. MUSL: L from the velocity that the new particles give the
 * nodes. USF has its strain already. */
mpm_status mpmi_explicit_end(mpmi_step *step, mpmi_nodes *nodes);

#endif
