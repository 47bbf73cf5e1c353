/* Tests of whole stories step this body of two sets, which moves along x through gravity, every kind of wall
 * and the host's callbacks. Its options are in world.h. */
#ifndef BODY_H
#define BODY_H

#include "world.h"

#define BODY_DT 1e-3

/* Both laws have these constants; the grid has body_cells[dim - 1] cells unless the body is large. */
extern const double body_E, body_nu, body_density, body_spacing[3], body_origin[3];
extern const int64_t body_cells[3][3];

world_desc world_of_body(const body_desc *of);
void body_open(world *w, const body_desc *of);

/* Returns the defaults with the scheme and the transfer of the body. */
mpm_stepper_desc body_stepper(const world *w);
/* Takes gravity, callbacks and walls away, so that only what the test adds acts. */
void body_calm(world *w);

/* The neo-Hookean law as a callback keeps the stretch that it saw last as its state, if it has one. */
mpm_status host_neo_hookean(void *user, const mpm_material_batch *batch);

#endif
