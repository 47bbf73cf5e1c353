/* Grids: descriptions that are taken and refused, numbers of nodes, bounds and periods. */
#include "sets.h"

static world w;

static void open_context(void) {
  w.context = context_with(1, MPM_ISA_BEST, &w.memory);
}

static void close_context(void) {
  ck_assert_int_eq(w.context->children, 0);
  world_close(&w);
}

static void refused(const mpm_grid_desc *desc, mpm_status status, const char *text) {
  mpm_grid *grid = (mpm_grid *)&grid;
  ck_refused(&w, mpm_grid_create(w.context, desc, &grid), status, text);
  ck_assert_ptr_null(grid);
}

static mpm_grid *made(const mpm_grid_desc *desc) {
  mpm_grid *grid = NULL;
  ck_ok(&w, mpm_grid_create(w.context, desc, &grid));
  return grid;
}

START_TEST(defaults) {
  mpm_grid_desc d;
  memset(&d, 0xff, sizeof d);
  ck_ok(&w, mpm_grid_desc_init(&d, sizeof d));
  ck_assert_uint_eq(d.struct_size, sizeof d);
  ck_assert_int_eq(d.dim, 3);
  ck_assert_int_eq(d.basis, MPM_BSPLINE2);
  ck_assert_int_eq(d.boundary_basis, MPM_BOUNDARY_GHOST);
  ck_assert_double_eq(d.smoothing, 0.5);
  for (int k = 0; k < 3; ++k) {
    ck_assert_int_eq(d.periodic[k], 0);
    ck_assert_int_eq(d.cells[k], 0);
    ck_assert_double_eq(d.origin[k], 0.0);
    ck_assert_double_eq(d.spacing[k], 0.0);
  }
  ck_assert_int_eq(mpm_grid_desc_init(NULL, sizeof d), MPM_E_ARG);
  ck_assert_int_eq(mpm_grid_desc_init(&d, 4), MPM_E_ARG);
}
END_TEST

START_TEST(derived_values) {
  for (int32_t dim = 1; dim <= 3; ++dim)
    for (int32_t basis = MPM_LINEAR; basis <= MPM_BSPLINE3; ++basis) {
      mpm_grid_desc d = sets_grid(dim);
      d.basis = basis;
      d.spacing[dim - 1] = 0.25;
      mpm_grid *grid = made(&d);
      ck_assert_int_eq(grid->dim, dim);
      ck_assert_int_eq(grid->family, MPMI_FAMILY_BSPLINE1 + basis - MPM_LINEAR);
      ck_assert_int_eq(grid->width, basis + 1);
      ck_assert_int_eq(w.context->children, 1);
      ck_assert_double_eq(grid->h_min, 0.25);
      for (int32_t k = 0; k < dim; ++k) {
        ck_assert_double_eq(grid->upper[k], -1.0 + (double)d.cells[k] * d.spacing[k]);
        ck_assert_double_eq(grid->inverse_spacing[k], 1.0 / d.spacing[k]);
      }
      ck_ok(&w, mpm_grid_destroy(grid));
    }
}
END_TEST

START_TEST(axes_beyond_dim_are_ignored) {
  for (int32_t dim = 1; dim <= 2; ++dim) {
    mpm_grid_desc d = sets_grid(dim);
    for (int32_t k = dim; k < 3; ++k) {
      d.cells[k] = -5;
      d.spacing[k] = d.origin[k] = NOT_A_NUMBER;
      d.periodic[k] = 17;
    }
    mpm_grid *grid = made(&d);
    ck_assert_int_eq(grid->desc.cells[2], 1);
    ck_assert_int_eq(grid->desc.periodic[2], 0);
    ck_assert_double_eq(grid->desc.spacing[2], 1.0);
    ck_assert_double_eq(grid->h_min, 0.5);
    ck_ok(&w, mpm_grid_destroy(grid));
  }
}
END_TEST

START_TEST(bad_values_are_named) {
  const mpm_grid_desc good = sets_grid(3);
  mpm_grid_desc d;
#define REFUSED(set, text) (d = good, set, refused(&d, MPM_E_ARG, text))
  REFUSED(d.dim = 0, "dim is 0");
  REFUSED(d.dim = 4, "dim is 4");
  REFUSED(d.dim = -1, "dim is -1");
  REFUSED(d.cells[1] = 0, "cells[1] is 0");
  REFUSED(d.cells[2] = -7, "cells[2] is -7");
  REFUSED(d.cells[0] = (6 << 20) + 1, "cells[0] is 6291457");
  REFUSED(d.cells[0] = INT64_MAX, "21 bits");
  REFUSED(d.spacing[0] = 0.0, "spacing[0] is 0");
  REFUSED(d.spacing[1] = -0.5, "spacing[1] is -0.5");
  REFUSED(d.spacing[2] = NOT_A_NUMBER, "spacing[2] is nan");
  REFUSED(d.spacing[2] = INFINITE, "spacing[2] is inf");
  REFUSED(d.spacing[2] = 1e-310, "spacing[2] is 1e-310");
  REFUSED(d.spacing[1] = 1e308, "spacing[1]");
  REFUSED(d.origin[0] = NOT_A_NUMBER, "origin[0] is nan");
  REFUSED(d.origin[1] = -INFINITE, "origin[1] is -inf");
  REFUSED(d.origin[2] = 1e17, "does not resolve");
  REFUSED(d.periodic[0] = 2, "periodic[0] is 2");
  REFUSED(d.periodic[2] = -1, "periodic[2] is -1");
  REFUSED(d.basis = 0, "basis is 0");
  REFUSED(d.basis = 19, "basis is 19");
  REFUSED(d.boundary_basis = 2, "boundary_basis is 2");
  REFUSED(d.boundary_basis = -1, "boundary_basis is -1");
  REFUSED(d.smoothing = 0.0, "smoothing is 0");
  REFUSED(d.smoothing = 1.5, "smoothing is 1.5");
  REFUSED(d.smoothing = NOT_A_NUMBER, "smoothing is nan");
  REFUSED(d.geometry = 3, "geometry is 3");
  REFUSED(d.cells[0] = d.cells[1] = d.cells[2] = 6 << 20, "63 bits");
  REFUSED(d.struct_size = 8, "struct_size");
#undef REFUSED
}
END_TEST

START_TEST(open_knots_are_for_splines) {
  static const int32_t basis[] = {MPM_LINEAR, MPM_GIMP, MPM_UGIMP, MPM_CPGIMP};
  mpm_grid_desc d = sets_grid(2);
  d.boundary_basis = MPM_BOUNDARY_OPEN_KNOT;
  for (int i = 0; i < 4; ++i) {
    d.basis = basis[i];
    refused(&d, MPM_E_UNSUPPORTED, "MPM_BOUNDARY_GHOST");
  }
}
END_TEST

/* Greville points: the mean of the inner knots of each function. */
START_TEST(places_of_nodes) {
  mpm_grid_desc d = sets_grid(1);
  const double cells = (double)d.cells[0], quadratic[] = {0.0, 0.5, 1.5},
               cubic[] = {0.0, 1.0 / 3.0, 1.0, 2.0};
  d.boundary_basis = MPM_BOUNDARY_OPEN_KNOT;
  d.basis = MPM_BSPLINE2;
  mpm_grid *grid = made(&d);
  for (int32_t i = 0; i < 3; ++i) {
    ck_assert_double_eq_tol(mpmi_node_position(grid, 0, i), -1.0 + quadratic[i] * d.spacing[0], 1e-15);
    ck_assert_double_eq_tol(mpmi_node_position(grid, 0, d.cells[0] + 1 - i),
                            -1.0 + (cells - quadratic[i]) * d.spacing[0], 1e-14);
  }
  ck_assert_int_eq(mpmi_face_node(grid, MPM_X_MIN), 0);
  ck_assert_int_eq(mpmi_face_node(grid, MPM_X_MAX), d.cells[0] + 1);
  ck_ok(&w, mpm_grid_destroy(grid));
  d.basis = MPM_BSPLINE3;
  grid = made(&d);
  for (int32_t i = 0; i < 4; ++i) {
    ck_assert_double_eq_tol(mpmi_node_position(grid, 0, i - 1), -1.0 + cubic[i] * d.spacing[0], 1e-15);
    ck_assert_double_eq_tol(mpmi_node_position(grid, 0, d.cells[0] + 1 - i),
                            -1.0 + (cells - cubic[i]) * d.spacing[0], 1e-14);
  }
  ck_assert_int_eq(mpmi_face_node(grid, MPM_X_MIN), -1);
  ck_ok(&w, mpm_grid_destroy(grid));
}
END_TEST

START_TEST(limits_are_inside) {
  mpm_grid_desc d = sets_grid(2);
  d.cells[0] = d.cells[1] = 6 << 20;
  d.spacing[0] = d.spacing[1] = 1e-3;
  d.smoothing = 1e-9;
  ck_ok(&w, mpm_grid_destroy(made(&d)));
  d.cells[0] = d.cells[1] = 1;
  d.periodic[0] = 1;
  ck_ok(&w, mpm_grid_destroy(made(&d)));
}
END_TEST

static mpm_material *some_material(void) {
  mpm_material *material;
  ck_ok(&w, law_create(w.context, &(world_law){.model = "neo_hookean", .E = 1e6, .nu = 0.3, .density = 2e3},
                       &material));
  return material;
}

START_TEST(misuse) {
  mpm_grid_desc d = sets_grid(3);
  mpm_grid *grid;
  mpm_material *material = some_material();
  ck_assert_int_eq(mpm_grid_create(NULL, &d, &grid), MPM_E_ARG);
  ck_assert_int_eq(mpm_grid_create((mpm_context *)material, &d, &grid), MPM_E_ARG);
  ck_refused(&w, mpm_grid_create(w.context, &d, NULL), MPM_E_ARG, "out");
  refused(NULL, MPM_E_ARG, "mpm_grid_desc is NULL");
  ck_ok(&w, mpm_grid_destroy(NULL));
  ck_assert_int_eq(mpm_grid_destroy((mpm_grid *)material), MPM_E_ARG);
  ck_ok(&w, mpm_material_destroy(material));
  w.memory.fail_at = w.memory.calls + 1;
  refused(&d, MPM_E_NOMEM, "out of memory");
}
END_TEST

START_TEST(goes_after_its_sets) {
  mpm_grid_desc d = sets_grid(3);
  mpm_grid *grid = made(&d);
  mpm_material *material = some_material();
  mpm_particles *set;
  ck_ok(&w, mpm_particles_create(w.context, grid, material, &set));
  ck_refused(&w, mpm_grid_destroy(grid), MPM_E_STATE, "1 sets and steppers");
  ck_ok(&w, mpm_particles_destroy(set));
  ck_ok(&w, mpm_grid_destroy(grid));
  ck_ok(&w, mpm_material_destroy(material));
}
END_TEST

/* Numbers of the nodes low[] ... high[] are 0, 1, 2 ..., last axis fastest. */
static void check_numbers(const mpm_grid *grid, const int64_t *low, const int64_t *high) {
  int64_t i[3], expected = 0;
  for (i[0] = low[0]; i[0] <= high[0]; ++i[0])
    for (i[1] = low[1]; i[1] <= high[1]; ++i[1])
      for (i[2] = low[2]; i[2] <= high[2]; ++i[2]) ck_assert_int_eq(mpmi_node_number(grid, i), expected++);
}

START_TEST(node_numbers) {
  mpm_grid_desc d = sets_grid(3);
  mpm_grid *grid = made(&d);
  check_numbers(grid, (int64_t[]){-1, -1, -1}, (int64_t[]){11, 10, 9});
  ck_ok(&w, mpm_grid_destroy(grid));
  d.basis = MPM_LINEAR;
  d.periodic[1] = 1;
  grid = made(&d);
  check_numbers(grid, (int64_t[]){-1, -1, -1}, (int64_t[]){11, 10, 9});
  ck_ok(&w, mpm_grid_destroy(grid));
  d = sets_grid(1);
  grid = made(&d);
  check_numbers(grid, (int64_t[]){-1, 0, 0}, (int64_t[]){11, 0, 0});
  ck_ok(&w, mpm_grid_destroy(grid));
}
END_TEST

START_TEST(places_inside_and_outside) {
  mpm_grid_desc d = sets_grid(3); /* [-1, 4] x [-1, 3.5] x [-1, 3] */
  mpm_grid *grid = made(&d);
  double on_bounds[] = {-1.0, 3.5, 3.0};
  ck_assert_int_eq(mpmi_grid_place(grid, on_bounds, 1, NULL, 0), -1);
  static const double bad[] = {-1.0000001, 4.5, NOT_A_NUMBER, INFINITE, -INFINITE};
  for (int32_t k = 0; k < 3; ++k)
    for (int i = 0; i < 5; ++i) {
      double x[] = {0.0, 9.0, 0.0, 9.0, 0.0}; /* stride 2 */
      x[2 * k] = bad[i];
      ck_assert_int_eq(mpmi_grid_place(grid, x, 2, NULL, 0), k);
    }
  ck_ok(&w, mpm_grid_destroy(grid));
}
END_TEST

START_TEST(wraps_periods) {
  mpm_grid_desc d = sets_grid(2); /* [-1, 4] x [-1, 3.5] */
  d.periodic[0] = 1;
  mpm_grid *grid = made(&d);
  static const double from[] = {4.0, -1.0, 4.5, -1.5, 14.25, -11.0, 3.75};
  static const double to[] = {-1.0, -1.0, -0.5, 3.5, -0.75, -1.0, 3.75};
  static const int64_t periods[] = {1, 0, 1, -1, 3, -2, 0};
  for (int i = 0; i < 7; ++i) {
    double x[] = {from[i], 2.0};
    int64_t image[] = {10, 77, 20, 77};
    ck_assert_int_eq(mpmi_grid_place(grid, x, 1, image, 2), -1);
    ck_assert_double_eq(x[0], to[i]);
    ck_assert_double_eq(x[1], 2.0);
    ck_assert_int_eq(image[0], 10 + periods[i]);
    ck_assert_int_eq(image[2], 20);
    x[0] = from[i];
    ck_assert_int_eq(mpmi_grid_place(grid, x, 1, NULL, 0), -1);
    ck_assert_double_eq(x[0], to[i]);
  }
  /* Just below a face: the remainder rounds to the upper face, which is the lower one of the next period. */
  double edge[] = {nextafter(-1.0, -2.0), 2.0};
  int64_t image[] = {0, 0};
  ck_assert_int_eq(mpmi_grid_place(grid, edge, 1, image, 1), -1);
  ck_assert_double_ge(edge[0], -1.0);
  ck_assert_double_lt(edge[0], 4.0);
  ck_assert_double_le(fabs(edge[0] + 5.0 * (double)image[0] + 1.0), 1e-15);
  /* Nothing moves when another axis is bad, or when the period cannot be told. */
  static const double bad[][2] = {{4.5, 3.6}, {1e30, 2.0}, {INFINITE, 2.0}, {NOT_A_NUMBER, 2.0}};
  for (int i = 0; i < 4; ++i) {
    double x[] = {bad[i][0], bad[i][1]};
    ck_assert_int_eq(mpmi_grid_place(grid, x, 1, image, 1), i == 0);
    ck_assert_int_eq(memcmp(x, bad[i], sizeof x), 0);
  }
  ck_ok(&w, mpm_grid_destroy(grid));
}
END_TEST

Suite *grid_suite(void) {
  Suite *suite = suite_create("grid");
  TCase *tests = tcase_create("grid");
  tcase_add_checked_fixture(tests, open_context, close_context);
  tcase_add_test(tests, defaults);
  tcase_add_test(tests, derived_values);
  tcase_add_test(tests, axes_beyond_dim_are_ignored);
  tcase_add_test(tests, bad_values_are_named);
  tcase_add_test(tests, open_knots_are_for_splines);
  tcase_add_test(tests, places_of_nodes);
  tcase_add_test(tests, limits_are_inside);
  tcase_add_test(tests, misuse);
  tcase_add_test(tests, goes_after_its_sets);
  tcase_add_test(tests, node_numbers);
  tcase_add_test(tests, places_inside_and_outside);
  tcase_add_test(tests, wraps_periods);
  suite_add_tcase(suite, tests);
  return suite;
}
