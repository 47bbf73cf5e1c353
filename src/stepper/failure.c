#include "stepper/stepper.h"

void mpmi_failure_clear(mpmi_failure *failure) {
  *failure = (mpmi_failure){MPM_OK, 0, -1, -1, -1, ""};
}

/* Smallest (set, particle); failures without a particle (nodes, callbacks) come first in their set. */
void mpmi_failure_take(mpmi_failure *first, const mpmi_failure *other) {
  if (!other->cause) return;
  int32_t before = !first->cause;
  if (!before && other->set != first->set)
    before = other->set < first->set;
  else if (!before && other->particle != first->particle)
    before = other->particle < first->particle;
  else if (!before)
    before = other->node < first->node;
  if (before) *first = *other;
}

mpm_status mpmi_callback_cause(mpm_status status) {
  return status > 0 ? MPM_CUT_DT : MPM_E_CALLBACK;
}

mpm_status mpmi_stepper_failure(mpm_stepper *s) {
  for (int32_t k = 0; k < s->tasks; ++k) mpmi_failure_take(&s->failure, &s->scratch[k].failure);
  const mpmi_failure *f = &s->failure;
  if (!f->cause) return MPM_OK;
  if (f->callback_status && f->set >= 0)
    return mpmi_fail(s->context, f->cause, "%s returned %d for set %d in the step from t = %g with dt = %g",
                     f->what, (int)f->callback_status, (int)f->set, s->t, s->dt);
  if (f->callback_status)
    return mpmi_fail(s->context, f->cause, "%s returned %d in the step from t = %g with dt = %g", f->what,
                     (int)f->callback_status, s->t, s->dt);
  if (f->particle >= 0)
    return mpmi_fail(s->context, f->cause,
                     "%s at particle %lld of set %d in the step from t = %g with dt = %g", f->what,
                     (long long)f->particle, (int)f->set, s->t, s->dt);
  return mpmi_fail(s->context, f->cause, "%s at node %lld in the step from t = %g with dt = %g", f->what,
                   (long long)f->node, s->t, s->dt);
}
