/* One step. Explicit: USL, USF and MUSL (table in docs/theory.md), whole or in three parts with the host in
 * between; implicit ones are those of newmark.c. */
#include "stepper/newton.h"

#include <math.h>

mpm_status mpmi_run_tasks(mpm_stepper *s, int32_t calls_host, int64_t count, mpm_task_fn task, void *data) {
  const mpm_context *c = s->context;
  if (count > 1 && !(calls_host && (c->host.serial_callbacks || c->concurrency == 1)))
    return mpmi_parallel_for(s->context, count, task, data);
  for (int64_t k = 0; k < count; ++k) task(data, k);
  return MPM_OK;
}

/* Anew, where folding has moved mass between nodes. */
static void count_active(mpm_stepper *s) {
  const int64_t slots = s->blocks.count * s->blocks.nodes;
  s->last.active_nodes = 0;
  for (int64_t i = 0; i < slots; ++i) s->last.active_nodes += s->node[i * s->values + 3] > s->mass_cut;
}

/* A projection beside the one with the forces of the step, up to its boundary conditions. */
static mpm_status project(mpm_stepper *s, int32_t projection, double dt, double *clock) {
  mpm_status status = mpmi_stage_p2g(s, projection);
  mpmi_lap(s, MPMI_TIME_P2G, clock);
  if (!status) status = mpmi_stage_nodes(s, projection);
  if (!status) status = mpmi_stage_boundary(s, projection, dt, 0.0);
  mpmi_lap(s, MPMI_TIME_GRID, clock);
  return status;
}

static mpm_status gather(mpm_stepper *s, int32_t what, const double *nodes, int32_t values, double dt,
                         double *clock) {
  mpm_status status = MPM_OK;
  if (s->desc.locking_remedy && (what & MPMI_G2P_DEFORM)) status = mpmi_stage_locking(s, nodes, values, dt);
  if (!status) status = mpmi_stage_g2p(s, what, nodes, values, dt);
  mpmi_lap(s, MPMI_TIME_G2P, clock);
  return status;
}

/* USF: strain and stress from the velocities at the start of the step. */
static mpm_status strain_first(mpm_stepper *s, double dt, double *clock) {
  mpm_status status = MPM_OK;
  if (s->constraints.contact_count) status = project(s, MPMI_PROJECT_TOUCH, dt, clock);
  if (!status) status = project(s, MPMI_PROJECT_STRAIN, dt, clock);
  return status ? status : gather(s, MPMI_G2P_DEFORM, s->again, 4, dt, clock);
}

/* Up to date sets and topology; nothing known of the step yet. */
static mpm_status start(mpm_stepper *s, double dt, double *clock) {
  mpm_status status = mpmi_stepper_energies(s);
  if (!status) status = mpmi_stepper_prepare(s);
  if (status) return status;
  mpmi_lap(s, MPMI_TIME_SORT, clock);
  s->dt = dt;
  s->velocity_dt = s->desc.staggered && s->previous_dt > 0.0 ? 0.5 * (s->previous_dt + dt) : dt;
  s->nodes_valid = 0;
  s->prescribed_work = 0.0;
  s->last.newton_iterations = s->last.linear_solver = 0;
  s->last.linear_iterations = 0;
  s->last.residual = 0.0;
  mpmi_failure_clear(&s->failure);
  for (int32_t k = 0; k < s->tasks; ++k) {
    mpmi_failure_clear(&s->scratch[k].failure);
    s->scratch[k].left_tile = s->scratch[k].removes = s->scratch[k].holes_restored = 0;
    s->scratch[k].law_seconds = s->scratch[k].weights_seconds = 0.0;
  }
  for (int32_t f = 0; f < 6; ++f)
    for (int32_t c = 0; c < 3; ++c) s->impulse_in_step[f][c] = 0.0;
  return MPM_OK;
}

/* Particles to grid, and forces. */
static mpm_status begin_part(mpm_stepper *s, double dt) {
  double clock = mpmi_seconds();
  mpm_status status = start(s, dt, &clock);
  if (status) return status;
  status = mpmi_stage_forces(s, s->t, dt);
  if (!status) status = mpmi_stage_motion(s, dt);
  mpmi_lap(s, MPMI_TIME_CALLBACKS, &clock);
  if (!status && s->desc.scheme == MPM_USF) status = strain_first(s, dt, &clock);
  if (!status) status = mpmi_stage_p2g(s, MPMI_PROJECT_FORCES);
  mpmi_lap(s, MPMI_TIME_P2G, &clock);
  return status;
}

/* Velocities, walls, prescribed velocities. */
static mpm_status grid_part(mpm_stepper *s, double dt) {
  double clock = mpmi_seconds();
  mpm_status status = mpmi_stage_nodes(s, MPMI_PROJECT_FORCES);
  if (!status) status = mpmi_stage_boundary(s, MPMI_PROJECT_FORCES, dt, 1.0);
  if (!status && s->constraints.tie_count) count_active(s);
  mpmi_lap(s, MPMI_TIME_GRID, &clock);
  return status;
}

/* USL: everything from the updated nodal velocity. MUSL: L from the velocity that the new particles give the
 * nodes. USF has its strain already. */
static mpm_status particles_part(mpm_stepper *s, double dt) {
  double clock = mpmi_seconds();
  const int32_t usl = s->desc.scheme == MPM_USL, musl = s->desc.scheme == MPM_MUSL;
  mpm_status status = mpmi_corrects(s) ? mpmi_stage_xpic(s) : MPM_OK;
  if (!status)
    status = gather(s, MPMI_G2P_MOVE | (usl ? MPMI_G2P_DEFORM : 0), s->node, s->values, dt, &clock);
  if (!status && musl) status = project(s, MPMI_PROJECT_AGAIN, dt, &clock);
  if (!status && musl) status = gather(s, MPMI_G2P_DEFORM, s->again, 4, dt, &clock);
  mpmi_book_samples(s, MPMI_TIME_G2P);
  return status;
}

static void note_failure(mpm_stepper *s, mpm_status status) {
  s->last.cause = status;
  s->last.dt = s->dt;
  s->last.dt_suggested = 0.6 * s->dt;
  s->last.callback_status = s->failure.callback_status;
  s->last.set = s->failure.set;
  s->last.particle = s->failure.particle;
  s->last.node = s->failure.node;
  s->last.external_work = s->last.dissipation = 0.0;
}

static void note_success(mpm_stepper *s) {
  s->last.cause = MPM_OK;
  s->last.dt = s->dt;
  s->last.callback_status = 0;
  s->last.set = -1;
  s->last.particle = s->last.node = -1;
}

/* The host may still cancel: it sees the info that the step is about to have. */
static mpm_status ask_progress(mpm_stepper *s) {
  if (!s->progress) return MPM_OK;
  mpm_step_info info;
  mpmi_fill_info(s, &info);
  info.t = s->t + s->dt;
  info.dt = s->dt;
  info.step = s->step + 1;
  const mpm_status status = s->progress(s->progress_user, &info);
  if (!status) return MPM_OK;
  s->failure.callback_status = status;
  return mpmi_fail(s->context, status > 0 ? MPM_CANCELLED : MPM_E_CALLBACK,
                   "the progress callback returned %d in the step from t = %g", (int)status, s->t);
}

static mpm_status finish(mpm_stepper *s, double dt) {
  const mpm_status status = ask_progress(s);
  if (status) return status;
  note_success(s);
  mpmi_commit(s, dt);
  /* a removal leaves the sums to be made again; then the host's law may refuse, which is for the next call to
   * say */
  if (!s->energies.valid && mpmi_stepper_energies(s)) s->context->error[0] = '\0';
  s->last.dt_suggested = mpmi_is_implicit(s) ? mpmi_next_dt(s, dt) : mpmi_stable_dt_of(s, &s->energies.sums);
  s->nodes_valid = 1;
  s->nodes_dt = s->velocity_dt;
  return MPM_OK;
}

static mpm_status checked_dt(mpm_stepper *s, double dt) {
  if (!(dt > 0.0) || !isfinite(dt))
    return mpmi_fail(s->context, MPM_E_ARG, "dt is %g: it must be positive and finite", dt);
  if (!isfinite(s->t + dt) || s->t + dt == s->t)
    return mpmi_fail(s->context, MPM_E_ARG, "dt = %g does not advance the time %g", dt, s->t);
  if (s->phase != MPMI_IDLE)
    return mpmi_fail(s->context, MPM_E_STATE, "a step is under way: end or abort it first");
  if (s->mapped)
    return mpmi_fail(s->context, MPM_E_STATE,
                     "%d views of nodal fields are out: release them before stepping", (int)s->mapped);
  return MPM_OK;
}

/* Whatever has gone wrong: the particles are as before, the info says why. */
static mpm_status give_up(mpm_stepper *s, mpm_status status) {
  mpmi_roll_back(s);
  note_failure(s, status);
  s->phase = MPMI_IDLE;
  return status;
}

static mpm_status explicit(mpm_stepper *s, double dt) {
  mpm_status status = begin_part(s, dt);
  if (!status) status = grid_part(s, dt);
  return status ? status : particles_part(s, dt);
}

static mpm_status implicit(mpm_stepper *s, double dt) {
  double clock = mpmi_seconds();
  const mpm_status status = start(s, dt, &clock);
  return status ? status : mpmi_newmark_step(s, dt);
}

mpm_status mpmi_step(mpm_stepper *s, double dt) {
  mpm_status status = checked_dt(s, dt);
  if (status) return status;
  s->phase = MPMI_RUNNING;
  s->dt = dt;
  s->staged = 0;
  mpmi_failure_clear(&s->failure);
  status = mpmi_is_implicit(s) ? implicit(s, dt) : explicit(s, dt);
  if (!status) status = finish(s, dt);
  if (status) return give_up(s, status);
  s->context->error[0] = '\0'; /* of attempts before */
  s->phase = MPMI_IDLE;
  return MPM_OK;
}

static mpm_status give_info(mpm_stepper *s, mpm_status status, mpm_step_info *info) {
  if (!info) return status;
  mpm_step_info now;
  mpmi_fill_info(s, &now);
  now.cause = status;
  const mpm_status written = mpmi_write_struct(s->context, "mpm_step_info", &now, sizeof now, info);
  return status ? status : written;
}

/* Writing the info must not be what fails a step that is done. */
static mpm_status check_info(mpm_stepper *s, const mpm_step_info *info) {
  return info ? mpmi_check_out_struct(s->context, "mpm_step_info", sizeof *info, info) : MPM_OK;
}

mpm_status mpm_step(mpm_stepper *s, double dt, mpm_step_info *info) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = check_info(s, info);
  if (status) return status;
  status = mpmi_step(s, dt);
  return give_info(s, status, info);
}

mpm_status mpm_step_begin(mpm_stepper *s, double dt) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = checked_dt(s, dt);
  if (status) return status;
  if (mpmi_is_implicit(s))
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "scheme MPM_NEWMARK has no steps in parts: use mpm_step, or an explicit scheme");
  s->phase = MPMI_RUNNING;
  s->dt = dt;
  s->staged = 1;
  mpmi_failure_clear(&s->failure);
  status = begin_part(s, dt);
  if (status) return give_up(s, status);
  if (s->desc.scheme == MPM_USF) mpmi_make_volumes(s, 0); /* until the end the host sees the old state */
  s->phase = MPMI_BEGUN;
  return MPM_OK;
}

static mpm_status in_phase(mpm_stepper *s, int32_t phase, const char *call, const char *before) {
  if (s->phase != phase) return mpmi_fail(s->context, MPM_E_STATE, "%s must follow %s", call, before);
  if (s->mapped)
    return mpmi_fail(s->context, MPM_E_STATE, "%d views of nodal fields are out: release them before %s",
                     (int)s->mapped, call);
  for (int32_t m = 0; m < s->member_count; ++m)
    if (s->member[m].set->mapped)
      return mpmi_fail(s->context, MPM_E_STATE, "set %d is mapped: release its views before %s", (int)m,
                       call);
  return MPM_OK;
}

mpm_status mpm_step_grid(mpm_stepper *s) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = in_phase(s, MPMI_BEGUN, "mpm_step_grid", "mpm_step_begin");
  if (status) return status;
  s->phase = MPMI_RUNNING;
  status = grid_part(s, s->dt);
  if (status) return give_up(s, status);
  s->phase = MPMI_SOLVED;
  return MPM_OK;
}

mpm_status mpm_step_end(mpm_stepper *s, mpm_step_info *info) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = in_phase(s, MPMI_SOLVED, "mpm_step_end", "mpm_step_grid");
  if (!status) status = check_info(s, info);
  if (status) return status;
  s->phase = MPMI_RUNNING;
  if (s->desc.scheme == MPM_USF) mpmi_make_volumes(s, 1);
  status = particles_part(s, s->dt);
  if (!status) status = finish(s, s->dt);
  if (status) {
    give_up(s, status);
  } else {
    s->phase = MPMI_IDLE;
  }
  return give_info(s, status, info);
}

mpm_status mpm_step_abort(mpm_stepper *s) {
  MPMI_ENTER(s, MPMI_STEPPER);
  if (s->phase != MPMI_BEGUN && s->phase != MPMI_SOLVED)
    return mpmi_fail(s->context, MPM_E_STATE, "no step is under way");
  if (s->mapped)
    return mpmi_fail(s->context, MPM_E_STATE,
                     "%d views of nodal fields are out: release them before mpm_step_abort", (int)s->mapped);
  mpmi_roll_back(s);
  s->phase = MPMI_IDLE;
  s->nodes_valid = 0;
  return MPM_OK;
}
