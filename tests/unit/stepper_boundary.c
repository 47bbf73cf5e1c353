/* Prescribed nodal velocities: what the callback is given, that it comes before walls, on periodic axes too;
 * open walls and what the set knows of those that left. */
#include "stepper_parts.h"

/* Nodes that the callback was shown in the last step, and what it is to do with them. */
static struct {
  int64_t n, index[8192][3];
  double mass, t, dt;
  int32_t dim, axis; /* that is held, or -1; all axes: 3 */
  double low, high;  /* of x: where */
  double value[3];
} shown;

static mpm_status show(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  ck_assert_ptr_eq(user, &shown);
  ck_assert_uint_eq(b->struct_size, sizeof *b);
  ck_assert_int_eq(b->dim, shown.dim);
  ck_assert_int_eq(b->body, 0);
  ck_assert_int_eq(b->reserved, 0);
  ck_assert_int_gt(b->n, 0);
  ck_assert_int_ge(b->ld, b->n);
  ck_assert_double_eq(b->t, shown.t);
  ck_assert_double_eq(b->dt, shown.dt);
  static const double spacing[3] = {0.1, 0.11, 0.09}, origin[3] = {-0.3, 0.2, 0.1};
  for (int64_t i = 0; i < b->n; ++i) {
    parts_holds(b->mass[i] > 0.0);
    shown.mass += b->mass[i];
    for (int32_t c = 0; c < b->dim; ++c) {
      parts_holds(prescribed[c * b->ld + i] == 0);
      shown.index[shown.n][c] = b->index[c * b->ld + i];
      parts_close(b->position[c * b->ld + i], origin[c] + spacing[c] * (double)b->index[c * b->ld + i], 1e-12,
                  "position of a node");
      if (b->position[i] < shown.low || b->position[i] > shown.high) continue;
      if (c != shown.axis && shown.axis != 3) continue;
      prescribed[c * b->ld + i] = 1;
      velocity[c * b->ld + i] = shown.value[c];
    }
    for (int64_t k = 0; k < shown.n && shown.axis < 0; ++k)
      parts_holds(memcmp(shown.index[k], shown.index[shown.n], sizeof shown.index[k]) != 0); /* once only */
    ++shown.n;
    parts_holds(shown.n < 8192);
  }
  return 0;
}

static void open_shown(run *r, const run_options *o) {
  run_open(r, o);
  memset(&shown, 0, sizeof shown);
  shown.dim = o->dim;
  shown.axis = -1;
  shown.low = -1e9;
  shown.high = 1e9;
  run_ok(r, mpm_stepper_set_velocity_bc(r->stepper, show, &shown));
}

static void shown_step(run *r) {
  shown.n = 0;
  shown.mass = 0.0;
  shown.t = r->info.t;
  shown.dt = RUN_DT;
  run_steps(r, 1);
}

static double all_mass(const run *r) {
  double sum = 0.0;
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r->set[m]);
    double *mass = run_get(r, m, "mass", 1);
    for (int64_t i = 0; i < n; ++i) sum += mass[i];
    free(mass);
  }
  return sum;
}

/* Every node that moves by itself is shown once, and together they have all the mass. */
START_TEST(nodes_shown) {
  run r;
  run_options o = {.dim = 1 + _i % 3, .periodic = _i / 3 % 2, .basis = _i / 6 ? MPM_LINEAR : MPM_BSPLINE2};
  open_shown(&r, &o);
  for (int32_t i = 0; i < 6; ++i) {
    const double mass = all_mass(&r);
    shown_step(&r);
    ck_assert_int_gt(shown.n, 50);
    parts_close(shown.mass, mass, 1e-12 * mass, "mass of the nodes shown");
  }
  run_close(&r);
}
END_TEST

/* All nodes held at one velocity: particles can have no other, whatever walls, contacts and periods say. */
START_TEST(all_nodes_held) {
  run r;
  run_options o = {.dim = 1 + _i / RUN_METHODS % 3, .periodic = _i / RUN_METHODS / 3};
  run_use(&o, &run_methods[_i % RUN_METHODS]);
  open_shown(&r, &o);
  parts_calm(&r);
  run_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, show, &shown));
  memcpy(shown.value, (double[]){3.0, -2.0, 1.0}, sizeof shown.value);
  shown.axis = 3;
  double *x[2];
  for (int32_t m = 0; m < 2; ++m) x[m] = run_get(&r, m, "position", o.dim);
  shown_step(&r);
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r.set[m]);
    double *now = run_get(&r, m, "position", o.dim);
    for (int64_t i = 0; i < n * o.dim; ++i)
      parts_close(now[i] - x[m][i], RUN_DT * shown.value[i / n], 1e-12, "displacement of a held particle");
    free(now);
    free(x[m]);
  }
  run_close(&r);
}
END_TEST

/* Where a wall and the callback both want a node, the callback has it and takes the reaction. */
START_TEST(callback_before_walls) {
  static const int32_t kinds[] = {MPM_WALL_FIXED, MPM_WALL_SLIP, MPM_WALL_FRICTION};
  for (int32_t k = 0; k < 3; ++k) {
    run r;
    double force[3];
    run_options o = {.dim = 2};
    open_shown(&r, &o);
    parts_calm(&r);
    run_ok(&r, mpm_stepper_set_wall(r.stepper, MPM_Y_MIN, kinds[k], 0.5));
    run_steps(&r, 8); /* the body falls onto the wall and is pressed together: it acts */
    run_ok(&r, mpm_stepper_wall_reaction(r.stepper, MPM_Y_MIN, force));
    ck_assert_double_gt(force[1], 1e3);
    run_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, show, &shown));
    memcpy(shown.value, (double[]){0.0, -7.0, 0.0}, sizeof shown.value);
    shown.axis = 1;
    shown_step(&r);
    int64_t n;
    mpm_view index = {.struct_size = sizeof index};
    double *v = run_nodes(&r, "velocity", 2, &n), *reaction = run_nodes(&r, "reaction", 2, &n), booked = 0.0;
    run_ok(&r, mpm_grid_map(r.stepper, 0, "index", MPM_READ, &index));
    int64_t on_wall = 0;
    for (int64_t i = 0; i < n; ++i) {
      const int64_t row = ((int64_t *)index.data)[index.component_stride + i];
      if (row == 0) ++on_wall;
      if (row >= 0) parts_close(v[n + i], -7.0, 1e-12, "held velocity");
      booked += fabs(reaction[n + i]);
    }
    ck_assert_int_gt(on_wall, 10);
    ck_assert_double_gt(booked, 1.0);
    run_ok(&r, mpm_view_release(&index));
    run_ok(&r, mpm_stepper_wall_reaction(r.stepper, MPM_Y_MIN, force));
    parts_close(force[1], 0.0, 1e-9 * booked, "normal reaction of a wall that holds nothing");
    free(v);
    free(reaction);
    run_close(&r);
  }
}
END_TEST

/* The callback holds one axis and a region; walls keep the rest. */
START_TEST(callback_beside_walls) {
  run r;
  double force[3];
  run_options o = {.dim = 2};
  open_shown(&r, &o);
  parts_calm(&r);
  run_ok(&r, mpm_stepper_set_wall(r.stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  run_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, show, &shown));
  for (int32_t i = 0; i < 8; ++i) shown_step(&r); /* nothing is held yet */
  shown.axis = 0;
  shown.value[0] = 4.0;
  shown.high = 1.5;
  shown_step(&r);
  mpm_view index = {.struct_size = sizeof index};
  int64_t n, held = 0, bound = 0;
  double *v = run_nodes(&r, "velocity", 2, &n), *x = run_nodes(&r, "position", 2, &n);
  run_ok(&r, mpm_grid_map(r.stepper, 0, "index", MPM_READ, &index));
  for (int64_t i = 0; i < n; ++i) {
    if (x[i] <= 1.5) parts_close(v[i], 4.0, 1e-12, "held velocity"), ++held;
    if (((int64_t *)index.data)[index.component_stride + i] == 0)
      parts_close(v[n + i], 0.0, 1e-12, "velocity into the wall"), ++bound;
  }
  ck_assert(held > 10 && bound > 10);
  run_ok(&r, mpm_view_release(&index));
  run_ok(&r, mpm_stepper_wall_reaction(r.stepper, MPM_Y_MIN, force));
  ck_assert_double_gt(force[1], 1.0);
  free(v);
  free(x);
  run_close(&r);
}
END_TEST

/* The work of a callback that pulls everything from rest in one step is the kinetic energy. */
START_TEST(work_of_the_callback) {
  run r;
  run_options o = {.dim = 2};
  open_shown(&r, &o);
  parts_calm(&r);
  for (int32_t m = 0; m < 2; ++m) {
    const double rest[2] = {0.0, 0.0};
    run_ok(&r, mpm_particles_set_all(r.set[m], "velocity", MPM_F64, 2, rest));
  }
  run_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, show, &shown));
  shown.axis = 0;
  shown.value[0] = 5.0;
  shown_step(&r);
  const double mass = all_mass(&r);
  parts_close(r.info.kinetic_energy, 0.5 * mass * 25.0, 1e-10 * mass * 25.0, "kinetic energy");
  parts_close(r.info.external_work, mass * 25.0, 1e-10 * mass * 25.0, "work at the velocity of the step");
  parts_close(r.info.dissipation, 0.5 * mass * 25.0, 1e-10 * mass * 25.0, "what the jerk loses");
  run_close(&r);
}
END_TEST

/* A value that is not finite is named by its node. */
static mpm_status one_bad(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  const int64_t *at = user;
  for (int64_t i = 0; i < b->n; ++i) {
    velocity[i] = RUN_NAN; /* not prescribed: does not count */
    int32_t here = 1;
    for (int32_t c = 0; c < b->dim; ++c) here &= b->index[c * b->ld + i] == at[c];
    prescribed[i] = (uint8_t)here;
  }
  return 0;
}
START_TEST(node_that_failed) {
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t basis = MPM_LINEAR; basis <= MPM_BSPLINE2; ++basis) {
      run r;
      run_options o = {.dim = dim, .basis = basis};
      static const int64_t at[3] = {7, 3, 2}, cells[3][3] = {{142}, {38, 18}, {11, 11, 7}};
      mpm_step_info info = {.struct_size = sizeof info};
      run_open(&r, &o);
      run_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, one_bad, (void *)(uintptr_t)at));
      if (dim == 2) run_close(&r);
      if (dim == 2) continue; /* the body starts at cell 10 */
      run_refused(&r, mpm_step(r.stepper, RUN_DT, &info), MPM_NONFINITE, "prescribed velocity");
      int64_t number = 0; /* with one ghost layer, whatever the basis */
      for (int32_t k = 0; k < dim; ++k) number = number * (cells[dim - 1][k] + 3) + at[k] + 1;
      ck_assert_int_eq(info.node, number);
      ck_assert_int_eq(info.particle, -1);
      ck_assert_int_eq(info.set, -1);
      run_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, NULL, NULL));
      run_steps(&r, 1);
      ck_assert_int_eq(r.info.node, -1);
      run_close(&r);
    }
}
END_TEST

/* ---- open walls ---------------------------------------------------------------------------------------- */
/* Particles that left are gone for every call, also where the set had an index of its ids. */
START_TEST(those_that_left) {
  run r;
  run_open(&r, &(run_options){.dim = 1 + _i});
  int64_t before[2], left = 0;
  int64_t *ids[2];
  for (int32_t i = 0; i < 40 && !left; ++i) {
    for (int32_t m = 0; m < 2; ++m) {
      before[m] = mpm_particles_count(r.set[m]);
      ids[m] = malloc((size_t)before[m] * sizeof *ids[m]);
      run_ok(&r, mpm_particles_get(r.set[m], "id", MPM_I64, 1, before[m], NULL, ids[m]));
    }
    run_steps(&r, 1);
    left = before[0] + before[1] - mpm_particles_count(r.set[0]) - mpm_particles_count(r.set[1]);
    ck_assert_int_eq(r.info.removed, left);
    for (int32_t m = 0; m < 2 && left; ++m) {
      const int64_t n = mpm_particles_count(r.set[m]);
      int64_t *now = malloc((size_t)n * sizeof *now), gone = 0;
      double x[3];
      run_ok(&r, mpm_particles_get(r.set[m], "id", MPM_I64, 1, n, NULL, now));
      for (int64_t k = 0; k < n; ++k) ck_assert_msg(now[k] >= 0 && (k == 0 || now[k] > now[k - 1]), "no id");
      for (int64_t k = 0, at = 0; k < before[m]; ++k) {
        const int32_t is_here = at < n && now[at] == ids[m][k];
        at += is_here;
        if (is_here) continue;
        ++gone;
        run_refused(&r, mpm_particles_get(r.set[m], "position", MPM_F64, 1 + _i, 1, &ids[m][k], x),
                    MPM_E_NOT_FOUND, "no particle with id");
        run_refused(&r, mpm_particles_remove(r.set[m], 1, &ids[m][k]), MPM_E_NOT_FOUND,
                    "no particle with id");
      }
      ck_assert_int_eq(gone, before[m] - n);
      free(now);
    }
    for (int32_t m = 0; m < 2; ++m) free(ids[m]);
  }
  ck_assert_int_gt(left, 0);
  mpm_step_info info = {.struct_size = sizeof info};
  run_ok(&r, mpm_stepper_info(r.stepper, &info));
  ck_assert_int_eq(info.removed, left);
  run_steps(&r, 1);
  run_close(&r);
}
END_TEST

TCase *stepper_boundary_case(void) {
  TCase *tests = tcase_create("boundary");
  tcase_set_tags(tests, "long");
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, nodes_shown, 0, 12);
  tcase_add_loop_test(tests, all_nodes_held, 0, 6 * RUN_METHODS);
  tcase_add_test(tests, callback_before_walls);
  tcase_add_test(tests, callback_beside_walls);
  tcase_add_test(tests, work_of_the_callback);
  tcase_add_test(tests, node_that_failed);
  tcase_add_loop_test(tests, those_that_left, 0, 3);
  return tests;
}
