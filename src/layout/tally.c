#include "layout/tally.h"

#include <stddef.h>

enum { ENERGIES = sizeof(mpmi_sums) / sizeof(double) };

mpm_status mpmi_tally_prepare(mpmi_tally *tally, mpm_context *context, int32_t sets, int64_t pairs) {
  const int64_t first = MPMI_TALLY_REACTIONS + 3 * (int64_t)sets, count = first + MPMI_PAIR_SUMS * pairs;
  mpm_status status;
  if ((status = MPMI_RESERVE_MORE(context, tally->sum, tally->sum_capacity, count)) ||
      (status = MPMI_RESERVE_MORE(context, tally->total, tally->total_capacity, count)))
    return status;
  tally->count = count;
  tally->pairs = first;
  for (int64_t i = 0; i < count; ++i) mpmi_exact_clear(&tally->sum[i]);
  return MPM_OK;
}

void mpmi_tally_free(mpmi_tally *tally, mpm_context *context) {
  MPMI_FREE_ARRAY(context, tally->sum, tally->sum_capacity);
  MPMI_FREE_ARRAY(context, tally->total, tally->total_capacity);
}

static int32_t is_rate(int32_t at) {
  return at == offsetof(mpmi_sums, rate) / sizeof(double) ||
         at == offsetof(mpmi_sums, viscous_rate) / sizeof(double);
}

void mpmi_tally_block(mpmi_whole_sum *sum, const mpmi_sums *block, mpmi_sums *rates) {
  const double *term = (const double *)block;
  for (int32_t i = 0; i < ENERGIES; ++i)
    if (!is_rate(i)) mpmi_exact_add(&sum[i], term[i]);
  if (block->rate > rates->rate) rates->rate = block->rate;
  if (block->viscous_rate > rates->viscous_rate) rates->viscous_rate = block->viscous_rate;
}

void mpmi_tally_read(const double *total, mpmi_sums *sums) {
  double *to = (double *)sums;
  for (int32_t i = 0; i < ENERGIES; ++i)
    if (!is_rate(i)) to[i] = total[i];
}
