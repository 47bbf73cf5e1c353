/* One problem in several parts has the bits that it has in one. Parts are threads here (parts.h), where
 * Check's macros may not be used: every part keeps what it has found, which is compared afterwards. */
#include "combinations.h"
#include "parts.h"
#include "shared.h"

enum { SAMPLE = 120 };

/* Velocities that follow from the positions: a spin and a drift, so that particles change their blocks. */
mpm_status set_velocities(world *w, mpm_particles *set, double speed) {
  const int64_t n = mpm_particles_count(set);
  const int32_t dim = w->dim;
  double *x = calloc((size_t)(n * dim + 1), 2 * sizeof *x), *v = x + n * dim;
  const double middle = 0.5 * w->desc.grid.spacing[0] * (double)w->desc.grid.cells[0];
  mpm_status status = mpm_particles_get(set, "position", MPM_F64, dim, n, NULL, x);
  for (int64_t p = 0; p < n && !status; ++p) {
    const double across = dim > 1 ? x[n + p] - middle : 0.0;
    v[p] = speed * (1.0 + across);
    if (dim > 1) v[n + p] = speed * (0.4 - x[p] + middle);
    if (dim > 2) v[2 * n + p] = -0.3 * speed;
  }
  if (!status) status = mpm_particles_set(set, "velocity", MPM_F64, dim, n, NULL, v);
  free(x);
  return status;
}

mpm_status fill_middle(world *w, mpm_particles *set, double from, double to) {
  const double size = w->desc.grid.spacing[0] * (double)w->desc.grid.cells[0];
  const double low[] = {from * size, from * size, from * size}, high[] = {to * size, to * size, to * size};
  const int32_t per_cell[] = {2, 2, 2};
  return mpm_particles_fill_box(set, low, high, per_cell, NULL, NULL);
}

static mpm_status set_walls(world *w) {
  mpm_status status = MPM_OK;
  for (int32_t face = 0; face < 2 * w->dim && !status; ++face)
    if (!w->desc.grid.periodic[face / 2])
      status = mpm_stepper_set_wall(w->stepper, face, face % 2 ? MPM_WALL_SLIP : MPM_WALL_FIXED, 0.0);
  return status;
}

mpm_status run_steps(world *w) {
  double dt;
  mpm_status status = mpm_stable_dt(w->stepper, &dt);
  for (int32_t i = 0; i < STEPS && !status; ++i)
    status = mpm_step(w->stepper, dt * (0.2 + 0.1 * (i % 3)), &w->info);
  return status;
}

/* What is played in a world that is open. */
static mpm_status play(world *w, const scene *is, outcome *found) {
  mpm_status status = is->set_up(w, is);
  w->info.struct_size = sizeof w->info;
  if (!status) status = is->run ? is->run(w, is, found) : run_steps(w);
  found->info.struct_size = sizeof found->info;
  found->parallel.struct_size = sizeof found->parallel;
  mpm_status read = mpm_stepper_info(w->stepper, &found->info);
  if (!read) read = mpm_state_hash(w->stepper, &found->hash);
  if (!read) read = mpm_stable_dt(w->stepper, &found->stable_dt);
  if (!read) read = mpm_particles_total(w->set[0], &found->total);
  if (!read) read = mpm_stepper_parallel_info(w->stepper, 0, &found->parallel);
  for (int32_t face = 0; face < 2 * w->dim && !read && found->info.step > 0; ++face)
    read = mpm_stepper_wall_reaction(w->stepper, face, found->reaction[face]);
  found->own = mpm_particles_count(w->set[0]);
  return status ? status : read;
}

void live(int32_t part, const mpm_transport *transport, void *user) {
  scene *is = user;
  outcome *found = &is->found[part];
  world w;
  memset(&w, 0, sizeof w);
  w.desc = is->desc;
  w.desc.context.transport = transport;
  found->status = world_try_open(&w);
  if (!found->status) found->status = play(&w, is, found);
  if (found->status) snprintf(found->text, sizeof found->text, "%s", mpm_last_error(w.context));
  if (world_try_close(&w) && !found->status) found->status = MPM_E_INTERNAL;
}

/* Plays the scene in one part, and then in several. */
void check_scene(const scene *is, const char *name, int32_t parts) {
  scene one = *is, many = *is;
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  live(0, NULL, &one);
  if (parts_run(parts, live, &many, &plan)) ck_abort_msg("%s, %d parts: %s", name, parts, plan.text);
  const outcome *a = &one.found[0];
  for (int32_t r = 0; r < parts; ++r) {
    const outcome *b = &many.found[r];
    if (a->status != b->status)
      ck_abort_msg("%s, part %d of %d: %s (%s) and not %s (%s)", name, r, parts, mpm_status_name(b->status),
                   b->text, mpm_status_name(a->status), a->text);
    if (a->hash != b->hash)
      ck_abort_msg("%s, part %d of %d: another state after %lld steps, %lld sorts", name, r, parts,
                   (long long)b->info.step, (long long)b->info.resorts);
    if (memcmp(&a->info, &b->info, sizeof a->info) != 0)
      ck_abort_msg(
          "%s, part %d of %d: another info: kinetic energy %.17g, %.17g; strain energy %.17g, %.17g; work "
          "%.17g, %.17g; dissipation %.17g, %.17g; active nodes %lld, %lld; removed %lld, %lld; sorts %lld, "
          "%lld",
          name, r, parts, a->info.kinetic_energy, b->info.kinetic_energy, a->info.strain_energy,
          b->info.strain_energy, a->info.external_work, b->info.external_work, a->info.dissipation,
          b->info.dissipation, (long long)a->info.active_nodes, (long long)b->info.active_nodes,
          (long long)a->info.removed, (long long)b->info.removed, (long long)a->info.resorts,
          (long long)b->info.resorts);
    if (memcmp(a->reaction, b->reaction, sizeof a->reaction) != 0)
      ck_abort_msg("%s, part %d of %d: other reactions", name, r, parts);
    ck_assert_msg(a->failed_particle == b->failed_particle, "%s, part %d of %d: particle %lld, not %lld",
                  name, r, parts, (long long)b->failed_particle, (long long)a->failed_particle);
    ck_assert_msg(a->stable_dt == b->stable_dt && a->total == b->total, "%s, part %d of %d: %g, %g", name, r,
                  parts, a->stable_dt, b->stable_dt);
  }
}

/* ---- combinations -------------------------------------------------------------------------------------- */
mpm_status set_up_combination(world *w, const scene *is) {
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

/* Blocks are 64, 16 and 6 nodes wide: a body spans several along each axis. */
static const int32_t cells_of[] = {0, 300, 56, 20};

static int32_t describe(scene *is, const combination *c) {
  if (refusal_of(c) || scheme_options[c->choice[CHOOSE_SCHEME]].scheme == MPM_NEWMARK) return 0;
  memset(is, 0, sizeof *is);
  is->desc = describe_combination(c);
  for (int32_t k = 0; k < is->desc.grid.dim; ++k) {
    is->desc.grid.cells[k] = cells_of[is->desc.grid.dim];
    is->desc.grid.spacing[k] = 1.0 / (double)is->desc.grid.cells[k];
  }
  is->set_up = set_up_combination;
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
scene scene_of(int32_t dim, int64_t cells, scene_fn set_up) {
  scene is;
  memset(&is, 0, sizeof is);
  is.desc = world_default(dim, cells, 1.0 / (double)cells);
  is.set_up = set_up;
  is.speed = 8.0;
  return is;
}

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

static mpm_status prescribe_some(mpm_particles *set) {
  const int64_t n = mpm_particles_count(set);
  int64_t *id = calloc((size_t)n + 1, sizeof *id);
  uint8_t *flags = calloc((size_t)n + 1, 2);
  mpm_status status = mpm_particles_get(set, "id", MPM_I64, 1, n, NULL, id);
  for (int64_t p = 0; p < n; ++p) flags[p] = id[p] % 7 == 0 && id[p] < 200;
  if (!status) status = mpm_particles_set(set, "prescribed", MPM_U8, 2, n, NULL, flags);
  free(id), free(flags);
  return status;
}

static mpm_status set_up_host(world *w, const scene *is) {
  mpm_status status = set_walls(w);
  if (!status) status = fill_middle(w, w->set[0], 0.2, 0.6);
  if (!status) status = fill_middle(w, w->set[1], 0.6, 0.8);
  for (int32_t m = 0; m < 2 && !status; ++m) status = set_velocities(w, w->set[m], is->speed);
  if (!status) status = prescribe_some(w->set[0]);
  return status ? status : add_callbacks(w);
}

START_TEST(host_acts) {
  static const int32_t schemes[] = {MPM_USL, MPM_USF, MPM_MUSL};
  scene is = scene_of(2, 4 * wide, set_up_host);
  is.desc.sets = 2;
  is.desc.stepper.scheme = schemes[_i % 3];
  is.desc.stepper.locking_remedy = _i / 3 % 2;
  is.desc.grid.periodic[1] = _i / 6;
  is.desc.grid.cells[1] = _i / 6 ? 4 * wide - 7 : 4 * wide; /* a period that is no multiple of a block */
  is.desc.stepper.mass_damping = _i % 2 ? 2.0 : 0.0;
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
  scene is = scene_of(2, 4 * wide, set_up_open);
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
    if (i == 4) status = prescribe_some(w->set[0]);
    if (!status) status = mpm_step(w->stepper, 0.3 * dt, &w->info);
  }
  return status;
}

START_TEST(prescribed_later) {
  scene is = scene_of(2, 2 * wide, set_up_combination);
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
  scene is = scene_of(2, 2 * wide, set_up_clumps);
  is.speed = 1 + _i;
  is.desc.grid.basis = MPM_LINEAR;
  is.desc.stepper.scheme = _i % 2 ? MPM_MUSL : MPM_USL;
  is.desc.stepper.transfer = transfers[_i % 3];
  is.desc.stepper.xpic_order = 2;
  check_scene(&is, "clumps", 2 + _i % 4);
}
END_TEST

/* More parts than blocks, one block for all, and none at all. */
static mpm_status set_up_small(world *w, const scene *is) {
  (void)is;
  return fill_middle(w, w->set[0], 0.4, 0.5);
}

START_TEST(few_blocks) {
  scene is = scene_of(2, wide, set_up_small);
  check_scene(&is, "small", MOST_PARTS);
}
END_TEST

/* A body that flies through the grid takes the blocks of all parts in turn. */
mpm_status fly(world *w, const scene *is, outcome *found) {
  (void)is, (void)found;
  mpm_advance_desc d = advance_desc(0.02);
  return mpm_advance(w->stepper, &d, &w->info);
}

START_TEST(blocks_are_cut_anew) {
  scene is = scene_of(2, 6 * wide, set_up_combination);
  is.desc.grid.periodic[0] = 1;
  is.run = fly;
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
  scene is = scene_of(2, 4 * wide, set_up_combination);
  is.desc.stepper.scheme = schemes[_i % 3];
  is.desc.stepper.locking_remedy = _i / 3;
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
  const mpm_status body = mpm_stepper_set_body(w->stepper, w->set[0], 1);
  const mpm_status refused =
      parts > 1 && !body ? mpm_step(w->stepper, 1e-5, NULL) : (mpm_status)MPM_E_UNSUPPORTED;
  int64_t bytes;
  if (refused != MPM_E_UNSUPPORTED || (parts > 1 && mpm_state_size(w->stepper, &bytes) != MPM_E_UNSUPPORTED))
    return MPM_E_INTERNAL;
  return MPM_OK;
}

START_TEST(unlike_parts) {
  scene is = scene_of(2, 2 * wide, set_up_combination);
  is.run = differ;
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  ck_assert_int_eq(parts_run(3, live, &is, &plan), 0);
  /* infos are refused as well where bodies are */
  for (int32_t r = 0; r < 3; ++r)
    ck_assert_msg(is.found[r].status == MPM_OK, "part %d: %s", r, is.found[r].text);
}
END_TEST

/* Wherever the transport fails on one part, every part returns and gives its memory back. */
START_TEST(transport_fails) {
  scene is = scene_of(2, 2 * wide, set_up_combination);
  parts_plan plan;
  int64_t calls = 0;
  for (int64_t at = 0; !at || at <= calls; at += 1 + at / 6) {
    scene run = is;
    memset(&plan, 0, sizeof plan);
    plan.fail_part = (int32_t)(at % 3);
    plan.fail_kinds = PARTS_ANY;
    plan.fail_at = at;
    const int done = parts_run(3, live, &run, &plan);
    if (!at) calls = plan.calls[0];
    ck_assert_msg(at ? done != 0 : done == 0, "call %lld of %lld: %s", (long long)at, (long long)calls,
                  plan.text);
    for (int32_t r = 0; r < 3; ++r)
      ck_assert_msg(run.found[r].status == (at ? MPM_E_CALLBACK : MPM_OK), "call %lld, part %d: %s, %s",
                    (long long)at, r, mpm_status_name(run.found[r].status), run.found[r].text);
  }
  ck_assert_int_gt(calls, 100);
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

/* Wherever memory fails on one part once its world is open, the call fails on all, and goes through when it
 * is made again. No part waits, and nothing is lost. */
typedef struct hungry {
  scene is;
  int64_t fail_at, calls; /* of part 1: the allocation that fails, from 1; how many there are */
  int32_t failed[3];      /* how many calls of each part */
  host_memory memory[3];
} hungry;

/* Tries a call until it is not for want of memory that it fails. */
#define AGAIN(h, part, status, call)                                                                         \
  do {                                                                                                       \
    (status) = (call);                                                                                       \
    (h)->failed[part] += (status) == MPM_E_NOMEM;                                                            \
  } while ((status) == MPM_E_NOMEM)

static void live_hungry(int32_t part, const mpm_transport *transport, void *user) {
  hungry *h = user;
  outcome *found = &h->is.found[part];
  world w;
  double dt;
  memset(&w, 0, sizeof w);
  w.desc = h->is.desc;
  w.desc.context.transport = transport;
  mpm_status status = world_try_open(&w);
  const int64_t opened = w.memory.calls;
  if (part == 1 && h->fail_at) w.memory.fail_at = opened + h->fail_at;
  if (!status) AGAIN(h, part, status, fill_middle(&w, w.set[0], 0.2, 0.7));
  if (!status) status = set_velocities(&w, w.set[0], h->is.speed);
  if (!status) AGAIN(h, part, status, mpm_stable_dt(w.stepper, &dt));
  for (int32_t i = 0; i < 12 && !status; ++i) AGAIN(h, part, status, mpm_step(w.stepper, 0.3 * dt, NULL));
  if (part == 1) h->calls = w.memory.calls - opened;
  w.memory.fail_at = 0;
  if (!status) status = mpm_state_hash(w.stepper, &found->hash);
  found->status = status;
  world_try_close(&w);
  h->memory[part] = w.memory;
}

START_TEST(memory_runs_out) {
  static hungry h;
  parts_plan plan;
  int64_t calls = 0;
  uint64_t hash = 0;
  for (int64_t at = 0; !at || at <= calls; at += 1 + at / 12) {
    memset(&h, 0, sizeof h);
    memset(&plan, 0, sizeof plan);
    h.is = scene_of(2, 2 * wide, set_up_combination);
    h.fail_at = at;
    ck_assert_msg(!parts_run(3, live_hungry, &h, &plan), "allocation %lld of %lld: %s", (long long)at,
                  (long long)calls, plan.text);
    if (!at) calls = h.calls, hash = h.is.found[0].hash;
    for (int32_t r = 0; r < 3; ++r) {
      ck_assert_int_eq(h.memory[r].held, 0);
      ck_assert_msg(!h.is.found[r].status && h.failed[r] == (at != 0),
                    "allocation %lld, part %d: %s, %d calls failed", (long long)at, r,
                    mpm_status_name(h.is.found[r].status), h.failed[r]);
      ck_assert_msg(h.is.found[r].hash == hash, "allocation %lld, part %d: another state", (long long)at, r);
    }
  }
  ck_assert_int_gt(calls, 20);
}
END_TEST

Suite *shared_suite(void) {
  Suite *suite = suite_create("shared");
  TCase *all = tcase_create("combinations");
  tcase_set_timeout(all, 120);
  tcase_add_unchecked_fixture(all, set_up_list, tear_down_list);
  tcase_add_loop_test(all, combinations_in_parts, 0, SAMPLE);
  suite_add_tcase(suite, all);
  TCase *host = tcase_create("host");
  tcase_set_timeout(host, 120);
  tcase_add_loop_test(host, host_acts, 0, 12);
  tcase_add_test(host, particles_come_and_go);
  tcase_add_test(host, prescribed_later);
  tcase_add_loop_test(host, light_nodes_lead, 0, 12);
  tcase_add_test(host, few_blocks);
  tcase_add_test(host, blocks_are_cut_anew);
  suite_add_tcase(suite, host);
  suite_add_tcase(suite, shared_calls_case());
  suite_add_tcase(suite, shared_balance_case());
  TCase *failures = tcase_create("failures");
  tcase_set_timeout(failures, 120);
  tcase_add_loop_test(failures, steps_fail_together, 0, 6);
  tcase_add_test(failures, unlike_parts);
  tcase_add_test(failures, transport_fails);
  tcase_add_test(failures, transport_is_checked);
  tcase_add_test(failures, transport_is_lost);
  tcase_add_test(failures, memory_runs_out);
  suite_add_tcase(suite, failures);
  return suite;
}
