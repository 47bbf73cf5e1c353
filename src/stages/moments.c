#include "stages/moments.h"
#include "layout/axes.h"

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
