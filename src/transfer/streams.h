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

/* Brings the next chunk's share of particle p (0 ... MPMI_CHUNK - 1) nearer, to the second-level cache: a
 * chunk of a stream is two lines, and asking for all of them at once would fill the queues. */
MPMI_INLINE void mpmi_prefetch(const mpmi_streams *streams, int64_t next, int64_t p) {
  enum { LINES = MPMI_CHUNK * (int32_t)sizeof(double) / 64, DOUBLES = 64 / (int32_t)sizeof(double) };
  for (int64_t i = p; i < LINES * streams->count; i += MPMI_CHUNK)
    __builtin_prefetch(streams->at[i / LINES] + next + DOUBLES * (i % LINES), 0, 2);
}

#endif
