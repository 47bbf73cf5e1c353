/* Node hooks: the host reads and changes nodal velocities and forces at a stage of the step.
 *
 * All stages run after the nodes have been updated and ties folded, because both are linear: there a node
 * has its updated velocity v~ and the increment dv, hence the projected velocity v = v~ - dv and the force m
 * dv / dt. A change of force is one of dv and v~; a change of v is one of v~; a change of v~ is an impulse,
 * one of both. It is laid on every node of the tie, as if the host had written there: so it is no reaction
 * of the constraint. */
#include "stepper/node_batch.h"

#include <math.h>
#include <string.h>

typedef struct hook_job {
  const mpmi_boundary *f;
  int32_t stage;
} hook_job;

/* Velocity and force on both sides of the call. */
typedef struct hook_values {
  double shown[2][3 * MPMI_NODE_BATCH], velocity[3 * MPMI_NODE_BATCH], force[3 * MPMI_NODE_BATCH];
} hook_values;

static void shift_node(const mpmi_boundary *f, int64_t slot, int32_t c, double velocity, double increment) {
  double *node = mpmi_node_at(f, slot);
  node[c] += velocity;
  node[4 + c] += increment;
}

/* Changes v~ and dv of a free node with its tie; what particles take of that is the hook's impulse. */
static void shift(const mpmi_boundary *f, int64_t slot, int32_t c, double velocity, double increment) {
  const mpmi_constraints *constraints = &f->s->constraints;
  const int32_t at = constraints->tie_of[slot];
  const double given = f->flip * increment + (1.0 - f->flip) * velocity;
  f->s->hook_impulse[3 * slot + c] += mpmi_moving_mass(f, slot) * given;
  shift_node(f, slot, c, velocity, increment);
  if (at < 0) return;
  mpmi_tie_state *state = mpmi_tie_state_of(f, at);
  state->before[c] += given;
  state->increment[c] += increment;
  for (int64_t d = 0; d < constraints->tie[at].count; ++d) {
    const mpmi_follower *follower = &constraints->follower[constraints->tie[at].first + d];
    shift_node(f, follower->slot, c, follower->sign[c] * velocity, follower->sign[c] * increment);
  }
}

static void show_node(const hook_job *job, const mpmi_node_list *list, int64_t i, hook_values *values) {
  const mpmi_boundary *f = job->f;
  for (int32_t c = 0; c < f->dim; ++c) {
    const double *node = mpmi_node_at(f, list->slot[i]);
    const int64_t at = c * MPMI_NODE_BATCH + i;
    values->shown[0][at] = job->stage == MPM_AFTER_VELOCITY ? node[c] : node[c] - node[4 + c];
    values->shown[1][at] =
        job->stage == MPM_AFTER_P2G ? 0.0 : list->mass[i] * node[4 + c] / f->s->velocity_dt;
  }
}

/* What was written, against what was shown: values that are not touched leave every bit of the node. */
static void take_node(const hook_job *job, const mpmi_node_list *list, int64_t i, const hook_values *values) {
  const mpmi_boundary *f = job->f;
  for (int32_t c = 0; c < f->dim; ++c) {
    const int64_t at = c * MPMI_NODE_BATCH + i, slot = list->slot[i];
    const double change = values->velocity[at] - values->shown[0][at];
    const double force = values->force[at] - values->shown[1][at];
    if (job->stage == MPM_AFTER_VELOCITY) {
      if (change != 0.0) shift(f, slot, c, change, change);
      continue;
    }
    const double gained = force * f->s->velocity_dt / list->mass[i];
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
  const mpm_stepper *s = job->f->s;
  const int32_t h = job->stage - MPM_AFTER_P2G;
  if (!mpmi_list_nodes(job->f, block, list)) return;
  hook_values values = {{{0.0}}, {0.0}, {0.0}};
  for (int64_t i = 0; i < list->n; ++i) show_node(job, list, i, &values);
  memcpy(values.velocity, values.shown[0], sizeof values.velocity);
  memcpy(values.force, values.shown[1], sizeof values.force);
  const mpm_status status = s->hook[h](s->hook_user[h], &list->batch, values.velocity, values.force);
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
  const mpm_stepper *s = job->f->s;
  mpmi_node_list list;
  for (int64_t b = mpmi_first_block(s, k); b < mpmi_first_block(s, k + 1); ++b)
    call_hook(job, b, &list, &s->scratch[k].failure);
}

mpm_status mpmi_run_hook(const mpmi_boundary *f, int32_t stage) {
  mpm_stepper *s = f->s;
  hook_job job = {f, stage};
  if (!s->hook[stage - MPM_AFTER_P2G]) return MPM_OK;
  const mpm_status status = mpmi_run_tasks(s, 1, s->tasks, hook_task, &job);
  return status ? status : mpmi_stepper_failure(s);
}

/* Like that of every external force: impulse times the velocity with which the node moves in the step. */
static void work_task(void *data, int64_t k) {
  const mpmi_boundary *f = data;
  mpm_stepper *s = f->s;
  for (int64_t b = mpmi_first_block(s, k); b < mpmi_first_block(s, k + 1); ++b) {
    double work = 0.0;
    for (int64_t slot = b * s->blocks.nodes; slot < (b + 1) * s->blocks.nodes; ++slot)
      for (int32_t c = 0; c < f->dim; ++c) work += s->hook_impulse[3 * slot + c] * mpmi_node_at(f, slot)[c];
    s->block_work[b] = work;
  }
}

static void forget_task(void *data, int64_t k) {
  mpm_stepper *s = data;
  const int64_t begin = 3 * s->blocks.nodes * mpmi_first_block(s, k);
  const int64_t end = 3 * s->blocks.nodes * mpmi_first_block(s, k + 1);
  if (end > begin) memset(s->hook_impulse + begin, 0, (size_t)(end - begin) * sizeof *s->hook_impulse);
}

mpm_status mpmi_hooks_begin(mpm_stepper *s) {
  return mpmi_has_hooks(s) ? mpmi_run_tasks(s, 0, s->tasks, forget_task, s) : MPM_OK;
}

mpm_status mpmi_hooks_end(const mpmi_boundary *f) {
  mpm_stepper *s = f->s;
  if (!mpmi_has_hooks(s)) return MPM_OK;
  const mpm_status status = mpmi_run_tasks(s, 0, s->tasks, work_task, (void *)(uintptr_t)f);
  if (!status) mpmi_add_block_work(s);
  return status;
}

mpm_status mpmi_hooks_prepare(mpm_stepper *s) {
  if (!mpmi_has_hooks(s)) return MPM_OK;
  return mpmi_reserve_roomy(s->context, (void **)&s->hook_impulse, &s->hook_impulse_capacity,
                            3 * s->blocks.count * s->blocks.nodes, sizeof *s->hook_impulse);
}

void mpmi_hooks_free(mpm_stepper *s) {
  mpmi_free(s->context, s->hook_impulse, mpmi_bytes(s->hook_impulse_capacity, sizeof *s->hook_impulse));
}

mpm_status mpm_stepper_set_node_hook(mpm_stepper *s, int32_t stage, mpm_node_fn fn, void *user) {
  MPMI_ENTER(s, MPMI_STEPPER);
  const mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (stage < MPM_AFTER_P2G || stage > MPM_AFTER_VELOCITY)
    return mpmi_fail(s->context, MPM_E_ARG, "stage is %d: it must be an MPM_AFTER_P2G ... MPM_AFTER_VELOCITY",
                     (int)stage);
  if (fn && mpmi_is_implicit(s))
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "scheme MPM_NEWMARK has no node hooks: use force and velocity callbacks, or an explicit "
                     "scheme");
  s->hook[stage - MPM_AFTER_P2G] = fn;
  s->hook_user[stage - MPM_AFTER_P2G] = user;
  return MPM_OK;
}
