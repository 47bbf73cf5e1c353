/* Obstacles beside what holds nodes along an axis. There the normal impulse and friction both act along
 * what is left to a node, and together they are to stop what each alone would stop. */
#include "obstacle.h"
#include "prescribed_surfaces.h"

enum { WALL, CALLBACK, SURFACE, PARTICLES, HOLDERS };
static const double floor_at = 1.0, block_dt = 1e-4;

/* Holds what lies on the floor or below along y. */
static mpm_status hold_floor(void *user, const mpm_node_batch *b, uint8_t *prescribed, double *velocity) {
  for (int64_t i = 0; i < b->n; ++i) {
    prescribed[b->ld + i] = b->position[b->ld + i] < *(const double *)user;
    velocity[b->ld + i] = 0.0;
  }
  return MPM_OK;
}

/* A block that slides along a floor towards the foot of a ramp, less than one step away. */
static mpm_obstacle *open_ramp(world *w, int32_t holder, int32_t basis, double friction, double angle,
                               mpm_surface **surface) {
  world_desc d = world_default(2, 20, 0.1);
  d.grid.basis = basis;
  if (holder == WALL) d.grid.origin[1] = floor_at;
  mpm_particles *set = world_open(w, &d);
  const double low[2] = {0.2, floor_at}, high[2] = {1.0, floor_at + 0.4}, v[2] = {1.0, 0.0};
  const int64_t n = world_fill(w, set, low, high, 2);
  ck_ok(w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  *surface = NULL;
  static const double held_below = 1.0 + 1e-3;
  if (holder == WALL) ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  if (holder == CALLBACK)
    ck_ok(w, mpm_stepper_set_velocity_bc(w->stepper, hold_floor, (void *)(uintptr_t)&held_below));
  if (holder == SURFACE) {
    const mpm_surface_desc s = prescribing(1);
    *surface = put_surface(w, &s);
    const double at[4] = {0.01, 1.99, floor_at, floor_at};
    ck_ok(w, mpm_surface_add_polyline(*surface, 2, at, 0, 0.05, NULL, NULL));
  }
  if (holder == PARTICLES) {
    double *x = fetch(w, set, "position", 2);
    uint8_t held[2] = {0, 1};
    for (int64_t p = 0; p < n; ++p)
      if (x[n + p] < floor_at + 0.05) ck_ok(w, mpm_particles_set(set, "prescribed", MPM_U8, 2, 1, &p, held));
    free(x);
  }
  mpm_contact_desc rule = rule_with(friction);
  mpm_obstacle_desc o = obstacle_desc(MPM_SHAPE_PLANE);
  o.position[0] = 0.9;
  o.position[1] = floor_at;
  o.orientation[0] = cos(0.5 * angle);
  o.orientation[3] = sin(0.5 * angle);
  o.contact = &rule;
  mpm_obstacle *ramp;
  ck_ok(w, mpm_obstacle_create(w->context, &o, &ramp));
  ck_ok(w, mpm_stepper_add_obstacle(w->stepper, ramp));
  return ramp;
}

/* No node that the ramp touches comes closer than its gap, whatever the friction, and the ramp gives no
 * energy. */
START_TEST(nodes_that_are_held_are_stopped) {
  static const double frictions[] = {0.0, 0.2, 0.5, 0.9}, angles[] = {0.35, 0.8};
  static const int32_t bases[] = {MPM_LINEAR, MPM_BSPLINE2, MPM_BSPLINE3, MPM_GIMP};
  const int32_t holder = _i % HOLDERS, basis = bases[_i / HOLDERS % 4];
  const double angle = angles[_i / HOLDERS / 4];
  double pushed = 0.0;
  for (int32_t f = 0; f < 4; ++f) {
    world w;
    mpm_surface *surface;
    mpm_obstacle *ramp = open_ramp(&w, holder, basis, frictions[f], angle, &surface);
    world_step(&w, block_dt);
    int64_t n;
    double *v = fetch_nodes(&w, "velocity", &n), *gap = fetch_nodes(&w, "contact_gap", &n),
           *x = fetch_nodes(&w, "position", &n);
    int64_t held = 0;
    for (int64_t i = 0; i < n; ++i) {
      const double along = -sin(angle) * v[i] + cos(angle) * v[n + i];
      if (!(gap[i] < 0.1) || x[n + i] < floor_at - 1e-9) continue; /* below a wall lie images of nodes */
      ck_assert_double_ge(along, -fmax(gap[i], 0.0) / block_dt - 1e-7);
      held += fabs(v[n + i]) < 1e-12;
    }
    ck_assert_int_gt(held, 0);
    mpm_contact_info info = {.struct_size = sizeof info};
    ck_ok(&w, mpm_obstacle_contact_info(ramp, MPM_BODY_ANY, &info));
    ck_assert_double_gt(info.normal_force, 0.0);
    ck_assert_double_ge(w.info.contact_dissipation, -1e-12);
    if (f == 0) pushed = info.force[0];
    ck_assert_double_le(info.force[0], 0.5 * pushed); /* both point backwards */
    free(v), free(gap), free(x);
    ck_ok(&w, mpm_stepper_remove_obstacle(w.stepper, ramp));
    ck_ok(&w, mpm_obstacle_destroy(ramp));
    if (surface) drop_surface(&w, surface);
    world_close(&w);
  }
}
END_TEST

void add_obstacle_held(Suite *suite) {
  TCase *tc = tcase_create("held");
  tcase_add_loop_test(tc, nodes_that_are_held_are_stopped, 0, 2 * 4 * HOLDERS);
  tcase_set_timeout(tc, 30.0);
  suite_add_tcase(suite, tc);
}
