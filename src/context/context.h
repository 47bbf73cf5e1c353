/* The context: services of the host (memory, threads, log) and the text of the last error.
 * Everything the library allocates, runs in parallel or reports goes through here. */
#ifndef MPMI_CONTEXT_H
#define MPMI_CONTEXT_H

#include <mpm/mpm.h>

/* First word of every handle: tells a live object of the right kind from anything else. */
enum {
  MPMI_CONTEXT = 0x6d706d01,
  MPMI_GRID = 0x6d706d02,
  MPMI_MATERIAL = 0x6d706d03,
  MPMI_PARTICLES = 0x6d706d04,
  MPMI_STEPPER = 0x6d706d05,
  MPMI_SERIES = 0x6d706d06,
  MPMI_OPERATOR = 0x6d706d07
};

enum { MPMI_ALIGNMENT = 64 };

typedef struct mpmi_pool mpmi_pool;

struct mpm_context {
  uint32_t magic;
  int32_t children;      /* live objects made with this context */
  int32_t isa;           /* resolved: MPM_ISA_BASELINE ... */
  int32_t concurrency;   /* resolved: >= 1; how many tasks may run at once */
  mpm_context_desc host; /* services; alloc and release always set */
  mpmi_pool *pool;       /* own threads, NULL when concurrency is 1 or the host has an executor */
  int64_t bytes, peak_bytes;
  char error[1024];
};

/* Writes the text of the last error and returns status, so that callers can `return mpmi_fail(...)`. */
mpm_status mpmi_fail(mpm_context *context, mpm_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Checks the handle's magic word and clears the last error: the first line of every public call. */
#define MPMI_ENTER(handle, kind)                                                                             \
  do {                                                                                                       \
    if (!(handle) || (handle)->magic != (uint32_t)(kind)) return MPM_E_ARG;                                  \
    (handle)->context->error[0] = '\0';                                                                      \
  } while (0)
void mpmi_log(mpm_context *context, int32_t level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* 64-byte aligned, not zeroed. On failure NULL, with the error text set; the caller returns MPM_E_NOMEM.
 * Asking for 0 bytes gives a valid pointer. */
void *mpmi_alloc(mpm_context *context, size_t bytes);
void *mpmi_alloc_zeroed(mpm_context *context, size_t bytes);
void mpmi_free(mpm_context *context, void *memory, size_t bytes); /* NULL is fine */
/* Makes room for `wanted` elements where there is less; what was there is lost. On failure nothing has
 * changed. */
mpm_status mpmi_reserve(mpm_context *context, void **at, int64_t *capacity, int64_t wanted, size_t size);
/* The same with room for a quarter more where it has to grow, so that lists whose length varies a little from
 * step to step soon need no more memory. */
mpm_status mpmi_reserve_more(mpm_context *context, void **at, int64_t *capacity, int64_t wanted, size_t size);
/* count * size with overflow giving SIZE_MAX, which mpmi_alloc refuses. */
size_t mpmi_bytes(int64_t count, size_t size);

/* Runs task(data, k) for k in [0, count) on the pool, the host's executor or the calling thread. A failing
 * host executor gives MPM_E_CALLBACK with text; some tasks may then not have run. */
mpm_status mpmi_parallel_for(mpm_context *context, int64_t count, mpm_task_fn task, void *data);
/* The same for idempotent tasks that must all be done: repeats them on this thread when the executor fails.
 */
void mpmi_parallel_for_sure(mpm_context *context, int64_t count, mpm_task_fn task, void *data);

/* Own threads (executor.c). */
mpm_status mpmi_pool_create(mpm_context *context, int32_t threads, mpmi_pool **out);
void mpmi_pool_destroy(mpm_context *context, mpmi_pool *pool);
void mpmi_pool_run(mpmi_pool *pool, int64_t count, mpm_task_fn task, void *data);

/* Of a clock that only goes forward (clock.c). */
double mpmi_seconds(void);

/* Text helpers for errors: the names of `candidates` closest to `wanted`, as "a, b, c" into buffer. */
void mpmi_nearest_names(const char *wanted, const char *const *candidates, int32_t count, char *buffer,
                        size_t capacity);

#endif
