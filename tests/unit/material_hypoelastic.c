/* Objective increments: linear elasticity on every instruction set and dimension. */
#include "law_sample.h"

static const mpm_param params[] = {{"E", 2.5e6}, {"nu", 0.3}, {"density", 1.2e3}};
static const double dt = 0.5; /* a power of two: dt * L is the increment without rounding */

static real shear_modulus(void) {
  return 2.5e6L / (2 * (1 + (real)0.3));
}
static real lambda(void) {
  return 2 * shear_modulus() * (real)0.3 / (1 - 2 * (real)0.3);
}
static real p_modulus(void) {
  return lambda() + 2 * shear_modulus();
}

static tensor rounded(tensor t) {
  for (int k = 0; k < 9; ++k) t.m[k / 3][k % 3] = (double)t.m[k / 3][k % 3];
  return t;
}
static tensor diagonal(real x, real y, real z) {
  tensor t = {{{x, 0, 0}, {0, y, 0}, {0, 0, z}}};
  return t;
}

/* Increments F_inc - I about as large as `size`: items 0 to 9 have coinciding or
 * nearly coinciding stretches. */
static tensor increment(uint64_t *state, int32_t dim, real size, int i) {
  static const real gaps[] = {0, 1e-15L, 1e-11L, 1e-8L, 1e-5L, 1e-2L};
  for (;;) {
    tensor g = random_tensor(state, dim, size), q = random_rotation(state, dim);
    real a = size * uniform(state), b = a * (1 + gaps[i % 6]);
    if (i < 5) g = turned(q, diagonal(a, dim > 1 ? b : 0, dim > 2 ? size * uniform(state) : 0));
    if (i >= 5 && i < 10) g = turned(q, diagonal(a, dim > 1 ? b : 0, dim > 2 ? a : 0));
    if (i == 10) g = diagonal(a, 0, 0);
    if (i == 11 && dim > 1) g.m[0][0] = g.m[1][1] = g.m[1][0] = 0;
    g = rounded(g);
    if (det(combine(1, identity(), 1, g)) > 0.1L) return g;
  }
}

static tensor sample_increment(const sample *s, int i) {
  tensor g;
  for (int c = 0; c < 9; ++c) g.m[c / 3][c % 3] = dt * s->L[c * LD + i];
  return g;
}

static tensor old_stress(const sample *s, int32_t dim, int i) {
  tensor t = {{{0}}};
  for (int c = 0; c < 6; ++c)
    if (stress_exists(dim, c))
      t.m[sym_row[c]][sym_column[c]] = t.m[sym_column[c]][sym_row[c]] = s->stress[c * LD + i];
  return t;
}

static tensor exact_stress(tensor old, tensor g) {
  tensor r, log_v = polar_log(g, &r);
  return combine(1, turned(r, old), 1,
                 combine(lambda() * trace(log_v), identity(), 2 * shear_modulus(), log_v));
}

START_TEST(formula) {
  int32_t dim = loop_dim(_i);
  mpm_material *material = law_material(loop_isa(_i), "linear_elastic", params, 3);
  if (!material) return;
  static const real sizes[] = {1e-20L, 1e-12L, 1e-7L, 1e-4L, 2e-3L, 5e-3L, 1e-2L, 0.1L, 0.3L, 0.9L};
  uint64_t state = 11;
  sample s;
  for (int k = 0; k < 10 * 2; ++k) {
    real tolerance = k < 18 ? 6e-16L : 1e-14L; /* the last increments flatten to a quarter and less at once */
    real stress_size = k % 2 ? 1e-2L * p_modulus() : 0;
    sample_clear(&s, dt);
    for (int i = 0; i < ITEMS; ++i) {
      sample_set_increment(&s, i, increment(&state, dim, sizes[k / 2], i), identity());
      sample_set_stress(&s, dim, i, random_stress(&state, dim, stress_size));
    }
    sample_evaluate(&s, material, dim);
    sample_check_untouched(&s, dim);
    for (int i = 0; i < ITEMS; ++i) {
      /* Relative to the strain, as far as the ratio of the squared stretches allows. */
      tensor g = sample_increment(&s, i), old = old_stress(&s, dim, i), f = combine(1, identity(), 1, g);
      tensor f_inverse = inverse(f);
      real condition = contract(f, f) * contract(f_inverse, f_inverse);
      real scale = condition * (p_modulus() * norm(g) + norm(old));
      ck_assert(sample_error(&s, dim, i, exact_stress(old, g)) <= tolerance * scale);
    }
  }
  law_material_free(material);
}
END_TEST

START_TEST(rotation_leaves_no_stress) {
  int32_t dim = loop_dim(_i);
  mpm_material *material = law_material(loop_isa(_i), "linear_elastic", params, 3);
  if (!material) return;
  uint64_t state = 12;
  sample s;
  sample_clear(&s, dt);
  tensor expected[ITEMS];
  for (int i = 0; i < ITEMS; ++i) {
    tensor q = random_rotation(&state, dim), stress = random_stress(&state, dim, 1e-3L * p_modulus());
    sample_set_increment(&s, i, combine(1, q, -1, identity()), q);
    sample_set_stress(&s, dim, i, stress);
    expected[i] = turned(q, stress);
  }
  sample_evaluate(&s, material, dim);
  for (int i = 0; i < ITEMS; ++i) ck_assert(sample_error(&s, dim, i, expected[i]) <= 2e-15L * p_modulus());
  law_material_free(material);
}
END_TEST

START_TEST(objectivity) {
  int32_t dim = loop_dim(_i);
  mpm_material *material = law_material(loop_isa(_i), "linear_elastic", params, 3);
  if (!material) return;
  uint64_t state = 13;
  sample s, r;
  tensor q[ITEMS];
  sample_clear(&s, dt);
  sample_clear(&r, dt);
  for (int i = 0; i < ITEMS; ++i) {
    tensor g = increment(&state, dim, 0.3L, i), stress = random_stress(&state, dim, 0.1L * p_modulus());
    q[i] = random_rotation(&state, dim);
    sample_set_increment(&s, i, g, combine(1, identity(), 1, g));
    sample_set_increment(&r, i, turned(q[i], g), combine(1, identity(), 1, turned(q[i], g)));
    sample_set_stress(&s, dim, i, stress);
    sample_set_stress(&r, dim, i, turned(q[i], stress));
  }
  sample_evaluate(&s, material, dim);
  sample_evaluate(&r, material, dim);
  for (int i = 0; i < ITEMS; ++i) {
    ck_assert(sample_error(&r, dim, i, turned(q[i], sample_stress(&s, dim, i))) <= 1e-13L * p_modulus());
    ck_assert_double_eq_tol(r.energy[i], s.energy[i], 1e-13 * 2.5e6);
  }
  law_material_free(material);
}
END_TEST

/* Small and large increments are found in two ways: which one a particle has does not depend on others, also
 * where one of these is no number. */
START_TEST(increments_stand_alone) {
  int32_t dim = loop_dim(_i);
  mpm_material *material = law_material(loop_isa(_i), "linear_elastic", params, 3);
  if (!material) return;
  static sample s[3]; /* of small increments; some large; and some that are none */
  uint64_t state = 16;
  for (int k = 0; k < 3; ++k) sample_clear(&s[k], dt);
  for (int i = 0; i < ITEMS; ++i) {
    tensor small = increment(&state, dim, 1e-3L, i), large = increment(&state, dim, 0.9L, i);
    tensor stress = random_stress(&state, dim, 1e-2L * p_modulus());
    for (int k = 0; k < 3; ++k) {
      sample_set_increment(&s[k], i, k && sample_is_large(i) ? large : small, identity());
      sample_set_stress(&s[k], dim, i, stress);
    }
    if (sample_is_none(i)) s[2].L[i] = (double)NAN;
  }
  samples_stand_alone(s, material, dim);
  law_material_free(material);
}
END_TEST

/* Takes what came out as the old state of the next step. */
static void carry_over(sample *s) {
  memcpy(s->stress, s->stress_new, sizeof s->stress);
  memcpy(s->state, s->state_new, sizeof s->state);
}

START_TEST(uniaxial_strain_path) {
  int32_t dim = loop_dim(_i);
  mpm_material *material = law_material(loop_isa(_i), "linear_elastic", params, 3);
  if (!material) return;
  sample s;
  sample_clear(&s, dt);
  real stretch = 1;
  for (int i = 0; i < ITEMS; ++i) sample_set_stress(&s, dim, i, diagonal(0, 0, 0));
  for (int k = 0; k < 300; ++k) {
    tensor g = rounded(diagonal(k < 200 ? 0.005L : -0.02L, 0, 0));
    stretch *= 1 + g.m[0][0];
    for (int i = 0; i < ITEMS; ++i) sample_set_increment(&s, i, g, diagonal(stretch, 1, 1));
    sample_evaluate(&s, material, dim);
    carry_over(&s);
  }
  real strain = logl(stretch);
  tensor expected = diagonal(p_modulus() * strain, lambda() * strain, lambda() * strain);
  for (int i = 0; i < ITEMS; ++i) {
    ck_assert(sample_error(&s, dim, i, expected) <= 1e-12L * p_modulus());
    ck_assert_double_eq_tol(s.energy[i], (double)(stretch * p_modulus() * strain * strain / 2),
                            1e-11 * 2.5e6);
    ck_assert_double_eq_tol(s.wave_speed[i], (double)sqrtl(p_modulus() * stretch / 1.2e3L), 1e-11);
  }
  law_material_free(material);
}
END_TEST

/* A stressed body that turns round once in 250 steps has its stress back. */
START_TEST(full_turn) {
  int32_t dim = loop_dim(_i);
  mpm_material *material = law_material(loop_isa(_i), "linear_elastic", params, 3);
  if (!material || dim == 1) {
    if (material) law_material_free(material);
    return;
  }
  uint64_t state = 14;
  sample s;
  tensor first[ITEMS], step[ITEMS];
  sample_clear(&s, dt);
  for (int i = 0; i < ITEMS; ++i) {
    real a = 2 * acosl(-1) / 250;
    tensor frame = random_rotation(&state, dim);
    tensor about_z = {{{cosl(a), -sinl(a), 0}, {sinl(a), cosl(a), 0}, {0, 0, 1}}};
    step[i] = turned(frame, about_z);
    first[i] = random_stress(&state, dim, 1e-3L * p_modulus());
    sample_set_stress(&s, dim, i, first[i]);
    sample_set_increment(&s, i, combine(1, step[i], -1, identity()), identity());
  }
  for (int k = 0; k < 250; ++k) {
    sample_evaluate(&s, material, dim);
    carry_over(&s);
  }
  for (int i = 0; i < ITEMS; ++i) ck_assert(sample_error(&s, dim, i, first[i]) <= 1e-13L * p_modulus());
  law_material_free(material);
}
END_TEST

static const mpm_param j2_params[] = {{"E", 2.5e6}, {"nu", 0.3}, {"density", 1.2e3}, {"yield_stress", 1e3}};

START_TEST(no_time_no_change) {
  int32_t dim = loop_dim(_i);
  for (int law = 0; law < 2; ++law) {
    mpm_material *material = law ? law_material(loop_isa(_i), "j2", j2_params, 4)
                                 : law_material(loop_isa(_i), "linear_elastic", params, 3);
    if (!material) return;
    uint64_t state = 15;
    sample s;
    sample_clear(&s, 0.0);
    for (int i = 0; i < ITEMS; ++i) {
      sample_set_stress(&s, dim, i,
                        random_stress(&state, dim, 1e4L)); /* beyond yield, as a host may set it */
      s.state[i] = 0.25 * i;
    }
    s.stress[1] = -0.0;
    sample_evaluate(&s, material, dim);
    sample_check_untouched(&s, dim);
    for (int c = 0; c < 6; ++c)
      if (stress_exists(dim, c))
        ck_assert_mem_eq(s.stress_new + c * LD, s.stress + c * LD, ITEMS * sizeof(double));
    if (law) ck_assert_mem_eq(s.state_new, s.state, ITEMS * sizeof(double));
    for (int i = 0; i < ITEMS; ++i) {
      tensor stress = old_stress(&s, dim, i);
      real mean = trace(stress) / 3, young = 2.5e6L;
      real energy = ((1 + (real)0.3) * contract(stress, stress) - 9 * (real)0.3 * mean * mean) / (2 * young);
      ck_assert_double_eq_tol(s.energy[i], (double)energy, 1e-14 * (double)energy);
      ck_assert_double_eq_tol(s.wave_speed[i], (double)sqrtl(p_modulus() / 1.2e3L), 1e-12);
    }
    law_material_free(material);
  }
}
END_TEST

TCase *hypoelastic_case(void) {
  TCase *tc = tcase_create("hypoelastic");
  tcase_add_loop_test(tc, formula, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, rotation_leaves_no_stress, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, objectivity, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, increments_stand_alone, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, uniaxial_strain_path, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, full_turn, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, no_time_no_change, 0, LAW_LOOPS);
  return tc;
}
