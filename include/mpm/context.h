/**
 * @file context.h
 * The context: memory, threads, log and last error. The host may leave out every service.
 */
#ifndef MPM_CONTEXT_H
#define MPM_CONTEXT_H

#include <mpm/parallel.h>
#include <mpm/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A task of the library, which the host's executor calls with the task_data that it was given and a number
 * k. A task neither throws nor blocks, and may run on any thread. */
typedef void (*mpm_task_fn)(void *task_data, int64_t k);

/**
 * The host's executor. It runs task(task_data, k) exactly once for each k in [0, count), in any order, on any
 * threads, and returns when all are done. The library calls it on the calling thread, and its results do not
 * depend on order and threads. A return other than 0 makes the call that needed it fail with MPM_E_CALLBACK.
 */
typedef mpm_status (*mpm_parallel_for_fn)(void *user, int64_t count, mpm_task_fn task, void *task_data);

/** Services of the host. Fill the struct with mpm_context_desc_init(), then change what is wanted. */
typedef struct mpm_context_desc {
  uint32_t struct_size; /**< sizeof(mpm_context_desc) of the caller */
  /** Number of threads, 0 to 1024. 1 (default): the calling thread only; N: a pool of N threads, the calling
   * one included; 0: one per processor. The pool belongs to the context; its threads sleep when
   * idle, after they have looked for work for 100 microseconds, and rest in steps that are over sooner
   * without them. Results do not depend on the number. A build without
   * threads (MPM_NO_THREADS) takes 0 and 1, or any number with parallel_for, else MPM_E_UNSUPPORTED.
   *
   * A process that fork() makes between two calls has the context and its objects, but none of the pool's
   * threads: there everything runs on the calling thread, with the same results, and destroying frees as
   * ever. */
  int32_t concurrency;
  /** Instruction set of the kernels: MPM_ISA_BEST (default) or the one to be used, which creation refuses
   * with MPM_E_UNSUPPORTED if processor or library lacks it. With MPM_ISA_BEST the environment variable
   * MPM_ISA (portable or baseline, avx2, avx512, neon) decides where it is set; it is read once, at
   * creation. */
  int32_t isa;
  /** 1: the library calls the host from the calling thread only, also where a callback is marked (mt).
   * Default 0. */
  int32_t serial_callbacks;
  /** Returns memory of at least so many bytes at a multiple of alignment, a power of two; or NULL if there is
   * none. Default NULL: the C library's memory is used. alloc and release are set together. Called on the
   * calling thread only. */
  void *(*alloc)(void *user, size_t bytes, size_t alignment);
  /** Takes back memory from alloc, with the same bytes and alignment. Called on the calling thread only. */
  void (*release)(void *user, void *memory, size_t bytes, size_t alignment);
  void *alloc_user; /**< first argument of alloc and release */
  /** The host's executor, which takes the place of the pool; concurrency then says for how many threads the
   * work is cut. Default NULL: there is none. */
  mpm_parallel_for_fn parallel_for;
  void *parallel_user; /**< first argument of parallel_for */
  /** Takes a finished text without newline, with a level MPM_LOG_*. The text is valid during the call.
   * Default NULL: the library is silent, since it never writes to the standard streams. Called on the calling
   * thread only. */
  void (*log)(void *user, int32_t level, const char *text);
  void *log_user; /**< first argument of log */
  /** The host's memory for a sentence that says why mpm_context_create() has failed: it is cut to fit, and
   * ends with a zero; after MPM_OK it is as before. Used during that call only. Default NULL: there is
   * none. */
  char *error_text;
  uint64_t error_bytes; /**< size of error_text in bytes; 0 exactly where error_text is NULL */
  /** The ways to the other parts of the problem, read during mpm_context_create() and copied, or NULL
   * (default): there is one part. See parallel.h, which says what is collective then; mpm_context_create()
   * is, and all parts need the same version and instruction set. */
  const mpm_transport *transport;
} mpm_context_desc;

/** Fills desc with the defaults. struct_size is sizeof(mpm_context_desc) of the caller; no byte beyond is
 * written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any time. */
MPM_API mpm_status mpm_context_desc_init(mpm_context_desc *desc, uint32_t struct_size);

/** Makes a context. desc is copied and may be NULL for the defaults. *out is NULL unless MPM_OK is returned.
 * The host ends the context with mpm_context_destroy(). There is no context to ask why a call has failed: the
 * sentence goes to error_text, and to log with MPM_LOG_WARNING, as far as desc sets them.
 *
 * - MPM_E_ARG: a value is bad, only one of alloc and release or of error_text and error_bytes is set, or the
 *   variable MPM_ISA has an unknown value.
 * - MPM_E_NOMEM: memory or threads are not to be had.
 * - MPM_E_UNSUPPORTED: the instruction set is not available, the build has no threads, or desc sets a field
 *   that this version of the library does not know.
 */
MPM_API mpm_status mpm_context_create(const mpm_context_desc *desc, mpm_context **out);

/** Tells how many bytes the context and its objects hold now, and the most that they ever held. Either output
 * pointer may be NULL. Any thread, any time while the context lives, also in callbacks. */
MPM_API mpm_status mpm_context_memory(const mpm_context *context, int64_t *bytes, int64_t *peak_bytes);

/** Ends the pool and frees the context. NULL is fine. MPM_E_STATE while objects made with it live, and in its
 * own callbacks. */
MPM_API mpm_status mpm_context_destroy(mpm_context *context);

/** Gives one or two sentences, with the offending names and values, on the last call on this context or its
 * objects that did not return MPM_OK. Calls that succeed leave them as they are, so that a host may clean up
 * and log first and ask then; "" while no call has failed. The text belongs to the library and is valid until
 * the next call on the context. Of NULL, and of a handle of another kind, a sentence that says so: the calls
 * that get no further than to such a handle have no other. A context that was destroyed must not be given to
 * this or any other call. May be called in callbacks, too, on the thread of the call. */
MPM_API const char *mpm_last_error(const mpm_context *context);

/** Makes text the sentence of mpm_last_error() and returns status: for libraries that stand on this one and
 * refuse a call of their own on a context, as mpm_umat.h does. text is copied, and cut after some 1000 bytes.
 * MPM_E_ARG: status is MPM_OK, or text is NULL; the sentence then says that. */
MPM_API mpm_status mpm_set_last_error(mpm_context *context, mpm_status status, const char *text);

#ifdef __cplusplus
}
#endif

#endif
