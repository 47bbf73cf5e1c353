/* The methods of solution; solve.c chooses among them. */
#ifndef MPMI_METHODS_H
#define MPMI_METHODS_H

#include "linalg/system.h"

/* z = M^-1 r */
typedef mpm_status (*mpmi_precondition_fn)(void *user, const double *r, double *z);

/* Conjugate gradients from x on (cg.c); without a preconditioner with mpmi_inverse_diagonal().
 * MPM_NOT_CONVERGED and MPM_SINGULAR are left without a sentence; the latter says that the matrix is not
 * positive definite. */
mpm_status mpmi_cg(mpmi_system *s, mpmi_precondition_fn precondition, void *user, int64_t limit);

typedef struct mpmi_gmres_plan {
  mpmi_precondition_fn precondition;
  void *user;
  int32_t restart;   /* vectors of the basis */
  int32_t impatient; /* ends where progress is so slow that a factor is the better way */
  int64_t limit;     /* iterations */
} mpmi_gmres_plan;
/* GMRES from x on, with the preconditioner on the right: residuals are those of the system (gmres.c).
 * MPM_NOT_CONVERGED is left without a sentence. */
mpm_status mpmi_gmres(mpmi_system *s, const mpmi_gmres_plan *plan);

/* 1 / diagonal for CG; MPM_SINGULAR where an entry is not > 0, MPM_NONFINITE where it is not finite: *node is
 * the first row of the matrix with such a one. Inverse diagonal blocks for GMRES, where singular ones count
 * as the identity (preconditioner.c). */
mpm_status mpmi_inverse_diagonal(const mpmi_system *s, int64_t *node);
mpm_status mpmi_inverse_blocks(const mpmi_system *s, int64_t *node);
mpm_status mpmi_times_inverse_blocks(void *system, const double *r, double *z);

/* The factor and what it takes to reach the tolerance with it: LDL^T, or GMRES with L D U (direct.c). */
mpm_status mpmi_direct(mpmi_system *s);
/* The host's solver (host.c). */
mpm_status mpmi_solve_by_host(mpmi_system *s, const mpmi_solve_job *job);

#endif
