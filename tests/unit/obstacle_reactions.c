/* Implicit steps with contact and inertia: what walls, prescribed particles and the host report is what the
 * particles gain, and what is symmetric stays so. */
#include "obstacle.h"
#include "tables.h"

typedef struct newmark {
  double gamma, beta;
} newmark;
static const newmark rules[] = {{0.5, 0.25}, {0.5, 0.5}, {1.0, 0.5625}, {1.0, 1.0}};
enum { RULES = sizeof rules / sizeof *rules };

static world_desc newmark_world(const newmark *of, int32_t basis, int64_t cells, double h) {
  const method how = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
  world_desc desc = world_with(&how, 2, cells, h);
  desc.grid.basis = basis;
  desc.stepper.newmark_gamma = of->gamma;
  desc.stepper.newmark_beta = of->beta;
  desc.stepper.newton_tolerance_residual = 1e-12;
  return desc;
}

/* ---- what drives a body -------------------------------------------------------------------------------- */
/* The mean velocity over a step of what begins at rest and accelerates by 1. */
static mpm_status accelerate(void *user, const mpm_particle_batch *b, double *add) {
  (void)user;
  for (int64_t p = 0; p < b->n; ++p) add[p] += b->t + 0.5 * b->dt;
  return MPM_OK;
}
static mpm_status drive(void *user, const mpm_node_batch *b, uint8_t *is_held, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) is_held[i] = 1, velocity[i] = b->t + 0.5 * b->dt;
  return MPM_OK;
}

/* A body is driven along a smooth plane on which it rests: nothing resists but its inertia. Prescribed
 * particles have that themselves, and their reaction is 0; that of the host is the momentum that the body
 * gains, and with the trapezoid rule its work is the kinetic energy. */
START_TEST(driven_along_a_plane) {
  const newmark *of = &rules[_i / 2];
  const int32_t by_host = _i % 2;
  const double h = 0.1, dt = 1e-3, lower[2] = {5.0 * h, 3.0 * h}, upper[2] = {7.0 * h, 5.0 * h};
  world w;
  world_desc desc = newmark_world(of, MPM_BSPLINE2, 12, h);
  mpm_particles *set = world_open(&w, &desc);
  world_fill(&w, set, lower, upper, 2);
  if (by_host) {
    ck_ok(&w, mpm_stepper_set_velocity_bc(w.stepper, drive, NULL));
  } else {
    ck_ok(&w, mpm_particles_set_all(set, "prescribed", MPM_U8, 2, (uint8_t[]){1, 0}));
    ck_ok(&w, mpm_stepper_set_motion(w.stepper, set, accelerate, NULL));
  }
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_PLANE);
  d.position[1] = lower[1];
  mpm_obstacle *o = put_obstacle(&w, &d);
  const double mass = mass_of(&w, set);
  double work = 0.0, start = 0.0;
  for (int32_t step = 0; step < 6; ++step) {
    const mpm_step_info before = world_info(&w), after = world_step(&w, dt);
    const double mean = dt * (step + 0.5), gained = after.momentum[0] - before.momentum[0];
    if (by_host) {
      int64_t nodes;
      double *of_nodes = fetch_nodes(&w, "reaction", &nodes);
      ck_within("host", dt * sum_of(nodes, of_nodes), gained, 1e-12 * mass * dt);
      free(of_nodes);
      work += gained * mean;
      if (of->gamma == 0.5 && of->beta == 0.25)
        ck_within("energy", after.external_work_total, after.kinetic_energy, 1e-10 * mass * mean * mean);
    } else {
      double force[2];
      ck_ok(&w, mpm_stepper_particles_reaction(w.stepper, set, force));
      ck_within("reaction", force[0], 0.0, 1e-10 * mass);
      work += mass * (mean - start) * mean;
      start = mean;
    }
    ck_within("work", after.external_work_total, work, 1e-10 * mass * mean * mean);
  }
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

/* A body follows a plane that draws back half a cell in a step, a little faster. When gaps are measured again
 * the plane is where the step has taken it: else the body would be deep in it. */
START_TEST(follows_a_plane) {
  const double h = 0.1, speed = 1.0, lower[2] = {5.0 * h, 8.0 * h}, upper[2] = {7.0 * h, 10.0 * h};
  world w;
  world_desc desc = newmark_world(&rules[_i], MPM_BSPLINE2, 12, h);
  desc.stepper.newton_tolerance_residual = 1e-9; /* forces are small beside those of the way */
  mpm_particles *set = world_open(&w, &desc);
  world_fill(&w, set, lower, upper, 2);
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, (double[]){0.0, -1.1 * speed}));
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_PLANE);
  d.motion = MPM_MOTION_PRESCRIBED;
  d.position[1] = lower[1];
  d.velocity[1] = -speed;
  mpm_obstacle *o = put_obstacle(&w, &d);
  world_step(&w, 0.5 * h / speed);
  ck_assert_double_gt(touch_of(&w, o).impulse[1], 0.0);
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

/* ---- walls --------------------------------------------------------------------------------------------- */
/* An obstacle presses a thin layer onto a fixed wall, and reaches nodes that the wall mirrors. With gamma = 1
 * what particles gain is what acts at the end of the step. */
START_TEST(layer_on_a_wall) {
  static const int32_t bases[] = {MPM_BSPLINE2, MPM_BSPLINE3, MPM_GIMP};
  const newmark of = {1.0, (double[]){0.5, 0.5625, 1.0}[_i / 6]};
  const int32_t layers = 1 + _i % 6 / 3;
  const double h = 0.125, dt = 0.01, lower[2] = {0.0, 0.0}, upper[2] = {0.5, layers * h};
  world w;
  world_desc desc = newmark_world(&of, bases[_i % 3], 8, h);
  desc.grid.cells[0] = 4;
  desc.grid.periodic[0] = 1;
  desc.law.E = 100.0;
  desc.law.density = 1.0;
  desc.stepper.gravity[1] = -1.0;
  mpm_particles *set = world_open(&w, &desc);
  world_fill(&w, set, lower, upper, 2);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FIXED, 0.0));
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_PLANE);
  d.motion = MPM_MOTION_PRESCRIBED;
  d.position[1] = upper[1];
  d.orientation[0] = 0.0, d.orientation[3] = 1.0;
  d.velocity[1] = -0.1;
  mpm_obstacle *o = put_obstacle(&w, &d);
  double pressed = 0.0;
  for (int32_t step = 0; step < 4; ++step) {
    const mpm_step_info before = world_info(&w), after = world_step(&w, dt);
    double wall[2];
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_Y_MIN, wall));
    const double by_obstacle = touch_of(&w, o).force[1], weight = -mass_of(&w, set);
    ck_within("balance", wall[1] + by_obstacle + weight, (after.momentum[1] - before.momentum[1]) / dt, 1e-9);
    pressed += by_obstacle;
  }
  ck_assert_double_lt(pressed, -1.0);
  drop_obstacle(&w, o);
  world_close(&w);
}
END_TEST

/* ---- symmetry ------------------------------------------------------------------------------------------ */
/* A block that is symmetric about the middle of the grid falls straight on a smooth wall. It reaches over to
 * rows of nodes that have hardly any of its mass. */
START_TEST(symmetric_block) {
  enum { EDGE = 8, COUNT = EDGE * EDGE * EDGE };
  const double h = 0.125, apart = 0.5 * h, middle = 5.0 * h, volume = apart * apart * apart;
  const int32_t basis = _i ? MPM_BSPLINE3 : MPM_BSPLINE2;
  double x[3 * COUNT], volumes[COUNT];
  for (int32_t p = 0; p < COUNT; ++p) {
    const int32_t at[3] = {p / (EDGE * EDGE), p / EDGE % EDGE, p % EDGE};
    for (int32_t c = 0; c < 3; ++c) {
      const double off = (at[c] - 0.5 * (EDGE - 1)) * apart, wider = 0.75 * apart;
      x[c * COUNT + p] = c == 1 ? (at[c] + 0.5) * apart : middle + off + (off < 0.0 ? -wider : wider);
    }
    volumes[p] = volume;
  }
  world w;
  world_desc desc = newmark_world(&rules[0], basis, 10, h);
  desc.grid.dim = 3;
  desc.grid.cells[2] = 10;
  desc.grid.spacing[2] = h;
  desc.law.E = 1000.0;
  desc.law.density = 1.0;
  desc.stepper.gravity[1] = -1.0;
  mpm_particles *set = world_open(&w, &desc);
  ck_ok(&w, mpm_particles_add(set, COUNT, x, NULL, volumes, NULL, NULL, NULL));
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 3, (double[]){0.0, -0.2, 0.0}));
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_Y_MIN, MPM_WALL_FRICTION, 0.0));
  for (int32_t step = 0; step < 8; ++step) world_step(&w, 0.01);
  double *v = fetch(&w, set, "velocity", 3), *stress = fetch(&w, set, "stress", 6);
  const double most = largest(COUNT, stress + COUNT), fastest = largest(COUNT, v + COUNT);
  ck_assert_double_gt(most, 0.1);
  for (int32_t p = 0; p < COUNT; ++p) {
    const int32_t image = p + EDGE * EDGE * (EDGE - 1 - 2 * (p / (EDGE * EDGE)));
    ck_within("stress", stress[COUNT + p], stress[COUNT + image], 1e-9 * most);
    ck_within("across", v[p], -v[image], 1e-9 * fastest);
    ck_within("down", v[COUNT + p], v[COUNT + image], 1e-9 * fastest);
  }
  free(v), free(stress);
  world_close(&w);
}
END_TEST

void add_obstacle_reactions(Suite *suite) {
  TCase *reactions = tcase_create("reactions");
  tcase_add_loop_test(reactions, driven_along_a_plane, 0, 2 * RULES);
  tcase_add_loop_test(reactions, follows_a_plane, 0, RULES);
  tcase_add_loop_test(reactions, layer_on_a_wall, 0, 18);
  add_sparse(reactions, symmetric_block, 2, 3);
  tcase_set_timeout(reactions, 60);
  suite_add_tcase(suite, reactions);
}
