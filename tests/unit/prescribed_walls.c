/* Prescribed particles across the seam of a periodic axis, and beside a plane of symmetry. */
#include "prescribed.h"

static mpm_status against(void *user, const mpm_particle_batch *b, double *add) {
  const double middle = *(double *)user; /* towards it on both sides */
  for (int64_t p = 0; p < b->n; ++p) {
    add[p] += 0.2;
    add[b->ld + p] += b->position[b->ld + p] < middle ? 0.5 : -0.5;
  }
  return 0;
}

/* A cloud with prescribed particles, `from` cells along the periodic x axis. */
static void open_shifted(world *w, const method *how, int64_t from) {
  static double middle = 0.8;
  world_desc desc = world_with(how, 2, 8, 0.125);
  desc.grid.periodic[0] = 1;
  mpm_particles *set = world_open(w, &desc);
  dice d = {31};
  add_cloud(w, set, &d, CLOUD, 0.125, 0.25, 0.75, 1.0);
  double *x = fetch(w, set, "position", 2);
  uint8_t flags[2 * CLOUD];
  for (int32_t p = 0; p < CLOUD; ++p) {
    flags[p] = flags[CLOUD + p] = x[p] > 0.45 && x[p] < 0.6;
    x[p] = fmod(x[p] + 0.125 * (double)from, 1.0);
  }
  put(w, set, "position", 2, x);
  ck_ok(w, mpm_particles_set(set, "prescribed", MPM_U8, 2, CLOUD, NULL, flags));
  ck_ok(w, mpm_stepper_set_motion(w->stepper, set, against, &middle));
  free(x);
}

/* Whether they straddle the seam of a periodic axis does not matter. */
START_TEST(across_the_seam) {
  const method *how = &methods[_i];
  world w[2];
  double *v[2], *s[2], force[2][2];
  for (int32_t k = 0; k < 2; ++k) {
    open_shifted(&w[k], how, k ? 4 : 0);
    for (int32_t i = 0; i < 8; ++i) world_step(&w[k], 1e-3);
    v[k] = fetch(&w[k], w[k].set[0], "velocity", 2);
    s[k] = fetch(&w[k], w[k].set[0], "stress", 6);
    ck_ok(&w[k], mpm_stepper_particles_reaction(w[k].stepper, w[k].set[0], force[k]));
  }
  for (int32_t i = 0; i < 2 * CLOUD; ++i) ck_within(how->name, v[1][i], v[0][i], 1e-9);
  for (int32_t i = 0; i < 4 * CLOUD; ++i)
    ck_within(how->name, s[1][i], s[0][i], 1e-9 * largest(4 * CLOUD, s[0]));
  for (int32_t c = 0; c < 2; ++c) {
    ck_assert_double_gt(fabs(force[0][c]), 1.0);
    ck_within(how->name, force[1][c], force[0][c], 1e-8 * (fabs(force[0][0]) + fabs(force[0][1])));
  }
  for (int32_t k = 0; k < 2; ++k) free(v[k]), free(s[k]), world_close(&w[k]);
}
END_TEST

/* A symmetric body with prescribed particles, and its half on a slip wall in the plane: the same
 * motion. */
START_TEST(half_on_a_slip_wall) {
  const method *how = &methods[_i];
  double plane = 0.8;
  world w[2];
  double *x[2], *v[2];
  for (int32_t k = 0; k < 2; ++k) { /* the half is above the plane: 1 is the whole */
    const double shift = k ? 0.0 : -0.8, lower[2] = {0.3, k ? 0.4 : 0.0}, upper[2] = {0.9, 1.2 + shift};
    static double middle[2];
    middle[k] = plane + shift;
    world_desc desc = world_with(how, 2, 16, 0.1);
    mpm_particles *set = world_open(&w[k], &desc);
    world_fill(&w[k], set, lower, upper, 2);
    if (!k) ck_ok(&w[k], mpm_stepper_set_wall(w[k].stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
    const int64_t n = mpm_particles_count(set);
    double *at = fetch(&w[k], set, "position", 2), *speed = fetch(&w[k], set, "velocity", 2);
    uint8_t *flags = malloc((size_t)(2 * n));
    for (int64_t p = 0; p < n; ++p) {
      flags[p] = at[p] < 0.5;
      flags[n + p] = at[p] < 0.5 && fabs(at[n + p] - plane - shift) > 0.2; /* else against the wall */
      speed[n + p] = -0.3 * sin(3.0 * at[p]) * (at[n + p] - plane - shift);
      speed[p] = 0.1 * at[p];
    }
    put(&w[k], set, "velocity", 2, speed);
    ck_ok(&w[k], mpm_particles_set(set, "prescribed", MPM_U8, 2, n, NULL, flags));
    ck_ok(&w[k], mpm_stepper_set_motion(w[k].stepper, set, against, &middle[k]));
    free(at), free(speed), free(flags);
    for (int32_t i = 0; i < 10; ++i) world_step(&w[k], 1e-3);
    x[k] = fetch(&w[k], set, "position", 2);
    v[k] = fetch(&w[k], set, "velocity", 2);
  }
  const int64_t half = mpm_particles_count(w[0].set[0]), whole = mpm_particles_count(w[1].set[0]);
  int64_t found = 0;
  ck_assert_int_eq(whole, 2 * half);
  for (int64_t p = 0; p < half; ++p)
    for (int64_t q = 0; q < whole; ++q) {
      if (fabs(x[0][p] - x[1][q]) > 1e-6 || fabs(x[0][half + p] + plane - x[1][whole + q]) > 1e-6) continue;
      ++found;
      for (int32_t c = 0; c < 2; ++c) ck_within(how->name, v[0][c * half + p], v[1][c * whole + q], 1e-10);
    }
  ck_assert_int_eq(found, half);
  for (int32_t k = 0; k < 2; ++k) free(x[k]), free(v[k]), world_close(&w[k]);
}
END_TEST

TCase *prescribed_walls_case(void) {
  TCase *tc = tcase_create("walls");
  tcase_set_timeout(tc, 120);
  tcase_add_loop_test(tc, across_the_seam, 0, METHODS);
  tcase_add_loop_test(tc, half_on_a_slip_wall, 0, METHODS);
  return tc;
}
