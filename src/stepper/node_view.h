/* Views of nodal fields. */
#ifndef MPMI_NODE_VIEW_H
#define MPMI_NODE_VIEW_H

#include "particles/particles.h"

/* Ends a view made by mpm_grid_map: written values go back to the nodes. */
mpm_status mpmi_node_view_release(mpmi_view_record *record, mpm_view *view);

#endif
