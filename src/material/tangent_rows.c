/* Rows of tangents c_ijkl, [81][ld], from the values of a chunk of particles. */
#include "material/tangent_rows.h"

MPMI_INLINE void mpmi_isotropic_row(int i, int j, int k, int l, const double *volumetric, const double *shear,
                                    double *row) {
  const double of_volume = i == j && k == l;
  const double of_shape = (double)(i == k && j == l) + (double)(i == l && j == k);
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) row[p] = of_volume * volumetric[p] + of_shape * shear[p];
}

void KERNEL(isotropic_rows)(int32_t dim, const double *volumetric, const double *shear, double *tangent,
                            int64_t ld) {
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l)
          mpmi_isotropic_row(i, j, k, l, volumetric, shear, tangent + (27 * i + 9 * j + 3 * k + l) * ld);
}

void KERNEL(add_mixed_rows)(int32_t dim, const double (*s)[MPMI_CHUNK], double *tangent, int64_t ld) {
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      for (int k = 0; k < dim; ++k)
        for (int l = 0; l < dim; ++l) {
          double *row = tangent + (27 * i + 9 * j + 3 * k + l) * ld;
          const double left = k == l, right = i == j;
          const double *ij = s[mpmi_sym_index(i, j)], *kl = s[mpmi_sym_index(k, l)];
          MPMI_IVDEP
          for (int p = 0; p < MPMI_CHUNK; ++p) row[p] += left * ij[p] + right * kl[p];
        }
}
