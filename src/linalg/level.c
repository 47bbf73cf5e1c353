/* The steps that make levels share their memory, and cut their work into tasks in the same way. */
#include "linalg/level.h"

mpm_status mpmi_level_memory_reserve(mpmi_level_memory *w, size_t bytes) {
  return mpmi_reserve(w->context, (void **)&w->memory, &w->capacity, (int64_t)bytes, 1);
}

mpmi_ranges mpmi_level_memory_tasks(const mpmi_level_memory *w, const mpmi_matrix *A) {
  const int32_t alone = mpmi_matrix_unknowns(A) < MPMI_ALONE_UNKNOWNS;
  const int64_t count = alone ? 1 : w->context->concurrency;
  return (mpmi_ranges){.items = count, .size = 1, .count = count, .alone = alone};
}
