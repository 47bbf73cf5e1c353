/* Bodies, obstacles and friction walls of one problem in several parts: contact has the bits of one part, and
 * so have its reports. */
#include "shared.h"

enum { SCENES = 96, OBSTACLES = 3 };

/* Blocks are 64, 16 and 6 nodes wide: a body spans several along each axis. */
static const int64_t cells_of[] = {0, 300, 56, 20};

int32_t throw_of(dice *d, int32_t n) {
  return (int32_t)throw_between(d, 0.0, (double)n - 1e-9);
}

/* ---- what there is ------------------------------------------------------------------------------------- */
mpm_contact_desc throw_rule(dice *d, int32_t dim, int32_t implicit) {
  static const int32_t normals[] = {MPM_NORMAL_LOGISTIC, MPM_NORMAL_DISCRIMINANT, MPM_NORMAL_GRADIENT,
                                    MPM_NORMAL_FIXED};
  mpm_contact_desc rule;
  mpm_contact_desc_init(&rule, sizeof rule);
  rule.friction = throw_of(d, 3) * 0.2;
  rule.friction_static = rule.friction * (1.0 + throw_of(d, 2));
  rule.normal = normals[throw_of(d, 3) ? 0 : throw_of(d, 4)];
  if (rule.normal == MPM_NORMAL_FIXED) {
    rule.direction[0] = dim == 1 ? 1.0 : 0.8;
    rule.direction[1] = dim == 1 ? 0.0 : 0.6;
  }
  switch (throw_of(d, 6)) {
  case 0:
    rule.kind = MPM_CONTACT_TIED;
    break;
  case 1:
    rule.detection = MPM_DETECT_VELOCITY;
    break;
  case 2:
    rule.adhesion = implicit ? 0.0 : 50.0;
    break;
  default:
    rule.offset = throw_of(d, 2) * 0.002;
  }
  return rule;
}

static mpm_status rub(void *user, const mpm_contact_batch *batch, double *friction) {
  (void)user;
  for (int64_t i = 0; i < batch->n; ++i)
    friction[i] += 0.1 + 0.1 * batch->position[i] + 1e-6 * batch->pressure[i];
  return MPM_OK;
}

/* The distance from a ball, and what it is like at points that are asked for. */
static mpm_status ball(void *user, const mpm_distance_batch *batch) {
  (void)user;
  for (int64_t i = 0; i < batch->n; ++i) {
    double squared = 0.0;
    for (int32_t k = 0; k < batch->dim; ++k)
      squared += batch->position[k * batch->ld + i] * batch->position[k * batch->ld + i];
    const double r = sqrt(squared);
    batch->distance[i] = r - 0.12;
    for (int32_t k = 0; k < batch->dim; ++k)
      batch->normal[k * batch->ld + i] = r > 0.0 ? batch->position[k * batch->ld + i] / r : k == 0;
  }
  return MPM_OK;
}

static mpm_status move(void *user, double t, double dt, double *velocity, double *spin) {
  (void)user, (void)dt;
  velocity[0] = 2.0 + 30.0 * t;
  spin[2] = 4.0;
  return MPM_OK;
}

/* In 1-D there is only the plane. */
mpm_status throw_obstacle(world *w, dice *d, mpm_obstacle **out) {
  static const int32_t shapes[] = {MPM_SHAPE_PLANE, MPM_SHAPE_SPHERE, MPM_SHAPE_BOX, MPM_SHAPE_DISTANCE};
  mpm_obstacle_desc desc;
  const int32_t implicit = w->desc.stepper.scheme == MPM_NEWMARK;
  const mpm_contact_desc rule = throw_rule(d, w->dim, implicit);
  mpm_obstacle_desc_init(&desc, sizeof desc);
  desc.shape = w->dim == 1 ? MPM_SHAPE_PLANE : shapes[throw_of(d, 4)];
  desc.motion = throw_of(d, 3);
  if (desc.motion == MPM_MOTION_FREE && (desc.shape == MPM_SHAPE_PLANE || implicit))
    desc.motion = MPM_MOTION_FIXED;
  if (desc.motion == MPM_MOTION_FREE) {
    desc.mass = 20.0;
    desc.inertia[0] = desc.inertia[4] = w->dim == 3 ? 0.3 : 0.0;
    desc.inertia[8] = 0.2;
  }
  for (int32_t k = 0; k < w->dim; ++k) desc.position[k] = throw_between(d, 0.3, 0.6);
  desc.size[0] = 0.1, desc.size[1] = 0.07, desc.size[2] = 0.09;
  if (desc.shape == MPM_SHAPE_PLANE) desc.position[w->dim == 1 ? 0 : 1] = 0.21;
  if (desc.motion != MPM_MOTION_FIXED && w->dim > 1) desc.velocity[0] = 3.0;
  desc.distance = ball;
  desc.contact = &rule;
  mpm_status status = mpm_obstacle_create(w->context, &desc, out);
  if (!status) status = mpm_stepper_add_obstacle(w->stepper, *out);
  if (!status && desc.motion == MPM_MOTION_PRESCRIBED && w->dim > 1 && throw_of(d, 2))
    status = mpm_obstacle_set_motion(*out, move, NULL);
  return status;
}

mpm_status take_obstacle(world *w, mpm_obstacle *obstacle, mpm_status status) {
  const mpm_status removed = mpm_stepper_remove_obstacle(w->stepper, obstacle),
                   freed = mpm_obstacle_destroy(obstacle);
  return status ? status : removed ? removed : freed;
}

/* Contacts of nodes take many sweeps of all parts: beside shared_prescribing.c they are for wide cases. */
static mpm_status set_faces(world *w, dice *d, uint64_t seed) {
  static const int32_t kinds[] = {MPM_WALL_SLIP, MPM_WALL_FIXED, MPM_WALL_FRICTION, MPM_WALL_OPEN,
                                  MPM_WALL_FRICTION_NODES};
  mpm_status status = MPM_OK;
  for (int32_t face = 0; face < 2 * w->dim && !status; ++face) {
    const int32_t kind = kinds[throw_of(d, seed % 3 == 1 ? 4 : 5)];
    const int32_t rubs = kind == MPM_WALL_FRICTION || kind == MPM_WALL_FRICTION_NODES;
    if (!w->desc.grid.periodic[face / 2])
      status = mpm_stepper_set_wall(w->stepper, face, kind, rubs ? 0.3 : 0.0);
  }
  return status;
}

/* Two bodies side by side that run into each other, and a third one on them. */
static mpm_status set_up_bodies(world *w, const scene *is) {
  static const double low[3][3] = {{0.2, 0.2, 0.2}, {0.5, 0.25, 0.2}, {0.3, 0.6, 0.25}},
                      high[3][3] = {{0.5, 0.6, 0.55}, {0.75, 0.6, 0.6}, {0.7, 0.8, 0.5}},
                      along[3][3] = {{1.0, 0.4, 0.2}, {-1.0, 0.3, 0.0}, {0.2, -1.0, -0.3}};
  const int32_t per_cell[] = {2, 2, 2};
  dice d = {is->seed};
  mpm_status status = set_faces(w, &d, is->seed);
  const int32_t bodies = w->sets;
  for (int32_t m = 0; m < bodies && !status; ++m) {
    double v[3];
    for (int32_t k = 0; k < 3; ++k) v[k] = is->speed * along[m][k];
    status = mpm_particles_fill_box(w->set[m], low[m], high[m], per_cell, NULL, NULL);
    if (!status) status = mpm_particles_set_all(w->set[m], "velocity", MPM_F64, w->dim, v);
    if (!status) status = mpm_stepper_set_body(w->stepper, w->set[m], m == 2 ? 7 : m);
  }
  for (int32_t pair = 0; pair < 2 && !status && bodies > 1; ++pair) {
    const mpm_contact_desc rule = throw_rule(&d, w->dim, 0);
    status = mpm_stepper_set_contact(w->stepper, pair ? MPM_BODY_ANY : 0, pair ? 7 : 1, &rule);
  }
  if (!status && throw_of(&d, 3) == 0) status = mpm_stepper_set_friction(w->stepper, rub, NULL);
  return status;
}

/* ---- what happens -------------------------------------------------------------------------------------- */
static mpm_status touch(world *w, const scene *is, outcome *found) {
  mpm_obstacle *obstacle[OBSTACLES] = {NULL, NULL, NULL};
  dice d = {is->seed + 77};
  const int32_t count = throw_of(&d, OBSTACLES + 1);
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < count && !status; ++i) status = throw_obstacle(w, &d, &obstacle[i]);
  if (!status) status = run_steps(w);
  if (!status && is->seed % 3 == 0) status = save_and_load(w);
  if (!status && is->seed % 3 == 0) status = run_steps(w);
  for (int32_t i = 0; i < 4; ++i) found->contact[i].struct_size = sizeof found->contact[i];
  for (int32_t i = 0; i < count && !status; ++i)
    if (!(status = mpm_obstacle_contact_info(obstacle[i], MPM_BODY_ANY, &found->contact[i])))
      status = mpm_obstacle_get_pose(obstacle[i], found->seen + 8 * i, NULL, found->seen + 8 * i + 4, NULL);
  if (!status) status = mpm_stepper_contact_info(w->stepper, MPM_BODY_ANY, 1, &found->contact[3]);
  for (int32_t i = 0; i < count; ++i) status = take_obstacle(w, obstacle[i], status);
  return status;
}

static scene throw_scene(uint64_t seed) {
  dice d = {seed};
  const int32_t dim = seed % 8 == 7 ? 3 : seed % 8 == 6 ? 1 : 2;
  const basis_option *b = &basis_options[throw_of(&d, BASES)];
  const scheme_option *s = &scheme_options[throw_of(&d, 3)];
  const transfer_option *t = &transfer_options[throw_of(&d, TRANSFERS)];
  const method how = method_of(b, s, t);
  scene is;
  memset(&is, 0, sizeof is);
  is.desc = world_with(&how, dim, cells_of[dim], 1.0 / (double)cells_of[dim]);
  is.desc.sets = 1 + throw_of(&d, 3);
  is.desc.grid.periodic[dim - 1] = throw_of(&d, 3) == 0;
  is.set_up = set_up_bodies;
  is.run = touch;
  is.speed = 4.0;
  is.seed = seed;
  return is;
}

START_TEST(bodies_touch) {
  char name[120];
  const scene is = throw_scene(1000 + (uint64_t)_i);
  snprintf(name, sizeof name, "scene %d, %d-D", _i, is.desc.grid.dim);
  check_scene(&is, name, 2 + _i % 4);
}
END_TEST

/* ---- failures ------------------------------------------------------------------------------------------ */
/* Two blocks on a ball whose distance the host gives, until it fails. */
enum { FAILS_NOT, RETURNS, NO_NUMBER, FAILURES };
static const double fails_after = 2.5e-4;

static mpm_status failing_ball(void *user, const mpm_distance_batch *batch) {
  const scene *is = user;
  const mpm_status status = ball(NULL, batch);
  if (batch->t < fails_after || status) return status;
  if (is->seed == RETURNS) return -7;
  for (int64_t i = 0; i < batch->n && is->seed == NO_NUMBER; ++i)
    if (batch->position[i] > 0.02) batch->distance[i] = NOT_A_NUMBER;
  return MPM_OK;
}

static mpm_status failing_rub(void *user, const mpm_contact_batch *batch, double *friction) {
  const scene *is = user;
  for (int64_t i = 0; i < batch->n && batch->t >= fails_after; ++i)
    if (is->seed == NO_NUMBER + FAILURES && batch->position[batch->ld + i] > 0.4) friction[i] = -1.0;
  return batch->t >= fails_after && is->seed == RETURNS + FAILURES ? -7 : MPM_OK;
}

static mpm_status set_up_failure(world *w, const scene *is) {
  void *user = (void *)(uintptr_t)is;
  static const double low[2][2] = {{0.3, 0.62}, {0.5, 0.62}}, high[2][2] = {{0.5, 0.8}, {0.7, 0.8}};
  const int32_t per_cell[] = {2, 2};
  mpm_status status = set_walls(w);
  for (int32_t m = 0; m < 2 && !status; ++m) {
    const double v[] = {m ? -2.0 : 2.0, -3.0};
    status = mpm_particles_fill_box(w->set[m], low[m], high[m], per_cell, NULL, NULL);
    if (!status) status = mpm_particles_set_all(w->set[m], "velocity", MPM_F64, 2, v);
    if (!status) status = mpm_stepper_set_body(w->stepper, w->set[m], m);
  }
  return status ? status : mpm_stepper_set_friction(w->stepper, failing_rub, user);
}

/* The step that fails says so alike on all parts, with the node or the particle. */
static mpm_status fail_touching(world *w, const scene *is, outcome *found) {
  mpm_obstacle *obstacle = NULL;
  mpm_obstacle_desc desc;
  mpm_obstacle_desc_init(&desc, sizeof desc);
  desc.shape = MPM_SHAPE_DISTANCE;
  desc.position[0] = desc.position[1] = 0.5;
  desc.distance = failing_ball;
  desc.user = (void *)(uintptr_t)is;
  mpm_status status = mpm_obstacle_create(w->context, &desc, &obstacle);
  if (!status) status = mpm_stepper_add_obstacle(w->stepper, obstacle);
  int32_t steps = 0;
  for (; steps < 20 && !status; ++steps) status = mpm_step(w->stepper, 5e-5, &w->info);
  if (status) {
    found->failed_particle = 1000000 * steps + 1000 * (w->info.particle + 1) + (w->info.node + 1);
    snprintf(found->text, sizeof found->text, "%s", mpm_last_error(w->context));
  }
  const mpm_status wanted = is->seed % FAILURES == RETURNS     ? MPM_E_CALLBACK
                            : is->seed == NO_NUMBER            ? (mpm_status)MPM_NONFINITE
                            : is->seed == NO_NUMBER + FAILURES ? MPM_E_CALLBACK
                                                               : MPM_OK;
  const int32_t is_right = status == wanted;
  status = mpm_stepper_remove_obstacle(w->stepper, obstacle);
  if (!status) status = mpm_obstacle_destroy(obstacle);
  return status || is_right ? status : MPM_E_INTERNAL;
}

START_TEST(callbacks_fail) {
  scene is = scene_of(2, 96, set_up_failure);
  is.desc.sets = 2;
  is.desc.stepper.scheme = scheme_options[_i % 3].scheme;
  is.run = fail_touching;
  is.seed = (uint64_t)(_i % (2 * FAILURES));
  check_scene(&is, "failure", 2 + _i % 4);
}
END_TEST

static mpm_status step_in_contact(world *w, int32_t part, int32_t number) {
  (void)part, (void)number;
  return mpm_step(w->stepper, 2e-4, NULL);
}

START_TEST(memory_runs_out_touching) {
  static hungry h;
  memset(&h, 0, sizeof h);
  h.is = scene_of(2, 48, set_up_bodies);
  h.is.desc.sets = 3;
  h.is.seed = 3;
  h.act = step_in_contact;
  h.acts = 8;
  check_hunger(&h, live_hungrily);
}
END_TEST

Suite *shared_contact_suite(void) {
  Suite *suite = suite_create("shared_contact");
  TCase *all = tcase_create("bodies");
  tcase_set_timeout(all, 120);
  add_every(all, wide_case(suite, "more bodies"), bodies_touch, SCENES, 12);
  suite_add_tcase(suite, all);
  TCase *failures = tcase_create("failures");
  tcase_set_timeout(failures, 120);
  tcase_add_loop_test(failures, callbacks_fail, 0, 12);
  suite_add_tcase(suite, failures);
  tcase_add_test(faults_case(suite, "faults", 0), memory_runs_out_touching);
  add_shared_touching(suite);
  return suite;
}
