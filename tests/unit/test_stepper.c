/* The stepper: what sets, schemes and forces do to a step, seen from outside. Arguments, staged steps, nodes,
 * mpm_advance() and callbacks have files of their own: stepper_*.c. */
#include "stepper_parts.h"

static run_options numbered(int32_t i) {
  run_options o = {.dim = 1 + i / RUN_METHODS};
  run_use(&o, &run_methods[i % RUN_METHODS]);
  return o;
}
enum { COMBINATIONS = 3 * RUN_METHODS };

/* Undeformed neo-Hookean and elastic particles: c^2 = (lambda + 2 mu) / density. */
START_TEST(stable_dt_by_hand) {
  static const double spacing[3] = {0.1, 0.11, 0.09};
  const double mu = run_E / (2.0 * (1.0 + run_nu)), lambda = 2.0 * mu * run_nu / (1.0 - 2.0 * run_nu);
  const double c = sqrt((lambda + 2.0 * mu) / run_density);
  for (int32_t dim = 1; dim <= 3; ++dim) {
    run r;
    double dt, rate = 0.0;
    run_open(&r, &(run_options){.dim = dim});
    for (int32_t m = 0; m < 2; ++m) {
      const int64_t n = mpm_particles_count(r.set[m]);
      double *v = run_get(&r, m, "velocity", dim);
      for (int32_t k = 0; k < dim; ++k)
        for (int64_t i = 0; i < n; ++i) rate = fmax(rate, (fabs(v[k * n + i]) + c) / spacing[k]);
      free(v);
    }
    run_ok(&r, mpm_stable_dt(r.stepper, &dt));
    parts_close(dt, 1.0 / rate, 1e-13 / rate, "stable dt");
    run_steps(&r, 3);
    run_ok(&r, mpm_stable_dt(r.stepper, &dt));
    ck_assert_double_eq(r.info.dt_suggested, dt);
    run_close(&r);
  }
}
END_TEST

/* Inert slots, undeformed, would be faster than the particles here. */
START_TEST(stable_dt_of_a_stretched_body) {
  const double mu = run_E / (2.0 * (1.0 + run_nu)), lambda = 2.0 * mu * run_nu / (1.0 - 2.0 * run_nu);
  const double F[9] = {1.3, 0.0, 0.0, 0.0, 1.3, 0.0, 0.0, 0.0, 1.3}, zero[3] = {0.0, 0.0, 0.0};
  const double c = sqrt((lambda + mu - 3.0 * lambda * log(1.3) + mu * 1.69) / run_density);
  ck_assert_double_lt(c, 0.95 * sqrt((lambda + 2.0 * mu) / run_density));
  run r;
  double dt;
  run_open(&r, &(run_options){.dim = 3});
  run_ok(&r, mpm_stepper_remove(r.stepper, r.set[1]));
  run_ok(&r, mpm_particles_set_all(r.set[0], "deformation_gradient", MPM_F64, 9, F));
  run_ok(&r, mpm_particles_set_all(r.set[0], "velocity", MPM_F64, 3, zero));
  run_ok(&r, mpm_stable_dt(r.stepper, &dt));
  parts_close(dt, 0.09 / c, 1e-12 * dt, "stable dt");
  run_step_of(&r, 1e-12);
  parts_close(r.info.dt_suggested, 0.09 / c, 1e-9 * dt, "suggested dt");
  run_ok(&r, mpm_stepper_add(r.stepper, r.set[1]));
  run_close(&r);
}
END_TEST

/* Without stress, walls and callbacks every particle falls alike. */
START_TEST(free_fall) {
  const run_options o = numbered(_i);
  static const double g[3] = {2.0, -3.0, 5.0}, v[3] = {1.0, 2.0, -1.0};
  run r;
  run_open(&r, &o);
  parts_calm(&r);
  mpm_stepper_desc d = parts_desc(&r);
  d.scheme = o.scheme;
  d.transfer = o.transfer;
  d.flip = o.flip;
  memcpy(d.gravity, g, sizeof g);
  run_ok(&r, mpm_stepper_configure(r.stepper, &d));
  double *x[2], momentum[3] = {0.0, 0.0, 0.0}, mass = 0.0;
  for (int32_t m = 0; m < 2; ++m) {
    run_ok(&r, mpm_particles_set_all(r.set[m], "velocity", MPM_F64, o.dim, v));
    x[m] = run_get(&r, m, "position", o.dim);
  }
  const int32_t steps = 6;
  run_steps(&r, steps);
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r.set[m]);
    double *now = run_get(&r, m, "position", o.dim), *u = run_get(&r, m, "velocity", o.dim);
    double *weight = run_get(&r, m, "mass", 1);
    for (int32_t k = 0; k < o.dim; ++k)
      for (int64_t i = 0; i < n; ++i) {
        parts_close(u[k * n + i], v[k] + g[k] * steps * RUN_DT, 1e-12, "velocity");
        parts_close(now[k * n + i] - x[m][k * n + i],
                    RUN_DT * (steps * v[k] + g[k] * RUN_DT * steps * (steps + 1) / 2), 1e-12, "displacement");
        momentum[k] += weight[i] * u[k * n + i];
        if (k == 0) mass += weight[i];
      }
    free(now), free(u), free(weight), free(x[m]);
  }
  double work = 0.0;
  for (int32_t k = 0; k < o.dim; ++k) {
    parts_close(r.info.momentum[k], momentum[k], 1e-12 * mass * 5.0, "momentum");
    work += mass * g[k] * RUN_DT * (v[k] + g[k] * steps * RUN_DT);
  }
  parts_close(r.info.external_work, work, 1e-11 * mass, "work of gravity");
  for (int32_t k = o.dim; k < 3; ++k) ck_assert_double_eq(r.info.momentum[k], 0.0);
  run_close(&r);
}
END_TEST

/* ---- fields that a stepper keeps ----------------------------------------------------------------------- */
START_TEST(reference_positions) {
  run_options o = {.dim = 1 + _i % 3, .periodic = _i / 3};
  run r;
  double reference[3];
  run_open(&r, &o);
  const int64_t id = 1;
  run_refused(&r, mpm_particles_get(r.set[0], "reference_position", MPM_F64, o.dim, 1, &id, reference),
              MPM_E_STATE, "reference_positions");
  run_steps(&r, 2);
  mpm_stepper_desc d = parts_desc(&r);
  d.reference_positions = 1;
  double *start[2];
  for (int32_t m = 0; m < 2; ++m) start[m] = run_get(&r, m, "position", o.dim);
  const uint64_t hash = run_hash(&r);
  run_ok(&r, mpm_stepper_configure(r.stepper, &d));
  ck_assert(run_hash(&r) == hash); /* as it is to begin with */
  run_steps(&r, 9);
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r.set[m]);
    int64_t *ids = malloc((size_t)n * sizeof *ids);
    double *now = run_get(&r, m, "reference_position", o.dim);
    run_ok(&r, mpm_particles_get(r.set[m], "id", MPM_I64, 1, n, NULL, ids));
    if (o.periodic) /* no particle was lost */
      for (int64_t i = 0; i < n * o.dim; ++i) ck_assert_double_eq(now[i], start[m][i]);
    else
      ck_assert_double_eq(now[0], start[m][0]);
    free(ids), free(now), free(start[m]);
  }
  d.reference_positions = 0;
  run_ok(&r, mpm_stepper_configure(r.stepper, &d));
  run_refused(&r, mpm_particles_get(r.set[0], "reference_position", MPM_F64, o.dim, 1, &id, reference),
              MPM_E_STATE, "reference_positions");
  run_close(&r);
}
END_TEST

/* Joining later, a particle's reference is where it is unwrapped; it goes with the stepper. */
START_TEST(reference_of_a_new_set) {
  run r;
  run_open(&r, &(run_options){.dim = 2, .periodic = 1});
  run_steps(&r, 25); /* some have crossed the seam */
  run_ok(&r, mpm_stepper_remove(r.stepper, r.set[0]));
  mpm_stepper_desc d = parts_desc(&r);
  d.reference_positions = 1;
  run_ok(&r, mpm_stepper_configure(r.stepper, &d));
  run_ok(&r, mpm_stepper_add(r.stepper, r.set[0]));
  const int64_t n = mpm_particles_count(r.set[0]);
  double *x = run_get(&r, 0, "position", 2), *reference = run_get(&r, 0, "reference_position", 2);
  int64_t *image = malloc((size_t)(2 * n) * sizeof *image), crossed = 0;
  run_ok(&r, mpm_particles_get(r.set[0], "image", MPM_I64, 2, n, NULL, image));
  for (int64_t i = 0; i < n; ++i) {
    ck_assert(image[i] == 0 || image[i] == 1); /* everything moves forward */
    crossed += image[i];
    parts_close(reference[i], x[i] + 3.8 * (double)image[i], 1e-12, "unwrapped position");
    ck_assert_double_eq(reference[n + i], x[n + i]);
  }
  ck_assert_int_gt(crossed, 0);
  run_ok(&r, mpm_stepper_remove(r.stepper, r.set[0]));
  const int64_t id = 1;
  run_refused(&r, mpm_particles_get(r.set[0], "reference_position", MPM_F64, 2, 1, &id, x), MPM_E_STATE,
              "reference");
  run_ok(&r, mpm_stepper_add(r.stepper, r.set[0]));
  free(x), free(reference), free(image);
  run_close(&r);
}
END_TEST

START_TEST(accelerations) {
  const run_options o = numbered(_i);
  run r;
  run_open(&r, &o);
  for (int32_t m = 0; m < 2; ++m) {
    const double zero[3] = {0.0, 0.0, 0.0};
    run_ok(&r, mpm_particles_set_all(r.set[m], "acceleration", MPM_F64, o.dim, zero));
  }
  run_steps(&r, 2);
  double *before[2];
  for (int32_t m = 0; m < 2; ++m) before[m] = run_get(&r, m, "velocity", o.dim);
  run_steps(&r, 1);
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(r.set[m]);
    double *after = run_get(&r, m, "velocity", o.dim), *a = run_get(&r, m, "acceleration", o.dim);
    for (int64_t i = 0; i < n * o.dim; ++i)
      parts_close(a[i], (after[i] - before[m][i]) / RUN_DT, 1e-9 * (1.0 + fabs(a[i])), "acceleration");
    free(after), free(a), free(before[m]);
  }
  run_close(&r);
}
END_TEST

/* ---- changes between steps ----------------------------------------------------------------------------- */
/* Whatever was configured before, a step depends on the descriptor and the state alone. */
START_TEST(configured_mid_run) {
  run r, other;
  run_options o = {.dim = 2};
  run_use(&o, &run_methods[_i % 6]);
  run_open(&r, &o);
  run_options plain = {.dim = 2};
  run_open(&other, &plain);
  mpm_stepper_desc d = parts_desc(&r); /* of o */
  d.gravity[1] = -10.0;
  for (int32_t m = 0; m < 2; ++m) { /* both start with the affine matrix */
    const double zero[9] = {0.0};
    run_ok(&r, mpm_particles_set_all(r.set[m], "velocity_gradient", MPM_F64, 9, zero));
    run_ok(&other, mpm_particles_set_all(other.set[m], "velocity_gradient", MPM_F64, 9, zero));
  }
  run_ok(&r, mpm_stepper_configure(r.stepper, &d));
  run_ok(&other, mpm_stepper_configure(other.stepper, &d));
  run_steps(&r, 3);
  run_steps(&other, 3);
  ck_assert(run_hash(&r) == run_hash(&other));
  /* back and forth */
  for (int32_t k = 0; k < 2; ++k) {
    mpm_stepper_desc back = d;
    back.transfer = MPM_FLIP;
    back.scheme = k ? MPM_USL : MPM_MUSL;
    run_ok(&r, mpm_stepper_configure(r.stepper, &back));
    run_ok(&r, mpm_stepper_configure(r.stepper, &d));
    run_steps(&r, 1);
    run_steps(&other, 1);
    ck_assert(run_hash(&r) == run_hash(&other));
  }
  mpm_step_info info = {.struct_size = sizeof info};
  run_ok(&r, mpm_stepper_info(r.stepper, &info));
  ck_assert_int_eq(info.step, 5);
  run_close(&r);
  run_close(&other);
}
END_TEST

/* A set that is taken out stays where it is; the other one moves alone, as if there were no other. */
START_TEST(sets_come_and_go) {
  run_options o = {.dim = 1 + _i};
  run r, alone;
  run_open(&r, &o);
  run_steps(&r, 3);
  size_t bytes, again;
  char *was = run_fields(&r, 0, &bytes);
  run_open(&alone, &o);
  run_steps(&alone, 3);
  run_ok(&alone, mpm_stepper_remove(alone.stepper, alone.set[0]));
  run_ok(&r, mpm_stepper_remove(r.stepper, r.set[0]));
  run_steps(&r, 4);
  run_steps(&alone, 4);
  ck_assert(run_hash(&r) == run_hash(&alone));
  char *is = run_fields(&r, 0, &again);
  ck_assert(bytes == again && memcmp(was, is, bytes) == 0);
  free(was), free(is);
  /* numbered in order of joining */
  run_ok(&r, mpm_stepper_add(r.stepper, r.set[0]));
  run_steps(&r, 2);
  ck_assert(run_hash(&r) != run_hash(&alone));
  run_ok(&r, mpm_stepper_remove(r.stepper, r.set[1]));
  run_steps(&r, 2);
  run_ok(&r, mpm_stepper_remove(r.stepper, r.set[0]));
  run_steps(&r, 1); /* nothing at all */
  ck_assert_int_eq(r.info.active_nodes, 0);
  ck_assert_double_eq(r.info.kinetic_energy, 0.0);
  for (int32_t m = 0; m < 2; ++m) run_ok(&r, mpm_stepper_add(r.stepper, r.set[m]));
  run_steps(&r, 2);
  run_close(&r);
  run_close(&alone);
}
END_TEST

/* Sets without particles, in every order, change nothing. */
START_TEST(empty_sets) {
  run r, other;
  run_options o = {.dim = 1 + _i};
  run_open(&r, &o);
  run_open(&other, &o);
  mpm_particles *set;
  run_ok(&r, mpm_particles_create(r.context, r.grid, r.material[1], &set));
  run_ok(&r, mpm_stepper_add(r.stepper, set));
  run_steps(&r, 8);
  run_steps(&other, 8);
  parts_agree(&r, &other, "position", o.dim, 0.0);
  parts_agree(&r, &other, "velocity", o.dim, 0.0);
  ck_assert_double_eq(r.info.strain_energy, other.info.strain_energy);
  run_ok(&r, mpm_stepper_remove(r.stepper, set));
  run_ok(&r, mpm_particles_destroy(set));
  ck_assert(run_hash(&r) == run_hash(&other));
  run_steps(&r, 1); /* sorts anew */
  run_steps(&other, 1);
  parts_agree(&r, &other, "velocity", o.dim, 1e-13);
  run_close(&r);
  run_close(&other);
  o.empty = 1;
  run_open(&r, &o);
  run_steps(&r, 3);
  ck_assert_int_eq(r.info.step, 3);
  run_close(&r);
}
END_TEST

/* Walls may change between any two steps; what they were before leaves no trace. */
START_TEST(walls_change) {
  run r, other;
  run_options o = {.dim = 3};
  run_open(&r, &o);
  run_open(&other, &o);
  for (int32_t kind = MPM_WALL_NONE; kind <= MPM_WALL_FRICTION; ++kind) {
    run_steps(&r, 1);
    run_steps(&other, 1);
    run_ok(&r, mpm_stepper_set_wall(r.stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
    run_ok(&r, mpm_stepper_set_wall(r.stepper, MPM_Y_MIN, kind == 1 ? 0 : kind, 0.2));
    run_ok(&other, mpm_stepper_set_wall(other.stepper, MPM_Y_MIN, kind == 1 ? 0 : kind, 0.2));
    double a[3], b[3];
    run_steps(&r, 1);
    run_steps(&other, 1);
    ck_assert(run_hash(&r) == run_hash(&other));
    run_ok(&r, mpm_stepper_wall_reaction(r.stepper, MPM_Y_MIN, a));
    run_ok(&other, mpm_stepper_wall_reaction(other.stepper, MPM_Y_MIN, b));
    ck_assert_int_eq(memcmp(a, b, sizeof a), 0);
    if (kind < MPM_WALL_FIXED) ck_assert_double_eq(a[1], 0.0);
  }
  run_close(&r);
  run_close(&other);
}
END_TEST

/* Domains wider than a cell are taken as one cell, and the host is told how many there are. */
static void keep_text(void *user, int32_t level, const char *text) {
  (void)level;
  if (strstr(text, "domains")) snprintf(user, 200, "%s", text);
}

START_TEST(wide_domains_are_counted) {
  char told[200] = "";
  mpm_context *context;
  mpm_context_desc services;
  mpm_context_desc_init(&services, sizeof services);
  services.log = keep_text;
  services.log_user = told;
  ck_assert_int_eq(mpm_context_create(&services, &context), MPM_OK);
  mpm_grid_desc g;
  mpm_grid_desc_init(&g, sizeof g);
  g.dim = 2;
  g.basis = MPM_CPGIMP;
  for (int32_t k = 0; k < 2; ++k) g.cells[k] = 8, g.spacing[k] = 1.0;
  mpm_grid *grid;
  mpm_material *material;
  mpm_particles *set;
  mpm_stepper *stepper;
  const mpm_param elastic[] = {{"E", 1.0}, {"nu", 0.3}, {"density", 1.0}};
  const double x[6] = {2.0, 4.0, 6.0, 4.0, 4.0, 4.0}, volume[3] = {0.25, 0.25, 2.25};
  double F[27] = {0.0};
  for (int32_t p = 0; p < 3; ++p) F[p] = F[12 + p] = F[24 + p] = 1.0;
  F[1] = 2.1; /* of particle 1: half a cell times 2.1 */
  ck_assert_int_eq(mpm_grid_create(context, &g, &grid), MPM_OK);
  ck_assert_int_eq(mpm_material_create(context, "neo_hookean", elastic, 3, &material), MPM_OK);
  ck_assert_int_eq(mpm_particles_create(context, grid, material, &set), MPM_OK);
  ck_assert_int_eq(mpm_particles_add(set, 3, x, NULL, volume, NULL, NULL, NULL), MPM_OK);
  ck_assert_int_eq(mpm_particles_set(set, "deformation_gradient", MPM_F64, 9, 3, NULL, F), MPM_OK);
  ck_assert_int_eq(mpm_stepper_create(context, grid, NULL, &stepper), MPM_OK);
  ck_assert_int_eq(mpm_stepper_add(stepper, set), MPM_OK);
  ck_assert_int_eq(mpm_step(stepper, 1e-3, NULL), MPM_OK);
  ck_assert_msg(strstr(told, "2 of 3 particles") != NULL, "%s", told);
  ck_assert_int_eq(mpm_stepper_destroy(stepper), MPM_OK);
  ck_assert_int_eq(mpm_particles_destroy(set), MPM_OK);
  ck_assert_int_eq(mpm_material_destroy(material), MPM_OK);
  ck_assert_int_eq(mpm_grid_destroy(grid), MPM_OK);
  ck_assert_int_eq(mpm_context_destroy(context), MPM_OK);
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
