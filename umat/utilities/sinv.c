/* CALL SINV(STRESS, SINV1, SINV2, NDI, NSHR): the mean stress and von Mises' equivalent stress. */
#include <math.h>

#include "voigt.h"

void sinv_(const double *stress, double *sinv1, double *sinv2, const int *ndi, const int *nshr);

void sinv_(const double *stress, double *sinv1, double *sinv2, const int *ndi, const int *nshr) {
  double a[3][3], square = 0.0;
  mpmu_unpack(stress, 1, *ndi, *nshr, a);
  *sinv1 = (a[0][0] + a[1][1] + a[2][2]) / 3.0;
  for (int k = 0; k < 9; ++k) {
    const double s = a[k / 3][k % 3] - (k % 4 ? 0.0 : *sinv1);
    square += s * s;
  }
  *sinv2 = sqrt(1.5 * square);
}
