/* Worlds on total Lagrangian grids. */
#ifndef LAGRANGIAN_H
#define LAGRANGIAN_H

#include "surfaces.h"

static inline world_desc total_with(const method *how, int32_t dim) {
  world_desc d = world_with(how, dim, CELLS, spacing);
  d.grid.total_lagrangian = 1;
  return d;
}

static inline world_desc implicit_total(const basis_option *basis, int32_t dim, int32_t remedy,
                                        const char *model) {
  const method how = method_of(basis, &(scheme_option){MPM_NEWMARK, "Newmark"}, &transfer_options[0]);
  world_desc d = total_with(&how, dim);
  d.stepper.flip = 1.0;
  d.stepper.pic_damping = 0.0;
  d.stepper.locking_remedy = remedy;
  d.stepper.transfer = MPM_FLIP;
  d.law =
      (world_law){.model = model, .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 4e3, .hardening = 1e4};
  return d;
}

/* Adds the cases of lagrangian_contact.c. */
void add_lagrangian_contact(Suite *suite);

#endif
