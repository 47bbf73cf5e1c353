/* The methods of solution share one description of the linear system that they solve. */
#ifndef MPMI_SYSTEM_H
#define MPMI_SYSTEM_H

#include "linalg/multigrid.h"
#include "linalg/operator.h"
#include "linalg/solver.h"

struct mpmi_solver {
  mpm_context *context;
  mpmi_factor factor;
  mpmi_multigrid multigrid;
  mpm_operator lent; /* the operator that the host's solver borrows */
  double *work;      /* room for vectors */
  int64_t work_capacity;
  double *diagonal; /* inverse of the diagonal, or of its blocks */
  int64_t diagonal_capacity;
  double *inner; /* vectors of conjugate gradients that precondition */
  int64_t inner_capacity;
};

/* A system stands between job and report. */
typedef struct mpmi_system {
  mpmi_solver *solver;
  mpm_context *context;
  const mpmi_matrix *A;
  const double *b;
  double *x;
  int64_t n;      /* unknowns, with those that are held */
  double b_norm;  /* > 0 */
  double wanted;  /* the residual must have this norm or less */
  double reached; /* norm of the residual of the last solution */
  mpmi_solve_report *report;
  double *room; /* vectors for mpmi_cg() where those of the solver are in use; else NULL */
} mpmi_system;

/* Makes room for so many vectors of unknowns and `more` doubles. */
mpm_status mpmi_system_work(const mpmi_system *s, int64_t vectors, int64_t more);
/* Sets *good to 1 if a residual of this norm is small enough: as small as wanted, or all that rounding
 * leaves of A x - b. scratch: a vector. */
mpm_status mpmi_system_good(const mpmi_system *s, double norm, double *scratch, int32_t *good);

/* Of several parts: all have the status of the first one that has failed. */
mpm_status mpmi_system_together(const mpmi_system *s, mpm_status status);
/* The same for a status that may have been written for a row, by which the first is found; it goes into the
 * report. */
mpm_status mpmi_system_together_at(const mpmi_system *s, mpm_status status, int64_t row);

/* Fails with a sentence that names a row of the matrix, which goes into the report. */
mpm_status mpmi_system_fail_at(const mpmi_system *s, mpm_status status, int64_t row, const char *what);
mpm_status mpmi_system_not_converged(const mpmi_system *s, const char *method);

#endif
