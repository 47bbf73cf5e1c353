/* Implicit steps of several parts, beside those of shared_options. Linear systems that are not symmetric:
 * GMRES has the bits of one part with a transport; and what an executor that fails within a solver leaves to
 * the other parts. Surfaces, heat and total Lagrangian grids (shared_steps.c). */
#include "implicit.h"
#include "shared.h"

enum { TABLE = 3 * IMPLICIT_BASES * 2, LAWS_HERE = 5 };

static const mpm_param rubble[] = {{"density", 1e3}, {"E", 1e5},   {"nu", 0.3},
                                   {"phi", 30.0},    {"psi", 5.0}, {"cohesion", 1e3}};

/* Laws whose matrix is not symmetric, and one whose matrix is. */
static world_law law_of(int32_t i) {
  static const char *const model[LAWS_HERE] = {"j2", "linear_elastic", "drucker_prager", "neo_hookean",
                                               "mohr_coulomb"};
  world_law law = {.model = model[i], .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 1e3};
  if (i == 2 || i == 4) law.params = rubble, law.param_count = 6;
  return law;
}

scene gmres_scene(int32_t dim, const basis_option *basis, int32_t quasi_static) {
  /* equilibria on open cubic splines in 3-D are too hard for diagonal blocks: the linear basis stands in */
  const int32_t hard = dim == 3 && quasi_static && strstr(basis->name, "open cubic") != NULL;
  scene is = implicit_scene(dim, hard ? implicit_basis(0) : basis, quasi_static);
  for (int32_t k = 0; k < dim && dim == 2 && !quasi_static; ++k) {
    is.desc.grid.cells[k] = 56;
    is.desc.grid.spacing[k] = 1.0 / 56.0;
  }
  is.desc.stepper.linear_solver = MPM_SOLVER_GMRES;
  return is;
}

START_TEST(table) {
  const int32_t dim = 1 + (_i + 1) % 3, b = _i / 3 % IMPLICIT_BASES, quasi_static = _i / (3 * IMPLICIT_BASES);
  const basis_option *basis = implicit_basis(b);
  scene is = gmres_scene(dim, basis, quasi_static);
  char name[200];
  is.desc.law = law_of((_i + quasi_static) % LAWS_HERE);
  if (dim == 1 && quasi_static) is.desc.law = law_of(_i % 2); /* one that carries the weight of the bar */
  is.desc.grid.periodic[0] = dim > 1 && _i % 4 == 1;
  is.desc.context.concurrency = 1 + (_i / 2) % 2;
  is.speed += _i % 8;
  if (_i / 2 % 3 == 0 && dim < 3) is.desc.sets = 2, is.desc.other_law = law_of((_i + 1) % LAWS_HERE);
  snprintf(name, sizeof name, "%d: %d-D %s %s %s, options %d", _i, dim, basis->name, is.desc.law.model,
           quasi_static ? "quasi-static" : "Newmark", (int)is.speed);
  check_made(&is, name, 2 + _i % 4);
}
END_TEST

/* The remedy against locking where laws keep their own pressure. */
START_TEST(remedy) {
  static const int32_t bases[] = {0, 2, 3};
  scene is = gmres_scene(2 + _i % 2, implicit_basis(bases[_i / 2 % 3]), _i / 6);
  is.desc.stepper.locking_remedy = MPM_LOCKING_CELL_AVERAGE;
  is.desc.law = law_of((_i + 2) % LAWS_HERE);
  is.desc.grid.periodic[0] = _i % 4 == 2;
  check_made(&is, "remedy", 2 + _i % 4);
}
END_TEST

/* More unknowns, of which GMRES takes several cycles. */
START_TEST(large) {
  scene is = implicit_scene(2, implicit_basis(1 + _i), 1);
  is.desc.law = law_of(_i);
  is.desc.grid.cells[0] = is.desc.grid.cells[1] = 96;
  is.desc.grid.spacing[0] = is.desc.grid.spacing[1] = 1.0 / 96.0;
  is.desc.stepper.linear_solver = MPM_SOLVER_GMRES;
  is.desc.stepper.linear_tolerance = 1e-9;
  check_made(&is, "large", 2 + _i);
}
END_TEST

/* A long body that one end holds, under a pressure that follows it: diagonal blocks lead nowhere, and
 * conjugate gradients precondition in their place. */
static mpm_status set_up_long(world *w, const scene *is) {
  const double h = is->desc.grid.spacing[0], low[] = {0.0, 4.0 * h}, high[] = {35.0 * h, 8.0 * h};
  const int32_t per_cell[] = {2, 2};
  const mpm_status status = mpm_particles_fill_box(w->set[0], low, high, per_cell, NULL, NULL);
  return status ? status : mpm_stepper_set_wall(w->stepper, MPM_X_MIN, MPM_WALL_FIXED, 0.0);
}

static mpm_status bend(world *w, const scene *is, outcome *found) {
  const double h = is->desc.grid.spacing[0], ends[] = {34.0 * h, 12.0 * h, 8.0 * h, 8.0 * h};
  mpm_surface_desc d;
  mpm_surface *s = NULL;
  mpm_status status = mpm_surface_desc_init(&d, sizeof d);
  d.pressure = 1.0;
  if (!status) status = mpm_surface_create(w->context, w->grid, &d, &s);
  if (!status) status = mpm_surface_add_polyline(s, 2, ends, 0, 0.5 * h, NULL, NULL);
  if (!status) status = mpm_stepper_add_surface(w->stepper, s);
  if (!status) status = mpm_step(w->stepper, 0.05, &w->info);
  found->seen[0] = (double)w->info.linear_iterations;
  if (s) drop_loads(w, s);
  return status || found->seen[0] > 600.0 ? status : MPM_E_INTERNAL; /* blocks alone would stop far before */
}

static scene long_scene(void) {
  scene is = implicit_scene(2, implicit_basis(1), 1);
  is.desc.grid.cells[0] = 40;
  is.desc.grid.cells[1] = 16;
  is.desc.grid.spacing[0] = is.desc.grid.spacing[1] = 1.0 / 40.0;
  is.desc.law = law_of(3);
  is.desc.stepper.linear_solver = MPM_SOLVER_GMRES;
  is.desc.stepper.linear_tolerance = 1e-8;
  is.desc.stepper.gravity[1] = 0.0;
  is.speed = 0.0;
  is.set_up = set_up_long;
  is.run = bend;
  return is;
}

START_TEST(long_body) {
  const scene is = long_scene();
  check_made(&is, "long body", 2 + _i);
}
END_TEST

START_TEST(long_body_loses_transport) {
  const scene is = long_scene();
  check_lost_transport(&is, 2, 500);
}
END_TEST

/* What the library chooses: conjugate gradients where the matrix is symmetric, else GMRES. */
static mpm_status choose(world *w, const scene *is, outcome *found) {
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < 3 && !status; ++i)
    status = mpm_step(w->stepper, 0.3 * is->desc.grid.spacing[0], &w->info);
  found->seen[0] = w->info.linear_solver;
  return w->info.linear_solver == (int32_t)is->seed || status ? status : MPM_E_INTERNAL;
}

START_TEST(chosen) {
  scene is = gmres_scene(2, implicit_basis(_i), 0);
  is.run = choose;
  is.desc.law = law_of(_i % 2 ? 0 : 3);
  is.desc.stepper.linear_solver = MPM_SOLVER_AUTO;
  is.seed = _i % 2 ? MPM_SOLVER_GMRES : MPM_SOLVER_CG;
  check_made(&is, "chosen", 2 + _i);
}
END_TEST

/* ---- what may go wrong --------------------------------------------------------------------------------- */
START_TEST(steps_fail) {
  scene is = gmres_scene(2, implicit_basis(_i % 4), 0);
  is.run = fail_implicitly;
  is.speed = MOVES | (_i % 2 ? LEADS : 0);
  is.desc.law = law_of(_i % LAWS_HERE);
  if (_i % 2) is.desc.stepper.linear_max_iterations = 40;
  check_made(&is, "failure", 2 + _i % 4);
}
END_TEST

/* Conjugate gradients have a matrix that is none of theirs, and say what to use. */
static mpm_status ask_in_vain(world *w, const scene *is, outcome *found) {
  const mpm_status status = mpm_step(w->stepper, 0.3 * is->desc.grid.spacing[0], &w->info);
  (void)found;
  if (status != MPM_E_UNSUPPORTED ||
      !strstr(mpm_last_error(w->context), "use MPM_SOLVER_GMRES or MPM_SOLVER_AUTO"))
    return MPM_E_INTERNAL;
  mpm_stepper_desc desc = is->desc.stepper;
  desc.linear_solver = MPM_SOLVER_GMRES;
  const mpm_status changed = mpm_stepper_configure(w->stepper, &desc);
  return changed ? changed : mpm_step(w->stepper, 0.3 * is->desc.grid.spacing[0], &w->info);
}

START_TEST(symmetric_only) {
  scene is = gmres_scene(2, implicit_basis(1), 0);
  is.run = ask_in_vain;
  is.desc.law = law_of(0);
  is.desc.stepper.linear_solver = MPM_SOLVER_CG;
  check_made(&is, "not symmetric", 3);
}
END_TEST

START_TEST(transport_fails) {
  scene is = gmres_scene(2, implicit_basis(1), 0);
  is.desc.law = law_of(0);
  check_lost_transport(&is, 4, 500);
}
END_TEST

/* ---- the host's executor ---------- */
/* It fails once, on one part. */
typedef struct unsteady {
  scene is;
  int64_t fail_at, runs; /* of part 1: the run of the executor that fails, from 1; how many there were */
  int64_t left;
  int32_t failed[3]; /* how many steps of each part */
} unsteady;

static mpm_status run_or_fail(void *user, int64_t count, mpm_task_fn task, void *data) {
  unsteady *u = user;
  ++u->runs;
  const int32_t fails = --u->left == 0;
  for (int64_t i = 0; i < (fails ? count / 2 : count); ++i) task(data, i);
  return fails ? 5 : 0;
}

static void live_unsteady(int32_t part, const mpm_transport *transport, void *user) {
  unsteady *u = user;
  outcome *found = &u->is.found[part];
  world w;
  memset(&w, 0, sizeof w);
  w.desc = u->is.desc;
  w.desc.context.transport = transport;
  w.desc.context.concurrency = 2;
  if (part == 1) w.desc.context.parallel_for = run_or_fail, w.desc.context.parallel_user = u;
  mpm_status status = world_try_open(&w);
  if (!status) status = u->is.set_up(&w, &u->is);
  if (part == 1) u->runs = 0, u->left = u->fail_at;
  for (int32_t i = 0; i < 2 && !status; ++i) {
    mpm_step_info info = {.struct_size = sizeof info};
    const double dt = 0.3 * u->is.desc.grid.spacing[0];
    status = mpm_step(w.stepper, dt, &info);
    if (status != MPM_E_CALLBACK) continue;
    ++u->failed[part];
    if (info.cause != status || !strstr(mpm_last_error(w.context), "parallel_for returned 5")) break;
    status = mpm_step(w.stepper, dt, &info);
  }
  if (!status) status = mpm_state_hash(w.stepper, &found->hash);
  if (status) snprintf(found->text, sizeof found->text, "%s", mpm_last_error(w.context));
  found->status = status;
  world_try_close(&w);
}

/* Wherever it fails, no part waits for the others for ever, all of them give the step up, and the step goes
 * through when it is made again. */
START_TEST(executor_fails) {
  static unsteady u;
  int64_t runs = 0;
  uint64_t hash = 0;
  int32_t failures = 0;
  for (int64_t at = 0; !at || at <= runs; at += 1 + at / 3) {
    parts_plan plan;
    memset(&plan, 0, sizeof plan);
    memset(&u, 0, sizeof u);
    u.is = implicit_scene(2, implicit_basis(1), 0);
    u.is.desc.law = law_of(_i ? 0 : 3);
    u.is.desc.stepper.linear_solver = _i ? MPM_SOLVER_GMRES : MPM_SOLVER_CG;
    for (int32_t k = 0; k < 2; ++k) {
      u.is.desc.grid.cells[k] = 110; /* parts have more than 2000 unknowns, below which executors rest */
      u.is.desc.grid.spacing[k] = 1.0 / 110.0;
    }
    u.is.speed = MOVES | HOLDS;
    u.fail_at = at;
    ck_assert_msg(!parts_run(3, live_unsteady, &u, &plan), "run %lld of %lld: %s", (long long)at,
                  (long long)runs, plan.text);
    if (!at) runs = u.runs, hash = u.is.found[0].hash;
    failures += u.failed[1];
    for (int32_t r = 0; r < 3; ++r) {
      ck_assert_msg(!u.is.found[r].status && u.failed[r] == u.failed[1], "run %lld of %lld, part %d: %s",
                    (long long)at, (long long)runs, r, u.is.found[r].text);
      ck_assert_msg(u.is.found[r].hash == hash, "run %lld, part %d: another state", (long long)at, r);
    }
  }
  ck_assert_int_gt(runs, 300); /* most of them within the solver */
  ck_assert_int_gt(failures, 10);
}
END_TEST

Suite *shared_solvers_suite(void) {
  Suite *suite = suite_create("shared_solvers");
  TCase *all = tcase_create("solvers");
  tcase_set_timeout(all, 240);
  TCase *wide = wide_case(suite, "more solvers");
  add_every(all, wide, table, TABLE, 11);
  add_every(all, wide, remedy, 12, 7);
  tcase_add_loop_test(wide, large, 0, 3);
  tcase_add_loop_test(all, chosen, 0, 4);
  tcase_add_loop_test(wide, long_body, 0, 4);
  suite_add_tcase(suite, all);
  TCase *failures = tcase_create("failures");
  tcase_set_timeout(failures, 240);
  add_table(failures, wide, steps_fail, 7);
  tcase_add_test(failures, symmetric_only);
  tcase_add_test(wide, long_body_loses_transport);
  add_table(failures, wide, executor_fails, 2);
  suite_add_tcase(suite, failures);
  tcase_add_test(faults_case(suite, "faults", 0), transport_fails);
  add_shared_steps(suite);
  return suite;
}
