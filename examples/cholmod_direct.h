/* CHOLMOD (SuiteSparse) as the solver of MPM_SOLVER_HOST: a direct one, which sees the matrix where it lies.
 *
 *   cholmod_direct own;
 *   cholmod_direct_open(&own);
 *   mpm_stepper_set_linear_solver(stepper, cholmod_direct_solve, &own)
 *   cholmod_direct_close(&own);
 *
 * One of them serves one stepper, on the calling thread. */
#ifndef EXAMPLES_CHOLMOD_DIRECT_H
#define EXAMPLES_CHOLMOD_DIRECT_H

#include <mpm/mpm.h>

#include <stdlib.h>
#include <string.h>
#include <suitesparse/cholmod.h>

typedef struct cholmod_direct {
  cholmod_common common;
  cholmod_factor *factor; /* of the pattern that has this number */
  int64_t pattern_id;
  int32_t analyses, solves;
} cholmod_direct;

static void cholmod_direct_open(cholmod_direct *d) {
  *d = (cholmod_direct){.pattern_id = -1};
  cholmod_start(&d->common);
  d->common.print = 0;
}

static void cholmod_direct_close(cholmod_direct *d) {
  cholmod_free_factor(&d->factor, &d->common);
  cholmod_finish(&d->common);
}

/* The matrix is symmetric: by rows it is what CHOLMOD wants by columns, which with stype 1 reads its upper
 * triangle. Only the row starts have to be copied, to int. */
static mpm_status cholmod_direct_solve(void *user, const mpm_operator *matrix, const double *rhs,
                                       double *solution, double tolerance, int64_t *iterations) {
  cholmod_direct *d = user;
  const int64_t *start;
  const int32_t *column;
  const double *value;
  mpm_operator_info info = {.struct_size = sizeof info};
  (void)tolerance; /* a direct solver has its own */
  if (mpm_operator_get_info(matrix, &info) || mpm_operator_csr(matrix, &start, &column, &value)) return -1;
  if (!info.symmetric || info.rows >= INT32_MAX || info.nonzeros > INT32_MAX) return -1;
  int *p = malloc((size_t)(info.rows + 1) * sizeof *p);
  if (!p) return -1;
  for (int64_t i = 0; i <= info.rows; ++i) p[i] = (int)start[i];
  cholmod_sparse A = {.nrow = (size_t)info.rows,
                      .ncol = (size_t)info.rows,
                      .nzmax = (size_t)info.nonzeros,
                      .p = p,
                      .i = (void *)(uintptr_t)column,
                      .x = (void *)(uintptr_t)value,
                      .stype = 1,
                      .itype = CHOLMOD_INT,
                      .xtype = CHOLMOD_REAL,
                      .dtype = CHOLMOD_DOUBLE,
                      .sorted = 1,
                      .packed = 1};
  cholmod_dense b = {.nrow = (size_t)info.rows,
                     .ncol = 1,
                     .nzmax = (size_t)info.rows,
                     .d = (size_t)info.rows,
                     .x = (void *)(uintptr_t)rhs,
                     .xtype = CHOLMOD_REAL,
                     .dtype = CHOLMOD_DOUBLE};
  if (!d->factor || d->pattern_id != info.pattern_id) {
    cholmod_free_factor(&d->factor, &d->common);
    d->factor = cholmod_analyze(&A, &d->common);
    d->pattern_id = info.pattern_id;
    ++d->analyses;
  }
  cholmod_dense *x = NULL;
  if (d->factor && cholmod_factorize(&A, d->factor, &d->common) && d->common.status == CHOLMOD_OK)
    x = cholmod_solve(CHOLMOD_A, d->factor, &b, &d->common);
  if (x) memcpy(solution, x->x, (size_t)info.rows * sizeof *solution);
  const mpm_status status = x ? MPM_OK : 1; /* not positive definite: a shorter step may be */
  cholmod_free_dense(&x, &d->common);
  free(p);
  *iterations = 1;
  ++d->solves;
  return status;
}

#endif
