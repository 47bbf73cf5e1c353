/* Steps, whole or in three parts with the host in between: preparation, the scheme's stages, and the end. */
#include "stepper/stepper.h"
#include "stepper/together.h"
#include "stages/stages.h"
#include "boundary/prescribed.h"
#include "implicit/newmark.h"
#include "layout/members.h"
#include "layout/reached.h"

#include <math.h>

/* ---- beginning ---------------------------------------------------------------------------------------- */
static mpm_status check_dt(mpm_stepper *s, double dt) {
  const double t = s->history.t;
  if (!(dt > 0.0) || !isfinite(dt))
    return mpmi_fail(s->context, MPM_E_ARG, "dt is %g: it must be positive and finite", dt);
  if (!isfinite(t + dt) || t + dt == t)
    return mpmi_fail(s->context, MPM_E_ARG, "dt = %g does not advance the time %g", dt, t);
  const mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (s->mapped)
    return mpmi_fail(s->context, MPM_E_STATE,
                     "%d views of nodal fields are out: release them before stepping", (int)s->mapped);
  return mpmi_motions_are_set(s);
}

/* All parts begin the same step, or none does. */
static mpm_status enter(mpm_stepper *s, mpm_status status, double dt) {
  static const char *const name[] = {"dt", "the time", "the number of the step"};
  const double number[] = {dt, s->history.t, (double)s->history.step};
  if (!status) status = mpmi_together_offers(s);
  return mpmi_together_begin(s, status, 3, name, number);
}

/* Returns 1 for what is done by the time that a step has come to a phase; MPMI_IDLE: to its end. */
static int32_t is_due(int32_t of, int32_t phase) {
  return phase == MPMI_IDLE || (of != MPMI_IDLE && of <= phase);
}

/* Returns how many sums on nodes parts have exchanged when a step has come to this phase. */
static int64_t exchanges_to(const mpm_stepper *s, int32_t phase) {
  if (!mpmi_is_shared(s)) return 0;
  mpmi_parts *parts = s->layout.parts;
  parts->accords_due = 0;
  while (parts->accords_due < parts->accord_count && is_due(parts->accord[parts->accords_due].phase, phase))
    ++parts->accords_due;
  if (mpmi_is_implicit(&s->settings)) return 0; /* there the last vote has counted */
  return mpmi_explicit_exchanges(&s->step, &s->nodes, phase);
}

/* Asks the host whether to go on, and shows it the info that the step is about to have. */
static mpm_status ask_progress(mpm_stepper *s) {
  const mpmi_settings *settings = &s->settings;
  if (!settings->progress) return MPM_OK;
  mpm_step_info info;
  mpmi_fill_info(s, &s->step.info, &info);
  info.t = s->step.t + s->step.dt;
  info.step = s->history.step + 1;
  const mpm_status status = mpmi_from_host(settings->progress(settings->progress_user, &info));
  if (!status) return MPM_OK;
  s->step.failure.callback_status = status;
  return mpmi_fail(s->context, status > 0 ? MPM_CANCELLED : MPM_E_CALLBACK,
                   "the progress callback returned %d in the step from t = %g", (int)status, s->step.t);
}

static void begin(mpm_stepper *s, double dt, int32_t staged) {
  const mpmi_history *history = &s->history;
  const int32_t mean = s->settings.desc.staggered && history->previous_dt > 0.0;
  s->step = (mpmi_step){
      .phase = MPMI_RUNNING,
      .takes = mpmi_takes_in_step(&s->settings, history->step + 1),
      .staged = staged,
      .settings = &s->settings,
      .layout = &s->layout,
      .work = &s->work,
      .profile = &s->profile,
      .pairs = &s->history.pairs,
      .t = history->t,
      .dt = dt,
      .velocity_dt = mean ? 0.5 * (history->previous_dt + dt) : dt,
      .failure = mpmi_no_failure(),
      .ask_progress = ask_progress,
      .vote = mpmi_together_vote,
      .stepper = s,
      /* the nodes are those of the step before until they are counted */
      .info = {.dt = dt, .set = -1, .particle = -1, .node = -1, .active_nodes = history->last.active_nodes}};
  if (s->newton) s->newton->history_count = 0;
  mpmi_reports_clear(&s->work, s->settings.tasks);
  mpmi_time_begin(s->layout.parts);
  if (mpmi_is_shared(s)) {
    s->layout.parts->exchanges = s->layout.parts->is_echo = s->layout.parts->has_counted = 0;
    ++s->layout.parts->steps;
  }
}

/* Brings sets, layout and memory up to date for the step. */
static mpm_status prepare(mpm_stepper *s) {
  const mpmi_settings *settings = &s->settings;
  double clock = mpmi_seconds();
  mpm_status status;
  if ((status = mpmi_state_sums(s, &s->step.failure))) return status;
  status = mpmi_together_refreshed(s, mpmi_members_refresh(&s->layout, settings));
  if (status) return status;
  s->nodes.shown = -1;
  if ((status = mpmi_layout_prepare(&s->layout, settings))) return status;
  if ((status = s->layout.cover_is_old ? mpmi_layout_cover(&s->layout) : MPM_OK) ||
      (status = mpmi_prescribed_prepare(&s->layout, &s->nodes, settings)) ||
      (status = mpmi_workspace_prepare(&s->work, settings, &s->layout)) ||
      (status = mpmi_contact_prepare(&s->layout, settings, &s->nodes.contact, &s->history.pairs)) ||
      (status =
           mpmi_tally_prepare(&s->work.tally, s->context, s->layout.member_count, s->history.pairs.count)) ||
      (status = mpmi_nodes_prepare(&s->nodes, settings, &s->layout, s->step.staged)) ||
      (status = mpmi_member_rows_prepare(&s->work.rows, settings, &s->layout)) ||
      (status = mpmi_surfaces_prepare(settings)) ||
      (status = mpmi_obstacles_begin(&s->step, &s->nodes.contact)))
    return status;
  mpmi_pairs_begin(&s->history.pairs);
  if (mpmi_is_implicit(settings) && !s->newton && (status = mpmi_newton_create(settings, &s->newton)))
    return status;
  mpmi_lap(&s->step, MPMI_TIME_SORT, &clock);
  return MPM_OK;
}

/* The same on all parts. */
static mpm_status prepare_together(mpm_stepper *s) {
  const mpm_status status = mpmi_together_ready(s, prepare(s));
  if (status) return status;
  const mpm_status touching = mpmi_together_touching(s);
  if (mpmi_is_shared(s)) mpmi_explicit_accords(&s->step, &s->nodes);
  return touching;
}

/* Conducts heat, which comes first: all parts go on with the new temperatures, or none does. */
static mpm_status conduct(mpm_stepper *s) {
  const int32_t implicit = s->settings.heat.conduction == MPM_CONDUCTION_IMPLICIT;
  mpm_status status = mpmi_heat_check_dt(&s->step);
  if (status) return status;
  int64_t exchanges = mpmi_heat_exchanges(&s->step, &s->history.heat);
  status = mpmi_heat_begin(&s->step, s->heat, &s->history.heat);
  /* iterations have exchanges of their own, as many on all parts, and so have surfaces that heat */
  const int32_t votes = implicit || mpmi_heat_has_surfaces(&s->settings);
  if (votes && (status = mpmi_together_end(s, status, exchanges))) return status;
  if (!status) status = mpmi_heat_end(&s->step, s->heat, &s->history.heat);
  if (implicit && mpmi_is_shared(s)) exchanges = s->layout.parts->exchanges;
  status = mpmi_together_end(s, status, exchanges);
  if (mpmi_is_shared(s)) s->layout.parts->exchanges = 0;
  return status;
}

/* Begins a step that parts have agreed on, up to what its scheme does. */
static mpm_status set_out(mpm_stepper *s) {
  mpm_status status = mpmi_adaption_begin(s);
  if (!status) status = prepare_together(s);
  if (status || !s->settings.heat.any) return status;
  return conduct(s);
}

/* ---- the end ------------------------------------------------------------------------------------------ */
/* Ends the step, of which this is what the host gets to know. */
static void drop(mpm_stepper *s, mpm_step_info info) {
  s->history.last = info;
  s->step = (mpmi_step){.phase = MPMI_IDLE};
}

/* Leaves particles as they were. The info says why and how far the step came; as it has not been made, it has
 * no energies. */
static mpm_status give_up(mpm_stepper *s, mpm_status status) {
  const mpmi_failure *failure = &s->step.failure;
  const mpm_step_info *came = &s->step.info;
  mpmi_roll_back(s);
  drop(s, (mpm_step_info){.cause = status,
                          .callback_status = failure->callback_status,
                          .set = failure->set,
                          .particle = failure->particle,
                          .node = failure->node,
                          .body = failure->body,
                          .dt = came->dt,
                          .dt_suggested = 0.6 * came->dt,
                          .active_nodes = came->active_nodes,
                          .newton_iterations = came->newton_iterations,
                          .linear_solver = came->linear_solver,
                          .linear_iterations = came->linear_iterations,
                          .residual = came->residual});
  return status;
}

static mpm_status finish(mpm_stepper *s) {
  const double velocity_dt = s->step.velocity_dt;
  mpm_status status = MPM_OK;
  if (s->settings.surfaces.count && !mpmi_is_implicit(&s->settings))
    status = mpmi_together(s, mpmi_explicit_move_surfaces(&s->step, &s->nodes));
  if (!status) status = mpmi_obstacles_end(&s->step, &s->nodes.contact);
  if (status) return status;
  mpmi_stops_report(&s->step);
  mpmi_sums sums;
  if ((status = mpmi_adaption_prepare(s))) { /* on all parts */
    const mpm_status lost = mpmi_is_shared(s) ? mpmi_together_active(s) : MPM_OK;
    return lost ? lost : status;
  }
  if ((status = mpmi_add_up(s, &sums))) return status;
  status = ask_progress(s);
  if (mpmi_is_shared(s) && s->layout.parts->asks) status = mpmi_together_ready(s, status);
  if (status) return status;
  mpmi_commit(s, &sums);
  mpmi_contact_warn(s);
  mpmi_stability_warn(s);
  /* a removal leaves sums to be made anew; if the law refuses then, the next call that needs them says so */
  if (!s->history.has_sums && mpmi_state_sums(s, NULL)) mpmi_forget(s->context);
  mpm_step_info info = s->step.info;
  if (mpmi_is_implicit(&s->settings))
    info.dt_suggested = mpmi_next_dt(info.newton_iterations, info.dt);
  else if (mpmi_stable_dt(s, &info.dt_suggested))
    mpmi_forget(s->context); /* the other parts are lost, as the next call will say */
  drop(s, info);
  mpmi_adaption_carry_out(s); /* sums are those of the step until somebody asks for those of the state */
  s->nodes.shown = s->layout.version;
  s->nodes.shown_dt = velocity_dt;
  mpmi_time_add(s->layout.parts);
  return MPM_OK;
}

/* ---- short steps -------------------------------------------------------------------------------------- */
static double begin_pace(mpm_stepper *s) {
  s->context->pool_rests = s->pace.is_short;
  return s->context->pool ? mpmi_seconds() : 0.0;
}

static void end_pace(mpm_stepper *s, double begun) {
  s->context->pool_rests = 0;
  if (!s->context->pool) return;
  mpmi_pace *pace = &s->pace;
  const int32_t is_short = mpmi_seconds() - begun < pace->bound;
  if (!pace->is_short) {
    if (is_short && --pace->left <= 0) pace->is_short = 1; /* the next step shows whether it is */
    return;
  }
  const int32_t longer = 2 * pace->wait < MPMI_MOST_STEPS ? 2 * pace->wait : MPMI_MOST_STEPS;
  pace->wait = is_short ? MPMI_SHORT_STEPS : longer;
  pace->left = pace->wait;
  pace->is_short = is_short;
}

/* ---- whole steps -------------------------------------------------------------------------------------- */
/* Brings particles to the nodes. Only all parts together know whether nodes take the loads of markers. */
static mpm_status begin_explicit(mpm_stepper *s) {
  mpm_status status = mpmi_explicit_begin(&s->step, &s->nodes);
  if (s->step.staged || s->settings.surfaces.count)
    status = mpmi_together_end(s, status, exchanges_to(s, MPMI_BEGUN));
  return status ? status : mpmi_surfaces_carried(&s->step);
}

static mpm_status run_explicit(mpm_stepper *s) {
  mpm_status status = begin_explicit(s);
  if (!status) status = mpmi_explicit_grid(&s->step, &s->nodes);
  return status ? status : mpmi_explicit_end(&s->step, &s->nodes);
}

static mpm_status run_implicit(mpm_stepper *s) {
  mpmi_balance balance = {.step = &s->step,
                          .settings = &s->settings,
                          .layout = &s->layout,
                          .nodes = &s->nodes,
                          .newton = s->newton};
  return mpmi_newmark_step(&balance);
}

static mpm_status make_step(mpm_stepper *s, double dt, int32_t is_cut) {
  begin(s, dt, 0);
  s->step.is_cut = is_cut;
  mpm_status status = set_out(s);
  if (!status) {
    status = mpmi_is_implicit(&s->settings) ? run_implicit(s) : run_explicit(s);
    status = mpmi_together_end(s, status, exchanges_to(s, MPMI_IDLE));
  }
  if (!status) status = finish(s);
  if (status) return give_up(s, status);
  mpmi_forget(s->context); /* drops the texts of failed attempts */
  return MPM_OK;
}

mpm_status mpmi_make_step(mpm_stepper *s, mpm_status status, double dt, int32_t is_cut) {
  status = enter(s, status ? status : check_dt(s, dt), dt);
  if (status) return status;
  const double begun = begin_pace(s);
  status = make_step(s, dt, is_cut);
  end_pace(s, begun);
  return status;
}

mpm_status mpm_step(mpm_stepper *s, double dt, mpm_step_info *info) {
  MPMI_ENTER(s, MPMI_STEPPER);
  const mpm_status bad = mpmi_check_info(s, info), status = mpmi_make_step(s, bad, dt, 0);
  return bad ? status : mpmi_give_info(s, status, info);
}

/* ---- steps in parts ----------------------------------------------------------------------------------- */
mpm_status mpm_step_begin(mpm_stepper *s, double dt) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = enter(s, check_dt(s, dt), dt);
  if (status) return status;
  if (mpmi_is_implicit(&s->settings))
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "scheme MPM_NEWMARK has no steps in parts: use mpm_step, or an explicit scheme");
  begin(s, dt, 1);
  status = set_out(s);
  if (!status) status = begin_explicit(s);
  if (status) return give_up(s, status);
  /* until the end the host sees the old state */
  if (mpmi_deforms_first(&s->settings)) mpmi_make_volumes(&s->layout, 0);
  s->step.phase = MPMI_BEGUN;
  return MPM_OK;
}

static mpm_status in_phase(mpm_stepper *s, int32_t phase, const char *call, const char *before) {
  if (s->step.phase != phase) return mpmi_fail(s->context, MPM_E_STATE, "%s must follow %s", call, before);
  if (s->mapped)
    return mpmi_fail(s->context, MPM_E_STATE, "%d views of nodal fields are out: release them before %s",
                     (int)s->mapped, call);
  return mpmi_members_unmapped(&s->layout, &s->settings, "before the step goes on");
}

mpm_status mpm_step_grid(mpm_stepper *s) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_together(s, in_phase(s, MPMI_BEGUN, "mpm_step_grid", "mpm_step_begin"));
  if (status) return status;
  mpmi_time_begin(s->layout.parts);
  s->step.phase = MPMI_RUNNING;
  status = mpmi_places_check(&s->step);
  if (!status) status = mpmi_explicit_grid(&s->step, &s->nodes);
  status = mpmi_together_end(s, status, exchanges_to(s, MPMI_SOLVED));
  if (status) return give_up(s, status);
  s->step.phase = MPMI_SOLVED;
  return MPM_OK;
}

mpm_status mpm_step_end(mpm_stepper *s, mpm_step_info *info) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = in_phase(s, MPMI_SOLVED, "mpm_step_end", "mpm_step_grid");
  if (!status) status = mpmi_check_info(s, info);
  if ((status = mpmi_together(s, status))) return status;
  mpmi_time_begin(s->layout.parts);
  s->step.phase = MPMI_RUNNING;
  if (mpmi_deforms_first(&s->settings)) mpmi_make_volumes(&s->layout, 1);
  status = mpmi_places_check(&s->step);
  if (!status) status = mpmi_explicit_end(&s->step, &s->nodes);
  status = mpmi_together_end(s, status, exchanges_to(s, MPMI_IDLE));
  if (!status) status = finish(s);
  return mpmi_give_info(s, status ? give_up(s, status) : MPM_OK, info);
}

mpm_status mpm_step_abort(mpm_stepper *s) {
  MPMI_ENTER(s, MPMI_STEPPER);
  if (s->step.phase != MPMI_BEGUN && s->step.phase != MPMI_SOLVED)
    return mpmi_fail(s->context, MPM_E_STATE, "no step is under way");
  if (s->mapped)
    return mpmi_fail(s->context, MPM_E_STATE,
                     "%d views of nodal fields are out: release them before mpm_step_abort", (int)s->mapped);
  mpmi_roll_back(s);
  s->step = (mpmi_step){.phase = MPMI_IDLE};
  return MPM_OK;
}
