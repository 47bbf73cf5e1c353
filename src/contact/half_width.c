#include "contact/half_width.h"
#include "simd/elementary.h"
#include "simd/vector3.h"

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
  double F[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t j = 0; j < dim; ++j) F[i][j] = mpmi_f64(set, MPMI_F, 0)[(i * dim + j) * set->ld + slot];
  mpmi_invert3(F, inverse);
}
