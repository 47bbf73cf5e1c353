/* Contexts do not know of each other: several of them step at once on threads of the host, each with its own
 * pool, and give what they give alone. Steps that are short take one thread. */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <stdatomic.h>
#include <time.h>

#include "body.h"
#include "stepper/stepper.h"

enum { RUNS = 6, STEPS = 20 };

typedef struct job {
  world_desc desc;
  uint64_t hash;
  int32_t failed;
} job;

/* Check's macros may not be used beside the main thread. */
static void *tell(void *argument) {
  job *j = argument;
  world r = {.desc = j->desc};
  j->failed = world_try_open(&r) != MPM_OK;
  for (int32_t i = 0; i < STEPS && !j->failed; ++i) j->failed = mpm_step(r.stepper, BODY_DT, NULL) != MPM_OK;
  /* what is refused must not disturb the others */
  j->failed |= mpm_step(r.stepper, -1.0, NULL) != MPM_E_ARG || !strstr(mpm_last_error(r.context), "-1");
  j->failed |= mpm_state_hash(r.stepper, &j->hash) != MPM_OK;
  j->failed |= world_try_close(&r) != MPM_OK;
  return NULL;
}

START_TEST(several_contexts_at_once) {
  job alone[RUNS], beside[RUNS];
  pthread_t thread[RUNS];
  for (int32_t i = 0; i < RUNS; ++i) {
    const body_desc o = {
        .dim = 1 + i % 3, .concurrency = 1 + i % 2, .periodic = i / 3, .method = *broad_methods[i]};
    alone[i] = (job){.desc = world_of_body(&o)};
    beside[i] = alone[i];
    tell(&alone[i]);
    ck_assert_int_eq(alone[i].failed, 0);
  }
  for (int32_t round = 0; round < 3; ++round) {
    for (int32_t i = 0; i < RUNS; ++i)
      ck_assert_int_eq(pthread_create(&thread[i], NULL, tell, &beside[i]), 0);
    for (int32_t i = 0; i < RUNS; ++i) ck_assert_int_eq(pthread_join(thread[i], NULL), 0);
    for (int32_t i = 0; i < RUNS; ++i) {
      ck_assert_int_eq(beside[i].failed, 0);
      ck_assert(beside[i].hash == alone[i].hash);
      for (int32_t k = 0; k < i; ++k) ck_assert(beside[k].hash != beside[i].hash);
    }
  }
}
END_TEST

/* What callbacks of a step saw: threads other than that of the test, and whether steps are to last. */
typedef struct witness {
  pthread_t caller;
  _Atomic int64_t elsewhere, batches;
  int32_t naps;
} witness;

static mpm_status push(void *user, const mpm_particle_batch *batch, double *add) {
  witness *of = user;
  atomic_fetch_add(&of->batches, 1);
  if (!pthread_equal(pthread_self(), of->caller)) atomic_fetch_add(&of->elsewhere, 1);
  for (int64_t i = 0; i < batch->n; ++i) add[i] += 1e-3;
  return MPM_OK;
}

static mpm_status nap(void *user, const mpm_step_info *info) {
  (void)info;
  const witness *of = user;
  const struct timespec moment = {.tv_nsec = 1000000};
  if (of->naps) nanosleep(&moment, NULL);
  return MPM_OK;
}

/* Steps the same cloud on one thread or on two, as if its steps had been short or not; returns its hash. */
static uint64_t hash_with(int32_t concurrency, int32_t is_short, int32_t naps, mpmi_pace *after) {
  world_desc d = world_default(2, 40, 0.05);
  d.context.concurrency = concurrency;
  d.dt = 1e-5;
  world w;
  world_open(&w, &d);
  world_fill_cube(&w, w.set[0], 0.3, 1.5);
  witness of = {.caller = pthread_self(), .naps = naps};
  ck_ok(&w, mpm_stepper_set_force(w.stepper, push, &of));
  ck_ok(&w, mpm_stepper_set_progress(w.stepper, nap, &of));
  for (int32_t i = 0; i < 5; ++i) {
    w.stepper->pace.is_short = is_short;
    world_steps(&w, 1);
    ck_assert(!w.context->pool_rests);
  }
  ck_assert_int_gt(of.batches, 5); /* there is something to share out */
  if (is_short) ck_assert_int_eq(of.elsewhere, 0);
  *after = w.stepper->pace;
  const uint64_t hash = world_hash(&w);
  world_close(&w);
  return hash;
}

START_TEST(short_steps_take_one_thread) {
  mpmi_pace after;
  const uint64_t expected = hash_with(1, 0, 0, &after);
  ck_assert(hash_with(2, 1, 0, &after) == expected);
  ck_assert(hash_with(2, 1, 1, &after) == expected);
  ck_assert_int_eq(after.is_short, 0);               /* and the next one is known to last */
  ck_assert_int_eq(after.wait, MPMI_MOST_STEPS / 2); /* five were tried on one thread: 64 * 2^5 */
  ck_assert(hash_with(2, 0, 1, &after) == expected);
  ck_assert_int_eq(after.is_short, 0);
  ck_assert_int_eq(after.left, MPMI_SHORT_STEPS);
}
END_TEST

/* Steps that are short on several threads lead to one on one thread, which shows whether it is short there,
 * too; where it is not, it takes twice as many to another. */
START_TEST(short_steps_are_found) {
  world_desc d = world_default(2, 4, 0.25);
  d.context.concurrency = 2;
  d.dt = 1e-5;
  world w;
  world_open(&w, &d);
  mpmi_pace *pace = &w.stepper->pace;
  for (int32_t round = 0, wait = MPMI_SHORT_STEPS; round < 9; ++round) {
    pace->bound = INFINITE;
    for (int32_t i = 0; i < wait; ++i) {
      ck_holds(!pace->is_short && pace->left == wait - i);
      world_steps(&w, 1);
    }
    ck_assert_int_eq(pace->is_short, 1);
    pace->bound = 0.0;
    world_steps(&w, 1);
    ck_assert_int_eq(pace->is_short, 0);
    wait = wait < MPMI_MOST_STEPS ? 2 * wait : wait;
    ck_assert_int_eq(pace->wait, wait);
  }
  world_steps(&w, 3);
  ck_assert_int_eq(pace->left, MPMI_MOST_STEPS); /* steps that are long count for nothing */
  pace->bound = INFINITE, pace->left = 1;
  world_steps(&w, 2);
  ck_assert(pace->is_short == 1 && pace->wait == MPMI_SHORT_STEPS);
  world_close(&w);
}
END_TEST

/* Seconds of tasks pass side by side, unless one thread has made them all. */
START_TEST(samples_know_of_resting_threads) {
  world_desc d = world_default(2, 4, 0.25);
  d.context.concurrency = 2;
  world w;
  world_open(&w, &d);
  mpm_stepper *s = w.stepper;
  mpmi_step step = {.settings = &s->settings, .work = &s->work, .profile = &s->profile};
  for (int32_t rests = 0; rests < 2; ++rests) {
    memset(&s->profile, 0, sizeof s->profile);
    w.context->pool_rests = rests;
    for (int32_t k = 0; k < 2; ++k) s->work.report[k].law_seconds = s->work.report[k].weights_seconds = 2.0;
    mpmi_move_samples(&step, MPMI_TIME_G2P);
    const double *seconds = s->profile.seconds, expected = rests ? 4.0 : 2.0;
    ck_assert(seconds[MPMI_TIME_LAW] == expected && seconds[MPMI_TIME_WEIGHTS] == expected);
    ck_assert(seconds[MPMI_TIME_G2P] == -expected);
  }
  w.context->pool_rests = 0;
  mpmi_reports_clear(&s->work, 2);
  world_close(&w);
}
END_TEST

Suite *threads_suite(void) {
  Suite *suite = suite_create("threads");
  TCase *tests = tcase_create("threads");
  tcase_set_timeout(tests, 120);
  tcase_add_test(tests, several_contexts_at_once);
  tcase_add_test(tests, short_steps_take_one_thread);
  tcase_add_test(tests, short_steps_are_found);
  tcase_add_test(tests, samples_know_of_resting_threads);
  suite_add_tcase(suite, tests);
  return suite;
}
