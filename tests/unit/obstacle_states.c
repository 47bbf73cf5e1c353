/* Bits: threads, saved states, steps that fail. And what the calls refuse. */
#include "obstacle.h"

/* Four obstacles of all kinds around two bodies, and a friction wall. */
typedef struct scene {
  world w;
  mpm_obstacle *obstacle[MOST_OBSTACLES];
  int32_t count, motion_answer;
  int32_t distance_answer, spoils;
} scene;

static mpm_status push_down(void *user, double t, double dt, double *velocity, double *spin) {
  scene *s = user;
  (void)t, (void)dt;
  velocity[0] = 0.1;
  velocity[1] = -0.5;
  if (s->motion_answer == 100) velocity[0] = NOT_A_NUMBER;
  if (s->motion_answer == 200) spin[0] = 1.0;
  return s->motion_answer < 100 ? s->motion_answer : 0;
}

/* A slope whose surface runs. */
static mpm_status slope(void *user, const mpm_distance_batch *b) {
  scene *s = user;
  const double n[3] = {0.6, 0.8, 0.0};
  for (int64_t i = 0; i < b->n; ++i) {
    b->distance[i] = 0.0;
    for (int32_t c = 0; c < b->dim; ++c) {
      b->distance[i] += n[c] * b->position[c * b->ld + i];
      b->normal[c * b->ld + i] = n[c];
      if (b->velocity) b->velocity[c * b->ld + i] = 0.1 * (c ? n[0] : -n[1]);
    }
  }
  if (s->spoils == 1) b->distance[b->n / 2] = NOT_A_NUMBER;
  if (s->spoils == 2) b->normal[b->n / 2] += 0.01;
  if (s->spoils == 3) b->normal[b->n / 2] = INFINITE;
  if (s->spoils == 4 && b->velocity) b->velocity[b->n / 2] = NOT_A_NUMBER;
  if (s->spoils == 5 && !b->velocity) b->distance[b->n / 2] = NOT_A_NUMBER; /* of a particle */
  return s->distance_answer;
}

static void open_scene(scene *s, const method *how, int32_t dim, int32_t concurrency) {
  const double h = arena_spacing;
  *s = (scene){.count = 4};
  open_arena(&s->w,
             &(arena){.dim = dim, .concurrency = concurrency, .method = *how, .gravity = {0.0, -5.0, 0.0}});
  const double lower[3] = {5.5 * h, 9.1 * h, 5.0 * h}, upper[3] = {8.5 * h, 11.0 * h, 8.0 * h};
  mpm_particles *second = world_add_set(&s->w, NULL);
  world_fill(&s->w, second, lower, upper, 2);
  ck_ok(&s->w, mpm_stepper_set_body(s->w.stepper, second, 1));
  ck_ok(&s->w, mpm_stepper_set_wall(s->w.stepper, MPM_Y_MIN, MPM_WALL_FRICTION, 0.2));
  mpm_contact_desc rule = rule_with(0.3);
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_SPHERE);
  d.contact = &rule;
  d.motion = how->scheme == MPM_NEWMARK ? MPM_MOTION_FIXED : MPM_MOTION_FREE;
  d.size[0] = 1.5 * h;
  d.position[1] = 3.6 * h;
  d.mass = 50.0;
  for (int32_t k = 0; k < 3; ++k) d.inertia[4 * k] = 3.0 + k;
  s->obstacle[0] = put_obstacle(&s->w, &d);
  d = obstacle_desc(MPM_SHAPE_PLANE);
  d.motion = MPM_MOTION_PRESCRIBED;
  d.inside = 1;
  d.position[1] = 11.0 * h;
  s->obstacle[1] = put_obstacle(&s->w, &d);
  ck_ok(&s->w, mpm_obstacle_set_motion(s->obstacle[1], push_down, s));
  d = obstacle_desc(MPM_SHAPE_DISTANCE);
  d.contact = &rule;
  d.distance = slope;
  d.user = s;
  d.position[0] = d.position[1] = 5.05 * h;
  s->obstacle[2] = put_obstacle(&s->w, &d);
  d = obstacle_desc(MPM_SHAPE_BOX);
  d.size[0] = d.size[1] = d.size[2] = h;
  d.position[0] = 10.2 * h;
  s->obstacle[3] = put_obstacle(&s->w, &d);
}

static void close_scene(scene *s) {
  for (int32_t i = s->count; i-- > 0;) drop_obstacle(&s->w, s->obstacle[i]);
  world_close(&s->w);
}

/* The saved state holds all that a step depends on. */
static uint64_t hash_of(scene *s) {
  return world_hash(&s->w);
}

static void steps_of(scene *s, int32_t count) {
  for (int32_t i = 0; i < count; ++i) world_step(&s->w, arena_dt);
}

/* Two scenes in the same state have the same bits some steps later. */
static void go_on_alike(scene *a, scene *b) {
  steps_of(a, 6);
  steps_of(b, 6);
  ck_assert_uint_eq(hash_of(a), hash_of(b));
  close_scene(a);
  close_scene(b);
}

START_TEST(threads) {
  const method *how = broad_methods[_i];
  static const int32_t counts[3] = {1, 2, 5};
  for (int32_t dim = 2; dim <= 3; ++dim) {
    uint64_t hash[3];
    for (int32_t i = 0; i < 3; ++i) {
      scene s;
      open_scene(&s, how, dim, counts[i]);
      steps_of(&s, 12);
      if (!i) {
        ck_assert_double_gt(touch_of(&s.w, s.obstacle[0]).impulse[1], 0.0);
        ck_assert_double_gt(touch_of(&s.w, s.obstacle[2]).impulse[1], 0.0);
        ck_assert_double_lt(touch_of(&s.w, s.obstacle[1]).impulse[1], 0.0);
      }
      hash[i] = hash_of(&s);
      close_scene(&s);
    }
    ck_assert_uint_eq(hash[1], hash[0]);
    ck_assert_uint_eq(hash[2], hash[0]);
  }
}
END_TEST

START_TEST(saved_in_contact) {
  const method *how = broad_methods[_i];
  scene s, other;
  open_scene(&s, how, 2, 1);
  const double force[3] = {1.0, 2.0, 0.0}, torque[3] = {0.0, 0.0, 0.1};
  if (how->scheme != MPM_NEWMARK) ck_ok(&s.w, mpm_obstacle_set_load(s.obstacle[0], force, torque));
  steps_of(&s, 8);
  open_scene(&other, how, 2, 2);
  steps_of(&other, 3);
  world_copy(&s.w, &other.w);
  const mpm_contact_info a = touch_of(&s.w, s.obstacle[0]), b = touch_of(&other.w, other.obstacle[0]);
  ck_assert_int_eq(memcmp(&a, &b, sizeof a), 0);
  go_on_alike(&s, &other);
}
END_TEST

/* Saves what is awaited, too, and goes on as if the callback had been there before the state. */
START_TEST(motion_is_awaited) {
  scene s, other;
  open_scene(&s, &methods[_i], 2, 1);
  open_scene(&other, &methods[_i], 2, 1);
  steps_of(&s, 8);
  ck_ok(&other.w, mpm_obstacle_set_motion(other.obstacle[1], NULL, NULL));
  for (int32_t way = 0; way < 3; ++way) {
    world_copy(way == 2 ? &other.w : &s.w, &other.w); /* way 2: what awaits it is saved, and loaded again */
    const uint64_t was = hash_of(&other);
    ck_refused(&other.w, mpm_step(other.w.stepper, arena_dt, NULL), MPM_E_STATE,
               "obstacle 1 had a motion callback when the state was saved");
    ck_assert_uint_eq(hash_of(&other), was);
    if (way) continue;
    ck_ok(&other.w, mpm_obstacle_set_motion(other.obstacle[1], NULL, NULL));
    world_step(&other.w, arena_dt); /* at its last velocity */
  }
  ck_ok(&other.w, mpm_obstacle_set_motion(other.obstacle[1], push_down, &other));
  go_on_alike(&s, &other);
}
END_TEST

/* ---- steps that fail ----------------------------------------------------------------------------------- */
static mpm_status stop(void *user, const mpm_step_info *info) {
  (void)info;
  return *(int32_t *)user;
}

static void must_fail(scene *s, mpm_status wanted, const char *text) {
  const uint64_t was = hash_of(s);
  double before[2][3], after[2][3];
  ck_ok(&s->w, mpm_obstacle_get_pose(s->obstacle[0], before[0], NULL, before[1], NULL));
  ck_refused(&s->w, mpm_step(s->w.stepper, arena_dt, NULL), wanted, text);
  ck_ok(&s->w, mpm_obstacle_get_pose(s->obstacle[0], after[0], NULL, after[1], NULL));
  ck_assert_int_eq(memcmp(before, after, sizeof before), 0);
  ck_assert_uint_eq(hash_of(s), was);
}

START_TEST(failing_steps) {
  const int32_t dim = 2 + _i % 2;
  scene s, same;
  open_scene(&s, &methods[_i], dim, 2);
  open_scene(&same, &methods[_i], dim, 1);
  steps_of(&s, 6);
  steps_of(&same, 6);
  int32_t answer = 5;
  ck_ok(&s.w, mpm_stepper_set_progress(s.w.stepper, stop, &answer));
  must_fail(&s, MPM_CANCELLED, "the progress callback returned 5");
  ck_ok(&s.w, mpm_stepper_set_progress(s.w.stepper, NULL, NULL));
  s.motion_answer = 3;
  must_fail(&s, MPM_CUT_DT, "the motion callback of obstacle 1 returned 3");
  s.motion_answer = -3;
  must_fail(&s, MPM_E_CALLBACK, "the motion callback of obstacle 1 returned -3");
  s.motion_answer = 100;
  must_fail(&s, MPM_NONFINITE, "the motion callback of obstacle 1 gave a velocity that is not finite");
  s.motion_answer = dim == 2 ? 200 : 0;
  if (dim == 2) must_fail(&s, MPM_E_CALLBACK, "out of the grid's axes");
  s.motion_answer = 0;
  s.distance_answer = 4;
  must_fail(&s, MPM_CUT_DT, "the distance callback of an obstacle returned 4");
  s.distance_answer = -4;
  must_fail(&s, MPM_E_CALLBACK, "the distance callback of an obstacle returned -4");
  s.distance_answer = 0;
  static const struct {
    mpm_status status;
    const char *text;
  } bad[] = {{MPM_NONFINITE, "the distance of the callback of an obstacle is not finite at node"},
             {MPM_E_CALLBACK, "has not the length 1 at node"},
             {MPM_NONFINITE, "the normal of the distance callback of an obstacle is not finite at node"},
             {MPM_NONFINITE, "the velocity of the distance callback of an obstacle is not finite at node"},
             {MPM_NONFINITE, "the distance of the callback of an obstacle is not finite at particle"}};
  for (s.spoils = 1; s.spoils <= 5; ++s.spoils)
    must_fail(&s, bad[s.spoils - 1].status, bad[s.spoils - 1].text);
  s.spoils = 0;
  /* a step in parts that is given up */
  ck_ok(&s.w, mpm_step_begin(s.w.stepper, arena_dt));
  ck_ok(&s.w, mpm_step_grid(s.w.stepper));
  ck_refused(&s.w, mpm_obstacle_set_pose(s.obstacle[0], NULL, NULL, NULL, NULL), MPM_E_STATE, "under way");
  ck_refused(&s.w, mpm_obstacle_set_load(s.obstacle[0], NULL, NULL), MPM_E_STATE, "under way");
  ck_refused(&s.w, mpm_obstacle_set_contact(s.obstacle[0], NULL), MPM_E_STATE, "under way");
  ck_refused(&s.w, mpm_obstacle_set_motion(s.obstacle[1], NULL, NULL), MPM_E_STATE, "under way");
  ck_refused(&s.w, mpm_stepper_remove_obstacle(s.w.stepper, s.obstacle[0]), MPM_E_STATE, "under way");
  ck_ok(&s.w, mpm_step_abort(s.w.stepper));
  steps_of(&s, 6);
  steps_of(&same, 6);
  ck_assert_uint_eq(hash_of(&s), hash_of(&same));
  close_scene(&s);
  close_scene(&same);
}
END_TEST

START_TEST(memory_runs_out) {
  scene s, same;
  open_scene(&s, &methods[1], 2, 1);
  open_scene(&same, &methods[1], 2, 1);
  int64_t failures = 0;
  for (int32_t step = 0; step < 8; ++step) {
    world_step(&same.w, arena_dt);
    for (int64_t at = 1;; ++at) {
      const uint64_t was = hash_of(&s);
      s.w.memory.fail_at = s.w.memory.calls + at;
      const mpm_status status = mpm_step(s.w.stepper, arena_dt, &s.w.info);
      s.w.memory.fail_at = 0;
      if (!status) break;
      ck_assert_int_eq(status, MPM_E_NOMEM);
      ck_assert_uint_eq(hash_of(&s), was);
      ++failures;
    }
  }
  ck_assert_int_gt(failures, 10);
  ck_assert_uint_eq(hash_of(&s), hash_of(&same));
  mpm_obstacle *more[8];
  const mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_PLANE);
  for (int32_t i = 0; i < 8; ++i) {
    s.w.memory.fail_at = s.w.memory.calls + 1;
    ck_assert_int_eq(mpm_obstacle_create(s.w.context, &d, &more[i]), MPM_E_NOMEM);
    ck_assert_ptr_null(more[i]);
    s.w.memory.fail_at = 0;
    ck_ok(&s.w, mpm_obstacle_create(s.w.context, &d, &more[i]));
    s.w.memory.fail_at = s.w.memory.calls + 1;
    const mpm_status status = mpm_stepper_add_obstacle(s.w.stepper, more[i]);
    s.w.memory.fail_at = 0;
    if (status) ck_ok(&s.w, mpm_stepper_add_obstacle(s.w.stepper, more[i]));
  }
  for (int32_t i = 0; i < 8; ++i) drop_obstacle(&s.w, more[i]);
  close_scene(&s);
  close_scene(&same);
}
END_TEST

/* ---- states of other obstacles ------------------------------------------------------------------------- */
START_TEST(unlike_states) {
  scene s, other;
  open_scene(&s, &methods[1], 2, 1);
  open_scene(&other, &methods[1], 2, 1);
  steps_of(&s, 3);
  const saved_state state = world_save(&s.w);
  const uint64_t was = hash_of(&other);
  mpm_stepper *to = other.w.stepper;
  ck_ok(&other.w, mpm_stepper_remove_obstacle(to, other.obstacle[3]));
  ck_refused(&other.w, mpm_state_load(to, state.data, state.bytes), MPM_E_FORMAT,
             "number of obstacles is 4 there, 3 here");
  ck_ok(&other.w, mpm_stepper_remove_obstacle(to, other.obstacle[2]));
  ck_ok(&other.w, mpm_stepper_add_obstacle(to, other.obstacle[3]));
  ck_ok(&other.w, mpm_stepper_add_obstacle(to, other.obstacle[2]));
  ck_refused(&other.w, mpm_state_load(to, state.data, state.bytes), MPM_E_FORMAT,
             "obstacle 2: shape is 64 there, 5 here");
  ck_ok(&other.w, mpm_stepper_remove_obstacle(to, other.obstacle[3]));
  ck_ok(&other.w, mpm_stepper_add_obstacle(to, other.obstacle[3]));
  ck_assert_uint_eq(hash_of(&other), was);
  ck_ok(&other.w, mpm_state_load(to, state.data, state.bytes));
  ck_assert_uint_eq(hash_of(&other), hash_of(&s));
  free(state.data);
  close_scene(&s);
  close_scene(&other);
}
END_TEST

/* Reports follow their obstacle when another one goes. */
START_TEST(reports_move_along) {
  scene s;
  open_scene(&s, &methods[1], 2, 1);
  mpm_contact_info info = {.struct_size = sizeof info};
  ck_refused(&s.w, mpm_obstacle_contact_info(s.obstacle[0], 0, &info), MPM_E_STATE, "no step");
  steps_of(&s, 12);
  const mpm_contact_info was = touch_of(&s.w, s.obstacle[2]);
  ck_assert_double_gt(was.impulse[1], 0.0);
  drop_obstacle(&s.w, s.obstacle[1]);
  const mpm_contact_info is = touch_of(&s.w, s.obstacle[2]);
  ck_assert_int_eq(memcmp(&was, &is, sizeof was), 0);
  ck_ok(&s.w, mpm_obstacle_contact_info(s.obstacle[2], 0, &info));
  ck_assert_double_eq(info.impulse[1], was.impulse[1]);
  ck_ok(&s.w, mpm_obstacle_contact_info(s.obstacle[2], 1, &info));
  ck_assert_double_eq(info.impulse[1], 0.0);
  ck_ok(&s.w, mpm_stepper_contact_info(s.w.stepper, MPM_BODY_ANY, 1, &info)); /* of body 0 alone */
  ck_ok(&s.w, mpm_stepper_set_time(s.w.stepper, 0.0, 0));
  ck_assert_double_eq(touch_of(&s.w, s.obstacle[2]).impulse[1], 0.0);
  s.obstacle[1] = s.obstacle[2];
  s.obstacle[2] = s.obstacle[3];
  s.count = 3;
  close_scene(&s);
}
END_TEST

/* ---- refusals ------------------------------------------------------------------------------------------ */
START_TEST(refused_descriptions) {
  mpm_context *c = context_with(1, MPM_ISA_BEST, NULL);
  const mpm_obstacle_desc plane = obstacle_desc(MPM_SHAPE_PLANE);
  mpm_obstacle_desc box = obstacle_desc(MPM_SHAPE_BOX);
  box.size[0] = box.size[1] = box.size[2] = 1.0;
  const struct {
    int32_t offset;
    double value; /* of a double there */
    const char *text;
  } bad[] = {{offsetof(mpm_obstacle_desc, size), 0.0, "size[0] is 0: it must be positive"},
             {offsetof(mpm_obstacle_desc, size) + 16, -1.0, "size[2] is -1"},
             {offsetof(mpm_obstacle_desc, size) + 8, INFINITE, "size[1] is inf"},
             {offsetof(mpm_obstacle_desc, position) + 8, NOT_A_NUMBER, "position[1] is"},
             {offsetof(mpm_obstacle_desc, orientation), 1.1, "orientation has length 1.1"},
             {offsetof(mpm_obstacle_desc, orientation) + 24, INFINITE, "orientation[3] is inf"},
             {offsetof(mpm_obstacle_desc, mass), 0.0, "mass of a free obstacle is 0: it must be positive"},
             {offsetof(mpm_obstacle_desc, inertia) + 8, INFINITE, "inertia[1] is inf"},
             {offsetof(mpm_obstacle_desc, velocity), NOT_A_NUMBER, "velocity[0] is"},
             {offsetof(mpm_obstacle_desc, angular_velocity) + 8, INFINITE, "angular_velocity[1] is inf"}};
  mpm_obstacle *o;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
    mpm_obstacle_desc d = box;
    d.motion = MPM_MOTION_FREE;
    d.mass = d.inertia[0] = d.inertia[4] = d.inertia[8] = 1.0;
    memcpy((char *)&d + bad[i].offset, &bad[i].value, sizeof bad[i].value);
    o = (mpm_obstacle *)(void *)&d;
    ck_refused(c, mpm_obstacle_create(c, &d, &o), MPM_E_ARG, bad[i].text);
    ck_assert_ptr_null(o);
  }
#define REFUSED(status, text, ...)                                                                           \
  do {                                                                                                       \
    mpm_obstacle_desc d = plane;                                                                             \
    __VA_ARGS__;                                                                                             \
    ck_refused(c, mpm_obstacle_create(c, &d, &o), status, text);                                             \
  } while (0)
  mpm_contact_desc rule = rule_with(0.0);
  REFUSED(MPM_E_ARG, "shape is 0", d.shape = 0);
  REFUSED(MPM_E_ARG, "shape is 6", d.shape = 6);
  REFUSED(MPM_E_ARG, "motion is 3", d.motion = 3);
  REFUSED(MPM_E_ARG, "inside is 2", d.inside = 2);
  REFUSED(MPM_E_ARG, "distance is NULL", d.shape = MPM_SHAPE_DISTANCE);
  REFUSED(MPM_E_ARG, "lower[1] is 2 and upper[1] is 1", d.shape = MPM_SHAPE_DISTANCE; d.distance = slope;
          d.lower[1] = 2.0; d.upper[1] = 1.0);
  REFUSED(MPM_E_UNSUPPORTED, "has no bounds", d.shape = MPM_SHAPE_DISTANCE; d.distance = slope; d.inside = 1;
          d.upper[1] = 1.0);
  REFUSED(MPM_E_UNSUPPORTED, "use MPM_MOTION_PRESCRIBED", d.velocity[2] = 1.0);
  REFUSED(MPM_E_ARG, "kind is 3", rule.kind = 3; d.contact = &rule);
  REFUSED(MPM_E_ARG, "friction is -1", rule = rule_with(-1.0); d.contact = &rule);
  REFUSED(MPM_E_ARG, "friction_static is 0.1, less than friction 0.2", rule = rule_with(0.2);
          rule.friction_static = 0.1; d.contact = &rule);
  REFUSED(MPM_E_ARG, "adhesion is -1", rule = rule_with(0.2); rule.adhesion = -1.0; d.contact = &rule);
  REFUSED(MPM_E_ARG, "offset is inf", rule = rule_with(0.2); rule.offset = INFINITE; d.contact = &rule);
  REFUSED(MPM_E_ARG, "mpm_contact_desc", rule = rule_with(0.2); rule.struct_size = 3; d.contact = &rule);
#undef REFUSED
  ck_refused(c, mpm_obstacle_create(c, &plane, NULL), MPM_E_ARG, "out is NULL");
  ck_refused(c, mpm_obstacle_create(c, NULL, &o), MPM_E_ARG, "mpm_obstacle_desc is NULL");
  ck_assert_int_eq(mpm_obstacle_desc_init(NULL, sizeof plane), MPM_E_ARG);
  ck_assert_int_eq(mpm_obstacle_destroy(NULL), MPM_OK);
  ck_ok(c, mpm_obstacle_create(c, &plane, &o));
  ck_refused(c, mpm_context_destroy(c), MPM_E_STATE, "");
  const double one[3] = {1.0, 0.0, 0.0}, bad_turn[4] = {1.0, 1.0, 0.0, 0.0}, far[3] = {INFINITE, 0.0, 0.0};
  mpm_contact_info info = {.struct_size = sizeof info};
  ck_refused(c, mpm_obstacle_set_pose(o, NULL, NULL, one, NULL), MPM_E_UNSUPPORTED, "has no velocities");
  ck_refused(c, mpm_obstacle_set_pose(o, NULL, bad_turn, NULL, NULL), MPM_E_ARG, "unit quaternion");
  ck_refused(c, mpm_obstacle_set_pose(o, far, NULL, NULL, NULL), MPM_E_ARG, "position[0] is inf");
  ck_refused(c, mpm_obstacle_set_load(o, one, NULL), MPM_E_UNSUPPORTED, "only MPM_MOTION_FREE takes a load");
  ck_refused(c, mpm_obstacle_set_motion(o, push_down, NULL), MPM_E_UNSUPPORTED, "has a callback");
  ck_refused(c, mpm_obstacle_contact_info(o, 0, &info), MPM_E_STATE, "in no stepper");
  ck_refused(c, mpm_obstacle_contact_info(o, 0, NULL), MPM_E_ARG, "info is NULL");
  ck_refused(c, mpm_obstacle_contact_info(o, -2, &info), MPM_E_ARG, "body is -2");
  ck_ok(c, mpm_obstacle_destroy(o));
  ck_ok(c, mpm_context_destroy(c));
}
END_TEST

START_TEST(refused_by_the_grid) {
  const int32_t dim = _i;
  world w, other;
  open_arena(&w, &(arena){.dim = dim, .method = methods[1]});
  open_arena(&other, &(arena){.dim = dim, .method = methods[1]});
  mpm_obstacle *o;
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_CAPSULE);
  d.size[0] = d.size[1] = 1.0;
  ck_ok(&w, mpm_obstacle_create(w.context, &d, &o));
  if (dim < 3)
    ck_refused(&w, mpm_stepper_add_obstacle(w.stepper, o), MPM_E_UNSUPPORTED,
               dim == 1 ? "use MPM_SHAPE_PLANE" : "use MPM_SHAPE_SPHERE or MPM_SHAPE_BOX");
  ck_ok(&w, mpm_obstacle_destroy(o));
  d = obstacle_desc(MPM_SHAPE_PLANE);
  d.motion = MPM_MOTION_FREE;
  d.mass = 1.0;
  d.angular_velocity[0] = 1.0;
  ck_ok(&w, mpm_obstacle_create(w.context, &d, &o));
  ck_refused(&w, mpm_stepper_add_obstacle(w.stepper, o), MPM_E_ARG,
             dim < 3 ? "does not stay in a" : "is not positive definite");
  ck_ok(&w, mpm_obstacle_destroy(o));
  d.angular_velocity[0] = 0.0;
  d.inertia[0] = d.inertia[4] = d.inertia[8] = 1.0;
  ck_ok(&w, mpm_obstacle_create(w.context, &d, &o));
  ck_refused(&other, mpm_stepper_add_obstacle(other.stepper, o), MPM_E_ARG, "of another context");
  ck_refused(&w, mpm_stepper_add_obstacle(w.stepper, NULL), MPM_E_ARG, "obstacle is NULL");
  ck_refused(&w, mpm_stepper_remove_obstacle(w.stepper, o), MPM_E_NOT_FOUND, "not in this stepper");
  ck_ok(&w, mpm_stepper_add_obstacle(w.stepper, o));
  ck_refused(&w, mpm_stepper_add_obstacle(w.stepper, o), MPM_E_STATE, "already belongs to this");
  ck_refused(&w, mpm_obstacle_destroy(o), MPM_E_STATE, "call mpm_stepper_remove_obstacle() first");
  const double turned[4] = {0.0, 1.0, 0.0, 0.0};
  if (dim < 3)
    ck_refused(&w, mpm_obstacle_set_pose(o, NULL, turned, NULL, NULL), MPM_E_ARG, "does not stay in a");
  mpm_obstacle *bad;
  mpm_obstacle_desc flat = obstacle_desc(MPM_SHAPE_DISTANCE);
  flat.distance = slope;
  flat.upper[0] = dim == 1 ? 0.0 : 1.0, flat.upper[1] = dim == 1 ? 1.0 : 0.0, flat.upper[2] = 1.0;
  ck_ok(&w, mpm_obstacle_create(w.context, &flat, &bad));
  ck_refused(&w, mpm_stepper_add_obstacle(w.stepper, bad), MPM_E_ARG, "bounds have a length on each axis");
  ck_ok(&w, mpm_obstacle_destroy(bad));
  d.inertia[0] = d.inertia[4] = d.inertia[8] = 1e300;
  ck_ok(&w, mpm_obstacle_create(w.context, &d, &bad));
  if (dim == 3)
    ck_refused(&w, mpm_stepper_add_obstacle(w.stepper, bad), MPM_E_ARG,
               "inertia[0] of a free obstacle is 1e+300");
  ck_ok(&w, mpm_obstacle_destroy(bad));
  mpm_stepper_desc implicit = stepper_desc();
  implicit.scheme = MPM_NEWMARK;
  ck_refused(&w, mpm_stepper_configure(w.stepper, &implicit), MPM_E_UNSUPPORTED, "has no free obstacles");
  ck_ok(&w, mpm_stepper_remove_obstacle(w.stepper, o));
  ck_ok(&w, mpm_stepper_configure(w.stepper, &implicit));
  ck_refused(&w, mpm_stepper_add_obstacle(w.stepper, o), MPM_E_UNSUPPORTED, "has no free obstacles");
  ck_ok(&w, mpm_obstacle_destroy(o));
  world_close(&w);
  world_close(&other);
}
END_TEST

/* A stepper that goes lets its obstacles go. */
START_TEST(outlives_the_stepper) {
  world w;
  open_arena(&w, &(arena){.dim = 2, .method = methods[1]});
  mpm_stepper_desc d = stepper_desc();
  mpm_stepper *second;
  ck_ok(&w, mpm_stepper_create(w.context, w.grid, &d, &second));
  mpm_obstacle_desc plane = obstacle_desc(MPM_SHAPE_PLANE);
  mpm_obstacle *o;
  ck_ok(&w, mpm_obstacle_create(w.context, &plane, &o));
  ck_ok(&w, mpm_stepper_add_obstacle(second, o));
  ck_ok(&w, mpm_stepper_destroy(second));
  ck_ok(&w, mpm_stepper_add_obstacle(w.stepper, o));
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

/* ---- nodes that the host is asked for ------------------------------------------------------------------ */
/* A floor that is known only where the grid has nodes, and nowhere near one place. */
typedef struct floor_in_grid {
  int32_t first, answer; /* first: axis from which on the grid has faces */
  double low, high, height, unknown[3];
} floor_in_grid;

static mpm_status floor_of(void *user, const mpm_distance_batch *b) {
  const floor_in_grid *f = user;
  const int32_t up = b->dim > 1;
  for (int64_t i = 0; i < b->n; ++i) {
    double off = 0.0;
    b->distance[i] = b->position[up * b->ld + i] - f->height;
    for (int32_t k = 0; k < b->dim; ++k) {
      const double x = b->position[k * b->ld + i];
      b->normal[k * b->ld + i] = k == up;
      off = fmax(off, fabs(x - f->unknown[k]));
      if (k >= f->first && !(x >= f->low && x <= f->high)) b->distance[i] = NOT_A_NUMBER;
    }
    if (off < 0.01 * arena_spacing) b->distance[i] = NOT_A_NUMBER;
  }
  return f->answer;
}

static int64_t failed_node(const world *w, mpm_status wanted) {
  mpm_step_info info = {.struct_size = sizeof info};
  ck_refused(w, mpm_step(w->stepper, arena_dt, &info), wanted, "callback of an obstacle");
  return info.node;
}

START_TEST(asked_for_nodes_of_the_grid) {
  static const struct {
    int32_t basis, boundary;
    double beyond; /* spacings from the faces to the last node */
  } cases[] = {{MPM_LINEAR, MPM_BOUNDARY_GHOST, 0.0},       {MPM_BSPLINE2, MPM_BOUNDARY_GHOST, 1.0},
               {MPM_BSPLINE3, MPM_BOUNDARY_GHOST, 1.0},     {MPM_GIMP, MPM_BOUNDARY_GHOST, 1.0},
               {MPM_BSPLINE2, MPM_BOUNDARY_OPEN_KNOT, 0.0}, {MPM_BSPLINE3, MPM_BOUNDARY_OPEN_KNOT, 0.0}};
  enum { CELLS = 14, NODES = CELLS + 3, AT = 5 };
  const double h = arena_spacing, lower[3] = {5.0 * h, 5.0 * h, 5.0 * h},
               upper[3] = {9.0 * h, 9.0 * h, 9.0 * h};
  const double down[3] = {-arena_speed, -arena_speed, 0.0};
  const int32_t dim = 1 + _i % 3;
  for (int32_t c = 0; c < 6; ++c)
    for (int32_t periodic = 0; periodic < (dim > 1 ? 2 : 1); ++periodic) {
      world w;
      world_desc desc = world_with(&methods[0], dim, CELLS, h);
      desc.grid.basis = cases[c].basis;
      desc.grid.boundary_basis = cases[c].boundary;
      desc.grid.periodic[0] = periodic;
      mpm_particles *set = world_open(&w, &desc);
      world_fill(&w, set, lower, upper, 2);
      ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, down + (dim == 1)));
      const double margin = (cases[c].beyond + 1e-9) * h;
      floor_in_grid of = {.first = periodic, .low = -margin, .high = CELLS * h + margin, .height = 5.0 * h};
      for (int32_t k = 0; k < 3; ++k) of.unknown[k] = INFINITE;
      mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_DISTANCE);
      for (int32_t k = 0; k < 3; ++k) d.position[k] = 0.0;
      d.distance = floor_of;
      d.user = &of;
      mpm_obstacle *floor = put_obstacle(&w, &d);
      for (int32_t i = 0; i < 4; ++i) world_step(&w, arena_dt);
      ck_assert_double_ne(touch_of(&w, floor).impulse[dim > 1], 0.0);
      int64_t nodes = 1, wanted = 0;
      for (int32_t k = 0; k < dim; ++k) nodes *= NODES, wanted = wanted * NODES + AT + 1;
      of.answer = -3;
      int64_t node = failed_node(&w, MPM_E_CALLBACK);
      ck_holds(node >= 0 && node < nodes);
      of.answer = 0;
      for (int32_t k = 0; k < dim; ++k) of.unknown[k] = AT * h;
      if (cases[c].boundary == MPM_BOUNDARY_GHOST) ck_holds(failed_node(&w, MPM_NONFINITE) == wanted);
      for (int32_t k = 0; k < 3; ++k) of.unknown[k] = INFINITE;
      world_step(&w, arena_dt);
      drop_obstacle(&w, floor);
      world_close(&w);
    }
}
END_TEST

/* ---- shapes -------------------------------------------------------------------------------------------- */
/* Distances are no farther apart than their points, and have their gradients where these exist. */
START_TEST(shapes) {
  static const int32_t kind[] = {MPM_SHAPE_PLANE, MPM_SHAPE_SPHERE, MPM_SHAPE_CYLINDER, MPM_SHAPE_CAPSULE,
                                 MPM_SHAPE_BOX};
  const double size[3] = {0.7, 0.5, 0.9}, step = 1e-6;
  for (size_t s = 0; s < sizeof kind / sizeof *kind; ++s)
    for (int32_t dim = 1; dim <= 3; ++dim) {
      int32_t agree = 0;
      if ((dim == 1 && s) || (dim == 2 && (s == 2 || s == 3))) continue;
      for (uint64_t p = 0; p < 400; ++p) {
        double x[3] = {0.0, 0.0, 0.0}, n[3], unused[3], squared = 0.0, wrong = 0.0;
        for (int32_t k = 0; k < dim; ++k) x[k] = 3.0 * noise_at(3 * p + (uint64_t)k);
        const double at = mpmi_shape_distance(kind[s], dim, size, x, n);
        for (int32_t k = 0; k < dim; ++k) {
          double y[3] = {x[0], x[1], x[2]};
          y[k] += step;
          const double slope_k = (mpmi_shape_distance(kind[s], dim, size, y, unused) - at) / step;
          ck_assert_double_le(fabs(slope_k), 1.0 + 1e-9);
          wrong = fmax(wrong, fabs(slope_k - n[k]));
          squared += n[k] * n[k];
        }
        ck_within("unit", squared, 1.0, 1e-14);
        agree += wrong < 1e-4;
      }
      ck_assert_int_gt(agree, 390);
    }
  double n[3];
  ck_within("box", mpmi_shape_distance(MPM_SHAPE_BOX, 3, size, (const double[]){1.7, 1.5, 1.9}, n), sqrt(3.0),
            1e-15);
  ck_within("box", mpmi_shape_distance(MPM_SHAPE_BOX, 2, size, (const double[]){0.1, -0.4, 9.0}, n), -0.1,
            1e-15);
  ck_within("box", n[1], -1.0, 0.0);
  ck_within("cylinder", mpmi_shape_distance(MPM_SHAPE_CYLINDER, 3, size, (const double[]){0.0, 1.0, -0.9}, n),
            0.5, 1e-15);
  ck_within("capsule", mpmi_shape_distance(MPM_SHAPE_CAPSULE, 3, size, (const double[]){0.0, 0.0, 1.5}, n),
            0.3, 1e-15);
  ck_within("sphere", mpmi_shape_distance(MPM_SHAPE_SPHERE, 3, size, (const double[]){0.0, 0.0, 0.0}, n),
            -0.7, 0.0);
  ck_within("sphere", n[0], 1.0, 0.0);
}
END_TEST

void add_obstacle_states(Suite *suite) {
  TCase *bits = tcase_create("bits"), *refusals = tcase_create("refusals"), *counts = tcase_create("threads");
  tcase_add_loop_test(counts, threads, 0, BROAD);
  tcase_add_loop_test(bits, saved_in_contact, 0, BROAD);
  tcase_add_loop_test(bits, motion_is_awaited, 0, METHODS);
  tcase_add_loop_test(bits, failing_steps, 0, METHODS);
  tcase_add_loop_test(bits, asked_for_nodes_of_the_grid, 0, 3);
  tcase_add_test(bits, memory_runs_out);
  tcase_add_test(bits, unlike_states);
  tcase_add_test(bits, reports_move_along);
  tcase_add_test(refusals, refused_descriptions);
  tcase_add_loop_test(refusals, refused_by_the_grid, 1, 4);
  tcase_add_test(refusals, outlives_the_stepper);
  tcase_add_test(refusals, shapes);
  tcase_set_tags(counts, "long");
  tcase_set_timeout(bits, 60);
  tcase_set_timeout(counts, 60);
  suite_add_tcase(suite, bits);
  suite_add_tcase(suite, counts);
  suite_add_tcase(suite, refusals);
}
