/* What bodies did to each other: the reports of pairs, and what a committed step leaves there. */
#include "context/structs.h"
#include "stepper/stepper.h"

#include <math.h>

void mpmi_pairs_begin(mpmi_pair_records *pairs) {
  for (int64_t i = 0; i < pairs->count; ++i) pairs->record[i].now = (mpmi_pair_sums){.gap = (double)INFINITY};
}

static void take_totals(mpmi_pair_sums *now, const double *total) {
  for (int32_t c = 0; c < 3; ++c) {
    now->impulse[c] = total[MPMI_PAIR_IMPULSE + c];
    now->angular_impulse[c] = total[MPMI_PAIR_MOMENT + c];
  }
  now->normal_impulse = total[MPMI_PAIR_NORMAL];
  now->area = total[MPMI_PAIR_AREA];
  now->dissipation = total[MPMI_PAIR_DISSIPATION];
  now->friction_work = total[MPMI_PAIR_FRICTION_WORK];
}

void mpmi_pairs_total(mpmi_pair_records *pairs, const mpmi_tally *tally) {
  for (int64_t i = 0; i < pairs->count; ++i)
    take_totals(&pairs->record[i].now, tally->total + tally->pairs + MPMI_PAIR_SUMS * i);
}

void mpmi_pairs_commit(mpmi_pair_records *pairs) {
  for (int64_t i = 0; i < pairs->count; ++i) {
    mpmi_pair_record *record = &pairs->record[i];
    record->last = record->now;
    for (int32_t c = 0; c < 3; ++c) record->impulse_total[c] += record->now.impulse[c];
  }
}

void mpmi_pairs_forget(mpmi_pair_records *pairs) {
  for (int64_t i = 0; i < pairs->count; ++i)
    for (int32_t c = 0; c < 3; ++c) pairs->record[i].impulse_total[c] = 0.0;
}

void mpmi_pair_tell(const mpmi_pair_record *record, double sign, double dt, mpm_contact_info *info) {
  const mpmi_pair_sums *sums = &record->last;
  info->touching |= sums->closed > 0;
  info->nodes += sums->nodes;
  info->closed += sums->closed;
  info->stuck += sums->stuck;
  info->ambiguous += sums->ambiguous;
  for (int32_t c = 0; c < 3; ++c) {
    info->force[c] += sign * sums->impulse[c] / dt;
    info->torque[c] += sign * sums->angular_impulse[c] / dt;
    info->impulse[c] += sign * record->impulse_total[c];
  }
  info->normal_force += sums->normal_impulse / dt;
  info->area += sums->area;
  info->pressure_max = fmax(info->pressure_max, sums->pressure_max);
  info->gap = fmin(info->gap, sums->gap);
  info->dissipation += sums->dissipation;
  info->friction_work += sums->friction_work;
}

static mpm_status check_pair(const mpm_stepper *s, int32_t a, int32_t b) {
  const int32_t body[2] = {a, b};
  for (int32_t i = 0; i < 2; ++i)
    if (body[i] < MPM_BODY_ANY || body[i] >= MPMI_MAX_BODIES)
      return mpmi_fail(s->context, MPM_E_ARG, "body is %d: it must be MPM_BODY_ANY or 0 ... %d", (int)body[i],
                       MPMI_MAX_BODIES - 1);
  if (a == b)
    return mpmi_fail(s->context, MPM_E_ARG,
                     a == MPM_BODY_ANY ? "both bodies are MPM_BODY_ANY: name one of them"
                                       : "a body has no contact with itself: name two bodies");
  return MPM_OK;
}

mpm_status mpm_stepper_contact_info(const mpm_stepper *s, int32_t body_a, int32_t body_b,
                                    mpm_contact_info *info) {
  MPMI_ENTER(s, MPMI_STEPPER);
  if (!info) return mpmi_fail(s->context, MPM_E_ARG, "info is NULL");
  const mpm_status status = check_pair(s, body_a, body_b);
  if (status) return status;
  if (!s->history.has_reactions) return mpmi_fail(s->context, MPM_E_STATE, "no step has been made yet");
  mpm_contact_info now = {.struct_size = sizeof now, .gap = (double)INFINITY};
  for (int64_t i = 0; i < s->history.pairs.count; ++i) {
    const mpmi_pair_record *record = &s->history.pairs.record[i];
    if (record->a < 0) continue; /* of a surface */
    if ((body_a == MPM_BODY_ANY || body_a == record->a) && (body_b == MPM_BODY_ANY || body_b == record->b))
      mpmi_pair_tell(record, 1.0, s->history.reaction_dt, &now);
    else if ((body_a == MPM_BODY_ANY || body_a == record->b) &&
             (body_b == MPM_BODY_ANY || body_b == record->a))
      mpmi_pair_tell(record, -1.0, s->history.reaction_dt, &now);
  }
  return mpmi_write_struct(s->context, "mpm_contact_info", &now, sizeof now, info);
}
