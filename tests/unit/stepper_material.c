/* Laws of the host inside a step: what they are given, that they are worth as much as built-in ones, and what
 * becomes of their refusals. */
#include "stepper_parts.h"

static world r;

/* ---- the same law, built in and by callback ---- */
START_TEST(as_good_as_built_in) {
  const body_desc o = {
      .dim = 1 + _i / PLAIN, .stress = host_neo_hookean, .method = *broad_methods[_i % PLAIN]};
  world host, own;
  world_desc d = world_of_body(&o);
  world_open(&host, &d);
  d.other_law = d.law; /* the built-in one */
  world_open(&own, &d);
  const int64_t n = mpm_particles_count(own.set[1]);
  double *volume = fetch(&own, own.set[1], "volume", 1);
  world_steps(&own, 8);
  world_steps(&host, 8);
  world_agree("bodies", &own, &host, "position", o.dim, 1e-13);
  world_agree("bodies", &own, &host, "velocity", o.dim, 1e-12);
  world_agree("bodies", &own, &host, "deformation_gradient", 9, 1e-12);
  world_agree("bodies", &own, &host, "stress", 6, 1e-10);
  ck_within("strain energy", host.info.strain_energy, own.info.strain_energy, 1e-9 * own.info.strain_energy);
  double *J = fetch(&host, host.set[1], "state", 1), *now = fetch(&host, host.set[1], "volume", 1);
  for (int64_t i = 0; i < n; ++i) ck_within("J of the law's state", J[i] * volume[i], now[i], 1e-12 * now[i]);
  free(volume), free(J), free(now);
  world_close(&host);
  world_close(&own);
}
END_TEST

/* ---- what a batch has ---- */
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
      ck_within("F = F_inc F_old", b->F[e], F, 1e-12);
      ck_within("F_inc = I + dt L", b->F_inc[e], unit + b->dt * b->L[e], 1e-13);
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
      ck_within("preset viscosity", b->kinematic_viscosity[p], 0.0, 0.0);
      ck_assert(isnan(b->energy[p]));
      if (b->id[p] < 0) continue;
      check_item(b, p);
      ++known.seen;
    }
    const void *heat;
    int64_t stride;
    ck_ok(NULL, mpm_batch_field(b->lookup, "heat", &heat, &stride));
    ck_assert_int_eq(mpm_batch_field(b->lookup, "cold", &heat, &stride), MPM_E_NOT_FOUND);
  } else if (b->dt == 0.0) { /* the state as it is */
    ++known.asked_as_it_is;
    for (int32_t c = 0; c < 9; ++c)
      for (int64_t p = 0; p < b->n; ++p) {
        ck_assert_double_eq(b->F_inc[c * b->ld + p], c % 4 == 0 ? 1.0 : 0.0);
        ck_assert_double_eq(b->L[c * b->ld + p], 0.0);
      }
  }
  return host_neo_hookean(user, b);
}

START_TEST(batches) {
  memset(&known, 0, sizeof known);
  body_desc o = {.dim = 1 + _i / 2, .stress = inspect, .method.scheme = _i % 2 ? MPM_MUSL : MPM_USL};
  body_open(&r, &o);
  known.dim = o.dim;
  for (int32_t i = 0; i < 7; ++i) {
    known.n = mpm_particles_count(r.set[1]);
    known.x = fetch(&r, r.set[1], "position", o.dim);
    known.F = fetch(&r, r.set[1], "deformation_gradient", 9);
    known.stress = fetch(&r, r.set[1], "stress", 6);
    known.state = fetch(&r, r.set[1], "state", 1);
    known.ids = fetch_ids(&r, r.set[1]);
    known.on = 1;
    known.seen = 0;
    known.t = r.info.t + BODY_DT;
    known.dt = BODY_DT;
    world_steps(&r, 1);
    ck_assert_int_eq(known.seen, known.n);
    free(known.x), free(known.F), free(known.stress), free(known.state), free(known.ids);
  }
  ck_assert_int_gt(known.asked_as_it_is, 0);
  world_close(&r);
}
END_TEST

/* ---- refusals ---- */
static struct {
  mpm_status answer;
  int32_t as_it_is; /* refuse when dt is 0, else when it is not */
} refusal;
static mpm_status refusing(void *user, const mpm_material_batch *b) {
  host_neo_hookean(user, b);
  return (b->dt > 0.0) == !refusal.as_it_is ? refusal.answer : 0;
}

START_TEST(refusals) {
  static const mpm_status answer[] = {1, 5, -1, -77};
  mpm_step_info info = {.struct_size = sizeof info};
  memset(&refusal, 0, sizeof refusal);
  body_open(&r, &(body_desc){.dim = 2, .stress = refusing});
  for (int32_t i = 0; i < 4; ++i) {
    refusal.answer = answer[i];
    ck_refused(&r, mpm_step(r.stepper, BODY_DT, &info), answer[i] > 0 ? MPM_CUT_DT : MPM_E_CALLBACK,
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
    world_steps(&r, 1);
    refusal.answer = answer[i];
    ck_ok(&r, mpm_particles_set(r.set[0], "velocity", MPM_F64, 2, 1, (int64_t[]){1}, v));
    const uint64_t set = world_hash(&r);
    ck_refused(&r, mpm_stable_dt(r.stepper, &dt), MPM_E_CALLBACK, "material of set 1");
    ck_refused(&r, mpm_step(r.stepper, BODY_DT, &info), MPM_E_CALLBACK, "material of set 1");
    ck_assert_int_eq(info.callback_status, answer[i]);
    ck_assert_int_eq(info.set, 1);
    ck_assert(world_hash(&r) == set);
  }
  refusal.answer = 0;
  world_steps(&r, 1);
  world_close(&r);
}
END_TEST

/* ---- wave speed, viscosity, energy ---- */
static struct {
  double wave, viscosity;
  int32_t no_energy;
} given;
static mpm_status with_speeds(void *user, const mpm_material_batch *b) {
  host_neo_hookean(user, b);
  for (int64_t i = 0; i < b->n; ++i) {
    b->wave_speed[i] = b->id[i] < 0 ? 1e30 : given.wave; /* inert slots do not count */
    b->kinematic_viscosity[i] = b->id[i] < 0 ? 1e30 : given.viscosity;
    if (given.no_energy || b->id[i] < 0) b->energy[i] = NOT_A_NUMBER;
  }
  return 0;
}

START_TEST(what_limits_the_step) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    double dt, rate = 0.0;
    memset(&given, 0, sizeof given);
    given.wave = 900.0;
    body_open(&r, &(body_desc){.dim = dim, .stress = with_speeds});
    const int64_t n = mpm_particles_count(r.set[1]);
    double *v = fetch(&r, r.set[1], "velocity", dim);
    for (int32_t k = 0; k < dim; ++k)
      for (int64_t i = 0; i < n; ++i) rate = fmax(rate, (fabs(v[k * n + i]) + 900.0) / body_spacing[k]);
    free(v);
    ck_ok(&r, mpm_stable_dt(r.stepper, &dt));
    ck_within("1 / max (|v| + c) / h", dt, 1.0 / rate, 1e-14 / rate);
    given.viscosity = 7e3;
    const double zero[3] = {0.0, 0.0, 0.0};
    ck_ok(&r, mpm_particles_set_all(r.set[0], "velocity", MPM_F64, dim, zero)); /* asks anew */
    const double h = dim == 3 ? 0.09 : 0.1, wanted = h * h / (2.0 * dim * 7e3);
    ck_ok(&r, mpm_stable_dt(r.stepper, &dt));
    ck_within("h^2 / (2 dim nu)", dt, wanted, 1e-13 * wanted);
    /* and as a step reports it */
    world_step(&r, 1e-9);
    ck_within("dt_suggested", r.info.dt_suggested, wanted, 1e-13 * wanted);
    given.no_energy = 1;
    world_step(&r, 1e-9);
    ck_assert(isnan(r.info.strain_energy) && isnan(r.info.dissipation));
    ck_assert(isfinite(r.info.kinetic_energy) && isfinite(r.info.external_work));
    given.wave = NOT_A_NUMBER;
    ck_refused(&r, mpm_step(r.stepper, 1e-9, NULL), MPM_NONFINITE, "wave speed");
    given.wave = 0.0;
    given.viscosity = INFINITE;
    ck_refused(&r, mpm_step(r.stepper, 1e-9, NULL), MPM_NONFINITE, "wave speed");
    world_close(&r);
  }
}
END_TEST

/* What a law must not give is refused with the particle's id, by a step and where the state is asked for. */
static struct {
  int32_t what;
  int64_t id;
} bad;
static mpm_status giving_bad(void *user, const mpm_material_batch *b) {
  host_neo_hookean(user, b);
  for (int64_t i = 0; i < b->n; ++i) {
    if (b->id[i] != bad.id) continue;
    if (bad.what == 1) b->wave_speed[i] = -5.0;
    if (bad.what == 2) b->kinematic_viscosity[i] = -1e-9;
    if (bad.what == 3) b->energy[i] = INFINITE;
    if (bad.what == 4) b->energy[i] = -INFINITE;
    if (bad.what == 5) b->wave_speed[i] = INFINITE;
  }
  return 0;
}

START_TEST(refused_answers) {
  static const char *const value[] = {"", "wave speed is negative", "kinematic viscosity is negative",
                                      "energy is infinite", "energy is infinite"};
  mpm_step_info info = {.struct_size = sizeof info};
  double dt, unit[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  const int32_t scheme[] = {MPM_USL, MPM_USF, MPM_NEWMARK};
  for (int32_t k = 0; k < 3; ++k) {
    bad.id = -7;
    body_open(&r, &(body_desc){.dim = 2, .stress = giving_bad, .method.scheme = scheme[k]});
    world_steps(&r, 1);
    int64_t *ids = fetch_ids(&r, r.set[1]);
    const int64_t one = ids[2];
    free(ids);
    for (bad.what = 1; bad.what <= 4; ++bad.what) {
      char text[96];
      snprintf(text, sizeof text, "%s at particle %lld of set 1", value[bad.what], (long long)one);
      const mpm_status cause = bad.what < 3 ? MPM_E_CALLBACK : MPM_NONFINITE;
      const uint64_t hash = world_hash(&r);
      bad.id = one;
      ck_refused(&r, mpm_step(r.stepper, BODY_DT, &info), cause, text);
      ck_assert_int_eq(info.cause, cause);
      ck_assert_int_eq(info.particle, one);
      ck_assert_int_eq(info.set, 1);
      ck_assert_int_eq(info.callback_status, 0);
      ck_assert(world_hash(&r) == hash);
      ck_ok(&r,
            mpm_particles_set_all(r.set[0], "velocity", MPM_F64, 2, (double[]){0.0, 0.0})); /* asks anew */
      ck_refused(&r, mpm_stable_dt(r.stepper, &dt), cause, text);
      bad.id = -7;
      world_steps(&r, 1);
    }
    char text[96];
    snprintf(text, sizeof text, "gives wave speed inf and kinematic viscosity 0 at particle %lld of set 1",
             (long long)one);
    bad.id = one, bad.what = 5;
    ck_ok(&r, mpm_particles_set_all(r.set[0], "velocity", MPM_F64, 2, (double[]){0.0, 0.0}));
    ck_refused(&r, mpm_stable_dt(r.stepper, &dt), MPM_NONFINITE, text);
    ck_ok(&r, mpm_particles_set_all(r.set[1], "deformation_gradient", MPM_F64, 9, unit));
    bad.what = 1;
    double *stress = calloc((size_t)mpm_particles_count(r.set[1]) * 6, sizeof *stress);
    ck_refused(&r,
               mpm_particles_get(r.set[1], "stress", MPM_F64, 6, mpm_particles_count(r.set[1]), NULL, stress),
               MPM_E_CALLBACK, "wave speed is negative at particle");
    free(stress);
    bad.id = -7;
    world_close(&r);
  }
}
END_TEST

/* A law of the library whose square of the wave speed is negative: F is flat but for rounding, and det F > 0
 * by one formula and not by another. Which particle it was is told. */
START_TEST(squares_below_zero) {
  dice d = {11};
  int32_t refused = 0;
  double dt;
  world_desc desc = world_default(3, 8, 1.0);
  desc.law.model = "linear_elastic";
  mpm_particles *set = world_open(&r, &desc);
  world_fill(&r, set, (double[]){2.0, 2.0, 2.0}, (double[]){5.0, 5.0, 5.0}, 2);
  int64_t *ids = fetch_ids(&r, set);
  const int64_t one = ids[17];
  free(ids);
  for (int32_t k = 0; k < 3000; ++k) {
    double F[9];
    for (int32_t e = 0; e < 9; ++e)
      F[e] = e < 6 ? throw_between(&d, -1.0, 1.0) : 1.5 * F[e - 6] - 0.5 * F[e - 3];
    if (mpm_particles_set(set, "deformation_gradient", MPM_F64, 9, 1, &one, F)) continue;
    if (!mpm_stable_dt(r.stepper, &dt)) continue;
    char text[40];
    snprintf(text, sizeof text, "at particle %lld of", (long long)one);
    ck_holds(strstr(mpm_last_error(r.context), text) != NULL);
    ++refused;
  }
  ck_assert_int_gt(refused, 0);
  world_close(&r);
}
END_TEST

/* ---- a law that depends on the place ---- */
static mpm_status graded(void *user, const mpm_material_batch *b) {
  host_neo_hookean(user, b);
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
  body_open(&r, &(body_desc){.dim = dim, .stress = graded, .method.scheme = _i % 2 ? MPM_MUSL : MPM_USL});
  /* set 0 alone, which stays as it is */
  ck_ok(&r, mpm_stepper_remove(r.stepper, r.set[1]));
  const double other = world_info(&r).strain_energy;
  ck_ok(&r, mpm_stepper_add(r.stepper, r.set[1]));
  const int64_t n = mpm_particles_count(r.set[1]);
  double *x = fetch(&r, r.set[1], "position", dim), *volume = fetch(&r, r.set[1], "initial_volume", 1);
  for (int64_t i = 0; i < n; ++i) most = fmax(most, x[i]);
  const double wanted = graded_energy(x, volume, n), h = spacing[dim - 1];
  ck_ok(&r, mpm_stepper_info(r.stepper, &info));
  ck_within("energy as it is", info.strain_energy - other, wanted, 1e-12 * wanted);
  ck_ok(&r, mpm_stable_dt(r.stepper, &dt));
  const double limit = h * h / (2.0 * dim * 1e3 * (1.0 + most));
  ck_within("viscous limit at the farthest place", dt, limit, 1e-13 * limit);
  ck_ok(&r, mpm_step(r.stepper, 0.1 * limit, &info));
  ck_ok(&r, mpm_step(r.stepper, 0.1 * limit, &info));
  double *old = fetch(&r, r.set[1], "position", dim);
  ck_ok(&r, mpm_stepper_remove(r.stepper, r.set[0]));
  ck_ok(&r, mpm_step(r.stepper, 0.1 * limit, &info));
  const double in_step = graded_energy(old, volume, n);
  ck_within("energy after a step", info.strain_energy, in_step, 1e-13 * in_step);
  double *now = fetch(&r, r.set[1], "position", dim);
  ck_assert(fabs(graded_energy(now, volume, n) - in_step) > 1e-11 * in_step); /* they have moved */
  ck_ok(&r, mpm_stepper_add(r.stepper, r.set[0]));
  free(x), free(volume), free(old), free(now);
  world_close(&r);
}
END_TEST

TCase *stepper_material_case(void) {
  TCase *tests = tcase_create("material");
  tcase_set_timeout(tests, 60);
  tcase_add_loop_test(tests, as_good_as_built_in, 0, 3 * PLAIN);
  tcase_add_loop_test(tests, batches, 0, 6);
  tcase_add_test(tests, refusals);
  tcase_add_test(tests, what_limits_the_step);
  tcase_add_test(tests, refused_answers);
  tcase_add_test(tests, squares_below_zero);
  tcase_add_loop_test(tests, by_place, 0, 6);
  return tests;
}
