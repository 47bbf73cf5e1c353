/* The grid's own part of a step, on every node as if it were free: momentum to velocity, force to increment
 * (transfer/update.c). */
#include "stages/stages.h"
#include "layout/tasks.h"
#include "layout/reached.h"

#include <float.h>
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
  mpmi_updated found;
  mpmi_light_node *light; /* where the next light node goes in the list */
} update_runs;

static void update_run(void *user, int64_t slot, int64_t count) {
  update_runs *runs = user;
  const mpmi_step *step = runs->job->step;
  const mpmi_nodal *values = runs->job->values;
  const double cut[2] = {step->layout->mass_cut, step->layout->light_cut};
  const mpmi_updated found = step->settings->kernels->update(values->values, mpmi_nodal_at(values, slot),
                                                             count, cut, step->velocity_dt);
  runs->found.active += found.active;
  runs->found.light += found.light;
}

static void list_run(void *user, int64_t slot, int64_t count) {
  update_runs *runs = user;
  const double cut = runs->job->step->layout->light_cut;
  for (int64_t i = slot; i < slot + count; ++i) {
    const double mass = *mpmi_mass(runs->job->values, i);
    if (mass <= cut && mass > DBL_MIN) (runs->light++)->slot = i;
  }
}

/* Takes the runs of nodes of a task's share. */
static void take_runs(const update_job *job, int64_t k, mpmi_run_fn fn, update_runs *runs) {
  const mpmi_layout *layout = job->step->layout;
  const mpmi_share share = mpmi_share_of(job->step->settings, mpmi_slots(layout), k);
  if (mpmi_zero_elsewhere(layout, job->values)) {
    const mpmi_share blocks = mpmi_share_of(job->step->settings, layout->blocks.count, k);
    mpmi_reached_runs(&layout->blocks, blocks.begin, blocks.end, fn, runs);
  } else if (share.end > share.begin) {
    fn(runs, share.begin, share.end - share.begin);
  }
}

static void update_task(void *data, int64_t k) {
  const update_job *job = data;
  const mpmi_step *step = job->step;
  const mpmi_nodes *nodes = job->nodes;
  const mpmi_share share = mpmi_share_of(step->settings, mpmi_slots(step->layout), k);
  const int64_t count = share.end - share.begin;
  update_runs runs = {job, {0, 0}, NULL};
  if (count) take_runs(job, k, update_run, &runs); /* without nodes there are no runs */
  step->work->report[k].active = runs.found.active;
  step->work->report[k].light = runs.found.light;
  if (!count) return;
  if (job->forgets_impulses && nodes->has_impulses)
    memset(nodes->impulse + share.begin, 0, (size_t)count * sizeof *nodes->impulse);
  if (job->forgets_held && nodes->has_holders)
    memset(nodes->held + share.begin, 0, (size_t)count * sizeof *nodes->held);
}

static void list_task(void *data, int64_t k) {
  const update_job *job = data;
  const mpmi_task_report *report = &job->step->work->report[k];
  update_runs runs = {job, {0, 0}, job->nodes->light + report->first_light};
  if (report->light) take_runs(job, k, list_run, &runs);
}

/* Lists the light nodes of a projection, in the order of slots. */
static mpm_status list_light_nodes(update_job *job) {
  const mpmi_settings *settings = job->step->settings;
  mpmi_nodes *nodes = job->nodes;
  nodes->light_count = 0;
  int64_t count = 0;
  for (int32_t k = 0; k < settings->tasks; ++k) {
    job->step->work->report[k].first_light = count;
    count += job->step->work->report[k].light;
  }
  if (!count) return MPM_OK;
  const mpm_status status = MPMI_RESERVE_MORE(settings->context, nodes->light, nodes->light_capacity, count);
  if (status) return status;
  nodes->light_count = count;
  return mpmi_run_tasks(settings, 0, settings->tasks, list_task, job);
}

mpm_status mpmi_node_update_stage(mpmi_step *step, const mpmi_projection *projection, mpmi_nodes *nodes) {
  const mpmi_settings *settings = step->settings;
  const int32_t first =
      projection == &mpmi_projections[MPMI_PROJECT_CONTACT] || mpmi_asks_host(settings, projection);
  update_job job = {step, nodes, mpmi_projected_nodes(nodes, projection), projection->main, first};
  mpm_status status = mpmi_run_tasks(settings, 0, settings->tasks, update_task, &job);
  if (!status && projection->contact != MPMI_CONTACT_NONE) status = list_light_nodes(&job);
  if (status || !projection->main) return status;
  int64_t active = 0;
  for (int32_t k = 0; k < settings->tasks; ++k) active += step->work->report[k].active;
  step->info.active_nodes = active;
  return MPM_OK;
}
