/* Where the time of steps goes. */
#include "stepper/stepper.h"

#include <string.h>

/* Weights are made inside the transfers: one block in so many has them made once more, for the clock. */
enum { SAMPLED_BLOCKS = 64 };

void mpmi_sample_weights(const mpm_stepper *s, mpmi_scratch *scratch, const mpmi_axis *axis, int32_t need,
                         const mpmi_points *points, int64_t begin, int64_t end) {
  if (!s->profiled || scratch->blocks_seen++ % SAMPLED_BLOCKS) return;
  const mpmi_weights_fn weights = s->kernels->weights[s->grid->family][s->grid->dim];
  mpmi_weights W;
  const double started = mpmi_seconds();
  for (int64_t at = begin; at < end; at += MPMI_CHUNK)
    weights(axis, need, points, at, end - at < MPMI_CHUNK ? end - at : MPMI_CHUNK, &W);
  scratch->weights_seconds += SAMPLED_BLOCKS * (mpmi_seconds() - started);
}

void mpmi_lap(mpm_stepper *s, int32_t stage, double *from) {
  const double now = mpmi_seconds();
  s->seconds[stage] += now - *from;
  s->seconds[MPMI_TIME_TOTAL] += now - *from;
  *from = now;
}

void mpmi_book_samples(mpm_stepper *s, int32_t stage) {
  double law = 0.0;
  for (int32_t k = 0; k < s->tasks; ++k) {
    law += s->scratch[k].law_seconds / s->tasks;
    s->seconds[MPMI_TIME_WEIGHTS] += s->scratch[k].weights_seconds / s->tasks;
  }
  s->seconds[MPMI_TIME_LAW] += law;
  s->seconds[stage] -= law;
}

mpm_status mpm_stepper_profile(mpm_stepper *s, int32_t reset, mpm_profile *out) {
  MPMI_ENTER(s, MPMI_STEPPER);
  if (!out) return mpmi_fail(s->context, MPM_E_ARG, "out is NULL");
  const double *t = s->seconds;
  const mpm_profile profile = {.struct_size = sizeof profile,
                               .sort = t[MPMI_TIME_SORT],
                               .p2g = t[MPMI_TIME_P2G],
                               .grid = t[MPMI_TIME_GRID],
                               .g2p = t[MPMI_TIME_G2P],
                               .law = t[MPMI_TIME_LAW],
                               .assembly = t[MPMI_TIME_ASSEMBLY],
                               .factor = t[MPMI_TIME_FACTOR],
                               .solve = t[MPMI_TIME_SOLVE],
                               .callbacks = t[MPMI_TIME_CALLBACKS],
                               .total = t[MPMI_TIME_TOTAL],
                               .weights = t[MPMI_TIME_WEIGHTS]};
  const mpm_status status = mpmi_write_struct(s->context, "mpm_profile", &profile, sizeof profile, out);
  if (status) return status;
  s->profiled = 1;
  if (reset) memset(s->seconds, 0, sizeof s->seconds);
  return MPM_OK;
}
