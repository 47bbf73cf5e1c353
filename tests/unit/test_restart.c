/* A saved state goes on bit by bit: saved between two sorts, with host fields, removed particles, all kinds
 * of walls and periods, through memory and files, on other numbers of threads. */
#include "run_support.h"

enum { BEFORE = 5, AFTER = 12 };

static run_options numbered(int32_t i) {
  run_options o = {.dim = 1 + i / (2 * RUN_ALL),
                   .periodic = i / RUN_ALL % 2,
                   .velocity_bc = i % 3 == 0,
                   .led = i % 3 == 1 && i % RUN_ALL < 6}; /* linear: too soft */
  run_use(&o, &run_methods[i % RUN_ALL]);
  return o;
}
enum { COMBINATIONS = 3 * 2 * RUN_ALL };

static void remove_one(run *r) {
  const int64_t id = 1;
  run_ok(r, mpm_particles_remove(r->set[0], 1, &id));
}

static void same_info(const run *a, const run *b) {
  const mpm_step_info *x = &a->info, *y = &b->info;
  ck_assert_int_eq(x->step, y->step);
  ck_assert_int_eq(x->removed, y->removed);
  ck_assert_int_eq(x->resorts, y->resorts);
  ck_assert_int_eq(x->active_nodes, y->active_nodes);
  ck_assert_double_eq(x->t, y->t);
  ck_assert_double_eq(x->dt, y->dt);
  ck_assert_double_eq(x->dt_suggested, y->dt_suggested);
  ck_assert_double_eq(x->kinetic_energy, y->kinetic_energy);
  ck_assert_double_eq(x->strain_energy, y->strain_energy);
  ck_assert_double_eq(x->external_work, y->external_work);
  ck_assert_double_eq(x->dissipation, y->dissipation);
  for (int32_t k = 0; k < 3; ++k) {
    ck_assert_double_eq(x->momentum[k], y->momentum[k]);
    ck_assert_double_eq(x->angular_momentum[k], y->angular_momentum[k]);
  }
}

static void same_reactions(run *a, run *b) {
  for (int32_t face = 0; face < 2 * a->options.dim; ++face) {
    double x[3], y[3];
    run_ok(a, mpm_stepper_wall_reaction(a->stepper, face, x));
    run_ok(b, mpm_stepper_wall_reaction(b->stepper, face, y));
    for (int32_t k = 0; k < a->options.dim; ++k) ck_assert_double_eq(x[k], y[k]);
  }
  for (int32_t m = 0; m < 2; ++m) {
    double x[3], y[3];
    run_ok(a, mpm_stepper_particles_reaction(a->stepper, a->set[m], x));
    run_ok(b, mpm_stepper_particles_reaction(b->stepper, b->set[m], y));
    for (int32_t k = 0; k < a->options.dim; ++k) ck_assert_double_eq(x[k], y[k]);
  }
}

/* Goes on step by step beside the run that never stopped. */
static void go_on(run *a, run *b) {
  run_state state = run_take(a);
  run_same(b, &state, "the loaded state");
  run_drop(&state);
  same_reactions(a, b);
  for (int32_t i = 0; i < AFTER; ++i) {
    run_steps(a, 1);
    run_steps(b, 1);
    ck_assert_msg(run_hash(a) == run_hash(b), "another hash %d steps after loading", (int)i + 1);
    same_info(a, b);
    same_reactions(a, b);
  }
}

static const char *path_of(char *path, size_t size, int32_t i) {
  const char *scratch = getenv("MPM_SCRATCH");
  snprintf(path, size, "%s/restart-%d.state", scratch ? scratch : ".", (int)i);
  return path;
}

START_TEST(goes_on_bit_by_bit) {
  run_options o = numbered(_i);
  run a, b, c;
  char path[512];
  int64_t bytes;
  path_of(path, sizeof path, _i);
  run_open(&a, &o);
  run_steps(&a, BEFORE - 2);
  remove_one(&a);
  run_steps(&a, 2);
  const int64_t resorts = a.info.resorts;
  run_ok(&a, mpm_state_size(a.stepper, &bytes));
  char *state = malloc((size_t)bytes);
  run_ok(&a, mpm_state_save(a.stepper, state, bytes));
  run_ok(&a, mpm_state_save_file(a.stepper, path));

  o.concurrency = 3; /* into sets that are empty */
  o.empty = 1;
  run_open(&b, &o);
  run_ok(&b, mpm_state_load(b.stepper, state, bytes));
  go_on(&a, &b);
  ck_assert_int_gt(a.info.resorts, resorts);
  const uint64_t end = run_hash(&a);

  o.concurrency = 2; /* into a run that is somewhere else */
  o.empty = 0;
  run_open(&c, &o);
  run_steps(&c, 9);
  run_ok(&c, mpm_state_load_file(c.stepper, path));
  run_steps(&c, AFTER);
  ck_assert(run_hash(&c) == end);

  /* and back into the run that it came from */
  run_ok(&a, mpm_state_load(a.stepper, state, bytes));
  run_steps(&a, AFTER);
  ck_assert(run_hash(&a) == end);
  run_close(&a);
  run_close(&b);
  run_close(&c);
  free(state);
  remove(path);
}
END_TEST

/* The controller's dt is part of the state: mpm_advance() takes the same sub-steps. */
START_TEST(controller) {
  run_options o = {.dim = 2};
  run a, b;
  mpm_advance_desc d;
  int64_t bytes;
  ck_assert_int_eq(mpm_advance_desc_init(&d, sizeof d), MPM_OK);
  run_open(&a, &o);
  d.dt_first = 1e-5;
  d.t_end = 1.0;
  d.max_steps = 3;
  run_ok(&a, mpm_advance(a.stepper, &d, NULL));
  run_ok(&a, mpm_state_size(a.stepper, &bytes));
  char *state = malloc((size_t)bytes);
  run_ok(&a, mpm_state_save(a.stepper, state, bytes));
  o.empty = 1;
  o.concurrency = 3;
  run_open(&b, &o);
  run_ok(&b, mpm_state_load(b.stepper, state, bytes));
  d.dt_first = 0.0;
  d.max_steps = 4;
  a.info.struct_size = b.info.struct_size = sizeof a.info;
  run_ok(&a, mpm_advance(a.stepper, &d, &a.info));
  run_ok(&b, mpm_advance(b.stepper, &d, &b.info));
  same_info(&a, &b);
  ck_assert_double_gt(a.info.t, 7e-5); /* 1 + 2 + 4 + 8 + ... */
  ck_assert_double_lt(a.info.t, 13e-4);
  ck_assert(run_hash(&a) == run_hash(&b));
  run_close(&a);
  run_close(&b);
  free(state);
}
END_TEST

/* Saving and loading before the first step, and of a set with added particles not yet sorted. */
START_TEST(unsorted) {
  run_options o = {.dim = 1 + _i, .concurrency = 2};
  run a, b;
  int64_t bytes;
  run_open(&a, &o);
  run_ok(&a, mpm_state_size(a.stepper, &bytes));
  char *state = malloc((size_t)bytes);
  run_ok(&a, mpm_state_save(a.stepper, state, bytes));
  o.concurrency = 1;
  o.empty = 1;
  run_open(&b, &o);
  run_ok(&b, mpm_state_load(b.stepper, state, bytes));
  run_steps(&a, AFTER);
  run_steps(&b, AFTER);
  ck_assert(run_hash(&a) == run_hash(&b));
  same_info(&a, &b);
  run_close(&a);
  run_close(&b);
  free(state);
}
END_TEST

Suite *restart_suite(void) {
  Suite *suite = suite_create("restart");
  TCase *tests = tcase_create("restart");
  tcase_set_timeout(tests, 300);
  tcase_add_loop_test(tests, goes_on_bit_by_bit, 0, COMBINATIONS);
  tcase_add_test(tests, controller);
  tcase_add_loop_test(tests, unsorted, 0, 3);
  suite_add_tcase(suite, tests);
  return suite;
}
