/* Materials as handles: the registry, what laws say of themselves, and refused arguments; and the logarithms
 * of the kernels. The laws themselves are tested in material_*.c. */
#include "law_sample.h"
#include "particles/law_batch.h"
#include "simd/vector_math.h"

enum { MOST_PARAMS = 16 };

static mpm_context *context;
static mpm_material *material;

static void setup(void) {
  context = context_with(1, MPM_ISA_BEST, NULL);
}
static void teardown(void) {
  ck_assert_int_eq(context->children, 0);
  ck_ok(context, mpm_context_destroy(context));
}

/* The refusal has a text that contains `text`, gives no object and leaves none behind. */
static void refused(mpm_status got, mpm_status expected, const char *text) {
  ck_refused(context, got, expected, text);
  ck_assert_ptr_null(material);
  ck_assert_int_eq(context->children, 0);
}
static void refuse(const char *model, const mpm_param *params, int32_t count, mpm_status expected,
                   const char *text) {
  material = (mpm_material *)&material;
  refused(mpm_material_create(context, model, params, count, &material), expected, text);
}

/* How many state variables a law has, and whether its stress is part of the state. */
typedef struct law_kind {
  const char *model;
  int32_t states, keeps_stress;
} law_kind;
static law_kind kind_of(const char *model) {
  static const law_kind kinds[] = {
      {"neo_hookean", 0, 0},      {"linear_elastic", 0, 1}, {"j2", 1, 1},
      {"newtonian_fluid", 0, 0},  {"rigid", 0, 0},          {"neo_hookean_decoupled", 0, 0},
      {"drucker_prager", 2, 1},   {"mohr_coulomb", 2, 1},   {"mu_i", 2, 1},
      {"herschel_bulkley", 0, 1}, {"snow", 6, 0},           {"cam_clay", 2, 1}};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k)
    if (!strcmp(kinds[k].model, model)) return kinds[k];
  ck_abort_msg("%s: no such kind", model);
}

START_TEST(registry_describes_every_law) {
  ck_assert_int_eq(mpm_material_model_count(), MPMI_LAW_COUNT);
  ck_assert_ptr_null(mpm_material_model_name(-1));
  ck_assert_ptr_null(mpm_material_model_name(MPMI_LAW_COUNT));
  ck_assert_ptr_null(mpmi_law_of(MPM_ISA_BASELINE, MPMI_LAW_COUNT));
  for (int32_t m = 0; m < mpm_material_model_count(); ++m) {
    const char *model = mpm_material_model_name(m), *name, *unit, *text;
    mpm_param params[MOST_PARAMS];
    double value, low, high;
    int32_t k = 0;
    for (; !mpm_material_model_param(model, k, &name, &unit, &text, &value, &low, &high); ++k) {
      ck_assert(strlen(name) && strlen(unit) && strlen(text) && low < high);
      ck_assert(isnan(value) || (value >= low && value <= high));
      ck_assert_int_lt(k, MOST_PARAMS);
      params[k] = (mpm_param){name, isnan(value) ? 0.25 : value};
      if (!strcmp(name, "mu_2") || !strcmp(name, "lambda")) params[k].value = 0.5; /* above mu_s, kappa */
    }
    ck_assert_int_ge(k, 1);
    ck_assert_int_eq(mpm_material_model_param(model, k, NULL, NULL, NULL, NULL, NULL, NULL), MPM_E_NOT_FOUND);
    ck_ok(NULL, mpm_material_model_param(model, k - 1, NULL, NULL, NULL, NULL, NULL, NULL));
    ck_ok(context, mpm_material_create(context, model, params, k, &material));
    ck_assert_int_eq(context->children, 1);
    ck_assert_str_eq(material->law->name, model);
    ck_assert_ptr_eq(material->law, mpmi_law_of(context->isa, m));
    ck_assert_double_eq(material->density, 0.25);
    ck_assert_int_eq(material->state_count, kind_of(model).states);
    ck_assert_int_eq(mpmi_material_stress_from_F(material), !kind_of(model).keeps_stress);
    ck_assert_int_eq(mpmi_material_mean_from_F(material), !strcmp(model, "herschel_bulkley"));
    ck_ok(context, mpm_material_destroy(material));
  }
  ck_assert_int_eq(mpm_material_model_param("neo_hookean", -1, NULL, NULL, NULL, NULL, NULL, NULL),
                   MPM_E_ARG);
  ck_assert_int_eq(mpm_material_model_param(NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_material_model_param("ether", 0, NULL, NULL, NULL, NULL, NULL, NULL), MPM_E_NOT_FOUND);
}
END_TEST

/* Laws that look at F alone have a kernel that takes it as sets store it in 2-D. */
START_TEST(kernels_differ) {
  for (int32_t law = 0; law < MPMI_LAW_COUNT; ++law) {
    const mpmi_law *baseline = mpmi_law_of(MPM_ISA_BASELINE, law);
    const int32_t looks_at_F_alone =
        baseline->stress_from_F && !baseline->state_count && baseline->kinematics == MPMI_F_DEFORMS;
    ck_assert_int_eq(baseline->plane_stored != NULL, looks_at_F_alone);
    ck_assert(baseline->stress != mpmi_law_of(MPM_ISA_BASELINE, (law + 1) % MPMI_LAW_COUNT)->stress);
#if MPMI_HAS_X86
    ck_assert(mpmi_law_of(MPM_ISA_AVX2, law)->stress != baseline->stress);
    ck_assert(mpmi_law_of(MPM_ISA_AVX512, law)->stress != baseline->stress);
    ck_assert(mpmi_law_of(MPM_ISA_AVX512, law)->stress != mpmi_law_of(MPM_ISA_AVX2, law)->stress);
#elif MPMI_HAS_NEON
    ck_assert(mpmi_law_of(MPM_ISA_NEON, law)->stress != baseline->stress);
#endif
  }
}
END_TEST

START_TEST(refused_names) {
  mpm_param p[] = {{"E", 1e6}, {"nu", 0.3}, {"density", 1e3}};
  refuse("neo_hooke", p, 3, MPM_E_NOT_FOUND, "neo_hookean");
  refuse("", p, 3, MPM_E_NOT_FOUND, "no model");
  p[2].name = "densty";
  refuse("linear_elastic", p, 3, MPM_E_NOT_FOUND, "nearest: density");
  p[2].name = "yield_stress";
  refuse("linear_elastic", p, 3, MPM_E_NOT_FOUND, "no parameter \"yield_stress\"");
  p[2].name = NULL;
  refuse("linear_elastic", p, 3, MPM_E_ARG, "params[2].name is NULL");
  p[2].name = "E";
  refuse("linear_elastic", p, 3, MPM_E_ARG, "\"E\" is given twice");
}
END_TEST

START_TEST(refused_arguments) {
  const mpm_param p[] = {{"E", 1e6}, {"nu", 0.3}, {"density", 1e3}, {"hardening", 1.0}};
  refuse(NULL, p, 3, MPM_E_ARG, "model is NULL");
  refuse("linear_elastic", NULL, 3, MPM_E_ARG, "params is NULL");
  refuse("linear_elastic", p, -1, MPM_E_ARG, "count = -1");
  refuse("linear_elastic", NULL, 0, MPM_E_ARG, "\"E\"");
  refuse("linear_elastic", p, 1, MPM_E_ARG, "\"nu\"");
  refuse("linear_elastic", p, 2, MPM_E_ARG, "\"density\"");
  refuse("j2", p, 4, MPM_E_ARG, "\"yield_stress\"");
  material = NULL;
  refused(mpm_material_create(context, "linear_elastic", p, 3, NULL), MPM_E_ARG, "out is NULL");
  material = (mpm_material *)&material;
  ck_assert_int_eq(mpm_material_create(NULL, "linear_elastic", p, 3, &material), MPM_E_ARG);
  ck_assert_ptr_null(material);
  int64_t not_a_context[512] = {0};
  ck_assert_int_eq(mpm_material_create((mpm_context *)not_a_context, "linear_elastic", p, 3, &material),
                   MPM_E_ARG);
}
END_TEST

START_TEST(refused_values) {
  const double nan = (double)NAN, inf = (double)INFINITY;
  const struct {
    int32_t index;
    double value;
    const char *text;
  } bad[] = {{0, 0.0, "E = 0"},
             {0, -1e6, "E = -1000000"},
             {0, nan, "E = "},
             {0, inf, "E = inf"},
             {1, -1.0, "nu = -1"},
             {1, 0.5, "nu = 0.5, but it must be"},
             {1, 0.7, "nu = 0.69"},
             {1, nan, "nu = "},
             {2, 0.0, "density = 0"},
             {2, -1.0, "density = -1"},
             {2, inf, "density = inf"},
             {2, nan, "density = "},
             {3, 0.0, "yield_stress = 0"},
             {3, -2.0, "yield_stress = -2"},
             {3, nan, "yield_stress = "},
             {4, -1.0, "hardening = -1"},
             {4, inf, "hardening = inf"},
             {4, nan, "hardening = "}};
  for (size_t i = 0; i < sizeof bad / sizeof bad[0]; ++i) {
    mpm_param p[] = {{"E", 1e6}, {"nu", 0.3}, {"density", 1e3}, {"yield_stress", 1e3}, {"hardening", 0.0}};
    p[bad[i].index].value = bad[i].value;
    refuse("j2", p, 5, MPM_E_ARG, bad[i].text);
    if (bad[i].index > 2) continue;
    refuse("neo_hookean", p, 3, MPM_E_ARG, bad[i].text);
    refuse("linear_elastic", p, 3, MPM_E_ARG, bad[i].text);
  }
  static const struct {
    mpm_param param;
    const char *text;
  } odd[] = {{{"bulk_modulus", 0.0}, "bulk_modulus = 0"},
             {{"gamma", 0.99}, "gamma = 0.98999999999999999, but it must"},
             {{"viscosity", -1.0}, "viscosity = -1"},
             {{"tension", 0.5}, "tension = 0.5, but it must be 0 or 1"},
             {{"tension", 2.0}, "tension = 2"},
             {{"density", 0.0}, "density = 0"}};
  for (size_t i = 0; i < sizeof odd / sizeof odd[0]; ++i) {
    mpm_param p[] = {{"density", 1e3}, {"bulk_modulus", 1e6}, odd[i].param};
    int32_t same = 0;
    while (same < 2 && strcmp(p[same].name, odd[i].param.name)) ++same;
    p[same] = odd[i].param;
    refuse("newtonian_fluid", p, same < 2 ? 2 : 3, MPM_E_ARG, odd[i].text);
  }
  refuse("rigid", &odd[5].param, 1, MPM_E_ARG, "density = 0");
  refuse("neo_hookean_decoupled", (mpm_param[]){{"mu", 0.0}, {"kappa", 1.0}, {"density", 1.0}}, 3, MPM_E_ARG,
         "mu = 0");
  refuse("neo_hookean_decoupled", (mpm_param[]){{"mu", 1.0}, {"kappa", -1.0}, {"density", 1.0}}, 3, MPM_E_ARG,
         "kappa = -1");
  const mpm_param overflow[] = {{"E", 1e300}, {"nu", 0.3}, {"density", 1e-300}};
  refuse("neo_hookean", overflow, 3, MPM_E_ARG, "double precision");
  const mpm_param fine[][3] = {{{"E", 1e6}, {"nu", -0.999}, {"density", 1e3}},
                               {{"nu", 0.4999999}, {"E", 1e-3}, {"density", 1e-12}}};
  for (int i = 0; i < 2; ++i) {
    ck_ok(context, mpm_material_create(context, "neo_hookean", fine[i], 3, &material));
    ck_ok(context, mpm_material_destroy(material));
  }
}
END_TEST

START_TEST(destroying) {
  const mpm_param p[] = {{"E", 1e6}, {"nu", 0.3}, {"density", 1e3}};
  int64_t before, after;
  ck_ok(context, mpm_context_memory(context, &before, NULL));
  ck_ok(context, mpm_material_destroy(NULL));
  ck_ok(context, mpm_material_create(context, "linear_elastic", p, 3, &material));
  ck_assert_int_eq(mpm_context_destroy(context), MPM_E_STATE);
  material->users = 2;
  ck_refused(context, mpm_material_destroy(material), MPM_E_STATE, "2 set");
  material->users = 0;
  ck_ok(context, mpm_material_destroy(material));
  ck_assert_int_eq(mpm_material_destroy((mpm_material *)context), MPM_E_ARG);
  ck_ok(context, mpm_context_memory(context, &after, NULL));
  ck_assert_int_eq(before, after);
}
END_TEST

/* ---- all laws ---- */
/* Values for all parameters that there are; a law takes those that it has. */
static int32_t all_params(const char *model, mpm_param *params) {
  static const mpm_param values[] = {{"E", 2.5e6},
                                     {"nu", 0.25},
                                     {"density", 1e3},
                                     {"mu", 1e6},
                                     {"yield_stress", 1e3},
                                     {"hardening", 1e4},
                                     {"kappa", 2e6},
                                     {"bulk_modulus", 1e5},
                                     {"gamma", 7.0},
                                     {"viscosity", 30.0},
                                     {"tension", 1.0},
                                     {"phi", 20.0},
                                     {"psi", 5.0},
                                     {"cohesion", 2e3},
                                     {"cone", 2.0},
                                     {"tension_cutoff", 3e3},
                                     {"cohesion_residual", 1e2},
                                     {"close_gaps", 1.0},
                                     {"shear_modulus", 1e6},
                                     {"yield_shear", 1e3},
                                     {"consistency", 30.0},
                                     {"n", 0.7},
                                     {"critical_compression", 0.025},
                                     {"critical_stretch", 0.0075},
                                     {"hardening_max", 20.0},
                                     {"mu_s", 0.2},
                                     {"mu_2", 0.8},
                                     {"I_0", 0.3},
                                     {"grain_diameter", 0.01},
                                     {"grain_density", 2.5e3},
                                     {"lambda", 0.12},
                                     {"M", 1.05},
                                     {"mu0", 2e5},
                                     {"alpha", 0.5},
                                     {"p_ref", 1e3},
                                     {"pc0", 2e3},
                                     {"p_min", 10.0}};
  const char *name;
  int32_t k = 0;
  for (; !mpm_material_model_param(model, k, &name, NULL, NULL, NULL, NULL, NULL); ++k) {
    size_t i = 0;
    while (strcmp(values[i].name, name)) ck_assert_uint_lt(++i, sizeof values / sizeof values[0]);
    params[k] = values[i];
    if (!strcmp(model, "snow") && !strcmp(name, "hardening")) params[k].value = 10.0; /* has no unit */
    /* the one name that means a modulus in one law and a slope in another */
    if (!strcmp(model, "cam_clay") && !strcmp(name, "kappa")) params[k].value = 0.02;
  }
  return k;
}

/* Sums look at the kinematic viscosity of those laws alone that say that they write it. */
START_TEST(viscous_laws_say_so) {
  for (int32_t law = 0; law < mpm_material_model_count(); ++law) {
    const char *name = mpm_material_model_name(law);
    mpm_param params[MOST_PARAMS];
    mpm_material *m = law_material(MPM_ISA_BASELINE, name, params, all_params(name, params));
    static sample s;
    sample_clear(&s, 0.01);
    s.batch.state_count = m->state_count;
    for (int i = 0; i < ITEMS; ++i) s.viscosity[i] = sample_unset;
    for (int c = 0; c < 6; ++c)
      for (int i = 0; i < ITEMS; ++i) s.stress[c * LD + i] = 0.0;
    ck_ok(m->context, mpmi_material_evaluate(m, 3, &s.batch));
    for (int i = 0; i < ITEMS; ++i)
      ck_assert_msg((s.viscosity[i] != sample_unset) == m->law->viscous, "%s", name);
    law_material_free(m);
  }
}
END_TEST

/* A law that lists one refusal, and gives squares of wave speeds that are none of it. */
static double given_square;
static void give_square(const void *constants, int32_t dim, const mpm_material_batch *batch) {
  (void)constants, (void)dim;
  for (int64_t p = 0; p < batch->n; ++p) batch->wave_speed[p] = given_square;
}

START_TEST(refusals_are_listed) {
  static const mpmi_law_refusal only = {MPM_CUT_DT, "what it refuses"};
  static const double squares[] = {-0.5, -2.0, -3e9, MPMI_REFUSED(0)};
  const mpmi_law fake = {.name = "fake", .refusal = &only, .refusal_count = 1, .stress = give_square};
  mpm_material of = {.law = &fake};
  const int64_t id[MPMI_BATCH_OWN] = {7};
  void *memory = aligned_alloc(64, mpmi_law_batch_bytes(&of));
  for (int k = 0; k < 4; ++k) {
    mpmi_law_batch b;
    mpmi_law_batch_bind(&b, &of, memory);
    b.batch.n = 1, b.batch.id = id;
    given_square = squares[k];
    const mpm_status status = mpmi_law_batch_run(&b, &of, 3);
    ck_assert_int_eq(status, k == 3 ? MPM_CUT_DT : MPM_OK);
    if (k == 3)
      ck_assert(b.fault.particle == 7 && b.fault.what == only.what);
    else
      ck_assert(isnan(b.wave_speed[0]));
  }
  free(memory);
}
END_TEST

/* What a law makes of its parameters is the same on every instruction set to the last bit. */
START_TEST(constants_agree) {
  uint64_t state = 31;
  for (int32_t law = 0; law < mpm_material_model_count(); ++law)
    for (int32_t round = 0; round < 50; ++round) {
      const char *name = mpm_material_model_name(law);
      mpm_param params[MOST_PARAMS];
      const int32_t count = all_params(name, params);
      for (int32_t k = 0; k < count; ++k)
        if (strcmp(params[k].name, "tension") && strcmp(params[k].name, "cone") &&
            strcmp(params[k].name, "close_gaps"))
          params[k].value *= (double)(1 + uniform(&state) / 2);
      mpm_material *base = law_material(MPM_ISA_BASELINE, name, params, count);
      mpm_material *other = law_material(MPM_ISA_BASELINE + _i, name, params, count);
      if (other) {
        ck_assert(other->law != base->law && other->law->constants_size == base->law->constants_size);
        ck_assert_mem_eq(other->constants, base->constants, base->law->constants_size);
        law_material_free(other);
      }
      law_material_free(base);
    }
}
END_TEST

/* Every built-in law gives the same on every instruction set up to round-off. */
START_TEST(instruction_sets_agree) {
  int32_t dim = loop_dim(_i);
  for (int32_t law = 0; law < mpm_material_model_count(); ++law) {
    const char *name = mpm_material_model_name(law);
    mpm_param params[MOST_PARAMS];
    int32_t count = all_params(name, params);
    mpm_material *base = law_material(MPM_ISA_BASELINE, name, params, count);
    mpm_material *other = law_material(loop_isa(_i), name, params, count);
    if (!other) {
      law_material_free(base);
      return;
    }
    uint64_t states[2] = {22, 22};
    sample s[2];
    for (int k = 0; k < 2; ++k) {
      sample_clear(&s[k], 0.5);
      for (int i = 0; i < ITEMS; ++i) {
        tensor g = random_tensor(&states[k], dim, i % 2 ? 0.2L : 1e-3L);
        sample_set_increment(&s[k], i, g, combine(1, identity(), 1, g));
        sample_set_stress(&s[k], dim, i, random_stress(&states[k], dim, 1e3L));
      }
      sample_evaluate(&s[k], k ? other : base, dim);
    }
    for (int i = 0; i < ITEMS; ++i) {
      ck_assert(sample_error(&s[1], dim, i, sample_stress(&s[0], dim, i)) <= 1e-13L * 2.5e6L);
      ck_assert_double_eq_tol(s[1].energy[i], s[0].energy[i], 1e-13 * 2.5e6);
      ck_assert_double_eq_tol(s[1].wave_speed[i], s[0].wave_speed[i],
                              1e-13 * fabs(s[0].wave_speed[i]) + 1e-300);
      ck_assert_double_eq_tol(s[1].viscosity[i], s[0].viscosity[i], 1e-13 * s[0].viscosity[i] + 1e-300);
      for (int32_t c = 0; c < base->state_count; ++c)
        ck_assert_double_eq_tol(s[1].state_new[c * LD + i], s[0].state_new[c * LD + i],
                                1e-13 * (1.0 + fabs(s[0].state_new[c * LD + i])));
    }
    law_material_free(base);
    law_material_free(other);
  }
}
END_TEST

/* ---- logarithms and the exponential ------------------------------------------------------------------- */
static real relative_error(double got, real exact) {
  return exact == 0 ? fabsl(got) : fabsl(got / exact - 1);
}

START_TEST(logarithms) {
  uint64_t state = 31;
  real near_one = 0, elsewhere = 0, plus_one = 0;
  for (int i = 0; i < 1000000; ++i) {
    double u = (double)uniform(&state), x = 1.0 + 0.3 * u * (i % 2 ? 1.0 : 1e-6);
    double wide = exp(700.0 * u), medium = exp(3.0 * u), small = ldexp(u, -(i % 300)), grown = expm1(3.0 * u);
    near_one = fmaxl(near_one, relative_error(mpmi_lane_log(x), logl(x)));
    elsewhere = fmaxl(elsewhere, relative_error(mpmi_lane_log(wide), logl(wide)));
    elsewhere = fmaxl(elsewhere, relative_error(mpmi_lane_log(medium), logl(medium)));
    plus_one = fmaxl(plus_one, relative_error(mpmi_lane_log1p(grown), log1pl(grown)));
    if (u > -1) plus_one = fmaxl(plus_one, relative_error(mpmi_lane_log1p(small), log1pl(small)));
  }
  ck_assert_msg(near_one <= 2e-16L && elsewhere <= 4e-16L && plus_one <= 4e-16L, "%Lg %Lg %Lg", near_one,
                elsewhere, plus_one);
  ck_assert(mpmi_lane_log(1.0) == 0.0 && mpmi_lane_log1p(0.0) == 0.0);
}
END_TEST

START_TEST(exponential) {
  uint64_t state = 32;
  real worst = 0;
  for (int i = 0; i < 1000000; ++i) {
    double u = (double)uniform(&state), x = i % 3 == 0   ? 709.0 * u
                                            : i % 3 == 1 ? 2.0 * u
                                                         : ldexp(u, -(i % 300));
    worst = fmaxl(worst, relative_error(mpmi_lane_expm1(x), expm1l(x)));
  }
  ck_assert_msg(worst <= 3e-16L, "%Lg", worst);
  const double inf = (double)INFINITY;
  ck_assert(mpmi_lane_expm1(0.0) == 0.0 && mpmi_lane_expm1(-1e300) == -1.0 && mpmi_lane_expm1(-inf) == -1.0);
  ck_assert(!isfinite(mpmi_lane_expm1(709.9)) && !isfinite(mpmi_lane_expm1(inf)) &&
            !isfinite(mpmi_lane_expm1((double)NAN)));
}
END_TEST

Suite *material_suite(void) {
  Suite *suite = suite_create("material");
  TCase *handles = tcase_create("handles");
  tcase_add_checked_fixture(handles, setup, teardown);
  tcase_add_test(handles, registry_describes_every_law);
  tcase_add_test(handles, kernels_differ);
  tcase_add_test(handles, viscous_laws_say_so);
  tcase_add_test(handles, refusals_are_listed);
  tcase_add_test(handles, refused_names);
  tcase_add_test(handles, refused_arguments);
  tcase_add_test(handles, refused_values);
  tcase_add_test(handles, destroying);
  tcase_add_loop_test(handles, constants_agree, 1, 4);
  tcase_add_loop_test(handles, instruction_sets_agree, 0, LAW_LOOPS);
  tcase_add_test(handles, logarithms);
  tcase_add_test(handles, exponential);
  suite_add_tcase(suite, handles);
  suite_add_tcase(suite, custom_material_case());
  suite_add_tcase(suite, hyperelastic_case());
  suite_add_tcase(suite, fluid_case());
  suite_add_tcase(suite, hypoelastic_case());
  suite_add_tcase(suite, hencky_case());
  suite_add_tcase(suite, j2_case());
  return suite;
}
