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

static mpm_status look(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  ck_assert_ptr_eq(user, &shown);
  ck_assert_uint_eq(b->struct_size, sizeof *b);
  ck_assert_int_eq(b->dim, shown.dim);
  ck_assert_int_eq(b->body, 0);
  ck_assert_int_eq(b->reserved, 0);
  ck_assert_int_gt(b->n, 0);
  ck_assert_int_ge(b->ld, b->n);
  ck_assert_double_eq(b->t, shown.t);
  ck_assert_double_eq(b->dt, shown.dt);
  for (int64_t i = 0; i < b->n; ++i) {
    ck_holds(b->mass[i] > 0.0);
    shown.mass += b->mass[i];
    for (int32_t c = 0; c < b->dim; ++c) {
      ck_holds(prescribed[c * b->ld + i] == 0);
      shown.index[shown.n][c] = b->index[c * b->ld + i];
      ck_within("position of a node", b->position[c * b->ld + i],
                body_origin[c] + body_spacing[c] * (double)b->index[c * b->ld + i], 1e-12);
      if (b->position[i] < shown.low || b->position[i] > shown.high) continue;
      if (c != shown.axis && shown.axis != 3) continue;
      prescribed[c * b->ld + i] = 1;
      velocity[c * b->ld + i] = shown.value[c];
    }
    for (int64_t k = 0; k < shown.n && shown.axis < 0; ++k)
      ck_holds(memcmp(shown.index[k], shown.index[shown.n], sizeof shown.index[k]) != 0); /* once only */
    ++shown.n;
    ck_holds(shown.n < 8192);
  }
  return 0;
}

static void open_shown(world *r, const body_desc *o) {
  body_open(r, o);
  memset(&shown, 0, sizeof shown);
  shown.dim = o->dim;
  shown.axis = -1;
  shown.low = -1e9;
  shown.high = 1e9;
  ck_ok(r, mpm_stepper_set_velocity_bc(r->stepper, look, &shown));
}

static void shown_step(world *r) {
  shown.n = 0;
  shown.mass = 0.0;
  shown.t = r->info.t;
  shown.dt = BODY_DT;
  world_steps(r, 1);
}

static double all_mass(const world *r) {
  return mass_of(r, r->set[0]) + mass_of(r, r->set[1]);
}

/* Every node that moves by itself is shown once, and together they have all the mass. */
START_TEST(nodes_shown) {
  world r;
  body_desc o = {
      .dim = 1 + _i % 3, .periodic = _i / 3 % 2, .method.basis = _i / 6 ? MPM_LINEAR : MPM_BSPLINE2};
  open_shown(&r, &o);
  for (int32_t i = 0; i < 6; ++i) {
    const double mass = all_mass(&r);
    shown_step(&r);
    ck_assert_int_gt(shown.n, 50);
    ck_within("mass of the nodes shown", shown.mass, mass, 1e-12 * mass);
  }
  world_close(&r);
}
END_TEST

/* All nodes held at one velocity: particles can have no other, whatever walls, contacts and periods say. */
START_TEST(all_nodes_held) {
  world r;
  body_desc o = {.dim = 1 + _i / PLAIN % 3, .periodic = _i / PLAIN / 3, .method = *broad_methods[_i % PLAIN]};
  open_shown(&r, &o);
  body_calm(&r);
  ck_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, look, &shown));
  memcpy(shown.value, (double[]){3.0, -2.0, 1.0}, sizeof shown.value);
  shown.axis = 3;
  double *x[2];
  for (int32_t m = 0; m < 2; ++m) x[m] = fetch(&r, r.set[m], "position", o.dim);
  shown_step(&r);
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r.set[m]);
    double *now = fetch(&r, r.set[m], "position", o.dim);
    for (int64_t i = 0; i < n * o.dim; ++i)
      ck_within("displacement of a held particle", now[i] - x[m][i], BODY_DT * shown.value[i / n], 1e-12);
    free(now);
    free(x[m]);
  }
  world_close(&r);
}
END_TEST

/* Where a wall and the callback both want a node, the callback has it and takes the reaction. */
START_TEST(callback_before_walls) {
  static const int32_t kinds[] = {MPM_WALL_FIXED, MPM_WALL_SLIP, MPM_WALL_FRICTION, MPM_WALL_FRICTION_NODES};
  for (int32_t k = 0; k < 4; ++k) {
    world r;
    double force[3];
    body_desc o = {.dim = 2};
    open_shown(&r, &o);
    body_calm(&r);
    ck_ok(&r, mpm_stepper_set_wall(r.stepper, MPM_Y_MIN, kinds[k], 0.5));
    world_steps(&r, 8); /* the body falls onto the wall and is pressed together: it acts */
    ck_ok(&r, mpm_stepper_wall_reaction(r.stepper, MPM_Y_MIN, force));
    ck_assert_double_gt(force[1], 1e3);
    ck_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, look, &shown));
    memcpy(shown.value, (double[]){0.0, -7.0, 0.0}, sizeof shown.value);
    shown.axis = 1;
    shown_step(&r);
    int64_t n, on_wall = 0, *index = fetch_node_indices(&r, &n);
    double *v = fetch_nodes(&r, "velocity", &n), *reaction = fetch_nodes(&r, "reaction", &n), sum = 0.0;
    for (int64_t i = 0; i < n; ++i) {
      const int64_t row = index[n + i];
      if (row == 0) ++on_wall;
      if (row >= 0) ck_within("held velocity", v[n + i], -7.0, 1e-12);
      sum += fabs(reaction[n + i]);
    }
    ck_assert_int_gt(on_wall, 10);
    ck_assert_double_gt(sum, 1.0);
    ck_ok(&r, mpm_stepper_wall_reaction(r.stepper, MPM_Y_MIN, force));
    ck_within("normal reaction of a wall that holds nothing", force[1], 0.0, 1e-9 * sum);
    free(index), free(v), free(reaction);
    world_close(&r);
  }
}
END_TEST

/* The callback holds one axis and a region; walls keep the rest. */
START_TEST(callback_beside_walls) {
  world r;
  double force[3];
  body_desc o = {.dim = 2};
  open_shown(&r, &o);
  body_calm(&r);
  ck_ok(&r, mpm_stepper_set_wall(r.stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  ck_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, look, &shown));
  for (int32_t i = 0; i < 8; ++i) shown_step(&r); /* nothing is held yet */
  shown.axis = 0;
  shown.value[0] = 4.0;
  shown.high = 1.5;
  shown_step(&r);
  int64_t n, held = 0, bound = 0, *index = fetch_node_indices(&r, &n);
  double *v = fetch_nodes(&r, "velocity", &n), *x = fetch_nodes(&r, "position", &n);
  for (int64_t i = 0; i < n; ++i) {
    held += x[i] <= 1.5;
    bound += index[n + i] == 0;
    if (x[i] <= 1.5) ck_within("held velocity", v[i], 4.0, 1e-12);
    if (index[n + i] == 0) ck_within("velocity into the wall", v[n + i], 0.0, 1e-12);
  }
  ck_assert(held > 10 && bound > 10);
  ck_ok(&r, mpm_stepper_wall_reaction(r.stepper, MPM_Y_MIN, force));
  ck_assert_double_gt(force[1], 1.0);
  free(index), free(v), free(x);
  world_close(&r);
}
END_TEST

/* The work of a callback that pulls everything from rest in one step is the kinetic energy. */
START_TEST(work_of_the_callback) {
  world r;
  body_desc o = {.dim = 2};
  open_shown(&r, &o);
  body_calm(&r);
  for (int32_t m = 0; m < 2; ++m) {
    const double rest[2] = {0.0, 0.0};
    ck_ok(&r, mpm_particles_set_all(r.set[m], "velocity", MPM_F64, 2, rest));
  }
  ck_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, look, &shown));
  shown.axis = 0;
  shown.value[0] = 5.0;
  shown_step(&r);
  const double mass = all_mass(&r);
  ck_within("kinetic energy", r.info.kinetic_energy, 0.5 * mass * 25.0, 1e-10 * mass * 25.0);
  ck_within("work at the velocity of the step", r.info.external_work, mass * 25.0, 1e-10 * mass * 25.0);
  ck_within("what the jerk loses", r.info.dissipation, 0.5 * mass * 25.0, 1e-10 * mass * 25.0);
  world_close(&r);
}
END_TEST

/* A value that is not finite is named by its node. */
static mpm_status one_bad(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  const int64_t *at = user;
  for (int64_t i = 0; i < b->n; ++i) {
    velocity[i] = NOT_A_NUMBER; /* not prescribed: does not count */
    int32_t here = 1;
    for (int32_t c = 0; c < b->dim; ++c) here &= b->index[c * b->ld + i] == at[c];
    prescribed[i] = (uint8_t)here;
  }
  return 0;
}
START_TEST(node_that_failed) {
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t basis = MPM_LINEAR; basis <= MPM_BSPLINE2; ++basis) {
      world r;
      body_desc o = {.dim = dim, .method.basis = basis};
      static const int64_t at[3] = {7, 3, 2};
      mpm_step_info info = {.struct_size = sizeof info};
      body_open(&r, &o);
      ck_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, one_bad, (void *)(uintptr_t)at));
      if (dim == 2) world_close(&r);
      if (dim == 2) continue; /* the body starts at cell 10 */
      ck_refused(&r, mpm_step(r.stepper, BODY_DT, &info), MPM_NONFINITE, "prescribed velocity");
      int64_t number = 0; /* with one ghost layer, whatever the basis */
      for (int32_t k = 0; k < dim; ++k) number = number * (body_cells[dim - 1][k] + 3) + at[k] + 1;
      ck_assert_int_eq(info.node, number);
      ck_assert_int_eq(info.particle, -1);
      ck_assert_int_eq(info.set, -1);
      ck_ok(&r, mpm_stepper_set_velocity_bc(r.stepper, NULL, NULL));
      world_steps(&r, 1);
      ck_assert_int_eq(r.info.node, -1);
      world_close(&r);
    }
}
END_TEST

/* ---- open walls ---- */
/* Particles that left are gone for every call, also where the set had an index of its ids. */
START_TEST(those_that_left) {
  world r;
  body_open(&r, &(body_desc){.dim = 1 + _i});
  int64_t before[2], left = 0;
  int64_t *ids[2];
  for (int32_t i = 0; i < 40 && !left; ++i) {
    for (int32_t m = 0; m < 2; ++m) {
      before[m] = mpm_particles_count(r.set[m]);
      ids[m] = fetch_ids(&r, r.set[m]);
    }
    world_steps(&r, 1);
    left = before[0] + before[1] - mpm_particles_count(r.set[0]) - mpm_particles_count(r.set[1]);
    ck_assert_int_eq(r.info.removed, left);
    for (int32_t m = 0; m < 2 && left; ++m) {
      const int64_t n = mpm_particles_count(r.set[m]);
      int64_t *now = fetch_ids(&r, r.set[m]), gone = 0;
      double x[3];
      for (int64_t k = 0; k < n; ++k) ck_assert_msg(now[k] >= 0 && (k == 0 || now[k] > now[k - 1]), "no id");
      for (int64_t k = 0, at = 0; k < before[m]; ++k) {
        const int32_t is_here = at < n && now[at] == ids[m][k];
        at += is_here;
        if (is_here) continue;
        ++gone;
        ck_refused(&r, mpm_particles_get(r.set[m], "position", MPM_F64, 1 + _i, 1, &ids[m][k], x),
                   MPM_E_NOT_FOUND, "no particle with id");
        ck_refused(&r, mpm_particles_remove(r.set[m], 1, &ids[m][k]), MPM_E_NOT_FOUND, "no particle with id");
      }
      ck_assert_int_eq(gone, before[m] - n);
      free(now);
    }
    for (int32_t m = 0; m < 2; ++m) free(ids[m]);
  }
  ck_assert_int_gt(left, 0);
  ck_assert_int_eq(world_info(&r).removed, left);
  world_steps(&r, 1);
  world_close(&r);
}
END_TEST

TCase *stepper_boundary_case(void) {
  TCase *tests = tcase_create("boundary");
  tcase_set_tags(tests, "long");
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, nodes_shown, 0, 12);
  tcase_add_loop_test(tests, all_nodes_held, 0, 6 * PLAIN);
  tcase_add_test(tests, callback_before_walls);
  tcase_add_test(tests, callback_beside_walls);
  tcase_add_test(tests, work_of_the_callback);
  tcase_add_test(tests, node_that_failed);
  tcase_add_loop_test(tests, those_that_left, 0, 3);
  return tests;
}
