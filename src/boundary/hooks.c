#include "boundary/hooks.h"
#include "boundary/node_batch.h"
#include "layout/tasks.h"

#include <math.h>
#include <string.h>

typedef struct hook_job {
  const mpmi_bound *f;
  int32_t stage;
} hook_job;

/* Velocity and force on both sides of the call. */
typedef struct hook_values {
  double shown[2][3 * MPMI_NODE_BATCH], velocity[3 * MPMI_NODE_BATCH], force[3 * MPMI_NODE_BATCH];
} hook_values;

static void shift_node(const mpmi_bound *f, int64_t slot, int32_t c, double velocity, double increment) {
  mpmi_velocity(f->values, slot)[c] += velocity;
  mpmi_increment(f->values, slot)[c] += increment;
}

/* Changes v~ and dv of a free node with its tie; what particles take of that is the hook's impulse. */
static void shift(const mpmi_bound *f, int64_t slot, int32_t c, double velocity, double increment) {
  const mpmi_constraints *constraints = mpmi_constraints_of(f);
  const int32_t at = constraints->tie_of[slot];
  const double given = f->flip * increment + (1.0 - f->flip) * velocity;
  f->nodes->hook_impulse[slot][c] += mpmi_moving_mass(f, slot) * given;
  shift_node(f, slot, c, velocity, increment);
  if (at < 0) return;
  mpmi_tie_state *state = &f->nodes->tie_state[at];
  state->before[c] += given;
  state->increment[c] += increment;
  for (int64_t d = 0; d < constraints->tie[at].count; ++d) {
    const mpmi_follower *follower = &constraints->follower[constraints->tie[at].first + d];
    shift_node(f, follower->slot, c, follower->sign[c] * velocity, follower->sign[c] * increment);
  }
}

static void show_node(const hook_job *job, const mpmi_node_list *list, int64_t i, hook_values *values) {
  const mpmi_bound *f = job->f;
  for (int32_t c = 0; c < f->dim; ++c) {
    const int64_t at = c * MPMI_NODE_BATCH + i;
    const double v = mpmi_velocity(f->values, list->slot[i])[c];
    const double dv = mpmi_increment(f->values, list->slot[i])[c];
    values->shown[0][at] = job->stage == MPM_AFTER_VELOCITY ? v : v - dv;
    values->shown[1][at] = job->stage == MPM_AFTER_P2G ? 0.0 : list->mass[i] * dv / f->step->velocity_dt;
  }
}

/* What was written, against what was shown: values that are not touched leave every bit of the node. */
static void take_node(const hook_job *job, const mpmi_node_list *list, int64_t i, const hook_values *values) {
  const mpmi_bound *f = job->f;
  for (int32_t c = 0; c < f->dim; ++c) {
    const int64_t at = c * MPMI_NODE_BATCH + i, slot = list->slot[i];
    const double change = values->velocity[at] - values->shown[0][at];
    const double force = values->force[at] - values->shown[1][at];
    if (job->stage == MPM_AFTER_VELOCITY) {
      if (change != 0.0) shift(f, slot, c, change, change);
      continue;
    }
    const double gained = force * f->step->velocity_dt / list->mass[i];
    if (change != 0.0 || force != 0.0) shift(f, slot, c, change + gained, gained);
  }
}

static int32_t is_finite(const hook_job *job, int64_t i, const hook_values *values) {
  for (int32_t c = 0; c < job->f->dim; ++c) {
    const int64_t at = c * MPMI_NODE_BATCH + i;
    if (!isfinite(values->velocity[at])) return 0;
    if (job->stage != MPM_AFTER_VELOCITY && !isfinite(values->force[at])) return 0;
  }
  return 1;
}

static void call_hook(const hook_job *job, int64_t block, mpmi_node_list *list, mpmi_failure *failure) {
  static const char *const what[] = {"the hook after P2G", "the hook after forces",
                                     "the hook after velocity"};
  static const char *const bad[] = {"velocity or force of the hook after P2G not finite",
                                    "velocity or force of the hook after forces not finite",
                                    "velocity of the hook after velocity not finite"};
  const mpmi_settings *settings = job->f->step->settings;
  const int32_t h = job->stage - MPM_AFTER_P2G;
  if (!mpmi_list_nodes(job->f, block, list)) return;
  hook_values values = {{{0.0}}, {0.0}, {0.0}};
  for (int64_t i = 0; i < list->n; ++i) show_node(job, list, i, &values);
  memcpy(values.velocity, values.shown[0], sizeof values.velocity);
  memcpy(values.force, values.shown[1], sizeof values.force);
  const mpm_status status =
      settings->hook[h](settings->hook_user[h], &list->batch, values.velocity, values.force);
  if (status) {
    mpmi_failure_take(failure, &(mpmi_failure){mpmi_callback_cause(status), status, -1, -1, -1, what[h]});
    return;
  }
  for (int64_t i = 0; i < list->n; ++i)
    if (!is_finite(job, i, &values)) mpmi_bad_node(job->f, list, i, bad[h], failure);
  if (failure->cause) return;
  for (int64_t i = 0; i < list->n; ++i) take_node(job, list, i, &values);
}

static void hook_task(void *data, int64_t k) {
  const hook_job *job = data;
  const mpmi_step *step = job->f->step;
  const mpmi_share share = mpmi_share_of(step->settings, step->layout->blocks.count, k);
  mpmi_node_list list;
  for (int64_t b = share.begin; b < share.end; ++b) call_hook(job, b, &list, &step->work->report[k].failure);
}

mpm_status mpmi_hooks_run(const mpmi_bound *f, int32_t stage) {
  const mpmi_settings *settings = f->step->settings;
  hook_job job = {f, stage};
  if (!settings->hook[stage - MPM_AFTER_P2G]) return MPM_OK;
  const mpm_status status = mpmi_run_tasks(settings, 1, settings->tasks, hook_task, &job);
  return status ? status : mpmi_step_failure(f->step);
}

/* Like that of every external force: impulse times the velocity with which the node moves in the step. */
static void work_task(void *data, int64_t k) {
  const mpmi_bound *f = data;
  const mpmi_blocks *blocks = &f->step->layout->blocks;
  const mpmi_share share = mpmi_share_of(f->step->settings, blocks->count, k);
  for (int64_t b = share.begin; b < share.end; ++b) {
    double work = 0.0;
    for (int64_t slot = b * blocks->nodes; slot < (b + 1) * blocks->nodes; ++slot)
      for (int32_t c = 0; c < f->dim; ++c)
        work += f->nodes->hook_impulse[slot][c] * mpmi_velocity(f->values, slot)[c];
    f->step->work->block_work[b] = work;
  }
}

static void forget_task(void *data, int64_t k) {
  const mpmi_bound *f = data;
  mpmi_clear_share(f->step->settings, (double *)f->nodes->hook_impulse, mpmi_slots(f->step->layout), 3, k);
}

static mpm_status run_all(const mpmi_bound *f, mpm_task_fn task) {
  const mpmi_settings *settings = f->step->settings;
  return mpmi_run_tasks(settings, 0, settings->tasks, task, (void *)(uintptr_t)f);
}

mpm_status mpmi_hooks_begin(const mpmi_bound *f) {
  return mpmi_has_hooks(f->step->settings) ? run_all(f, forget_task) : MPM_OK;
}

mpm_status mpmi_hooks_end(const mpmi_bound *f) {
  if (!mpmi_has_hooks(f->step->settings)) return MPM_OK;
  const mpm_status status = run_all(f, work_task);
  if (!status) mpmi_add_block_work(f->step);
  return status;
}
