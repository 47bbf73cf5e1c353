/**
 * @file stepper_core.hpp
 * C++17: descriptors and callbacks of the time loop, and what a stepper keeps alive. See mpm.hpp.
 */
#ifndef MPM_STEPPER_CORE_HPP
#define MPM_STEPPER_CORE_HPP

#include <mpm/adaption.hpp>
#include <mpm/heat.hpp>
#include <mpm/linear_system.hpp>
#include <mpm/obstacle.hpp>
#include <mpm/surface.hpp>
#include <mpm/particles.hpp>
#include <mpm/stepper.h>

#include <array>

namespace mpm {

/** An mpm_stepper_desc that starts with the defaults. */
struct stepper_desc : mpm_stepper_desc {
  /** Starts with the defaults. */
  stepper_desc() : mpm_stepper_desc() {
    if (const mpm_status status = mpm_stepper_desc_init(this, sizeof(mpm_stepper_desc)))
      throw error(status, "mpm_stepper_desc_init");
  }
};

/** An mpm_balance_desc that starts with the defaults. */
struct balance_desc : mpm_balance_desc {
  /** Starts with the defaults. */
  balance_desc() : mpm_balance_desc() {
    if (const mpm_status status = mpm_balance_desc_init(this, sizeof(mpm_balance_desc)))
      throw error(status, "mpm_balance_desc_init");
  }
};

/** An mpm_advance_desc that starts with the defaults. */
struct advance_desc : mpm_advance_desc {
  /** Starts with the defaults and t_end = t, the time to reach. */
  explicit advance_desc(double t = 0.0) : mpm_advance_desc() {
    if (const mpm_status status = mpm_advance_desc_init(this, sizeof(mpm_advance_desc)))
      throw error(status, "mpm_advance_desc_init");
    t_end = t;
  }
};

/** An mpm_step_info that is ready to be filled. */
struct step_info : mpm_step_info {
  /** Starts with struct_size set and zeros elsewhere. */
  step_info() : mpm_step_info() {
    struct_size = sizeof(mpm_step_info);
  }
};

/** As mpm_particle_fn: takes batch and add, and adds to add[c * batch.ld + i] (mt). */
using particle_callback = callback<const mpm_particle_batch &, double *>;
/** As mpm_velocity_fn: takes batch, prescribed and velocity (mt). */
using velocity_callback = callback<const mpm_node_batch &, uint8_t *, double *>;
/** As mpm_node_fn: takes batch, velocity and force (mt). */
using node_callback = callback<const mpm_node_batch &, double *, double *>;
/** As mpm_progress_fn: a status > 0 ends the call with MPM_CANCELLED. */
using progress_callback = callback<const mpm_step_info &>;

namespace detail {

/** The stepper of C with its grid, its sets, obstacles and surfaces, and the host's functions. */
struct stepper_core {
  /** A function where C finds it, as its user pointer. */
  template <class F> struct slot {
    F function;         /**< not empty */
    thrown &exceptions; /**< those of the context */
  };
  /** The motion of a set's prescribed particles. */
  struct motion {
    const mpm_particles *set;                      /**< the set that moves */
    std::unique_ptr<slot<particle_callback>> rule; /**< its mean velocity */
  };

  /** The host's word on how a set adapts. */
  struct adaption {
    const mpm_particles *set;                      /**< the set that adapts */
    std::unique_ptr<slot<adaption_callback>> rule; /**< what it accepts */
  };

  /** The host's word on what heats a set. */
  struct heat {
    const mpm_particles *set;                  /**< the set that is heated */
    std::unique_ptr<slot<heat_callback>> rule; /**< its sources */
  };

  std::shared_ptr<context_core> context;                     /**< outlives the stepper */
  std::shared_ptr<grid_core> grid;                           /**< outlives the stepper */
  std::vector<std::shared_ptr<particles_core>> sets;         /**< outlive the stepper, or are removed */
  std::vector<std::shared_ptr<obstacle_core>> obstacles;     /**< outlive the stepper, or are removed */
  std::vector<std::shared_ptr<surface_core>> surfaces;       /**< outlive the stepper, or are removed */
  std::vector<motion> motions;                               /**< see stepper::set_motion() */
  std::vector<adaption> adaptions;                           /**< see stepper::set_adaption() */
  std::vector<heat> heats;                                   /**< see stepper::set_heat() */
  std::unique_ptr<slot<particle_callback>> acceleration;     /**< see stepper::set_acceleration() */
  std::unique_ptr<slot<particle_callback>> force;            /**< see stepper::set_force() */
  std::unique_ptr<slot<velocity_callback>> velocity;         /**< see stepper::set_velocity_bc() */
  std::array<std::unique_ptr<slot<node_callback>>, 3> hooks; /**< see stepper::set_node_hook() */
  std::unique_ptr<slot<friction_callback>> friction;         /**< see stepper::set_friction() */
  std::unique_ptr<slot<solve_callback>> solver;              /**< see stepper::set_linear_solver() */
  std::unique_ptr<slot<progress_callback>> progress;         /**< see stepper::set_progress() */
  mpm_stepper *handle = nullptr;                             /**< what mpm_stepper_create() gave */

  explicit stepper_core(std::shared_ptr<grid_core> on) : context(on->context), grid(std::move(on)) {}
  stepper_core(const stepper_core &) = delete;
  stepper_core &operator=(const stepper_core &) = delete;
  ~stepper_core() {
    context->leave([held = handle] {
      if (mpm_stepper_destroy(held) == MPM_OK) return true;
      mpm_step_abort(held);
      return mpm_stepper_destroy(held) == MPM_OK;
    });
  }

  /** Does as context_core::result(), for calls that run callbacks: the exception that comes out is that of
   * the failure that the library reports. */
  outcome result(mpm_status status) {
    if (status != MPM_E_CALLBACK) return context->result(status);
    const std::string message = mpm_last_error(context->handle);
    step_info last;
    mpm_stepper_info(handle, &last); // may refuse, too, and then leaves last as it is
    const std::exception_ptr exception = context->exceptions.take(last.callback_status);
    if (exception) std::rethrow_exception(exception);
    throw error(status, message);
  }
  /** Makes a function ready for C; gives nullptr if it is empty. */
  template <class F> std::unique_ptr<slot<F>> keep(F function) {
    if (!function) return nullptr;
    return std::unique_ptr<slot<F>>(new slot<F>{std::move(function), context->exceptions});
  }
  /** Calls the function to which user points. */
  template <class F, class... A> static mpm_status call(void *user, A &&...arguments) noexcept {
    auto &at = *static_cast<slot<F> *>(user);
    return guarded(at.exceptions, at.function, std::forward<A>(arguments)...);
  }
  /** The mpm_particle_fn that calls the host's function. */
  static mpm_status on_particles(void *user, const mpm_particle_batch *batch, double *add) {
    return call<particle_callback>(user, *batch, add);
  }
  /** The mpm_velocity_fn that calls the host's function. */
  static mpm_status on_velocity(void *user, const mpm_node_batch *batch, uint8_t *prescribed, double *value) {
    return call<velocity_callback>(user, *batch, prescribed, value);
  }
  /** The mpm_node_fn that calls the host's function. */
  static mpm_status on_nodes(void *user, const mpm_node_batch *batch, double *value, double *nodal_force) {
    return call<node_callback>(user, *batch, value, nodal_force);
  }
  /** The mpm_friction_fn that calls the host's function. */
  static mpm_status on_contact(void *user, const mpm_contact_batch *batch, double *value) {
    return call<friction_callback>(user, *batch, value);
  }
  /** The mpm_adaption_fn that calls the host's function. */
  static mpm_status on_adaption(void *user, const mpm_adaption_batch *batch, uint8_t *accept) {
    return call<adaption_callback>(user, *batch, accept);
  }
  /** The mpm_heat_fn that calls the host's function. */
  static mpm_status on_heat(void *user, const mpm_particle_batch *batch, double *power) {
    return call<heat_callback>(user, *batch, power);
  }
  /** The mpm_progress_fn that calls the host's function. */
  static mpm_status on_progress(void *user, const mpm_step_info *info) {
    return call<progress_callback>(user, *info);
  }
  /** The mpm_solve_fn that calls the host's function. */
  static mpm_status on_solve(void *user, const mpm_operator *matrix, const double *rhs, double *solution,
                             double tolerance, int64_t *iterations) {
    auto &at = *static_cast<slot<solve_callback> *>(user);
    return guarded(at.exceptions, [&] {
      const linear_system system(matrix, rhs, solution, tolerance);
      return at.function(system, *iterations);
    });
  }
};

} // namespace detail

} // namespace mpm

#endif
