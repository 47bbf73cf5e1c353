#include "shared.h"

scene scene_of(int32_t dim, int64_t cells, scene_fn set_up) {
  scene is;
  memset(&is, 0, sizeof is);
  is.desc = world_default(dim, cells, 1.0 / (double)cells);
  is.set_up = set_up;
  is.speed = 8.0;
  return is;
}

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

mpm_status set_walls(world *w) {
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

mpm_status fly_through(world *w, const scene *is, outcome *found) {
  (void)is, (void)found;
  mpm_advance_desc d = advance_desc(0.02);
  return mpm_advance(w->stepper, &d, &w->info);
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
  found->heat.struct_size = sizeof found->heat;
  if (!read && is->heat) read = mpm_stepper_heat_info(w->stepper, &found->heat);
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

/* All parts must have found what was found before. */
static void compare(const outcome *a, const scene *many, const char *name, int32_t parts) {
  for (int32_t r = 0; r < parts; ++r) {
    const outcome *b = &many->found[r];
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
    ck_assert_msg(a->markers == b->markers, "%s, part %d of %d: other markers", name, r, parts);
    if (memcmp(&a->heat, &b->heat, sizeof a->heat) != 0)
      ck_abort_msg("%s, part %d of %d: another heat: %.17g, %.17g; gained %.17g, %.17g; sources %.17g, "
                   "%.17g; walls %.17g, %.17g; dissipated %.17g, %.17g",
                   name, r, parts, a->heat.heat, b->heat.heat, a->heat.gained_total, b->heat.gained_total,
                   a->heat.sources_total, b->heat.sources_total, a->heat.walls_total[0],
                   b->heat.walls_total[0], a->heat.dissipated_total, b->heat.dissipated_total);
    if (memcmp(a->seen, b->seen, sizeof a->seen) != 0)
      ck_abort_msg("%s, part %d of %d: another pose", name, r, parts);
    for (int32_t i = 0; i < 4; ++i)
      if (memcmp(&a->contact[i], &b->contact[i], sizeof a->contact[i]) != 0)
        ck_abort_msg(
            "%s, part %d of %d: contact %d: nodes %lld, %lld; closed %lld, %lld; stuck %lld, %lld; ambiguous "
            "%lld, %lld; force %.17g, %.17g; area %.17g, %.17g; gap %.17g, %.17g; pressure %.17g, %.17g",
            name, r, parts, i, (long long)a->contact[i].nodes, (long long)b->contact[i].nodes,
            (long long)a->contact[i].closed, (long long)b->contact[i].closed, (long long)a->contact[i].stuck,
            (long long)b->contact[i].stuck, (long long)a->contact[i].ambiguous,
            (long long)b->contact[i].ambiguous, a->contact[i].normal_force, b->contact[i].normal_force,
            a->contact[i].area, b->contact[i].area, a->contact[i].gap, b->contact[i].gap,
            a->contact[i].pressure_max, b->contact[i].pressure_max);
    if (memcmp(&a->failed, &b->failed, sizeof a->failed) != 0)
      ck_abort_msg(
          "%s, part %d of %d: another failure: particle %lld, %lld; node %lld, %lld; residual %.17g, "
          "%.17g; iterations %d, %d",
          name, r, parts, (long long)a->failed.particle, (long long)b->failed.particle,
          (long long)a->failed.node, (long long)b->failed.node, a->failed.residual, b->failed.residual,
          (int)a->failed.newton_iterations, (int)b->failed.newton_iterations);
    ck_assert_msg(a->failed_particle == b->failed_particle, "%s, part %d of %d: particle %lld, not %lld",
                  name, r, parts, (long long)b->failed_particle, (long long)a->failed_particle);
    ck_assert_msg(a->stable_dt == b->stable_dt && a->total == b->total, "%s, part %d of %d: %g, %g", name, r,
                  parts, a->stable_dt, b->stable_dt);
  }
}

static void play_in_parts(scene *is, const char *name, int32_t parts) {
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  if (parts_run(parts, live, is, &plan)) ck_abort_msg("%s, %d parts: %s", name, parts, plan.text);
}

/* One part has the linear solver of several where it has a transport. */
static int32_t asks_transport(const mpm_stepper_desc *d) {
  return d->scheme == MPM_NEWMARK &&
         (d->linear_solver == MPM_SOLVER_AUTO || d->linear_solver == MPM_SOLVER_GMRES);
}

mpm_status check_scene(const scene *is, const char *name, int32_t parts) {
  scene one = *is, many = *is;
  if (asks_transport(&is->desc.stepper))
    play_in_parts(&one, name, 1);
  else
    live(0, NULL, &one);
  play_in_parts(&many, name, parts);
  compare(&one.found[0], &many, name, parts);
  return one.found[0].status;
}

void check_parts(scene *is, int32_t parts) {
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  ck_assert_msg(!parts_run(parts, live, is, &plan), "%s", plan.text);
  for (int32_t r = 0; r < parts; ++r)
    ck_assert_msg(is->found[r].status == MPM_OK, "part %d: %s", r, is->found[r].text);
}

int32_t faults_are_full(void) {
  return getenv("MPM_FULL") != NULL;
}

static int32_t next_of_all(planned *f, const int64_t *calls) {
  enum { EACH = 300, SPREAD = 150 };
  const int64_t more = calls[f->part] - EACH;
  f->at += f->at < EACH || more < SPREAD ? 1 : 1 + more / SPREAD;
  while (f->part < FAULTY && f->at > calls[f->part]) ++f->part, f->at = 1;
  return f->part < FAULTY;
}

static int32_t next_of_some(planned *f, int64_t density, const int64_t *calls) {
  int64_t most = 0;
  for (int32_t r = 0; r < FAULTY; ++r)
    if (most < calls[r]) most = calls[r];
  do {
    f->at += 1 + f->at / density;
    f->part = (int32_t)(f->at % FAULTY);
  } while (f->at <= most && f->at > calls[f->part]);
  return f->at <= most;
}

int32_t next_fault(planned *f, int64_t density, const int64_t *calls) {
  const int32_t is_one = faults_are_full() ? next_of_all(f, calls) : next_of_some(f, density, calls);
  f->tried += is_one;
  return is_one;
}

void tell_faults(const planned *f, const char *what) {
  if (faults_are_full()) fprintf(stderr, "%lld faults of %s\n", (long long)f->tried, what);
}

void check_lost_transport(const scene *is, int64_t density, int64_t least) {
  parts_plan plan;
  int64_t calls[FAULTY];
  planned f = {0};
  do {
    scene run = *is;
    memset(&plan, 0, sizeof plan);
    plan.fail_part = f.part;
    plan.fail_kinds = PARTS_ANY;
    plan.fail_at = f.at;
    const int done = parts_run(FAULTY, live, &run, &plan);
    if (!f.at) memcpy(calls, plan.calls, sizeof calls);
    ck_assert_msg(f.at ? done != 0 : done == 0, "call %lld of part %d: %s", (long long)f.at, (int)f.part,
                  plan.text);
    for (int32_t r = 0; r < FAULTY; ++r)
      ck_assert_msg(run.found[r].status == (f.at ? MPM_E_CALLBACK : MPM_OK),
                    "call %lld of part %d, part %d: %s, %s", (long long)f.at, (int)f.part, r,
                    mpm_status_name(run.found[r].status), run.found[r].text);
  } while (next_fault(&f, density, calls));
  ck_assert_int_gt(calls[0], least);
  tell_faults(&f, "the transport");
}

void check_hunger(const hungry *as, parts_fn lives) {
  static hungry h;
  parts_plan plan;
  int64_t calls[FAULTY];
  uint64_t hash = 0;
  planned f = {0};
  do {
    h = *as;
    memset(&plan, 0, sizeof plan);
    h.fault = f;
    const long long at = f.at;
    const int part = f.part;
    ck_assert_msg(!parts_run(FAULTY, lives, &h, &plan), "allocation %lld of part %d: %s", at, part,
                  plan.text);
    if (!f.at) {
      memcpy(calls, h.calls, sizeof calls);
      hash = h.is.found[0].hash;
    }
    for (int32_t r = 0; r < FAULTY; ++r) {
      ck_assert_int_eq(h.memory[r].held, 0);
      ck_assert_msg(!h.is.found[r].status && h.failed[r] == (f.at != 0),
                    "allocation %lld of part %d, part %d: %s, %d calls failed", at, part, r,
                    mpm_status_name(h.is.found[r].status), h.failed[r]);
      ck_assert_msg(h.is.found[r].hash == hash, "allocation %lld of part %d, part %d: another state", at,
                    part, r);
    }
  } while (next_fault(&f, 12, calls));
  ck_assert_int_gt(calls[1], 20);
  tell_faults(&f, "memory");
}

void begin_hunger(const hungry *h, world *w, int32_t part, int64_t before) {
  if (part == h->fault.part && h->fault.at) w->memory.fail_at = before + h->fault.at;
}

void end_hunger(hungry *h, world *w, int32_t part, int64_t before) {
  h->calls[part] = w->memory.calls - before;
  w->memory.fail_at = 0;
}

mpm_status save_and_load(world *w) {
  int64_t bytes = 0;
  mpm_status status = mpm_state_size(w->stepper, &bytes);
  void *state = malloc((size_t)bytes + 1);
  const void *piece[] = {state};
  if (!status) status = mpm_state_save(w->stepper, state, bytes);
  if (!status) status = mpm_state_load_pieces(w->stepper, 1, piece, &bytes);
  free(state);
  return status;
}

void live_hungrily(int32_t part, const mpm_transport *transport, void *user) {
  hungry *h = user;
  world w;
  memset(&w, 0, sizeof w);
  w.desc = h->is.desc;
  w.desc.context.transport = transport;
  mpm_status status = world_try_open(&w);
  if (!status) status = h->is.set_up(&w, &h->is);
  const int64_t before = w.memory.calls;
  begin_hunger(h, &w, part, before);
  for (int32_t i = 0; i < h->acts && !status; ++i) {
    status = h->act(&w, part, i);
    if (status != MPM_E_NOMEM) continue;
    ++h->failed[part];
    status = h->act(&w, part, i);
  }
  end_hunger(h, &w, part, before);
  if (!status) status = mpm_state_hash(w.stepper, &h->is.found[part].hash);
  h->is.found[part].status = status;
  world_try_close(&w);
  h->memory[part] = w.memory;
}

TCase *faults_case(Suite *suite, const char *name, int32_t wide) {
  TCase *faults = tcase_create(name);
  tcase_set_tags(faults, wide ? "wide faults" : "faults");
  tcase_set_timeout(faults, faults_are_full() ? 3600 : 300);
  suite_add_tcase(suite, faults);
  return faults;
}
