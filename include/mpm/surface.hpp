/**
 * @file surface.hpp
 * C++17: surfaces. See mpm.hpp.
 */
#ifndef MPM_SURFACE_HPP
#define MPM_SURFACE_HPP

#include <mpm/particles.hpp>
#include <mpm/heat.h>
#include <mpm/surface.h>

namespace mpm {

/** As mpm_traction_fn: takes the batch, and adds forces per area to add[dim][ld]. */
using traction_callback = callback<const mpm_marker_batch &, double *>;

/** As mpm_marker_velocity_fn: takes the batch, and adds velocities to add[dim][ld]. */
using marker_velocity_callback = callback<const mpm_marker_batch &, double *>;

/** mpm_surface_desc with its defaults. */
struct surface_desc : mpm_surface_desc {
  surface_desc() : mpm_surface_desc() {
    if (const mpm_status status = mpm_surface_desc_init(this, sizeof(mpm_surface_desc)))
      throw error(status, "mpm_surface_desc_init");
  }
};

namespace detail {

/** The surface of C with its context, its grid and the host's functions. */
struct surface_core {
  std::shared_ptr<context_core> context; /**< outlives the surface */
  std::shared_ptr<grid_core> grid;       /**< outlives the surface */
  traction_callback traction;            /**< see surface::set_traction() */
  marker_velocity_callback velocity;     /**< see surface::set_velocity() */
  mpm_surface *handle = nullptr;         /**< what mpm_surface_create() gave */

  explicit surface_core(std::shared_ptr<grid_core> on) : context(on->context), grid(std::move(on)) {}
  surface_core(const surface_core &) = delete;
  surface_core &operator=(const surface_core &) = delete;
  ~surface_core() {
    context->leave([held = handle] { return mpm_surface_destroy(held) == MPM_OK; });
  }

  /** The mpm_traction_fn that calls the host's function; user is a surface_core. */
  static mpm_status on_traction(void *user, const mpm_marker_batch *batch, double *add) {
    auto &self = *static_cast<surface_core *>(user);
    return guarded(self.context->exceptions, self.traction, *batch, add);
  }
  /** The mpm_marker_velocity_fn that calls the host's function; user is a surface_core. */
  static mpm_status on_velocity(void *user, const mpm_marker_batch *batch, double *add) {
    auto &self = *static_cast<surface_core *>(user);
    return guarded(self.context->exceptions, self.velocity, *batch, add);
  }
};

} // namespace detail

/** A surface: see surface.h. A stepper to which it was added keeps it alive. */
class surface : public wrapper<detail::surface_core> {
public:
  /** Makes a surface without markers: see mpm_surface_create(). */
  explicit surface(const grid &on, const mpm_surface_desc &desc = surface_desc()) : wrapper(on.shared()) {
    detail::surface_core &c = core();
    check(mpm_surface_create(c.context->handle, c.grid->handle, &desc, &c.handle));
  }

  /** Replaces loads and options: see mpm_surface_configure(). */
  void configure(const mpm_surface_desc &desc) {
    check(mpm_surface_configure(core().handle, &desc));
  }
  /** Sets the function that adds tractions; nullptr takes it away. See mpm_surface_set_traction(). */
  void set_traction(traction_callback tractions) {
    detail::surface_core &c = core();
    check(mpm_surface_set_traction(c.handle, tractions ? c.on_traction : nullptr, &c));
    c.traction = std::move(tractions);
  }
  /** Sets the function that adds to the velocities of a surface that prescribes; nullptr takes it away. See
   * mpm_surface_set_velocity(). */
  void set_velocity(marker_velocity_callback velocities) {
    detail::surface_core &c = core();
    check(mpm_surface_set_velocity(c.handle, velocities ? c.on_velocity : nullptr, &c));
    c.velocity = std::move(velocities);
  }

  /** Heats what lies below: see mpm_surface_set_heat(). */
  void set_heat(double flux, double film = 0.0, double ambient = 0.0) {
    check(mpm_surface_set_heat(core().handle, flux, film, ambient));
  }

  /** Adds markers at position[dim][n] with area vectors, or without: see mpm_surface_add(). Returns the first
   * id. */
  int64_t add(span<const double> position, span<const double> area = {}) {
    const int64_t dim = core().grid->dim, n = static_cast<int64_t>(position.size()) / dim;
    detail::expect_size("position", position.size(), dim * n);
    if (!area.empty()) detail::expect_size("area", area.size(), dim * n);
    int64_t first = 0;
    check(mpm_surface_add(core().handle, n, detail::not_null(position), area.empty() ? nullptr : area.data(),
                          &first));
    return first;
  }
  /** Adds markers along the line through position[2][n]: see mpm_surface_add_polyline(). */
  id_range add_polyline(span<const double> position, bool closed, double spacing) {
    const int64_t n = static_cast<int64_t>(position.size()) / 2;
    detail::expect_size("position", position.size(), 2 * n);
    id_range made{};
    check(mpm_surface_add_polyline(core().handle, n, detail::not_null(position), closed ? 1 : 0, spacing,
                                   &made.first, &made.count));
    return made;
  }
  /** Adds markers on triangles of the corners position[3][n]: see mpm_surface_add_triangles(). */
  id_range add_triangles(span<const double> position, span<const int64_t> corner, double spacing) {
    const int64_t n = static_cast<int64_t>(position.size()) / 3,
                  triangles = static_cast<int64_t>(corner.size()) / 3;
    detail::expect_size("position", position.size(), 3 * n);
    detail::expect_size("corner", corner.size(), 3 * triangles);
    id_range made{};
    check(mpm_surface_add_triangles(core().handle, n, detail::not_null(position), triangles,
                                    detail::not_null(corner), spacing, &made.first, &made.count));
    return made;
  }
  /** Removes markers by id: see mpm_surface_remove(). */
  void remove(span<const int64_t> ids) {
    check(mpm_surface_remove(core().handle, static_cast<int64_t>(ids.size()), detail::not_null(ids)));
  }
  /** Splits markers with edges longer than the spacing, and returns how many came: see
   * mpm_surface_refine(). */
  int64_t refine(double spacing) {
    int64_t added = 0;
    check(mpm_surface_refine(core().handle, spacing, &added));
    return added;
  }
  /** The number of markers: see mpm_surface_count(). */
  int64_t count() const {
    return mpm_surface_count(core().handle);
  }

  /** Copies a field of all markers by ascending id, [components][count()]: see mpm_surface_get(). */
  template <class T = double> std::vector<T> get(const std::string &field) const {
    const int32_t components = components_of(field);
    std::vector<T> values(static_cast<std::size_t>(components * count()));
    T none{};
    check(mpm_surface_get(core().handle, field.c_str(), detail::type_of<T>(), components, count(), nullptr,
                          values.empty() ? &none : values.data()));
    return values;
  }
  /** Copies values, [components][count()] by ascending id, into a field: see mpm_surface_set(). */
  void set(const std::string &field, span<const double> values) {
    const int32_t components = components_of(field);
    detail::expect_size(field.c_str(), values.size(), components * count());
    check(mpm_surface_set(core().handle, field.c_str(), MPM_F64, components, count(), nullptr,
                          detail::not_null(values)));
  }

private:
  void check(mpm_status status) const {
    core().context->check(status);
  }
  int32_t components_of(const std::string &field) const {
    return field == "id" || field == "reference_area" || field == "pressure" ? 1 : core().grid->dim;
  }
};

} // namespace mpm

#endif
