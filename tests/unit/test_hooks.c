/* Node hooks: what they are shown at each stage, what comes of what they write, work and momentum of it,
 * refusals. */
#include "world.h"

enum { CLOUD = 300 };
static const double g[3] = {1.0, -10.0, 3.0};

/* A free cloud in 2-D or 3-D, x periodic; `walled` puts walls of all kinds around. */
static void open_cloud(world *w, const method *how, int32_t dim, int32_t walled) {
  world_desc desc = world_with(how, dim, 8, 0.1);
  desc.grid.periodic[0] = 1;
  world_open(w, &desc);
  dice d = {11};
  const double low = walled ? 0.0 : 0.2, high = walled ? 0.8 : 0.6;
  add_cloud(w, w->set[0], &d, CLOUD, 0.1, low, high, 1.0);
  if (!walled) return;
  ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_Y_MIN, MPM_WALL_FRICTION, 0.3));
  ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_Y_MAX, MPM_WALL_SLIP, 0.0));
  if (dim == 3) ck_ok(w, mpm_stepper_set_wall(w->stepper, MPM_Z_MIN, MPM_WALL_FIXED, 0.0));
}

static void set_gravity(world *w) {
  memcpy(w->desc.stepper.gravity, g, sizeof g);
  ck_ok(w, mpm_stepper_configure(w->stepper, &w->desc.stepper));
}

static mpm_status add_weight(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  (void)user, (void)velocity;
  for (int32_t c = 0; c < b->dim; ++c)
    for (int64_t i = 0; i < b->n; ++i) force[c * b->ld + i] += b->mass[i] * g[c];
  return 0;
}

/* A force of mass times g on each node is gravity: motion, stress, work and dissipation. */
START_TEST(weight_is_gravity) {
  const method *how = &methods[_i % METHODS];
  const int32_t dim = 2 + _i / METHODS % 2, stage = MPM_AFTER_P2G + _i / METHODS / 2;
  world a, b;
  open_cloud(&a, how, dim, 0);
  open_cloud(&b, how, dim, 0);
  set_gravity(&a);
  ck_ok(&b, mpm_stepper_set_node_hook(b.stepper, stage, add_weight, NULL));
  for (int32_t i = 0; i < 6; ++i) {
    const mpm_step_info x = world_step(&a, 1e-3), y = world_step(&b, 1e-3);
    ck_assert_double_gt(fabs(x.external_work), 1e-3);
    ck_within(how->name, y.external_work, x.external_work, 1e-10 * x.kinetic_energy);
    ck_within(how->name, y.dissipation, x.dissipation, 1e-10 * x.kinetic_energy);
    for (int32_t k = 0; k < dim; ++k)
      ck_within(how->name, y.momentum[k], x.momentum[k], 1e-11 * fabs(x.momentum[1]));
  }
  world_agree(how->name, &a, &b, "position", dim, 1e-12);
  world_agree(how->name, &a, &b, "velocity", dim, 1e-10);
  world_agree(how->name, &a, &b, "stress", 6, 1e-8);
  world_close(&a), world_close(&b);
}
END_TEST

static mpm_status look_only(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  (void)b, (void)velocity, (void)force;
  ++*(int32_t *)user;
  return 0;
}

static uint64_t hash_after(world *w, int32_t steps, int32_t staged) {
  for (int32_t i = 0; i < steps; ++i)
    if (staged)
      world_staged_step(w, 1e-3);
    else
      world_step(w, 1e-3);
  return world_hash(w);
}

/* Hooks that change nothing leave every bit, with walls and periods around; with the fused force of MLS the
 * step is that in parts. */
START_TEST(looking_changes_nothing) {
  const method *how = &methods[_i % METHODS];
  const int32_t dim = 2 + _i / METHODS;
  int32_t calls = 0;
  world a, b;
  open_cloud(&a, how, dim, 1);
  open_cloud(&b, how, dim, 1);
  for (int32_t stage = MPM_AFTER_P2G; stage <= MPM_AFTER_VELOCITY; ++stage)
    ck_ok(&b, mpm_stepper_set_node_hook(b.stepper, stage, look_only, &calls));
  ck_assert(hash_after(&a, 6, how->transfer == MPM_APIC_MLS) == hash_after(&b, 6, 0));
  ck_assert(hash_after(&a, 2, 1) == hash_after(&b, 2, 1));
  for (int32_t stage = MPM_AFTER_P2G; stage <= MPM_AFTER_VELOCITY; ++stage)
    ck_ok(&b, mpm_stepper_set_node_hook(b.stepper, stage, NULL, NULL));
  const int32_t before = calls;
  ck_assert_int_gt(before, 0);
  ck_assert(hash_after(&a, 2, 0) == hash_after(&b, 2, 0));
  ck_assert_int_eq(calls, before);
  world_close(&a), world_close(&b);
}
END_TEST

typedef struct seen {
  double mass, momentum[3], force[3], largest_force, dt;
  int64_t calls;
} seen;

static mpm_status take_sums(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  seen *s = user;
  ck_assert_uint_eq(b->struct_size, sizeof *b);
  s->dt = b->dt;
  ++s->calls;
  for (int64_t i = 0; i < b->n; ++i) {
    s->mass += b->mass[i];
    for (int32_t c = 0; c < b->dim; ++c) {
      s->momentum[c] += b->mass[i] * velocity[c * b->ld + i];
      s->force[c] += force[c * b->ld + i];
      s->largest_force = fmax(s->largest_force, fabs(force[c * b->ld + i]));
    }
  }
  return 0;
}

static mpm_status spoil_force(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  (void)velocity;
  take_sums(user, b, velocity, force);
  for (int32_t c = 0; c < b->dim; ++c)
    for (int64_t i = 0; i < b->n; ++i) force[c * b->ld + i] = (double)NAN;
  return 0;
}

/* After P2G: the particles' momentum and no force. After forces: the same, and the force, which adds up to
 * the weight. After velocity: the new momentum and the same force, which is not looked at again. */
START_TEST(what_hooks_are_shown) {
  const method *how = &methods[_i];
  world w;
  seen s[3];
  memset(s, 0, sizeof s);
  open_cloud(&w, how, 3, 0);
  set_gravity(&w);
  for (int32_t k = 0; k < 3; ++k)
    ck_ok(&w,
          mpm_stepper_set_node_hook(w.stepper, MPM_AFTER_P2G + k, k == 2 ? spoil_force : take_sums, &s[k]));
  const mpm_step_info before = world_info(&w), after = world_step(&w, 1e-3);
  const double total = mass_of(&w, w.set[0]);
  for (int32_t k = 0; k < 3; ++k) {
    ck_assert_int_gt(s[k].calls, 0);
    ck_within(how->name, s[k].mass, total, 1e-12 * total);
    ck_within(how->name, s[k].dt, 1e-3, 0.0);
    for (int32_t c = 0; c < 3; ++c) {
      const double gained = k == 2 ? 1e-3 * total * g[c] : 0.0;
      ck_within(how->name, s[k].momentum[c], before.momentum[c] + gained, 1e-11 * total);
      ck_within(how->name, s[k].force[c], k ? total * g[c] : 0.0, k ? 1e-7 * total : 0.0);
    }
  }
  ck_assert_double_gt(s[1].largest_force, 0.1 * total);
  for (int32_t c = 0; c < 3; ++c) ck_within(how->name, after.momentum[c], s[2].momentum[c], 1e-11 * total);
  world_close(&w);
}
END_TEST

static mpm_status damp(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  (void)user, (void)force;
  for (int32_t c = 0; c < b->dim; ++c)
    for (int64_t i = 0; i < b->n; ++i) velocity[c * b->ld + i] *= 0.9;
  return 0;
}

/* A body in uniform motion, whose nodes lose a tenth of their velocity in each
 * step: an impulse of the host. */
START_TEST(damping) {
  const method *how = &methods[_i];
  const double v0[3] = {0.3, -0.2, 0.1}, dt = 1e-3, unit[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  world w;
  open_cloud(&w, how, 3, 0);
  ck_ok(&w, mpm_particles_set_all(w.set[0], "velocity", MPM_F64, 3, v0));
  ck_ok(&w, mpm_particles_set_all(w.set[0], "deformation_gradient", MPM_F64, 9, unit));
  ck_ok(&w, mpm_stepper_set_node_hook(w.stepper, MPM_AFTER_VELOCITY, damp, NULL));
  double factor = 1.0;
  for (int32_t i = 0; i < 20; ++i) {
    double *x = fetch(&w, w.set[0], "position", 3);
    const mpm_step_info before = world_info(&w), after = world_step(&w, dt);
    double *now = fetch(&w, w.set[0], "position", 3), *v = fetch(&w, w.set[0], "velocity", 3);
    factor *= 0.9;
    for (int64_t p = 0; p < CLOUD; ++p)
      for (int32_t c = 0; c < 3; ++c) {
        ck_within(how->name, v[c * CLOUD + p], factor * v0[c], 1e-11); /* round-off in F has stress */
        ck_within(how->name, remainder(now[c * CLOUD + p] - x[c * CLOUD + p] - dt * factor * v0[c], 0.8), 0.0,
                  1e-12);
      }
    /* impulse times the new velocity, -m v / 10 times 0.9 v; half of the rest of the loss is dissipated */
    ck_within(how->name, after.external_work, -0.18 * before.kinetic_energy, 1e-12 * before.kinetic_energy);
    ck_within(how->name, after.dissipation, 0.01 * before.kinetic_energy, 1e-11 * before.kinetic_energy);
    free(x), free(now), free(v);
  }
  world_close(&w);
}
END_TEST

static mpm_status kick(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    velocity[i] += 0.2 * b->position[b->ld + i];
    force[b->ld + i] += 30.0 * b->mass[i] * b->position[i];
  }
  return 0;
}

/* What the host would write between the parts of a step. */
static void staged_kick(world *w, double dt) {
  int64_t n;
  ck_ok(w, mpm_step_begin(w->stepper, dt));
  double *x = fetch_nodes(w, "position", &n), *m = fetch_nodes(w, "mass", &n);
  mpm_view v = {.struct_size = sizeof v}, f = {.struct_size = sizeof f};
  ck_ok(w, mpm_grid_map(w->stepper, 0, "velocity", MPM_READ | MPM_WRITE, &v));
  ck_ok(w, mpm_grid_map(w->stepper, 0, "force", MPM_READ | MPM_WRITE, &f));
  for (int64_t i = 0; i < n; ++i) {
    ((double *)v.data)[i] += 0.2 * x[n + i];
    ((double *)f.data)[n + i] += 30.0 * m[i] * x[i];
  }
  ck_ok(w, mpm_view_release(&v));
  ck_ok(w, mpm_view_release(&f));
  ck_ok(w, mpm_step_grid(w->stepper));
  ck_ok(w, mpm_step_end(w->stepper, NULL));
  free(x), free(m);
}

/* The two first stages act as the host's own writes in a step in parts. */
START_TEST(as_in_a_step_in_parts) {
  const method *how = &methods[_i % METHODS];
  world a, b;
  world_desc desc = world_with(how, 2, 8, 0.1);
  world *both[2] = {&a, &b};
  for (int32_t k = 0; k < 2; ++k) {
    dice d = {5};
    world_open(both[k], &desc);
    add_cloud(both[k], both[k]->set[0], &d, CLOUD, 0.1, 0.2, 0.6, 1.0);
  }
  ck_ok(&b, mpm_stepper_set_node_hook(b.stepper, MPM_AFTER_P2G + _i / METHODS, kick, NULL));
  for (int32_t i = 0; i < 5; ++i) {
    staged_kick(&a, 1e-3);
    world_step(&b, 1e-3);
  }
  world_agree(how->name, &a, &b, "position", 2, 1e-12);
  world_agree(how->name, &a, &b, "velocity", 2, 1e-10);
  world_agree(how->name, &a, &b, "stress", 6, 1e-8);
  world_close(&a), world_close(&b);
}
END_TEST

typedef struct given {
  double sum[3]; /* of impulses over masses that folding leaves alone */
  int32_t stage;
} given;

static mpm_status push_sideways(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  given *to = user;
  for (int64_t i = 0; i < b->n; ++i) {
    const double by = 5.0 * b->mass[i] * (1.0 + b->position[b->ld + i]);
    if (to->stage == MPM_AFTER_VELOCITY)
      velocity[i] += b->dt * by / b->mass[i];
    else
      force[i] += by;
    to->sum[0] += by;
  }
  return 0;
}

/* Along walls what hooks give is none of the walls' reaction: with it, it is the change of momentum, and the
 * nodal reactions add up to the walls'. */
START_TEST(hooks_beside_walls) {
  const method *how = &methods[_i % METHODS];
  world w;
  given to = {{0.0, 0.0, 0.0}, MPM_AFTER_P2G + _i / METHODS};
  open_cloud(&w, how, 2, 1);
  ck_ok(&w, mpm_stepper_set_node_hook(w.stepper, to.stage, push_sideways, &to));
  for (int32_t i = 0; i < 5; ++i) {
    double low[3], high[3];
    int64_t n;
    to.sum[0] = 0.0;
    const mpm_step_info before = world_info(&w), after = world_step(&w, 1e-3);
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_Y_MIN, low));
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_Y_MAX, high));
    double *reaction = fetch_nodes(&w, "reaction", &n);
    const double nodal = sum_of(n, reaction);
    free(reaction);
    const double scale = fabs(to.sum[0]) + fabs(low[1]);
    ck_within(how->name, nodal, low[0] + high[0], 1e-10 * scale);
    ck_within(how->name, (after.momentum[0] - before.momentum[0]) / 1e-3, to.sum[0] + low[0] + high[0],
              1e-9 * scale);
    ck_assert_double_gt(fabs(to.sum[0]), 0.0);
  }
  world_close(&w);
}
END_TEST

typedef struct trouble {
  mpm_status status;
  int64_t node[2]; /* index that gets NaN where not status */
  int32_t in_force;
} trouble;

static mpm_status misbehave(void *user, const mpm_node_batch *b, double *velocity, double *force) {
  const trouble *t = user;
  for (int64_t i = 0; i < b->n && !t->status; ++i)
    if (b->index[i] == t->node[0] && b->index[b->ld + i] == t->node[1])
      (t->in_force ? force : velocity)[b->ld + i] = (double)NAN;
  return t->status;
}

/* Values that are not finite name the node; statuses cut the step or stop it; nothing has changed. */
START_TEST(hooks_that_fail) {
  static const char *const named[3] = {"hook after P2G", "hook after forces", "hook after velocity"};
  const method *how = &methods[_i % METHODS];
  const int32_t stage = MPM_AFTER_P2G + _i / METHODS;
  world w;
  trouble t = {0, {4, 5}, 0};
  mpm_step_info info = {.struct_size = sizeof info};
  open_cloud(&w, how, 2, 0);
  world_step(&w, 1e-3);
  ck_ok(&w, mpm_stepper_set_node_hook(w.stepper, stage, misbehave, &t));
  const uint64_t was = world_hash(&w);
  for (t.in_force = 0; t.in_force < (stage == MPM_AFTER_VELOCITY ? 1 : 2); ++t.in_force) {
    ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_NONFINITE, named[stage - MPM_AFTER_P2G]);
    ck_assert_int_eq(info.node, (4 + 1) * (8 + 3) + 5 + 1);
    ck_assert_int_eq(info.cause, MPM_NONFINITE);
  }
  t.status = 7;
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_CUT_DT, named[stage - MPM_AFTER_P2G]);
  ck_assert_int_eq(info.callback_status, 7);
  t.status = -2;
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-3));
  ck_refused(&w, mpm_stepper_set_node_hook(w.stepper, stage, NULL, NULL), MPM_E_STATE, "under way");
  ck_refused(&w, mpm_step_grid(w.stepper), MPM_E_CALLBACK, named[stage - MPM_AFTER_P2G]);
  ck_assert(world_hash(&w) == was);
  ck_refused(&w, mpm_stepper_set_node_hook(w.stepper, 0, misbehave, &t), MPM_E_ARG, "stage is 0");
  ck_refused(&w, mpm_stepper_set_node_hook(w.stepper, 4, misbehave, &t), MPM_E_ARG, "stage is 4");
  ck_ok(&w, mpm_stepper_set_node_hook(w.stepper, stage, NULL, NULL));
  world_step(&w, 1e-3);
  world_close(&w);
}
END_TEST

/* A fused step does not keep the force apart, unless a hook wants to see it. */
START_TEST(mls_keeps_the_force) {
  mpm_view view = {.struct_size = sizeof view};
  int32_t calls = 0;
  world w;
  open_cloud(&w, &methods[8], 2, 0);
  ck_assert_int_eq(methods[8].transfer, MPM_APIC_MLS);
  world_step(&w, 1e-3);
  ck_refused(&w, mpm_grid_map(w.stepper, 0, "force", MPM_READ, &view), MPM_E_UNSUPPORTED, "");
  ck_ok(&w, mpm_stepper_set_node_hook(w.stepper, MPM_AFTER_FORCES, look_only, &calls));
  world_step(&w, 1e-3);
  ck_ok(&w, mpm_grid_map(w.stepper, 0, "force", MPM_READ, &view));
  ck_ok(&w, mpm_view_release(&view));
  world_close(&w);
}
END_TEST

Suite *hooks_suite(void) {
  Suite *suite = suite_create("hooks");
  TCase *tc = tcase_create("hooks");
  tcase_set_timeout(tc, 120);
  tcase_add_loop_test(tc, weight_is_gravity, 0, 4 * METHODS);
  tcase_add_loop_test(tc, looking_changes_nothing, 0, 2 * METHODS);
  tcase_add_loop_test(tc, what_hooks_are_shown, 0, METHODS);
  tcase_add_loop_test(tc, damping, 0, METHODS);
  tcase_add_loop_test(tc, as_in_a_step_in_parts, 0, 2 * METHODS);
  tcase_add_loop_test(tc, hooks_beside_walls, 0, 3 * METHODS);
  tcase_add_loop_test(tc, hooks_that_fail, 0, 3 * METHODS);
  tcase_add_test(tc, mls_keeps_the_force);
  suite_add_tcase(suite, tc);
  return suite;
}
