/* The grid's own part of a step, on every node as if it were free: momentum to velocity, force to increment
 * (transfer/update.c). */
#include "stages/stages.h"
#include "layout/tasks.h"
#include "layout/reached.h"

#include <string.h>

typedef struct update_job {
  mpmi_step *step;
  mpmi_nodes *nodes;
  const mpmi_nodal *values;
  int32_t forgets_impulses, forgets_held; /* 1: clears what the boundary stage will write */
} update_job;

/* Runs of nodes, for a task. */
typedef struct update_runs {
  const update_job *job;
  int64_t active;
} update_runs;

static void update_run(void *user, int64_t slot, int64_t count) {
  update_runs *runs = user;
  const mpmi_step *step = runs->job->step;
  const mpmi_nodal *values = runs->job->values;
  runs->active += step->settings->kernels->update(values->values, mpmi_nodal_at(values, slot), count,
                                                  step->layout->mass_cut, step->velocity_dt);
}

static void update_task(void *data, int64_t k) {
  const update_job *job = data;
  const mpmi_step *step = job->step;
  const mpmi_nodes *nodes = job->nodes;
  const mpmi_share share = mpmi_share_of(step->settings, mpmi_slots(step->layout), k);
  const int64_t count = share.end - share.begin;
  step->work->report[k].active = 0;
  if (!count) return; /* perhaps there are no nodes at all */
  update_runs runs = {job, 0};
  if (mpmi_zero_elsewhere(step->layout, job->values)) {
    const mpmi_share blocks = mpmi_share_of(step->settings, step->layout->blocks.count, k);
    mpmi_reached_runs(&step->layout->blocks, blocks.begin, blocks.end, update_run, &runs);
  } else {
    update_run(&runs, share.begin, count);
  }
  step->work->report[k].active = runs.active;
  if (job->forgets_impulses && nodes->has_impulses)
    memset(nodes->impulse + share.begin, 0, (size_t)count * sizeof *nodes->impulse);
  if (job->forgets_held && nodes->has_holders)
    memset(nodes->held + share.begin, 0, (size_t)count * sizeof *nodes->held);
}

mpm_status mpmi_node_update_stage(mpmi_step *step, const mpmi_projection *projection, mpmi_nodes *nodes) {
  const mpmi_settings *settings = step->settings;
  const int32_t first =
      projection == &mpmi_projections[MPMI_PROJECT_CONTACT] || mpmi_asks_host(settings, projection);
  update_job job = {step, nodes, mpmi_projected_nodes(nodes, projection), projection->main, first};
  const mpm_status status = mpmi_run_tasks(settings, 0, settings->tasks, update_task, &job);
  if (status || !projection->main) return status;
  step->info.active_nodes = 0;
  for (int32_t k = 0; k < settings->tasks; ++k) step->info.active_nodes += step->work->report[k].active;
  return MPM_OK;
}
