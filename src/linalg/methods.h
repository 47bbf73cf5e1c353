/* These are the methods that solve a system; solve.c chooses among them. */
#ifndef MPMI_METHODS_H
#define MPMI_METHODS_H

#include "linalg/system.h"

/* A preconditioner sets z = M^-1 r. */
typedef mpm_status (*mpmi_precondition_fn)(void *user, const double *r, double *z);

/* Conjugate gradients start from x (cg.c). Without a preconditioner they scale with what
 * mpmi_inverse_diagonal() has left. MPM_NOT_CONVERGED and MPM_SINGULAR come without a sentence in the
 * context; the latter says that the matrix is not positive definite. */
mpm_status mpmi_cg(mpmi_system *s, mpmi_precondition_fn precondition, void *user, int64_t limit);

typedef struct mpmi_gmres_plan {
  mpmi_precondition_fn precondition;
  void *user;
  int32_t together;  /* 1: all parts are asked to precondition, or none */
  int32_t restart;   /* how many vectors the basis may have */
  int32_t impatient; /* 1: ends where progress is so slow that a factor is the better way */
  int64_t limit;     /* the most iterations, counted in the report */
} mpmi_gmres_plan;
/* GMRES starts from x and has the preconditioner on the right, so that residuals are those of the system
 * (gmres.c). MPM_NOT_CONVERGED comes without a sentence in the context. */
mpm_status mpmi_gmres(mpmi_system *s, const mpmi_gmres_plan *plan);

/* The first inverts the diagonal for CG: MPM_SINGULAR where an entry is not > 0, MPM_NONFINITE where it is
 * not finite; *node is the first row of the matrix with such an entry. The second inverts diagonal blocks
 * for GMRES, where singular ones count as the identity; the third applies them (preconditioner.c). */
mpm_status mpmi_inverse_diagonal(const mpmi_system *s, int64_t *node);
mpm_status mpmi_inverse_blocks(const mpmi_system *s, int64_t *node);
mpm_status mpmi_times_inverse_blocks(void *system, const double *r, double *z);
/* Conjugate gradients precondition GMRES, where blocks do too little: r comes with norm 1, and z is A^-1 r as
 * if the matrix were symmetric, to a thousandth. First room is made, and the diagonal inverted as for CG. */
typedef struct mpmi_inner_cg {
  mpmi_system *system;
  int64_t limit; /* the most iterations of both methods, counted in the report */
} mpmi_inner_cg;
mpm_status mpmi_reserve_inner_cg(mpmi_system *s, int64_t *node);
mpm_status mpmi_times_inner_cg(void *inner_cg, const double *r, double *z);

/* The direct solver reaches the tolerance with LDL^T, or with GMRES and L D U (direct.c). */
mpm_status mpmi_direct(mpmi_system *s);
/* The host's solver gets the system, and its answer is checked (host.c). */
mpm_status mpmi_solve_by_host(mpmi_system *s, const mpmi_solve_job *job);

#endif
