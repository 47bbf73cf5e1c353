/* Linear systems of implicit steps: what the stepper asks for, and what it is told. */
#ifndef MPMI_SOLVER_H
#define MPMI_SOLVER_H

#include "linalg/matrix.h"

/* Work memory, and the structure of the factor while the pattern is the same. */
typedef struct mpmi_solver mpmi_solver;

typedef struct mpmi_solve_job {
  const mpmi_matrix *matrix; /* eliminated */
  const double *rhs;         /* [rows * block], 0 at held unknowns */
  double *x;              /* in: the best guess, 0 if there is none; out: the solution, 0 at held unknowns */
  int32_t choice;         /* MPM_SOLVER_AUTO ... MPM_SOLVER_HOST */
  double tolerance;       /* ||A x - b|| <= tolerance ||b||, or what rounding allows */
  int64_t max_iterations; /* 0: chosen by the solver */
  mpm_solve_fn host;      /* of MPM_SOLVER_HOST */
  void *host_user;
  int32_t expects_positive; /* what to tell the host */
  double inertia;           /* its share of the diagonal; 0: none or not known */
} mpmi_solve_job;

typedef struct mpmi_solve_report {
  int32_t solver;                       /* the one that gave the answer: MPM_SOLVER_CG, MULTIGRID_CG ... */
  int64_t iterations;                   /* of CG and GMRES, or as the host counted; 0 for LDLT */
  int32_t indefinite;                   /* the matrix was seen not to be positive definite */
  int64_t negative;                     /* pivots < 0, if LDLT ran to its end, else -1 */
  int64_t node;                         /* number of the node of a tiny pivot or a bad diagonal, else -1 */
  int32_t callback_status;              /* what the host's solver returned */
  double factor_seconds, solve_seconds; /* order and factor, or preconditioner; the rest */
} mpmi_solve_report;

mpm_status mpmi_solver_create(mpm_context *context, mpmi_solver **out);
void mpmi_solver_destroy(mpmi_solver *solver); /* NULL is fine */

/* Each with a sentence in the context:
 * MPM_SINGULAR: a pivot is tiny (names the node), or an iteration met an indefinite matrix, and was asked for
 * alone or the factor is too large.
 * MPM_NOT_CONVERGED: the tolerance was not reached, or the host claims a solution that is none.
 * MPM_NONFINITE: in matrix or right-hand side (names the node), or in the host's solution.
 * MPM_CUT_DT, MPM_E_CALLBACK: as the host's solver asks.
 * MPM_E_UNSUPPORTED: CG, with multigrid or without, or LDLT for a matrix that is not symmetric.
 * MPM_E_STATE: MPM_SOLVER_HOST without a host's solver. MPM_E_ARG: no such solver. MPM_E_NOMEM. */
mpm_status mpmi_solve(mpmi_solver *solver, const mpmi_solve_job *job, mpmi_solve_report *report);

#endif
