/* The host may keep particles from being split or merged. */
#include "adaption/adaption.h"

/* What the host sees of a list: a batch at a time. */
enum { BATCH = 256 };
typedef struct asked {
  int64_t id[BATCH], other[BATCH];
  double position[3 * BATCH];
  uint8_t accept[BATCH];
} asked;

static void show(const mpmi_adaption *a, const mpm_particles *set, int32_t copy, int32_t what, int64_t begin,
                 int64_t n, asked *to) {
  for (int64_t i = 0; i < n; ++i) {
    const mpmi_merging *pair = what == MPM_ADAPT_MERGE ? &a->pair[begin + i] : NULL;
    const mpmi_splitting *split = what == MPM_ADAPT_SPLIT ? &a->split[begin + i] : NULL;
    const int64_t slot = split ? split->slot : pair->stays;
    to->id[i] = split ? split->id : pair->id;
    to->other[i] = split ? -1 : pair->other;
    to->accept[i] = 1;
    for (int32_t k = 0; k < set->grid->dim; ++k)
      to->position[k * BATCH + i] = mpmi_row_of(set, MPMI_POSITION, copy, k)[slot];
  }
}

/* Moves what is accepted of a batch behind the `kept` ones of its list. */
static int64_t thin_out(mpmi_adaption *a, const mpm_particles *set, int32_t what, int64_t begin, int64_t n,
                        const uint8_t *accept, int64_t kept) {
  for (int64_t i = 0; i < n; ++i) {
    if (!accept[i]) continue;
    if (what == MPM_ADAPT_SPLIT)
      a->split[kept++] = a->split[begin + i];
    else
      mpmi_keep_merging(a, set, begin + i, kept++);
  }
  return kept;
}

static mpm_status ask(mpmi_adaption *a, const mpm_particles *set, int32_t copy, int32_t what,
                      int64_t *count) {
  asked of;
  int64_t kept = 0;
  for (int64_t begin = 0; begin < *count; begin += BATCH) {
    const int64_t n = *count - begin < BATCH ? *count - begin : BATCH;
    show(a, set, copy, what, begin, n, &of);
    const mpm_adaption_batch batch = {.struct_size = sizeof batch,
                                      .what = what,
                                      .n = n,
                                      .ld = BATCH,
                                      .dim = set->grid->dim,
                                      .id = of.id,
                                      .other = what == MPM_ADAPT_MERGE ? of.other : NULL,
                                      .position = of.position};
    const mpm_status status = mpmi_from_host(a->desc.accept(a->desc.user, &batch, of.accept));
    if (status)
      return mpmi_fail(set->context, mpmi_callback_cause(status), "the adaption callback returned %d",
                       (int)status);
    kept = thin_out(a, set, what, begin, n, of.accept, kept);
  }
  *count = kept;
  return MPM_OK;
}

mpm_status mpmi_adaption_ask(mpmi_adaption *a, const mpm_particles *set, int32_t copy) {
  if (!a->desc.accept) return MPM_OK;
  const mpm_status status = ask(a, set, copy, MPM_ADAPT_SPLIT, &a->splits);
  return status ? status : ask(a, set, copy, MPM_ADAPT_MERGE, &a->pairs);
}
