#include "drawn.h"

/* Nodes that have a weight at the end move as the uniform stretch has it. */
static mpm_status hold_nodes(void *user, const mpm_node_batch *batch, uint8_t *prescribed, double *velocity) {
  const drawn_pull *by = user;
  const double stretch = by->total ? 1.0 : 1.0 + by->rate * batch->t;
  for (int64_t i = 0; i < batch->n; ++i)
    if (batch->position[i] > (DRAWN_LENGTH - 1.01 * by->h) * stretch)
      prescribed[i] = 1, velocity[i] = by->rate / stretch * batch->position[i];
  return MPM_OK;
}

mpm_particles *drawn_open(verify_world *w, const verify_setup *setup, drawn_pull *by, int32_t at_rest) {
  verify_open(w, setup);
  mpm_particles *set = verify_set(w, verify_elastic(w, "neo_hookean", DRAWN_E, DRAWN_NU, 1.0));
  verify_fill_box(w, set, (const double[]){0.0, 0.0}, (const double[]){DRAWN_LENGTH, DRAWN_HEIGHT}, 2);
  verify_ok(w, mpm_stepper_set_wall(w->stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  verify_ok(w, mpm_stepper_set_wall(w->stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  const int64_t n = mpm_particles_count(set);
  double *x = verify_get(w, set, "position", 2), *v = verify_array(2 * n);
  for (int64_t i = 0; i < n; ++i) v[i] = at_rest ? 0.0 : by->rate * x[i];
  verify_put(w, set, "velocity", 2, v);
  free(x), free(v);
  verify_ok(w, mpm_stepper_set_velocity_bc(w->stepper, hold_nodes, by));
  return set;
}

double drawn_force(const verify_world *w) {
  mpm_view at = {.struct_size = sizeof at}, f = {.struct_size = sizeof f};
  double sum = 0.0;
  verify_ok(w, mpm_grid_map(w->stepper, 0, "position", MPM_READ, &at));
  verify_ok(w, mpm_grid_map(w->stepper, 0, "reaction", MPM_READ, &f));
  for (int64_t i = 0; i < at.count; ++i)
    if (((const double *)at.data)[i * at.item_stride] > 0.5 * DRAWN_LENGTH)
      sum += ((const double *)f.data)[i * f.item_stride];
  verify_ok(w, mpm_view_release(&at));
  verify_ok(w, mpm_view_release(&f));
  return sum;
}

double drawn_thinning(double stretch, double *force) {
  const double mu = DRAWN_E / (2.0 * (1.0 + DRAWN_NU)),
               lambda = DRAWN_E * DRAWN_NU / ((1.0 + DRAWN_NU) * (1.0 - 2.0 * DRAWN_NU));
  double low = 0.01, high = 1.0;
  for (int32_t k = 0; k < 200; ++k) {
    const double l = 0.5 * (low + high);
    if (lambda * log(l * stretch) + mu * (l * l - 1.0) > 0.0)
      high = l;
    else
      low = l;
  }
  *force = DRAWN_HEIGHT / stretch * (lambda * log(low * stretch) + mu * (stretch * stretch - 1.0));
  return low;
}
