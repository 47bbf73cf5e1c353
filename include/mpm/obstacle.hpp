/**
 * @file obstacle.hpp
 * C++17: obstacles. See mpm.hpp.
 */
#ifndef MPM_OBSTACLE_HPP
#define MPM_OBSTACLE_HPP

#include <mpm/contact.hpp>
#include <mpm/context.hpp>
#include <mpm/obstacle.h>

#include <array>

namespace mpm {

/** As mpm_distance_fn: takes the batch and fills its distances and normals (mt). */
using distance_callback = callback<const mpm_distance_batch &>;
/** As mpm_motion_fn: takes t, dt, velocity[3] and angular_velocity[3]. */
using motion_callback = callback<double, double, double *, double *>;

/** An obstacle: the fields of mpm_obstacle_desc with their defaults, and a function object in place of its
 * pointer. */
struct obstacle_desc : mpm_obstacle_desc {
  /** Gives distances of MPM_SHAPE_DISTANCE, as distance does, which it replaces where it is set. */
  distance_callback on_distance;

  /** Starts with the defaults and a shape, one of MPM_SHAPE_PLANE ... */
  explicit obstacle_desc(int32_t of_shape = 0) : mpm_obstacle_desc() {
    if (const mpm_status status = mpm_obstacle_desc_init(this, sizeof(mpm_obstacle_desc)))
      throw error(status, "mpm_obstacle_desc_init");
    shape = of_shape;
  }
};

/** Where an obstacle is and how it moves, as mpm_obstacle_desc has it. */
struct pose {
  std::array<double, 3> position;         /**< of the centre */
  std::array<double, 4> orientation;      /**< unit quaternion w, x, y, z from axes of the body to space */
  std::array<double, 3> velocity;         /**< of the centre */
  std::array<double, 3> angular_velocity; /**< in space */
};

namespace detail {

/** The obstacle of C with its context and the host's functions. */
struct obstacle_core {
  std::shared_ptr<context_core> context; /**< outlives the obstacle */
  distance_callback distance;            /**< see obstacle_desc */
  motion_callback motion;                /**< see obstacle::set_motion() */
  mpm_obstacle *handle = nullptr;        /**< what mpm_obstacle_create() gave */

  explicit obstacle_core(std::shared_ptr<context_core> made_with) : context(std::move(made_with)) {}
  obstacle_core(const obstacle_core &) = delete;
  obstacle_core &operator=(const obstacle_core &) = delete;
  ~obstacle_core() {
    context->leave([held = handle] { return mpm_obstacle_destroy(held) == MPM_OK; });
  }

  /** The mpm_distance_fn that calls the host's function; user is an obstacle_core. */
  static mpm_status on_distance(void *user, const mpm_distance_batch *batch) {
    auto &self = *static_cast<obstacle_core *>(user);
    return guarded(self.context->exceptions, self.distance, *batch);
  }
  /** The mpm_motion_fn that calls the host's function. */
  static mpm_status on_motion(void *user, double t, double dt, double *velocity, double *angular_velocity) {
    auto &self = *static_cast<obstacle_core *>(user);
    return guarded(self.context->exceptions, self.motion, t, dt, velocity, angular_velocity);
  }
};

} // namespace detail

/** An obstacle: see obstacle.h. A stepper to which it was added keeps it alive. */
class obstacle : public wrapper<detail::obstacle_core> {
public:
  /** Makes an obstacle: see mpm_obstacle_create(). */
  obstacle(const context &made_with, obstacle_desc desc) : wrapper(made_with.shared()) {
    detail::obstacle_core &c = core();
    c.distance = std::move(desc.on_distance);
    if (c.distance) desc.distance = c.on_distance, desc.user = &c;
    check(mpm_obstacle_create(c.context->handle, &desc, &c.handle));
  }

  /** Sets the mean velocities of each step; nullptr: it keeps those that it has. See
   * mpm_obstacle_set_motion(). */
  void set_motion(motion_callback mean_velocities) {
    detail::obstacle_core &c = core();
    check(mpm_obstacle_set_motion(c.handle, mean_velocities ? c.on_motion : nullptr, &c));
    c.motion = std::move(mean_velocities);
  }
  /** Sets how it meets the material: see mpm_obstacle_set_contact(). */
  void set_contact(const mpm_contact_desc &desc) {
    check(mpm_obstacle_set_contact(core().handle, &desc));
  }
  /** Lets it meet the material as by default: see mpm_obstacle_set_contact(). */
  void reset_contact() {
    check(mpm_obstacle_set_contact(core().handle, nullptr));
  }
  /** Puts it somewhere; an empty argument keeps what it has. See mpm_obstacle_set_pose(). */
  void set_pose(span<const double> position, span<const double> orientation = {},
                span<const double> velocity = {}, span<const double> angular_velocity = {}) {
    check(mpm_obstacle_set_pose(core().handle, given("position", position, 3),
                                given("orientation", orientation, 4), given("velocity", velocity, 3),
                                given("angular_velocity", angular_velocity, 3)));
  }
  /** Where it is and how it moves: see mpm_obstacle_get_pose(). */
  mpm::pose pose() const {
    mpm::pose now{};
    check(mpm_obstacle_get_pose(core().handle, now.position.data(), now.orientation.data(),
                                now.velocity.data(), now.angular_velocity.data()));
    return now;
  }
  /** Sets the load on a free one; an empty argument keeps what it has. See mpm_obstacle_set_load(). */
  void set_load(span<const double> force, span<const double> torque = {}) {
    check(mpm_obstacle_set_load(core().handle, given("force", force, 3), given("torque", torque, 3)));
  }
  /** What a body, or all of them, and the obstacle did to each other in the last step: see
   * mpm_obstacle_contact_info(). */
  mpm::contact_info contact(int32_t body = MPM_BODY_ANY) const {
    mpm::contact_info info;
    check(mpm_obstacle_contact_info(core().handle, body, &info));
    return info;
  }

private:
  void check(mpm_status status) const {
    core().context->check(status);
  }
  static const double *given(const char *what, span<const double> values, int64_t size) {
    if (!values.empty()) detail::expect_size(what, values.size(), size);
    return values.empty() ? nullptr : values.data();
  }
};

} // namespace mpm

#endif
