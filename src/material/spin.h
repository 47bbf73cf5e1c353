/* How V and R of F_inc = V R change when dF_inc = D F_inc with a symmetric D. In the frame of the principal
 * stretches v_a of V, with x = ln v_a - ln v_b, (d ln V)_ab = x coth x D_ab,   (dR R^T)_ab = -tanh(x/2) D_ab.
 * With u the axial vector of the skew ln V D - D ln V, which has the entries x D_ab, that is
 *   d ln V = D + [ln V, spin(q(H) u)],   dR R^T = -spin(r(H) u)
 *   q(x^2) = (x coth x - 1) / x^2,   r(x^2) = tanh(x/2) / x
 * where H is the symmetric tensor with the eigenvalue x^2 on the axis about which a and b turn. No
 * eigenvectors and no differences of close numbers: u vanishes with ln V. */
#ifndef MPMI_SPIN_H
#define MPMI_SPIN_H

#include "simd/tensor.h"

typedef struct mpmi_vector {
  double x, y, z;
} mpmi_vector;

/* Returns the axial vector of a d - d a; spin(w) has w.z in yx, w.x in zy, w.y in xz. */
MPMI_INLINE mpmi_vector mpmi_commutator(int dim, mpmi_sym a, mpmi_sym d) {
  mpmi_vector u = {0.0, 0.0, 0.0};
  if (dim >= 2) u.z = a.xy * (d.xx - d.yy) - d.xy * (a.xx - a.yy);
  if (dim == 3) {
    u.x = a.yz * (d.yy - d.zz) - d.yz * (a.yy - a.zz) + (a.xz * d.xy - a.xy * d.xz);
    u.y = a.xz * (d.zz - d.xx) - d.xz * (a.zz - a.xx) + (a.xy * d.yz - a.yz * d.xy);
    u.z += a.yz * d.xz - a.xz * d.yz;
  }
  return u;
}

/* Returns m u, of which 2-D has the z alone. */
MPMI_INLINE mpmi_vector mpmi_transformed(int dim, mpmi_sym m, mpmi_vector u) {
  mpmi_vector t = {0.0, 0.0, m.zz * u.z};
  if (dim == 3) {
    t.x = m.xx * u.x + m.xy * u.y + m.xz * u.z;
    t.y = m.xy * u.x + m.yy * u.y + m.yz * u.z;
    t.z += m.xz * u.x + m.yz * u.y;
  }
  return t;
}

/* Returns s + a spin(w) - spin(w) a. */
MPMI_INLINE mpmi_sym mpmi_add_turning(int dim, mpmi_sym s, mpmi_sym a, mpmi_vector w) {
  if (dim >= 2) {
    s.xx += 2.0 * a.xy * w.z;
    s.yy -= 2.0 * a.xy * w.z;
    s.xy -= (a.xx - a.yy) * w.z;
  }
  if (dim == 3) {
    s.xx -= 2.0 * a.xz * w.y;
    s.yy += 2.0 * a.yz * w.x;
    s.zz += 2.0 * (a.xz * w.y - a.yz * w.x);
    s.xy += a.xz * w.x - a.yz * w.y;
    s.yz += a.xy * w.y - a.xz * w.z - (a.yy - a.zz) * w.x;
    s.xz += a.yz * w.z - a.xy * w.x + (a.xx - a.zz) * w.y;
  }
  return s;
}

/* These return q and r of y = x^2, by Lambert's continued fractions,
 *   x coth x - 1 = x^2 / (3 + x^2 / (5 + ...   and   tanh(x/2) / x = 1/2 / (1 + x^2/4 / (3 + ...,
 * cut after 17 and 13: x coth x and tanh(x/2) are off by 2e-14 where one stretch of the step is 4 times
 * another, by 2e-11 at 10 times. */
MPMI_INLINE double mpmi_stretching(double y) {
  double above = 11486475.0 + y * (810810.0 + y * (12870.0 + y * 44.0));
  return above / (34459425.0 + y * (4729725.0 + y * (135135.0 + y * (990.0 + y))));
}

MPMI_INLINE double mpmi_turning(double y) {
  double above = 4324320.0 + y * (138600.0 + y * (756.0 + y * 0.5));
  return above / (8648640.0 + y * (997920.0 + y * (12600.0 + y * 28.0)));
}

/* Returns the product of two tensors that commute: it is symmetric. */
MPMI_INLINE mpmi_sym mpmi_commuting_product(mpmi_sym a, mpmi_sym b) {
  mpmi_sym p = {a.xx * b.xx + a.xy * b.xy + a.xz * b.xz, a.xy * b.xy + a.yy * b.yy + a.yz * b.yz,
                a.xz * b.xz + a.yz * b.yz + a.zz * b.zz, a.xx * b.xy + a.xy * b.yy + a.xz * b.yz,
                a.xy * b.xz + a.yy * b.yz + a.yz * b.zz, a.xx * b.xz + a.xy * b.yz + a.xz * b.zz};
  return p;
}

/* Returns a step of Horner's rule for polynomials of h: h p + c I. */
MPMI_INLINE mpmi_sym mpmi_horner(mpmi_sym p, mpmi_sym h, double c) {
  return mpmi_shifted(1.0, mpmi_commuting_product(h, p), c);
}

MPMI_INLINE mpmi_sym mpmi_inverse(mpmi_sym a) {
  double xx = a.yy * a.zz - a.yz * a.yz, xy = a.yz * a.xz - a.xy * a.zz, xz = a.xy * a.yz - a.yy * a.xz;
  double f = 1.0 / (a.xx * xx + a.xy * xy + a.xz * xz);
  mpmi_sym b = {f * xx, f * (a.xx * a.zz - a.xz * a.xz), f * (a.xx * a.yy - a.xy * a.xy),
                f * xy, f * (a.xy * a.xz - a.xx * a.yz), f * xz};
  return b;
}

MPMI_INLINE mpmi_sym mpmi_stretching_3d(mpmi_sym h) {
  mpmi_sym above = mpmi_horner(mpmi_shifted(44.0, h, 12870.0), h, 810810.0);
  mpmi_sym below = mpmi_horner(mpmi_horner(mpmi_shifted(1.0, h, 990.0), h, 135135.0), h, 4729725.0);
  return mpmi_commuting_product(mpmi_horner(above, h, 11486475.0),
                                mpmi_inverse(mpmi_horner(below, h, 34459425.0)));
}

MPMI_INLINE mpmi_sym mpmi_turning_3d(mpmi_sym h) {
  mpmi_sym above = mpmi_horner(mpmi_shifted(0.5, h, 756.0), h, 138600.0);
  mpmi_sym below = mpmi_horner(mpmi_shifted(28.0, h, 12600.0), h, 997920.0);
  return mpmi_commuting_product(mpmi_horner(above, h, 4324320.0),
                                mpmi_inverse(mpmi_horner(below, h, 8648640.0)));
}

/* Holds q(H) and r(H) for a = ln V; 2-D has their zz alone, 1-D none. With a deviator a,
 * H is 2 (a : a) I - 3 a a. */
typedef struct mpmi_spins {
  mpmi_sym stretching, turning;
} mpmi_spins;

MPMI_INLINE mpmi_spins mpmi_spins_of(int dim, mpmi_sym a) {
  mpmi_spins s = {{0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}};
  if (dim == 2) {
    double difference = a.xx - a.yy, y = difference * difference + 4.0 * a.xy * a.xy;
    s.stretching.zz = mpmi_stretching(y);
    s.turning.zz = mpmi_turning(y);
  } else if (dim == 3) {
    double mean = (a.xx + a.yy + a.zz) * (1.0 / 3.0);
    mpmi_sym d = mpmi_shifted(1.0, a, -mean), square = mpmi_commuting_product(d, d);
    mpmi_sym h = mpmi_shifted(-3.0, square, 2.0 * (square.xx + square.yy + square.zz));
    s.stretching = mpmi_stretching_3d(h);
    s.turning = mpmi_turning_3d(h);
  }
  return s;
}

#endif
