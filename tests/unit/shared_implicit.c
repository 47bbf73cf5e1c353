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

/* Some particles of a set are led; those that are held in every direction keep still. */
static mpm_status lead_some(mpm_particles *set, int32_t dim) {
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

/* Which options a scene has: bits of `speed`, which is no velocity here. */
enum { LEADS = 1, HOLDS = 2, PULLS = 4, MOVES = 8 };

static mpm_status set_up_implicit(world *w, const scene *is) {
  const int32_t options = (int32_t)is->speed;
  const double low = is->desc.stepper.quasi_static ? 0.0 : 0.15;
  mpm_status status = set_walls(w);
  if (!status) status = fill_middle(w, w->set[0], low, 0.5);
  if (!status && w->sets > 1) status = fill_middle(w, w->set[1], 0.5, 0.62);
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
  for (int32_t i = 0; i < MOST_STEPS && !status; ++i)
    status = mpm_step(w->stepper, (0.3 + 0.1 * (i % 2)) * is->desc.grid.spacing[0], &w->info);
  return status;
}

/* Blocks are 64, 16 and 6 nodes wide. */
static const int32_t cells_of[] = {0, 260, 44, 13};

static scene implicit_scene(int32_t dim, const basis_option *basis, int32_t quasi_static) {
  scene is = scene_of(dim, cells_of[dim] * (dim < 3 && !quasi_static ? 2 : 1), set_up_implicit);
  use_basis(basis, &is.desc.grid);
  is.desc.stepper.scheme = MPM_NEWMARK;
  is.desc.stepper.quasi_static = quasi_static;
  is.desc.stepper.linear_solver = MPM_SOLVER_CG;
  is.desc.stepper.gravity[dim - 1] = -2.0;
  is.run = run_implicit;
  is.speed = quasi_static ? 0 : MOVES;
  return is;
}

static void check_made(const scene *is, const char *name, int32_t parts) {
  const mpm_status status = check_scene(is, name, parts);
  ck_assert_msg(status == MPM_OK, "%s: %s", name, mpm_status_name(status));
}

START_TEST(table) {
  if (getenv("ONE") && atoi(getenv("ONE")) != _i) return;
  const int32_t dim = 1 + _i % 3, b = _i / 3 % IMPLICIT_BASES, quasi_static = _i / (3 * IMPLICIT_BASES);
  const basis_option *basis = implicit_basis(b);
  scene is = implicit_scene(dim, basis, quasi_static);
  char name[200];
  is.desc.law = law_of((_i + quasi_static) % LAWS_HERE);
  if (basis->basis == MPM_CPGIMP && keeps_volume_alone(is.desc.law.model)) is.desc.law = law_of(0);
  is.desc.grid.periodic[0] = dim > 1 && _i % 4 == 1;
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
  if (getenv("ONE")) return;
  static const int32_t bases[] = {0, 2, 3};
  scene is = implicit_scene(2 + _i % 2, implicit_basis(bases[_i / 2 % 3]), _i / 6);
  is.desc.stepper.locking_remedy = MPM_LOCKING_CELL_AVERAGE;
  is.desc.law = law_of(2);
  is.desc.grid.periodic[0] = _i % 4 == 2;
  check_made(&is, "remedy", 2 + _i % 4);
}
END_TEST

void add_shared_implicit(Suite *suite) {
  TCase *all = tcase_create("implicit");
  tcase_set_timeout(all, 240);
  tcase_add_loop_test(all, table, 0, TABLE);
  tcase_add_loop_test(all, remedy, 0, 12);
  suite_add_tcase(suite, all);
}
