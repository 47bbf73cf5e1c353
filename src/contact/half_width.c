#include "contact/half_width.h"
#include "simd/elementary.h"

double mpmi_half_edge(int32_t dim, double volume) {
  switch (dim) {
  case 1:
    return 0.5 * volume;
  case 2:
    return 0.5 * sqrt(volume);
  default:
    return 0.5 * mpmi_cbrt(volume);
  }
}

void mpmi_inverse_at(const mpm_particles *set, int64_t slot, double inverse[3][3]) {
  const int32_t dim = set->grid->dim;
  double F[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}, det = 0.0;
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t j = 0; j < dim; ++j) F[i][j] = mpmi_f64(set, MPMI_F, 0)[(i * dim + j) * set->ld + slot];
  for (int32_t i = 0; i < 3; ++i)
    for (int32_t j = 0; j < 3; ++j) {
      const int32_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      inverse[i][j] = F[a][c] * F[b][d] - F[a][d] * F[b][c];
    }
  for (int32_t i = 0; i < 3; ++i) det += F[0][i] * inverse[i][0];
  for (int32_t i = 0; i < 9; ++i) inverse[i / 3][i % 3] /= det;
}
