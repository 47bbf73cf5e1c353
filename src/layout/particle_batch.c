#include "layout/particle_batch.h"
#include "layout/tasks.h"

enum { BATCH = 2048 };

typedef struct batches_job {
  mpmi_step *step;
  int32_t m;
  double t;
  mpmi_particle_batch_fn fn;
  void *user;
} batches_job;

static void one_batch(const batches_job *job, int64_t begin, int64_t n, mpmi_failure *failure) {
  const mpm_particles *set = job->step->layout->member[job->m].set;
  const mpmi_lookup lookup = {set, begin};
  mpm_particle_batch batch = {.struct_size = sizeof batch,
                              .dim = set->grid->dim,
                              .n = n,
                              .ld = set->ld,
                              .t = job->t,
                              .dt = job->step->dt,
                              .id = mpmi_i64(set, MPMI_ID, 0) + begin,
                              .position = mpmi_f64(set, MPMI_POSITION, 0) + begin,
                              .velocity = mpmi_f64(set, MPMI_VELOCITY, 0) + begin,
                              .mass = mpmi_f64(set, MPMI_MASS, 0) + begin,
                              .volume = mpmi_f64(set, MPMI_VOLUME, 0) + begin,
                              .particles = set,
                              .lookup = &lookup};
  if (set->field[MPMI_REFERENCE].present) batch.reference_position = mpmi_f64(set, MPMI_REFERENCE, 0) + begin;
  job->fn(job->user, job->m, &batch, begin, failure);
}

static void batches_task(void *data, int64_t k) {
  const batches_job *job = data;
  const int64_t slots = job->step->layout->member[job->m].set->slots;
  const mpmi_share share = mpmi_share_of(job->step->settings, (slots + BATCH - 1) / BATCH, k);
  for (int64_t b = share.begin; b < share.end; ++b) {
    const int64_t begin = b * BATCH, left = slots - begin;
    one_batch(job, begin, left < BATCH ? left : BATCH, &job->step->work->report[k].failure);
  }
}

mpm_status mpmi_particle_batches(mpmi_step *step, int32_t m, double t, int32_t calls_host,
                                 mpmi_particle_batch_fn fn, void *user) {
  batches_job job = {step, m, t, fn, user};
  return mpmi_run_tasks(step->settings, calls_host, step->settings->tasks, batches_task, &job);
}

mpm_status mpmi_call_particle_fn(mpm_particle_fn fn, void *user, const char *what, int32_t m,
                                 const mpm_particle_batch *batch, double *add, mpmi_failure *failure) {
  const mpm_status status = mpmi_from_host(fn(user, batch, add));
  if (status) mpmi_failure_take(failure, mpmi_callback_failure(status, m, what));
  return status;
}
