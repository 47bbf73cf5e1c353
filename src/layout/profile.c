#include "layout/profile.h"

/* Weights are made inside the transfers: one block in so many has them made once more, for the clock. */
enum { SAMPLED_BLOCKS = 64 };

void mpmi_sample_weights(mpmi_step *step, int32_t task, const mpmi_axis *axis, int32_t need,
                         const mpmi_points *points, int64_t begin, int64_t end) {
  const mpmi_settings *settings = step->settings;
  if (!step->profile->sampled || step->work->scratch[task].blocks_seen++ % SAMPLED_BLOCKS) return;
  const mpmi_weights_fn weights = settings->kernels->weights[settings->grid->family][settings->grid->dim];
  mpmi_weights W;
  const double started = mpmi_seconds();
  for (int64_t at = begin; at < end; at += MPMI_CHUNK)
    weights(axis, need, points, at, end - at < MPMI_CHUNK ? end - at : MPMI_CHUNK, &W);
  step->work->report[task].weights_seconds += SAMPLED_BLOCKS * (mpmi_seconds() - started);
}

void mpmi_lap(mpmi_step *step, int32_t stage, double *from) {
  const double now = mpmi_seconds();
  step->profile->seconds[stage] += now - *from;
  step->profile->seconds[MPMI_TIME_TOTAL] += now - *from;
  *from = now;
}

void mpmi_move_samples(mpmi_step *step, int32_t stage) {
  const int32_t tasks = step->settings->tasks;
  double law = 0.0;
  for (int32_t k = 0; k < tasks; ++k) {
    law += step->work->report[k].law_seconds / tasks;
    step->profile->seconds[MPMI_TIME_WEIGHTS] += step->work->report[k].weights_seconds / tasks;
  }
  step->profile->seconds[MPMI_TIME_LAW] += law;
  step->profile->seconds[stage] -= law;
}
