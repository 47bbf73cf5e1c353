/* What a fluid and a rigid material do beside their formulas in F (material_hyperelastic.c): viscous stress
 * of the step, tension cut off, paths of the volume, and the parameters. */
#include "law_sample.h"

static const double dt = 0.5; /* a power of two: dt * L is the increment without rounding */
static const real eta = 40, bulk = 2.5e6L, density = 1.2e3L;

static mpm_material *fluid(int32_t isa, double tension) {
  const mpm_param params[] = {
      {"bulk_modulus", 2.5e6}, {"density", 1.2e3}, {"viscosity", 40}, {"tension", tension}, {"gamma", 7}};
  return law_material(isa, "newtonian_fluid", params, 5);
}

static tensor deviator(tensor t) {
  return combine(1, t, -trace(t) / 3, identity());
}

/* A shape F that has the volume J: the fluid sees the volume alone. */
static tensor of_volume(uint64_t *state, int32_t dim, real volume) {
  tensor f = combine(1, identity(), 1, random_tensor(state, dim, 0.2L));
  real now = det(f);
  for (int c = 0; c < 3; ++c) f.m[0][c] *= volume / now;
  return f;
}

/* p(J) through compression and tension, where the law has it. */
START_TEST(volume_path) {
  int32_t dim = loop_dim(_i);
  for (int tension = 0; tension < 2; ++tension) {
    mpm_material *material = fluid(loop_isa(_i), tension);
    if (!material) return;
    uint64_t state = 41;
    sample s;
    for (int k = 0; k < 40; ++k) {
      sample_clear(&s, dt);
      for (int i = 0; i < ITEMS; ++i)
        sample_set(s.F, i, of_volume(&state, dim, 0.7L + 0.0101L * (k + (real)i / ITEMS)));
      sample_evaluate(&s, material, dim);
      sample_check_untouched(&s, dim);
      for (int i = 0; i < ITEMS; ++i) {
        tensor f;
        for (int c = 0; c < 9; ++c) f.m[c / 3][c % 3] = s.F[c * LD + i];
        real j = det(f), seen = tension || j < 1 ? j : 1, p = bulk / 7 * (powl(seen, -7) - 1);
        ck_assert(sample_error(&s, dim, i, combine(-p, identity(), 0, f)) <= 1e-14L * (fabsl(p) + bulk));
        ck_assert(fabsl(s.energy[i] - bulk / 7 * ((powl(seen, -6) - 1) / 6 + seen - 1)) <= 1e-14L * bulk);
        ck_assert(fabsl(s.wave_speed[i] / sqrtl(bulk * powl(seen, -6) / density) - 1) <= 1e-14L);
        ck_assert(fabsl(s.viscosity[i] / (eta * j / density) - 1) <= 1e-14L);
      }
    }
    law_material_free(material);
  }
}
END_TEST

/* 2 eta dev(ln V) / dt, objective at finite increments, on top of the pressure. */
START_TEST(shear) {
  int32_t dim = loop_dim(_i);
  mpm_material *material = fluid(loop_isa(_i), 1);
  if (!material) return;
  static const real sizes[] = {1e-12L, 1e-6L, 1e-2L, 0.3L};
  uint64_t state = 42;
  sample s, r;
  tensor q[ITEMS], viscous[ITEMS];
  for (int k = 0; k < 4; ++k) {
    sample_clear(&s, dt);
    sample_clear(&r, dt);
    for (int i = 0; i < ITEMS; ++i) {
      tensor g = random_tensor(&state, dim, sizes[k]), unused;
      q[i] = random_rotation(&state, dim);
      sample_set_increment(&s, i, g, identity());
      sample_set_increment(&r, i, turned(q[i], g), identity());
      viscous[i] = combine(2 * eta / (real)dt, deviator(polar_log(g, &unused)), 0, g);
    }
    sample_evaluate(&s, material, dim);
    sample_evaluate(&r, material, dim);
    for (int i = 0; i < ITEMS; ++i) {
      ck_assert(sample_error(&s, dim, i, viscous[i]) <= 2e-14L * eta * sizes[k]);
      ck_assert(sample_error(&r, dim, i, turned(q[i], viscous[i])) <= (k ? 1e-13L : 1e-11L) * eta * sizes[k]);
      ck_assert(s.energy[i] == 0.0);
    }
  }
  law_material_free(material);
}
END_TEST

/* A small simple shear of rate c gives the shear stress eta c, and a rotation of any size nothing. */
START_TEST(rates_and_rotations) {
  int32_t dim = loop_dim(_i);
  mpm_material *material = fluid(loop_isa(_i), 1);
  if (!material) return;
  uint64_t state = 43;
  sample s;
  sample_clear(&s, dt);
  for (int i = 0; i < ITEMS; ++i) {
    tensor q = random_rotation(&state, dim), g = combine(1, q, -1, identity());
    if (dim > 1 && i < 8) {
      g = combine(0, g, 0, g);
      g.m[0][1] = dt * 1e-7L * (i + 1);
    }
    sample_set_increment(&s, i, g, q);
  }
  sample_evaluate(&s, material, dim);
  for (int i = 0; i < ITEMS; ++i) {
    tensor t = sample_stress(&s, dim, i);
    t = deviator(t);
    if (dim > 1 && i < 8)
      ck_assert(fabsl(t.m[0][1] / (eta * 1e-7L * (i + 1)) - 1) <= 1e-6L);
    else
      ck_assert(norm(t) <= 1e-14L * eta / (real)dt + 1e-15L * bulk);
  }
  law_material_free(material);
}
END_TEST

/* Asked for the state as it is, the fluid gives the pressure of F and keeps what is viscous in the stress. */
START_TEST(as_it_is) {
  int32_t dim = loop_dim(_i);
  const mpm_param thin[] = {{"bulk_modulus", 2.5e6}, {"density", 1.2e3}};
  for (int viscous = 0; viscous < 2; ++viscous) {
    mpm_material *material =
        viscous ? fluid(loop_isa(_i), 1) : law_material(loop_isa(_i), "newtonian_fluid", thin, 2);
    if (!material) return;
    uint64_t state = 44;
    sample s;
    tensor old[ITEMS];
    sample_clear(&s, 0.0);
    for (int c = 0; c < 9; ++c)
      for (int i = 0; i < ITEMS; ++i) s.L[c * LD + i] = 0.0;
    for (int i = 0; i < ITEMS; ++i) {
      sample_set(s.F, i, of_volume(&state, dim, 0.9L));
      old[i] = random_stress(&state, dim, 1e3L);
      sample_set_stress(&s, dim, i, old[i]);
    }
    sample_evaluate(&s, material, dim);
    for (int i = 0; i < ITEMS; ++i) {
      tensor expected = combine(-bulk / 7 * (powl(0.9L, -7) - 1), identity(), viscous, deviator(old[i]));
      ck_assert(sample_error(&s, dim, i, expected) <= 1e-14L * bulk);
      tensor t = sample_stress(&s, dim, i);
      if (!viscous) ck_assert(t.m[0][0] == t.m[1][1] && t.m[1][1] == t.m[2][2] && norm(deviator(t)) < 1e-9L);
    }
    law_material_free(material);
  }
}
END_TEST

START_TEST(rigid) {
  int32_t dim = loop_dim(_i);
  const mpm_param params[] = {{"density", 7.8e3}};
  mpm_material *material = law_material(loop_isa(_i), "rigid", params, 1);
  if (!material) return;
  uint64_t state = 45;
  sample s;
  sample_clear(&s, dt);
  for (int i = 0; i < ITEMS; ++i)
    sample_set_increment(&s, i, random_tensor(&state, dim, 0.3L), of_volume(&state, dim, 0.5L));
  sample_evaluate(&s, material, dim);
  sample_check_untouched(&s, dim);
  ck_assert_double_eq(material->density, 7.8e3);
  for (int i = 0; i < ITEMS; ++i) {
    ck_assert(norm(sample_stress(&s, dim, i)) == 0);
    ck_assert(s.wave_speed[i] == 0.0 && s.energy[i] == 0.0 && s.viscosity[i] == 0.0);
  }
  law_material_free(material);
}
END_TEST

TCase *fluid_case(void) {
  TCase *tc = tcase_create("fluid");
  tcase_add_loop_test(tc, volume_path, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, shear, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, rates_and_rotations, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, as_it_is, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, rigid, 0, LAW_LOOPS);
  return tc;
}
