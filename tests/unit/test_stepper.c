/* The stepper: what sets, schemes and forces do to a step, seen from outside. Arguments, staged steps, nodes,
 * mpm_advance() and callbacks have files of their own: stepper_*.c. */
#include "stepper_parts.h"

static body_desc numbered(int32_t i) {
  body_desc o = {.dim = 1 + i / PLAIN, .method = *broad_methods[i % PLAIN]};
  return o;
}
enum { COMBINATIONS = 3 * PLAIN };

/* Undeformed neo-Hookean and elastic particles: c^2 = (lambda + 2 mu) / density. */
START_TEST(stable_dt_by_hand) {
  const double mu = body_E / (2.0 * (1.0 + body_nu)), lambda = 2.0 * mu * body_nu / (1.0 - 2.0 * body_nu);
  const double c = sqrt((lambda + 2.0 * mu) / body_density);
  for (int32_t dim = 1; dim <= 3; ++dim) {
    world r;
    double dt, rate = 0.0;
    body_open(&r, &(body_desc){.dim = dim});
    for (int32_t m = 0; m < 2; ++m) {
      const int64_t n = mpm_particles_count(r.set[m]);
      double *v = fetch(&r, r.set[m], "velocity", dim);
      for (int32_t k = 0; k < dim; ++k)
        for (int64_t i = 0; i < n; ++i) rate = fmax(rate, (fabs(v[k * n + i]) + c) / body_spacing[k]);
      free(v);
    }
    ck_ok(&r, mpm_stable_dt(r.stepper, &dt));
    ck_within("stable dt", dt, 1.0 / rate, 1e-13 / rate);
    world_steps(&r, 3);
    ck_ok(&r, mpm_stable_dt(r.stepper, &dt));
    ck_assert_double_eq(r.info.dt_suggested, dt);
    world_close(&r);
  }
}
END_TEST

/* Inert slots, undeformed, would be faster than the particles here. */
START_TEST(stable_dt_of_a_stretched_body) {
  const double mu = body_E / (2.0 * (1.0 + body_nu)), lambda = 2.0 * mu * body_nu / (1.0 - 2.0 * body_nu);
  const double F[9] = {1.3, 0.0, 0.0, 0.0, 1.3, 0.0, 0.0, 0.0, 1.3}, zero[3] = {0.0, 0.0, 0.0};
  const double c = sqrt((lambda + mu - 3.0 * lambda * log(1.3) + mu * 1.69) / body_density);
  ck_assert_double_lt(c, 0.95 * sqrt((lambda + 2.0 * mu) / body_density));
  world r;
  double dt;
  body_open(&r, &(body_desc){.dim = 3});
  ck_ok(&r, mpm_stepper_remove(r.stepper, r.set[1]));
  ck_ok(&r, mpm_particles_set_all(r.set[0], "deformation_gradient", MPM_F64, 9, F));
  ck_ok(&r, mpm_particles_set_all(r.set[0], "velocity", MPM_F64, 3, zero));
  ck_ok(&r, mpm_stable_dt(r.stepper, &dt));
  ck_within("stable dt", dt, 0.09 / c, 1e-12 * dt);
  world_step(&r, 1e-12);
  ck_within("suggested dt", r.info.dt_suggested, 0.09 / c, 1e-9 * dt);
  ck_ok(&r, mpm_stepper_add(r.stepper, r.set[1]));
  world_close(&r);
}
END_TEST

/* Without stress, walls and callbacks every particle falls alike. */
START_TEST(free_fall) {
  const body_desc o = numbered(_i);
  static const double g[3] = {2.0, -3.0, 5.0}, v[3] = {1.0, 2.0, -1.0};
  world r;
  body_open(&r, &o);
  body_calm(&r);
  mpm_stepper_desc d = body_stepper(&r);
  d.scheme = o.method.scheme;
  d.transfer = o.method.transfer;
  d.flip = o.method.flip;
  memcpy(d.gravity, g, sizeof g);
  ck_ok(&r, mpm_stepper_configure(r.stepper, &d));
  double *x[2], momentum[3] = {0.0, 0.0, 0.0}, mass = 0.0;
  for (int32_t m = 0; m < 2; ++m) {
    ck_ok(&r, mpm_particles_set_all(r.set[m], "velocity", MPM_F64, o.dim, v));
    x[m] = fetch(&r, r.set[m], "position", o.dim);
  }
  const int32_t steps = 6;
  world_steps(&r, steps);
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r.set[m]);
    double *now = fetch(&r, r.set[m], "position", o.dim), *u = fetch(&r, r.set[m], "velocity", o.dim);
    double *weight = fetch(&r, r.set[m], "mass", 1);
    for (int32_t k = 0; k < o.dim; ++k)
      for (int64_t i = 0; i < n; ++i) {
        ck_within("velocity", u[k * n + i], v[k] + g[k] * steps * BODY_DT, 1e-12);
        ck_within("displacement", now[k * n + i] - x[m][k * n + i],
                  BODY_DT * (steps * v[k] + g[k] * BODY_DT * steps * (steps + 1) / 2), 1e-12);
        momentum[k] += weight[i] * u[k * n + i];
        if (k == 0) mass += weight[i];
      }
    free(now), free(u), free(weight), free(x[m]);
  }
  double work = 0.0;
  for (int32_t k = 0; k < o.dim; ++k) {
    ck_within("momentum", r.info.momentum[k], momentum[k], 1e-12 * mass * 5.0);
    work += mass * g[k] * BODY_DT * (v[k] + g[k] * steps * BODY_DT);
  }
  ck_within("work of gravity", r.info.external_work, work, 1e-11 * mass);
  for (int32_t k = o.dim; k < 3; ++k) ck_assert_double_eq(r.info.momentum[k], 0.0);
  world_close(&r);
}
END_TEST

/* ---- fields that a stepper keeps ---- */
START_TEST(reference_positions) {
  body_desc o = {.dim = 1 + _i % 3, .periodic = _i / 3};
  world r;
  double reference[3];
  body_open(&r, &o);
  const int64_t id = 1;
  ck_refused(&r, mpm_particles_get(r.set[0], "reference_position", MPM_F64, o.dim, 1, &id, reference),
             MPM_E_STATE, "reference_positions");
  world_steps(&r, 2);
  mpm_stepper_desc d = body_stepper(&r);
  d.reference_positions = 1;
  double *start[2];
  for (int32_t m = 0; m < 2; ++m) start[m] = fetch(&r, r.set[m], "position", o.dim);
  const uint64_t hash = world_hash(&r);
  ck_ok(&r, mpm_stepper_configure(r.stepper, &d));
  ck_assert(world_hash(&r) == hash); /* as it is to begin with */
  world_steps(&r, 9);
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r.set[m]);
    double *now = fetch(&r, r.set[m], "reference_position", o.dim);
    if (o.periodic) /* no particle was lost */
      for (int64_t i = 0; i < n * o.dim; ++i) ck_assert_double_eq(now[i], start[m][i]);
    else
      ck_assert_double_eq(now[0], start[m][0]);
    free(now), free(start[m]);
  }
  d.reference_positions = 0;
  ck_ok(&r, mpm_stepper_configure(r.stepper, &d));
  ck_refused(&r, mpm_particles_get(r.set[0], "reference_position", MPM_F64, o.dim, 1, &id, reference),
             MPM_E_STATE, "reference_positions");
  world_close(&r);
}
END_TEST

/* Joining later, a particle's reference is where it is unwrapped; it goes with the stepper. */
START_TEST(reference_of_a_new_set) {
  world r;
  body_open(&r, &(body_desc){.dim = 2, .periodic = 1});
  world_steps(&r, 25); /* some have crossed the seam */
  ck_ok(&r, mpm_stepper_remove(r.stepper, r.set[0]));
  mpm_stepper_desc d = body_stepper(&r);
  d.reference_positions = 1;
  ck_ok(&r, mpm_stepper_configure(r.stepper, &d));
  ck_ok(&r, mpm_stepper_add(r.stepper, r.set[0]));
  const int64_t n = mpm_particles_count(r.set[0]);
  double *x = fetch(&r, r.set[0], "position", 2), *reference = fetch(&r, r.set[0], "reference_position", 2);
  int64_t *image = fetch_as(&r, r.set[0], "image", MPM_I64, 2), crossed = 0;
  for (int64_t i = 0; i < n; ++i) {
    ck_assert(image[i] == 0 || image[i] == 1); /* everything moves forward */
    crossed += image[i];
    ck_within("unwrapped position", reference[i], x[i] + 3.8 * (double)image[i], 1e-12);
    ck_assert_double_eq(reference[n + i], x[n + i]);
  }
  ck_assert_int_gt(crossed, 0);
  ck_ok(&r, mpm_stepper_remove(r.stepper, r.set[0]));
  const int64_t id = 1;
  ck_refused(&r, mpm_particles_get(r.set[0], "reference_position", MPM_F64, 2, 1, &id, x), MPM_E_STATE,
             "reference");
  ck_ok(&r, mpm_stepper_add(r.stepper, r.set[0]));
  free(x), free(reference), free(image);
  world_close(&r);
}
END_TEST

START_TEST(accelerations) {
  const body_desc o = numbered(_i);
  world r;
  body_open(&r, &o);
  for (int32_t m = 0; m < 2; ++m) {
    const double zero[3] = {0.0, 0.0, 0.0};
    ck_ok(&r, mpm_particles_set_all(r.set[m], "acceleration", MPM_F64, o.dim, zero));
  }
  world_steps(&r, 2);
  double *before[2];
  for (int32_t m = 0; m < 2; ++m) before[m] = fetch(&r, r.set[m], "velocity", o.dim);
  world_steps(&r, 1);
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r.set[m]);
    double *after = fetch(&r, r.set[m], "velocity", o.dim), *a = fetch(&r, r.set[m], "acceleration", o.dim);
    for (int64_t i = 0; i < n * o.dim; ++i)
      ck_within("acceleration", a[i], (after[i] - before[m][i]) / BODY_DT, 1e-9 * (1.0 + fabs(a[i])));
    free(after), free(a), free(before[m]);
  }
  world_close(&r);
}
END_TEST

/* ---- changes between steps ---- */
/* Whatever was configured before, a step depends on the descriptor and the state alone. */
START_TEST(configured_mid_run) {
  world r, other;
  body_desc o = {.dim = 2, .method = *broad_methods[_i % 6]};
  body_open(&r, &o);
  body_desc plain = {.dim = 2};
  body_open(&other, &plain);
  mpm_stepper_desc d = body_stepper(&r); /* of o */
  d.gravity[1] = -10.0;
  for (int32_t m = 0; m < 2; ++m) { /* both start with the affine matrix */
    const double zero[9] = {0.0};
    ck_ok(&r, mpm_particles_set_all(r.set[m], "velocity_gradient", MPM_F64, 9, zero));
    ck_ok(&other, mpm_particles_set_all(other.set[m], "velocity_gradient", MPM_F64, 9, zero));
  }
  ck_ok(&r, mpm_stepper_configure(r.stepper, &d));
  ck_ok(&other, mpm_stepper_configure(other.stepper, &d));
  world_steps(&r, 3);
  world_steps(&other, 3);
  ck_assert(world_hash(&r) == world_hash(&other));
  /* back and forth */
  for (int32_t k = 0; k < 2; ++k) {
    mpm_stepper_desc back = d;
    back.transfer = MPM_FLIP;
    back.scheme = k ? MPM_USL : MPM_MUSL;
    ck_ok(&r, mpm_stepper_configure(r.stepper, &back));
    ck_ok(&r, mpm_stepper_configure(r.stepper, &d));
    world_steps(&r, 1);
    world_steps(&other, 1);
    ck_assert(world_hash(&r) == world_hash(&other));
  }
  ck_assert_int_eq(world_info(&r).step, 5);
  world_close(&r);
  world_close(&other);
}
END_TEST

/* A set that is taken out stays where it is; the other one moves alone, as if there were no other. */
START_TEST(sets_come_and_go) {
  body_desc o = {.dim = 1 + _i};
  world r, alone;
  body_open(&r, &o);
  world_steps(&r, 3);
  size_t bytes, again;
  char *was = world_fields(&r, 0, &bytes);
  body_open(&alone, &o);
  world_steps(&alone, 3);
  ck_ok(&alone, mpm_stepper_remove(alone.stepper, alone.set[0]));
  ck_ok(&r, mpm_stepper_remove(r.stepper, r.set[0]));
  world_steps(&r, 4);
  world_steps(&alone, 4);
  ck_assert(world_hash(&r) == world_hash(&alone));
  char *is = world_fields(&r, 0, &again);
  ck_assert(bytes == again && memcmp(was, is, bytes) == 0);
  free(was), free(is);
  /* numbered in order of joining */
  ck_ok(&r, mpm_stepper_add(r.stepper, r.set[0]));
  world_steps(&r, 2);
  ck_assert(world_hash(&r) != world_hash(&alone));
  ck_ok(&r, mpm_stepper_remove(r.stepper, r.set[1]));
  world_steps(&r, 2);
  ck_ok(&r, mpm_stepper_remove(r.stepper, r.set[0]));
  world_steps(&r, 1); /* nothing at all */
  ck_assert_int_eq(r.info.active_nodes, 0);
  ck_assert_double_eq(r.info.kinetic_energy, 0.0);
  for (int32_t m = 0; m < 2; ++m) ck_ok(&r, mpm_stepper_add(r.stepper, r.set[m]));
  world_steps(&r, 2);
  world_close(&r);
  world_close(&alone);
}
END_TEST

/* Sets without particles, in every order, change nothing. */
START_TEST(empty_sets) {
  world r, other;
  body_desc o = {.dim = 1 + _i};
  body_open(&r, &o);
  body_open(&other, &o);
  mpm_particles *set = world_add_set(&r, &r.desc.other_law);
  world_steps(&r, 8);
  world_steps(&other, 8);
  world_agree("bodies", &r, &other, "position", o.dim, 0.0);
  world_agree("bodies", &r, &other, "velocity", o.dim, 0.0);
  ck_assert_double_eq(r.info.strain_energy, other.info.strain_energy);
  ck_ok(&r, mpm_stepper_remove(r.stepper, set));
  ck_assert(world_hash(&r) == world_hash(&other));
  world_steps(&r, 1); /* sorts anew */
  world_steps(&other, 1);
  world_agree("bodies", &r, &other, "velocity", o.dim, 1e-13);
  world_close(&r);
  world_close(&other);
  o.empty = 1;
  body_open(&r, &o);
  world_steps(&r, 3);
  ck_assert_int_eq(r.info.step, 3);
  world_close(&r);
}
END_TEST

/* Walls may change between any two steps; what they were before leaves no trace. */
START_TEST(walls_change) {
  world r, other;
  body_desc o = {.dim = 3};
  body_open(&r, &o);
  body_open(&other, &o);
  for (int32_t kind = MPM_WALL_NONE; kind <= MPM_WALL_FRICTION_NODES; ++kind) {
    world_steps(&r, 1);
    world_steps(&other, 1);
    ck_ok(&r, mpm_stepper_set_wall(r.stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
    ck_ok(&r, mpm_stepper_set_wall(r.stepper, MPM_Y_MIN, kind == 1 ? 0 : kind, 0.2));
    ck_ok(&other, mpm_stepper_set_wall(other.stepper, MPM_Y_MIN, kind == 1 ? 0 : kind, 0.2));
    double a[3], b[3];
    world_steps(&r, 1);
    world_steps(&other, 1);
    ck_assert(world_hash(&r) == world_hash(&other));
    ck_ok(&r, mpm_stepper_wall_reaction(r.stepper, MPM_Y_MIN, a));
    ck_ok(&other, mpm_stepper_wall_reaction(other.stepper, MPM_Y_MIN, b));
    ck_assert_int_eq(memcmp(a, b, sizeof a), 0);
    if (kind < MPM_WALL_FIXED) ck_assert_double_eq(a[1], 0.0);
  }
  world_close(&r);
  world_close(&other);
}
END_TEST

/* Domains wider than a cell are taken as one cell, and the host is told how many there are. */
static void keep_text(void *user, int32_t level, const char *text) {
  (void)level;
  if (strstr(text, "domains")) snprintf(user, 200, "%s", text);
}

START_TEST(wide_domains_are_counted) {
  char told[200] = "";
  world w;
  world_desc d = world_default(2, 8, 1.0);
  d.context.log = keep_text;
  d.context.log_user = told;
  d.grid.basis = MPM_CPGIMP;
  d.law = (world_law){.model = "neo_hookean", .E = 1.0, .nu = 0.3, .density = 1.0};
  const double x[6] = {2.0, 4.0, 6.0, 4.0, 4.0, 4.0}, volume[3] = {0.25, 0.25, 2.25};
  double F[27] = {0.0};
  for (int32_t p = 0; p < 3; ++p) F[p] = F[12 + p] = F[24 + p] = 1.0;
  F[1] = 2.1; /* of particle 1: half a cell times 2.1 */
  mpm_particles *set = world_open(&w, &d);
  ck_ok(&w, mpm_particles_add(set, 3, x, NULL, volume, NULL, NULL, NULL));
  put(&w, set, "deformation_gradient", 9, F);
  world_step(&w, 1e-3);
  ck_assert_msg(strstr(told, "2 of 3 particles") != NULL, "%s", told);
  world_close(&w);
}
END_TEST

Suite *stepper_suite(void) {
  Suite *suite = suite_create("stepper");
  TCase *tests = tcase_create("whole");
  tcase_set_timeout(tests, 120);
  tcase_add_test(tests, stable_dt_by_hand);
  tcase_add_test(tests, stable_dt_of_a_stretched_body);
  tcase_add_loop_test(tests, free_fall, 0, COMBINATIONS);
  tcase_add_loop_test(tests, reference_positions, 0, 6);
  tcase_add_test(tests, reference_of_a_new_set);
  tcase_add_loop_test(tests, accelerations, 0, COMBINATIONS);
  tcase_add_loop_test(tests, configured_mid_run, 0, 6);
  tcase_add_loop_test(tests, sets_come_and_go, 0, 3);
  tcase_add_loop_test(tests, empty_sets, 0, 3);
  tcase_add_test(tests, walls_change);
  tcase_add_test(tests, wide_domains_are_counted);
  suite_add_tcase(suite, tests);
  suite_add_tcase(suite, stepper_description_case());
  suite_add_tcase(suite, stepper_arguments_case());
  suite_add_tcase(suite, stepper_staged_case());
  suite_add_tcase(suite, stepper_nodes_case());
  suite_add_tcase(suite, stepper_advance_case());
  suite_add_tcase(suite, stepper_callbacks_case());
  suite_add_tcase(suite, stepper_boundary_case());
  suite_add_tcase(suite, stepper_material_case());
  return suite;
}
