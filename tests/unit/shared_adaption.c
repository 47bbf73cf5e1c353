/* Splitting and merging in several parts: the particles that one part would choose, with its ids. */
#include "shared.h"

static mpm_adaption_desc describe(uint64_t kind) {
  mpm_adaption_desc d;
  mpm_adaption_desc_init(&d, sizeof d);
  d.every = 4;
  d.least_edge = 0.1;
  d.merge_distance = 0.8;
  d.merge_tolerance = 0.5;
  if (kind % 4 == 0) d.split_edge = 0.499;
  if (kind % 4 != 0) d.min_per_cell = 2 + kind % 4;
  if (kind % 4 > 1) d.max_per_cell = 2 * d.min_per_cell;
  return d;
}

/* Some particles are left as they are. */
static mpm_status choose(void *user, const mpm_adaption_batch *b, uint8_t *accept) {
  (void)user;
  for (int64_t i = 0; i < b->n; ++i)
    accept[i] = (b->id[i] + (b->what == MPM_ADAPT_MERGE ? b->other[i] : 0)) % 7 != 3;
  return MPM_OK;
}

static mpm_status tell(const world *w, outcome *found) {
  mpm_adaption_info info = {.struct_size = sizeof info};
  const mpm_status status = mpm_stepper_adaption_info(w->stepper, w->set[0], &info);
  const double seen[] = {(double)info.splits,
                         (double)info.added,
                         (double)info.merges,
                         info.kinetic_loss,
                         info.affine_loss,
                         info.strain_loss,
                         info.angular_momentum_loss[0],
                         info.angular_momentum_loss[1],
                         info.angular_momentum_loss[2]};
  memcpy(found->seen, seen, sizeof seen);
  if (!status && !info.splits && !info.merges) return MPM_E_INTERNAL; /* there was something to do */
  return status;
}

/* A body that holes and a denser corner make uneven. */
static mpm_status set_up_uneven(world *w, const scene *is) {
  const double size = w->desc.grid.spacing[0] * (double)w->desc.grid.cells[0];
  const double low[] = {0.55 * size, 0.3 * size, 0.3 * size}, high[] = {0.72 * size, 0.5 * size, 0.45 * size};
  const int32_t once[] = {1, 1, 1}, dense[] = {3, 3, 2};
  mpm_adaption_desc d = describe(is->seed);
  mpm_status status = set_walls(w);
  if (is->seed % 3 == 1) d.accept = choose;
  if (is->seed % 5 == 4) d.most_particles = is->seed % 2 ? 4500 : 9000;
  if (!status) status = fill_middle(w, w->set[0], 0.2, 0.5);
  if (!status) status = mpm_particles_fill_box(w->set[0], low, high, is->seed % 2 ? once : dense, NULL, NULL);
  if (!status) status = set_velocities(w, w->set[0], is->speed);
  return status ? status : mpm_stepper_set_adaption(w->stepper, w->set[0], &d);
}

static mpm_status adapt(world *w, const scene *is, outcome *found) {
  (void)is;
  mpm_status status = run_steps(w);
  if (!status) status = tell(w, found);
  return status;
}

START_TEST(adaption_combines) {
  scene is;
  char name[300];
  if (!describe_option(&is, _i, 0, name, sizeof name)) return;
  if (!strcmp(is.desc.law.model, "rigid")) return;
  is.set_up = set_up_uneven;
  is.run = adapt;
  is.seed = (uint64_t)_i;
  is.speed = 8.0;
  check_made(&is, name, 2 + _i % 4);
}
END_TEST

/* ---- stories ------------------------------------------------------------------------------------------- */
/* Between steps and before the first, with a field that one part alone has, and by mpm_advance(). */
static mpm_status adapt_between(world *w, const scene *is, outcome *found) {
  const int64_t id = 40;
  const double force[] = {3.0, 1.0};
  mpm_status status = is->seed % 2 ? mpm_stepper_adapt(w->stepper) : MPM_OK;
  for (int32_t round = 0; round < 3 && !status; ++round) {
    status = run_steps(w);
    if (!status && round == 1) {
      status = mpm_particles_set(w->set[0], "applied_force", MPM_F64, 2, 1, &id, force);
      if (status == MPM_E_NOT_FOUND) status = MPM_OK; /* another part has it */
    }
    if (!status) status = mpm_stepper_adapt(w->stepper);
    if (!status && round != 1) status = mpm_stepper_adapt(w->stepper);
    if (!status && is->seed % 3 != 2) status = save_and_load(w);
  }
  mpm_advance_desc d = advance_desc(w->info.t + 0.002);
  if (!status) status = mpm_advance(w->stepper, &d, &w->info);
  if (!status) status = tell(w, found);
  return status;
}

START_TEST(adapted_between_steps) {
  static const int32_t transfers[] = {MPM_APIC, MPM_FLIP, MPM_TPIC};
  scene is = scene_of(2, 96, set_up_uneven);
  is.desc.stepper.transfer = transfers[_i % 3];
  is.desc.stepper.scheme = scheme_options[_i % 3].scheme;
  is.desc.grid.periodic[0] = _i % 2;
  is.run = adapt_between;
  is.seed = (uint64_t)_i;
  is.speed = 30.0;
  check_made(&is, "between steps", 2 + _i % 4);
}
END_TEST

/* Sets with heat keep it, whoever has the other particle of a pair. */
static mpm_status adapt_warm(world *w, const scene *is, outcome *found) {
  mpm_adaption_desc d = describe(2 + is->seed);
  mpm_status status = mpm_stepper_set_adaption(w->stepper, w->set[0], &d);
  if (!status) status = run_steps(w);
  if (!status) status = tell(w, found);
  const mpm_status off = mpm_stepper_set_adaption(w->stepper, w->set[0], NULL);
  return status ? status : off;
}

START_TEST(warm_sets_adapt) {
  scene is = warm_scene(96, _i % 2);
  is.run = adapt_warm;
  is.seed = (uint64_t)_i;
  check_made(&is, "warm", 2 + _i % 4);
}
END_TEST

static mpm_status adapt_slowly(world *w, const scene *is, outcome *found) {
  (void)is;
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < 6 && !status; ++i) status = mpm_step(w->stepper, 2e-5, &w->info);
  return status ? status : tell(w, found);
}

START_TEST(implicit_steps_adapt) {
  scene is = scene_of(2, 48, set_up_uneven);
  is.desc.stepper.scheme = MPM_NEWMARK;
  is.desc.grid.periodic[0] = _i % 2;
  is.run = adapt_slowly;
  is.seed = (uint64_t)_i;
  check_made(&is, "implicit", 2 + _i);
}
END_TEST

/* ---- failures ------------------------------------------------------------------------------------------ */
static mpm_status refuse(void *user, const mpm_adaption_batch *b, uint8_t *accept) {
  const mpm_status *answer = user;
  memset(accept, 0, (size_t)b->n); /* so that there is always something to be done */
  return *answer;
}

static mpm_status fail_adapting(world *w, const scene *is, outcome *found) {
  mpm_status answer = MPM_OK;
  mpm_adaption_desc d = describe(3);
  int32_t part = 0, parts = 1;
  (void)is;
  mpm_context_part(w->context, &part, &parts);
  d.every = 1;
  d.accept = refuse;
  d.user = &answer;
  mpm_status status = mpm_stepper_set_adaption(w->stepper, w->set[0], &d);
  for (int32_t i = 0; i < 3 && !status; ++i) status = mpm_step(w->stepper, 1e-5, &w->info);
  answer = part == parts - 1 ? -6 : MPM_OK;
  const mpm_status step = mpm_step(w->stepper, 1e-5, &w->info);
  found->failed = w->info;
  if (step != MPM_E_CALLBACK || !strstr(mpm_last_error(w->context), "adaption callback returned -6"))
    return MPM_E_INTERNAL;
  if (mpm_stepper_adapt(w->stepper) != MPM_E_CALLBACK) return MPM_E_INTERNAL;
  answer = MPM_OK;
  for (int32_t i = 0; i < 3 && !status; ++i) status = mpm_step(w->stepper, 1e-5, &w->info);
  if (!status && parts > 1) {
    if (part == 1) d.max_per_cell += 4;
    status = mpm_stepper_set_adaption(w->stepper, w->set[0], &d);
    if (!status && mpm_step(w->stepper, 1e-5, NULL) != MPM_E_STATE) status = MPM_E_INTERNAL;
    if (!status && mpm_stepper_adapt(w->stepper) != MPM_E_STATE) status = MPM_E_INTERNAL;
  }
  const mpm_status off = mpm_stepper_set_adaption(w->stepper, w->set[0], NULL);
  if (!status) status = off;
  if (!status) status = mpm_step(w->stepper, 1e-5, &w->info);
  return status;
}

START_TEST(adaption_fails_together) {
  scene is = scene_of(2, 96, set_up_uneven);
  is.seed = 3;
  is.run = fail_adapting;
  if (_i == 2) is.desc.stepper.scheme = MPM_NEWMARK;
  check_made(&is, "failure", 2 + _i);
}
END_TEST

static mpm_status set_up_worn(world *w, const scene *is) {
  mpm_status status = set_up_uneven(w, is);
  for (int32_t i = 0; i < 3 && !status; ++i) status = mpm_step(w->stepper, 2e-5, NULL);
  return status;
}

static mpm_status adapt_or_step(world *w, int32_t part, int32_t number) {
  (void)part;
  return number == 3 ? mpm_stepper_adapt(w->stepper) : mpm_step(w->stepper, 2e-5, NULL);
}

START_TEST(memory_runs_out_adapting) {
  static hungry h;
  memset(&h, 0, sizeof h);
  h.is = scene_of(2, 48, set_up_worn);
  h.is.seed = 3;
  h.act = adapt_or_step;
  h.acts = 6;
  check_hunger(&h, live_hungrily);
}
END_TEST

START_TEST(transport_fails_adapting) {
  scene is = scene_of(2, 48, set_up_uneven);
  is.seed = 3;
  check_lost_transport(&is, 6, 100);
}
END_TEST

void add_shared_adaption(Suite *suite) {
  TCase *adaption = tcase_create("adaption");
  tcase_set_timeout(adaption, 120);
  add_option_list(adaption);
  TCase *wide = wide_case(suite, "more adaption");
  add_option_list(wide);
  add_table(adaption, wide, adaption_combines, OPTIONS_SAMPLE);
  add_table(adaption, wide, adapted_between_steps, 12);
  tcase_add_loop_test(adaption, warm_sets_adapt, 0, 2);
  tcase_add_loop_test(adaption, implicit_steps_adapt, 0, 4);
  tcase_add_loop_test(adaption, adaption_fails_together, 0, 3);
  suite_add_tcase(suite, adaption);
  tcase_add_test(faults_case(suite, "faults of adaption", 0), memory_runs_out_adapting);
  tcase_add_test(faults_case(suite, "more faults of adaption", 1), transport_fails_adapting);
}
