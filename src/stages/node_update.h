/* The grid's own part of a step, on every node as if it were free: momentum to velocity, force to increment
 * (transfer/update.c). */
#ifndef MPMI_NODE_UPDATE_H
#define MPMI_NODE_UPDATE_H

#include "layout/projection.h"
#include "layout/step.h"

mpm_status mpmi_node_update_stage(mpmi_step *step, const mpmi_projection *projection, mpmi_nodes *nodes);

#endif
