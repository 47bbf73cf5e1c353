/* Worlds whose sets have heat. */
#ifndef HEAT_H
#define HEAT_H

#include "surfaces.h"

static inline mpm_heat_desc heat_desc(double specific_heat, double conductivity) {
  mpm_heat_desc desc;
  ck_assert(mpm_heat_desc_init(&desc, sizeof desc) == MPM_OK);
  desc.specific_heat = specific_heat;
  desc.conductivity = conductivity;
  return desc;
}

static inline mpm_heat_info heat_told(const world *w) {
  mpm_heat_info info = {.struct_size = sizeof info};
  ck_ok(w, mpm_stepper_heat_info(w->stepper, &info));
  return info;
}

/* What is missing in the balance of the last step. */
static inline double heat_missing(const mpm_heat_info *i) {
  double left = i->gained - i->sources - i->surfaces - i->dissipated;
  for (int32_t face = 0; face < 6; ++face) left -= i->walls[face];
  return left;
}

/* The longest step of explicit conduction in a material of this diffusivity. */
static inline double heat_dt(const world *w, double diffusivity) {
  double sum = 0.0;
  for (int32_t k = 0; k < w->dim; ++k) sum += 1.0 / (w->desc.grid.spacing[k] * w->desc.grid.spacing[k]);
  return 0.5 / (sum * diffusivity);
}

/* Holds both faces of the x axis at a temperature. */
static inline void hold_ends(const world *w, double T) {
  ck_ok(w, mpm_stepper_set_heat_wall(w->stepper, MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, T));
  ck_ok(w, mpm_stepper_set_heat_wall(w->stepper, MPM_X_MAX, MPM_HEAT_WALL_TEMPERATURE, T));
}

/* A source that differs from place to place, and has no value for a hole. */
static inline mpm_status warm_middle(void *user, const mpm_particle_batch *b, double *power) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i)
    power[i] = b->id[i] < 0 ? NOT_A_NUMBER : 30.0 + 10.0 * sin(7.0 * b->position[i]);
  return 0;
}

/* Opens a cloud with that source and temperatures of its own. */
static inline mpm_particles *open_cloud(world *w, const world_desc *desc, uint64_t seed) {
  dice d = {seed};
  mpm_particles *set = world_open(w, desc);
  add_cloud(w, set, &d, 60, 0.25, 0.0, 1.6, 0.3);
  const int64_t n = mpm_particles_count(set);
  mpm_heat_desc heat = heat_desc(2.0, 300.0);
  heat.source = warm_middle;
  ck_ok(w, mpm_stepper_set_heat(w->stepper, set, &heat));
  double *T = malloc((size_t)n * sizeof *T);
  for (int64_t p = 0; p < n; ++p) T[p] = 300.0 + 40.0 * noise_at((uint64_t)p + seed);
  put(w, set, "temperature", 1, T);
  free(T);
  return set;
}

/* Gives two faces temperatures. */
static inline void equip_faces(const world *w) {
  ck_ok(w, mpm_stepper_set_heat_wall(w->stepper, MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, 250.0));
  if (w->dim > 1)
    ck_ok(w, mpm_stepper_set_heat_wall(w->stepper, MPM_Y_MIN, MPM_HEAT_WALL_TEMPERATURE, 350.0));
}

/* Add the cases of heat_laws.c, heat_exact.c and heat_states.c. */
void add_heat_laws(Suite *suite);
void add_heat_exact(Suite *suite);
void add_heat_states(Suite *suite);

#endif
