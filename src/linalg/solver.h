/* Implicit steps have linear systems solved: a job says what the stepper asks for, a report what came of
 * it. */
#ifndef MPMI_SOLVER_H
#define MPMI_SOLVER_H

#include "linalg/matrix.h"

/* A solver keeps its work memory, and the structure of the factor while the pattern is the same. */
typedef struct mpmi_solver mpmi_solver;

typedef struct mpmi_solve_job {
  const mpmi_matrix *matrix; /* after mpmi_matrix_eliminate() */
  const double *rhs;         /* [rows * block], 0 at held unknowns */
  double *x;                 /* in: the best guess, or 0; out: the solution, 0 at held unknowns */
  int32_t choice;            /* MPM_SOLVER_AUTO ... MPM_SOLVER_HOST */
  double tolerance;          /* ||A x - b|| <= tolerance ||b||, or what rounding allows */
  int64_t max_iterations;    /* 0: chosen by the solver */
  mpm_solve_fn host;         /* the solver of MPM_SOLVER_HOST */
  void *host_user;
  int32_t expects_positive; /* 1: the host is told that the matrix should be positive definite */
  double inertia;           /* share of inertia in the diagonal; 0: none or not known */
  int32_t several_fields;   /* rows of several bodies at one index are coupled: no multigrid */
} mpmi_solve_job;

typedef struct mpmi_solve_report {
  int32_t solver;          /* the solver that gave the answer: MPM_SOLVER_CG, MPM_SOLVER_MULTIGRID_CG ... */
  int64_t iterations;      /* of CG and GMRES, or as the host counted; 0 for LDLT */
  int32_t indefinite;      /* the matrix was seen not to be positive definite */
  int64_t negative;        /* pivots < 0, if LDLT ran to its end, else -1 */
  int64_t node;            /* number of the node of a tiny pivot or a bad diagonal, else -1 */
  int32_t callback_status; /* what the host's solver returned */
  double factor_seconds, solve_seconds; /* for order and factor or preconditioner, and for the rest */
} mpmi_solve_report;

mpm_status mpmi_solver_create(mpm_context *context, mpmi_solver **out);
void mpmi_solver_destroy(mpmi_solver *solver); /* NULL is fine */

/* Solves the system. Each failure leaves a sentence in the context:
 *
 *   MPM_SINGULAR        a pivot is tiny (the report has its node); or an iteration met a matrix that is not
 *                       positive definite, and was asked for by name or the factor is too large
 *
 *   MPM_NOT_CONVERGED   the tolerance was not reached, or the host claims a solution that is none
 *
 *   MPM_NONFINITE       the matrix, the right-hand side or the host's solution is not finite
 *
 *   MPM_CUT_DT, MPM_E_CALLBACK   the host's solver asks for it
 *
 *   MPM_E_UNSUPPORTED   CG, multigrid or LDLT cannot take a matrix that is not symmetric
 *
 *   MPM_E_STATE         MPM_SOLVER_HOST was asked for, and the host has set no solver
 *
 *   MPM_E_ARG           there is no such solver
 *
 *   MPM_E_NOMEM         memory ran out */
mpm_status mpmi_solve(mpmi_solver *solver, const mpmi_solve_job *job, mpmi_solve_report *report);

#endif
