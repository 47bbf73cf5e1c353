/* Asking for memory ahead of its use. */
#ifndef MPMI_STREAMS_H
#define MPMI_STREAMS_H

#include "simd/chunk.h"

/* Component arrays, each at slot 0, that are read or written chunk by chunk. */
enum { MPMI_MAX_STREAMS = 64 };
typedef struct mpmi_streams {
  int32_t count;
  const double *at[MPMI_MAX_STREAMS];
} mpmi_streams;

/* Brings the next chunk's share of particle p (0 ... MPMI_CHUNK - 1) nearer, to the second-level cache: whole
 * chunks of some streams, because asking for all of them at once would fill the queues. */
MPMI_INLINE void mpmi_prefetch(const mpmi_streams *streams, int64_t next, int64_t p) {
  enum { LINES = MPMI_CHUNK * (int32_t)sizeof(double) / 64, DOUBLES = 64 / (int32_t)sizeof(double) };
  for (int64_t i = p; i < streams->count; i += MPMI_CHUNK) {
    const double *at = streams->at[i] + next;
    MPMI_UNROLL for (int32_t line = 0; line < LINES; ++line) __builtin_prefetch(at + DOUBLES * line, 0, 2);
  }
}

#endif
