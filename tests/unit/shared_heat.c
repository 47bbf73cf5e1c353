/* Heat in several parts. */
#include "shared.h"

enum { NONE = -1 }; /* no particle */

/* ---- worlds -------------------------------------------------------------------------------------------- */
/* A source that differs from place to place, and has no value for a hole. */
static mpm_status warm_places(void *user, const mpm_particle_batch *b, double *power) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i)
    power[i] = b->id[i] < 0 ? NOT_A_NUMBER : 3000.0 + 1000.0 * sin(7.0 * b->position[i]);
  return 0;
}

static mpm_heat_desc describe_heat(const world *w, int32_t m) {
  mpm_heat_desc d;
  memset(&d, 0, sizeof d);
  if (mpm_heat_desc_init(&d, sizeof d)) return d;
  const char *law = w->desc.law.model;
  const int32_t rigid = law && !strcmp(law, "rigid");
  d.specific_heat = m ? 3.0 : 2.0;
  d.conductivity = 100.0;
  d.source = m ? NULL : warm_places;
  d.reference_temperature = 300.0;
  d.expansion = rigid || m ? 0.0 : 1e-4;
  d.dissipated_share = rigid || !law ? 0.0 : 0.9;
  return d;
}

static mpm_status hold_face(world *w, int32_t face, int32_t kind, double temperature) {
  if (face >= 2 * w->dim || w->desc.grid.periodic[face / 2]) return MPM_OK;
  return mpm_stepper_set_heat_wall(w->stepper, face, kind, temperature);
}

static mpm_status set_temperatures(mpm_particles *set) {
  const int64_t n = mpm_particles_count(set);
  int64_t *id = calloc((size_t)n + 1, sizeof *id);
  double *T = calloc((size_t)n + 1, sizeof *T);
  mpm_status status = mpm_particles_get(set, "id", MPM_I64, 1, n, NULL, id);
  for (int64_t p = 0; p < n; ++p) T[p] = 300.0 + 40.0 * noise_at((uint64_t)id[p]);
  if (!status) status = mpm_particles_set(set, "temperature", MPM_F64, 1, n, NULL, T);
  free(id), free(T);
  return status;
}

mpm_status equip_heat(world *w, const scene *is) {
  mpm_status status = set_walls(w);
  for (int32_t m = 0; m < w->sets && !status; ++m) {
    const mpm_heat_desc d = describe_heat(w, m);
    status = mpm_stepper_set_heat(w->stepper, w->set[m], &d);
  }
  if (!status)
    status = mpm_stepper_set_conduction(
        w->stepper, is->heat > 1 ? MPM_CONDUCTION_IMPLICIT : MPM_CONDUCTION_EXPLICIT, 1e-9);
  return status ? status : hold_face(w, MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, 250.0);
}

/* A body in the corner of the grid, so that faces conduct; its second half is another set. */
static mpm_status set_up_warm(world *w, const scene *is) {
  mpm_status status = equip_heat(w, is);
  if (!status) status = fill_middle(w, w->set[0], 0.0, w->sets > 1 ? 0.4 : 0.6);
  if (!status && w->sets > 1) status = fill_middle(w, w->set[1], 0.4, 0.6);
  for (int32_t m = 0; m < w->sets && !status; ++m) {
    status = set_velocities(w, w->set[m], is->speed);
    if (!status) status = set_temperatures(w->set[m]);
  }
  return status;
}

static mpm_status make_step(world *w, double dt, int32_t staged) {
  if (!staged) return mpm_step(w->stepper, dt, &w->info);
  mpm_status status = mpm_step_begin(w->stepper, dt);
  if (!status) status = mpm_step_grid(w->stepper);
  return status ? status : mpm_step_end(w->stepper, &w->info);
}

/* Faces begin and end to prescribe temperatures while it goes on. */
static mpm_status warm_up(world *w, const scene *is, outcome *found) {
  double dt;
  mpm_status status = mpm_stable_dt(w->stepper, &dt);
  (void)is, (void)found;
  for (int32_t i = 0; i < STEPS && !status; ++i) {
    if (i == 3) status = hold_face(w, MPM_Y_MIN, MPM_HEAT_WALL_TEMPERATURE, 350.0);
    if (i == 4) status = hold_face(w, MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, 260.0);
    if (i == 5) status = hold_face(w, MPM_Z_MIN, MPM_HEAT_WALL_TEMPERATURE, 300.0);
    if (i == 8) status = hold_face(w, MPM_X_MIN, MPM_HEAT_WALL_INSULATED, 0.0);
    if (i == 11) status = hold_face(w, MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, 280.0);
    if (!status) status = make_step(w, dt * (0.2 + 0.1 * (i % 3)), i % 3 == 2);
  }
  return status;
}

mpm_status warm_slowly(world *w, const scene *is, outcome *found) {
  mpm_status status = MPM_OK;
  (void)found;
  for (int32_t i = 0; i < 6 && !status; ++i) {
    if (i == 2) status = hold_face(w, MPM_Y_MIN, MPM_HEAT_WALL_TEMPERATURE, 350.0);
    if (i == 3) status = hold_face(w, MPM_X_MIN, MPM_HEAT_WALL_TEMPERATURE, 260.0);
    if (i == 4) status = hold_face(w, MPM_X_MIN, MPM_HEAT_WALL_INSULATED, 0.0);
    if (!status)
      status = mpm_step(w->stepper, (is->heat > 1 ? 1e-3 : 2e-4) * (1.0 + 0.5 * (i % 2)), &w->info);
  }
  return status;
}

scene warm_scene(int32_t cells, int32_t implicit) {
  scene is = scene_of(2, cells, set_up_warm);
  is.run = warm_up;
  is.speed = 2.0;
  is.heat = 1 + implicit;
  return is;
}

/* ---- bits ---------------------------------------------------------------------------------------------- */
START_TEST(warm_combinations) {
  scene is;
  char name[300];
  const int32_t total = _i / 2 % 2;
  if (!describe_option(&is, _i, total, name, sizeof name)) return;
  is.set_up = set_up_warm;
  is.run = warm_up;
  is.speed = 2.0;
  is.heat = 1 + _i % 2;
  check_made(&is, name, 2 + _i % 4);
}
END_TEST

/* Two sets, a period that is no multiple of a block, and faces that are walls of the motion, too, or not. */
START_TEST(warm_host) {
  scene is = warm_scene(96, _i % 2);
  is.desc.sets = 2;
  is.desc.grid.periodic[1] = _i / 2 % 2;
  is.desc.grid.cells[1] = is.desc.grid.periodic[1] ? 61 : 96;
  is.desc.grid.basis = _i / 4 ? MPM_LINEAR : MPM_BSPLINE3;
  is.desc.stepper.scheme = _i / 4 ? MPM_USF : MPM_USL;
  check_made(&is, "warm host", 3 + 2 * (_i % 2));
}
END_TEST

static mpm_status set_up_small(world *w, const scene *is) {
  mpm_status status = equip_heat(w, is);
  if (!status) status = fill_middle(w, w->set[0], 0.4, 0.5);
  return status ? status : set_temperatures(w->set[0]);
}

/* More parts than blocks. */
START_TEST(few_warm_blocks) {
  scene is = warm_scene(24, _i);
  is.set_up = set_up_small;
  check_made(&is, "small", MOST_PARTS);
}
END_TEST

/* ---- failures ------------------------------------------------------------------------------------------ */
/* What goes wrong with the source. */
typedef struct fault {
  int32_t kind;
} fault;
enum { SOUND, NOT_FINITE, CUTS, STOPS };

static mpm_status faulty(void *user, const mpm_particle_batch *b, double *power) {
  const fault *f = user;
  int32_t meets = 0;
  for (int64_t i = 0; i < b->n; ++i) {
    meets |= b->id[i] == 4000;
    power[i] = f->kind == NOT_FINITE && (b->id[i] == 4000 || b->id[i] == 4100) ? NOT_A_NUMBER : 1.0;
  }
  return meets && f->kind == CUTS ? 5 : meets && f->kind == STOPS ? -5 : 0;
}

/* Wants a step to fail with this status, words and particle. */
static mpm_status expect(world *w, double dt, mpm_status wanted, const char *words, int64_t particle) {
  const mpm_status status = mpm_step(w->stepper, dt, &w->info);
  if (status == wanted && strstr(mpm_last_error(w->context), words) && w->info.cause == wanted &&
      w->info.particle == particle)
    return MPM_OK;
  fprintf(stderr, "%s, particle %lld: %s\n", mpm_status_name(status), (long long)w->info.particle,
          mpm_last_error(w->context));
  return MPM_E_INTERNAL;
}

static mpm_status overheat(world *w, double T) {
  const int64_t id[] = {4000, 700, 2500};
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < 3 && !status; ++i) {
    status = mpm_particles_set(w->set[0], "temperature", MPM_F64, 1, 1, &id[i], &T);
    if (status == MPM_E_NOT_FOUND) status = MPM_OK; /* it is on another part */
  }
  return status;
}

/* All parts fail as one does, and go on from the state before. */
static mpm_status fail_warm(world *w, const scene *is, outcome *found) {
  double dt;
  fault f = {SOUND};
  mpm_heat_desc d = describe_heat(w, 0);
  d.specific_heat = 1000.0; /* so that the heat of the hottest is not finite */
  d.source = faulty;
  d.user = &f;
  (void)found;
  mpm_status status = mpm_stepper_set_heat(w->stepper, w->set[0], &d);
  if (!status) status = mpm_stable_dt(w->stepper, &dt);
  for (int32_t i = 0; i < 4 && !status; ++i) status = mpm_step(w->stepper, 0.3 * dt, &w->info);
  f.kind = NOT_FINITE;
  if (!status) status = expect(w, 0.3 * dt, MPM_NONFINITE, "power of the heat source not finite", 4000);
  f.kind = CUTS;
  if (!status) status = expect(w, 0.3 * dt, MPM_CUT_DT, "the heat source", NONE);
  f.kind = STOPS;
  if (!status) status = expect(w, 0.3 * dt, MPM_E_CALLBACK, "the heat source", NONE);
  f.kind = SOUND;
  if (!status && is->heat == 1)
    status = expect(w, 10.0, MPM_CUT_DT, "explicit conduction is stable up to", NONE);
  if (!status) status = overheat(w, 1e308);
  if (!status) status = expect(w, 0.3 * dt, MPM_NONFINITE, "the heat that a temperature stands for", 700);
  if (!status) status = overheat(w, 300.0);
  for (int32_t i = 0; i < 4 && !status; ++i) status = mpm_step(w->stepper, 0.3 * dt, &w->info);
  d.source = NULL;
  return status ? status : mpm_stepper_set_heat(w->stepper, w->set[0], &d);
}

START_TEST(warm_failures) {
  scene is = warm_scene(96, _i % 2);
  is.run = fail_warm;
  check_made(&is, "failures", 2 + _i);
}
END_TEST

void add_shared_heat(Suite *suite) {
  TCase *heat = tcase_create("heat");
  tcase_set_timeout(heat, 120);
  add_option_list(heat);
  TCase *wide = wide_case(suite, "more heat");
  add_option_list(wide);
  add_table(heat, wide, warm_combinations, OPTIONS_SAMPLE);
  tcase_add_loop_test(heat, warm_host, 0, 8);
  tcase_add_loop_test(heat, few_warm_blocks, 0, 2);
  tcase_add_loop_test(heat, warm_failures, 0, 4);
  suite_add_tcase(suite, heat);
}
