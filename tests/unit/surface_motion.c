/* Surfaces: how markers move and stretch, and where they go at the faces of the grid. */
#include "surfaces.h"
#include "tables.h"

static const double rates[3][3] = {{0.4, -0.3, 0.1}, {0.5, -0.2, 0.3}, {-0.1, 0.2, 0.6}};
static void linear(const double *x, double *v) {
  for (int32_t k = 0; k < 3; ++k)
    v[k] = rates[k][0] * (x[0] - 1.5) + rates[k][1] * (x[1] - 1.5) + rates[k][2] * (x[2] - 1.5);
}

static int32_t moves_by_nodes(const method *how) {
  return is_explicit(how) && how->position_order != 2 && !how->projected;
}

/* Against v = x - c pressure has the power -dim p V: also across faces, where nodes are missing. */
START_TEST(power_of_pressure) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 2; dim <= 3 && moves_by_nodes(how); ++dim) {
    world w;
    open_block(&w, how, dim);
    mpm_surface_desc d = load_desc();
    d.pressure = 1000.0;
    mpm_surface *s = put_surface(&w, &d);
    add_closed(&w, s, 0.62);
    const double dt = 1e-3, volume = dim == 2 ? area_of_circle(0.62) : 4.0 / 3.0 * pow(0.62, 3.0);
    const mpm_step_info info = step_with(&w, dt, away);
    double *v = markers(s, "velocity", dim), *f = markers(s, "force", dim), power = 0.0;
    for (int64_t i = 0; i < dim * mpm_surface_count(s); ++i) power += v[i] * f[i];
    ck_within(how->name, power, -dim * 1000.0 * volume, 1e-11 * 1000.0);
    show("%s %dd: work %g of %g\n", how->name, dim, info.external_work, power * dt);
    ck_within(how->name, info.external_work, power * dt, 1e-11 * fabs(power * dt));
    free(v);
    free(f);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* In a linear field markers move and stretch with F = 1 + dt grad v, and area vectors with det F F^-T. */
START_TEST(linear_fields_are_exact) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 2; dim <= 3 && moves_by_nodes(how); ++dim) {
    world w;
    open_block(&w, how, dim);
    mpm_surface *s = put_surface(&w, NULL);
    add_closed(&w, s, 0.62);
    const int64_t n = mpm_surface_count(s);
    const double dt = 0.02;
    double *x = markers(s, "position", dim), *a = markers(s, "area", dim);
    step_with(&w, dt, linear);
    double *y = markers(s, "position", dim), *b = markers(s, "area", dim),
           *u = markers(s, "displacement", dim);
    double F[9];
    for (int32_t e = 0; e < 9; ++e) F[e] = (e % 4 ? 0.0 : 1.0);
    for (int32_t r = 0; r < dim; ++r)
      for (int32_t c = 0; c < dim; ++c) F[3 * r + c] += dt * rates[r][c];
    for (int64_t i = 0; i < n; ++i)
      for (int32_t k = 0; k < dim; ++k) {
        double back = 0.0, moved = 0.0; /* F^T a' = det F a */
        for (int32_t c = 0; c < dim; ++c) {
          back += F[3 * c + k] * b[c * n + i];
          moved += dt * rates[k][c] * (x[c * n + i] - 1.5);
        }
        ck_within(how->name, back, determinant(F) * a[k * n + i], 1e-13);
        ck_within(how->name, u[k * n + i], moved, 1e-14);
        ck_within(how->name, y[k * n + i], x[k * n + i] + moved, 1e-14);
      }
    free(x), free(a), free(y), free(b), free(u);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

static void wavy(const double *x, double *v) {
  v[0] = sin(2.0 * x[0] + 3.0 * x[1]);
  v[1] = cos(3.0 * x[0] - x[1]);
  v[2] = 0.0;
}

/* An edge is stretched as the line between two markers close to each other: Nanson's relation by
 * differences. */
START_TEST(nanson_by_differences) {
  const method *how = broad_methods[_i];
  if (!moves_by_nodes(how) || how->basis == MPM_LINEAR || how->basis == MPM_UGIMP) return; /* kinks */
  world w;
  open_block(&w, how, 2);
  mpm_surface *s = put_surface(&w, NULL);
  const double d = 1e-5, length = 0.1, angle = 0.7, e[2] = {cos(angle), sin(angle)};
  for (int32_t k = 0; k < 6; ++k) {
    const double at[2] = {1.2 + 0.113 * k, 1.3 + 0.077 * k}, area[2] = {length * e[1], -length * e[0]};
    const double pair[4] = {at[0] - d * e[0], at[0] + d * e[0], at[1] - d * e[1], at[1] + d * e[1]};
    ck_ok(&w, mpm_surface_add(s, 1, at, area, NULL));
    ck_ok(&w, mpm_surface_add(s, 2, pair, NULL, NULL));
  }
  step_with(&w, 0.05, wavy);
  const int64_t n = mpm_surface_count(s);
  double *x = markers(s, "position", 2), *a = markers(s, "area", 2);
  for (int64_t i = 0; i < n; i += 3) {
    ck_within(how->name, a[i] / length, (x[n + i + 2] - x[n + i + 1]) / (2.0 * d), 1e-8);
    ck_within(how->name, -a[n + i] / length, (x[i + 2] - x[i + 1]) / (2.0 * d), 1e-8);
  }
  free(x);
  free(a);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* A body that flies as one takes its markers along, over a seam too. */
START_TEST(flight_across_a_seam) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 1; dim <= 3 && is_explicit(how); ++dim) {
    if (dim == 1 && how->remedy) continue;
    world w;
    world_desc desc = world_with(how, dim, CELLS, spacing);
    desc.grid.periodic[0] = 1;
    mpm_particles *set = open_block_with(&w, &desc);
    const double v[3] = {25.0, 0.5, -0.25}, dt = 2e-3;
    ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, v));
    mpm_surface_desc d = load_desc();
    d.pressure = 10.0;
    mpm_surface *s = put_surface(&w, &d);
    add_closed(&w, s, 0.62);
    const int64_t n = mpm_surface_count(s);
    double *x = markers(s, "position", dim);
    const double momentum = world_info(&w).momentum[0], mass = momentum / v[0];
    enum { STEPS = 60 }; /* 3 lengths of 25 * 2e-3 * 60: one period */
    for (int32_t i = 0; i < STEPS; ++i) world_step(&w, dt);
    double *y = markers(s, "position", dim), *u = markers(s, "displacement", dim);
    ck_within(how->name, world_info(&w).momentum[0], momentum, 1e-11 * mass * v[0]);
    for (int64_t i = 0; i < n; ++i)
      for (int32_t k = 0; k < dim; ++k) {
        const double way = v[k] * dt * STEPS, turns = k ? 0.0 : 3.0;
        /* the pressure deforms the block a little */
        ck_within(how->name, u[k * n + i], way, 1e-3);
        ck_within(how->name, y[k * n + i], x[k * n + i] + u[k * n + i] - turns, 1e-12);
      }
    free(x), free(y), free(u);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* Markers of a body that falls fall as its particles do, of whatever order positions are. */
START_TEST(falls_with_its_particles) {
  const method *how = broad_methods[_i];
  world w;
  world_desc desc = world_with(how, 2, CELLS, spacing);
  desc.stepper.gravity[1] = -9.81;
  mpm_particles *set = open_block_with(&w, &desc);
  mpm_surface *s = put_surface(&w, NULL);
  add_circle(&w, s, 0.62, 0.1);
  const double from = fetch1(&w, set, "position", 2, 1, 0), dt = 4e-3;
  for (int32_t i = 0; i < 25; ++i) world_step(&w, dt);
  const double way = fetch1(&w, set, "position", 2, 1, 0) - from;
  const int64_t n = mpm_surface_count(s);
  double *u = markers(s, "displacement", 2);
  ck_assert(way < -0.04);
  for (int64_t i = 0; i < n; ++i) ck_within(how->name, u[n + i], way, 1e-12);
  free(u);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* Half a block on a slip wall under pressure is half of the whole one. */
START_TEST(half_on_a_slip_wall) {
  const method *how = broad_methods[_i];
  /* functions of open knots are others at a face than within */
  if (!is_explicit(how) || how->boundary == MPM_BOUNDARY_OPEN_KNOT) return;
  double *x[2], *f[2];
  for (int32_t half = 0; half < 2; ++half) {
    world w;
    world_desc desc = world_with(how, 2, CELLS, spacing);
    desc.grid.origin[0] = half ? 0.0 : -1.5;
    mpm_particles *set = world_open(&w, &desc);
    if (half) ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
    const double low[] = {half ? 0.0 : -0.75, 1.0}, high[] = {0.75, 2.0};
    world_fill(&w, set, low, high, 2);
    mpm_surface_desc d = load_desc();
    d.pressure = 3000.0;
    mpm_surface *s = put_surface(&w, &d);
    /* markers 0 to 2 are those of the half */
    const double at[2][10] = {{0.05, 0.3, 0.6, -0.05, -0.3, -0.6, 0.75, -0.75, 0.0, 0.0},
                              {2.0, 2.0, 2.0, 2.0, 2.0, 2.0, 1.5, 1.5, 1.5, 1.5}};
    const int32_t whole[8] = {0, 1, 2, 6, 3, 4, 5, 7};
    for (int32_t k = 0; k < (half ? 4 : 8); ++k) {
      const double p[2] = {at[0][whole[k]], at[1][whole[k]]};
      const int32_t side = whole[k] >= 6;
      const double a[2] = {side ? (p[0] > 0.0 ? 0.2 : -0.2) : 0.0, side ? 0.0 : 0.2};
      ck_ok(&w, mpm_surface_add(s, 1, p, a, NULL));
    }
    for (int32_t i = 0; i < 20; ++i) world_step(&w, 5e-4);
    x[half] = markers(s, "position", 2);
    f[half] = markers(s, "velocity", 2);
    drop_surface(&w, s);
    world_close(&w);
  }
  for (int32_t i = 0; i < 4; ++i)
    for (int32_t k = 0; k < 2; ++k) {
      ck_within(how->name, x[1][k * 4 + i], x[0][k * 8 + i], 1e-11);
      ck_within(how->name, f[1][k * 4 + i], f[0][k * 8 + i], 1e-9);
    }
  for (int32_t half = 0; half < 2; ++half) free(x[half]), free(f[half]);
}
END_TEST

/* A dead load on a marker is a force on the particle where it lies: next to a slip wall, in every scheme. */
START_TEST(as_a_force_on_a_particle) {
  const method *how = broad_methods[_i];
  if (is_gimp(how->basis)) return; /* particles have domains of their own */
  double *x[2];
  int64_t n = 0;
  for (int32_t by_marker = 0; by_marker < 2; ++by_marker) {
    world w;
    world_desc desc = world_with(how, 2, CELLS, spacing);
    mpm_particles *set = world_open(&w, &desc);
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
    const double low[] = {0.0, 1.0}, high[] = {1.0, 2.0}, wanted[] = {0.0625, 1.5625};
    n = world_fill(&w, set, low, high, 2);
    double *at = fetch(&w, set, "position", 2);
    for (int64_t i = 0; i < n; ++i) {
      const double from[2] = {at[i], at[n + i]}, area[2] = {0.2, 0.0},
                   force[2] = {-3000.0 * 0.2, 2000.0 * 0.2};
      if (fabs(from[0] - wanted[0]) + fabs(from[1] - wanted[1]) > 1e-6) continue;
      if (!by_marker) {
        ck_ok(&w, mpm_particles_set(set, "applied_force", MPM_F64, 2, 1, &i, force));
        continue;
      }
      mpm_surface_desc d = load_desc();
      d.dead_traction[0] = -3000.0, d.dead_traction[1] = 2000.0;
      ck_ok(&w, mpm_surface_add(put_surface(&w, &d), 1, from, area, NULL));
    }
    free(at);
    for (int32_t i = 0; i < 8; ++i) world_step(&w, 5e-4);
    x[by_marker] = fetch(&w, set, "position", 2);
    mpm_surface *s = by_marker ? w.stepper->settings.surfaces.surface[0] : NULL;
    if (s) drop_surface(&w, s);
    world_close(&w);
  }
  for (int64_t i = 0; i < 2 * n; ++i)
    ck_within(how->name, x[1][i], x[0][i], is_explicit(how) ? 1e-12 : 1e-10);
  free(x[0]);
  free(x[1]);
}
END_TEST

/* A ring under inner pressure swings: nothing moves it as a whole, and its energy is that of the work. */
START_TEST(ring_under_pressure) {
  world w;
  world_desc desc = world_default(2, 24, 0.125);
  world_open(&w, &desc);
  double at[2 * 64], inside = 0.5, outside = 1.0;
  for (double y = -outside; y < outside; y += 0.0625)
    for (double x = -outside; x < outside; x += 0.0625) {
      const double p[2] = {1.5 + x + 0.03125, 1.5 + y + 0.03125}, volume = 0.0625 * 0.0625;
      const double r = sqrt((p[0] - 1.5) * (p[0] - 1.5) + (p[1] - 1.5) * (p[1] - 1.5));
      if (r < inside || r > outside) continue;
      ck_ok(&w, mpm_particles_add(w.set[0], 1, p, NULL, &volume, NULL, NULL, NULL));
    }
  for (int32_t i = 0; i < 64; ++i) { /* clockwise: the material is outside of it */
    at[i] = 1.5 + inside * cos(2.0 * PI * i / 64);
    at[64 + i] = 1.5 - inside * sin(2.0 * PI * i / 64);
  }
  mpm_surface_desc d = load_desc();
  d.pressure = 2000.0;
  mpm_surface *s = put_surface(&w, &d);
  ck_ok(&w, mpm_surface_add_polyline(s, 64, at, 1, 0.0625, NULL, NULL));
  const double dt = 0.3 * world_stable_dt(&w);
  double most = 0.0, gained = 0.0;
  for (int32_t i = 0; i < 10000; ++i) {
    const mpm_step_info info = world_step(&w, dt);
    const double energy = info.kinetic_energy + info.strain_energy;
    most = energy > most ? energy : most;
    gained = energy - info.external_work_total > gained ? energy - info.external_work_total : gained;
  }
  const mpm_step_info info = world_info(&w);
  const double mass = mass_of(&w, w.set[0]);
  show("ring: energy at most %g, at the end %g, work %g, gained %g, momentum %g %g\n", most,
       info.kinetic_energy + info.strain_energy, info.external_work_total, gained, info.momentum[0],
       info.momentum[1]);
  ck_assert_double_gt(most, 1.0);
  for (int32_t k = 0; k < 2; ++k) ck_within("momentum", info.momentum[k], 0.0, 1e-12 * mass);
  ck_between("energy is that of the work", gained, 0.0, 0.05 * most);
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

/* ---- faces of the grid --------------------------------------------------------------------------------- */
START_TEST(beyond_the_grid) {
  world w;
  mpm_particles *set = open_block(&w, &methods[0], 2);
  const double v[2] = {100.0, 0.0};
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  mpm_surface *s = put_surface(&w, NULL), *first = put_surface(&w, NULL);
  drop_surface(&w, first);
  for (int32_t k = 0; k < 3; ++k) {
    const double at[2] = {1.4 + 0.3 * k, 1.5};
    ck_ok(&w, mpm_surface_add(s, 1, at, NULL, NULL));
  }
  const double place[2] = {2.99, 1.5};
  const int64_t two = 2;
  ck_ok(&w, mpm_surface_set(s, "position", MPM_F64, 2, 1, &two, place));
  mpm_step_info info = {.struct_size = sizeof info};
  /* there is no material around it: it stays, as it carries nothing */
  ck_ok(&w, mpm_step(w.stepper, 1e-6, &info));
  const double near[2] = {2.15, 1.5};
  ck_ok(&w, mpm_surface_set(s, "position", MPM_F64, 2, 1, &two, near));
  world_bits was = world_take(&w);
  ck_refused(&w, mpm_step(w.stepper, 0.0087, &info), MPM_OFF_GRID,
             "marker 2 of surface 0 would leave the grid through MPM_X_MAX");
  ck_assert_int_eq(info.cause, MPM_OFF_GRID);
  world_same(&w, &was, "markers too");
  bits_drop(&was);
  /* through an open wall it goes for good */
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MAX, MPM_WALL_OPEN, 0.0));
  ck_ok(&w, mpm_step(w.stepper, 0.0087, &info));
  ck_assert_int_eq(mpm_surface_count(s), 2);
  double out[2];
  ck_refused(&w, mpm_surface_get(s, "position", MPM_F64, 2, 1, &two, out), MPM_E_NOT_FOUND, "id 2");
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

void add_surface_motion(Suite *suite) {
  TCase *motion = tcase_create("motion");
  tcase_add_loop_test(motion, power_of_pressure, 0, BROAD);
  tcase_add_loop_test(motion, linear_fields_are_exact, 0, BROAD);
  tcase_add_loop_test(motion, nanson_by_differences, 0, BROAD);
  add_sparse(motion, flight_across_a_seam, BROAD, 5);
  tcase_add_loop_test(motion, falls_with_its_particles, 0, BROAD);
  tcase_add_loop_test(motion, half_on_a_slip_wall, 0, BROAD);
  tcase_add_loop_test(motion, as_a_force_on_a_particle, 0, BROAD);
  add_sparse(motion, ring_under_pressure, 1, 2);
  tcase_add_test(motion, beyond_the_grid);
  tcase_set_timeout(motion, 60);
  suite_add_tcase(suite, motion);
}
