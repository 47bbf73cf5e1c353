/* CALL SPRIND(S, PS, AN, LSTR, NDI, NSHR): the same with the directions: AN(K, :) is that of PS(K). */
#include "voigt.h"

void sprind_(const double *s, double *ps, double *an, const int *lstr, const int *ndi, const int *nshr);

void sprind_(const double *s, double *ps, double *an, const int *lstr, const int *ndi, const int *nshr) {
  double a[3][3], v[3][3];
  mpmu_unpack(s, *lstr, *ndi, *nshr, a);
  mpmu_principal(a, ps, v);
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) an[k + 3 * i] = v[i][k];
}
