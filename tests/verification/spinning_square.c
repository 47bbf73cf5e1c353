#include "spinning_square.h"

const double spinning_square_side = 0.4;
static const double E = 1e5, nu = 0.3, density = 1000.0;

double spinning_square_speed(void) {
  return verify_speed_of_sound(E, nu, density);
}

mpm_particles *spinning_square(verify_world *w, verify_setup *setup, double omega) {
  for (int32_t k = 0; k < 2; ++k)
    setup->grid.origin[k] = -0.5 * (double)setup->grid.cells[k] * setup->grid.spacing[k];
  verify_open(w, setup);
  mpm_particles *set = verify_set(w, verify_elastic(w, "neo_hookean", E, nu, density));
  const double half = 0.5 * spinning_square_side;
  verify_fill_box(w, set, (const double[]){-half, -half}, (const double[]){half, half}, 2);
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(w, set, "position", 2), *v = verify_array(2 * n);
  for (int64_t i = 0; i < n; ++i) v[i] = -omega * x[n + i], v[n + i] = omega * x[i];
  verify_put(w, set, "velocity", 2, v);
  free(x), free(v);
  const double L[9] = {0.0, -omega, 0.0, omega, 0.0, 0.0, 0.0, 0.0, 0.0};
  verify_ok(w, mpm_particles_set_all(set, "velocity_gradient", MPM_F64, 9, L));
  return set;
}
