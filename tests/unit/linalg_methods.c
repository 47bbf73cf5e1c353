/* Every method of solution against a dense one, and what it says where it fails. */
#include "linalg_fixture.h"

static const springs shapes[] = {
    {.dim = 1, .block = 1, .reach = 1, .n = {40}, .mass = 0.01, .clamped = 1},
    {.dim = 1, .block = 1, .reach = 3, .n = {37}, .mass = 0.01, .clamped = 1, .light = 1e-4},
    {.dim = 2, .block = 1, .reach = 1, .n = {9, 13}, .mass = 0.01, .holes = 5},
    {.dim = 2, .block = 2, .reach = 1, .n = {11, 9}, .clamped = 1, .rollers = 1, .light = 1e-3},
    {.dim = 2, .block = 2, .reach = 2, .n = {9, 9}, .mass = 0.01, .periodic = 1, .holes = 11},
    {.dim = 2, .block = 3, .reach = 1, .n = {8, 7}, .clamped = 1, .rollers = 1},
    {.dim = 3, .block = 3, .reach = 1, .n = {5, 4, 6}, .clamped = 1, .rollers = 1, .light = 1e-5},
    {.dim = 3, .block = 3, .reach = 2, .n = {5, 5, 4}, .mass = 0.05, .holes = 6},
    {.dim = 3, .block = 1, .reach = 1, .n = {7, 6, 5}, .mass = 0.02, .rollers = 1, .periodic = 1}};
enum { SHAPES = 9 };
static const int32_t choices[] = {MPM_SOLVER_AUTO, MPM_SOLVER_CG, MPM_SOLVER_LDLT, MPM_SOLVER_GMRES,
                                  MPM_SOLVER_MULTIGRID_CG};
enum { CHOICES = 5 };

/* The solution agrees with that by elimination with pivoting. */
static void compare(const springs *of, int32_t choice, int32_t wanted_solver) {
  springs_build(&A, context, of);
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *b = noise_vector(&A, 5), *x = malloc((size_t)n * sizeof *x), *a = dense_of(&A);
  mpmi_solve_job job = job_of(&A, b, x, choice);
  job.tolerance = 1e-12;
  solved(solver, &job, &report);
  if (wanted_solver) ck_assert_int_eq(report.solver, wanted_solver);
  ck_assert_int_eq(report.node, -1);
  ck_assert_int_eq(report.iterations > 0, report.solver != MPM_SOLVER_LDLT);
  ck_assert_int_eq(report.negative, report.solver == MPM_SOLVER_LDLT ? 0 : -1);
  ck_assert_int_eq(report.indefinite, 0);
  ck_assert(report.factor_seconds >= 0.0 && report.solve_seconds >= 0.0);
  for (int64_t i = 0; i < n; ++i)
    if (A.held[i]) ck_assert(x[i] == 0.0);
  dense_solve(n, a, b);
  ck_assert_double_lt(distance(n, x, b), 1e-8);
  free(a), free(b), free(x);
  mpmi_matrix_free(&A);
}

START_TEST(symmetric) {
  static const int32_t wanted[] = {0, MPM_SOLVER_CG, MPM_SOLVER_LDLT, MPM_SOLVER_GMRES,
                                   MPM_SOLVER_MULTIGRID_CG};
  compare(&shapes[_i / CHOICES], choices[_i % CHOICES], wanted[_i % CHOICES]);
}
END_TEST

START_TEST(not_symmetric) {
  springs of = shapes[_i];
  of.convection = 0.4;
  of.mass += 0.2;
  compare(&of, MPM_SOLVER_GMRES, MPM_SOLVER_GMRES);
}
END_TEST

static void try(const springs *of, int32_t choice, mpm_status wanted, const char *text) {
  springs_build(&A, context, of);
  double *b = noise_vector(&A, 5), *x = malloc((size_t)mpmi_matrix_unknowns(&A) * sizeof *x);
  const mpmi_solve_job job = job_of(&A, b, x, choice);
  refused(solver, &job, &report, wanted, text);
  free(b), free(x);
  mpmi_matrix_free(&A);
}

START_TEST(refusals) {
  springs of = shapes[2];
  try(&of, MPM_SOLVER_HOST, MPM_E_STATE, "call mpm_stepper_set_linear_solver first");
  try(&of, 5, MPM_E_ARG, "is 5");
  try(&of, -1, MPM_E_ARG, "is -1");
  of.convection = 0.1;
  try(&of, MPM_SOLVER_CG, MPM_E_UNSUPPORTED, "use MPM_SOLVER_GMRES or MPM_SOLVER_AUTO");
  try(&of, MPM_SOLVER_MULTIGRID_CG, MPM_E_UNSUPPORTED, "MPM_SOLVER_MULTIGRID_CG is for symmetric");
  try(&of, MPM_SOLVER_LDLT, MPM_E_UNSUPPORTED, "use MPM_SOLVER_GMRES or MPM_SOLVER_AUTO");
}
END_TEST

/* Nothing to do, with a guess that is not the answer: x = 0. */
START_TEST(no_load) {
  springs_build(&A, context, &shapes[3]);
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *b = calloc((size_t)n, sizeof *b), *x = calloc((size_t)n, sizeof *x);
  mpmi_solve_job job = job_of(&A, b, x, choices[_i]);
  x[5] = 1.0;
  solved(solver, &job, &report);
  for (int64_t i = 0; i < n; ++i) ck_assert(x[i] == 0.0);
  ck_assert_int_eq(report.iterations, 0);
  ck_assert_int_ne(report.solver, MPM_SOLVER_AUTO);
  free(b), free(x);
}
END_TEST

/* A guess near the solution saves iterations, one far off costs none,
 * and at held unknowns it does not count. */
START_TEST(guesses) {
  const int32_t choice = _i ? MPM_SOLVER_GMRES : MPM_SOLVER_CG;
  springs_build(&A, context, &shapes[5]);
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *x = noise_vector(&A, 9), *b = rhs_for(&A, x), *y = malloc((size_t)n * sizeof *y);
  const mpmi_solve_job job = job_of(&A, b, y, choice);
  solved(solver, &job, &report);
  const int64_t without = report.iterations;
  for (int64_t i = 0; i < n; ++i) y[i] = A.held[i] ? 1e3 : x[i] * (1.0 + 1e-7 * (double)(i % 3));
  solved(solver, &job, &report);
  ck_assert_int_lt(report.iterations, without);
  ck_assert_double_lt(distance(n, y, x), 1e-6);
  solved(solver, &job, &report); /* with the solution as the guess */
  ck_assert_int_eq(report.iterations, 0);
  for (int64_t i = 0; i < n; ++i) y[i] = 1e9 * (double)(i % 5);
  solved(solver, &job, &report);
  ck_assert_int_eq(report.iterations, without);
  free(x), free(b), free(y);
}
END_TEST

/* A tolerance that rounding does not allow: what it allows is enough. */
START_TEST(beyond_rounding) {
  springs_build(&A, context, &shapes[6]);
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *x = noise_vector(&A, 9), *b = rhs_for(&A, x), *y = malloc((size_t)n * sizeof *y);
  mpmi_solve_job job = job_of(&A, b, y, choices[_i]);
  job.tolerance = 1e-20;
  solved(solver, &job, &report);
  ck_assert_double_lt(distance(n, y, x), 1e-9);
  free(x), free(b), free(y);
}
END_TEST

START_TEST(limits) {
  springs_build(&A, context, &shapes[6]);
  double *b = noise_vector(&A, 4), *x = malloc((size_t)mpmi_matrix_unknowns(&A) * sizeof *x);
  mpmi_solve_job job = job_of(&A, b, x, _i ? MPM_SOLVER_GMRES : MPM_SOLVER_CG);
  job.max_iterations = 7;
  refused(solver, &job, &report, MPM_NOT_CONVERGED, "after 7 iterations");
  ck_assert_int_eq(report.iterations, 7);
  free(b), free(x);
}
END_TEST

/* Negative curvature: CG alone says so. */
START_TEST(indefinite) {
  springs of = shapes[4];
  of.mass = -0.4;
  try(&of, MPM_SOLVER_MULTIGRID_CG, MPM_SINGULAR, "not positive definite");
  ck_assert(report.indefinite && report.node == -1);
  try(&of, MPM_SOLVER_CG, MPM_SINGULAR, "not positive definite");
  ck_assert(report.indefinite && report.node == -1);
  springs_build(&A, context, &of);
  int64_t e = A.row_start[20];
  while (A.column[e] != 20) ++e;
  A.value[4 * e + 3] = -1e-3;
  double *b = noise_vector(&A, 4), *x = malloc((size_t)mpmi_matrix_unknowns(&A) * sizeof *x);
  const mpmi_solve_job job = job_of(&A, b, x, MPM_SOLVER_CG);
  refused(solver, &job, &report, MPM_SINGULAR, "node 1140");
  ck_assert(report.indefinite && report.node == 1140);
  free(b), free(x);
}
END_TEST

START_TEST(not_finite) {
  static const double bad[] = {(double)NAN, (double)INFINITY};
  springs_build(&A, context, &shapes[3]);
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *b = noise_vector(&A, 4), *x = malloc((size_t)n * sizeof *x);
  mpmi_solve_job job = job_of(&A, b, x, choices[_i / 2]);
  const double was = b[41];
  b[41] = bad[_i % 2];
  refused(solver, &job, &report, MPM_NONFINITE, "right-hand side");
  ck_assert_int_eq(report.node, 1000 + 7 * 20);
  for (int64_t i = 0; i < n; ++i) b[i] = A.held[i] ? 0.0 : 1e300;
  refused(solver, &job, &report, MPM_NONFINITE, "too large");
  for (int64_t i = 0; i < n; ++i) b[i] = A.held[i] ? 0.0 : 1.0;
  b[41] = was;
  int64_t e = A.row_start[20];
  while (A.column[e] != 20) ++e;
  A.value[4 * e] = bad[_i % 2];
  refused(solver, &job, &report, MPM_NONFINITE, "node 1140");
  free(b), free(x);
}
END_TEST

TCase *linalg_methods_case(void) {
  TCase *tests = tcase_create("methods");
  tcase_add_checked_fixture(tests, open_solver, close_solver);
  tcase_add_loop_test(tests, symmetric, 0, CHOICES * SHAPES);
  tcase_add_loop_test(tests, not_symmetric, 0, SHAPES);
  tcase_add_test(tests, refusals);
  tcase_add_loop_test(tests, no_load, 0, CHOICES);
  tcase_add_loop_test(tests, guesses, 0, 2);
  tcase_add_loop_test(tests, beyond_rounding, 0, CHOICES);
  tcase_add_loop_test(tests, limits, 0, 2);
  tcase_add_test(tests, indefinite);
  tcase_add_loop_test(tests, not_finite, 0, 2 * CHOICES);
  return tests;
}
