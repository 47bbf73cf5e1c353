#include "modulus.h"

#include <math.h>

#include "subroutine.h"

/* So much is rounding between directions that are alike. */
static const double rounding = 1e-12;

/* What is not a number stays. */
static void take_larger(double *most, double modulus) {
  if (*most == *most && !(modulus <= *most)) *most = modulus;
}

/* Returns the modulus of uniaxial strain along n, and turns n to where a fibre along it would be sought next:
 * the stress of that strain, times n. */
static double follow(const double *ddsdde, double *n) {
  const double square = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  const double strain[MPMU_SYM] = {n[0] * n[0],       n[1] * n[1],       n[2] * n[2],
                                   2.0 * n[0] * n[1], 2.0 * n[0] * n[2], 2.0 * n[1] * n[2]};
  double s[MPMU_SYM], along = 0.0;
  for (int i = 0; i < MPMU_SYM; ++i) {
    s[i] = 0.0;
    for (int j = 0; j < MPMU_SYM; ++j) s[i] += ddsdde[i + MPMU_SYM * j] * strain[j] / square;
    along += s[i] * strain[i] / square;
  }
  const double to[3] = {s[0] * n[0] + s[3] * n[1] + s[4] * n[2], s[3] * n[0] + s[1] * n[1] + s[5] * n[2],
                        s[4] * n[0] + s[5] * n[1] + s[2] * n[2]};
  const double largest = fmax(fmax(fabs(to[0]), fabs(to[1])), fabs(to[2]));
  for (int k = 0; k < 3 && largest > 0.0; ++k) n[k] = to[k] / largest;
  return along;
}

/* From the axes, the diagonals of the faces and those of a cube power iterations climb to the largest value
 * of a form of fourth degree (Kofidis & Regalia 2002, On the best rank-1 approximation of higher-order
 * supersymmetric tensors). */
double mpmu_largest_modulus(const double *ddsdde) {
  enum { STARTS = 13, CLIMBS = 12 };
  static const double start[STARTS][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},  {1, 1, 0},  {1, -1, 0},
                                          {1, 0, 1},  {1, 0, -1}, {0, 1, 1},  {0, 1, -1}, {1, 1, 1},
                                          {1, 1, -1}, {1, -1, 1}, {1, -1, -1}};
  double most = ddsdde[0];
  for (int k = 1; k < MPMU_SYM; ++k) take_larger(&most, ddsdde[(MPMU_SYM + 1) * k]);
  const double along_axes = most;
  for (int d = 0; d < STARTS; ++d) {
    double n[3] = {start[d][0], start[d][1], start[d][2]};
    for (int climb = 0; climb < CLIMBS; ++climb) take_larger(&most, follow(ddsdde, n));
  }
  return most <= along_axes * (1.0 + rounding) ? along_axes : most;
}
