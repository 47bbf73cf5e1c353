/**
 * @file view.hpp
 * C++17: views of the library's memory, which is lent to the host. See mpm.hpp.
 */
#ifndef MPM_VIEW_HPP
#define MPM_VIEW_HPP

#include <mpm/handle.hpp>

namespace mpm {

/**
 * A view of the library's memory, which is lent until release() or destruction: see mpm_view.
 * view<const double> is for reading, view<double> for reading and writing. It keeps alive what it looks into.
 */
template <class T> class view {
public:
  /** Takes the memory over. */
  view(view &&other) noexcept
      : keep_(std::move(other.keep_)), context_(std::move(other.context_)), view_(other.view_) {
    other.view_ = {};
  }
  /** Gives back what it held before. */
  view &operator=(view &&other) noexcept {
    view taken(std::move(other));
    std::swap(keep_, taken.keep_);
    std::swap(context_, taken.context_);
    std::swap(view_, taken.view_);
    return *this;
  }
  /** Gives the memory back; in a callback, when the call is over. Bad values that were written do not throw
   * here: they bar the set from steps, which say so. */
  ~view() {
    if (!view_.owner) return;
    context_->leave([keep = keep_, held = view_]() mutable {
      mpm_view_release(&held);
      return !held.owner;
    });
  }
  /** Gives the memory back; throws error: MPM_E_ARG if bad values were written, MPM_E_STATE in a callback,
   * where the view stays lent. */
  void release() {
    if (!view_.owner) throw error(MPM_E_STATE, "the view was released or moved from");
    const mpm_status status = mpm_view_release(&view_);
    if (view_.owner) context_->check(status); // still lent
    const auto context = std::move(context_);
    const auto keep = std::move(keep_);
    context->check(status);
  }
  /** A component of an item. The indices are not checked. */
  T &operator()(int64_t item, int32_t component = 0) const noexcept {
    return static_cast<T *>(view_.data)[item * view_.item_stride + component * view_.component_stride];
  }
  /** The number of items, inert slots included. */
  int64_t size() const noexcept {
    return view_.count;
  }
  /** The number of stored components of an item. */
  int32_t components() const noexcept {
    return view_.components;
  }
  /** The C struct with pointer and strides. */
  const mpm_view &raw() const noexcept {
    return view_;
  }

  /** Maps by map(view) and keeps the core of what is mapped: for particles::map() and stepper::map(). */
  template <class Core, class Map>
  view(std::shared_ptr<Core> core, const std::string &field, Map map) : keep_(core), context_(core->context) {
    const int32_t type = detail::type_of<T>();
    view_.struct_size = sizeof view_;
    context_->check(map(std::is_const_v<T> ? MPM_READ : MPM_READ | MPM_WRITE, &view_));
    if (view_.type == type) return;
    mpm_view_release(&view_);
    static const char *const names[] = {"", "double", "int64_t", "uint8_t"};
    throw error(MPM_E_ARG, "\"" + field + "\" holds " + names[view_.type] + ", not " + names[type]);
  }

private:
  std::shared_ptr<const void> keep_;
  std::shared_ptr<detail::context_core> context_;
  mpm_view view_ = {};
};

} // namespace mpm

#endif
