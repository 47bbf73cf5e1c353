#include "tensor.h"

#include <math.h>

static const mpmu_sym unit = {1.0, 1.0, 1.0, 0.0, 0.0, 0.0};

/* The larger one; b where a is not a number. */
static double larger(double a, double b) {
  return a > b ? a : b;
}

/* Higham's iteration, X' = (X + X^-T) / 2, from F, without its change of volume where that is large. It
 * converges quadratically: once a change is below 1e-8, the next one would be lost in rounding. */
mpmu_polar mpmu_polar_of(const mpmu_mat *F) {
  enum { MOST = 60 };
  mpmu_polar of = {.R = *F};
  const double J = mpmu_determinant(F), scale = J > 0.5 && J < 2.0 ? 1.0 : 1.0 / cbrt(J);
  for (int k = 0; k < 9; ++k) of.R.m[k / 3][k % 3] *= scale;
  double change = 1.0;
  for (int step = 0; step < MOST && !(change < 1e-8); ++step) {
    const mpmu_mat X = of.R, c = mpmu_cofactors(&X);
    const double by = 1.0 / (X.m[0][0] * c.m[0][0] + X.m[0][1] * c.m[0][1] + X.m[0][2] * c.m[0][2]);
    change = 0.0;
    for (int k = 0; k < 9; ++k) {
      const double half = 0.5 * (by * c.m[k / 3][k % 3] - X.m[k / 3][k % 3]);
      of.R.m[k / 3][k % 3] += half;
      change = larger(fabs(half), change);
    }
  }
  const mpmu_mat back = mpmu_transposed(&of.R), v = mpmu_product(F, &back);
  of.V = (mpmu_sym){v.m[0][0],
                    v.m[1][1],
                    v.m[2][2],
                    0.5 * (v.m[0][1] + v.m[1][0]),
                    0.5 * (v.m[1][2] + v.m[2][1]),
                    0.5 * (v.m[0][2] + v.m[2][0])};
  return of;
}

static mpmu_sym inverse(mpmu_sym a) {
  const mpmu_sym c = {a.yy * a.zz - a.yz * a.yz, a.xx * a.zz - a.xz * a.xz, a.xx * a.yy - a.xy * a.xy,
                      a.xz * a.yz - a.xy * a.zz, a.xy * a.xz - a.xx * a.yz, a.xy * a.yz - a.xz * a.yy};
  const double by = 1.0 / (a.xx * c.xx + a.xy * c.xy + a.xz * c.xz);
  const mpmu_sym inverted = {by * c.xx, by * c.yy, by * c.zz, by * c.xy, by * c.yz, by * c.xz};
  return inverted;
}

static double largest(mpmu_sym a) {
  return larger(larger(larger(fabs(a.xx), fabs(a.yy)), larger(fabs(a.zz), fabs(a.xy))),
                larger(fabs(a.yz), fabs(a.xz)));
}

/* With V V = I + e, ln V = 2 artanh Z for Z = (V - I)(V + I)^-1 = e (V + I)^-2: e comes from G without a
 * difference of close numbers, and the series of artanh converges for every V. */
mpmu_sym mpmu_log_stretch(const mpmu_mat *G, mpmu_sym V) {
  enum { MOST = 2000 }; /* terms, for stretches beyond 100 in a step */
  const mpmu_mat back = mpmu_transposed(G), square = mpmu_product(G, &back);
  const double(*g)[3] = G->m, (*s)[3] = square.m;
  const mpmu_sym e = {2.0 * g[0][0] + s[0][0],       2.0 * g[1][1] + s[1][1],
                      2.0 * g[2][2] + s[2][2],       (g[0][1] + g[1][0]) + s[0][1],
                      (g[1][2] + g[2][1]) + s[1][2], (g[0][2] + g[2][0]) + s[0][2]};
  const mpmu_sym sum = mpmu_add(V, 1.0, unit);
  const mpmu_sym z = mpmu_commuting_product(e, inverse(mpmu_commuting_product(sum, sum)));
  const mpmu_sym z2 = mpmu_commuting_product(z, z);
  mpmu_sym power = z, log_v = z;
  for (int k = 3; k < 2 * MOST; k += 2) {
    power = mpmu_commuting_product(power, z2);
    log_v = mpmu_add(log_v, 1.0 / k, power);
    if (!(largest(power) > 1e-17 * k * largest(log_v))) break;
  }
  return mpmu_add(log_v, 1.0, log_v);
}
