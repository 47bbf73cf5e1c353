/* Implicit steps in several parts: by the library's own conjugate gradients, with the bits of one part. */
#include "implicit.h"
#include "shared.h"

enum { TABLE = 3 * IMPLICIT_BASES * 2, LAWS_HERE = 4, MOST_STEPS = 4 };

static const mpm_param associated[] = {{"density", 1e3}, {"E", 1e5},    {"nu", 0.3},
                                       {"phi", 20.0},    {"psi", 20.0}, {"cohesion", 1e3}};

/* Laws whose matrix is symmetric; with the remedy that is so where pressure is averaged as well. */
static world_law law_of(int32_t i) {
  static const char *const model[LAWS_HERE] = {"neo_hookean", "herschel_bulkley", "drucker_prager",
                                               "neo_hookean_decoupled"};
  world_law law = {.model = model[i], .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 1e3};
  if (i == 2) law.params = associated, law.param_count = 6;
  return law;
}

/* Those that are held in every direction keep still. */
mpm_status lead_some(mpm_particles *set, int32_t dim) {
  const int64_t n = mpm_particles_count(set);
  int64_t *id = calloc((size_t)n + 1, sizeof *id);
  uint8_t *flags = calloc((size_t)(n * dim) + 1, 1);
  mpm_status status = mpm_particles_get(set, "id", MPM_I64, 1, n, NULL, id);
  for (int64_t p = 0; p < n; ++p) flags[p] = id[p] % 11 == 0;
  if (!status) status = mpm_particles_set(set, "prescribed", MPM_U8, dim, n, NULL, flags);
  free(id), free(flags);
  return status;
}

static mpm_status lead(void *user, const mpm_particle_batch *batch, double *velocity) {
  (void)user;
  for (int64_t p = 0; p < batch->n; ++p) velocity[p] = 0.05 + 0.01 * batch->t;
  return MPM_OK;
}

static mpm_status hold_corner(void *user, const mpm_node_batch *batch, uint8_t *held, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < batch->n; ++i) {
    held[i] = batch->position[i] > 0.42 && batch->position[i] < 0.47;
    velocity[i] = 0.02;
  }
  return MPM_OK;
}

static mpm_status pull(void *user, const mpm_particle_batch *batch, double *force) {
  (void)user;
  for (int64_t p = 0; p < batch->n; ++p) force[p] = batch->position[p] > 0.3 ? 0.5 * batch->mass[p] : 0.0;
  return MPM_OK;
}

/* A set beside the first, which it would not fall off. */
static mpm_status fill_beside(mpm_particles *set, double low) {
  const double from[] = {0.5, low, low}, to[] = {0.62, 0.5, 0.5};
  const int32_t per_cell[] = {2, 2, 2};
  return mpm_particles_fill_box(set, from, to, per_cell, NULL, NULL);
}

/* Without inertia cells that are half full on three sides take conjugate gradients thousands of
 * iterations. */
static const double whole_cells = 6.0 / 13.0;

static mpm_status set_up_implicit(world *w, const scene *is) {
  const int32_t options = (int32_t)is->speed;
  const double low = is->desc.stepper.quasi_static ? 0.0 : 0.15;
  mpm_status status = set_walls(w);
  const double high = is->desc.stepper.quasi_static && w->dim == 3 ? whole_cells : 0.5;
  if (!status) status = fill_middle(w, w->set[0], low, high);
  if (!status && w->sets > 1) status = fill_beside(w->set[1], low);
  for (int32_t m = 0; m < w->sets && !status && (options & MOVES); ++m)
    status = set_velocities(w, w->set[m], 0.5);
  if (!status && (options & LEADS)) status = lead_some(w->set[0], w->dim);
  if (!status && (options & LEADS)) status = mpm_stepper_set_motion(w->stepper, w->set[0], lead, NULL);
  if (!status && (options & HOLDS)) status = mpm_stepper_set_velocity_bc(w->stepper, hold_corner, NULL);
  if (!status && (options & PULLS)) status = mpm_stepper_set_force(w->stepper, pull, NULL);
  return status;
}

static mpm_status run_implicit(world *w, const scene *is, outcome *found) {
  mpm_status status = MPM_OK;
  (void)found;
  for (int32_t i = 0; i < (w->dim < 3 ? MOST_STEPS : MOST_STEPS / 2) && !status; ++i)
    status = mpm_step(w->stepper, (0.3 + 0.1 * (i % 2)) * is->desc.grid.spacing[0], &w->info);
  return status;
}

/* Blocks are 64, 16 and 6 nodes wide. */
static const int32_t cells_of[] = {0, 260, 44, 13};

scene implicit_scene(int32_t dim, const basis_option *basis, int32_t quasi_static) {
  scene is = scene_of(dim, cells_of[dim] * (dim < 3 && !quasi_static ? 2 : 1), set_up_implicit);
  use_basis(basis, &is.desc.grid);
  is.desc.stepper.scheme = MPM_NEWMARK;
  is.desc.stepper.quasi_static = quasi_static;
  is.desc.stepper.linear_solver = MPM_SOLVER_CG;
  is.desc.stepper.gravity[dim - 1] = -2.0;
  is.desc.stepper.linear_tolerance = 1e-6;
  is.run = run_implicit;
  is.speed = quasi_static ? 0 : MOVES;
  return is;
}

START_TEST(table) {
  const int32_t dim = 1 + _i % 3, b = _i / 3 % IMPLICIT_BASES, quasi_static = _i / (3 * IMPLICIT_BASES);
  const basis_option *basis = implicit_basis(b);
  scene is = implicit_scene(dim, basis, quasi_static);
  char name[200];
  is.desc.law = law_of((_i + quasi_static) % LAWS_HERE);
  if (basis->basis == MPM_CPGIMP && keeps_volume_alone(is.desc.law.model)) is.desc.law = law_of(0);
  is.desc.grid.periodic[0] = dim > 1 && _i % 4 == 1;
  is.desc.context.concurrency = 1 + (_i / 2) % 2; /* threads of each part */
  is.speed += _i % 8;
  is.desc.stepper.mass_damping = _i % 5 == 2 && !quasi_static ? 3.0 : 0.0;
  if (_i / 2 % 3 == 0) is.desc.sets = 2, is.desc.other_law = law_of((_i + 1) % 3);
  if (basis->basis == MPM_CPGIMP) is.desc.other_law = law_of(3);
  snprintf(name, sizeof name, "%d: %d-D %s %s %s, options %d", _i, dim, basis->name, is.desc.law.model,
           quasi_static ? "quasi-static" : "Newmark", (int)is.speed);
  check_made(&is, name, 2 + _i % 4);
}
END_TEST

/* With the remedy against locking, where the matrix is symmetric. */
START_TEST(remedy) {
  static const int32_t bases[] = {0, 2, 3};
  scene is = implicit_scene(2 + _i % 2, implicit_basis(bases[_i / 2 % 3]), _i / 6);
  is.desc.stepper.locking_remedy = MPM_LOCKING_CELL_AVERAGE;
  is.desc.law = law_of(2);
  is.desc.grid.periodic[0] = _i % 4 == 2;
  check_made(&is, "remedy", 2 + _i % 4);
}
END_TEST

/* ---- what may go wrong --------------------------------------------------------------------------------- */
mpm_status fail_implicitly(world *w, const scene *is, outcome *found) {
  const double h = is->desc.grid.spacing[0];
  mpm_status status = mpm_step(w->stepper, 0.3 * h, &w->info);
  if (status) return status;
  status = mpm_step(w->stepper, 1e3 * h, &w->info);
  if (!status || w->info.cause != status) return MPM_E_INTERNAL;
  found->failed = w->info;
  for (int32_t i = 0; i < 2 && (!i || !status); ++i) status = mpm_step(w->stepper, 0.2 * h, &w->info);
  return status;
}

START_TEST(steps_fail) {
  scene is = implicit_scene(2, implicit_basis(_i % 4), 0);
  is.run = fail_implicitly;
  is.speed = MOVES | (_i % 2 ? LEADS : 0);
  if (_i % 3 == 1) is.desc.stepper.newton_max_iterations = 6;
  if (_i % 3 == 2) is.desc.stepper.linear_max_iterations = 40;
  check_made(&is, "failure", 2 + _i % 4);
}
END_TEST

/* Sub-steps that are cut and grow. */
static mpm_status advance(world *w, const scene *is, outcome *found) {
  mpm_advance_desc d = advance_desc(3.0 * is->desc.grid.spacing[0]);
  (void)found;
  d.dt_first = 2.0 * is->desc.grid.spacing[0];
  return mpm_advance(w->stepper, &d, &w->info);
}

START_TEST(advances) {
  scene is = implicit_scene(2, implicit_basis(2 * _i % 4), 0);
  is.run = advance;
  is.desc.stepper.newton_max_iterations = 5;
  is.desc.stepper.linear_solver = MPM_SOLVER_CG;
  check_made(&is, "advance", 3 + _i);
}
END_TEST

/* Only some parts have a progress callback, and one of them wants to stop. */
static mpm_status stop(void *user, const mpm_step_info *info) {
  (void)info;
  int32_t *left = user;
  return --*left < 0 ? 1 : MPM_OK;
}

static mpm_status stop_and_go_on(world *w, const scene *is, outcome *found) {
  const double dt = 0.3 * is->desc.grid.spacing[0];
  int32_t part = 0, parts = 1, left = 2;
  (void)found;
  mpm_context_part(w->context, &part, &parts);
  mpm_status status = mpm_step(w->stepper, dt, &w->info);
  if (!status && part == parts / 2) status = mpm_stepper_set_progress(w->stepper, stop, &left);
  if (status) return status;
  if (mpm_step(w->stepper, dt, &w->info) != MPM_CANCELLED || w->info.callback_status != 1)
    return MPM_E_INTERNAL;
  status = mpm_stepper_set_progress(w->stepper, NULL, NULL);
  return status ? status : mpm_step(w->stepper, dt, &w->info);
}

START_TEST(hosts_stop) {
  scene is = implicit_scene(2, implicit_basis(1), 0);
  is.run = stop_and_go_on;
  check_made(&is, "stop", 3);
}
END_TEST

/* What several parts do not have says what they have. */
static mpm_status ask_in_vain(world *w, const scene *is, outcome *found) {
  const mpm_status status = mpm_step(w->stepper, 0.3 * is->desc.grid.spacing[0], &w->info);
  (void)found;
  if (status == MPM_E_UNSUPPORTED &&
      strstr(mpm_last_error(w->context), "use MPM_SOLVER_CG, MPM_SOLVER_GMRES or MPM_SOLVER_HOST"))
    return MPM_OK;
  return MPM_E_INTERNAL;
}

START_TEST(refused) {
  static const int32_t solvers[] = {MPM_SOLVER_MULTIGRID_CG, MPM_SOLVER_LDLT};
  scene is = implicit_scene(2, implicit_basis(1), 0);
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  is.run = ask_in_vain;
  is.desc.stepper.linear_solver = solvers[_i];
  ck_assert_int_eq(parts_run(2, live, &is, &plan), 0);
  for (int32_t r = 0; r < 2; ++r)
    ck_assert_msg(is.found[r].status == MPM_OK, "solver %d, part %d: %s", (int)solvers[_i], r,
                  is.found[r].text);
}
END_TEST

START_TEST(transport_fails) {
  const scene is = implicit_scene(2, implicit_basis(1), 0);
  check_lost_transport(&is, 4, 500);
}
END_TEST

void add_shared_implicit(Suite *suite) {
  TCase *all = tcase_create("implicit");
  tcase_set_timeout(all, 240);
  TCase *wide = wide_case(suite, "more implicit");
  add_table(all, wide, table, TABLE);
  add_table(all, wide, remedy, 12);
  suite_add_tcase(suite, all);
  TCase *failures = tcase_create("implicit failures");
  tcase_set_timeout(failures, 240);
  tcase_add_loop_test(failures, steps_fail, 0, 12);
  tcase_add_loop_test(failures, advances, 0, 3);
  tcase_add_test(failures, hosts_stop);
  tcase_add_loop_test(failures, refused, 0, 2);
  suite_add_tcase(suite, failures);
  tcase_add_test(faults_case(suite, "faults of implicit", 0), transport_fails);
}
