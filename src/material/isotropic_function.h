/* Functions of a symmetric 3x3 tensor e without eigenvectors, branches or iterations: Newton's interpolation
 *   f(e) = f[1] I + f[1,2] (e - l1 I) + f[1,2,3] (e - l1 I)(e - l2 I)
 * with the divided differences of f at the eigenvalues l1, l2, l3. An error of the eigenvalues matters
 * little, above all where two are close: f(e) is off by f'''/6 times the product of the distances from
 * eigenvalues to l1, l2, l3. */
#ifndef MPMI_ISOTROPIC_FUNCTION_H
#define MPMI_ISOTROPIC_FUNCTION_H

#include <math.h>

#include "simd/tensor.h"
#include "simd/vector_math.h"

/* l1 is the extreme eigenvalue that stands further off the middle one, l2 the middle; none of the differences
 * is 0. */
typedef struct mpmi_eigenvalue_nodes {
  double l1, l2, l3;
  double d12, d23, d13; /* l1 - l2 ... */
} mpmi_eigenvalue_nodes;

/* The largest root c >= cos(30 degrees) of 4 c^3 - 3 c = x for 0 <= x <= 1, c = cos(arccos(x) / 3): a
 * polynomial good to 7e-8 and one step of Newton. */
MPMI_INLINE double mpmi_cos_third(double x) {
  double c =
      0.8660254727162848 +
      x * (0.1666592636770671 +
           x * (-0.04798178196012517 +
                x * (0.02380456118583253 +
                     x * (-0.01257720443079993 + x * (0.00511346681565548 - x * 0.0010438469357609691)))));
  double square = c * c;
  return (8.0 * c * square + x) / (12.0 * square - 3.0);
}

/* Eigenvalues by Cardano's formula: mean + radius cos(angle + k 120 degrees), with cos(3 angle) from
 * det(deviator). */
MPMI_INLINE mpmi_eigenvalue_nodes mpmi_eigenvalues(mpmi_sym e) {
  double mean = (e.xx + e.yy + e.zz) * (1.0 / 3.0), x = e.xx - mean, y = e.yy - mean, z = e.zz - mean;
  double off = e.xy * e.xy + e.yz * e.yz + e.xz * e.xz;
  double det = x * (y * z - e.yz * e.yz) - z * e.xy * e.xy + e.xz * (2.0 * e.xy * e.yz - y * e.xz);
  double radius_squared = (2.0 / 3.0) * (2.0 * off + x * x + y * y + z * z) + 1e-60;
  double radius = sqrt(radius_squared), cos3 = 4.0 * det / (radius_squared * radius);
  double c = mpmi_cos_third(fabs(cos3)), toward = copysign(radius, cos3);
  double s = sqrt(0.75 * mpmi_max(1.0 - c * c, 1e-16));
  mpmi_eigenvalue_nodes n;
  n.l1 = mean + toward * c;
  n.l2 = mean - toward * (0.5 * c - s);
  n.l3 = mean - toward * (0.5 * c + s);
  n.d12 = toward * (1.5 * c - s);
  n.d23 = toward * (2.0 * s);
  n.d13 = toward * (1.5 * c + s);
  return n;
}

/* (e - l1 I)(e - l2 I) */
MPMI_INLINE mpmi_sym mpmi_quadratic(mpmi_sym e, mpmi_eigenvalue_nodes n) {
  double xx = e.xx - n.l1, yy = e.yy - n.l1, zz = e.zz - n.l1;
  mpmi_sym q = {
      xx * (e.xx - n.l2) + e.xy * e.xy + e.xz * e.xz, yy * (e.yy - n.l2) + e.xy * e.xy + e.yz * e.yz,
      zz * (e.zz - n.l2) + e.xz * e.xz + e.yz * e.yz, e.xy * (xx + (e.yy - n.l2)) + e.xz * e.yz,
      e.yz * (yy + (e.zz - n.l2)) + e.xy * e.xz,      e.xz * (xx + (e.zz - n.l2)) + e.xy * e.yz};
  return q;
}

MPMI_INLINE mpmi_sym mpmi_interpolated(mpmi_sym e, mpmi_sym q, double l1, double f1, double f12,
                                       double f123) {
  double constant = f1 - f12 * l1;
  mpmi_sym f = {constant + f12 * e.xx + f123 * q.xx,
                constant + f12 * e.yy + f123 * q.yy,
                constant + f12 * e.zz + f123 * q.zz,
                f12 * e.xy + f123 * q.xy,
                f12 * e.yz + f123 * q.yz,
                f12 * e.xz + f123 * q.xz};
  return f;
}

/* For V V = I + e: ln V = 1/2 ln(I + e), and V^-1 = (I + e)^(-1/2). */
MPMI_INLINE mpmi_sym mpmi_log_stretch(mpmi_sym e, mpmi_sym q, mpmi_eigenvalue_nodes n) {
  double f1 = 0.5 * mpmi_lane_log1p(n.l1);
  double f12 = 0.5 * mpmi_lane_log1p(n.d12 / (1.0 + n.l2)) / n.d12;
  double f23 = 0.5 * mpmi_lane_log1p(n.d23 / (1.0 + n.l3)) / n.d23;
  return mpmi_interpolated(e, q, n.l1, f1, f12, (f12 - f23) / n.d13);
}

MPMI_INLINE mpmi_sym mpmi_inverse_stretch(mpmi_sym e, mpmi_sym q, mpmi_eigenvalue_nodes n) {
  double v1 = sqrt(1.0 + n.l1), v2 = sqrt(1.0 + n.l2), v3 = sqrt(1.0 + n.l3);
  double s12 = v1 + v2, s23 = v2 + v3, s13 = v1 + v3;
  double f123 = 1.0 / (v1 * v2 * v3 * s12 * s23 * s13);
  double f12 = v3 * s23 * s13 * f123;
  return mpmi_interpolated(e, q, n.l1, v2 * s12 * f12, -f12, (s12 + v3) * f123);
}

#endif
