/**
 * @file callback.hpp
 * C++17: functions of the host, and what they throw. See mpm.hpp.
 */
#ifndef MPM_CALLBACK_HPP
#define MPM_CALLBACK_HPP

#include <mpm/types.hpp>

#include <exception>
#include <functional>
#include <mutex>
#include <vector>

namespace mpm {

/** A function of the host. It returns to the library nothing for "go on", or a status: > 0 asks for what the
 * C declaration says (mostly a smaller dt), < 0 stops. An exception stops, too, and comes out of the call
 * that ran the function. A callback is made from any copyable function object; from nullptr it is empty. */
template <class... A> class callback {
public:
  /** Makes an empty callback. */
  callback(std::nullptr_t = nullptr) {}
  /** Takes a function object; function(A...) returns void, mpm_status or one of the MPM_* constants. */
  template <class F, class R = std::invoke_result_t<F &, A...>,
            class = std::enable_if_t<!std::is_same_v<std::decay_t<F>, callback>>>
  callback(F function) {
    static_assert(std::is_void_v<R> || std::is_same_v<R, mpm_status> || std::is_enum_v<R>,
                  "a callback returns void or mpm_status");
    call_ = [function = std::move(function)](A... arguments) mutable -> mpm_status {
      if constexpr (std::is_void_v<R>) {
        function(std::forward<A>(arguments)...);
        return MPM_OK;
      } else {
        return static_cast<mpm_status>(function(std::forward<A>(arguments)...));
      }
    };
  }
  /** Tells whether there is a function. */
  explicit operator bool() const noexcept {
    return static_cast<bool>(call_);
  }
  /** Calls the function, which must be there. */
  mpm_status operator()(A... arguments) const {
    return call_(std::forward<A>(arguments)...);
  }

private:
  std::function<mpm_status(A...)> call_;
};

/** As mpm_write_fn: takes the next bytes of an output. */
using write_callback = callback<span<const unsigned char>>;

namespace detail {

/** Exceptions that callbacks threw during a call, on any thread. Each has a number, which the library carries
 * as the status of the callback. So the exception that comes out does not depend on threads. */
class thrown {
public:
  /** Keeps the exception of the catch block it is called in, and gives the status that stands for it. */
  mpm_status keep() noexcept {
    try {
      const std::lock_guard<std::mutex> hold(mutex_);
      kept_.push_back(std::current_exception());
      return first - static_cast<mpm_status>(kept_.size() - 1);
    } catch (...) {
      return MPM_E_NOMEM;
    }
  }
  /** Forgets all exceptions and gives the one for which status stands, else the first, else none. */
  std::exception_ptr take(mpm_status status) noexcept {
    const std::lock_guard<std::mutex> hold(mutex_);
    if (kept_.empty()) return nullptr;
    const auto number = static_cast<std::size_t>(status <= first ? int64_t{first} - status : 0);
    const std::exception_ptr wanted = kept_[number < kept_.size() ? number : 0];
    kept_.clear();
    return wanted;
  }

private:
  static constexpr mpm_status first = -1000000000;
  std::mutex mutex_;
  std::vector<std::exception_ptr> kept_;
};

/** Calls a callback of the host for C frames, through which nothing may be thrown. */
template <class F, class... A>
mpm_status guarded(thrown &kept, const F &function, A &&...arguments) noexcept {
  try {
    return function(std::forward<A>(arguments)...);
  } catch (...) {
    return kept.keep();
  }
}

/** A function that takes an output, where C finds it during the call. */
struct byte_taker {
  const write_callback &function; /**< of the host */
  thrown &exceptions;             /**< those of the context */

  /** Is an mpm_write_fn. */
  static mpm_status write(void *user, const void *data, int64_t bytes) {
    const byte_taker &to = *static_cast<const byte_taker *>(user);
    return guarded(to.exceptions, [&] {
      return to.function({static_cast<const unsigned char *>(data), static_cast<std::size_t>(bytes)});
    });
  }
};

} // namespace detail

} // namespace mpm

#endif
