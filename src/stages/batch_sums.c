/* What a step sums up over the particles of a batch: energies, momenta and rates, by the kernels of
 * transfer/sums.c; and what they have to know for that. */
#include "stages/batch.h"
#include "layout/tile.h"

#include <string.h>

void mpmi_sums_bind(mpmi_batch *b) {
  const mpmi_settings *settings = b->step->settings;
  const mpm_grid *grid = settings->grid;
  b->sums_job =
      (mpmi_sums_job){.ld = b->law.batch.ld,
                      .wave_speed = b->law.wave_speed,
                      .kinematic_viscosity = mpmi_may_be_viscous(b->set->material) ? b->law.viscosity : NULL,
                      .squared = b->law.squares,
                      .energy = b->law.energy,
                      .viscous_factor = 2.0 * grid->dim / (grid->h_min * grid->h_min),
                      .carried = mpmi_is_total_lagrangian(grid) ? 0.0 : 1.0,
                      .checked = {b->law.stress_new, b->law.state_new},
                      .checked_rows = {mpmi_stress_components(grid->dim), b->set->material->state_count}};
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double length = grid->upper[k] - grid->desc.origin[k];
    const int32_t periodic = grid->desc.periodic[k] != 0;
    b->sums_job.period[k] = periodic ? length : 0.0;
    b->sums_job.inverse_period[k] = periodic ? 1.0 / length : 0.0;
    b->sums_job.gravity[k] = settings->desc.gravity[k];
    b->sums_job.spacing[k] = grid->desc.spacing[k];
    b->sums_job.inverse_spacing[k] = grid->inverse_spacing[k];
  }
}

void mpmi_wave_speed_leave(const mpmi_batch *b) {
  memcpy(b->step->work->rows.of[b->m].wave_speed + b->begin, b->law.wave_speed,
         (size_t)b->n * sizeof(double));
}

void mpmi_wave_speed_fetch(mpmi_batch *b) {
  memcpy(b->law.wave_speed, b->step->work->rows.of[b->m].wave_speed + b->begin,
         (size_t)b->n * sizeof(double));
}

void mpmi_batch_sums(mpmi_batch *b, int32_t what) {
  const mpmi_settings *settings = b->step->settings;
  const double *force = b->step->work->rows.of[b->m].force;
  mpm_particles *set = b->set;
  const int32_t dim = settings->grid->dim;
  mpmi_sums_job *job = &b->sums_job;
  job->what = what;
  job->mass = mpmi_f64(set, MPMI_MASS, 0) + b->begin;
  job->initial_volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0) + b->begin;
  for (int32_t k = 0; k < dim; ++k) {
    job->x[k] = mpmi_component_row(set, MPMI_POSITION, 1, k) + b->begin;
    job->v[k] = mpmi_component_row(set, MPMI_VELOCITY, 1, k) + b->begin;
    job->x_old[k] = mpmi_component_row(set, MPMI_POSITION, 0, k) + b->begin;
    job->force[k] = force ? force + k * set->ld + b->begin : NULL;
  }
  if (mpmi_is_affine(settings) && (what & MPMI_SUMS_MOTION)) {
    mpmi_sums_moments(settings, set, 1, b->begin, b->n, b->law.ld, b->C,
                      job); /* C is stored, its buffer free */
    for (int32_t c = 0; c < mpmi_gradient_components(dim); ++c)
      job->affine[mpmi_gradient_map(dim)[c]] = mpmi_component_row(set, MPMI_L, 1, c) + b->begin;
  }
  if (mpmi_is_total_lagrangian(set->grid)) mpmi_point_at(set, MPMI_F, 1, b->begin, job->F);
  if (b->sums->rate < b->largest_rate) b->sums->rate = b->largest_rate; /* lesser ones are not looked at */
  b->flags |= settings->kernels->sums[dim](job, b->n, b->sums);
  b->largest_rate = b->sums->rate;
}

/* ---- moments ----------------------------------------------------------------------------------------- */
void mpmi_sums_moments(const mpmi_settings *settings, const mpm_particles *set, int32_t copy, int64_t begin,
                       int64_t n, int64_t ld, double *buffer, mpmi_sums_job *job) {
  const mpm_grid *grid = settings->grid;
  const int32_t dim = grid->dim, anywhere[3] = {0, 0, 0};
  for (int32_t k = 0; k < dim; ++k) {
    job->constant_moment[k] = grid->moment * grid->desc.spacing[k] * grid->desc.spacing[k];
    job->moment[k] = grid->moment > 0.0 ? NULL : buffer + k * ld;
  }
  if (grid->moment > 0.0) return;
  const mpmi_points points = mpmi_points_of(set, copy);
  const mpmi_weights_fn weights = settings->kernels->weights[grid->family][dim];
  mpmi_axis axis[3];
  mpmi_weights W;
  mpmi_block_axes(grid, anywhere, axis);
  for (int64_t p = 0; p < n; p += MPMI_CHUNK) {
    const int64_t count = n - p < MPMI_CHUNK ? n - p : MPMI_CHUNK;
    weights(axis, MPMI_NEED_MOMENT | MPMI_NO_PLACE, &points, begin + p, count, &W);
    for (int32_t k = 0; k < dim; ++k)
      for (int64_t i = 0; i < count; ++i) {
        const double inverse = W.inverse_moment[k][i];
        buffer[k * ld + p + i] = inverse > 0.0 ? 1.0 / inverse : 0.0;
      }
  }
}
