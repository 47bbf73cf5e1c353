/**
 * @file staged_step.hpp
 * C++17: a step in parts. See mpm.hpp.
 */
#ifndef MPM_STAGED_STEP_HPP
#define MPM_STAGED_STEP_HPP

#include <mpm/stepper_core.hpp>

namespace mpm {

/** A step in parts, which stepper::begin() begins. It is ended by end(), and dropped by abort(), by
 * destruction and by a part that is not done. */
class staged_step {
public:
  /** Takes the step over. */
  staged_step(staged_step &&) noexcept = default;
  /** Drops the step that it held before. */
  staged_step &operator=(staged_step &&other) noexcept {
    staged_step taken(std::move(other));
    std::swap(core_, taken.core_);
    std::swap(begun_, taken.begun_);
    return *this;
  }
  /** Drops the step unless it is over. */
  ~staged_step() {
    if (core_) mpm_step_abort(core_->handle);
  }
  /** The outcome of the first part. Unless that was done there are no others. */
  const outcome &begun() const noexcept {
    return begun_;
  }
  /** Makes the second part: see mpm_step_grid(). */
  outcome update_grid() {
    return part(mpm_step_grid(core().handle));
  }
  /** Makes the last part: see mpm_step_end(). */
  outcome end() {
    const outcome result = part(mpm_step_end(core().handle, nullptr));
    core_.reset();
    return result;
  }
  /** Makes the last part and fills info with what the step did. */
  outcome end(mpm_step_info &info) {
    const outcome result = part(mpm_step_end(core().handle, &info));
    core_.reset();
    return result;
  }
  /** Drops the step: see mpm_step_abort(). Throws error (MPM_E_STATE) while a view of nodal fields is out. */
  void abort() {
    core().context->check(mpm_step_abort(core().handle));
    core_.reset();
  }

private:
  friend class stepper;
  staged_step(std::shared_ptr<detail::stepper_core> of, double dt) : core_(std::move(of)) {
    begun_ = part(mpm_step_begin(core_->handle, dt));
  }
  detail::stepper_core &core() const {
    if (!core_) throw error(MPM_E_STATE, "the step is over");
    return *core_;
  }
  /* A part that fails has dropped the step, unless it was refused out of hand. */
  outcome part(mpm_status status) {
    const std::shared_ptr<detail::stepper_core> core = core_;
    if (status != MPM_OK && status != MPM_E_STATE && status != MPM_E_ARG) core_.reset();
    return core->result(status);
  }

  std::shared_ptr<detail::stepper_core> core_;
  outcome begun_;
};

} // namespace mpm

#endif
