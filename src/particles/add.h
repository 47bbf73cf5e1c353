/* New particles come to the end of a set in three moves: begin, the caller writes what it knows, finish. */
#ifndef MPMI_ADD_H
#define MPMI_ADD_H

#include "particles/builtin_fields.h"

/* Makes room for n more particles. in_step: a step is under way, whose results are kept. */
mpm_status mpmi_append_reserve(mpm_particles *set, int64_t n, int32_t in_step);

/* Does everything that may fail, for n particles that there is room for; on failure the set is unchanged.
 * On success the slots [*slot, *slot + n) hold inert defaults in every field. The caller then writes
 * position (in reach of a wrap), velocity and initial_volume, and size when with_size is 1. */
mpm_status mpmi_append_begin(mpm_particles *set, int64_t n, int32_t with_size, int64_t *slot);
/* Writes what follows from these fields and makes the slots particles. Without ids they are numbered on. */
void mpmi_append_finish(mpm_particles *set, int64_t slot, int64_t n, int32_t with_size, const int64_t *ids);
/* Refuses n more particles when slots or numbers for ids would run out. */
mpm_status mpmi_check_room(const mpm_particles *set, int64_t n, int32_t numbered);

/* Fills that part of a box which a function accepts: mpm_particles_fill() within a call. */
mpm_status mpmi_fill_part(mpm_particles *set, const double *lower, const double *upper,
                          const int32_t *per_cell, mpm_inside_fn inside, void *user, int64_t *first_id,
                          int64_t *count);

#endif
