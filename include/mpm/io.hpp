/**
 * @file io.hpp
 * C++17: time series of output files. Files of sets and nodes, and saved states, are members of particles and
 * stepper. See mpm.hpp.
 */
#ifndef MPM_IO_HPP
#define MPM_IO_HPP

#include <mpm/context.hpp>
#include <mpm/io.h>

namespace mpm {

namespace detail {

/** The series of C with its context. */
struct series_core {
  std::shared_ptr<context_core> context; /**< outlives the series */
  mpm_series *handle = nullptr;          /**< what mpm_series_open() gave */

  explicit series_core(std::shared_ptr<context_core> made_with) : context(std::move(made_with)) {}
  series_core(const series_core &) = delete;
  series_core &operator=(const series_core &) = delete;
  ~series_core() {
    mpm_series_close(handle);
  }
};

} // namespace detail

/** A series of output files in a .pvd file, which is valid on disk after every append. Destruction ends the
 * series. */
class series : public wrapper<detail::series_core> {
public:
  /** Starts a series: see mpm_series_open(). */
  series(const context &made_with, const std::string &path) : wrapper(made_with.shared()) {
    detail::series_core &c = core();
    c.context->check(mpm_series_open(c.context->handle, path.c_str(), &c.handle));
  }
  /** Appends a file at a time: see mpm_series_append(). */
  void append(double t, const std::string &file) {
    core().context->check(mpm_series_append(core().handle, t, file.c_str()));
  }
};

} // namespace mpm

#endif
