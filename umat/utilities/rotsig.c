/* CALL ROTSIG(S, R, SPRIME, LSTR, NDI, NSHR): SPRIME = R S R^T, of stresses (LSTR = 1) or strains (LSTR =
 * 2). */
#include "voigt.h"

void rotsig_(const double *s, const double *r, double *sprime, const int *lstr, const int *ndi,
             const int *nshr);

void rotsig_(const double *s, const double *r, double *sprime, const int *lstr, const int *ndi,
             const int *nshr) {
  double a[3][3], turned[3][3];
  mpmu_unpack(s, *lstr, *ndi, *nshr, a);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      turned[i][j] = 0.0;
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) turned[i][j] += r[i + 3 * k] * a[k][l] * r[j + 3 * l];
    }
  mpmu_pack(turned, *lstr, *ndi, *nshr, sprime);
}
