/* Combinations of options on 2-D grids of other geometries. */
#ifndef GEOMETRY_H
#define GEOMETRY_H

#include "combinations.h"

/* Steps a combination that is 2-D and not refused: one and three threads go on with the same bits, and so
 * does what comes back from a state. */
void check_geometry(const combination *c, int32_t geometry);

#endif
