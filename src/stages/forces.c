/* External forces on particles: f = m (g + b) + f_app (MPoint theory eq. 21). Gravity needs no storage and is
 * added in the scatter; everything else is collected here. */
#include "stages/stages.h"
#include "layout/particle_batch.h"

#include <string.h>

static void check_finite(int32_t m, const mpm_particle_batch *batch, const double *force,
                         mpmi_failure *failure) {
  double bad = 0.0;
  for (int32_t k = 0; k < batch->dim; ++k)
    for (int64_t p = 0; p < batch->n; ++p) bad += force[k * batch->ld + p] - force[k * batch->ld + p];
  if (bad == 0.0) return;
  for (int32_t k = 0; k < batch->dim; ++k)
    for (int64_t p = 0; p < batch->n; ++p)
      if (force[k * batch->ld + p] - force[k * batch->ld + p] != 0.0)
        mpmi_failure_take(
            failure, &(mpmi_failure){MPM_NONFINITE, 0, m, batch->id[p], -1, "external force not finite", 0});
}

static void forces_of_batch(void *user, int32_t m, const mpm_particle_batch *batch, int64_t begin,
                            mpmi_failure *failure) {
  const mpmi_step *step = user;
  const mpmi_settings *settings = step->settings;
  const mpmi_member *member = &step->layout->member[m];
  const mpm_particles *set = member->set;
  const int64_t n = batch->n, ld = batch->ld;
  double *force = member->force + begin;
  for (int32_t k = 0; k < batch->dim; ++k) memset(force + k * ld, 0, (size_t)n * sizeof *force);
  if (settings->acceleration) {
    if (mpmi_call_particle_fn(settings->acceleration, settings->acceleration_user,
                              "the acceleration callback", m, batch, force, failure))
      return;
    for (int32_t k = 0; k < batch->dim; ++k)
      for (int64_t p = 0; p < n; ++p) force[k * ld + p] *= batch->mass[p];
  }
  if (settings->force && mpmi_call_particle_fn(settings->force, settings->force_user, "the force callback", m,
                                               batch, force, failure))
    return;
  const double *applied =
      set->field[MPMI_APPLIED_FORCE].present ? mpmi_f64(set, MPMI_APPLIED_FORCE, 0) + begin : NULL;
  for (int32_t k = 0; k < batch->dim; ++k)
    for (int64_t p = 0; p < n; ++p) {
      const int64_t at = k * ld + p;
      if (applied) force[at] += applied[at];
      if (batch->id[p] < 0) force[at] = 0.0;
    }
  check_finite(m, batch, force, failure);
}

mpm_status mpmi_forces_stage(mpmi_step *step, double t) {
  const int32_t calls_host = step->settings->acceleration || step->settings->force;
  for (int32_t m = 0; m < step->layout->member_count; ++m) {
    if (!step->layout->member[m].force) continue;
    const mpm_status status = mpmi_particle_batches(step, m, t, calls_host, forces_of_batch, step);
    if (status) return status;
  }
  return mpmi_step_failure(step);
}
