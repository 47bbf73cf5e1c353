/* Lattices: which points of boxes, balls and the host's own shapes become particles. */
#include "sets.h"

static world w;

static void open_set(void) {
  sets_open(&w, 3, "linear_elastic", 0);
}

static void close_set(void) {
  sets_close(&w);
}

static const double low_corner[] = {-1, -1, -1};

START_TEST(fills_boxes) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    sets_open(&w, dim, "linear_elastic", 0);
    int32_t per[] = {2, 2, 2};
    double lower[] = {0, 0.5, -0.5}, upper[] = {1.5, 1, 0.5};
    int64_t first = -1, count = -1, expected = 6;
    if (dim > 1) expected *= 2;
    if (dim > 2) expected *= 4;
    w.set[0]->next_id = 100;
    ck_ok(&w, mpm_particles_fill_box(w.set[0], lower, upper, per, &first, &count));
    ck_assert_int_eq(first, 100);
    ck_assert_int_eq(count, expected);
    ck_assert_int_eq(mpm_particles_count(w.set[0]), expected);
    ck_assert_int_eq(w.set[0]->next_id, 100 + expected);
    ck_assert_int_eq(w.set[0]->field[MPMI_SIZE].present, 0);
    double volume = pow(0.25, dim);
    for (int64_t id = 100; id < 100 + count; ++id) {
      int64_t rest = id - 100; /* last axis fastest */
      for (int32_t k = dim - 1; k >= 0; --k) {
        int64_t n = (int64_t)((upper[k] - lower[k]) / 0.25);
        ck_assert_double_eq(sets_get(&w, "position", dim, k, id),
                            lower[k] + 0.125 + 0.25 * (double)(rest % n));
        rest /= n;
      }
      ck_assert_double_eq(sets_get(&w, "volume", 1, 0, id), volume);
      ck_assert_double_eq(sets_get(&w, "mass", 1, 0, id), 2e3 * volume);
    }
    ck_ok(&w, mpm_particles_fill_box(w.set[0], lower, upper, per, NULL, NULL));
    sets_check_slots(&w);
  }
}
END_TEST

START_TEST(boxes_are_half_open) {
  sets_open(&w, 1, "linear_elastic", 0);
  int64_t count;
  /* centres at -0.75, -0.25, 0.25 ... */
  ck_ok(&w,
        mpm_particles_fill_box(w.set[0], (double[]){-0.25}, (double[]){0.75}, (int32_t[]){1}, NULL, &count));
  ck_assert_int_eq(count, 2);
  ck_assert_double_eq(sets_get(&w, "position", 1, 0, 0), -0.25);
  ck_ok(&w,
        mpm_particles_fill_box(w.set[0], (double[]){-0.2}, (double[]){0.2}, (int32_t[]){1}, NULL, &count));
  ck_assert_int_eq(count, 0);
  ck_ok(&w, mpm_particles_fill_box(w.set[0], (double[]){-1 - 4e-12}, (double[]){4 + 4e-12}, (int32_t[]){3},
                                   NULL, &count));
  ck_assert_int_eq(count, 30);
}
END_TEST

static mpm_status everywhere(void *user, int32_t dim, int64_t n, int64_t ld, const double *position,
                             uint8_t *inside) {
  (void)user, (void)dim, (void)ld, (void)position;
  memset(inside, 1, (size_t)n);
  return 0;
}

/* Every shape is cut off at the faces of the grid, and the count says what is left. */
START_TEST(shapes_beyond_the_grid) {
  for (int32_t dim = 1; dim <= 3; ++dim) {
    sets_open(&w, dim, "linear_elastic", 0);
    const double low[] = {-1e6, -1.5, -9}, inner[] = {-1, -1, -1}, high[] = {0.5, 0, 0.5},
                 centre[] = {-1, -1, -1};
    const int32_t per[] = {2, 2, 2};
    int64_t inside, count;
    ck_ok(&w, mpm_particles_fill_box(w.set[0], inner, high, per, NULL, &inside));
    ck_assert_int_gt(inside, 0);
    ck_ok(&w, mpm_particles_fill_box(w.set[0], low, high, per, NULL, &count));
    ck_assert_int_eq(count, inside);
    ck_ok(&w, mpm_particles_fill(w.set[0], low, high, per, everywhere, NULL, NULL, &count));
    ck_assert_int_eq(count, inside);
    ck_ok(&w, mpm_particles_fill_ball(w.set[0], centre, 0.9, per, NULL, &count)); /* a part of the ball */
    ck_assert_int_gt(count, 0);
    sets_check_slots(&w);
  }
}
END_TEST

START_TEST(uneven_lattices_keep_sizes) {
  int64_t count;
  ck_ok(&w, mpm_particles_fill_box(w.set[0], low_corner, (double[]){-0.5, -0.5, -0.5}, (int32_t[]){1, 2, 4},
                                   NULL, &count));
  ck_assert_int_eq(count, 8);
  ck_assert_int_eq(w.set[0]->field[MPMI_SIZE].present, 1);
  ck_assert_double_eq(sets_get(&w, "size", 3, 0, 3), 0.5);
  ck_assert_double_eq(sets_get(&w, "size", 3, 1, 3), 0.25);
  ck_assert_double_eq(sets_get(&w, "size", 3, 2, 3), 0.125);
  ck_assert_double_eq(sets_get(&w, "volume", 1, 0, 3), 0.5 * 0.25 * 0.125);
  ck_ok(&w, mpm_particles_fill_box(w.set[0], low_corner, (double[]){-0.5, -0.5, -0.5}, (int32_t[]){1, 1, 1},
                                   NULL, &count));
  ck_assert_double_eq_tol(sets_get(&w, "size", 3, 1, 8), 0.5, 1e-15);
}
END_TEST

START_TEST(bad_boxes) {
  const double upper[] = {0, 0, 0};
  const int32_t per[] = {1, 1, 1};
  sets_counts was = sets_take(&w);
  int64_t first = 7, count = 7;
#define REFUSED(low, up, cell, text)                                                                         \
  ck_refused(&w, mpm_particles_fill_box(w.set[0], low, up, cell, &first, &count), MPM_E_ARG, text)
  REFUSED(NULL, upper, per, "lower is NULL");
  REFUSED(low_corner, NULL, per, "upper is NULL");
  REFUSED(low_corner, upper, NULL, "per_cell is NULL");
  REFUSED(((double[]){-3, -1, -1}), ((double[]){-1.1, 0, 0}), per, "beyond the grid");
  REFUSED(((double[]){-1, NOT_A_NUMBER, -1}), upper, per, "lower[1] is nan");
  REFUSED(((double[]){0, 40, 0}), ((double[]){1, 41, 1}), per, "from 40 to 41 on axis 1");
  REFUSED(low_corner, ((double[]){-1, 0, 0}), per, "must be below upper[0]");
  REFUSED(low_corner, ((double[]){0, 0, INFINITE}), per, "upper[2] is inf");
  REFUSED(low_corner, ((double[]){0, 0, -1}), per, "lower[2] is -1, must be below upper[2]");
  REFUSED(upper, low_corner, per, "must be below");
  REFUSED(low_corner, upper, ((int32_t[]){0, 1, 1}), "per_cell[0] is 0");
  REFUSED(low_corner, upper, ((int32_t[]){1, 65, 1}), "per_cell[1] is 65");
  REFUSED(low_corner, upper, ((int32_t[]){1, 1, -3}), "per_cell[2] is -3");
#undef REFUSED
  ck_refused(&w, mpm_particles_fill(w.set[0], low_corner, upper, per, NULL, NULL, NULL, NULL), MPM_E_ARG,
             "inside is NULL");
  ck_assert_int_eq(mpm_particles_fill_box(NULL, low_corner, upper, per, NULL, NULL), MPM_E_ARG);
  ck_assert_int_eq(first, 7);
  ck_assert_int_eq(count, 7);
  sets_unchanged(&w, was);
}
END_TEST

START_TEST(too_many_points) {
  mpm_grid_desc grid = sets_grid(2);
  grid.cells[0] = grid.cells[1] = 2000;
  sets_open_on(&w, &grid, "linear_elastic", 0);
  ck_refused(
      w.context,
      mpm_particles_fill_box(w.set[0], low_corner, (double[]){999, 999}, (int32_t[]){64, 64}, NULL, NULL),
      MPM_E_ARG, "lattice points");
  int64_t peak;
  ck_ok(&w, mpm_context_memory(w.context, NULL, &peak));
  ck_assert_int_lt(peak, 1 << 20);
}
END_TEST

START_TEST(lattice_cells_without_volume) {
  mpm_grid_desc grid = sets_grid(3);
  for (int k = 0; k < 3; ++k) {
    grid.spacing[k] = 1e-110;
    grid.origin[k] = 0.0;
  }
  sets_open_on(&w, &grid, "linear_elastic", 0);
  ck_refused(w.context,
             mpm_particles_fill_ball(w.set[0], (double[]){0, 0, 0}, 1e-109, (int32_t[]){1, 1, 1}, NULL, NULL),
             MPM_E_ARG, "a lattice cell has volume 0");
}
END_TEST

/* Lattice points within the radius, found the long way round. */
static int64_t points_in_ball(const double *centre, double radius, int32_t per) {
  int64_t found = 0, n[3] = {1, 1, 1}, i[3];
  for (int32_t k = 0; k < w.dim; ++k) n[k] = w.grid->desc.cells[k] * per;
  for (i[0] = 0; i[0] < n[0]; ++i[0])
    for (i[1] = 0; i[1] < n[1]; ++i[1])
      for (i[2] = 0; i[2] < n[2]; ++i[2]) {
        double square = 0;
        for (int32_t k = 0; k < w.dim; ++k) {
          double d = -1.0 + ((double)i[k] + 0.5) * 0.5 / per - centre[k];
          square += d * d;
        }
        found += square < radius * radius;
      }
  return found;
}

START_TEST(fills_balls) {
  static const double centre[][3] = {{1, 1, 1}, {0.9, 0.3, 1.7}, {-1, -1, -1}, {4, 3.5, 3}, {1.01, 1, 1}};
  static const double radius[] = {0.9, 1.2345, 1.1, 40.0, 1e-3};
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int i = 0; i < 5; ++i) {
      sets_open(&w, dim, "linear_elastic", 0);
      int64_t count = -1, first = -1;
      ck_ok(&w,
            mpm_particles_fill_ball(w.set[0], centre[i], radius[i], (int32_t[]){4, 4, 4}, &first, &count));
      ck_assert_int_eq(count, points_in_ball(centre[i], radius[i], 4));
      ck_assert_int_eq(count, mpm_particles_count(w.set[0]));
      ck_assert_int_eq(first, 0);
      sets_check_slots(&w);
    }
}
END_TEST

START_TEST(bad_balls) {
  static const double centre[] = {1, 1, 1};
  const int32_t per[] = {1, 1, 1};
  static const double bad[] = {0.0, -1.0, NOT_A_NUMBER, INFINITE};
  for (int i = 0; i < 4; ++i)
    ck_refused(&w, mpm_particles_fill_ball(w.set[0], centre, bad[i], per, NULL, NULL), MPM_E_ARG,
               "radius is");
  ck_refused(&w, mpm_particles_fill_ball(w.set[0], NULL, 1, per, NULL, NULL), MPM_E_ARG, "centre is NULL");
  ck_refused(&w, mpm_particles_fill_ball(w.set[0], centre, 1, NULL, NULL, NULL), MPM_E_ARG,
             "per_cell is NULL");
  ck_refused(&w, mpm_particles_fill_ball(w.set[0], (double[]){1, 9, 1}, 1, per, NULL, NULL), MPM_E_ARG,
             "centre[1] is 9");
  ck_refused(&w, mpm_particles_fill_ball(w.set[0], (double[]){1, 1, NOT_A_NUMBER}, 1, per, NULL, NULL),
             MPM_E_ARG, "centre[2] is nan");
  ck_refused(&w, mpm_particles_fill_ball(w.set[0], centre, 1, (int32_t[]){1, 0, 1}, NULL, NULL), MPM_E_ARG,
             "per_cell[1] is 0");
  ck_assert_int_eq(mpm_particles_fill_ball(NULL, centre, 1, per, NULL, NULL), MPM_E_ARG);
  ck_assert_int_eq(mpm_particles_count(w.set[0]), 0);
}
END_TEST

typedef struct shape {
  int64_t calls, points, fail_at;
  mpm_status status;
} shape;

/* Takes every third point, and checks how it is asked. */
static mpm_status every_third(void *user, int32_t dim, int64_t n, int64_t ld, const double *position,
                              uint8_t *inside) {
  shape *s = user;
  ck_assert_int_eq(dim, w.dim);
  ck_assert_int_ge(n, 1);
  ck_assert_int_le(n, 4096);
  ck_assert_int_ge(ld, n);
  for (int64_t i = 0; i < n; ++i) {
    for (int32_t k = 0; k < dim; ++k) ck_assert_double_ge(position[k * ld + i], -1.0);
    if ((s->points + i) % 3 == 0) inside[i] = 1;
  }
  s->points += n;
  return ++s->calls == s->fail_at ? s->status : MPM_OK;
}

START_TEST(fills_by_function) {
  const double upper[] = {4, 3.5, 3};
  const int32_t per[] = {2, 2, 2}; /* 20 x 18 x 16 = 5760 points */
  shape s = {0, 0, 0, MPM_OK};
  int64_t count;
  ck_ok(&w, mpm_particles_fill(w.set[0], low_corner, upper, per, every_third, &s, NULL, &count));
  ck_assert_int_eq(s.calls, 2);
  ck_assert_int_eq(s.points, 5760);
  ck_assert_int_eq(count, 1920);
  static const int64_t id[] = {0, 1365, 1366, 1919}; /* points 0, 4095, 4098, 5757 */
  for (int i = 0; i < 4; ++i) {
    int64_t point = 3 * id[i];
    ck_assert_double_eq(sets_get(&w, "position", 3, 0, id[i]), -0.875 + 0.25 * (double)(point / 288));
    ck_assert_double_eq(sets_get(&w, "position", 3, 1, id[i]), -0.875 + 0.25 * (double)(point / 16 % 18));
    ck_assert_double_eq(sets_get(&w, "position", 3, 2, id[i]), -0.875 + 0.25 * (double)(point % 16));
  }
  static const mpm_status status[] = {MPM_CUT_DT, -44};
  static const char *const text[] = {"returned 1", "returned -44"};
  sets_counts was = sets_take(&w);
  for (int i = 0; i < 2; ++i) {
    s = (shape){0, 0, 2, status[i]};
    ck_refused(&w, mpm_particles_fill(w.set[0], low_corner, upper, per, every_third, &s, NULL, NULL),
               MPM_E_CALLBACK, text[i]);
    sets_unchanged(&w, was);
    ck_assert_int_eq(w.memory.held, was.held);
  }
}
END_TEST

START_TEST(memory_of_a_fill) {
  mpm_grid_desc grid = sets_grid(3);
  for (int k = 0; k < 3; ++k) grid.cells[k] = 24;
  sets_open_on(&w, &grid, "linear_elastic", 0);
  int64_t before = w.memory.held, count, peak;
  ck_ok(&w, mpm_particles_fill_box(w.set[0], low_corner, (double[]){11, 11, 11}, (int32_t[]){2, 2, 2}, NULL,
                                   &count));
  ck_assert_int_eq(count, 48 * 48 * 48);
  ck_ok(&w, mpm_context_memory(w.context, NULL, &peak));
  double each = (double)(w.memory.held - before) / (double)count;
  if (each > 400.0) ck_abort_msg("%g bytes per particle", each);
  if ((double)(peak - before) / (double)count > 405.0) ck_abort_msg("peak %d", (int)(peak - before));
}
END_TEST

Suite *fill_suite(void) {
  Suite *suite = suite_create("fill");
  TCase *tests = tcase_create("fill");
  tcase_add_checked_fixture(tests, open_set, close_set);
  tcase_add_test(tests, fills_boxes);
  tcase_add_test(tests, boxes_are_half_open);
  tcase_add_test(tests, shapes_beyond_the_grid);
  tcase_add_test(tests, uneven_lattices_keep_sizes);
  tcase_add_test(tests, bad_boxes);
  tcase_add_test(tests, too_many_points);
  tcase_add_test(tests, lattice_cells_without_volume);
  tcase_add_test(tests, fills_balls);
  tcase_add_test(tests, bad_balls);
  tcase_add_test(tests, fills_by_function);
  tcase_add_test(tests, memory_of_a_fill);
  suite_add_tcase(suite, tests);
  return suite;
}
