/* Fields of a set by name: what there is, what the host adds, and the storage below. */
#include "context/radix.h"
#include "sets.h"

static world w;

static void open_set(void) {
  sets_open(&w, 3, "linear_elastic", 20);
}

static void close_set(void) {
  sets_close(&w);
}

/* ---- what there is ---- */
typedef struct row {
  const char *name;
  int32_t type, stored[3], full[3], writable;
} row;

static const row table[] = {{"id", MPM_I64, {1, 1, 1}, {1, 1, 1}, 0},
                            {"position", MPM_F64, {1, 2, 3}, {1, 2, 3}, 1},
                            {"velocity", MPM_F64, {1, 2, 3}, {1, 2, 3}, 1},
                            {"acceleration", MPM_F64, {1, 2, 3}, {1, 2, 3}, 1},
                            {"mass", MPM_F64, {1, 1, 1}, {1, 1, 1}, 1},
                            {"volume", MPM_F64, {1, 1, 1}, {1, 1, 1}, 0},
                            {"initial_volume", MPM_F64, {1, 1, 1}, {1, 1, 1}, 1},
                            {"size", MPM_F64, {1, 2, 3}, {1, 2, 3}, 1},
                            {"deformation_gradient", MPM_F64, {1, 5, 9}, {9, 9, 9}, 1},
                            {"velocity_gradient", MPM_F64, {1, 4, 9}, {9, 9, 9}, 1},
                            {"stress", MPM_F64, {3, 4, 6}, {6, 6, 6}, 1},
                            {"state", MPM_F64, {0, 0, 0}, {0, 0, 0}, 1},
                            {"reference_position", MPM_F64, {1, 2, 3}, {1, 2, 3}, 1},
                            {"prescribed", MPM_U8, {1, 2, 3}, {1, 2, 3}, 1},
                            {"applied_force", MPM_F64, {1, 2, 3}, {1, 2, 3}, 1},
                            {"image", MPM_I64, {1, 2, 3}, {1, 2, 3}, 0},
                            {"dilation_ratio", MPM_F64, {1, 1, 1}, {1, 1, 1}, 1}};

START_TEST(built_in_fields) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    sets_open(&w, dim, "linear_elastic", 20);
    for (int32_t i = 0; i < 17; ++i) {
      const char *name;
      int32_t type, components, writable;
      ck_ok(&w, mpm_particles_field_info(w.set[0], i, &name, &type, &components, &writable));
      ck_assert_str_eq(name, table[i].name);
      ck_assert_int_eq(type, table[i].type);
      ck_assert_int_eq(components, table[i].full[dim - 1]);
      ck_assert_int_eq(writable, table[i].writable);
      ck_assert_int_eq(w.set[0]->field[i].components, table[i].stored[dim - 1]);
      ck_ok(&w, mpm_particles_field_info(w.set[0], i, NULL, NULL, NULL, NULL));
    }
    ck_refused(&w, mpm_particles_field_info(w.set[0], 17, NULL, NULL, NULL, NULL), MPM_E_NOT_FOUND,
               "17 fields");
    ck_refused(&w, mpm_particles_field_info(w.set[0], -1, NULL, NULL, NULL, NULL), MPM_E_NOT_FOUND, "-1");
    ck_assert_int_eq(mpm_particles_field_info(NULL, 0, NULL, NULL, NULL, NULL), MPM_E_ARG);
  }
}
END_TEST

START_TEST(present_and_doubled) {
  static const int32_t doubled[] = {MPMI_POSITION, MPMI_VELOCITY, MPMI_F, MPMI_STRESS};
  uint32_t present = 0, copies = 0;
  for (int i = 0; i < 4; ++i) copies |= 1u << doubled[i];
  for (int32_t i = 0; i < MPMI_BUILTIN_FIELDS; ++i) {
    const mpmi_field *field = &w.set[0]->field[i];
    if (field->present) present |= 1u << i;
    ck_assert_int_eq(field->data[0] != NULL, field->present);
    ck_assert_int_eq(field->data[1] != NULL, copies >> i & 1);
    ck_assert_uint_eq((uintptr_t)field->data[0] % MPMI_ALIGNMENT, 0);
  }
  ck_assert_uint_eq(present,
                    copies | 1u << MPMI_ID | 1u << MPMI_MASS | 1u << MPMI_VOLUME | 1u << MPMI_INITIAL_VOLUME);
  mpm_grid_desc grid = sets_grid(3);
  grid.periodic[2] = 1;
  sets_open_on(&w, &grid, "linear_elastic", 20);
  ck_assert_int_eq(w.set[0]->field[MPMI_IMAGE].present, 1);
  ck_assert_ptr_nonnull(w.set[0]->field[MPMI_IMAGE].data[1]);
}
END_TEST

START_TEST(added_fields) {
  int32_t type, components, writable;
  const char *name;
  ck_ok(&w, mpm_particles_add_field(w.set[0], "temperature_0", MPM_F64, 1));
  ck_ok(&w, mpm_particles_add_field(w.set[0], "label", MPM_I64, 2));
  ck_ok(&w, mpm_particles_add_field(w.set[0], "flags", MPM_U8, 64));
  ck_ok(&w, mpm_particles_field_info(w.set[0], 18, &name, &type, &components, &writable));
  ck_assert_str_eq(name, "label");
  ck_assert_int_eq(type, MPM_I64);
  ck_assert_int_eq(components, 2);
  ck_assert_int_eq(writable, 1);
  uint8_t flags[20 * 64];
  memset(flags, 9, sizeof flags);
  ck_ok(&w, mpm_particles_get(w.set[0], "flags", MPM_U8, 64, 20, NULL, flags));
  for (int i = 0; i < 20 * 64; ++i) ck_assert_int_eq(flags[i], 0);
  /* They travel with growth, and new particles have zeros. */
  int64_t label[40], more[240];
  for (int i = 0; i < 40; ++i) label[i] = 1000 - i;
  ck_ok(&w, mpm_particles_set(w.set[0], "label", MPM_I64, 2, 20, NULL, label));
  sets_add(&w, 100, NULL);
  ck_ok(&w, mpm_particles_get(w.set[0], "label", MPM_I64, 2, 120, NULL, more));
  for (int i = 0; i < 120; ++i)
    for (int c = 0; c < 2; ++c) ck_assert_int_eq(more[120 * c + i], i < 20 ? label[20 * c + i] : 0);
}
END_TEST

START_TEST(bad_added_fields) {
  static const char *const bad[] = {"", "Mass", "a-b", "a b", "\xc3\xa4"};
  char longest[MPMI_NAME + 1] = {0};
  memset(longest, 'a', MPMI_NAME);
  sets_counts was = sets_take(&w);
  ck_refused(&w, mpm_particles_add_field(w.set[0], NULL, MPM_F64, 1), MPM_E_ARG, "field is NULL");
  for (int i = 0; i < 5; ++i)
    ck_refused(&w, mpm_particles_add_field(w.set[0], bad[i], MPM_F64, 1), MPM_E_ARG, "names are made of");
  ck_refused(&w, mpm_particles_add_field(w.set[0], longest, MPM_F64, 1), MPM_E_ARG, "48 characters");
  ck_refused(&w, mpm_particles_add_field(w.set[0], "mass", MPM_F64, 1), MPM_E_ARG, "\"mass\" already");
  ck_refused(&w, mpm_particles_add_field(w.set[0], "t", 0, 1), MPM_E_ARG, "type is 0");
  ck_refused(&w, mpm_particles_add_field(w.set[0], "t", 4, 1), MPM_E_ARG, "type is 4");
  ck_refused(&w, mpm_particles_add_field(w.set[0], "t", MPM_F64, 0), MPM_E_ARG, "components is 0");
  ck_refused(&w, mpm_particles_add_field(w.set[0], "t", MPM_F64, 65), MPM_E_ARG, "components is 65");
  ck_assert_int_eq(mpm_particles_add_field(NULL, "t", MPM_F64, 1), MPM_E_ARG);
  sets_unchanged(&w, was);
  longest[MPMI_NAME - 1] = '\0';
  ck_ok(&w, mpm_particles_add_field(w.set[0], longest, MPM_F64, 1));
  ck_refused(&w, mpm_particles_add_field(w.set[0], longest, MPM_U8, 2), MPM_E_ARG, "already");
  for (char name[] = "x0"; w.set[0]->field_count < MPMI_MAX_FIELDS;) {
    name[0] = (char)('a' + w.set[0]->field_count % 26);
    name[1] = (char)('0' + w.set[0]->field_count / 26);
    ck_ok(&w, mpm_particles_add_field(w.set[0], name, MPM_U8, 1));
  }
  ck_refused(&w, mpm_particles_add_field(w.set[0], "t", MPM_F64, 1), MPM_E_STATE, "64 fields");
}
END_TEST

/* ---- storage ---- */
START_TEST(leading_dimensions) {
  ck_assert_int_eq(mpmi_leading_dimension(1), 16);
  for (int64_t slots = 1; slots < 200000; slots = slots * 5 / 4 + 1) {
    int64_t ld = mpmi_leading_dimension(slots);
    ck_assert_int_ge(ld, slots);
    ck_assert_int_le(ld, slots + 7 * MPMI_PAD);
    ck_assert_int_eq(ld % MPMI_PAD, 0);
    for (int32_t c = 1; c < 9 && ld > MPMI_PAD; ++c) ck_assert_int_ne(c * ld * 8 % 4096, 0);
  }
}
END_TEST

START_TEST(reserving) {
  int64_t ld = w.set[0]->ld, held = w.memory.held;
  ck_ok(&w, mpmi_particles_reserve(w.set[0], ld));
  ck_assert_int_eq(w.memory.held, held);
  ck_refused(&w, mpmi_particles_reserve(w.set[0], INT64_C(0xffffffff)), MPM_E_ARG, "too many");
  for (int64_t k = 1; k <= 12; ++k) { /* 8 fields, 4 of them twice */
    w.memory.fail_at = w.memory.calls + k;
    ck_refused(&w, mpmi_particles_reserve(w.set[0], 1000), MPM_E_NOMEM, "out of memory");
    ck_assert_int_eq(w.memory.held, held);
    ck_assert_int_eq(w.set[0]->ld, ld);
  }
  w.memory.fail_at = 0;
  ck_ok(&w, mpmi_particles_reserve(w.set[0], 1000));
  ck_assert_int_ge(w.set[0]->ld, 1000);
  for (int64_t id = 0; id < 20; ++id)
    ck_assert_double_eq(sets_get(&w, "volume", 1, 0, id), 0.125 * (double)(id + 1));
}
END_TEST

START_TEST(lookups) {
  const int64_t ids[] = {1000, 25, 26, 27, 500};
  sets_add(&w, 5, ids);
  ck_ok(&w, mpmi_index_build(w.set[0]));
  for (int64_t id = -3; id < 1005; ++id) {
    int64_t slot = mpmi_index_find(w.set[0], id);
    int known = (id >= 0 && id < 20) || (id >= 25 && id <= 27) || id == 500 || id == 1000;
    ck_assert_int_eq(slot >= 0, known);
    if (known) ck_assert_int_eq(mpmi_i64(w.set[0], MPMI_ID, 0)[slot], id);
  }
  ck_assert_int_eq(mpmi_index_find(w.set[0], INT64_MIN), -1);
  ck_assert_int_eq(mpmi_index_find(w.set[0], INT64_MAX), -1);
  int64_t calls = w.memory.calls;
  ck_ok(&w, mpmi_index_build(w.set[0]));
  ck_assert_int_eq(w.memory.calls, calls);
}
END_TEST

START_TEST(radix_sorts) {
  enum { N = 3000 };
  static uint64_t key[N], keep[N], key_scratch[N];
  static uint32_t order[N], order_scratch[N];
  static const uint64_t mask[] = {0xff, 0xff00ff, 0x7, 0, ~UINT64_C(0), UINT64_C(0xff00000000000000)};
  uint64_t random = 88172645463325252u;
  for (int m = 0; m < 6; ++m)
    for (int64_t n = 0; n <= N; n = 3 * n + 1) {
      for (int64_t i = 0; i < n; ++i) {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        keep[i] = key[i] = random & mask[m];
      }
      mpmi_radix_sort(n, key, order, key_scratch, order_scratch);
      for (int64_t i = 1; i < n; ++i) {
        uint64_t a = keep[order[i - 1]], b = keep[order[i]];
        ck_assert(a < b || (a == b && order[i - 1] < order[i]));
      }
    }
}
END_TEST

Suite *fields_suite(void) {
  Suite *suite = suite_create("fields");
  TCase *tests = tcase_create("fields");
  tcase_add_checked_fixture(tests, open_set, close_set);
  tcase_add_test(tests, built_in_fields);
  tcase_add_test(tests, present_and_doubled);
  tcase_add_test(tests, added_fields);
  tcase_add_test(tests, bad_added_fields);
  tcase_add_test(tests, leading_dimensions);
  tcase_add_test(tests, reserving);
  tcase_add_test(tests, lookups);
  tcase_add_test(tests, radix_sorts);
  suite_add_tcase(suite, tests);
  return suite;
}
