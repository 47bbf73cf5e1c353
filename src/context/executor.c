/* Numbered tasks on the library's own threads, the host's executor or the calling thread.
 *
 * The pool hands out tasks by compare-and-swap on one word, `ticket`: the number of the run in the upper
 * half, the tasks not yet handed out in the lower. A worker that wakes late finds a word that has moved on
 * and takes nothing. So a run ends as soon as its tasks are done, without a wait for workers that never came.
 */
#include <stdatomic.h>

#include "context/context.h"
#include "platform/platform.h"

enum {
  SPIN_NS = 100000, /* the longest wait before sleeping: tasks of a step end and begin closer together */
  CACHE_LINE = 64   /* words that threads write often are kept apart from those that they read */
};
#define TASKS_AT_ONCE ((int64_t)UINT32_MAX)

struct mpmi_pool {
  _Alignas(CACHE_LINE) _Atomic uint64_t ticket;
  _Alignas(CACHE_LINE) _Atomic int64_t unfinished; /* number of tasks of the run that are not done yet */
  /* What to run. It is written only while no task can be taken, and atomic because late workers may look. */
  _Alignas(CACHE_LINE) _Atomic(mpm_task_fn) task;
  _Atomic(void *) data;
  _Atomic int64_t first; /* number of the first task */
  _Atomic uint32_t count;
  _Alignas(CACHE_LINE) _Atomic int32_t sleeping; /* number of workers that need a signal */
  _Atomic int32_t stop;
  mpmi_monitor monitor;
  int64_t
      process; /* in which the threads are; a fork takes the pool into another one and leaves them behind */
  int32_t workers; /* number of threads besides the caller's */
  size_t bytes;    /* size of this allocation */
  mpmi_system_thread thread[];
};

static void pause_briefly(void) {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  __asm__ volatile("yield");
#endif
}

static int nothing_to_take(mpmi_pool *pool) {
  return (uint32_t)atomic_load(&pool->ticket) == 0;
}

static int not_finished(mpmi_pool *pool) {
  return atomic_load(&pool->unfinished) != 0;
}

/* Waits a moment for the condition to end, and tells whether it still lasts. The clock bounds the wait,
 * because a pause takes ten times longer on some processors than on others. */
static int lasts(mpmi_pool *pool, int (*condition)(mpmi_pool *)) {
  if (!condition(pool)) return 0;
  int64_t end = mpmi_nanoseconds() + SPIN_NS;
  do {
    for (int32_t k = 0; k < 4; ++k) pause_briefly();
    if (!condition(pool)) return 0;
  } while (mpmi_nanoseconds() < end);
  return 1;
}

/* Runs tasks until none is left to take. The thread that finishes the last task of a run wakes the caller. */
static void take_part(mpmi_pool *pool) {
  int64_t finished = 0;
  uint64_t ticket = atomic_load(&pool->ticket);
  while ((uint32_t)ticket) {
    /* These are valid when the exchange succeeds: while a task is not handed out the run cannot end, and they
     * cannot change. */
    mpm_task_fn task = atomic_load_explicit(&pool->task, memory_order_relaxed);
    void *data = atomic_load_explicit(&pool->data, memory_order_relaxed);
    int64_t first = atomic_load_explicit(&pool->first, memory_order_relaxed);
    uint32_t count = atomic_load_explicit(&pool->count, memory_order_relaxed);
    if (!atomic_compare_exchange_weak(&pool->ticket, &ticket, ticket - 1)) continue;
    task(data, first + (count - (uint32_t)ticket));
    finished++;
    ticket = atomic_load(&pool->ticket);
  }
  if (finished && atomic_fetch_sub(&pool->unfinished, finished) == finished) {
    mpmi_lock(&pool->monitor); /* so as not to signal between the caller's last look and its sleep */
    mpmi_unlock(&pool->monitor);
    mpmi_wake_one(&pool->monitor, MPMI_DONE);
  }
}

static void sleep_until_work(mpmi_pool *pool) {
  mpmi_lock(&pool->monitor);
  atomic_fetch_add(&pool->sleeping, 1); /* comes before the last look: see the order in run() */
  while (nothing_to_take(pool) && !atomic_load(&pool->stop)) mpmi_wait(&pool->monitor, MPMI_WORK);
  atomic_fetch_sub(&pool->sleeping, 1);
  mpmi_unlock(&pool->monitor);
}

static void *work(void *argument) {
  mpmi_pool *pool = argument;
  while (!atomic_load(&pool->stop)) {
    take_part(pool);
    if (lasts(pool, nothing_to_take)) sleep_until_work(pool);
  }
  return NULL;
}

static void run(mpmi_pool *pool, int64_t first, uint32_t count, mpm_task_fn task, void *data) {
  atomic_store_explicit(&pool->task, task, memory_order_relaxed);
  atomic_store_explicit(&pool->data, data, memory_order_relaxed);
  atomic_store_explicit(&pool->first, first, memory_order_relaxed);
  atomic_store_explicit(&pool->count, count, memory_order_relaxed);
  atomic_store_explicit(&pool->unfinished, count, memory_order_relaxed);
  uint64_t number = (atomic_load_explicit(&pool->ticket, memory_order_relaxed) >> 32) + 1;
  /* The ticket is written before `sleeping` is read, and a worker counts itself as sleeping before it reads
   * the ticket: one of the two sees the other, so no wake-up is lost. */
  atomic_store(&pool->ticket, number << 32 | count);
  int32_t sleeping = atomic_load(&pool->sleeping);
  if (sleeping) {
    mpmi_lock(&pool->monitor); /* so as not to signal between a worker's last look and its sleep */
    mpmi_unlock(&pool->monitor);
    if (count - 1 < (uint32_t)sleeping)
      for (uint32_t k = 1; k < count; ++k) mpmi_wake_one(&pool->monitor, MPMI_WORK);
    else
      mpmi_wake_all(&pool->monitor, MPMI_WORK);
  }
  take_part(pool);
  if (!lasts(pool, not_finished)) return;
  mpmi_lock(&pool->monitor);
  while (not_finished(pool)) mpmi_wait(&pool->monitor, MPMI_DONE);
  mpmi_unlock(&pool->monitor);
}

static void run_inline(int64_t count, mpm_task_fn task, void *data) {
  for (int64_t k = 0; k < count; ++k) task(data, k);
}

/* In a child of fork the threads are gone, and the monitor is as they happened to hold it: it is not
 * touched. */
static int32_t has_threads(const mpmi_pool *pool) {
  return pool->process == mpmi_process();
}

static void pool_run(mpmi_pool *pool, int64_t count, mpm_task_fn task, void *data) {
  for (int64_t first = 0; first < count; first += TASKS_AT_ONCE) {
    int64_t rest = count - first;
    run(pool, first, (uint32_t)(rest < TASKS_AT_ONCE ? rest : TASKS_AT_ONCE), task, data);
  }
}

mpm_status mpmi_pool_create(mpm_context *context, int32_t threads, mpmi_pool **out) {
  if (!MPMI_HAS_THREADS)
    return mpmi_fail(
        context, MPM_E_UNSUPPORTED,
        "concurrency is %d, but this build has no threads: it must be 0 or 1, or parallel_for set",
        (int)threads);
  int32_t workers = threads - 1;
  size_t bytes = sizeof(mpmi_pool) + mpmi_bytes(workers, sizeof(mpmi_system_thread));
  mpmi_pool *pool = mpmi_alloc_zeroed(context, bytes);
  if (!pool) return MPM_E_NOMEM;
  pool->bytes = bytes;
  pool->process = mpmi_process();
  mpmi_monitor_begin(&pool->monitor);
  while (pool->workers < workers && mpmi_thread_start(&pool->thread[pool->workers], work, pool))
    pool->workers++;
  if (pool->workers < workers) {
    mpmi_pool_destroy(context, pool);
    return mpmi_fail(context, MPM_E_NOMEM, "the system refuses to start %d threads", workers);
  }
  *out = pool;
  return MPM_OK;
}

static void end_workers(mpmi_pool *pool) {
  mpmi_lock(&pool->monitor);
  atomic_store(&pool->stop, 1);
  mpmi_wake_all(&pool->monitor, MPMI_WORK);
  mpmi_unlock(&pool->monitor);
  for (int32_t k = 0; k < pool->workers; ++k) mpmi_thread_join(&pool->thread[k]);
  mpmi_monitor_end(&pool->monitor);
}

void mpmi_pool_destroy(mpm_context *context, mpmi_pool *pool) {
  if (!pool) return;
  if (has_threads(pool)) end_workers(pool);
  mpmi_free(context, pool, pool->bytes);
}

/* A task that the host's executor runs: its threads have environments of their own. */
typedef struct hosted {
  mpm_task_fn task;
  void *data;
} hosted;

static void run_hosted(void *data, int64_t k) {
  const hosted *h = data;
  mpmi_environment host;
  mpmi_environment_enter(&host);
  h->task(h->data, k);
  mpmi_environment_leave(&host);
}

/* What the host's executor returned. */
static mpm_status run_by_host(const mpm_context_desc *host, int64_t count, mpm_task_fn task, void *data) {
  hosted h = {task, data};
  return mpmi_from_host(host->parallel_for(host->parallel_user, count, run_hosted, &h));
}

/* The system is asked once per call, because to ask takes as long as a small task. */
static int32_t pool_runs(mpm_context *context) {
  if (!context->pool || context->pool_rests) return 0;
  if (!context->pool_runs) context->pool_runs = has_threads(context->pool) ? 1 : -1;
  return context->pool_runs > 0;
}

static mpm_status run_anywhere(mpm_context *context, int64_t count, mpm_task_fn task, void *data) {
  if (count > 1 && context->host.parallel_for) return run_by_host(&context->host, count, task, data);
  if (count > 1 && pool_runs(context)) {
    pool_run(context->pool, count, task, data);
  } else {
    run_inline(count, task, data);
  }
  return MPM_OK;
}

mpm_status mpmi_parallel_for(mpm_context *context, int64_t count, mpm_task_fn task, void *data) {
  const mpm_status status = run_anywhere(context, count, task, data);
  if (!status) return MPM_OK;
  return mpmi_fail(context, MPM_E_CALLBACK, "the host's parallel_for returned %d", (int)status);
}

void mpmi_parallel_for_sure(mpm_context *context, int64_t count, mpm_task_fn task, void *data) {
  if (run_anywhere(context, count, task, data)) run_inline(count, task, data);
}
