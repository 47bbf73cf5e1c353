/* Surfaces that prescribe how the material moves, in implicit steps: springs. */
#include "prescribed_surfaces.h"

static world_desc implicit_world(int32_t dim, int64_t cells, double h, int32_t quasi_static) {
  const method how = {METHOD(BSPLINE2, NEWMARK, FLIP, 1.0, "Newmark")};
  world_desc desc = world_with(&how, dim, cells, h);
  desc.stepper.quasi_static = quasi_static;
  desc.stepper.newton_tolerance_residual = 1e-11;
  return desc;
}

/* A bar with E = 1 under a small end force is off at its wall by that force over beta, whatever the cut; and
 * stays there in further steps, with all its particles. */
START_TEST(bar_is_off_by_traction_over_beta) {
  static const double cuts[] = {0.1, 0.5, 0.9, 0.999}, factors[] = {1e2, 1e4};
  const double cut = cuts[_i % 4], factor = factors[_i / 4 % 2];
  for (int32_t by_law = 0; by_law < 2; ++by_law)
    for (int32_t basis = MPM_LINEAR; basis <= MPM_BSPLINE2; ++basis) {
      world w;
      const double h = basis == MPM_LINEAR ? 1.0 : 0.5;
      world_desc desc = implicit_world(1, 12, h, 1);
      desc.grid.basis = basis;
      desc.law = (world_law){.model = "linear_elastic", .E = 1.0, .nu = 0.0, .density = 1.0};
      mpm_particles *set = world_open(&w, &desc);
      const double start = (3.0 - cut) * h, end = 8.0 * h, length = (end - start) / 16.0;
      double first = 0.0;
      for (int32_t i = 0; i < 16; ++i) {
        const double x = start + length * (i + 0.5);
        ck_ok(&w, mpm_particles_add(set, 1, &x, NULL, &length, NULL, NULL, NULL));
      }
      mpm_surface_desc d = prescribing(0), load = load_desc();
      d.penalty = factor;
      d.modulus = by_law ? 0.0 : 1.0;
      const double force = 1e-6, area[2] = {-1.0, 1.0};
      load.dead_traction[0] = force;
      mpm_surface *s = put_surface(&w, &d), *t = put_surface(&w, &load);
      ck_ok(&w, mpm_surface_add(s, 1, &start, &area[0], NULL));
      ck_ok(&w, mpm_surface_add(t, 1, &end, &area[1], NULL));
      for (int32_t step = 0; step < 3; ++step) {
        world_step(&w, 1.0);
        double *gap = markers(s, "gap", 1), *u = markers(s, "displacement", 1),
               *x = fetch(&w, set, "position", 1);
        const double off = force * h / factor;
        ck_within("gap", gap[0], off, 1e-9 * off + 1e-8 * force * force);
        if (step == 0) first = x[0];
        ck_within("particle", x[0], first, 1e-3 * off);
        ck_within("rests", u[0], 0.0, 0.0);
        ck_within("reaction", reaction_of(&w, s)[0], -force, 1e-11 * force);
        free(gap), free(u), free(x);
      }
      drop_surface(&w, s);
      drop_surface(&w, t);
      world_close(&w);
    }
}
END_TEST

/* What holds a block balances what loads it, dead or not, in all dimensions and geometries. */
START_TEST(reaction_balances_loads) {
  const int32_t dim = 1 + _i % 3, variant = _i / 3; /* plain, total Lagrangian, plane stress */
  if (variant == 2 && dim != 2) return;
  world w;
  world_desc desc = implicit_world(dim, CELLS, spacing, 1);
  desc.grid.total_lagrangian = variant == 1;
  if (variant == 2) desc.grid.geometry = MPM_PLANE_STRESS;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.9, 0.9, 0.9}, high[] = {2.1, 2.1, 2.1};
  world_fill(&w, set, low, high, 2);
  mpm_surface_desc d = prescribing(0), load = load_desc();
  load.dead_traction[0] = 500.0, load.dead_traction[1] = dim > 1 ? 300.0 : 0.0;
  mpm_surface *s = put_surface(&w, &d), *t = put_surface(&w, &load);
  const int32_t n = dim == 1 ? 1 : dim == 2 ? 10 : 100;
  for (int32_t i = 0; i < n; ++i) {
    double x[3] = {0.9, 0.96 + 0.12 * (i % 10), 0.96 + 0.12 * (i / 10)}, a[3] = {-1.44 / n, 0.0, 0.0};
    ck_ok(&w, mpm_surface_add(s, 1, x, a, NULL));
    x[0] = 2.1, a[0] = 1.44 / n;
    ck_ok(&w, mpm_surface_add(t, 1, x, a, NULL));
  }
  for (int32_t step = 0; step < 2; ++step) {
    const mpm_step_info info = world_step(&w, 1.0);
    const double *r = reaction_of(&w, s);
    show("%d-D, variant %d: %d iterations, solver %d, reaction %.15g %.15g\n", (int)dim, (int)variant,
         (int)info.newton_iterations, (int)info.linear_solver, r[0], r[1]);
    for (int32_t k = 0; k < dim; ++k) ck_within("balance", r[k], -1.44 * load.dead_traction[k], 1e-9 * 720.0);
    ck_assert_int_eq(info.linear_solver, MPM_SOLVER_LDLT); /* the matrix is symmetric */
    ck_assert_int_le(info.newton_iterations, 8);
  }
  drop_surface(&w, s);
  drop_surface(&w, t);
  world_close(&w);
}
END_TEST

/* A block falls onto nothing: it stands on a slip line, across which springs hold it, and every solver finds
 * the same. */
START_TEST(solvers_agree) {
  static const int32_t solvers[] = {MPM_SOLVER_LDLT, MPM_SOLVER_CG, MPM_SOLVER_MULTIGRID_CG,
                                    MPM_SOLVER_GMRES};
  double wanted = 0.0;
  for (int32_t k = 0; k < 4; ++k) {
    world w;
    world_desc desc = implicit_world(2, CELLS, spacing, 0);
    desc.stepper.linear_solver = solvers[k];
    desc.stepper.linear_tolerance = 1e-12;
    desc.stepper.gravity[1] = -9.81;
    mpm_particles *set = open_block_with(&w, &desc);
    mpm_surface_desc d = prescribing(1);
    mpm_surface *s = put_surface(&w, &d);
    for (int32_t i = 0; i < 10; ++i) {
      const double x[2] = {0.96 + 0.12 * i, 0.85}, a[2] = {0.0, -0.12};
      ck_ok(&w, mpm_surface_add(s, 1, x, a, NULL));
    }
    for (int32_t step = 0; step < 5; ++step) world_step(&w, 1e-2);
    const double y = fetch1(&w, set, "position", 2, 1, 0);
    if (!k) wanted = y;
    ck_within("position", y, wanted, 1e-9);
    drop_surface(&w, s);
    world_close(&w);
  }
}
END_TEST

/* On a periodic axis and beside a wall the matrix is that of the forces: few iterations. */
START_TEST(images_couple) {
  world w;
  world_desc desc = implicit_world(2, CELLS, spacing, 1);
  desc.grid.periodic[0] = 1;
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.0, 1.0}, high[] = {3.0, 2.0};
  world_fill(&w, set, low, high, 2);
  mpm_surface_desc d = prescribing(0), load = load_desc();
  load.dead_traction[0] = 900.0, load.dead_traction[1] = -400.0;
  mpm_surface *s = put_surface(&w, &d), *t = put_surface(&w, &load);
  for (int32_t i = 0; i < 24; ++i) {
    const double x[2] = {0.125 * i, 1.0}, y[2] = {0.125 * i, 2.0}, down[2] = {0.0, -0.125},
                 up[2] = {0.0, 0.125};
    ck_ok(&w, mpm_surface_add(s, 1, x, down, NULL));
    ck_ok(&w, mpm_surface_add(t, 1, y, up, NULL));
  }
  const mpm_step_info info = world_step(&w, 1.0);
  const double *r = reaction_of(&w, s);
  for (int32_t k = 0; k < 2; ++k) ck_within("balance", r[k], -3.0 * load.dead_traction[k], 1e-9 * 2700.0);
  ck_assert_int_le(info.newton_iterations, 7);
  drop_surface(&w, s);
  drop_surface(&w, t);
  world_close(&w);
}
END_TEST

/* What walls and a surface hold together they hold whole: their reactions balance the load, and with inertia
 * and gamma = 1 what the particles gain. */
START_TEST(beside_a_wall) {
  static const double betas[] = {0.5, 0.5625, 1.0};
  const int32_t dynamic = _i > 0;
  const double dt = dynamic ? 0.1 : 1.0;
  world w;
  world_desc desc = implicit_world(2, CELLS, spacing, !dynamic);
  if (dynamic) desc.stepper.newmark_gamma = 1.0, desc.stepper.newmark_beta = betas[_i - 1];
  mpm_particles *set = world_open(&w, &desc);
  const double low[] = {0.0, 1.0}, high[] = {1.0, 2.0};
  world_fill(&w, set, low, high, 2);
  ck_ok(&w, mpm_stepper_set_wall(w.stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0));
  mpm_surface_desc d = prescribing(0), load = load_desc();
  load.dead_traction[0] = 200.0, load.dead_traction[1] = -900.0;
  mpm_surface *s = put_surface(&w, &d), *t = put_surface(&w, &load);
  for (int32_t i = 0; i < 8; ++i) {
    const double x[2] = {0.0625 + 0.125 * i, 1.0}, y[2] = {0.0625 + 0.125 * i, 2.0}, down[2] = {0.0, -0.125},
                 up[2] = {0.0, 0.125};
    ck_ok(&w, mpm_surface_add(s, 1, x, down, NULL));
    ck_ok(&w, mpm_surface_add(t, 1, y, up, NULL));
  }
  for (int32_t step = 0; step < 2; ++step) {
    const mpm_step_info before = world_info(&w), after = world_step(&w, dt);
    double wall[3];
    ck_ok(&w, mpm_stepper_wall_reaction(w.stepper, MPM_X_MIN, wall));
    const double *r = reaction_of(&w, s);
    for (int32_t k = 0; k < 2; ++k) {
      const double gained = dynamic ? (after.momentum[k] - before.momentum[k]) / dt : 0.0;
      ck_within("balance", wall[k] + r[k] + load.dead_traction[k], gained, 1e-8 * 900.0);
      ck_holds(fabs(wall[k]) > 1.0 && fabs(r[k]) > 1.0);
    }
  }
  drop_surface(&w, s);
  drop_surface(&w, t);
  world_close(&w);
}
END_TEST

/* Particles without a wave speed tell no stiffness. */
static mpm_status no_stress(void *user, const mpm_material_batch *b) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i) {
    for (int32_t c = 0; c < 6; ++c) b->stress_new[c * b->ld + i] = 0.0;
    b->wave_speed[i] = 0.0;
  }
  return MPM_OK;
}
static mpm_status no_tangent(void *user, const mpm_material_batch *b, double *tangent, int32_t *symmetric) {
  (void)user;
  *symmetric = 1;
  for (int64_t i = 0; i < 36 * b->ld; ++i) tangent[i] = 0.0;
  return MPM_OK;
}

START_TEST(no_wave_speed) {
  world w;
  world_desc desc = implicit_world(2, CELLS, spacing, 0);
  desc.law = (world_law){.stress = no_stress, .tangent = no_tangent, .density = 1000.0};
  open_block_with(&w, &desc);
  mpm_surface_desc d = prescribing(0);
  mpm_surface *s = put_surface(&w, &d);
  add_circle(&w, s, 0.5, 0.1);
  mpm_step_info info = {.struct_size = sizeof info};
  ck_refused(&w, mpm_step(w.stepper, 1e-3, &info), MPM_SINGULAR, "set mpm_surface_desc.modulus");
  d.modulus = 1e5;
  ck_ok(&w, mpm_surface_configure(s, &d));
  ck_ok(&w, mpm_step(w.stepper, 1e-3, &info));
  drop_surface(&w, s);
  world_close(&w);
}
END_TEST

void add_prescribed_implicit(Suite *suite) {
  TCase *implicit = tcase_create("implicit");
  tcase_add_loop_test(implicit, bar_is_off_by_traction_over_beta, 0, 8);
  tcase_add_loop_test(implicit, reaction_balances_loads, 0, 9);
  tcase_add_test(implicit, solvers_agree);
  tcase_add_test(implicit, images_couple);
  tcase_add_loop_test(implicit, beside_a_wall, 0, 4);
  tcase_add_test(implicit, no_wave_speed);
  tcase_set_timeout(implicit, 60);
  suite_add_tcase(suite, implicit);
}
