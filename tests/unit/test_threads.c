/* Contexts do not know of each other: several of them step at once on threads of the host, each with its own
 * pool, and give what they give alone. */
#include <pthread.h>

#include "body.h"

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

Suite *threads_suite(void) {
  Suite *suite = suite_create("threads");
  TCase *tests = tcase_create("threads");
  tcase_set_timeout(tests, 120);
  tcase_add_test(tests, several_contexts_at_once);
  suite_add_tcase(suite, tests);
  return suite;
}
