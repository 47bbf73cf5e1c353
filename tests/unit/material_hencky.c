/* Trial strains of laws that are linear in the logarithmic strain, on every instruction set and dimension: of
 * a soil that bears everything the stress is that of the trial. */
#include "law_sample.h"

static const mpm_param params[] = {
    {"E", 1.0}, {"nu", 0.3}, {"density", 1.0}, {"phi", 0.0}, {"cohesion", 1e30}};
static const double dt = 0.5; /* a power of two: dt * L is the increment without rounding */

static real shear_modulus(void) {
  return 1 / (2 * (1 + (real)0.3));
}
static real bulk_modulus(void) {
  return 1 / (3 * (1 - 2 * (real)0.3));
}

static tensor deviator(tensor t) {
  return combine(1, t, -trace(t) / 3, identity());
}

/* Returns exp(e) - I. */
static tensor exp_minus_1(tensor e) {
  tensor sum = {{{0}}}, term = identity();
  for (int k = 1; k < 40; ++k) {
    term = combine(1 / (real)k, multiply(term, e), 0, e);
    sum = combine(1, sum, 1, term);
  }
  return sum;
}

/* A particle: the stress before the step, and F_inc - I of the step. */
typedef struct particle {
  tensor stress, g;
} particle;

static particle random_particle(uint64_t *state, int32_t dim, real strain, real increment) {
  particle p = {random_stress(state, dim, strain), random_tensor(state, dim, increment)};
  return p;
}

static void set_particle(sample *s, int32_t dim, int i, particle p) {
  sample_set_increment(s, i, p.g, combine(1, identity(), 1, p.g));
  sample_set_stress(s, dim, i, p.stress);
}

/* Returns the logarithmic strain of the trial; J: det F at the end of the step. */
static tensor exact_strain(particle p, real J) {
  const real before = J / (1 + det_minus_1(p.g));
  tensor e = combine(before * trace(p.stress) / (9 * bulk_modulus()), identity(),
                     before / (2 * shear_modulus()), deviator(p.stress)),
         u = exp_minus_1(e), unused;
  return polar_log(combine(1, combine(1, p.g, 1, u), 1, multiply(p.g, u)), &unused);
}

START_TEST(trial_strains) {
  int32_t dim = loop_dim(_i);
  mpm_material *material = law_material(loop_isa(_i), "drucker_prager", params, 5);
  if (!material) return;
  /* moderate are strains up to 1/16, whose b - I is twice as large */
  static const real sizes[] = {1e-20L, 1e-12L, 1e-7L, 1e-4L, 1e-2L, 2e-2L, 3e-2L, 4e-2L, 6e-2L, 0.1L, 0.2L};
  uint64_t state = 21;
  sample s;
  particle p[ITEMS];
  for (int k = 0; k < 11 * 3; ++k) {
    const real tolerance = k / 3 < 9 ? 1.5e-15L : 2e-14L; /* by series; by eigenvalues, of large stretches */
    const real strain = k % 3 == 1 ? 0 : sizes[k / 3], increment = k % 3 == 2 ? 0 : sizes[k / 3];
    sample_clear(&s, dt);
    s.batch.state_count = 2;
    for (int i = 0; i < ITEMS; ++i)
      set_particle(&s, dim, i, p[i] = random_particle(&state, dim, strain, increment));
    sample_evaluate(&s, material, dim);
    sample_check_untouched(&s, dim);
    for (int i = 0; i < ITEMS; ++i) {
      tensor f;
      for (int c = 0; c < 9; ++c) f.m[c / 3][c % 3] = s.F[c * LD + i];
      const real J = det(f);
      tensor e = exact_strain(p[i], J),
             exact = combine(bulk_modulus() * trace(e) / J, identity(), 2 * shear_modulus() / J, deviator(e));
      ck_assert(sample_error(&s, dim, i, exact) <= tolerance * (norm(p[i].g) + norm(p[i].stress)));
    }
  }
  law_material_free(material);
}
END_TEST

/* Moderate and large strains are found in two ways: which one a particle has does not depend on others, also
 * where one of these is no number. */
START_TEST(trials_stand_alone) {
  int32_t dim = loop_dim(_i);
  mpm_material *material = law_material(loop_isa(_i), "drucker_prager", params, 5);
  if (!material) return;
  static sample s[3]; /* of moderate strains; some large; and some that are none */
  uint64_t state = 22;
  for (int k = 0; k < 3; ++k) {
    sample_clear(&s[k], dt);
    s[k].batch.state_count = 2;
  }
  for (int i = 0; i < ITEMS; ++i) {
    const particle usual = random_particle(&state, dim, 1e-2L, 1e-3L);
    const particle large = random_particle(&state, dim, 0.3L, 1e-3L);
    for (int k = 0; k < 3; ++k) set_particle(&s[k], dim, i, k && sample_is_large(i) ? large : usual);
    if (sample_is_none(i)) s[2].stress[i] = (double)NAN;
  }
  samples_stand_alone(s, material, dim);
  law_material_free(material);
}
END_TEST

TCase *hencky_case(void) {
  TCase *tc = tcase_create("hencky");
  tcase_add_loop_test(tc, trial_strains, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, trials_stand_alone, 0, LAW_LOOPS);
  return tc;
}
