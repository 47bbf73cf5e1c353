/* Worlds whose sets adapt. */
#ifndef ADAPTION_H
#define ADAPTION_H

#include "reference.h"
#include "world.h"

static inline mpm_adaption_desc adaption_desc(void) {
  mpm_adaption_desc desc;
  ck_assert(mpm_adaption_desc_init(&desc, sizeof desc) == MPM_OK);
  return desc;
}

static inline mpm_adaption_info told(const world *w, const mpm_particles *set) {
  mpm_adaption_info info = {.struct_size = sizeof info};
  ck_ok(w, mpm_stepper_adaption_info(w->stepper, set, &info));
  return info;
}

/* Every edge is halved, however short. */
static inline mpm_adaption_desc split_all(void) {
  mpm_adaption_desc desc = adaption_desc();
  desc.least_edge = 1e-6;
  desc.split_edge = 2e-6;
  return desc;
}

/* Pairs are alike whatever they are. */
static inline mpm_adaption_desc merge_all(void) {
  mpm_adaption_desc desc = adaption_desc();
  desc.max_per_cell = 1;
  desc.merge_distance = 2.0;
  desc.merge_tolerance = 1e6;
  return desc;
}

static inline world_desc described(const method *how, int32_t dim) {
  world_desc desc = world_with(how, dim, 8, 0.25);
  desc.stepper.reference_positions = 1;
  return desc;
}

/* Adds the cases of adaption_steps.c. */
void add_adaption_steps(Suite *suite);

#endif
