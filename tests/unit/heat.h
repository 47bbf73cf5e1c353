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

/* Add the cases of heat_laws.c and heat_exact.c. */
void add_heat_laws(Suite *suite);
void add_heat_exact(Suite *suite);

#endif
