/* External forces on particles: f = m (g + b) + f_app (MPoint theory eq. 21). Gravity needs no storage and is
 * added in the scatter; everything else is collected here, in long batches because calling the host costs. */
#include "stepper/stepper.h"

#include <string.h>

typedef struct forces_job {
  mpm_stepper *s;
  int32_t m;
  double t, dt;
} forces_job;

static mpm_status call_host(const forces_job *job, mpm_particle_fn fn, void *user, const char *what,
                            const mpm_particle_batch *batch, double *add, mpmi_failure *failure) {
  const mpm_status status = fn(user, batch, add);
  if (status)
    mpmi_failure_take(failure, &(mpmi_failure){mpmi_callback_cause(status), status, job->m, -1, -1, what});
  return status;
}

static void check_finite(const forces_job *job, const mpm_particle_batch *batch, const double *force,
                         mpmi_failure *failure) {
  double bad = 0.0;
  for (int32_t k = 0; k < batch->dim; ++k)
    for (int64_t p = 0; p < batch->n; ++p) bad += force[k * batch->ld + p] - force[k * batch->ld + p];
  if (bad == 0.0) return;
  for (int32_t k = 0; k < batch->dim; ++k)
    for (int64_t p = 0; p < batch->n; ++p)
      if (force[k * batch->ld + p] - force[k * batch->ld + p] != 0.0)
        mpmi_failure_take(failure, &(mpmi_failure){MPM_NONFINITE, 0, job->m, batch->id[p], -1,
                                                   "external force not finite"});
}

mpm_particle_batch mpmi_particle_batch(const mpm_stepper *s, const mpm_particles *set, int64_t begin,
                                       int64_t n, double t, double dt, const mpmi_lookup *lookup) {
  mpm_particle_batch batch = {.struct_size = sizeof batch,
                              .dim = s->grid->dim,
                              .n = n,
                              .ld = set->ld,
                              .t = t,
                              .dt = dt,
                              .id = mpmi_i64(set, MPMI_ID, 0) + begin,
                              .position = mpmi_f64(set, MPMI_POSITION, 0) + begin,
                              .velocity = mpmi_f64(set, MPMI_VELOCITY, 0) + begin,
                              .mass = mpmi_f64(set, MPMI_MASS, 0) + begin,
                              .volume = mpmi_f64(set, MPMI_VOLUME, 0) + begin,
                              .particles = set,
                              .lookup = lookup};
  if (set->field[MPMI_REFERENCE].present) batch.reference_position = mpmi_f64(set, MPMI_REFERENCE, 0) + begin;
  return batch;
}

static void forces_of_batch(const forces_job *job, int64_t begin, int64_t n, mpmi_failure *failure) {
  mpm_stepper *s = job->s;
  mpmi_member *member = &s->member[job->m];
  mpm_particles *set = member->set;
  const int32_t dim = s->grid->dim;
  const mpmi_lookup lookup = {set, begin};
  const mpm_particle_batch batch = mpmi_particle_batch(s, set, begin, n, job->t, job->dt, &lookup);
  double *force = member->force + begin;
  for (int32_t k = 0; k < dim; ++k) memset(force + k * set->ld, 0, (size_t)n * sizeof *force);
  if (s->acceleration) {
    if (call_host(job, s->acceleration, s->acceleration_user, "the acceleration callback", &batch, force,
                  failure))
      return;
    for (int32_t k = 0; k < dim; ++k)
      for (int64_t p = 0; p < n; ++p) force[k * set->ld + p] *= batch.mass[p];
  }
  if (s->force && call_host(job, s->force, s->force_user, "the force callback", &batch, force, failure))
    return;
  const double *applied =
      set->field[MPMI_APPLIED_FORCE].present ? mpmi_f64(set, MPMI_APPLIED_FORCE, 0) + begin : NULL;
  for (int32_t k = 0; k < dim; ++k)
    for (int64_t p = 0; p < n; ++p) {
      const int64_t at = k * set->ld + p;
      if (applied) force[at] += applied[at];
      if (batch.id[p] < 0) force[at] = 0.0;
    }
  check_finite(job, &batch, force, failure);
}

static void forces_task(void *data, int64_t k) {
  const forces_job *job = data;
  const mpm_particles *set = job->s->member[job->m].set;
  const int64_t batches = (set->slots + MPMI_PARTICLE_BATCH - 1) / MPMI_PARTICLE_BATCH, tasks = job->s->tasks;
  for (int64_t b = batches * k / tasks; b < batches * (k + 1) / tasks; ++b) {
    const int64_t begin = b * MPMI_PARTICLE_BATCH;
    const int64_t n = set->slots - begin < MPMI_PARTICLE_BATCH ? set->slots - begin : MPMI_PARTICLE_BATCH;
    forces_of_batch(job, begin, n, &job->s->scratch[k].failure);
  }
}

mpm_status mpmi_stage_forces(mpm_stepper *s, double t, double dt) {
  for (int32_t m = 0; m < s->member_count; ++m) {
    if (!s->member[m].force) continue;
    forces_job job = {s, m, t, dt};
    const mpm_status status = mpmi_run_tasks(s, s->acceleration || s->force, s->tasks, forces_task, &job);
    if (status) return status;
  }
  return mpmi_stepper_failure(s);
}
