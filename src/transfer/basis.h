/* What every basis has in common. A basis is a file that defines
 *
 *   MPMI_INLINE void NAME_axis(const mpmi_axis *axis, int64_t n, const double *x, int32_t gradient,
 *                              double (*w)[MPMI_CHUNK], double (*g)[MPMI_CHUNK], double *first, double
 * *place)
 *
 * for n particles along one axis: weights w[k], their gradients g[k] when asked for, the distance in cells
 * from the particle to the first node of its stencil, and the place of that node in the tile; then says
 * MPMI_BASIS(NAME, width). kernels.c lists it. */
#ifndef MPMI_BASIS_H
#define MPMI_BASIS_H

#include "transfer/kernel_common.h"

/* Below this share of h^2 an axis has no usable second moment and carries no affine part. */
#define MPMI_MOMENT_CUT 1e-8

/* From w and the distance d_k = (first + k) h of node k from the particle: D = sum w_k d_k^2, its inverse,
 * and u_k = w_k d_k; the MLS form puts u_k / D in the place of the gradient. */
MPMI_INLINE void mpmi_moments(int32_t width, double h, int32_t need, int64_t n, double (*w)[MPMI_CHUNK],
                              double (*g)[MPMI_CHUNK], double (*u)[MPMI_CHUNK], const double *first,
                              double *inverse_moment) {
  const double cut = MPMI_MOMENT_CUT * h * h;
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
    double D = 0.0;
    for (int32_t k = 0; k < width; ++k) {
      double d = (first[p] + k) * h, ud = w[k][p] * d;
      u[k][p] = ud;
      D += ud * d;
    }
    inverse_moment[p] = D > cut ? 1.0 / D : 0.0;
  }
  if (need & MPMI_NEED_MLS)
    for (int32_t k = 0; k < width; ++k)
      MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) g[k][p] = u[k][p] * inverse_moment[p];
}

/* The first nodes of stencils, relative to the tile, in the periodic image that lies in the tile. */
MPMI_INLINE void mpmi_into_tile(const mpmi_axis *a, int64_t n, double *place) {
  if (a->period > 0.0) MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
      double at = place[p];
      place[p] = at - a->period * mpmi_round((at - a->middle) * a->inverse_period);
    }
}

/* Place of each stencil in the tile. */
MPMI_INLINE void mpmi_find_nodes(int32_t dim, int32_t width, int64_t n, double (*place)[MPMI_CHUNK],
                                 int32_t *node) {
  const double edge = MPMI_TILE_EDGE(dim, width);
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
    double at = place[0][p];
    if (dim > 1) at = at * edge + place[1][p];
    if (dim > 2) at = at * edge + place[2][p];
    node[p] = (int32_t)at;
  }
}

#define MPMI_BASIS_IN(dim, name, width)                                                                      \
  void KERNEL(name##_##dim)(const mpmi_axis *axis, int32_t need, int64_t n, const double *const *x,          \
                            mpmi_weights *W);                                                                \
  void KERNEL(name##_##dim)(const mpmi_axis *axis, int32_t need, int64_t n, const double *const *x,          \
                            mpmi_weights *W) {                                                               \
    _Alignas(64) double place[3][MPMI_CHUNK];                                                                \
    for (int32_t k = 0; k < (dim); ++k) {                                                                    \
      if (need & MPMI_NEED_GRADIENT)                                                                         \
        name##_axis(axis + k, n, x[k], 1, W->w[k], W->g[k], W->first[k], place[k]);                          \
      else                                                                                                   \
        name##_axis(axis + k, n, x[k], 0, W->w[k], W->g[k], W->first[k], place[k]);                          \
      if (need & (MPMI_NEED_MOMENT | MPMI_NEED_MLS))                                                         \
        mpmi_moments(width, axis[k].spacing, need, n, W->w[k], W->g[k], W->u[k], W->first[k],                \
                     W->inverse_moment[k]);                                                                  \
    }                                                                                                        \
    mpmi_find_nodes(dim, width, n, place, W->node);                                                          \
  }
#define MPMI_BASIS(name, width)                                                                              \
  MPMI_BASIS_IN(1, name, width)                                                                              \
  MPMI_BASIS_IN(2, name, width)                                                                              \
  MPMI_BASIS_IN(3, name, width)

#endif
