/**
 * @file grid.hpp
 * C++17: the background grid. See mpm.hpp.
 */
#ifndef MPM_GRID_HPP
#define MPM_GRID_HPP

#include <mpm/context.hpp>
#include <mpm/grid.h>

namespace mpm {

/** An mpm_grid_desc that starts with the defaults; the host must set cells and spacing. */
struct grid_desc : mpm_grid_desc {
  /** Starts with the defaults. */
  grid_desc() : mpm_grid_desc() {
    if (const mpm_status status = mpm_grid_desc_init(this, sizeof(mpm_grid_desc)))
      throw error(status, "mpm_grid_desc_init");
  }
};

namespace detail {

/** The grid of C with its context. */
struct grid_core {
  std::shared_ptr<context_core> context; /**< outlives the grid */
  mpm_grid *handle = nullptr;            /**< what mpm_grid_create() gave */
  int32_t dim = 0;                       /**< length of the vectors that calls take */

  explicit grid_core(std::shared_ptr<context_core> made_with) : context(std::move(made_with)) {}
  grid_core(const grid_core &) = delete;
  grid_core &operator=(const grid_core &) = delete;
  ~grid_core() {
    context->leave([held = handle] { return mpm_grid_destroy(held) == MPM_OK; });
  }
};

} // namespace detail

/** A grid: see grid.h. Sets and steppers on it keep it alive. */
class grid : public wrapper<detail::grid_core> {
public:
  /** Makes a grid: see mpm_grid_create(). */
  grid(const context &made_with, const mpm_grid_desc &desc) : wrapper(made_with.shared()) {
    detail::grid_core &c = core();
    c.context->check(mpm_grid_create(c.context->handle, &desc, &c.handle));
    c.dim = desc.dim;
  }

  /** The dimension: 1, 2 or 3. */
  int32_t dim() const {
    return core().dim;
  }
};

} // namespace mpm

#endif
