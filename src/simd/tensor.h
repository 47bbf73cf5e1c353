/* Rows of component arrays as small tensors, by dimension: 1-D is uniaxial strain, 2-D plane strain, so that
 * the components that do not exist are those of the identity (F) or zero (shear stress) and cost nothing. */
#ifndef MPMI_TENSOR_H
#define MPMI_TENSOR_H

#include <stdint.h>

#include "simd/isa.h"

typedef struct mpmi_sym {
  double xx, yy, zz, xy, yz, xz;
} mpmi_sym;

typedef struct mpmi_mat {
  double xx, xy, xz, yx, yy, yz, zx, zy, zz;
} mpmi_mat;

/* Which of xx yy zz xy yz xz holds component (i, j): the order in which symmetric tensors are stored. */
MPMI_INLINE int32_t mpmi_sym_index(int32_t i, int32_t j) {
  return i == j ? i : i + j == 1 ? 3 : i + j == 3 ? 4 : 5;
}

/* How many of them exist: xx yy zz, and the shear components that `dim` has. */
MPMI_INLINE int32_t mpmi_stress_components(int dim) {
  return dim == 1 ? 3 : dim == 2 ? 4 : 6;
}

/* scale * (A - shift I), with zeros where `dim` has no component. */
MPMI_INLINE mpmi_mat mpmi_load_mat(int dim, const double *a, int64_t ld, int64_t i, double shift,
                                   double scale) {
  mpmi_mat m = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  m.xx = scale * (a[i] - shift);
  if (dim >= 2) {
    m.xy = scale * a[1 * ld + i];
    m.yx = scale * a[3 * ld + i];
    m.yy = scale * (a[4 * ld + i] - shift);
  }
  if (dim == 3) {
    m.xz = scale * a[2 * ld + i];
    m.yz = scale * a[5 * ld + i];
    m.zx = scale * a[6 * ld + i];
    m.zy = scale * a[7 * ld + i];
    m.zz = scale * (a[8 * ld + i] - shift);
  }
  return m;
}

/* F - I, with the zz that a plane strain F keeps. */
MPMI_INLINE mpmi_mat mpmi_load_F_minus_1(int dim, const double *F, int64_t ld, int64_t i) {
  mpmi_mat h = mpmi_load_mat(dim, F, ld, i, 1.0, 1.0);
  if (dim == 2) h.zz = F[8 * ld + i] - 1.0;
  return h;
}

/* The same in 2-D from the rows that a set stores: xx xy yx yy zz. */
MPMI_INLINE mpmi_mat mpmi_load_stored_F_minus_1(const double *F, int64_t ld, int64_t i) {
  mpmi_mat h = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  h.xx = F[i] - 1.0;
  h.xy = F[ld + i];
  h.yx = F[2 * ld + i];
  h.yy = F[3 * ld + i] - 1.0;
  h.zz = F[4 * ld + i] - 1.0;
  return h;
}

MPMI_INLINE mpmi_sym mpmi_load_sym(int dim, const double *a, int64_t ld, int64_t i) {
  mpmi_sym s = {a[i], a[ld + i], a[2 * ld + i], 0.0, 0.0, 0.0};
  if (dim >= 2) s.xy = a[3 * ld + i];
  if (dim == 3) {
    s.yz = a[4 * ld + i];
    s.xz = a[5 * ld + i];
  }
  return s;
}

MPMI_INLINE void mpmi_store_sym(int dim, double *a, int64_t ld, int64_t i, mpmi_sym s) {
  a[i] = s.xx;
  a[ld + i] = s.yy;
  a[2 * ld + i] = s.zz;
  if (dim >= 2) a[3 * ld + i] = s.xy;
  if (dim == 3) {
    a[4 * ld + i] = s.yz;
    a[5 * ld + i] = s.xz;
  }
}

/* Returns f a + c I. */
MPMI_INLINE mpmi_sym mpmi_shifted(double f, mpmi_sym a, double c) {
  mpmi_sym s = {c + f * a.xx, c + f * a.yy, c + f * a.zz, f * a.xy, f * a.yz, f * a.xz};
  return s;
}

/* det(I + H) - 1 within the plane in 2-D, without losing the digits of a small H: expanded along the first
 * row, with the ones of the diagonal taken out by hand. */
MPMI_INLINE double mpmi_det_minus_1(int dim, mpmi_mat h) {
  if (dim == 1) return h.xx;
  if (dim == 2) return (h.xx + h.yy) + h.xx * h.yy - h.xy * h.yx;
  double minor_x = (h.yy + h.zz) + h.yy * h.zz - h.yz * h.zy; /* minus 1 */
  double minor_y = h.yx + h.yx * h.zz - h.yz * h.zx;
  double minor_z = h.yx * h.zy - h.yy * h.zx - h.zx;
  return (h.xx + minor_x) + h.xx * minor_x - h.xy * minor_y + h.xz * minor_z;
}

/* det F - 1 for H of mpmi_load_F_minus_1. */
MPMI_INLINE double mpmi_J_minus_1(int dim, mpmi_mat h) {
  double d = mpmi_det_minus_1(dim, h);
  return dim == 2 ? (d + h.zz) + d * h.zz : d;
}

/* F F^T - I = H + H^T + H H^T with H = F - I, each a sum and a chain of multiply-adds. */
MPMI_INLINE mpmi_sym mpmi_left_cauchy_green_minus_1(int dim, mpmi_mat h) {
  mpmi_sym e = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  if (dim == 1) {
    e.xx = 2.0 * h.xx + h.xx * h.xx;
  } else if (dim == 2) {
    e.xx = 2.0 * h.xx + h.xx * h.xx + h.xy * h.xy;
    e.yy = 2.0 * h.yy + h.yx * h.yx + h.yy * h.yy;
    e.zz = 2.0 * h.zz + h.zz * h.zz;
    e.xy = (h.xy + h.yx) + h.xx * h.yx + h.xy * h.yy;
  } else {
    e.xx = 2.0 * h.xx + h.xx * h.xx + h.xy * h.xy + h.xz * h.xz;
    e.yy = 2.0 * h.yy + h.yx * h.yx + h.yy * h.yy + h.yz * h.yz;
    e.zz = 2.0 * h.zz + h.zx * h.zx + h.zy * h.zy + h.zz * h.zz;
    e.xy = (h.xy + h.yx) + h.xx * h.yx + h.xy * h.yy + h.xz * h.yz;
    e.yz = (h.yz + h.zy) + h.yx * h.zx + h.yy * h.zy + h.yz * h.zz;
    e.xz = (h.xz + h.zx) + h.xx * h.zx + h.xy * h.zy + h.xz * h.zz;
  }
  return e;
}

#endif
