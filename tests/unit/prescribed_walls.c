/* Prescribed particles across the seam of a periodic axis, and beside a plane of symmetry. */
#include "prescribed.h"
#include "surfaces.h"

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

/* Platens that press a body and widen: across the plane of symmetry they have a velocity, too. */
typedef struct pressing {
  double plane, widens;
  uint8_t held[2]; /* on which axes platens are prescribed */
} pressing;
enum { PRESSED, PLATEN, OTHER_PLATEN, PRESSED_SETS };

static mpm_status press(void *user, const mpm_particle_batch *b, double *add) {
  const pressing *of = user;
  for (int64_t p = 0; p < b->n; ++p) {
    const double away = b->position[p] - of->plane;
    add[p] += of->widens * (copysign(0.4, away) + 0.5 * away);
    add[b->ld + p] += -0.5 + 0.3 * fabs(away);
  }
  return 0;
}

typedef struct pressed_way {
  int32_t scheme, transfer, order, quasi_static;
  double flip;
  const char *name;
} pressed_way;
static const pressed_way pressed_ways[] = {
    {MPM_USL, MPM_FLIP, 0, 0, 1.0, "FLIP USL"},        {MPM_MUSL, MPM_FLIP, 0, 0, 0.9, "blend MUSL"},
    {MPM_USF, MPM_APIC, 0, 0, 1.0, "APIC USF"},        {MPM_USL, MPM_XPIC, 3, 0, 1.0, "XPIC(3) USL"},
    {MPM_MUSL, MPM_FMPM, 4, 0, 1.0, "FMPM(4) MUSL"},   {MPM_NEWMARK, MPM_FLIP, 0, 0, 1.0, "Newmark"},
    {MPM_NEWMARK, MPM_FLIP, 0, 1, 1.0, "quasi-static"}};
enum { PRESSED_WAYS = sizeof pressed_ways / sizeof pressed_ways[0] };

static const double pull = 100.0;

/* A load under the platen, beside the plane, away from it; returns its surface. */
static mpm_surface *pull_away(world *w, double plane, double side) {
  const double at[2] = {plane + side * 0.04, 0.9}, area[2] = {side, 0.0};
  mpm_surface_desc desc = load_desc();
  desc.dead_traction[0] = side * pull;
  mpm_surface *s = put_surface(w, &desc);
  ck_ok(w, mpm_surface_add(s, 1, at, area, NULL));
  return s;
}

/* The body ends where no node of its rim sees hardly any of it. Of platens that are prescribed on all axes
 * such nodes are not asked for; of those that may fall they are, above the platen. */
static void open_pressed(world *w, const method *how, const pressed_way *way, int32_t whole, pressing *by) {
  const double bottom = how->basis == MPM_BSPLINE3 ? 0.5 : 0.5625, width = 1.25 - bottom;
  world_desc desc = world_with(how, 2, 16, 0.125);
  desc.sets = whole ? PRESSED_SETS : OTHER_PLATEN;
  desc.stepper.gravity[1] = -2.0;
  desc.stepper.quasi_static = way->quasi_static;
  desc.stepper.newton_tolerance_residual = 1e-13;
  if (!whole) desc.grid.origin[0] = by->plane, desc.grid.cells[0] = 8;
  world_open(w, &desc);
  if (!whole) ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  for (int32_t m = 0; m < desc.sets; ++m) {
    const double lower[2] = {m == PLATEN || !whole ? by->plane : by->plane - width, m ? 0.875 : bottom};
    const double upper[2] = {m == OTHER_PLATEN ? by->plane : by->plane + width,
                             m ? (by->held[1] ? 1.0 : 1.0625) : 0.875};
    world_fill(w, w->set[m], lower, upper, 2);
    if (m == PRESSED) continue;
    ck_ok(w, mpm_particles_set_all(w->set[m], "prescribed", MPM_U8, 2, by->held));
    ck_ok(w, mpm_stepper_set_motion(w->stepper, w->set[m], press, by));
  }
}

/* Particles are listed along x slowest: the half is the last of the whole. */
static void compare_pressed(const char *name, const world *w, int32_t set, const char *field,
                            int32_t components) {
  const int64_t n = mpm_particles_count(w[0].set[set]), all = mpm_particles_count(w[1].set[set]);
  double *half = fetch(&w[0], w[0].set[set], field, components);
  double *whole = fetch(&w[1], w[1].set[set], field, components);
  const double most = largest(components * all, whole);
  for (int32_t c = 0; c < components; ++c)
    for (int64_t p = 0; p < n; ++p)
      ck_within(name, half[c * n + p], whole[c * all + all - n + p], 1e-11 * most);
  free(half), free(whole);
}

/* Along the wall the platen pushes as it does on the whole; across it nodes on the plane are held for both
 * halves, and the platen has what holds its half. What it, the load and the wall exert is the change of the
 * momentum of the body. */
static void compare_forces(const char *name, const world *w, const pressed_way *way, double pulled,
                           double before) {
  double force[2][2], impulse[2][2], wall[2];
  for (int32_t k = 0; k < 2; ++k) {
    ck_ok(&w[k], mpm_stepper_particles_reaction(w[k].stepper, w[k].set[PLATEN], force[k]));
    ck_ok(&w[k], mpm_stepper_particles_impulse(w[k].stepper, w[k].set[PLATEN], impulse[k]));
  }
  ck_ok(&w[0], mpm_stepper_wall_reaction(w[0].stepper, MPM_X_MIN, wall));
  const double scale = fabs(force[1][0]) + fabs(force[1][1]) + fabs(wall[0]) + pulled;
  ck_within(name, force[0][1], force[1][1], 1e-10 * scale);
  ck_within(name, impulse[0][1], impulse[1][1], 1e-10 * 1e-3 * scale);
  const double gained = way->quasi_static ? 0.0 : of_field(&w[0], w[0].set[PRESSED], "velocity", 0) - before;
  if (way->scheme == MPM_NEWMARK && !way->quasi_static) return; /* there forces are those at the end */
  ck_within(name, 1e-3 * (force[0][0] + wall[0] + pulled), gained, 1e-10 * 1e-3 * scale);
}

START_TEST(half_with_a_platen_that_widens) {
  const pressed_way *way = &pressed_ways[_i % PRESSED_WAYS];
  const basis_option *basis = &basis_options[_i / PRESSED_WAYS % BASES];
  const int32_t loads = _i / PRESSED_WAYS / BASES % 2, motion = _i / PRESSED_WAYS / BASES / 2;
  pressing by = {1.0, motion == 1 ? 0.0 : 1.0, {1, motion < 2}};
  if (basis->boundary == MPM_BOUNDARY_OPEN_KNOT || (motion == 2 && way->quasi_static)) return;
  method how = {.basis = basis->basis,
                .smoothing = basis->smoothing,
                .scheme = way->scheme,
                .transfer = way->transfer,
                .flip = way->flip,
                .xpic_order = way->order};
  snprintf(how.name, sizeof how.name, "%s %s", basis->name, way->name);
  world w[2];
  mpm_surface *load[3] = {NULL, NULL, NULL};
  for (int32_t k = 0; k < 2; ++k) {
    open_pressed(&w[k], &how, way, k, &by);
    for (int32_t side = 0; side <= k && loads; ++side)
      load[k + side] = pull_away(&w[k], by.plane, side ? -1.0 : 1.0);
  }
  for (int32_t i = 0; i < 6; ++i) {
    const double before = of_field(&w[0], w[0].set[PRESSED], "velocity", 0);
    for (int32_t k = 0; k < 2; ++k) world_step(&w[k], 1e-3);
    compare_forces(how.name, w, way, loads ? pull : 0.0, before);
    const double work = world_info(&w[1]).external_work;
    ck_within(how.name, 2.0 * world_info(&w[0]).external_work, work, 1e-10 * fabs(work));
  }
  for (int32_t m = PRESSED; m <= PLATEN; ++m) {
    compare_pressed(how.name, w, m, "position", 2);
    compare_pressed(how.name, w, m, "velocity", 2);
    compare_pressed(how.name, w, m, "stress", 6);
  }
  for (int32_t i = 0; i < 3; ++i)
    if (load[i]) drop_surface(&w[i > 0], load[i]);
  for (int32_t k = 0; k < 2; ++k) world_close(&w[k]);
}
END_TEST

TCase *prescribed_walls_case(void) {
  TCase *tc = tcase_create("walls");
  tcase_set_timeout(tc, 120);
  tcase_add_loop_test(tc, across_the_seam, 0, METHODS);
  tcase_add_loop_test(tc, half_on_a_slip_wall, 0, METHODS);
  tcase_add_loop_test(tc, half_with_a_platen_that_widens, 0, 6 * BASES * PRESSED_WAYS);
  return tc;
}
