/* Implicit steps in several parts: surfaces, heat, total Lagrangian grids, and steppers that turn to such
 * steps. */
#include "implicit.h"
#include "shared.h"

enum { TABLE = 3 * IMPLICIT_BASES * 2, LAWS_HERE = 3 };

static world_law law_of(int32_t i) {
  static const char *const model[LAWS_HERE] = {"neo_hookean", "neo_hookean_decoupled", "j2"};
  return (world_law){.model = model[i], .E = 1e5, .nu = 0.3, .density = 1e3, .yield_stress = 1e3};
}

/* ---- surfaces ------------------------------------------------------------------------------------------ */
/* Two surfaces, the second of which comes later, and the first goes. */
static mpm_status load(world *w, const scene *is, outcome *found) {
  mpm_surface *s[2] = {NULL, NULL};
  mpm_status status = add_loads(w, 0.3, 0.12, &s[0]);
  for (int32_t i = 0; i < (w->dim < 3 ? 5 : 3) && !status; ++i) {
    if (i == 1) status = add_loads(w, 0.34, 0.1, &s[1]);
    if (i == 2 && !(status = mix_markers(w, s[0], &found->markers))) {
      status = drop_loads(w, s[0]);
      s[0] = NULL;
    }
    if (!status) status = mpm_step(w->stepper, (0.3 + 0.1 * (i % 2)) * is->desc.grid.spacing[0], &w->info);
  }
  if (!status) status = mix_markers(w, s[1], &found->markers);
  for (int32_t i = 0; i < 2; ++i)
    if (s[i]) drop_loads(w, s[i]);
  return status;
}

static scene loaded_scene(int32_t i, char *name, size_t size) {
  const int32_t dim = 1 + (i + 1) % 3, b = i / 3 % IMPLICIT_BASES, quasi_static = i / (3 * IMPLICIT_BASES);
  const basis_option *basis = implicit_basis(b);
  scene is = gmres_scene(dim, basis, quasi_static);
  is.desc.law = law_of(i % LAWS_HERE);
  if (basis->basis == MPM_CPGIMP && keeps_volume_alone(is.desc.law.model)) is.desc.law = law_of(0);
  is.desc.grid.periodic[0] = dim > 1 && i % 4 == 1;
  is.desc.context.concurrency = 1 + (i / 2) % 2;
  is.speed += i % 8;
  is.run = load;
  snprintf(name, size, "%d: %d-D %s %s %s, options %d", i, dim, basis->name, is.desc.law.model,
           quasi_static ? "quasi-static" : "Newmark", (int)is.speed);
  return is;
}

START_TEST(loads) {
  char name[200];
  const scene is = loaded_scene(_i, name, sizeof name);
  check_made(&is, name, 2 + _i % 4);
}
END_TEST

/* A surface over a period that is no multiple of a block, and with the remedy against locking. */
START_TEST(loads_beside) {
  char name[200];
  scene is = loaded_scene(3 * _i, name, sizeof name);
  is.desc.grid.cells[0] = 51;
  is.desc.grid.periodic[0] = 1;
  is.desc.stepper.locking_remedy = _i % 2;
  is.desc.grid.total_lagrangian = _i % 3 == 2;
  is.desc.law = law_of(0);
  check_made(&is, "beside", 2 + _i % 4);
}
END_TEST

/* One surface holds, along its normal alone or in all directions, and another one loads. */
static mpm_status hold(world *w, const scene *is, outcome *found) {
  mpm_surface *s[2] = {NULL, NULL};
  const double middle = is->desc.stepper.quasi_static ? 0.13 : 0.3; /* there at walls */
  mpm_status status =
      add_holder(w, middle, 0.12, is->heard ? MPM_PRESCRIBES_NORMAL : MPM_PRESCRIBES_VELOCITY, &s[0]);
  for (int32_t i = 0; i < (w->dim < 3 ? 4 : 2) && !status; ++i) {
    if (i == 1 && is->seed % 2) status = add_loads(w, 0.34, 0.08, &s[1]);
    if (!status) status = mpm_step(w->stepper, (0.3 + 0.1 * (i % 2)) * is->desc.grid.spacing[0], &w->info);
  }
  if (!status) status = mpm_stepper_surface_reaction(w->stepper, s[0], found->seen);
  if (!status) status = mpm_stepper_surface_impulse(w->stepper, s[0], found->seen + 3);
  for (int32_t i = 0; i < 2; ++i) {
    if (s[i] && !status) status = mix_markers(w, s[i], &found->markers);
    if (s[i]) drop_loads(w, s[i]);
  }
  return status;
}

START_TEST(holds) {
  char name[200];
  scene is = loaded_scene(_i, name, sizeof name);
  is.run = hold;
  is.heard = _i / 3 % 2;
  is.seed = (uint64_t)_i;
  if (is.desc.grid.dim == 3)
    is.desc.stepper.linear_tolerance = 1e-4; /* springs are hard for diagonal blocks */
  if (_i % 4 == 3) is.desc.grid.total_lagrangian = 1;
  if (_i % 2 && strcmp(is.desc.law.model, "j2")) is.desc.law = law_of(0);
  check_made(&is, name, 2 + _i % 4);
}
END_TEST

/* Rigid particles carry no load in equilibrium: the same marker is named, however many parts there are. */
static mpm_status load_rigid(world *w, const scene *is, outcome *found) {
  mpm_surface *s = NULL;
  mpm_status status = add_loads(w, 0.3, 0.12, &s);
  if (!status) status = mpm_step(w->stepper, 0.3 * is->desc.grid.spacing[0], &w->info);
  found->failed = w->info;
  const char *text = mpm_last_error(w->context), *at = strstr(text, "marker 0 of surface 0 loads rigid");
  drop_loads(w, s);
  return status == MPM_SINGULAR && at ? MPM_OK : MPM_E_INTERNAL;
}

START_TEST(loads_rigid) {
  scene is = gmres_scene(2, implicit_basis(_i), 1);
  is.desc.law = (world_law){.model = "rigid", .density = 1e3};
  is.desc.stepper.gravity[1] = 0.0;
  is.run = load_rigid;
  check_made(&is, "rigid", 2 + _i);
}
END_TEST

/* All parts fail as one does, and go on from the state before. */
static mpm_status fail_loads(world *w, const scene *is, outcome *found) {
  const double dt = 0.3 * is->desc.grid.spacing[0], x[] = {0.9, 0.9}, area[] = {0.01, 0.0}, huge = 1e300;
  const double none = 0.0;
  mpm_surface *s = NULL;
  mpm_status answer = MPM_OK;
  int64_t id;
  int32_t part = 0, parts = 1;
  mpm_context_part(w->context, &part, &parts);
  mpm_status status = add_loads(w, 0.3, 0.12, &s);
  if (!status) status = mpm_step(w->stepper, dt, &w->info);
  if (!status) status = mpm_surface_set_traction(s, refuse_markers, &answer);
  if (part == parts - 1) answer = -3; /* one of them says no */
  if (!status) status = expect_step(w, dt, MPM_E_CALLBACK, "the traction callback of surface 0 returned -3");
  answer = MPM_OK;
  if (!status) status = mpm_surface_add(s, 1, x, area, &id);
  if (!status) status = expect_step(w, dt, MPM_E_STATE, "has a load and no material around it");
  if (!status) status = mpm_surface_remove(s, 1, &id);
  id = 0;
  if (!status) status = mpm_surface_set(s, "pressure", MPM_F64, 1, 1, &id, &huge);
  if (!status && mpm_step(w->stepper, dt, &w->info) == MPM_OK) status = MPM_E_INTERNAL;
  if (!status) status = mpm_surface_set(s, "pressure", MPM_F64, 1, 1, &id, &none);
  for (int32_t i = 0; i < 2 && !status; ++i) status = mpm_step(w->stepper, dt, &w->info);
  if (!status) status = mix_markers(w, s, &found->markers);
  if (s) drop_loads(w, s);
  return status;
}

START_TEST(loads_fail_together) {
  scene is = gmres_scene(2, implicit_basis(1), 0);
  is.run = fail_loads;
  check_made(&is, "failures", 2 + _i);
}
END_TEST

START_TEST(transport_fails) {
  scene is = gmres_scene(2, implicit_basis(1), 0);
  is.run = load;
  check_lost_transport(&is, 4, 500);
}
END_TEST

/* ---- heat ---------------------------------------------------------------------------------------------- */
/* Bodies that conduct, expand and dissipate; both conductions, both solvers, two sets, a period. */
START_TEST(warm) {
  scene is = warm_scene(40, _i % 2);
  is.run = warm_slowly;
  is.desc.stepper.scheme = MPM_NEWMARK;
  is.desc.stepper.quasi_static = _i / 8;
  is.desc.stepper.linear_solver = _i / 2 % 2 ? MPM_SOLVER_GMRES : MPM_SOLVER_CG;
  is.desc.law = law_of(_i / 2 % 2 && !is.desc.stepper.quasi_static ? 2 : _i / 4 % 2);
  is.desc.sets = is.desc.stepper.quasi_static ? 1 : 1 + _i / 4 % 2; /* they would hang by a corner */
  is.desc.grid.periodic[1] = _i % 3 == 1;
  is.desc.grid.cells[1] = _i % 3 == 1 ? 31 : 40;
  is.desc.stepper.locking_remedy = _i == 3;
  check_made(&is, "warm", 2 + _i % 4);
}
END_TEST

/* ---- total Lagrangian grids ---------------------------------------------------------------------------- */
START_TEST(total) {
  const int32_t dim = 1 + (_i + 1) % 3, b = _i / 3 % IMPLICIT_BASES, quasi_static = _i / (3 * IMPLICIT_BASES);
  scene is = gmres_scene(dim, implicit_basis(b), quasi_static);
  char name[200];
  is.desc.grid.total_lagrangian = 1;
  is.desc.law = law_of((_i + quasi_static) % LAWS_HERE);
  if (_i % 2 && strcmp(is.desc.law.model, "j2")) is.desc.stepper.linear_solver = MPM_SOLVER_CG;
  is.desc.grid.periodic[0] = dim > 1 && _i % 4 == 1;
  is.speed += _i % 8;
  snprintf(name, sizeof name, "%d: %d-D %s %s %s, options %d", _i, dim, implicit_basis(b)->name,
           is.desc.law.model, quasi_static ? "quasi-static" : "Newmark", (int)is.speed);
  check_made(&is, name, 2 + _i % 4);
}
END_TEST

/* ---- steppers that turn to implicit steps -------------------------------------------------------------- */
/* Explicit steps, implicit ones, and both once more. */
static mpm_status turn(world *w, const scene *is, outcome *found) {
  mpm_stepper_desc implicit = is->desc.stepper;
  mpm_surface *s = NULL;
  double dt;
  implicit.scheme = MPM_NEWMARK;
  mpm_status status = mpm_stable_dt(w->stepper, &dt);
  if (!status && is->heard) status = add_loads(w, 0.3, 0.12, &s);
  for (int32_t i = 0; i < 16 && !status; ++i) {
    if (i == 6 || i == 12) status = mpm_stepper_configure(w->stepper, &implicit);
    if (i == 8) status = mpm_stepper_configure(w->stepper, &is->desc.stepper);
    if (!status) status = mpm_step(w->stepper, (i / 2 == 3 || i >= 12 ? 2.0 : 0.4) * dt, &w->info);
  }
  if (!status && s) status = mix_markers(w, s, &found->markers);
  if (s) drop_loads(w, s);
  return status;
}

START_TEST(turned) {
  static const int32_t schemes[] = {MPM_USL, MPM_USF, MPM_MUSL};
  scene is = gmres_scene(2, implicit_basis(_i), 0);
  is.desc.stepper.scheme = schemes[_i % 3];
  is.desc.law = law_of(_i % LAWS_HERE);
  is.run = turn;
  is.heard = _i % 2; /* with loads */
  is.speed = MOVES | HOLDS;
  check_made(&is, "turned", 2 + _i % 4);
}
END_TEST

void add_shared_steps(Suite *suite) {
  TCase *all = tcase_create("steps");
  tcase_set_timeout(all, 240);
  TCase *wide = wide_case(suite, "more steps");
  add_every(all, wide, loads, TABLE, 11);
  add_table(all, wide, loads_beside, IMPLICIT_BASES);
  add_every(all, wide, holds, TABLE, 13);
  add_every(all, wide, warm, 16, 9);
  add_every(all, wide, total, TABLE, 11);
  add_table(all, wide, turned, 7);
  tcase_add_loop_test(all, loads_rigid, 0, 3);
  add_table(all, wide, loads_fail_together, 3);
  suite_add_tcase(suite, all);
  tcase_add_test(faults_case(suite, "faults of steps", 1), transport_fails);
}
