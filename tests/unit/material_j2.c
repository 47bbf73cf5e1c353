/* Von Mises plasticity with radial return, on every instruction set and dimension. */
#include "law_sample.h"

static const double dt = 0.5, yield = 1e3;
static const real nu = 0.25L, mu = 1e6L, bulk = 5e6L / 3; /* E = 2.5e6 */

static mpm_material *j2(int32_t isa, double hardening) {
  const mpm_param params[] = {
      {"hardening", hardening}, {"density", 1e3}, {"yield_stress", yield}, {"nu", 0.25}, {"E", 2.5e6}};
  return law_material(isa, "j2", params, 5);
}

static real mises(tensor stress) {
  tensor d = combine(1, stress, -trace(stress) / 3, identity());
  return sqrtl(1.5L * contract(d, d));
}

/* Uniaxial strain to and fro: with e = ln(stretch) the plastic strain is (2 mu e - yield) / (3 mu +
 * hardening) after first yield, and the axial stress K e + 2/3 (yield + hardening * plastic strain). */
static void uniaxial_strain(int32_t isa, int32_t dim, double hardening, real sign) {
  mpm_material *material = j2(isa, hardening);
  if (!material) return;
  sample s;
  sample_clear(&s, dt);
  for (int i = 0; i < ITEMS; ++i) sample_set_stress(&s, dim, i, combine(0, identity(), 0, identity()));
  real strain = 0, last = 0, last_strain = 0;
  int32_t yielded = 0;
  for (int k = 0; k < 400; ++k) {
    tensor g = combine(0, identity(), 0, identity());
    g.m[0][0] = (double)(sign * 5e-6L);
    strain += log1pl(g.m[0][0]);
    for (int i = 0; i < ITEMS; ++i) sample_set_increment(&s, i, g, identity());
    sample_evaluate(&s, material, dim);
    real e = fabsl(strain), plastic = (2 * mu * e - yield) / (3 * mu + hardening);
    real axial = plastic <= 0 ? (bulk + 4 * mu / 3) * e : bulk * e + 2 * (yield + hardening * plastic) / 3;
    real lateral = (3 * bulk * e - axial) / 2;
    for (int i = 0; i < ITEMS; ++i) {
      tensor t = sample_stress(&s, dim, i);
      ck_assert(fabsl(sign * t.m[0][0] - axial) <= 1e-10L * yield);
      ck_assert(fabsl(sign * t.m[1][1] - lateral) <= 1e-10L * yield);
      ck_assert(fabsl(sign * t.m[2][2] - lateral) <= 1e-10L * yield);
      ck_assert(fabsl(s.state_new[i] - fmaxl(plastic, 0)) <= 1e-14L);
    }
    if (plastic > 0 && !yielded++) /* the step that yields ends just beyond yield (1 - nu) / (1 - 2 nu) */
      ck_assert(fabsl(axial / (yield * (1 - nu) / (1 - 2 * nu)) - 1) < 0.01L);
    else if (yielded && hardening == 0) /* from then on the slope is K */
      ck_assert(fabsl((axial - last) / (e - last_strain) / bulk - 1) < 1e-9L);
    last = sign * s.stress_new[0];
    last_strain = e;
    memcpy(s.stress, s.stress_new, sizeof s.stress);
    memcpy(s.state, s.state_new, sizeof s.state);
  }
  ck_assert_int_gt(yielded, 0);
  law_material_free(material);
}

START_TEST(uniaxial_strain_path) {
  uniaxial_strain(loop_isa(_i), loop_dim(_i), 0, 1);
  uniaxial_strain(loop_isa(_i), loop_dim(_i), 0, -1);
  uniaxial_strain(loop_isa(_i), loop_dim(_i), 3e5, 1);
}
END_TEST

/* Against the elastic law, on whose result the radial return works. */
START_TEST(radial_return) {
  int32_t isa = loop_isa(_i), dim = loop_dim(_i);
  const mpm_param elastic[] = {{"E", 2.5e6}, {"nu", 0.25}, {"density", 1e3}};
  static const double hardenings[] = {0.0, 1e4, 1e7};
  uint64_t state = 21;
  for (int k = 0; k < 3; ++k) {
    double hardening = hardenings[k];
    mpm_material *plastic = j2(isa, hardening), *reference = law_material(isa, "linear_elastic", elastic, 3);
    if (!plastic || !reference) return;
    sample s, trial;
    sample_clear(&s, dt);
    for (int i = 0; i < ITEMS; ++i) {
      tensor g = random_tensor(&state, dim, i < 8 ? 1e-5L : i < 30 ? 1e-3L : 0.3L);
      if (i == 0) g = combine(0, g, 0, g);
      sample_set_increment(&s, i, g, combine(1, identity(), 1, random_tensor(&state, dim, 0.2L)));
      sample_set_stress(&s, dim, i, random_stress(&state, dim, i == 0 ? 0 : 300));
      s.state[i] = i % 3 ? 1e-3 * i : 0.0;
    }
    trial = s;
    trial.batch.stress_new = trial.stress_new;
    trial.batch.wave_speed = trial.wave_speed;
    trial.batch.energy = trial.energy;
    sample_evaluate(&s, plastic, dim);
    sample_evaluate(&trial, reference, dim);
    sample_check_untouched(&s, dim);
    int32_t yielding = 0;
    for (int i = 0; i < ITEMS; ++i) {
      tensor t = sample_stress(&trial, dim, i), got = sample_stress(&s, dim, i);
      real q = mises(t), limit = yield + hardening * s.state[i];
      real step = fmaxl(q - limit, 0) / (3 * mu + hardening), keep = q > limit ? 1 - 3 * mu * step / q : 1;
      tensor deviator = combine(1, t, -trace(t) / 3, identity());
      tensor expected = combine(trace(t) / 3, identity(), keep, deviator);
      ck_assert(sample_error(&s, dim, i, expected) <= 1e-13L * (norm(t) + yield));
      ck_assert(fabsl(s.state_new[i] - (s.state[i] + step)) <= 1e-14L * (s.state[i] + step));
      real now = yield + hardening * s.state_new[i];
      ck_assert(mises(got) <= now * (1 + 1e-10L));
      if (q > limit) ck_assert(fabsl(mises(got) - now) <= 1e-10L * now);
      yielding += q > limit;
      tensor f;
      for (int c = 0; c < 9; ++c) f.m[c / 3][c % 3] = s.F[c * LD + i];
      real mean = trace(got) / 3, m = mises(got);
      real energy = det(f) * (mean * mean / (2 * bulk) + m * m / (6 * mu));
      ck_assert_double_eq_tol(s.energy[i], (double)energy, 1e-13 * (double)energy + 1e-300);
      ck_assert_double_eq(s.wave_speed[i], trial.wave_speed[i]);
    }
    ck_assert(yielding > 1 && yielding < ITEMS - 1);
    law_material_free(plastic);
    law_material_free(reference);
  }
}
END_TEST

TCase *j2_case(void) {
  TCase *tc = tcase_create("j2");
  tcase_add_loop_test(tc, uniaxial_strain_path, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, radial_return, 0, LAW_LOOPS);
  return tc;
}
