/* Ids that a host gives to particles of several parts. */
#ifndef MPMI_SHARED_IDS_H
#define MPMI_SHARED_IDS_H

#include "particles/particles.h"

/* Refuses ids that are given on two parts, or that another part has: MPM_E_ARG on all (collective). ids may
 * be NULL where n is 0; lowest: of all that are given; free_id: no id in use is as high, and so many from
 * there on are given to particles without. */
mpm_status mpmi_check_shared_ids(mpm_particles *set, int64_t n, const int64_t *ids, int64_t lowest,
                                 int64_t free_id, int64_t numbered);

#endif
