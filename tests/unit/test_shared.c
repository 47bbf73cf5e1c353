/* One problem in several parts has the bits that it has in one. Parts are threads here (parts.h), where
 * Check's macros may not be used: every part keeps what it has found, which is compared afterwards. */
#include "shared.h"
#include "tables.h"

/* ---- combinations -------------------------------------------------------------------------------------- */
mpm_status set_up_body(world *w, const scene *is) {
  mpm_status status = set_walls(w);
  if (!status) status = fill_middle(w, w->set[0], 0.2, 0.7);
  return status ? status : set_velocities(w, w->set[0], is->speed);
}

static combination *list;
static int32_t list_count;

static void set_up_list(void) {
  list = list_combinations(&list_count);
}
static void tear_down_list(void) {
  free(list);
}

/* Blocks are 64, 16 and 6 nodes wide. */
static const int32_t cells_of[] = {0, 300, 56, 20};

void refine(world_desc *desc) {
  for (int32_t k = 0; k < desc->grid.dim; ++k) {
    desc->grid.cells[k] = cells_of[desc->grid.dim];
    desc->grid.spacing[k] = 1.0 / (double)desc->grid.cells[k];
  }
}

static int32_t describe(scene *is, const combination *c) {
  if (refusal_of(c) || scheme_options[c->choice[CHOOSE_SCHEME]].scheme == MPM_NEWMARK) return 0;
  memset(is, 0, sizeof *is);
  is->desc = describe_combination(c);
  refine(&is->desc);
  is->set_up = set_up_body;
  is->speed = 8.0;
  return 1;
}

START_TEST(combinations_in_parts) {
  scene is;
  char name[300];
  const combination *c = &list[(int64_t)_i * list_count / SAMPLE + (_i * 7) % (list_count / SAMPLE)];
  if (!describe(&is, c)) return;
  check_scene(&is, name_of(c, name, sizeof name), 2 + _i % 4);
}
END_TEST

/* ---- what hosts do ------------------------------------------------------------------------------------- */
static mpm_status hold_some(void *user, const mpm_node_batch *batch, uint8_t *held, double *velocity) {
  (void)user;
  for (int64_t i = 0; i < batch->n; ++i) {
    held[i] = batch->position[i] < 0.3;
    velocity[i] = 0.5 * batch->t;
  }
  return MPM_OK;
}

static mpm_status push(void *user, const mpm_node_batch *batch, double *velocity, double *force) {
  (void)user, (void)velocity;
  for (int64_t i = 0; i < batch->n; ++i)
    if (batch->position[batch->ld + i] > 0.5) force[i] += 3.0 * batch->mass[i];
  return MPM_OK;
}

static mpm_status pull(void *user, const mpm_particle_batch *batch, double *force) {
  (void)user;
  for (int64_t p = 0; p < batch->n; ++p) force[p] = batch->position[p] > 0.5 ? 0.1 * batch->mass[p] : 0.0;
  return MPM_OK;
}

static mpm_status add_callbacks(world *w) {
  mpm_status status = mpm_stepper_set_velocity_bc(w->stepper, hold_some, NULL);
  if (!status) status = mpm_stepper_set_node_hook(w->stepper, MPM_AFTER_FORCES, push, NULL);
  return status ? status : mpm_stepper_set_force(w->stepper, pull, NULL);
}

static mpm_status set_up_host(world *w, const scene *is) {
  mpm_status status = set_walls(w);
  if (!status) status = fill_middle(w, w->set[0], 0.2, 0.6);
  if (!status) status = fill_middle(w, w->set[1], 0.6, 0.8);
  for (int32_t m = 0; m < 2 && !status; ++m) status = set_velocities(w, w->set[m], is->speed);
  if (!status) status = prescribe_sevenths(w->set[0]);
  return status ? status : add_callbacks(w);
}

START_TEST(host_acts) {
  static const int32_t schemes[] = {MPM_USL, MPM_USF, MPM_MUSL};
  scene is = scene_of(2, 4 * WIDE, set_up_host);
  is.desc.sets = 2;
  is.desc.stepper.scheme = schemes[_i % 3];
  is.desc.stepper.locking_remedy = _i / 3 % 2;
  is.desc.grid.periodic[1] = _i / 6 % 2;
  is.desc.grid.cells[1] = _i / 6 % 2 ? 4 * WIDE - 7 : 4 * WIDE; /* a period that is no multiple of a block */
  is.desc.stepper.mass_damping = _i % 2 ? 2.0 : 0.0;
  is.desc.grid.total_lagrangian = _i / 12;
  check_scene(&is, "host", 3);
}
END_TEST

/* Particles that leave through an open wall, others that are added and removed while it goes on. */
static mpm_status come_and_go(world *w, const scene *is, outcome *found) {
  double dt;
  (void)found;
  mpm_status status = mpm_stable_dt(w->stepper, &dt);
  int32_t part = 0, parts = 1;
  mpm_context_part(w->context, &part, &parts);
  for (int32_t i = 0; i < 60 && !status; ++i) {
    status = mpm_step(w->stepper, 0.3 * dt, &w->info);
    if (status || i % 20 != 10) continue;
    const double x[] = {0.31 + 0.01 * i / 20, 0.27}, v[] = {is->speed, 0.0}, volume[] = {1e-4};
    const int64_t id[] = {100000 + i};
    status = mpm_particles_add(w->set[0], part == (i / 20) % parts, x, v, volume, NULL, id, NULL);
    const int64_t gone[] = {500 + i};
    if (!status && mpm_particles_remove(w->set[0], 1, gone) == MPM_E_NOT_FOUND) status = MPM_OK;
  }
  return status;
}

static mpm_status set_up_open(world *w, const scene *is) {
  mpm_status status = MPM_OK;
  for (int32_t face = 0; face < 4 && !status; ++face)
    status = mpm_stepper_set_wall(w->stepper, face, MPM_WALL_OPEN, 0.0);
  if (!status) status = fill_middle(w, w->set[0], 0.5, 0.99);
  return status ? status : set_velocities(w, w->set[0], is->speed);
}

START_TEST(particles_come_and_go) {
  scene is = scene_of(2, 4 * WIDE, set_up_open);
  is.run = come_and_go;
  is.speed = 40.0;
  check_scene(&is, "open", 4);
}
END_TEST

/* Particles become prescribed while it goes on; a part that has none of the set has nothing to set. */
static mpm_status prescribe_later(world *w, const scene *is, outcome *found) {
  double dt;
  mpm_status status = mpm_stable_dt(w->stepper, &dt);
  (void)is, (void)found;
  for (int32_t i = 0; i < 12 && !status; ++i) {
    if (i == 4) status = prescribe_sevenths(w->set[0]);
    if (!status) status = mpm_step(w->stepper, 0.3 * dt, &w->info);
  }
  return status;
}

START_TEST(prescribed_later) {
  scene is = scene_of(2, 2 * WIDE, set_up_body);
  is.run = prescribe_later;
  check_scene(&is, "prescribed later", MOST_PARTS);
}
END_TEST

/* Clumps of a few particles about cells: on the linear basis nearly every node at their rim is light. */
static mpm_status set_up_clumps(world *w, const scene *is) {
  enum { CLUMPS = 60, EACH = 15 };
  double x[2 * CLUMPS * EACH], volume[CLUMPS * EACH];
  const double h = w->desc.grid.spacing[0], size = h * (double)w->desc.grid.cells[0];
  int32_t part = 0, parts = 1;
  dice random = {(uint64_t)is->speed};
  mpm_context_part(w->context, &part, &parts);
  for (int32_t k = 0; k < CLUMPS; ++k) {
    const double at[] = {throw_between(&random, 0.1, 0.8) * size, throw_between(&random, 0.1, 0.8) * size};
    for (int32_t i = 0; i < EACH; ++i)
      for (int32_t c = 0; c < 2; ++c)
        x[c * CLUMPS * EACH + k * EACH + i] =
            h * (floor(at[c] / h) + 0.5 * floor(throw_between(&random, 0.0, 5.0)) +
                 throw_between(&random, 1e-7, 2e-7));
  }
  for (int32_t p = 0; p < CLUMPS * EACH; ++p) volume[p] = 0.1 * h * h;
  mpm_status status =
      mpm_particles_add(w->set[0], part ? 0 : CLUMPS * EACH, x, NULL, volume, NULL, NULL, NULL);
  return status ? status : set_velocities(w, w->set[0], 0.1);
}

START_TEST(light_nodes_lead) {
  static const int32_t transfers[] = {MPM_FLIP, MPM_APIC, MPM_XPIC};
  scene is = scene_of(2, 2 * WIDE, set_up_clumps);
  is.speed = 1 + _i;
  is.desc.grid.basis = MPM_LINEAR;
  is.desc.stepper.scheme = _i % 2 ? MPM_MUSL : MPM_USL;
  is.desc.stepper.transfer = transfers[_i % 3];
  is.desc.stepper.xpic_order = 2;
  is.desc.grid.total_lagrangian = _i / 12;
  check_scene(&is, "clumps", 2 + _i % 4);
}
END_TEST

/* More parts than blocks, one block for all, and none at all. */
static mpm_status set_up_small(world *w, const scene *is) {
  (void)is;
  return fill_middle(w, w->set[0], 0.4, 0.5);
}

START_TEST(few_blocks) {
  scene is = scene_of(2, WIDE, set_up_small);
  check_scene(&is, "small", MOST_PARTS);
}
END_TEST

START_TEST(blocks_are_cut_anew) {
  scene is = scene_of(2, 6 * WIDE, set_up_body);
  is.desc.grid.periodic[0] = 1;
  is.run = fly_through;
  is.speed = 30.0;
  scene many = is;
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  check_scene(&is, "flight", 4);
  ck_assert_int_eq(parts_run(4, live, &many, &plan), 0);
  int64_t moved = 0, own = 0;
  for (int32_t r = 0; r < 4; ++r) {
    moved += many.found[r].parallel.moved;
    own += many.found[r].own;
    ck_assert(many.found[r].parallel.cuts > 1 && many.found[r].parallel.imbalance < 1.6);
  }
  ck_assert_int_eq(own, many.found[0].total);
  ck_assert_int_gt(moved, own / 2);
}
END_TEST

/* ---- failures ------------------------------------------------------------------------------------------ */
/* All parts fail as one part does, with the particle's number, and go on from the state before. */
static mpm_status fail_and_go_on(world *w, const scene *is, outcome *found) {
  double dt;
  mpm_status status = mpm_stable_dt(w->stepper, &dt);
  (void)is;
  for (int32_t i = 0; i < 5 && !status; ++i) status = mpm_step(w->stepper, 0.3 * dt, &w->info);
  if (status) return status;
  w->info.struct_size = sizeof w->info;
  status = mpm_step(w->stepper, 400.0 * dt, &w->info);
  if (status != MPM_INVERTED && status != MPM_OFF_GRID && status != MPM_NONFINITE) return MPM_E_INTERNAL;
  if (w->info.cause != status || w->info.particle < 0 || !strstr(mpm_last_error(w->context), "at particle"))
    return MPM_E_INTERNAL;
  found->failed_particle = w->info.particle;
  for (int32_t i = 0; i < 5 && (!i || !status); ++i) status = mpm_step(w->stepper, 0.3 * dt, &w->info);
  return status;
}

START_TEST(steps_fail_together) {
  static const int32_t schemes[] = {MPM_USL, MPM_USF, MPM_MUSL};
  scene is = scene_of(2, 4 * WIDE, set_up_body);
  is.desc.stepper.scheme = schemes[_i % 3];
  is.desc.stepper.locking_remedy = _i / 3 % 2;
  is.desc.grid.total_lagrangian = _i / 6;
  is.run = fail_and_go_on;
  check_scene(&is, "failure", 3);
}
END_TEST

/* Parts that differ in what they ask for are told so. */
static mpm_status differ(world *w, const scene *is, outcome *found) {
  int32_t part = 0, parts = 1;
  (void)is, (void)found;
  mpm_context_part(w->context, &part, &parts);
  const mpm_status dt = mpm_step(w->stepper, part == 1 ? 2e-5 : 1e-5, NULL);
  if (parts > 1 && (dt != MPM_E_ARG || !strstr(mpm_last_error(w->context), "dt is"))) return MPM_E_INTERNAL;
  const mpm_status bad = mpm_step(w->stepper, part == 2 ? -1.0 : 1e-5, NULL);
  if (parts > 2 && (bad != MPM_E_ARG || !strstr(mpm_last_error(w->context), "dt is -1")))
    return MPM_E_INTERNAL;
  if (parts > 2 && part != 2 && !strstr(mpm_last_error(w->context), "part 2: ")) return MPM_E_INTERNAL;
  double stable;
  uint64_t hash;
  const double low[] = {0.1, 0.1}, high[] = {0.2, part == 1 ? -0.1 : 0.2};
  const int32_t per_cell[] = {2, 2};
  mpm_step_info info = {.struct_size = sizeof info};
  if (parts > 1 && (mpm_stable_dt(w->stepper, part == 1 ? NULL : &stable) != MPM_E_ARG ||
                    mpm_stepper_info(w->stepper, part == 1 ? NULL : &info) != MPM_E_ARG ||
                    mpm_state_hash(w->stepper, part == 1 ? NULL : &hash) != MPM_E_ARG ||
                    mpm_particles_fill_box(w->set[0], low, high, per_cell, NULL, NULL) != MPM_E_ARG ||
                    !strstr(mpm_last_error(w->context), "lower[1]")))
    return MPM_E_INTERNAL;
  const mpm_status held = part == 1 ? mpm_stepper_set_velocity_bc(w->stepper, hold_some, NULL) : MPM_OK;
  const mpm_status unlike = mpm_step(w->stepper, 1e-5, NULL);
  if (held ||
      (parts > 1 && (unlike != MPM_E_STATE || !strstr(mpm_last_error(w->context), "set up otherwise"))))
    return MPM_E_INTERNAL;
  mpm_stepper_set_velocity_bc(w->stepper, NULL, NULL);
  return mpm_step(w->stepper, 1e-5, NULL);
}

START_TEST(unlike_parts) {
  scene is = scene_of(2, 2 * WIDE, set_up_body);
  is.run = differ;
  check_parts(&is, 3);
}
END_TEST

START_TEST(transport_fails) {
  const scene is = _i ? warm_scene(2 * WIDE, _i - 1) : scene_of(2, 2 * WIDE, set_up_body);
  check_lost_transport(&is, 6, 100);
}
END_TEST

/* ---- a transport that one thread plays ---------- */
/* The other part has what this one has, until it is to be unlike or gone. */
typedef struct echo {
  int32_t calls, fails, unlike;
} echo;

static mpm_status echo_send(void *user, int32_t exchange, int32_t count, const mpm_message *out,
                            const int64_t *most) {
  (void)user, (void)exchange, (void)count, (void)out, (void)most;
  return MPM_OK;
}
static mpm_status echo_receive(void *user, int32_t *count, const mpm_message **in) {
  (void)user, (void)in;
  *count = 0;
  return MPM_OK;
}
static mpm_status echo_reduce(void *user, int32_t op, int64_t count, int64_t *values) {
  echo *e = user;
  ++e->calls;
  for (int64_t i = 0; i < count && op == MPM_REDUCE_SUM; ++i) values[i] *= 2;
  if (e->unlike >= 0 && e->unlike < count) ++values[e->unlike];
  return e->fails ? MPM_E_IO : MPM_OK;
}
static mpm_status echo_gather(void *user, int64_t value, int64_t *all) {
  (void)user;
  all[0] = all[1] = value;
  return MPM_OK;
}

static mpm_transport echo_transport(echo *e) {
  return (mpm_transport){.struct_size = sizeof(mpm_transport),
                         .parts = 2,
                         .send = echo_send,
                         .receive = echo_receive,
                         .reduce = echo_reduce,
                         .gather = echo_gather,
                         .user = e};
}

static void refuse_context(const mpm_transport *transport, mpm_status wanted, const char *words) {
  char text[400] = "";
  mpm_context_desc desc = context_desc();
  mpm_context *context;
  desc.transport = transport;
  desc.error_text = text;
  desc.error_bytes = sizeof text;
  ck_assert_int_eq(mpm_context_create(&desc, &context), wanted);
  ck_assert_msg(strstr(text, words) != NULL, "%s", text);
}

START_TEST(transport_is_checked) {
  echo e = {0, 0, -1};
  mpm_transport t = echo_transport(&e);
  t.part = 2;
  refuse_context(&t, MPM_E_ARG, "part is 2 of 2");
  t = echo_transport(&e);
  t.parts = 0;
  refuse_context(&t, MPM_E_ARG, "part is 0 of 0");
  t = echo_transport(&e);
  t.gather = NULL;
  refuse_context(&t, MPM_E_ARG, "gather is NULL");
  t = echo_transport(&e);
  t.struct_size = 8;
  refuse_context(&t, MPM_E_ARG, "struct_size is 8");
  t = echo_transport(&e);
  e.unlike = 2; /* the second number that parts compare */
  refuse_context(&t, MPM_E_UNSUPPORTED, "unlike instruction sets");
}
END_TEST

/* What has failed once is not asked again. */
START_TEST(transport_is_lost) {
  echo e = {0, 0, -1};
  const mpm_transport t = echo_transport(&e);
  world w;
  world_desc desc = world_default(2, 8, 0.25);
  int64_t n;
  int32_t part, parts;
  desc.context.transport = &t;
  mpm_particles *set = world_open(&w, &desc);
  ck_ok(&w, mpm_context_part(w.context, &part, &parts));
  ck_assert(part == 0 && parts == 2);
  ck_ok(&w, mpm_particles_total(set, &n));
  ck_refused(&w, mpm_particles_total(set, NULL), MPM_E_ARG, "n is NULL");
  ck_refused(&w, mpm_stepper_parallel_info(w.stepper, 0, NULL), MPM_E_ARG, "info is NULL");
  e.fails = 1;
  ck_refused(&w, mpm_particles_total(set, &n), MPM_E_CALLBACK, "reduce returned -7");
  e.fails = 0;
  const int32_t calls = e.calls;
  ck_refused(&w, mpm_particles_total(set, &n), MPM_E_CALLBACK, "has failed before");
  ck_assert_int_eq(e.calls, calls);
  world_close(&w);
}
END_TEST

/* Memory does not fail, and is not counted, where a call concerns one part alone: the others would wait. */
static mpm_status set_fed_velocities(world *w, double speed) {
  const int64_t calls = w->memory.calls, fail_at = w->memory.fail_at;
  w->memory.fail_at = 0;
  const mpm_status status = set_velocities(w, w->set[0], speed);
  w->memory.calls = calls, w->memory.fail_at = fail_at;
  return status;
}

static void live_hungry(int32_t part, const mpm_transport *transport, void *user) {
  hungry *h = user;
  outcome *found = &h->is.found[part];
  world w;
  double dt;
  memset(&w, 0, sizeof w);
  w.desc = h->is.desc;
  w.desc.context.transport = transport;
  mpm_status status = world_try_open(&w);
  mpm_surface *surface = NULL;
  if (!status && h->is.heat) status = equip_heat(&w, &h->is);
  if (!status && h->loads) status = add_loads(&w, 0.45, 0.2, &surface);
  const int64_t opened = w.memory.calls;
  begin_hunger(h, &w, part, opened);
  if (!status) AGAIN(h, part, status, MPM_E_NOMEM, fill_middle(&w, w.set[0], 0.2, 0.7));
  if (!status) status = set_fed_velocities(&w, h->is.speed);
  if (!status) AGAIN(h, part, status, MPM_E_NOMEM, mpm_stable_dt(w.stepper, &dt));
  const int32_t steps = faults_are_full() ? 4 : 12; /* all that is allocated anew is so in the first ones */
  for (int32_t i = 0; i < steps && !status; ++i)
    AGAIN(h, part, status, MPM_E_NOMEM, mpm_step(w.stepper, 0.3 * dt, NULL));
  end_hunger(h, &w, part, opened);
  if (!status) status = mpm_state_hash(w.stepper, &found->hash);
  found->status = status;
  if (surface) drop_loads(&w, surface);
  world_try_close(&w);
  h->memory[part] = w.memory;
}

START_TEST(memory_runs_out) {
  static hungry h;
  memset(&h, 0, sizeof h);
  h.loads = _i == 3 || _i == 5;
  h.is = _i == 1 || _i == 2 ? warm_scene(2 * WIDE, _i - 1) : scene_of(2, 2 * WIDE, set_up_body);
  if (_i >= 4) {
    h.is.desc.stepper.scheme = MPM_NEWMARK;
    h.is.desc.stepper.linear_solver = _i == 4 ? MPM_SOLVER_CG : MPM_SOLVER_GMRES;
  }
  check_hunger(&h, live_hungry);
}
END_TEST

Suite *shared_suite(void) {
  Suite *suite = suite_create("shared");
  TCase *all = tcase_create("combinations");
  tcase_set_timeout(all, 120);
  tcase_add_unchecked_fixture(all, set_up_list, tear_down_list);
  TCase *wide = wide_case(suite, "more combinations");
  tcase_add_unchecked_fixture(wide, set_up_list, tear_down_list);
  add_table(all, wide, combinations_in_parts, SAMPLE);
  suite_add_tcase(suite, all);
  TCase *host = tcase_create("host");
  tcase_set_timeout(host, 120);
  add_sparse(host, host_acts, 24, 5);
  tcase_add_test(host, particles_come_and_go);
  tcase_add_test(host, prescribed_later);
  tcase_add_loop_test(host, light_nodes_lead, 0, 24);
  tcase_add_test(host, few_blocks);
  add_sparse(host, blocks_are_cut_anew, 1, 2);
  suite_add_tcase(suite, host);
  suite_add_tcase(suite, shared_calls_case(suite));
  suite_add_tcase(suite, shared_balance_case());
  suite_add_tcase(suite, shared_timed_case());
  suite_add_tcase(suite, shared_threads_case());
  add_shared_callbacks(suite);
  TCase *failures = tcase_create("failures");
  tcase_set_timeout(failures, 120);
  tcase_add_loop_test(failures, steps_fail_together, 0, 12);
  tcase_add_test(failures, unlike_parts);
  tcase_add_test(failures, transport_is_checked);
  tcase_add_test(failures, transport_is_lost);
  suite_add_tcase(suite, failures);
  TCase *faults = faults_case(suite, "faults", 0), *more = faults_case(suite, "more faults", 1);
  tcase_add_loop_test(faults, transport_fails, 0, 1);
  tcase_add_loop_test(faults, memory_runs_out, 0, 2);
  tcase_add_loop_test(more, transport_fails, 1, 3);
  tcase_add_loop_test(more, memory_runs_out, 2, 6);
  return suite;
}
