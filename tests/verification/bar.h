/* The manufactured periodic bar of Steffen et al. 2008, eqs 47-50: u = A sin(2 pi X) cos(C pi t) on [0, 1],
 * with the body force that causes it; u = 0 at both ends. */
#ifndef BAR_H
#define BAR_H

#include "verify.h"

enum { BAR_PERIODIC, BAR_FIXED_WALLS, BAR_OVERWRITTEN_NODES }; /* the last: by the velocity callback */

typedef struct bar {
  const char *name;
  int32_t basis, boundary_basis, ends, per_cell;
  double smoothing; /* edge of the domains / h, of MPM_UGIMP */
  int32_t scheme, projected;
  int32_t zero_acceleration; /* of overwritten nodes: mpm_stepper_desc.boundary_zero_acceleration */
  int32_t total;             /* mpm_grid_desc.total_lagrangian */
} bar;

static const double bar_E = 1e4, bar_speed = 100.0; /* density 1 */

/* Largest error of a particle's position at t_end, eq. 54; infinite if the step failed on the way. */
double bar_error(const bar *how, int32_t cells, double amplitude, double dt, double t_end);

#endif
