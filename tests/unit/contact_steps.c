/* Steps in contact that are refused, cut, or fail, most of them implicit. */
#include "boxes.h"
#include "implicit.h"

static mpm_status keep_friction(void *user, const mpm_contact_batch *b, double *friction) {
  (void)user, (void)b, (void)friction;
  return MPM_OK;
}

/* What implicit steps do not offer, whichever call comes last. */
START_TEST(implicit_bodies) {
  world w;
  open_boxes(&w, &(boxes){.dim = 2, .method = methods[1], .contact = contact_desc(0.0)});
  mpm_stepper_desc implicit = stepper_desc();
  implicit.scheme = MPM_NEWMARK;
  mpm_contact_desc none = contact_desc(0.0), pulls = contact_desc(0.0);
  none.kind = MPM_CONTACT_NONE;
  pulls.adhesion = 1.0;
  const char *text = "has adhesion, which MPM_NEWMARK does not offer";
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 2, 3, &pulls));
  ck_refused(&w, mpm_stepper_configure(w.stepper, &implicit), MPM_E_UNSUPPORTED, text);
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 2, 3, NULL));
  ck_ok(&w, mpm_stepper_set_friction(w.stepper, keep_friction, NULL));
  ck_refused(&w, mpm_stepper_configure(w.stepper, &implicit), MPM_E_UNSUPPORTED, "no friction callback");
  ck_ok(&w, mpm_stepper_set_friction(w.stepper, NULL, NULL));
  ck_ok(&w, mpm_stepper_configure(w.stepper, &implicit));
  ck_refused(&w, mpm_stepper_set_friction(w.stepper, keep_friction, NULL), MPM_E_UNSUPPORTED,
             "no friction callback");
  ck_refused(&w, mpm_stepper_set_contact(w.stepper, 2, 3, &pulls), MPM_E_UNSUPPORTED, text);
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 1, 3, &pulls)); /* there is no body 1 yet */
  ck_refused(&w, mpm_stepper_set_body(w.stepper, w.set[1], 1), MPM_E_UNSUPPORTED, text);
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 0, 3, &pulls));
  ck_ok(&w, mpm_stepper_remove(w.stepper, w.set[1]));
  ck_refused(&w, mpm_stepper_add(w.stepper, w.set[1]), MPM_E_UNSUPPORTED, text);
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 0, 3, &none));
  ck_ok(&w, mpm_stepper_add(w.stepper, w.set[1]));
  ck_ok(&w, mpm_step(w.stepper, box_dt, NULL));
  /* multigrid knows one body alone */
  implicit.linear_solver = MPM_SOLVER_MULTIGRID_CG;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &implicit));
  ck_refused(&w, mpm_stepper_set_body(w.stepper, w.set[1], 2), MPM_E_UNSUPPORTED, "is for one body");
  implicit.linear_solver = MPM_SOLVER_AUTO;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &implicit));
  ck_ok(&w, mpm_stepper_set_body(w.stepper, w.set[1], 2));
  ck_ok(&w, mpm_step(w.stepper, box_dt, NULL));
  implicit.linear_solver = MPM_SOLVER_MULTIGRID_CG;
  ck_refused(&w, mpm_stepper_configure(w.stepper, &implicit), MPM_E_UNSUPPORTED, "is for one body");
  world_close(&w);
}
END_TEST

/* Blocks that collide: while it stays the same what touches, Newton's method is of second order. */
START_TEST(implicit_contact_is_quadratic) {
  const int32_t dim = 1 + _i % 3, tied = _i / 3;
  const int32_t per_cell[] = {2, 2, 2};
  world w;
  world_desc d = implicit_default(dim, 14, 0.1, implicit_basis(1));
  mpm_contact_desc meets = contact_desc(0.0);
  d.sets = 2;
  world_open(&w, &d);
  if (tied) meets.kind = MPM_CONTACT_TIED;
  for (int32_t m = 0; m < 2; ++m) {
    const double low[] = {m ? 0.7 : 0.3, 0.3, 0.3}, high[] = {m ? 1.1 : 0.7, 0.7, 0.7};
    const double velocity[] = {m ? -0.5 : 0.5, 0.0, 0.0};
    ck_ok(&w, mpm_particles_fill_box(w.set[m], low, high, per_cell, NULL, NULL));
    ck_ok(&w, mpm_particles_set_all(w.set[m], "velocity", MPM_F64, dim, velocity));
  }
  ck_ok(&w, mpm_stepper_set_body(w.stepper, w.set[1], 1));
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 0, 1, &meets));
  char name[60];
  snprintf(name, sizeof name, "%s blocks in %d-D", tied ? "tied" : "pushed", (int)dim);
  for (int32_t k = 0; k < 3; ++k) world_step(&w, 0.03);
  implicit_quadratic(name, &w, 60.0);
  mpm_contact_info info = {.struct_size = sizeof info};
  ck_ok(&w, mpm_stepper_contact_info(w.stepper, 0, 1, &info));
  ck_assert_int_gt(info.closed, 0);
  world_close(&w);
}
END_TEST

/* All solvers of a symmetric system, and of one that sliding makes unsymmetric, find the same step. */
START_TEST(implicit_solvers) {
  static const int32_t solver[] = {MPM_SOLVER_LDLT, MPM_SOLVER_CG, MPM_SOLVER_GMRES, MPM_SOLVER_AUTO};
  for (int32_t slides = 0; slides < 2; ++slides) {
    world w[4];
    for (int32_t i = 2 * slides; i < 4; ++i) {
      open_boxes(&w[i], &(boxes){.dim = _i, .method = methods[1], .contact = contact_desc(0.3 * slides)});
      mpm_stepper_desc implicit = stepper_desc();
      implicit.scheme = MPM_NEWMARK;
      implicit.linear_solver = solver[i];
      ck_ok(&w[i], mpm_stepper_configure(w[i].stepper, &implicit));
      for (int32_t step = 0; step < 5; ++step) world_step(&w[i], 4.0 * box_dt);
      ck_assert_double_gt(fabs(contact_of(&w[i], 2, 3).impulse[0]), 0.0);
      if (i > 2 * slides) world_agree("solvers", &w[i], &w[2 * slides], "velocity", _i, 1e-7);
    }
    for (int32_t i = 2 * slides; i < 4; ++i) world_close(&w[i]);
  }
}
END_TEST

/* A step in which bodies slide by more than half a cell is cut, and mpm_advance gets through. */
START_TEST(implicit_slip) {
  world w;
  open_boxes(&w, &(boxes){.dim = 2, .method = methods[1], .contact = contact_desc(0.0)});
  mpm_stepper_desc implicit = stepper_desc();
  implicit.scheme = MPM_NEWMARK;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &implicit));
  const double v[2] = {0.1 * box_speed, 10.0 * box_speed};
  ck_ok(&w, mpm_particles_set_all(w.set[0], "velocity", MPM_F64, 2, v));
  const uint64_t was = world_hash(&w);
  ck_refused(&w, mpm_step(w.stepper, 0.6 * spacing / v[1], &w.info), MPM_CUT_DT, "more than half a cell");
  ck_assert_int_ge(w.info.node, 0);
  ck_assert_uint_eq(world_hash(&w), was);
  mpm_advance_desc advance;
  ck_ok(&w, mpm_advance_desc_init(&advance, sizeof advance));
  advance.t_end = advance.dt_first = 0.6 * spacing / v[1];
  ck_ok(&w, mpm_advance(w.stepper, &advance, NULL));
  world_close(&w);
}
END_TEST

/* Points below a slope that rises to the right, or those above it. */
static mpm_status is_below(void *user, int32_t dim, int64_t n, int64_t ld, const double *x, uint8_t *inside) {
  const int32_t *above = user;
  (void)dim;
  for (int64_t i = 0; i < n; ++i) inside[i] = (x[ld + i] > 0.5 * spacing + 0.7 * x[i]) == (*above != 0);
  return MPM_OK;
}

static void set_going(world *w, double lower, double upper) {
  ck_ok(w, mpm_particles_set_all(w->set[0], "velocity", MPM_F64, 2, (double[]){lower, 0.0}));
  ck_ok(w, mpm_particles_set_all(w->set[1], "velocity", MPM_F64, 2, (double[]){upper, -0.05 * box_speed}));
}

/* What lies on a slope is pushed against it, along a normal that is said to be upright: nothing resists, and
 * a step after which the bodies overlap by more than a quarter of a cell is cut, wherever they have come to
 * together, but not a smaller one, nor one in which both go as far. */
START_TEST(implicit_overlap) {
  const int32_t per_cell[2] = {2, 2};
  const double low[2] = {3.0 * spacing, spacing}, high[2] = {9.0 * spacing, 9.0 * spacing};
  method how = methods[1];
  how.scheme = MPM_NEWMARK;
  world w;
  world_desc desc = world_with(&how, 2, 12, spacing);
  desc.sets = 1;
  desc.grid.periodic[0] = 1;
  world_open(&w, &desc);
  for (int32_t m = 0; m < 2; ++m) {
    mpm_particles *set = m ? world_add_set(&w, NULL) : w.set[0];
    ck_ok(&w, mpm_particles_fill(set, low, high, per_cell, is_below, &m, NULL, NULL));
    ck_ok(&w, mpm_stepper_set_body(w.stepper, set, m));
  }
  mpm_contact_desc rule = contact_desc(0.0);
  rule.normal = MPM_NORMAL_FIXED;
  rule.direction[1] = 1.0;
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 0, 1, &rule));
  const double far = spacing / box_speed; /* the bodies overlap by 0.7 of the way */
  for (int32_t fast = 0; fast < 6; fast += 5) {
    set_going(&w, fast * box_speed, (fast + 1.0) * box_speed);
    const uint64_t was = world_hash(&w);
    ck_refused(&w, mpm_step(w.stepper, far, &w.info), MPM_CUT_DT, "more than a quarter of one");
    ck_assert_int_ge(w.info.node, 0);
    ck_assert_uint_eq(world_hash(&w), was);
  }
  for (int32_t fast = 1; fast < 6; fast += 4) {
    set_going(&w, fast * box_speed, (fast + 0.2) * box_speed);
    world_step(&w, far);
    ck_assert_double_gt(contact_of(&w, 0, 1).impulse[1], 0.0);
  }
  /* particles stand in stairs: the gap jumps by half a cell where one comes near, in short steps, too */
  int64_t n = mpm_particles_count(w.set[0]);
  double *x = fetch(&w, w.set[0], "position", 2);
  for (int64_t i = 0; i < n; ++i) x[i] = spacing * (0.5 * floor(2.0 * x[i] / spacing) + 0.31);
  put(&w, w.set[0], "position", 2, x);
  free(x);
  for (int32_t step = 0; step < 10; ++step) {
    set_going(&w, 0.0, box_speed);
    world_step(&w, 0.1 * far);
  }
  set_going(&w, 0.0, box_speed);
  mpm_advance_desc advance;
  ck_ok(&w, mpm_advance_desc_init(&advance, sizeof advance));
  advance.t_end = world_info(&w).t + far;
  advance.dt_first = far;
  ck_ok(&w, mpm_advance(w.stepper, &advance, NULL));
  world_close(&w);
}
END_TEST

/* Two discs, which meet at a point, have no more energy while they touch than before: internal forces that
 * balance contact do no work at other nodes. */
START_TEST(implicit_discs) {
  const double h = 0.1, speed = 0.02, fast[2] = {speed, 0.0}, centre[2][2] = {{1.0, 1.0}, {2.0, 1.0}};
  const int32_t per_cell[2] = {2, 2};
  method how = methods[1];
  how.scheme = MPM_NEWMARK;
  world w;
  world_desc desc = world_with(&how, 2, 30, h);
  desc.sets = 1;
  desc.law.E = desc.law.density;
  world_open(&w, &desc);
  for (int32_t m = 0; m < 2; ++m) {
    mpm_particles *disc = m ? world_add_set(&w, NULL) : w.set[0];
    ck_ok(&w, mpm_particles_fill_ball(disc, centre[m], 0.5, per_cell, NULL, NULL));
    if (!m) ck_ok(&w, mpm_particles_set_all(disc, "velocity", MPM_F64, 2, fast));
    ck_ok(&w, mpm_stepper_set_body(w.stepper, disc, m));
  }
  mpm_contact_desc rule = contact_desc(0.0);
  rule.kind = _i ? MPM_CONTACT_TIED : MPM_CONTACT_UNILATERAL;
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, 0, 1, &rule));
  mpm_step_info now = world_info(&w);
  const double first = now.kinetic_energy;
  double most = 0.0, least = first;
  while (now.t < 3.0) {
    now = world_step(&w, 0.4 * h);
    most = fmax(most, now.kinetic_energy + now.strain_energy);
    least = fmin(least, now.kinetic_energy);
  }
  show("discs %d: largest energy %.4f, least kinetic %.4f\n", (int)_i, most / first, least / first);
  ck_between("they met", least / first, 0.3, 0.7);
  ck_between("energy", most / first, 0.9, 1.0005);
  world_close(&w);
}
END_TEST

/* Two blocks side by side on a floor with friction, and a third on both; the grid is shifted by a part of a
 * cell. */
static void open_masonry(world *w, int32_t basis, double shift, double friction, int32_t is_static) {
  const double h = 0.05, lower[3][2] = {{-0.5, 0.0}, {0.0, 0.0}, {-0.3, 0.4}},
               upper[3][2] = {{0.0, 0.4}, {0.5, 0.4}, {0.3, 0.8}};
  method how = methods[1];
  how.scheme = MPM_NEWMARK;
  how.basis = basis;
  world_desc desc = world_with(&how, 2, 48, h);
  desc.sets = 1;
  desc.law.E = 1e6;
  desc.grid.origin[0] = shift * h - 1.2;
  desc.grid.origin[1] = shift * h - 0.3;
  desc.stepper.gravity[1] = -10.0;
  desc.stepper.quasi_static = is_static;
  world_open(w, &desc);
  for (int32_t m = 0; m < 3; ++m) {
    mpm_particles *block = m ? world_add_set(w, NULL) : w->set[0];
    world_fill(w, block, lower[m], upper[m], 2);
    ck_ok(w, mpm_stepper_set_body(w->stepper, block, m));
  }
  const mpm_contact_desc rule = contact_desc(friction);
  ck_ok(w, mpm_stepper_set_contact(w->stepper, MPM_BODY_ANY, MPM_BODY_ANY, &rule));
}

static mpm_obstacle *put_floor(world *w, double friction) {
  mpm_contact_desc rule = contact_desc(friction);
  mpm_obstacle_desc floor;
  mpm_obstacle *obstacle;
  ck_ok(w, mpm_obstacle_desc_init(&floor, sizeof floor));
  floor.shape = MPM_SHAPE_PLANE;
  floor.contact = &rule;
  ck_ok(w, mpm_obstacle_create(w->context, &floor, &obstacle));
  ck_ok(w, mpm_stepper_add_obstacle(w->stepper, obstacle));
  return obstacle;
}

/* Blocks that rest on each other find their equilibrium under full weight in one quasi-static step, also
 * where the measured gaps between them are a part of a cell; floor and joints bear what lies on them. */
START_TEST(masonry_at_rest) {
  static const int32_t basis[] = {MPM_LINEAR, MPM_BSPLINE2, MPM_BSPLINE3, MPM_GIMP};
  static const double shift[] = {0.0, 0.3, 0.65};
  for (int32_t k = 0; k < 3; ++k) {
    world w;
    open_masonry(&w, basis[_i], shift[k], 0.6, 1);
    mpm_obstacle *floor = put_floor(&w, 0.6);
    world_step(&w, 1.0);
    const double block = 0.2 * 1e3 * 10.0, top = 0.24 * 1e3 * 10.0;
    mpm_contact_info info = {.struct_size = sizeof info};
    ck_ok(&w, mpm_obstacle_contact_info(floor, MPM_BODY_ANY, &info));
    ck_within("floor", info.force[1], 2.0 * block + top, 1e-6 * block);
    info = contact_of(&w, MPM_BODY_ANY, 2);
    ck_within("joint", info.force[1], top, 1e-6 * block);
    ck_ok(&w, mpm_stepper_remove_obstacle(w.stepper, floor));
    ck_ok(&w, mpm_obstacle_destroy(floor));
    world_close(&w);
  }
}
END_TEST

/* With GIMP and no shift the edges of blocks lie on rows of nodes, and nodes beside them have a mass of
 * rounding: what contact does there keeps no step from its end, and asks for no iterations. */
START_TEST(masonry_settles) {
  static const double shift[] = {0.0, 0.25};
  int32_t iterations[2] = {0, 0};
  for (int32_t k = 0; k < 2; ++k) {
    world w;
    open_masonry(&w, MPM_GIMP, shift[k], _i ? 1.0 : 0.6, 0);
    mpm_obstacle *floor = put_floor(&w, _i ? 1.0 : 0.6);
    for (int32_t step = 0; step < 25; ++step) {
      const mpm_step_info info = world_step(&w, 2e-3);
      ck_between("contact takes energy", info.contact_dissipation, -1e-9, 1e3);
      iterations[k] += info.newton_iterations;
    }
    ck_ok(&w, mpm_stepper_remove_obstacle(w.stepper, floor));
    ck_ok(&w, mpm_obstacle_destroy(floor));
    world_close(&w);
  }
  show("masonry: %d iterations, shifted %d\n", (int)iterations[0], (int)iterations[1]);
  ck_between("iterations", iterations[0], 0, 1.3 * iterations[1]);
}
END_TEST

/* Blocks that slide down a slope on each other, three at some nodes: what holds a light node elsewhere is
 * stiffer than that node, and its gaps close as fast as others all the same. */
START_TEST(masonry_slides) {
  static const double v[3][2] = {{0.2, -0.2}, {-0.25, 0.25}, {-0.27, 0.0}};
  mpm_contact_desc rule = contact_desc(1.0);
  rule.friction_static = 1.5;
  world w;
  open_masonry(&w, MPM_BSPLINE3, 0.2, 1.0, 0);
  mpm_stepper_desc slope = w.desc.stepper;
  slope.gravity[0] = 4.5, slope.gravity[1] = -9.0;
  ck_ok(&w, mpm_stepper_configure(w.stepper, &slope));
  ck_ok(&w, mpm_stepper_set_contact(w.stepper, MPM_BODY_ANY, MPM_BODY_ANY, &rule));
  for (int32_t m = 0; m < 3; ++m) ck_ok(&w, mpm_particles_set_all(w.set[m], "velocity", MPM_F64, 2, v[m]));
  mpm_obstacle *floor = put_floor(&w, 1.0);
  ck_ok(&w, mpm_obstacle_set_contact(floor, &rule));
  int32_t most = 0;
  for (int32_t step = 0; step < 20; ++step) {
    const int32_t iterations = world_step(&w, 5e-3).newton_iterations;
    most = iterations > most ? iterations : most;
  }
  show("sliding blocks: %d iterations at most\n", (int)most);
  ck_assert_int_le(most, 14);
  ck_ok(&w, mpm_stepper_remove_obstacle(w.stepper, floor));
  ck_ok(&w, mpm_obstacle_destroy(floor));
  world_close(&w);
}
END_TEST

/* ---- memory -------------------------------------------------------------------------------------------- */
/* Every allocation of steps in contact fails once; the state stays, and the next try succeeds. */
START_TEST(memory_runs_out) {
  world w, same;
  const boxes of = {.dim = 2, .flags = THIRD, .method = methods[1], .contact = contact_desc(0.3)};
  open_boxes(&same, &of);
  open_boxes(&w, &of);
  mpm_stepper_desc implicit = stepper_desc();
  implicit.scheme = MPM_NEWMARK;
  if (_i) ck_ok(&w, mpm_stepper_configure(w.stepper, &implicit));
  if (_i) ck_ok(&same, mpm_stepper_configure(same.stepper, &implicit));
  int64_t failures = 0;
  for (int32_t step = 0; step < 6; ++step) {
    world_step(&same, box_dt);
    for (int64_t at = 1;; ++at) {
      const uint64_t was = world_hash(&w);
      w.memory.fail_at = w.memory.calls + at;
      const mpm_status status = mpm_step(w.stepper, box_dt, &w.info);
      w.memory.fail_at = 0;
      if (!status) break;
      ck_assert_int_eq(status, MPM_E_NOMEM);
      ck_assert_uint_eq(world_hash(&w), was);
      ++failures;
    }
  }
  ck_assert_int_gt(failures, 10);
  ck_assert_uint_eq(world_hash(&w), world_hash(&same));
  world_close(&w);
  world_close(&same);
}
END_TEST

void add_contact_steps(Suite *suite) {
  TCase *steps = tcase_create("steps");
  tcase_set_timeout(steps, 60.0);
  tcase_add_test(steps, implicit_bodies);
  tcase_add_loop_test(steps, implicit_contact_is_quadratic, 0, 6);
  tcase_add_loop_test(steps, implicit_solvers, 1, 4);
  tcase_add_test(steps, implicit_slip);
  tcase_add_test(steps, implicit_overlap);
  tcase_add_loop_test(steps, implicit_discs, 0, 2);
  tcase_add_loop_test(steps, masonry_at_rest, 0, 4);
  tcase_add_loop_test(steps, masonry_settles, 0, 2);
  tcase_add_test(steps, masonry_slides);
  tcase_add_loop_test(steps, memory_runs_out, 0, 2);
  suite_add_tcase(suite, steps);
}
