/* Particles that go to the part that has their block. First everything is found, packed, exchanged and given
 * room, which may fail and changes nothing; then all parts know whether all have succeeded; then it is
 * done, which cannot fail.
 *
 * Arrivals stand behind a set's own particles, those from parts before this one first. The sort that follows
 * takes them in the order of the parts (particles/sort.h), as if there had been one part. */
#ifndef MPMI_MIGRATION_H
#define MPMI_MIGRATION_H

#include "parallel/parts.h"
#include "particles/sort.h"

/* A set that takes part, and what of it is on the way. */
typedef struct mpmi_moving_set {
  mpm_particles *set;
  int32_t body;
  mpmi_sorting *sorting;
  int64_t leave, runs;        /* particles that go, and runs of their slots */
  int64_t arrive, arrive_low; /* those that come, and those of them from parts before this one */
} mpmi_moving_set;

/* Makes the fields of the sets alike on all parts (collective): one that is present on a part becomes so on
 * all. MPM_E_STATE: the host's own fields are unlike. */
mpm_status mpmi_move_align_fields(mpmi_parts *parts, mpmi_moving_set *sets, int32_t count);
/* Moves what has to be moved (collective). The provisional blocks are those of mpmi_sort_blocks(), which
 * has to be called again where *moved is not 0: some particle of this part has gone or come. */
mpm_status mpmi_move_particles(mpmi_parts *parts, const mpmi_blocks *blocks, mpmi_moving_set *sets,
                               int32_t count, int64_t *moved);

/* ---- sharing.c: a sort, in which all that follows is collective ---------------------------------------- */
/* Moves particles to the parts that have their blocks, which have been inserted, and inserts the blocks of
 * other parts that share nodes. insert(user) inserts the blocks anew; status is what has happened before. */
mpm_status mpmi_share_out(mpmi_parts *parts, mpmi_blocks *blocks, mpmi_moving_set *sets, int32_t count,
                          mpm_status status, mpm_status (*insert)(void *user), void *user);
/* Ends the sort, which has come to this status here. */
mpm_status mpmi_share_end(mpmi_parts *parts, const mpmi_blocks *blocks, const mpmi_moving_set *sets,
                          int32_t count, mpm_status status);
/* Finds which nodes are whole, and whose, where the layout has another version than before; not collective.
 * */
mpm_status mpmi_share_nodes(mpmi_parts *parts, const mpmi_blocks *blocks, const mpmi_constraints *constraints,
                            int64_t version);

#endif
