/* What material dissipates in a step: the work of its stress less the change of strain energy,
 *
 *   (V sigma + V' sigma') : e / 2 - V0 (W' - W),  e = sym 2 (F_inc - I) (F_inc + I)^-1
 *
 * with volumes and increments as the law sees them. Of laws whose energy w per present volume follows from
 * the Cauchy stress alone what is stored is V dw, because V w itself changes with the volume at a given
 * stress. The increment e is that of Hencky's strain up to terms of third order, so that elastic cycles
 * leave nothing. */
#include "layout/tasks.h"
#include "particles/thermal.h"
#include "simd/vector3.h"
#include "stages/batch.h"
#include "stages/stages.h"

#include <math.h>

static double *row_of(const mpmi_step *step, int32_t m, int32_t row) {
  const mpmi_member_rows *rows = &step->work->rows.of[m];
  return rows->heat + row * rows->heat_ld;
}

/* Returns by how much the law sees the volume of a particle grown. */
static double growth_of(const mpmi_law_batch *b, const mpm_particles *set, int64_t p) {
  const double *F = b->F + p;
  const int64_t ld = b->ld;
  const double det = F[0] * (F[4 * ld] * F[8 * ld] - F[5 * ld] * F[7 * ld]) -
                     F[ld] * (F[3 * ld] * F[8 * ld] - F[5 * ld] * F[6 * ld]) +
                     F[2 * ld] * (F[3 * ld] * F[7 * ld] - F[4 * ld] * F[6 * ld]);
  return mpmi_expands(set) ? det * b->growth[p] : det;
}

/* ---- before the step ----------------------------------------------------------------------------------- */
typedef struct energy_job {
  mpmi_step *step;
  int32_t m;
} energy_job;

static void energies_of_batch(const energy_job *job, mpmi_law_batch *b, int64_t begin, int64_t n,
                              mpmi_failure *failure) {
  const mpm_particles *set = job->step->layout->member[job->m].set;
  double *energy = row_of(job->step, job->m, MPMI_ROW_ENERGY) + begin,
         *growth = row_of(job->step, job->m, MPMI_ROW_GROWTH) + begin;
  mpmi_law_batch_load(b, set, begin, n, job->step->t, 0.0);
  mpmi_law_batch_load_F(b, set, begin, n);
  if (mpmi_law_batch_run_in(b, set)) {
    mpmi_failure_take(failure,
                      mpmi_particle_failure(b->fault.cause, job->m, b->fault.particle, b->fault.what));
    return;
  }
  for (int64_t p = 0; p < n; ++p) {
    energy[p] = b->energy[p];
    growth[p] = growth_of(b, set, p);
  }
}

static void energies_task(void *data, int64_t task) {
  const energy_job *job = data;
  const mpm_particles *set = job->step->layout->member[job->m].set;
  mpmi_law_batch b;
  mpmi_law_batch_bind(&b, set->material, job->step->work->scratch[task].batch_memory);
  const mpmi_share share = mpmi_share_of(job->step->settings, (set->slots + b.ld - 1) / b.ld, task);
  for (int64_t k = share.begin; k < share.end; ++k) {
    const int64_t begin = k * b.ld, left = set->slots - begin;
    energies_of_batch(job, &b, begin, left < b.ld ? left : b.ld, &job->step->work->report[task].failure);
  }
}

mpm_status mpmi_dissipation_prepare(mpmi_step *step) {
  const mpmi_settings *settings = step->settings;
  for (int32_t m = 0; m < step->layout->member_count; ++m) {
    energy_job job = {step, m};
    if (!mpmi_dissipates(settings, m)) continue;
    const mpm_status status = mpmi_run_tasks(settings, 0, settings->tasks, energies_task, &job);
    if (status) return status;
  }
  return mpmi_step_failure(step);
}

/* ---- after it ------------------------------------------------------------------------------------------ */
/* Finds the increment of strain. */
static void find_strain(const mpmi_law_batch *b, int64_t p, double dt, double *strain) {
  double less[3][3], more[3][3], inverse[3][3], X[3][3];
  for (int32_t e = 0; e < 9; ++e) {
    less[e / 3][e % 3] = dt * b->L[e * b->ld + p];
    more[e % 3][e / 3] = less[e / 3][e % 3] + (e % 4 ? 0.0 : 2.0);
  }
  mpmi_invert3(more, inverse); /* transposed, so that rows meet */
  for (int32_t i = 0; i < 3; ++i)
    for (int32_t j = 0; j < 3; ++j) X[i][j] = 2.0 * mpmi_inner(less[i], inverse[j]);
  for (int32_t i = 0; i < 3; ++i) strain[i] = X[i][i];
  strain[3] = X[0][1] + X[1][0];
  strain[4] = X[1][2] + X[2][1];
  strain[5] = X[0][2] + X[2][0];
}

void mpmi_dissipation_find(mpmi_batch *b) {
  const mpm_particles *set = b->set;
  const mpmi_law_batch *law = &b->law;
  const double *initial = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0) + b->begin,
               *energy = row_of(b->step, b->m, MPMI_ROW_ENERGY) + b->begin,
               *growth = row_of(b->step, b->m, MPMI_ROW_GROWTH) + b->begin;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0) + b->begin;
  const int32_t by_stress = set->material->law->energy_of_stress;
  double *dissipated = row_of(b->step, b->m, MPMI_ROW_DISSIPATED) + b->begin;
  for (int64_t p = 0; p < b->n; ++p) {
    double strain[6], work = 0.0;
    const double grown = growth_of(law, set, p);
    find_strain(law, p, b->step->dt, strain);
    for (int32_t c = 0; c < mpmi_stress_components(set->grid->dim); ++c)
      work += 0.5 * strain[c] *
              (growth[p] * mpmi_f64(set, MPMI_STRESS, 0)[c * set->ld + b->begin + p] +
               grown * law->stress_new[c * law->ld + p]);
    const double stored = by_stress
                              ? 0.5 * (growth[p] + grown) * (law->energy[p] / grown - energy[p] / growth[p])
                              : law->energy[p] - energy[p];
    dissipated[p] = id[p] < 0 ? 0.0 : initial[p] * (work - stored);
    if (!isfinite(dissipated[p]))
      mpmi_batch_fail(b, MPM_NONFINITE, b->begin + p, "dissipated work not finite");
  }
}
