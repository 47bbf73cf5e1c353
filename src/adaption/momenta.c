/* Momenta and energies of particles with the matrices that transfers carry: a particle's angular momentum is
 * m (x x v + sum_k D_k e_k x C e_k), its kinetic energy m/2 (v.v + sum_k D_k |C e_k|^2). */
#include "adaption/adaption.h"
#include "stages/batch.h"

void mpmi_second_moments(const mpmi_settings *settings, const mpm_particles *set, int64_t slot, double *D) {
  double buffer[3 * MPMI_CHUNK];
  mpmi_sums_job job;
  const int64_t begin = slot - slot % MPMI_CHUNK;
  mpmi_sums_moments(settings, set, 0, begin, MPMI_CHUNK, MPMI_CHUNK, buffer, &job);
  for (int32_t k = 0; k < set->grid->dim; ++k)
    D[k] = job.moment[k] ? job.moment[k][slot - begin] : job.constant_moment[k];
}

static int32_t carries_matrix(const mpmi_settings *settings, const mpm_particles *set) {
  return mpmi_is_affine(settings) && set->field[MPMI_L].present;
}

mpmi_motion_of mpmi_motion_in(const mpmi_settings *settings, const mpm_particles *set, int64_t slot) {
  const int32_t dim = set->grid->dim;
  mpmi_motion_of motion = {.mass = mpmi_f64(set, MPMI_MASS, 0)[slot]};
  for (int32_t k = 0; k < dim; ++k) {
    motion.x[k] = mpmi_row_of(set, MPMI_POSITION, 0, k)[slot];
    motion.v[k] = mpmi_row_of(set, MPMI_VELOCITY, 0, k)[slot];
  }
  if (!carries_matrix(settings, set)) return motion;
  for (int32_t r = 0; r < dim; ++r)
    for (int32_t c = 0; c < dim; ++c) motion.C[r][c] = mpmi_row_of(set, MPMI_L, 0, dim * r + c)[slot];
  mpmi_second_moments(settings, set, slot, motion.D);
  return motion;
}

void mpmi_write_motion(const mpmi_settings *settings, mpm_particles *set, int64_t slot,
                       const mpmi_motion_of *motion) {
  const int32_t dim = set->grid->dim;
  for (int32_t k = 0; k < dim; ++k) mpmi_f64(set, MPMI_VELOCITY, 0)[k * set->ld + slot] = motion->v[k];
  for (int32_t r = 0; r < dim && carries_matrix(settings, set); ++r)
    for (int32_t c = 0; c < dim; ++c)
      mpmi_f64(set, MPMI_L, 0)[(dim * r + c) * set->ld + slot] = motion->C[r][c];
}

void mpmi_count_motion(const mpm_grid *grid, const mpmi_motion_of *motion, const double *centre, double sign,
                       mpmi_whole_sum *lost) {
  double square = 0.0, spin = 0.0;
  const double m = sign * motion->mass;
  for (int32_t r = 0; r < 3; ++r) {
    square += motion->v[r] * motion->v[r];
    for (int32_t k = 0; k < 3; ++k) spin += motion->D[k] * motion->C[r][k] * motion->C[r][k];
  }
  mpmi_exact_add(&lost[MPMI_LOST_KINETIC], 0.5 * m * square);
  mpmi_exact_add(&lost[MPMI_LOST_AFFINE], 0.5 * m * spin);
  for (int32_t r = 0; r < 3 && !mpmi_is_axisymmetric(grid); ++r) {
    const int32_t a = (r + 1) % 3, b = (r + 2) % 3;
    mpmi_exact_add(&lost[MPMI_LOST_ANGULAR + r],
                   m * ((motion->x[a] - centre[a]) * motion->v[b] -
                        (motion->x[b] - centre[b]) * motion->v[a] + motion->D[a] * motion->C[b][a] -
                        motion->D[b] * motion->C[a][b]));
  }
}
