/* Weights of a chunk: the basis along each axis, what the affine transfers make of it, and the place of each
 * stencil in the tile. */
#include "transfer/kernel_common.h"

/* Below this share of h^2 an axis has no usable second moment and carries no affine part. */
#define MOMENT_CUT 1e-8

/* From w and the distance d_k = (first + k) h of node k from the particle: D = sum w_k d_k^2, its inverse,
 * and u_k = w_k d_k; the MLS form puts u_k / D in the place of the gradient. */
MPMI_INLINE void moments(int32_t width, double h, int32_t need, int64_t n, double (*w)[MPMI_CHUNK],
                         double (*g)[MPMI_CHUNK], double (*u)[MPMI_CHUNK], const double *first,
                         double *inverse_moment) {
  const double cut = MOMENT_CUT * h * h;
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

MPMI_INLINE void all_axes(int32_t dim, int32_t width, const mpmi_axis *axis,
                          mpmi_axis_weights_fn axis_weights, int32_t need, int64_t n, const double *const *x,
                          mpmi_weights *out) {
  _Alignas(64) double place[3][MPMI_CHUNK];
  const double edge = MPMI_TILE_EDGE(dim, width);
  for (int32_t k = 0; k < dim; ++k) {
    axis_weights(axis + k, n, x[k], need & MPMI_NEED_GRADIENT, out->w[k], out->g[k], out->first[k], place[k]);
    if (need & (MPMI_NEED_MOMENT | MPMI_NEED_MLS))
      moments(width, axis[k].spacing, need, n, out->w[k], out->g[k], out->u[k], out->first[k],
              out->inverse_moment[k]);
  }
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
    double node = place[0][p];
    for (int32_t k = 1; k < dim; ++k) node = node * edge + place[k][p];
    out->node[p] = (int32_t)node;
  }
}

#define WEIGHTS(dim, width)                                                                                  \
  void KERNEL(weights_##dim##_##width)(const mpmi_axis *axis, mpmi_axis_weights_fn axis_weights,             \
                                       int32_t need, int64_t n, const double *const *x, mpmi_weights *out) { \
    all_axes(dim, width, axis, axis_weights, need, n, x, out);                                               \
  }
#include "transfer/instances.h"
