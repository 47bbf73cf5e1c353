/* Surfaces that prescribe how a body moves, or heat it, in several parts. */
#include "shared.h"

/* ---- prescribed velocities ----------------------------------------------------------------------------- */
static mpm_status turn_by_place(void *user, const mpm_marker_batch *b, double *add) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i)
    for (int32_t k = 0; k < b->dim; ++k) add[k * b->ld + i] += 2.0 * sin(7.0 * b->position[i] + k);
  return MPM_OK;
}

static mpm_status add_holds(world *w, int32_t prescribes, double middle, mpm_surface **out) {
  mpm_surface_desc d;
  mpm_status status = mpm_surface_desc_init(&d, sizeof d);
  d.prescribes = prescribes;
  d.velocity[0] = 6.0;
  d.velocity[1] = w->dim > 1 ? -2.0 : 0.0;
  d.pressure = 100.0;
  if (!status) status = mpm_surface_create(w->context, w->grid, &d, out);
  if (!status) status = mpm_surface_set_velocity(*out, turn_by_place, NULL);
  if (!status) status = add_around(w, *out, middle, 0.18, w->desc.grid.spacing[0]);
  return status ? status : mpm_stepper_add_surface(w->stepper, *out);
}

static mpm_status read_reaction(const world *w, mpm_surface *s, double *seen) {
  const mpm_status status = mpm_stepper_surface_reaction(w->stepper, s, seen);
  return status ? status : mpm_stepper_surface_impulse(w->stepper, s, seen + 3);
}

/* Two surfaces, one of which lets the material slide, and which share nodes. */
static mpm_status hold(world *w, const scene *is, outcome *found) {
  static const int32_t kinds[] = {MPM_PRESCRIBES_VELOCITY, MPM_PRESCRIBES_NORMAL};
  mpm_surface *s[2] = {NULL, NULL};
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < 2 && !status; ++i)
    status = add_holds(w, kinds[(i + (int32_t)is->seed) % 2], 0.45 + 0.03 * i, &s[i]);
  if (!status) status = run_steps(w);
  for (int32_t i = 0; i < 2 && !status; ++i) {
    status = mix_markers(w, s[i], &found->markers);
    if (!status) status = read_reaction(w, s[i], found->seen + 6 * i);
    if (!status && !(fabs(found->seen[6 * i]) > 0.0)) status = MPM_E_INTERNAL; /* it has done something */
  }
  for (int32_t i = 0; i < 2; ++i)
    if (s[i]) drop_loads(w, s[i]);
  return status;
}

START_TEST(holds_combine) {
  scene is;
  char name[300];
  if (!describe_option(&is, _i, 0, name, sizeof name)) return;
  is.set_up = set_up_body;
  is.run = hold;
  is.seed = (uint64_t)_i;
  is.speed = 3.0; /* with which no scene inverts, in one part or in several */
  check_made(&is, name, 2 + _i % 4);
}
END_TEST

/* Across a period, through a wall that rubs on nodes, with bodies of their own that run into what is held. */
static mpm_status set_up_meeting(world *w, const scene *is) {
  const double low[2][2] = {{0.05, 0.0}, {0.05, 0.55}}, high[2][2] = {{0.95, 0.5}, {0.95, 0.9}};
  const int32_t per_cell[] = {2, 2}, kind = is->seed % 2 ? MPM_WALL_FRICTION : MPM_WALL_FRICTION_NODES;
  mpm_status status = mpm_stepper_set_wall(w->stepper, MPM_Y_MIN, kind, 0.3);
  if (!status) status = mpm_stepper_set_wall(w->stepper, MPM_Y_MAX, MPM_WALL_SLIP, 0.0);
  for (int32_t m = 0; m < 2 && !status; ++m) {
    const double v[] = {m ? 3.0 : -2.0, m ? -9.0 : 1.0};
    status = mpm_particles_fill_box(w->set[m], low[m], high[m], per_cell, NULL, NULL);
    if (!status) status = mpm_particles_set_all(w->set[m], "velocity", MPM_F64, 2, v);
    if (!status) status = mpm_stepper_set_body(w->stepper, w->set[m], m);
  }
  return status;
}

/* A line along the face where the bodies meet, and another one along the wall. */
static mpm_status add_line(world *w, int32_t prescribes, double y, mpm_surface **out) {
  mpm_surface_desc d;
  const double x[] = {0.93, 0.07, y, y};
  mpm_status status = mpm_surface_desc_init(&d, sizeof d);
  d.prescribes = prescribes;
  d.velocity[1] = 1.0;
  if (!status) status = mpm_surface_create(w->context, w->grid, &d, out);
  if (!status) status = mpm_surface_add_polyline(*out, 2, x, 0, 0.5 * w->desc.grid.spacing[0], NULL, NULL);
  return status ? status : mpm_stepper_add_surface(w->stepper, *out);
}

static mpm_status hold_bodies(world *w, const scene *is, outcome *found) {
  mpm_surface *s[2] = {NULL, NULL};
  const int32_t kind = is->seed % 4 < 2 ? MPM_PRESCRIBES_NORMAL : MPM_PRESCRIBES_VELOCITY;
  mpm_status status = add_line(w, is->seed < 8 ? kind : MPM_PRESCRIBES_NOTHING, 0.495, &s[0]);
  if (!status) status = add_line(w, kind, 0.03, &s[1]);
  if (!status) status = run_steps(w);
  if (!status) status = run_steps(w);
  for (int32_t i = 0; i < 2 && !status; ++i) {
    status = mix_markers(w, s[i], &found->markers);
    if (!status) status = read_reaction(w, s[i], found->seen + 6 * i);
  }
  found->contact[0].struct_size = sizeof found->contact[0];
  if (!status) status = mpm_stepper_contact_info(w->stepper, 0, 1, &found->contact[0]);
  for (int32_t i = 0; i < 2; ++i)
    if (s[i]) drop_loads(w, s[i]);
  return status;
}

START_TEST(holds_meet_bodies) {
  scene is = scene_of(2, 90, set_up_meeting);
  is.desc.sets = 2;
  is.desc.grid.periodic[0] = 1;
  is.desc.stepper.scheme = scheme_options[_i % 3].scheme;
  is.desc.grid.basis = _i % 5 == 4 ? MPM_LINEAR : MPM_BSPLINE2;
  is.run = hold_bodies;
  is.seed = (uint64_t)_i;
  check_made(&is, "bodies", 2 + _i % 4);
}
END_TEST

/* ---- heat ---------------------------------------------------------------------------------------------- */
static mpm_status heat_up(world *w, const scene *is, outcome *found) {
  mpm_surface *s[3] = {NULL, NULL, NULL};
  static const double flux[] = {400.0, 0.0, -50.0}, film[] = {0.0, 30.0, 8.0};
  mpm_status status = MPM_OK;
  (void)is;
  for (int32_t i = 0; i < 3 && !status; ++i) {
    status =
        i == 2 ? add_holds(w, MPM_PRESCRIBES_NORMAL, 0.3, &s[i]) : add_loads(w, 0.26 + 0.03 * i, 0.2, &s[i]);
    if (!status) status = mpm_surface_set_heat(s[i], flux[i], film[i], 350.0);
  }
  if (!status) status = run_steps(w);
  for (int32_t i = 0; i < 3 && !status; ++i) status = mix_markers(w, s[i], &found->markers);
  for (int32_t i = 0; i < 3; ++i)
    if (s[i]) drop_loads(w, s[i]);
  return status;
}

START_TEST(surfaces_heat) {
  scene is = warm_scene(96, _i % 2);
  is.run = heat_up;
  if (_i & 2) is.desc.grid.basis = MPM_LINEAR;
  check_made(&is, "heated", 2 + _i % 4);
}
END_TEST

/* ---- failures ------------------------------------------------------------------------------------------ */
/* One part refuses, markers heat where nothing is, parts describe surfaces otherwise. */
static mpm_status fail_held(world *w, const scene *is, outcome *found) {
  mpm_surface *s[2] = {NULL, NULL};
  mpm_status answer = MPM_OK;
  int32_t part = 0, parts = 1;
  (void)is;
  mpm_context_part(w->context, &part, &parts);
  mpm_status status = add_holds(w, MPM_PRESCRIBES_VELOCITY, 0.3, &s[0]);
  if (!status) status = add_loads(w, 0.26, 0.2, &s[1]);
  if (!status) status = mpm_surface_set_heat(s[1], 1.0, 2.0, 300.0);
  for (int32_t i = 0; i < 4 && !status; ++i) status = mpm_step(w->stepper, 1e-5, &w->info);
  if (!status) status = mpm_surface_set_velocity(s[0], refuse_markers, &answer);
  if (part == parts - 1) answer = -3;
  if (!status)
    status = expect_step(w, 1e-5, MPM_E_CALLBACK, "the velocity callback of surface 0 returned -3");
  answer = MPM_OK;
  const double x[] = {0.9, 0.9}, area[] = {0.01, 0.0}, infinite[] = {(double)INFINITY, 0.0};
  int64_t id;
  if (!status) status = mpm_surface_add(s[1], 1, x, area, &id);
  if (!status)
    status = expect_step(w, 1e-5, MPM_E_STATE, "heats, and there is no material with heat around it");
  if (!status) status = mpm_surface_remove(s[1], 1, &id);
  if (!status && parts > 1) {
    if (part) status = mpm_surface_set_heat(s[1], 1.0, 0.0, 300.0);
    if (!status)
      status = expect_step(w, 1e-5, MPM_E_STATE, "the stepper is set up otherwise on another part");
    if (status == MPM_OK) w->info.cause = MPM_OK;
    if (!status) status = mpm_surface_set_heat(s[1], 1.0, 2.0, 300.0);
  }
  id = 0;
  if (!status && mpm_surface_set(s[0], "prescribed_velocity", MPM_F64, 2, 1, &id, infinite) == MPM_OK)
    status = MPM_E_INTERNAL;
  for (int32_t i = 0; i < 4 && !status; ++i) status = mpm_step(w->stepper, 1e-5, &w->info);
  for (int32_t i = 0; i < 2 && !status; ++i) status = mix_markers(w, s[i], &found->markers);
  for (int32_t i = 0; i < 2; ++i)
    if (s[i]) drop_loads(w, s[i]);
  return status;
}

START_TEST(holds_fail_together) {
  scene is = warm_scene(96, _i % 2);
  is.run = fail_held;
  check_made(&is, "failures", 2 + _i);
}
END_TEST

void add_shared_prescribing(Suite *suite) {
  TCase *prescribing = tcase_create("prescribing");
  tcase_set_timeout(prescribing, 120);
  add_option_list(prescribing);
  TCase *wide = wide_case(suite, "more prescribing");
  add_option_list(wide);
  add_table(prescribing, wide, holds_combine, OPTIONS_SAMPLE);
  add_table(prescribing, wide, holds_meet_bodies, 12);
  tcase_add_loop_test(prescribing, surfaces_heat, 0, 4);
  tcase_add_loop_test(prescribing, holds_fail_together, 0, 4);
  suite_add_tcase(suite, prescribing);
}
