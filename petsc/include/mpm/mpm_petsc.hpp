/**
 * @file mpm_petsc.hpp
 * C++17: linear systems of implicit steps are solved by PETSc. See mpm_petsc.h and mpm.hpp.
 */
#ifndef MPM_PETSC_HPP
#define MPM_PETSC_HPP

#include <mpm/mpm.hpp>
#include <mpm/mpm_petsc.h>

namespace mpm {

/**
 * A solver of PETSc for steppers. It outlives the last step of each: declare it first. Where it ends,
 * all processes have to come, before PetscFinalize().
 *
 *     mpm::petsc solver(MPI_COMM_SELF);
 *     solver.attach(stepper);
 */
class petsc {
public:
  /** Makes a solver: see mpm_petsc_open(). */
  explicit petsc(MPI_Comm comm, const std::string &prefix = "mpm_") {
    const mpm_status status = mpm_petsc_open(comm, prefix.c_str(), &handle_);
    if (status) throw error(status, "mpm_petsc_open");
  }
  /** Takes the handle over. */
  petsc(petsc &&other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  /** Lets go of its handle and takes the other over. */
  petsc &operator=(petsc &&other) noexcept {
    if (this != &other) mpm_petsc_close(std::exchange(handle_, std::exchange(other.handle_, nullptr)));
    return *this;
  }
  /** Frees the solver: see mpm_petsc_close(). */
  ~petsc() {
    mpm_petsc_close(handle_);
  }

  /** The handle, for calls of the C interface. It stays the object's. NULL once it was moved from. */
  mpm_petsc *handle() const noexcept {
    return handle_;
  }
  /** Makes it the solver of a stepper: see mpm_petsc_solve(). stepper::set_linear_solver(nullptr) takes it
   * away.
   */
  void attach(stepper &to) const {
    to.set_linear_solver(nullptr);
    const mpm_status status = mpm_stepper_set_linear_solver(to.handle(), mpm_petsc_solve, handle_);
    if (status) throw error(status, "mpm_stepper_set_linear_solver");
  }
  /** The sentence on its last failure: see mpm_petsc_last_error(). */
  std::string last_error() const {
    return mpm_petsc_last_error(handle_);
  }
  /** What it has done: see mpm_petsc_info. */
  mpm_petsc_info info() const {
    mpm_petsc_info now{};
    now.struct_size = sizeof now;
    const mpm_status status = mpm_petsc_get_info(handle_, &now);
    if (status) throw error(status, mpm_petsc_last_error(handle_));
    return now;
  }

private:
  mpm_petsc *handle_ = nullptr;
};

} // namespace mpm

#endif
