/* mohr_coulomb: numbers of an independent program for planes, edges and apex, closed forms, random states. */
#include "law_path.h"
#include "simd/elementary.h"
#include "simd/tensor.h"

enum { PHI = 3, PSI, C, T, H, RES, CLOSE, PARAMS };
typedef struct rock {
  mpm_param value[PARAMS];
} rock;

static rock with(double nu, double phi, double psi, double cohesion) {
  return (rock){{{"E", 20e6},
                 {"nu", nu},
                 {"density", 2e3},
                 {"phi", phi},
                 {"psi", psi},
                 {"cohesion", cohesion},
                 {"tension_cutoff", (double)INFINITY},
                 {"hardening", 0.0},
                 {"cohesion_residual", 0.0},
                 {"close_gaps", 1.0}}};
}
static path open_rock(const rock *of) {
  return path_of("mohr_coulomb", of->value, PARAMS);
}

START_TEST(planes_edges_and_apex) {
  static const struct {
    double trial[3], tau[3], plastic;
  } rows[] = {{{0.004, -0.001, -0.008}, {-44198.4045094, -78234.2378340, -149915.7216040}, 0.0044413025},
              {{0.0015, 0.0014, -0.008}, {-49756.9619782, -49756.9619782, -166591.3940102}, 0.0022069659},
              {{0.004, -0.005, -0.0052}, {-41425.2461946, -141596.2466596, -141596.2466596}, 0.0029049913},
              {{0.01, 0.009, 0.008}, {8660.2540378, 8660.2540378, 8660.2540378}, 0.263123062}};
  static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  const rock of = with(0.3, 30.0, 5.0, 5e3);
  path s = open_rock(&of);
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k)
    for (int turn = 0; turn < 6; ++turn) {
      const int *at = order[turn];
      start(&s, 0.0);
      stretch(&s, rows[k].trial[at[0]], rows[k].trial[at[1]], rows[k].trial[at[2]]);
      for (int c = 0; c < 3; ++c) ck_number("tau", s.stress[c] * jacobian_of(&s), rows[k].tau[at[c]]);
      ck_within("plastic strain", s.state[0], rows[k].plastic, 1e-9);
      ck_within("gap", s.state[1], k == 3 ? 0.027 - 8660.2540378 * 1.2 / 20e6 : 0.0, 1e-12);
    }
  law_material_free(s.material);
}
END_TEST

START_TEST(simple_shear) {
  const rock of = with(0.3, 30.0, 5.0, 5e3), tresca = with(0.49, 0.0, 0.0, 1e4);
  path s = open_rock(&of);
  start(&s, -1e5);
  shear(&s, 0.05, 1);
  static const double once[4] = {-162719.06884, -167056.41351, -138932.64471, 86746.89344};
  static const double rate[4] = {-164002.566, -165784.426, -138936.098, 86772.3014};
  for (int c = 0; c < 4; ++c) ck_within("one step", s.stress[c], once[c], 1e-5);
  ck_within("plastic strain", s.state[0], 0.033527458, 1e-9);
  start(&s, -1e5);
  shear(&s, 0.05, 1000);
  for (int c = 0; c < 4; ++c) ck_within("many steps", s.stress[c], rate[c], 1e-3);
  law_material_free(s.material);
  s = open_rock(&tresca);
  start(&s, 0.0);
  shear(&s, 0.05, 100);
  ck_within("shear strength", s.stress[3], 9999.984862, 1e-6);
  law_material_free(s.material);
}
END_TEST

/* In triaxial compression tan^2(45 + phi/2) times the stress across and 2 c cos phi / ((1 - sin phi) J). */
START_TEST(triaxial_strength) {
  const rock of = with(0.3, 30.0, 5.0, 5e3);
  path s = open_rock(&of);
  start(&s, -1e5);
  triaxial(&s, -0.05, 20);
  const double J = jacobian_of(&s);
  ck_within("ln J", mpmi_ln(J), 0.0030883692, 1e-9);
  ck_within("axial stress", s.stress[2], -(3e5 + 2.0 * 5e3 * sqrt(3.0) / J), 1e-8 * 3e5);
  law_material_free(s.material);
}
END_TEST

/* A soil without cohesion that is compressed along one axis ends at Rankine's coefficient of active
 * pressure. */
START_TEST(oedometer) {
  const rock of = with(0.2, 30.0, 0.0, 0.0);
  path s = open_rock(&of);
  start(&s, 0.0);
  for (int k = 0; k < 20; ++k) stretch(&s, 0.0, 0.0, -0.005);
  ck_within("K0", s.stress[0] / s.stress[2], 1.0 / 3.0, 1e-12);
  ck_within("K0", s.stress[1] / s.stress[2], 1.0 / 3.0, 1e-12);
  law_material_free(s.material);
}
END_TEST

/* Hardening and softening in plane flow follow the cohesion, and stop at the residual; the apex moves with
 * it. */
START_TEST(cohesion_changes) {
  static const double slope[4] = {2e5, -1e5, -1e6, 3e5};
  for (int k = 0; k < 4; ++k) {
    rock of = with(0.3, 30.0, 5.0, 5e3);
    of.value[H].value = slope[k];
    of.value[RES].value = 2e3;
    path s = open_rock(&of);
    start(&s, 0.0);
    if (k < 3) stretch(&s, 0.004, -0.001, -0.008);
    if (k == 3) stretch(&s, 0.002, 0.0015, 0.001);
    const double J = jacobian_of(&s), c = fmax(5e3 + slope[k] * s.state[0], 2e3), root = sqrt(3.0);
    ck_assert(s.state[0] > 0.0 && (c > 2e3) == (k != 2));
    const double volume = 0.0045 - root * c * 3.0 / (20e6 / 0.4); /* what opens in the last of them */
    if (k < 3) ck_within("yield", J * (1.5 * s.stress[0] - 0.5 * s.stress[2]), root * c, 1e-8 * c);
    for (int a = 0; k == 3 && a < 3; ++a) ck_within("apex", J * s.stress[a], root * c, 1e-8 * c);
    ck_within("gap", s.state[1], k == 3 ? volume : 0.0, 1e-12);
    const double strain = volume * 0.5 * root / mpmi_sin(5.0 * 3.14159265358979323846 / 180.0);
    if (k == 3) ck_within("plastic strain", s.state[0], strain, 1e-9);
    law_material_free(s.material);
  }
}
END_TEST

/* What opens at the apex is plastic, whatever the angle: rounding leaves no room for a deviator there. */
START_TEST(apex_of_all_angles) {
  static const double degree = 3.14159265358979323846 / 180.0;
  for (int k = 1; k < 60; ++k) {
    const double phi = 1.03 * k, psi = 0.4 * phi;
    const rock of = with(0.3, phi, psi, 300.0);
    path s = open_rock(&of);
    start(&s, 0.0);
    stretch(&s, 0.01, 0.009, 0.008);
    const double tip = 300.0 * mpmi_cos(phi * degree) / mpmi_sin(phi * degree),
                 open = 0.027 - tip * 1.2 / 20e6;
    for (int c = 0; c < 3; ++c) ck_within("tau", jacobian_of(&s) * s.stress[c], tip, 1e-6);
    ck_within("gap", s.state[1], open, 1e-12);
    ck_number("plastic strain", s.state[0], open * mpmi_cos(phi * degree) / mpmi_sin(psi * degree));
    law_material_free(s.material);
  }
}
END_TEST

/* Without friction there is no apex: what is left without cohesion is a fluid that keeps its pressure, on
 * every instruction set. */
START_TEST(without_friction) {
  for (int32_t isa = MPM_ISA_BASELINE; isa <= MPM_ISA_NEON; ++isa)
    for (int32_t which = 0; which < 3; ++which) {
      rock of = with(0.3, 0.0, 0.0, which == 1 ? 1e3 : 0.0);
      uint64_t seed = 32;
      if (which == 1) of.value[H].value = -2e5;
      if (which == 2) of.value[T].value = 0.0;
      path s = {.F = {0}};
      s.material = law_material(isa, "mohr_coulomb", of.value, PARAMS);
      for (int32_t k = 0; s.material && k < 300; ++k) {
        const tensor g = random_tensor(&seed, 3, 1e-2L);
        double F_inc[9];
        for (int c = 0; c < 9; ++c) F_inc[c] = (double)((c % 4 == 0) + g.m[c / 3][c % 3]);
        start(&s, -1e6);
        s.state[0] = 1.0; /* soft by now */
        advance(&s, F_inc);
        const double J = jacobian_of(&s), p = 1e6 - 20e6 / 1.2 * mpmi_ln(J);
        for (int c = 0; c < 6; ++c) ck_within("stress", J * s.stress[c], c < 3 ? -p : 0.0, 1e-8 * p);
      }
      if (s.material) law_material_free(s.material);
    }
}
END_TEST

/* An apex that hardens moves up to the cut-off, and no further; nor does the plastic strain. */
START_TEST(apex_meets_the_cut_off) {
  rock of = with(0.3, 30.0, 5.0, 5e3);
  of.value[H].value = 3e5;
  of.value[T].value = 9e3;
  path s = open_rock(&of);
  start(&s, 0.0);
  stretch(&s, 0.002, 0.0015, 0.001);
  for (int c = 0; c < 3; ++c) ck_number("tau", jacobian_of(&s) * s.stress[c], 9e3);
  ck_within("plastic strain", s.state[0], (9e3 / sqrt(3.0) - 5e3) / 3e5, 1e-12);
  ck_within("gap", s.state[1], 0.0045 - 9e3 * 1.2 / 20e6, 1e-12);
  for (int c = 0; c < 81; ++c) {
    const int i = c / 27, j = c / 9 % 3, k = c / 3 % 3, l = c % 3;
    const double wanted = -9e3 * ((i == k && j == l) + (i == l && j == k));
    ck_within("tangent", s.tangent[c], wanted, 1e-4);
  }
  law_material_free(s.material);
}
END_TEST

/* What has opened closes before it bears, and opens the plastic strain once only. */
START_TEST(gaps_close) {
  const rock of = with(0.3, 30.0, 5.0, 1e3);
  const double bulk = 20e6 / 1.2, tip = 1e3 * sqrt(3.0);
  path s = open_rock(&of);
  start(&s, -1e4);
  stretch(&s, 0.004, 0.004, 0.004);
  const double plastic = s.state[0], gap = s.state[1];
  ck_within("gap", gap, 0.012 - (1e4 + tip) / bulk, 1e-12);
  stretch(&s, 0.0, 0.0, 0.0);
  ck_within("plastic strain", s.state[0], plastic, 1e-13);
  ck_within("gap", s.state[1], gap, 1e-13);
  stretch(&s, -0.003, -0.003, -0.003);
  ck_within("gap", s.state[1], gap - 0.009, 1e-12);
  ck_within("tension", jacobian_of(&s) * s.stress[0], tip, 1e-6);
  ck_within("plastic strain", s.state[0], plastic, 1e-13);
  stretch(&s, -0.002, -0.002, -0.002);
  ck_within("pressure", jacobian_of(&s) * s.stress[0], -1e4 - bulk * 0.003, 1e-6);
  ck_assert(s.state[1] == 0.0);
  law_material_free(s.material);
}
END_TEST

/* Beyond the cut-off the mean stress is the cut-off, and the deviator is on the surface if it was beyond. */
START_TEST(cut_off) {
  rock of = with(0.3, 30.0, 10.0, 5e3);
  of.value[T].value = 2e3;
  path s = open_rock(&of);
  start(&s, 0.0);
  stretch(&s, 0.001, 0.001, 0.001);
  for (int c = 0; c < 3; ++c) ck_number("tau", jacobian_of(&s) * s.stress[c], 2e3);
  ck_within("gap", s.state[1], 0.003 - 2e3 * 1.2 / 20e6, 1e-12);
  static const double trials[3][3] = {
      {0.004, 0.001, -0.001}, {0.004, 0.00399, -0.001}, {0.004, -0.0009, -0.00095}};
  for (int k = 0; k < 3; ++k) {
    start(&s, 0.0);
    stretch(&s, trials[k][0], trials[k][1], trials[k][2]);
    const double J = jacobian_of(&s), *t = s.stress;
    ck_within("mean", J * (t[0] + t[1] + t[2]), 6e3, 1e-7);
    ck_within("yield", J * (1.5 * t[0] - 0.5 * t[2]), sqrt(3.0) * 5e3, 1e-7);
    ck_assert(t[0] >= t[1] && t[1] >= t[2]);
    ck_assert((k == 1) == (t[0] == t[1]) && (k == 2) == (t[1] == t[2]));
    ck_assert(s.state[0] > 0.0 && s.state[1] > 0.0);
  }
  law_material_free(s.material);
}
END_TEST

START_TEST(parameters_go_together) {
  static const struct {
    int which;
    double value;
    const char *text;
  } rows[] = {{PSI, 31.0, "psi must not be larger than phi"},
              {RES, 5001.0, "cohesion_residual must not be larger"},
              {H, -1.5e7, "hardening is so negative"},
              {PHI, 90.0, "phi = 90"},
              {T, -1.0, "tension_cutoff"},
              {CLOSE, 0.5, "close_gaps"}};
  mpm_context *context = context_with(1, MPM_ISA_BEST, NULL);
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    rock of = with(0.3, 30.0, 5.0, 5e3);
    mpm_material *m;
    of.value[rows[k].which].value = rows[k].value;
    ck_refused(context, mpm_material_create(context, "mohr_coulomb", of.value, PARAMS, &m), MPM_E_ARG,
               rows[k].text);
    ck_assert_ptr_null(m);
  }
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* ---- random states ------------------------------------------------------------------------------------- */
enum { RANDOM = 100000, TESTED = 3000 };

static rock random_rock(uint64_t *seed) {
  static const double angles[] = {0.0, 1e-3, 20.0, 30.0, 35.0, 45.0};
  const double phi = angles[(int)wide(seed, 0.0, 5.999)], pick = wide(seed, 0.0, 3.0);
  rock of = with(wide(seed, 0.1, 0.45), phi, wide(seed, 0.0, phi), wide(seed, 0.0, 2e4));
  if (pick > 1.0) of.value[T].value = wide(seed, 0.0, 2e4);
  if (pick > 2.0) of.value[H].value = wide(seed, -2e5, 2e5);
  of.value[RES].value = 0.3 * of.value[C].value;
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
  s->state[1] = fmax(wide(seed, -0.01, 0.01), 0.0);
}

/* Where a step has ended. */
enum { ELASTIC, PLANE, EDGE_12, EDGE_23, CUT, APEX, REGIMES };
static void sorted(const path *s, double *t) {
  const double J = jacobian_of(s);
  tensor x;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) x.m[i][j] = J * s->stress[mpmi_sym_index(i, j)];
  diagonalise(&x);
  for (int k = 0; k < 3; ++k) t[k] = (double)x.m[k][k];
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 2; ++l)
      if (t[l] < t[l + 1]) {
        const double keep = t[l];
        t[l] = t[l + 1];
        t[l + 1] = keep;
      }
}
static int32_t regime_of(const path *from, const path *to) {
  double t[3];
  sorted(to, t);
  const double near = 1e-9 * (fabs(t[0]) + fabs(t[2]) + 1e3);
  const int32_t edge_12 = t[0] - t[1] < near, edge_23 = t[1] - t[2]<near, opens = to->state[1]> 0.0;
  if (opens)
    return edge_12 && edge_23              ? APEX
           : to->state[0] > from->state[0] ? CUT + 8 * edge_12 + 16 * edge_23
                                           : CUT + 32;
  if (!(to->state[0] > from->state[0])) return ELASTIC;
  return edge_12 ? EDGE_12 : edge_23 ? EDGE_23 : PLANE;
}

/* The trial is that of a rock which bears everything. */
START_TEST(random_states_yield) {
  static const double degree = 3.14159265358979323846 / 180.0;
  uint64_t seed = 27;
  int32_t seen[REGIMES] = {0}, took = 0;
  for (int32_t round = 0; round < RANDOM / 500; ++round) {
    const rock of = random_rock(&seed);
    const double sine = sin(of.value[PHI].value * degree), cosine = cos(of.value[PHI].value * degree);
    rock firm = with(of.value[1].value, 0.0, 0.0, 1e100);
    path s = open_rock(&of), trial = open_rock(&firm);
    const double E = of.value[0].value, nu = of.value[1].value;
    for (int32_t k = 0; k < 500; ++k) {
      double F_inc[9], t[3], digits;
      random_step(&seed, &s, F_inc);
      const path from = s;
      path_like(&trial, &s);
      advance(&s, F_inc);
      advance(&trial, F_inc);
      const double lost = dissipated(&s, &trial, E / (2 + 2 * nu), E / (3 - 6 * nu), &digits);
      ck_holds(lost >= -digits);
      took += lost > digits;
      sorted(&s, t);
      const double slope = of.value[H].value,
                   before = fmax(of.value[C].value + slope * from.state[0], of.value[RES].value);
      const double now = fmax(of.value[C].value + slope * s.state[0], of.value[RES].value);
      const double scale = 1e-11 * (fabs(t[0]) + fabs(t[2]) + 1e5), mean = (t[0] + t[1] + t[2]) / 3.0;
      const double f = (1.0 + sine) * t[0] - (1.0 - sine) * t[2];
      const int32_t regime = regime_of(&from, &s) % 8;
      ck_holds(f <= 2.0 * cosine * (regime >= CUT ? fmax(before, now) : now) + scale);
      ck_holds(mean <= of.value[T].value + scale);
      ck_holds(s.state[0] >= from.state[0] && s.state[1] >= 0.0 && s.energy >= 0.0 && s.wave > 0.0);
      if (regime == PLANE || regime == EDGE_12 || regime == EDGE_23)
        ck_within("yield", f, 2.0 * cosine * now, scale);
      if (regime == APEX) ck_within("apex", mean, fmin(of.value[T].value, now * cosine / sine), scale * 1e2);
      ++seen[regime];
    }
    law_material_free(s.material);
    law_material_free(trial.material);
  }
  for (int k = 0; k < REGIMES; ++k) ck_assert_int_gt(seen[k], RANDOM / 200);
  ck_assert_int_gt(took, RANDOM / 2);
}
END_TEST

START_TEST(random_tangents) {
  uint64_t seed = 28;
  int32_t compared[64] = {0}, all = 0;
  double worst = 0.0;
  for (int32_t k = 0; k < TESTED; ++k) {
    const rock of = random_rock(&seed);
    path s = open_rock(&of), end;
    double F_inc[9];
    int32_t smooth;
    random_step(&seed, &s, F_inc);
    end = s;
    advance(&end, F_inc);
    const double off = tangent_off(&s, F_inc, regime_of, &smooth) / 4e7;
    if (smooth) {
      worst = fmax(worst, off);
      ++compared[regime_of(&s, &end)];
      ++all;
    }
    law_material_free(s.material);
  }
  ck_assert_int_gt(all, TESTED * 8 / 10);
  for (int k = 0; k < REGIMES; ++k) ck_assert_int_gt(compared[k], 10);
  ck_between("tangent", worst, 0.0, 1e-8);
}
END_TEST

static path draw(uint64_t *seed, double *F_inc) {
  const rock of = random_rock(seed);
  path s = open_rock(&of);
  random_step(seed, &s, F_inc);
  return s;
}

START_TEST(frames) {
  ck_frames(draw, 29);
}
END_TEST

START_TEST(dimensions) {
  static const double gap[2] = {0.0, 1e-3};
  const rock of = with(0.3, 30.0, 10.0, 2e3);
  ck_dimensions(_i, "mohr_coulomb", of.value, PARAMS, 0.0L, 3e4L, gap, 30);
}
END_TEST

/* All angles of friction and dilation on every instruction set, with principal values that are equal or
 * nearly so. */
START_TEST(axes_alike) {
  static const double apart[] = {0.0, 1e-15, 1e-12, 1e-9, 1e-6};
  for (int32_t isa = MPM_ISA_BASELINE; isa <= MPM_ISA_NEON; ++isa) {
    const rock of = with(0.3, 30.0, 5.0, 5e3);
    path s = {.F = {0}};
    uint64_t seed = 31;
    s.material = law_material(isa, "mohr_coulomb", of.value, PARAMS);
    for (size_t k = 0; s.material && k < 4 * sizeof apart / sizeof *apart; ++k) {
      const double d = apart[k / 4];
      const tensor q = random_rotation(&seed, 3), e = {{{k % 2 ? 0.003L : -0.004L, 0, 0},
                                                        {0, k % 2 ? -0.004L : 0.003L, 0},
                                                        {0, 0, (k % 2 ? -0.004L : 0.003L) + d}}};
      const tensor f = multiply(q, multiply(combine(1, identity(), 1, e), transpose(q)));
      double F_inc[9], t[3];
      for (int c = 0; c < 9; ++c) F_inc[c] = (double)f.m[c / 3][c % 3];
      start(&s, -1e4);
      advance(&s, F_inc);
      sorted(&s, t);
      ck_within("yield", 1.5 * t[0] - 0.5 * t[2], sqrt(3.0) * 5e3, 1e-6);
      ck_within("edge", k % 2 ? t[1] - t[2] : t[0] - t[1], 0.0, 1e-6);
      for (int c = 0; c < 81; ++c) ck_holds(fabs(s.tangent[c]) < 4e7);
    }
    if (s.material) law_material_free(s.material);
  }
}
END_TEST

/* Where all principal values are equal, their rounded mean may differ from them by a digit. */
START_TEST(blown_up) {
  const rock of = with(0.3, 30.0, 5.0, 5e3);
  path s = open_rock(&of);
  for (int k = 0; k < 300; ++k) {
    const double by = mpmi_ln(8.0 + 0.25 * k);
    start(&s, -1e4);
    stretch(&s, by, by, by);
    for (int c = 0; c < 3; ++c) ck_number("apex", jacobian_of(&s) * s.stress[c], 5e3 * sqrt(3.0));
    for (int c = 0; c < 81; ++c) ck_holds(isfinite(s.tangent[c]));
  }
  law_material_free(s.material);
}
END_TEST

Suite *mohr_coulomb_suite(void) {
  Suite *suite = suite_create("mohr_coulomb");
  TCase *tc = tcase_create("mohr_coulomb");
  tcase_set_timeout(tc, 60.0);
  tcase_add_test(tc, planes_edges_and_apex);
  tcase_add_test(tc, simple_shear);
  tcase_add_test(tc, triaxial_strength);
  tcase_add_test(tc, oedometer);
  tcase_add_test(tc, cohesion_changes);
  tcase_add_test(tc, without_friction);
  tcase_add_test(tc, apex_of_all_angles);
  tcase_add_test(tc, apex_meets_the_cut_off);
  tcase_add_test(tc, gaps_close);
  tcase_add_test(tc, cut_off);
  tcase_add_test(tc, parameters_go_together);
  tcase_add_test(tc, random_states_yield);
  tcase_add_test(tc, random_tangents);
  tcase_add_test(tc, frames);
  tcase_add_loop_test(tc, dimensions, 0, LAW_LOOPS);
  tcase_add_test(tc, axes_alike);
  tcase_add_test(tc, blown_up);
  suite_add_tcase(suite, tc);
  return suite;
}
