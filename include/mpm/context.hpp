/**
 * @file context.hpp
 * C++17: the context and the services of the host. See mpm.hpp.
 */
#ifndef MPM_CONTEXT_HPP
#define MPM_CONTEXT_HPP

#include <mpm/handle.hpp>

namespace mpm {

/** Services of the host: the fields of mpm_context_desc with their defaults, and function objects in place of
 * its pointers. A function that is set replaces the pointers. */
struct context_desc : mpm_context_desc {
  /** Takes a level MPM_LOG_* and a text, as log does. What it throws is dropped. */
  std::function<void(int32_t level, const char *text)> on_log;
  /** Takes bytes and alignment, as alloc does, and is set together with on_release. An exception counts as a
   * nullptr: MPM_E_NOMEM. */
  std::function<void *(std::size_t bytes, std::size_t alignment)> on_alloc;
  /** Takes memory, bytes and alignment, as release does. What it throws is dropped. */
  std::function<void(void *memory, std::size_t bytes, std::size_t alignment)> on_release;
  /** Takes count and task, and calls task(k), which does not throw, once for each k in [0, count). */
  callback<int64_t, const std::function<void(int64_t)> &> on_parallel_for;

  /** Starts with the defaults. */
  context_desc() : mpm_context_desc() {
    if (const mpm_status status = mpm_context_desc_init(this, sizeof(mpm_context_desc)))
      throw error(status, "mpm_context_desc_init");
  }
};

/** What mpm_context_memory() tells. */
struct memory_use {
  int64_t bytes;      /**< bytes that are held now */
  int64_t peak_bytes; /**< most bytes that were ever held */
};

/**
 * A context. The C object lives until the wrapper and everything made with it are gone, in whatever order:
 * grids, materials, sets, obstacles, steppers, series and views keep it.
 */
class context : public wrapper<detail::context_core> {
public:
  /** Makes a context: see mpm_context_create(). error::what() has the sentence that says why there is none;
   * it goes to error_text of the descriptor as well, where that is set. */
  explicit context(context_desc desc = {}) {
    detail::context_core &c = core();
    char text[1024] = "";
    const bool own = !desc.error_text && !desc.error_bytes;
    if (own) desc.error_text = text, desc.error_bytes = sizeof text;
    bind(desc, c);
    mpm_status status = mpm_context_create(&desc, &c.handle);
    if (own && status == MPM_E_UNSUPPORTED && !*text) { // a library of before there was error_text
      desc.error_text = nullptr, desc.error_bytes = 0;
      status = mpm_context_create(&desc, &c.handle);
    }
    if (status)
      throw error(status, desc.error_text && *desc.error_text ? desc.error_text : "mpm_context_create");
  }

  /** Tells how much memory is held: see mpm_context_memory(). */
  memory_use memory() const {
    memory_use use{};
    core().check(mpm_context_memory(core().handle, &use.bytes, &use.peak_bytes));
    return use;
  }

  /** Makes text the sentence of a failure with status < 0, and throws it: see mpm_set_last_error(). */
  [[noreturn]] void refuse(mpm_status status, const std::string &text) const {
    const mpm_status refused = mpm_set_last_error(core().handle, status, text.c_str());
    throw error(refused, mpm_last_error(core().handle));
  }

private:
  static void bind(context_desc &desc, detail::context_core &c) {
    c.log = std::move(desc.on_log);
    c.alloc = std::move(desc.on_alloc);
    c.release = std::move(desc.on_release);
    c.parallel_for = std::move(desc.on_parallel_for);
    if (c.log) desc.log = log, desc.log_user = &c;
    if (c.alloc || c.release) desc.alloc_user = &c;
    if (c.alloc) desc.alloc = alloc;
    if (c.release) desc.release = release;
    if (c.parallel_for) desc.parallel_for = parallel_for, desc.parallel_user = &c;
  }
  static void log(void *user, int32_t level, const char *text) {
    try {
      static_cast<detail::context_core *>(user)->log(level, text);
    } catch (...) {}
  }
  static void *alloc(void *user, std::size_t bytes, std::size_t alignment) {
    try {
      return static_cast<detail::context_core *>(user)->alloc(bytes, alignment);
    } catch (...) {
      return nullptr;
    }
  }
  static void release(void *user, void *memory, std::size_t bytes, std::size_t alignment) {
    try {
      static_cast<detail::context_core *>(user)->release(memory, bytes, alignment);
    } catch (...) {}
  }
  static mpm_status parallel_for(void *user, int64_t count, mpm_task_fn task, void *task_data) {
    auto &c = *static_cast<detail::context_core *>(user);
    return detail::guarded(c.exceptions,
                           [&] { return c.parallel_for(count, [=](int64_t k) { task(task_data, k); }); });
  }
};

/** The version of the library that runs, 0xMMmmpp: see mpm_version(). */
inline uint32_t version() noexcept {
  return mpm_version();
}

/** The name of a status: see mpm_status_name(). */
inline const char *status_name(mpm_status status) noexcept {
  return mpm_status_name(status);
}

/** What a status says, in a sentence without names and values: see mpm_status_text(). */
inline const char *status_text(mpm_status status) noexcept {
  return mpm_status_text(status);
}

} // namespace mpm

#endif
