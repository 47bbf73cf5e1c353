/* The hash of a state: of what the particles are, not of how they are kept. */
#include "io.h"

/* The same particles by id, added one by one from `first` on with a stride; some others come and go. */
static void fill_by_id(world *w, int64_t first, int64_t stride) {
  enum { N = 37 };
  for (int32_t m = 0; m < 2; ++m)
    for (int64_t i = 0; i < N; ++i) {
      const int64_t id = (first + i * stride) % N, passing = 1000 + i;
      const double x[] = {0.01 * (double)id, 0.02 * (double)id}, v[] = {(double)id, 1.0},
                   volume = 0.5 + (double)id;
      ck_ok(w, mpm_particles_add(w->set[m], 1, x, v, &volume, NULL, &id, NULL));
      if (first && i % 5 == 0) {
        ck_ok(w, mpm_particles_add(w->set[m], 1, x, v, &volume, NULL, &passing, NULL));
        ck_ok(w, mpm_particles_remove(w->set[m], 1, &passing));
      }
    }
}

START_TEST(order_does_not_matter) {
  io_setup setup = io_plain(2);
  setup.empty = 1;
  world a, b;
  io_open(&a, &setup);
  setup.concurrency = 3;
  io_open(&b, &setup);
  fill_by_id(&a, 0, 1);
  fill_by_id(&b, 5, 11);
  ck_assert_uint_eq(world_hash(&a), world_hash(&b));
  world_steps(&a, 3);
  world_steps(&b, 3);
  ck_assert_uint_eq(world_hash(&a), world_hash(&b));
  world_close(&a);
  world_close(&b);
}
END_TEST

START_TEST(every_value_matters) {
  const io_setup setup = {_i, MPM_FLIP, MPM_USL, 1, 1, 1, 0};
  world w;
  io_open(&w, &setup);
  world_steps(&w, 2);
  const uint64_t before = world_hash(&w);
  for (int32_t m = 0; m < 2; ++m) {
    mpm_particles *set = w.set[m];
    int64_t slot = 0;
    while (mpmi_i64(set, MPMI_ID, 0)[slot] < 0) ++slot;
    for (int32_t f = 0; f < set->field_count; ++f)
      for (int32_t c = 0; c < set->field[f].components && set->field[f].present; ++c) {
        const size_t size = mpmi_type_size(set->field[f].type);
        unsigned char *at = (unsigned char *)set->field[f].data[0] + (size_t)(c * set->ld + slot) * size;
        at[0] ^= 1;
        ck_assert_uint_ne(world_hash(&w), before);
        at[0] ^= 1;
      }
  }
  ck_assert_uint_eq(world_hash(&w), before);
  ck_ok(&w, mpm_stepper_set_time(w.stepper, world_info(&w).t, 77));
  ck_assert_uint_ne(world_hash(&w), before);
  ck_ok(&w, mpm_stepper_set_time(w.stepper, 1.0, 2));
  ck_assert_uint_ne(world_hash(&w), before);
  world_close(&w);
}
END_TEST

/* Exchanging values between particles, components or sets changes the hash,
 * although every sum is the same. */
START_TEST(places_matter) {
  io_setup setup = io_plain(2);
  world w;
  io_open(&w, &setup);
  const uint64_t before = world_hash(&w);
  const int64_t pair[] = {4, 9};
  const double swapped[] = {0.9, 0.4};
  ck_ok(&w, mpm_particles_set(w.set[0], "temperature", MPM_F64, 1, 2, pair, swapped));
  ck_assert_uint_ne(world_hash(&w), before);
  const double back[] = {0.1 * 4.0, 0.1 * 9.0};
  ck_ok(&w, mpm_particles_set(w.set[0], "temperature", MPM_F64, 1, 2, pair, back));
  ck_assert_uint_eq(world_hash(&w), before);
  world_close(&w);
}
END_TEST

START_TEST(presence_does_not_matter) {
  const io_setup setup = io_plain(2);
  world w;
  io_open(&w, &setup);
  world_steps(&w, 1);
  const uint64_t before = world_hash(&w);
  static const char *const optional[] = {"applied_force", "acceleration", "velocity_gradient", "prescribed",
                                         "size"};
  for (size_t i = 0; i < sizeof optional / sizeof *optional; ++i) {
    mpm_view view = {.struct_size = sizeof view};
    ck_ok(&w, mpm_particles_map(w.set[0], optional[i], MPM_READ, &view));
    ck_ok(&w, mpm_view_release(&view));
    ck_assert_int_eq(w.set[0]->field[mpmi_find_field(w.set[0], optional[i])].present, 1);
    ck_assert_uint_eq(world_hash(&w), before);
  }
  world_close(&w);
}
END_TEST

/* Stress follows from F when it is asked for. */
START_TEST(settles_first) {
  const io_setup setup = io_plain(2);
  world a, b;
  io_open(&a, &setup);
  io_open(&b, &setup);
  const double stretched[] = {1.1, 0, 0, 0, 1, 0, 0, 0, 1};
  ck_ok(&a, mpm_particles_set_all(a.set[0], "deformation_gradient", MPM_F64, 9, stretched));
  ck_ok(&b, mpm_particles_set_all(b.set[0], "deformation_gradient", MPM_F64, 9, stretched));
  double stress[6];
  const int64_t id = 0;
  ck_ok(&a, mpm_particles_get(a.set[0], "stress", MPM_F64, 6, 1, &id, stress));
  ck_assert_uint_eq(world_hash(&a), world_hash(&b));
  saved_state saved = world_save(&b);
  world_load(&a, &saved);
  ck_assert_uint_eq(world_hash(&a), world_hash(&b));
  free(saved.data);
  world_close(&a);
  world_close(&b);
}
END_TEST

TCase *io_hash_case(void) {
  TCase *tests = tcase_create("hash");
  tcase_add_test(tests, order_does_not_matter);
  tcase_add_loop_test(tests, every_value_matters, 1, 4);
  tcase_add_test(tests, places_matter);
  tcase_add_test(tests, presence_does_not_matter);
  tcase_add_test(tests, settles_first);
  return tests;
}
