/* cam_clay: numbers of an independent program, closed forms, random states against the equations that
 * define a return, what is refused. */
#include "law_path.h"
#include "simd/elementary.h"
#include "simd/tensor.h"

enum { DENSITY, KAPPA, LAMBDA, M, MU, ALPHA, P_REF, PC0, P_MIN, PARAMS };
typedef struct mud {
  mpm_param value[PARAMS];
} mud;
enum { PC, GAP };

static mud with(double mu0, double alpha, double pc0) {
  return (mud){{{"density", 2e3},
                {"kappa", 0.02},
                {"lambda", 0.12},
                {"M", 1.05},
                {"mu0", mu0},
                {"alpha", alpha},
                {"p_ref", 1e5},
                {"pc0", pc0},
                {"p_min", 0.0}}};
}
static path open_clay(const mud *of) {
  return path_of("cam_clay", of->value, PARAMS);
}

/* Begins with p = 100 kPa. */
static path begun(const mud *of) {
  path s = open_clay(of);
  start(&s, -1e5);
  return s;
}

/* ---- numbers and closed forms -------------------------------------------------------------------------- */
/* On the normal compression line ln p falls by 1/lambda with ln J. */
START_TEST(isotropic_compression) {
  const mud of = with(4e6, 0.0, 2e5);
  path s = begun(&of);
  for (int k = 0; k < 10; ++k) stretch(&s, -0.01 / 3.0, -0.01 / 3.0, -0.01 / 3.0);
  const double pc = 2e5 * mpmi_exp((0.1 - 0.02 * mpmi_ln(2.0)) / 0.12);
  ck_number("pc", s.state[PC], 409987.294333649);
  ck_within("pc", s.state[PC], pc, 1e-12 * pc);
  ck_number("p", -(s.stress[0] + s.stress[1] + s.stress[2]) / 3.0, 453106.034478069);
  for (int c = 0; c < 3; ++c) ck_within("p", -s.stress[c], pc * mpmi_exp(0.1), 1e-12 * pc);
  for (int c = 3; c < 6; ++c) ck_within("shear", s.stress[c], 0.0, 1e-9);
  law_material_free(s.material);
}
END_TEST

static invariants undrained(double pc, double axial, int32_t steps) {
  const mud of = with(4e6, 0.0, pc);
  path s = begun(&of);
  for (int32_t k = 0; k < steps; ++k) stretch(&s, 0.5 * axial / steps, 0.5 * axial / steps, -axial / steps);
  law_material_free(s.material);
  return invariants_of(&s);
}

/* Without drainage the end is the critical state at p0 (OCR / 2)^((lambda - kappa) / lambda). */
START_TEST(without_drainage) {
  invariants o = undrained(100010.0, 0.3, 20);
  ck_number("p", o.p, 56127.8300386);
  ck_number("q", o.q, 58934.1576120);
  ck_within("critical p", o.p, 56127.7793, 1.0);
  ck_within("critical q", o.q, 58934.1683, 1.0);
  o = undrained(5e5, 0.3, 20);
  ck_number("p", o.p, 214592.820521);
  ck_number("q", o.q, 225323.386653);
  ck_within("critical p", o.p, 214593.5547, 5.0);
  ck_within("critical q", o.q, 225323.2325, 5.0);
  o = undrained(1.5e5, 0.02, 4);
  ck_number("p", o.p, 87526.4907026);
  ck_number("q", o.q, 80121.4032563);
  o = undrained(1.5e5, 0.02, 4000);
  ck_within("p", o.p, 86393.300, 1e-3);
  ck_within("q", o.q, 80514.314, 1e-3);
}
END_TEST

START_TEST(oedometer) {
  const mud of = with(4e6, 0.0, 1.2e5);
  path s = begun(&of);
  for (int k = 0; k < 10; ++k) stretch(&s, 0.0, 0.0, -0.02);
  ck_number("axial", s.stress[2], -849257.920164);
  ck_number("lateral", s.stress[0], -618045.829994);
  ck_number("pc", s.state[PC], 626225.093537);
  start(&s, -1e5);
  for (int k = 0; k < 2000; ++k) stretch(&s, 0.0, 0.0, -1e-4);
  ck_within("axial", s.stress[2], -849039.3460, 5.0);
  ck_within("lateral", s.stress[0], -619503.3192, 20.0);
  ck_within("pc", s.state[PC], 626063.2744, 5.0);
  law_material_free(s.material);
}
END_TEST

/* At the strain where it yields a step that is a little shorter leaves pc, one that is a little longer
 * does not. */
START_TEST(yields_where_it_should) {
  const mud of = with(4e6, 0.0, 1.2e5);
  const double at = 0.00292037356;
  for (int k = 0; k < 2; ++k) {
    path s = begun(&of);
    stretch(&s, 0.0, 0.0, -at * (k ? 1.0 + 1e-6 : 1.0 - 1e-6));
    ck_assert(k ? s.state[PC] > 1.2e5 : s.state[PC] == 1.2e5);
    law_material_free(s.material);
  }
}
END_TEST

START_TEST(shear_that_couples) {
  static const double wanted[4] = {-81641.0627291, -83115.7343646, 0.0, 48470.9114229};
  const mud of = with(1e6, 50.0, 1.5e5);
  path s = begun(&of);
  shear(&s, 0.1, 10);
  for (int c = 0; c < 4; ++c)
    if (c != 2) ck_number("stress", s.stress[c], wanted[c]);
  ck_number("pc", s.state[PC], 160001.710534);
  law_material_free(s.material);
}
END_TEST

/* Drained compression ends at the critical state, where the stress across is held: q = M p. */
START_TEST(drained_critical_state) {
  const mud of = with(4e6, 0.0, 1.2e5);
  path s = begun(&of);
  triaxial(&s, -0.9, 300);
  const invariants o = invariants_of(&s);
  ck_within("q/p", o.q / o.p, 1.05, 2e-3);
  ck_within("axial", s.stress[2], -1e5 * (1.0 + 3.0 * 1.05 / (3.0 - 1.05)), 700.0);
  law_material_free(s.material);
}
END_TEST

/* ---- elasticity ---------------------------------------------------------------------------------------- */
/* A closed path of strain inside of the yield surface gives stress and energy back. */
START_TEST(elastic_cycles) {
  static const double legs[4][2] = {{0.002, 0.001}, {-0.004, 0.002}, {-0.001, -0.004}, {0.003, 0.001}};
  for (int k = 0; k < 2; ++k) {
    const mud of = with(k ? 1e6 : 4e6, k ? 50.0 : 0.0, 1e7);
    path s = begun(&of);
    stretch(&s, 0.0, 0.0, 0.0);
    const path at = s;
    double most = 0.0;
    for (int round = 0; round < 5; ++round)
      for (int leg = 0; leg < 4; ++leg)
        for (int step = 0; step < 10; ++step) {
          stretch(&s, legs[leg][0] / 10.0, -0.5 * legs[leg][0] / 10.0, legs[leg][1] / 10.0);
          most = fmax(most, fabs(s.energy - at.energy));
        }
    ck_assert(most > 10.0 && s.state[PC] == 1e7 && s.state[GAP] == 0.0);
    for (int c = 0; c < 6; ++c) ck_within("stress", s.stress[c], at.stress[c], 1e-11 * 1e5);
    ck_within("energy", s.energy, at.energy, 1e-10 * most);
    law_material_free(s.material);
  }
}
END_TEST

/* The energy is what the stress has done, by Simpson's rule on straight paths of the logarithmic strain. */
START_TEST(energy_is_work) {
  const mud of = with(1e6, 50.0, 1e7);
  path s = begun(&of);
  stretch(&s, 0.0, 0.0, 0.0);
  const double before = s.energy, d[3] = {0.001, -0.004, -0.003};
  double work = 0.0;
  for (int k = 0; k <= 200; ++k) {
    const double J = jacobian_of(&s), weight = k == 0 || k == 200 ? 1.0 : k % 2 ? 4.0 : 2.0;
    for (int a = 0; a < 3; ++a) work += weight / 600.0 * J * s.stress[a] * d[a];
    if (k < 200) stretch(&s, d[0] / 200.0, d[1] / 200.0, d[2] / 200.0);
  }
  ck_within("work", s.energy - before, work, 1e-7 * fabs(work));
  law_material_free(s.material);
}
END_TEST

/* ---- tension ------------------------------------------------------------------------------------------- */
/* The pressure does not fall below p_min; what has opened closes before it rises. */
START_TEST(opens_and_closes) {
  mud of = with(4e6, 0.0, 2e5);
  for (int k = 0; k < 3; ++k) {
    const double least = k == 1 ? 5e3 : 200.0, elastic = 0.02 * mpmi_ln(1e5 / least);
    of.value[P_MIN].value = k == 1 ? least : 0.0;
    of.value[PC0].value = k == 2 ? 0.0 : 2e5;
    path s = begun(&of);
    s.state[PC] = 2e5;
    stretch(&s, 0.1, 0.1, 0.1);
    ck_within("gap", s.state[GAP], 0.3 - elastic, 1e-12);
    for (int c = 0; c < 3; ++c) ck_within("least", -jacobian_of(&s) * s.stress[c], least, 1e-9 * least);
    stretch(&s, 0.0, 0.0, 0.0);
    ck_within("gap", s.state[GAP], 0.3 - elastic, 1e-12);
    stretch(&s, -0.05, -0.05, -0.05);
    ck_within("gap", s.state[GAP], 0.15 - elastic, 1e-12);
    ck_within("least", -jacobian_of(&s) * s.stress[0], least, 1e-9 * least);
    stretch(&s, -0.05, -0.05, -0.05);
    ck_assert(s.state[GAP] == 0.0);
    for (int c = 0; c < 3; ++c) ck_within("as it was", s.stress[c], -1e5, 1e-9 * 1e5);
    ck_number("pc", s.state[PC], 2e5);
    law_material_free(s.material);
  }
}
END_TEST

/* ---- what is refused ----------------------------------------------------------------------------------- */
START_TEST(parameters_are_checked) {
  static const struct {
    int which;
    double value;
    const char *text;
  } rows[] = {{KAPPA, 0.0, "kappa = 0"},
              {KAPPA, 0.12, "kappa must be smaller than lambda"},
              {LAMBDA, 1.0, "lambda = 1, but it must be above 0 and below 1"},
              {LAMBDA, 0.0, "lambda = 0"},
              {M, 0.0, "M = 0"},
              {M, 3.0, "M = 3, but it must be above 0 and below 3"},
              {MU, -1.0, "mu0 = -1"},
              {MU, 0.0, "mu0 and alpha must not both be 0"},
              {ALPHA, -1.0, "alpha = -1"},
              {P_REF, 0.0, "p_ref = 0"},
              {PC0, -1.0, "pc0 = -1"},
              {P_MIN, -1.0, "p_min = -1"},
              {P_MIN, 1.1e5, "p_min must not be larger than pc0 / 2"},
              {DENSITY, 0.0, "density = 0"}};
  mpm_context *context = context_with(1, MPM_ISA_BEST, NULL);
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    mud of = with(4e6, 0.0, 2e5);
    mpm_material *m;
    of.value[rows[k].which].value = rows[k].value;
    ck_refused(context, mpm_material_create(context, "cam_clay", of.value, PARAMS, &m), MPM_E_ARG,
               rows[k].text);
    ck_assert_ptr_null(m);
  }
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Without grid: stress and pc must be there, and a particle that is refused leaves all as it was. */
START_TEST(stress_and_pc_must_be_given) {
  static const double same[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  mud of = with(4e6, 0.0, 0.0);
  path s = open_clay(&of);
  for (int k = 0; k < 4; ++k) {
    start(&s, k == 0 ? 0.0 : k == 1 ? 1e3 : -1e5);
    s.state[PC] = k < 2 ? 1e5 : k == 2 ? 0.0 : -1.0;
    const path before = s;
    ck_refused(s.material->context, attempt(&s, same), MPM_E_STATE,
               k < 2 ? "cam_clay needs an initial stress" : "cam_clay needs a preconsolidation pressure");
    ck_assert_ptr_nonnull(strstr(mpm_last_error(s.material->context), "id 0"));
    ck_assert_mem_eq(&before, &s, sizeof s);
  }
  start(&s, -1e5);
  s.state[PC] = 1e5;
  advance(&s, same);
  law_material_free(s.material);
}
END_TEST

/* With alpha the elasticity bears shear up to where its energy is convex: q = sqrt(3/2 alpha kappa) p for
 * mu0 = 0. */
START_TEST(shear_out_of_reach) {
  static const double same[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const mud of = with(0.0, 50.0, 1e7);
  path s = open_clay(&of);
  for (int k = 0; k < 2; ++k) {
    const double q = 1e5 * sqrt(1.5 * 50.0 * 0.02) * (k ? 1.001 : 0.999);
    start(&s, -1e5);
    s.stress[0] -= 2.0 / 3.0 * q, s.stress[1] += q / 3.0, s.stress[2] += q / 3.0;
    if (k)
      ck_refused(s.material->context, attempt(&s, same), MPM_E_STATE, "bears no such shear stress");
    else
      advance(&s, same);
  }
  law_material_free(s.material);
}
END_TEST

/* A strain so far beyond kappa that stresses, or their squares, are no numbers asks for a smaller step. */
START_TEST(strain_out_of_range) {
  const mud of = with(4e6, 0.0, 1e8);
  path s = begun(&of);
  const path before = s;
  for (int k = 1; k <= 35; ++k) {
    const double by = mpmi_exp(-0.3 * k), F_inc[9] = {by, 0, 0, 0, by, 0, 0, 0, by};
    if (k > 30 || attempt(&s, F_inc))
      ck_refused(s.material->context, attempt(&s, F_inc), MPM_CUT_DT,
                 "not come back to its yield surface at id 0");
    else
      s = before;
    ck_assert_mem_eq(&before, &s, sizeof s);
  }
  law_material_free(s.material);
}
END_TEST

/* ---- random states against the equations --------------------------------------------------------------- */
enum { TESTED = 3000 };

/* coupled: alpha is large enough for the whole of the yield surface near the critical state. */
static mud random_clay(uint64_t *seed, int32_t coupled) {
  mud of = with(wide(seed, 1e6, 1e7), 0.0, 0.0);
  of.value[KAPPA].value = wide(seed, 0.005, 0.03);
  of.value[LAMBDA].value = wide(seed, 0.05, 0.2);
  of.value[M].value = wide(seed, 0.8, 1.4);
  if (wide(seed, 0.0, 1.0) < 0.3) { /* stiff */
    of.value[KAPPA].value = 0.005;
    of.value[LAMBDA].value = 0.15;
    of.value[M].value = 1.4;
    of.value[MU].value = 8e6;
  }
  const double slope = of.value[M].value;
  if (coupled) of.value[ALPHA].value = wide(seed, 1.0, 2.0) * slope * slope / of.value[KAPPA].value;
  return of;
}

/* A stress on or within the yield surface, and a step with an F_inc - I of a size. */
static void random_step(uint64_t *seed, const mud *of, double size, path *s, double *F_inc) {
  const double p = mpmi_exp(wide(seed, mpmi_ln(1e4), mpmi_ln(1e6))),
               pc = p * mpmi_exp(wide(seed, 0.01, mpmi_ln(20.0)));
  const tensor g = random_tensor(seed, 3, size);
  tensor t = random_stress(seed, 3, 1.0L);
  t = combine(1, t, -trace(t) / 3, identity());
  const double alpha = of->value[ALPHA].value, reach = 0.8 * p * sqrt(1.5 * alpha * of->value[KAPPA].value);
  const double yield = of->value[M].value * sqrt(p * (pc - p));
  const double q = wide(seed, 0.0, alpha > 0.0 ? fmin(reach, yield) : yield);
  const real by = q / sqrtl(1.5L * contract(t, t));
  start(s, -p);
  for (int c = 0; c < 6; ++c) s->stress[c] += (double)(by * t.m[sym_row[c]][sym_column[c]]);
  s->state[PC] = pc;
  for (int c = 0; c < 9; ++c) F_inc[c] = (double)((c % 4 == 0) + g.m[c / 3][c % 3]);
}

/* Elastic strains of a stress: the compression, the shear strain, and X. */
typedef struct strains {
  real v, e, X;
} strains;
static strains strains_of(const mud *of, real p, real q) {
  const real kappa = of->value[KAPPA].value, mu = of->value[MU].value, alpha = of->value[ALPHA].value;
  real X = p;
  for (int k = 0; k < 60; ++k) {
    const real m = mu + alpha * X, B = alpha * q * q / (6 * kappa);
    X -= (X + B * X / (m * m) - p) / (1 + B * (mu - alpha * X) / (m * m * m));
  }
  return (strains){kappa * logl(X / (real)of->value[P_REF].value), q / (3 * (mu + alpha * X)), X};
}

static tensor stress_tensor(const path *s) {
  tensor t;
  const real J = jacobian_of(s);
  for (int c = 0; c < 9; ++c) t.m[c / 3][c % 3] = J * s->stress[mpmi_sym_index(c / 3, c % 3)];
  return t;
}
static void invariants_to(tensor t, real *p, real *q) {
  *p = -trace(t) / 3;
  const tensor d = combine(1, t, *p, identity());
  *q = sqrtl(1.5L * contract(d, d));
}

/* The trial's strains, from the stress before the step and F_inc. */
static strains trial_of(const mud *of, const path *from, const double *F_inc) {
  tensor t = stress_tensor(from), f;
  real p, q;
  invariants_to(t, &p, &q);
  const strains old = strains_of(of, p, q);
  tensor axes = diagonalise(&t), b = {{{0}}};
  const real by = q > 0 ? 1.5L * old.e / q : 0;
  for (int k = 0; k < 3; ++k) b.m[k][k] = expl(2 * (by * (t.m[k][k] + p) - old.v / 3));
  for (int c = 0; c < 9; ++c) f.m[c / 3][c % 3] = F_inc[c];
  b = multiply(f, multiply(turned(axes, b), transpose(f)));
  diagonalise(&b);
  real e[3], volume = 0, square = 0;
  for (int k = 0; k < 3; ++k) e[k] = logl(b.m[k][k]) / 2, volume += e[k];
  for (int k = 0; k < 3; ++k) square += (e[k] - volume / 3) * (e[k] - volume / 3);
  return (strains){-volume - from->state[GAP], sqrtl(2 * square / 3), 0};
}

enum { ELASTIC, WET, DRY, OPEN, REGIMES };
static int32_t regime_of(const path *from, const path *to) {
  if (to->state[GAP] > 0.0) return to->state[PC] < from->state[PC] ? OPEN : OPEN + 8;
  return to->state[PC] > from->state[PC] ? WET : to->state[PC] < from->state[PC] ? DRY : ELASTIC;
}

/* The return by its equations: the gap, yield, normality with one multiplier >= 0, hardening, and
 * dissipation. */
static void ck_return(const mud *of, const path *from, const path *to, const double *F_inc) {
  const real kappa = of->value[KAPPA].value, harden = 1 / (of->value[LAMBDA].value - kappa),
             pc = to->state[PC];
  const real M2 = (real)of->value[M].value * of->value[M].value,
             least = fminl(1e-3L * from->state[PC], 0.5L * from->state[PC]);
  const real lowest = kappa * logl(least / (real)of->value[P_REF].value);
  real p, q;
  strains trial = trial_of(of, from, F_inc);
  invariants_to(stress_tensor(to), &p, &q);
  const strains end = strains_of(of, p, q);
  ck_holds(fabsl(to->state[GAP] - fmaxl(lowest - trial.v, 0)) <= 1e-13L);
  trial.v = fmaxl(trial.v, lowest);
  const real size = q * q / M2 + p * (p + pc), f = q * q / M2 + p * (p - pc);
  ck_holds(f <= 1e-10L * size && to->energy > 0.0 && to->wave > 0.0 && p > 0);
  if (regime_of(from, to) % 8 == ELASTIC || regime_of(from, to) == OPEN + 8) {
    const real digits = 1e-13L * expl(4 * trial.e); /* as the largest value of b goes with the smallest */
    ck_holds(fabsl(end.v - trial.v) <= digits && fabsl(end.e - trial.e) <= digits);
    return;
  }
  ck_holds(f >= -1e-10L * size);
  const real along = 2 * p - pc, across = 2 * q / M2, length = along * along + across * across;
  const real flow = ((trial.v - end.v) * along + (trial.e - end.e) * across) / length;
  ck_holds(flow >= 0);
  ck_holds(fabsl((trial.v - end.v) - flow * along) <= 1e-12L + 1e-9L * flow * sqrtl(length));
  ck_holds(fabsl((trial.e - end.e) - flow * across) <= 1e-12L + 1e-9L * flow * sqrtl(length));
  ck_holds(fabsl(logl(pc / from->state[PC]) - (trial.v - end.v) * harden) <= 1e-11L);
  ck_holds(p * (trial.v - end.v) + q * (trial.e - end.e) >= -1e-12L * p);
}

/* Runs many steps of a size and returns how many have ended without a return. */
static int32_t failures(int32_t coupled, double size, int32_t many, uint64_t seed, int32_t *seen) {
  int32_t failed = 0;
  for (int32_t round = 0; round < many / 500; ++round) {
    const mud of = random_clay(&seed, coupled);
    path s = open_clay(&of);
    for (int32_t k = 0; k < 500; ++k) {
      double F_inc[9];
      random_step(&seed, &of, size, &s, F_inc);
      const path from = s;
      const mpm_status status = attempt(&s, F_inc);
      failed += status == MPM_CUT_DT;
      if (status) {
        ck_refused(s.material->context, status, MPM_CUT_DT, "at id 0");
        ck_assert_mem_eq(&from, &s, sizeof s);
        continue;
      }
      ck_return(&of, &from, &s, F_inc);
      ++seen[regime_of(&from, &s) % 8];
    }
    law_material_free(s.material);
  }
  return failed;
}

START_TEST(random_states) {
  static const struct {
    int32_t coupled, many;
    double size;
  } rows[] = {{0, 35000, 1e-3}, {0, 35000, 1e-2}, {0, 35000, 3e-2}, {0, 5000, 1e-1},
              {0, 5000, 3e-1},  {1, 5000, 1e-3},  {1, 5000, 1e-2}};
  int32_t seen[REGIMES] = {0};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    const int32_t failed = failures(rows[k].coupled, rows[k].size, rows[k].many, 27, seen);
    show("cam_clay%s, increments of %g: %d of %d have no return\n", rows[k].coupled ? " with alpha" : "",
         rows[k].size, (int)failed, (int)rows[k].many);
    if (!rows[k].coupled) ck_assert_int_eq(failed, 0);
    if (rows[k].coupled) ck_assert_int_lt(failed, rows[k].size < 5e-3 ? 10 : rows[k].many / 4);
  }
  for (int k = 0; k < REGIMES; ++k) ck_assert_int_gt(seen[k], 2000);
}
END_TEST

START_TEST(random_tangents) {
  uint64_t seed = 28;
  int32_t compared[OPEN + 9] = {0}, all = 0;
  double worst = 0.0;
  for (int32_t k = 0; k < TESTED; ++k) {
    const mud of = random_clay(&seed, k % 2);
    path s = open_clay(&of), end;
    double F_inc[9], scale = 0.0;
    int32_t smooth;
    random_step(&seed, &of, k % 4 == 0 ? 0.1 : 0.01, &s, F_inc);
    end = s;
    if (!attempt(&end, F_inc)) {
      for (int c = 0; c < 81; ++c) scale = fmax(scale, fabs(end.tangent[c]));
      const double off = tangent_off(&s, F_inc, regime_of, &smooth) / scale;
      if (smooth) worst = fmax(worst, off);
      compared[regime_of(&s, &end)] += smooth;
      all += smooth;
    }
    law_material_free(s.material);
  }
  ck_assert_int_gt(all, TESTED * 7 / 10);
  for (int k = 0; k < REGIMES; ++k) ck_assert_int_gt(compared[k], 100);
  show("cam_clay: tangents off by %g\n", worst);
  ck_between("tangent", worst, 0.0, 1e-8);
}
END_TEST

START_TEST(frames) {
  uint64_t seed = 29;
  for (int32_t k = 0; k < 500; ++k) {
    mud of = random_clay(&seed, 0);
    double F_inc[9];
    of.value[MU].value *= 0.01;
    of.value[P_REF].value *= 0.01;
    path s = open_clay(&of);
    random_step(&seed, &of, 0.01, &s, F_inc);
    for (int c = 0; c < 6; ++c) s.stress[c] *= 0.01;
    s.state[PC] *= 0.01;
    path end = s;
    advance(&end, F_inc);
    for (int c = 0; c < 6; ++c) ck_holds(fabs(end.stress[c]) < 1e7);
    ck_frame(&s, F_inc, &seed);
    law_material_free(s.material);
  }
}
END_TEST

START_TEST(dimensions) {
  static const double state[2] = {2e4, 1e-3};
  const mud of = with(1e6, 0.0, 1e4);
  ck_dimensions(_i, "cam_clay", of.value, PARAMS, -1e4L, 8e3L, state, 30);
}
END_TEST

/* ---- in steps ------------------------------------------------------------------------------------------ */
/* A body that is not under stress is refused before the first step, and so is one without pc; then it is
 * stepped. */
START_TEST(steps) {
  static const mpm_param loose[] = {{"density", 2e3}, {"kappa", 0.02}, {"lambda", 0.12},
                                    {"M", 1.05},      {"mu0", 1e5},    {"p_ref", 1e4}};
  const int32_t dim = 1 + _i % 3, implicit = _i / 3;
  world_desc d = world_default(dim, 6, 0.25);
  d.law = (world_law){.model = "cam_clay", .params = loose, .param_count = 6};
  if (implicit) d.stepper.scheme = MPM_NEWMARK;
  d.stepper.locking_remedy = dim > 1;
  d.stepper.gravity[0] = -0.3;
  world w;
  mpm_particles *set = world_open(&w, &d);
  const double low[3] = {0.5, 0.5, 0.5}, high[3] = {1.0, 1.0, 1.0};
  world_fill(&w, set, low, high, 2);
  double stress[6] = {-1e4, -1e4, -1e4}, state[2] = {1.5e4, 0.0}, dt;
  const uint64_t before = world_hash(&w);
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &w.info), MPM_E_STATE,
             "cam_clay needs an initial stress: the mean pressure must be above 0 at particle ");
  ck_refused(&w, mpm_stable_dt(w.stepper, &dt), MPM_E_STATE, "cam_clay needs an initial stress");
  ck_assert_uint_eq(world_hash(&w), before);
  ck_ok(&w, mpm_particles_set_all(set, "stress", MPM_F64, 6, stress));
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &w.info), MPM_E_STATE,
             "cam_clay needs a preconsolidation pressure");
  ck_ok(&w, mpm_particles_set_all(set, "state", MPM_F64, 2, state));
  ck_ok(&w, mpm_stable_dt(w.stepper, &dt));
  for (int k = 0; k < 10; ++k) world_step(&w, (implicit ? 2.0 : 0.4) * dt);
  ck_assert_int_eq(w.info.removed, 0);
  world_close(&w);
}
END_TEST

/* New particles have pc0. */
START_TEST(starts_with_pc0) {
  const mud of = with(4e6, 0.0, 2e5);
  world_desc d = world_default(2, 6, 0.25);
  d.law = (world_law){.model = "cam_clay", .params = of.value, .param_count = PARAMS};
  world w;
  mpm_particles *set = world_open(&w, &d);
  const double low[2] = {0.5, 0.5}, high[2] = {1.0, 1.0};
  world_fill(&w, set, low, high, 2);
  double *state = fetch(&w, set, "state", 2);
  for (int64_t p = 0; p < mpm_particles_count(set); ++p)
    ck_assert(state[p] == 2e5 && state[mpm_particles_count(set) + p] == 0.0);
  free(state);
  world_close(&w);
}
END_TEST

Suite *cam_clay_suite(void) {
  Suite *suite = suite_create("cam_clay");
  TCase *tc = tcase_create("cam_clay");
  tcase_set_timeout(tc, 120.0);
  tcase_add_test(tc, isotropic_compression);
  tcase_add_test(tc, without_drainage);
  tcase_add_test(tc, oedometer);
  tcase_add_test(tc, yields_where_it_should);
  tcase_add_test(tc, shear_that_couples);
  tcase_add_test(tc, drained_critical_state);
  tcase_add_test(tc, elastic_cycles);
  tcase_add_test(tc, energy_is_work);
  tcase_add_test(tc, opens_and_closes);
  tcase_add_test(tc, parameters_are_checked);
  tcase_add_test(tc, stress_and_pc_must_be_given);
  tcase_add_test(tc, shear_out_of_reach);
  tcase_add_test(tc, strain_out_of_range);
  tcase_add_test(tc, random_states);
  tcase_add_test(tc, random_tangents);
  tcase_add_test(tc, frames);
  tcase_add_loop_test(tc, dimensions, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, steps, 0, 6);
  tcase_add_test(tc, starts_with_pc0);
  suite_add_tcase(suite, tc);
  return suite;
}
