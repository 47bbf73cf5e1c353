/* New particles come to the end of a set in three moves: begin, the caller writes what it knows, finish. */
#ifndef MPMI_ADD_H
#define MPMI_ADD_H

#include "context/transport.h"
#include "particles/builtin_fields.h"

/* Does everything that may fail, for n more particles; on failure the set is unchanged. in_step: a step is
 * under way, whose results are kept. */
mpm_status mpmi_append_reserve(mpm_particles *set, int64_t n, int32_t with_size, int32_t in_step);

/* Returns the first of n slots, for which there is room: they hold inert defaults in every field. The caller
 * then writes position (in reach of a wrap), velocity and initial_volume, and size when with_size is 1. */
int64_t mpmi_append_begin(mpm_particles *set, int64_t n);
/* The same, and no slot is in the last block as the set is sorted. */
int64_t mpmi_append_apart(mpm_particles *set, int64_t n);
/* Numbers for new particles of this part (collective where there are several): those of the parts before come
 * first. status: what has happened before; on failure nothing has changed on any part. */
typedef struct mpmi_numbers {
  int64_t first, next; /* the number of the first one here; the next that is free on all parts afterwards */
} mpmi_numbers;
mpm_status mpmi_number(mpm_particles *set, int64_t n, const int64_t *ids, mpm_status status,
                       mpmi_numbers *out);
/* Writes what follows from these fields and makes the slots particles. Without ids they are numbered from
 * first_id on. The caller sets next_id. */
void mpmi_append_finish(mpm_particles *set, int64_t slot, int64_t n, int32_t with_size, const int64_t *ids,
                        int64_t first_id);
/* Writes the default of a field that is kept, where the default is not 0 and the caller has not written the
 * field. */
void mpmi_append_default(mpm_particles *set, int32_t field, int64_t begin, int64_t end);
/* Refuses n more particles when slots would run out. */
mpm_status mpmi_check_room(const mpm_particles *set, int64_t n);
/* Refuses ids that are given twice: MPM_E_ARG; of new particles also those that the set has. */
mpm_status mpmi_check_unique(mpm_particles *set, int64_t n, const int64_t *ids, int32_t are_new);

/* Fills that part of a box which a function accepts: mpm_particles_fill() within a call. */
mpm_status mpmi_fill_part(mpm_particles *set, const double *lower, const double *upper,
                          const int32_t *per_cell, mpm_inside_fn inside, void *user, int64_t *first_id,
                          int64_t *count);

#endif
