/* Parts with so much to tell each other that their threads share the copying; and what a part takes that is
 * the only one. */
#include "shared.h"

enum { CELLS = 32 };
/* 1.02 times what the library took before it had parts. */
static const double MEMORY = 1.02 * 574.3;

/* A block of some 90 000 particles, some thousands of which go to another part. */
static mpm_status set_up_block(world *w, const scene *is) {
  mpm_status status = set_walls(w);
  if (!status) status = fill_middle(w, w->set[0], 0.15, 0.85);
  return status ? status : set_velocities(w, w->set[0], is->speed);
}

static mpm_status step_and_weigh(world *w, const scene *is, outcome *found) {
  const mpm_status status = run_steps(w);
  (void)is;
  found->seen[0] = (double)w->memory.held;
  return status;
}

START_TEST(threads_copy) {
  static scene alone, is;
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  alone = scene_of(3, CELLS, set_up_block);
  alone.speed = 30.0;
  is = alone;
  is.desc.context.concurrency = 3;
  live(0, NULL, &alone);
  ck_assert_msg(!parts_run(3, live, &is, &plan), "%s", plan.text);
  for (int32_t r = 0; r < 3; ++r) {
    const mpm_parallel_info *info = &is.found[r].parallel;
    ck_assert_msg(!is.found[r].status, "part %d: %s", r, is.found[r].text);
    ck_assert_uint_eq(is.found[r].hash, alone.found[0].hash);
    show("part %d: %lld bytes for nodes, %lld for particles, in %lld sorts\n", r,
         (long long)info->bytes_nodes, (long long)info->bytes_moved, (long long)is.found[r].info.resorts);
    /* 64 KB are worth another thread, of what is sent in a step and of what goes to one of two partners */
    ck_assert_int_gt(info->bytes_nodes, 4 * 65536 * STEPS);
    ck_assert_int_gt(info->bytes_moved, 4 * 65536 * is.found[r].info.resorts);
  }
}
END_TEST

/* Bytes for each particle, with nodes and blocks, which are more for so few than for a million: 405 there. */
START_TEST(one_part_takes_no_memory) {
  static scene without, with;
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  without = scene_of(3, CELLS, set_up_block);
  without.run = step_and_weigh;
  with = without;
  live(0, NULL, &without);
  ck_assert_int_eq(parts_run(1, live, &with, &plan), 0);
  ck_assert_msg(!with.found[0].status, "%s", with.found[0].text);
  ck_assert_uint_eq(with.found[0].hash, without.found[0].hash);
  const double particles = (double)without.found[0].total;
  show("%g and %g bytes for each of %g particles\n", without.found[0].seen[0] / particles,
       with.found[0].seen[0] / particles, particles);
  ck_between("without", without.found[0].seen[0] / particles, 400.0, MEMORY);
  ck_between("with", with.found[0].seen[0] / particles, 400.0, MEMORY);
}
END_TEST

TCase *shared_threads_case(void) {
  TCase *tests = tcase_create("threads");
  tcase_set_timeout(tests, 120);
  tcase_add_test(tests, threads_copy);
  tcase_add_test(tests, one_part_takes_no_memory);
  return tests;
}
