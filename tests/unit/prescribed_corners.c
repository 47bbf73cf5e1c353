/* Surfaces that prescribe how the material moves, where walls, other bodies and obstacles are near. */
#include "prescribed_surfaces.h"
#include "obstacle.h"

static const double corner_dt = 2e-4;

/* Covers a box with markers whose areas are along y. */
static void cover(const world *w, mpm_surface *s, const double *low, const double *high) {
  for (double x = low[0]; x < high[0]; x += 0.125)
    for (double y = low[1]; y < high[1]; y += 0.125) {
      const double at[2] = {x, y}, area[2] = {0.0, 0.1};
      ck_ok(w, mpm_surface_add(s, 1, at, area, NULL));
    }
}

/* Walls that hold come before surfaces: nodes on them stay there. Each tells its own force, walls that rub
 * too. */
START_TEST(walls_come_first) {
  static const int32_t kinds[] = {MPM_WALL_FIXED, MPM_WALL_SLIP, MPM_WALL_FRICTION, MPM_WALL_FRICTION_NODES};
  const int32_t kind = kinds[_i % 4], normal_only = _i / 4, holds = _i % 4 < 2;
  for (int32_t k = 0; k < BROAD; ++k) {
    const method *how = broad_methods[k];
    if (!is_explicit(how)) continue;
    world w;
    world_desc desc = world_with(how, 2, CELLS, spacing);
    mpm_particles *set = world_open(&w, &desc);
    const double low[] = {0.9, 0.0}, high[] = {2.1, 1.0}, from[] = {0.7, 0.15}, to[] = {2.4, 0.5};
    world_fill(&w, set, low, high, 2);
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, kind, holds ? 0.0 : 0.3));
    mpm_surface_desc d = prescribing(normal_only);
    d.velocity[0] = 0.5, d.velocity[1] = holds ? 2.0 : -2.0;
    mpm_surface *s = put_surface(&w, &d);
    cover(&w, s, from, to);
    ck_ok(&w, mpm_step_begin(w.stepper, corner_dt));
    ck_ok(&w, mpm_step_grid(w.stepper));
    int64_t n;
    double *v = fetch_nodes(&w, "velocity", &n), *x = fetch_nodes(&w, "position", &n), most = 0.0;
    for (int64_t i = 0; i < n; ++i) {
      if (holds && fabs(x[n + i]) < 1e-9) ck_within(how->name, v[n + i], 0.0, 1e-13);
      most = fmax(most, fabs(v[n + i]));
    }
    ck_holds(most > 1.0); /* others go as the surface says */
    free(v), free(x);
    ck_ok(&w, mpm_step_abort(w.stepper));
    for (int32_t step = 0; step < 3; ++step) {
      const mpm_step_info before = world_info(&w), after = world_step(&w, corner_dt);
      double wall[2];
      const double *r = reaction_of(&w, s);
      ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_Y_MIN, wall));
      for (int32_t c = 0; c < 2; ++c)
        ck_within(how->name, after.momentum[c] - before.momentum[c], corner_dt * (r[c] + wall[c]),
                  1e-11 * corner_dt * (fabs(r[0]) + fabs(r[1]) + fabs(wall[1]) + 1.0));
    }
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* A body that a surface holds stops what hits it as a wall does, whether the material may slide along the
 * surface or not; the force goes on to the surface. */
enum { HIT_BY_BODY, TIED_TO_BODY, HIT_BY_OBSTACLE, HITS };
typedef struct hit {
  double y, momentum[2], work, dissipation, pressure;
} hit;

static mpm_status note_pressure(void *user, const mpm_contact_batch *b, double *friction) {
  (void)friction;
  for (int64_t i = 0; i < b->n; ++i) *(double *)user += b->pressure[i];
  return MPM_OK;
}

static hit strike(const method *how, int32_t by, int32_t normal_only) {
  world w;
  world_desc desc = world_with(how, 2, CELLS, spacing);
  mpm_particles *set = world_open(&w, &desc), *other = NULL;
  const double low[] = {0.9, 0.9}, high[] = {2.1, 1.5}, from[] = {0.4, 0.5}, to[] = {2.6, 2.1};
  world_fill(&w, set, low, high, 2);
  mpm_obstacle *box = NULL;
  if (by == HIT_BY_OBSTACLE) {
    mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_BOX);
    d.position[0] = 1.5, d.position[1] = 1.7, d.size[0] = 0.4, d.size[1] = 0.2;
    d.velocity[1] = -1.0;
    d.motion = MPM_MOTION_FREE;
    d.mass = 1000.0;
    d.inertia[8] = 100.0;
    box = put_obstacle(&w, &d);
  } else {
    other = world_add_set(&w, NULL);
    const double under[] = {0.9, 1.5}, above[] = {2.1, 2.1}, down[] = {0.0, -1.0};
    world_fill(&w, other, under, above, 2);
    ck_ok(&w, mpm_particles_set_all(other, "velocity", MPM_F64, 2, down));
    ck_ok(&w, mpm_stepper_set_body(w.stepper, other, 1));
    mpm_contact_desc rule = rule_with(0.0);
    if (by == TIED_TO_BODY) rule.kind = MPM_CONTACT_TIED;
    rule.normal = MPM_NORMAL_FIXED;
    rule.direction[1] = 1.0;
    ck_ok(&w, mpm_stepper_set_contact(w.stepper, 0, 1, &rule));
  }
  mpm_surface_desc d = prescribing(normal_only);
  d.velocity[1] = 0.25;
  mpm_surface *s = put_surface(&w, &d);
  cover(&w, s, from, to);
  hit of = {0.0, {0.0, 0.0}, 0.0, 0.0, 0.0};
  ck_ok(&w, mpm_stepper_set_friction(w.stepper, note_pressure, &of.pressure));
  double scale = 0.0;
  for (int32_t step = 0; step < 20; ++step) {
    const mpm_step_info before = world_info(&w), after = world_step(&w, corner_dt);
    const double *r = reaction_of(&w, s);
    double force[3] = {0.0, 0.0, 0.0};
    if (box) memcpy(force, touch_of(&w, box).force, sizeof force);
    scale = fmax(scale, fabs(r[1]));
    for (int32_t c = 0; c < 2; ++c)
      ck_within(how->name, after.momentum[c] - before.momentum[c], corner_dt * (r[c] + force[c]),
                1e-10 * corner_dt * scale);
    of.work += after.external_work;
    of.dissipation += after.contact_dissipation;
  }
  ck_holds(scale > 1.0);
  for (int32_t c = 0; c < 2; ++c) of.momentum[c] = world_info(&w).momentum[c];
  double at[3] = {0.0, 0.0, 0.0};
  if (box) ck_ok(&w, mpm_obstacle_get_pose(box, at, NULL, NULL, NULL));
  of.y = box ? at[1] : fetch1(&w, other, "position", 2, 1, 0);
  if (box) drop_obstacle(&w, box);
  drop_surface(&w, s);
  world_close(&w);
  return of;
}

START_TEST(holds_against_contact) {
  static const method how[] = {{METHOD(BSPLINE2, USL, FLIP, 1.0, "FLIP USL")},
                               {METHOD(BSPLINE2, USF, FLIP, 0.9, "FLIP .9 USF")},
                               {METHOD(LINEAR, MUSL, APIC, 1.0, "linear APIC MUSL")},
                               {METHOD(BSPLINE2, USL, XPIC, 1.0, "XPIC(3) USL"), .xpic_order = 3},
                               {METHOD(BSPLINE2, USL, FMPM, 1.0, "FMPM(4) USL"), .xpic_order = 4}};
  const method *of = &how[_i / HITS];
  const hit held = strike(of, _i % HITS, 0), slid = strike(of, _i % HITS, 1);
  show("%s, %d: y %.9f %.9f, work %g %g, dissipation %g %g\n", of->name, (int)(_i % HITS), held.y, slid.y,
       held.work, slid.work, held.dissipation, slid.dissipation);
  /* along the surface the held body gives way a little to what is tied to it, and at corners of the box */
  const double share = _i % HITS == HIT_BY_BODY ? 1e-9 : 1e-5;
  ck_within(of->name, slid.y, held.y, share);
  for (int32_t c = 0; c < 2; ++c)
    ck_within(of->name, slid.momentum[c], held.momentum[c], share * (1.0 + fabs(held.momentum[1])));
  ck_within(of->name, slid.dissipation, held.dissipation, share * held.dissipation);
  ck_within(of->name, slid.pressure, held.pressure, share * held.pressure);
  ck_within(of->name, slid.work, held.work, share * (1.0 + fabs(held.work)));
}
END_TEST

/* Across an inclined surface, with friction or tied, each impulse has its like, and contact makes no energy:
 * what a surface takes of an impulse changes its direction. */
START_TEST(inclined_against_contact) {
  static const method how[] = {{METHOD(BSPLINE2, USL, FLIP, 1.0, "FLIP USL")},
                               {METHOD(BSPLINE2, USF, APIC, 1.0, "APIC USF")},
                               {METHOD(BSPLINE2, MUSL, FLIP, 0.97, "FLIP .97 MUSL")},
                               {METHOD(BSPLINE2, USL, FMPM, 1.0, "FMPM(3) USL"), .xpic_order = 3}};
  static const double normals[][2] = {{0.05, 0.1}, {0.1, 0.005}, {0.004, 0.1}};
  const method *of = &how[_i / 3];
  for (int32_t tied = 0; tied < 2; ++tied) {
    world w;
    world_desc desc = world_with(of, 2, CELLS, spacing);
    mpm_particles *set = world_open(&w, &desc), *other = world_add_set(&w, NULL);
    const double low[] = {0.9, 0.9}, high[] = {2.1, 1.5}, under[] = {0.9, 1.5}, above[] = {2.1, 2.1};
    const double down[] = {0.3, -1.0};
    world_fill(&w, set, low, high, 2);
    world_fill(&w, other, under, above, 2);
    ck_ok(&w, mpm_particles_set_all(other, "velocity", MPM_F64, 2, down));
    ck_ok(&w, mpm_stepper_set_body(w.stepper, other, 1));
    mpm_contact_desc rule = rule_with(0.4);
    if (tied) rule.kind = MPM_CONTACT_TIED;
    ck_ok(&w, mpm_stepper_set_contact(w.stepper, 0, 1, &rule));
    const mpm_surface_desc d = prescribing(1);
    mpm_surface *s = put_surface(&w, &d);
    for (int32_t k = 0; k < 300; ++k) {
      const double at[2] = {0.5 + 0.125 * (k % 17), 0.5 + 0.1 * (k / 17)};
      ck_ok(&w, mpm_surface_add(s, 1, at, normals[_i % 3], NULL));
    }
    const mpm_step_info start = world_info(&w);
    double scale = 0.0;
    for (int32_t step = 0; step < 40; ++step) {
      const mpm_step_info before = world_info(&w), after = world_step(&w, corner_dt);
      const double *r = reaction_of(&w, s);
      scale = fmax(scale, fabs(r[0]) + fabs(r[1]));
      for (int32_t c = 0; c < 2; ++c)
        ck_within(of->name, after.momentum[c] - before.momentum[c], corner_dt * r[c],
                  1e-9 * corner_dt * scale);
      ck_holds(after.contact_dissipation >= -1e-9 * start.kinetic_energy);
      ck_within(of->name, after.external_work, 0.0, 1e-9 * start.kinetic_energy);
    }
    const mpm_step_info end = world_info(&w);
    show("%s, %d: reaction up to %g, energy %g of %g\n", of->name, (int)(_i % 3), scale,
         end.kinetic_energy + end.strain_energy, start.kinetic_energy);
    ck_holds(end.kinetic_energy + end.strain_energy < start.kinetic_energy);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

void add_prescribed_corners(Suite *suite) {
  TCase *corners = tcase_create("corners");
  tcase_add_loop_test(corners, walls_come_first, 0, 8);
  tcase_add_loop_test(corners, holds_against_contact, 0, 5 * HITS);
  tcase_add_loop_test(corners, inclined_against_contact, 0, 12);
  tcase_set_timeout(corners, 60);
  suite_add_tcase(suite, corners);
}
