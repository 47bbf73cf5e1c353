/* A body of two sets that moves along x through gravity, every kind of wall and the host's callbacks: what
 * tests of whole stories step. Its options are in world.h. */
#ifndef BODY_H
#define BODY_H

#include "world.h"

#define BODY_DT 1e-3

/* Of both laws; and the grid, which has body_cells[dim - 1] unless the body is large. */
extern const double body_E, body_nu, body_density, body_spacing[3], body_origin[3];
extern const int64_t body_cells[3][3];

world_desc world_of_body(const body_desc *of);
void body_open(world *w, const body_desc *of);

/* The scheme and the transfer of the body, and the defaults. */
mpm_stepper_desc body_stepper(const world *w);
/* No gravity, no callbacks, no walls: whatever acts is the test's own doing. */
void body_calm(world *w);

/* Neo-Hookean law as a callback, with the stretch it sees last as its state where state_count is 1. */
mpm_status host_neo_hookean(void *user, const mpm_material_batch *batch);

#endif
