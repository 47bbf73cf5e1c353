/* A box of material that flies at an obstacle. */
#ifndef OBSTACLE_H
#define OBSTACLE_H

#include "body.h"
#include "io/state.h"

enum { MOST_OBSTACLES = 4 };

typedef struct arena {
  int32_t dim, concurrency, periodic;
  method method;
  double gravity[3];
} arena;

/* The grid has 14 cells of this spacing on each axis; the box takes four in the middle. */
static const double arena_spacing = 0.25, arena_speed = 2.0, arena_dt = 1e-3;

static inline double arena_middle(void) {
  return 7.0 * arena_spacing;
}

static inline void open_arena(world *w, const arena *of) {
  const double h = arena_spacing, lower[3] = {5.0 * h, 5.0 * h, 5.0 * h},
               upper[3] = {9.0 * h, 9.0 * h, 9.0 * h};
  world_desc desc = world_with(&of->method, of->dim, 14, h);
  desc.context.concurrency = of->concurrency ? of->concurrency : 1;
  desc.grid.periodic[0] = of->periodic;
  for (int32_t k = 0; k < 3; ++k) desc.stepper.gravity[k] = of->gravity[k];
  mpm_particles *set = world_open(w, &desc);
  world_fill(w, set, lower, upper, 2);
  double v[3] = {of->dim == 1 ? -arena_speed : 0.4, -arena_speed, 0.3};
  ck_ok(w, mpm_particles_set_all(set, "velocity", MPM_F64, of->dim, v));
}

static inline mpm_obstacle_desc obstacle_desc(int32_t shape) {
  mpm_obstacle_desc d;
  ck_assert_int_eq(mpm_obstacle_desc_init(&d, sizeof d), MPM_OK);
  d.shape = shape;
  for (int32_t k = 0; k < 3; ++k) d.position[k] = arena_middle();
  return d;
}

static inline mpm_contact_desc rule_with(double friction) {
  mpm_contact_desc d;
  ck_assert_int_eq(mpm_contact_desc_init(&d, sizeof d), MPM_OK);
  d.friction = friction;
  return d;
}

static inline mpm_obstacle *put_obstacle(world *w, const mpm_obstacle_desc *d) {
  mpm_obstacle *obstacle;
  ck_ok(w, mpm_obstacle_create(w->context, d, &obstacle));
  ck_ok(w, mpm_stepper_add_obstacle(w->stepper, obstacle));
  return obstacle;
}

static inline void drop_obstacle(world *w, mpm_obstacle *obstacle) {
  ck_ok(w, mpm_stepper_remove_obstacle(w->stepper, obstacle));
  ck_ok(w, mpm_obstacle_destroy(obstacle));
}

static inline mpm_contact_info touch_of(const world *w, const mpm_obstacle *obstacle) {
  mpm_contact_info info = {.struct_size = sizeof info};
  ck_ok(w, mpm_obstacle_contact_info(obstacle, MPM_BODY_ANY, &info));
  return info;
}

/* Adds the cases of obstacle_states.c. */
void add_obstacle_states(Suite *suite);
/* Adds those of obstacle_held.c. */
void add_obstacle_held(Suite *suite);
/* Adds those of obstacle_corners.c. */
void add_obstacle_corners(Suite *suite);
/* Adds those of obstacle_reactions.c. */
void add_obstacle_reactions(Suite *suite);

#endif
