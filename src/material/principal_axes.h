/* Principal values and vectors of symmetric tensors, without iterations or branches: the value that stands
 * furthest off the others is well conditioned, and so is its vector; the other two follow by one rotation
 * in the plane across it (the deflation of Scherzinger and Dohrmann 2008). Values and vectors are good to
 * rounding, also where two or all values are close, which those of Cardano's formula alone are not. */
#ifndef MPMI_PRINCIPAL_AXES_H
#define MPMI_PRINCIPAL_AXES_H

#include "material/isotropic_function.h"

typedef struct mpmi_axes {
  double value[3], vector[3][3]; /* vector[A]: of value[A], by component */
} mpmi_axes;

/* Jacobi's rotation: s and c turn the axes u, v so that the tensor with the diagonal uu, vv has no shear
 * uv. */
typedef struct mpmi_rotation {
  double t, s, c;
} mpmi_rotation;
MPMI_INLINE mpmi_rotation mpmi_rotation_of(double uu, double vv, double uv) {
  double apart = vv - uu;
  double t = 2.0 * uv / (fabs(apart) + sqrt(apart * apart + 4.0 * uv * uv + 1e-300));
  mpmi_rotation r;
  r.t = apart < 0.0 ? -t : t;
  r.c = 1.0 / sqrt(1.0 + r.t * r.t);
  r.s = r.t * r.c;
  return r;
}

MPMI_INLINE double mpmi_form(mpmi_sym s, const double *u, const double *v) {
  double x = s.xx * v[0] + s.xy * v[1] + s.xz * v[2], y = s.xy * v[0] + s.yy * v[1] + s.yz * v[2];
  return u[0] * x + u[1] * y + u[2] * (s.xz * v[0] + s.yz * v[1] + s.zz * v[2]);
}

/* The unit vector of the eigenvalue l1, which stands off by d12 or more: the largest column of the adjugate
 * of s - l1 I. Where nothing is left of that, all values are equal, and any vector will do. */
MPMI_INLINE void mpmi_vector_of(mpmi_sym s, double l1, double d12, double *n) {
  double scale = 1.0 / d12, xx = scale * (s.xx - l1), yy = scale * (s.yy - l1), zz = scale * (s.zz - l1);
  double xy = scale * s.xy, yz = scale * s.yz, xz = scale * s.xz;
  double of_xx = yy * zz - yz * yz, of_yy = xx * zz - xz * xz, of_zz = xx * yy - xy * xy;
  double of_xy = yz * xz - xy * zz, of_yz = xy * xz - xx * yz, of_xz = xy * yz - yy * xz;
  double a = fabs(of_xx), b = fabs(of_yy), c = fabs(of_zz);
  double x = of_xx, y = of_xy, z = of_xz;
  x = b > a ? of_xy : x, y = b > a ? of_yy : y, z = b > a ? of_yz : z;
  a = mpmi_max(a, b);
  x = c > a ? of_xz : x, y = c > a ? of_yz : y, z = c > a ? of_zz : z;
  double square = x * x + y * y + z * z, inverse = 1.0 / sqrt(square > 0.0 ? square : 1.0);
  n[0] = square > 0.0 ? inverse * x : 1.0, n[1] = inverse * y, n[2] = inverse * z;
}

/* Two unit vectors across a third, without a branch (Duff et al. 2017). */
MPMI_INLINE void mpmi_vectors_across(const double *n, double *u, double *v) {
  double sign = copysign(1.0, n[2]), a = -1.0 / (sign + n[2]), b = n[0] * n[1] * a;
  u[0] = 1.0 + sign * n[0] * n[0] * a, u[1] = sign * b, u[2] = -sign * n[0];
  v[0] = b, v[1] = sign + n[1] * n[1] * a, v[2] = -n[1];
}

MPMI_INLINE mpmi_axes mpmi_principal_axes_3d(mpmi_sym b) {
  double mean = (b.xx + b.yy + b.zz) * (1.0 / 3.0), u[3], v[3];
  mpmi_sym s = {b.xx - mean, b.yy - mean, b.zz - mean, b.xy, b.yz, b.xz};
  mpmi_eigenvalue_nodes n = mpmi_eigenvalues(s);
  mpmi_axes o;
  mpmi_vector_of(s, n.l1, n.d12, o.vector[0]);
  mpmi_vectors_across(o.vector[0], u, v);
  double uu = mpmi_form(s, u, u), vv = mpmi_form(s, v, v), uv = mpmi_form(s, u, v);
  mpmi_rotation r = mpmi_rotation_of(uu, vv, uv);
  for (int k = 0; k < 3; ++k) {
    o.vector[1][k] = r.c * u[k] - r.s * v[k];
    o.vector[2][k] = r.s * u[k] + r.c * v[k];
  }
  o.value[0] = mean - (uu + vv);
  o.value[1] = mean + (uu - r.t * uv);
  o.value[2] = mean + (vv + r.t * uv);
  return o;
}

/* In plane strain z is the last axis, in uniaxial strain the axes are x, y, z. */
MPMI_INLINE mpmi_axes mpmi_principal_axes(int dim, mpmi_sym b) {
  if (dim == 3) return mpmi_principal_axes_3d(b);
  mpmi_rotation r = {0.0, 0.0, 1.0};
  if (dim == 2) r = mpmi_rotation_of(b.xx, b.yy, b.xy);
  mpmi_axes o = {{b.xx - r.t * b.xy, b.yy + r.t * b.xy, b.zz},
                 {{r.c, -r.s, 0.0}, {r.s, r.c, 0.0}, {0.0, 0.0, 1.0}}};
  return o;
}

#endif
