/* mu_i: numbers of an independent program, the law in steady flow, gaps, random states. */
#include "law_path.h"
#include "simd/elementary.h"

enum { MU_S = 3, MU_2, I_0, DIAMETER, GRAINS, PARAMS };
typedef struct beads {
  mpm_param value[PARAMS];
} beads;

static beads with(double E, double nu, double mu_s, double mu_2, double I_zero) {
  return (beads){{{"E", E},
                  {"nu", nu},
                  {"density", 1500.0},
                  {"mu_s", mu_s},
                  {"mu_2", mu_2},
                  {"I_0", I_zero},
                  {"grain_diameter", 0.01},
                  {"grain_density", 2500.0}}};
}
static path open_beads(const beads *of) {
  return path_of("mu_i", of->value, PARAMS);
}
static double shear_stress(const path *s) {
  return invariants_of(s).q / sqrt(3.0);
}
static double friction(const double *value, double rate, double p) {
  const double I = rate * value[DIAMETER] * sqrt(value[GRAINS] / p);
  return value[MU_S] + (value[MU_2] - value[MU_S]) / (1.0 + value[I_0] / I);
}

/* In steady shear at a pressure the friction is mu(I), whatever the step. */
START_TEST(steady_flow) {
  static const double rate[3] = {1.0, 10.0, 100.0},
                      ratio[3] = {0.395930187922, 0.476526579944, 0.604262928648};
  const beads of = with(2.6e6, 0.3, 0.3819, 0.6435, 0.279);
  path s = open_beads(&of);
  for (int k = 0; k < 3; ++k) {
    start(&s, -1000.0);
    s.dt = 1e-4 / rate[k];
    for (int step = 0; step < 200; ++step) stretch(&s, 0.5 * rate[k] * s.dt, -0.5 * rate[k] * s.dt, 0.0);
    ck_number("pressure", invariants_of(&s).p, 1000.0);
    double before = 0.0;
    for (int step = 0; step < 200000 && shear_stress(&s) != before; ++step) {
      before = shear_stress(&s);
      stretch(&s, 0.5 * rate[k] * s.dt, -0.5 * rate[k] * s.dt, 0.0);
    }
    ck_within("friction", shear_stress(&s) / invariants_of(&s).p, ratio[k], 1e-9);
    ck_within("friction", shear_stress(&s) / invariants_of(&s).p,
              friction(s.material->value, rate[k], 1000.0), 1e-9);
  }
  law_material_free(s.material);
}
END_TEST

START_TEST(one_return) {
  const beads of = with(2.6e6, 0.3, 0.3819, 0.6435, 0.279);
  path s = open_beads(&of);
  start(&s, -1000.0);
  s.stress[0] += 900.0, s.stress[1] -= 900.0;
  s.dt = 1e-4;
  stretch(&s, 0.0, 0.0, 0.0);
  ck_number("shear stress", shear_stress(&s), 436.335751264);
  ck_number("pressure", invariants_of(&s).p, 1000.0);
  ck_number("plastic strain", s.state[0], (900.0 - 436.335751264) / (sqrt(3.0) * 1e6));
  law_material_free(s.material);
}
END_TEST

/* Grains that are spread open without stress, and bear again when their volume is back. */
START_TEST(gaps_close) {
  static const double by[] = {1.01, 1.01, 0.985, 0.99, 0.999};
  static const double p[] = {0.0, 0.0, 0.0, 277513.09818, 329321.251911};
  static const double gap[] = {0.02925099256, 0.05910198512, 0.01376107169, 0.0, 0.0};
  const beads of = with(20e6, 0.3, 0.3819, 0.6435, 0.279);
  path s = open_beads(&of);
  start(&s, -1e4);
  for (int32_t k = 0; k < 5; ++k) {
    stretch(&s, mpmi_ln(by[k]), mpmi_ln(by[k]), mpmi_ln(by[k]));
    ck_within("pressure", -s.stress[0], p[k], 1e-10 * 3e5);
    ck_within("gap", s.state[1], gap[k], 1e-11);
    for (int c = 0; c < 81 && k < 3; ++c) ck_within("tangent", s.tangent[c], 0.0, 1e-6);
  }
  const double bulk = 20e6 / 1.2, J = jacobian_of(&s);
  ck_within("pressure", -s.stress[0], -bulk * (mpmi_ln(J) - 1e4 / bulk) / J, 1e-10 * 3e5);
  law_material_free(s.material);
}
END_TEST

/* Without stress grains are stiff against pressure; a sheared particle that just opens bears nothing. */
START_TEST(at_rest) {
  const beads of = with(20e6, 0.3, 0.3819, 0.6435, 0.279);
  const double mu = 20e6 / 2.6, bulk = 20e6 / 1.2;
  path s = open_beads(&of);
  start(&s, 0.0);
  stretch(&s, 0.0, 0.0, 0.0);
  ck_within("xxxx", s.tangent[0], bulk + 4.0 / 3.0 * mu, 1e-8 * bulk);
  ck_within("xyxy", s.tangent[9 + 1], mu, 1e-8 * bulk);
  ck_number("wave", s.wave, sqrt((bulk + 4.0 / 3.0 * mu) / 1500.0));
  start(&s, 0.0);
  stretch(&s, 1e-4, -1e-4, 0.0);
  for (int c = 0; c < 6; ++c) ck_within("stress", s.stress[c], 0.0, 1e-4);
  for (int c = 0; c < 81; ++c) ck_holds(fabs(s.tangent[c]) < 4e7);
  law_material_free(s.material);
}
END_TEST

START_TEST(parameters_go_together) {
  static const struct {
    int which;
    double value;
    const char *text;
  } rows[] = {{MU_2, 0.3819, "mu_2 must be larger than mu_s"},
              {MU_2, 0.2, "mu_2 must be larger than mu_s"},
              {MU_S, -0.1, "mu_s = -0.1"},
              {I_0, 0.0, "I_0 = 0"},
              {DIAMETER, 0.0, "grain_diameter = 0"},
              {GRAINS, -1.0, "grain_density = -1"}};
  mpm_context *context = context_with(1, MPM_ISA_BEST, NULL);
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    beads of = with(20e6, 0.3, 0.3819, 0.6435, 0.279);
    mpm_material *m;
    of.value[rows[k].which].value = rows[k].value;
    ck_refused(context, mpm_material_create(context, "mu_i", of.value, PARAMS, &m), MPM_E_ARG, rows[k].text);
    ck_assert_ptr_null(m);
  }
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* ---- random states ------------------------------------------------------------------------------------- */
enum { RANDOM = 100000, TESTED = 3000 };

static beads random_beads(uint64_t *seed) {
  const double mu_s = wide(seed, 0.0, 0.8);
  beads of = with(20e6, wide(seed, 0.1, 0.45), mu_s, mu_s + wide(seed, 0.01, 0.8), wide(seed, 0.01, 1.0));
  of.value[DIAMETER].value = mpmi_exp(wide(seed, -9.0, -2.0));
  return of;
}

/* A step of a random size from a random stress, in a time from 1e-7 to 1. */
static void random_step(uint64_t *seed, path *s, double *F_inc) {
  random_increment(seed, F_inc);
  const tensor t = random_stress(seed, 3, 5e4L);
  const double p = wide(seed, -1e4, 3e5);
  start(s, 0.0);
  s->dt = mpmi_exp(wide(seed, -16.0, 0.0));
  for (int c = 0; c < 6; ++c) s->stress[c] = (double)t.m[sym_row[c]][sym_column[c]] - (c < 3 ? p : 0.0);
  s->state[0] = wide(seed, 0.0, 0.05);
  s->state[1] = fmax(wide(seed, -0.01, 0.01), 0.0);
}

/* The trial is that of grains whose friction is never overcome. */
START_TEST(random_states_yield) {
  uint64_t seed = 61;
  int32_t seen[3] = {0, 0, 0}, took = 0;
  for (int32_t round = 0; round < RANDOM / 500; ++round) {
    const beads of = random_beads(&seed);
    beads locked = of;
    locked.value[MU_S].value = 1e100, locked.value[MU_2].value = 2e100;
    path s = open_beads(&of), trial = open_beads(&locked);
    const double E = of.value[0].value, nu = of.value[1].value, G = E / (2 + 2 * nu);
    for (int32_t k = 0; k < 500; ++k) {
      double F_inc[9], digits;
      random_step(&seed, &s, F_inc);
      path_like(&trial, &s);
      const double plastic = s.state[0];
      advance(&s, F_inc);
      advance(&trial, F_inc);
      const invariants now = invariants_of(&s);
      const double lost = dissipated(&s, &trial, G, E / (3 - 6 * nu), &digits);
      ck_holds(lost >= -digits);
      took += lost > digits;
      const double t = now.q / sqrt(3.0), from = shear_stress(&trial), scale = 1e-11 * (now.p + from + 1e5);
      ck_holds(s.state[0] >= plastic && s.state[1] >= 0.0 && s.energy >= 0.0 && s.wave > 0.0);
      ck_within("gap", s.state[1], trial.state[1], 1e-14);
      const int32_t open = s.state[1] > 0.0, flows = !open && from > of.value[MU_S].value * now.p;
      if (open) {
        for (int c = 0; c < 6; ++c) ck_holds(s.stress[c] == 0.0);
      } else {
        ck_within("pressure", now.p, invariants_of(&trial).p, scale);
        ck_holds(t <= from + scale && t <= of.value[MU_2].value * now.p + scale);
        ck_within("plastic strain", s.state[0] - plastic, (from - t) / (sqrt(3.0) * G), scale / G);
      }
      if (flows) {
        const double least = fmax((from - t - scale) / (G * s.dt), 1e-300),
                     most = (from - t + scale) / (G * s.dt);
        ck_holds(t >= now.p * friction(s.material->value, least, now.p) - scale);
        ck_holds(t <= now.p * friction(s.material->value, most, now.p) + scale);
      }
      if (!flows && !open) ck_within("elastic", t, from, scale);
      ++seen[open ? 2 : flows];
    }
    law_material_free(s.material);
    law_material_free(trial.material);
  }
  for (int k = 0; k < 3; ++k) ck_assert_int_gt(seen[k], RANDOM / 50);
  ck_assert_int_gt(took, RANDOM / 4);
}
END_TEST

static int32_t regime_of(const path *from, const path *to) {
  return (to->state[0] > from->state[0]) + 2 * (to->state[1] > 0.0);
}

/* Differences change the pressure by a share of it that is not small where grains are about to open: there
 * they are no measure. */
START_TEST(random_tangents) {
  uint64_t seed = 62;
  int32_t compared[4] = {0};
  double worst = 0.0;
  for (int32_t k = 0; k < TESTED; ++k) {
    const beads of = random_beads(&seed);
    path s = open_beads(&of), end;
    double F_inc[9];
    int32_t smooth;
    random_step(&seed, &s, F_inc);
    end = s;
    advance(&end, F_inc);
    const double off = tangent_off(&s, F_inc, regime_of, &smooth) / 4e7;
    const int32_t opens_soon = end.state[1] == 0.0 && invariants_of(&end).p < 1e-4 * of.value[0].value;
    if (smooth && !opens_soon) {
      worst = fmax(worst, off);
      ++compared[regime_of(&s, &end)];
    }
    law_material_free(s.material);
  }
  ck_assert_int_gt(compared[0], TESTED / 20);
  ck_assert_int_gt(compared[1], TESTED / 4);
  ck_assert_int_gt(compared[2] + compared[3], TESTED / 20);
  ck_between("tangent", worst, 0.0, 1e-8);
}
END_TEST

static path draw(uint64_t *seed, double *F_inc) {
  const beads of = random_beads(seed);
  path s = open_beads(&of);
  random_step(seed, &s, F_inc);
  return s;
}

START_TEST(frames) {
  ck_frames(draw, 63);
}
END_TEST

START_TEST(dimensions) {
  static const double gap[2] = {0.0, 1e-3};
  const beads of = with(20e6, 0.3, 0.3819, 0.6435, 0.279);
  ck_dimensions(_i, "mu_i", of.value, PARAMS, 0.0L, 3e4L, gap, 64);
}
END_TEST

Suite *mu_i_suite(void) {
  Suite *suite = suite_create("mu_i");
  TCase *tc = tcase_create("mu_i");
  tcase_set_timeout(tc, 60.0);
  tcase_add_test(tc, steady_flow);
  tcase_add_test(tc, one_return);
  tcase_add_test(tc, gaps_close);
  tcase_add_test(tc, at_rest);
  tcase_add_test(tc, parameters_go_together);
  tcase_add_test(tc, random_states_yield);
  tcase_add_test(tc, random_tangents);
  tcase_add_test(tc, frames);
  tcase_add_loop_test(tc, dimensions, 0, LAW_LOOPS);
  suite_add_tcase(suite, tc);
  return suite;
}
