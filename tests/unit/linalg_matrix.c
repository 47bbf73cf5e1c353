/* Block matrices: products, held unknowns, memory. */
#include "linalg.h"

static const springs shapes[] = {
    {.dim = 1, .block = 1, .reach = 1, .n = {23}, .mass = 0.1, .clamped = 1},
    {.dim = 2, .block = 2, .reach = 2, .n = {6, 5}, .mass = 0.2, .rollers = 1, .convection = 0.3},
    {.dim = 3, .block = 3, .reach = 1, .n = {4, 3, 5}, .mass = 0.2, .clamped = 1, .rollers = 1, .holes = 9},
    {.dim = 2, .block = 3, .reach = 1, .n = {7, 4}, .mass = 0.2, .periodic = 1}};
enum { SHAPES = 4 };

START_TEST(products) {
  mpm_context *context = context_with(1, MPM_ISA_BEST, NULL);
  mpmi_matrix A;
  springs_build(&A, context, &shapes[_i]);
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *a = dense_of(&A), *x = noise_vector(&A, 1), *b = noise_vector(&A, 2), dot, norm, rounding;
  double *y = malloc((size_t)n * sizeof *y), *r = malloc((size_t)n * sizeof *r);
  for (int64_t i = 0; i < n; ++i) x[i] += A.held[i] ? 3.0 : 0.0; /* held ones are multiplied, too */
  ck_ok(context, mpmi_matrix_apply_dot(&A, x, y, &dot, MPM_OK));
  ck_ok(context, mpmi_matrix_residual(&A, b, x, r, &norm));
  double wanted_dot = 0.0, wanted_norm = 0.0, size = 0.0;
  for (int64_t i = 0; i < n; ++i) {
    double sum = 0.0, magnitude = fabs(b[i]);
    for (int64_t j = 0; j < n; ++j) {
      sum += a[i * n + j] * x[j];
      magnitude += fabs(a[i * n + j] * x[j]);
    }
    ck_assert_double_eq_tol(y[i], sum, 1e-13);
    ck_assert_double_eq_tol(r[i], b[i] - sum, 1e-13);
    wanted_dot += sum * x[i];
    wanted_norm += (b[i] - sum) * (b[i] - sum);
    size += magnitude * magnitude;
  }
  ck_assert_double_eq_tol(dot, wanted_dot, 1e-11);
  ck_assert_double_eq_tol(norm, sqrt(wanted_norm), 1e-12);
  ck_ok(context, mpmi_matrix_rounding(&A, b, x, y, &rounding));
  ck_assert_double_eq_tol(rounding / (32.0 * DBL_EPSILON * sqrt(size)), 1.0, 1e-12);
  free(a), free(x), free(b), free(y), free(r);
  mpmi_matrix_free(&A);
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Rows and columns of held unknowns are those of the identity, and nothing else has changed. */
START_TEST(elimination) {
  mpm_context *context = context_with(1, MPM_ISA_BEST, NULL);
  mpmi_matrix A, B;
  springs whole = shapes[2];
  whole.clamped = whole.rollers = 0;
  springs_build(&A, context, &shapes[2]);
  springs_build(&B, context, &whole);
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *a = dense_of(&A), *b = dense_of(&B);
  int64_t held = 0;
  for (int64_t i = 0; i < n; ++i) {
    held += A.held[i];
    for (int64_t j = 0; j < n; ++j) {
      const double wanted = A.held[i] || A.held[j] ? (i == j ? 1.0 : 0.0) : b[i * n + j];
      ck_assert(a[i * n + j] == wanted);
    }
  }
  ck_assert_int_gt(held, 10);
  free(a), free(b);
  mpmi_matrix_free(&A);
  mpmi_matrix_free(&B);
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Sums of all lengths around the size of a range. */
START_TEST(dots) {
  static const int64_t lengths[] = {0, 1, 3, 5, 511, 512, 513, 1500, 2000, 131072, 131073, 200001};
  mpm_context *context = context_with(2, MPM_ISA_BEST, NULL);
  for (int32_t k = 0; k < 12; ++k) {
    const int64_t n = lengths[k];
    double *a = malloc((size_t)(n + 1) * sizeof *a), *b = malloc((size_t)(n + 1) * sizeof *b), dot, norm;
    double wanted = 0.0, squares = 0.0;
    for (int64_t i = 0; i < n; ++i) {
      a[i] = (double)(i % 17) - 5.0;
      b[i] = (double)(i % 13) - 4.0;
      wanted += a[i] * b[i]; /* whole numbers: no rounding */
      squares += a[i] * a[i];
    }
    ck_ok(context, mpmi_dot(context, a, b, n, &dot));
    ck_ok(context, mpmi_norm(context, a, n, &norm));
    ck_assert(dot == wanted && norm == sqrt(squares));
    free(a), free(b);
  }
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Room is kept while it is enough; a block of another size wants other room. */
START_TEST(room) {
  host_memory memory = {0};
  mpm_context *context = context_with(1, MPM_ISA_BEST, &memory);
  mpmi_matrix A;
  const int64_t before = memory.held;
  mpmi_matrix_init(&A, context);
  ck_ok(context, mpmi_matrix_reserve(&A, 100, 900, 2));
  ck_assert(A.rows == 100 && A.block == 2);
  const int64_t calls = memory.calls;
  A.row_start[100] = 900;
  A.value[900 * 4 - 1] = 1.0;
  A.position[299] = 1.0;
  ck_ok(context, mpmi_matrix_reserve(&A, 40, 300, 2));
  ck_ok(context, mpmi_matrix_reserve(&A, 105, 905, 2)); /* some slack is there */
  ck_assert_int_eq(memory.calls, calls);
  ck_ok(context, mpmi_matrix_reserve(&A, 100, 900, 3));
  ck_assert_int_gt(memory.calls, calls);
  A.value[900 * 9 - 1] = 1.0;
  A.held[299] = 1;
  for (int64_t k = 1;; ++k) {
    memory.fail_at = memory.calls + k;
    const mpm_status status = mpmi_matrix_reserve(&A, 200, 1800, 3);
    memory.fail_at = 0;
    if (!status) break;
    ck_assert_int_eq(status, MPM_E_NOMEM);
    ck_assert_int_eq(memory.held, before);
    ck_assert(A.rows == 0 && !A.value && !A.row_start);
  }
  ck_assert_int_eq(A.rows, 200);
  mpmi_matrix_free(&A);
  ck_assert_int_eq(memory.held, before);
  ck_assert_int_eq(mpmi_matrix_reserve(&A, INT64_MAX / 2, 5, 3), MPM_E_NOMEM);
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

TCase *linalg_matrix_case(void) {
  TCase *tests = tcase_create("matrix");
  tcase_add_loop_test(tests, products, 0, SHAPES);
  tcase_add_test(tests, elimination);
  tcase_add_test(tests, dots);
  tcase_add_test(tests, room);
  return tests;
}
