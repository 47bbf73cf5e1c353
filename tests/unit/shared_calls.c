/* Calls of one part that others need not make: particles that are packed, nodes that a host adds up. */
#include "shared.h"

/* Parts pack some of their particles, take them out and in again; one gets some from elsewhere. */
static saved_state foreign;

static void pack_foreign(const world_desc *desc) {
  world w;
  const double x[] = {0.82, 0.82}, volume[] = {1e-4};
  const int64_t id[] = {200000};
  world_open(&w, desc);
  ck_ok(&w, mpm_particles_add(w.set[0], 1, x, NULL, volume, NULL, id, NULL));
  ck_ok(&w, fill_middle(&w, w.set[0], 0.75, 0.8));
  const int64_t n = mpm_particles_count(w.set[0]);
  ck_ok(&w, mpm_particles_packed_size(w.set[0], n, &foreign.bytes));
  foreign.data = malloc((size_t)foreign.bytes);
  ck_ok(&w, mpm_particles_pack(w.set[0], n, NULL, foreign.data, foreign.bytes));
  world_close(&w);
}

static mpm_status pack_own(mpm_particles *set) {
  int64_t n = mpm_particles_count(set), some = 0, bytes = 0;
  int64_t *id = calloc((size_t)n + 1, sizeof *id);
  mpm_status status = mpm_particles_get(set, "id", MPM_I64, 1, n, NULL, id);
  for (int64_t i = 0; i < n; ++i)
    if (id[i] % 5 == 0) id[some++] = id[i];
  if (!status) status = mpm_particles_packed_size(set, some, &bytes);
  void *packed = malloc((size_t)bytes + 1);
  if (!status) status = mpm_particles_pack(set, some, id, packed, bytes);
  if (!status) status = mpm_particles_remove(set, some, id);
  if (!status) status = mpm_particles_unpack(set, packed, bytes);
  free(id), free(packed);
  return status;
}

static mpm_status pack_and_unpack(world *w, const scene *is, outcome *found) {
  const double x[] = {0.15, 0.2, 0.3, 0.3}, volume[] = {1e-4, 1e-4};
  int32_t part = 0, parts = 1;
  double dt;
  (void)is, (void)found;
  mpm_context_part(w->context, &part, &parts);
  mpm_status status = mpm_stable_dt(w->stepper, &dt);
  for (int32_t i = 0; i < 16 && !status; ++i) {
    status = mpm_step(w->stepper, 0.3 * dt, &w->info);
    if (!status && i == 5) status = pack_own(w->set[0]);
    if (!status && i == 6 && part == parts - 1)
      status = mpm_particles_unpack(w->set[0], foreign.data, foreign.bytes);
    if (i == 6 || i == 9) /* the first knows of the new ids only if parts agree on what is free */
      status = mpm_particles_add(w->set[0], part ? 0 : 2 - i / 9, x, NULL, volume, NULL, NULL, NULL);
  }
  return status;
}

START_TEST(particles_are_packed) {
  scene is = scene_of(2, 4 * WIDE, set_up_body);
  is.run = pack_and_unpack;
  is.desc.grid.periodic[0] = _i % 2;
  pack_foreign(&is.desc);
  check_scene(&is, "packed", 2 + _i);
  free(foreign.data);
}
END_TEST

/* Sums of a host over nodes: each counts on one part. */
static mpm_status count_owned(void *user, const mpm_node_batch *batch, double *velocity, double *force) {
  outcome *found = user;
  (void)velocity, (void)force;
  for (int64_t i = 0; i < batch->n; ++i) found->in_hook += batch->owned[i] == 1;
  return MPM_OK;
}

static mpm_status add_owned(world *w, outcome *found) {
  static const char *const field[] = {"index", "mass", "owned"};
  mpm_view view[3];
  mpm_status status = MPM_OK;
  int32_t mapped = 0;
  for (; mapped < 3 && !status; ++mapped) {
    view[mapped] = (mpm_view){.struct_size = sizeof view[mapped]};
    status = mpm_grid_map(w->stepper, 0, field[mapped], MPM_READ, &view[mapped]);
  }
  for (int64_t i = 0; !status && i < view[0].count; ++i) {
    uint64_t mass, key = 0;
    memcpy(&mass, (const double *)view[1].data + i, sizeof mass);
    for (int32_t c = 0; c < w->dim; ++c)
      key = mixed(key + (uint64_t)((const int64_t *)view[0].data)[i + c * view[0].component_stride]);
    const uint8_t owned = ((const uint8_t *)view[2].data)[i];
    if (owned > 1 || view[2].type != MPM_U8 || view[2].components != 1) return MPM_E_INTERNAL;
    found->node_sum += owned ? mixed(key ^ mass) : 0;
    found->nodes += owned;
  }
  for (int32_t i = 0; i < mapped; ++i)
    if (view[i].data && mpm_view_release(&view[i])) status = MPM_E_INTERNAL;
  return status;
}

static mpm_status step_and_add(world *w, const scene *is, outcome *found) {
  (void)is;
  mpm_status status = mpm_stepper_set_node_hook(w->stepper, MPM_AFTER_FORCES, count_owned, found);
  if (!status) status = run_steps(w);
  if (!status) status = add_owned(w, found);
  const mpm_status dropped = mpm_stepper_set_node_hook(w->stepper, MPM_AFTER_FORCES, NULL, NULL);
  return status ? status : dropped;
}

START_TEST(nodes_are_owned_once) {
  const int32_t dim = 2 + _i % 2, parts = 2 + _i % 4;
  scene is = scene_of(dim, dim == 2 ? 3 * WIDE : 20, set_up_body), one, many;
  is.run = step_and_add;
  if (_i & 2) is.desc.grid.periodic[0] = 1, is.desc.grid.cells[0] -= 3;
  if (_i & 4) is.desc.grid.basis = MPM_LINEAR;
  one = many = is;
  parts_plan plan;
  memset(&plan, 0, sizeof plan);
  live(0, NULL, &one);
  ck_assert_msg(!parts_run(parts, live, &many, &plan), "%s", plan.text);
  uint64_t sum = 0;
  int64_t nodes = 0, in_hook = 0;
  for (int32_t r = 0; r < parts; ++r) {
    ck_assert_msg(!many.found[r].status, "part %d: %s", r, many.found[r].text);
    sum += many.found[r].node_sum, nodes += many.found[r].nodes, in_hook += many.found[r].in_hook;
  }
  ck_assert_int_gt(nodes, 100);
  ck_assert_int_eq(nodes, one.found[0].nodes);
  ck_assert_int_eq(nodes, one.found[0].info.active_nodes);
  ck_assert_int_eq(in_hook, one.found[0].in_hook);
  ck_assert_uint_eq(sum, one.found[0].node_sum);
}
END_TEST

/* ---- ids ----------------------------------------------------------------------------------------------- */
/* What a part gives: two particles with ids, or without where the first is negative; or nothing. */
static mpm_status add_some(world *w, int32_t part, const int64_t (*id)[2], int32_t count) {
  const double x[] = {0.5, 0.52, 0.5, 0.5}, volume[] = {1e-4, 1e-4};
  const int32_t gives = part < count;
  return mpm_particles_add(w->set[0], gives ? 2 : 0, x, NULL, volume, NULL,
                           gives && id[part][0] >= 0 ? id[part] : NULL, NULL);
}

/* Wants it refused on all parts, and nothing to have changed. */
static mpm_status refuse_ids(world *w, int32_t part, const int64_t (*id)[2], const char *words) {
  int64_t before, after;
  mpm_status status = mpm_particles_total(w->set[0], &before);
  const mpm_status refused = add_some(w, part, id, 3);
  const int32_t is_said = strstr(mpm_last_error(w->context), words) != NULL;
  if (refused != MPM_E_ARG || !is_said)
    fprintf(stderr, "part %d: %s, %s\n", part, mpm_status_name(refused), mpm_last_error(w->context));
  if (!status) status = mpm_particles_total(w->set[0], &after);
  return status || (refused == MPM_E_ARG && is_said && before == after) ? status : MPM_E_INTERNAL;
}

static mpm_status give_ids(world *w, const scene *is, outcome *found) {
  int32_t part = 0;
  int64_t first = 0, last;
  (void)is, (void)found;
  mpm_context_part(w->context, &part, NULL);
  mpm_status status = mpm_step(w->stepper, 1e-5, &w->info);
  if (!status) status = mpm_particles_total(w->set[0], &first);
  const int64_t twice[][2] = {{9000, 9004}, {9001, 9003}, {9002, 9003}},
                used[][2] = {{9000, first - 1}, {9001, 9003}, {9002, 9007}},
                both[][2] = {{-1, -1}, {first + 1, 9003}, {9002, 9007}},
                own[][2] = {{9000, 9001}, {9002, 9002}, {9003, 9004}},
                good[][2] = {{9000, 9007}, {-1, -1}, {20000, 9001}};
  /* ids of the fill are those below `first`: two parts do not have the last one */
  for (int32_t turn = 0; turn < 3 && !status; ++turn) {
    int64_t asked[3][2];
    for (int32_t r = 0; r < 3; ++r) memcpy(asked[r], used[(r + turn) % 3], sizeof asked[r]);
    last = mpm_particles_count(w->set[0]);
    status = refuse_ids(w, part, (const int64_t(*)[2])asked, "is in use");
    if (last != mpm_particles_count(w->set[0])) status = MPM_E_INTERNAL;
  }
  if (!status) status = refuse_ids(w, part, twice, "id 9003 is given twice");
  if (!status) status = refuse_ids(w, part, both, "is given twice");
  if (!status) status = refuse_ids(w, part, own, "id 9002 is given twice");
  if (!status) status = add_some(w, part, good, 3);
  if (!status) status = refuse_ids(w, part, good, "is in use");
  if (!status) status = mpm_step(w->stepper, 1e-5, &w->info);
  if (!status) status = mpm_particles_total(w->set[0], &last);
  return status || last == first + 6 ? status : MPM_E_INTERNAL;
}

START_TEST(ids_are_given_once) {
  scene is = scene_of(2, 2 * WIDE, set_up_body);
  is.run = give_ids;
  check_parts(&is, 3);
}
END_TEST

/* Memory that runs out on one part changes nothing on any. */
static mpm_status set_up_fewer(world *w, const scene *is) {
  const int64_t gone = 1;
  mpm_status status = set_up_body(w, is);
  if (!status && (status = mpm_particles_remove(w->set[0], 1, &gone)) == MPM_E_NOT_FOUND)
    status = MPM_OK; /* another part has it */
  return status;
}

static mpm_status add_and_step(world *w, int32_t part, int32_t number) {
  const int64_t id[][2] = {{9000, 1}, {9001, 9003}, {9002, 9007}};
  return number ? mpm_step(w->stepper, 1e-5, NULL) : add_some(w, part, id, 3);
}

START_TEST(memory_runs_out_adding) {
  static hungry h;
  memset(&h, 0, sizeof h);
  h.is = scene_of(2, 2 * WIDE, set_up_fewer);
  h.act = add_and_step;
  h.acts = 2;
  check_hunger(&h, live_hungrily);
}
END_TEST

/* Six sets, one after another, of which a part changes those that it has particles of near one side. */
static mpm_status set_up_sets(world *w, const scene *is) {
  mpm_status status = set_walls(w);
  for (int32_t m = 0; m < w->sets && !status; ++m) {
    const double low[] = {0.1 + 0.13 * m, 0.2}, high[] = {0.23 + 0.13 * m, 0.7};
    const int32_t per_cell[] = {2, 2};
    status = mpm_particles_fill_box(w->set[m], low, high, per_cell, NULL, NULL);
    if (!status) status = set_velocities(w, w->set[m], is->speed * (1.0 + m));
  }
  return status;
}

static mpm_status change_some(mpm_particles *set) {
  const int64_t n = mpm_particles_count(set);
  double *v = calloc((size_t)(4 * n) + 1, sizeof *v), *x = v + 2 * n;
  int64_t changed = 0;
  mpm_status status = mpm_particles_get(set, "velocity", MPM_F64, 2, n, NULL, v);
  if (!status) status = mpm_particles_get(set, "position", MPM_F64, 2, n, NULL, x);
  for (int64_t p = 0; p < n; ++p)
    if (x[n + p] < 0.3) v[p] *= 0.5, ++changed;
  if (!status && changed) status = mpm_particles_set(set, "velocity", MPM_F64, 2, n, NULL, v);
  free(v);
  return status;
}

static mpm_status change_in_turn(world *w, const scene *is, outcome *found) {
  double dt;
  (void)is, (void)found;
  mpm_status status = mpm_stable_dt(w->stepper, &dt);
  for (int32_t i = 0; i < 3 * w->sets && !status; ++i) {
    status = change_some(w->set[i % w->sets]);
    if (!status) status = mpm_step(w->stepper, 0.2 * dt, &w->info);
  }
  return status;
}

START_TEST(sets_are_changed) {
  scene is = scene_of(2, 4 * WIDE, set_up_sets);
  is.desc.sets = MOST_SETS;
  is.run = change_in_turn;
  is.speed = 4.0;
  ck_assert_int_eq(check_scene(&is, "six sets", 2 + _i), MPM_OK);
}
END_TEST

TCase *shared_calls_case(Suite *suite) {
  TCase *tests = tcase_create("calls");
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, particles_are_packed, 0, 4);
  tcase_add_loop_test(tests, nodes_are_owned_once, 0, 8);
  tcase_add_test(tests, ids_are_given_once);
  tcase_add_loop_test(tests, sets_are_changed, 0, 3);
  tcase_add_test(faults_case(suite, "faults of calls", 0), memory_runs_out_adding);
  return tests;
}
