/* P2G: particles to nodes. */
#ifndef MPMI_P2G_H
#define MPMI_P2G_H

#include "layout/projection.h"
#include "layout/step.h"

mpm_status mpmi_p2g_stage(mpmi_step *step, const mpmi_projection *projection, mpmi_nodes *nodes);

#endif
