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

/** The C++ interface. What it does not say stands at the C declaration that it wraps. */
namespace mpm {

/** A call that the library refused or could not do. what() starts with the name of the status. */
class error : public std::runtime_error {
public:
  /** status: the MPM_* value; message: a sentence, as from mpm_last_error(). */
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
 * How a step ended: done, or not done with the state as it was (MPM_CUT_DT ... MPM_CANCELLED). These are
 * events that a time loop deals with, so they are returned; faults (status < 0) are thrown as error.
 */
class [[nodiscard]] outcome {
public:
  /** Done. */
  outcome() = default;
  /** status: >= 0; message: why it was not done. */
  outcome(mpm_status status, std::string message) : status_(status), message_(std::move(message)) {}

  /** True if the step was done. */
  explicit operator bool() const noexcept {
    return status_ == MPM_OK;
  }
  /** MPM_OK, or why it was not done. */
  mpm_status status() const noexcept {
    return status_;
  }
  /** True if a smaller dt may cure it: MPM_CUT_DT ... MPM_SINGULAR. */
  bool retryable() const noexcept {
    return status_ >= MPM_CUT_DT && status_ <= MPM_SINGULAR;
  }
  /** Why it was not done; empty if it was. */
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

/** Elements that belong to someone else; made from arrays, vectors and other containers, and, for arguments,
 * from lists in braces. */
template <class T> class span {
  template <class C>
  using fits = std::enable_if_t<
      std::is_convertible_v<std::remove_pointer_t<decltype(std::data(std::declval<C &>()))> (*)[], T (*)[]>>;

public:
  /** No elements. */
  span() = default;
  /** size elements from data. */
  span(T *data, std::size_t size) : data_(data), size_(size) {}
  /** The elements of an array or a container. */
  template <class C, class = fits<C>>
  span(C &&container) : span(std::data(container), std::size(container)) {}
  /** The elements of a list, which live as long as the call that they are an argument of. */
  template <class U = T, class = std::enable_if_t<std::is_const_v<U>>>
  span(std::initializer_list<std::remove_const_t<U>> list) : span(list.begin(), list.size()) {}

  /** The first element; may be null if there are none. */
  T *data() const noexcept {
    return data_;
  }
  /** How many elements. */
  std::size_t size() const noexcept {
    return size_;
  }
  /** True if there are none. */
  bool empty() const noexcept {
    return size_ == 0;
  }
  /** Element i, not checked. */
  T &operator[](std::size_t i) const noexcept {
    return data_[i];
  }
  /** The first element. */
  T *begin() const noexcept {
    return data_;
  }
  /** Past the last element. */
  T *end() const noexcept {
    return data_ + size_;
  }

private:
  T *data_ = nullptr;
  std::size_t size_ = 0;
};

/** Parts of the wrapper that hosts do not name. */
namespace detail {

/** MPM_F64, MPM_I64 or MPM_U8 for the type of a field's elements. */
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

/** A pointer that is not null even if there are no elements: to the library NULL means "not given". */
template <class T> const T *not_null(span<const T> elements) {
  static const T none{};
  return elements.data() ? elements.data() : &none;
}

} // namespace detail

} // namespace mpm

#endif
