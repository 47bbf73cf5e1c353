/* The volume change of particles, measured and exchanged for the mean of their cell: what the locking remedy
 * (stages/locking.c) does to each of them. */
#include "material/dilation.h"
#include "simd/chunk.h"
#include "simd/tensor.h"
#include "simd/vector_math.h"

#include <math.h>

/* x^(1/d) of x = 1 + growth, less 1. */
MPMI_INLINE double root_minus_1(int32_t dim, double growth) {
  if (dim == 1) return growth;
  if (dim == 2) return growth / (1.0 + sqrt(1.0 + growth));
  return mpmi_lane_expm1((1.0 / 3.0) * mpmi_lane_log1p(growth));
}

MPMI_INLINE void measure(int32_t dim, const double *L, int64_t ld, double dt, int64_t n, double *out) {
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    const double j = mpmi_det_minus_1(dim, mpmi_load_mat(dim, L, ld, p, 0.0, dt));
    out[p] = j - j == 0.0 ? j : 0.0;
  }
}

MPMI_INLINE void exchange(int32_t dim, const mpmi_exchange *job, int64_t n) {
  const double dt = job->dt, per_dt = 1.0 / dt;
  const double *mean = job->mean, *old = job->old_ratio;
  double *ratio = job->ratio, *L = job->L, *F_inc = job->F_inc;
  const int64_t ld = job->ld;
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    const double j = mpmi_det_minus_1(dim, mpmi_load_mat(dim, L, ld, p, 0.0, dt));
    /* a mean that is not a number changes nothing; an inverted increment ends the step elsewhere */
    const double change = (mean[p] - j) / (1.0 + j), known = mean[p] > -1.0 ? change : 0.0;
    const double growth = j > -1.0 ? known : 0.0;
    const double stretch = root_minus_1(dim, growth);
    ratio[p] = old[p] * (1.0 + growth);
    for (int32_t r = 0; r < dim; ++r)
      for (int32_t c = 0; c < dim; ++c) {
        const int64_t at = (3 * r + c) * ld + p;
        const double rate = L[at] + stretch * (L[at] + (r == c ? per_dt : 0.0));
        L[at] = rate;
        F_inc[at] = (r == c ? 1.0 : 0.0) + dt * rate;
      }
  }
}

MPMI_INLINE void scale(int32_t dim, double *F, int64_t ld, const double *ratio, int64_t n) {
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    const double f = dim == 1   ? ratio[p]
                     : dim == 2 ? sqrt(ratio[p])
                                : mpmi_lane_exp((1.0 / 3.0) * mpmi_lane_log(ratio[p]));
    for (int32_t r = 0; r < dim; ++r)
      for (int32_t c = 0; c < dim; ++c) F[(3 * r + c) * ld + p] *= f;
  }
}

#define BY_DIM(dim)                                                                                          \
  static void measure_##dim(const double *L, int64_t ld, double dt, int64_t n, double *out) {                \
    measure(dim, L, ld, dt, n, out);                                                                         \
  }                                                                                                          \
  static void exchange_##dim(const mpmi_exchange *job, int64_t n) {                                          \
    exchange(dim, job, n);                                                                                   \
  }                                                                                                          \
  static void scale_##dim(double *F, int64_t ld, const double *ratio, int64_t n) {                           \
    scale(dim, F, ld, ratio, n);                                                                             \
  }
BY_DIM(1)
BY_DIM(2)
BY_DIM(3)

const mpmi_dilation KERNEL(dilation) = {.measure = {NULL, measure_1, measure_2, measure_3},
                                        .exchange = {NULL, exchange_1, exchange_2, exchange_3},
                                        .scale = {NULL, scale_1, scale_2, scale_3}};
