/* Tangents of the built-in laws: against differences of the stress, major symmetry, and
 * frames, on every instruction set and dimension. Limits are tested in tangent_limits.c, laws
 * of the host in tangent_host.c. */
#include "tangent_sample.h"

static const tangent_law laws[] = {
    {"neo_hookean", 3, 1, {{"E", 2.5e6}, {"nu", 0.3}, {"density", 1e3}}},
    {"neo_hookean_decoupled", 3, 1, {{"mu", 1e6}, {"kappa", 7e6}, {"density", 1e3}}},
    {"linear_elastic", 3, 0, {{"E", 2.5e6}, {"nu", 0.25}, {"density", 1e3}}},
    {"j2", 5, 0, {{"E", 2.5e6}, {"nu", 0.25}, {"density", 1e3}, {"yield_stress", 4e4}, {"hardening", 0.0}}},
    {"j2", 5, 0, {{"E", 2.5e6}, {"nu", 0.25}, {"density", 1e3}, {"yield_stress", 4e4}, {"hardening", 3e5}}},
    {"newtonian_fluid", 3, 1, {{"density", 1e3}, {"bulk_modulus", 1e5}, {"gamma", 7.0}}},
    {"newtonian_fluid", 4, 0, {{"density", 1e3}, {"bulk_modulus", 1e5}, {"gamma", 7.0}, {"viscosity", 3e4}}},
    {"newtonian_fluid", 4, 1, {{"density", 1e3}, {"bulk_modulus", 1e5}, {"gamma", 1.0}, {"tension", 0.0}}},
    {"newtonian_fluid",
     5,
     0,
     {{"density", 1e3}, {"bulk_modulus", 1e5}, {"gamma", 3.0}, {"tension", 0.0}, {"viscosity", 3e4}}},
    {"rigid", 1, 1, {{"density", 1e3}}},
};
enum { MODELS = sizeof laws / sizeof laws[0], BATCHES = 8 };

static int32_t is_law(const tangent_law *law, const char *model) {
  return !strcmp(law->model, model);
}
static double param(const tangent_law *law, const char *name, double otherwise) {
  for (int k = 0; k < law->count; ++k)
    if (!strcmp(law->params[k].name, name)) return law->params[k].value;
  return otherwise;
}

/* Whether no kink lies within reach of the differences. */
static int32_t is_smooth(const tangent_law *law, const tangent_batch *b, int32_t dim, int i) {
  if (is_law(law, "j2"))
    return fabsl(tangent_over_yield(b, dim, i, param(law, "hardening", 0.0))) >
           6 * tangent_mu * tangent_reach;
  return param(law, "tension", 1.0) == 1.0 || fabsl(det(sample_F(&b->s, i)) - 1) > 2 * tangent_reach;
}

/* Rows beyond dim and items past the end are not written. */
static void check_untouched(const tangent_batch *b, int32_t dim) {
  for (int row = 0; row < 81; ++row) {
    const int32_t exists = row / 27 < dim && row / 9 % 3 < dim && row / 3 % 3 < dim && row % 3 < dim;
    for (int i = exists ? ITEMS : 0; i < LD; ++i) ck_assert(b->c[row * LD + i] == sample_unset);
  }
}

static void compare_law(const tangent_law *law, int32_t isa, int32_t dim) {
  mpm_material *material = law_material(isa, law->model, law->params, law->count);
  if (!material) return;
  static tangent_batch b;
  static real exact[ITEMS][81];
  uint64_t state = 41;
  real worst = 0, most_odd = 0;
  int32_t compared = 0, regimes[2] = {0, 0};
  for (int k = 0; k < BATCHES; ++k) {
    tangent_fill(&b, &state, dim);
    tangent_run(&b, material, dim);
    check_untouched(&b, dim);
    ck_assert_int_eq(b.symmetric, dim == 1 || law->symmetric);
    tangent_by_differences(&b, material, dim, exact);
    for (int i = 0; i < ITEMS; ++i) {
      real odd, error = tangent_error(&b, dim, i, exact[i], &odd);
      most_odd = fmaxl(most_odd, odd);
      if (!is_smooth(law, &b, dim, i)) continue;
      ck_assert_msg(error <= 1e-9L, "%s, %d-D, item %d: %Lg", law->model, dim, i, error);
      worst = fmaxl(worst, error);
      ++compared;
      if (is_law(law, "j2"))
        ++regimes[tangent_over_yield(&b, dim, i, param(law, "hardening", 0.0)) > 0];
      else
        ++regimes[det(sample_F(&b.s, i)) > 1];
    }
  }
  ck_assert_int_ge(compared, 200);
  ck_assert_int_ge(regimes[0], 20);
  ck_assert_int_ge(regimes[1], 20);
  if (dim > 1)
    ck_assert_msg(law->symmetric ? most_odd <= 1e-15L : most_odd > 1e-3L, "%s: %Lg", law->model, most_odd);
  law_material_free(material);
}

START_TEST(differences) {
  for (int k = 0; k < MODELS; ++k) compare_law(&laws[k], loop_isa(_i), loop_dim(_i));
}
END_TEST

/* c'_ijkl = Q_ia Q_jb Q_kc Q_ld c_abcd, one index after the other. */
static void turn(const tensor *q, int32_t dim, real *c) {
  static const int stride[] = {27, 9, 3, 1};
  for (int index = 0; index < 4; ++index) {
    real next[81];
    for (int row = 0; row < 81; ++row) {
      const int at = row / stride[index] % 3, rest = row - at * stride[index];
      next[row] = 0;
      for (int a = 0; a < dim; ++a) next[row] += q->m[at][a] * c[rest + a * stride[index]];
    }
    memcpy(c, next, sizeof next);
  }
}

/* A step that ends in a turned frame has a turned tangent: F_inc -> Q F_inc with the same past. */
START_TEST(frames) {
  const int32_t isa = loop_isa(_i), dim = loop_dim(_i);
  for (int k = 0; k < MODELS; ++k) {
    mpm_material *material = law_material(isa, laws[k].model, laws[k].params, laws[k].count);
    if (!material) return;
    static tangent_batch plain, other;
    uint64_t state = 42;
    tangent_fill(&plain, &state, dim);
    other = plain;
    sample_clear(&other.s, tangent_dt);
    memcpy(other.s.stress, plain.s.stress, sizeof plain.s.stress);
    memcpy(other.s.state, plain.s.state, sizeof plain.s.state);
    tensor q[ITEMS];
    for (int i = 0; i < ITEMS; ++i) {
      q[i] = random_rotation(&state, dim);
      tensor f = multiply(q[i], combine(1, identity(), 1, plain.g[i]));
      other.g[i] = combine(1, f, -1, identity());
      sample_set_increment(&other.s, i, other.g[i], multiply(f, other.F_old[i]));
    }
    tangent_run(&plain, material, dim);
    tangent_run(&other, material, dim);
    for (int i = 0; i < ITEMS; ++i) {
      real expected[81], odd;
      for (int row = 0; row < 81; ++row) expected[row] = plain.c[row * LD + i];
      turn(&q[i], dim, expected);
      const real error = tangent_error(&other, dim, i, expected, &odd);
      ck_assert_msg(error <= 1e-12L, "%s, %d-D, item %d: %Lg", laws[k].model, dim, i, error);
    }
    law_material_free(material);
  }
}
END_TEST

START_TEST(kernels_differ) {
  for (int32_t law = 0; law < MPMI_LAW_COUNT; ++law) {
    const mpmi_law *baseline = mpmi_law_of(MPM_ISA_BASELINE, law);
    ck_assert(baseline->tangent != mpmi_law_of(MPM_ISA_BASELINE, (law + 1) % MPMI_LAW_COUNT)->tangent);
#if MPMI_HAS_X86
    ck_assert(mpmi_law_of(MPM_ISA_AVX2, law)->tangent != baseline->tangent);
    ck_assert(mpmi_law_of(MPM_ISA_AVX512, law)->tangent != baseline->tangent);
    ck_assert(mpmi_law_of(MPM_ISA_AVX512, law)->tangent != mpmi_law_of(MPM_ISA_AVX2, law)->tangent);
#elif MPMI_HAS_NEON
    ck_assert(mpmi_law_of(MPM_ISA_NEON, law)->tangent != baseline->tangent);
#endif
  }
}
END_TEST

Suite *tangent_suite(void) {
  Suite *suite = suite_create("tangent");
  TCase *tc = tcase_create("laws");
  tcase_add_loop_test(tc, differences, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, frames, 0, LAW_LOOPS);
  tcase_add_test(tc, kernels_differ);
  suite_add_tcase(suite, tc);
  suite_add_tcase(suite, tangent_limits_case());
  suite_add_tcase(suite, tangent_host_case());
  return suite;
}
