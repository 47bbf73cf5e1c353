/* A saved state goes on bit by bit: saved between two sorts, with host fields, removed particles, all kinds
 * of walls and periods, through memory and files, on other numbers of threads. */
#include "body.h"
#include "tables.h"

enum { BEFORE = 5, AFTER = 12 };

static body_desc numbered(int32_t i) {
  return (body_desc){.dim = 1 + i / (2 * BROAD),
                     .periodic = i / BROAD % 2,
                     .velocity_bc = i % 3 == 0,
                     .led = i % 3 == 1 && i % BROAD < 6, /* linear: too soft */
                     .method = *broad_methods[i % BROAD]};
}
enum { COMBINATIONS = 3 * 2 * BROAD };

static void remove_one(world *r) {
  const int64_t id = 1;
  ck_ok(r, mpm_particles_remove(r->set[0], 1, &id));
}

/* The steppers must agree byte by byte, and so must what their last calls have given. */
static void same_infos(const world *a, const world *b) {
  same_info(a, b);
  ck_assert_mem_eq(&a->info, &b->info, sizeof a->info);
}

static void same_reactions(world *a, world *b) {
  for (int32_t face = 0; face < 2 * a->dim; ++face) {
    double x[3], y[3];
    ck_ok(a, mpm_stepper_wall_reaction(a->stepper, face, x));
    ck_ok(b, mpm_stepper_wall_reaction(b->stepper, face, y));
    for (int32_t k = 0; k < a->dim; ++k) ck_assert_double_eq(x[k], y[k]);
    ck_ok(a, mpm_stepper_wall_impulse(a->stepper, face, x));
    ck_ok(b, mpm_stepper_wall_impulse(b->stepper, face, y));
    for (int32_t k = 0; k < a->dim; ++k) ck_assert_double_eq(x[k], y[k]);
  }
  for (int32_t m = 0; m < 2; ++m) {
    double x[3], y[3];
    ck_ok(a, mpm_stepper_particles_reaction(a->stepper, a->set[m], x));
    ck_ok(b, mpm_stepper_particles_reaction(b->stepper, b->set[m], y));
    for (int32_t k = 0; k < a->dim; ++k) ck_assert_double_eq(x[k], y[k]);
    ck_ok(a, mpm_stepper_particles_impulse(a->stepper, a->set[m], x));
    ck_ok(b, mpm_stepper_particles_impulse(b->stepper, b->set[m], y));
    for (int32_t k = 0; k < a->dim; ++k) ck_assert_double_eq(x[k], y[k]);
  }
}

/* Goes on step by step beside the run that never stopped. */
static void go_on(world *a, world *b) {
  world_bits state = world_take(a);
  world_same(b, &state, "the loaded state");
  bits_drop(&state);
  same_reactions(a, b);
  for (int32_t i = 0; i < AFTER; ++i) {
    world_steps(a, 1);
    world_steps(b, 1);
    ck_assert_msg(world_hash(a) == world_hash(b), "another hash %d steps after loading", (int)i + 1);
    same_infos(a, b);
    same_reactions(a, b);
  }
}

START_TEST(goes_on_bit_by_bit) {
  body_desc o = numbered(_i);
  world a, b, c;
  char name[64], path[512];
  snprintf(name, sizeof name, "restart-%d.state", (int)_i);
  scratch_path(name, path, sizeof path);
  body_open(&a, &o);
  world_steps(&a, BEFORE - 2);
  remove_one(&a);
  world_steps(&a, 2);
  const int64_t resorts = a.info.resorts;
  const saved_state state = world_save(&a);
  ck_ok(&a, mpm_state_save_file(a.stepper, path));

  o.concurrency = 3; /* into sets that are empty */
  o.empty = 1;
  body_open(&b, &o);
  world_load(&b, &state);
  go_on(&a, &b);
  ck_assert_int_gt(a.info.resorts, resorts);
  const uint64_t end = world_hash(&a);

  o.concurrency = 2; /* into a run that is somewhere else */
  o.empty = 0;
  body_open(&c, &o);
  world_steps(&c, 9);
  ck_ok(&c, mpm_state_load_file(c.stepper, path));
  world_steps(&c, AFTER);
  ck_assert(world_hash(&c) == end);

  /* and back into the run that it came from */
  world_load(&a, &state);
  world_steps(&a, AFTER);
  ck_assert(world_hash(&a) == end);
  world_close(&a);
  world_close(&b);
  world_close(&c);
  free(state.data);
  remove(path);
}
END_TEST

/* The controller's dt is part of the state: mpm_advance() takes the same sub-steps. */
START_TEST(controller) {
  body_desc o = {.dim = 2};
  world a, b;
  mpm_advance_desc d = advance_desc(1.0);
  body_open(&a, &o);
  d.dt_first = 1e-5;
  d.max_steps = 3;
  ck_ok(&a, mpm_advance(a.stepper, &d, NULL));
  const saved_state state = world_save(&a);
  o.empty = 1;
  o.concurrency = 3;
  body_open(&b, &o);
  world_load(&b, &state);
  d.dt_first = 0.0;
  d.max_steps = 4;
  ck_ok(&a, mpm_advance(a.stepper, &d, &a.info));
  ck_ok(&b, mpm_advance(b.stepper, &d, &b.info));
  same_infos(&a, &b);
  ck_assert_double_gt(a.info.t, 7e-5); /* 1 + 2 + 4 + 8 + ... */
  ck_assert_double_lt(a.info.t, 13e-4);
  ck_assert(world_hash(&a) == world_hash(&b));
  world_close(&a);
  world_close(&b);
  free(state.data);
}
END_TEST

/* Saving and loading before the first step, and of a set with added particles not yet sorted. */
START_TEST(unsorted) {
  body_desc o = {.dim = 1 + _i, .concurrency = 2};
  world a, b;
  body_open(&a, &o);
  const saved_state state = world_save(&a);
  o.concurrency = 1;
  o.empty = 1;
  body_open(&b, &o);
  world_load(&b, &state);
  world_steps(&a, AFTER);
  world_steps(&b, AFTER);
  ck_assert(world_hash(&a) == world_hash(&b));
  same_infos(&a, &b);
  world_close(&a);
  world_close(&b);
  free(state.data);
}
END_TEST

Suite *restart_suite(void) {
  Suite *suite = suite_create("restart");
  TCase *tests = tcase_create("restart");
  tcase_set_timeout(tests, 300);
  add_table(tests, wide_case(suite, "more combinations"), goes_on_bit_by_bit, COMBINATIONS);
  tcase_add_test(tests, controller);
  tcase_add_loop_test(tests, unsorted, 0, 3);
  suite_add_tcase(suite, tests);
  return suite;
}
