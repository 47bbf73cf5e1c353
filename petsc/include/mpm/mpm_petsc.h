/**
 * @file mpm_petsc.h
 * libmpm-petsc, a companion of libmpm: linear systems of implicit steps are solved by PETSc, on one process
 * or on all processes of a communicator, among which libmpm-mpi (mpm_mpi.h) has spread the problem. Link
 * with mpm-petsc (pkg-config).
 *
 * The method is algebraic multigrid by smoothed aggregation (GAMG), which is told the rigid motions of a
 * body, as the preconditioner of conjugate gradients, or of GMRES where the matrix is not symmetric and
 * positive definite. Options of PETSc choose others that measure the residual itself, and direct ones
 * (preonly); each solver has a prefix for them. The tolerance is the stepper's.
 *
 * It takes PETSc 3.17 or later. The host starts PETSc, by PetscInitialize(), and ends it. The contract of
 * mpm.h (status, structs, threads) holds here too. Calls marked (collective) are made on all processes of
 * the communicator.
 *
 * The library never ends the program and prints nothing: errors of PETSc are statuses. After MPM_E_CALLBACK
 * other processes may wait for ever within PETSc, where one alone has run out of memory, and the host ends
 * them, by MPI_Abort().
 *
 * Adams, Bayraktar, Keaveny & Papadopoulos 2004 for GAMG; Balay et al., PETSc Users Manual, ANL-21/39.
 */
#ifndef MPM_PETSC_H
#define MPM_PETSC_H

#include <mpi.h>
#include <mpm/mpm.h>

/** Marks every exported function of libmpm-petsc. A host may define it before the first include. */
#ifndef MPM_PETSC_API
#if defined(__GNUC__) || defined(__clang__)
#define MPM_PETSC_API __attribute__((visibility("default")))
#else
#define MPM_PETSC_API
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** A solver of PETSc with its matrix. Serves one thread at a time, and any steppers of contexts with the same
 * parts: one that comes after another makes the matrix anew. */
typedef struct mpm_petsc mpm_petsc;

/**
 * Makes a solver (collective), which lives until mpm_petsc_close(). comm has the parts of the problem as its
 * processes, in their order: the communicator of mpm_mpi_open(), or MPI_COMM_SELF for a context of one part.
 * It is duplicated. On failure *out is NULL.
 *
 * - prefix: of options in PETSc's database, 1 to 63 letters, digits and underscores that begin with a
 *   letter, as in "-mpm_ksp_view" for "mpm_"; "" for options without a prefix; NULL is "mpm_". Where the host
 *   sets none for the smoother of multigrid this library has its own: two steps of Chebyshev's over
 *   incomplete factors, each of the rows of a process and those beside them.
 *
 * - MPM_E_ARG: out is NULL, comm is MPI_COMM_NULL or an intercommunicator, or prefix is none.
 * - MPM_E_STATE: PETSc is not started, or has ended.
 * - MPM_E_NOMEM: memory ran out on a process.
 * - MPM_E_CALLBACK: MPI or PETSc has failed.
 */
MPM_PETSC_API mpm_status mpm_petsc_open(MPI_Comm comm, const char *prefix, mpm_petsc **out);

/** Frees the solver (collective), before PetscFinalize(), when no stepper calls it any more. NULL is fine.
 * MPM_E_STATE: PETSc has ended: the handle is freed all the same, and the memory of PETSc's matrix and
 * solver is lost. MPM_E_CALLBACK: MPI or PETSc has failed. */
MPM_PETSC_API mpm_status mpm_petsc_close(mpm_petsc *petsc);

/**
 * Is the mpm_solve_fn of the solver (collective), with the mpm_petsc as its user pointer:
 *
 *     mpm_stepper_set_linear_solver(stepper, mpm_petsc_solve, petsc);
 *
 * The stepper has linear_solver = MPM_SOLVER_HOST. The matrix gets its structure once for each pattern
 * (pattern_id), and values in each call. Components of nodes that are held, which the library has no rows
 * for, are rows of the identity there, so that all nodes have as many unknowns.
 *
 * Returns 0; 1 where the iterations do not come to the tolerance, which makes the step end with MPM_CUT_DT;
 * and a status < 0, which makes it end with MPM_E_CALLBACK: MPM_E_ARG: the communicator does not have the
 * parts of the stepper's context. MPM_E_UNSUPPORTED: there are more unknowns than PetscInt counts.
 * MPM_E_CALLBACK: MPI or PETSc has failed. Others are those of mpm_operator_get_info() and
 * mpm_operator_csr(). All processes return the same but for failures within PETSc. mpm_petsc_last_error()
 * has the sentence.
 */
MPM_PETSC_API mpm_status mpm_petsc_solve(void *petsc, const mpm_operator *matrix, const double *rhs,
                                         double *solution, double tolerance, int64_t *iterations);

/** Gives one sentence on the last call that failed on this process; "" if there is none, and a sentence
 * that says so if petsc is NULL. Valid until the next call. */
MPM_PETSC_API const char *mpm_petsc_last_error(const mpm_petsc *petsc);

/** What a solver has done. The caller sets struct_size. */
typedef struct mpm_petsc_info {
  uint32_t struct_size; /**< sizeof(mpm_petsc_info) of the caller */
  int32_t reason;       /**< KSPConvergedReason of the last system; 0: there was none */
  int64_t solves;       /**< number of systems */
  int64_t patterns;     /**< number of structures that the matrix has had */
  int64_t iterations;   /**< of all systems together */
  int64_t unknowns;     /**< rows of the last matrix, with those of the identity; of all processes */
} mpm_petsc_info;

/** Tells what the solver has done. MPM_E_ARG: petsc or info is NULL, or struct_size is not set. */
MPM_PETSC_API mpm_status mpm_petsc_get_info(mpm_petsc *petsc, mpm_petsc_info *info);

#ifdef __cplusplus
}
#endif

#endif
