#include "contact/contact.h"
#include "particles/particles.h"
#include "simd/elementary.h"

#include <math.h>

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

double mpmi_half_width(const mpm_particles *set, int64_t slot, double edge, const double *n) {
  const mpm_grid *grid = set->grid;
  const double *F = mpmi_f64(set, MPMI_F, 0);
  const int32_t dim = grid->dim, *map = mpmi_tensor_map(dim), components = mpmi_tensor_components(dim);
  double along[3] = {0.0, 0.0, 0.0}, width = 0.0; /* F^T n */
  for (int32_t c = 0; c < components; ++c)
    if (map[c] / 3 < dim && map[c] % 3 < dim) along[map[c] % 3] += F[c * set->ld + slot] * n[map[c] / 3];
  if (mpmi_has_domains(grid)) {
    for (int32_t k = 0; k < dim; ++k)
      width += 0.5 * mpmi_f64(set, MPMI_SIZE, 0)[k * set->ld + slot] * fabs(along[k]);
  } else {
    for (int32_t k = 0; k < dim; ++k) width += along[k] * along[k];
    width = edge * sqrt(width);
  }
  return width < 0.5 * grid->h_min ? width : 0.5 * grid->h_min;
}
