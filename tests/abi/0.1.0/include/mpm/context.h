/**
 * @file context.h
 * The context: memory, threads, log and last error. All services of the host are optional.
 */
#ifndef MPM_CONTEXT_H
#define MPM_CONTEXT_H

#include <mpm/types.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A task of the library: call it with the task_data given to mpm_parallel_for_fn and a number k. It
 * neither throws nor blocks, and may run on any thread. */
typedef void (*mpm_task_fn)(void *task_data, int64_t k);

/**
 * The host's executor. Runs task(task_data, k) exactly once for each k in [0, count), in any order, on any
 * threads, and returns when all are done. The library's results do not depend on how. A return other than 0
 * makes the call that needed it fail with MPM_E_CALLBACK.
 */
typedef mpm_status (*mpm_parallel_for_fn)(void *user, int64_t count, mpm_task_fn task, void *task_data);

/** Services of the host. Fill with mpm_context_desc_init(), then change what is wanted. */
typedef struct mpm_context_desc {
  uint32_t struct_size; /**< sizeof(mpm_context_desc) of the caller */
  /** 1: the calling thread only (default); N: a pool of N threads, the calling one included; 0: one per
   * processor. The pool belongs to the context; its threads sleep when idle and never spin for longer
   * than a few microseconds. Results do not depend on it. */
  int32_t concurrency;
  /** MPM_ISA_BEST (default) or a set to be used; MPM_E_UNSUPPORTED at creation if processor or library
   * lacks it. With MPM_ISA_BEST the environment variable MPM_ISA (baseline, avx2, avx512), read once at
   * creation, decides where it is set. */
  int32_t isa;
  /** 1: call the host from the calling thread only, also where a callback is marked (mt); default 0. */
  int32_t serial_callbacks;
  /** Returns memory of at least bytes at a multiple of alignment (a power of two), or NULL. NULL
   * (default): the C library's. Set together with release. Called on the calling thread only. */
  void *(*alloc)(void *user, size_t bytes, size_t alignment);
  /** Takes back memory from alloc, with the same bytes and alignment. Called on the calling thread only. */
  void (*release)(void *user, void *memory, size_t bytes, size_t alignment);
  void *alloc_user; /**< passed to alloc and release */
  /** Replaces the pool, NULL (default): none. concurrency then says for how many threads to cut the work. */
  mpm_parallel_for_fn parallel_for;
  void *parallel_user; /**< passed to parallel_for */
  /** Takes a finished text without newline, with a level MPM_LOG_*; text is valid during the call. NULL
   * (default): the library is silent; it never writes to the standard streams. Called on the calling
   * thread only. */
  void (*log)(void *user, int32_t level, const char *text);
  void *log_user; /**< passed to log */
} mpm_context_desc;

/** Fills desc with the defaults. struct_size: sizeof(mpm_context_desc) of the caller; no byte beyond is
 * written. MPM_E_ARG if it is smaller than the first released struct. */
MPM_API mpm_status mpm_context_desc_init(mpm_context_desc *desc, uint32_t struct_size);

/** Makes a context; desc is copied and may be NULL for the defaults. *out is NULL unless MPM_OK is
 * returned. MPM_E_ARG: a bad value, only one of alloc and release, or an unknown value of MPM_ISA.
 * MPM_E_NOMEM: memory or threads are not to be had. MPM_E_UNSUPPORTED: isa not available. */
MPM_API mpm_status mpm_context_create(const mpm_context_desc *desc, mpm_context **out);

/** Bytes that the context and its objects hold now, and the most they ever held. Either pointer may be
 * NULL. */
MPM_API mpm_status mpm_context_memory(const mpm_context *context, int64_t *bytes, int64_t *peak_bytes);

/** Ends the pool and frees the context. MPM_E_STATE while objects made with it live. NULL is fine. */
MPM_API mpm_status mpm_context_destroy(mpm_context *context);

/** One or two sentences on the last call of this context or its objects that did not return MPM_OK, with
 * the offending names and values. Valid until the next call on the context; "" if there is none or
 * context is NULL. */
MPM_API const char *mpm_last_error(const mpm_context *context);

#ifdef __cplusplus
}
#endif

#endif
