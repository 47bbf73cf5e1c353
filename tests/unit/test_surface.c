/* Surfaces: what their markers give to nodes. */
#include "surfaces.h"

/* A closed surface under pressure has neither force nor moment, inside the block and across its faces. */
START_TEST(closed_under_pressure) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 1; dim <= 3 && is_explicit(how); ++dim) {
    if (dim == 1 && how->remedy) continue;
    for (int32_t out = 0; out < 2; ++out) {
      world w;
      open_block(&w, how, dim);
      mpm_surface_desc d = load_desc();
      d.pressure = 1000.0;
      mpm_surface *s = put_surface(&w, &d);
      add_closed(&w, s, out ? 0.62 : 0.3);
      const resultant sum = on_nodes(&w);
      ck_assert(sum.scale > 100.0);
      for (int32_t k = 0; k < 3; ++k) {
        ck_within(how->name, sum.force[k], 0.0, 1e-12 * sum.scale);
        ck_within(how->name, sum.moment[k], 0.0, 1e-12 * sum.scale);
      }
      drop_surface(&w, s);
      world_close(&w);
    }
  }
}
END_TEST

/* Tractions keep force and moment of their markers, also where markers see nodes without mass; and a whole
 * step gives the body their impulse. */
START_TEST(tractions_keep_force_and_moment) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 1; dim <= 3 && is_explicit(how); ++dim) {
    if (dim == 1 && how->remedy) continue;
    world w;
    open_block(&w, how, dim);
    mpm_surface_desc d = load_desc();
    for (int32_t k = 0; k < 3; ++k) d.traction[k] = 300.0 - 200.0 * k, d.dead_traction[k] = 50.0 * k;
    mpm_surface *s = put_surface(&w, &d);
    for (int32_t k = 0; k < 5; ++k) { /* on a face, and a little beyond it and before it */
      const double x[3] = {2.07 + 0.02 * k, 1.1 + 0.17 * k, 1.2}, a[3] = {0.04, 0.01, 0.02};
      ck_ok(&w, mpm_surface_add(s, 1, x, a, NULL));
    }
    const double dt = 1e-4;
    const resultant sum = on_nodes(&w);
    const double before = world_info(&w).momentum[0];
    const mpm_step_info info = world_step(&w, dt);
    double *f = markers(s, "force", dim), *area = markers(s, "reference_area", 1);
    double x[15], wanted = 0.0;
    for (int32_t k = 0; k < 5; ++k) {
      const double at[3] = {2.07 + 0.02 * k, 1.1 + 0.17 * k, 1.2};
      for (int32_t c = 0; c < dim; ++c) x[c * 5 + k] = at[c];
      wanted += (d.traction[0] + d.dead_traction[0]) * area[k];
    }
    const resultant given = resultant_of(dim, 5, x, f);
    ck_within(how->name, given.force[0], wanted, 1e-12 * given.scale);
    for (int32_t k = 0; k < 3; ++k) {
      ck_within(how->name, sum.force[k], given.force[k], 1e-12 * given.scale);
      ck_within(how->name, sum.moment[k], given.moment[k], 1e-12 * given.scale);
    }
    ck_within(how->name, info.momentum[0] - before, dt * given.force[0], 1e-11 * dt * given.scale);
    free(f);
    free(area);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* Beside a wall that mirrors, surfaces and the wall together give the body what it gains: mirror images turn
 * a part of the load round, which is the wall's, or that of whoever holds the nodes. */
START_TEST(loads_beside_walls) {
  const method *how = broad_methods[_i];
  static const int32_t kind[] = {MPM_WALL_SLIP, MPM_WALL_FIXED};
  for (int32_t dim = 1; dim <= 3 && is_explicit(how); ++dim)
    for (int32_t k = 0; k < 2 && !(dim == 1 && how->remedy); ++k) {
      world w;
      const world_desc desc = world_with(how, dim, CELLS, spacing);
      mpm_particles *set = world_open(&w, &desc);
      const double low[] = {0.0, 0.85, 0.9}, high[] = {1.2, 2.1, 2.15};
      world_fill(&w, set, low, high, 2);
      ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, kind[k], 0.0));
      mpm_surface_desc d = load_desc();
      for (int32_t c = 0; c < 3; ++c) d.traction[c] = 300.0 - 200.0 * c;
      mpm_surface *s = put_surface(&w, &d);
      const double x[3] = {0.1, 1.5, 1.6}, a[3] = {0.04, 0.01, 0.02}, dt = 1e-4;
      ck_ok(&w, mpm_surface_add(s, 1, x, a, NULL));
      const mpm_step_info info = world_step(&w, dt);
      double *f = markers(s, "force", dim), wall[3] = {0.0};
      ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MIN, wall));
      for (int32_t c = 0; c < dim; ++c)
        ck_within(how->name, info.momentum[c], dt * (f[c] + wall[c]), 1e-11 * dt * fabs(f[c]));
      ck_assert_double_lt(wall[0], -1e-3 * fabs(f[0]));
      free(f);
      drop_surface(&w, s);
      world_close(&w);
    }
}
END_TEST

START_TEST(buoyancy) {
  const method *how = broad_methods[_i];
  if (!is_explicit(how)) return;
  world w;
  open_block(&w, how, 2);
  mpm_surface *s = put_surface(&w, NULL);
  water of = {3.0, 9810.0, 0, 0.0, 0.0};
  add_circle(&w, s, 0.4, 0.1);
  ck_ok(&w, mpm_surface_set_traction(s, push_by_depth, &of));
  const double lift = of.weight * area_of_circle(0.4);
  resultant sum = on_nodes(&w);
  ck_within(how->name, sum.force[1], lift, 1e-12 * sum.scale);
  ck_within(how->name, sum.force[0], 0.0, 1e-12 * sum.scale);
  ck_holds(of.t == 0.0 && of.dt == 1e-4);
  ck_ok(&w, mpm_surface_set_traction(s, NULL, NULL));
  double *x = markers(s, "position", 2);
  const int64_t n = mpm_surface_count(s);
  for (int64_t i = 0; i < n; ++i) x[i] = of.weight * (of.level - x[n + i]);
  ck_ok(&w, mpm_surface_set(s, "pressure", MPM_F64, 1, n, NULL, x)); /* the same by the markers' own */
  sum = on_nodes(&w);
  ck_within(how->name, sum.force[1], lift, 1e-12 * sum.scale);
  free(x);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* A node that hardly any particle reaches takes hardly any force: its acceleration is of the size of the
 * others'. */
START_TEST(light_nodes_take_little) {
  world w;
  const world_desc desc = world_default(2, CELLS, spacing);
  world_open(&w, &desc);
  const double edge = 1.5 * spacing - 0.02 * spacing,
               volume = 0.25 * spacing * spacing; /* a hundredth of a cell */
  for (int32_t i = 0; i < 8; ++i)
    for (int32_t k = 0; k < 8; ++k) {
      const double x[2] = {2.0 + 2.0 * spacing - edge - 0.5 * spacing * i, 1.0 + 0.5 * spacing * (k + 0.5)};
      ck_ok(&w, mpm_particles_add(w.set[0], 1, x, NULL, &volume, NULL, NULL, NULL));
    }
  mpm_surface_desc d = load_desc();
  d.pressure = 1000.0;
  mpm_surface *s = put_surface(&w, &d);
  const double at[2] = {2.0 + 2.0 * spacing - edge + 0.25 * spacing, 1.5}, area[2] = {0.1, 0.0};
  ck_ok(&w, mpm_surface_add(s, 1, at, area, NULL));
  int64_t n;
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-4));
  double *f = fetch_nodes(&w, "force", &n), *m = fetch_nodes(&w, "mass", &n), most = 0.0, least = INFINITE;
  for (int64_t i = 0; i < n; ++i) {
    if (fabs(f[i]) > 0.0 && m[i] < least) least = m[i];
    most = fmax(most, fabs(f[i]) / m[i]);
  }
  ck_within("total", sum_of(n, f), -100.0, 1e-11);
  ck_assert(least < 1e-3 * 1e3 * spacing * spacing);
  ck_between("largest acceleration", most, 0.0, 20.0 * 100.0 / (1e3 * spacing * spacing));
  free(f);
  free(m);
  ck_ok(&w, mpm_step_abort(w.stepper));
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* A marker that lies off a row of nodes without mass by rounding gives all of its force to the others. */
START_TEST(beside_rows_without_mass) {
  for (int32_t basis = MPM_LINEAR; basis <= MPM_BSPLINE3; ++basis)
    for (int32_t i = 0; i < 6; ++i) {
      world w;
      world_desc desc = world_default(2, 8, 0.1);
      desc.grid.basis = basis;
      desc.grid.boundary_basis = basis != MPM_LINEAR;
      world_open(&w, &desc);
      const double low[2] = {0.1, 0.3}, high[2] = {0.6, 0.7}, area[2] = {0.0, 0.05};
      const double at[2] = {0.33 + 0.011 * i, 0.8 - (i % 3 + 1) * 0x1p-53};
      world_fill(&w, w.set[0], low, high, 2);
      mpm_surface_desc d = load_desc();
      d.traction[1] = -100.0;
      mpm_surface *s = put_surface(&w, &d);
      ck_ok(&w, mpm_surface_add(s, 1, at, area, NULL));
      world_step(&w, 1e-3);
      double force[2], edges[2];
      ck_ok(&w, mpm_surface_get(s, "force", MPM_F64, 2, 1, NULL, force));
      ck_ok(&w, mpm_surface_get(s, "area", MPM_F64, 2, 1, NULL, edges));
      ck_within("force", force[1], -5.0, 1e-9);
      ck_within("what arrives", w.info.momentum[1], 1e-3 * force[1], 1e-14);
      ck_within("area", edges[1], area[1], 1e-3 * area[1]);
      drop_surface(&w, s);
      world_close(&w);
    }
}
END_TEST

Suite *surface_suite(void);
Suite *surface_suite(void) {
  Suite *suite = suite_create("surface");
  TCase *loads = tcase_create("loads");
  tcase_add_loop_test(loads, closed_under_pressure, 0, BROAD);
  tcase_add_loop_test(loads, tractions_keep_force_and_moment, 0, BROAD);
  tcase_add_loop_test(loads, loads_beside_walls, 0, BROAD);
  tcase_add_loop_test(loads, buoyancy, 0, BROAD);
  tcase_add_test(loads, light_nodes_take_little);
  tcase_add_test(loads, beside_rows_without_mass);
  tcase_set_timeout(loads, 60);
  suite_add_tcase(suite, loads);
  add_surface_motion(suite);
  add_surface_states(suite);
  add_surface_implicit(suite);
  return suite;
}
