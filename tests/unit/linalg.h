/* What the tests of linear systems share: matrices on grids of springs, dense algebra to compare with, hosts
 * that count memory. */
#ifndef LINALG_H
#define LINALG_H

#include <float.h>

#include "linalg/solver.h"
#include "linalg/vectors.h"
#include "world.h"

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
  double stiff;      /* more stiffness of springs along an axis, against motion along it */
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

/* A job with the usual settings, and what it must come to. */
mpmi_solve_job job_of(const mpmi_matrix *A, const double *b, double *x, int32_t choice);
#define solved(solver_, job_, report_) ck_ok((job_)->matrix->context, mpmi_solve(solver_, job_, report_))
#define refused(solver_, job_, report_, wanted_, text_)                                                      \
  ck_refused((job_)->matrix->context, mpmi_solve(solver_, job_, report_), wanted_, text_)

TCase *linalg_matrix_case(void);
TCase *linalg_methods_case(void);
TCase *linalg_direct_case(void);
TCase *linalg_host_case(void);
TCase *linalg_multigrid_case(void);

#endif
