/**
 * @file handle.hpp
 * C++17: what the wrappers of all handles share. See mpm.hpp.
 */
#ifndef MPM_HANDLE_HPP
#define MPM_HANDLE_HPP

#include <mpm/callback.hpp>
#include <mpm/context.h>

#include <memory>

namespace mpm {

namespace detail {

/** A handle of the C interface with all that must live as long: the cores of what it was made with, and
 * callbacks. Wrappers, views and the cores of other objects share it. */
struct context_core {
  mpm_context *handle = nullptr;                         /**< what mpm_context_create() gave */
  thrown exceptions;                                     /**< what callbacks threw in the call under way */
  std::function<void(int32_t, const char *)> log;        /**< see context_desc */
  std::function<void *(std::size_t, std::size_t)> alloc; /**< see context_desc */
  std::function<void(void *, std::size_t, std::size_t)> release;        /**< see context_desc */
  callback<int64_t, const std::function<void(int64_t)> &> parallel_for; /**< see context_desc */

  context_core() = default;
  context_core(const context_core &) = delete;
  context_core &operator=(const context_core &) = delete;
  ~context_core() {
    settle();
    mpm_context_destroy(handle);
  }

  /** Gives an object or a view up by a function that tells whether that is done. In a callback the library
   * refuses it; then it is tried again after the call. */
  void leave(std::function<bool()> give_up) noexcept {
    if (give_up()) return;
    try {
      late_.push_back(std::move(give_up));
    } catch (const std::exception &) { // there is no memory to remember it: it is leaked
    }
  }
  /** Gives the outcome of a call; throws error, or what a callback threw, if status < 0. */
  outcome result(mpm_status status) {
    const at_end settling{*this}; // when the text of the error has been read
    const std::exception_ptr exception = exceptions.take(MPM_OK);
    if (status == MPM_OK) return {};
    if (status == MPM_E_CALLBACK && exception) std::rethrow_exception(exception);
    if (status > MPM_OK) return {status, mpm_last_error(handle)};
    throw error(status, mpm_last_error(handle));
  }
  /** Throws unless status is MPM_OK. */
  void check(mpm_status status) {
    result(status).or_throw();
  }

private:
  struct at_end {
    context_core &context;
    ~at_end() {
      context.settle();
    }
  };

  /** Tries what waits until nothing more is done: objects may need each other. */
  void settle() noexcept {
    for (std::size_t before = late_.size() + 1; late_.size() < before && !late_.empty();) {
      std::vector<std::function<bool()>> tried; // what is given up may leave more
      tried.swap(late_);
      before = tried.size();
      for (auto &one : tried) leave(std::move(one));
    }
  }

  std::vector<std::function<bool()>> late_; // what the library has refused to take back
};

} // namespace detail

/** The base of all wrappers of handles: they move, and share a core with what was made from them. */
template <class Core> class wrapper {
public:
  /** Tells whether it holds a handle: false once it was moved from. */
  explicit operator bool() const noexcept {
    return static_cast<bool>(core_);
  }
  /** The handle, for calls of the C interface. It stays the wrapper's. NULL once it was moved from. */
  auto handle() const noexcept {
    return core_ ? core_->handle : nullptr;
  }
  /** The core, for other wrappers. Throws error (MPM_E_ARG) if it was moved from. */
  const std::shared_ptr<Core> &shared() const {
    if (!core_) throw error(MPM_E_ARG, "the object was moved from");
    return core_;
  }

protected:
  /** Makes a core of its own. */
  template <class... A>
  explicit wrapper(A &&...arguments) : core_(std::make_shared<Core>(std::forward<A>(arguments)...)) {}
  /** Takes the core over. */
  wrapper(wrapper &&) noexcept = default;
  /** Lets go of its core and takes the other over. */
  wrapper &operator=(wrapper &&) noexcept = default;
  ~wrapper() = default;
  /** The core. */
  Core &core() const {
    return *shared();
  }

private:
  std::shared_ptr<Core> core_;
};

} // namespace mpm

#endif
