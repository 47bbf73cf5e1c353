/* Sets: made and freed, added to, taken from, and whole after every failure. */
#include "sets.h"

static world w;

static void open_set(void) {
  sets_open(&w, 3, "linear_elastic", 0);
}

static void close_set(void) {
  sets_close(&w);
}

/* ---- made and freed ---- */
START_TEST(creation_misuse) {
  world other = {.context = NULL};
  sets_open(&other, 2, "neo_hookean", 0);
  mpm_particles *set = w.set[0];
  ck_assert_int_eq(mpm_particles_create(NULL, w.grid, w.material[0], &set), MPM_E_ARG);
  ck_assert_int_eq(mpm_particles_create((mpm_context *)w.grid, w.grid, w.material[0], &set), MPM_E_ARG);
  ck_refused(&w, mpm_particles_create(w.context, w.grid, w.material[0], NULL), MPM_E_ARG, "out");
  ck_refused(&w, mpm_particles_create(w.context, NULL, w.material[0], &set), MPM_E_ARG, "grid");
  ck_assert_ptr_null(set);
  ck_refused(&w, mpm_particles_create(w.context, (mpm_grid *)w.material[0], w.material[0], &set), MPM_E_ARG,
             "grid");
  ck_refused(&w, mpm_particles_create(w.context, w.grid, NULL, &set), MPM_E_ARG, "material");
  ck_refused(&w, mpm_particles_create(w.context, w.grid, (mpm_material *)w.grid, &set), MPM_E_ARG,
             "material");
  ck_refused(&w, mpm_particles_create(w.context, other.grid, w.material[0], &set), MPM_E_ARG,
             "grid belongs to another context");
  ck_refused(&w, mpm_particles_create(w.context, w.grid, other.material[0], &set), MPM_E_ARG,
             "material belongs to another context");
  ck_assert_int_eq(w.grid->children, 1);
  ck_assert_int_eq(w.material[0]->users, 1);
  ck_assert_int_eq(w.context->children, 3);
  world_close(&other);
}
END_TEST

START_TEST(destruction) {
  mpm_view view = {.struct_size = sizeof view};
  ck_ok(&w, mpm_particles_destroy(NULL));
  ck_assert_int_eq(mpm_particles_destroy((mpm_particles *)w.grid), MPM_E_ARG);
  ck_refused(&w, mpm_material_destroy(w.material[0]), MPM_E_STATE, "");
  ck_ok(&w, mpm_particles_map(w.set[0], "mass", MPM_READ, &view));
  ck_refused(&w, mpm_particles_destroy(w.set[0]), MPM_E_STATE, "1 views");
  ck_ok(&w, mpm_view_release(&view));
  w.set[0]->stepper = (mpm_stepper *)w.context; /* not looked into */
  ck_refused(&w, mpm_particles_destroy(w.set[0]), MPM_E_STATE, "mpm_stepper_remove");
  w.set[0]->stepper = NULL;
  ck_ok(&w, mpm_particles_destroy(w.set[0]));
  ck_assert_int_eq(w.grid->children, 0);
  ck_assert_int_eq(w.material[0]->users, 0);
  ck_assert_int_eq(w.context->children, 2);
  ck_ok(&w, mpm_particles_create(w.context, w.grid, w.material[0], &w.set[0]));
}
END_TEST

START_TEST(counts) {
  ck_assert_int_eq(mpm_particles_count(NULL), 0);
  ck_assert_int_eq(mpm_particles_count((mpm_particles *)w.grid), 0);
  ck_assert_int_eq(mpm_particles_count(w.set[0]), 0);
  sets_add(&w, 17, NULL);
  ck_assert_int_eq(mpm_particles_count(w.set[0]), 17);
  ck_assert_int_eq(w.set[0]->slots, 32);
}
END_TEST

/* ---- add ---- */
START_TEST(adds_in_every_dimension) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    sets_open(&w, dim, "linear_elastic", 0);
    double x[] = {0.5, 1.0, 0.25, 1.25, 0.75, 1.5}, v[] = {1, 2, 3, 4, 5, 6}, volume[] = {0.125, 8.0};
    int64_t first = -1;
    w.set[0]->dirty = 0;
    ck_ok(&w, mpm_particles_add(w.set[0], 2, x, v, volume, NULL, NULL, &first));
    ck_assert_int_eq(first, 0);
    ck_assert_uint_eq(w.set[0]->dirty,
                      MPMI_DIRTY_ORDER | MPMI_DIRTY_PLACE | MPMI_DIRTY_SUMS | MPMI_DIRTY_ACCELERATION);
    ck_assert_double_eq(w.set[0]->mass_max, 16e3);
    for (int64_t i = 0; i < 2; ++i) {
      for (int32_t k = 0; k < dim; ++k) {
        ck_assert_double_eq(sets_get(&w, "position", dim, k, i), x[2 * k + i]);
        ck_assert_double_eq(sets_get(&w, "velocity", dim, k, i), v[2 * k + i]);
        ck_assert_double_eq_tol(sets_get(&w, "size", dim, k, i), pow(volume[i], 1.0 / dim), 1e-15);
      }
      ck_assert_double_eq(sets_get(&w, "mass", 1, 0, i), 2e3 * volume[i]);
      ck_assert_double_eq(sets_get(&w, "volume", 1, 0, i), volume[i]);
      ck_assert_double_eq(sets_get(&w, "initial_volume", 1, 0, i), volume[i]);
      for (int32_t c = 0; c < 9; ++c)
        ck_assert_double_eq(sets_get(&w, "deformation_gradient", 9, c, i), c % 4 == 0);
      for (int32_t c = 0; c < 6; ++c) ck_assert_double_eq(sets_get(&w, "stress", 6, c, i), 0.0);
    }
    ck_assert_int_eq(w.set[0]->field[MPMI_SIZE].present, 0);
    sets_check_slots(&w);
  }
}
END_TEST

START_TEST(sizes_given) {
  double x[] = {0, 1, 0, 1, 0, 1}, volume[] = {8.0, 1.0}, size[] = {1, 1, 2, 1, 4, 1};
  sets_add(&w, 1, NULL);
  ck_ok(&w, mpm_particles_add(w.set[0], 2, x, NULL, volume, size, NULL, NULL));
  ck_assert_int_eq(w.set[0]->field[MPMI_SIZE].present, 1);
  for (int32_t k = 0; k < 3; ++k) {
    ck_assert_double_eq_tol(sets_get(&w, "size", 3, k, 0), 0.5, 1e-15);
    ck_assert_double_eq(sets_get(&w, "size", 3, k, 1), size[2 * k]);
  }
  sets_add(&w, 1, NULL); /* sizes not given are written out where the field is kept */
  ck_assert_double_eq_tol(sets_get(&w, "size", 3, 2, 3), 0.5, 1e-15);
}
END_TEST

START_TEST(ids_given) {
  int64_t ids[] = {70, 3, 12}, first = -1;
  sets_add(&w, 3, ids);
  ck_assert_int_eq(w.set[0]->next_id, 71);
  double x[] = {0, 0, 0}, volume[] = {1.0};
  ck_ok(&w, mpm_particles_add(w.set[0], 1, x, NULL, volume, NULL, NULL, &first));
  ck_assert_int_eq(first, 71);
  ck_ok(&w, mpm_particles_add(w.set[0], 1, x, NULL, volume, NULL, (int64_t[]){11}, &first));
  ck_assert_int_eq(first, 11);
  ck_assert_int_eq(w.set[0]->next_id, 72);
  int64_t all[5];
  ck_ok(&w, mpm_particles_get(w.set[0], "id", MPM_I64, 1, 5, NULL, all));
  static const int64_t sorted[] = {3, 11, 12, 70, 71};
  ck_assert_int_eq(memcmp(all, sorted, sizeof all), 0);
  ck_ok(&w, mpm_particles_add(w.set[0], 0, NULL, NULL, NULL, NULL, NULL, &first));
  ck_assert_int_eq(first, 72);
}
END_TEST

START_TEST(bad_ids) {
  int64_t known[] = {5, 9};
  sets_add(&w, 2, known);
  double x[9] = {0}, volume[] = {1, 1, 1};
  sets_counts was = sets_take(&w);
#define REFUSED(text, ...)                                                                                   \
  ck_refused(&w, mpm_particles_add(w.set[0], 3, x, NULL, volume, NULL, (int64_t[]){__VA_ARGS__}, NULL),      \
             MPM_E_ARG, text)
  REFUSED("ids[1] is -1", 1, -1, 3);
  REFUSED("ids[0] is -9223372036854775808", INT64_MIN, 2, 3);
  REFUSED("ids[2] is 9223372036854775807", 1, 2, INT64_MAX);
  REFUSED("id 20 is given twice", 20, 21, 20);
  REFUSED("id 0 is given twice", 0, 0, 1);
  REFUSED("id 9 is in use", 20, 9, 21);
  REFUSED("id 5 is in use", 4, 5, 6);
#undef REFUSED
  sets_unchanged(&w, was);
  sets_add(&w, 1, (int64_t[]){INT64_MAX - 1});
  ck_refused(&w, mpm_particles_add(w.set[0], 1, x, NULL, volume, NULL, NULL, NULL), MPM_E_ARG, "ids run out");
  ck_refused(w.context,
             mpm_particles_fill_box(w.set[0], (double[]){0, 0, 0}, (double[]){1, 1, 1}, (int32_t[]){1, 1, 1},
                                    NULL, NULL),
             MPM_E_ARG, "ids run out");
  ck_assert_int_eq(w.set[0]->count, 3);
}
END_TEST

START_TEST(bad_values) {
  double x[] = {0, 0, 0, 0, 0, 0}, v[] = {0, 0, 0, 0, 0, 0}, volume[] = {1, 1}, size[] = {1, 1, 1, 1, 1, 1};
  sets_add(&w, 2, NULL);
  sets_counts was = sets_take(&w);
#define REFUSED(array, i, bad, text)                                                                         \
  do {                                                                                                       \
    double keep = array[i];                                                                                  \
    array[i] = bad;                                                                                          \
    ck_refused(&w, mpm_particles_add(w.set[0], 2, x, v, volume, size, NULL, NULL), MPM_E_ARG, text);         \
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
  ck_assert_int_eq(mpm_particles_add((mpm_particles *)w.grid, 1, x, v, volume, size, NULL, NULL), MPM_E_ARG);
  ck_refused(&w, mpm_particles_add(w.set[0], -1, x, v, volume, size, NULL, NULL), MPM_E_ARG, "n is -1");
  ck_refused(&w, mpm_particles_add(w.set[0], 1, NULL, v, volume, size, NULL, NULL), MPM_E_ARG,
             "position is NULL");
  ck_refused(&w, mpm_particles_add(w.set[0], 1, x, v, NULL, size, NULL, NULL), MPM_E_ARG, "volume is NULL");
  static const int64_t too_many[] = {INT64_C(0xffffffff), INT64_C(0xfffffff0), INT64_MAX};
  for (int i = 0; i < 3; ++i)
    ck_refused(&w, mpm_particles_add(w.set[0], too_many[i], x, v, volume, size, NULL, NULL), MPM_E_ARG,
               "too many");
  sets_unchanged(&w, was);
}
END_TEST

START_TEST(single_adds_share_groups) {
  double x[] = {0, 0, 0}, volume[] = {1};
  for (int64_t i = 0; i < 1000; ++i) {
    x[0] = 1e-3 * (double)i;
    ck_ok(&w, mpm_particles_add(w.set[0], 1, x, NULL, volume, NULL, NULL, NULL));
  }
  ck_assert_int_eq(w.set[0]->slots, 1008);
  ck_assert_int_lt(w.memory.calls, 400); /* capacity grows by half */
  for (int64_t i = 0; i < 1000; ++i) ck_assert_double_eq(sets_get(&w, "position", 3, 0, i), 1e-3 * (double)i);
}
END_TEST

START_TEST(periodic_axes_wrap) {
  mpm_grid_desc grid = sets_grid(2); /* [-1, 4] x [-1, 3.5] */
  grid.periodic[0] = 1;
  sets_open_on(&w, &grid, "linear_elastic", 0);
  double x[] = {4.5, -6.5, 1.0, 1.0}, volume[] = {1, 1};
  ck_ok(&w, mpm_particles_add(w.set[0], 2, x, NULL, volume, NULL, NULL, NULL));
  double at[4];
  int64_t image[4];
  ck_ok(&w, mpm_particles_get(w.set[0], "position", MPM_F64, 2, 2, NULL, at));
  ck_ok(&w, mpm_particles_get(w.set[0], "image", MPM_I64, 2, 2, NULL, image));
  static const double wrapped[] = {-0.5, 3.5, 1.0, 1.0};
  static const int64_t periods[] = {1, -2, 0, 0};
  ck_assert_int_eq(memcmp(at, wrapped, sizeof at), 0);
  ck_assert_int_eq(memcmp(image, periods, sizeof image), 0);
  x[2] = 3.6;
  ck_refused(&w, mpm_particles_add(w.set[0], 2, x, NULL, volume, NULL, NULL, NULL), MPM_E_ARG,
             "component 1, is 3.6, must be inside the grid, in [-1, 3.5]");
  x[2] = 1.0;
  x[0] = 5.0 * 2147483648.0 - 1.0; /* so many periods away, and the last place that is nearer */
  ck_refused(&w, mpm_particles_add(w.set[0], 2, x, NULL, volume, NULL, NULL, NULL), MPM_E_ARG,
             "must be within 2147483648 periods of -1, the lower end of a periodic axis");
  x[0] -= 5.0;
  ck_ok(&w, mpm_particles_add(w.set[0], 2, x, NULL, volume, NULL, NULL, NULL));
  ck_ok(&w, mpm_particles_get(w.set[0], "position", MPM_F64, 2, 2, (int64_t[]){2, 3}, at));
  ck_ok(&w, mpm_particles_get(w.set[0], "image", MPM_I64, 2, 2, (int64_t[]){2, 3}, image));
  ck_assert(at[0] == -1.0 && image[0] == INT64_C(2147483647));
}
END_TEST

/* ---- remove ---- */
START_TEST(removes) {
  sets_add(&w, 40, NULL);
  w.set[0]->dirty = 0;
  ck_ok(&w, mpm_particles_remove(w.set[0], 3, (int64_t[]){39, 0, 17}));
  ck_assert_int_eq(mpm_particles_count(w.set[0]), 37);
  ck_assert_uint_eq(w.set[0]->dirty, MPMI_DIRTY_SUMS);
  sets_check_slots(&w);
  double mass;
  ck_refused(&w, mpm_particles_get(w.set[0], "mass", MPM_F64, 1, 1, (int64_t[]){17}, &mass), MPM_E_NOT_FOUND,
             "id 17");
  int64_t ids[37];
  ck_ok(&w, mpm_particles_get(w.set[0], "id", MPM_I64, 1, 37, NULL, ids));
  for (int64_t i = 0, id = 1; i < 37; ++i, ++id) {
    if (id == 17) ++id;
    ck_assert_int_eq(ids[i], id);
    ck_assert_double_eq(sets_get(&w, "volume", 1, 0, id), 0.125 * (double)(id + 1));
  }
  sets_add(&w, 1, NULL);
  ck_assert_double_eq(sets_get(&w, "volume", 1, 0, 40), 0.125);
  ck_ok(&w, mpm_particles_add(w.set[0], 1, (double[]){0, 0, 0}, NULL, (double[]){1}, NULL, (int64_t[]){17},
                              NULL));
}
END_TEST

START_TEST(bad_removals) {
  sets_add(&w, 10, NULL);
  sets_counts was = sets_take(&w);
  ck_refused(&w, mpm_particles_remove(w.set[0], 3, (int64_t[]){1, 2, 77}), MPM_E_NOT_FOUND, "id 77");
  ck_refused(&w, mpm_particles_remove(w.set[0], 1, (int64_t[]){-1}), MPM_E_NOT_FOUND, "id -1");
  ck_refused(&w, mpm_particles_remove(w.set[0], 1, (int64_t[]){INT64_MIN}), MPM_E_NOT_FOUND, "id -");
  ck_refused(&w, mpm_particles_remove(w.set[0], 3, (int64_t[]){4, 0, 4}), MPM_E_ARG, "id 4 is given twice");
  ck_refused(&w, mpm_particles_remove(w.set[0], 1, NULL), MPM_E_ARG, "ids is NULL");
  ck_refused(&w, mpm_particles_remove(w.set[0], -1, (int64_t[]){4}), MPM_E_ARG, "n is -1");
  ck_assert_int_eq(mpm_particles_remove(NULL, 1, (int64_t[]){4}), MPM_E_ARG);
  ck_ok(&w, mpm_particles_remove(w.set[0], 0, NULL));
  sets_unchanged(&w, was);
  int64_t ids[10];
  ck_ok(&w, mpm_particles_get(w.set[0], "id", MPM_I64, 1, 10, NULL, ids));
  for (int64_t i = 0; i < 10; ++i) ck_assert_int_eq(ids[i], i);
}
END_TEST

/* ---- failing memory ---- */
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
    return mpm_particles_create(w.context, w.grid, w.material[0], &w.set[0]);
  case 1:
    return mpm_particles_fill_box(w.set[0], lower, upper, per, NULL, NULL);
  case 2:
    return mpm_particles_add(w.set[0], 2, x, NULL, volume, size, given, NULL);
  case 3:
    return mpm_particles_add_field(w.set[0], "colour", MPM_U8, 3);
  case 4:
    return mpm_particles_add(w.set[0], 1, value, NULL, volume, NULL, (int64_t[]){5000}, NULL);
  case 5:
    return mpm_particles_get(w.set[0], "position", MPM_F64, 3, 1, (int64_t[]){7000}, value);
  case 6:
    return mpm_particles_set(w.set[0], "applied_force", MPM_F64, 3, 1, (int64_t[]){5000}, value);
  default:
    return mpm_particles_fill_ball(w.set[0], x, 2.0, per, NULL, NULL);
  }
}

START_TEST(every_failing_allocation) {
  int64_t failures = 0, k = 1;
  for (int32_t failed = 1; failed; ++k) {
    ck_ok(&w, mpm_particles_destroy(w.set[0]));
    w.set[0] = NULL;
    int64_t before = w.memory.held;
    failed = 0;
    w.memory.calls = 0;
    w.memory.fail_at = k;
    for (int i = 0; i < CALLS; ++i) {
      sets_counts was = w.set[0] ? sets_take(&w) : (sets_counts){0};
      const mpm_status status = call(i);
      if (!status) continue;
      ck_refused(&w, status, MPM_E_NOMEM, "out of memory");
      ck_assert_int_eq(failed++, 0);
      if (i == 0) {
        ck_assert_ptr_null(w.set[0]);
        ck_assert_int_eq(w.memory.held, before);
        ck_assert_int_eq(w.grid->children, 0);
      } else {
        sets_unchanged(&w, was);
        sets_check_slots(&w);
      }
      ck_ok(&w, call(i));
    }
    failures += failed;
    sets_check_slots(&w);
    ck_assert_int_eq(mpmi_f64(w.set[0], MPMI_MASS, 0) != NULL, 1);
  }
  w.memory.fail_at = 0;
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
