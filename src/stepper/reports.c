/* What a stepper reports: the info of the state and of the last step, reactions, where the time went. */
#include "context/structs.h"
#include "stepper/together.h"
#include "implicit/balance.h"
#include "layout/members.h"

#include <string.h>

/* ---- to its sets and obstacles ------------------------------------------------------------------------- */
static int32_t in_step(const mpm_stepper *s) {
  return s->step.phase != MPMI_IDLE;
}

static double present_time(const mpm_stepper *s) {
  return s->history.t;
}

static int32_t has_markers(const mpm_stepper *s) {
  int64_t markers = 0;
  for (int64_t i = 0; i < s->settings.surfaces.count; ++i)
    markers += s->settings.surfaces.surface[i]->now.count;
  return markers > 0;
}

const mpmi_owner mpmi_stepper_owns = {in_step, present_time, has_markers};

/* ---- info --------------------------------------------------------------------------------------------- */
void mpmi_fill_info(const mpm_stepper *s, const mpm_step_info *last, mpm_step_info *info) {
  const int32_t rings = mpmi_is_axisymmetric(s->grid);
  const mpmi_sums *sums = &s->history.sums;
  *info = *last;
  info->struct_size = sizeof *info;
  info->step = s->history.step;
  info->removed = s->history.removed;
  info->resorts = s->layout.sorts;
  info->t = s->history.t;
  info->external_work_total = s->history.totals.external_work;
  info->damping_dissipation_total = s->history.totals.damping_dissipation;
  info->kinetic_energy = sums->kinetic;
  info->affine_kinetic_energy = sums->affine;
  info->strain_energy = sums->strain;
  for (int32_t k = 0; k < 3; ++k) {
    /* around the axis the momenta along radii sum to nothing */
    info->momentum[k] = rings && k == 0 ? 0.0 : sums->momentum[k];
    info->angular_momentum[k] = rings ? 0.0 : sums->angular[k];
  }
}

mpm_status mpmi_give_info(const mpm_stepper *s, mpm_status status, mpm_step_info *info) {
  if (!info) return status;
  mpm_step_info now;
  mpmi_fill_info(s, &s->history.last, &now);
  now.cause = status;
  const mpm_status written = mpmi_write_struct(s->context, "mpm_step_info", &now, sizeof now, info);
  return status ? status : written;
}

mpm_status mpmi_check_info(const mpm_stepper *s, const mpm_step_info *info) {
  return info ? mpmi_check_out_struct(s->context, "mpm_step_info", sizeof *info, info) : MPM_OK;
}

mpm_status mpm_stepper_info(const mpm_stepper *stepper, mpm_step_info *info) {
  MPMI_ENTER(stepper, MPMI_STEPPER);
  /* the sums are a cache of the particles' state */
  mpm_stepper *s = (mpm_stepper *)(uintptr_t)stepper;
  mpm_status status = info ? mpmi_stepper_idle(s) : mpmi_fail(s->context, MPM_E_ARG, "info is NULL");
  if (!status) status = mpmi_check_sets(s, MPM_WRITE);
  if (!(status = mpmi_together_begin(s, status, 0, NULL, NULL))) status = mpmi_state_sums(s, NULL);
  if (status) return status;
  mpm_step_info now;
  mpmi_fill_info(s, &s->history.last, &now);
  return mpmi_write_struct(s->context, "mpm_step_info", &now, sizeof now, info);
}

mpm_status mpmi_tell_stable_dt(mpm_stepper *s, double *dt) {
  int64_t count = 0;
  for (int32_t m = 0; m < s->layout.member_count; ++m) count += s->layout.member[m].set->count;
  mpm_status status = dt ? mpmi_stepper_idle(s) : mpmi_fail(s->context, MPM_E_ARG, "dt is NULL");
  if ((status = mpmi_together(s, status)) ||
      (status = mpmi_reduce_parts(s->context, MPM_REDUCE_SUM, 1, &count)))
    return status;
  if (!count) return mpmi_fail(s->context, MPM_E_STATE, "the stepper has no particles");
  status = mpmi_together_begin(s, mpmi_check_sets(s, MPM_READ | MPM_WRITE), 0, NULL, NULL);
  if (!status) status = mpmi_state_sums(s, NULL);
  double stable = 0.0;
  if (status || (status = mpmi_stable_dt(s, &stable))) return status;
  if (!(stable > 0.0))
    return mpmi_fail(s->context, MPM_NONFINITE,
                     "velocity and wave speed over the spacing are beyond the range of double precision: no "
                     "step is stable");
  *dt = stable;
  return MPM_OK;
}

mpm_status mpm_stable_dt(mpm_stepper *s, double *dt) {
  MPMI_ENTER(s, MPMI_STEPPER);
  return mpmi_tell_stable_dt(s, dt);
}

/* ---- reactions ---------------------------------------------------------------------------------------- */
mpm_status mpm_stepper_wall_reaction(const mpm_stepper *s, int32_t face, double *force) {
  MPMI_ENTER(s, MPMI_STEPPER);
  const mpmi_history *history = &s->history;
  if (!force) return mpmi_fail(s->context, MPM_E_ARG, "force is NULL");
  const mpm_status status = mpmi_check_face(s, face);
  if (status) return status;
  if (!history->has_reactions) return mpmi_fail(s->context, MPM_E_STATE, "no step has been made yet");
  for (int32_t k = 0; k < s->grid->dim; ++k)
    force[k] = history->impulse_by_face[face][k] / history->reaction_dt;
  return MPM_OK;
}

mpm_status mpm_stepper_particles_reaction(const mpm_stepper *s, const mpm_particles *prescribed,
                                          double *force) {
  MPMI_ENTER(s, MPMI_STEPPER);
  int32_t m;
  if (!force) return mpmi_fail(s->context, MPM_E_ARG, "force is NULL");
  const mpm_status status = mpmi_members_find(&s->layout, &s->settings, prescribed, &m);
  if (status) return status;
  if (!s->history.has_reactions) return mpmi_fail(s->context, MPM_E_STATE, "no step has been made yet");
  for (int32_t c = 0; c < s->grid->dim; ++c)
    force[c] = s->history.reaction[m].impulse[c] / s->history.reaction_dt;
  return MPM_OK;
}

mpm_status mpm_stepper_wall_impulse(const mpm_stepper *s, int32_t face, double *impulse) {
  MPMI_ENTER(s, MPMI_STEPPER);
  if (!impulse) return mpmi_fail(s->context, MPM_E_ARG, "impulse is NULL");
  const mpm_status status = mpmi_check_face(s, face);
  if (status) return status;
  for (int32_t c = 0; c < s->grid->dim; ++c) impulse[c] = s->history.totals.impulse_by_face[face][c];
  return MPM_OK;
}

mpm_status mpm_stepper_particles_impulse(const mpm_stepper *s, const mpm_particles *prescribed,
                                         double *impulse) {
  MPMI_ENTER(s, MPMI_STEPPER);
  int32_t m;
  if (!impulse) return mpmi_fail(s->context, MPM_E_ARG, "impulse is NULL");
  const mpm_status status = mpmi_members_find(&s->layout, &s->settings, prescribed, &m);
  if (status) return status;
  for (int32_t c = 0; c < s->grid->dim; ++c) impulse[c] = s->history.reaction[m].impulse_total[c];
  return MPM_OK;
}

/* ---- Newton's method, time ---------------------------------------------------------------------------- */
mpm_status mpm_stepper_residuals(const mpm_stepper *s, int32_t capacity, double *residual, int32_t *count) {
  MPMI_ENTER(s, MPMI_STEPPER);
  if (!count) return mpmi_fail(s->context, MPM_E_ARG, "count is NULL");
  const mpm_status status = mpmi_check_count(s->context, "capacity", capacity);
  if (status) return status;
  if (capacity && !residual) return mpmi_fail(s->context, MPM_E_ARG, "residual is NULL");
  const int32_t known = s->newton ? s->newton->history_count : 0;
  for (int32_t i = 0; i < known && i < capacity; ++i) residual[i] = s->newton->history[i];
  *count = known;
  return MPM_OK;
}

mpm_status mpm_stepper_profile(mpm_stepper *s, int32_t reset, mpm_profile *out) {
  MPMI_ENTER(s, MPMI_STEPPER);
  if (!out) return mpmi_fail(s->context, MPM_E_ARG, "out is NULL");
  const double *t = s->profile.seconds;
  const mpm_profile profile = {.struct_size = sizeof profile,
                               .sort = t[MPMI_TIME_SORT],
                               .p2g = t[MPMI_TIME_P2G],
                               .grid = t[MPMI_TIME_GRID],
                               .g2p = t[MPMI_TIME_G2P],
                               .law = t[MPMI_TIME_LAW],
                               .assembly = t[MPMI_TIME_ASSEMBLY],
                               .factor = t[MPMI_TIME_FACTOR],
                               .solve = t[MPMI_TIME_SOLVE],
                               .callbacks = t[MPMI_TIME_CALLBACKS],
                               .total = t[MPMI_TIME_TOTAL],
                               .weights = t[MPMI_TIME_WEIGHTS]};
  const mpm_status status = mpmi_write_struct(s->context, "mpm_profile", &profile, sizeof profile, out);
  if (status) return status;
  s->profile.sampled = 1;
  if (reset) memset(s->profile.seconds, 0, sizeof s->profile.seconds);
  return MPM_OK;
}
