/**
 * @file linear_system.hpp
 * C++17: the linear system of an implicit step, for a solver of the host. See mpm.hpp.
 */
#ifndef MPM_LINEAR_SYSTEM_HPP
#define MPM_LINEAR_SYSTEM_HPP

#include <mpm/callback.hpp>
#include <mpm/operator.h>

namespace mpm {

/** A matrix by compressed rows: see mpm_operator_csr(). The arrays belong to the library. */
struct csr_matrix {
  span<const int64_t> row_start; /**< [owned_rows + 1] place of the first entry of each owned row */
  span<const int32_t> column;    /**< [nonzeros] column of each entry */
  span<const double> value;      /**< [nonzeros] value of each entry */
};

/** The system that a solve_callback solves. It is valid during the call. Its calls throw error, which ends
 * the step. */
class linear_system {
public:
  /** Takes the arguments of mpm_solve_fn. */
  linear_system(const mpm_operator *matrix, const double *rhs, double *solution, double tolerance)
      : matrix_(matrix), tolerance_(tolerance) {
    info_.struct_size = sizeof info_;
    check(mpm_operator_get_info(matrix, &info_), "mpm_operator_get_info");
    if (!info_.all_rows) info_.all_rows = info_.owned_rows = info_.rows; // of a library without parts
    rhs_ = {rhs, static_cast<std::size_t>(info_.owned_rows)};
    solution_ = {solution, static_cast<std::size_t>(info_.owned_rows)};
  }
  /** Describes rows, symmetry and nodes: see mpm_operator_info. */
  const mpm_operator_info &info() const noexcept {
    return info_;
  }
  /** The right-hand side of the owned rows. */
  span<const double> rhs() const noexcept {
    return rhs_;
  }
  /** The solution on the owned rows, to be written by the host; it is preset to the best guess known. */
  span<double> solution() const noexcept {
    return solution_;
  }
  /** The wanted ||matrix * solution - rhs|| / ||rhs||. */
  double tolerance() const noexcept {
    return tolerance_;
  }
  /** The numbers of all local rows over all parts. */
  span<const int64_t> number() const noexcept {
    return {info_.number, info_.number ? static_cast<std::size_t>(info_.rows) : 0};
  }
  /** Computes y = matrix * x: see mpm_operator_apply(). */
  void apply(span<const double> x, span<double> y) const {
    detail::expect_size("x", x.size(), info_.owned_rows);
    detail::expect_size("y", y.size(), info_.owned_rows);
    check(mpm_operator_apply(matrix_, x.data(), y.data()), "mpm_operator_apply");
  }
  /** The matrix by compressed rows: see mpm_operator_csr(). */
  csr_matrix csr() const {
    const int64_t *row_start = nullptr;
    const int32_t *column = nullptr;
    const double *value = nullptr;
    check(mpm_operator_csr(matrix_, &row_start, &column, &value), "mpm_operator_csr");
    const auto rows = static_cast<std::size_t>(info_.owned_rows),
               entries = static_cast<std::size_t>(info_.nonzeros);
    return {{row_start, rows + 1}, {column, entries}, {value, entries}};
  }

private:
  static void check(mpm_status status, const char *call) {
    if (status) throw error(status, call);
  }
  const mpm_operator *matrix_;
  double tolerance_;
  mpm_operator_info info_ = {};
  span<const double> rhs_;
  span<double> solution_;
};

/** As mpm_solve_fn: takes the system and the number of iterations, and writes system.solution() and, where
 * they are to be counted, the iterations. A status > 0 says that the system was not solved. */
using solve_callback = callback<const linear_system &, int64_t &>;

} // namespace mpm

#endif
