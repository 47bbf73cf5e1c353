/* herschel_bulkley: numbers of an independent program, closed forms, random states, and what the host may
 * set. */
#include "law_path.h"
#include "simd/elementary.h"

enum { SHEAR = 3, YIELD, K, N, TENSION, PARAMS };
typedef struct mud {
  mpm_param value[PARAMS];
} mud;

static mud with(double shear, double yield, double consistency, double n) {
  return (mud){{{"density", 1e3},
                {"bulk_modulus", 4e7},
                {"gamma", 7.0},
                {"shear_modulus", shear},
                {"yield_shear", yield},
                {"consistency", consistency},
                {"n", n},
                {"tension", 1.0}}};
}
static path open_mud(const mud *of) {
  return path_of("herschel_bulkley", of->value, PARAMS);
}

/* Pure shear at a rate: the strain of each step is along the axes of the stress, as in the algorithm for
 * one number. */
static void flow(path *s, double rate, double time, int32_t steps) {
  s->dt = time / steps;
  for (int32_t k = 0; k < steps; ++k) stretch(s, 0.5 * rate * s->dt, -0.5 * rate * s->dt, 0.0);
}
static double shear_stress(const path *s) {
  return invariants_of(s).q / sqrt(3.0);
}

START_TEST(starting_flow) {
  static const struct {
    double n, of_ten, exact;
  } rows[] = {{1.0, 89.9996737413266, 89.9999999981},
              {0.5, 78.2842711634304, 78.2842712475},
              {1.5, 106.531376271512, 106.5679118}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    const mud of = with(1e4, 50.0, 20.0, rows[k].n);
    path s = open_mud(&of);
    start(&s, 0.0);
    flow(&s, 2.0, 0.05, 10);
    ck_within("ten steps", shear_stress(&s), rows[k].of_ten, 1e-11 * 100.0);
    start(&s, 0.0);
    flow(&s, 2.0, 0.05, 2000);
    ck_within("many steps", shear_stress(&s), rows[k].exact, 2e-6 * 100.0);
    law_material_free(s.material);
  }
}
END_TEST

/* Held still, the stress above yield decays as exp(-G t / k). */
START_TEST(relaxation) {
  const mud of = with(1e4, 50.0, 20.0, 1.0);
  path s = open_mud(&of);
  for (int32_t steps = 100; steps <= 10000; steps *= 10) {
    start(&s, 0.0);
    s.stress[0] = 200.0, s.stress[1] = -200.0;
    flow(&s, 0.0, 1e-3, steps);
    if (steps == 100) ck_number("relaxed", shear_stress(&s), 141.0930164257);
    ck_within("relaxed", shear_stress(&s), 140.9795989, 0.12 * 100.0 / steps);
  }
  law_material_free(s.material);
}
END_TEST

/* Below yield it is a solid, at yield the stress stays, and without viscosity it is what yield leaves. */
START_TEST(yield_is_exact) {
  static const double exponents[] = {0.1, 0.5, 1.0, 2.0};
  for (size_t k = 0; k < sizeof exponents / sizeof *exponents; ++k) {
    mud of = with(1e4, 50.0, 20.0, exponents[k]);
    path s = open_mud(&of);
    start(&s, 0.0);
    flow(&s, 0.0049, 1.0, 100);
    ck_number("elastic", shear_stress(&s), 49.0);
    flow(&s, 0.0, 1e3, 100);
    ck_number("elastic", shear_stress(&s), 49.0);
    law_material_free(s.material);
    of.value[K].value = 0.0;
    s = open_mud(&of);
    start(&s, 0.0);
    flow(&s, 2.0, 1.0, 10);
    ck_number("plastic", shear_stress(&s), 50.0);
    law_material_free(s.material);
    of.value[YIELD].value = 0.0;
    s = open_mud(&of);
    start(&s, 0.0);
    s.stress[3] = 30.0;
    flow(&s, 2.0, 1.0, 10);
    ck_within("nothing", shear_stress(&s), 0.0, 1e-9);
    law_material_free(s.material);
  }
}
END_TEST

/* Pressure, energy and speed of sound are those of newtonian_fluid, with what the deviator adds. */
START_TEST(volume_alone) {
  const mpm_param water[] = {{"density", 1e3}, {"bulk_modulus", 4e7}, {"gamma", 7.0}, {"tension", 0.0}};
  for (int32_t tension = 0; tension < 2; ++tension) {
    mpm_param like[4];
    memcpy(like, water, sizeof like);
    like[3].value = tension;
    mud of = with(1e4, 50.0, 20.0, 0.7);
    of.value[TENSION].value = tension;
    path s = open_mud(&of), fluid = path_of("newtonian_fluid", like, 4);
    start(&s, 0.0);
    start(&fluid, 0.0);
    static const double by[] = {-0.002, -0.001, 0.004, 0.003, -0.002, -0.006};
    for (int k = 0; k < 6; ++k) {
      stretch(&s, by[k], 2.0 * by[k], 0.0);
      stretch(&fluid, by[k], 2.0 * by[k], 0.0);
      const invariants now = invariants_of(&s), wanted = invariants_of(&fluid);
      const double G = 1e4, square = 2.0 / 3.0 * now.q * now.q;
      ck_within("pressure", now.p, wanted.p, 1e-7);
      ck_within("energy", s.energy, fluid.energy + square / (4.0 * G), 1e-9 * (1.0 + fluid.energy));
      const double c2 = fluid.wave * fluid.wave + (4.0 / 3.0 * G + sqrt(2.0 / 3.0 * square)) / 1e3;
      ck_number("wave", s.wave, sqrt(c2));
      ck_assert(now.q > 0.0);
    }
    law_material_free(s.material);
    law_material_free(fluid.material);
  }
}
END_TEST

START_TEST(parameters_are_refused) {
  static const struct {
    int which;
    double value;
    const char *text;
  } rows[] = {{SHEAR, 0.0, "shear_modulus = 0"},
              {YIELD, -1.0, "yield_shear = -1"},
              {K, -1.0, "consistency = -1"},
              {N, 0.09, "n = 0.089"},
              {N, 2.1, "n = 2.1"},
              {TENSION, 0.5, "tension = 0.5"},
              {2, 0.5, "gamma = 0.5"}};
  mpm_context *context = context_with(1, MPM_ISA_BEST, NULL);
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    mud of = with(1e4, 50.0, 20.0, 1.0);
    mpm_material *m;
    of.value[rows[k].which].value = rows[k].value;
    ck_refused(context, mpm_material_create(context, "herschel_bulkley", of.value, PARAMS, &m), MPM_E_ARG,
               rows[k].text);
    ck_assert_ptr_null(m);
  }
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* The deviator is the host's to set; the mean stress follows from F, which keeps its volume alone. */
START_TEST(stress_of_the_host) {
  const int32_t dim = 1 + _i;
  const mud of = with(1e4, 5e3, 20.0, 1.0);
  const double F[9] = {0.99, 0, 0, 0, dim > 1 ? 0.98 : 1.0, 0, 0, 0, 1},
               dev[6] = {100.0, 20.0, -120.0, dim > 1 ? 40.0 : 0.0};
  double set_to[6];
  world w;
  world_desc d = world_default(dim, 8, 0.1);
  d.law = (world_law){.model = "herschel_bulkley", .params = of.value, .param_count = PARAMS};
  mpm_particles *set = world_open(&w, &d);
  const int64_t n = world_fill_cube(&w, set, 0.2, 0.6);
  const double J = F[0] * F[4], p = 4e7 / 7.0 * (pow(J, -7.0) - 1.0);
  for (int k = 0; k < 3; ++k) {
    for (int c = 0; c < 6; ++c) set_to[c] = dev[c] + (c < 3 ? 1e4 : 0.0);
    if (k != 1) ck_ok(&w, mpm_particles_set_all(set, "stress", MPM_F64, 6, set_to));
    if (k != 0) ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
    double *s = fetch(&w, set, "stress", 6);
    for (int64_t i = 0; i < n; ++i)
      for (int c = 0; c < 6; ++c)
        ck_within("stress", s[c * n + i], dev[c] - (c < 3 && k > 0 ? p : 0.0), 1e-12 * p + 1e-10);
    free(s);
  }
  world_step(&w, 1e-6);
  double *now = fetch(&w, set, "deformation_gradient", 9);
  ck_within("F", now[0], dim == 1 ? J : cbrt(J), 1e-6);
  ck_within("F", now[8 * n], dim == 1 ? 1.0 : cbrt(J), 1e-6);
  free(now);
  world_close(&w);
}
END_TEST

/* ---- random states ------------------------------------------------------------------------------------- */
enum { RANDOM = 100000, TESTED = 3000 };

static double power_of_ten(uint64_t *seed, double low, double high) {
  return mpmi_exp(2.302585092994046 * wide(seed, low, high));
}

static mud random_mud(uint64_t *seed, double most) {
  const double pick = wide(seed, 0.0, 10.0);
  mud of = with(power_of_ten(seed, 4.0, 7.0), wide(seed, 0.0, 3e4), power_of_ten(seed, -most, most),
                pick > 8.0 ? 1.0 : wide(seed, 0.1, 2.0));
  if (pick < 1.0) of.value[K].value = 0.0;
  if (pick < 2.0) of.value[YIELD].value = 0.0;
  of.value[TENSION].value = pick < 5.0;
  return of;
}

/* A step of a random size from a random stress below or above yield. */
static void random_step(uint64_t *seed, path *s, double *F_inc) {
  random_increment(seed, F_inc);
  const double shear = s->material->value[SHEAR];
  const tensor t = random_stress(seed, 3, fmin(5e4, 0.3 * shear));
  start(s, 0.0);
  for (int c = 0; c < 6; ++c) s->stress[c] = (double)t.m[sym_row[c]][sym_column[c]];
}

/* The trial is that of the same fluid which does not yield; the flow's shear rate x is what the stress has
 * lost. */
START_TEST(random_states_yield) {
  uint64_t seed = 41;
  int32_t seen[2] = {0, 0}, took = 0;
  for (int32_t round = 0; round < RANDOM / 250; ++round) {
    const mud of = random_mud(&seed, 8.0);
    mud solid = of;
    solid.value[YIELD].value = 1e300;
    path s = open_mud(&of), trial = open_mud(&solid);
    const double G = of.value[SHEAR].value, yield = of.value[YIELD].value, k = of.value[K].value;
    for (int32_t i = 0; i < 250; ++i) {
      double F_inc[9], digits;
      s.dt = trial.dt = power_of_ten(&seed, -8.0, 2.0);
      random_step(&seed, &s, F_inc);
      memcpy(trial.stress, s.stress, sizeof s.stress);
      memcpy(trial.F, s.F, sizeof s.F);
      advance(&s, F_inc);
      advance(&trial, F_inc);
      const invariants now = invariants_of(&s), before = invariants_of(&trial);
      const double lost = dissipated(&s, &trial, G, of.value[1].value, &digits);
      ck_holds(lost >= -digits);
      took += lost > digits;
      const double t = now.q / sqrt(3.0), from = before.q / sqrt(3.0);
      const double scale = 1e-12 * (from + fabs(now.p) + 1.0);
      ck_within("pressure", now.p, before.p, scale);
      if (from <= yield) {
        ck_within("elastic", t, from, scale);
      } else {
        const double x = fmax(from - t, 0.0) / (G * s.dt), n = of.value[N].value;
        /* x is a difference: what its rounding is worth in the stress */
        const double off =
            k > 0.0 ? k * (pow(x + scale / (G * s.dt), n) - pow(fmax(x - scale / (G * s.dt), 0.0), n)) : 0.0;
        ck_holds(t <= from + scale && t >= yield - scale);
        ck_within("yield", t, yield + (k > 0.0 ? k * pow(x, n) : 0.0), scale + off);
      }
      ck_holds(s.energy <= trial.energy + scale && s.wave > 0.0);
      for (int c = 0; c < 6; ++c) {
        const double J = jacobian_of(&s), p = c < 3 ? now.p : 0.0;
        ck_within("direction", J * s.stress[c] + p, (from > 0.0 ? t / from : 1.0) * (J * trial.stress[c] + p),
                  10.0 * scale);
      }
      ++seen[from > yield];
    }
    law_material_free(s.material);
    law_material_free(trial.material);
  }
  for (int k = 0; k < 2; ++k) ck_assert_int_gt(seen[k], RANDOM / 10);
  ck_assert_int_gt(took, RANDOM / 4);
}
END_TEST

/* 0 below yield, 2 above, 1 where differences would come near the kink; and 4 where pressure is cut off, 8
 * near that. */
static int32_t regime_of(const path *from, const path *to) {
  const double *value = from->material->value, J = jacobian_of(to), t = shear_stress(to);
  const double reach = 1e-4 * value[SHEAR] + 1e-4 * value[YIELD];
  return (t > value[YIELD] + reach ? 2 : t > value[YIELD] - reach) + (value[TENSION] > 0.0   ? 0
                                                                      : fabs(J - 1.0) < 1e-4 ? 8
                                                                      : J > 1.0              ? 4
                                                                                             : 0);
}

START_TEST(random_tangents) {
  uint64_t seed = 42;
  int32_t compared[16] = {0};
  double worst = 0.0;
  for (int32_t k = 0; k < TESTED; ++k) {
    const mud of = random_mud(&seed, 5.0);
    path s = open_mud(&of), end;
    double F_inc[9];
    int32_t smooth;
    s.dt = power_of_ten(&seed, -4.0, 0.0);
    random_step(&seed, &s, F_inc);
    end = s;
    advance(&end, F_inc);
    const int32_t regime = regime_of(&s, &end);
    const double off = tangent_off(&s, F_inc, regime_of, &smooth) / (4e7 + of.value[SHEAR].value);
    if (smooth && !(regime & 9)) worst = fmax(worst, off);
    if (smooth) ++compared[regime];
    law_material_free(s.material);
  }
  ck_assert_int_gt(compared[0], TESTED / 20);
  ck_assert_int_gt(compared[2], TESTED / 6);
  ck_assert_int_gt(compared[4], TESTED / 50);
  ck_assert_int_gt(compared[6], TESTED / 20);
  ck_between("tangent", worst, 0.0, 1e-8);
}
END_TEST

static path draw(uint64_t *seed, double *F_inc) {
  const mud of = random_mud(seed, 5.0);
  path s = open_mud(&of);
  random_step(seed, &s, F_inc);
  return s;
}

START_TEST(frames) {
  ck_frames(draw, 43);
}
END_TEST

START_TEST(dimensions) {
  for (int32_t linear = 0; linear < 2; ++linear) {
    const mud of = with(1e7, 1e4, 3e3, linear ? 1.0 : 0.6);
    ck_dimensions(_i, "herschel_bulkley", of.value, PARAMS, 0.0L, 3e4L, NULL, 44);
  }
}
END_TEST

Suite *herschel_bulkley_suite(void) {
  Suite *suite = suite_create("herschel_bulkley");
  TCase *tc = tcase_create("herschel_bulkley");
  tcase_set_timeout(tc, 60.0);
  tcase_add_test(tc, starting_flow);
  tcase_add_test(tc, relaxation);
  tcase_add_test(tc, yield_is_exact);
  tcase_add_test(tc, volume_alone);
  tcase_add_test(tc, parameters_are_refused);
  tcase_add_loop_test(tc, stress_of_the_host, 0, 3);
  tcase_add_test(tc, random_states_yield);
  tcase_add_test(tc, random_tangents);
  tcase_add_test(tc, frames);
  tcase_add_loop_test(tc, dimensions, 0, LAW_LOOPS);
  suite_add_tcase(suite, tc);
  return suite;
}
