/**
 * @file particles.hpp
 * C++17: sets of particles. See mpm.hpp.
 */
#ifndef MPM_PARTICLES_HPP
#define MPM_PARTICLES_HPP

#include <mpm/grid.hpp>
#include <mpm/io.h>
#include <mpm/material.hpp>
#include <mpm/particles.h>
#include <mpm/view.hpp>

#include <algorithm>

namespace mpm {

/** The ids of particles that a call has made: first to first + count - 1. */
struct id_range {
  int64_t first; /**< smallest id */
  int64_t count; /**< number of ids; may be 0 */
};

/** What particles::add() takes: arrays as mpm_particles_add() wants them, empty where those may be NULL. */
struct new_particles {
  span<const double> position; /**< [dim][n], length */
  span<const double> velocity; /**< [dim][n], length/time; empty: zeros */
  span<const double> volume;   /**< [n] initial volumes */
  span<const double> size;     /**< [dim][n] edges of the domains; empty: cubes */
  span<const int64_t> ids;     /**< [n]; empty: ids number on from the largest */
};

/** What mpm_particles_field_info() tells of a field of a set. */
struct field_info {
  std::string name;   /**< name, as calls want it */
  int32_t type;       /**< MPM_F64, MPM_I64 or MPM_U8 */
  int32_t components; /**< components of copies */
  bool writable;      /**< whether the host may write it */
};

namespace detail {

/** The set of C with its grid and material. */
struct particles_core {
  std::shared_ptr<context_core> context;   /**< outlives the set */
  std::shared_ptr<grid_core> grid;         /**< outlives the set */
  std::shared_ptr<material_core> material; /**< outlives the set */
  mpm_particles *handle = nullptr;         /**< what mpm_particles_create() gave */

  particles_core(std::shared_ptr<grid_core> on, std::shared_ptr<material_core> of)
      : context(on->context), grid(std::move(on)), material(std::move(of)) {}
  particles_core(const particles_core &) = delete;
  particles_core &operator=(const particles_core &) = delete;
  ~particles_core() {
    context->leave([held = handle] { return mpm_particles_destroy(held) == MPM_OK; });
  }
};

/** The type of the elements of a container. */
template <class C>
using element = std::remove_cv_t<std::remove_pointer_t<decltype(std::data(std::declval<C &>()))>>;

/** The names of fields as C wants them. They live as long as `names` does. */
inline std::vector<const char *> c_names(const std::vector<std::string> &names) {
  std::vector<const char *> pointers;
  for (const std::string &name : names) pointers.push_back(name.c_str());
  return pointers;
}

} // namespace detail

/** A set of particles: see particles.h. A stepper to which it was added keeps it alive. */
class particles : public wrapper<detail::particles_core> {
public:
  /** Makes an empty set: see mpm_particles_create(). */
  particles(const grid &on, const material &of) : wrapper(on.shared(), of.shared()) {
    detail::particles_core &c = core();
    check(mpm_particles_create(c.context->handle, c.grid->handle, c.material->handle, &c.handle));
  }

  /** Adds particles and gives the first of their ids: see mpm_particles_add(). */
  int64_t add(const new_particles &p) {
    const auto n = static_cast<int64_t>(p.volume.size()), coordinates = n * core().grid->dim;
    detail::expect_size("position", p.position.size(), coordinates);
    if (!p.velocity.empty()) detail::expect_size("velocity", p.velocity.size(), coordinates);
    if (!p.size.empty()) detail::expect_size("size", p.size.size(), coordinates);
    if (!p.ids.empty()) detail::expect_size("ids", p.ids.size(), n);
    int64_t first = 0;
    check(mpm_particles_add(core().handle, n, detail::not_null(p.position), p.velocity.data(),
                            detail::not_null(p.volume), p.size.data(), p.ids.data(), &first));
    return first;
  }
  /** Fills a box: see mpm_particles_fill_box(). All arrays are [dim]. */
  id_range fill_box(span<const double> lower, span<const double> upper, span<const int32_t> per_cell) {
    expect_axes("lower", lower.size()), expect_axes("upper", upper.size()),
        expect_axes("per_cell", per_cell.size());
    id_range made{};
    check(mpm_particles_fill_box(core().handle, lower.data(), upper.data(), per_cell.data(), &made.first,
                                 &made.count));
    return made;
  }
  /** Fills a ball: see mpm_particles_fill_ball(). All arrays are [dim]. */
  id_range fill_ball(span<const double> centre, double radius, span<const int32_t> per_cell) {
    expect_axes("centre", centre.size()), expect_axes("per_cell", per_cell.size());
    id_range made{};
    check(mpm_particles_fill_ball(core().handle, centre.data(), radius, per_cell.data(), &made.first,
                                  &made.count));
    return made;
  }
  /** Fills a body: see mpm_particles_fill(). The function is asked about one point x[dim] at a time: bool
   * inside(const double *x). What it throws comes out of this call, and nothing is added. */
  template <class F>
  id_range fill(span<const double> lower, span<const double> upper, span<const int32_t> per_cell, F inside) {
    expect_axes("lower", lower.size()), expect_axes("upper", upper.size()),
        expect_axes("per_cell", per_cell.size());
    struct job {
      F &inside;
      detail::thrown &exceptions;
    } each{inside, core().context->exceptions};
    const mpm_inside_fn points = [](void *user, int32_t dim, int64_t n, int64_t ld, const double *position,
                                    uint8_t *accepted) -> mpm_status {
      return detail::guarded(static_cast<job *>(user)->exceptions, [&] {
        double x[3] = {0.0, 0.0, 0.0};
        for (int64_t i = 0; i < n; ++i) {
          for (int32_t c = 0; c < dim; ++c) x[c] = position[c * ld + i];
          accepted[i] = static_cast<job *>(user)->inside(static_cast<const double *>(x)) ? 1 : 0;
        }
        return MPM_OK;
      });
    };
    id_range made{};
    check(mpm_particles_fill(core().handle, lower.data(), upper.data(), per_cell.data(), points, &each,
                             &made.first, &made.count));
    return made;
  }
  /** Fills what a mesh encloses: see mpm_particles_fill_mesh(). position is [dim][n], corner is
   * [elements][dim]. */
  id_range fill_mesh(span<const double> position, span<const int64_t> corner, span<const int32_t> per_cell) {
    const auto dim = static_cast<size_t>(core().grid->dim);
    expect_axes("per_cell", per_cell.size());
    const auto n = static_cast<int64_t>(position.size() / dim),
               elements = static_cast<int64_t>(corner.size() / dim);
    detail::expect_size("position", position.size(), n * core().grid->dim);
    detail::expect_size("corner", corner.size(), elements * core().grid->dim);
    id_range made{};
    check(mpm_particles_fill_mesh(core().handle, n, detail::not_null(position), elements,
                                  detail::not_null(corner), per_cell.data(), &made.first, &made.count));
    return made;
  }
  /** Removes particles by id: see mpm_particles_remove(). */
  void remove(span<const int64_t> ids) {
    check(mpm_particles_remove(core().handle, static_cast<int64_t>(ids.size()), detail::not_null(ids)));
  }
  /** The number of particles: see mpm_particles_count(). */
  int64_t count() const {
    return mpm_particles_count(core().handle);
  }
  /** The number on all parts of the problem: see mpm_particles_total(). */
  int64_t total() const {
    int64_t n = 0;
    check(mpm_particles_total(core().handle, &n));
    return n;
  }

  /** All particles by ascending id as bytes, for another set: see mpm_particles_pack(). */
  std::vector<unsigned char> pack() const {
    return packed(count(), nullptr);
  }
  /** The particles with the given ids, in this order. */
  std::vector<unsigned char> pack(span<const int64_t> ids) const {
    return packed(static_cast<int64_t>(ids.size()), detail::not_null(ids));
  }
  /** Adds particles that pack() has given, of this set or of another: see mpm_particles_unpack(). */
  void unpack(span<const unsigned char> bytes) {
    check(mpm_particles_unpack(core().handle, detail::not_null(bytes), static_cast<int64_t>(bytes.size())));
  }

  /** Describes all fields: see mpm_particles_field_info(). */
  std::vector<field_info> fields() const {
    std::vector<field_info> all;
    for (int32_t i = 0;; ++i) {
      const char *name = "";
      int32_t writable = 0;
      field_info field{};
      if (mpm_particles_field_info(core().handle, i, &name, &field.type, &field.components, &writable)) break;
      field.name = name;
      field.writable = writable != 0;
      all.push_back(field);
    }
    return all;
  }
  /** Adds a field of the host: see mpm_particles_add_field(). */
  template <class T> void add_field(const std::string &field, int32_t components = 1) {
    check(mpm_particles_add_field(core().handle, field.c_str(), detail::type_of<T>(), components));
  }

  /** Says that values of a field of the host are amounts: see mpm_particles_set_extensive(). */
  void set_extensive(const std::string &field, bool extensive = true) {
    check(mpm_particles_set_extensive(core().handle, field.c_str(), extensive));
  }

  /** Copies a field of all particles by ascending id, [components][count()]: see mpm_particles_get(). */
  template <class T = double> std::vector<T> get(const std::string &field) const {
    return copy<T>(field, count(), nullptr);
  }
  /** Copies a field of the particles with the given ids. */
  template <class T = double> std::vector<T> get(const std::string &field, span<const int64_t> ids) const {
    return copy<T>(field, static_cast<int64_t>(ids.size()), detail::not_null(ids));
  }
  /** Copies fields of all particles, one particle after the other, as floats: see mpm_particles_get_f32(). */
  std::vector<float> get_f32(const std::vector<std::string> &names, int32_t order = MPM_BY_ID) const {
    std::vector<float> values(static_cast<std::size_t>(std::max(floats_of(names), int64_t{0})));
    copy_f32(names, order, values);
    return values;
  }
  /** Copies them into a buffer of the host, which has the size of what the other overload gives. */
  void get_f32(const std::vector<std::string> &names, span<float> out, int32_t order = MPM_BY_ID) const {
    if (const int64_t floats = floats_of(names); floats >= 0) detail::expect_size("out", out.size(), floats);
    copy_f32(names, order, out);
  }
  /** Copies values, [components][count()] by ascending id, into a field: see mpm_particles_set(). */
  template <class C> void set(const std::string &field, const C &values) {
    write<detail::element<const C>>(field, count(), nullptr, values);
  }
  /** Copies values into a field of the particles with the given ids. */
  template <class C> void set(const std::string &field, span<const int64_t> ids, const C &values) {
    write<detail::element<const C>>(field, static_cast<int64_t>(ids.size()), detail::not_null(ids), values);
  }
  /** Copies values from a list in braces. */
  template <class T>
  void set(const std::string &field, span<const int64_t> ids, std::initializer_list<T> values) {
    set<std::initializer_list<T>>(field, ids, values);
  }
  /** Sets one value, [components], in every particle: see mpm_particles_set_all(). */
  template <class C> void set_all(const std::string &field, const C &value) {
    const span<const detail::element<const C>> all(value);
    check(mpm_particles_set_all(core().handle, field.c_str(), detail::type_of<detail::element<const C>>(),
                                static_cast<int32_t>(all.size()), detail::not_null(all)));
  }
  /** Sets one value from a list in braces, such as {1.0, 0.0}. */
  template <class T> void set_all(const std::string &field, std::initializer_list<T> value) {
    set_all<std::initializer_list<T>>(field, value);
  }
  /** Gives all particles the stress of ground at rest: see mpm_particles_set_geostatic(). */
  void set_geostatic(int32_t axis, double gravity, double surface, double K0, double surcharge = 0.0) {
    check(mpm_particles_set_geostatic(core().handle, axis, gravity, surface, K0, surcharge));
  }
  /** Lets deformation and displacements count from here: see mpm_particles_reset_reference(). */
  void reset_reference() {
    check(mpm_particles_reset_reference(core().handle));
  }
  /** Lends a field in library order: see mpm_particles_map(). map<const double>() is for reading,
   * map<double>() for reading and writing. */
  template <class T> view<T> map(const std::string &field) {
    return view<T>(shared(), field, [&](int32_t access, mpm_view *out) {
      return mpm_particles_map(core().handle, field.c_str(), access, out);
    });
  }

  /** Writes a .vtp file with the named fields, or with all: see mpm_write_particles(). */
  void write_file(const std::string &path, const std::vector<std::string> &names = {}) const {
    check(mpm_write_particles(core().handle, path.c_str(), static_cast<int32_t>(names.size()),
                              detail::c_names(names).data()));
  }
  /** Gives the bytes of that file to a function: see mpm_write_particles_to(). */
  void write_to(const write_callback &write, const std::vector<std::string> &names = {}) const {
    detail::byte_taker taker{write, core().context->exceptions};
    check(mpm_write_particles_to(core().handle, write ? detail::byte_taker::write : nullptr, &taker,
                                 static_cast<int32_t>(names.size()), detail::c_names(names).data()));
  }

private:
  void check(mpm_status status) const {
    core().context->check(status);
  }
  void expect_axes(const char *what, std::size_t size) const {
    detail::expect_size(what, size, core().grid->dim);
  }
  /* What is given for an unknown field, which the library then names. */
  int32_t components_of(const std::string &field, int32_t unknown = 0) const {
    const char *name = "";
    int32_t components = 0;
    for (int32_t i = 0; !mpm_particles_field_info(core().handle, i, &name, nullptr, &components, nullptr);
         ++i)
      if (field == name) return components;
    return unknown;
  }
  /* -1 if one of the fields is unknown */
  int64_t floats_of(const std::vector<std::string> &names) const {
    int64_t floats = 0;
    for (const std::string &name : names) {
      const int32_t components = components_of(name, -1);
      if (components < 0) return -1;
      floats += components * count();
    }
    return floats;
  }
  void copy_f32(const std::vector<std::string> &names, int32_t order, span<float> out) const {
    float none{};
    check(mpm_particles_get_f32(core().handle, static_cast<int32_t>(names.size()),
                                detail::c_names(names).data(), order, count(),
                                out.empty() ? &none : out.data()));
  }
  std::vector<unsigned char> packed(int64_t n, const int64_t *ids) const {
    int64_t bytes = 0;
    check(mpm_particles_packed_size(core().handle, n, &bytes));
    std::vector<unsigned char> buffer(static_cast<std::size_t>(bytes));
    check(mpm_particles_pack(core().handle, n, ids, buffer.data(), bytes));
    return buffer;
  }
  template <class T> std::vector<T> copy(const std::string &field, int64_t n, const int64_t *ids) const {
    const int32_t components = components_of(field);
    std::vector<T> values(static_cast<std::size_t>(components) * static_cast<std::size_t>(n));
    T none{};
    check(mpm_particles_get(core().handle, field.c_str(), detail::type_of<T>(), components, n, ids,
                            values.empty() ? &none : values.data()));
    return values;
  }
  template <class T>
  void write(const std::string &field, int64_t n, const int64_t *ids, span<const T> values) {
    const int32_t components = components_of(field);
    if (components) detail::expect_size(field.c_str(), values.size(), components * n);
    check(mpm_particles_set(core().handle, field.c_str(), detail::type_of<T>(), components, n, ids,
                            detail::not_null(values)));
  }
};

} // namespace mpm

#endif
