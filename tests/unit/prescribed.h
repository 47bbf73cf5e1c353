/* What the files of the suite share: clouds with prescribed particles. */
#ifndef PRESCRIBED_H
#define PRESCRIBED_H

#include "world.h"

/* Particles of one set. */
enum { CLOUD = 200 };

/* Two clouds through each other, the second prescribed on some axes of some particles, or on all. */
void open_clouds(world *w, const method *how, int32_t dim, int32_t walled, int32_t all);
/* A motion that turns, so that particles have velocities of their own; user: the set. */
mpm_status prescribed_turn(void *user, const mpm_particle_batch *b, double *add);
uint8_t *fetch_flags(const world *w, const mpm_particles *set); /* [dim][count]; to be freed */

/* The sum of mass times a component of a field. */
double of_field(const world *w, const mpm_particles *set, const char *field, int32_t c);

TCase *prescribed_walls_case(void);
TCase *prescribed_state_case(void);
TCase *prescribed_waves_case(void);

#endif
