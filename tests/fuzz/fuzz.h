/* What the fuzz targets share: bytes as choices, a host whose memory is counted and bounded, and what must be
 * true whatever the bytes say. An input that has run out gives zeros. */
#ifndef FUZZ_H
#define FUZZ_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <mpm/mpm.h>

#define MUST(condition)                                                                                      \
  do {                                                                                                       \
    if (!(condition)) fuzz_fail(#condition, __FILE__, __LINE__);                                             \
  } while (0)

static inline void fuzz_fail(const char *what, const char *file, int line) {
  fprintf(stderr, "%s:%d: not true: %s\n", file, line, what);
  abort();
}

typedef struct fuzz_input {
  const uint8_t *at, *end;
} fuzz_input;

static inline int32_t fuzz_left(const fuzz_input *in) {
  return in->at < in->end;
}
static inline uint32_t fuzz_byte(fuzz_input *in) {
  return fuzz_left(in) ? *in->at++ : 0;
}
/* 0 ... n - 1, n <= 256 */
static inline int32_t fuzz_below(fuzz_input *in, int32_t n) {
  return (int32_t)(fuzz_byte(in) % (uint32_t)n);
}
/* one entry of a table, whatever its length is */
#define FUZZ_PICK(in, table) ((table)[fuzz_below(in, (int32_t)(sizeof(table) / sizeof((table)[0])))])
static inline uint64_t fuzz_word(fuzz_input *in, int32_t bytes) {
  uint64_t word = 0;
  for (int32_t i = 0; i < bytes; ++i) word = word << 8 | fuzz_byte(in);
  return word;
}
/* low ... high in 256 steps */
static inline double fuzz_between(fuzz_input *in, double low, double high) {
  return low + (high - low) * (double)fuzz_byte(in) / 255.0;
}
/* Any double: special ones, powers of ten of all sizes, or eight bytes as they are. */
static inline double fuzz_double(fuzz_input *in) {
  static const double special[] = {0.0,
                                   -0.0,
                                   1.0,
                                   -1.0,
                                   0.5,
                                   2.0,
                                   1e-3,
                                   1e3,
                                   1e-300,
                                   1e300,
                                   -1e300,
                                   5e-324,
                                   1e-16,
                                   1e16,
                                   0.49999,
                                   0.999999,
                                   1e-8,
                                   1e8,
                                   (double)NAN,
                                   (double)INFINITY,
                                   -(double)INFINITY};
  enum { SPECIAL = sizeof special / sizeof *special };
  const uint32_t kind = fuzz_byte(in);
  if (kind < SPECIAL) return special[kind];
  if (kind < 200) return ((double)kind - 110.0) / 16.0;
  if (kind < 250) return pow(10.0, (double)fuzz_byte(in) * 2.4 - 306.0) * (kind % 2 ? 1.0 : -1.0);
  const uint64_t word = fuzz_word(in, 8);
  double value;
  memcpy(&value, &word, sizeof value);
  return value;
}
static inline int64_t fuzz_integer(fuzz_input *in) {
  static const int64_t special[] = {INT64_MAX, INT64_MIN, INT32_MAX, INT32_MIN, (int64_t)UINT32_MAX, 6 << 20};
  const int32_t kind = fuzz_below(in, 256);
  if (kind < 6) return special[kind];
  return kind < 240 ? kind - 26 : (int64_t)fuzz_word(in, 1 + kind % 8);
}

/* Memory from the host: the bound keeps inputs small, and the allocation with number fail_at fails. */
typedef struct fuzz_memory {
  int64_t held, calls, fail_at;
} fuzz_memory;
enum { FUZZ_MOST_BYTES = 1 << 28 };

static inline void *fuzz_alloc(void *user, size_t bytes, size_t alignment) {
  fuzz_memory *m = user;
  if (m->fail_at && ++m->calls == m->fail_at) return NULL;
  if (bytes > FUZZ_MOST_BYTES || m->held + (int64_t)bytes > FUZZ_MOST_BYTES) return NULL;
  void *memory = aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (memory) memset(memory, 0xff, bytes);
  m->held += (int64_t)bytes;
  return memory;
}

static inline void fuzz_release(void *user, void *memory, size_t bytes, size_t alignment) {
  fuzz_memory *m = user;
  (void)alignment;
  m->held -= (int64_t)bytes;
  free(memory);
}

/* For calls that must not fail; what is returned goes back to fail_at. */
static inline int64_t fuzz_no_failure(fuzz_memory *m) {
  const int64_t fail_at = m->fail_at;
  m->fail_at = 0;
  return fail_at;
}

static inline mpm_context *fuzz_context_of_part(fuzz_memory *memory, int32_t concurrency,
                                                const mpm_transport *transport) {
  mpm_context_desc desc;
  mpm_context *context;
  *memory = (fuzz_memory){0, 0, 0};
  MUST(mpm_context_desc_init(&desc, sizeof desc) == MPM_OK);
  desc.alloc = fuzz_alloc;
  desc.release = fuzz_release;
  desc.alloc_user = memory;
  desc.concurrency = concurrency;
  desc.transport = transport;
  MUST(mpm_context_create(&desc, &context) == MPM_OK);
  return context;
}

static inline mpm_context *fuzz_context(fuzz_memory *memory, int32_t concurrency) {
  return fuzz_context_of_part(memory, concurrency, NULL);
}

static inline void fuzz_close(mpm_context *context, fuzz_memory *memory) {
  MUST(mpm_context_destroy(context) == MPM_OK);
  MUST(memory->held == 0);
}

/* A status of the list, and a failure has a sentence; never a fault of the library itself. */
static inline mpm_status fuzz_status(const mpm_context *context, mpm_status status) {
  MUST(status >= MPM_E_FORMAT && status <= MPM_CANCELLED);
  MUST(status == MPM_OK || *mpm_last_error(context) != '\0');
  return status;
}

/* Every field of every particle can be read, and its numbers are finite. */
static inline void fuzz_finite(const mpm_particles *set) {
  const char *name;
  int32_t type, components;
  const int64_t n = mpm_particles_count(set);
  for (int32_t f = 0; !mpm_particles_field_info(set, f, &name, &type, &components, NULL); ++f) {
    if (!components) continue;
    double *values = malloc(sizeof *values * (size_t)(n * components + 1));
    const mpm_status status = mpm_particles_get(set, name, type, components, n, NULL, values);
    MUST(status == MPM_OK || status == MPM_E_STATE); /* fields that are not kept now */
    for (int64_t i = 0; !status && type == MPM_F64 && i < n * components; ++i) MUST(isfinite(values[i]));
    free(values);
  }
}

#endif
