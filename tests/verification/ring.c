#include "ring.h"

double ring_radius(const ring *r, int32_t layer) {
  return r->a + (r->b - r->a) * (layer + 0.5) / r->layers;
}

static double ring_angle(const ring *r, int64_t id) {
  return 0.5 * PI * ((double)(id % r->along) + 0.5) / r->along;
}

/* The virtual work of the pressure is a theta p v(a), with v(a) from the two inner layers as on a straight
 * line: their shares are 3/2 and -1/2. */
static mpm_status press(void *user, const mpm_particle_batch *b, double *add) {
  const ring *r = user;
  const double whole = 0.5 * PI * r->a / r->along * r->pressure * b->t;
  for (int64_t i = 0; i < b->n; ++i) {
    if (b->id[i] < 0 || b->id[i] >= 2 * r->along) continue;
    const double angle = ring_angle(r, b->id[i]), force = b->id[i] < r->along ? 1.5 * whole : -0.5 * whole;
    add[i] += force * cos(angle);
    add[b->ld + i] += force * sin(angle);
  }
  return MPM_OK;
}

void ring_open(verify_world *w, ring *r) {
  const int64_t n = (int64_t)r->layers * r->along;
  double *x = verify_array(2 * n), *volume = verify_array(n);
  for (int64_t i = 0; i < n; ++i) {
    const double radius = ring_radius(r, (int32_t)(i / r->along));
    x[i] = radius * cos(ring_angle(r, i));
    x[n + i] = radius * sin(ring_angle(r, i));
    volume[i] = radius * 0.5 * PI / r->along * (r->b - r->a) / r->layers;
  }
  verify_ok(w, mpm_particles_add(r->set, n, x, NULL, volume, NULL, NULL, NULL));
  free(x), free(volume);
  verify_ok(w, mpm_stepper_set_wall(w->stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(w, mpm_stepper_set_wall(w->stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(w, mpm_stepper_set_force(w->stepper, press, r));
}

double ring_displacement(const verify_world *w, const ring *r, int32_t layer) {
  const int64_t n = mpm_particles_count(r->set);
  double *x = verify_get(w, r->set, "position", 2), sum = 0.0;
  for (int64_t i = (int64_t)layer * r->along; i < (int64_t)(layer + 1) * r->along; ++i)
    sum += hypot(x[i], x[n + i]) - ring_radius(r, layer);
  free(x);
  return sum / r->along;
}

void ring_stress(const verify_world *w, const ring *r, int32_t layer, double *radial, double *hoop) {
  const int64_t n = mpm_particles_count(r->set);
  double *s = verify_get(w, r->set, "stress", 6);
  *radial = *hoop = 0.0;
  for (int64_t i = (int64_t)layer * r->along; i < (int64_t)(layer + 1) * r->along; ++i) {
    const double c = cos(ring_angle(r, i)), z = sin(ring_angle(r, i)), xy = 2.0 * s[3 * n + i] * c * z;
    *radial += (s[i] * c * c + s[n + i] * z * z + xy) / r->along;
    *hoop += (s[i] * z * z + s[n + i] * c * c - xy) / r->along;
  }
  free(s);
}
