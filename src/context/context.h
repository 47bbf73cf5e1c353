/* The context holds the services of the host (memory, threads, log) and the text of the last error.
 * Everything that the library allocates, runs in parallel or reports goes through it. */
#ifndef MPMI_CONTEXT_H
#define MPMI_CONTEXT_H

#include <mpm/mpm.h>
#include <stdatomic.h>

#include "context/environment.h"

/* The first word of every handle, which tells a live object of the right kind from anything else. */
enum {
  MPMI_CONTEXT = 0x6d706d01,
  MPMI_GRID = 0x6d706d02,
  MPMI_MATERIAL = 0x6d706d03,
  MPMI_PARTICLES = 0x6d706d04,
  MPMI_STEPPER = 0x6d706d05,
  MPMI_SERIES = 0x6d706d06,
  MPMI_OPERATOR = 0x6d706d07,
  MPMI_OBSTACLE = 0x6d706d08,
  MPMI_SURFACE = 0x6d706d09
};

enum { MPMI_ALIGNMENT = 64, MPMI_SENTENCE = 1024 };

typedef struct mpmi_pool mpmi_pool;

struct mpm_context {
  uint32_t magic;
  int32_t children;                  /* number of live objects made with this context */
  int32_t isa;                       /* the instruction set in use: never MPM_ISA_BEST */
  int32_t works_by_halves;           /* registers of eight doubles take two steps: transfer/scatter.h */
  int32_t concurrency;               /* how many tasks may run at once, >= 1 */
  mpm_context_desc host;             /* the services; alloc and release are always set */
  mpmi_pool *pool;                   /* own threads; NULL when concurrency is 1 or the host has an executor */
  int32_t pool_runs;                 /* in this process: 1, -1: not, 0: this call has not asked yet */
  int32_t pool_rests;                /* the step under way is short: the calling thread makes it alone */
  mpm_transport transport;           /* to the other parts; without one there is 1 part */
  double reducing;                   /* seconds in its reduce and gather */
  int32_t apart;                     /* the transport has failed: the other parts are lost */
  _Atomic int64_t bytes, peak_bytes; /* written by the thread of the call, read by any */
  _Atomic uint32_t busy;             /* a call on the context or one of its objects is under way */
  /* What the last failure said. A call writes into one text and leaves alone that which was there when it
   * began, so that a failure that it gets over can be forgotten. */
  _Atomic(const char *) error;
  const char *kept, *said; /* the error when the call began; what the call itself has said, or NULL */
  char text[2][MPMI_SENTENCE];
};

/* Writes the text of the last error and returns status, so that callers can `return mpmi_fail(...)`. Without
 * a context there is no text. */
mpm_status mpmi_fail(mpm_context *context, mpm_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* The call has got over what went wrong in it: the last error is again that of an earlier call. */
void mpmi_forget(mpm_context *context);

/* An entry is open while a public call runs. It marks the context as busy, so that calls from callbacks and
 * from other threads are refused, and keeps the floating-point environment of the host. */
typedef struct mpmi_entry {
  mpm_context *context; /* whose call this is; NULL for calls on what is lent to a callback */
  _Atomic uint32_t
      *busy;    /* what is to be cleared; NULL: nothing, because the call was refused or has freed it */
  int32_t open; /* the environment is to be restored */
  mpmi_environment host;
} mpmi_entry;
/* MPM_E_STATE with a text where another call is under way. Then, too, the entry may be left. */
mpm_status mpmi_enter(mpmi_entry *entry, mpm_context *context);
/* The same for what is lent to a callback while its context is busy, and has a mark of its own. */
mpm_status mpmi_enter_lent(mpmi_entry *entry, mpm_context *context, _Atomic uint32_t *busy);
void mpmi_leave(mpmi_entry *entry);
/* This is the first line of every public call, after outputs were cleared: it checks the handle's magic word,
 * and opens an entry that is left on every way out. */
#define MPMI_ENTER(handle, kind)                                                                             \
  if (!(handle) || (handle)->magic != (uint32_t)(kind)) return MPM_E_ARG;                                    \
  MPMI_ENTER_CONTEXT((handle)->context)
#define MPMI_ENTER_CONTEXT(context)                                                                          \
  if (!(context) || (context)->magic != (uint32_t)MPMI_CONTEXT) return MPM_E_ARG;                            \
  __attribute__((cleanup(mpmi_leave))) mpmi_entry entry_;                                                    \
  if (mpmi_enter(&entry_, context)) return MPM_E_STATE
/* Passes on what a callback has returned. The callback may have left another environment behind. */
mpm_status mpmi_from_host(mpm_status returned);

/* Gives a text to the host's log, if it has one. */
void mpmi_log(mpm_context *context, int32_t level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Memory is aligned to MPMI_ALIGNMENT. On failure these give NULL and set the error text, and the caller
 * returns MPM_E_NOMEM. A request of 0 bytes gives a valid pointer. */
void *mpmi_alloc(mpm_context *context, size_t bytes);
void *mpmi_alloc_zeroed(mpm_context *context, size_t bytes);
void mpmi_free(mpm_context *context, void *memory, size_t bytes); /* memory may be NULL */
/* Makes room for `wanted` elements where there is less; what was there is then lost. On failure nothing has
 * changed. Only these elements may be touched: the rest of the capacity is slack (slack.h). */
mpm_status mpmi_reserve(mpm_context *context, void **at, int64_t *capacity, int64_t wanted, size_t size);
/* Does the same with room for a quarter more where it has to grow, so that lists whose length varies a little
 * from step to step soon need no more memory. */
mpm_status mpmi_reserve_more(mpm_context *context, void **at, int64_t *capacity, int64_t wanted, size_t size);
/* Makes room for one element after the `count` there are, which stay; twice as many where it has to grow. On
 * failure nothing has changed. */
mpm_status mpmi_reserve_next(mpm_context *context, void **at, int64_t *capacity, int64_t count, size_t size);
/* Returns count * size, or where that overflows SIZE_MAX, which mpmi_alloc refuses. */
size_t mpmi_bytes(int64_t count, size_t size);
/* These make room for an array, as mpmi_reserve_more() does, and free one: they know the size of its type. */
#define MPMI_RESERVE_MORE(context, array, capacity, wanted)                                                  \
  mpmi_reserve_more(context, (void **)&(array), &(capacity), wanted, sizeof *(array))
#define MPMI_RESERVE_NEXT(context, array, capacity, count)                                                   \
  mpmi_reserve_next(context, (void **)&(array), &(capacity), count, sizeof *(array))
#define MPMI_FREE_ARRAY(context, array, count) mpmi_free(context, array, mpmi_bytes(count, sizeof *(array)))

/* Runs task(data, k) for k in [0, count) on the pool, the host's executor or the calling thread. If the
 * host's executor fails it returns MPM_E_CALLBACK with a text; some tasks may then not have run. */
mpm_status mpmi_parallel_for(mpm_context *context, int64_t count, mpm_task_fn task, void *data);
/* Does the same for idempotent tasks that must all be done: if the executor fails they are repeated on this
 * thread. */
void mpmi_parallel_for_sure(mpm_context *context, int64_t count, mpm_task_fn task, void *data);

/* The library's own threads (executor.c). */
mpm_status mpmi_pool_create(mpm_context *context, int32_t threads, mpmi_pool **out);
void mpmi_pool_destroy(mpm_context *context, mpmi_pool *pool);

/* Seconds of a clock that only goes forward (clock.c). */
double mpmi_seconds(void);

/* Writes the names among `candidates` that are closest to `wanted` into buffer, as "a, b, c". */
void mpmi_nearest_names(const char *wanted, const char *const *candidates, int32_t count, char *buffer,
                        size_t capacity);
/* Refuses a name with MPM_E_NOT_FOUND, and says which of those that there are come closest to it; the
 * sentence begins with `refusal`. */
mpm_status mpmi_refuse_name(mpm_context *context, const char *refusal, const char *wanted,
                            const char *const *candidates, int32_t count);

#endif
