/* Sets: made and freed, added to, taken from, and whole after every failure. */
#include "set_fixture.h"

static fixture f;

static void open_set(void) {
  fixture_open(&f, 3, "linear_elastic");
}

static void open_dim(int32_t dim) {
  fixture_close(&f);
  fixture_open(&f, dim, "linear_elastic");
}

static void close_set(void) {
  fixture_check_slots(&f);
  fixture_close(&f);
}

/* ---- made and freed ---------------------------------------------------------------------------------- */
START_TEST(creation_misuse) {
  fixture other;
  fixture_open(&other, 2, "neo_hookean");
  mpm_particles *set = f.set;
  ck_assert_int_eq(mpm_particles_create(NULL, f.grid, f.material, &set), MPM_E_ARG);
  ck_assert_int_eq(mpm_particles_create((mpm_context *)f.grid, f.grid, f.material, &set), MPM_E_ARG);
  ck_refused(f.context, mpm_particles_create(f.context, f.grid, f.material, NULL), MPM_E_ARG, "out");
  ck_refused(f.context, mpm_particles_create(f.context, NULL, f.material, &set), MPM_E_ARG, "grid");
  ck_assert_ptr_null(set);
  ck_refused(f.context, mpm_particles_create(f.context, (mpm_grid *)f.material, f.material, &set), MPM_E_ARG,
             "grid");
  ck_refused(f.context, mpm_particles_create(f.context, f.grid, NULL, &set), MPM_E_ARG, "material");
  ck_refused(f.context, mpm_particles_create(f.context, f.grid, (mpm_material *)f.grid, &set), MPM_E_ARG,
             "material");
  ck_refused(f.context, mpm_particles_create(f.context, other.grid, f.material, &set), MPM_E_ARG,
             "grid belongs to another context");
  ck_refused(f.context, mpm_particles_create(f.context, f.grid, other.material, &set), MPM_E_ARG,
             "material belongs to another context");
  ck_assert_int_eq(f.grid->children, 1);
  ck_assert_int_eq(f.material->users, 1);
  ck_assert_int_eq(f.context->children, 3);
  fixture_close(&other);
}
END_TEST

START_TEST(destruction) {
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(mpm_particles_destroy(NULL));
  ck_assert_int_eq(mpm_particles_destroy((mpm_particles *)f.grid), MPM_E_ARG);
  ck_refused(f.context, mpm_material_destroy(f.material), MPM_E_STATE, "");
  ck_ok(mpm_particles_map(f.set, "mass", MPM_READ, &view));
  ck_refused(f.context, mpm_particles_destroy(f.set), MPM_E_STATE, "1 views");
  ck_ok(mpm_view_release(&view));
  f.set->stepper = (mpm_stepper *)f.context; /* not looked into */
  ck_refused(f.context, mpm_particles_destroy(f.set), MPM_E_STATE, "mpm_stepper_remove");
  f.set->stepper = NULL;
  ck_ok(mpm_particles_destroy(f.set));
  ck_assert_int_eq(f.grid->children, 0);
  ck_assert_int_eq(f.material->users, 0);
  ck_assert_int_eq(f.context->children, 2);
  ck_ok(mpm_particles_create(f.context, f.grid, f.material, &f.set));
}
END_TEST

START_TEST(counts) {
  ck_assert_int_eq(mpm_particles_count(NULL), 0);
  ck_assert_int_eq(mpm_particles_count((mpm_particles *)f.grid), 0);
  ck_assert_int_eq(mpm_particles_count(f.set), 0);
  fixture_add(&f, 17, NULL);
  ck_assert_int_eq(mpm_particles_count(f.set), 17);
  ck_assert_int_eq(f.set->slots, 32);
}
END_TEST

/* ---- add --------------------------------------------------------------------------------------------- */
START_TEST(adds_in_every_dimension) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    open_dim(dim);
    double x[] = {0.5, 1.0, 0.25, 1.25, 0.75, 1.5}, v[] = {1, 2, 3, 4, 5, 6}, volume[] = {0.125, 8.0};
    int64_t first = -1;
    f.set->dirty = 0;
    ck_ok(mpm_particles_add(f.set, 2, x, v, volume, NULL, NULL, &first));
    ck_assert_int_eq(first, 0);
    ck_assert_uint_eq(f.set->dirty,
                      MPMI_DIRTY_ORDER | MPMI_DIRTY_PLACE | MPMI_DIRTY_SUMS | MPMI_DIRTY_ACCELERATION);
    ck_assert_double_eq(f.set->mass_max, 16e3);
    for (int64_t i = 0; i < 2; ++i) {
      for (int32_t k = 0; k < dim; ++k) {
        ck_assert_double_eq(fixture_get1(&f, "position", dim, k, i), x[2 * k + i]);
        ck_assert_double_eq(fixture_get1(&f, "velocity", dim, k, i), v[2 * k + i]);
        ck_assert_double_eq_tol(fixture_get1(&f, "size", dim, k, i), pow(volume[i], 1.0 / dim), 1e-15);
      }
      ck_assert_double_eq(fixture_get1(&f, "mass", 1, 0, i), 2e3 * volume[i]);
      ck_assert_double_eq(fixture_get1(&f, "volume", 1, 0, i), volume[i]);
      ck_assert_double_eq(fixture_get1(&f, "initial_volume", 1, 0, i), volume[i]);
      for (int32_t c = 0; c < 9; ++c)
        ck_assert_double_eq(fixture_get1(&f, "deformation_gradient", 9, c, i), c % 4 == 0);
      for (int32_t c = 0; c < 6; ++c) ck_assert_double_eq(fixture_get1(&f, "stress", 6, c, i), 0.0);
    }
    ck_assert_int_eq(f.set->field[MPMI_SIZE].present, 0);
    fixture_check_slots(&f);
  }
}
END_TEST

START_TEST(sizes_given) {
  double x[] = {0, 1, 0, 1, 0, 1}, volume[] = {8.0, 1.0}, size[] = {1, 1, 2, 1, 4, 1};
  fixture_add(&f, 1, NULL);
  ck_ok(mpm_particles_add(f.set, 2, x, NULL, volume, size, NULL, NULL));
  ck_assert_int_eq(f.set->field[MPMI_SIZE].present, 1);
  for (int32_t k = 0; k < 3; ++k) {
    ck_assert_double_eq_tol(fixture_get1(&f, "size", 3, k, 0), 0.5, 1e-15);
    ck_assert_double_eq(fixture_get1(&f, "size", 3, k, 1), size[2 * k]);
  }
  fixture_add(&f, 1, NULL); /* sizes not given are written out where the field is kept */
  ck_assert_double_eq_tol(fixture_get1(&f, "size", 3, 2, 3), 0.5, 1e-15);
}
END_TEST

START_TEST(ids_given) {
  int64_t ids[] = {70, 3, 12}, first = -1;
  fixture_add(&f, 3, ids);
  ck_assert_int_eq(f.set->next_id, 71);
  double x[] = {0, 0, 0}, volume[] = {1.0};
  ck_ok(mpm_particles_add(f.set, 1, x, NULL, volume, NULL, NULL, &first));
  ck_assert_int_eq(first, 71);
  ck_ok(mpm_particles_add(f.set, 1, x, NULL, volume, NULL, (int64_t[]){11}, &first));
  ck_assert_int_eq(first, 11);
  ck_assert_int_eq(f.set->next_id, 72);
  int64_t all[5];
  ck_ok(mpm_particles_get(f.set, "id", MPM_I64, 1, 5, NULL, all));
  static const int64_t sorted[] = {3, 11, 12, 70, 71};
  ck_assert_int_eq(memcmp(all, sorted, sizeof all), 0);
  ck_ok(mpm_particles_add(f.set, 0, NULL, NULL, NULL, NULL, NULL, &first));
  ck_assert_int_eq(first, 72);
}
END_TEST

START_TEST(bad_ids) {
  int64_t known[] = {5, 9};
  fixture_add(&f, 2, known);
  double x[9] = {0}, volume[] = {1, 1, 1};
  fixture_counts was = fixture_take(&f);
#define REFUSED(text, ...)                                                                                   \
  ck_refused(f.context, mpm_particles_add(f.set, 3, x, NULL, volume, NULL, (int64_t[]){__VA_ARGS__}, NULL),  \
             MPM_E_ARG, text)
  REFUSED("ids[1] is -1", 1, -1, 3);
  REFUSED("ids[0] is -9223372036854775808", INT64_MIN, 2, 3);
  REFUSED("ids[2] is 9223372036854775807", 1, 2, INT64_MAX);
  REFUSED("id 20 is given twice", 20, 21, 20);
  REFUSED("id 0 is given twice", 0, 0, 1);
  REFUSED("id 9 is in use", 20, 9, 21);
  REFUSED("id 5 is in use", 4, 5, 6);
#undef REFUSED
  fixture_unchanged(&f, was);
  fixture_add(&f, 1, (int64_t[]){INT64_MAX - 1});
  ck_refused(f.context, mpm_particles_add(f.set, 1, x, NULL, volume, NULL, NULL, NULL), MPM_E_ARG,
             "ids run out");
  ck_refused(f.context,
             mpm_particles_fill_box(f.set, (double[]){0, 0, 0}, (double[]){1, 1, 1}, (int32_t[]){1, 1, 1},
                                    NULL, NULL),
             MPM_E_ARG, "ids run out");
  ck_assert_int_eq(f.set->count, 3);
}
END_TEST

START_TEST(bad_values) {
  double x[] = {0, 0, 0, 0, 0, 0}, v[] = {0, 0, 0, 0, 0, 0}, volume[] = {1, 1}, size[] = {1, 1, 1, 1, 1, 1};
  fixture_add(&f, 2, NULL);
  fixture_counts was = fixture_take(&f);
#define REFUSED(array, i, bad, text)                                                                         \
  do {                                                                                                       \
    double keep = array[i];                                                                                  \
    array[i] = bad;                                                                                          \
    ck_refused(f.context, mpm_particles_add(f.set, 2, x, v, volume, size, NULL, NULL), MPM_E_ARG, text);     \
    array[i] = keep;                                                                                         \
  } while (0)
  REFUSED(x, 0, NOT_A_NUMBER, "position of the particle with index 0, component 0, is nan");
  REFUSED(x, 3, 3.6, "position of the particle with index 1, component 1, is 3.6");
  REFUSED(x, 4, -INFINITE, "position of the particle with index 0, component 2, is -inf");
  REFUSED(v, 5, INFINITE, "velocity of the particle with index 1, component 2, is inf");
  REFUSED(v, 0, NOT_A_NUMBER, "velocity of the particle with index 0, component 0, is nan");
  REFUSED(volume, 0, 0.0, "volume of the particle with index 0 is 0");
  REFUSED(volume, 1, -2.0, "volume of the particle with index 1 is -2");
  REFUSED(volume, 1, NOT_A_NUMBER, "volume of the particle with index 1 is nan");
  REFUSED(volume, 1, INFINITE, "volume of the particle with index 1 is inf");
  REFUSED(volume, 0, 1e306, "its mass overflows");
  REFUSED(size, 3, 0.0, "size of the particle with index 1, component 1, is 0");
  REFUSED(size, 3, -1.0, "size of the particle with index 1, component 1, is -1");
  REFUSED(size, 2, NOT_A_NUMBER, "size of the particle with index 0, component 1, is nan");
#undef REFUSED
  ck_assert_int_eq(mpm_particles_add(NULL, 1, x, v, volume, size, NULL, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_particles_add((mpm_particles *)f.grid, 1, x, v, volume, size, NULL, NULL), MPM_E_ARG);
  ck_refused(f.context, mpm_particles_add(f.set, -1, x, v, volume, size, NULL, NULL), MPM_E_ARG, "n is -1");
  ck_refused(f.context, mpm_particles_add(f.set, 1, NULL, v, volume, size, NULL, NULL), MPM_E_ARG,
             "position is NULL");
  ck_refused(f.context, mpm_particles_add(f.set, 1, x, v, NULL, size, NULL, NULL), MPM_E_ARG,
             "volume is NULL");
  static const int64_t too_many[] = {INT64_C(0xffffffff), INT64_C(0xfffffff0), INT64_MAX};
  for (int i = 0; i < 3; ++i)
    ck_refused(f.context, mpm_particles_add(f.set, too_many[i], x, v, volume, size, NULL, NULL), MPM_E_ARG,
               "too many");
  fixture_unchanged(&f, was);
}
END_TEST

START_TEST(single_adds_share_groups) {
  double x[] = {0, 0, 0}, volume[] = {1};
  for (int64_t i = 0; i < 1000; ++i) {
    x[0] = 1e-3 * (double)i;
    ck_ok(mpm_particles_add(f.set, 1, x, NULL, volume, NULL, NULL, NULL));
  }
  ck_assert_int_eq(f.set->slots, 1008);
  ck_assert_int_lt(f.calls, 400); /* capacity grows by half */
  for (int64_t i = 0; i < 1000; ++i)
    ck_assert_double_eq(fixture_get1(&f, "position", 3, 0, i), 1e-3 * (double)i);
}
END_TEST

START_TEST(periodic_axes_wrap) {
  mpm_grid_desc grid = fixture_grid(2); /* [-1, 4] x [-1, 3.5] */
  grid.periodic[0] = 1;
  fixture_close(&f);
  fixture_open_on(&f, &grid, "linear_elastic");
  double x[] = {4.5, -6.5, 1.0, 1.0}, volume[] = {1, 1};
  ck_ok(mpm_particles_add(f.set, 2, x, NULL, volume, NULL, NULL, NULL));
  double at[4];
  int64_t image[4];
  ck_ok(mpm_particles_get(f.set, "position", MPM_F64, 2, 2, NULL, at));
  ck_ok(mpm_particles_get(f.set, "image", MPM_I64, 2, 2, NULL, image));
  static const double wrapped[] = {-0.5, 3.5, 1.0, 1.0};
  static const int64_t periods[] = {1, -2, 0, 0};
  ck_assert_int_eq(memcmp(at, wrapped, sizeof at), 0);
  ck_assert_int_eq(memcmp(image, periods, sizeof image), 0);
  x[2] = 3.6;
  ck_refused(f.context, mpm_particles_add(f.set, 2, x, NULL, volume, NULL, NULL, NULL), MPM_E_ARG,
             "component 1, is 3.6");
}
END_TEST

/* ---- remove ------------------------------------------------------------------------------------------ */
START_TEST(removes) {
  fixture_add(&f, 40, NULL);
  f.set->dirty = 0;
  ck_ok(mpm_particles_remove(f.set, 3, (int64_t[]){39, 0, 17}));
  ck_assert_int_eq(mpm_particles_count(f.set), 37);
  ck_assert_uint_eq(f.set->dirty, MPMI_DIRTY_SUMS);
  fixture_check_slots(&f);
  double mass;
  ck_refused(f.context, mpm_particles_get(f.set, "mass", MPM_F64, 1, 1, (int64_t[]){17}, &mass),
             MPM_E_NOT_FOUND, "id 17");
  int64_t ids[37];
  ck_ok(mpm_particles_get(f.set, "id", MPM_I64, 1, 37, NULL, ids));
  for (int64_t i = 0, id = 1; i < 37; ++i, ++id) {
    if (id == 17) ++id;
    ck_assert_int_eq(ids[i], id);
    ck_assert_double_eq(fixture_get1(&f, "volume", 1, 0, id), 0.125 * (double)(id + 1));
  }
  fixture_add(&f, 1, NULL);
  ck_assert_double_eq(fixture_get1(&f, "volume", 1, 0, 40), 0.125);
  ck_ok(mpm_particles_add(f.set, 1, (double[]){0, 0, 0}, NULL, (double[]){1}, NULL, (int64_t[]){17}, NULL));
}
END_TEST

START_TEST(bad_removals) {
  fixture_add(&f, 10, NULL);
  fixture_counts was = fixture_take(&f);
  ck_refused(f.context, mpm_particles_remove(f.set, 3, (int64_t[]){1, 2, 77}), MPM_E_NOT_FOUND, "id 77");
  ck_refused(f.context, mpm_particles_remove(f.set, 1, (int64_t[]){-1}), MPM_E_NOT_FOUND, "id -1");
  ck_refused(f.context, mpm_particles_remove(f.set, 1, (int64_t[]){INT64_MIN}), MPM_E_NOT_FOUND, "id -");
  ck_refused(f.context, mpm_particles_remove(f.set, 3, (int64_t[]){4, 0, 4}), MPM_E_ARG,
             "id 4 is given twice");
  ck_refused(f.context, mpm_particles_remove(f.set, 1, NULL), MPM_E_ARG, "ids is NULL");
  ck_refused(f.context, mpm_particles_remove(f.set, -1, (int64_t[]){4}), MPM_E_ARG, "n is -1");
  ck_assert_int_eq(mpm_particles_remove(NULL, 1, (int64_t[]){4}), MPM_E_ARG);
  ck_ok(mpm_particles_remove(f.set, 0, NULL));
  fixture_unchanged(&f, was);
  int64_t ids[10];
  ck_ok(mpm_particles_get(f.set, "id", MPM_I64, 1, 10, NULL, ids));
  for (int64_t i = 0; i < 10; ++i) ck_assert_int_eq(ids[i], i);
}
END_TEST

/* ---- failing memory ---------------------------------------------------------------------------------- */
enum { CALLS = 8 };

/* The k-th of a life's calls. */
static mpm_status call(int k) {
  static const double lower[] = {-1, -1, -1}, upper[] = {1, 1, 1}, x[] = {0, 0.5, 0, 0.5, 0, 0.5},
                      volume[] = {1, 1}, size[] = {1, 1, 1, 1, 1, 1};
  static const int32_t per[] = {1, 2, 1};
  static const int64_t given[] = {7000, 3000};
  double value[3] = {0.25, 0.5, 0.75};
  switch (k) {
  case 0:
    return mpm_particles_create(f.context, f.grid, f.material, &f.set);
  case 1:
    return mpm_particles_fill_box(f.set, lower, upper, per, NULL, NULL);
  case 2:
    return mpm_particles_add(f.set, 2, x, NULL, volume, size, given, NULL);
  case 3:
    return mpm_particles_add_field(f.set, "colour", MPM_U8, 3);
  case 4:
    return mpm_particles_add(f.set, 1, value, NULL, volume, NULL, (int64_t[]){5000}, NULL);
  case 5:
    return mpm_particles_get(f.set, "position", MPM_F64, 3, 1, (int64_t[]){7000}, value);
  case 6:
    return mpm_particles_set(f.set, "applied_force", MPM_F64, 3, 1, (int64_t[]){5000}, value);
  default:
    return mpm_particles_fill_ball(f.set, x, 2.0, per, NULL, NULL);
  }
}

START_TEST(every_failing_allocation) {
  int64_t failures = 0, k = 1;
  for (int32_t failed = 1; failed; ++k) {
    ck_ok(mpm_particles_destroy(f.set));
    f.set = NULL;
    int64_t before = f.held;
    failed = 0;
    f.calls = 0;
    f.fail_at = k;
    for (int i = 0; i < CALLS; ++i) {
      fixture_counts was = f.set ? fixture_take(&f) : (fixture_counts){0};
      mpm_status status = call(i);
      if (!status) continue;
      ck_assert_int_eq(status, MPM_E_NOMEM);
      ck_assert_ptr_nonnull(strstr(mpm_last_error(f.context), "out of memory"));
      ck_assert_int_eq(failed++, 0);
      if (i == 0) {
        ck_assert_ptr_null(f.set);
        ck_assert_int_eq(f.held, before);
        ck_assert_int_eq(f.grid->children, 0);
      } else {
        fixture_unchanged(&f, was);
        fixture_check_slots(&f);
      }
      ck_ok(call(i));
    }
    failures += failed;
    fixture_check_slots(&f);
    ck_assert_int_eq(mpmi_f64(f.set, MPMI_MASS, 0) != NULL, 1);
  }
  f.fail_at = 0;
  ck_assert_int_eq(failures, k - 2);
  ck_assert_int_gt(failures, 40);
}
END_TEST

Suite *particles_suite(void) {
  Suite *suite = suite_create("particles");
  TCase *tests = tcase_create("particles");
  tcase_add_checked_fixture(tests, open_set, close_set);
  tcase_add_test(tests, creation_misuse);
  tcase_add_test(tests, destruction);
  tcase_add_test(tests, counts);
  tcase_add_test(tests, adds_in_every_dimension);
  tcase_add_test(tests, sizes_given);
  tcase_add_test(tests, ids_given);
  tcase_add_test(tests, bad_ids);
  tcase_add_test(tests, bad_values);
  tcase_add_test(tests, single_adds_share_groups);
  tcase_add_test(tests, periodic_axes_wrap);
  tcase_add_test(tests, removes);
  tcase_add_test(tests, bad_removals);
  tcase_add_test(tests, every_failing_allocation);
  suite_add_tcase(suite, tests);
  return suite;
}
