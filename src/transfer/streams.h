/* Asking for memory ahead of its use. */
#ifndef MPMI_STREAMS_H
#define MPMI_STREAMS_H

#include "simd/chunk.h"

/* Component arrays, each at slot 0, that are read or written chunk by chunk. A block ends before the slot
 * `end`, and the next one begins at `follow`. */
enum { MPMI_MAX_STREAMS = 64, MPMI_AHEAD = 2 * MPMI_CHUNK };
typedef struct mpmi_streams {
  int32_t count;
  const double *at[MPMI_MAX_STREAMS];
  int64_t end, follow;
} mpmi_streams;

/* Returns the slot that is worked on MPMI_AHEAD slots after s: memory needs about as long. */
MPMI_INLINE int64_t mpmi_ahead(const mpmi_streams *streams, int64_t s) {
  const int64_t ahead = s + MPMI_AHEAD;
  return ahead < streams->end ? ahead : ahead - streams->end + streams->follow;
}

/* Brings the share that particle p (0 ... MPMI_CHUNK - 1) has of a later chunk nearer, to the second-level
 * cache: whole chunks of some streams, because asking for all of them at once would fill the queues. */
MPMI_INLINE void mpmi_prefetch(const mpmi_streams *streams, int64_t later, int64_t p) {
  enum { LINES = MPMI_CHUNK * (int32_t)sizeof(double) / 64, DOUBLES = 64 / (int32_t)sizeof(double) };
  for (int64_t i = p; i < streams->count; i += MPMI_CHUNK) {
    const double *at = streams->at[i] + later;
    MPMI_UNROLL for (int32_t line = 0; line < LINES; ++line) __builtin_prefetch(at + DOUBLES * line, 0, 2);
  }
}

#endif
