/* States in memory: what is loaded is what was saved, and goes on with the same bits. */
#include "io.h"
#include "old_format.h"

enum { FIRST_STEPS = 14, MORE_STEPS = 12 };

static const io_setup setups[] = {{1, MPM_FLIP, MPM_USL, 0, 1, 0, 0},     {2, MPM_FLIP, MPM_USL, 0, 1, 0, 0},
                                  {3, MPM_FLIP, MPM_USL, 0, 1, 0, 0},     {1, MPM_APIC, MPM_USL, 1, 1, 1, 0},
                                  {2, MPM_APIC_MLS, MPM_USL, 1, 2, 1, 0}, {3, MPM_APIC, MPM_MUSL, 1, 3, 0, 0},
                                  {2, MPM_FLIP, MPM_MUSL, 1, 1, 1, 0}};
enum { SETUPS = sizeof setups / sizeof *setups };

static void same_bytes(const saved_state *a, const saved_state *b) {
  ck_assert_int_eq(a->bytes, b->bytes);
  for (int64_t i = 0; i < a->bytes; ++i)
    if (a->data[i] != b->data[i])
      ck_abort_msg("byte %lld of %lld differs", (long long)i, (long long)a->bytes);
}

/* One world runs on; another loads what the first had saved, at every step. */
START_TEST(goes_on_with_the_same_bits) {
  const io_setup *setup = &setups[_i];
  int32_t sorted = 0, unsorted = 0;
  for (int32_t first = 0; first < FIRST_STEPS; ++first) {
    io_setup other = *setup;
    other.empty = first % 2; /* sets that are loaded may hold something or not */
    other.concurrency = 1 + first % 3;
    world a, b;
    io_open(&a, setup);
    io_open(&b, &other);
    if (!other.empty) world_steps(&b, first / 2);
    world_steps(&a, first);
    const int32_t was_sorted = mpmi_state_is_sorted(a.stepper);
    const saved_state saved = world_save(&a);
    const uint64_t hash = world_hash(&a);
    world_load(&b, &saved);
    ck_assert_uint_eq(world_hash(&b), hash);
    if (was_sorted) {
      ++sorted;
      const saved_state again = world_save(&b);
      same_bytes(&saved, &again);
      free(again.data);
    } else {
      ++unsorted;
    }
    same_info(&a, &b);
    for (int32_t i = 0; i < MORE_STEPS; ++i) {
      world_steps(&a, 1);
      world_steps(&b, 1);
      ck_assert_uint_eq(world_hash(&a), world_hash(&b));
      same_info(&a, &b);
    }
    const saved_state end_a = world_save(&a), end_b = world_save(&b);
    same_bytes(&end_a, &end_b);
    free(saved.data);
    free(end_a.data);
    free(end_b.data);
    world_close(&a);
    world_close(&b);
  }
  ck_assert_int_gt(sorted, 0);
  ck_assert_int_gt(unsorted, 0);
}
END_TEST

/* Every field by id, holes, ids and the next id. */
START_TEST(keeps_every_field) {
  const io_setup setup = {_i, MPM_FLIP, MPM_USL, 1, 1, 1, 0};
  world a, b;
  io_open(&a, &setup);
  io_open(&b, &setup);
  const double push[] = {1.0, 2.0, 3.0};
  const int64_t gone[] = {3, 0};
  ck_ok(&a, mpm_particles_set_all(a.set[0], "applied_force", MPM_F64, setup.dim, push));
  world_steps(&a, 3);
  ck_ok(&a, mpm_particles_remove(a.set[1], 2, gone));
  world_steps(&a, 1);
  ck_ok(&b, mpm_particles_set_all(b.set[0], "acceleration", MPM_F64, setup.dim, push));
  const saved_state saved = world_save(&a);
  world_load(&b, &saved);
  for (int32_t m = 0; m < 2; ++m) {
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
  world_steps(&a, MORE_STEPS);
  world_steps(&b, MORE_STEPS);
  ck_assert_uint_eq(world_hash(&a), world_hash(&b));
  /* sets that are added to after loading number on alike */
  const double x[] = {0.0, 0.0, 0.0}, volume = 0.1;
  int64_t id_a = -1, id_b = -2;
  ck_ok(&a, mpm_particles_add(a.set[1], 1, x, NULL, &volume, NULL, NULL, &id_a));
  ck_ok(&b, mpm_particles_add(b.set[1], 1, x, NULL, &volume, NULL, NULL, &id_b));
  ck_assert_int_eq(id_a, id_b);
  world_steps(&a, 2);
  world_steps(&b, 2);
  ck_assert_uint_eq(world_hash(&a), world_hash(&b));
  free(saved.data);
  world_close(&a);
  world_close(&b);
}
END_TEST

static mpm_status add_in_other_order(world *w, int32_t m) {
  if (m) return mpm_particles_add_field(w->set[1], "grain", MPM_I64, 2);
  const mpm_status status = mpm_particles_add_field(w->set[0], "temperature", MPM_F64, 1);
  return status ? status : mpm_particles_add_field(w->set[0], "colour", MPM_U8, 3);
}

/* The fields of the host may have been added in another order. */
START_TEST(host_fields_in_any_order) {
  static const fill_fn other[] = {add_in_other_order, NULL};
  const io_setup setup = io_plain(2);
  world_desc d = io_desc(&setup);
  world a, b;
  world_open(&a, &d);
  d.fill = other;
  world_open(&b, &d);
  world_steps(&a, 3);
  const saved_state saved = world_save(&a);
  world_load(&b, &saved);
  ck_assert_uint_eq(world_hash(&a), world_hash(&b));
  free(saved.data);
  world_close(&a);
  world_close(&b);
}
END_TEST

START_TEST(views_and_staged_steps_bar_it) {
  const io_setup setup = io_plain(2);
  world w;
  io_open(&w, &setup);
  world_steps(&w, 1);
  const saved_state saved = world_save(&w);
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(&w, mpm_particles_map(w.set[1], "velocity", MPM_READ, &view));
  ck_ok(&w, mpm_state_save(w.stepper, saved.data, saved.bytes));
  ck_refused(&w, mpm_state_load(w.stepper, saved.data, saved.bytes), MPM_E_STATE, "set 1");
  ck_ok(&w, mpm_view_release(&view));
  ck_ok(&w, mpm_particles_map(w.set[1], "velocity", MPM_WRITE, &view));
  ck_refused(&w, mpm_state_save(w.stepper, saved.data, saved.bytes), MPM_E_STATE, "velocity of set 1");
  ((double *)view.data)[0] = (double)NAN;
  ck_assert_int_eq(mpm_view_release(&view), MPM_E_ARG);
  ck_refused(&w, mpm_state_save(w.stepper, saved.data, saved.bytes), MPM_E_STATE, "velocity");
  world_load(&w, &saved); /* which repairs it */
  int64_t bytes;
  ck_ok(&w, mpm_step_begin(w.stepper, 1e-3));
  ck_refused(&w, mpm_state_size(w.stepper, &bytes), MPM_E_STATE, "step");
  ck_refused(&w, mpm_state_save(w.stepper, saved.data, saved.bytes), MPM_E_STATE, "step");
  ck_refused(&w, mpm_state_load(w.stepper, saved.data, saved.bytes), MPM_E_STATE, "step");
  ck_ok(&w, mpm_step_abort(w.stepper));
  world_steps(&w, 1);
  ck_ok(&w, mpm_grid_map(w.stepper, 0, "mass", MPM_READ, &view));
  ck_refused(&w, mpm_state_load(w.stepper, saved.data, saved.bytes), MPM_E_STATE, "nodal");
  ck_ok(&w, mpm_view_release(&view));
  free(saved.data);
  world_close(&w);
}
END_TEST

START_TEST(misuse) {
  const io_setup setup = io_plain(1);
  world w;
  io_open(&w, &setup);
  saved_state saved = world_save(&w);
  mpm_context *c = w.context;
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
  world_close(&w);
}
END_TEST

/* A world that is smaller than what it is to load, so that everything has to grow. */
static void open_lone(world *w, int32_t dim) {
  io_setup setup = io_plain(dim);
  setup.empty = 1;
  io_open(w, &setup);
  const double x[] = {0.3, 0.3, 0.3}, v[] = {1.0, 0.0, 0.0}, volume = 0.1;
  for (int32_t m = 0; m < 2; ++m) ck_ok(w, mpm_particles_add(w->set[m], 1, x, v, &volume, NULL, NULL, NULL));
  world_steps(w, 2);
}

/* Nothing changes when memory runs out while loading, wherever that happens: stepping goes on as if it had
 * not been tried. */
START_TEST(every_failing_allocation) {
  const io_setup setup = io_plain(_i);
  world a, b, twin;
  io_open(&a, &setup);
  world_steps(&a, 13);
  const saved_state saved = world_save(&a);
  mpm_status status = MPM_E_NOMEM;
  for (int64_t k = 1; status; ++k) {
    open_lone(&b, _i);
    open_lone(&twin, _i);
    const uint64_t before = world_hash(&b);
    b.memory.calls = 0;
    b.memory.fail_at = k;
    status = mpm_state_load(b.stepper, saved.data, saved.bytes);
    b.memory.fail_at = 0;
    if (status) {
      ck_assert_int_eq(status, MPM_E_NOMEM);
      ck_assert_uint_eq(world_hash(&b), before);
      world_steps(&b, 2);
      world_steps(&twin, 2);
      ck_assert_uint_eq(world_hash(&b), world_hash(&twin));
    } else {
      ck_assert_int_gt(k, 40);
      ck_assert_uint_eq(world_hash(&b), world_hash(&a));
      world_steps(&a, 3);
      world_steps(&b, 3);
      ck_assert_uint_eq(world_hash(&b), world_hash(&a));
    }
    world_close(&b);
    world_close(&twin);
  }
  free(saved.data);
  world_close(&a);
}
END_TEST

/* What format 2 does not have is found anew, or begins at 0. */
START_TEST(states_of_the_first_format) {
  const io_setup *setup = &setups[_i];
  world a, b;
  io_open(&a, setup);
  io_open(&b, setup);
  world_steps(&a, 9);
  world_steps(&b, 3);
  const mpm_step_info was = world_info(&a);
  ck_assert_double_ne(was.external_work_total, 0.0);
  ck_assert_double_ne(world_info(&b).external_work_total, 0.0);
  saved_state saved = world_save(&a);
  saved.bytes = contents_of_format_2(a.stepper, saved.data, saved.bytes);
  seal_state(saved.data, MPMI_STATE_FIRST_FORMAT, saved.bytes);
  world_load(&b, &saved);
  ck_assert_uint_eq(world_hash(&b), world_hash(&a));
  const mpm_step_info now = world_info(&b);
  ck_assert_double_eq(now.external_work_total, 0.0);
  for (int32_t face = 0; face < 2 * b.dim; ++face) {
    double impulse[3];
    ck_ok(&b, mpm_stepper_wall_impulse(b.stepper, face, impulse));
    for (int32_t c = 0; c < b.dim; ++c) ck_assert_double_eq(impulse[c], 0.0);
  }
  ck_assert((was.affine_kinetic_energy > 0.0) == (setup->transfer != MPM_FLIP));
  ck_within("affine", now.affine_kinetic_energy, was.affine_kinetic_energy, 1e-13 * was.kinetic_energy);
  ck_within("kinetic", now.kinetic_energy, was.kinetic_energy, 1e-13 * was.kinetic_energy);
  for (int32_t i = 0; i < MORE_STEPS; ++i) {
    world_steps(&a, 1);
    world_steps(&b, 1);
    ck_assert_uint_eq(world_hash(&a), world_hash(&b));
  }
  free(saved.data);
  world_close(&a);
  world_close(&b);
}
END_TEST

TCase *io_state_case(void) {
  TCase *tests = tcase_create("states");
  tcase_set_timeout(tests, 120);
  tcase_add_loop_test(tests, goes_on_with_the_same_bits, 0, SETUPS);
  tcase_add_loop_test(tests, states_of_the_first_format, 0, SETUPS);
  tcase_add_loop_test(tests, keeps_every_field, 1, 4);
  tcase_add_test(tests, host_fields_in_any_order);
  tcase_add_test(tests, views_and_staged_steps_bar_it);
  tcase_add_test(tests, misuse);
  tcase_add_loop_test(tests, every_failing_allocation, 1, 4);
  return tests;
}
