/* Tensors as the utility routines of Abaqus take them: ndi direct components, then nshr shears in the order
 * 12 13 23, which are engineering strains where lstr is 2. */
#ifndef MPMU_VOIGT_H
#define MPMU_VOIGT_H

static const int mpmu_shear_row[3] = {0, 0, 1}, mpmu_shear_column[3] = {1, 2, 2};

static inline void mpmu_unpack(const double *s, int lstr, int ndi, int nshr, double a[3][3]) {
  const double shear = lstr == 2 ? 0.5 : 1.0;
  for (int k = 0; k < 9; ++k) a[k / 3][k % 3] = 0.0;
  for (int k = 0; k < ndi && k < 3; ++k) a[k][k] = s[k];
  for (int k = 0; k < nshr && k < 3; ++k)
    a[mpmu_shear_row[k]][mpmu_shear_column[k]] = a[mpmu_shear_column[k]][mpmu_shear_row[k]] =
        shear * s[ndi + k];
}

static inline void mpmu_pack(double a[3][3], int lstr, int ndi, int nshr, double *s) {
  const double shear = lstr == 2 ? 2.0 : 1.0;
  for (int k = 0; k < ndi && k < 3; ++k) s[k] = a[k][k];
  for (int k = 0; k < nshr && k < 3; ++k) s[ndi + k] = shear * a[mpmu_shear_row[k]][mpmu_shear_column[k]];
}

/* Principal values, the largest first, and their unit directions in the columns of v; a is overwritten. */
void mpmu_principal(double a[3][3], double value[3], double v[3][3]);

#endif
