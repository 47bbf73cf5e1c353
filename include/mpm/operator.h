/**
 * @file operator.h
 * The linear system of an implicit step, for hosts that solve it themselves: mpm_stepper_set_linear_solver()
 * in stepper.h takes the solver.
 */
#ifndef MPM_OPERATOR_H
#define MPM_OPERATOR_H

#include <mpm/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Solves matrix * solution = rhs. Runs on the calling thread. Both vectors have as many entries as
 * mpm_operator_get_info() reports rows, and solution is preset to the best guess known. The host writes the
 * solution, and into *iterations the number that linear_iterations is to count.
 *
 * - tolerance: the wanted ||matrix * solution - rhs|| / ||rhs||.
 *
 * Returns 0, a value > 0 if the system was not solved (MPM_CUT_DT), or a value < 0 to stop (MPM_E_CALLBACK).
 */
typedef mpm_status (*mpm_solve_fn)(void *user, const mpm_operator *matrix, const double *rhs,
                                   double *solution, double tolerance, int64_t *iterations);

/** A linear system. The caller sets struct_size. The arrays belong to the library and are valid until the
 * solve callback returns. A row is one component of one node; nodes and components whose displacement is
 * prescribed have none. */
typedef struct mpm_operator_info {
  uint32_t struct_size;      /**< sizeof(mpm_operator_info) of the caller */
  int32_t block;             /**< number of rows of a node on which nothing is prescribed */
  int32_t symmetric;         /**< 1 if the matrix is symmetric, else 0 */
  int32_t positive_definite; /**< 1 if the matrix is expected to be positive definite, which is not checked */
  int64_t rows;              /**< number of rows and of columns */
  int64_t nonzeros;          /**< number of stored entries */
  int64_t pattern_id;        /**< a number that stays the same as long as the sparsity does */
  int64_t ld;                /**< distance from component c to c + 1 of position, in elements; >= rows */
  const int64_t *node;       /**< [rows] number of the node of each row, as in mpm_step_info.node */
  const int32_t *component;  /**< [rows] axis of each row */
  const double *position;    /**< [dim][ld] position of the node of each row, for near-null spaces */
} mpm_operator_info;

/** Describes the system. This call and the two below may be made from within the solve callback only, one at
 * a time; at other times they return MPM_E_STATE. */
MPM_API mpm_status mpm_operator_get_info(const mpm_operator *matrix, mpm_operator_info *info);

/** Computes y = matrix * x. Both vectors have the rows of the system and do not overlap. */
MPM_API mpm_status mpm_operator_apply(const mpm_operator *matrix, const double *x, double *y);

/** Lends the matrix by compressed rows, with both triangles and with columns in ascending order: row r has
 * the entries (*row_start)[r] to (*row_start)[r + 1] - 1 of *column and *value. The arrays belong to the
 * library and are valid until the solve callback returns. MPM_E_NOMEM: there is no memory for them. */
MPM_API mpm_status mpm_operator_csr(const mpm_operator *matrix, const int64_t **row_start,
                                    const int32_t **column, const double **value);

#ifdef __cplusplus
}
#endif

#endif
