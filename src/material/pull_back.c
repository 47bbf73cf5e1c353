/* Gradients over reference positions become those over the present ones, and wave speeds the other way. */
#include "material/pull_back.h"
#include "simd/chunk.h"

MPMI_INLINE void spatial(int32_t dim, const double *const *F, int64_t ld, double *L, int64_t n) {
  for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_LANES) {
    mpmi_lanes inverse[3][3];
    mpmi_inverse_load(dim, F, s, inverse);
    for (int32_t r = 0; r < dim; ++r) {
      double *row = L + 3 * r * ld + s;
      mpmi_lanes of[3];
      for (int32_t k = 0; k < dim; ++k) of[k] = mpmi_lanes_load(row + k * ld);
      for (int32_t c = 0; c < dim; ++c) {
        mpmi_lanes sum = {0.0};
        for (int32_t k = 0; k < dim; ++k) sum += of[k] * inverse[k][c];
        mpmi_lanes_store(row + c * ld, sum);
      }
    }
  }
}

/* The largest row of |F^-1 F^-T| bounds the square of the largest stretch of F^-1. */
MPMI_INLINE void speeds(int32_t dim, const double *const *F, int32_t squared, double *wave_speed,
                        double *viscosity, int64_t n) {
  for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_LANES) {
    mpmi_lanes adjugate[3][3], most = {0.0};
    const mpmi_lanes J = mpmi_adjugate_load(dim, F, s, adjugate);
    for (int32_t r = 0; r < dim; ++r) {
      mpmi_lanes row = {0.0};
      for (int32_t c = 0; c < dim; ++c) {
        mpmi_lanes entry = {0.0};
        for (int32_t k = 0; k < dim; ++k) entry += adjugate[r][k] * adjugate[c][k];
        row += mpmi_lanes_abs(entry);
      }
      most = mpmi_lanes_max(most, row);
    }
    most = most / (J * J);
    mpmi_lanes_store(wave_speed + s,
                     mpmi_lanes_load(wave_speed + s) * (squared ? most : mpmi_lanes_sqrt(most)));
    if (viscosity) mpmi_lanes_store(viscosity + s, mpmi_lanes_load(viscosity + s) * most);
  }
}

#define BY_DIM(dim)                                                                                          \
  static void spatial_##dim(const double *const *F, int64_t ld, double *L, int64_t n) {                      \
    spatial(dim, F, ld, L, n);                                                                               \
  }                                                                                                          \
  static void speeds_##dim(const double *const *F, int32_t squared, double *wave_speed, double *viscosity,   \
                           int64_t n) {                                                                      \
    speeds(dim, F, squared, wave_speed, viscosity, n);                                                       \
  }
BY_DIM(1)
BY_DIM(2)
BY_DIM(3)

const mpmi_pull_back KERNEL(pull_back) = {
    .spatial = {NULL, spatial_1, spatial_2, spatial_3},
    .speeds = {NULL, speeds_1, speeds_2, speeds_3},
};
