/* Linear systems: parts in linalg_*.c; here what holds for all methods: the number of threads, executors and
 * memory that fail. */
#include "linalg.h"

#include "linalg/system.h"
#include "tables.h"

/* Every method, on systems large enough for threads. */
typedef struct scene {
  springs of;
  int32_t choice;
} scene;
static const scene scenes[] = {
    {{.dim = 2, .block = 2, .reach = 1, .n = {45, 40}, .clamped = 1, .rollers = 1}, MPM_SOLVER_CG},
    {{.dim = 2, .block = 2, .reach = 1, .n = {60, 61}, .clamped = 1, .rollers = 1}, MPM_SOLVER_LDLT},
    {{.dim = 3, .block = 3, .reach = 1, .n = {11, 10, 12}, .mass = 0.02}, MPM_SOLVER_LDLT},
    {{.dim = 2, .block = 2, .reach = 1, .n = {45, 40}, .mass = 0.5, .convection = 0.3}, MPM_SOLVER_GMRES},
    {{.dim = 3, .block = 3, .reach = 1, .n = {11, 10, 12}, .mass = 0.5, .convection = 0.3}, MPM_SOLVER_AUTO},
    {{.dim = 2, .block = 2, .reach = 1, .n = {45, 60}, .clamped = 1, .rollers = 1}, MPM_SOLVER_MULTIGRID_CG},
    {{.dim = 3, .block = 3, .reach = 2, .n = {12, 10, 11}, .mass = 0.1}, MPM_SOLVER_MULTIGRID_CG},
    {{.dim = 3, .block = 3, .reach = 1, .n = {12, 10, 11}, .mass = 0.1, .convection = 0.1},
     MPM_SOLVER_GMRES}};
enum { SCENES = 8 };

static mpm_status by_sweeps(void *user, const mpm_operator *matrix, const double *rhs, double *solution,
                            double tolerance, int64_t *iterations) {
  mpm_operator_info info = {.struct_size = sizeof info};
  const int64_t *row_start;
  const int32_t *column;
  const double *value;
  (void)user, (void)tolerance, (void)iterations;
  mpm_status status = mpm_operator_get_info(matrix, &info);
  if (!status) status = mpm_operator_csr(matrix, &row_start, &column, &value);
  if (status) return status;
  for (int32_t round = 0; round < 2000; ++round) /* Gauss-Seidel */
    for (int64_t r = 0; r < info.rows; ++r) {
      double sum = rhs[r], diagonal = 1.0;
      for (int64_t e = row_start[r]; e < row_start[r + 1]; ++e)
        if (column[e] == r)
          diagonal = value[e];
        else
          sum -= value[e] * solution[column[e]];
      solution[r] = sum / diagonal;
    }
  return 0;
}

START_TEST(threads) {
  static const int32_t counts[] = {1, 2, 3, 4, 7};
  const scene *at = &scenes[_i];
  mpmi_solve_report first_report = {0}, report;
  double *first = NULL;
  for (int32_t t = 0; t < 5; ++t) {
    mpm_context *context = context_with(counts[t], MPM_ISA_BEST, NULL);
    mpmi_matrix A;
    mpmi_solver *solver;
    springs_build(&A, context, &at->of);
    const size_t bytes = (size_t)mpmi_matrix_unknowns(&A) * sizeof(double);
    double *b = noise_vector(&A, 2), *x = malloc(bytes);
    const mpmi_solve_job job = job_of(&A, b, x, at->choice);
    ck_ok(context, mpmi_solver_create(context, &solver));
    solved(solver, &job, &report);
    if (!first) {
      first = memcpy(malloc(bytes), x, bytes);
      first_report = report;
    }
    ck_assert_int_eq(memcmp(first, x, bytes), 0);
    ck_assert(report.iterations == first_report.iterations && report.negative == first_report.negative);
    free(b), free(x);
    mpmi_solver_destroy(solver);
    mpmi_matrix_free(&A);
    ck_ok(context, mpm_context_destroy(context));
  }
  free(first);
}
END_TEST

/* An executor that runs tasks backwards; small systems are not its business, and of large ones some runs of
 * tasks fail. */
typedef struct moody {
  int32_t calls, fail_at;
} moody;

static mpm_status run_tasks(void *user, int64_t count, mpm_task_fn task, void *data) {
  moody *m = user;
  if (++m->calls == m->fail_at) return -9;
  for (int64_t k = count - 1; k >= 0; --k) task(data, k);
  return 0;
}

static double *solution_of(const scene *at) {
  mpm_context *context = context_with(2, MPM_ISA_BEST, NULL);
  mpmi_matrix A;
  mpmi_solver *solver;
  mpmi_solve_report report;
  springs_build(&A, context, &at->of);
  double *b = noise_vector(&A, 2), *x = malloc((size_t)mpmi_matrix_unknowns(&A) * sizeof *x);
  const mpmi_solve_job job = job_of(&A, b, x, at->choice);
  ck_ok(context, mpmi_solver_create(context, &solver));
  solved(solver, &job, &report);
  free(b);
  mpmi_solver_destroy(solver);
  mpmi_matrix_free(&A);
  ck_ok(context, mpm_context_destroy(context));
  return x;
}

START_TEST(executors) {
  const scene *at = &scenes[_i];
  moody m = {0};
  mpm_context_desc desc = context_desc();
  mpm_context *context;
  mpmi_matrix A;
  mpmi_solver *solver;
  mpmi_solve_report report;
  desc.parallel_for = run_tasks;
  desc.parallel_user = &m;
  ck_ok(NULL, mpm_context_create(&desc, &context));
  ck_ok(context, mpmi_solver_create(context, &solver));
  springs_build(&A, context, &at->of);
  double *b = noise_vector(&A, 2), *x = malloc((size_t)mpmi_matrix_unknowns(&A) * sizeof *x);
  mpmi_solve_job job = job_of(&A, b, x, at->choice);
  m.calls = 0;
  solved(solver, &job, &report);
  const int32_t calls = m.calls;
  ck_assert_int_gt(calls, 3);
  double *by_pool = solution_of(at);
  ck_assert_int_eq(memcmp(x, by_pool, (size_t)mpmi_matrix_unknowns(&A) * sizeof *x), 0);
  free(by_pool);
  for (int32_t fail_at = 1; fail_at <= calls; fail_at += 1 + fail_at / 10) {
    ++A.pattern_id; /* as if nothing were known of it */
    job = job_of(&A, b, x, at->choice);
    m = (moody){0, fail_at};
    refused(solver, &job, &report, MPM_E_CALLBACK, "parallel_for returned -9");
  }
  free(b), free(x);
  mpmi_matrix_free(&A);
  springs small = at->of;
  for (int32_t k = 0; k < 3; ++k) small.n[k] = small.n[k] / 2;
  m = (moody){0, 1};
  springs_build(&A, context, &small);
  b = noise_vector(&A, 2);
  x = malloc((size_t)mpmi_matrix_unknowns(&A) * sizeof *x);
  A.pattern_id = 1000000;
  job = job_of(&A, b, x, at->choice);
  solved(solver, &job, &report);
  ck_assert_int_eq(m.calls, 0);
  free(b), free(x);
  mpmi_solver_destroy(solver);
  mpmi_matrix_free(&A);
  ck_ok(context, mpm_context_destroy(context));
}
END_TEST

/* Each allocation fails once: the call says so, loses nothing, and succeeds when it is repeated. */
START_TEST(out_of_memory) {
  static const int32_t choices[] = {MPM_SOLVER_AUTO,        MPM_SOLVER_CG,   MPM_SOLVER_LDLT,
                                    MPM_SOLVER_GMRES,       MPM_SOLVER_HOST, MPM_SOLVER_AUTO,
                                    MPM_SOLVER_MULTIGRID_CG};
  const springs of = {.dim = 2,
                      .block = 2,
                      .reach = 1,
                      .n = {_i == 6 ? 45 : 8, _i == 6 ? 40 : 9},
                      .mass = 0.5,
                      .rollers = 1,
                      .convection = _i == 5 ? 0.2 : 0.0};
  host_memory memory = {0};
  mpmi_solve_report report;
  int32_t failures = 0;
  for (int64_t fail_at = 1, done = 0; !done; ++fail_at) {
    memory = (host_memory){0};
    mpm_context *context = context_with(1, MPM_ISA_BEST, &memory);
    mpmi_matrix A;
    mpmi_solver *solver;
    springs_build(&A, context, &of);
    const int64_t held = memory.held;
    double *b = noise_vector(&A, 2), *x = malloc((size_t)mpmi_matrix_unknowns(&A) * sizeof *x);
    mpmi_solve_job job = job_of(&A, b, x, choices[_i]);
    job.host = by_sweeps;
    memory.fail_at = memory.calls + fail_at;
    mpm_status status = mpmi_solver_create(context, &solver);
    if (status) {
      ck_assert_int_eq(status, MPM_E_NOMEM);
      ck_assert_ptr_null(solver);
      ck_assert_int_eq(memory.held, held);
      ck_ok(context, mpmi_solver_create(context, &solver));
    } else {
      status = mpmi_solve(solver, &job, &report);
      /* what it needs within the callback is the callback's failure */
      if (status) ck_assert_int_eq(status, report.callback_status ? MPM_E_CALLBACK : MPM_E_NOMEM);
      if (report.callback_status) ck_assert_int_eq(report.callback_status, MPM_E_NOMEM);
    }
    failures += status != MPM_OK;
    done = !status;
    job = job_of(&A, b, x, choices[_i]);
    job.host = by_sweeps;
    solved(solver, &job, &report);
    const int64_t calls = memory.calls;
    job = job_of(&A, b, x, choices[_i]);
    job.host = by_sweeps;
    solved(solver, &job, &report);
    ck_assert_int_eq(memory.calls, calls); /* all there is already */
    free(b), free(x);
    mpmi_solver_destroy(solver);
    ck_assert_int_eq(memory.held, held);
    mpmi_matrix_free(&A);
    ck_ok(context, mpm_context_destroy(context));
    ck_assert_int_eq(memory.held, 0);
  }
  ck_assert_int_ge(failures, 3);
}
END_TEST

Suite *linalg_suite(void) {
  Suite *suite = suite_create("linalg");
  suite_add_tcase(suite, linalg_matrix_case());
  suite_add_tcase(suite, linalg_methods_case());
  suite_add_tcase(suite, linalg_direct_case());
  suite_add_tcase(suite, linalg_host_case());
  suite_add_tcase(suite, linalg_multigrid_case());
  TCase *all = tcase_create("all methods");
  tcase_set_timeout(all, 120);
  add_sparse(all, threads, SCENES, 3);
  add_sparse(all, executors, SCENES, 3);
  tcase_add_loop_test(all, out_of_memory, 0, 7);
  suite_add_tcase(suite, all);
  return suite;
}
