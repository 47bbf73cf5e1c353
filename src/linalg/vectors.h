/* Work on vectors of unknowns is cut into chunks that depend on the length alone, and sums are formed in
 * the order of the chunks. So no bit of a result depends on the number of threads. */
#ifndef MPMI_VECTORS_H
#define MPMI_VECTORS_H

#include "context/context.h"

enum {
  MPMI_MOST_CHUNKS = 256,
  MPMI_LEAST_CHUNK = 512,    /* items: below that a chunk is not worth its task */
  MPMI_ALONE_UNKNOWNS = 2000 /* systems smaller than that do not wake other threads */
};

typedef struct mpmi_chunks {
  int64_t items, size, count; /* chunks of `size` items, the last one may be shorter */
  int32_t alone;              /* the calling thread does them all */
} mpmi_chunks;

/* Cuts items, which may be unknowns or nodes, into chunks; unknowns: how many the whole system has. */
mpmi_chunks mpmi_chunks_of(int64_t items, int64_t unknowns);
static inline int64_t mpmi_chunk_begin(const mpmi_chunks *chunks, int64_t k) {
  return k * chunks->size < chunks->items ? k * chunks->size : chunks->items;
}
/* Runs one task per chunk. */
mpm_status mpmi_run_chunks(mpm_context *context, const mpmi_chunks *chunks, mpm_task_fn task, void *data);

/* Each chunk notes whether it failed, and at which item. */
typedef struct mpmi_chunk_failures {
  mpm_status status[MPMI_MOST_CHUNKS];
  int64_t item[MPMI_MOST_CHUNKS];
} mpmi_chunk_failures;
/* Returns the first failure in the order of the chunks; without one *item stays as it is. */
mpm_status mpmi_first_failure(const mpmi_chunk_failures *of, int64_t chunks, int64_t *item);

double mpmi_sum_in_order(const double *part, int64_t count);
mpm_status mpmi_dot(mpm_context *context, const double *a, const double *b, int64_t n, double *out);
mpm_status mpmi_norm(mpm_context *context, const double *a, int64_t n, double *out);

#endif
