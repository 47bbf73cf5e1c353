/* What the host is told of equilibria that are not stable. */
#include "stepper/stepper.h"

/* A balance without inertia whose stiffness has negative pivots holds only as long as nothing disturbs it. */
void mpmi_stability_warn(mpm_stepper *s) {
  if (!s->settings.desc.quasi_static || !mpmi_is_implicit(&s->settings)) return;
  const int32_t unstable = s->step.negative_pivots > 0;
  if (unstable && !s->told_unstable)
    mpmi_log(s->context, MPM_LOG_WARNING,
             "the equilibrium at t = %g is not stable: its stiffness has %lld negative pivots, and the "
             "smallest push takes the body elsewhere; a small load across, or inertia, finds where to",
             s->history.t, (long long)s->step.negative_pivots);
  s->told_unstable = unstable;
}
