/* Half of a body on a wall in its plane of symmetry is the whole body: to rounding wherever ghosts mirror,
 * and with the linear basis, which has none. Functions of open knots differ near a wall from those inside, so
 * that there the two agree to the order of the basis only. */
#include "walls.h"

static const double plane = 0.8;

typedef struct fields {
  int64_t n;
  double *x, *v, *F;
} fields;

/* On a slip wall the mirror image has the same velocity along the wall and the opposite across it. */
static void slip_velocity(int32_t dim, int64_t n, const double *x, double *v) {
  for (int64_t p = 0; p < n; ++p)
    for (int32_t k = 0; k < dim; ++k) {
      const double away = x[p] - plane;
      v[k * n + p] = k == 0 ? -sin(3.0 * away) : cos(4.0 * away) * (k == 1 ? 0.5 : -0.3) + 0.2 * x[n + p];
    }
}

/* On a fixed wall every component is opposite. That is the inversion through a point of the wall, if nothing
 * depends on the place along it. */
static void fixed_velocity(int32_t dim, int64_t n, const double *x, double *v) {
  static const double rate[3] = {-3.0, 4.0, 5.0};
  for (int64_t p = 0; p < n; ++p)
    for (int32_t k = 0; k < dim; ++k) v[k * n + p] = 0.3 * sin(rate[k] * (x[p] - plane));
}

/* fine: cells of half the edge. thin: a body of one cell on either side of the plane that reaches into the
 * next ones by a fiftieth: its light nodes go with those in the plane. */
static fields run(const method *how, int32_t kind, int32_t dim, int32_t whole, int32_t steps, int32_t fine,
                  int32_t thin) {
  const int32_t fixed = kind == MPM_WALL_FIXED;
  const double along = fixed ? 0.0 : 0.6, reach = thin ? 0.1 : 0.4;
  const double lower[3] = {whole ? plane - reach : plane, along, along},
               upper[3] = {plane + reach, along + 0.4, along + 0.4};
  world w;
  world_desc desc = world_with(how, dim, 16 * fine, 0.1 / fine);
  if (!whole) {
    desc.grid.origin[0] = plane;
    desc.grid.cells[0] = 8 * fine;
  }
  for (int32_t k = 1; fixed && k < dim; ++k) {
    desc.grid.periodic[k] = 1;
    desc.grid.cells[k] = 4 * fine;
  }
  if (!fixed) desc.stepper.gravity[1] = -2.0;
  mpm_particles *set = world_open(&w, &desc);
  if (!whole) ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, kind, 0.0));
  world_fill(&w, set, lower, upper, 2);
  fields f = {.n = mpm_particles_count(set)};
  double *at = fetch(&w, set, "position", dim), *speed = malloc((size_t)(dim * f.n) * sizeof *speed);
  for (int64_t p = 0; p < f.n && thin; ++p) at[p] = plane + 1.36 * (at[p] - plane);
  put(&w, set, "position", dim, at);
  (fixed ? fixed_velocity : slip_velocity)(dim, f.n, at, speed);
  put(&w, set, "velocity", dim, speed);
  free(at), free(speed);
  for (int32_t i = 0; i < steps; ++i) world_step(&w, 1e-3);
  f.x = fetch(&w, set, "position", dim);
  f.v = fetch(&w, set, "velocity", dim);
  f.F = fetch(&w, set, "deformation_gradient", 9);
  world_close(&w);
  return f;
}

static void drop(fields *f) {
  free(f->x), free(f->v), free(f->F);
}

/* ids run along x slowest: the upper half of the whole is the half */
static double difference(const fields *half, const fields *whole, int32_t components, const double *a,
                         const double *b) {
  double worst = 0.0;
  for (int32_t c = 0; c < components; ++c)
    for (int64_t p = 0; p < half->n; ++p) {
      const double off = fabs(b[c * whole->n + half->n + p] - a[c * half->n + p]);
      if (!(off <= worst)) worst = off;
    }
  return worst;
}

static void check_half(const method *how, int32_t kind, int32_t dim, int32_t steps, int32_t thin) {
  fields half = run(how, kind, dim, 0, steps, 1, thin), whole = run(how, kind, dim, 1, steps, 1, thin);
  ck_assert_int_eq(2 * half.n, whole.n);
  const double x = difference(&half, &whole, dim, half.x, whole.x);
  const double v = difference(&half, &whole, dim, half.v, whole.v);
  const double F = difference(&half, &whole, 9, half.F, whole.F);
  show("half %s wall %d %d-D: x %.2e v %.2e F %.2e\n", how->name, (int)kind, (int)dim, x, v, F);
  ck_between(how->name, x, 0.0, 1e-10);
  ck_between(how->name, v, 0.0, 1e-10);
  ck_between(how->name, F, 0.0, 1e-10);
  drop(&half), drop(&whole);
}

/* Mean square difference of the velocities. */
static double mean_difference(const fields *half, const fields *whole, int32_t dim) {
  double sum = 0.0;
  for (int32_t c = 0; c < dim; ++c)
    for (int64_t p = 0; p < half->n; ++p) {
      const double off = whole->v[c * whole->n + half->n + p] - half->v[c * half->n + p];
      sum += off * off;
    }
  return sqrt(sum / (double)half->n);
}

/* Halves come nearer to the whole with the cells, at order 1 at least; where a step gives particles
 * increments alone, they keep what the grid does not see of their differences. */
static void check_approach(const method *how, int32_t kind, int32_t dim) {
  double off[2];
  for (int32_t fine = 1; fine <= 2; ++fine) {
    fields half = run(how, kind, dim, 0, 40, fine, 0), whole = run(how, kind, dim, 1, 40, fine, 0);
    off[fine - 1] = mean_difference(&half, &whole, dim);
    drop(&half), drop(&whole);
  }
  show("half %s wall %d %d-D: off by %.2e %.2e, order %.2f\n", how->name, (int)kind, (int)dim, off[0], off[1],
       log2(off[0] / off[1]));
  const int32_t keeps = how->transfer == MPM_FLIP || how->transfer == MPM_AFLIP;
  ck_between(how->name, off[0], 0.0, 0.06);
  ck_between(how->name, off[1], 0.0, (keeps && !(how->flip < 1.0) ? 0.8 : 0.5) * off[0]);
}

static void check(const method *how, int32_t kind, int32_t dim, int32_t steps) {
  if (how->boundary != MPM_BOUNDARY_OPEN_KNOT)
    check_half(how, kind, dim, steps, 0);
  else if (dim < 3)
    check_approach(how, kind, dim);
}

START_TEST(half_on_slip_wall_is_the_whole) {
  const method how = wall_method_of(_i);
  for (int32_t dim = 1; dim <= 2; ++dim) check(&how, MPM_WALL_SLIP, dim, 40);
  if (how.basis == MPM_LINEAR)
    for (int32_t dim = 1; dim <= 2; ++dim) check_half(&how, MPM_WALL_SLIP, dim, 5, 1);
}
END_TEST

START_TEST(half_on_fixed_wall_is_the_whole) {
  const method how = wall_method_of(_i);
  for (int32_t dim = 1; dim <= 3; ++dim) check(&how, MPM_WALL_FIXED, dim, 30);
}
END_TEST

START_TEST(half_on_slip_wall_in_space) {
  const method how = wall_method_of(_i);
  check(&how, MPM_WALL_SLIP, 3, 20);
}
END_TEST

/* Stretches what is not on the plane. */
static mpm_status stretch(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    if (fabs(b->position[i] - plane) < 0.05) continue;
    prescribed[i] = 1;
    velocity[i] = 0.3 * (b->position[i] - plane);
  }
  return MPM_OK;
}

static double work_of(const method *how, int32_t whole) {
  world w;
  world_desc desc = world_with(how, 2, 16, 0.1);
  const double lower[2] = {whole ? plane - 0.4 : plane, 0.6}, upper[2] = {plane + 0.4, 1.0};
  if (!whole) desc.grid.origin[0] = plane, desc.grid.cells[0] = 8;
  mpm_particles *set = world_open(&w, &desc);
  if (!whole) ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  world_fill(&w, set, lower, upper, 2);
  ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, stretch, NULL));
  for (int32_t i = 0; i < 3; ++i) world_step(&w, 1e-3);
  const double work = world_info(&w).external_work_total;
  world_close(&w);
  return work;
}

/* Mirror images go the other way by an impulse the other way: who moves both halves works twice as much. */
START_TEST(work_on_half_is_half_the_work) {
  const method how = wall_method_of(_i);
  if (how.scheme == MPM_NEWMARK || how.boundary == MPM_BOUNDARY_OPEN_KNOT) return;
  const double half = work_of(&how, 0), whole = work_of(&how, 1);
  ck_assert_double_gt(whole, 0.0);
  ck_within(how.name, 2.0 * half, whole, 1e-10 * whole);
}
END_TEST

TCase *walls_space_case(void) {
  TCase *tc = tcase_create("space");
  tcase_set_timeout(tc, 60.0);
  tcase_set_tags(tc, "long");
  tcase_add_loop_test(tc, half_on_slip_wall_in_space, 0, WALL_METHODS);
  return tc;
}

TCase *walls_symmetry_case(void) {
  TCase *tc = tcase_create("symmetry");
  tcase_set_timeout(tc, 60.0);
  tcase_add_loop_test(tc, half_on_slip_wall_is_the_whole, 0, WALL_METHODS);
  tcase_add_loop_test(tc, half_on_fixed_wall_is_the_whole, 0, WALL_METHODS);
  tcase_add_loop_test(tc, work_on_half_is_half_the_work, 0, WALL_METHODS);
  return tc;
}
