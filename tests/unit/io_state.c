/* States in memory: what is loaded is what was saved, and goes on with the same bits. */
#include "io_world.h"

enum { FIRST_STEPS = 14, MORE_STEPS = 12 };

static const io_setup setups[] = {{1, MPM_FLIP, MPM_USL, 0, 1, 0, 0},     {2, MPM_FLIP, MPM_USL, 0, 1, 0, 0},
                                  {3, MPM_FLIP, MPM_USL, 0, 1, 0, 0},     {1, MPM_APIC, MPM_USL, 1, 1, 1, 0},
                                  {2, MPM_APIC_MLS, MPM_USL, 1, 2, 1, 0}, {3, MPM_APIC, MPM_MUSL, 1, 3, 0, 0},
                                  {2, MPM_FLIP, MPM_MUSL, 1, 1, 1, 0}};
enum { SETUPS = sizeof setups / sizeof *setups };

static void same_bytes(const io_buffer *a, const io_buffer *b) {
  ck_assert_int_eq(a->bytes, b->bytes);
  for (int64_t i = 0; i < a->bytes; ++i)
    if (a->data[i] != b->data[i])
      ck_abort_msg("byte %lld of %lld differs", (long long)i, (long long)a->bytes);
}

static void same_info(const io_world *a, const io_world *b) {
  mpm_step_info x = {.struct_size = sizeof x}, y = {.struct_size = sizeof y};
  ck_ok(mpm_stepper_info(a->stepper, &x));
  ck_ok(mpm_stepper_info(b->stepper, &y));
  ck_assert_mem_eq(&x, &y, sizeof x);
}

/* One world runs on; another loads what the first had saved, at every step. */
START_TEST(goes_on_with_the_same_bits) {
  const io_setup *setup = &setups[_i];
  int32_t sorted = 0, unsorted = 0;
  for (int32_t first = 0; first < FIRST_STEPS; ++first) {
    io_setup other = *setup;
    other.empty = first % 2; /* sets that are loaded may hold something or not */
    other.concurrency = 1 + first % 3;
    io_world a, b;
    io_open(&a, setup);
    io_open(&b, &other);
    if (!other.empty) io_steps(&b, first / 2);
    io_steps(&a, first);
    const io_buffer saved = io_save(&a);
    const uint64_t hash = io_hash(&a);
    io_load(&b, &saved);
    ck_assert_uint_eq(io_hash(&b), hash);
    same_info(&a, &b);
    if (mpmi_state_is_sorted(a.stepper)) {
      ++sorted;
      const io_buffer again = io_save(&b);
      same_bytes(&saved, &again);
      free(again.data);
    } else {
      ++unsorted;
    }
    for (int32_t i = 0; i < MORE_STEPS; ++i) {
      io_steps(&a, 1);
      io_steps(&b, 1);
      ck_assert_uint_eq(io_hash(&a), io_hash(&b));
      same_info(&a, &b);
    }
    const io_buffer end_a = io_save(&a), end_b = io_save(&b);
    same_bytes(&end_a, &end_b);
    free(saved.data);
    free(end_a.data);
    free(end_b.data);
    io_close(&a);
    io_close(&b);
  }
  ck_assert_int_gt(sorted, 0);
  ck_assert_int_gt(unsorted, 0);
}
END_TEST

/* Every field by id, holes, ids and the next id. */
START_TEST(keeps_every_field) {
  const io_setup setup = {_i, MPM_FLIP, MPM_USL, 1, 1, 1, 0};
  io_world a, b;
  io_open(&a, &setup);
  io_open(&b, &setup);
  const double push[] = {1.0, 2.0, 3.0};
  const int64_t gone[] = {3, 0};
  ck_ok(mpm_particles_set_all(a.set[0], "applied_force", MPM_F64, setup.dim, push));
  io_steps(&a, 3);
  ck_ok(mpm_particles_remove(a.set[1], 2, gone));
  io_steps(&a, 1);
  ck_ok(mpm_particles_set_all(b.set[0], "acceleration", MPM_F64, setup.dim, push));
  const io_buffer saved = io_save(&a);
  io_load(&b, &saved);
  for (int32_t m = 0; m < WORLD_SETS; ++m) {
    const mpm_particles *x = a.set[m], *y = b.set[m];
    ck_assert_int_eq(x->count, y->count);
    ck_assert_int_eq(x->slots, y->slots);
    ck_assert_int_eq(x->next_id, y->next_id);
    ck_assert_double_eq(x->mass_max, y->mass_max);
    for (int32_t f = 0; f < x->field_count; ++f) {
      const mpmi_field *p = &x->field[f], *q = &y->field[f];
      ck_assert_int_eq(p->present, q->present);
      const size_t size = mpmi_type_size(p->type);
      for (int32_t c = 0; c < p->components && p->present; ++c)
        ck_assert_mem_eq((char *)p->data[0] + (size_t)(c * x->ld) * size,
                         (char *)q->data[0] + (size_t)(c * y->ld) * size, (size_t)x->slots * size);
      if (p->two_copies && p->present) ck_assert_ptr_nonnull(q->data[1]);
    }
  }
  ck_assert_int_eq(b.set[0]->field[MPMI_ACCELERATION].present, 0);
  ck_assert_int_eq(b.set[0]->field[MPMI_APPLIED_FORCE].present, 1);
  io_steps(&a, MORE_STEPS);
  io_steps(&b, MORE_STEPS);
  ck_assert_uint_eq(io_hash(&a), io_hash(&b));
  /* sets that are added to after loading number on alike */
  const double x[] = {0.0, 0.0, 0.0}, volume = 0.1;
  int64_t id_a = -1, id_b = -2;
  ck_ok(mpm_particles_add(a.set[1], 1, x, NULL, &volume, NULL, NULL, &id_a));
  ck_ok(mpm_particles_add(b.set[1], 1, x, NULL, &volume, NULL, NULL, &id_b));
  ck_assert_int_eq(id_a, id_b);
  io_steps(&a, 2);
  io_steps(&b, 2);
  ck_assert_uint_eq(io_hash(&a), io_hash(&b));
  free(saved.data);
  io_close(&a);
  io_close(&b);
}
END_TEST

/* The fields of the host may have been added in another order. */
START_TEST(host_fields_in_any_order) {
  const io_setup setup = io_plain(2);
  const mpm_grid_desc grid = io_grid(&setup);
  io_world a, b;
  io_open(&a, &setup);
  io_open_context(&b, 1);
  ck_ok(mpm_grid_create(b.f.context, &grid, &b.f.grid));
  io_open_sets(&b);
  ck_ok(mpm_particles_add_field(b.set[0], "temperature", MPM_F64, 1));
  ck_ok(mpm_particles_add_field(b.set[0], "colour", MPM_U8, 3));
  ck_ok(mpm_particles_add_field(b.set[1], "grain", MPM_I64, 2));
  io_open_stepper(&b, &setup);
  io_steps(&a, 3);
  const io_buffer saved = io_save(&a);
  io_load(&b, &saved);
  ck_assert_uint_eq(io_hash(&a), io_hash(&b));
  free(saved.data);
  io_close(&a);
  io_close(&b);
}
END_TEST

static void check_mismatch(const io_buffer *saved, const io_setup *setup, const mpm_grid_desc *grid,
                           int32_t fields, const char *text) {
  io_world w;
  io_open_context(&w, 1);
  ck_ok(mpm_grid_create(w.f.context, grid, &w.f.grid));
  io_open_sets(&w);
  if (fields == 0) io_add_fields(&w);
  if (fields == 1) ck_ok(mpm_particles_add_field(w.set[0], "colour", MPM_U8, 3)); /* and no temperature */
  if (fields >= 2) {
    ck_ok(mpm_particles_add_field(w.set[0], "colour", MPM_U8, fields == 2 ? 4 : 3));
    ck_ok(mpm_particles_add_field(w.set[0], "temperature", fields == 3 ? MPM_I64 : MPM_F64, 1));
    ck_ok(mpm_particles_add_field(w.set[1], "grain", MPM_I64, 2));
  }
  if (fields == 4) ck_ok(mpm_particles_add_field(w.set[1], "extra", MPM_I64, 2));
  io_open_stepper(&w, setup);
  const uint64_t before = io_hash(&w);
  ck_refused(w.f.context, mpm_state_load(w.stepper, saved->data, saved->bytes), MPM_E_FORMAT, text);
  ck_assert_uint_eq(io_hash(&w), before);
  io_close(&w);
}

START_TEST(unlike_setups_are_named) {
  const io_setup setup = io_plain(2);
  const mpm_grid_desc grid = io_grid(&setup);
  io_world a;
  io_open(&a, &setup);
  const io_buffer saved = io_save(&a);
  io_close(&a);
  io_setup s = io_plain(3);
  mpm_grid_desc g = io_grid(&s);
  check_mismatch(&saved, &s, &g, 0, "dim is 2 there, 3 here");
  s = setup;
  g = grid;
  g.basis = MPM_LINEAR;
  check_mismatch(&saved, &s, &g, 0, "basis is 2 there, 1 here");
  g = grid;
  g.cells[1] = 11;
  check_mismatch(&saved, &s, &g, 0, "cells[1] is 9 there, 11 here");
  g = grid;
  g.spacing[0] = 0.75;
  check_mismatch(&saved, &s, &g, 0, "spacing[0] is 0.5 there, 0.75 here");
  g = grid;
  g.origin[1] = -2.0;
  check_mismatch(&saved, &s, &g, 0, "origin[1] is -1 there, -2 here");
  g = grid;
  g.periodic[0] = s.periodic = 1;
  check_mismatch(&saved, &s, &g, 0, "periodic[0] is 0 there, 1 here");
  s = setup;
  s.scheme = MPM_MUSL;
  check_mismatch(&saved, &s, &grid, 0, "scheme is 1 there, 3 here");
  s = setup;
  s.transfer = MPM_APIC;
  check_mismatch(&saved, &s, &grid, 0, "transfer is 1 there, 2 here");
  s = setup;
  s.references = 1;
  check_mismatch(&saved, &s, &grid, 0, "reference_positions is 0 there, 1 here");
  check_mismatch(&saved, &setup, &grid, 1, "set 0: field \"temperature\" is there, but not here");
  check_mismatch(&saved, &setup, &grid, 2, "set 0: number of components of colour is 3 there, 4 here");
  check_mismatch(&saved, &setup, &grid, 3, "set 0: type of temperature is 1 there, 2 here");
  check_mismatch(&saved, &setup, &grid, 4, "set 1: field \"extra\" is here, but not there");
  free(saved.data);
}
END_TEST

static mpm_status some_stress(void *user, const mpm_material_batch *b) {
  (void)user;
  for (int32_t c = 0; c < 6; ++c)
    for (int64_t i = 0; i < b->n; ++i) b->stress_new[c * b->ld + i] = 0.0;
  for (int64_t i = 0; i < b->n; ++i) b->wave_speed[i] = 1.0;
  for (int64_t i = 0; i < b->n * b->state_count; ++i) b->state_new[i] = 0.0;
  return MPM_OK;
}

/* One set of the given law in a stepper of its own. */
static void open_single(io_world *w, const char *model, double young, int32_t state_count, int32_t sets) {
  const io_setup setup = io_plain(1);
  const mpm_grid_desc grid = io_grid(&setup);
  const mpm_param params[] = {{"E", young}, {"nu", 0.3}, {"density", 2e3}};
  const mpm_stepper_desc desc = io_stepper_desc(&setup);
  mpm_material_desc custom;
  ck_ok(mpm_material_desc_init(&custom, sizeof custom));
  custom.density = 2e3;
  custom.stress = some_stress;
  custom.state_count = state_count;
  io_open_context(w, 1);
  ck_ok(mpm_grid_create(w->f.context, &grid, &w->f.grid));
  if (model)
    ck_ok(mpm_material_create(w->f.context, model, params, 3, &w->material[0]));
  else
    ck_ok(mpm_material_create_custom(w->f.context, &custom, &w->material[0]));
  w->material[1] = NULL;
  for (int32_t m = 0; m < WORLD_SETS; ++m)
    ck_ok(mpm_particles_create(w->f.context, w->f.grid, w->material[0], &w->set[m]));
  ck_ok(mpm_stepper_create(w->f.context, w->f.grid, &desc, &w->stepper));
  for (int32_t m = 0; m < sets; ++m) ck_ok(mpm_stepper_add(w->stepper, w->set[m]));
}

START_TEST(unlike_laws_are_named) {
  static const struct {
    const char *model;
    double young;
    int32_t state_count, sets;
    const char *text;
  } other[] = {{"neo_hookean", 2e6, 0, 1, "set 0: E is 1000000 there, 2000000 here"},
               {"linear_elastic", 1e6, 0, 1, "set 0: law is \"neo_hookean\" there, \"linear_elastic\" here"},
               {NULL, 0, 2, 1, "set 0: law is \"neo_hookean\" there, \"custom\" here"},
               {"neo_hookean", 1e6, 0, 2, "number of sets is 1 there, 2 here"},
               {"neo_hookean", 1e6, 0, 0, "number of sets is 1 there, 0 here"}};
  io_world a, b;
  open_single(&a, "neo_hookean", 1e6, 0, 1);
  io_buffer saved = io_save(&a);
  for (size_t i = 0; i < sizeof other / sizeof *other; ++i) {
    open_single(&b, other[i].model, other[i].young, other[i].state_count, other[i].sets);
    ck_refused(b.f.context, mpm_state_load(b.stepper, saved.data, saved.bytes), MPM_E_FORMAT, other[i].text);
    io_close(&b);
  }
  free(saved.data);
  io_close(&a);
  open_single(&a, NULL, 0, 2, 1);
  open_single(&b, NULL, 0, 3, 1);
  saved = io_save(&a);
  ck_refused(b.f.context, mpm_state_load(b.stepper, saved.data, saved.bytes), MPM_E_FORMAT,
             "set 0: state_count is 2 there, 3 here");
  free(saved.data);
  io_close(&a);
  io_close(&b);
}
END_TEST

START_TEST(views_and_staged_steps_bar_it) {
  const io_setup setup = io_plain(2);
  io_world w;
  io_open(&w, &setup);
  io_steps(&w, 1);
  const io_buffer saved = io_save(&w);
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(mpm_particles_map(w.set[1], "velocity", MPM_READ, &view));
  ck_ok(mpm_state_save(w.stepper, saved.data, saved.bytes));
  ck_refused(w.f.context, mpm_state_load(w.stepper, saved.data, saved.bytes), MPM_E_STATE, "set 1");
  ck_ok(mpm_view_release(&view));
  ck_ok(mpm_particles_map(w.set[1], "velocity", MPM_WRITE, &view));
  ck_refused(w.f.context, mpm_state_save(w.stepper, saved.data, saved.bytes), MPM_E_STATE,
             "velocity of set 1");
  ((double *)view.data)[0] = (double)NAN;
  ck_assert_int_eq(mpm_view_release(&view), MPM_E_ARG);
  ck_refused(w.f.context, mpm_state_save(w.stepper, saved.data, saved.bytes), MPM_E_STATE, "velocity");
  io_load(&w, &saved); /* which repairs it */
  int64_t bytes;
  ck_ok(mpm_step_begin(w.stepper, 1e-3));
  ck_refused(w.f.context, mpm_state_size(w.stepper, &bytes), MPM_E_STATE, "step");
  ck_refused(w.f.context, mpm_state_save(w.stepper, saved.data, saved.bytes), MPM_E_STATE, "step");
  ck_refused(w.f.context, mpm_state_load(w.stepper, saved.data, saved.bytes), MPM_E_STATE, "step");
  ck_ok(mpm_step_abort(w.stepper));
  ck_ok(mpm_grid_map(w.stepper, 0, "mass", MPM_READ, &view));
  ck_refused(w.f.context, mpm_state_load(w.stepper, saved.data, saved.bytes), MPM_E_STATE, "nodal");
  ck_ok(mpm_view_release(&view));
  free(saved.data);
  io_close(&w);
}
END_TEST

START_TEST(misuse) {
  const io_setup setup = io_plain(1);
  io_world w;
  io_open(&w, &setup);
  io_buffer saved = io_save(&w);
  mpm_context *c = w.f.context;
  uint64_t hash;
  ck_assert_int_eq(mpm_state_size(NULL, &saved.bytes), MPM_E_ARG);
  ck_assert_int_eq(mpm_state_save(NULL, saved.data, saved.bytes), MPM_E_ARG);
  ck_assert_int_eq(mpm_state_load(NULL, saved.data, saved.bytes), MPM_E_ARG);
  ck_assert_int_eq(mpm_state_hash(NULL, &hash), MPM_E_ARG);
  ck_assert_int_eq(mpm_state_save_file(NULL, "x"), MPM_E_ARG);
  ck_assert_int_eq(mpm_state_load_file((mpm_stepper *)w.set[0], "x"), MPM_E_ARG);
  ck_refused(c, mpm_state_size(w.stepper, NULL), MPM_E_ARG, "bytes");
  ck_refused(c, mpm_state_hash(w.stepper, NULL), MPM_E_ARG, "hash");
  ck_refused(c, mpm_state_save(w.stepper, NULL, 100), MPM_E_ARG, "buffer");
  ck_refused(c, mpm_state_load(w.stepper, NULL, 100), MPM_E_ARG, "buffer");
  ck_refused(c, mpm_state_load(w.stepper, saved.data, -1), MPM_E_ARG, "bytes is -1");
  ck_refused(c, mpm_state_save(w.stepper, saved.data, saved.bytes - 1), MPM_E_ARG, "capacity");
  ck_refused(c, mpm_state_save(w.stepper, saved.data, -1), MPM_E_ARG, "capacity is -1");
  free(saved.data);
  io_close(&w);
}
END_TEST

/* Nothing changes when memory runs out while loading, wherever that happens. */
START_TEST(every_failing_allocation) {
  const io_setup setup = io_plain(_i);
  io_world a, b, twin;
  io_open(&a, &setup);
  io_steps(&a, 13);
  const io_buffer saved = io_save(&a);
  io_open(&b, &setup);
  io_open(&twin, &setup);
  io_steps(&b, 2);
  io_steps(&twin, 2);
  const uint64_t before = io_hash(&b);
  mpm_status status = MPM_E_NOMEM;
  int32_t failures = 0;
  for (int64_t k = 1; status; ++k, ++failures) {
    const int64_t held = b.f.context->bytes;
    b.f.calls = 0;
    b.f.fail_at = k;
    status = mpm_state_load(b.stepper, saved.data, saved.bytes);
    b.f.fail_at = 0;
    if (!status) break;
    ck_assert_int_eq(status, MPM_E_NOMEM);
    ck_assert_uint_eq(io_hash(&b), before);
    ck_assert_int_le(b.f.context->bytes, held + saved.bytes); /* spare capacity may stay */
    if (k % 4) continue;
    io_steps(&b, 1); /* it goes on as if nothing had been tried */
    io_steps(&twin, 1);
    ck_assert_uint_eq(io_hash(&b), io_hash(&twin));
    io_close(&b);
    io_close(&twin);
    io_open(&b, &setup);
    io_open(&twin, &setup);
    io_steps(&b, 2);
    io_steps(&twin, 2);
  }
  ck_assert_int_gt(failures, 20);
  ck_assert_uint_eq(io_hash(&b), io_hash(&a));
  io_steps(&a, 3);
  io_steps(&b, 3);
  ck_assert_uint_eq(io_hash(&b), io_hash(&a));
  free(saved.data);
  io_close(&a);
  io_close(&b);
  io_close(&twin);
}
END_TEST

TCase *io_state_case(void) {
  TCase *tests = tcase_create("states");
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, goes_on_with_the_same_bits, 0, SETUPS);
  tcase_add_loop_test(tests, keeps_every_field, 1, 4);
  tcase_add_test(tests, host_fields_in_any_order);
  tcase_add_test(tests, unlike_setups_are_named);
  tcase_add_test(tests, unlike_laws_are_named);
  tcase_add_test(tests, views_and_staged_steps_bar_it);
  tcase_add_test(tests, misuse);
  tcase_add_loop_test(tests, every_failing_allocation, 1, 4);
  return tests;
}
