/* Memory that is held and not in use: gaps between the pieces of one allocation, and room that an array has
 * not grown into. Under the address sanitizer it is closed, so that a read or write there is reported as one
 * beyond an allocation would be; elsewhere nothing happens. */
#ifndef MPMI_SLACK_H
#define MPMI_SLACK_H

#include <stddef.h>

#if defined(__SANITIZE_ADDRESS__)
#define MPMI_WATCHED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define MPMI_WATCHED 1
#endif
#endif
#ifndef MPMI_WATCHED
#define MPMI_WATCHED 0
#endif

/* The sanitizer's own functions. */
#if MPMI_WATCHED
void __asan_poison_memory_region(const volatile void *memory, size_t bytes);
void __asan_unpoison_memory_region(const volatile void *memory, size_t bytes);
#endif

/* Of `held` bytes the first `used` are open and the rest is closed. */
static inline void mpmi_slack(void *memory, size_t held, size_t used) {
#if MPMI_WATCHED
  if (!memory) return;
  __asan_unpoison_memory_region(memory, used);
  __asan_poison_memory_region((char *)memory + used, held - used);
#else
  (void)memory, (void)held, (void)used;
#endif
}

/* Opens the first `used` bytes, and leaves the rest as it is. */
static inline void mpmi_slack_open(void *memory, size_t used) {
#if MPMI_WATCHED
  __asan_unpoison_memory_region(memory, used);
#else
  (void)memory, (void)used;
#endif
}

/* Does as mpmi_slack() in each of `rows` rows of `ld` elements of a size, of which `count` are in use. */
static inline void mpmi_slack_rows(void *memory, size_t rows, size_t ld, size_t count, size_t size) {
  for (size_t c = 0; c < rows && MPMI_WATCHED && memory; ++c)
    mpmi_slack((char *)memory + c * ld * size, ld * size, count * size);
}

/* Bytes between pieces of one allocation: a line where nobody watches, else as far as an index may go
 * astray. */
static inline size_t mpmi_gap(size_t bytes, size_t alignment) {
  const size_t most = (size_t)1 << 16, away = bytes < most ? bytes : most;
  return MPMI_WATCHED ? (away + alignment) / alignment * alignment : 0;
}

#endif
