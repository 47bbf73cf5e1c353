/* Laws whose stress follows from F, on every instruction set and dimension: their formulas
 * in extended precision, the energy as potential of the stress, objectivity, and the wave
 * speed against the acoustic tensor. */
#include "law_sample.h"

/* In terms of h = F - I, as extended precision alone does not carry strains of 1e-12. */
static tensor strain(tensor f, real *log_j) {
  tensor h = combine(1, f, -1, identity());
  *log_j = log1pl(det_minus_1(h));
  return combine(1, combine(1, h, 1, transpose(h)), 1, multiply(h, transpose(h)));
}

/* ---- neo_hookean: Steffen et al. 2008, eq. 46 ---- */
static const mpm_param coupled_params[] = {{"E", 2.5e6}, {"nu", 0.3}, {"density", 1.2e3}};
static const real density = 1.2e3L, mu = 2.5e6L / (2 * (1 + (real)0.3));
static const real lambda = 2.5e6L / (1 + (real)0.3) * (real)0.3 / (1 - 2 * (real)0.3);

static tensor coupled_stress(tensor f) {
  real log_j, j = det(f);
  tensor e = strain(f, &log_j);
  return combine(lambda * log_j / j, identity(), mu / j, e);
}
static real coupled_energy(tensor f) {
  real log_j;
  tensor e = strain(f, &log_j);
  return lambda / 2 * log_j * log_j + mu * (trace(e) / 2 - log_j);
}

/* ---- neo_hookean_decoupled: Guilkey & Weiss 2003, eq. 20 ---- */
static const mpm_param decoupled_params[] = {{"mu", 1e6}, {"kappa", 2.5e6}, {"density", 1.2e3}};
static const real shear = 1e6L, kappa = 2.5e6L;

/* b_bar - I = J^(-2/3) e + (J^(-2/3) - 1) I */
static tensor shape(tensor f, real *log_j) {
  tensor e = strain(f, log_j);
  return combine(expl(-2 * *log_j / 3), e, expm1l(-2 * *log_j / 3), identity());
}
static tensor decoupled_stress(tensor f) {
  real log_j, j = det(f);
  tensor b = shape(f, &log_j);
  return combine((kappa * log_j - shear * trace(b) / 3) / j, identity(), shear / j, b);
}
static real decoupled_energy(tensor f) {
  real log_j;
  tensor b = shape(f, &log_j);
  return kappa / 2 * log_j * log_j + shear / 2 * trace(b);
}

/* ---- newtonian_fluid at rest: p = K/gamma (J^-gamma - 1) ---- */
static const mpm_param fluid_params[] = {{"bulk_modulus", 2.5e6}, {"density", 1.2e3}};
static const mpm_param gas_params[] = {{"bulk_modulus", 2.5e6}, {"density", 1.2e3}, {"gamma", 1.0}};
static const mpm_param spray_params[] = {{"bulk_modulus", 2.5e6}, {"density", 1.2e3}, {"tension", 0.0}};
static const real bulk = 2.5e6L;

static real log_of_volume(tensor f) {
  return log1pl(det_minus_1(combine(1, f, -1, identity())));
}
static tensor pressure(real p) {
  return combine(-p, identity(), 0, identity());
}
static tensor fluid_stress(tensor f) {
  return pressure(bulk / 7 * expm1l(-7 * log_of_volume(f)));
}
static real fluid_energy(tensor f) {
  real log_j = log_of_volume(f);
  return bulk / 7 * (expm1l(-6 * log_j) / 6 + expm1l(log_j));
}
static tensor gas_stress(tensor f) {
  return pressure(bulk * expm1l(-log_of_volume(f)));
}
static real gas_energy(tensor f) {
  real log_j = log_of_volume(f);
  return bulk * (expm1l(log_j) - log_j);
}
static tensor spray_stress(tensor f) {
  return log_of_volume(f) < 0 ? fluid_stress(f) : pressure(0);
}
static real spray_energy(tensor f) {
  return log_of_volume(f) < 0 ? fluid_energy(f) : 0;
}

/* ---- what the tests need of a law ---- */
typedef struct hyperelastic {
  const char *model;
  const mpm_param *params;
  int32_t count;
  real p_modulus; /* density c^2 at rest */
  real gamma;     /* the stiffness grows with J^-gamma */
  real floor;     /* the wave speed is never less than that of this modulus */
  tensor (*stress)(tensor f);
  real (*energy)(tensor f);
} hyperelastic;

enum { MODELS = 5 };
static const hyperelastic laws[MODELS] = {
    {"neo_hookean", coupled_params, 3, lambda + 2 * mu, 0, 0, coupled_stress, coupled_energy},
    {"neo_hookean_decoupled", decoupled_params, 3, kappa + 4 * shear / 3, 0, 0, decoupled_stress,
     decoupled_energy},
    {"newtonian_fluid", fluid_params, 2, bulk, 7, 0, fluid_stress, fluid_energy},
    {"newtonian_fluid", gas_params, 3, bulk, 1, 0, gas_stress, gas_energy},
    {"newtonian_fluid", spray_params, 3, bulk, 7, bulk, spray_stress, spray_energy},
};

static real stiffness(const hyperelastic *law, tensor f) {
  return law->p_modulus * fmaxl(1, powl(det(f), -law->gamma));
}

/* Loops over laws, instruction sets and dimensions. */
static const hyperelastic *loop_law(int loop) {
  return &laws[loop / LAW_LOOPS];
}
static mpm_material *loop_material(int loop) {
  const hyperelastic *law = loop_law(loop);
  return law_material(loop_isa(loop % LAW_LOOPS), law->model, law->params, law->count);
}

static tensor first_piola(const hyperelastic *law, tensor f) {
  return combine(det(f), multiply(law->stress(f), transpose(inverse(f))), 0, f);
}

/* Deformation gradients of item i with det > 0.2, at strains of about size. */
static tensor random_f(uint64_t *state, int32_t dim, real size) {
  for (;;) {
    tensor f = combine(1, identity(), 1, random_tensor(state, dim, size));
    if (dim == 2) f.m[2][2] += size * uniform(state); /* plane strain keeps what the host has set */
    for (int k = 0; k < 9; ++k) f.m[k / 3][k % 3] = (double)f.m[k / 3][k % 3];
    if (det(f) > 0.2L) return f;
  }
}

static tensor sample_f(const sample *s, int i) {
  tensor f;
  for (int c = 0; c < 9; ++c) f.m[c / 3][c % 3] = s->F[c * LD + i];
  return f;
}

START_TEST(formula) {
  int32_t dim = loop_dim(_i);
  const hyperelastic *law = loop_law(_i);
  mpm_material *material = loop_material(_i);
  if (!material) return;
  static const real sizes[] = {1e-12L, 1e-8L, 1e-4L, 1e-2L, 0.5L};
  uint64_t state = 1;
  sample s;
  for (int k = 0; k < 5; ++k) {
    sample_clear(&s, 0.5);
    for (int i = 0; i < ITEMS; ++i) sample_set(s.F, i, random_f(&state, dim, sizes[k]));
    sample_evaluate(&s, material, dim);
    sample_check_untouched(&s, dim);
    for (int i = 0; i < ITEMS; ++i) {
      /* Relative to the strain: small strains keep their digits. */
      tensor f = sample_f(&s, i);
      real scale = stiffness(law, f) * norm(combine(1, f, -1, identity()));
      ck_assert(sample_error(&s, dim, i, law->stress(f)) <= 1e-14L * scale);
      ck_assert(fabsl(s.energy[i] - law->energy(f)) <= 1e-15L * scale);
    }
  }
  law_material_free(material);
}
END_TEST

START_TEST(at_rest) {
  int32_t dim = loop_dim(_i);
  const hyperelastic *law = loop_law(_i);
  mpm_material *material = loop_material(_i);
  if (!material) return;
  sample s;
  sample_clear(&s, 0.5);
  sample_evaluate(&s, material, dim);
  for (int i = 0; i < ITEMS; ++i) {
    ck_assert(norm(sample_stress(&s, dim, i)) == 0);
    ck_assert(s.energy[i] == 0.0 && s.viscosity[i] == 0.0);
    ck_assert_double_eq_tol(s.wave_speed[i], (double)sqrtl(law->p_modulus / density), 1e-12);
  }
  law_material_free(material);
}
END_TEST

/* dW = J stress F^-T : dF, by differences of the law's own energy. */
START_TEST(energy_is_the_potential) {
  int32_t dim = loop_dim(_i);
  const hyperelastic *law = loop_law(_i);
  mpm_material *material = loop_material(_i);
  if (!material) return;
  const real h = 1e-5L;
  uint64_t state = 2;
  sample at, ahead, behind;
  tensor direction[ITEMS];
  sample_clear(&at, 0.5);
  sample_clear(&ahead, 0.5);
  sample_clear(&behind, 0.5);
  for (int i = 0; i < ITEMS; ++i) {
    tensor f = random_f(&state, dim, 0.4L);
    direction[i] = random_tensor(&state, dim, 1);
    sample_set(at.F, i, f);
    sample_set(ahead.F, i, combine(1, f, h, direction[i]));
    sample_set(behind.F, i, combine(1, f, -h, direction[i]));
  }
  sample_evaluate(&at, material, dim);
  sample_evaluate(&ahead, material, dim);
  sample_evaluate(&behind, material, dim);
  for (int i = 0; i < ITEMS; ++i) {
    tensor f = sample_f(&at, i), stress = sample_stress(&at, dim, i);
    real expected = det(f) * contract(multiply(stress, transpose(inverse(f))), direction[i]);
    real got = ((real)ahead.energy[i] - (real)behind.energy[i]) / (2 * h);
    ck_assert(fabsl(got - expected) <= 1e-7L * stiffness(law, f));
  }
  law_material_free(material);
}
END_TEST

START_TEST(objectivity) {
  int32_t dim = loop_dim(_i);
  const hyperelastic *law = loop_law(_i);
  mpm_material *material = loop_material(_i);
  if (!material) return;
  uint64_t state = 3;
  sample s, r;
  tensor q[ITEMS];
  sample_clear(&s, 0.5);
  sample_clear(&r, 0.5);
  for (int i = 0; i < ITEMS; ++i) {
    tensor f = random_f(&state, dim, 0.4L);
    q[i] = random_rotation(&state, dim);
    sample_set(s.F, i, f);
    sample_set(r.F, i, multiply(q[i], f));
  }
  sample_evaluate(&s, material, dim);
  sample_evaluate(&r, material, dim);
  for (int i = 0; i < ITEMS; ++i) {
    tensor expected = turned(q[i], sample_stress(&s, dim, i));
    ck_assert(sample_error(&r, dim, i, expected) <= 1e-13L * stiffness(law, sample_f(&s, i)));
    ck_assert_double_eq_tol(r.energy[i], s.energy[i], 1e-13 * (double)stiffness(law, sample_f(&s, i)));
  }
  law_material_free(material);
}
END_TEST

/* Largest density * c^2 over many directions n: eigenvalues of Q_ik = A_iJkL N_J N_L with A = dP/dF, N = F^T
 * n, from differences of the first Piola-Kirchhoff stress P. */
static real fastest_squared(const hyperelastic *law, tensor f, int32_t dim) {
  const real h = 1e-7L;
  real fastest = 0;
  uint64_t state = 4;
  for (int k = 0; k < 200; ++k) {
    real n[3] = {1, 0, 0}, length = 0;
    for (int a = 0; a < dim; ++a) n[a] = dim == 1 ? 1 : uniform(&state);
    for (int a = 0; a < dim; ++a) length += n[a] * n[a];
    tensor q = {{{0}}};
    for (int b = 0; b < dim; ++b) {
      tensor ahead = f, behind = f;
      real along[3];
      for (int c = 0; c < 3; ++c)
        along[c] = (n[0] * f.m[0][c] + n[1] * f.m[1][c] + n[2] * f.m[2][c]) / sqrtl(length);
      for (int c = 0; c < 3; ++c) ahead.m[b][c] += h * along[c];
      for (int c = 0; c < 3; ++c) behind.m[b][c] -= h * along[c];
      tensor d = combine(1 / (2 * h), first_piola(law, ahead), -1 / (2 * h), first_piola(law, behind));
      for (int a = 0; a < dim; ++a)
        q.m[a][b] = d.m[a][0] * along[0] + d.m[a][1] * along[1] + d.m[a][2] * along[2];
    }
    tensor symmetric = combine(0.5L, q, 0.5L, transpose(q));
    diagonalise(&symmetric);
    for (int a = 0; a < 3; ++a)
      if (symmetric.m[a][a] > fastest) fastest = symmetric.m[a][a];
  }
  return fastest;
}

START_TEST(wave_speed) {
  int32_t dim = loop_dim(_i);
  const hyperelastic *law = loop_law(_i);
  mpm_material *material = loop_material(_i);
  if (!material) return;
  uint64_t state = 5;
  sample s;
  sample_clear(&s, 0.5);
  for (int i = 0; i < ITEMS; ++i) sample_set(s.F, i, random_f(&state, dim, i < 20 ? 0.2L : 0.6L));
  for (int c = 0; c < 27; ++c) s.F[c % 9 * LD + 20 + c / 9] = c % 9 % 4 == 0;
  s.F[21] = 12.0; /* transverse waves are the fastest here */
  s.F[22] = 0.3;
  sample_evaluate(&s, material, dim);
  for (int i = 0; i < ITEMS; ++i) {
    real exact = sqrtl(fastest_squared(law, sample_f(&s, i), dim) / density);
    real floor = sqrtl(law->floor / density), rest = sqrtl(law->p_modulus / density);
    ck_assert(s.wave_speed[i] >= fmaxl(exact, floor) * (1 - 1e-8L) - 1e-8L * rest);
    if (i < 20) ck_assert(s.wave_speed[i] <= 1.2L * fmaxl(exact, floor));
    if (law->gamma > 0 && i < 20)
      ck_assert(fabsl(s.wave_speed[i] - fmaxl(exact, floor)) <= 1e-7L * exact + 1e-12L * rest);
  }
  law_material_free(material);
}
END_TEST

/* A compressed auxetic softens until its waves stand still;
 * the reported speed keeps the time step in bounds. */
START_TEST(wave_speed_has_a_floor) {
  int32_t dim = loop_dim(_i);
  const mpm_param auxetic[] = {{"E", 2.5e6}, {"nu", -0.5}, {"density", 1.2e3}};
  mpm_material *material = law_material(loop_isa(_i), "neo_hookean", auxetic, 3);
  if (!material) return;
  sample s;
  sample_clear(&s, 0.5);
  for (int i = 0; i < ITEMS; ++i)
    for (int k = 0; k < dim; ++k) s.F[4 * k * LD + i] = 0.1 + 0.02 * i;
  sample_evaluate(&s, material, dim);
  const double slowest = sqrt(2.5e6 / (2 * 0.5) / 1.2e3);
  for (int i = 0; i < ITEMS; ++i) ck_assert(s.wave_speed[i] >= slowest * (1 - 1e-14));
  law_material_free(material);
}
END_TEST

/* The time step of a particle that is about to be refused must not be a trap. */
START_TEST(inverted_items_do_not_trap) {
  int32_t dim = loop_dim(_i);
  mpm_material *material = loop_material(_i);
  if (!material) return;
  sample s, good;
  sample_clear(&s, 0.5);
  sample_clear(&good, 0.5);
  for (int i = 0; i < ITEMS; i += 2) s.F[i] = i % 4 ? -0.5 : 0.0;
  sample_evaluate(&s, material, dim);
  sample_evaluate(&good, material, dim);
  for (int i = 1; i < ITEMS; i += 2) ck_assert(sample_error(&s, dim, i, sample_stress(&good, dim, i)) == 0);
  law_material_free(material);
}
END_TEST

TCase *hyperelastic_case(void) {
  TCase *tc = tcase_create("hyperelastic");
  tcase_set_timeout(tc, 60);
  tcase_add_loop_test(tc, formula, 0, MODELS * LAW_LOOPS);
  tcase_add_loop_test(tc, at_rest, 0, MODELS * LAW_LOOPS);
  tcase_add_loop_test(tc, energy_is_the_potential, 0, MODELS * LAW_LOOPS);
  tcase_add_loop_test(tc, objectivity, 0, MODELS * LAW_LOOPS);
  tcase_add_loop_test(tc, wave_speed, 0, MODELS * LAW_LOOPS);
  tcase_add_loop_test(tc, wave_speed_has_a_floor, 0, LAW_LOOPS);
  tcase_add_loop_test(tc, inverted_items_do_not_trap, 0, MODELS * LAW_LOOPS);
  return tc;
}
