#include "layout/step.h"
#include "context/arena.h"
#include "layout/tile.h"
#include "particles/law_batch.h"

#include <string.h>

mpmi_failure mpmi_no_failure(void) {
  return (mpmi_failure){.cause = MPM_OK, .set = -1, .particle = -1, .node = -1, .what = ""};
}

/* Keeps the failure with the smallest (set, particle); failures without a particle (nodes, callbacks) come
 * first in their set. */
void mpmi_failure_take(mpmi_failure *first, mpmi_failure other) {
  if (!other.cause) return;
  int32_t before = !first->cause;
  if (!before && other.set != first->set)
    before = other.set < first->set;
  else if (!before && other.particle != first->particle)
    before = other.particle < first->particle;
  else if (!before)
    before = other.node < first->node || (other.node == first->node && other.body < first->body);
  if (before) *first = other;
}

mpm_status mpmi_callback_cause(mpm_status status) {
  return status > 0 ? MPM_CUT_DT : MPM_E_CALLBACK;
}

mpmi_failure mpmi_particle_failure(mpm_status cause, int32_t m, int64_t id, const char *what) {
  return (mpmi_failure){.cause = cause, .set = m, .particle = id, .node = -1, .what = what};
}

mpmi_failure mpmi_node_failure(mpm_status cause, const mpmi_blocks *blocks, int64_t slot, const char *what) {
  return (mpmi_failure){.cause = cause,
                        .set = -1,
                        .particle = -1,
                        .node = mpmi_blocks_number(blocks, slot),
                        .what = what,
                        .body = blocks->body[slot / blocks->nodes]};
}

mpmi_failure mpmi_callback_failure(mpm_status returned, int32_t m, const char *what) {
  mpmi_failure failure = mpmi_particle_failure(mpmi_callback_cause(returned), m, -1, what);
  failure.callback_status = returned;
  return failure;
}

/* Returns the status of a step from t over dt that fails so, with its sentence. */
static mpm_status report(mpm_context *context, const mpmi_failure *f, double t, double dt) {
  if (!f->cause) return MPM_OK;
  if (f->callback_status && f->set >= 0)
    return mpmi_fail(context, f->cause, "%s returned %d for set %d in the step from t = %g with dt = %g",
                     f->what, (int)f->callback_status, (int)f->set, t, dt);
  if (f->callback_status)
    return mpmi_fail(context, f->cause, "%s returned %d in the step from t = %g with dt = %g", f->what,
                     (int)f->callback_status, t, dt);
  if (f->particle >= 0)
    return mpmi_fail(context, f->cause, "%s at particle %lld of set %d in the step from t = %g with dt = %g",
                     f->what, (long long)f->particle, (int)f->set, t, dt);
  return mpmi_fail(context, f->cause, "%s at node %lld in the step from t = %g with dt = %g", f->what,
                   (long long)f->node, t, dt);
}

void mpmi_failures_clear(mpmi_step *step) {
  step->failure = mpmi_no_failure();
  for (int32_t k = 0; k < step->settings->tasks; ++k) step->work->report[k].failure = mpmi_no_failure();
}

mpm_status mpmi_step_failure(mpmi_step *step) {
  for (int32_t k = 0; k < step->settings->tasks; ++k)
    mpmi_failure_take(&step->failure, step->work->report[k].failure);
  return report(step->settings->context, &step->failure, step->t, step->dt);
}

/* ---- workspace --------------------------------------------------------------------------------------- */
mpm_status mpmi_workspace_create(mpmi_workspace *work, const mpmi_settings *settings) {
  mpm_context *c = settings->context;
  work->scratch = mpmi_alloc_zeroed(c, mpmi_bytes(settings->tasks, sizeof *work->scratch));
  if (!work->scratch) return MPM_E_NOMEM;
  work->report = mpmi_alloc_zeroed(c, mpmi_bytes(settings->tasks, sizeof *work->report));
  return work->report ? MPM_OK : MPM_E_NOMEM;
}

void mpmi_workspace_free(mpmi_workspace *work, const mpmi_settings *settings) {
  mpm_context *c = settings->context;
  mpmi_free(c, work->scratch_memory, work->scratch_bytes);
  MPMI_FREE_ARRAY(c, work->scratch, settings->tasks);
  MPMI_FREE_ARRAY(c, work->report, settings->tasks);
  mpmi_member_rows_free(&work->rows, settings);
  MPMI_FREE_ARRAY(c, work->block_sums, work->block_sums_capacity);
  mpmi_tally_free(&work->tally, c);
  MPMI_FREE_ARRAY(c, work->block_stops, work->block_stops_capacity);
}

/* Rows of v, dv and C of a batch. */
enum { GATHERED_ROWS = 3 + 3 + 9 };

/* Places one task's scratch, with room for the longest batch and the largest law. */
static void lay_out(mpmi_arena *from, const mpmi_settings *settings, const mpmi_layout *layout,
                    mpmi_scratch *to) {
  const int64_t tile = 8 * (int64_t)mpmi_tile_nodes(settings->grid);
  int64_t batch = 0, length = 0;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpm_material *material = layout->member[m].set->material;
    const int64_t bytes = (int64_t)mpmi_law_batch_bytes(material), rows = mpmi_law_batch_length(material);
    batch = bytes > batch ? bytes : batch;
    length = rows > length ? rows : length;
  }
  to->cells = settings->desc.locking_remedy ? mpmi_arena_take(from, tile / 2, sizeof(double)) : NULL;
  to->tile = mpmi_arena_take(from, tile, sizeof(double));
  to->sum_tile = mpmi_is_implicit(settings) ? mpmi_arena_take(from, tile / 2, sizeof(double)) : NULL;
  to->gathered = mpmi_arena_take(from, GATHERED_ROWS * length, sizeof(double));
  to->batch_memory = mpmi_arena_take(from, batch, 1);
}

mpm_status mpmi_workspace_prepare(mpmi_workspace *work, const mpmi_settings *settings,
                                  const mpmi_layout *layout) {
  mpm_context *c = settings->context;
  const int64_t blocks = layout->blocks.count;
  mpm_status status;
  if ((status = MPMI_RESERVE_MORE(c, work->block_sums, work->block_sums_capacity, blocks))) return status;
  if (mpmi_has_friction_planes(settings)) {
    if ((status = MPMI_RESERVE_MORE(c, work->block_stops, work->block_stops_capacity, blocks))) return status;
    if (blocks > 0) memset(work->block_stops, 0, (size_t)blocks * sizeof *work->block_stops);
  }
  mpmi_arena counter = {NULL, 0};
  mpmi_scratch one;
  lay_out(&counter, settings, layout, &one);
  const size_t bytes = counter.used * (size_t)settings->tasks;
  if (bytes > work->scratch_bytes) {
    void *memory = mpmi_alloc(c, bytes);
    if (!memory) return MPM_E_NOMEM;
    mpmi_free(c, work->scratch_memory, work->scratch_bytes);
    work->scratch_memory = memory;
    work->scratch_bytes = bytes;
  }
  for (int32_t k = 0; k < settings->tasks; ++k) {
    mpmi_arena from = {(char *)work->scratch_memory + (size_t)k * counter.used, 0};
    lay_out(&from, settings, layout, &work->scratch[k]);
  }
  return MPM_OK;
}

void mpmi_reports_clear(mpmi_workspace *work, int32_t tasks) {
  for (int32_t k = 0; k < tasks; ++k) work->report[k] = (mpmi_task_report){.failure = mpmi_no_failure()};
}

/* ---- profile ----------------------------------------------------------------------------------------- */
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
  step->work->report[task].weights_seconds += (double)SAMPLED_BLOCKS * (mpmi_seconds() - started);
}

void mpmi_lap(mpmi_step *step, int32_t stage, double *from) {
  const double now = mpmi_seconds();
  step->profile->seconds[stage] += now - *from;
  step->profile->seconds[MPMI_TIME_TOTAL] += now - *from;
  *from = now;
}

void mpmi_move_samples(mpmi_step *step, int32_t stage) {
  const int32_t tasks = step->settings->tasks, at_once = step->settings->context->pool_rests ? 1 : tasks;
  double law = 0.0;
  for (int32_t k = 0; k < tasks; ++k) {
    law += step->work->report[k].law_seconds / at_once;
    step->profile->seconds[MPMI_TIME_WEIGHTS] += step->work->report[k].weights_seconds / at_once;
  }
  step->profile->seconds[MPMI_TIME_LAW] += law;
  step->profile->seconds[stage] -= law;
}
