/* Work on vectors of unknowns is cut into ranges that depend on the length alone, and sums are formed in
 * the order of the ranges. So no bit of a result depends on the number of threads. */
#ifndef MPMI_VECTORS_H
#define MPMI_VECTORS_H

#include "context/context.h"

enum {
  MPMI_MOST_RANGES = 256,
  MPMI_LEAST_RANGE = 512,    /* items: below that a range is not worth its task */
  MPMI_ALONE_UNKNOWNS = 2000 /* systems smaller than that do not wake other threads */
};

typedef struct mpmi_ranges {
  int64_t items, size, count; /* ranges of `size` items, the last one may be shorter */
  int32_t alone;              /* the calling thread does them all */
} mpmi_ranges;

/* Cuts items, which may be unknowns or nodes, into ranges; unknowns: how many the whole system has. */
mpmi_ranges mpmi_ranges_of(int64_t items, int64_t unknowns);
static inline int64_t mpmi_range_begin(const mpmi_ranges *ranges, int64_t k) {
  return k * ranges->size < ranges->items ? k * ranges->size : ranges->items;
}
/* Runs one task per range. */
mpm_status mpmi_run_ranges(mpm_context *context, const mpmi_ranges *ranges, mpm_task_fn task, void *data);

/* Each range notes whether it failed, and at which item. */
typedef struct mpmi_range_failures {
  mpm_status status[MPMI_MOST_RANGES];
  int64_t item[MPMI_MOST_RANGES];
} mpmi_range_failures;
/* Returns the first failure in the order of the ranges; without one *item stays as it is. */
mpm_status mpmi_first_failure(const mpmi_range_failures *of, int64_t ranges, int64_t *item);

mpm_status mpmi_dot(mpm_context *context, const double *a, const double *b, int64_t n, double *out);
mpm_status mpmi_norm(mpm_context *context, const double *a, int64_t n, double *out);

#endif
