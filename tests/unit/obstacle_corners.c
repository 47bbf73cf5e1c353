/* Corners of bodies that are sharper than a cell, on friction walls: contact acts on nodes, and what comes
 * through between them is stopped by the wall itself. */
#include "obstacle.h"
#include "tables.h"

enum { STEPS = 100 };
static const double fall = 3.0, fall_dt = 1.5e-3;

/* A cube of 4 cells that stands on its corner and falls on the friction wall of Z_MIN, or that of Z_MAX. */
static void open_corner(world *w, const method *how, int32_t upwards, int32_t threads) {
  const double h = arena_spacing, middle = 6.0 * h, side = upwards ? 1.0 : -1.0;
  world_desc desc = world_with(how, 3, 12, h);
  desc.context.concurrency = threads;
  mpm_particles *set = world_open(w, &desc);
  const double lower[3] = {4.0 * h, 4.0 * h, 4.0 * h}, upper[3] = {8.0 * h, 8.0 * h, 8.0 * h};
  const int64_t n = world_fill(w, set, lower, upper, 2);
  double *x = fetch(w, set, "position", 3);
  for (int64_t p = 0; p < n; ++p) {
    double y[3];
    for (int32_t c = 0; c < 3; ++c) y[c] = x[c * n + p] - middle;
    /* turned about x by 45 degrees, and about y until the diagonal points along z */
    const double b = sqrt(0.5) * (y[1] - y[2]), d = sqrt(0.5) * (y[1] + y[2]), a = y[0];
    x[p] = middle + sqrt(2.0 / 3.0) * a - sqrt(1.0 / 3.0) * d;
    x[n + p] = middle + b;
    x[2 * n + p] =
        middle + sqrt(1.0 / 3.0) * a + sqrt(2.0 / 3.0) * d + side * (middle - 2.0 * h * sqrt(3.0) - 0.3 * h);
  }
  put(w, set, "position", 3, x);
  free(x);
  const double v[3] = {0.3, 0.0, side * fall};
  ck_ok(w, mpm_particles_set_all(set, "velocity", MPM_F64, 3, v));
  ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_Z_MIN + upwards, MPM_WALL_FRICTION, 0.3));
}

/* Returns the distance to the wall of the particle that is nearest to it. */
static double distance(const world *w, int32_t upwards) {
  const int64_t n = mpm_particles_count(w->set[0]);
  double *x = fetch(w, w->set[0], "position", 3), nearest = INFINITE;
  for (int64_t p = 0; p < n; ++p)
    nearest = fmin(nearest, upwards ? 12.0 * arena_spacing - x[2 * n + p] : x[2 * n + p]);
  free(x);
  return nearest;
}

/* Puts a marker without area on the tip of the corner; it comes through before the particles do. */
static mpm_surface *mark_tip(const world *w, int32_t upwards) {
  const double h = arena_spacing, tip[3] = {6.0 * h, 6.0 * h, upwards ? 11.7 * h : 0.3 * h};
  mpm_surface *surface;
  ck_ok(w, mpm_surface_create(w->context, w->grid, NULL, &surface));
  ck_ok(w, mpm_surface_add(surface, 1, tip, NULL, NULL));
  ck_ok(w, mpm_stepper_add_surface(w->stepper, surface));
  return surface;
}

/* Between nodes of a cubic basis the corner comes through. */
static int32_t comes_through(const method *how) {
  return how->basis == MPM_BSPLINE3;
}

/* A corner that falls on a wall stays inside, and so does a marker on its tip; the wall reports all momentum
 * that the body gains, what it stops of particles included, and energy is never made. */
START_TEST(sharp) {
  const method *how = broad_methods[_i];
  const int32_t upwards = _i % 2;
  world w;
  int32_t stopped = 0, marked = 0;
  double total[3] = {0.0, 0.0, 0.0};
  open_corner(&w, how, upwards, 1);
  mpm_surface *tip = mark_tip(&w, upwards);
  const double energy = world_info(&w).kinetic_energy, scale = fall * mass_of(&w, w.set[0]);
  for (int32_t i = 0; i < STEPS; ++i) {
    const mpm_step_info before = world_info(&w), after = world_step(&w, fall_dt);
    double impulse[3];
    ck_ok(&w, mpm_stepper_wall_impulse(w.stepper, MPM_Z_MIN + upwards, impulse));
    for (int32_t c = 0; c < 3; ++c) {
      ck_within(how->name, after.momentum[c] - before.momentum[c], impulse[c] - total[c], 1e-11 * scale);
      total[c] = impulse[c];
    }
    ck_between(how->name, after.contact_dissipation, -1e-12 * energy, energy);
    const double nearest = distance(&w, upwards);
    ck_between(how->name, nearest, 0.0, INFINITE);
    stopped += nearest <= 0.0;
    double at[3];
    ck_ok(&w, mpm_surface_get(tip, "position", MPM_F64, 3, 1, NULL, at));
    marked += !(upwards ? at[2] < 12.0 * arena_spacing : at[2] > 0.0);
  }
  ck_between(how->name, upwards ? -total[2] : total[2], 0.3 * scale, 2.0 * scale);
  show("%s: %d steps with a particle on the wall\n", how->name, (int)stopped);
  if (comes_through(how)) ck_assert_int_gt(stopped, 0);
  if (comes_through(how)) ck_assert_int_gt(marked, 0);
  ck_ok(&w, mpm_stepper_remove_surface(w.stepper, tip));
  ck_ok(&w, mpm_surface_destroy(tip));
  world_close(&w);
}
END_TEST

/* What the wall stops itself depends on no number of threads, and steps in parts do the same. */
START_TEST(stops) {
  const method *how = broad_methods[_i];
  if (!comes_through(how)) return;
  world w[3];
  double impulse[3][3];
  for (int32_t i = 0; i < 3; ++i) {
    open_corner(&w[i], how, 0, i == 1 ? 3 : 1);
    for (int32_t k = 0; k < STEPS; ++k)
      i == 2 ? world_staged_step(&w[i], fall_dt) : world_step(&w[i], fall_dt);
    ck_ok(&w[i], mpm_stepper_wall_impulse(w[i].stepper, MPM_Z_MIN, impulse[i]));
  }
  ck_assert_uint_eq(world_hash(&w[1]), world_hash(&w[0]));
  same_info(&w[0], &w[1]);
  for (int32_t c = 0; c < 3; ++c) {
    ck_assert_double_eq(impulse[1][c], impulse[0][c]);
    ck_within(how->name, impulse[2][c], impulse[0][c], 1e-6 * fabs(impulse[0][2]));
  }
  for (int32_t i = 0; i < 3; ++i) world_close(&w[i]);
}
END_TEST

/* Who is prescribed goes where the host says, also out of the grid; nothing has changed then. */
START_TEST(driven) {
  world w;
  open_corner(&w, broad_methods[_i], 0, 1);
  ck_ok(&w, mpm_particles_set_all(w.set[0], "prescribed", MPM_U8, 3, (uint8_t[]){0, 0, 1}));
  mpm_status status = MPM_OK;
  mpm_step_info info = {.struct_size = sizeof info};
  world_bits before = world_take(&w);
  for (int32_t i = 0; !status && i < 3 * STEPS; ++i) {
    bits_drop(&before);
    before = world_take(&w);
    status = mpm_step(w.stepper, fall_dt, &info);
  }
  ck_assert_int_eq(status, MPM_OFF_GRID);
  ck_assert_ptr_nonnull(strstr(last_error_of(&w), "through MPM_Z_MIN"));
  world_same(&w, &before, broad_methods[_i]->name);
  bits_drop(&before);
  world_close(&w);
}
END_TEST

void add_obstacle_corners(Suite *suite) {
  TCase *corners = tcase_create("corners"), *falls = tcase_create("corners that fall");
  tcase_add_loop_test(falls, sharp, 0, BROAD);
  add_sparse(corners, stops, BROAD, 5);
  tcase_add_loop_test(corners, driven, 0, 2);
  tcase_set_tags(falls, "long");
  tcase_set_timeout(corners, 60);
  tcase_set_timeout(falls, 60);
  suite_add_tcase(suite, corners);
  suite_add_tcase(suite, falls);
}
