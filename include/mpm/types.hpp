/**
 * @file types.hpp
 * C++17: errors, outcomes, and spans of elements. See mpm.hpp.
 */
#ifndef MPM_TYPES_HPP
#define MPM_TYPES_HPP

#include <mpm/types.h>

#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

/** The C++ interface. What its comments do not say stands at the C declaration that is wrapped. */
namespace mpm {

/** The exception for a call that the library refused or could not do. what() starts with the name of the
 * status. */
class error : public std::runtime_error {
public:
  /** Takes a status MPM_* and a message, which is a sentence as from mpm_last_error(). */
  error(mpm_status status, const std::string &message)
      : std::runtime_error(message.empty() ? mpm_status_name(status)
                                           : mpm_status_name(status) + (": " + message)),
        status_(status) {}

  /** The status of the call, such as MPM_E_ARG. */
  mpm_status status() const noexcept {
    return status_;
  }

private:
  mpm_status status_;
};

/**
 * How a step ended: it was done, or it was not and the state is as it was (MPM_CUT_DT to MPM_CANCELLED).
 * These are events that a time loop deals with, so they are returned; faults (status < 0) are thrown as
 * error.
 */
class [[nodiscard]] outcome {
public:
  /** The outcome of a step that was done. */
  outcome() = default;
  /** Takes a status >= 0 and a message that says why the step was not done. */
  outcome(mpm_status status, std::string message) : status_(status), message_(std::move(message)) {}

  /** Tells whether the step was done. */
  explicit operator bool() const noexcept {
    return status_ == MPM_OK;
  }
  /** The status: MPM_OK, or why the step was not done. */
  mpm_status status() const noexcept {
    return status_;
  }
  /** Tells whether a smaller dt may cure it: MPM_CUT_DT to MPM_SINGULAR. */
  bool retryable() const noexcept {
    return status_ >= MPM_CUT_DT && status_ <= MPM_SINGULAR;
  }
  /** The sentence that says why the step was not done; empty if it was. */
  const std::string &message() const noexcept {
    return message_;
  }
  /** Throws error unless the step was done: for hosts that have no other answer to it. */
  void or_throw() const {
    if (status_ != MPM_OK) throw error(status_, message_);
  }

private:
  mpm_status status_ = MPM_OK;
  std::string message_;
};

/** A span of elements that belong to someone else. It is made from arrays, vectors and other containers, and
 * for arguments from lists in braces. */
template <class T> class span {
  template <class C>
  using fits = std::enable_if_t<
      std::is_convertible_v<std::remove_pointer_t<decltype(std::data(std::declval<C &>()))> (*)[], T (*)[]>>;

public:
  /** Makes a span without elements. */
  span() = default;
  /** Makes a span of size elements from data on. */
  span(T *data, std::size_t size) : data_(data), size_(size) {}
  /** Makes a span of the elements of an array or a container. */
  template <class C, class = fits<C>>
  span(C &&container) : span(std::data(container), std::size(container)) {}
  /** Makes a span of the elements of a list, which live as long as the call of which they are an argument. */
  template <class U = T, class = std::enable_if_t<std::is_const_v<U>>>
  span(std::initializer_list<std::remove_const_t<U>> list) : span(list.begin(), list.size()) {}

  /** The address of the first element; may be null if there are none. */
  T *data() const noexcept {
    return data_;
  }
  /** The number of elements. */
  std::size_t size() const noexcept {
    return size_;
  }
  /** Tells whether there are no elements. */
  bool empty() const noexcept {
    return size_ == 0;
  }
  /** Element i. The index is not checked. */
  T &operator[](std::size_t i) const noexcept {
    return data_[i];
  }
  /** The iterator to the first element. */
  T *begin() const noexcept {
    return data_;
  }
  /** The iterator past the last element. */
  T *end() const noexcept {
    return data_ + size_;
  }

private:
  T *data_ = nullptr;
  std::size_t size_ = 0;
};

/** The parts of the wrapper that hosts do not name. */
namespace detail {

/** Gives MPM_F64, MPM_I64 or MPM_U8 for the type of a field's elements. */
template <class T> constexpr int32_t type_of() {
  using value = std::remove_cv_t<T>;
  static_assert(std::is_same_v<value, double> || std::is_same_v<value, int64_t> ||
                    std::is_same_v<value, uint8_t>,
                "fields hold double, int64_t or uint8_t");
  return std::is_same_v<value, double> ? MPM_F64 : std::is_same_v<value, int64_t> ? MPM_I64 : MPM_U8;
}

/** Throws error (MPM_E_ARG) unless an array has the number of elements that the library will read. */
inline void expect_size(const char *what, std::size_t size, int64_t expected) {
  if (size != static_cast<std::size_t>(expected))
    throw error(MPM_E_ARG,
                what + (" has " + std::to_string(size)) + " values, must have " + std::to_string(expected));
}

/** Gives a pointer that is not null even if there are no elements, because NULL means "not given" to the
 * library. */
template <class T> const T *not_null(span<const T> elements) {
  static const T none{};
  return elements.data() ? elements.data() : &none;
}

} // namespace detail

} // namespace mpm

#endif
