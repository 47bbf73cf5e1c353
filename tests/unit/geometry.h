/* Combinations of options on grids of other geometries, and on total Lagrangian ones. */
#ifndef GEOMETRY_H
#define GEOMETRY_H

#include "combinations.h"

/* Steps a combination that such a grid does not refuse, of 2-D alone where that is so: one and three threads
 * go on with the same bits, and so does what comes back from a state. */
void check_geometry(const combination *c, int32_t geometry, int32_t total_lagrangian);

#endif
