/* Guests: copies of particles of other parts around the nodes at which bodies meet, with what contact has to
 * know of them. They are sent before a step, and count for that one alone. */
#ifndef MPMI_GUESTS_H
#define MPMI_GUESTS_H

#include "parallel/parts.h"
#include "particles/sort.h"

/* The guests of one set, with the fields that contact reads and nothing else of a set, and where those of
 * each ghost lie: [start[2 g], start[2 g + 1]). */
typedef struct mpmi_guest_set {
  mpm_particles set;
  int64_t *start;
  int64_t start_capacity, capacity;
  uint64_t *memory;
} mpmi_guest_set;

/* A set of this part, and where its particles lie. */
typedef struct mpmi_host_set {
  const mpm_particles *set;
  const mpmi_arrangement *now;
} mpmi_host_set;

/* Sends the particles of the given blocks (parts.h) to the partners that know these as ghosts, and takes
 * theirs (collective). [count] sets; copy: of the fields that change in a step. */
mpm_status mpmi_guests_exchange(mpmi_parts *parts, const mpmi_host_set *sets, int32_t count, int32_t copy);
/* Forgets the guests of the step before. */
void mpmi_guests_clear(mpmi_parts *parts);
void mpmi_guests_free(mpmi_parts *parts);

#endif
