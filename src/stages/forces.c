/* External forces on particles: f = m (g + b) + f_app (MPoint theory eq. 21). Gravity needs no storage and is
 * added in the scatter; everything else is collected here. */
#include "stages/stages.h"
#include "layout/particle_batch.h"
#include "simd/chunk.h"
#include "simd/lanes.h"

#include <string.h>

_Static_assert(MPMI_CHUNK % MPMI_LANES == 0, "a chunk is whole registers");

/* Adds the applied force, where there is one, on one axis and takes it off inert slots; gives whether one is
 * not finite. Slots come in whole chunks. */
static int32_t complete(double *force, const double *applied, const int64_t *id, int64_t n) {
  mpmi_mask bad = {0}; /* bits of what is not 0: a sum would wait for itself */
  for (int64_t p = 0; p < n; p += MPMI_LANES) {
    mpmi_lanes f = mpmi_lanes_load(force + p);
    mpmi_mask number;
    memcpy(&number, id + p, sizeof number);
    if (applied) f += mpmi_lanes_load(applied + p);
    f = mpmi_lanes_where(~(number >> 63), f); /* compilers for SSE2 would split a comparison */
    mpmi_lanes_store(force + p, f);
    bad |= (mpmi_mask)(f - f);
  }
  return mpmi_lanes_any(bad, 1) != 0;
}

static void name_bad_forces(int32_t m, const mpm_particle_batch *batch, const double *force,
                            mpmi_failure *failure) {
  for (int32_t k = 0; k < batch->dim; ++k)
    for (int64_t p = 0; p < batch->n; ++p)
      if (force[k * batch->ld + p] - force[k * batch->ld + p] != 0.0)
        mpmi_failure_take(failure,
                          mpmi_particle_failure(MPM_NONFINITE, m, batch->id[p], "external force not finite"));
}

static void forces_of_batch(void *user, int32_t m, const mpm_particle_batch *batch, int64_t begin,
                            mpmi_failure *failure) {
  const mpmi_step *step = user;
  const mpmi_settings *settings = step->settings;
  const mpmi_member *member = &step->layout->member[m];
  const mpm_particles *set = member->set;
  const int64_t n = batch->n, ld = batch->ld;
  double *force = step->work->rows.of[m].force + begin;
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
  int32_t bad = 0;
  for (int32_t k = 0; k < batch->dim; ++k)
    bad |= complete(force + k * ld, applied ? applied + k * ld : NULL, batch->id, n);
  if (bad) name_bad_forces(m, batch, force, failure);
}

mpm_status mpmi_forces_stage(mpmi_step *step, double t) {
  const int32_t calls_host = step->settings->acceleration || step->settings->force;
  for (int32_t m = 0; m < step->layout->member_count; ++m) {
    if (!step->work->rows.of[m].force) continue;
    const mpm_status status = mpmi_particle_batches(step, m, t, calls_host, forces_of_batch, step);
    if (status) return status;
  }
  return mpmi_step_failure(step);
}
