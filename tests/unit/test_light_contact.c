/* Contact at light nodes of the linear basis, which go with heavier ones before contact and after it. */
#include "obstacle.h"
#include "walls.h"

#include <string.h>

/* ---- energy -------------------------------------------------------------------------------------------- */
enum { PAIRS = 6, PLACES = 3 };
static method pair_of(int32_t i) {
  enum { USL, MUSL, FLIP = 0, APIC = 3, TFLIP = 7 }; /* places in the lists of methods.h */
  static const int32_t pair[PAIRS][2] = {{USL, FLIP},  {USL, APIC},  {USL, TFLIP},
                                         {MUSL, FLIP}, {MUSL, APIC}, {MUSL, TFLIP}};
  return method_of(&basis_options[0], &scheme_options[pair[i][0]], &transfer_options[pair[i][1]]);
}

/* Two discs of 8 cells across that meet aslant as bodies, at three places of the grid. A light node that goes
 * on with what contact alone has left it is strained by what nothing pays for: the discs would gain up to
 * 27 % of their energy. */
START_TEST(discs_meet_at_light_nodes) {
  static const double shift[PLACES] = {0.0, 0.27, 0.69};
  const method how = pair_of(_i / PLACES);
  const double h = 0.05, at = shift[_i % PLACES] * h;
  const double centre[2][2] = {{0.4185 + at, 0.5685 + 0.7 * at}, {1.0185 + at, 0.8685 + 0.7 * at}};
  const double v[2][2] = {{0.13, 0.05}, {-0.13, -0.05}};
  const int32_t per_cell[2] = {2, 2};
  world w;
  world_desc desc = world_with(&how, 2, 28, h);
  desc.sets = 2;
  desc.law.E = 1000.0;
  world_open(&w, &desc);
  double most = 0.0;
  for (int32_t i = 0; i < 2; ++i) {
    ck_ok(&w, mpm_stepper_set_body(w.stepper, w.set[i], i));
    ck_ok(&w, mpm_particles_fill_ball(w.set[i], centre[i], 0.2, per_cell, NULL, NULL));
    ck_ok(&w, mpm_particles_set_all(w.set[i], "velocity", MPM_F64, 2, v[i]));
  }
  mpm_step_info now = world_info(&w);
  const double E0 = now.kinetic_energy, mass = mass_of(&w, w.set[0]);
  double highest = 0.0;
  while (now.t < 3.6) {
    now = world_step(&w, 0.2 * world_stable_dt(&w));
    highest = fmax(highest, (now.kinetic_energy + now.affine_kinetic_energy + now.strain_energy) / E0);
    most = fmax(most, fabs(now.momentum[0]));
  }
  mpm_contact_info met = {.struct_size = sizeof met};
  ck_ok(&w, mpm_stepper_contact_info(w.stepper, 0, 1, &met));
  show("discs at light nodes, %s: highest E %.6f, momentum %.1e, pushed by %.4f\n", how.name, highest, most,
       -met.impulse[0] / mass);
  ck_between(how.name, highest, 0.0, 1.0005);
  ck_between(how.name, most, 0.0, 1e-12);
  ck_assert_double_gt(fabs(met.impulse[0]) / mass, 0.13); /* they have turned back */
  world_close(&w);
}
END_TEST

/* Two bars, the first of which flies at the other one. What light nodes follow with the velocities of contact
 * in place of their leaders would give them up to 0.4 % of energy. */
START_TEST(bars_meet_at_light_nodes) {
  const method how = pair_of(_i);
  const double h = 0.05, v = 0.01, shift = 0.41 * h, gap = 0.003;
  world w;
  world_desc desc = world_with(&how, 1, 64, h);
  desc.sets = 2;
  desc.law = (world_law){.model = "neo_hookean", .E = 1.0, .nu = 0.0, .density = 1.0};
  world_open(&w, &desc);
  for (int32_t i = 0; i < 2; ++i) {
    const double low = 0.5 + i, high = low + 1.0, speed = i ? 0.0 : v;
    ck_ok(&w, mpm_stepper_set_body(w.stepper, w.set[i], i));
    const int64_t n = world_fill(&w, w.set[i], &low, &high, 2);
    double *x = fetch(&w, w.set[i], "position", 1);
    for (int64_t p = 0; p < n; ++p) x[p] += shift + gap * i;
    put(&w, w.set[i], "position", 1, x);
    free(x);
    ck_ok(&w, mpm_particles_set_all(w.set[i], "velocity", MPM_F64, 1, &speed));
  }
  mpm_step_info now = world_info(&w);
  const double E0 = now.kinetic_energy;
  double highest = 0.0;
  while (now.t < 4.0) {
    now = world_step(&w, 0.2 * world_stable_dt(&w));
    highest = fmax(highest, (now.kinetic_energy + now.affine_kinetic_energy + now.strain_energy) / E0);
  }
  double *u = fetch(&w, w.set[1], "velocity", 1), mean = 0.0;
  const int64_t n = mpm_particles_count(w.set[1]);
  for (int64_t p = 0; p < n; ++p) mean += u[p] / (double)n;
  show("bars at light nodes, %s: highest E %.6f, second bar %.4f of the speed\n", how.name, highest,
       mean / v);
  ck_between(how.name, highest, 0.0, 1.0005);
  ck_between(how.name, mean / v, 0.95, 1.02); /* they have changed their speeds */
  free(u);
  world_close(&w);
}
END_TEST

/* ---- what holds nodes ---------------------------------------------------------------------------------- */
enum { CLOUD = 120, HELD = 8, SEEDS = 16 };

/* Returns 1 for a node to which a prescribed particle, one of the first, gives. */
static int32_t is_held(const double *x, int64_t n, double h, const double *node, int64_t nodes) {
  for (int64_t p = 0; p < HELD; ++p)
    if (fabs(x[p] - node[0]) < h && fabs(x[n + p] - node[nodes]) < h) return 1;
  return 0;
}

/* A thin cloud, most of whose nodes are light, on a plane that pushes it. What prescribed particles hold, and
 * the nodes of a friction wall, stay as these have set them. */
START_TEST(holders_have_the_last_word) {
  const method how = pair_of(_i / SEEDS);
  const double h = 0.1, dt = 1e-4, v[2] = {0.3, -0.2};
  const uint8_t held[2] = {1, 1};
  world w;
  world_desc desc = world_with(&how, 2, 12, h);
  mpm_particles *set = world_open(&w, &desc);
  dice d = {31 + (uint64_t)_i};
  add_cloud(&w, set, &d, CLOUD, h, 0.0, 1.1, 1.0);
  for (int64_t p = 0; p < HELD; ++p) {
    ck_ok(&w, mpm_particles_set(set, "prescribed", MPM_U8, 2, 1, &p, held));
    ck_ok(&w, mpm_particles_set(set, "velocity", MPM_F64, 2, 1, &p, v));
  }
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FRICTION_NODES, 0.3));
  mpm_contact_desc rule = rule_with(0.2);
  mpm_obstacle_desc plane = obstacle_desc(MPM_SHAPE_PLANE);
  plane.position[1] = 0.52;
  plane.contact = &rule;
  mpm_obstacle *floor;
  ck_ok(&w, mpm_obstacle_create(w.context, &plane, &floor));
  ck_ok(&w, mpm_stepper_add_obstacle(w.stepper, floor));
  ck_ok(&w, mpm_step_begin(w.stepper, dt));
  ck_ok(&w, mpm_step_grid(w.stepper));
  int64_t nodes;
  const int64_t n = mpm_particles_count(set);
  double *at = fetch_nodes(&w, "position", &nodes), *u = fetch_nodes(&w, "velocity", &nodes),
         *x = fetch(&w, set, "position", 2);
  int64_t checked = 0, on_wall = 0;
  for (int64_t i = 0; i < nodes; ++i) {
    if (is_held(x, n, h, at + i, nodes)) {
      for (int32_t c = 0; c < 2; ++c) ck_within(how.name, u[c * nodes + i], v[c], 1e-15);
      ++checked;
    } else if (fabs(at[i]) < 1e-3 * h) {
      ck_assert_double_ge(u[i], -1e-13);
      ++on_wall;
    }
  }
  mpm_contact_info met = {.struct_size = sizeof met};
  ck_ok(&w, mpm_step_end(w.stepper, NULL));
  ck_ok(&w, mpm_obstacle_contact_info(floor, MPM_BODY_ANY, &met));
  ck_assert_int_gt(checked, HELD);
  ck_assert_int_gt(on_wall, 2);
  ck_assert_int_gt(met.closed, 0);
  free(at), free(u), free(x);
  ck_ok(&w, mpm_stepper_remove_obstacle(w.stepper, floor));
  ck_ok(&w, mpm_obstacle_destroy(floor));
  world_close(&w);
}
END_TEST

/* Returns copies of the positions and velocities of a body's nodes. */
static int64_t nodes_of_body(world *w, int32_t body, double *out[2]) {
  static const char *const field[2] = {"position", "velocity"};
  int64_t n = 0;
  for (int32_t f = 0; f < 2; ++f) {
    mpm_view view = {.struct_size = sizeof view};
    ck_ok(w, mpm_grid_map(w->stepper, body, field[f], MPM_READ, &view));
    n = view.count;
    out[f] = malloc(sizeof(double) * 2 * (size_t)(n + 1));
    for (int32_t c = 0; c < 2; ++c)
      for (int64_t i = 0; i < n; ++i)
        memcpy(&out[f][c * n + i],
               (const char *)view.data + 8 * (i * view.item_stride + c * view.component_stride), 8);
    ck_ok(w, mpm_view_release(&view));
  }
  return n;
}

/* Two thin clouds side by side that are tied: light nodes of one that the tie holds do not leave it again. */
START_TEST(ties_stay_closed) {
  const method how = pair_of(_i / SEEDS);
  const double h = 0.1;
  world w;
  world_desc desc = world_with(&how, 2, 12, h);
  desc.sets = 2;
  world_open(&w, &desc);
  dice d = {131 + (uint64_t)_i};
  mpm_contact_desc rule = rule_with(0.0);
  rule.kind = MPM_CONTACT_TIED;
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, MPM_BODY_ANY, MPM_BODY_ANY, &rule));
  for (int32_t m = 0; m < 2; ++m) {
    ck_ok(&w, mpm_stepper_set_body(w.stepper, w.set[m], m));
    add_cloud(&w, w.set[m], &d, CLOUD / 2, h, 0.1 + 0.4 * m, 0.7 + 0.4 * m, 1.0);
  }
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-4));
  ck_ok(&w, mpm_step_grid(w.stepper));
  double *of[2][2];
  int64_t n[2], shared = 0;
  for (int32_t m = 0; m < 2; ++m) n[m] = nodes_of_body(&w, m, of[m]);
  for (int64_t i = 0; i < n[0]; ++i)
    for (int64_t j = 0; j < n[1]; ++j) {
      if (hypot(of[0][0][i] - of[1][0][j], of[0][0][n[0] + i] - of[1][0][n[1] + j]) > 1e-6 * h) continue;
      ++shared;
      for (int32_t c = 0; c < 2; ++c)
        ck_within(how.name, of[0][1][c * n[0] + i], of[1][1][c * n[1] + j], 1e-12);
    }
  ck_assert_int_gt(shared, 2);
  for (int32_t m = 0; m < 2; ++m) free(of[m][0]), free(of[m][1]);
  ck_ok(&w, mpm_step_abort(w.stepper));
  world_close(&w);
}
END_TEST

Suite *light_contact_suite(void) {
  Suite *suite = suite_create("light_contact");
  TCase *tc = tcase_create("light_contact");
  tcase_set_timeout(tc, 60.0);
  tcase_add_loop_test(tc, discs_meet_at_light_nodes, 0, PAIRS * PLACES);
  tcase_add_loop_test(tc, bars_meet_at_light_nodes, 0, PAIRS);
  tcase_add_loop_test(tc, holders_have_the_last_word, 0, PAIRS * SEEDS);
  tcase_add_loop_test(tc, ties_stay_closed, 0, PAIRS * SEEDS);
  suite_add_tcase(suite, tc);
  return suite;
}
