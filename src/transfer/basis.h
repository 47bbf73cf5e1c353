/* What every basis has in common. A basis is a file that defines
 *
 *   MPMI_INLINE void NAME_axis(const mpmi_axis *axis, int64_t n, const mpmi_chunk *at, int32_t gradient,
 *                              mpmi_stencils *out)
 *
 * for n particles along one axis: weights w[k], their gradients g[k] when asked for, the distance in cells
 * from the particle to the first node of its stencil, and the place of that node in the tile; then says
 * MPMI_BASIS(NAME, width, EVEN) when its nodes are a spacing apart, and MPMI_BASIS(NAME, width, UNEVEN) when
 * it gives the distance of each node. Or, where a position is all that it needs and its nodes are a spacing
 * apart, it defines
 *
 *   MPMI_INLINE mpmi_lanes NAME_lanes(const mpmi_axis *axis, mpmi_lanes x, int32_t gradient, mpmi_lanes *w,
 *                                     mpmi_lanes *g, mpmi_lanes *first)
 *
 * for as many particles as a register holds, which returns the place, and says MPMI_BASIS_LANES(NAME, width).
 * kernels.c lists it. */
#ifndef MPMI_BASIS_H
#define MPMI_BASIS_H

#include "simd/rounding.h"
#include "transfer/weights.h"

/* Below this share of h^2 an axis has no usable second moment and carries no affine part. */
#define MPMI_MOMENT_CUT 1e-8

/* A particle that reaches less than this far, in cells, beyond where a node's function begins does not reach
 * it. Fills put particles so that they end there, and rounding must not decide whether a node has a weight:
 * one of 1e-33 has a velocity as others do, which counts where gradients do (USL). Weights jump by 1e-20. */
#define MPMI_LEAST_REACH MPMI_HAIR

enum { EVEN, UNEVEN };

/* A chunk of particles along one axis. size, stretch: see mpmi_points. */
typedef struct mpmi_chunk {
  const double *x, *size, *stretch;
} mpmi_chunk;

/* Holds the stencils of a chunk along an axis, in component arrays. */
typedef struct mpmi_stencils {
  double (*w)[MPMI_CHUNK], (*g)[MPMI_CHUNK], *first, *place;
  double (*distance)[MPMI_CHUNK]; /* from the particle to each node, in cells; UNEVEN only */
} mpmi_stencils;

/* Computes from w and the distances d_k of the nodes from the particle: D = sum w_k d_k^2, its inverse, and
 * u_k = w_k d_k; the MLS form puts u_k / D in the place of the gradient. */
MPMI_INLINE void mpmi_moments(int32_t width, int32_t spaced, double h, int32_t need, int64_t n,
                              const mpmi_stencils *at, double (*u)[MPMI_CHUNK], double *inverse_moment) {
  const double cut = MPMI_MOMENT_CUT * h * h;
  double(*w)[MPMI_CHUNK] = at->w;
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    double D = 0.0;
    for (int32_t k = 0; k < width; ++k) {
      double d = (spaced == EVEN ? at->first[p] + k : at->distance[k][p]) * h, ud = w[k][p] * d;
      u[k][p] = ud;
      D += ud * d;
    }
    inverse_moment[p] = D > cut ? 1.0 / D : 0.0;
  }
  if (need & MPMI_NEED_MLS)
    for (int32_t k = 0; k < width; ++k)
      MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) at->g[k][p] = u[k][p] * inverse_moment[p];
}

/* Moves the first nodes of stencils, which are relative to the tile, to the periodic image that lies in the
 * tile. */
MPMI_INLINE void mpmi_into_tile(const mpmi_axis *a, int64_t n, double *place) {
  if (a->period > 0.0) MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
      double at = place[p];
      place[p] = at - a->period * mpmi_round((at - a->middle) * a->inverse_period);
    }
}

/* Return the cells that hold particles at xi; the last one for those on the upper face. */
MPMI_INLINE double mpmi_cell(const mpmi_axis *a, double xi) {
  const double cell = mpmi_floor(xi);
  return cell > a->last_cell ? a->last_cell : cell;
}
MPMI_INLINE mpmi_lanes mpmi_lanes_cell(const mpmi_axis *a, mpmi_lanes xi) {
  const mpmi_lanes zero = {0.0}, cell = mpmi_lanes_floor(xi), last = zero + a->last_cell;
  return mpmi_lanes_min(cell, last);
}

/* Finds the place of each stencil in the tile. */
MPMI_INLINE void mpmi_find_nodes(int32_t dim, int32_t width, int64_t n, double (*place)[MPMI_CHUNK],
                                 int32_t *node) {
  const double edge = MPMI_TILE_EDGE(dim, width);
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    double at = place[0][p];
    if (dim > 1) at = at * edge + place[1][p];
    if (dim > 2) at = at * edge + place[2][p];
    node[p] = (int32_t)at;
  }
}

#define MPMI_BASIS_IN(dim, name, width, spaced)                                                              \
  void KERNEL(name##_##dim)(const mpmi_axis *axis, int32_t need, const mpmi_points *points, int64_t begin,   \
                            int64_t n, mpmi_weights *W);                                                     \
  void KERNEL(name##_##dim)(const mpmi_axis *axis, int32_t need, const mpmi_points *points, int64_t begin,   \
                            int64_t n, mpmi_weights *W) {                                                    \
    _Alignas(64) double place[3][MPMI_CHUNK];                                                                \
    for (int32_t k = 0; k < (dim); ++k) {                                                                    \
      const mpmi_chunk at = {points->x[k] + begin, points->size[k] ? points->size[k] + begin : NULL,         \
                             points->stretch[k] ? points->stretch[k] + begin : NULL};                        \
      const mpmi_stencils out = {W->w[k], W->g[k], W->first[k], place[k], W->u[k]};                          \
      if (need & MPMI_NEED_GRADIENT)                                                                         \
        name##_axis(axis + k, n, &at, 1, &out);                                                              \
      else                                                                                                   \
        name##_axis(axis + k, n, &at, 0, &out);                                                              \
      if (need & (MPMI_NEED_MOMENT | MPMI_NEED_MLS))                                                         \
        mpmi_moments(width, spaced, axis[k].spacing, need, n, &out, W->u[k], W->inverse_moment[k]);          \
    }                                                                                                        \
    if (!(need & MPMI_NO_PLACE)) mpmi_find_nodes(dim, width, n, place, W->node);                             \
  }
#define MPMI_BASIS(name, width, spaced)                                                                      \
  MPMI_BASIS_IN(1, name, width, spaced)                                                                      \
  MPMI_BASIS_IN(2, name, width, spaced)                                                                      \
  MPMI_BASIS_IN(3, name, width, spaced)

/* The weights of a chunk a register at a time: all axes of some particles before the next ones, so that what
 * leads from a position to the place of its stencil stays in registers. */
#define MPMI_BASIS_LANES_IN(dim, name, width)                                                                \
  MPMI_INLINE void name##_chunk_##dim(const mpmi_axis *axis, int32_t gradient, int32_t placed,               \
                                      int32_t keeps_first, const mpmi_points *points, int64_t begin,         \
                                      int64_t n, mpmi_weights *W) {                                          \
    const double edge = MPMI_TILE_EDGE(dim, width);                                                          \
    for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_LANES) {                                         \
      mpmi_lanes node = {0.0};                                                                               \
      for (int32_t k = 0; k < (dim); ++k) {                                                                  \
        const mpmi_axis *a = axis + k;                                                                       \
        mpmi_lanes w[width], g[width], first;                                                                \
        mpmi_lanes place =                                                                                   \
            name##_lanes(a, mpmi_lanes_load(points->x[k] + begin + s), gradient, w, g, &first);              \
        if (a->period > 0.0) place -= a->period * mpmi_lanes_round((place - a->middle) * a->inverse_period); \
        for (int32_t i = 0; i < (width); ++i) {                                                              \
          mpmi_lanes_store(W->w[k][i] + s, w[i]);                                                            \
          if (gradient) mpmi_lanes_store(W->g[k][i] + s, g[i]);                                              \
        }                                                                                                    \
        if (keeps_first) mpmi_lanes_store(W->first[k] + s, first);                                           \
        node = k ? node * edge + place : place;                                                              \
      }                                                                                                      \
      if (placed) mpmi_lanes_store_int32(W->node + s, node);                                                 \
    }                                                                                                        \
  }                                                                                                          \
  void KERNEL(name##_##dim)(const mpmi_axis *axis, int32_t need, const mpmi_points *points, int64_t begin,   \
                            int64_t n, mpmi_weights *W);                                                     \
  void KERNEL(name##_##dim)(const mpmi_axis *axis, int32_t need, const mpmi_points *points, int64_t begin,   \
                            int64_t n, mpmi_weights *W) {                                                    \
    if (need & MPMI_NO_PLACE)                                                                                \
      name##_chunk_##dim(axis, (need & MPMI_NEED_GRADIENT) != 0, 0, 1, points, begin, n, W);                 \
    else if (need & MPMI_NO_FIRST)                                                                           \
      name##_chunk_##dim(axis, !mpmi_gradients_alike(dim, width), 1, 0, points, begin, n, W);                \
    else if (need & MPMI_NEED_GRADIENT)                                                                      \
      name##_chunk_##dim(axis, 1, 1, 1, points, begin, n, W);                                                \
    else                                                                                                     \
      name##_chunk_##dim(axis, 0, 1, 1, points, begin, n, W);                                                \
    for (int32_t k = 0; k < (dim) && need & (MPMI_NEED_MOMENT | MPMI_NEED_MLS); ++k) {                       \
      const mpmi_stencils at = {W->w[k], W->g[k], W->first[k], NULL, NULL};                                  \
      mpmi_moments(width, EVEN, axis[k].spacing, need, n, &at, W->u[k], W->inverse_moment[k]);               \
    }                                                                                                        \
  }
#define MPMI_BASIS_LANES(name, width)                                                                        \
  MPMI_BASIS_LANES_IN(1, name, width)                                                                        \
  MPMI_BASIS_LANES_IN(2, name, width)                                                                        \
  MPMI_BASIS_LANES_IN(3, name, width)

#endif
