/* How blocks are given to parts: by counts or by time, without a bit of the results. */
#define _POSIX_C_SOURCE 200809L /* nanosleep */
#include "shared.h"

#include <time.h>

static const mpm_balance_desc balances[] = {{sizeof(mpm_balance_desc), 0, 1.0, 0.0},
                                            {sizeof(mpm_balance_desc), 1, 1.0, 1e-3},
                                            {sizeof(mpm_balance_desc), 1, 1.3, 1e6},
                                            {sizeof(mpm_balance_desc), 0, (double)INFINITY, 60.0}};

/* The settings change while it goes on; _i of the test is in the speed. */
static mpm_status fly_balanced(world *w, const scene *is, outcome *found) {
  const mpm_balance_desc *balance = &balances[(int32_t)is->speed % 10];
  mpm_status status = mpm_stepper_set_balance(w->stepper, balance);
  if (!status) status = fly_through(w, is, found);
  if (!status && balance->limit > 2.0) return MPM_OK; /* cut once, and never again */
  if (!status) status = mpm_stepper_set_balance(w->stepper, NULL);
  return status ? status : run_steps(w);
}

/* With the default, or with a limit: then it is no matter what a cut gains. */
static mpm_status fly_balanced_by(world *w, const scene *is, outcome *found) {
  const mpm_balance_desc limited = {sizeof limited, 0, 1.1, 0.0};
  const mpm_status status = mpm_stepper_set_balance(w->stepper, is->seed ? &limited : NULL);
  return status ? status : fly_through(w, is, found);
}

START_TEST(balance_changes_no_bit) {
  scene is = scene_of(2, 4 * WIDE, set_up_body), many;
  is.desc.grid.periodic[0] = 1;
  is.run = fly_balanced;
  is.speed = 30.0 + _i;
  many = is;
  check_scene(&is, "balance", 3);
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  ck_assert_int_eq(parts_run(3, live, &many, &plan), 0);
  const int64_t cuts = many.found[0].parallel.cuts, sorts = many.found[0].info.resorts;
  ck_assert_int_gt(sorts, 6);
  if (balances[_i].limit > 2.0)
    ck_assert_int_eq(cuts, 1);
  else if (balances[_i].limit < 1.1)
    ck_assert_int_gt(cuts, sorts / 2);
}
END_TEST

START_TEST(default_cuts_where_it_pays) {
  static scene is[2];
  for (int32_t k = 0; k < 2; ++k) {
    parts_plan plan;
    memset(&plan, 0, sizeof plan);
    is[k] = scene_of(2, 6 * WIDE, set_up_body);
    is[k].desc.grid.periodic[0] = 1;
    is[k].run = fly_balanced_by;
    is[k].speed = 30.0;
    is[k].seed = (uint64_t)k;
    ck_assert_int_eq(parts_run(5, live, &is[k], &plan), 0);
  }
  const mpm_parallel_info *usual = &is[0].found[0].parallel, *limited = &is[1].found[0].parallel;
  show("cuts %lld and %lld, imbalance %g and %g\n", (long long)usual->cuts, (long long)limited->cuts,
       usual->imbalance, limited->imbalance);
  ck_assert_uint_eq(is[0].found[0].hash, is[1].found[0].hash);
  ck_assert_int_gt(usual->cuts, 4);
  ck_assert_int_gt(limited->cuts, 3 * usual->cuts);
  ck_between("imbalance", usual->imbalance, 1.0, 1.2);
}
END_TEST

/* A body of a few blocks that three parts cannot share evenly, and that is sorted in every step. */
enum { SORTS = 60 };
static mpm_status sort_often(world *w, const scene *is, outcome *found) {
  const mpm_balance_desc never = {sizeof never, 0, (double)INFINITY, 0.0};
  double dt;
  mpm_status status = mpm_stepper_set_balance(w->stepper, is->seed ? &never : NULL);
  if (!status) status = mpm_stable_dt(w->stepper, &dt);
  for (int32_t i = 0; i < SORTS && !status; ++i) {
    const int64_t own = mpm_particles_count(w->set[0]);
    double *x = calloc((size_t)(2 * own + 1), sizeof *x);
    status = mpm_particles_get(w->set[0], "position", MPM_F64, 2, own, NULL, x);
    if (!status) status = mpm_particles_set(w->set[0], "position", MPM_F64, 2, own, NULL, x);
    if (!status) status = mpm_step(w->stepper, 0.01 * dt, NULL);
    free(x);
  }
  (void)found;
  return status;
}

static mpm_status set_up_few(world *w, const scene *is) {
  (void)is;
  return fill_middle(w, w->set[0], 0.3, 0.6);
}

START_TEST(cuts_that_do_not_pay_are_seldom_looked_for) {
  static scene is[2];
  int64_t calls[2], sorts[2];
  for (int32_t k = 0; k < 2; ++k) {
    parts_plan plan;
    memset(&plan, 0, sizeof plan);
    is[k] = scene_of(2, 2 * WIDE, set_up_few);
    is[k].run = sort_often;
    is[k].seed = (uint64_t)k;
    ck_assert_msg(!parts_run(3, live, &is[k], &plan), "%s", plan.text);
    ck_assert_msg(!is[k].found[0].status, "%s", is[k].found[0].text);
    calls[k] = plan.calls[0];
    sorts[k] = is[k].found[0].info.resorts;
  }
  show("%lld and %lld calls in %lld sorts, imbalance %g\n", (long long)calls[0], (long long)calls[1],
       (long long)sorts[0], is[0].found[0].parallel.imbalance);
  ck_assert_uint_eq(is[0].found[0].hash, is[1].found[0].hash);
  ck_assert_double_gt(is[0].found[0].parallel.imbalance, 1.1);
  ck_assert_int_eq(is[0].found[0].parallel.cuts, 1);
  ck_assert_int_ge(sorts[0], SORTS);
  /* each takes a reduction for every bit of a key; they are looked for when the steps have doubled */
  ck_assert_int_lt(calls[0] - calls[1], 2 * SORTS);
}
END_TEST

/* A state does not have the settings, and those that are there stay. */
static mpm_status load_and_fly(world *w, const scene *is, outcome *found) {
  saved_state state = {NULL, 0};
  mpm_status status = mpm_stepper_set_balance(w->stepper, &balances[3]);
  if (!status) status = run_steps(w);
  if (!status) status = mpm_state_size(w->stepper, &state.bytes);
  if (!status) state.data = malloc((size_t)state.bytes);
  if (!status) status = mpm_state_save(w->stepper, state.data, state.bytes);
  const void *const piece[] = {state.data};
  if (!status) status = mpm_state_load_pieces(w->stepper, 1, piece, &state.bytes);
  free(state.data);
  return status ? status : fly_through(w, is, found);
}

START_TEST(balance_stays_with_a_state) {
  scene is = scene_of(2, 4 * WIDE, set_up_body), many;
  is.desc.grid.periodic[0] = 1;
  is.run = load_and_fly;
  is.speed = 30.0;
  many = is;
  check_scene(&is, "loaded", 3);
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  ck_assert_int_eq(parts_run(3, live, &many, &plan), 0);
  ck_assert_int_eq(many.found[0].parallel.cuts, 2); /* of the first sort, and of loading */
  ck_assert_int_gt(many.found[0].info.resorts, 6);
}
END_TEST

/* A host whose particles are slow on one side: it sleeps for each of them, and counts them. */
enum { SLOW_STEPS = 40, COUNTED = 8 };
typedef struct slow_side {
  scene is;
  int32_t measure;
  int64_t slept[3];
} slow_side;
typedef struct slow_part {
  int64_t slept;
  double speed;
} slow_part;

static mpm_status be_slow(void *user, const mpm_particle_batch *batch, double *force) {
  slow_part *part = user;
  int64_t slow = 0;
  (void)force;
  for (int64_t p = 0; p < batch->n; ++p)
    slow += batch->id[p] >= 0 && batch->position[p] - part->speed * batch->t < 0.35;
  part->slept += slow;
  const struct timespec time = {.tv_nsec = 30000 * (long)slow};
  nanosleep(&time, NULL);
  return MPM_OK;
}

/* One particle in each cell, so that sleeping takes most of the time. */
static mpm_status set_up_thin(world *w, const scene *is) {
  const double low[] = {0.2, 0.2}, high[] = {0.7, 0.7};
  const int32_t per_cell[] = {1, 1};
  const mpm_status status = mpm_particles_fill_box(w->set[0], low, high, per_cell, NULL, NULL);
  return status ? status : set_velocities(w, w->set[0], is->speed);
}

static void live_slow(int32_t part, const mpm_transport *transport, void *user) {
  slow_side *side = user;
  outcome *found = &side->is.found[part];
  slow_part mine = {0, side->is.speed};
  mpm_balance_desc balance;
  world w;
  double dt;
  memset(&w, 0, sizeof w);
  w.desc = side->is.desc;
  w.desc.context.transport = transport;
  mpm_status status = world_try_open(&w);
  if (!status) status = set_up_thin(&w, &side->is);
  if (!status) status = mpm_stepper_set_force(w.stepper, be_slow, &mine);
  if (!status) status = mpm_balance_desc_init(&balance, sizeof balance);
  balance.measure = side->measure;
  if (!status) status = mpm_stepper_set_balance(w.stepper, &balance);
  if (!status) status = mpm_stable_dt(w.stepper, &dt);
  for (int32_t i = 0; i < SLOW_STEPS && !status; ++i) {
    if (i == SLOW_STEPS - COUNTED) mine.slept = 0;
    status = mpm_step(w.stepper, 0.3 * dt, NULL);
  }
  side->slept[part] = mine.slept;
  found->parallel.struct_size = sizeof found->parallel;
  if (!status) status = mpm_stepper_parallel_info(w.stepper, 0, &found->parallel);
  if (!status) status = mpm_state_hash(w.stepper, &found->hash);
  if (status) snprintf(found->text, sizeof found->text, "%s", mpm_last_error(w.context));
  found->status = status;
  world_try_close(&w);
}

/* Returns the largest time of a part over the mean, as the host has slept. */
static double uneven_time(int32_t parts, int32_t measure, uint64_t *hash) {
  static slow_side side;
  parts_plan plan;
  memset(&side, 0, sizeof side);
  memset(&plan, 0, sizeof plan);
  side.is = scene_of(2, 6 * WIDE, set_up_thin);
  side.is.speed = 20.0;
  side.measure = measure;
  ck_assert_msg(!parts_run(parts, live_slow, &side, &plan), "%s", plan.text);
  int64_t largest = 0, total = 0;
  for (int32_t r = 0; r < parts; ++r) {
    ck_assert_msg(!side.is.found[r].status, "part %d: %s", r, side.is.found[r].text);
    if (side.slept[r] > largest) largest = side.slept[r];
    total += side.slept[r];
  }
  ck_assert_int_gt(total, 1000);
  *hash = side.is.found[0].hash;
  show("%d parts, measure %d: %lld %lld %lld, cuts %lld, imbalance %g\n", parts, measure,
       (long long)side.slept[0], (long long)side.slept[1], (long long)side.slept[2],
       (long long)side.is.found[0].parallel.cuts, side.is.found[0].parallel.imbalance);
  return (double)largest * parts / (double)total;
}

START_TEST(measured_time_evens_out) {
  const int32_t parts = 2 + _i;
  uint64_t plain_hash, measured_hash;
  const double plain = uneven_time(parts, 0, &plain_hash), measured = uneven_time(parts, 1, &measured_hash);
  ck_assert_uint_eq(plain_hash, measured_hash);
  ck_between("plain", plain, 1.8, 3.0);
  /* what is not slept is measured as well, and blocks are few */
  ck_between("measured", measured, 1.0, 1.0 + 0.6 * (plain - 1.0));
}
END_TEST

/* All parts must give the same. */
static mpm_status unlike_balance(world *w, const scene *is, outcome *found) {
  int32_t part = 0, parts = 1;
  mpm_balance_desc d;
  (void)is, (void)found;
  mpm_context_part(w->context, &part, &parts);
  if (mpm_balance_desc_init(&d, sizeof d)) return MPM_E_INTERNAL;
  d.limit = part == 1 ? 1.5 : 1.2;
  if (mpm_stepper_set_balance(w->stepper, &d) != MPM_E_ARG ||
      !strstr(mpm_last_error(w->context), "limit is 1."))
    return MPM_E_INTERNAL;
  d.limit = part == 1 ? 0.9 : 1.2;
  if (mpm_stepper_set_balance(w->stepper, &d) != MPM_E_ARG ||
      !strstr(mpm_last_error(w->context), "limit is 0.9: it must be 0, or at least 1"))
    return MPM_E_INTERNAL;
  return run_steps(w);
}

START_TEST(balance_is_alike) {
  scene is = scene_of(2, 2 * WIDE, set_up_body);
  is.run = unlike_balance;
  check_parts(&is, 3);
}
END_TEST

START_TEST(balance_is_checked) {
  world w;
  mpm_balance_desc d;
  world_desc desc = world_default(2, 8, 0.25);
  world_open(&w, &desc);
  ck_ok(&w, mpm_balance_desc_init(&d, sizeof d));
  ck_assert(d.measure == 0 && d.limit == 0.0 && d.block_weight == 0.0);
  ck_ok(&w, mpm_stepper_set_balance(w.stepper, &d));
  ck_ok(&w, mpm_stepper_set_balance(w.stepper, NULL));
  d.measure = 2;
  ck_refused(&w, mpm_stepper_set_balance(w.stepper, &d), MPM_E_ARG, "measure is 2");
  d.measure = 1;
  d.limit = 0.99;
  ck_refused(&w, mpm_stepper_set_balance(w.stepper, &d), MPM_E_ARG, "limit is 0.99");
  d.limit = NOT_A_NUMBER;
  ck_refused(&w, mpm_stepper_set_balance(w.stepper, &d), MPM_E_ARG, "limit is nan");
  d.limit = 1.0;
  d.block_weight = -1.0;
  ck_refused(&w, mpm_stepper_set_balance(w.stepper, &d), MPM_E_ARG, "block_weight is -1");
  d.block_weight = 2e6;
  ck_refused(&w, mpm_stepper_set_balance(w.stepper, &d), MPM_E_ARG, "block_weight is 2e+06");
  d.block_weight = 1.0;
  d.struct_size = 4;
  ck_refused(&w, mpm_stepper_set_balance(w.stepper, &d), MPM_E_ARG, "struct_size is 4");
  d.struct_size = sizeof d;
  world_fill_cube(&w, w.set[0], 0.5, 1.0);
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-5));
  ck_refused(&w, mpm_stepper_set_balance(w.stepper, &d), MPM_E_STATE, "");
  ck_ok(&w, mpm_step_abort(w.stepper));
  world_close(&w);
}
END_TEST

/* What depends on the clock, for quiet machines. */
TCase *shared_timed_case(void) {
  TCase *tests = tcase_create("timed");
  tcase_set_tags(tests, "clock");
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, measured_time_evens_out, 0, 2);
  return tests;
}

TCase *shared_balance_case(void) {
  TCase *tests = tcase_create("balance");
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, balance_changes_no_bit, 0, 4);
  tcase_add_test(tests, balance_stays_with_a_state);
  tcase_add_test(tests, default_cuts_where_it_pays);
  tcase_add_test(tests, cuts_that_do_not_pay_are_seldom_looked_for);
  tcase_add_test(tests, balance_is_alike);
  tcase_add_test(tests, balance_is_checked);
  return tests;
}
