/* Blocks with particles, shared out among tasks. */
#ifndef MPMI_WORKLIST_H
#define MPMI_WORKLIST_H

#include "layout/member.h"
#include "layout/settings.h"

/* Task k works on block[bound[k]] ... block[bound[k + 1] - 1]. */
typedef struct mpmi_worklist {
  int32_t *block;
  int64_t count;
  int64_t *bound; /* [tasks + 1] */
} mpmi_worklist;

/* Blocks of one colour have the same parity of coordinates on each axis: their tiles do not overlap. */
enum { MPMI_COLOURS = 8 };

/* The list of all blocks with particles, list[0], and those of each colour, list[1 + colour]: of the
 * arrangements that the members call next. memory: room for two entries per block; bound_memory:
 * [lists][tasks + 1]. */
enum { MPMI_WORKLISTS = 1 + MPMI_COLOURS };
void mpmi_worklists_make(mpmi_worklist *list, const mpmi_settings *settings, const mpmi_blocks *blocks,
                         const mpmi_member *member, int32_t member_count, int32_t *memory,
                         int64_t *bound_memory);

#endif
