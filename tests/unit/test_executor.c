/* Tasks on the library's own threads and on the host's executor. */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "context/context.h"
#include "world.h"

static mpm_context_desc desc_for(int32_t concurrency) {
  mpm_context_desc desc = context_desc();
  desc.concurrency = concurrency;
  return desc;
}

static mpm_context *make(const mpm_context_desc *desc) {
  mpm_context *context = NULL;
  ck_ok(NULL, mpm_context_create(desc, &context));
  return context;
}

typedef struct tally {
  _Atomic int32_t *seen;
  int64_t count;
  _Atomic int64_t out_of_range;
} tally;

static void count_task(void *data, int64_t k) {
  tally *t = data;
  if (k < 0 || k >= t->count)
    atomic_fetch_add(&t->out_of_range, 1);
  else
    atomic_fetch_add(&t->seen[k], 1);
}

static void expect_each_once(mpm_context *context, int64_t count) {
  tally t = {.count = count};
  t.seen = calloc((size_t)count + 1, sizeof *t.seen);
  ck_ok(context, mpmi_parallel_for(context, count, count_task, &t));
  for (int64_t k = 0; k < count; ++k)
    if (t.seen[k] != 1) ck_abort_msg("task %d of %d ran %d times", (int)k, (int)count, (int)t.seen[k]);
  ck_assert_int_eq(t.out_of_range, 0);
  free(t.seen);
}

START_TEST(every_task_once) {
  static const int32_t threads[] = {0, 1, 2, 3, 8};
  for (int i = 0; i < 5; ++i) {
    mpm_context_desc desc = desc_for(threads[i]);
    mpm_context *context = make(&desc);
    ck_assert_int_ge(context->concurrency, 1);
    if (threads[i]) ck_assert_int_eq(context->concurrency, threads[i]);
    for (int64_t count = 0; count < 70; ++count) expect_each_once(context, count);
    expect_each_once(context, 1000);
    expect_each_once(context, 100003);
    ck_ok(context, mpm_context_destroy(context));
  }
}
END_TEST

static void add_task(void *data, int64_t k) {
  int64_t *sums = data;
  sums[k] += k + 1; /* not atomic: runs must not overlap, and their results must be visible afterwards */
}

static void idle(long nanoseconds) {
  struct timespec time = {0, nanoseconds};
  nanosleep(&time, NULL);
}

/* Short runs back to back, with and without pauses long enough for the workers to fall asleep. */
START_TEST(many_short_runs) {
  mpm_context_desc desc = desc_for(4);
  mpm_context *context = make(&desc);
  int64_t sums[5] = {0}, runs = 4000;
  for (int64_t r = 0; r < runs; ++r) {
    if (r % 16 == 0) idle(20000);
    ck_ok(context, mpmi_parallel_for(context, 5, add_task, sums));
  }
  for (int64_t k = 0; k < 5; ++k) ck_assert_int_eq(sums[k], runs * (k + 1));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

static void slow_task(void *data, int64_t k) {
  (void)k;
  idle(2000000);
  atomic_fetch_add((_Atomic int64_t *)data, 1);
}

/* The caller must sleep and be woken; a pool that was never used must end as well. */
START_TEST(slow_tasks) {
  mpm_context_desc desc = desc_for(3);
  mpm_context *context = make(&desc);
  _Atomic int64_t done = 0;
  for (int r = 0; r < 5; ++r) ck_ok(context, mpmi_parallel_for(context, 7, slow_task, &done));
  ck_assert_int_eq(done, 35);
  ck_ok(context, mpm_context_destroy(context));
  ck_ok(NULL, mpm_context_destroy(make(&desc)));
}
END_TEST

static void mask_task(void *data, int64_t k) {
  (void)k;
  sigset_t mask;
  pthread_sigmask(SIG_SETMASK, NULL, &mask);
  idle(1000000);
  if (!pthread_equal(pthread_self(), *(pthread_t *)data))
    ck_assert(sigismember(&mask, SIGINT) == 1 && sigismember(&mask, SIGTERM) == 1);
}

START_TEST(workers_take_no_signals) {
  mpm_context_desc desc = desc_for(2);
  sigset_t before, after;
  pthread_sigmask(SIG_SETMASK, NULL, &before);
  mpm_context *context = make(&desc);
  pthread_sigmask(SIG_SETMASK, NULL, &after);
  for (int s = 1; s < 32; ++s) ck_assert_int_eq(sigismember(&before, s), sigismember(&after, s));
  pthread_t self = pthread_self();
  ck_ok(context, mpmi_parallel_for(context, 8, mask_task, &self));
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

typedef struct executor {
  int64_t calls;
  mpm_status status;
} executor;

static mpm_status backwards(void *user, int64_t count, mpm_task_fn task, void *data) {
  executor *e = user;
  e->calls++;
  if (e->status) return e->status;
  for (int64_t k = count - 1; k >= 0; --k) task(data, k);
  return MPM_OK;
}

START_TEST(host_executor) {
  executor e = {0, MPM_OK};
  mpm_context_desc desc = desc_for(6);
  desc.parallel_for = backwards;
  desc.parallel_user = &e;
  mpm_context *context = make(&desc);
  ck_assert_ptr_null(context->pool);
  ck_assert_int_eq(context->concurrency, 6);
  expect_each_once(context, 17);
  ck_assert_int_eq(e.calls, 1);
  expect_each_once(context, 1); /* not worth a call */
  expect_each_once(context, 0);
  ck_assert_int_eq(e.calls, 1);
  int64_t sums[3] = {0};
  e.status = 42;
  ck_refused(context, mpmi_parallel_for(context, 3, add_task, sums), MPM_E_CALLBACK, "42");
  ck_assert_int_eq(sums[2], 0);
  mpmi_parallel_for_sure(context, 3, add_task, sums);
  ck_assert_int_eq(sums[2], 3);
  ck_ok(context, mpm_context_destroy(context));
  desc.concurrency = 0;
  context = make(&desc);
  ck_assert_int_ge(context->concurrency, 1);
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

static void *own_context(void *argument) {
  (void)argument;
  for (int r = 0; r < 20; ++r) {
    mpm_context_desc desc = desc_for(1 + r % 3);
    mpm_context *context = make(&desc);
    expect_each_once(context, 100 + r);
    mpmi_fail(context, MPM_E_IO, "run %d", r);
    ck_assert_int_eq(mpm_last_error(context)[4] - '0', r < 10 ? r : r / 10);
    ck_ok(context, mpm_context_destroy(context));
  }
  return NULL;
}

START_TEST(contexts_side_by_side) {
  pthread_t thread[4];
  for (int k = 0; k < 4; ++k) ck_assert_int_eq(pthread_create(&thread[k], NULL, own_context, NULL), 0);
  for (int k = 0; k < 4; ++k) ck_assert_int_eq(pthread_join(thread[k], NULL), 0);
}
END_TEST

/* In the child: 0 where the world steps on as it would have, and everything can be freed. */
static int32_t child_of(world *w, uint64_t expected) {
  alarm(60); /* a lost thread that is waited for */
  world_steps(w, 5);
  const int32_t same = world_hash(w) == expected;
  world_close(w);
#if !defined(__SANITIZE_THREAD__) /* it ends children that start threads, and so does qemu */
  if (getenv("MPM_EMULATED")) return same ? 0 : 3;
  mpm_context_desc desc = desc_for(3);
  mpm_context *context = make(&desc);
  expect_each_once(context, 100);
  ck_ok(context, mpm_context_destroy(context));
#endif
  return same ? 0 : 3;
}

/* Of the threads of a process none is in the child that it forks. */
START_TEST(children_of_fork) {
  for (int32_t stepped = 0; stepped < 2; ++stepped) { /* the pool sleeps, or is about to */
    world_desc d = world_default(2, 40, 0.05);
    d.context.concurrency = 4;
    d.dt = 1e-5;
    world w;
    world_open(&w, &d);
    world_fill_cube(&w, w.set[0], 0.3, 1.5);
    if (stepped) world_steps(&w, 3);
    const saved_state before = world_save(&w);
    world_steps(&w, 5);
    const uint64_t expected = world_hash(&w);
    ck_ok(&w, mpm_state_load(w.stepper, before.data, before.bytes));
    free(before.data);
    fflush(NULL);
    const pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (!child) _exit(child_of(&w, expected));
    int status = 0;
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    if (WIFSIGNALED(status)) ck_abort_msg("the child ended by signal %d", WTERMSIG(status));
    ck_assert_int_eq(WEXITSTATUS(status), 0);
    world_steps(&w, 5); /* the parent has its threads still */
    ck_assert_uint_eq(world_hash(&w), expected);
    world_close(&w);
  }
}
END_TEST

/* The child may fork on, and its own pools work there as little as those that it has from its parent. */
START_TEST(pools_know_their_process) {
  mpm_context_desc desc = desc_for(2);
  mpm_context *context = make(&desc);
  fflush(NULL);
  const pid_t child = fork();
  if (!child) {
    alarm(60);
    expect_each_once(context, 50);
    pid_t inner = fork();
    expect_each_once(context, 50);
    ck_ok(context, mpm_context_destroy(context));
    int status = 0;
    if (inner && (waitpid(inner, &status, 0) != inner || status)) _exit(4);
    _exit(0);
  }
  int status = 0;
  ck_assert_int_eq(waitpid(child, &status, 0), child);
  ck_assert_int_eq(status, 0);
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

Suite *executor_suite(void) {
  Suite *suite = suite_create("executor");
  TCase *threads = tcase_create("threads");
  tcase_set_timeout(threads, 60);
  tcase_add_test(threads, every_task_once);
  tcase_add_test(threads, many_short_runs);
  tcase_add_test(threads, slow_tasks);
  tcase_add_test(threads, workers_take_no_signals);
  tcase_add_test(threads, host_executor);
  tcase_add_test(threads, contexts_side_by_side);
  tcase_add_test(threads, children_of_fork);
  tcase_add_test(threads, pools_know_their_process);
  suite_add_tcase(suite, threads);
  return suite;
}
