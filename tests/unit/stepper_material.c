/* Laws of the host inside a step: what they are given, that they are worth as much as built-in ones, and what
 * becomes of their refusals. */
#include "stepper_parts.h"

static run r;

/* ---- the same law, built in and by callback ------------------------------------------------------------ */
START_TEST(as_good_as_built_in) {
  run_options o = {.dim = 1 + _i / RUN_METHODS, .stress = run_neo_hookean};
  run_use(&o, &run_methods[_i % RUN_METHODS]);
  run host, own;
  run_open(&host, &o);
  run_open(&own, &o);
  /* set 1 of `own` is made anew, of the built-in law */
  const int64_t n = mpm_particles_count(own.set[1]);
  double *x = run_get(&own, 1, "position", o.dim), *v = run_get(&own, 1, "velocity", o.dim);
  double *volume = run_get(&own, 1, "volume", 1), *heat = run_get(&own, 1, "heat", 1);
  int64_t *ids = malloc((size_t)n * sizeof *ids);
  run_ok(&own, mpm_particles_get(own.set[1], "id", MPM_I64, 1, n, NULL, ids));
  run_ok(&own, mpm_stepper_remove(own.stepper, own.set[1]));
  run_ok(&own, mpm_particles_destroy(own.set[1]));
  run_ok(&own, mpm_particles_create(own.context, own.grid, own.material[0], &own.set[1]));
  run_ok(&own, mpm_particles_add_field(own.set[1], "heat", MPM_F64, 1));
  run_ok(&own, mpm_particles_add(own.set[1], n, x, v, volume, NULL, ids, NULL));
  run_put(&own, 1, "heat", 1, heat);
  run_ok(&own, mpm_stepper_add(own.stepper, own.set[1]));
  for (int32_t i = 0; i < 8; ++i) {
    run_steps(&own, 1);
    run_steps(&host, 1);
  }
  parts_agree(&own, &host, "position", o.dim, 1e-13);
  parts_agree(&own, &host, "velocity", o.dim, 1e-12);
  parts_agree(&own, &host, "deformation_gradient", 9, 1e-12);
  parts_agree(&own, &host, "stress", 6, 1e-10);
  parts_close(host.info.strain_energy, own.info.strain_energy, 1e-9 * own.info.strain_energy,
              "strain energy");
  double *J = run_get(&host, 1, "state", 1), *now = run_get(&host, 1, "volume", 1);
  for (int64_t i = 0; i < n; ++i)
    parts_close(J[i] * volume[i], now[i], 1e-12 * now[i], "J of the law's state");
  free(x), free(v), free(volume), free(heat), free(ids), free(J), free(now);
  run_close(&host);
  run_close(&own);
}
END_TEST

/* ---- what a batch has ---------------------------------------------------------------------------------- */
static struct {
  double t, dt;
  int64_t seen, asked_as_it_is;
  double *x, *F, *stress, *state;
  int64_t *ids, n;
  int32_t dim, on;
} known;

static void check_item(const mpm_material_batch *b, int64_t p) {
  int64_t i = 0;
  while (known.ids[i] != b->id[p]) ++i;
  for (int32_t c = 0; c < known.dim; ++c)
    ck_assert_double_eq(b->position[c * b->ld + p], known.x[c * known.n + i]);
  for (int32_t c = 0; c < 6; ++c)
    ck_assert_double_eq(b->stress[c * b->ld + p], known.stress[c * known.n + i]);
  ck_assert_double_eq(b->state[p], known.state[i]);
  for (int32_t row = 0; row < 3; ++row)
    for (int32_t column = 0; column < 3; ++column) {
      const int64_t e = (3 * row + column) * b->ld + p;
      const double unit = row == column ? 1.0 : 0.0;
      double F = 0.0;
      for (int32_t k = 0; k < 3; ++k)
        F += b->F_inc[(3 * row + k) * b->ld + p] * known.F[(3 * k + column) * known.n + i];
      parts_close(b->F[e], F, 1e-12, "F = F_inc F_old");
      parts_close(b->F_inc[e], unit + b->dt * b->L[e], 1e-13, "F_inc = I + dt L");
    }
}

static mpm_status inspect(void *user, const mpm_material_batch *b) {
  ck_assert_uint_eq(b->struct_size, sizeof *b);
  ck_assert_int_eq(b->state_count, 1);
  ck_assert_int_ge(b->ld, b->n);
  if (known.on && b->dt > 0.0) {
    ck_assert_double_eq(b->t, known.t);
    ck_assert_double_eq(b->dt, known.dt);
    for (int64_t p = 0; p < b->n; ++p) {
      parts_close(b->kinematic_viscosity[p], 0.0, 0.0, "preset viscosity");
      ck_assert(isnan(b->energy[p]));
      if (b->id[p] < 0) continue;
      check_item(b, p);
      ++known.seen;
    }
    const void *heat;
    int64_t stride;
    ck_assert_int_eq(mpm_batch_field(b->lookup, "heat", &heat, &stride), MPM_OK);
    ck_assert_int_eq(mpm_batch_field(b->lookup, "cold", &heat, &stride), MPM_E_NOT_FOUND);
  } else if (b->dt == 0.0) { /* the state as it is */
    ++known.asked_as_it_is;
    for (int32_t c = 0; c < 9; ++c)
      for (int64_t p = 0; p < b->n; ++p) {
        ck_assert_double_eq(b->F_inc[c * b->ld + p], c % 4 == 0 ? 1.0 : 0.0);
        ck_assert_double_eq(b->L[c * b->ld + p], 0.0);
      }
  }
  return run_neo_hookean(user, b);
}

START_TEST(batches) {
  memset(&known, 0, sizeof known);
  run_options o = {.dim = 1 + _i / 2, .stress = inspect, .scheme = _i % 2 ? MPM_MUSL : MPM_USL};
  run_open(&r, &o);
  known.dim = o.dim;
  for (int32_t i = 0; i < 7; ++i) {
    known.n = mpm_particles_count(r.set[1]);
    known.x = run_get(&r, 1, "position", o.dim);
    known.F = run_get(&r, 1, "deformation_gradient", 9);
    known.stress = run_get(&r, 1, "stress", 6);
    known.state = run_get(&r, 1, "state", 1);
    known.ids = malloc((size_t)known.n * sizeof *known.ids);
    run_ok(&r, mpm_particles_get(r.set[1], "id", MPM_I64, 1, known.n, NULL, known.ids));
    known.on = 1;
    known.seen = 0;
    known.t = r.info.t + RUN_DT;
    known.dt = RUN_DT;
    run_steps(&r, 1);
    ck_assert_int_eq(known.seen, known.n);
    free(known.x), free(known.F), free(known.stress), free(known.state), free(known.ids);
  }
  ck_assert_int_gt(known.asked_as_it_is, 0);
  run_close(&r);
}
END_TEST

/* ---- refusals ------------------------------------------------------------------------------------------ */
static struct {
  mpm_status answer;
  int32_t as_it_is; /* refuse when dt is 0, else when it is not */
} refusal;
static mpm_status refusing(void *user, const mpm_material_batch *b) {
  run_neo_hookean(user, b);
  return (b->dt > 0.0) == !refusal.as_it_is ? refusal.answer : 0;
}

START_TEST(refusals) {
  static const mpm_status answer[] = {1, 5, -1, -77};
  mpm_step_info info = {.struct_size = sizeof info};
  memset(&refusal, 0, sizeof refusal);
  run_open(&r, &(run_options){.dim = 2, .stress = refusing});
  for (int32_t i = 0; i < 4; ++i) {
    refusal.answer = answer[i];
    run_refused(&r, mpm_step(r.stepper, RUN_DT, &info), answer[i] > 0 ? MPM_CUT_DT : MPM_E_CALLBACK,
                "material");
    ck_assert_int_eq(info.callback_status, answer[i]);
    ck_assert_int_eq(info.set, 1);
    ck_assert_int_eq(info.particle, -1);
  }
  /* asked for the state as it is */
  refusal.as_it_is = 1;
  const double v[2] = {1.0, 0.0};
  for (int32_t i = 0; i < 4; ++i) {
    double dt = 0.0;
    refusal.answer = 0;
    run_steps(&r, 1);
    refusal.answer = answer[i];
    run_ok(&r, mpm_particles_set(r.set[0], "velocity", MPM_F64, 2, 1, (int64_t[]){1}, v));
    const uint64_t set = run_hash(&r);
    run_refused(&r, mpm_stable_dt(r.stepper, &dt), MPM_E_CALLBACK, "material of set 1");
    run_refused(&r, mpm_step(r.stepper, RUN_DT, &info), MPM_E_CALLBACK, "material of set 1");
    ck_assert_int_eq(info.callback_status, answer[i]);
    ck_assert_int_eq(info.set, 1);
    ck_assert(run_hash(&r) == set);
  }
  refusal.answer = 0;
  run_steps(&r, 1);
  run_close(&r);
}
END_TEST

/* ---- wave speed, viscosity, energy --------------------------------------------------------------------- */
static struct {
  double wave, viscosity;
  int32_t no_energy;
} given;
static mpm_status with_speeds(void *user, const mpm_material_batch *b) {
  run_neo_hookean(user, b);
  for (int64_t i = 0; i < b->n; ++i) {
    b->wave_speed[i] = b->id[i] < 0 ? 1e30 : given.wave; /* inert slots do not count */
    b->kinematic_viscosity[i] = b->id[i] < 0 ? 1e30 : given.viscosity;
    if (given.no_energy || b->id[i] < 0) b->energy[i] = RUN_NAN;
  }
  return 0;
}

START_TEST(what_limits_the_step) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    double dt, rate = 0.0;
    static const double spacing[3] = {0.1, 0.11, 0.09};
    memset(&given, 0, sizeof given);
    given.wave = 900.0;
    run_open(&r, &(run_options){.dim = dim, .stress = with_speeds});
    const int64_t n = mpm_particles_count(r.set[1]);
    double *v = run_get(&r, 1, "velocity", dim);
    for (int32_t k = 0; k < dim; ++k)
      for (int64_t i = 0; i < n; ++i) rate = fmax(rate, (fabs(v[k * n + i]) + 900.0) / spacing[k]);
    free(v);
    run_ok(&r, mpm_stable_dt(r.stepper, &dt));
    parts_close(dt, 1.0 / rate, 1e-14 / rate, "1 / max (|v| + c) / h");
    given.viscosity = 7e3;
    const double zero[3] = {0.0, 0.0, 0.0};
    run_ok(&r, mpm_particles_set_all(r.set[0], "velocity", MPM_F64, dim, zero)); /* asks anew */
    const double h = dim == 3 ? 0.09 : 0.1, wanted = h * h / (2.0 * dim * 7e3);
    run_ok(&r, mpm_stable_dt(r.stepper, &dt));
    parts_close(dt, wanted, 1e-13 * wanted, "h^2 / (2 dim nu)");
    /* and as a step reports it */
    run_step_of(&r, 1e-9);
    parts_close(r.info.dt_suggested, wanted, 1e-13 * wanted, "dt_suggested");
    given.no_energy = 1;
    run_step_of(&r, 1e-9);
    ck_assert(isnan(r.info.strain_energy) && isnan(r.info.dissipation));
    ck_assert(isfinite(r.info.kinetic_energy) && isfinite(r.info.external_work));
    given.wave = RUN_NAN;
    run_refused(&r, mpm_step(r.stepper, 1e-9, NULL), MPM_NONFINITE, "wave speed");
    given.wave = 0.0;
    given.viscosity = RUN_INFINITY;
    run_refused(&r, mpm_step(r.stepper, 1e-9, NULL), MPM_NONFINITE, "wave speed");
    run_close(&r);
  }
}
END_TEST

/* ---- a law that depends on the place ------------------------------------------------------------------- */
static mpm_status graded(void *user, const mpm_material_batch *b) {
  run_neo_hookean(user, b);
  for (int64_t i = 0; i < b->n; ++i) {
    b->energy[i] = 2.0 + b->position[i];
    b->wave_speed[i] = 1.0;
    b->kinematic_viscosity[i] = 1e3 * (1.0 + b->position[i]);
  }
  return 0;
}

/* Energies of set 1 belong to the places that the law was shown: those at the start of the step. */
static double graded_energy(const double *x, const double *volume, int64_t n) {
  double sum = 0.0;
  for (int64_t i = 0; i < n; ++i) sum += volume[i] * (2.0 + x[i]);
  return sum;
}

START_TEST(by_place) {
  const int32_t dim = 1 + _i / 2;
  static const double spacing[3] = {0.1, 0.1, 0.09};
  mpm_step_info info = {.struct_size = sizeof info};
  double dt, most = 0.0;
  run_open(&r, &(run_options){.dim = dim, .stress = graded, .scheme = _i % 2 ? MPM_MUSL : MPM_USL});
  /* set 0 alone, which stays as it is */
  run_ok(&r, mpm_stepper_remove(r.stepper, r.set[1]));
  run_ok(&r, mpm_stepper_info(r.stepper, &info));
  const double other = info.strain_energy;
  run_ok(&r, mpm_stepper_add(r.stepper, r.set[1]));
  const int64_t n = mpm_particles_count(r.set[1]);
  double *x = run_get(&r, 1, "position", dim), *volume = run_get(&r, 1, "initial_volume", 1);
  for (int64_t i = 0; i < n; ++i) most = fmax(most, x[i]);
  const double wanted = graded_energy(x, volume, n), h = spacing[dim - 1];
  run_ok(&r, mpm_stepper_info(r.stepper, &info));
  parts_close(info.strain_energy - other, wanted, 1e-12 * wanted, "energy as it is");
  run_ok(&r, mpm_stable_dt(r.stepper, &dt));
  const double limit = h * h / (2.0 * dim * 1e3 * (1.0 + most));
  parts_close(dt, limit, 1e-13 * limit, "viscous limit at the farthest place");
  run_ok(&r, mpm_step(r.stepper, 0.1 * limit, &info));
  run_ok(&r, mpm_step(r.stepper, 0.1 * limit, &info));
  double *old = run_get(&r, 1, "position", dim);
  run_ok(&r, mpm_stepper_remove(r.stepper, r.set[0]));
  run_ok(&r, mpm_step(r.stepper, 0.1 * limit, &info));
  const double in_step = graded_energy(old, volume, n);
  parts_close(info.strain_energy, in_step, 1e-13 * in_step, "energy after a step");
  double *now = run_get(&r, 1, "position", dim);
  ck_assert(fabs(graded_energy(now, volume, n) - in_step) > 1e-11 * in_step); /* they have moved */
  run_ok(&r, mpm_stepper_add(r.stepper, r.set[0]));
  free(x), free(volume), free(old), free(now);
  run_close(&r);
}
END_TEST

TCase *stepper_material_case(void) {
  TCase *tests = tcase_create("material");
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, as_good_as_built_in, 0, 3 * RUN_METHODS);
  tcase_add_loop_test(tests, batches, 0, 6);
  tcase_add_test(tests, refusals);
  tcase_add_test(tests, what_limits_the_step);
  tcase_add_loop_test(tests, by_place, 0, 6);
  return tests;
}
