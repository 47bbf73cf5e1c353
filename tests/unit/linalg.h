/* What the tests of linear systems share: matrices on grids of springs, dense algebra to compare with, hosts
 * that count memory. */
#ifndef LINALG_H
#define LINALG_H

#include <check.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "linalg/solver.h"
#include "linalg/vectors.h"

/* Springs between all nodes within `reach` of each other, each of them stiff along and across itself. */
typedef struct springs {
  int32_t dim, block, reach;
  int64_t n[3];      /* nodes along the axes in use */
  int32_t chains;    /* springs along the first axis only */
  int32_t periodic;  /* around the first axis */
  int32_t below;     /* axes begin at this index below 0 */
  int32_t holes;     /* one node in so many is left out; 0: none */
  int32_t clamped;   /* the plane of the first nodes along the first axis is held */
  int32_t rollers;   /* one component is held on nodes here and there */
  double mass;       /* on the diagonal */
  double convection; /* not symmetric unless 0 */
  double light;      /* one node in seven is scaled by this; 0: none */
} springs;
/* Columns of held unknowns are eliminated. Node numbers are 1000 + 7 row. */
void springs_build(mpmi_matrix *A, mpm_context *context, const springs *of);

/* x of noise, zero at held unknowns; to be freed. */
double *noise_vector(const mpmi_matrix *A, uint64_t seed);
/* b = A x for it; to be freed. */
double *rhs_for(const mpmi_matrix *A, const double *x);
double distance(int64_t n, const double *a, const double *b); /* of a and b, over that of b from 0 */

/* [n][n]; to be freed. */
double *dense_of(const mpmi_matrix *A);
void dense_solve(int64_t n, double *a, double *b); /* b becomes the solution */
int64_t dense_negative(int64_t n, double *a);      /* eigenvalues < 0 of a symmetric one, by rotations */

typedef struct counting {
  int64_t held, calls, fail_at;
} counting;
mpm_context *context_of(int32_t concurrency, int32_t isa, counting *memory);

/* A job with the usual settings, and what it must come to. */
mpmi_solve_job job_of(const mpmi_matrix *A, const double *b, double *x, int32_t choice);
#define solved(solver_, job_, report_)                                                                       \
  do {                                                                                                       \
    const mpm_status status_ = mpmi_solve(solver_, job_, report_);                                           \
    if (status_) ck_abort_msg("%s: %s", mpm_status_name(status_), mpm_last_error((job_)->matrix->context));  \
  } while (0)
#define refused(solver_, job_, report_, wanted_, text_)                                                      \
  do {                                                                                                       \
    const mpm_status status_ = mpmi_solve(solver_, job_, report_);                                           \
    if (status_ != (wanted_) || !strstr(mpm_last_error((job_)->matrix->context), text_))                     \
      ck_abort_msg("%s, wanted " #wanted_ ": \"%s\" in \"%s\"", mpm_status_name(status_), text_,             \
                   mpm_last_error((job_)->matrix->context));                                                 \
  } while (0)

TCase *linalg_matrix_case(void);
TCase *linalg_methods_case(void);
TCase *linalg_direct_case(void);
TCase *linalg_host_case(void);
TCase *linalg_multigrid_case(void);

#endif
