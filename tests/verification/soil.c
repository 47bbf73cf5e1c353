#include "soil.h"

void soil_settle(const verify_world *w, const soil_rest *rest) {
  const int64_t n = mpm_particles_count(w->set[0]);
  double *x = verify_get(w, w->set[0], "position", 2), *stress = verify_array(6 * n);
  for (int64_t i = 0; i < n; ++i) {
    stress[n + i] = -(rest->load + rest->weight * (rest->height - x[n + i]));
    stress[i] = stress[2 * n + i] = rest->K * stress[n + i];
  }
  verify_put(w, w->set[0], "stress", 6, stress);
  free(x), free(stress);
}

double soil_row_share(double depth, double row) {
  return depth < row ? 1.5 : depth < 2.0 * row ? -0.5 : 0.0;
}

void soil_cloud(const verify_world *w, const char *label, double length, double scale, FILE *file) {
  const int64_t n = mpm_particles_count(w->set[0]);
  double *x = verify_get(w, w->set[0], "position", 2), *state = verify_get(w, w->set[0], "state", 2);
  for (int64_t i = 0; i < n; ++i)
    fprintf(file, "%s,%.4f,%.4f,%.3f\n", label, x[i] / length, x[n + i] / length, scale * state[i]);
  free(x), free(state);
}
