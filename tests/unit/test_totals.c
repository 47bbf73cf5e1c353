/* Sums over steps: impulses of walls and prescribed particles, and the external work. */
#include "body.h"

typedef struct totals {
  double wall[6][3], particles[2][3], work;
} totals;

static totals totals_of(const world *w) {
  totals t = {.work = world_info(w).external_work_total};
  for (int32_t face = 0; face < 2 * w->dim; ++face)
    ck_ok(w, mpm_stepper_wall_impulse(w->stepper, face, t.wall[face]));
  for (int32_t m = 0; m < w->sets && m < 2; ++m)
    ck_ok(w, mpm_stepper_particles_impulse(w->stepper, w->set[m], t.particles[m]));
  return t;
}

static void same_totals(const totals *a, const totals *b) {
  ck_assert_mem_eq(a, b, sizeof *a);
}

/* Adds what the last step reports. */
static void add_step(const world *w, double dt, totals *sum) {
  double force[3];
  sum->work += w->info.external_work;
  for (int32_t face = 0; face < 2 * w->dim; ++face) {
    ck_ok(w, mpm_stepper_wall_reaction(w->stepper, face, force));
    for (int32_t c = 0; c < w->dim; ++c) sum->wall[face][c] += dt * force[c];
  }
  for (int32_t m = 0; m < 2; ++m) {
    ck_ok(w, mpm_stepper_particles_reaction(w->stepper, w->set[m], force));
    for (int32_t c = 0; c < w->dim; ++c) sum->particles[m][c] += dt * force[c];
  }
}

static void totals_within(const char *name, const totals *a, const totals *wanted) {
  const double *x = (const double *)a, *y = (const double *)wanted;
  const int64_t n = (int64_t)(sizeof *a / sizeof *x);
  const double scale = largest(n, y);
  ck_assert_double_gt(scale, 0.0);
  for (int64_t i = 0; i < n; ++i) ck_within(name, x[i], y[i], 1e-13 * scale);
}

/* Every method, whole steps and steps in parts, between all kinds of walls with prescribed particles. */
START_TEST(sums_of_reactions) {
  const method *how = broad_methods[_i];
  const int32_t implicit = how->scheme == MPM_NEWMARK;
  world w;
  body_open(&w, &(body_desc){.dim = 2, .method = *how, .led = 1});
  totals sum = {.work = 0.0}, none = {.work = 0.0}, now = totals_of(&w);
  same_totals(&now, &none);
  for (int32_t i = 0; i < 6; ++i) {
    if (i % 2 && !implicit)
      world_staged_step(&w, BODY_DT);
    else
      world_steps(&w, 1);
    add_step(&w, BODY_DT, &sum);
    now = totals_of(&w);
    totals_within(how->name, &now, &sum);
    ck_assert_double_eq(w.info.external_work_total, now.work);
  }
  ck_ok(&w, mpm_stepper_set_time(w.stepper, 0.0, 0));
  now = totals_of(&w);
  same_totals(&now, &none);
  world_steps(&w, 1);
  sum = none;
  add_step(&w, BODY_DT, &sum);
  now = totals_of(&w);
  totals_within(how->name, &now, &sum);
  world_close(&w);
}
END_TEST

/* Staggered steps: forces act from the middle of the last step to the middle of this one. */
START_TEST(staggered_steps) {
  method how = methods[_i];
  how.staggered = 1;
  world w;
  body_open(&w, &(body_desc){.dim = 2, .method = how, .led = 1});
  totals sum = {.work = 0.0};
  double last = BODY_DT;
  for (int32_t i = 0; i < 6; ++i) {
    const double dt = BODY_DT / (double)(1 + i % 3);
    world_step(&w, dt);
    add_step(&w, 0.5 * (last + dt), &sum);
    last = dt;
  }
  const totals now = totals_of(&w);
  totals_within(how.name, &now, &sum);
  world_close(&w);
}
END_TEST

/* A block falls on a floor: its momentum is the impulse of weight and floor, without a loop of the host's. */
START_TEST(impulse_of_a_floor) {
  const double g = 10.0;
  world_desc desc = world_with(&methods[_i], 2, 12, 0.25);
  desc.stepper.gravity[1] = -g;
  world w;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {1.0, 0.05}, high[] = {2.0, 1.05};
  world_fill(&w, set, low, high, 2);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FRICTION, 0.0));
  mpm_advance_desc go = advance_desc(0.2);
  mpm_step_info info = {.struct_size = sizeof info};
  double impulse[2];
  ck_ok(&w, mpm_advance(w.stepper, &go, &info));
  ck_ok(&w, mpm_stepper_wall_impulse(w.stepper, MPM_Y_MIN, impulse));
  const double weight = g * mass_of(&w, set);
  ck_assert_double_gt(impulse[1], 0.5 * weight * info.t);
  ck_within(methods[_i].name, impulse[1] - weight * info.t, info.momentum[1], 1e-12 * weight * info.t);
  ck_within(methods[_i].name, impulse[0], 0.0, 1e-12 * weight * info.t);
  world_close(&w);
}
END_TEST

static mpm_status refuse(void *user, const mpm_particle_batch *b, double *add) {
  (void)user, (void)b, (void)add;
  return MPM_CUT_DT;
}

START_TEST(kept_and_dropped) {
  world w, other;
  const body_desc of = {.dim = 2, .method = methods[_i], .led = 1};
  body_open(&w, &of);
  world_steps(&w, 3);
  const totals was = totals_of(&w);
  /* steps that fail or are given up */
  ck_ok(&w, mpm_stepper_set_force(w.stepper, refuse, NULL));
  ck_assert_int_eq(mpm_step(w.stepper, BODY_DT, &w.info), MPM_CUT_DT);
  ck_assert_double_eq(w.info.external_work_total, was.work);
  totals now = totals_of(&w);
  same_totals(&now, &was);
  ck_ok(&w, mpm_stepper_set_force(w.stepper, NULL, NULL));
  ck_ok(&w, mpm_step_begin(w.stepper, BODY_DT));
  ck_ok(&w, mpm_step_grid(w.stepper));
  ck_ok(&w, mpm_step_abort(w.stepper));
  now = totals_of(&w);
  same_totals(&now, &was);
  /* a saved state has them */
  body_open(&other, &of);
  world_steps(&other, 1);
  world_copy(&w, &other);
  now = totals_of(&other);
  same_totals(&now, &was);
  world_close(&other);
  /* those of a set go with it */
  ck_ok(&w, mpm_stepper_remove(w.stepper, w.set[1]));
  double impulse[3];
  ck_refused(&w, mpm_stepper_particles_impulse(w.stepper, w.set[1], impulse), MPM_E_NOT_FOUND,
             "not in this stepper");
  ck_ok(&w, mpm_stepper_add(w.stepper, w.set[1]));
  now = totals_of(&w);
  for (int32_t c = 0; c < 3; ++c) ck_assert_double_eq(now.particles[1][c], 0.0);
  ck_assert_mem_eq(now.wall, was.wall, sizeof was.wall);
  world_close(&w);
}
END_TEST

START_TEST(refusals) {
  world w;
  double impulse[3];
  body_open(&w, &(body_desc){.dim = 2});
  ck_refused(&w, mpm_stepper_wall_impulse(w.stepper, -1, impulse), MPM_E_ARG, "face is -1");
  ck_refused(&w, mpm_stepper_wall_impulse(w.stepper, 4, impulse), MPM_E_ARG, "face is 4");
  ck_refused(&w, mpm_stepper_wall_impulse(w.stepper, 0, NULL), MPM_E_ARG, "impulse is NULL");
  ck_refused(&w, mpm_stepper_particles_impulse(w.stepper, w.set[0], NULL), MPM_E_ARG, "impulse is NULL");
  ck_refused(&w, mpm_stepper_particles_impulse(w.stepper, NULL, impulse), MPM_E_ARG, "particles is NULL");
  world_close(&w);
}
END_TEST

Suite *totals_suite(void);
Suite *totals_suite(void) {
  Suite *suite = suite_create("totals");
  TCase *sums = tcase_create("sums"), *state = tcase_create("state");
  tcase_add_loop_test(sums, sums_of_reactions, 0, BROAD);
  tcase_add_loop_test(sums, staggered_steps, 0, METHODS);
  tcase_add_loop_test(sums, impulse_of_a_floor, 0, METHODS);
  tcase_add_loop_test(state, kept_and_dropped, 0, METHODS);
  tcase_add_test(state, refusals);
  tcase_set_timeout(sums, 60);
  suite_add_tcase(suite, sums);
  suite_add_tcase(suite, state);
  return suite;
}
