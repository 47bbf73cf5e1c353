/* Separating planes (Nairn, Hammerquist & Smith 2020). The discriminant is that of Fisher: the direction in
 * which the means are farthest apart, measured by the scatter within the clouds. The logistic regression is
 * by likelihood, which is convex, with both clouds of the same weight:
 *
 *   minimise  sum_p omega_p (-y_p ln s_p - (1 - y_p) ln (1 - s_p)) + lambda / 2 |beta|^2,
 *   s = 1 / (1 + exp(-beta . x - beta_0)),  y = 0 on the first cloud and 1 on the second. */
#include "simd/chunk.h"
#include "simd/lanes.h"
#include "simd/vector_math.h"
#include "transfer/separation.h"

#include <math.h>

/* Solves the symmetric positive definite system A x = b of n equations, and leaves x in b; returns 0 if it
 * is not definite. A is [4][4]. */
MPMI_INLINE int32_t solve(int32_t n, double (*A)[4], double *b) {
  for (int32_t i = 0; i < n; ++i) {
    if (!(A[i][i] > 0.0)) return 0;
    for (int32_t r = i + 1; r < n; ++r) {
      const double factor = A[r][i] / A[i][i];
      for (int32_t c = i; c < n; ++c) A[r][c] -= factor * A[i][c];
      b[r] -= factor * b[i];
    }
  }
  for (int32_t i = n - 1; i >= 0; --i) {
    for (int32_t c = i + 1; c < n; ++c) b[i] -= A[i][c] * b[c];
    b[i] /= A[i][i];
  }
  return 1;
}

/* Weighted mean of a cloud and the scatter around it; returns the sum of weights. */
MPMI_INLINE double moments(int32_t dim, const mpmi_separation *in, int32_t cloud, double *mean,
                           double (*scatter)[4]) {
  mpmi_lanes weight = {0.0}, first[3] = {{0.0}}, second[3][3] = {{{0.0}}};
  const int64_t begin = in->first[cloud], end = begin + in->padded[cloud];
  for (int64_t s = begin; s < end; s += MPMI_LANES) {
    const mpmi_lanes w = mpmi_lanes_load(in->weight + s);
    mpmi_lanes x[3];
    weight += w;
    for (int32_t k = 0; k < dim; ++k) {
      x[k] = mpmi_lanes_load(in->x[k] + s);
      first[k] += w * x[k];
      for (int32_t l = 0; l <= k; ++l) second[k][l] += w * x[k] * x[l];
    }
  }
  const double sum = mpmi_lanes_sum(weight), inverse = sum > 0.0 ? 1.0 / sum : 0.0;
  for (int32_t k = 0; k < dim; ++k) mean[k] = mpmi_lanes_sum(first[k]) * inverse;
  for (int32_t k = 0; k < dim; ++k)
    for (int32_t l = 0; l <= k; ++l) {
      double of = mpmi_lanes_sum(second[k][l]) * inverse - mean[k] * mean[l];
      if (k == l) of += in->ball[cloud][k] * inverse;
      scatter[k][l] += of;
      if (k != l) scatter[l][k] += of;
    }
  return sum;
}

/* The plane starts steep, four times the unit direction, and half-way between the means. */
MPMI_INLINE int32_t discriminate(int32_t dim, mpmi_separation *io) {
  double mean[2][3], scatter[4][4] = {{0.0}}, direction[3] = {0.0, 0.0, 0.0}, squared = 0.0, apart = 0.0;
  const double steep = 4.0, at_one_place = 1e-20; /* squares of cells: means that differ by rounding */
  for (int32_t c = 0; c < 2; ++c)
    if (!(moments(dim, io, c, mean[c], scatter) > 0.0)) return 0;
  for (int32_t k = 0; k < dim; ++k) {
    direction[k] = mean[1][k] - mean[0][k];
    apart += direction[k] * direction[k];
  }
  if (!(apart > at_one_place) || !solve(dim, scatter, direction)) return 0;
  for (int32_t k = 0; k < dim; ++k) squared += direction[k] * direction[k];
  if (!(squared > 0.0) || !(squared - squared == 0.0)) return 0;
  io->plane[0] = io->plane[1] = io->plane[2] = io->plane[3] = 0.0;
  for (int32_t k = 0; k < dim; ++k) {
    io->plane[k] = steep * direction[k] / sqrt(squared);
    io->plane[3] -= 0.5 * io->plane[k] * (mean[0][k] + mean[1][k]);
  }
  return 1;
}

/* Sums of a Newton step: gradient and Hessian in the coefficients of the plane, the last of them beta_0. */
typedef struct newton_sums {
  mpmi_lanes gradient[4], hessian[4][4];
} newton_sums;

MPMI_INLINE void add_chunk(int32_t dim, const mpmi_separation *in, int64_t s, double y, double omega,
                           newton_sums *sums) {
  double slope[MPMI_CHUNK], curvature[MPMI_CHUNK];
  MPMI_IVDEP for (int64_t p = 0; p < MPMI_CHUNK; ++p) {
    double t = in->plane[3];
    for (int32_t k = 0; k < dim; ++k) t += in->plane[k] * in->x[k][s + p];
    t = mpmi_min(mpmi_max(t, -30.0), 30.0);
    const double share = 1.0 / (1.0 + mpmi_lane_exp_within(-t)), of = in->weight[s + p] > 0.0 ? omega : 0.0;
    slope[p] = of * (y - share);
    curvature[p] = of * share * (1.0 - share);
  }
  for (int32_t p = 0; p < MPMI_CHUNK; p += MPMI_LANES) {
    const mpmi_lanes r = mpmi_lanes_load(slope + p), h = mpmi_lanes_load(curvature + p);
    mpmi_lanes x[3];
    for (int32_t k = 0; k < dim; ++k) {
      x[k] = mpmi_lanes_load(in->x[k] + s + p);
      sums->gradient[k] += r * x[k];
      sums->hessian[dim][k] += h * x[k];
      for (int32_t l = 0; l <= k; ++l) sums->hessian[k][l] += h * x[k] * x[l];
    }
    sums->gradient[dim] += r;
    sums->hessian[dim][dim] += h;
  }
}

/* Makes one Newton step; without the bound on its length the iteration may diverge. Returns 0 when the system
 * is not definite. */
MPMI_INLINE int32_t newton_step(int32_t dim, mpmi_separation *io) {
  const double penalty = 1e-3, floor_of_hessian = 1e-9, longest = 4.0;
  const double all = (double)(io->count[0] + io->count[1]);
  newton_sums sums = {{{0.0}}, {{{0.0}}}};
  for (int32_t c = 0; c < 2; ++c)
    for (int64_t s = io->first[c]; s < io->first[c] + io->padded[c]; s += MPMI_CHUNK)
      add_chunk(dim, io, s, (double)c, 0.5 * all / (double)io->count[c], &sums);
  double A[4][4], b[4], largest = 0.0;
  for (int32_t k = 0; k <= dim; ++k) {
    b[k] = mpmi_lanes_sum(sums.gradient[k]) - (k < dim ? penalty * io->plane[k] : 0.0);
    for (int32_t l = 0; l <= k; ++l) A[k][l] = A[l][k] = mpmi_lanes_sum(sums.hessian[k][l]);
    A[k][k] += floor_of_hessian + (k < dim ? penalty : 0.0);
  }
  if (!solve(dim + 1, A, b)) return 0;
  for (int32_t k = 0; k <= dim; ++k) largest = mpmi_max(largest, fabs(b[k]));
  const double scale = largest > longest ? longest / largest : 1.0;
  for (int32_t k = 0; k < dim; ++k) io->plane[k] += scale * b[k];
  io->plane[3] += scale * b[dim];
  return 1;
}

MPMI_INLINE double inner(int32_t dim, const double *a, const double *b) {
  double sum = 0.0;
  for (int32_t k = 0; k < dim; ++k) sum += a[k] * b[k];
  return sum;
}

MPMI_INLINE int32_t fit(int32_t dim, mpmi_separation *io) {
  enum { MOST = 30 };
  const double settled = 1e-6; /* 1 - the cosine between directions that follow each other */
  for (int32_t i = 0; i < MOST; ++i) {
    const double before[3] = {io->plane[0], io->plane[1], io->plane[2]};
    if (!newton_step(dim, io)) return 0;
    const double lengths = sqrt(inner(dim, before, before)) * sqrt(inner(dim, io->plane, io->plane));
    if (!(lengths > 0.0) || !(lengths - lengths == 0.0)) return 0;
    if (1.0 - inner(dim, before, io->plane) / lengths < settled) break;
  }
  return 1;
}

MPMI_INLINE void project(int32_t dim, const mpmi_separation *in, const double *spacing, const double *n,
                         double limit, double *far, double *most) {
  const mpmi_lanes zero = {0.0}, none = zero - (double)INFINITY;
  double cells[3] = {0.0, 0.0, 0.0}; /* the line, in cells for a unit of length */
  for (int32_t k = 0; k < dim; ++k) cells[k] = n[k] / spacing[k];
  for (int32_t c = 0; c < 2; ++c) {
    mpmi_lanes farthest = none;
    for (int64_t p = in->first[c]; p < in->first[c] + in->padded[c]; p += MPMI_LANES) {
      mpmi_lanes sum = zero, beside = zero;
      for (int32_t k = 0; k < dim; ++k) sum += mpmi_lanes_load(in->x[k] + p) * spacing[k] * n[k];
      for (int32_t k = 0; k < dim; ++k) {
        const mpmi_lanes x = mpmi_lanes_load(in->x[k] + p) - sum * cells[k];
        beside += x * x;
      }
      const mpmi_lanes weight = mpmi_lanes_load(in->weight + p);
      const mpmi_lanes reach = mpmi_lanes_select((weight > 0.0) & (beside <= limit), c ? -sum : sum, none);
      mpmi_lanes_store(far + p, reach);
      farthest = mpmi_lanes_max(farthest, reach);
    }
    most[c] = mpmi_lanes_largest(farthest);
  }
}

#define SEPARATION(dim)                                                                                      \
  int32_t KERNEL(discriminate_##dim)(mpmi_separation * clouds);                                              \
  int32_t KERNEL(discriminate_##dim)(mpmi_separation * clouds) {                                             \
    return discriminate(dim, clouds);                                                                        \
  }                                                                                                          \
  int32_t KERNEL(fit_##dim)(mpmi_separation * clouds);                                                       \
  int32_t KERNEL(fit_##dim)(mpmi_separation * clouds) {                                                      \
    return fit(dim, clouds);                                                                                 \
  }                                                                                                          \
  void KERNEL(project_##dim)(const mpmi_separation *clouds, const double *spacing, const double *n,          \
                             double limit, double *far, double *most);                                       \
  void KERNEL(project_##dim)(const mpmi_separation *clouds, const double *spacing, const double *n,          \
                             double limit, double *far, double *most) {                                      \
    project(dim, clouds, spacing, n, limit, far, most);                                                      \
  }
SEPARATION(1)
SEPARATION(2)
SEPARATION(3)
