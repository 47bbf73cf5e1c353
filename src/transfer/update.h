/* The grid's own part of a step on a run of nodes. */
#ifndef MPMI_UPDATE_H
#define MPMI_UPDATE_H

#include <stdint.h>

/* How many nodes of a run are heavier than the mass cut, and how many with mass are light. */
typedef struct mpmi_updated {
  int64_t active, light;
} mpmi_updated;
/* Turns momentum and force of nodes into velocity and increment. values: 4, without forces, or 8. cut: the
 * mass cut, and the mass up to which nodes are light. */
typedef mpmi_updated (*mpmi_update_fn)(int32_t values, double *nodes, int64_t count, const double *cut,
                                       double dt);

#endif
