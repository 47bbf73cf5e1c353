#include "layout/failure.h"

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

mpm_status mpmi_failure_report(mpm_context *context, const mpmi_failure *f, double t, double dt) {
  if (!f->cause) return MPM_OK;
  if (f->callback_status && f->set >= 0)
    return mpmi_fail(context, f->cause, "%s returned %d for set %d in the step from t = %g with dt = %g",
                     f->what, (int)f->callback_status, (int)f->set, t, dt);
  if (f->callback_status)
    return mpmi_fail(context, f->cause, "%s returned %d in the step from t = %g with dt = %g", f->what,
                     (int)f->callback_status, t, dt);
  if (f->particle >= 0)
    return mpmi_fail(context, f->cause, "%s at particle %lld of set %d in the step from t = %g with dt = %g",
                     f->what, (long long)f->particle, (int)f->set, t, dt);
  return mpmi_fail(context, f->cause, "%s at node %lld in the step from t = %g with dt = %g", f->what,
                   (long long)f->node, t, dt);
}
