#include "layout/accumulate.h"
#include "layout/reached.h"
#include "layout/tasks.h"
#include "layout/tile.h"

#include <string.h>

typedef struct sum_job {
  mpmi_step *step;
  const mpmi_accumulation *sum;
} sum_job;

static double *tile_of(const sum_job *job, int64_t task) {
  const mpmi_scratch *scratch = &job->step->work->scratch[task];
  return job->sum->gathers ? scratch->sum_tile : scratch->tile;
}

static void clear_run(void *user, int64_t slot, int64_t count) {
  const mpmi_nodal *to = user;
  memset(mpmi_nodal_at(to, slot), 0, (size_t)(count * to->values) * sizeof(double));
}

static void clear_task(void *data, int64_t k) {
  const sum_job *job = data;
  const mpmi_accumulation *sum = job->sum;
  const mpmi_settings *settings = job->step->settings;
  const mpmi_blocks *b = &job->step->layout->blocks;
  const int64_t each = (int64_t)b->nodes * sum->to->values;
  if (!sum->gathers) mpmi_tile_use(settings->grid, tile_of(job, k), sum->to->values);
  memset(tile_of(job, k), 0, (size_t)(sum->to->values * mpmi_tile_nodes(settings->grid)) * sizeof(double));
  const mpmi_share share = mpmi_share_of(settings, b->count, k);
  if (!sum->flags && mpmi_zero_elsewhere(job->step->layout, sum->to)) {
    mpmi_reached_runs(b, share.begin, share.end, clear_run, sum->to);
    return;
  }
  if (!sum->flags) {
    mpmi_clear_share(settings, sum->to->at, b->count * b->nodes, sum->to->values, k);
    return;
  }
  for (int64_t block = share.begin; block < share.end; ++block)
    if (sum->flags[block] & sum->receiving)
      memset(sum->to->at + block * each, 0, (size_t)each * sizeof(double));
}

static void add_block(void *user, const mpmi_visit *visit) {
  const sum_job *job = user;
  const mpmi_accumulation *sum = job->sum;
  if (sum->flags && !(sum->flags[visit->block] & sum->giving)) return;
  double *tile = tile_of(job, visit->task);
  sum->give(sum->user, visit, tile);
  mpmi_tile_add(job->step->settings->kernels, &job->step->layout->blocks, visit->block, sum->to, tile);
}

/* Tied nodes get values where no stencil is, and so may hosts and implicit steps give them. */
static int32_t stays_zero_elsewhere(const mpmi_step *step, const mpmi_accumulation *sum) {
  const mpmi_settings *settings = step->settings;
  return !sum->flags && !step->layout->constraints.tie_count && !settings->velocity_bc &&
         !mpmi_has_hooks(settings) && !mpmi_is_implicit(settings);
}

mpm_status mpmi_accumulate(mpmi_step *step, const mpmi_accumulation *sum) {
  const mpmi_settings *settings = step->settings;
  sum_job job = {step, sum};
  mpm_status status = mpmi_run_tasks(settings, 0, settings->tasks, clear_task, &job);
  sum->to->zero_elsewhere = stays_zero_elsewhere(step, sum) ? step->layout->covers : -1;
  if (!status) status = mpmi_visit_colours(step, sum->calls_host, add_block, &job);
  if (!status && sum->fold) status = mpmi_run_tasks(settings, 0, settings->tasks, sum->fold, sum->user);
  return status;
}
