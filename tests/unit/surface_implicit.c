/* Surfaces in implicit steps. */
#include "surfaces.h"

/* Opens a block of 4 cells an edge that stands on a floor, in quasi-static steps or in dynamic ones. */
static mpm_surface *implicit_block(world *w, int32_t dim, int32_t quasi_static, const mpm_surface_desc *d) {
  const method how = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
  world_desc desc = world_with(&how, dim, CELLS, spacing);
  desc.stepper.quasi_static = quasi_static;
  world_open(w, &desc);
  const double low[] = {0.0, 1.0, 1.0}, high[] = {1.0, 2.0, 2.0};
  world_fill(w, w->set[0], low, high, 2);
  ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  return put_surface(w, d);
}

/* A face of the block at x = 1. */
static void add_face(const world *w, mpm_surface *s) {
  const int32_t n = w->dim == 1 ? 1 : w->dim == 2 ? 8 : 64;
  for (int32_t i = 0; i < n; ++i) {
    const double x[3] = {1.0, 1.0625 + 0.125 * (i % 8), 1.0625 + 0.125 * (i / 8 % 8)},
                 a[3] = {1.0 / n, 0.0, 0.0};
    ck_ok(w, mpm_surface_add(s, 1, x, a, NULL));
  }
}

/* The wall takes the whole load, dead or alive; and a load that turns takes few iterations, because its
 * stiffness is that of its force. */
START_TEST(equilibrium_under_loads) {
  const int32_t dim = 1 + _i % 3, follows = _i / 3;
  world w;
  mpm_surface_desc d = load_desc();
  if (follows)
    d.pressure = 8000.0;
  else
    d.dead_traction[0] = -3000.0, d.dead_traction[1] = 2000.0;
  mpm_surface *s = implicit_block(&w, dim, 1, &d);
  add_face(&w, s);
  const mpm_step_info info = world_step(&w, 1.0);
  double reaction[3], given[3] = {0.0, 0.0, 0.0}, work = 0.0;
  ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MIN, reaction));
  double *f = markers(s, "force", dim), *u = markers(s, "displacement", dim);
  const int64_t n = mpm_surface_count(s);
  for (int64_t i = 0; i < n; ++i)
    for (int32_t k = 0; k < dim; ++k) given[k] += f[k * n + i], work += f[k * n + i] * u[k * n + i];
  for (int32_t k = 0; k < dim; ++k) ck_within("reaction", reaction[k], -given[k], 1e-5 * 8000.0);
  if (!follows) ck_within("dead", given[0], -3000.0, 1e-9 * 3000.0);
  if (follows && dim == 1) ck_within("along", given[0], -8000.0, 1e-9 * 8000.0);
  ck_within("work", info.external_work, work, 1e-9 * fabs(work));
  show("%d-D, follows %d: %d iterations, solver %d, work %g, force %g %g\n", (int)dim, (int)follows,
       (int)info.newton_iterations, (int)info.linear_solver, work, given[0], given[1]);
  ck_assert_int_le(info.newton_iterations, 7);
  /* LDL^T is for symmetric matrices, and in 1-D areas do not turn */
  ck_assert((info.linear_solver == MPM_SOLVER_LDLT) == (!follows || dim == 1));
  free(f);
  free(u);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* Newton's method converges quadratically with all that follows: the last ratio of residuals says so. */
START_TEST(stiffness_of_what_follows) {
  world w;
  mpm_surface_desc d = load_desc();
  d.pressure = 6000.0;
  d.traction[1] = 9000.0;
  mpm_surface *s = implicit_block(&w, 2, _i, &d);
  add_face(&w, s);
  const mpm_step_info info = world_step(&w, 0.05);
  double residual[32];
  int32_t count;
  ck_ok(&w, mpm_stepper_residuals(w.stepper, 32, residual, &count));
  for (int32_t i = 0; i < count; ++i) show("%d: %g\n", (int)i, residual[i]);
  ck_assert_int_le(info.newton_iterations, 7);
  ck_assert_int_ge(count, 4);
  int32_t quadratic = 0; /* from below 1e-3 in one step to its square */
  for (int32_t i = 1; i < count; ++i)
    quadratic |= residual[i - 1] < 3e-2 && residual[i - 1] > 1e-6 &&
                 residual[i] < 10.0 * residual[i - 1] * residual[i - 1] + 1e-13;
  ck_assert(quadratic);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* An implicit step of small size is an explicit one: the same momentum goes in. */
START_TEST(implicit_momentum) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    const method how = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
    world w;
    open_block(&w, &how, dim);
    mpm_surface_desc d = load_desc();
    d.traction[0] = 100.0;
    mpm_surface *s = put_surface(&w, &d);
    add_closed(&w, s, 0.62);
    const double dt = 1e-4;
    double *A = markers(s, "reference_area", 1);
    const double force = 100.0 * sum_of(mpm_surface_count(s), A);
    for (int32_t i = 0; i < 4; ++i) world_step(&w, dt);
    ck_within("momentum", world_info(&w).momentum[0], 4.0 * dt * force, 1e-5 * dt * force);
    ck_assert(mpm_surface_count(s) > 0);
    free(A);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

void add_surface_implicit(Suite *suite) {
  TCase *implicit = tcase_create("implicit");
  tcase_add_loop_test(implicit, equilibrium_under_loads, 0, 6);
  tcase_add_loop_test(implicit, stiffness_of_what_follows, 0, 2);
  tcase_add_test(implicit, implicit_momentum);
  tcase_set_timeout(implicit, 60);
  suite_add_tcase(suite, implicit);
}
