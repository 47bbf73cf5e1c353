/* The scatter of four values of a particle by the weights alone. */
#ifndef MPMI_PLAIN_H
#define MPMI_PLAIN_H

#include "simd/vector.h"
#include "transfer/weights.h"

MPMI_INLINE void mpmi_scatter_plain(int32_t dim, int32_t width, const mpmi_weights *W, int64_t p,
                                    const double *values, double *restrict stencil) {
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1;
  const mpmi_node a = mpmi_node_load(MPMI_LOW, values);
  MPMI_UNROLL for (int32_t i = 0; i < width; ++i) {
    if (dim < 3 && i > 0) break;
    MPMI_UNROLL for (int32_t j = 0; j < width; ++j) {
      if (dim < 2 && j > 0) break;
      double outer = dim == 3 ? W->w[0][i][p] * W->w[1][j][p] : dim == 2 ? W->w[0][j][p] : 1.0;
      const mpmi_node row = mpmi_node_scale(MPMI_LOW, outer, a);
      double *node = stencil + 4 * (i * edge + j) * (dim == 1 ? 0 : edge);
      MPMI_UNROLL for (int32_t k = 0; k < width; ++k) {
        mpmi_node q = mpmi_node_load(MPMI_LOW, node + 4 * k);
        mpmi_node_store(MPMI_LOW, node + 4 * k, mpmi_node_fma(MPMI_LOW, q, W->w[last][k][p], row));
      }
    }
  }
}

#endif
