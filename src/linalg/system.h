/* One linear system on its way to a solution: what the methods share. */
#ifndef MPMI_SYSTEM_H
#define MPMI_SYSTEM_H

#include "linalg/multigrid.h"
#include "linalg/operator.h"
#include "linalg/solver.h"
#include "linalg/vectors.h"

struct mpmi_solver {
  mpm_context *context;
  mpmi_factor factor;
  mpmi_multigrid multigrid;
  mpm_operator lent; /* to the host's solver */
  double *work;      /* vectors */
  int64_t work_capacity;
  double *diagonal; /* inverse of the diagonal, or of its blocks */
  int64_t diagonal_capacity;
};

/* One system on its way. */
typedef struct mpmi_system {
  mpmi_solver *solver;
  mpm_context *context;
  const mpmi_matrix *A;
  const double *b;
  double *x;
  int64_t n;      /* unknowns, held ones too */
  double b_norm;  /* > 0 */
  double wanted;  /* norm of the residual */
  double reached; /* that of the last solution */
  mpmi_solve_report *report;
} mpmi_system;

/* Room for so many vectors. */
mpm_status mpmi_system_work(const mpmi_system *s, int64_t vectors, int64_t more);
/* Whether a residual of this norm will do: it is as wanted, or all that rounding leaves of A x - b. scratch:
 * a vector. */
mpm_status mpmi_system_good(const mpmi_system *s, double norm, double *scratch, int32_t *good);

/* Fails with a sentence that names a row of the matrix, which goes into the report. */
mpm_status mpmi_system_fail_at(const mpmi_system *s, mpm_status status, int64_t row, const char *what);
mpm_status mpmi_system_not_converged(const mpmi_system *s, const char *method);

#endif
