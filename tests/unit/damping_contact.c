/* Damping of implicit steps in contact, whose force acts wholly at the end of the step: bodies that rest stay
 * at rest, what a plane carries moves as if it flew, and forces, momentum and energy are those of the damped
 * motion. */
#include "damping.h"
#include "obstacle.h"
#include "prescribed_surfaces.h"

typedef struct newmark {
  double gamma, beta;
} newmark;
static const newmark rules[] = {{0.5, 0.25}, {0.6, 0.3025}, {1.0, 0.5625},
                                {0.5, 0.5},  {1.0, 1.0},    {1.0, 0.45}};
enum { RULES = sizeof rules / sizeof *rules };

static const double edge = 0.1, rate = 30.0, dt = 0.01, weight = 100.0; /* weight: per mass */
/* Touches may miss by 1e-8 spacings in a step, which is this velocity. */
static const double missed = 4e-8 * 0.1 / 0.01;

/* Opens a block that begins and ends so many cells above 0. Of one within a row of cells on the linear basis
 * all nodes touch a plane that carries it: it moves as one. */
static mpm_particles *open_damped(world *w, const newmark *of, int32_t basis, double from, double to) {
  const method how = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
  const double low[] = {5.0 * edge, from * edge}, high[] = {8.0 * edge, to * edge};
  world_desc desc = world_with(&how, 2, 14, edge);
  desc.grid.basis = basis;
  desc.grid.total_lagrangian = to - from > 1.0;
  desc.stepper.newmark_gamma = of->gamma;
  desc.stepper.newmark_beta = of->beta;
  desc.stepper.mass_damping = rate;
  desc.stepper.newton_tolerance_residual = 1e-12;
  mpm_particles *set = world_open(w, &desc);
  world_fill(w, set, low, high, 2);
  return set;
}

static mpm_obstacle *put_plane(world *w, double height, double friction) {
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_PLANE);
  d.position[1] = height;
  mpm_obstacle *o = put_obstacle(w, &d);
  const mpm_contact_desc rule = rule_with(friction);
  ck_ok(w, mpm_obstacle_set_contact(o, &rule));
  return o;
}

static void set_gravity(world *w, double x, double y) {
  mpm_stepper_desc d = w->desc.stepper;
  d.gravity[0] = x, d.gravity[1] = y;
  ck_ok(w, mpm_stepper_configure(w->stepper, &d));
}

/* ---- rest ---------------------------------------------------------------------------------------------- */
static void stays(world *w, const mpm_particles *set, const mpm_obstacle *o, double push) {
  const double mass = mass_of(w, set);
  for (int32_t k = 0; k < 200; ++k) {
    world_step(w, dt);
    double *v = fetch(w, set, "velocity", 2);
    ck_within("velocity", largest(2 * mpm_particles_count(set), v), 0.0, missed);
    free(v);
    const mpm_contact_info touch = touch_of(w, o);
    ck_within("weight", touch.force[1], mass * weight, 2.0 * mass * missed / dt);
    ck_within("push", touch.force[0], -mass * push, 2.0 * mass * missed / dt);
  }
}

/* A block that rests on a plane stays there, and its weight is what the plane carries; pushed aside it
 * sticks. */
START_TEST(rests_on_a_plane) {
  const double push = _i % 2 ? 0.4 * weight : 0.0;
  world w;
  mpm_particles *set = open_damped(&w, &rules[_i / 2], MPM_LINEAR, 5.0, 6.0);
  mpm_obstacle *o = put_plane(&w, 5.0 * edge, 0.5);
  set_gravity(&w, push, -weight);
  stays(&w, set, o, push);
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

/* So does an elastic block that is compressed by its weight. */
START_TEST(compressed_block_rests) {
  world w;
  mpm_particles *set = open_damped(&w, &rules[_i], MPM_LINEAR, 5.0, 8.0);
  mpm_obstacle *o = put_plane(&w, 5.0 * edge, 0.5);
  w.desc.stepper.gravity[1] = -weight;
  const mpm_stepper_desc dynamic = w.desc.stepper;
  mpm_stepper_desc still = dynamic;
  still.quasi_static = 1;
  still.mass_damping = 0.0;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &still));
  for (int32_t k = 0; k < 3; ++k) world_step(&w, dt);
  ck_ok(&w, mpm_stepper_configure(w.stepper, &dynamic));
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, (double[]){0.0, 0.0}));
  stays(&w, set, o, 0.0);
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

/* ---- motion -------------------------------------------------------------------------------------------- */
/* A block that slides on a smooth plane moves as one that flies without weight, by the rule of the scheme. */
START_TEST(slides_as_it_flies) {
  enum { STEPS = 12 };
  const newmark *of = &rules[_i];
  double x[2][STEPS], v[2][STEPS], taken[2];
  for (int32_t slides = 0; slides < 2; ++slides) {
    world w;
    mpm_particles *set = open_damped(&w, of, MPM_LINEAR, 5.0, 6.0);
    mpm_obstacle *o = put_plane(&w, slides ? 5.0 * edge : 2.0 * edge, 0.0);
    set_gravity(&w, 1.0, slides ? -weight : 0.0);
    ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, (double[]){0.4, 0.0}));
    const double start = fetch1(&w, set, "position", 2, 0, 0), mass = mass_of(&w, set);
    for (int32_t k = 0; k < STEPS; ++k) {
      const mpm_step_info info = world_step(&w, dt);
      v[slides][k] = info.momentum[0] / mass;
      x[slides][k] = fetch1(&w, set, "position", 2, 0, 0) - start;
      ck_within("across", info.momentum[1], 0.0, mass * missed);
    }
    taken[slides] = w.info.damping_dissipation_total / mass;
    drop_obstacle(&w, o);
    world_close(&w);
  }
  double place = 0.0, now = 0.4;
  for (int32_t k = 0; k < STEPS; ++k) {
    const double first = 1.0 - rate * now,
                 last = (1.0 - rate * (now + dt * (1.0 - of->gamma) * first)) / (1.0 + rate * of->gamma * dt);
    const double next = now + dt * ((1.0 - of->gamma) * first + of->gamma * last);
    place += 2.0 * of->beta < of->gamma ? dt * now + dt * dt * ((0.5 - of->beta) * first + of->beta * last)
                                        : 0.5 * dt * (now + next);
    now = next;
    for (int32_t slides = 0; slides < 2; ++slides) {
      ck_within("velocity", v[slides][k], now, 1e-12);
      ck_within("place", x[slides][k], place, 1e-12);
    }
  }
  ck_assert_double_gt(taken[0], 0.0);
  ck_within("taken", taken[1], taken[0], 100.0 * missed * missed);
}
END_TEST

/* A block falls onto a plane, bounces and comes to rest: its energy goes to damping, to contact and to what
 * the scheme takes of the trapezoid. */
START_TEST(energy_of_a_fall) {
  const newmark *of = &rules[_i];
  world w;
  mpm_particles *set = open_damped(&w, of, MPM_LINEAR, 5.3, 5.8);
  mpm_obstacle *o = put_plane(&w, 5.1 * edge, 0.0);
  set_gravity(&w, 0.0, -weight);
  const double mass = mass_of(&w, set);
  double v = 0.0, x = fetch1(&w, set, "position", 2, 1, 0), bounced = 0.0;
  for (int32_t k = 0; k < 60; ++k) {
    const mpm_step_info info = world_step(&w, dt);
    const double next = info.momentum[1] / mass, place = fetch1(&w, set, "position", 2, 1, 0);
    const double scheme = (of->gamma - 0.5) * rate * (next - v) * (place - x);
    ck_within("energy", info.dissipation / mass,
              (info.damping_dissipation + info.contact_dissipation) / mass + scheme, 1e-10 * weight);
    bounced = fmax(bounced, next);
    v = next, x = place;
  }
  ck_assert_double_gt(bounced, 0.01);
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

/* ---- what is held -------------------------------------------------------------------------------------- */
static mpm_status drive(void *user, const mpm_node_batch *b, uint8_t *is_held, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) is_held[i] = 1, velocity[i] = b->t + 0.5 * b->dt;
  return MPM_OK;
}

/* What the host drives has the momentum, and takes the force, of what is not damped. */
START_TEST(driven_nodes_are_not_damped) {
  mpm_step_info info[2];
  double force[2];
  for (int32_t damped = 0; damped < 2; ++damped) {
    world w;
    open_damped(&w, &rules[_i], MPM_BSPLINE2, 5.0, 6.0);
    w.desc.stepper.mass_damping = damped ? rate : 0.0;
    ck_ok(&w, mpm_stepper_configure(w.stepper, &w.desc.stepper));
    ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, drive, NULL));
    for (int32_t k = 0; k < 3; ++k) info[damped] = world_step(&w, dt);
    int64_t nodes;
    double *reaction = fetch_nodes(&w, "reaction", &nodes);
    force[damped] = sum_of(nodes, reaction);
    free(reaction);
    world_close(&w);
  }
  ck_assert_double_gt(force[0], 0.0);
  ck_within("force", force[1], force[0], 1e-12 * force[0]);
  ck_within("momentum", info[1].momentum[0], info[0].momentum[0], 1e-12 * info[0].momentum[0]);
}
END_TEST

/* ---- momentum ------------------------------------------------------------------------------------------ */
/* With gamma = 1 all forces are those of the end: a block that an obstacle hits, or that a surface drags,
 * gains what that gives it less what damping takes of its momentum. */
START_TEST(momentum_of_a_push) {
  static const double betas[] = {0.45, 0.5, 0.5625, 1.0};
  const newmark of = {1.0, betas[_i / 2]};
  world w;
  mpm_particles *set = open_damped(&w, &of, MPM_BSPLINE2, 5.0, 6.0);
  const mpm_surface_desc drags = prescribing(0);
  mpm_surface *s = _i % 2 ? put_surface(&w, &drags) : NULL;
  mpm_obstacle *o = _i % 2 ? NULL : put_plane(&w, 5.0 * edge, 0.3);
  for (int32_t i = 0; i < 6 && s; ++i) {
    const double x[2] = {(5.25 + 0.5 * i) * edge, 5.0 * edge}, down[2] = {0.0, -0.5 * edge};
    ck_ok(&w, mpm_surface_add(s, 1, x, down, NULL));
  }
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, (double[]){0.5, -0.5}));
  const double mass = mass_of(&w, set);
  double most = 0.0;
  for (int32_t k = 0; k < 6; ++k) {
    const mpm_step_info before = world_info(&w), after = world_step(&w, dt);
    for (int32_t c = 0; c < 2; ++c) {
      const double by = s ? reaction_of(&w, s)[c] : touch_of(&w, o).force[c];
      ck_within("momentum", (after.momentum[c] - before.momentum[c]) / dt, by - rate * after.momentum[c],
                1e-8 * mass / dt);
      most = fmax(most, fabs(by));
    }
  }
  ck_assert_double_gt(most, 0.1 * mass / dt);
  if (s) drop_surface(&w, s);
  if (o) drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

void add_damping_contact(Suite *suite) {
  TCase *contact = tcase_create("contact");
  tcase_add_loop_test(contact, rests_on_a_plane, 0, 2 * RULES);
  tcase_add_loop_test(contact, compressed_block_rests, 0, RULES);
  tcase_add_loop_test(contact, slides_as_it_flies, 0, RULES);
  tcase_add_loop_test(contact, energy_of_a_fall, 0, RULES - 1);
  tcase_add_loop_test(contact, driven_nodes_are_not_damped, 0, RULES);
  tcase_add_loop_test(contact, momentum_of_a_push, 0, 8);
  tcase_set_timeout(contact, 60);
  suite_add_tcase(suite, contact);
}
