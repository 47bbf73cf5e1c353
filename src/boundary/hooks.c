/* Node hooks: the host reads and changes nodal velocities and forces at a stage of the step.
 *
 * All stages run after the nodes have been updated and ties folded, because both are linear: there a node has
 * its updated velocity v~ and the increment dv, hence the projected velocity v = v~ - dv and the force m dv /
 * dt. A change of force changes dv and v~ alike; a change of v changes v~ alone; a change of v~ is an impulse
 * and changes both. Each is laid on every node of the tie, as if the host had written there: so it is no
 * reaction of the constraint. */
#include "boundary/bound.h"

#include <math.h>
#include <string.h>

typedef struct hook_job {
  mpmi_bound *bound;
  int32_t stage;
} hook_job;

/* Holds what a hook is shown, and what it leaves. */
typedef struct hook_values {
  double shown[2][3 * MPMI_NODE_BATCH], velocity[3 * MPMI_NODE_BATCH], force[3 * MPMI_NODE_BATCH];
} hook_values;

/* Changes v~ and dv of a free node with its tie; what particles take of that is the hook's impulse. */
static void shift(mpmi_bound *bound, int64_t slot, int32_t c, double velocity, double increment) {
  const double given = mpmi_shift_node(bound, slot, c, velocity, increment);
  bound->nodes->hook_impulse[slot][c] += mpmi_moving_mass(bound, slot) * given;
}

static void show_node(const hook_job *job, const mpmi_node_list *list, int64_t i, hook_values *values) {
  mpmi_bound *bound = job->bound;
  for (int32_t c = 0; c < bound->dim; ++c) {
    const int64_t at = c * MPMI_NODE_BATCH + i;
    const double v = mpmi_velocity(bound->values, list->slot[i])[c];
    const double dv = mpmi_increment(bound->values, list->slot[i])[c];
    values->shown[0][at] = job->stage == MPM_AFTER_VELOCITY ? v : v - dv;
    values->shown[1][at] = job->stage == MPM_AFTER_P2G ? 0.0 : list->mass[i] * dv / bound->step->velocity_dt;
  }
}

/* Adds what the hook has changed: values left alone change no bit. */
static void take_node(const hook_job *job, const mpmi_node_list *list, int64_t i, const hook_values *values) {
  mpmi_bound *bound = job->bound;
  for (int32_t c = 0; c < bound->dim; ++c) {
    const int64_t at = c * MPMI_NODE_BATCH + i, slot = list->slot[i];
    const double change = values->velocity[at] - values->shown[0][at];
    const double force = values->force[at] - values->shown[1][at];
    if (job->stage == MPM_AFTER_VELOCITY) {
      if (change != 0.0) shift(bound, slot, c, change, change);
      continue;
    }
    const double gained = force * bound->step->velocity_dt / list->mass[i];
    if (change != 0.0 || force != 0.0) shift(bound, slot, c, change + gained, gained);
  }
}

static int32_t is_finite(const hook_job *job, int64_t i, const hook_values *values) {
  for (int32_t c = 0; c < job->bound->dim; ++c) {
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
  const mpmi_settings *settings = job->bound->step->settings;
  const int32_t h = job->stage - MPM_AFTER_P2G;
  if (!mpmi_list_nodes(job->bound, block, list)) return;
  hook_values values = {{{0.0}}, {0.0}, {0.0}};
  for (int64_t i = 0; i < list->n; ++i) show_node(job, list, i, &values);
  memcpy(values.velocity, values.shown[0], sizeof values.velocity);
  memcpy(values.force, values.shown[1], sizeof values.force);
  const mpm_status status =
      mpmi_from_host(settings->hook[h](settings->hook_user[h], &list->batch, values.velocity, values.force));
  if (status) {
    mpmi_failure_take(failure, mpmi_callback_failure(status, -1, what[h]));
    return;
  }
  for (int64_t i = 0; i < list->n; ++i)
    if (!is_finite(job, i, &values)) mpmi_bad_node(job->bound, list, i, bad[h], failure);
  if (failure->cause) return;
  for (int64_t i = 0; i < list->n; ++i) take_node(job, list, i, &values);
}

static void hook_task(void *data, int64_t k) {
  const hook_job *job = data;
  const mpmi_step *step = job->bound->step;
  const mpmi_share share = mpmi_share_of(step->settings, step->layout->blocks.count, k);
  mpmi_node_list list;
  for (int64_t b = share.begin; b < share.end; ++b) call_hook(job, b, &list, &step->work->report[k].failure);
}

mpm_status mpmi_hooks_run(mpmi_bound *bound, int32_t stage) {
  const mpmi_settings *settings = bound->step->settings;
  hook_job job = {bound, stage};
  if (!settings->hook[stage - MPM_AFTER_P2G]) return MPM_OK;
  const mpm_status status = mpmi_run_tasks(settings, 1, settings->tasks, hook_task, &job);
  return status ? status : mpmi_step_failure(bound->step);
}

/* Adds up the hooks' work: impulse times the velocity of the node in the step. */
static void work_task(void *data, int64_t k) {
  mpmi_bound *bound = data;
  const mpmi_share share = mpmi_share_of(bound->step->settings, mpmi_slots(bound->step->layout), k);
  for (int64_t slot = share.begin; slot < share.end; ++slot) {
    double work = 0.0;
    for (int32_t c = 0; c < bound->dim; ++c)
      work += bound->nodes->hook_impulse[slot][c] * mpmi_velocity(bound->values, slot)[c];
    if (!mpmi_owns_node(bound->step->layout->parts, slot)) continue;
    mpmi_exact_add(&bound->step->work->report[k].host_work, work);
  }
}

static void forget_task(void *data, int64_t k) {
  mpmi_bound *bound = data;
  mpmi_clear_share(bound->step->settings, (double *)bound->nodes->hook_impulse,
                   mpmi_slots(bound->step->layout), 3, k);
}

mpm_status mpmi_hooks_begin(mpmi_bound *bound) {
  return mpmi_has_hooks(bound->step->settings) ? mpmi_run_bound(bound, forget_task) : MPM_OK;
}

mpm_status mpmi_hooks_end(mpmi_bound *bound) {
  if (!mpmi_has_hooks(bound->step->settings)) return MPM_OK;
  return mpmi_run_bound(bound, work_task);
}
