/* Obstacles: what contact with them keeps and reports, how they move, and that they are the walls that they
 * look like. Their numbers are verified by the cases obstacle_... of the verification. */
#include "obstacle.h"

/* ---- what contact with an obstacle keeps --------------------------------------------------------------- */
/* An obstacle of each shape just below the box, into which the box flies; the material of a container is
 * inside. In 1-D there are planes alone. */
typedef struct meeting {
  int32_t shape, inside, motion;
} meeting;
static const meeting meetings[] = {
    {MPM_SHAPE_PLANE, 0, MPM_MOTION_FIXED},   {MPM_SHAPE_PLANE, 0, MPM_MOTION_PRESCRIBED},
    {MPM_SHAPE_PLANE, 0, MPM_MOTION_FREE},    {MPM_SHAPE_PLANE, 1, MPM_MOTION_FIXED},
    {MPM_SHAPE_SPHERE, 0, MPM_MOTION_FREE},   {MPM_SHAPE_SPHERE, 1, MPM_MOTION_PRESCRIBED},
    {MPM_SHAPE_BOX, 0, MPM_MOTION_FREE},      {MPM_SHAPE_BOX, 1, MPM_MOTION_FREE},
    {MPM_SHAPE_CYLINDER, 0, MPM_MOTION_FREE}, {MPM_SHAPE_CYLINDER, 1, MPM_MOTION_FIXED},
    {MPM_SHAPE_CAPSULE, 0, MPM_MOTION_FREE},  {MPM_SHAPE_CAPSULE, 1, MPM_MOTION_FREE}};
enum { MEETINGS = sizeof meetings / sizeof *meetings };

static int32_t exists_in(int32_t shape, int32_t dim) {
  if (dim == 1) return shape == MPM_SHAPE_PLANE;
  return dim == 3 || (shape != MPM_SHAPE_CYLINDER && shape != MPM_SHAPE_CAPSULE);
}

static mpm_obstacle_desc obstacle_of(const meeting *m, int32_t dim) {
  const double h = arena_spacing;
  const int32_t down = dim == 1 ? 0 : 1; /* the axis along which the box flies */
  mpm_obstacle_desc d = obstacle_desc(m->shape);
  d.inside = m->inside;
  d.motion = m->motion;
  d.size[0] = d.size[1] = d.size[2] = m->inside ? 2.1 * h : 1.6 * h;
  if (m->inside && m->shape != MPM_SHAPE_BOX) d.size[0] = 2.8 * h;
  if (!m->inside) d.position[down] -= m->shape == MPM_SHAPE_CAPSULE ? 3.7 * h : 3.6 * h;
  if (m->shape == MPM_SHAPE_PLANE) d.position[down] = 5.0 * h;
  if (m->shape == MPM_SHAPE_PLANE && m->inside) d.orientation[0] = 0.0, d.orientation[3] = 1.0;
  if (dim == 3 && m->shape >= MPM_SHAPE_CYLINDER) {
    const double q[4] = {0.96, 0.0, 0.16, 0.0};
    const double length = sqrt(q[0] * q[0] + q[2] * q[2]);
    for (int32_t k = 0; k < 4; ++k) d.orientation[k] = q[k] / length;
  }
  if (m->motion != MPM_MOTION_FIXED) d.velocity[down] = 0.3;
  if (m->motion != MPM_MOTION_FIXED && dim > 1) d.angular_velocity[2] = 0.2;
  if (m->motion != MPM_MOTION_FREE) return d;
  d.mass = 300.0;
  for (int32_t k = 0; k < 3; ++k) d.inertia[4 * k] = 20.0 + 5.0 * k;
  d.inertia[1] = d.inertia[3] = 2.0;
  return d;
}

/* I w about the centre, in space. */
static void spin_momentum(const mpm_obstacle *obstacle, const mpm_obstacle_desc *d, int32_t dim, double *L) {
  double q[4], w[3], axis[3][3], local[3], of_body[3];
  ck_assert_int_eq(mpm_obstacle_get_pose(obstacle, NULL, q, NULL, w), MPM_OK);
  mpmi_pose_axes(q, axis);
  for (int32_t k = 0; k < 3; ++k) local[k] = axis[k][0] * w[0] + axis[k][1] * w[1] + axis[k][2] * w[2];
  for (int32_t k = 0; k < 3; ++k)
    of_body[k] = dim == 3 ? d->inertia[3 * k] * local[0] + d->inertia[3 * k + 1] * local[1] +
                                d->inertia[3 * k + 2] * local[2]
                          : (k == 2 ? d->inertia[8] * local[2] : 0.0);
  for (int32_t c = 0; c < 3; ++c)
    L[c] = axis[0][c] * of_body[0] + axis[1][c] * of_body[1] + axis[2][c] * of_body[2];
}

/* What the material gains is what the obstacle reports, and what a free one loses; energy is never gained. */
static void follow(world *w, const mpm_obstacle_desc *d, const arena *of, const char *name) {
  mpm_obstacle *o = put_obstacle(w, d);
  const mpm_step_info start = world_info(w);
  const double energy = start.kinetic_energy, mass = energy / (0.5 * arena_speed * arena_speed),
               dt = arena_dt;
  double sum[3] = {0.0, 0.0, 0.0};
  int64_t closed = 0;
  const int32_t steps = of->dim == 3 && w->desc.stepper.scheme == MPM_NEWMARK ? 12 : 36;
  for (int32_t i = 0; i < steps; ++i) {
    double v[2][3], L[2][3];
    const mpm_step_info before = world_info(w);
    ck_ok(w, mpm_obstacle_get_pose(o, NULL, NULL, v[0], NULL));
    spin_momentum(o, d, of->dim, L[0]);
    const int32_t staged = i % 3 == 0 && w->desc.stepper.scheme != MPM_NEWMARK;
    const mpm_step_info info = staged ? world_staged_step(w, dt) : world_step(w, dt);
    const mpm_contact_info got = touch_of(w, o);
    ck_ok(w, mpm_obstacle_get_pose(o, NULL, NULL, v[1], NULL));
    spin_momentum(o, d, of->dim, L[1]);
    ck_between(name, info.contact_dissipation, -1e-12 * energy, energy);
    ck_within(name, got.dissipation, info.contact_dissipation, 1e-12 * energy);
    for (int32_t c = 0; c < of->dim; ++c) {
      ck_within(name, info.momentum[c] - before.momentum[c], dt * got.force[c], 1e-11 * mass * arena_speed);
      sum[c] += dt * got.force[c];
      ck_within(name, got.impulse[c], sum[c], 1e-11 * mass * arena_speed);
      if (d->motion == MPM_MOTION_FREE)
        ck_within(name, d->mass * (v[1][c] - v[0][c]), -dt * got.force[c], 1e-11 * mass * arena_speed);
    }
    for (int32_t c = 0; c < 3 && d->motion == MPM_MOTION_FREE; ++c)
      ck_within(name, L[1][c] - L[0][c], dt * got.torque[c], 1e-11 * mass * arena_speed);
    if (d->motion == MPM_MOTION_FIXED) ck_within(name, info.external_work, 0.0, 1e-12 * energy);
    closed += info.contact_nodes;
  }
  ck_assert_int_gt(closed, 0);
  drop_obstacle(w, o);
}

START_TEST(momentum_and_energy) {
  const method *how = broad_methods[_i];
  if (how->staggered) return;
  for (int32_t dim = 1; dim <= 3; ++dim) {
    if (dim == 1 && how->remedy) continue;
    for (int32_t m = _i % 2; m < MEETINGS; m += 2) { /* the other half with the next method */
      if (!exists_in(meetings[m].shape, dim) || (dim == 1 && meetings[m].inside)) continue;
      char name[96];
      snprintf(name, sizeof name, "%s, %d-D, meeting %d", how->name, (int)dim, (int)m);
      const arena of = {.dim = dim, .method = *how};
      const mpm_contact_desc rule = rule_with(m % 3 ? 0.3 : 0.0);
      mpm_obstacle_desc d = obstacle_of(&meetings[m], dim);
      d.contact = &rule;
      if (how->scheme == MPM_NEWMARK && d.motion == MPM_MOTION_FREE) d.motion = MPM_MOTION_PRESCRIBED;
      world w;
      open_arena(&w, &of);
      follow(&w, &d, &of, name);
      world_close(&w);
    }
  }
}
END_TEST

/* Friction on a plane is Coulomb's; a plane that moves does the work of its force. */
START_TEST(friction_and_work) {
  const method *how = &methods[_i];
  for (int32_t dim = 1; dim <= 3; ++dim) {
    world w;
    open_arena(&w, &(arena){.dim = dim, .method = *how});
    mpm_obstacle_desc d = obstacle_of(&meetings[1], dim);
    const mpm_contact_desc rule = rule_with(0.2);
    const int32_t down = dim == 1 ? 0 : 1;
    d.contact = &rule;
    d.angular_velocity[2] = 0.0;
    mpm_obstacle *o = put_obstacle(&w, &d);
    double pressed = 0.0;
    for (int32_t i = 0; i < 30; ++i) {
      const mpm_step_info info = world_step(&w, arena_dt);
      const mpm_contact_info got = touch_of(&w, o);
      double along = 0.0, work = 0.0;
      for (int32_t c = 0; c < dim; ++c) along += c == down ? 0.0 : got.force[c] * got.force[c];
      for (int32_t c = 0; c < dim; ++c) work += arena_dt * got.force[c] * d.velocity[c];
      ck_assert_double_ge(got.force[down], 0.0);
      ck_within(how->name, got.normal_force, got.force[down], 1e-12 * got.normal_force);
      ck_between(how->name, sqrt(along), 0.0, 0.2 * got.force[down] * (1.0 + 1e-12) + 1e-12);
      ck_within(how->name, info.external_work, work, 1e-12 * info.kinetic_energy);
      pressed = fmax(pressed, got.force[down]);
    }
    ck_assert_double_gt(pressed, 0.0);
    drop_obstacle(&w, o);
    world_close(&w);
  }
}
END_TEST

/* ---- obstacles that are the same ----------------------------------------------------------------------- */
/* A friction wall is the plane of its face, bit by bit. */
START_TEST(walls_are_planes) {
  const method *how = broad_methods[_i];
  for (int32_t dim = 1; dim <= 3; ++dim) {
    if (dim == 1 && how->remedy) continue;
    const int32_t down = dim == 1 ? 0 : 1;
    world w[2];
    mpm_obstacle *o = NULL;
    double force[3];
    for (int32_t i = 0; i < 2; ++i) {
      open_arena(&w[i], &(arena){.dim = dim, .method = *how});
      const int64_t n = mpm_particles_count(w[i].set[0]);
      double *x = fetch(&w[i], w[i].set[0], "position", dim);
      for (int64_t p = 0; p < n; ++p) x[down * n + p] -= 4.9 * arena_spacing;
      put(&w[i], w[i].set[0], "position", dim, x);
      free(x);
    }
    ck_ok(&w[0], mpm_stepper_set_wall(w[0].stepper, 2 * down, MPM_WALL_FRICTION, 0.4));
    mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_PLANE);
    const mpm_contact_desc rule = rule_with(0.4);
    d.contact = &rule;
    d.position[down] = 0.0;
    o = put_obstacle(&w[1], &d);
    for (int32_t step = 0; step < 20; ++step)
      for (int32_t i = 0; i < 2; ++i) world_step(&w[i], arena_dt);
    world_agree(how->name, &w[0], &w[1], "velocity", dim, 0.0);
    world_agree(how->name, &w[0], &w[1], "stress", 6, 0.0);
    ck_ok(&w[0], mpm_stepper_wall_reaction(w[0].stepper, 2 * down, force));
    for (int32_t c = 0; c < dim; ++c) ck_within(how->name, touch_of(&w[1], o).force[c], force[c], 0.0);
    int64_t n;
    double *of_nodes = fetch_nodes(&w[0], "reaction", &n), largest = 0.0;
    for (int32_t c = 0; c < dim; ++c) largest = fmax(largest, fabs(force[c]));
    for (int32_t c = 0; c < dim; ++c)
      ck_within(how->name, sum_of(n, of_nodes + c * n), force[c], 1e-12 * largest);
    free(of_nodes);
    ck_assert_double_gt(touch_of(&w[1], o).impulse[down], 0.0);
    drop_obstacle(&w[1], o);
    for (int32_t i = 0; i < 2; ++i) world_close(&w[i]);
  }
}
END_TEST

/* A plane that is turned by a hair against a slip wall squeezes the material between them, and throws none of
 * it along the wall. */
START_TEST(squeezed) {
  method how = methods[1];
  how.scheme = _i ? MPM_NEWMARK : MPM_USL;
  world w;
  world_desc desc = world_with(&how, 2, 12, arena_spacing);
  world_open(&w, &desc);
  const double h = arena_spacing, lower[2] = {4.0 * h, 0.0}, upper[2] = {8.0 * h, 1.0 * h}, turn = 5e-4;
  const int64_t n = world_fill(&w, w.set[0], lower, upper, 2);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_SLIP, 0.0));
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_PLANE);
  d.motion = MPM_MOTION_PRESCRIBED;
  d.inside = 1;
  d.position[0] = 6.0 * h;
  d.position[1] = 1.02 * h;
  d.orientation[0] = cos(0.5 * turn);
  d.orientation[3] = sin(0.5 * turn);
  d.velocity[1] = -arena_speed;
  mpm_obstacle *o = put_obstacle(&w, &d);
  for (int32_t step = 0; step < 20; ++step) world_step(&w, arena_dt);
  ck_assert_double_lt(touch_of(&w, o).impulse[1], 0.0);
  double *v = fetch(&w, w.set[0], "velocity", 2), most = 0.0;
  for (int64_t p = 0; p < n; ++p) most = fmax(most, fabs(v[p]));
  ck_assert_double_lt(most, 2.0 * arena_speed);
  free(v);
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

/* A plane moves along the only axis on which a fixed wall holds the nodes that it touches: that cannot be
 * stopped, by ties as little as by friction, and is no reason to let go. */
START_TEST(implicit_held) {
  const double h = arena_spacing, lower[2] = {0.0, 0.0}, upper[2] = {0.5 * h, 4.0 * h};
  method how = methods[1];
  how.scheme = MPM_NEWMARK;
  how.basis = MPM_LINEAR;
  world w;
  world_desc desc = world_with(&how, 2, 8, h);
  world_open(&w, &desc);
  world_fill(&w, w.set[0], lower, upper, 2);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
  mpm_contact_desc rule = rule_with(0.5);
  rule.kind = _i ? MPM_CONTACT_TIED : MPM_CONTACT_UNILATERAL;
  rule.friction_static = 100.0;
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_PLANE);
  d.contact = &rule;
  d.motion = MPM_MOTION_PRESCRIBED;
  d.position[1] = 0.02 * h;
  d.velocity[0] = 0.2 * arena_speed;
  d.velocity[1] = 0.1 * arena_speed;
  mpm_obstacle *o = put_obstacle(&w, &d);
  for (int32_t step = 0; step < 10; ++step) world_step(&w, arena_dt);
  const mpm_contact_info info = touch_of(&w, o);
  ck_assert_int_eq(info.ambiguous, 0);
  ck_assert_double_gt(info.impulse[1], 0.0);
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

/* Implicit steps at a corner of a slip wall and a friction wall: what particles gain along the slip wall
 * is what the other one gives, and weight; at rest both walls bear the weight. Reactions of nodes add up
 * to those of the walls. */
START_TEST(implicit_corner) {
  static const int32_t basis[] = {MPM_LINEAR, MPM_BSPLINE2, MPM_BSPLINE3, MPM_GIMP};
  const int32_t rests = _i / 4;
  for (int32_t dim = 2; dim <= 3; ++dim) {
    const double h = arena_spacing, gravity[3] = {-3.0, -10.0, 0.5};
    method how = methods[1];
    how.scheme = MPM_NEWMARK;
    how.basis = basis[_i % 4];
    how.transfer = MPM_FLIP;
    how.flip = 1.0;
    world w;
    world_desc desc = world_with(&how, dim, 8, h);
    memcpy(desc.stepper.gravity, gravity, sizeof gravity);
    desc.stepper.quasi_static = rests;
    desc.stepper.newton_max_iterations = 60;
    world_open(&w, &desc);
    const double lower[3] = {0.0, 0.0, 2.0 * h}, upper[3] = {3.0 * h, 3.0 * h, 5.0 * h};
    const int64_t n = world_fill(&w, w.set[0], lower, upper, 2);
    double *mass = fetch(&w, w.set[0], "mass", 1);
    const double total = sum_of(n, mass), dt = 10.0 * arena_dt;
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_SLIP, 0.0));
    ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FRICTION, 0.3));
    double pushed = 0.0;
    for (int32_t step = 0; step < 10; ++step) {
      const mpm_step_info before = world_info(&w), after = world_step(&w, dt);
      double force[2][3];
      ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MIN, force[0]));
      ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_Y_MIN, force[1]));
      const double scale = total * 10.0 * dt * (step + 1);
      int64_t nodes;
      double *of_nodes = fetch_nodes(&w, "reaction", &nodes);
      for (int32_t c = 0; c < dim; ++c) {
        const double reaction = force[0][c] + force[1][c],
                     gained = rests ? 0.0 : after.momentum[c] - before.momentum[c];
        ck_within(how.name, dt * sum_of(nodes, of_nodes + c * nodes), dt * reaction, 1e-7 * scale);
        if (c > 0 || rests) ck_within(how.name, gained, dt * (reaction + total * gravity[c]), 1e-7 * scale);
      }
      free(of_nodes);
      ck_between(how.name, after.contact_dissipation, -1e-12 * scale, scale);
      pushed += force[1][1];
    }
    ck_assert_double_gt(pushed, 0.0);
    free(mass);
    world_close(&w);
  }
}
END_TEST

/* What touches a ceiling at rest falls off it in implicit steps as if there were none. */
START_TEST(implicit_release) {
  const int32_t dim = _i;
  const double h = arena_spacing, fall = 10.0, dt = 10.0 * arena_dt;
  const double lower[3] = {3.0 * h, 3.0 * h, 3.0 * h}, upper[3] = {5.0 * h, 5.0 * h, 5.0 * h};
  const int32_t up = dim == 1 ? 0 : 1;
  method how = methods[1];
  how.scheme = MPM_NEWMARK;
  world w;
  world_desc desc = world_with(&how, dim, 8, h);
  desc.stepper.gravity[up] = -fall;
  world_open(&w, &desc);
  world_fill(&w, w.set[0], lower, upper, 2);
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_PLANE);
  const mpm_contact_desc rule = rule_with(0.3);
  d.contact = &rule;
  d.inside = 1;
  d.position[up] = upper[up];
  mpm_obstacle *o = put_obstacle(&w, &d);
  mpm_step_info now = world_info(&w);
  for (int32_t step = 0; step < 5; ++step) now = world_step(&w, dt);
  double *mass = fetch(&w, w.set[0], "mass", 1);
  const double total = sum_of(mpm_particles_count(w.set[0]), mass);
  ck_assert_int_eq(touch_of(&w, o).touching, 0);
  ck_assert_double_eq(touch_of(&w, o).impulse[up], 0.0);
  ck_within("falls", now.momentum[up], -total * fall * now.t, 1e-12 * total * fall * now.t);
  free(mass);
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

/* What is taken away while it bears a weight pushes no more in the next step: it falls freely. */
START_TEST(implicit_loss) {
  const double h = arena_spacing, fall = 10.0, dt = 10.0 * arena_dt;
  const double lower[2] = {3.0 * h, 3.0 * h}, upper[2] = {5.0 * h, 5.0 * h};
  method how = methods[1];
  how.scheme = MPM_NEWMARK;
  world w;
  world_desc desc = world_with(&how, 2, 8, h);
  desc.stepper.gravity[1] = -fall;
  world_open(&w, &desc);
  world_fill(&w, w.set[0], lower, upper, 2);
  mpm_contact_desc rule = rule_with(0.0);
  rule.kind = _i ? MPM_CONTACT_TIED : MPM_CONTACT_UNILATERAL;
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_PLANE);
  d.contact = &rule;
  d.position[1] = lower[1];
  mpm_obstacle *o = put_obstacle(&w, &d);
  double *mass = fetch(&w, w.set[0], "mass", 1);
  const double total = sum_of(mpm_particles_count(w.set[0]), mass), weight = total * fall;
  for (int32_t step = 0; step < 20 && !(step > 4 && touch_of(&w, o).force[1] > 0.5 * weight); ++step)
    world_step(&w, dt);
  ck_assert_double_gt(touch_of(&w, o).force[1], 0.5 * weight);
  ck_ok(&w, mpm_stepper_remove_obstacle(w.stepper, o));
  ck_ok(&w, mpm_obstacle_destroy(o));
  for (int32_t step = 0; step < 3; ++step) {
    const double before = world_info(&w).momentum[1], after = world_step(&w, dt).momentum[1];
    ck_within("falls", after - before, -weight * dt, 1e-9 * weight * dt);
  }
  free(mass);
  world_close(&w);
}
END_TEST

/* The host's own shapes: a plane, or a ball, in axes of the body; with `slides` the surface moves. */
typedef struct host_shape {
  int32_t ball, answer, spoils;
  double radius, slides;
} host_shape;

static mpm_status host_distance(void *user, const mpm_distance_batch *b) {
  const host_shape *s = user;
  ck_holds(b->struct_size == sizeof *b && b->n > 0 && b->ld >= b->n);
  for (int64_t i = 0; i < b->n; ++i) {
    double squared = 0.0;
    for (int32_t c = 0; c < b->dim; ++c) squared += b->position[c * b->ld + i] * b->position[c * b->ld + i];
    const double r = sqrt(squared);
    const int32_t axis = b->dim == 1 ? 0 : 1;
    b->distance[i] = s->ball ? r - s->radius : b->position[axis * b->ld + i];
    for (int32_t c = 0; c < b->dim; ++c)
      b->normal[c * b->ld + i] = s->ball ? b->position[c * b->ld + i] / r : c == axis;
    if (b->velocity) b->velocity[i] += s->slides;
  }
  if (s->spoils == 1) b->distance[b->n / 2] = NOT_A_NUMBER;
  if (s->spoils == 2) b->normal[b->n / 2] += 0.01;
  if (s->spoils == 3) b->normal[b->n / 2] = INFINITE;
  if (s->spoils == 4 && b->velocity) b->velocity[b->n / 2] = NOT_A_NUMBER;
  return s->answer;
}

static void compare_shapes(const mpm_obstacle_desc *a, const mpm_obstacle_desc *b, const arena *of,
                           const char *name) {
  world w[2];
  mpm_obstacle *o[2];
  for (int32_t i = 0; i < 2; ++i) {
    open_arena(&w[i], of);
    o[i] = put_obstacle(&w[i], i ? b : a);
    for (int32_t step = 0; step < 20; ++step) world_step(&w[i], arena_dt);
  }
  const mpm_contact_info one = touch_of(&w[0], o[0]), other = touch_of(&w[1], o[1]);
  const double pushed = one.impulse[of->dim == 1 ? 0 : 1];
  ck_assert_double_gt(pushed, 0.0);
  for (int32_t c = 0; c < 3; ++c) ck_within(name, other.impulse[c], one.impulse[c], 1e-9 * pushed);
  world_agree(name, &w[0], &w[1], "velocity", of->dim, 1e-9);
  for (int32_t i = 0; i < 2; ++i) {
    drop_obstacle(&w[i], o[i]);
    world_close(&w[i]);
  }
}

START_TEST(same_by_another_name) {
  const int32_t dim = _i;
  const arena of = {.dim = dim, .method = methods[1]};
  const mpm_contact_desc rule = rule_with(0.3);
  /* a plane of the host's, turned; and within bounds */
  mpm_obstacle_desc plane = obstacle_of(&meetings[0], dim), host = plane;
  plane.contact = host.contact = &rule;
  host_shape shape = {.ball = 0};
  host.shape = MPM_SHAPE_DISTANCE;
  host.distance = host_distance;
  host.user = &shape;
  if (dim > 1) {
    host.orientation[0] = plane.orientation[0] = cos(0.1);
    host.orientation[3] = plane.orientation[3] = sin(0.1);
  }
  compare_shapes(&plane, &host, &of, "plane");
  for (int32_t k = 0; k < 3; ++k) host.lower[k] = -4.0, host.upper[k] = k == (dim > 1) ? 0.5 : 4.0;
  compare_shapes(&plane, &host, &of, "plane within bounds");
  /* its surface moves as a plane that moves, for a while */
  if (dim > 1) {
    mpm_obstacle_desc moving = obstacle_of(&meetings[1], dim);
    moving.contact = &rule;
    moving.velocity[0] = -0.7, moving.velocity[1] = moving.angular_velocity[2] = 0.0;
    mpm_obstacle_desc conveyor = obstacle_of(&meetings[0], dim);
    conveyor.contact = &rule;
    conveyor.shape = MPM_SHAPE_DISTANCE;
    conveyor.distance = host_distance;
    host_shape belt = {.slides = -0.7};
    conveyor.user = &belt;
    compare_shapes(&moving, &conveyor, &of, "conveyor");
    arena implicit = of;
    implicit.method.scheme = MPM_NEWMARK;
    compare_shapes(&moving, &conveyor, &implicit, "conveyor in implicit steps");
    mpm_obstacle_desc ball = obstacle_of(&meetings[4], dim), host_ball = ball;
    host_shape round = {.ball = 1, .radius = ball.size[0]};
    ball.contact = host_ball.contact = &rule;
    host_ball.shape = MPM_SHAPE_DISTANCE;
    host_ball.distance = host_distance;
    host_ball.user = &round;
    compare_shapes(&ball, &host_ball, &of, "ball");
  }
  /* what is outside of one half-space is inside of the other */
  mpm_obstacle_desc inner = obstacle_of(&meetings[0], dim), outer = inner;
  inner.inside = 1;
  if (dim > 1) inner.orientation[0] = 0.0, inner.orientation[3] = 1.0;
  if (dim > 1) compare_shapes(&outer, &inner, &of, "inside");
}
END_TEST

/* On a periodic axis an obstacle is seen through the seam. */
START_TEST(through_the_seam) {
  const arena of = {.dim = _i, .method = methods[0], .periodic = 1};
  mpm_obstacle_desc d = obstacle_of(&meetings[4], _i), round = d;
  round.position[0] += 14.0 * arena_spacing;
  compare_shapes(&d, &round, &of, "seam");
}
END_TEST

/* A long bar, turned, holds what falls on its end, also where blocks reach over to the side of its next
 * image. */
START_TEST(far_ends) {
  const double h = 0.25, turn = 0.25 * PI, lower[2] = {30.0 * h, 32.5 * h}, upper[2] = {34.5 * h, 36.5 * h},
               down[2] = {0.0, -4.0};
  world w[2];
  mpm_obstacle *o[2];
  for (int32_t periodic = 0; periodic < 2; ++periodic) {
    world_desc desc = world_with(&methods[1], 2, 64, h);
    desc.grid.periodic[0] = periodic;
    mpm_particles *set = world_open(&w[periodic], &desc);
    world_fill(&w[periodic], set, lower, upper, 2);
    ck_ok(&w[periodic], mpm_particles_set_all(set, "velocity", MPM_F64, 2, down));
    mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_BOX);
    d.size[0] = 40.0 * h, d.size[1] = 2.0 * h;
    d.position[0] = 5.0 * h, d.position[1] = 3.0 * h;
    d.orientation[0] = cos(0.5 * turn), d.orientation[3] = sin(0.5 * turn);
    o[periodic] = put_obstacle(&w[periodic], &d);
    for (int32_t step = 0; step < 20; ++step) world_step(&w[periodic], arena_dt);
  }
  ck_assert_double_gt(touch_of(&w[0], o[0]).impulse[1], 0.0);
  ck_assert_int_gt(touch_of(&w[0], o[0]).nodes, 0);
  ck_assert_int_eq(touch_of(&w[1], o[1]).nodes, touch_of(&w[0], o[0]).nodes);
  world_agree("far ends", &w[0], &w[1], "velocity", 2, 1e-9);
  for (int32_t i = 0; i < 2; ++i) {
    drop_obstacle(&w[i], o[i]);
    world_close(&w[i]);
  }
}
END_TEST

/* Where cells are long a wall is felt beside its nodes, too. */
START_TEST(long_cells) {
  world w;
  world_desc desc = world_with(&methods[1], 2, 10, 0.25);
  desc.grid.spacing[0] = 1.0;
  mpm_particles *set = world_open(&w, &desc);
  const double lower[2] = {2.0, 0.0}, upper[2] = {6.0, 1.0}, down[2] = {0.0, -1.0};
  world_fill(&w, set, lower, upper, 2);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, down));
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FRICTION, 0.0));
  double force[3];
  world_step(&w, 1e-3);
  world_step(&w, 1e-3);
  ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_Y_MIN, force));
  ck_assert_double_gt(force[1], 0.0);
  world_close(&w);
}
END_TEST

/* ---- rules --------------------------------------------------------------------------------------------- */
/* What is bound moves as the obstacle does, also when that turns; in 3-D about its z alone. */
static void moves_with(world *w, const mpm_obstacle *o, double tolerance) {
  const int32_t dim = w->dim;
  double c[3], v[3], spin[3];
  int64_t n;
  ck_ok(w, mpm_obstacle_get_pose(o, c, NULL, v, spin));
  for (int32_t k = 0; k < 3; ++k) c[k] -= arena_dt * v[k]; /* it was there when the step began */
  double *gap = fetch_nodes(w, "contact_gap", &n), *of_nodes = fetch_nodes(w, "velocity", &n);
  double *x = fetch_nodes(w, "position", &n);
  for (int64_t i = 0; i < n; ++i) {
    if (!isfinite(gap[i])) continue;
    for (int32_t k = 0; k < dim; ++k) {
      const double turns = dim == 1 ? 0.0
                           : k == 0 ? -spin[2] * (x[n + i] - c[1])
                           : k == 1 ? spin[2] * (x[i] - c[0])
                                    : 0.0;
      ck_within("tied", of_nodes[k * n + i], v[k] + turns, tolerance);
    }
  }
  free(gap), free(of_nodes), free(x);
}

START_TEST(kinds_of_contact) {
  const int32_t dim = _i, down = dim == 1 ? 0 : 1;
  for (int32_t kind = MPM_CONTACT_UNILATERAL; kind <= MPM_CONTACT_TIED; ++kind)
    for (int32_t motion = MPM_MOTION_FIXED; motion <= MPM_MOTION_FREE; ++motion) {
      world w;
      open_arena(&w, &(arena){.dim = dim, .method = methods[1]});
      mpm_obstacle_desc d = obstacle_of(&(meeting){MPM_SHAPE_PLANE, 0, motion}, dim);
      const mpm_step_info start = world_info(&w);
      mpm_contact_desc rule = rule_with(0.3);
      rule.kind = kind;
      rule.friction_static = 0.5;
      d.contact = &rule;
      mpm_obstacle *o = put_obstacle(&w, &d);
      for (int32_t step = 0; step < 10; ++step) {
        const mpm_step_info info = world_step(&w, arena_dt);
        ck_assert_double_ge(info.contact_dissipation, -1e-9);
      }
      const mpm_contact_info got = touch_of(&w, o);
      ck_assert_int_eq(got.nodes > 0, kind != MPM_CONTACT_NONE);
      if (kind == MPM_CONTACT_TIED) {
        ck_assert_int_eq(got.stuck, got.nodes);
        if (motion != MPM_MOTION_FREE || dim < 3) moves_with(&w, o, 1e-6); /* there it turns about all axes */
      }
      if (kind == MPM_CONTACT_NONE)
        ck_within("none", w.info.momentum[down], start.momentum[down], 1e-12 * fabs(start.momentum[down]));
      drop_obstacle(&w, o);
      world_close(&w);
    }
}
END_TEST

/* A plane that weighs a hundredth of the box on it, whose nodes move at unlike speeds. */
START_TEST(light) {
  world w;
  open_arena(&w, &(arena){.dim = 2, .method = methods[1]});
  mpm_particles *set = w.set[0];
  const int64_t n = mpm_particles_count(set);
  double *x = fetch(&w, set, "position", 2), *v = fetch(&w, set, "velocity", 2), mass = 0.0;
  double *m = fetch(&w, set, "mass", 1);
  for (int64_t p = 0; p < n; ++p) {
    v[n + p] *= 1.0 + 0.5 * sin(8.0 * x[p]);
    mass += m[p];
  }
  put(&w, set, "velocity", 2, v);
  free(x), free(v), free(m);
  mpm_obstacle_desc d = obstacle_of(&(meeting){MPM_SHAPE_PLANE, 0, MPM_MOTION_FREE}, 2);
  mpm_contact_desc rule = rule_with(0.0);
  rule.kind = MPM_CONTACT_TIED;
  d.contact = &rule;
  d.mass = 1e-2 * mass;
  d.inertia[8] = 0.1 * d.mass;
  mpm_obstacle *o = put_obstacle(&w, &d);
  world_step(&w, arena_dt);
  ck_assert_int_gt(touch_of(&w, o).stuck, 4);
  moves_with(&w, o, 1e-9);
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

/* Adhesion holds what leaves; the offset keeps a distance. */
START_TEST(adhesion_and_offset) {
  const int32_t dim = _i, down = dim == 1 ? 0 : 1;
  world w;
  open_arena(&w, &(arena){.dim = dim, .method = methods[1]});
  const double up[3] = {dim == 1 ? arena_speed : 0.0, arena_speed, 0.0};
  mpm_obstacle_desc d = obstacle_of(&meetings[0], dim);
  mpm_contact_desc rule = rule_with(0.0);
  rule.adhesion = 100.0;
  d.contact = &rule;
  mpm_obstacle *o = put_obstacle(&w, &d);
  /* friction acts on what adhesion would hold, and is reported */
  if (dim > 1) {
    const double along[3] = {1.0, 0.0, 0.0};
    ck_ok(&w, mpm_particles_set_all(w.set[0], "velocity", MPM_F64, dim, along));
    rule.friction = 0.5;
    rule.adhesion = 1e4;
    ck_ok(&w, mpm_obstacle_set_contact(o, &rule));
    const double before = world_info(&w).momentum[0];
    const double got = world_step(&w, arena_dt).momentum[0] - before;
    ck_assert_double_lt(got, 0.0);
    ck_within("friction of adhesion", arena_dt * touch_of(&w, o).force[0], got, -1e-9 * got);
    rule.friction = 0.0;
    rule.adhesion = 100.0;
    ck_ok(&w, mpm_obstacle_set_contact(o, &rule));
  }
  ck_ok(&w, mpm_particles_set_all(w.set[0], "velocity", MPM_F64, dim, up));
  world_step(&w, arena_dt);
  const mpm_contact_info pulled = touch_of(&w, o);
  ck_within("adhesion", pulled.force[down], -100.0 * pulled.area, 1e-9 * pulled.area);
  rule = rule_with(0.0);
  rule.offset = 0.3 * arena_spacing;
  ck_ok(&w, mpm_obstacle_set_contact(o, &rule));
  world_step(&w, arena_dt);
  /* it has moved up by about 2 dt v in two steps, one of them adhering */
  ck_within("offset", touch_of(&w, o).gap, -0.3 * arena_spacing, 2.0 * arena_dt * arena_speed);
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

/* ---- motion -------------------------------------------------------------------------------------------- */
static mpm_status circle(void *user, double t, double dt, double *velocity, double *spin) {
  const int32_t *answer = user;
  velocity[0] = (cos(t + dt) - cos(t)) / dt;
  velocity[1] = (sin(t + dt) - sin(t)) / dt;
  spin[2] = 2.0;
  if (*answer == 100) velocity[1] = NOT_A_NUMBER;
  if (*answer == 200) velocity[2] = 1.0;
  return *answer < 100 ? *answer : 0;
}

/* A driven one goes where its mean velocities lead it; a free one falls, and turns with constant angular
 * momentum. */
START_TEST(poses) {
  world w;
  open_arena(&w, &(arena){.dim = 2, .method = methods[1], .gravity = {0.5, -3.0, 0.0}});
  int32_t answer = 0;
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_SPHERE);
  d.motion = MPM_MOTION_PRESCRIBED;
  d.size[0] = 0.1;
  d.position[0] = 30.0, d.position[1] = 20.0;
  mpm_obstacle *driven = put_obstacle(&w, &d);
  ck_ok(&w, mpm_obstacle_set_motion(driven, circle, &answer));
  d.motion = MPM_MOTION_FREE;
  d.mass = 2.0;
  d.inertia[8] = 0.5;
  d.angular_velocity[2] = 1.5;
  mpm_obstacle *free_one = put_obstacle(&w, &d);
  const double force[3] = {4.0, 0.0, 0.0}, torque[3] = {0.0, 0.0, 0.25};
  ck_ok(&w, mpm_obstacle_set_load(free_one, force, torque));
  const int32_t steps = 50;
  for (int32_t i = 0; i < steps; ++i) world_step(&w, arena_dt);
  const double t = steps * arena_dt;
  double x[3], q[4], v[3], spin[3];
  ck_ok(&w, mpm_obstacle_get_pose(driven, x, q, v, spin));
  ck_within("driven", x[0], 30.0 + cos(t) - 1.0, 1e-12);
  ck_within("driven", x[1], 20.0 + sin(t), 1e-12);
  ck_within("driven", q[0], cos(t), 1e-12); /* half of the angle 2 t */
  ck_within("driven", q[3], sin(t), 1e-12);
  ck_ok(&w, mpm_obstacle_get_pose(free_one, x, q, v, spin));
  ck_within("free", v[0], 2.5 * t, 1e-12);
  ck_within("free", v[1], -3.0 * t, 1e-12);
  ck_within("free", x[1], 20.0 - 1.5 * t * (t + arena_dt), 1e-12); /* semi-implicit */
  ck_within("free", spin[2], 1.5 + 0.5 * t, 1e-12);
  ck_within("free", 2.0 * atan2(q[3], q[0]), 1.5 * t + 0.25 * t * (t + arena_dt), 1e-12);
  drop_obstacle(&w, driven);
  drop_obstacle(&w, free_one);
  world_close(&w);
}
END_TEST

/* A free body that spins about no axis of its own keeps its angular momentum to rounding, and its energy to
 * second order in dt. */
START_TEST(tumbling) {
  double drift[2];
  for (int32_t fine = 0; fine < 2; ++fine) {
    world w;
    open_arena(&w, &(arena){.dim = 3, .method = methods[1]});
    mpm_obstacle_desc d = obstacle_of(&meetings[6], 3);
    for (int32_t k = 0; k < 3; ++k) d.position[k] = 50.0;
    d.angular_velocity[0] = 3.0, d.angular_velocity[1] = 0.2, d.angular_velocity[2] = -2.0;
    mpm_obstacle *o = put_obstacle(&w, &d);
    double L[2][3], energy[2] = {0.0, 0.0}, spin[3];
    drift[fine] = 0.0;
    spin_momentum(o, &d, 3, L[0]);
    for (int32_t k = 0; k < 3; ++k) energy[0] += 0.5 * L[0][k] * d.angular_velocity[k];
    for (int32_t i = 0; i < 100 << fine; ++i) {
      world_step(&w, 0.01 / (1 << fine));
      ck_ok(&w, mpm_particles_set_all(w.set[0], "velocity", MPM_F64, 3, (const double[]){0.0, 0.0, 0.0}));
      spin_momentum(o, &d, 3, L[1]);
      ck_ok(&w, mpm_obstacle_get_pose(o, NULL, NULL, NULL, spin));
      energy[1] = 0.0;
      for (int32_t k = 0; k < 3; ++k) energy[1] += 0.5 * L[1][k] * spin[k];
      for (int32_t k = 0; k < 3; ++k) ck_within("angular momentum", L[1][k], L[0][k], 1e-11);
      drift[fine] = fmax(drift[fine], fabs(energy[1] / energy[0] - 1.0));
    }
    drop_obstacle(&w, o);
    world_close(&w);
  }
  show("tumbling: drift of energy %g, %g\n", drift[0], drift[1]);
  ck_between("order", log2(drift[0] / drift[1]), 1.8, 4.0);
  ck_assert_double_lt(drift[0], 1e-3);
}
END_TEST

/* The fastest point of an obstacle bounds the stable step. */
START_TEST(stable_step) {
  world w;
  open_arena(&w, &(arena){.dim = 2, .method = methods[1]});
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_BOX);
  d.motion = MPM_MOTION_PRESCRIBED;
  d.size[0] = 3.0, d.size[1] = 4.0;
  d.position[0] = 100.0;
  mpm_obstacle *o = put_obstacle(&w, &d);
  double rest, moving;
  ck_ok(&w, mpm_stable_dt(w.stepper, &rest));
  const double v[3] = {1e4, -2e4, 0.0}, spin[3] = {0.0, 0.0, 1e3};
  ck_ok(&w, mpm_obstacle_set_pose(o, NULL, NULL, v, spin));
  ck_ok(&w, mpm_stable_dt(w.stepper, &moving));
  ck_assert_double_lt(moving, rest);
  ck_within("stable step", moving, arena_spacing / (2e4 + 5.0 * 1e3), 1e-12);
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

Suite *obstacles_suite(void);
Suite *obstacles_suite(void) {
  Suite *suite = suite_create("obstacles");
  TCase *law = tcase_create("law"), *same = tcase_create("same"), *motion = tcase_create("motion");
  tcase_add_loop_test(law, momentum_and_energy, 0, BROAD);
  tcase_add_loop_test(law, friction_and_work, 0, METHODS);
  tcase_add_loop_test(law, kinds_of_contact, 1, 4);
  tcase_add_test(motion, light);
  tcase_add_loop_test(law, adhesion_and_offset, 1, 4);
  tcase_add_loop_test(same, walls_are_planes, 0, BROAD);
  tcase_add_loop_test(same, squeezed, 0, 2);
  tcase_add_loop_test(same, implicit_held, 0, 2);
  tcase_add_loop_test(same, implicit_corner, 0, 7); /* GIMP leaves nodes beside the wall without stiffness */
  tcase_add_loop_test(same, implicit_release, 1, 4);
  tcase_add_loop_test(same, implicit_loss, 0, 2);
  tcase_add_loop_test(same, same_by_another_name, 1, 4);
  tcase_add_loop_test(same, through_the_seam, 2, 4);
  tcase_add_test(same, far_ends);
  tcase_add_test(same, long_cells);
  tcase_add_test(motion, poses);
  tcase_add_test(motion, tumbling);
  tcase_add_test(motion, stable_step);
  tcase_set_tags(law, "long");
  tcase_set_tags(same, "long");
  tcase_set_timeout(law, 60);
  tcase_set_timeout(same, 60);
  tcase_set_timeout(motion, 60);
  suite_add_tcase(suite, law);
  suite_add_tcase(suite, same);
  suite_add_tcase(suite, motion);
  add_obstacle_states(suite);
  add_obstacle_held(suite);
  add_obstacle_corners(suite);
  add_obstacle_reactions(suite);
  return suite;
}
