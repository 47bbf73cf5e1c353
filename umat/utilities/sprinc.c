/* CALL SPRINC(S, PS, LSTR, NDI, NSHR): the principal values PS(3) of stresses (LSTR = 1) or strains (LSTR =
 * 2), the largest first. */
#include "voigt.h"

void sprinc_(const double *s, double *ps, const int *lstr, const int *ndi, const int *nshr);

void sprinc_(const double *s, double *ps, const int *lstr, const int *ndi, const int *nshr) {
  double a[3][3], v[3][3];
  mpmu_unpack(s, *lstr, *ndi, *nshr, a);
  mpmu_principal(a, ps, v);
}
