/* What friction walls report in implicit steps. */
#include "walls.h"

/* Prescribes the velocities of the nodes from x = 7 on along x. */
static mpm_status draw(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  for (int64_t i = 0; i < b->n; ++i) {
    prescribed[i] = b->position[i] > 6.9;
    velocity[i] = *(const double *)user;
  }
  return MPM_OK;
}

/* A bar whose end nodes the host draws beyond a friction wall, the plane of which stops particles. */
static int64_t draw_bar(world *w, int32_t quasi_static, double dt) {
  world_desc d = world_default(2, 10, 1.0);
  d.grid.basis = MPM_LINEAR;
  d.stepper.scheme = MPM_NEWMARK;
  d.stepper.quasi_static = quasi_static;
  d.law = (world_law){.model = "linear_elastic", .E = 1e4, .nu = 0.0, .density = 1.0};
  mpm_particles *set = world_open(w, &d);
  const double low[2] = {0.0, 3.0}, high[2] = {10.0, 6.0};
  static double speed;
  speed = 0.3 / dt;
  const int64_t n = world_fill(w, set, low, high, 2);
  ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_X_MAX, MPM_WALL_FRICTION, 0.3));
  ck_ok(w, mpm_stepper_set_velocity_bc(w->stepper, draw, &speed));
  world_step(w, dt);
  return n;
}

/* In equilibrium that takes no momentum, however long the step is, and forces are those of who holds the
 * bar. */
START_TEST(stopped_without_momentum) {
  static const double dts[] = {1e-3, 1.0};
  for (int32_t i = 0; i < 2; ++i) {
    world w;
    double met[2], held[2];
    const int64_t n = draw_bar(&w, 1, dts[i]);
    mpm_particles *set = w.set[0];
    double *x = fetch(&w, set, "position", 2);
    int64_t stopped = 0;
    for (int64_t p = 0; p < n; ++p) stopped += x[p] >= 10.0;
    ck_assert_int_eq(stopped, 6);
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MIN, held));
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MAX, met));
    ck_assert_double_lt(held[0], -100.0); /* 3 E times a strain of about 0.04 */
    for (int32_t c = 0; c < 2; ++c) ck_within("of the plane", met[c], 0.0, 1e-9);
    ck_within("dissipation", w.info.contact_dissipation, 0.0, 1e-9);
    free(x);
    world_close(&w);
  }
}
END_TEST

/* What is stopped begins at rest: by its old acceleration Newmark's rule would drive it on into the wall. */
START_TEST(stopped_without_acceleration) {
  world w;
  const int64_t n = draw_bar(&w, 0, 1e-2);
  double *x = fetch(&w, w.set[0], "position", 2), *v = fetch(&w, w.set[0], "velocity", 2),
         *a = fetch(&w, w.set[0], "acceleration", 2);
  int64_t stopped = 0, driven = 0;
  for (int64_t p = 0; p < n; ++p) {
    const int32_t on_wall = x[p] >= 10.0;
    stopped += on_wall;
    driven += !on_wall && a[p] > 0.0;
    ck_holds(!on_wall || (v[p] == 0.0 && a[p] == 0.0));
  }
  ck_assert_int_eq(stopped, 6);
  ck_assert_int_gt(driven, 0);
  free(x), free(v), free(a);
  world_close(&w);
}
END_TEST

/* Particles that are led along a friction wall, which the material presses against it: their reaction is
 * less their own weight, has what the wall takes from them once, and with the wall's is the change of
 * momentum. */
START_TEST(led_along_a_wall) {
  const int32_t basis = _i ? MPM_BSPLINE2 : MPM_LINEAR;
  world w;
  world_desc d = world_default(2, 10, 1.0);
  d.grid.basis = basis;
  d.stepper.scheme = MPM_NEWMARK;
  d.stepper.newmark_gamma = 1.0;
  d.stepper.newmark_beta = 0.5;
  d.stepper.newton_tolerance_residual = 1e-11;
  d.stepper.gravity[0] = 10.0;
  d.stepper.gravity[1] = -3.0;
  d.law = (world_law){.model = "linear_elastic", .E = 1e4, .nu = 0.2, .density = 10.0};
  mpm_particles *set = world_open(&w, &d);
  const double low[2] = {5.0, 3.0}, high[2] = {10.0, 6.0}, v[2] = {0.0, 0.5};
  const int64_t n = world_fill(&w, set, low, high, 2);
  double *x = fetch(&w, set, "position", 2);
  const uint8_t led[2] = {0, 1};
  double free_mass[2] = {0.0, 0.0}, *m = fetch(&w, set, "mass", 1);
  for (int64_t p = 0; p < n; ++p) {
    free_mass[0] += m[p];
    if (x[n + p] < 4.0)
      ck_ok(&w, mpm_particles_set(set, "prescribed", MPM_U8, 2, 1, &p, led));
    else
      free_mass[1] += m[p];
  }
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MAX, MPM_WALL_FRICTION, 0.5));
  const double dt = 2e-3, mass = free_mass[0];
  double rubbed = 0.0;
  for (int32_t step = 0; step < 5; ++step) {
    const mpm_step_info before = world_info(&w);
    world_step(&w, dt);
    double wall[2], holder[2];
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MAX, wall));
    ck_ok(&w, mpm_stepper_particles_reaction(w.stepper, set, holder));
    for (int32_t c = 0; c < 2; ++c)
      ck_within("momentum", w.info.momentum[c] - before.momentum[c],
                dt * (wall[c] + holder[c] + free_mass[c] * d.stepper.gravity[c]), 1e-9 * mass);
    rubbed = fmin(rubbed, wall[1]);
  }
  ck_assert_double_lt(rubbed, -0.01 * mass);
  free(x);
  free(m);
  world_close(&w);
}
END_TEST

TCase *walls_implicit_case(void) {
  TCase *tc = tcase_create("implicit");
  tcase_set_timeout(tc, 30.0);
  tcase_add_test(tc, stopped_without_momentum);
  tcase_add_test(tc, stopped_without_acceleration);
  tcase_add_loop_test(tc, led_along_a_wall, 0, 2);
  return tc;
}
