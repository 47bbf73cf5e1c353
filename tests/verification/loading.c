#include "loading.h"

mpm_status loading_weigh(void *user, const mpm_particle_batch *b, double *add) {
  const load *is = user;
  for (int64_t p = 0; p < b->n; ++p) add[b->ld + p] -= is->g * is->per_mass * fmin(b->t, 1.0);
  return MPM_OK;
}

double loading_tail(const verify_world *w, double near) {
  double r[64], worst = 0.0;
  int32_t count;
  verify_ok(w, mpm_stepper_residuals(w->stepper, 64, r, &count));
  for (int32_t k = 0; k + 2 < count; ++k)
    if (r[k] < near) worst = fmax(worst, r[k + 2]);
  return worst;
}
