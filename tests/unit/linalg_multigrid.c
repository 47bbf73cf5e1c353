/* Multigrid: what its levels are, and what a cycle is worth. */
#include "linalg/multigrid.h"

#include "linalg_fixture.h"
#include "tables.h"

/* Large enough for three levels, small enough to be solved by the factor beside. */
static const springs bodies[] = {
    {.dim = 1, .block = 1, .reach = 1, .n = {5001}, .mass = 1e-7, .clamped = 1},
    {.dim = 1, .block = 1, .reach = 3, .n = {4001}, .mass = 1e-6, .periodic = 1},
    {.dim = 2, .block = 2, .reach = 1, .n = {61, 48}, .clamped = 1, .rollers = 1, .below = 1},
    {.dim = 2, .block = 2, .reach = 1, .n = {51, 48}, .mass = 1e-3, .periodic = 1, .holes = 13},
    {.dim = 2, .block = 2, .reach = 2, .n = {50, 41}, .mass = 1e-3, .periodic = 1, .light = 1e-4},
    {.dim = 2, .block = 1, .reach = 3, .n = {60, 61}, .clamped = 1, .holes = 7},
    {.dim = 3, .block = 3, .reach = 1, .n = {14, 13, 15}, .clamped = 1, .rollers = 1, .light = 1e-6},
    {.dim = 3, .block = 3, .reach = 2, .n = {12, 13, 11}, .clamped = 1, .below = 1},
    {.dim = 3, .block = 3, .reach = 1, .n = {13, 12, 14}, .mass = 1e-3, .periodic = 1, .holes = 9},
    {.dim = 3, .block = 1, .reach = 3, .n = {12, 13, 12}, .mass = 1e-3, .clamped = 1}};
enum { BODIES = 10, WIDE = BODIES - 1 };

static void solve_noise(int32_t choice, double tolerance, double within) {
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *x = noise_vector(&A, 9), *b = rhs_for(&A, x), *y = malloc((size_t)n * sizeof *y);
  mpmi_solve_job job = job_of(&A, b, y, choice);
  job.tolerance = tolerance;
  solved(solver, &job, &report);
  ck_assert_double_lt(distance(n, y, x), within);
  free(x), free(b), free(y);
}

START_TEST(solves) {
  springs_build(&A, context, &bodies[_i]);
  solve_noise(MPM_SOLVER_MULTIGRID_CG, 1e-12, 1e-5);
  ck_assert_int_eq(report.solver, MPM_SOLVER_MULTIGRID_CG);
  ck_assert_int_le(report.iterations, 80);
}
END_TEST

/* Badly conditioned: what a cycle in single precision makes of a sum is not the sum of what it makes. */
START_TEST(slender) {
  static const springs beams[] = {{.dim = 2, .block = 2, .reach = 1, .n = {400, 10}, .clamped = 1},
                                  {.dim = 3, .block = 3, .reach = 1, .n = {150, 5, 5}, .clamped = 1}};
  springs_build(&A, context, &beams[_i / 2]);
  A.symmetric = _i % 2;
  const int32_t choice = A.symmetric ? MPM_SOLVER_MULTIGRID_CG : MPM_SOLVER_GMRES;
  solve_noise(choice, 1e-10, 1e-3);
  ck_assert_int_eq(report.solver, choice);
}
END_TEST

START_TEST(solves_not_symmetric) {
  springs of = bodies[_i];
  of.convection = 0.05;
  of.mass += 0.05;
  springs_build(&A, context, &of);
  solve_noise(MPM_SOLVER_GMRES, 1e-12, 1e-5);
  ck_assert_int_eq(report.solver, MPM_SOLVER_GMRES);
  ck_assert_int_le(report.iterations, 80);
}
END_TEST

/* With twice the nodes along each axis conjugate gradients need twice the iterations, cycles no more. */
START_TEST(sizes) {
  int64_t iterations[2][2];
  for (int32_t k = 0; k < 2; ++k) {
    const springs of = {.dim = 3, .block = 3, .reach = 1, .n = {9 << k, 9 << k, 9 << k}, .clamped = 1};
    springs_build(&A, context, &of);
    A.pattern_id = k;
    for (int32_t by = 0; by < 2; ++by) {
      solve_noise(by ? MPM_SOLVER_CG : MPM_SOLVER_MULTIGRID_CG, 1e-8, 1e-3);
      iterations[k][by] = report.iterations;
    }
    mpmi_matrix_free(&A);
  }
  ck_assert_int_le(3 * iterations[1][0], 4 * iterations[0][0]);
  ck_assert_int_gt(2 * iterations[1][1], 3 * iterations[0][1]);
}
END_TEST

/* Rows of nodes tied along x to each other a thousand times as stiffly as to those beside. */
START_TEST(stiff_along_lines) {
  const springs of = {.dim = 2,
                      .block = 2,
                      .reach = 1 + _i % 2,
                      .n = {80, 61},
                      .mass = 1e-5,
                      .clamped = !(_i / 2),
                      .periodic = _i / 2,
                      .stiff = 1e3};
  springs_build(&A, context, &of);
  solve_noise(MPM_SOLVER_MULTIGRID_CG, 1e-8, 1e-2);
  show("reach %d: %d iterations\n", 1 + _i % 2, (int)report.iterations);
  ck_assert_int_le(report.iterations, 20);
}
END_TEST

/* The Laplacian on cubic splines, whose functions that alternate in all axes are a hundred times softer than
 * the diagonal says: mass and stiffness at 0 to 3 nodes' distance. */
START_TEST(alternating_functions) {
  static const double m[] = {2416.0 / 5040, 1191.0 / 5040, 120.0 / 5040, 1.0 / 5040},
                      k[] = {80.0 / 120, -15.0 / 120, -24.0 / 120, -1.0 / 120};
  springs_build(&A, context, &bodies[WIDE]);
  for (int64_t i = 0; i < A.rows; ++i)
    for (int64_t e = A.row_start[i]; e < A.row_start[i + 1]; ++e) {
      int64_t by[3];
      for (int32_t c = 0; c < 3; ++c) by[c] = llabs(A.index[i][c] - A.index[A.column[e]][c]);
      A.value[e] =
          k[by[0]] * m[by[1]] * m[by[2]] + m[by[0]] * k[by[1]] * m[by[2]] + m[by[0]] * m[by[1]] * k[by[2]];
    }
  memset(A.held, 0, (size_t)A.rows);
  solve_noise(MPM_SOLVER_MULTIGRID_CG, 1e-8, 1e-4);
  show("%d iterations\n", (int)report.iterations);
  ck_assert_int_le(report.iterations, 13);
}
END_TEST

/* e of a coarse level on the finer one, by the rule itself: the mean over the parents, 0 where held; with the
 * other sign on every other node where it alternates. */
static double *interpolated(const mpmi_matrix *fine, const mpmi_matrix *coarse, int32_t alternates,
                            const double *e) {
  double *x = calloc((size_t)mpmi_matrix_unknowns(fine), sizeof *x);
  for (int64_t i = 0; i < fine->rows; ++i)
    for (int64_t I = 0; I < coarse->rows; ++I) {
      double weight = 1.0;
      int64_t sum = 0;
      for (int32_t k = 0; k < 3 && weight > 0.0; ++k) {
        sum += fine->index[i][k];
        int64_t away = llabs(fine->index[i][k] - 2 * coarse->index[I][k]);
        if (fine->period[k] && fine->index[i][k] == fine->period[k] - 1 && !coarse->index[I][k] &&
            fine->period[k] % 2 == 0)
          away = 1;
        weight *= away == 0 ? 1.0 : away == 1 ? 0.5 : 0.0;
      }
      for (int32_t c = 0; c < fine->block && weight > 0.0; ++c)
        if (!fine->held[i * fine->block + c] && !coarse->held[I * fine->block + c])
          x[i * fine->block + c] += (alternates && sum % 2 ? -weight : weight) * e[I * fine->block + c];
    }
  return x;
}

static double energy(const mpmi_matrix *M, const double *x, const double *y) {
  double *z = rhs_for(M, x), sum = 0.0;
  for (int64_t i = 0; i < mpmi_matrix_unknowns(M); ++i) sum += y[i] * z[i];
  free(z);
  return sum;
}

static void check_levels(const mpmi_hierarchy *h, int32_t alternating) {
  for (int32_t l = 0; l + 1 < h->levels; ++l) {
    const mpmi_matrix *fine = h->level[l].A, *coarse = h->level[l + 1].A;
    const int32_t alternates = alternating && !l;
    ck_assert_int_lt(coarse->rows, fine->rows);
    double *e = noise_vector(coarse, 3), *f = noise_vector(coarse, 4);
    double *x = interpolated(fine, coarse, alternates, e), *y = interpolated(fine, coarse, alternates, f);
    const double wanted = energy(fine, x, y), size = sqrt(energy(fine, x, x) * energy(fine, y, y));
    ck_assert_double_le(fabs(energy(coarse, e, f) - wanted), 1e-12 * size);
    for (int64_t i = 0; i < fine->rows; ++i)
      for (int64_t I = 0; I < coarse->rows; ++I) {
        int32_t same = 1;
        for (int32_t k = 0; k < 3; ++k) same &= fine->index[i][k] == 2 * coarse->index[I][k];
        for (int32_t c = 0; c < A.block && same; ++c)
          if (fine->held[i * A.block + c]) ck_assert(coarse->held[I * A.block + c]);
      }
    free(e), free(f), free(x), free(y);
  }
}

/* Coarse matrices are those of interpolated vectors, and a coarse unknown is held where the fine one is. */
START_TEST(galerkin) {
  mpmi_multigrid g;
  int64_t row;
  springs_build(&A, context, &bodies[_i]);
  mpmi_multigrid_init(&g, context);
  ck_ok(context, mpmi_multigrid_prepare(&g, &A, &row));
  ck_assert_int_ge(g.smooth.levels, 2);
  ck_assert_int_eq(g.alternating.levels, _i == WIDE ? g.smooth.levels : 0);
  check_levels(&g.smooth, 0);
  check_levels(&g.alternating, 1);
  mpmi_multigrid_free(&g);
}
END_TEST

/* sqrt(e . A e) of the e with A e = r. */
static double energy_of_solution(const double *r) {
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *e = malloc((size_t)n * sizeof *e), sum = 0.0;
  const mpmi_solve_job job = job_of(&A, r, e, MPM_SOLVER_LDLT);
  solved(solver, &job, &report);
  for (int64_t i = 0; i < n; ++i) sum += e[i] * r[i];
  free(e);
  return sqrt(sum);
}

/* A cycle is symmetric and independent of scale up to single precision, and takes energy from an error: most
 * of it, but for light nodes in wide stencils. */
START_TEST(one_cycle) {
  mpmi_multigrid g;
  int64_t row;
  springs_build(&A, context, &bodies[_i]);
  const int64_t n = mpmi_matrix_unknowns(&A);
  mpmi_multigrid_init(&g, context);
  ck_ok(context, mpmi_multigrid_prepare(&g, &A, &row));
  double *r = noise_vector(&A, 1), *q = noise_vector(&A, 2), *zr = calloc((size_t)n, sizeof *zr),
         *zq = calloc((size_t)n, sizeof *zq), rq = 0.0, qr = 0.0, size = 0.0;
  ck_ok(context, mpmi_multigrid_cycle(&g, r, zr));
  ck_ok(context, mpmi_multigrid_cycle(&g, q, zq));
  for (int64_t i = 0; i < n; ++i) {
    if (A.held[i]) ck_assert(zr[i] == 0.0);
    rq += r[i] * zq[i];
    qr += q[i] * zr[i];
    size += fabs(r[i] * zr[i]);
  }
  ck_assert_double_le(fabs(rq - qr), 1e-4 * size);
  double *left = rhs_for(&A, zr);
  for (int64_t i = 0; i < n; ++i) left[i] = r[i] - left[i]; /* A times the error that is left */
  const double before = energy_of_solution(r), after = energy_of_solution(left);
  ck_assert_double_lt(after, (bodies[_i].light > 0.0 ? 0.95 : 0.5) * before);
  free(left);
  for (int64_t i = 0; i < n; ++i) r[i] *= 1e-60;
  ck_ok(context, mpmi_multigrid_cycle(&g, r, zq));
  for (int64_t i = 0; i < n; ++i) zq[i] *= 1e60;
  ck_assert_double_lt(distance(n, zq, zr), 1e-5);
  free(r), free(q), free(zr), free(zq);
  mpmi_multigrid_free(&g);
}
END_TEST

/* Moduli may be in any unit: single precision is not asked to hold them. */
START_TEST(units) {
  static const double factors[] = {1e-90, 1e90};
  springs_build(&A, context, &bodies[6]);
  for (int64_t v = 0; v < A.row_start[A.rows] * A.block * A.block; ++v) A.value[v] *= factors[_i / 2];
  solve_noise(_i % 2 ? MPM_SOLVER_GMRES : MPM_SOLVER_MULTIGRID_CG, 1e-12, 1e-5);
  ck_assert_int_le(report.iterations, 80);
}
END_TEST

/* Where nodes are so far apart that the next level has as many, large levels are coarsened all the same. */
START_TEST(far_apart) {
  mpmi_multigrid g;
  int64_t row;
  const springs of = {.dim = 3, .block = 3, .reach = 1, .n = {26, 25, 24}, .clamped = 1};
  springs_build(&A, context, &of);
  for (int64_t i = 0; i < A.rows; ++i)
    for (int32_t k = 0; k < 3; ++k) A.index[i][k] *= 4;
  mpmi_multigrid_init(&g, context);
  ck_ok(context, mpmi_multigrid_prepare(&g, &A, &row));
  ck_assert_int_gt(g.smooth.levels, 3);
  ck_assert_int_lt(mpmi_matrix_unknowns(g.smooth.level[g.smooth.levels - 1].A), 1000);
  mpmi_multigrid_free(&g);
}
END_TEST

/* Instruction sets take other roundings, and agree. */
START_TEST(instruction_sets) {
  springs_build(&A, context, &bodies[6]);
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *b = noise_vector(&A, 5), *x = malloc((size_t)n * sizeof *x), *y = malloc((size_t)n * sizeof *y);
  mpmi_solve_job job = job_of(&A, b, x, MPM_SOLVER_MULTIGRID_CG);
  job.tolerance = 1e-12;
  solved(solver, &job, &report);
  for (int32_t isa = MPM_ISA_BASELINE; isa <= MPM_ISA_NEON; ++isa) {
    mpm_context *other = context_with(1, isa, NULL);
    mpmi_solver *by;
    if (!other) continue;
    ck_ok(other, mpmi_solver_create(other, &by));
    job = job_of(&A, b, y, MPM_SOLVER_MULTIGRID_CG);
    job.tolerance = 1e-12;
    solved(by, &job, &report);
    ck_assert_double_lt(distance(n, y, x), 1e-8);
    mpmi_solver_destroy(by);
    ck_ok(other, mpm_context_destroy(other));
  }
  free(b), free(x), free(y);
}
END_TEST

/* What is chosen: the factor where it is cheap, multigrid for large bodies,
 * plain iterations where inertia rules. */
START_TEST(choice) {
  static const struct {
    springs of;
    double inertia;
    int32_t wanted;
  } at[] = {
      {{.dim = 2, .block = 2, .reach = 1, .n = {30, 30}, .clamped = 1}, 0.0, MPM_SOLVER_LDLT},
      {{.dim = 3, .block = 3, .reach = 1, .n = {22, 22, 22}, .clamped = 1}, 0.0, MPM_SOLVER_MULTIGRID_CG},
      {{.dim = 3, .block = 3, .reach = 1, .n = {22, 22, 22}, .mass = 50.0}, 0.8, MPM_SOLVER_CG},
      {{.dim = 1, .block = 1, .reach = 1, .n = {9001}, .clamped = 1}, 0.0, MPM_SOLVER_LDLT}};
  springs_build(&A, context, &at[_i].of);
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *b = noise_vector(&A, 5), *x = malloc((size_t)n * sizeof *x);
  mpmi_solve_job job = job_of(&A, b, x, MPM_SOLVER_AUTO);
  job.inertia = at[_i].inertia;
  solved(solver, &job, &report);
  ck_assert_int_eq(report.solver, at[_i].wanted);
  free(b), free(x);
}
END_TEST

/* A body that nothing holds has no solution, whatever rounding makes of it. */
START_TEST(floating) {
  static const springs afloat[] = {{.dim = 2, .block = 2, .reach = 1, .n = {50, 50}},
                                   {.dim = 3, .block = 3, .reach = 1, .n = {16, 16, 16}}};
  static const int32_t choices[] = {MPM_SOLVER_AUTO, MPM_SOLVER_LDLT};
  springs_build(&A, context, &afloat[_i / 2]);
  const int64_t n = mpmi_matrix_unknowns(&A);
  double *b = malloc((size_t)n * sizeof *b), *x = malloc((size_t)n * sizeof *x);
  for (int64_t i = 0; i < n; ++i) b[i] = i % A.block == 0 ? 1.0 : 0.0;
  const mpmi_solve_job job = job_of(&A, b, x, choices[_i % 2]);
  refused(solver, &job, &report, MPM_SINGULAR, "singular");
  ck_assert_int_ge(report.node, 0);
  free(b), free(x);
}
END_TEST

TCase *linalg_multigrid_case(void) {
  TCase *tests = tcase_create("multigrid");
  tcase_set_timeout(tests, 120);
  tcase_add_checked_fixture(tests, open_solver, close_solver);
  tcase_add_loop_test(tests, solves, 0, BODIES);
  add_sparse(tests, solves_not_symmetric, BODIES, 3);
  tcase_add_loop_test(tests, slender, 0, 4);
  tcase_add_loop_test(tests, stiff_along_lines, 0, 4);
  tcase_add_test(tests, alternating_functions);
  tcase_add_test(tests, sizes);
  tcase_add_loop_test(tests, galerkin, 0, BODIES);
  add_sparse(tests, one_cycle, BODIES, 3);
  tcase_add_loop_test(tests, units, 0, 4);
  tcase_add_test(tests, far_apart);
  tcase_add_test(tests, instruction_sets);
  tcase_add_loop_test(tests, choice, 0, 4);
  tcase_add_loop_test(tests, floating, 0, 4);
  return tests;
}
