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
 * mpm_operator_get_info() reports owned rows, and solution is preset to the best guess known. The host writes
 * the solution, and into *iterations the number that linear_iterations is to count.
 *
 * - tolerance: the wanted ||matrix * solution - rhs|| / ||rhs||.
 *
 * Returns 0, a value > 0 if the system was not solved (MPM_CUT_DT), or a value < 0 to stop (MPM_E_CALLBACK).
 *
 * With several parts (parallel.h) it is called on all of them, and solves the system of all rows together:
 * each part lends the rows that it owns, complete, with the right-hand side on them, and takes its part of
 * the solution. Where the solver returns another value than 0 on a part, all parts have the outcome of the
 * lowest such; of the iterations the largest number counts. The residual is checked over all parts. A
 * solver that waits for its other parts ends on all of them when it ends on one.
 */
typedef mpm_status (*mpm_solve_fn)(void *user, const mpm_operator *matrix, const double *rhs,
                                   double *solution, double tolerance, int64_t *iterations);

/**
 * A linear system. The caller sets struct_size. The arrays belong to the library and are valid until the
 * solve callback returns. A row is one component of one node; nodes and components whose displacement is
 * prescribed have none. Rows of one node follow each other, by ascending component.
 *
 * With several parts a row is owned by exactly one part. Local rows 0 to owned_rows - 1 are those that this
 * part owns, in the order of nodes that it has; they are numbered first_row, first_row + 1, ... over all
 * parts, part by part. Behind them stand rows that other parts own, those alone that columns of owned rows
 * name: they have number, node, component and position, and no entries of their own. Every vector has
 * owned_rows entries. With one part all rows are owned, and number[i] is i.
 *
 * What a solver has made of a pattern serves as long as pattern_id is the same, of another stepper too.
 */
typedef struct mpm_operator_info {
  uint32_t struct_size;      /**< sizeof(mpm_operator_info) of the caller */
  int32_t block;             /**< number of rows of a node on which nothing is prescribed */
  int32_t symmetric;         /**< 1 if the matrix is symmetric, else 0 */
  int32_t positive_definite; /**< 1 if the matrix is expected to be positive definite, which is not checked */
  int64_t rows;              /**< number of local rows and of local columns */
  int64_t nonzeros;          /**< number of stored entries, all of them in owned rows */
  int64_t pattern_id;        /**< a hash of nodes, axes and columns, below 2^53, equal on all parts */
  int64_t ld;                /**< distance from component c to c + 1 of position, in elements; >= rows */
  const int64_t *node;       /**< [rows] number of the node of each row, as in mpm_step_info.node */
  const int32_t *component;  /**< [rows] axis of each row */
  const double *position;    /**< [dim][ld] position of the node of each row, for near-null spaces */
  int64_t first_row;         /**< number of the first owned row over all parts; 0 with one part */
  int64_t owned_rows;        /**< number of rows that this part owns; rows with one part */
  int64_t all_rows;          /**< number of rows of all parts together */
  const int64_t *number;     /**< [rows] number of each local row over all parts */
} mpm_operator_info;

/** Describes the system. This call and the two below may be made from within the solve callback only, one at
 * a time; at other times they return MPM_E_STATE. It waits for no other part. MPM_E_UNSUPPORTED: there are
 * several parts, and struct_size is that of a release without number. */
MPM_API mpm_status mpm_operator_get_info(const mpm_operator *matrix, mpm_operator_info *info);

/** Computes y = matrix * x on owned rows. Both vectors have owned_rows entries and do not overlap.
 *
 * With several parts it is (collective): x of rows that others own comes from them. It fails on all parts
 * that make it when one is refused, and with MPM_E_STATE when the solver has returned on a part, so that
 * nobody waits. */
MPM_API mpm_status mpm_operator_apply(const mpm_operator *matrix, const double *x, double *y);

/** Lends the matrix by compressed rows, with both triangles and with columns in ascending order: row r has
 * the entries (*row_start)[r] to (*row_start)[r + 1] - 1 of *column and *value. Columns are local ones, and
 * number of mpm_operator_info has those over all parts; rows that others own are empty. The arrays belong
 * to the library and are valid until the solve callback returns. It waits for no other part. MPM_E_NOMEM:
 * there is no memory for them. */
MPM_API mpm_status mpm_operator_csr(const mpm_operator *matrix, const int64_t **row_start,
                                    const int32_t **column, const double **value);

#ifdef __cplusplus
}
#endif

#endif
