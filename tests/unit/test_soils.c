/* Laws of soils: numbers of an independent program for paths without a grid, random states, tangents against
 * differences of whole steps. */
#include "law_path.h"
#include "simd/elementary.h"

/* ---- drucker_prager ------------------------------------------------------------------------------------ */
enum { DP_PHI = 3, DP_PSI, DP_C, DP_CONE, DP_T, DP_H, DP_RES, DP_CLOSE, DP_PARAMS };
typedef struct soil {
  mpm_param value[DP_PARAMS];
} soil;

static soil sand(double phi, double psi, double cohesion, double cone) {
  return (soil){{{"E", 20e6},
                 {"nu", 0.3},
                 {"density", 2e3},
                 {"phi", phi},
                 {"psi", psi},
                 {"cohesion", cohesion},
                 {"cone", cone},
                 {"tension_cutoff", (double)INFINITY},
                 {"hardening", 0.0},
                 {"cohesion_residual", 0.0},
                 {"close_gaps", 1.0}}};
}
static path open_soil(const soil *of) {
  return path_of("drucker_prager", of->value, DP_PARAMS);
}

START_TEST(simple_shear) {
  static const struct {
    double psi, xx, yy, zz, xy, plastic;
    int32_t steps;
  } rows[] = {
      {0.0, -98238.49957533, -101761.50042467, -100000.0, 70460.01698680, 0.0235744406302, 1},
      {0.0, -99192.45018236, -100807.54981762, -100000.0, 70477.40588882, 0.0235763129787, 10},
      {10.0, -206107.33420321, -213431.67449257, -209769.50434788, 146486.80578727, 0.0178664264042, 1},
      {10.0, -207349.80258418, -212201.39628207, -209775.59943312, 146516.71864538, 0.0178674184592, 10}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    const soil of = sand(30.0, rows[k].psi, 1e3, 0.0);
    path s = open_soil(&of);
    start(&s, -1e5);
    shear(&s, 0.05, rows[k].steps);
    ck_number("xx", s.stress[0], rows[k].xx);
    ck_number("yy", s.stress[1], rows[k].yy);
    ck_number("zz", s.stress[2], rows[k].zz);
    ck_number("xy", s.stress[3], rows[k].xy);
    ck_number("plastic strain", s.state[0], rows[k].plastic);
    ck_assert(s.state[1] == 0.0);
    law_material_free(s.material);
  }
  /* the rate equations, integrated by tiny steps */
  static const double rate[2][4] = {{0.0, -99357.96, -100642.04, 70479.1080},
                                    {10.0, -207549.48, -212004.06, 146520.6818}};
  for (int32_t k = 0; k < 2; ++k) {
    const soil of = sand(30.0, rate[k][0], 1e3, 0.0);
    path s = open_soil(&of);
    start(&s, -1e5);
    shear(&s, 0.05, 1000);
    ck_within("xx", s.stress[0], rate[k][1], 2e-5 * fabs(rate[k][1]));
    ck_within("yy", s.stress[1], rate[k][2], 2e-5 * fabs(rate[k][2]));
    ck_within("xy", s.stress[3], rate[k][3], 2e-5 * fabs(rate[k][3]));
    law_material_free(s.material);
  }
}
END_TEST

/* Sand that is spread opens without stress, and bears again when its volume is back. */
START_TEST(gaps_close) {
  static const double by[] = {1.01, 1.01, 0.985, 0.99, 0.999};
  static const double p[] = {0.0, 0.0, 0.0, 277513.09818, 329321.251911},
                      at_once[] = {744907.0, 1278223.0, 1333040.0};
  static const double gap[] = {0.02925099256, 0.05910198512, 0.01376107169, 0.0, 0.0};
  for (int32_t close = 0; close < 2; ++close) {
    soil of = sand(30.0, 0.0, 0.0, 0.0);
    of.value[DP_CLOSE].value = close;
    path s = open_soil(&of);
    start(&s, -1e4);
    for (int32_t k = 0; k < 5; ++k) {
      stretch(&s, mpmi_ln(by[k]), mpmi_ln(by[k]), mpmi_ln(by[k]));
      ck_assert(s.stress[0] == s.stress[1] && fabs(s.stress[3]) < 1e-9);
      if (close) {
        ck_within("pressure", -s.stress[0], p[k], 1e-10 * 3e5);
        ck_within("gap", s.state[1], gap[k], 1e-11);
      } else if (k >= 2) {
        ck_within("pressure", -s.stress[0], at_once[k - 2], 0.5);
        ck_assert(s.state[1] == 0.0);
      }
    }
    const double bulk = 20e6 / 1.2, J = jacobian_of(&s);
    if (close) ck_within("pressure", -s.stress[0], -bulk * (mpmi_ln(J) - 1e4 / bulk) / J, 1e-10 * 3e5);
    law_material_free(s.material);
  }
}
END_TEST

START_TEST(softening_and_cut_off) {
  soil of = sand(30.0, 0.0, 1e4, 0.0);
  of.value[DP_H].value = -2e5;
  of.value[DP_RES].value = 2e3;
  path s = open_soil(&of);
  start(&s, -1e5);
  shear(&s, 0.05, 50);
  ck_within("xy", s.stress[3], 75713.91930, 1e-5);
  ck_within("xx", s.stress[0], -99212.92903, 1e-5);
  ck_within("plastic strain", s.state[0], 0.023183426, 1e-9);
  law_material_free(s.material);

  of = sand(30.0, 10.0, 5e3, 0.0);
  of.value[DP_T].value = 2e3;
  s = open_soil(&of);
  start(&s, 0.0);
  stretch(&s, 0.001, 0.001, 0.001);
  for (int k = 0; k < 3; ++k) ck_number("tau", s.stress[k] * jacobian_of(&s), 2000.0);
  ck_within("gap", s.state[1], 0.00288, 1e-12);
  start(&s, 0.0);
  stretch(&s, 0.003, 0.0, -0.0028);
  static const double tau[] = {2783.18740678, -11284.795519627, -24414.912917606};
  for (int k = 0; k < 3; ++k) ck_number("tau", s.stress[k] * jacobian_of(&s), tau[k]);
  ck_within("plastic strain", s.state[0], 0.002328409, 1e-9);
  start(&s, 0.0); /* at the corner of cone and cut-off */
  stretch(&s, 0.004, 0.001, -0.001);
  static const double corner[] = {6889.49461714, 1388.81317286, -2278.30779};
  for (int k = 0; k < 3; ++k) ck_within("tau", s.stress[k] * jacobian_of(&s), corner[k], 1e-8 * 7e3);
  ck_within("plastic strain", s.state[0], 0.0025596, 1e-8);
  ck_within("gap", s.state[1], 0.00388, 1e-12);
  law_material_free(s.material);
}
END_TEST

/* Compressed alike on all axes, and nearly so, soil is elastic: its energy and tangent are known. */
START_TEST(all_axes_alike) {
  const soil of = sand(30.0, 10.0, 1e3, 0.0);
  const double mu = 20e6 / 2.6, bulk = 20e6 / 1.2;
  path s = open_soil(&of);
  for (int k = 0; k < 3; ++k) {
    const double e = -0.01, d = k * 1e-10;
    start(&s, 0.0);
    stretch(&s, e + d, e, e);
    const double p = -(3.0 * e + d) * bulk;
    ck_number("energy", s.energy, 0.5 * p * p / bulk);
    ck_within("xxxx", s.tangent[0], bulk + 4.0 / 3.0 * mu + 2.0 * p, 1e-8 * bulk);
    ck_within("xxyy", s.tangent[4], bulk - 2.0 / 3.0 * mu, 1e-8 * bulk);
    ck_within("xyxy", s.tangent[9 + 1], mu + p, 1e-8 * bulk);
    ck_within("yzyz", s.tangent[9 * 5 + 5], mu + p, 1e-8 * bulk);
    ck_number("wave", s.wave, sqrt((bulk + 4.0 / 3.0 * mu + p) / 2e3));
  }
  start(&s, 0.0);
  shear(&s, 1e-5, 1);
  ck_within("energy", s.energy, 0.5 * mu * 1e-10, 1e-6 * mu * 1e-10);
  law_material_free(s.material);
}
END_TEST

static void ck_refuses(mpm_context *context, int32_t which, double value, const char *text) {
  soil of = sand(30.0, 10.0, 1e3, 0.0);
  mpm_material *m;
  of.value[which].value = value;
  ck_refused(context, mpm_material_create(context, "drucker_prager", of.value, DP_PARAMS, &m), MPM_E_ARG,
             text);
  ck_assert_ptr_null(m);
}

START_TEST(parameters_go_together) {
  mpm_context *context = context_with(1, MPM_ISA_BEST, NULL);
  ck_refuses(context, DP_PSI, 31.0, "psi must not be larger than phi");
  ck_refuses(context, DP_RES, 1001.0, "cohesion_residual must not be larger");
  ck_refuses(context, DP_H, -1e8, "hardening is so negative");
  ck_refuses(context, DP_CONE, 1.5, "cone = 1.5");
  ck_refuses(context, DP_PHI, 90.0, "phi = 90");
  ck_refuses(context, DP_T, -1.0, "tension_cutoff");
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* In triaxial compression the first cone is Mohr-Coulomb, the others are weaker. */
START_TEST(cones) {
  static const double strength[] = {-317267.098469, -230338.949965, -225066.315623};
  for (int32_t cone = 0; cone < 3; ++cone) {
    const soil of = sand(30.0, 5.0, 5e3, cone);
    path s = open_soil(&of);
    start(&s, -1e5);
    triaxial(&s, -0.05, 20);
    ck_within("axial stress", s.stress[2], strength[cone], 1e-6 * 3e5);
    law_material_free(s.material);
  }
}
END_TEST

/* Without friction there is no apex: what is left without cohesion is a fluid that keeps its pressure, on
 * every instruction set. */
START_TEST(without_friction) {
  for (int32_t isa = MPM_ISA_BASELINE; isa <= MPM_ISA_NEON; ++isa)
    for (int32_t which = 0; which < 3; ++which) {
      soil of = sand(0.0, 0.0, which == 1 ? 1e3 : 0.0, 0.0);
      uint64_t seed = 21;
      if (which == 1) of.value[DP_H].value = -2e5;
      if (which == 2) of.value[DP_T].value = 0.0;
      path s = {.F = {0}};
      s.material = law_material(isa, "drucker_prager", of.value, DP_PARAMS);
      for (int32_t k = 0; s.material && k < 300; ++k) {
        const tensor g = random_tensor(&seed, 3, 1e-2L);
        double F_inc[9];
        for (int c = 0; c < 9; ++c) F_inc[c] = (double)((c % 4 == 0) + g.m[c / 3][c % 3]);
        start(&s, -1e6);
        s.state[0] = 1.0; /* soft by now */
        advance(&s, F_inc);
        const double J = jacobian_of(&s), p = 1e6 - 20e6 / 1.2 * mpmi_ln(J);
        ck_between("pressure", p, 1e5, 2e6);
        for (int c = 0; c < 6; ++c) ck_within("stress", J * s.stress[c], c < 3 ? -p : 0.0, 1e-8 * p);
      }
      if (s.material) law_material_free(s.material);
    }
}
END_TEST

/* An open particle has no stiffness, also where it has opened alike on all axes; a stress beyond what a
 * strain can be is found, and a gap below 0 is none. */
START_TEST(ends_of_the_range) {
  const soil of = sand(30.0, 0.0, 0.0, 0.0);
  path s = open_soil(&of);
  for (int k = 0; k < 9; ++k) {
    const double open = 0.001 * (k + 1);
    start(&s, 0.0);
    advance(&s, (const double[]){1 + open, 0, 0, 0, 1 + open, 0, 0, 0, 1 + open});
    ck_assert(s.state[1] > 0.0);
    for (int c = 0; c < 81; ++c) ck_within("tangent", s.tangent[c], 0.0, 1e-6);
  }
  start(&s, -1e5);
  s.state[1] = -0.01;
  stretch(&s, 0.0, 0.0, 0.0);
  ck_within("pressure", s.stress[0], -1e5, 1e-6);
  for (int k = 0; k < 2; ++k) {
    double F[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, stress[6] = {0}, state[2] = {0};
    for (int c = 0; c < 3; ++c) stress[c] = k ? -40.0 * 20e6 : 40.0 * 20e6;
    const mpm_material_batch b = {.struct_size = sizeof b,
                                  .state_count = 2,
                                  .n = 1,
                                  .ld = 1,
                                  .dt = 1.0,
                                  .F = F,
                                  .F_inc = F,
                                  .stress = stress,
                                  .state = state,
                                  .stress_new = stress,
                                  .state_new = state};
    ck_refused(s.material->context, mpm_material_update(s.material, &b, NULL, NULL), MPM_NONFINITE, "item 0");
  }
  law_material_free(s.material);
}
END_TEST

/* Tangents at strains as small as 1e-8, where the axes are not alike for all that. */
START_TEST(small_strains) {
  soil of = sand(30.0, 0.0, 0.0, 0.0);
  of.value[0].value = 1e9;
  const double mu = 1e9 / 2.6;
  path s = open_soil(&of);
  start(&s, 0.0);
  stretch(&s, 2e-8, -0.7e-8, -4.3e-8);
  ck_assert(s.state[0] > 0.0 && s.state[1] == 0.0);
  /* the return keeps the share r of the deviator: shear across the axes has r mu - (tau_A + tau_B) / 2 */
  const double mean = (2e-8 - 0.7e-8 - 4.3e-8) / 3.0,
               kept = (s.stress[0] - s.stress[2]) / (2.0 * mu * 6.3e-8);
  ck_assert(mean < 0.0);
  ck_within("xyxy", s.tangent[9 + 1], kept * mu, 1e-5 * mu);
  ck_within("yzyz", s.tangent[9 * 5 + 5], kept * mu, 1e-5 * mu);
  ck_within("xzxz", s.tangent[9 * 2 + 2], kept * mu, 1e-5 * mu);
  law_material_free(s.material);
}
END_TEST

/* ---- random states ------------------------------------------------------------------------------------- */
enum { RANDOM = 100000, TESTED = 3000 };

static soil random_soil(uint64_t *seed) {
  const double phi = wide(seed, 0.0, 45.0);
  soil of = sand(phi, wide(seed, 0.0, phi), wide(seed, 0.0, 2e4), floor(wide(seed, 0.0, 2.999)));
  const double pick = wide(seed, 0.0, 3.0);
  of.value[1].value = wide(seed, 0.1, 0.45);
  if (pick > 1.0) of.value[DP_T].value = wide(seed, 0.0, 2e4);
  if (pick > 2.0) of.value[DP_H].value = wide(seed, -2e5, 2e5);
  of.value[DP_RES].value = 0.3 * of.value[DP_C].value;
  return of;
}

/* A step of a random size from a random stress inside or outside of the yield surface. */
static void random_step(uint64_t *seed, path *s, double *F_inc) {
  random_increment(seed, F_inc);
  const tensor t = random_stress(seed, 3, 5e4L);
  const double p = wide(seed, -3e4, 2e5);
  start(s, 0.0);
  for (int c = 0; c < 6; ++c) s->stress[c] = (double)t.m[sym_row[c]][sym_column[c]] - (c < 3 ? p : 0.0);
  s->state[0] = wide(seed, 0.0, 0.05);
  s->state[1] = wide(seed, -0.01, 0.01);
  if (s->state[1] < 0.0) s->state[1] = 0.0;
}

/* The yield surface is met, nothing bears more tension than it may, state grows as it must, and flow takes
 * energy. The trial is that of a soil which bears everything. */
START_TEST(random_states_yield) {
  static const double pi = 3.14159265358979323846;
  uint64_t seed = 17;
  int32_t seen[3] = {0, 0, 0}, took = 0;
  for (int32_t round = 0; round < RANDOM / 500; ++round) {
    const soil of = random_soil(&seed);
    const double s30 = sin(of.value[DP_PHI].value * pi / 180), cone = of.value[DP_CONE].value;
    const double c30 = cos(of.value[DP_PHI].value * pi / 180), t30 = s30 / c30,
                 r30 = sqrt(9 + 12 * t30 * t30);
    const double M = cone > 1.5 ? 3 * sqrt(3.0) * t30 / r30 : 6 * s30 / (3 + (cone > 0.5 ? s30 : -s30));
    const double kappa = cone > 1.5 ? 3 * sqrt(3.0) / r30 : 6 * c30 / (3 + (cone > 0.5 ? s30 : -s30));
    soil firm = sand(0.0, 0.0, 1e100, 0.0);
    firm.value[1] = of.value[1];
    path s = open_soil(&of), trial = open_soil(&firm);
    const double E = of.value[0].value, nu = of.value[1].value;
    for (int32_t k = 0; k < 500; ++k) {
      double F_inc[9], digits;
      random_step(&seed, &s, F_inc);
      path_like(&trial, &s);
      const double plastic = s.state[0], H = of.value[DP_H].value;
      advance(&s, F_inc);
      advance(&trial, F_inc);
      const invariants now = invariants_of(&s);
      const double lost = dissipated(&s, &trial, E / (2 + 2 * nu), E / (3 - 6 * nu), &digits);
      ck_holds(lost >= -digits);
      took += lost > digits;
      const double cohesion = fmax(of.value[DP_C].value + H * s.state[0], of.value[DP_RES].value);
      const double before = fmax(of.value[DP_C].value + H * plastic, of.value[DP_RES].value);
      const double scale = 1e-11 * (fabs(now.p) + now.q + 1e5);
      const int32_t open = s.state[1] > 0.0;
      ck_holds(now.q - M * now.p <= kappa * fmax(cohesion, open ? before : 0.0) + scale);
      ck_holds(now.p >= -of.value[DP_T].value - scale);
      ck_holds(s.state[0] >= plastic && s.state[1] >= 0.0 && s.energy >= 0.0 && s.wave > 0.0);
      if (s.state[0] > plastic && !open)
        ck_within("yield", now.q - M * now.p, kappa * cohesion, scale + 1e-6 * (double)(now.q < 1e-6));
      ++seen[open ? 2 : s.state[0] > plastic];
    }
    law_material_free(s.material);
    law_material_free(trial.material);
  }
  for (int k = 0; k < 3; ++k) ck_assert_int_gt(seen[k], RANDOM / 50);
  ck_assert_int_gt(took, RANDOM / 2);
}
END_TEST

static path draw(uint64_t *seed, double *F_inc) {
  const soil of = random_soil(seed);
  path s = open_soil(&of);
  random_step(seed, &s, F_inc);
  return s;
}

START_TEST(frames) {
  ck_frames(draw, 19);
}
END_TEST

START_TEST(dimensions) {
  static const double gap[2] = {0.0, 1e-3};
  const soil of = sand(30.0, 10.0, 2e3, 2.0);
  ck_dimensions(_i, "drucker_prager", of.value, DP_PARAMS, 0.0L, 3e4L, gap, 20);
}
END_TEST

static int32_t regime_of(const path *from, const path *to) {
  return (to->state[0] > from->state[0]) + 2 * (to->state[1] > 0.0);
}

START_TEST(random_tangents) {
  uint64_t seed = 18;
  int32_t compared = 0;
  double worst = 0.0;
  for (int32_t k = 0; k < TESTED; ++k) {
    const soil of = random_soil(&seed);
    path s = open_soil(&of);
    double F_inc[9];
    int32_t smooth;
    random_step(&seed, &s, F_inc);
    const double off = tangent_off(&s, F_inc, regime_of, &smooth) / 4e7;
    if (smooth) {
      worst = fmax(worst, off);
      ++compared;
    }
    law_material_free(s.material);
  }
  ck_assert_int_gt(compared, TESTED * 9 / 10);
  ck_between("tangent", worst, 0.0, 1e-8);
}
END_TEST

Suite *soils_suite(void) {
  Suite *suite = suite_create("soils");
  TCase *tc = tcase_create("drucker_prager");
  tcase_set_timeout(tc, 60.0);
  tcase_add_test(tc, simple_shear);
  tcase_add_test(tc, gaps_close);
  tcase_add_test(tc, softening_and_cut_off);
  tcase_add_test(tc, all_axes_alike);
  tcase_add_test(tc, without_friction);
  tcase_add_test(tc, ends_of_the_range);
  tcase_add_test(tc, small_strains);
  tcase_add_test(tc, parameters_go_together);
  tcase_add_test(tc, cones);
  tcase_add_test(tc, random_states_yield);
  tcase_add_test(tc, random_tangents);
  tcase_add_test(tc, frames);
  tcase_add_loop_test(tc, dimensions, 0, LAW_LOOPS);
  suite_add_tcase(suite, tc);
  return suite;
}
