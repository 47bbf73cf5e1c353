/* New particles at the end of a set, in three moves: begin, the caller writes what it knows, finish. */
#ifndef MPMI_APPEND_H
#define MPMI_APPEND_H

#include "particles/layout.h"

/* Does everything that may fail, for n particles that there is room for; on failure the set is unchanged. On
 * success the slots
 * [*slot, *slot + n) hold inert defaults in every field, and the caller writes position (in reach of a wrap),
 * velocity and initial_volume, and size when with_size. */
mpm_status mpmi_append_begin(mpm_particles *set, int64_t n, int32_t with_size, int64_t *slot);
/* Writes what follows from that and makes them particles. ids NULL: numbered on. */
void mpmi_append_finish(mpm_particles *set, int64_t slot, int64_t n, int32_t with_size, const int64_t *ids);
/* Refuses n more particles when the slots would run out, or the numbers for ids. */
mpm_status mpmi_check_room(const mpm_particles *set, int64_t n, int32_t numbered);

#endif
