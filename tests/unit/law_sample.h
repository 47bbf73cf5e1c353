/* For tests of constitutive laws: 3x3 algebra in extended precision, and a batch with its arrays. Sizes
 * differ from the leading dimension, and everything that a law must not read is NaN. */
#ifndef LAW_SAMPLE_H
#define LAW_SAMPLE_H

#include <float.h>

#include "material/laws.h"
#include "material/material.h"
#include "world.h"

/* Exact values are meant to be of higher precision than what they are compared with. */
#if defined(__clang__)
#pragma clang diagnostic ignored "-Wdouble-promotion"
#endif

typedef long double real;
typedef struct {
  real m[3][3];
} tensor;

enum { ITEMS = 32, LD = 48, STATES = 8 };

static const double sample_unset = 7.25e77;
static const int32_t sym_row[6] = {0, 1, 2, 0, 1, 0}, sym_column[6] = {0, 1, 2, 1, 2, 2};

static inline tensor identity(void) {
  tensor t = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  return t;
}
static inline tensor combine(real a, tensor x, real b, tensor y) {
  tensor t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t.m[i][j] = a * x.m[i][j] + b * y.m[i][j];
  return t;
}
static inline tensor multiply(tensor x, tensor y) {
  tensor t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      t.m[i][j] = x.m[i][0] * y.m[0][j] + x.m[i][1] * y.m[1][j] + x.m[i][2] * y.m[2][j];
  return t;
}
static inline tensor transpose(tensor x) {
  tensor t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t.m[i][j] = x.m[j][i];
  return t;
}
static inline real trace(tensor x) {
  return x.m[0][0] + x.m[1][1] + x.m[2][2];
}
static inline real contract(tensor x, tensor y) {
  return trace(multiply(x, transpose(y)));
}
static inline real norm(tensor x) {
  return sqrtl(contract(x, x));
}
static inline tensor cofactor(tensor x) {
  tensor t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
      t.m[i][j] = x.m[a][c] * x.m[b][d] - x.m[a][d] * x.m[b][c];
    }
  return t;
}
static inline real det(tensor x) {
  return contract(x, cofactor(x)) / 3;
}
/* det(I + h) - 1 with the digits of a small h. */
static inline real det_minus_1(tensor h) {
  real t = trace(h);
  return t + (t * t - trace(multiply(h, h))) / 2 + det(h);
}
static inline tensor inverse(tensor x) {
  tensor c = transpose(cofactor(x));
  return combine(1 / det(x), c, 0, c);
}
/* Q x Q^T */
static inline tensor turned(tensor q, tensor x) {
  return multiply(q, multiply(x, transpose(q)));
}

/* Eigenvalues (on the diagonal of *x afterwards) and eigenvectors (columns) by
 * Jacobi rotations until done. */
static inline tensor diagonalise(tensor *x) {
  tensor q = identity();
  for (int sweep = 0; sweep < 30; ++sweep)
    for (int p = 0; p < 2; ++p)
      for (int r = p + 1; r < 3; ++r) {
        if (x->m[p][r] == 0) continue;
        real theta = (x->m[r][r] - x->m[p][p]) / (2 * x->m[p][r]);
        real t = (theta < 0 ? -1 : 1) / (fabsl(theta) + sqrtl(1 + theta * theta)), c = 1 / sqrtl(1 + t * t);
        tensor g = identity();
        g.m[p][p] = g.m[r][r] = c;
        g.m[p][r] = t * c;
        g.m[r][p] = -t * c;
        *x = multiply(transpose(g), multiply(*x, g));
        q = multiply(q, g);
      }
  return q;
}

/* F_inc = V R: gives R and ln V; g = F_inc - I. */
static inline tensor polar_log(tensor g, tensor *rotation) {
  tensor f = combine(1, identity(), 1, g),
         e = combine(1, combine(1, g, 1, transpose(g)), 1, multiply(g, transpose(g)));
  tensor q = diagonalise(&e), log_v = {{{0}}}, v_inverse = {{{0}}};
  for (int k = 0; k < 3; ++k) {
    log_v.m[k][k] = log1pl(e.m[k][k]) / 2;
    v_inverse.m[k][k] = 1 / sqrtl(1 + e.m[k][k]);
  }
  *rotation = multiply(turned(q, v_inverse), f);
  return turned(q, log_v);
}

/* ---- pseudo-random tensors ---- */
static inline real uniform(uint64_t *state) { /* in [-1, 1), repeatable everywhere */
  *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (real)(int64_t)(*state >> 11) / (real)(INT64_C(1) << 52) - 1;
}
static inline tensor random_tensor(uint64_t *state, int32_t dim, real size) {
  tensor t = {{{0}}};
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) t.m[i][j] = (double)(size * uniform(state));
  return t;
}
static inline tensor random_rotation(uint64_t *state, int32_t dim) {
  real q[4] = {0}, length = 0;
  for (int k = 0; k < 4; ++k)
    if (dim == 3 || (dim == 2 && k != 1 && k != 2)) q[k] = uniform(state);
  if (dim == 1) q[0] = 1;
  for (int k = 0; k < 4; ++k) length += q[k] * q[k];
  real w = q[0], x = q[1], y = q[2], z = q[3], s = 2 / length;
  tensor r = {{{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
               {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
               {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}}};
  return r;
}
/* A symmetric tensor with the components that a stress has in dim. */
static inline tensor random_stress(uint64_t *state, int32_t dim, real size) {
  tensor t = random_tensor(state, dim, size);
  for (int i = dim; i < 3; ++i) t.m[i][i] = (double)(size * uniform(state));
  return combine(0.5L, t, 0.5L, transpose(t));
}

/* ---- a batch ---- */
typedef struct sample {
  _Alignas(64) double F[9 * LD], F_inc[9 * LD], L[9 * LD], stress[6 * LD];
  _Alignas(64) double state[STATES * LD], state_new[STATES * LD];
  double stress_new[6 * LD], wave_speed[LD], viscosity[LD], energy[LD];
  int64_t id[LD];
  mpm_material_batch batch;
} sample;

static inline int32_t stress_exists(int32_t dim, int c) {
  return c < 3 || (c == 3 && dim >= 2) || dim == 3;
}

static inline void sample_clear(sample *s, double dt) {
  double *inputs[] = {s->F, s->F_inc, s->L}, *outputs[] = {s->wave_speed, s->energy};
  for (int i = 0; i < LD; ++i) {
    for (int a = 0; a < 3; ++a)
      for (int c = 0; c < 9; ++c) inputs[a][c * LD + i] = i < ITEMS ? (c % 4 == 0 && a < 2) : (double)NAN;
    for (int c = 0; c < 6; ++c) s->stress[c * LD + i] = (double)NAN;
    for (int c = 0; c < 6; ++c) s->stress_new[c * LD + i] = sample_unset;
    for (int a = 0; a < 2; ++a) outputs[a][i] = sample_unset;
    for (int c = 0; c < STATES; ++c) {
      s->state_new[c * LD + i] = sample_unset;
      s->state[c * LD + i] = i < ITEMS ? 0.0 : (double)NAN;
    }
    s->viscosity[i] = 0.0;
    s->id[i] = i;
  }
  s->batch = (mpm_material_batch){.struct_size = sizeof s->batch,
                                  .state_count = 1,
                                  .n = ITEMS,
                                  .ld = LD,
                                  .dt = dt,
                                  .id = s->id,
                                  .F = s->F,
                                  .F_inc = s->F_inc,
                                  .L = s->L,
                                  .stress = s->stress,
                                  .state = s->state,
                                  .stress_new = s->stress_new,
                                  .state_new = s->state_new,
                                  .wave_speed = s->wave_speed,
                                  .kinematic_viscosity = s->viscosity,
                                  .energy = s->energy};
}

static inline void sample_set(double *rows, int i, tensor t) {
  for (int c = 0; c < 9; ++c) rows[c * LD + i] = (double)t.m[c / 3][c % 3];
}
/* An increment g = F_inc - I of a particle whose deformation gradient becomes f. */
static inline void sample_set_increment(sample *s, int i, tensor g, tensor f) {
  sample_set(s->F_inc, i, combine(1, identity(), 1, g));
  sample_set(s->L, i, combine(1 / (real)s->batch.dt, g, 0, g));
  sample_set(s->F, i, f);
}
static inline void sample_set_stress(sample *s, int32_t dim, int i, tensor t) {
  for (int c = 0; c < 6; ++c)
    if (stress_exists(dim, c)) s->stress[c * LD + i] = (double)t.m[sym_row[c]][sym_column[c]];
}
static inline tensor sample_stress(const sample *s, int32_t dim, int i) {
  tensor t = {{{0}}};
  for (int c = 0; c < 6; ++c)
    if (stress_exists(dim, c))
      t.m[sym_row[c]][sym_column[c]] = t.m[sym_column[c]][sym_row[c]] = s->stress_new[c * LD + i];
  return t;
}

/* Largest difference of a stress to the exact one. */
static inline real sample_error(const sample *s, int32_t dim, int i, tensor exact) {
  real error = 0;
  tensor got = sample_stress(s, dim, i);
  for (int c = 0; c < 6; ++c) {
    if (!stress_exists(dim, c)) continue;
    real off = fabsl(got.m[sym_row[c]][sym_column[c]] - exact.m[sym_row[c]][sym_column[c]]);
    error = off <= error ? error : off; /* keeps a NaN */
  }
  return error;
}
/* Rows that do not exist in dim and items past the end are not written. */
static inline void sample_check_untouched(const sample *s, int32_t dim) {
  for (int i = 0; i < LD; ++i)
    for (int c = 0; c < 6; ++c)
      if (i >= ITEMS || !stress_exists(dim, c)) ck_assert(s->stress_new[c * LD + i] == sample_unset);
  for (int i = ITEMS; i < LD; ++i)
    ck_assert(s->state_new[i] == sample_unset && s->wave_speed[i] == sample_unset &&
              s->energy[i] == sample_unset);
}

/* Built-in laws give the squares of wave speeds, and in their place what they refuse. */
static inline void sample_evaluate(sample *s, const mpm_material *material, int32_t dim) {
  ck_ok(material->context, mpmi_material_evaluate(material, dim, &s->batch));
  for (int i = 0; material->law && i < ITEMS; ++i)
    if (s->wave_speed[i] >= 0.0) s->wave_speed[i] = sqrt(s->wave_speed[i]);
}

/* Which items of a chunk are large in two of three samples, and which no numbers in the last one: a large one
 * beside one that is none, and two of these in one register. */
static inline int32_t sample_is_large(int i) {
  return i % 16 == 9;
}
static inline int32_t sample_is_none(int i) {
  return i % 16 < 2 || i % 16 == 8;
}
/* Evaluates samples that differ in such items: all others have the same bits in each of them. */
static inline void samples_stand_alone(sample *s, const mpm_material *material, int32_t dim) {
  for (int k = 0; k < 3; ++k) sample_evaluate(&s[k], material, dim);
  for (int i = 0; i < ITEMS; ++i)
    for (int c = 0; c < 6; ++c) {
      if (!stress_exists(dim, c) || sample_is_none(i)) continue;
      const int at = c * LD + i;
      ck_assert_mem_eq(&s[2].stress_new[at], &s[1].stress_new[at], sizeof(double));
      if (!sample_is_large(i)) ck_assert_mem_eq(&s[1].stress_new[at], &s[0].stress_new[at], sizeof(double));
    }
}

/* Loop tests run over instruction sets and dimensions. */
enum { LAW_LOOPS = 12 };
static inline int32_t loop_isa(int loop) {
  return MPM_ISA_BASELINE + loop / 3;
}
static inline int32_t loop_dim(int loop) {
  return 1 + loop % 3;
}

/* A material in a context of its own; NULL where the processor lacks the instruction set. */
static inline mpm_material *law_material(int32_t isa, const char *model, const mpm_param *params,
                                         int32_t count) {
  mpm_context *context = context_with(1, isa, NULL);
  mpm_material *material;
  if (!context) return NULL;
  ck_ok(context, mpm_material_create(context, model, params, count, &material));
  return material;
}
static inline void law_material_free(mpm_material *material) {
  mpm_context *context = material->context;
  ck_ok(context, mpm_material_destroy(material));
  ck_ok(context, mpm_context_destroy(context));
}

TCase *custom_material_case(void);
TCase *hyperelastic_case(void);
TCase *fluid_case(void);
TCase *hypoelastic_case(void);
TCase *hencky_case(void);
TCase *j2_case(void);

#endif
