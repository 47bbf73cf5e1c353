/* Weights of a chunk: one call of the basis per axis, then the place of each stencil in the tile. */
#include "transfer/kernel_common.h"

void KERNEL(weights)(int32_t dim, int32_t width, const mpmi_axis *axis, mpmi_axis_weights_fn axis_weights,
                     int32_t need, int64_t n, const double *const *x, mpmi_weights *out) {
  _Alignas(64) double first[3][MPMI_CHUNK];
  const double edge = MPMI_TILE_EDGE(dim, width);
  for (int32_t k = 0; k < dim; ++k)
    axis_weights(axis + k, n, x[k], need, out->w[k], out->g[k], out->u[k], out->moment[k], first[k]);
  for (int32_t k = 1; k < dim; ++k)
    MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) first[0][p] = first[0][p] * edge + first[k][p];
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) out->node[p] = (int32_t)first[0][p];
}
