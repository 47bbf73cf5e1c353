/* Tensors of one particle: matrices by rows, symmetric ones xx yy zz xy yz xz. */
#ifndef MPMU_TENSOR_H
#define MPMU_TENSOR_H

#include <stdint.h>

typedef struct mpmu_mat {
  double m[3][3];
} mpmu_mat;
typedef struct mpmu_sym {
  double xx, yy, zz, xy, yz, xz;
} mpmu_sym;

static inline mpmu_mat mpmu_load_mat(const double *rows, int64_t ld, int64_t i) {
  mpmu_mat a;
  for (int k = 0; k < 9; ++k) a.m[k / 3][k % 3] = rows[k * ld + i];
  return a;
}

static inline mpmu_sym mpmu_load_sym(const double *rows, int64_t ld, int64_t i) {
  const mpmu_sym s = {rows[i],          rows[ld + i],     rows[2 * ld + i],
                      rows[3 * ld + i], rows[4 * ld + i], rows[5 * ld + i]};
  return s;
}

static inline void mpmu_store_sym(double *rows, int64_t ld, int64_t i, mpmu_sym s) {
  rows[i] = s.xx, rows[ld + i] = s.yy, rows[2 * ld + i] = s.zz;
  rows[3 * ld + i] = s.xy, rows[4 * ld + i] = s.yz, rows[5 * ld + i] = s.xz;
}

static inline mpmu_mat mpmu_product(const mpmu_mat *a, const mpmu_mat *b) {
  mpmu_mat c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      c.m[i][j] = a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j];
  return c;
}

static inline mpmu_mat mpmu_transposed(const mpmu_mat *a) {
  mpmu_mat t;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) t.m[i][j] = a->m[j][i];
  return t;
}

/* The cofactors: det(a) a^-T. */
static inline mpmu_mat mpmu_cofactors(const mpmu_mat *a) {
  mpmu_mat c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int p = (i + 1) % 3, q = (i + 2) % 3, r = (j + 1) % 3, s = (j + 2) % 3;
      c.m[i][j] = a->m[p][r] * a->m[q][s] - a->m[p][s] * a->m[q][r];
    }
  return c;
}

static inline double mpmu_determinant(const mpmu_mat *a) {
  const mpmu_mat c = mpmu_cofactors(a);
  return a->m[0][0] * c.m[0][0] + a->m[0][1] * c.m[0][1] + a->m[0][2] * c.m[0][2];
}

/* r s r^T */
static inline mpmu_sym mpmu_turned(const mpmu_mat *r, mpmu_sym s) {
  const mpmu_mat full = {{{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}};
  const mpmu_mat a = mpmu_product(r, &full), back = mpmu_transposed(r), t = mpmu_product(&a, &back);
  const mpmu_sym turned = {t.m[0][0], t.m[1][1], t.m[2][2], t.m[0][1], t.m[1][2], t.m[0][2]};
  return turned;
}

/* The product of two symmetric tensors that commute, which is symmetric. */
static inline mpmu_sym mpmu_commuting_product(mpmu_sym a, mpmu_sym b) {
  const mpmu_sym c = {a.xx * b.xx + a.xy * b.xy + a.xz * b.xz, a.xy * b.xy + a.yy * b.yy + a.yz * b.yz,
                      a.xz * b.xz + a.yz * b.yz + a.zz * b.zz, a.xx * b.xy + a.xy * b.yy + a.xz * b.yz,
                      a.xy * b.xz + a.yy * b.yz + a.yz * b.zz, a.xx * b.xz + a.xy * b.yz + a.xz * b.zz};
  return c;
}

/* Adds a multiple. */
static inline mpmu_sym mpmu_add(mpmu_sym a, double by, mpmu_sym b) {
  const mpmu_sym c = {a.xx + by * b.xx, a.yy + by * b.yy, a.zz + by * b.zz,
                      a.xy + by * b.xy, a.yz + by * b.yz, a.xz + by * b.xz};
  return c;
}

/* F = V R with the rotation R; V is the left stretch. */
typedef struct mpmu_polar {
  mpmu_mat R;
  mpmu_sym V;
} mpmu_polar;
mpmu_polar mpmu_polar_of(const mpmu_mat *F);

/* ln V for the V of F = I + G = V R, with the digits of a small G. */
mpmu_sym mpmu_log_stretch(const mpmu_mat *G, mpmu_sym V);

#endif
