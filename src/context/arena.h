/* An arena hands out aligned pieces of one allocation. Without memory it only adds up how many bytes they
 * take, so that the same calls first find the size of the allocation and then place the pieces in it. */
#ifndef MPMI_ARENA_H
#define MPMI_ARENA_H

#include "context/context.h"
#include "context/slack.h"

typedef struct mpmi_arena {
  char *memory; /* aligned to MPMI_ALIGNMENT; NULL: the arena only counts */
  size_t used;  /* bytes of all pieces so far */
} mpmi_arena;

static inline void *mpmi_arena_take(mpmi_arena *from, int64_t count, size_t size) {
  const size_t bytes = mpmi_bytes(count, size);
  const size_t lines = (bytes + MPMI_ALIGNMENT - 1) / MPMI_ALIGNMENT * MPMI_ALIGNMENT;
  const size_t held = lines + mpmi_gap(lines, MPMI_ALIGNMENT);
  void *at = from->memory ? from->memory + from->used : NULL;
  mpmi_slack(at, held, bytes);
  from->used += held;
  return at;
}

#endif
