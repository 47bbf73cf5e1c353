/* The factor: inertia, singular matrices, structure kept and renewed, and what the choice by the library
 * makes of systems that iterations do not solve. */
#include "linalg/factor.h"
#include "linalg/methods.h"

#include "linalg_fixture.h"
#include "tables.h"

/* Solves for a known x with the matrix as it is; the distance from it. */
static double error_of(int32_t choice, uint64_t seed) {
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *x = noise_vector(&A, seed), *b = rhs_for(&A, x), *y = malloc((size_t)n * sizeof *y);
  const mpmi_solve_job job = job_of(&A, b, y, choice);
  solved(solver, &job, &report);
  const double error = distance(n, y, x);
  free(x), free(b), free(y);
  return error;
}

static void refuse(int32_t choice, mpm_status wanted, const char *text) {
  double *b = noise_vector(&A, 3), *x = malloc((size_t)mpmi_matrix_unknowns(&A) * sizeof *x);
  const mpmi_solve_job job = job_of(&A, b, x, choice);
  refused(solver, &job, &report, wanted, text);
  free(b), free(x);
}

/* Negative pivots are negative eigenvalues; the system is solved all the same. */
START_TEST(inertia) {
  static const springs shapes[] = {
      {.dim = 1, .block = 1, .reach = 2, .n = {60}, .clamped = 1},
      {.dim = 2, .block = 2, .reach = 1, .n = {8, 9}, .clamped = 1, .rollers = 1},
      {.dim = 3, .block = 3, .reach = 1, .n = {4, 4, 4}, .rollers = 1}};
  static const double shifts[] = {-0.11, -0.57, -1.3, -100.0};
  springs of = shapes[_i / 4];
  of.mass = shifts[_i % 4];
  springs_build(&A, context, &of);
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *a = dense_of(&A);
  const int64_t negative = dense_negative(n, a); /* held ones are 1 */
  free(a);
  if (_i % 4) ck_assert_int_gt(negative, 0);
  ck_assert_double_lt(error_of(MPM_SOLVER_LDLT, 1), 1e-9);
  ck_assert_int_eq(report.negative, negative);
  ck_assert_int_eq(report.indefinite, negative > 0);
  ck_assert_double_lt(error_of(MPM_SOLVER_AUTO, 2), 1e-9);
  ck_assert_int_eq(report.indefinite, negative > 0);
}
END_TEST

/* A body that nothing holds: the last of its nodes has no pivot left. */
START_TEST(floating_body) {
  static const springs shapes[] = {{.dim = 1, .block = 1, .reach = 1, .n = {50}},
                                   {.dim = 2, .block = 2, .reach = 1, .n = {60, 50}},
                                   {.dim = 2, .block = 2, .reach = 2, .n = {20, 20}, .periodic = 1},
                                   {.dim = 3, .block = 3, .reach = 1, .n = {9, 8, 10}, .holes = 13},
                                   {.dim = 2, .block = 2, .reach = 1, .n = {60, 50}, .convection = 1e-30}};
  springs_build(&A, context, &shapes[_i]);
  A.symmetric = _i != 4;
  refuse(_i == 4 ? MPM_SOLVER_AUTO : MPM_SOLVER_LDLT, MPM_SINGULAR, "singular: no pivot at node");
  ck_assert(report.node >= 1000 && report.node < 1000 + 7 * A.rows && (report.node - 1000) % 7 == 0);
  ck_assert_int_eq(report.negative, -1);
}
END_TEST

/* A small pivot that comes first makes the next ones 1e8 times as large, and where the matrix is singular the
 * last one is made of their rounding: it is not small. What is left of the right-hand side tells. */
START_TEST(pivots_of_rounding) {
  const springs of = {.dim = 3, .block = 3, .reach = 1, .n = {1, 1, 1}, .mass = 1.0};
  const double small = 0x1p-26, b = 0.5 + 0x1p-6 * (2 * _i + 1);
  const double c = 2.0 * b - small * b * b; /* exactly: the determinant vanishes */
  const double value[9] = {small, 1.0, 1.0, 1.0, 0.0, b, 1.0, b, c};
  springs_build(&A, context, &of);
  memcpy(A.value, value, sizeof value);
  A.symmetric = 1;
  refuse(MPM_SOLVER_LDLT, MPM_SINGULAR, "singular");
}
END_TEST

/* A node without any stiffness is the one that is named; held as well, it is none of the system. */
START_TEST(empty_node) {
  const springs of = {.dim = 2, .block = 2, .reach = 1, .n = {50, 30}, .mass = 0.1};
  springs_build(&A, context, &of);
  const int64_t bad = 700;
  const int32_t component = _i;
  for (int32_t held = 0; held < 2; ++held) {
    A.held[2 * bad + component] = 1;
    ck_ok(context, mpmi_matrix_eliminate(&A));
    A.held[2 * bad + component] = (uint8_t)held;
    int64_t e = A.row_start[bad];
    while (A.column[e] != bad) ++e;
    if (!held) A.value[4 * e + 3 * component] = 0.0;
    A.pattern_id += 1;
    if (held)
      ck_assert_double_lt(error_of(MPM_SOLVER_LDLT, 1), 1e-9);
    else
      refuse(MPM_SOLVER_LDLT, MPM_SINGULAR, "node 5900 (");
    ck_assert_int_eq(report.node, held ? -1 : 5900);
  }
}
END_TEST

/* Two nodes that differ by nothing: the later one in the order of elimination is named. */
START_TEST(equal_nodes) {
  const springs of = {.dim = 2, .block = 1, .reach = 1, .n = {9, 10}, .mass = 0.1};
  const int64_t pair[2] = {11 + 7 * _i, 21 + 7 * _i};
  springs_build(&A, context, &of);
  for (int64_t i = 0; i < A.rows; ++i)
    for (int64_t e = A.row_start[i]; e < A.row_start[i + 1]; ++e) {
      const int32_t row = i == pair[0] || i == pair[1],
                    column = A.column[e] == pair[0] || A.column[e] == pair[1];
      if (row || column) A.value[e] = row && column ? 1.0 : 0.0;
    }
  refuse(MPM_SOLVER_LDLT, MPM_SINGULAR, "no pivot");
  ck_assert(report.node == 1000 + 7 * pair[0] || report.node == 1000 + 7 * pair[1]);
}
END_TEST

/* Zeros on the diagonal that the elimination fills: [0 B; B^T C]. */
START_TEST(zero_diagonal) {
  const springs of = {.dim = 1, .block = 1, .reach = 1, .n = {2}, .mass = 0.5};
  springs_build(&A, context, &of);
  A.value[0] = 2.0;
  A.value[3] = 0.0;
  ck_assert_double_lt(error_of(MPM_SOLVER_LDLT, 1), 1e-12);
  ck_assert_int_eq(report.negative, 1);
}
END_TEST

/* Fronts of all kinds: tasks side by side, and those above them cut into slivers and strips. */
START_TEST(large) {
  static const springs shapes[] = {
      {.dim = 2, .block = 2, .reach = 1, .n = {70, 61}, .clamped = 1, .rollers = 1, .light = 1e-3},
      {.dim = 2, .block = 2, .reach = 2, .n = {40, 80}, .mass = 0.01, .periodic = 1, .holes = 17},
      {.dim = 3, .block = 3, .reach = 1, .n = {12, 11, 13}, .clamped = 1, .rollers = 1},
      {.dim = 3, .block = 3, .reach = 3, .n = {9, 16, 9}, .mass = 0.1, .holes = 5},
      {.dim = 3, .block = 1, .reach = 1, .n = {200, 5, 4}, .clamped = 1},
      {.dim = 2, .block = 3, .reach = 1, .n = {50, 50}, .mass = 0.1}};
  springs of = shapes[_i % 6];
  if (_i >= 6) of.convection = 0.5, of.mass += 0.3;
  springs_build(&A, context, &of);
  const int32_t choice = _i < 6 ? MPM_SOLVER_LDLT : MPM_SOLVER_AUTO;
  const double error = error_of(choice, 1);
  ck_assert_double_lt(error, 1e-9);
  if (_i < 6) ck_assert_int_eq(report.negative, 0);
  const mpmi_factor *f = &solver->factor;
  if (!f->analysed) return;
  int32_t top = 0, wide = 0;
  for (int32_t i = 0; i < f->fronts; ++i) {
    top += f->front[i].top;
    wide |= f->front[i].pivots > MPMI_PANEL;
  }
  ck_assert(f->tasks > 4 && top > 0 && (wide || _i % 6 == 4));
}
END_TEST

/* The structure is kept for other values, and made anew for another pattern: both as by a new solver. */
START_TEST(structure) {
  springs of = {.dim = 2, .block = 2, .reach = 1, .n = {30, 40}, .clamped = 1};
  for (int32_t round = 0; round < 4; ++round) {
    mpmi_matrix_free(&A);
    of.mass = round == 1 ? 0.5 : 0.0;
    of.rollers = round == 2; /* held otherwise */
    if (round == 3) of.n[0] = 20;
    springs_build(&A, context, &of);
    A.pattern_id = round < 2 ? 7 : 7 + round;
    const int32_t *order = solver->factor.order;
    const int64_t unknowns = solver->factor.unknowns;
    ck_assert_double_lt(error_of(MPM_SOLVER_LDLT, 1), 1e-9);
    if (round == 1) ck_assert(solver->factor.order == order && solver->factor.unknowns == unknowns);
    if (round > 1) ck_assert_int_lt(solver->factor.unknowns, unknowns);
  }
  A.symmetric = 0; /* and for the other kind of factor */
  ck_assert_double_lt(error_of(MPM_SOLVER_AUTO, 1), 1e-9);
  ck_assert_int_eq(report.solver, MPM_SOLVER_GMRES);
}
END_TEST

/* Looks large enough for an iteration to come first, while the factor is cheap. */
static const springs chains = {
    .dim = 3, .block = 2, .reach = 1, .n = {20, 20, 10}, .clamped = 1, .chains = 1};

static void build(double mass, double convection) {
  springs of = chains;
  of.mass = mass;
  of.convection = convection;
  mpmi_matrix_free(&A);
  springs_build(&A, context, &of);
}

/* With too few iterations allowed. */
static void solve_in_five(void) {
  double *x = noise_vector(&A, 1), *b = rhs_for(&A, x), *y = malloc(8000 * sizeof *y);
  mpmi_solve_job job = job_of(&A, b, y, MPM_SOLVER_AUTO);
  job.max_iterations = 5;
  solved(solver, &job, &report);
  ck_assert_int_eq(report.iterations, 5);
  ck_assert_int_eq(report.indefinite, 0);
  ck_assert_double_lt(distance(8000, y, x), 1e-9);
  ck_assert_str_eq(mpm_last_error(context), "");
  free(x), free(b), free(y);
}

START_TEST(iteration_first) {
  build(0.0, 0.0);
  ck_assert_double_lt(error_of(MPM_SOLVER_AUTO, 1), 1e-7);
  ck_assert_int_eq(report.solver, MPM_SOLVER_MULTIGRID_CG);
  build(0.5, 0.3);
  ck_assert_double_lt(error_of(MPM_SOLVER_AUTO, 1), 1e-7);
  ck_assert_int_eq(report.solver, MPM_SOLVER_GMRES);
  ck_assert_int_eq(solver->factor.analysed, 0);
  build(-0.1, 0.0); /* the iteration meets negative curvature, the factor solves */
  ck_assert_double_lt(error_of(MPM_SOLVER_AUTO, 1), 1e-9);
  ck_assert_int_eq(report.solver, MPM_SOLVER_LDLT);
  ck_assert(report.indefinite == 1 && report.negative > 0 && report.node == -1);
  ck_assert_str_eq(mpm_last_error(context), "");
  build(0.0, 0.0);
  solve_in_five();
  ck_assert(report.solver == MPM_SOLVER_LDLT && report.negative == 0);
  build(0.5, 0.3);
  solve_in_five();
  ck_assert(report.solver == MPM_SOLVER_GMRES && report.negative == -1);
}
END_TEST

/* Convection so strong that restarts do not get through it: the factor does,
 * and the impatient see it early. */
START_TEST(stalled) {
  springs of = chains;
  of.chains = 0;
  of.convection = 200.0;
  springs_build(&A, context, &of);
  refuse(MPM_SOLVER_GMRES, MPM_NOT_CONVERGED, "GMRES: after ");
  ck_assert_double_lt(error_of(MPM_SOLVER_AUTO, 1), 1e-7);
  ck_assert_int_eq(report.solver, MPM_SOLVER_GMRES);
  ck_assert(solver->factor.analysed);
  double *b = noise_vector(&A, 3), *x = malloc(8000 * sizeof *x);
  int64_t patient = 0, row;
  for (int32_t impatient = 0; impatient < 2; ++impatient) {
    mpmi_system s = {
        .solver = solver, .context = context, .A = &A, .b = b, .x = x, .n = 8000, .report = &report};
    memset(x, 0, 8000 * sizeof *x);
    ck_ok(context, mpmi_norm(context, b, 8000, &s.b_norm));
    s.wanted = 1e-10 * s.b_norm;
    ck_ok(context, mpmi_inverse_blocks(&s, &row));
    report.iterations = 0;
    const mpmi_gmres_plan plan = {.precondition = mpmi_times_inverse_blocks,
                                  .user = &s,
                                  .restart = 60,
                                  .impatient = impatient,
                                  .limit = 3000};
    ck_assert_int_eq(mpmi_gmres(&s, &plan), MPM_NOT_CONVERGED);
    if (impatient) ck_assert_int_lt(report.iterations, patient);
    patient = report.iterations;
  }
  free(b), free(x);
}
END_TEST

/* A long body that little holds is too hard for diagonal blocks, and nearly symmetric: conjugate gradients
 * precondition in their place. */
START_TEST(inner_cg) {
  const springs of = {.dim = 2, .block = 2, .reach = 1, .n = {240, 4}, .clamped = 1, .convection = 1e-4};
  springs_build(&A, context, &of);
  const int64_t n = mpmi_matrix_unknowns(&A);
  int64_t row;
  double *b = noise_vector(&A, 3), *x = calloc((size_t)n, sizeof *x);
  mpmi_system s = {.solver = solver, .context = context, .A = &A, .b = b, .x = x, .n = n, .report = &report};
  ck_ok(context, mpmi_norm(context, b, n, &s.b_norm));
  s.wanted = 1e-9 * s.b_norm;
  ck_ok(context, mpmi_inverse_blocks(&s, &row));
  report.iterations = 0;
  const mpmi_gmres_plan plan = {
      .precondition = mpmi_times_inverse_blocks, .user = &s, .restart = 60, .limit = 3000};
  ck_assert_int_eq(mpmi_gmres(&s, &plan), MPM_NOT_CONVERGED);
  free(b), free(x);
  ck_assert_double_lt(error_of(MPM_SOLVER_GMRES, 1), 1e-6);
  ck_assert_int_eq(report.solver, MPM_SOLVER_GMRES);
}
END_TEST

/* Conjugate gradients that precondition count the iterations that they take: here no more than there are
 * unknowns. */
START_TEST(inner_iterations) {
  const springs of = {.dim = 1, .block = 1, .reach = 1, .n = {20}, .clamped = 1};
  springs_build(&A, context, &of);
  const int64_t n = mpmi_matrix_unknowns(&A);
  int64_t row;
  double *r = noise_vector(&A, 3), *z = calloc((size_t)n, sizeof *z);
  mpmi_system s = {.solver = solver, .context = context, .A = &A, .n = n, .report = &report};
  ck_ok(context, mpmi_inverse_blocks(&s, &row));
  ck_ok(context, mpmi_reserve_inner_cg(&s, &row));
  mpmi_inner_cg inner = {&s, 3000};
  report.iterations = 7;
  ck_ok(context, mpmi_times_inner_cg(&inner, r, z));
  free(r), free(z);
  ck_between("iterations", (double)report.iterations, 7.0 + 2.0, 7.0 + 20.0);
}
END_TEST

/* The kernels of all instruction sets agree to rounding. */
START_TEST(instruction_sets) {
  const springs of = {.dim = 3,
                      .block = 3,
                      .reach = 1,
                      .n = {8, 9, 7},
                      .rollers = 1,
                      .mass = 0.01,
                      .convection = _i ? 0.1 : 0.0};
  double *first = NULL;
  for (int32_t isa = MPM_ISA_BASELINE; isa <= MPM_ISA_NEON; ++isa) {
    mpm_context *other = context_with(1, isa, NULL);
    if (!other) continue;
    mpmi_solver *own;
    mpmi_matrix B;
    ck_ok(other, mpmi_solver_create(other, &own));
    springs_build(&B, other, &of);
    const int64_t n = mpmi_matrix_unknowns(&B);
    double *b = noise_vector(&B, 1), *x = malloc((size_t)n * sizeof *x);
    const mpmi_solve_job job = job_of(&B, b, x, MPM_SOLVER_AUTO);
    solved(own, &job, &report);
    ck_assert(own->factor.analysed);
    if (first)
      ck_assert_double_lt(distance(n, x, first), 1e-11);
    else
      first = memcpy(malloc((size_t)n * sizeof *x), x, (size_t)n * sizeof *x);
    free(b), free(x);
    mpmi_matrix_free(&B);
    mpmi_solver_destroy(own);
    ck_ok(other, mpm_context_destroy(other));
  }
  free(first);
}
END_TEST

TCase *linalg_direct_case(void) {
  TCase *tests = tcase_create("direct");
  tcase_set_timeout(tests, 60);
  tcase_add_checked_fixture(tests, open_solver, close_solver);
  add_sparse(tests, inertia, 12, 5);
  tcase_add_loop_test(tests, floating_body, 0, 5);
  tcase_add_loop_test(tests, pivots_of_rounding, 0, 8);
  tcase_add_loop_test(tests, empty_node, 0, 2);
  tcase_add_loop_test(tests, equal_nodes, 0, 10);
  tcase_add_test(tests, zero_diagonal);
  add_sparse(tests, large, 12, 5);
  tcase_add_test(tests, structure);
  tcase_add_test(tests, iteration_first);
  add_sparse(tests, stalled, 1, 2);
  tcase_add_test(tests, inner_cg);
  tcase_add_test(tests, inner_iterations);
  tcase_add_loop_test(tests, instruction_sets, 0, 2);
  return tests;
}
