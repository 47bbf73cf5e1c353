/* For tests of tangents: particles in states of all kinds, and the derivative of their stress by differences
 * of sixth order. */
#ifndef TANGENT_SAMPLE_H
#define TANGENT_SAMPLE_H

#include "law_sample.h"

typedef struct tangent_law {
  const char *model;
  int32_t count, symmetric; /* by algebra, in 2-D and 3-D */
  mpm_param params[5];
} tangent_law;

/* Yield and old stresses that make both regimes of j2 common; the shear modulus of j2 is 1e6. */
static const double tangent_dt = 0.25, tangent_yield = 4e4, tangent_mu = 1e6;

/* A batch, what it was made of, and its tangent. */
typedef struct tangent_batch {
  sample s;
  tensor F_old[ITEMS], g[ITEMS]; /* F_inc = I + g */
  _Alignas(64) double c[81 * LD];
  int32_t symmetric;
} tangent_batch;

static inline int tangent_row(int i, int j, int k, int l) {
  return 9 * (3 * i + j) + 3 * k + l;
}

static inline tensor tangent_diagonal(real x, real y, real z) {
  tensor t = {{{x, 0, 0}, {0, y, 0}, {0, 0, z}}};
  return t;
}
/* In the axes that dim has. */
static inline tensor tangent_stretches(int32_t dim, real x, real y, real z) {
  return tangent_diagonal(x, dim > 1 ? y : 0, dim > 2 ? z : 0);
}

/* Increments of 20 %, 2 % and 1e-9; none; turns by any angle;
 * equal and nearly equal stretches; one stretch alone. */
static inline tensor tangent_increment(uint64_t *state, int32_t dim, int i) {
  const real a = 0.2L * uniform(state), b = 0.2L * uniform(state);
  const tensor q = random_rotation(state, dim), any = random_tensor(state, dim, 0.2L);
  switch (i % 10) {
  case 2:
    return combine(0.1L, any, 0, any);
  case 3:
    return combine(5e-9L, any, 0, any);
  case 4:
    return combine(0, any, 0, any);
  case 5:
    return combine(1, q, -1, identity());
  case 6:
    return turned(q, tangent_stretches(dim, a, a, b));
  case 7:
    return tangent_stretches(dim, a, a, a);
  case 8:
    return tangent_stretches(dim, a, 0, 0);
  case 9:
    return turned(q, tangent_stretches(dim, a, a * (1 + 1e-8L), a * (1 - 1e-5L)));
  default:
    return any;
  }
}

static inline tensor tangent_deformation(uint64_t *state, int32_t dim) {
  real stretch[3];
  for (int k = 0; k < 3; ++k) stretch[k] = 1.1L + 0.5L * uniform(state);
  tensor f = tangent_stretches(dim, stretch[0], stretch[1], stretch[2]);
  f = multiply(random_rotation(state, dim), multiply(f, random_rotation(state, dim)));
  for (int k = dim; k < 3; ++k) f.m[k][k] = dim == 2 && stretch[2] > 1 ? stretch[2] : 1; /* of plane strain */
  return f;
}

static inline void tangent_fill(tangent_batch *b, uint64_t *state, int32_t dim) {
  sample_clear(&b->s, tangent_dt);
  for (int i = 0; i < ITEMS; ++i) {
    b->F_old[i] = tangent_deformation(state, dim);
    b->g[i] = tangent_increment(state, dim, i);
    sample_set_increment(&b->s, i, b->g[i], multiply(combine(1, identity(), 1, b->g[i]), b->F_old[i]));
    sample_set_stress(&b->s, dim, i, random_stress(state, dim, i % 3 ? 5e4L : 2e4L));
    b->s.state[i] = i % 2 ? 1e-2 * i : 0.0;
  }
}

/* Law, then tangent, into a buffer whose rows and items of no concern stay as they are. */
static inline void tangent_run(tangent_batch *b, const mpm_material *material, int32_t isa, int32_t dim) {
  sample_evaluate(&b->s, material, dim);
  for (int k = 0; k < 81 * LD; ++k) b->c[k] = sample_unset;
  b->symmetric = 1;
  ck_assert_uint_eq(mpmi_material_tangent_scratch(material, LD), 0);
  ck_ok(material->context, mpmi_material_tangent(material, isa, dim, &b->s.batch, NULL, b->c, &b->symmetric));
}

/* ---- the derivative by differences ---- */
static inline tensor sample_F(const sample *s, int i) {
  tensor f;
  for (int c = 0; c < 9; ++c) f.m[c / 3][c % 3] = s->F[c * LD + i];
  return f;
}
static inline tensor sample_tau(const sample *s, int32_t dim, int i) {
  tensor t = sample_stress(s, dim, i);
  return combine(det(sample_F(s, i)), t, 0, t);
}

/* Adds weight * tau of all items with L_kl = e to slope. */
static inline void tangent_add_tau(const tangent_batch *b, const mpm_material *material, int32_t dim, int k,
                                   int l, real e, real weight, tensor *slope) {
  static sample s;
  s = b->s;
  s.batch.F = s.F, s.batch.F_inc = s.F_inc, s.batch.L = s.L, s.batch.stress = s.stress,
  s.batch.state = s.state;
  s.batch.stress_new = s.stress_new, s.batch.state_new = s.state_new, s.batch.wave_speed = s.wave_speed;
  s.batch.kinematic_viscosity = s.viscosity, s.batch.energy = s.energy;
  for (int i = 0; i < ITEMS; ++i) {
    tensor f = combine(1, identity(), 1, b->g[i]), g = b->g[i];
    for (int c = 0; c < 3; ++c) {
      g.m[k][c] += e * f.m[l][c];
      f.m[k][c] += e * (c == l ? 1 + b->g[i].m[l][c] : b->g[i].m[l][c]);
    }
    sample_set_increment(&s, i, g, multiply(f, b->F_old[i]));
  }
  sample_evaluate(&s, material, dim);
  for (int i = 0; i < ITEMS; ++i) slope[i] = combine(1, slope[i], weight, sample_tau(&s, dim, i));
}

static const real tangent_reach = 3 / 4096.0L; /* of the differences */

/* c[item][row] of the definition. */
static inline void tangent_by_differences(const tangent_batch *b, const mpm_material *material, int32_t dim,
                                          real (*c)[81]) {
  static const real weights[] = {45 / 60.0L, -9 / 60.0L, 1 / 60.0L};
  const real h = tangent_reach / 3;
  for (int k = 0; k < dim; ++k)
    for (int l = 0; l < dim; ++l) {
      tensor slope[ITEMS];
      memset(slope, 0, sizeof slope);
      for (int n = 1; n <= 3; ++n) {
        tangent_add_tau(b, material, dim, k, l, n * h, weights[n - 1] / h, slope);
        tangent_add_tau(b, material, dim, k, l, -n * h, -weights[n - 1] / h, slope);
      }
      for (int p = 0; p < ITEMS; ++p) {
        tensor tau = sample_tau(&b->s, dim, p);
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j)
            c[p][tangent_row(i, j, k, l)] =
                slope[p].m[i][j] - (i == k) * tau.m[j][l] - (j == k) * tau.m[i][l];
      }
    }
}

/* Largest difference of item p to c, over the largest entry of c; asymmetry: that of c_ijkl - c_klij. */
static inline real tangent_error(const tangent_batch *b, int32_t dim, int p, const real *c, real *asymmetry) {
  real error = 0, scale = 0, odd = 0;
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l) {
          const real got = b->c[tangent_row(i, j, k, l) * LD + p];
          const real off = fabsl(got - c[tangent_row(i, j, k, l)]);
          error = off <= error ? error : off; /* keeps a NaN */
          odd = fmaxl(odd, fabsl(got - b->c[tangent_row(k, l, i, j) * LD + p]));
          scale = fmaxl(scale, fabsl(c[tangent_row(i, j, k, l)]));
        }
  *asymmetry = scale > 0 ? odd / scale : odd;
  return scale > 0 ? error / scale : error;
}

/* ---- states where the stress has a kink ---- */
/* Von Mises trial stress of j2 above the yield stress. */
static inline real tangent_over_yield(const tangent_batch *b, int32_t dim, int i, real hardening) {
  tensor old = {{{0}}}, r, log_v = polar_log(b->g[i], &r);
  for (int c = 0; c < 6; ++c)
    if (stress_exists(dim, c))
      old.m[sym_row[c]][sym_column[c]] = old.m[sym_column[c]][sym_row[c]] = b->s.stress[c * LD + i];
  tensor trial = combine(1, turned(r, old), 2 * tangent_mu, log_v);
  tensor d = combine(1, trial, -trace(trial) / 3, identity());
  return sqrtl(1.5L * contract(d, d)) - (tangent_yield + hardening * b->s.state[i]);
}

TCase *tangent_limits_case(void);
TCase *tangent_host_case(void);

#endif
