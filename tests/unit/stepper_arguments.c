/* Every call of a stepper with arguments, or at a time, that it must refuse. */
#include "stepper_parts.h"

static world r;

static void open_run(void) {
  body_open(&r, &(body_desc){.dim = 2});
}
static void close_run(void) {
  world_close(&r);
}

static mpm_view mapped(const char *field, int32_t access) {
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(&r, mpm_particles_map(r.set[0], field, access, &view));
  return view;
}

START_TEST(no_stepper) {
  const mpm_advance_desc advance = {.struct_size = sizeof advance};
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_profile profile = {.struct_size = sizeof profile};
  mpm_contact_info contact = {.struct_size = sizeof contact};
  int32_t body;
  mpm_view view = {.struct_size = sizeof view};
  mpm_stepper *const none[] = {NULL, (mpm_stepper *)r.grid, (mpm_stepper *)r.context};
  double value[3];
  for (int32_t i = 0; i < 3; ++i) {
    mpm_stepper *s = none[i];
    if (s) ck_assert_int_eq(mpm_stepper_destroy(s), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_add(s, r.set[0]), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_remove(s, r.set[0]), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_set_time(s, 0.0, 0), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_set_wall(s, 0, MPM_WALL_SLIP, 0.0), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_set_acceleration(s, NULL, NULL), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_set_force(s, NULL, NULL), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_set_velocity_bc(s, NULL, NULL), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_set_progress(s, NULL, NULL), MPM_E_ARG);
    ck_assert_int_eq(mpm_stable_dt(s, value), MPM_E_ARG);
    ck_assert_int_eq(mpm_step(s, 1e-3, &info), MPM_E_ARG);
    ck_assert_int_eq(mpm_step_begin(s, 1e-3), MPM_E_ARG);
    ck_assert_int_eq(mpm_step_grid(s), MPM_E_ARG);
    ck_assert_int_eq(mpm_step_end(s, &info), MPM_E_ARG);
    ck_assert_int_eq(mpm_step_abort(s), MPM_E_ARG);
    ck_assert_int_eq(mpm_advance(s, &advance, &info), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_profile(s, 0, &profile), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_info(s, &info), MPM_E_ARG);
    ck_assert_int_eq(mpm_grid_map(s, 0, "mass", MPM_READ, &view), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_wall_reaction(s, 0, value), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_wall_impulse(s, 0, value), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_set_body(s, r.set[0], 0), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_body(s, r.set[0], &body), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_set_contact(s, 0, 1, NULL), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_set_friction(s, NULL, NULL), MPM_E_ARG);
    ck_assert_int_eq(mpm_stepper_contact_info(s, 0, 1, &contact), MPM_E_ARG);
    ck_assert_int_eq(mpm_write_body_grid(s, 0, "none.vti", 0, NULL), MPM_E_ARG);
  }
}
END_TEST

START_TEST(sets) {
  mpm_stepper *other;
  world elsewhere;
  body_open(&elsewhere, &(body_desc){.dim = 2});
  ck_ok(&r, mpm_stepper_create(r.context, r.grid, NULL, &other));
  ck_refused(&r, mpm_stepper_add(r.stepper, NULL), MPM_E_ARG, "particles is NULL");
  ck_refused(&r, mpm_stepper_add(r.stepper, (mpm_particles *)r.grid), MPM_E_ARG, "particles");
  ck_refused(&r, mpm_stepper_add(r.stepper, elsewhere.set[0]), MPM_E_ARG, "another context");
  ck_refused(&r, mpm_stepper_add(r.stepper, r.set[0]), MPM_E_STATE, "this stepper");
  ck_refused(&r, mpm_stepper_add(other, r.set[0]), MPM_E_STATE, "another stepper");
  ck_refused(&r, mpm_stepper_remove(other, r.set[0]), MPM_E_NOT_FOUND, "not in this stepper");
  ck_refused(&r, mpm_stepper_remove(r.stepper, NULL), MPM_E_NOT_FOUND, "not in this stepper");
  mpm_view view = mapped("mass", MPM_READ);
  ck_refused(&r, mpm_stepper_remove(r.stepper, r.set[0]), MPM_E_STATE, "mapped");
  ck_refused(&r, mpm_stepper_destroy(r.stepper), MPM_E_STATE, "mapped");
  ck_ok(&r, mpm_view_release(&view));
  ck_ok(&r, mpm_stepper_remove(r.stepper, r.set[0]));
  ck_refused(&r, mpm_stepper_remove(r.stepper, r.set[0]), MPM_E_NOT_FOUND, "not in this stepper");
  view = mapped("mass", MPM_READ);
  ck_refused(&r, mpm_stepper_add(r.stepper, r.set[0]), MPM_E_STATE, "mapped");
  ck_ok(&r, mpm_view_release(&view));
  ck_ok(&r, mpm_stepper_add(other, r.set[0]));
  ck_ok(&r, mpm_stepper_destroy(other)); /* lets its sets go */
  ck_ok(&r, mpm_stepper_add(r.stepper, r.set[0]));
  world_close(&elsewhere);

  const mpm_grid_desc d = grid_desc(2, 4, 1.0);
  mpm_grid *grid;
  mpm_particles *set;
  ck_ok(&r, mpm_grid_create(r.context, &d, &grid));
  ck_ok(&r, mpm_particles_create(r.context, grid, r.material[0], &set));
  ck_refused(&r, mpm_stepper_add(r.stepper, set), MPM_E_ARG, "another grid");
  ck_ok(&r, mpm_particles_destroy(set));
  ck_ok(&r, mpm_grid_destroy(grid));
}
END_TEST

START_TEST(times) {
  world_steps(&r, 2);
  ck_refused(&r, mpm_stepper_set_time(r.stepper, NOT_A_NUMBER, 3), MPM_E_ARG, "t is nan");
  ck_refused(&r, mpm_stepper_set_time(r.stepper, INFINITE, 3), MPM_E_ARG, "t is inf");
  ck_refused(&r, mpm_stepper_set_time(r.stepper, 1.0, -4), MPM_E_ARG, "step is -4");
  world_steps(&r, 1);
  ck_assert_int_eq(r.info.step, 3);
  ck_ok(&r, mpm_stepper_set_time(r.stepper, -7.5, 100));
  world_steps(&r, 1);
  ck_assert_int_eq(r.info.step, 101);
  ck_assert_double_eq(r.info.t, -7.5 + BODY_DT);
}
END_TEST

START_TEST(walls) {
#define REFUSED(text, ...) ck_refused(&r, mpm_stepper_set_wall(r.stepper, __VA_ARGS__), MPM_E_ARG, text)
  REFUSED("face is -1", -1, MPM_WALL_SLIP, 0.0);
  REFUSED("face is 4", MPM_Z_MIN, MPM_WALL_SLIP, 0.0);
  REFUSED("kind is -1", MPM_X_MIN, -1, 0.0);
  REFUSED("kind is 6", MPM_X_MIN, 6, 0.0);
  REFUSED("friction is -0.5", MPM_X_MIN, MPM_WALL_FRICTION, -0.5);
  REFUSED("friction is nan", MPM_X_MIN, MPM_WALL_FRICTION, NOT_A_NUMBER);
  REFUSED("friction is inf", MPM_X_MIN, MPM_WALL_FRICTION, INFINITE);
#undef REFUSED
  ck_ok(&r, mpm_stepper_set_wall(r.stepper, MPM_X_MIN, MPM_WALL_SLIP, NOT_A_NUMBER)); /* not used */
  world_steps(&r, 1);
  world other;
  body_open(&other, &(body_desc){.dim = 2, .periodic = 1});
  for (int32_t kind = MPM_WALL_OPEN; kind <= MPM_WALL_FRICTION_NODES; ++kind)
    for (int32_t face = MPM_X_MIN; face <= MPM_X_MAX; ++face)
      ck_refused(&other, mpm_stepper_set_wall(other.stepper, face, kind, 0.0), MPM_E_ARG, "periodic");
  world_close(&other);
}
END_TEST

START_TEST(reactions) {
  double force[3] = {7.0, 7.0, 7.0};
  ck_refused(&r, mpm_stepper_wall_reaction(r.stepper, MPM_Y_MIN, force), MPM_E_STATE, "no step");
  world_steps(&r, 1);
  ck_refused(&r, mpm_stepper_wall_reaction(r.stepper, -1, force), MPM_E_ARG, "face is -1");
  ck_refused(&r, mpm_stepper_wall_reaction(r.stepper, 4, force), MPM_E_ARG, "face is 4");
  ck_refused(&r, mpm_stepper_wall_reaction(r.stepper, 0, NULL), MPM_E_ARG, "force is NULL");
  ck_assert_double_eq(force[0], 7.0);
  ck_ok(&r, mpm_stepper_wall_reaction(r.stepper, MPM_Y_MIN, force));
  ck_assert_double_gt(force[1], 0.0);
  ck_assert_double_eq(force[2], 7.0); /* [dim] */
}
END_TEST

START_TEST(stable_dt_of_what) {
  double dt = -1.0;
  ck_refused(&r, mpm_stable_dt(r.stepper, NULL), MPM_E_ARG, "dt is NULL");
  mpm_view view = mapped("velocity", MPM_READ);
  ck_refused(&r, mpm_stable_dt(r.stepper, &dt), MPM_E_STATE, "mapped");
  ck_ok(&r, mpm_view_release(&view));
  for (int32_t m = 0; m < 2; ++m) ck_ok(&r, mpm_stepper_remove(r.stepper, r.set[m]));
  ck_refused(&r, mpm_stable_dt(r.stepper, &dt), MPM_E_STATE, "no particles");
  ck_assert_double_eq(dt, -1.0);
}
END_TEST

/* Speeds whose ratio to the spacing overflows leave no stable step, which is not 0. */
START_TEST(no_stable_dt) {
  const double fast[] = {1.7e308, 0.0, 0.0};
  double dt = -1.0;
  ck_ok(&r, mpm_particles_set_all(r.set[1], "velocity", MPM_F64, r.dim, fast));
  ck_refused(&r, mpm_stable_dt(r.stepper, &dt), MPM_NONFINITE, "over the spacing");
  ck_assert_double_eq(dt, -1.0);
}
END_TEST

START_TEST(steps) {
  static const struct {
    double dt;
    const char *text;
  } list[] = {
      {0.0, "dt is 0"}, {-1e-3, "dt is -0.001"}, {NOT_A_NUMBER, "dt is nan"}, {INFINITE, "dt is inf"}};
  mpm_step_info info = {.struct_size = sizeof info};
  for (int32_t i = 0; i < 4; ++i) {
    ck_refused(&r, mpm_step(r.stepper, list[i].dt, &info), MPM_E_ARG, list[i].text);
    ck_assert_int_eq(info.cause, MPM_E_ARG);
    ck_assert_int_eq(info.step, 0);
    ck_refused(&r, mpm_step_begin(r.stepper, list[i].dt), MPM_E_ARG, list[i].text);
  }
  ck_ok(&r, mpm_stepper_set_time(r.stepper, 1e10, 0));
  ck_refused(&r, mpm_step(r.stepper, 1e-8, NULL), MPM_E_ARG, "does not advance");
}
END_TEST

/* A struct_size that cannot be served is found before the step, not after it. */
START_TEST(infos) {
  static const uint32_t sizes[] = {0, 3, 1u << 20, UINT32_MAX};
  mpm_step_info info;
  ck_refused(&r, mpm_stepper_info(r.stepper, NULL), MPM_E_ARG, "info is NULL");
  const uint64_t hash = world_hash(&r);
  for (int32_t i = 0; i < 4; ++i) {
    const mpm_advance_desc d = advance_desc(1.0);
    info.struct_size = sizes[i];
    ck_refused(&r, mpm_stepper_info(r.stepper, &info), MPM_E_ARG, "struct_size");
    ck_refused(&r, mpm_step(r.stepper, BODY_DT, &info), MPM_E_ARG, "struct_size");
    ck_refused(&r, mpm_advance(r.stepper, &d, &info), MPM_E_ARG, "struct_size");
    ck_assert(world_hash(&r) == hash);
    ck_ok(&r, mpm_step_begin(r.stepper, BODY_DT));
    ck_ok(&r, mpm_step_grid(r.stepper));
    ck_refused(&r, mpm_step_end(r.stepper, &info), MPM_E_ARG, "struct_size");
    ck_ok(&r, mpm_step_abort(r.stepper)); /* it is still under way */
  }
  /* an older struct gets as much as it has room for */
  memset(&info, 0x5a, sizeof info);
  info.struct_size = 16;
  ck_ok(&r, mpm_step(r.stepper, BODY_DT, &info));
  ck_assert_int_eq(info.cause, MPM_OK);
  for (size_t i = 16; i < sizeof info; ++i) ck_assert_int_eq(((char *)&info)[i], 0x5a);
}
END_TEST

START_TEST(views_bar_steps) {
  const mpm_advance_desc d = advance_desc(1.0);
  world_steps(&r, 1);
  const uint64_t hash = world_hash(&r);
  for (int32_t access = MPM_READ; access <= MPM_WRITE; ++access) {
    mpm_view view = mapped("velocity", access);
    mpm_step_info info = {.struct_size = sizeof info};
    ck_refused(&r, mpm_step(r.stepper, BODY_DT, NULL), MPM_E_STATE, "set 0");
    ck_refused(&r, mpm_step_begin(r.stepper, BODY_DT), MPM_E_STATE, "set 0");
    ck_refused(&r, mpm_advance(r.stepper, &d, NULL), MPM_E_STATE, "mapped");
    const mpm_stepper_desc desc = body_stepper(&r);
    ck_refused(&r, mpm_stepper_configure(r.stepper, &desc), MPM_E_STATE, "set 0");
    if (access & MPM_WRITE)
      ck_refused(&r, mpm_stepper_info(r.stepper, &info), MPM_E_STATE, "mapped");
    else
      ck_ok(&r, mpm_stepper_info(r.stepper, &info));
    ck_ok(&r, mpm_view_release(&view));
    ck_assert(world_hash(&r) == hash);
  }
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(&r, mpm_grid_map(r.stepper, 0, "mass", MPM_READ, &view));
  ck_refused(&r, mpm_step(r.stepper, BODY_DT, NULL), MPM_E_STATE, "1 views of nodal fields");
  ck_refused(&r, mpm_step_begin(r.stepper, BODY_DT), MPM_E_STATE, "1 views of nodal fields");
  ck_refused(&r, mpm_advance(r.stepper, &d, NULL), MPM_E_STATE, "views of nodal fields");
  ck_refused(&r, mpm_stepper_destroy(r.stepper), MPM_E_STATE, "1 views of nodal fields");
  ck_ok(&r, mpm_view_release(&view));
  world_steps(&r, 1);
}
END_TEST

/* Values to be repaired bar the set from stepping, with their name and id. */
START_TEST(bad_values_bar_steps) {
  mpm_step_info info = {.struct_size = sizeof info};
  mpm_view ids = mapped("id", MPM_READ), view = mapped("velocity", MPM_WRITE);
  int64_t at = 0;
  while (((int64_t *)ids.data)[at] != 13) ++at;
  ((double *)view.data)[at] = NOT_A_NUMBER;
  ck_refused(&r, mpm_view_release(&view), MPM_E_ARG, "id 13");
  ck_ok(&r, mpm_view_release(&ids));
  ck_refused(&r, mpm_step(r.stepper, BODY_DT, &info), MPM_E_STATE, "velocity of the particle with id 13");
  ck_assert_int_eq(info.cause, MPM_E_STATE);
  ck_refused(&r, mpm_step_begin(r.stepper, BODY_DT), MPM_E_STATE, "id 13");
  const double v[2] = {1.0, 2.0};
  ck_ok(&r, mpm_particles_set(r.set[0], "velocity", MPM_F64, 2, 1, (int64_t[]){13}, v));
  world_steps(&r, 1);
}
END_TEST

START_TEST(profiles) {
  mpm_profile p = {.struct_size = 0};
  ck_refused(&r, mpm_stepper_profile(r.stepper, 0, NULL), MPM_E_ARG, "NULL");
  ck_refused(&r, mpm_stepper_profile(r.stepper, 1, &p), MPM_E_ARG, "struct_size is 0");
  memset(&p, 0x5a, sizeof p);
  p.struct_size = sizeof p;
  ck_ok(&r, mpm_stepper_profile(r.stepper, 1, &p));
  world_steps(&r, 5);
  ck_ok(&r, mpm_stepper_profile(r.stepper, 0, &p));
  ck_assert_uint_eq(p.struct_size, sizeof p);
  const double parts[] = {p.sort, p.p2g, p.grid, p.g2p, p.law, p.callbacks};
  double sum = 0.0;
  for (int32_t i = 0; i < 6; ++i) {
    ck_assert_double_gt(parts[i], 0.0);
    sum += parts[i];
  }
  ck_assert_double_eq(p.assembly, 0.0);
  ck_assert_double_eq(p.factor, 0.0);
  ck_assert_double_eq(p.solve, 0.0);
  ck_assert_double_ge(p.total, 0.999 * sum);
  ck_assert_double_lt(p.total, 60.0);
  mpm_profile again = {.struct_size = sizeof again};
  ck_ok(&r, mpm_stepper_profile(r.stepper, 1, &again)); /* gives the times, then zeroes them */
  ck_assert_double_eq(again.total, p.total);
  ck_ok(&r, mpm_stepper_profile(r.stepper, 0, &again));
  ck_assert_double_eq(again.total, 0.0);
  ck_assert_double_eq(again.law, 0.0);
}
END_TEST

TCase *stepper_arguments_case(void) {
  TCase *tests = tcase_create("arguments");
  tcase_add_checked_fixture(tests, open_run, close_run);
  tcase_add_test(tests, no_stepper);
  tcase_add_test(tests, sets);
  tcase_add_test(tests, times);
  tcase_add_test(tests, walls);
  tcase_add_test(tests, reactions);
  tcase_add_test(tests, stable_dt_of_what);
  tcase_add_test(tests, no_stable_dt);
  tcase_add_test(tests, steps);
  tcase_add_test(tests, infos);
  tcase_add_test(tests, views_bar_steps);
  tcase_add_test(tests, bad_values_bar_steps);
  tcase_add_test(tests, profiles);
  return tests;
}
