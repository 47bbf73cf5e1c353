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
    const int32_t was_sorted = mpmi_state_is_sorted(a.stepper);
    const io_buffer saved = io_save(&a);
    const uint64_t hash = io_hash(&a);
    io_load(&b, &saved);
    ck_assert_uint_eq(io_hash(&b), hash);
    if (was_sorted) {
      ++sorted;
      const io_buffer again = io_save(&b);
      same_bytes(&saved, &again);
      free(again.data);
    } else {
      ++unsorted;
    }
    same_info(&a, &b);
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
  io_steps(&w, 1);
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

/* A world that is smaller than what it is to load, so that everything has to grow. */
static void open_lone(io_world *w, int32_t dim) {
  io_setup setup = io_plain(dim);
  setup.empty = 1;
  io_open(w, &setup);
  const double x[] = {0.3, 0.3, 0.3}, v[] = {1.0, 0.0, 0.0}, volume = 0.1;
  for (int32_t m = 0; m < WORLD_SETS; ++m)
    ck_ok(mpm_particles_add(w->set[m], 1, x, v, &volume, NULL, NULL, NULL));
  io_steps(w, 2);
}

/* Nothing changes when memory runs out while loading, wherever that happens: stepping goes on as if it had
 * not been tried. */
START_TEST(every_failing_allocation) {
  const io_setup setup = io_plain(_i);
  io_world a, b, twin;
  io_open(&a, &setup);
  io_steps(&a, 13);
  const io_buffer saved = io_save(&a);
  mpm_status status = MPM_E_NOMEM;
  for (int64_t k = 1; status; ++k) {
    open_lone(&b, _i);
    open_lone(&twin, _i);
    const uint64_t before = io_hash(&b);
    b.f.calls = 0;
    b.f.fail_at = k;
    status = mpm_state_load(b.stepper, saved.data, saved.bytes);
    b.f.fail_at = 0;
    if (status) {
      ck_assert_int_eq(status, MPM_E_NOMEM);
      ck_assert_uint_eq(io_hash(&b), before);
      io_steps(&b, 2);
      io_steps(&twin, 2);
      ck_assert_uint_eq(io_hash(&b), io_hash(&twin));
    } else {
      ck_assert_int_gt(k, 40);
      ck_assert_uint_eq(io_hash(&b), io_hash(&a));
      io_steps(&a, 3);
      io_steps(&b, 3);
      ck_assert_uint_eq(io_hash(&b), io_hash(&a));
    }
    io_close(&b);
    io_close(&twin);
  }
  free(saved.data);
  io_close(&a);
}
END_TEST

TCase *io_state_case(void) {
  TCase *tests = tcase_create("states");
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, goes_on_with_the_same_bits, 0, SETUPS);
  tcase_add_loop_test(tests, keeps_every_field, 1, 4);
  tcase_add_test(tests, host_fields_in_any_order);
  tcase_add_test(tests, views_and_staged_steps_bar_it);
  tcase_add_test(tests, misuse);
  tcase_add_loop_test(tests, every_failing_allocation, 1, 4);
  return tests;
}
