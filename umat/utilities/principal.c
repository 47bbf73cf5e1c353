#include <math.h>

#include "voigt.h"

/* Turns a and v in the plane of p and q so that a[p][q] becomes 0. */
static void turn(double a[3][3], double v[3][3], int p, int q) {
  if (a[p][q] == 0.0) return;
  const double half = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
  const double t = (half >= 0.0 ? 1.0 : -1.0) / (fabs(half) + hypot(half, 1.0)), c = 1.0 / hypot(t, 1.0);
  const double s = t * c;
  for (int k = 0; k < 3; ++k) {
    const double x = a[k][p], y = a[k][q];
    a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
  }
  for (int k = 0; k < 3; ++k) {
    const double x = a[p][k], y = a[q][k];
    a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
  }
  for (int k = 0; k < 3; ++k) {
    const double x = v[k][p], y = v[k][q];
    v[k][p] = c * x - s * y, v[k][q] = s * x + c * y;
  }
}

static void exchange(double value[3], double v[3][3], int p, int q) {
  if (value[p] >= value[q]) return;
  const double x = value[p];
  value[p] = value[q], value[q] = x;
  for (int k = 0; k < 3; ++k) {
    const double y = v[k][p];
    v[k][p] = v[k][q], v[k][q] = y;
  }
}

/* Jacobi's method converges quadratically: a few sweeps are enough. */
void mpmu_principal(double a[3][3], double value[3], double v[3][3]) {
  enum { SWEEPS = 30 };
  for (int k = 0; k < 9; ++k) v[k / 3][k % 3] = k % 4 ? 0.0 : 1.0;
  for (int sweep = 0; sweep < SWEEPS && fabs(a[0][1]) + fabs(a[0][2]) + fabs(a[1][2]) > 0.0; ++sweep) {
    turn(a, v, 0, 1);
    turn(a, v, 0, 2);
    turn(a, v, 1, 2);
  }
  for (int k = 0; k < 3; ++k) value[k] = a[k][k];
  exchange(value, v, 0, 1);
  exchange(value, v, 0, 2);
  exchange(value, v, 1, 2);
}
