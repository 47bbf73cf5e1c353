/* Tangents where they are known: at rest, in and out of yield, without pressure;
 * and at very large increments. */
#include "tangent_sample.h"

static const mpm_param elastic[] = {
    {"E", 2.5e6}, {"nu", 0.25}, {"density", 1e3}, {"yield_stress", 4e4}, {"hardening", 0.0}};
static const double shear = 1e6, lame = 1e6; /* of E = 2.5e6, nu = 0.25 */

/* Nothing has happened in any item. */
static void at_rest_fill(tangent_batch *b, int32_t dim) {
  sample_clear(&b->s, tangent_dt);
  for (int i = 0; i < ITEMS; ++i) {
    b->g[i] = combine(0, identity(), 0, identity());
    b->F_old[i] = identity();
    sample_set_increment(&b->s, i, b->g[i], identity());
    sample_set_stress(&b->s, dim, i, b->g[i]);
  }
}

static void check_isotropic(const tangent_batch *b, int32_t dim, real volumetric, real of_shape) {
  real c[81] = {0}, odd;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) {
      c[tangent_row(i, i, j, j)] += volumetric;
      c[tangent_row(i, j, i, j)] += of_shape;
      c[tangent_row(i, j, j, i)] += of_shape;
    }
  for (int i = 0; i < ITEMS; ++i) ck_assert(tangent_error(b, dim, i, c, &odd) <= 1e-15L && odd <= 1e-15L);
}

/* Hooke's law at rest, from every law; without tension too, as long as the fluid fills its volume. */
START_TEST(at_rest) {
  const int32_t isa = loop_isa(_i), dim = loop_dim(_i);
  const real by_rate = 3e4L / tangent_dt;
  const struct {
    tangent_law law;
    real volumetric, shear;
  } known[] = {
      {{"neo_hookean", 3, 1, {elastic[0], elastic[1], elastic[2]}}, lame, shear},
      {{"linear_elastic", 3, 0, {elastic[0], elastic[1], elastic[2]}}, lame, shear},
      {{"j2", 4, 0, {elastic[0], elastic[1], elastic[2], elastic[3]}}, lame, shear},
      {{"neo_hookean_decoupled", 3, 1, {{"mu", 1e6}, {"kappa", 7e6}, {"density", 1e3}}},
       7e6L - 2e6L / 3,
       1e6L},
      {{"newtonian_fluid", 2, 1, {{"density", 1e3}, {"bulk_modulus", 2e5}}}, 2e5L, 0},
      {{"newtonian_fluid", 3, 1, {{"density", 1e3}, {"bulk_modulus", 2e5}, {"tension", 0.0}}}, 2e5L, 0},
      {{"newtonian_fluid", 3, 0, {{"density", 1e3}, {"bulk_modulus", 2e5}, {"viscosity", 3e4}}},
       2e5L - 2 * by_rate / 3,
       by_rate},
  };
  static tangent_batch b;
  for (size_t k = 0; k < sizeof known / sizeof known[0]; ++k) {
    const tangent_law *law = &known[k].law;
    mpm_material *material = law_material(isa, law->model, law->params, law->count);
    if (!material) return;
    at_rest_fill(&b, dim);
    tangent_run(&b, material, isa, dim);
    check_isotropic(&b, dim, known[k].volumetric, known[k].shear);
    law_material_free(material);
  }
}
END_TEST

/* Old stresses at yield, and an increment that goes on along them (sign 1) or back (-1), on top of a turn. */
static void at_yield_fill(tangent_batch *b, int32_t dim, real sign) {
  uint64_t state = 51;
  sample_clear(&b->s, tangent_dt);
  for (int i = 0; i < ITEMS; ++i) {
    tensor any = random_stress(&state, dim, 1), d = combine(1, any, -trace(any) / 3, identity());
    d = combine(tangent_yield / sqrtl(1.5L * contract(d, d)), d, 0, d);
    tensor stretch = combine(1, identity(), sign * 0.3L / tangent_mu, d), q = random_rotation(&state, dim);
    for (int k = dim; k < 3; ++k) stretch.m[k][k] = 1;
    tensor f = multiply(q, stretch);
    b->g[i] = combine(1, f, -1, identity());
    b->F_old[i] = identity();
    sample_set_increment(&b->s, i, b->g[i], f);
    sample_set_stress(&b->s, dim, i, combine(1, d, 2e4L, identity()));
  }
}

/* Stress change of the step for a symmetric D, back from c. */
static tensor stress_change(const tangent_batch *b, int i, tensor d) {
  const tensor s = sample_stress(&b->s, 3, i);
  tensor change = combine(-trace(d), s, 1, combine(1, multiply(d, s), 1, multiply(s, d)));
  const real jacobian = det(sample_F(&b->s, i));
  for (int row = 0; row < 81; ++row)
    change.m[row / 27][row / 9 % 3] += b->c[row * LD + i] / jacobian * d.m[row / 3 % 3][row % 3];
  return change;
}

/* Back from yield the tangent is the elastic one; beyond it, without hardening,
 * no D changes the von Mises stress. */
START_TEST(loading_and_unloading) {
  const int32_t isa = loop_isa(_i), dim = loop_dim(_i);
  mpm_material *plastic = law_material(isa, "j2", elastic, 5);
  mpm_material *reference = law_material(isa, "linear_elastic", elastic, 3);
  if (!plastic || !reference) return;
  static tangent_batch b, e;
  for (int sign = -1; sign <= 1; sign += 2) {
    at_yield_fill(&b, dim, sign);
    at_yield_fill(&e, dim, sign);
    tangent_run(&b, plastic, isa, dim);
    tangent_run(&e, reference, isa, dim);
    uint64_t state = 52;
    for (int i = 0; i < ITEMS; ++i) {
      real c[81], odd;
      for (int row = 0; row < 81; ++row) c[row] = e.c[row * LD + i];
      const real off = tangent_error(&b, dim, i, c, &odd);
      ck_assert_msg(sign > 0 ? off > 1e-6L : off <= 1e-14L, "item %d, %d: %Lg", i, sign, off);
      if (sign < 0 || dim < 3) continue;
      tensor d = random_stress(&state, dim, 1), s = sample_stress(&b.s, dim, i);
      const tensor shape = combine(1, s, -trace(s) / 3, identity());
      ck_assert(fabsl(contract(shape, stress_change(&b, i, d))) <= 1e-13L * tangent_mu * norm(shape));
    }
  }
  law_material_free(plastic);
  law_material_free(reference);
}
END_TEST

START_TEST(without_pressure) {
  const int32_t isa = loop_isa(_i), dim = loop_dim(_i);
  const mpm_param params[] = {{"density", 1e3}, {"bulk_modulus", 1e5}, {"tension", 0.0}};
  mpm_material *material = law_material(isa, "newtonian_fluid", params, 3);
  if (!material) return;
  static tangent_batch b;
  at_rest_fill(&b, dim);
  for (int i = 0; i < ITEMS; ++i) sample_set(b.s.F, i, tangent_diagonal(i % 2 ? 1 + 1e-12L : 1.5L, 1, 1));
  tangent_run(&b, material, isa, dim);
  check_isotropic(&b, dim, 0, 0);
  law_material_free(material);
}
END_TEST

/* One stretch of the step ten times another: what the cut continued fractions leave. */
START_TEST(large_increments) {
  const int32_t isa = loop_isa(_i), dim = loop_dim(_i);
  static const mpm_param fluid[] = {
      {"density", 1e3}, {"bulk_modulus", 1e3}, {"gamma", 1.0}, {"viscosity", 3e4}};
  for (int law = 0; law < 2; ++law) {
    mpm_material *material = law ? law_material(isa, "newtonian_fluid", fluid, 4)
                                 : law_material(isa, "linear_elastic", elastic, 3);
    if (!material) return;
    static tangent_batch b;
    static real exact[ITEMS][81];
    uint64_t state = 53;
    tangent_fill(&b, &state, dim);
    for (int i = 0; i < ITEMS; ++i) {
      const real middle = 2.2L + 1.8L * uniform(&state);
      tensor f = tangent_stretches(dim, 0.4L, 4.0L, middle);
      for (int k = dim; k < 3; ++k) f.m[k][k] = 1;
      f = multiply(random_rotation(&state, dim), multiply(f, random_rotation(&state, dim)));
      b.g[i] = combine(1, f, -1, identity());
      sample_set_increment(&b.s, i, b.g[i], multiply(f, b.F_old[i]));
    }
    tangent_run(&b, material, isa, dim);
    tangent_by_differences(&b, material, dim, exact);
    for (int i = 0; i < ITEMS; ++i) {
      real odd, error = tangent_error(&b, dim, i, exact[i], &odd);
      ck_assert_msg(error <= 5e-9L, "law %d, %d-D, item %d: %Lg", law, dim, i, error);
    }
    law_material_free(material);
  }
}
END_TEST

TCase *tangent_limits_case(void) {
  TCase *tc = tcase_create("limits");
  tcase_add_loop_test(tc, at_rest, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, loading_and_unloading, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, without_pressure, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, large_increments, 0, LAW_LOOPS);
  return tc;
}
