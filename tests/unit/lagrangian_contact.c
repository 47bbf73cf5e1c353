/* Total Lagrangian grids and obstacles, which meet bodies where they are now. */
#include "lagrangian.h"
#include "obstacle.h"

/* A block flies a long way, out of the grid, turned by half a right angle in between, and falls on a plane:
 * it touches where it is and not where it was, and leaves with the momentum that the plane reports. */
START_TEST(obstacles_meet_what_has_moved) {
  const int32_t dim = 1 + _i % 3, implicit = _i >= 3;
  world w;
  world_desc desc =
      implicit ? implicit_total(&basis_options[0], dim, 0, "neo_hookean") : total_with(broad_methods[0], dim);
  desc.stepper.flip = 1.0;
  mpm_particles *set = open_block_with(&w, &desc);
  const int64_t n = mpm_particles_count(set);
  double *x = fetch(&w, set, "position", dim), *moved = malloc((size_t)(dim * n) * sizeof *moved);
  double F[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  const double turn = sqrt(0.5);
  if (dim > 1) F[0] = F[4] = turn, F[1] = -turn, F[3] = turn;
  for (int64_t p = 0; p < n; ++p)
    for (int32_t i = 0; i < dim; ++i) {
      moved[i * n + p] = 20.0;
      for (int32_t k = 0; k < dim; ++k) moved[i * n + p] += F[3 * i + k] * (x[k * n + p] - 1.5);
    }
  put(&w, set, "position", dim, moved);
  ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
  const int32_t down = dim > 1 ? 1 : 0;
  double v[3] = {0.0, 0.0, 0.0}, lowest = moved[down * n];
  for (int64_t p = 0; p < n; ++p) lowest = fmin(lowest, moved[down * n + p]);
  v[down] = -1.0;
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, v));
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_PLANE);
  d.position[down] = lowest - 0.3;
  mpm_obstacle *floor = put_obstacle(&w, &d);
  mpm_contact_info info = {0};
  const double mass = mass_of(&w, set), dt = implicit ? 1e-2 : 1e-3;
  double first = 0.0, most = 0.0;
  while (w.info.t < 0.9) {
    world_step(&w, dt);
    info = touch_of(&w, floor);
    if (info.touching && first == 0.0) first = w.info.t;
    most = fmax(most, info.normal_force);
  }
  show("%d-D, implicit %d: first touch %g, momentum %g of %g, force %g\n", (int)dim, (int)implicit, first,
       w.info.momentum[down], mass, most);
  ck_between("first touch", first, 0.2, 0.3);
  ck_within("momentum", w.info.momentum[down], info.impulse[down] - mass, 1e-10 * mass);
  ck_between("rebound", w.info.momentum[down] / mass, 0.4, 1.0); /* on its edge */
  drop_obstacle(&w, floor);
  free(x);
  free(moved);
  world_close(&w);
}
END_TEST

/* Returns what came of a block that is turned by so many right angles, F and positions alike, when it comes
 * down on a ball, fixed or free: momentum, angular momentum, and those that the ball says it has got. */
typedef struct landing {
  double momentum[2], spin, force[2], torque;
} landing;

static landing land(const method *how, int32_t turns, int32_t is_free) {
  static const double cosine[4] = {1.0, 0.0, -1.0, 0.0}, sine[4] = {0.0, 1.0, 0.0, -1.0};
  const double c = cosine[turns], s = sine[turns], F[9] = {c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0},
               v[] = {0.4, -1.0};
  world w;
  const world_desc desc = total_with(how, 2);
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {1.0, 1.0}, high[] = {2.0, 2.0};
  const int64_t n = world_fill(&w, set, low, high, 2);
  double *x = fetch(&w, set, "position", 2), *moved = malloc((size_t)(2 * n) * sizeof *moved);
  for (int64_t p = 0; p < n; ++p)
    for (int32_t i = 0; i < 2; ++i)
      moved[i * n + p] = 8.0 + 2.0 * i + F[3 * i] * (x[p] - 1.5) + F[3 * i + 1] * (x[n + p] - 1.5);
  put(&w, set, "position", 2, moved);
  ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
  ck_ok(&w, mpm_particles_set_all(set, "velocity", MPM_F64, 2, v));
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_SPHERE);
  const mpm_contact_desc rule = rule_with(0.4);
  d.contact = &rule;
  d.motion = is_free ? MPM_MOTION_FREE : MPM_MOTION_FIXED;
  d.size[0] = 0.6;
  d.position[0] = 7.8, d.position[1] = 8.85;
  d.mass = 500.0;
  d.inertia[0] = d.inertia[4] = d.inertia[8] = 50.0;
  mpm_obstacle *ball = put_obstacle(&w, &d);
  mpm_contact_info info = {0};
  landing of = {.torque = 0.0};
  const double before = world_info(&w).angular_momentum[2];
  for (int32_t k = 0; k < 150; ++k) {
    world_step(&w, 1e-3);
    info = touch_of(&w, ball);
    of.torque += 1e-3 * info.torque[2];
  }
  double at[3], velocity[3], spin[3];
  ck_ok(&w, mpm_obstacle_get_pose(ball, at, NULL, velocity, spin));
  const double of_ball = is_free ? 500.0 * (at[0] * velocity[1] - at[1] * velocity[0]) + 50.0 * spin[2] : 0.0;
  for (int32_t i = 0; i < 2; ++i) of.momentum[i] = w.info.momentum[i], of.force[i] = info.impulse[i];
  of.spin = w.info.angular_momentum[2] + of_ball - before;
  drop_obstacle(&w, ball);
  free(x);
  free(moved);
  world_close(&w);
  return of;
}

/* Contact does not know how a body was turned before; and with a transfer that keeps angular momentum a free
 * ball gets what the body loses. */
START_TEST(contact_is_objective) {
  const method how =
      method_of(&basis_options[_i % 2 ? 1 : 2], &scheme_options[0], &transfer_options[_i / 2 ? 3 : 0]);
  for (int32_t is_free = 0; is_free < 2; ++is_free) {
    const landing first = land(&how, 0, is_free);
    ck_holds(first.force[1] > 50.0);
    /* of some 1e4; internal forces keep it as far as F is the gradient of the places of nodes */
    if (is_affine(&how) && is_free) ck_within("angular momentum", first.spin, 0.0, 0.5);
    for (int32_t turns = 1; turns < 4; ++turns) {
      const landing now = land(&how, turns, is_free);
      for (int32_t i = 0; i < 2; ++i) {
        ck_within(how.name, now.momentum[i], first.momentum[i], 1e-7 * 1e3);
        ck_within(how.name, now.force[i], first.force[i], 1e-7 * 1e3);
      }
      ck_within(how.name, now.torque, first.torque, 1e-7 * 1e3);
    }
  }
}
END_TEST

/* What lies on a plane does not sink into it, however far it is drawn out. */
START_TEST(stretched_bodies_rest) {
  const double stretch = 3.0, F[9] = {1.0, 0.0, 0.0, 0.0, stretch, 0.0, 0.0, 0.0, 1.0};
  world w;
  world_desc desc = total_with(&methods[0], 2);
  desc.law.model = "linear_elastic"; /* whose stress is its state: drawn out, it rests */
  desc.law.E = 1e6;
  desc.stepper.gravity[1] = -1.0;
  desc.stepper.mass_damping = 20.0;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {1.0, 1.0}, high[] = {2.0, 1.5};
  const int64_t n = world_fill(&w, set, low, high, 1);
  double *x = fetch(&w, set, "position", 2);
  for (int64_t p = 0; p < n; ++p) x[n + p] = stretch * (x[n + p] - 1.0); /* its face is at y = 0 */
  put(&w, set, "position", 2, x);
  ck_ok(&w, mpm_particles_set_all(set, "deformation_gradient", MPM_F64, 9, F));
  mpm_obstacle_desc d = obstacle_desc(MPM_SHAPE_PLANE);
  d.position[1] = 0.0;
  mpm_obstacle *floor = put_obstacle(&w, &d);
  for (int32_t k = 0; k < 600; ++k) world_step(&w, 2e-3);
  free(x);
  x = fetch(&w, set, "position", 2);
  double lowest = 10.0;
  for (int64_t p = 0; p < n; ++p) lowest = fmin(lowest, x[n + p]);
  ck_within("face", lowest - 0.5 * stretch * spacing, 0.0, 0.05 * spacing);
  ck_assert_int_eq((int)touch_of(&w, floor).nodes, 5); /* one row: two would make it stiff */
  free(x);
  drop_obstacle(&w, floor);
  world_close(&w);
}
END_TEST

void add_lagrangian_contact(Suite *suite) {
  TCase *contact = tcase_create("contact");
  tcase_add_loop_test(contact, obstacles_meet_what_has_moved, 0, 6);
  tcase_add_loop_test(contact, contact_is_objective, 0, 4);
  tcase_add_test(contact, stretched_bodies_rest);
  tcase_set_timeout(contact, 60);
  suite_add_tcase(suite, contact);
}
