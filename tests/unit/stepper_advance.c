/* mpm_advance(): the sub-steps that it chooses, cuts and grows, and where it ends. */
#include "stepper_parts.h"

static world r;
static mpm_advance_desc d;

/* What the sub-steps were, and what the progress callback is to answer. */
enum { MOST = 4096 };
static struct {
  int32_t n, cancel_at; /* sub-step to be cancelled, from 1 */
  mpm_status answer;
  double dt[MOST], t[MOST];
} seen;

static mpm_status watch(void *user, const mpm_step_info *info) {
  (void)user;
  if (seen.n + 1 == seen.cancel_at) return seen.answer;
  if (seen.n < MOST) {
    seen.dt[seen.n] = info->dt;
    seen.t[seen.n++] = info->t;
  }
  return 0;
}

/* Asks for a smaller step above a limit. */
static struct {
  double limit, tried[64];
  int32_t n;
  mpm_status answer;
} strict;

static mpm_status refuse_long(void *user, const mpm_particle_batch *b, double *add) {
  (void)user, (void)add;
  if (b->dt <= strict.limit) return 0;
  if (strict.n < 64 &&
      (!strict.n || strict.tried[strict.n - 1] > b->dt || strict.tried[strict.n - 1] < b->dt))
    strict.tried[strict.n++] = b->dt;
  return strict.answer;
}

static void open_run(void) {
  memset(&seen, 0, sizeof seen);
  memset(&strict, 0, sizeof strict);
  strict.answer = 1;
  body_open(&r, &(body_desc){.dim = 2});
  ck_ok(&r, mpm_stepper_set_progress(r.stepper, watch, NULL));
  d = advance_desc(0.0);
}
static void close_run(void) {
  world_close(&r);
}

START_TEST(defaults) {
  memset(&d, 0x5a, sizeof d);
  ck_assert_int_eq(mpm_advance_desc_init(NULL, sizeof d), MPM_E_ARG);
  ck_assert_int_eq(mpm_advance_desc_init(&d, sizeof d - 1), MPM_E_ARG);
  ck_ok(NULL, mpm_advance_desc_init(&d, sizeof d));
  ck_assert_uint_eq(d.struct_size, sizeof d);
  ck_assert_double_eq(d.cfl, 0.0);
  ck_assert(d.t_end == 0.0 && d.dt_first == 0.0 && d.dt_min == 0.0 && d.dt_max == 0.0);
  ck_assert_int_eq(d.max_steps, 0);
  ck_assert_int_eq(d.max_cuts, 0);
}
END_TEST

START_TEST(refused_values) {
  ck_ok(&r, mpm_stepper_set_time(r.stepper, 2.0, 5));
  ck_refused(&r, mpm_advance(r.stepper, NULL, NULL), MPM_E_ARG, "desc is NULL");
  const mpm_advance_desc good = {.struct_size = sizeof good, .t_end = 3.0, .cfl = 0.5};
#define REFUSED(field, value, text)                                                                          \
  d = good;                                                                                                  \
  d.field = value;                                                                                           \
  ck_refused(&r, mpm_advance(r.stepper, &d, NULL), MPM_E_ARG, text)
  REFUSED(struct_size, 0, "struct_size is 0");
  REFUSED(max_cuts, -1, "max_cuts is -1");
  REFUSED(t_end, 1.5, "t_end is 1.5");
  REFUSED(t_end, NOT_A_NUMBER, "t_end is nan");
  REFUSED(t_end, INFINITE, "t_end is inf");
  REFUSED(cfl, -0.1, "cfl is -0.1");
  REFUSED(cfl, 1.5, "cfl is 1.5");
  REFUSED(cfl, NOT_A_NUMBER, "cfl is nan");
  REFUSED(dt_first, -1.0, "dt_first is -1");
  REFUSED(dt_first, NOT_A_NUMBER, "dt_first is nan");
  REFUSED(dt_min, -2.0, "dt_min is -2");
  REFUSED(dt_min, INFINITE, "dt_min is inf");
  REFUSED(dt_max, -3.0, "dt_max is -3");
  REFUSED(dt_max, NOT_A_NUMBER, "dt_max is nan");
  REFUSED(max_steps, -1, "max_steps is -1");
  d = good;
  d.dt_min = 0.2;
  d.dt_max = 0.1;
  ck_refused(&r, mpm_advance(r.stepper, &d, NULL), MPM_E_ARG, "dt_min is 0.2");
#undef REFUSED
  ck_ok(&r, mpm_stepper_info(r.stepper, &r.info));
  ck_assert_int_eq(r.info.step, 5);
  for (int32_t m = 0; m < 2; ++m) ck_ok(&r, mpm_stepper_remove(r.stepper, r.set[m]));
  ck_refused(&r, mpm_advance(r.stepper, &good, NULL), MPM_E_STATE, "no particles");
}
END_TEST

/* However the times divide, the end is met to the bit, without a sliver before it. */
START_TEST(ends_exactly) {
  static const double ends[] = {1e-3, 0.01, 0.0100001, 0.0123456789, 1.0 / 77.0};
  for (int32_t i = 0; i < 5; ++i) {
    d.t_end = ends[i];
    d.dt_max = 1e-3;
    seen.n = 0;
    ck_ok(&r, mpm_advance(r.stepper, &d, &r.info));
    ck_assert_double_eq(r.info.t, ends[i]);
    ck_assert_int_gt(seen.n, 0);
    for (int32_t k = 0; k < seen.n; ++k) {
      ck_assert_double_le(seen.dt[k], 1e-3 * (1.0 + 1e-8));
      if (seen.n > 1) ck_assert_double_ge(seen.dt[k], 0.4 * seen.dt[0]);
    }
    const int64_t step = r.info.step;
    seen.n = 0;
    ck_ok(&r, mpm_advance(r.stepper, &d, &r.info)); /* there already */
    ck_assert_int_eq(r.info.step, step);
    ck_assert_int_eq(seen.n, 0);
  }
}
END_TEST

/* Also where t + (t_end - t) is not t_end. */
START_TEST(ends_exactly_whatever_rounds) {
  int32_t rounds = 0;
  for (int32_t i = 0; i < 30; ++i) {
    const double t = -2e-4 * (1.0 + 0.5 * noise_at((uint64_t)i));
    d.t_end = 1e-6 * (1.0 + 0.5 * noise_at((uint64_t)(i + 100)));
    rounds += t + (d.t_end - t) != d.t_end;
    ck_ok(&r, mpm_stepper_set_time(r.stepper, t, 0));
    ck_ok(&r, mpm_advance(r.stepper, &d, &r.info));
    ck_assert_int_eq(r.info.step, 1);
    ck_assert_double_eq(r.info.t, d.t_end);
  }
  ck_assert_int_gt(rounds, 0);
}
END_TEST

/* The sub-step is a share of the stable one of the present state, unless something else is smaller. */
START_TEST(share_of_the_stable_step) {
  double stable;
  d.t_end = 1.0;
  d.max_steps = 1;
  for (int32_t i = 0; i < 4; ++i) {
    d.cfl = 0.1 + 0.05 * i;
    ck_ok(&r, mpm_stable_dt(r.stepper, &stable));
    ck_ok(&r, mpm_advance(r.stepper, &d, &r.info));
    ck_assert_double_eq(r.info.dt, d.cfl * stable);
    ck_assert_int_eq(r.info.step, i + 1);
    ck_ok(&r, mpm_stable_dt(r.stepper, &stable));
    ck_assert_double_eq(r.info.dt_suggested, stable);
  }
  d.dt_max = 0.01 * stable;
  ck_ok(&r, mpm_advance(r.stepper, &d, &r.info));
  ck_assert_double_eq(r.info.dt, 0.01 * stable);
}
END_TEST

/* Where the host leaves the share to the library, it is two thirds of what was found to be stable. */
START_TEST(share_of_the_library) {
  static const struct {
    int32_t basis;
    double usl, usf, musl;
  } stable[] = {{MPM_LINEAR, 0.6, 0.9, 0.9}, {MPM_BSPLINE2, 0.6, 1.0, 1.0}, {MPM_BSPLINE3, 0.9, 1.0, 1.0},
                {MPM_UGIMP, 0.4, 0.7, 0.7},  {MPM_GIMP, 0.4, 0.7, 0.7},     {MPM_CPGIMP, 0.4, 0.5, 0.7}};
  for (size_t i = 0; i < 3 * sizeof stable / sizeof *stable; ++i) {
    static const int32_t scheme[3] = {MPM_USL, MPM_USF, MPM_MUSL};
    const double share[3] = {stable[i / 3].usl, stable[i / 3].usf, stable[i / 3].musl};
    const method how = {.basis = stable[i / 3].basis, .scheme = scheme[i % 3], .flip = 1.0};
    world_desc desc = world_with(&how, 2, 8, 0.25);
    world w;
    mpm_particles *set = world_open(&w, &desc);
    double dt;
    world_fill_cube(&w, set, 0.5, 1.25);
    ck_ok(&w, mpm_stable_dt(w.stepper, &dt));
    ck_ok(&w, mpm_advance_desc_init(&d, sizeof d));
    d.t_end = 10.0 * dt;
    d.max_steps = 1;
    ck_ok(&w, mpm_advance(w.stepper, &d, &w.info));
    ck_within("default share", w.info.dt / dt, share[i % 3] / 1.5, 1e-14);
    world_close(&w);
  }
}
END_TEST

START_TEST(first_and_growth) {
  d.t_end = 1.0;
  d.dt_first = 1e-6;
  d.max_steps = 6;
  ck_ok(&r, mpm_advance(r.stepper, &d, &r.info));
  ck_assert_int_eq(seen.n, 6);
  ck_assert_double_eq(seen.dt[0], 1e-6);
  for (int32_t k = 1; k < 6; ++k) {
    ck_assert_double_gt(seen.dt[k], 1.2 * seen.dt[k - 1]);
    ck_assert_double_lt(seen.dt[k], 4.0 * seen.dt[k - 1]);
  }
  /* and in the next call it goes on from there */
  d.dt_first = 0.0;
  d.max_steps = 1;
  ck_ok(&r, mpm_advance(r.stepper, &d, &r.info));
  ck_assert_double_gt(r.info.dt, 1.2 * seen.dt[5]);
  ck_assert_double_lt(r.info.dt, 4.0 * seen.dt[5]);
}
END_TEST

START_TEST(runs_out_of_steps) {
  d.t_end = 1.0;
  d.max_steps = 7;
  ck_ok(&r, mpm_advance(r.stepper, &d, &r.info));
  ck_assert_int_eq(r.info.step, 7);
  ck_assert_double_lt(r.info.t, 1.0);
  ck_assert_double_eq(r.info.t, seen.t[6]);
  ck_assert_int_eq(r.info.cause, MPM_OK);
}
END_TEST

/* Cut to 0.6 of it until the callback is content; failed tries do not count as sub-steps. */
START_TEST(cuts) {
  strict.limit = 1e-5;
  ck_ok(&r, mpm_stepper_set_force(r.stepper, refuse_long, NULL));
  d.t_end = 1.0;
  d.max_steps = 1;
  ck_ok(&r, mpm_advance(r.stepper, &d, &r.info));
  ck_assert_int_eq(r.info.step, 1);
  ck_assert_int_gt(strict.n, 4);
  for (int32_t k = 1; k < strict.n; ++k) ck_within("cut", strict.tried[k], 0.6 * strict.tried[k - 1], 1e-18);
  ck_within("last cut", r.info.dt, 0.6 * strict.tried[strict.n - 1], 1e-18);
  /* all the way, with cuts in between */
  d.t_end = r.info.t + 2e-4;
  d.max_steps = 0;
  ck_ok(&r, mpm_advance(r.stepper, &d, &r.info));
  ck_assert_double_eq(r.info.t, d.t_end);
  for (int32_t k = 0; k < seen.n; ++k) ck_assert_double_le(seen.dt[k], 1e-5);
}
END_TEST

START_TEST(not_below_dt_min) {
  strict.limit = 1e-9;
  ck_ok(&r, mpm_stepper_set_force(r.stepper, refuse_long, NULL));
  d.t_end = 1.0;
  d.dt_min = 1e-5;
  const uint64_t hash = world_hash(&r);
  for (int32_t again = 0; again < 3; ++again) { /* the bound holds in the next call, too */
    strict.n = 0;
    ck_refused(&r, mpm_advance(r.stepper, &d, &r.info), MPM_CUT_DT, "force callback");
    ck_assert_int_eq(r.info.cause, MPM_CUT_DT);
    ck_assert_int_eq(r.info.callback_status, 1);
    ck_assert_int_eq(r.info.step, 0);
    ck_assert_double_eq(r.info.t, 0.0);
    ck_assert(world_hash(&r) == hash);
    for (int32_t k = 0; k < strict.n; ++k) ck_assert_double_ge(strict.tried[k], 1e-5);
  }
  strict.limit = 1.0;
  d.max_steps = 2;
  ck_ok(&r, mpm_advance(r.stepper, &d, &r.info));
}
END_TEST

/* Without a bound cutting ends too, at t = 0, where every number advances the time: after 60 cuts, or as many
 * as the host grants, for which a sub-step that was committed starts anew. The next call starts where this
 * did. */
START_TEST(cuts_end) {
  ck_ok(&r, mpm_stepper_set_force(r.stepper, refuse_long, NULL));
  d.t_end = 1.0;
  for (int32_t k = 0; k < 3; ++k) {
    static const char *const text[] = {"gave up after 60 cuts", "gave up after 3 cuts", "the force callback"};
    strict.n = 0;
    d.max_cuts = k ? 3 : 0;
    ck_refused(&r, mpm_advance(r.stepper, &d, &r.info), MPM_CUT_DT, text[k]);
    ck_assert_int_eq(strict.n, k ? 4 : 61);
    ck_assert_double_eq(r.info.t, 0.0);
    static double first;
    if (k) ck_assert_double_eq(strict.tried[0], first);
    first = strict.tried[0];
  }
  strict.limit = 0.3 * strict.tried[0]; /* three cuts lead below it, and then one now and then */
  d.max_steps = 20;
  ck_ok(&r, mpm_advance(r.stepper, &d, &r.info));
  ck_assert_int_eq(r.info.step, 20);
}
END_TEST

/* Late in time cutting ends where it no longer moves the clock. The next call starts where this one did, too,
 * and so does one that meets its least dt. */
START_TEST(cuts_end_at_the_clock) {
  ck_ok(&r, mpm_stepper_set_force(r.stepper, refuse_long, NULL));
  for (int32_t k = 0; k < 2; ++k) {
    const double start = k ? 0.0 : 100.0, *tried = strict.tried;
    ck_ok(&r, mpm_stepper_set_time(r.stepper, start, 0));
    d.t_end = start + 1.0;
    d.dt_min = k ? 1e-5 : 0.0;
    double first = 0.0;
    for (int32_t again = 0; again < 2; ++again) {
      strict.n = 0;
      ck_refused(&r, mpm_advance(r.stepper, &d, &r.info), MPM_CUT_DT, "gave up after");
      ck_assert(strstr(last_error_of(&r), "the force callback"));
      ck_assert_int_gt(strict.n, 5);
      ck_assert_int_lt(strict.n, 61);
      if (again) ck_assert_double_eq(tried[0], first);
      first = tried[0];
    }
  }
}
END_TEST

/* A clock that the stable step does not move is an error, not a jump to the end. */
START_TEST(steps_too_small_for_the_clock) {
  ck_ok(&r, mpm_stepper_set_time(r.stepper, 1e18, 3));
  d.t_end = 1e18 + 4096.0;
  ck_refused(&r, mpm_advance(r.stepper, &d, &r.info), MPM_E_ARG, "does not advance the time 1e+18");
  ck_assert_int_eq(r.info.step, 3);
  ck_assert_double_eq(r.info.t, 1e18);
}
END_TEST

/* A failure that no smaller step cures ends the call at the last committed sub-step. */
START_TEST(not_curable) {
  strict.answer = -9;
  ck_ok(&r, mpm_stepper_set_force(r.stepper, refuse_long, NULL));
  d.t_end = 1.0;
  ck_refused(&r, mpm_advance(r.stepper, &d, &r.info), MPM_E_CALLBACK, "returned -9");
  ck_assert_int_eq(strict.n, 1);
  ck_assert_int_eq(r.info.cause, MPM_E_CALLBACK);
  ck_assert_int_eq(r.info.callback_status, -9);
}
END_TEST

/* Cancelled in the middle: what was done stays, and going on gives what it gives without. */
START_TEST(cancelled) {
  world other;
  body_open(&other, &(body_desc){.dim = 2});
  d.t_end = 0.01;
  mpm_advance_desc plain = d;
  ck_ok(&other, mpm_advance(other.stepper, &plain, NULL));
  for (int32_t k = 0; k < 2; ++k) {
    seen.cancel_at = 3 + k;
    seen.answer = k ? -6 : 6;
    ck_refused(&r, mpm_advance(r.stepper, &d, &r.info), k ? MPM_E_CALLBACK : MPM_CANCELLED, "progress");
    ck_assert_int_eq(r.info.cause, k ? MPM_E_CALLBACK : MPM_CANCELLED);
    ck_assert_int_eq(r.info.callback_status, seen.answer);
    ck_assert_int_eq(r.info.step, 2 + k);
    ck_assert_double_eq(r.info.t, seen.t[1 + k]);
  }
  seen.cancel_at = 0;
  ck_ok(&r, mpm_advance(r.stepper, &d, &r.info));
  ck_assert_double_eq(r.info.t, 0.01);
  ck_assert_msg(world_hash(&r) == world_hash(&other), "cancelling has changed the sub-steps that follow");
  world_close(&other);
}
END_TEST

/* Each sub-step asks once, with the info that it is about to have. */
START_TEST(progress) {
  d.t_end = 0.005;
  ck_ok(&r, mpm_advance(r.stepper, &d, &r.info));
  ck_assert_int_eq(seen.n, r.info.step);
  double t = 0.0;
  for (int32_t k = 0; k < seen.n; ++k) {
    ck_within("time in the progress callback", seen.t[k], t + seen.dt[k], 1e-17);
    t = seen.t[k];
  }
  ck_within("last time", t, 0.005, 1e-17);
}
END_TEST

TCase *stepper_advance_case(void) {
  TCase *tests = tcase_create("advance");
  tcase_set_timeout(tests, 60);
  tcase_add_checked_fixture(tests, open_run, close_run);
  tcase_add_test(tests, defaults);
  tcase_add_test(tests, refused_values);
  tcase_add_test(tests, ends_exactly);
  tcase_add_test(tests, ends_exactly_whatever_rounds);
  tcase_add_test(tests, share_of_the_stable_step);
  tcase_add_test(tests, share_of_the_library);
  tcase_add_test(tests, first_and_growth);
  tcase_add_test(tests, runs_out_of_steps);
  tcase_add_test(tests, cuts);
  tcase_add_test(tests, not_below_dt_min);
  tcase_add_test(tests, cuts_end_at_the_clock);
  tcase_add_test(tests, cuts_end);
  tcase_add_test(tests, steps_too_small_for_the_clock);
  tcase_add_test(tests, not_curable);
  tcase_add_test(tests, cancelled);
  tcase_add_test(tests, progress);
  return tests;
}
