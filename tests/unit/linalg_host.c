/* The host's solver: what it is shown, and that it is not believed. */
#include "linalg.h"

typedef struct host {
  int32_t calls, what;
  const mpm_operator *kept; /* after the call: not to be used any more */
  const mpmi_matrix *A;
  mpm_status returns;
  int64_t pattern_id; /* that it was told */
} host;
enum { GOOD, UNTOUCHED, NEARLY, TOO_FAR, BAD_NUMBER, BAD_COUNT, RETURNS };

static mpm_context *context;
static mpmi_solver *solver;
static mpmi_matrix A;
static mpmi_solve_report report;
static const springs shape = {
    .dim = 3, .block = 3, .reach = 1, .n = {4, 5, 3}, .mass = 0.1, .clamped = 1, .rollers = 1};

static void open_solver(void) {
  context = context_with(1, MPM_ISA_BEST, NULL);
  ck_ok(context, mpmi_solver_create(context, &solver));
  springs_build(&A, context, &shape);
}

static void close_solver(void) {
  mpmi_matrix_free(&A);
  mpmi_solver_destroy(solver);
  ck_ok(context, mpm_context_destroy(context));
}

/* Rows are the unknowns in the order of the nodes. */
static void check_info(const host *h, const mpm_operator *matrix, mpm_operator_info *info) {
  const mpmi_matrix *of = h->A;
  memset(info, 0, sizeof *info);
  ck_assert_int_eq(mpm_operator_get_info(matrix, info), MPM_E_ARG);
  ck_assert_int_eq(mpm_operator_get_info(matrix, NULL), MPM_E_ARG);
  info->struct_size = sizeof *info;
  ck_ok(NULL, mpm_operator_get_info(matrix, info));
  ck_assert(info->block == of->block && info->symmetric == of->symmetric && info->positive_definite == 1);
  ck_assert(info->pattern_id >= 0 && info->pattern_id < INT64_C(1) << 53 && info->ld >= info->rows);
  ck_assert(info->first_row == 0 && info->owned_rows == info->rows && info->all_rows == info->rows);
  int64_t r = 0;
  for (int64_t u = 0; u < mpmi_matrix_unknowns(of); ++u) {
    if (of->held[u]) continue;
    ck_assert_int_eq(info->node[r], of->number[u / of->block]);
    ck_assert_int_eq(info->component[r], u % of->block);
    ck_assert_int_eq(info->number[r], r);
    for (int64_t k = 0; k < 3; ++k)
      ck_assert(info->position[k * info->ld + r] == of->position[3 * (u / of->block) + k]);
    ++r;
  }
  ck_assert_int_eq(info->rows, r);
}

/* The matrix by rows, as dense, equals what is left of the whole one; apply agrees with it. */
static double *check_rows(const host *h, const mpm_operator *matrix, const mpm_operator_info *info) {
  const int64_t rows = info->rows, n = mpmi_matrix_unknowns(h->A), *row_start;
  const int32_t *column;
  const double *value;
  ck_assert_int_eq(mpm_operator_csr(matrix, NULL, &column, &value), MPM_E_ARG);
  ck_ok(NULL, mpm_operator_csr(matrix, &row_start, &column, &value));
  ck_assert(row_start[0] == 0 && row_start[rows] == info->nonzeros);
  double *a = calloc((size_t)(rows * rows), sizeof *a), *whole = dense_of(h->A);
  for (int64_t r = 0; r < rows; ++r)
    for (int64_t e = row_start[r]; e < row_start[r + 1]; ++e) {
      ck_assert(column[e] >= 0 && column[e] < rows);
      if (e > row_start[r]) ck_assert_int_gt(column[e], column[e - 1]);
      a[r * rows + column[e]] = value[e];
    }
  int64_t r = 0;
  for (int64_t i = 0; i < n; ++i) {
    if (h->A->held[i]) continue;
    int64_t c = 0;
    for (int64_t j = 0; j < n; ++j)
      if (!h->A->held[j]) ck_assert(a[r * rows + c++] == whole[i * n + j]);
    ++r;
  }
  double *x = malloc((size_t)rows * sizeof *x), *y = malloc((size_t)rows * sizeof *y);
  for (r = 0; r < rows; ++r) x[r] = cos((double)r);
  ck_assert_int_eq(mpm_operator_apply(matrix, NULL, y), MPM_E_ARG);
  ck_assert_int_eq(mpm_operator_apply(matrix, x, NULL), MPM_E_ARG);
  ck_ok(NULL, mpm_operator_apply(matrix, x, y));
  for (r = 0; r < rows; ++r) {
    double sum = 0.0;
    for (int64_t c = 0; c < rows; ++c) sum += a[r * rows + c] * x[c];
    ck_assert_double_eq_tol(y[r], sum, 1e-13);
  }
  free(x), free(y), free(whole);
  return a;
}

static mpm_status solve(void *user, const mpm_operator *matrix, const double *rhs, double *solution,
                        double tolerance, int64_t *iterations) {
  host *h = user;
  mpm_operator_info info;
  ++h->calls;
  h->kept = matrix;
  ck_assert_int_eq(*iterations, 0);
  ck_assert(tolerance == 1e-10);
  check_info(h, matrix, &info);
  h->pattern_id = info.pattern_id;
  double *a = check_rows(h, matrix, &info);
  for (int64_t r = 0; r < info.rows; ++r) ck_assert(solution[r] == 0.0);
  if (h->what != UNTOUCHED) {
    memcpy(solution, rhs, (size_t)info.rows * sizeof *rhs);
    dense_solve(info.rows, a, solution);
    *iterations = 17;
  }
  for (int64_t r = 0; r < info.rows; ++r)
    solution[r] *= h->what == NEARLY ? 1.0 + 5e-7 : h->what == TOO_FAR ? 1.0 + 2e-6 : 1.0;
  if (h->what == BAD_NUMBER) solution[info.rows - 1] = (double)NAN;
  if (h->what == BAD_COUNT) *iterations = -2;
  free(a);
  return h->what == RETURNS ? h->returns : 0;
}

/* A call of the host's solver that ends with this status. Returns the number of the pattern. */
static int64_t ask(int32_t what, mpm_status returns, mpm_status wanted, const char *text) {
  host h = {.what = what, .A = &A, .returns = returns};
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *x = noise_vector(&A, 8), *b = rhs_for(&A, x), *y = malloc((size_t)n * sizeof *y);
  mpmi_solve_job job = job_of(&A, b, y, MPM_SOLVER_HOST);
  job.host = solve;
  job.host_user = &h;
  if (wanted)
    refused(solver, &job, &report, wanted, text);
  else
    solved(solver, &job, &report);
  ck_assert(h.calls == 1 && report.solver == MPM_SOLVER_HOST);
  ck_assert_int_eq(report.callback_status, what == RETURNS ? returns : 0);
  if (!wanted) {
    ck_assert_double_lt(distance(n, y, x), what == NEARLY ? 6e-7 : 1e-10);
    ck_assert_int_eq(report.iterations, 17);
    for (int64_t i = 0; i < n; ++i)
      if (A.held[i]) ck_assert(y[i] == 0.0);
  }
  mpm_operator_info info = {.struct_size = sizeof info};
  const int64_t *row_start;
  const int32_t *column;
  const double *value;
  ck_refused(context, mpm_operator_get_info(h.kept, &info), MPM_E_STATE, "during the solve callback only");
  ck_assert_int_eq(mpm_operator_apply(h.kept, b, y), MPM_E_STATE);
  ck_assert_int_eq(mpm_operator_csr(h.kept, &row_start, &column, &value), MPM_E_STATE);
  free(x), free(b), free(y);
  return h.pattern_id;
}

START_TEST(good) {
  ask(GOOD, 0, MPM_OK, "");
  ask(NEARLY, 0, MPM_OK, "");
  mpmi_matrix_free(&A); /* another pattern, other unknowns, not symmetric */
  springs of = shape;
  of.block = 2;
  of.n[0] = 6;
  of.clamped = 0;
  of.convection = 0.2;
  springs_build(&A, context, &of);
  A.pattern_id = 2;
  ask(GOOD, 0, MPM_OK, "");
}
END_TEST

static int64_t pattern_of(const springs *of, int64_t counted) {
  mpmi_matrix_free(&A);
  springs_build(&A, context, of);
  A.pattern_id = counted;
  return ask(GOOD, 0, MPM_OK, "");
}

/* A host gives its solver to another stepper, where the library counts patterns from the beginning again. */
START_TEST(patterns) {
  springs turned = shape, loose = shape, wide = shape;
  turned.n[0] = shape.n[1];
  turned.n[1] = shape.n[0];
  loose.rollers = 0;
  wide.reach = 2;
  const int64_t first = pattern_of(&shape, 1);
  ck_assert_int_eq(pattern_of(&shape, 2), first);
  const int64_t second = pattern_of(&turned, 3), third = pattern_of(&loose, 4), fourth = pattern_of(&wide, 5);
  ck_assert(second != first && third != first && third != second);
  ck_assert(fourth != first && fourth != second && fourth != third); /* the same rows, other columns */
  mpmi_solver_destroy(solver);
  ck_ok(context, mpmi_solver_create(context, &solver));
  ck_assert_int_eq(pattern_of(&turned, 1), second);
  ck_assert_int_eq(pattern_of(&shape, 2), first);
}
END_TEST

START_TEST(bad) {
  ask(UNTOUCHED, 0, MPM_NOT_CONVERGED, "a residual of 1 of the right-hand side, allowed is 1e-06");
  ask(TOO_FAR, 0, MPM_NOT_CONVERGED, "a residual of 2e-06 of");
  ask(BAD_NUMBER, 0, MPM_NONFINITE, "node ");
  ck_assert_int_eq(report.node, 1000 + 7 * (A.rows - 1));
  ask(BAD_COUNT, 0, MPM_E_CALLBACK, "-2 iterations");
  ask(RETURNS, MPM_CUT_DT, MPM_CUT_DT, "returned 1");
  ask(RETURNS, 7, MPM_CUT_DT, "returned 7");
  ask(RETURNS, -3, MPM_E_CALLBACK, "returned -3");
}
END_TEST

TCase *linalg_host_case(void) {
  TCase *tests = tcase_create("host");
  tcase_add_checked_fixture(tests, open_solver, close_solver);
  tcase_add_test(tests, good);
  tcase_add_test(tests, patterns);
  tcase_add_test(tests, bad);
  return tests;
}
