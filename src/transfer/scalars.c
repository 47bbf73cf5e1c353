/* Scalars between particles and nodes.
 *
 *   given   n_i += w_ip a_p                  taken   a_p = sum w_ip n_i
 *   flows   f_i += k_p V_p grad w_ip . A_p sum grad w_jp T_j
 *
 * Stencils are summed over the outer axes, a row of nodes at a time. What is left of each particle then is
 * one row of nodes, and those of several particles are summed side by side. */
#include "transfer/scalars.h"
#include "material/pull_back.h"
#include "simd/pack.h"
#include "transfer/plain.h"

/* Rows of the particles of a chunk: of what they take by the weights of the outer axes, and by the gradients
 * along each of them; or of the weights along the last axis. */
typedef struct mpmi_rows {
  _Alignas(64) double w[4 * MPMI_CHUNK], g[2][4 * MPMI_CHUNK];
} mpmi_rows;

_Alignas(64) static const double no_node[MPMI_CHUNK] = {0.0};

/* ---- from the nodes ------------------------------------------------------------------------------------ */
/* Sums a field over the outer axes; slopes: with their gradients, too. */
MPMI_INLINE void sum_outer(int32_t dim, int32_t width, int32_t slopes, const mpmi_weights *W, int64_t p,
                           const double *field, mpmi_rows *to) {
  const int32_t edge = MPMI_TILE_EDGE(dim, width), mid = dim >= 2 ? dim - 2 : 0;
  const double *stencil = field + W->node[p];
  MPMI_SETTLE(stencil);
  mpmi_v4 sum = mpmi_zero4(), g[2] = {mpmi_zero4(), mpmi_zero4()};
  MPMI_UNROLL for (int32_t i = 0; i < width; ++i) {
    if (dim < 3 && i > 0) break;
    mpmi_v4 plane = mpmi_zero4(), slope = mpmi_zero4();
    MPMI_UNROLL for (int32_t j = 0; j < width; ++j) {
      if (dim < 2 && j > 0) break;
      const mpmi_v4 row = mpmi_load4(stencil + (i * edge + j) * (dim == 1 ? 0 : edge));
      if (dim == 1) {
        plane = row;
        continue;
      }
      plane = j ? mpmi_fma4(plane, W->w[mid][j][p], row) : mpmi_scale4(W->w[mid][j][p], row);
      if (slopes) slope = j ? mpmi_fma4(slope, W->g[mid][j][p], row) : mpmi_scale4(W->g[mid][j][p], row);
    }
    if (dim < 3) {
      sum = plane, g[0] = slope;
      continue;
    }
    const double w = W->w[0][i][p];
    sum = i ? mpmi_fma4(sum, w, plane) : mpmi_scale4(w, plane);
    if (slopes) g[1] = i ? mpmi_fma4(g[1], w, slope) : mpmi_scale4(w, slope);
    if (slopes) g[0] = i ? mpmi_fma4(g[0], W->g[0][i][p], plane) : mpmi_scale4(W->g[0][i][p], plane);
  }
  mpmi_store4(to->w + 4 * p, sum);
  for (int32_t k = 0; slopes && k < dim - 1; ++k) mpmi_store4(to->g[k] + 4 * p, g[k]);
}

/* Sums rows over their nodes, with weights along the last axis, from particle q on. */
MPMI_INLINE mpmi_lanes sum_rows(int32_t width, const double *rows, const double (*weight)[MPMI_CHUNK],
                                int64_t q) {
  mpmi_lanes node[4];
  mpmi_separate(rows + 4 * q, node);
  mpmi_lanes sum = mpmi_lanes_load(weight[0] + q) * node[0];
  for (int32_t k = 1; k < width; ++k) sum += mpmi_lanes_load(weight[k] + q) * node[k];
  return sum;
}

MPMI_INLINE void take_values(int32_t dim, int32_t width, const mpmi_scalars *at, int64_t begin, int64_t n,
                             const double *field, double *to) {
  mpmi_weights W;
  mpmi_rows rows;
  for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_CHUNK) {
    at->weights(at->axis, 0, &at->points, begin + s, MPMI_CHUNK, &W);
    for (int64_t p = 0; p < MPMI_CHUNK; ++p) sum_outer(dim, width, 0, &W, p, field, &rows);
    for (int64_t q = 0; q < MPMI_CHUNK; q += MPMI_LANES)
      mpmi_lanes_store(to + s + q, sum_rows(width, rows.w, (const double(*)[MPMI_CHUNK])W.w[dim - 1], q));
  }
}

/* ---- to the nodes -------------------------------------------------------------------------------------- */
MPMI_INLINE void give_values(int32_t dim, int32_t width, const mpmi_scalars *at, int64_t begin, int64_t n,
                             const double *const *value, double *tile) {
  mpmi_weights W;
  _Alignas(64) double of[4 * MPMI_CHUNK];
  for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_CHUNK) {
    at->weights(at->axis, 0, &at->points, begin + s, MPMI_CHUNK, &W);
    mpmi_pack(MPMI_CHUNK, (const double *[4]){value[0] + s, value[1] + s, value[2] + s, value[3] + s}, of);
    for (int64_t p = 0; p < MPMI_CHUNK; ++p) {
      double *stencil = tile + 4 * (int64_t)W.node[p];
      MPMI_SETTLE(stencil);
      mpmi_scatter_plain(dim, width, &W, p, of + 4 * p, stencil);
    }
  }
}

/* ---- conduction ---------------------------------------------------------------------------------------- */
/* A of the particles of a chunk, times k V. */
typedef struct mpmi_metric {
  _Alignas(64) double at[3][3][MPMI_CHUNK];
} mpmi_metric;

MPMI_INLINE void find_metric(int32_t dim, int32_t total, const mpmi_conduction *job, int64_t begin, int64_t s,
                             mpmi_metric *to) {
  for (int64_t q = 0; q < MPMI_CHUNK; q += MPMI_LANES) {
    const mpmi_lanes k_V = mpmi_lanes_load(job->conductance + s + q), zero = {0.0};
    mpmi_lanes inverse[3][3];
    if (total) mpmi_inverse_load(dim, job->F, begin + s + q, inverse);
    for (int32_t i = 0; i < dim; ++i)
      for (int32_t j = 0; j < dim; ++j) {
        mpmi_lanes sum = zero + (i == j ? 1.0 : 0.0);
        if (total) sum = inverse[i][0] * inverse[j][0];
        for (int32_t k = 1; total && k < dim; ++k) sum += inverse[i][k] * inverse[j][k];
        mpmi_lanes_store(to->at[i][j] + q, k_V * sum);
      }
  }
}

/* Finds k V A grad T; of particles that do not conduct nothing is known of the nodes. */
MPMI_INLINE void find_flux(int32_t dim, int32_t width, int32_t total, const mpmi_conduction *job, int64_t s,
                           const mpmi_weights *W, const mpmi_rows *rows, const mpmi_metric *A,
                           double (*flux)[MPMI_CHUNK]) {
  const int32_t last = dim - 1;
  for (int64_t q = 0; q < MPMI_CHUNK; q += MPMI_LANES) {
    const mpmi_mask conducts = mpmi_lanes_load(job->conductance + s + q) > 0.0;
    mpmi_lanes slope[3];
    for (int32_t k = 0; k < last; ++k) slope[k] = sum_rows(width, rows->g[k], W->w[last], q);
    slope[last] = sum_rows(width, rows->w, W->g[last], q);
    for (int32_t i = 0; i < dim; ++i) {
      mpmi_lanes sum = mpmi_lanes_load(A->at[i][i] + q) * slope[i];
      for (int32_t j = 0; total && j < dim; ++j)
        if (j != i) sum += mpmi_lanes_load(A->at[i][j] + q) * slope[j];
      mpmi_lanes_store(flux[i] + q, mpmi_lanes_where(conducts, sum));
    }
  }
}

/* Packs the weights and gradients of the last axis to a row of each particle. */
MPMI_INLINE void pack_last(int32_t dim, int32_t width, const mpmi_weights *W, mpmi_rows *to) {
  const double *w[4] = {no_node, no_node, no_node, no_node}, *g[4] = {no_node, no_node, no_node, no_node};
  for (int32_t k = 0; k < width; ++k) w[k] = W->w[dim - 1][k], g[k] = W->g[dim - 1][k];
  mpmi_pack(MPMI_CHUNK, w, to->w);
  mpmi_pack(MPMI_CHUNK, g, to->g[0]);
}

MPMI_INLINE void add_row(double *to, mpmi_v4 row) {
  mpmi_store4(to, mpmi_sum4(mpmi_load4(to), row));
}

/* Adds flux . grad w. */
MPMI_INLINE void add_outflow(int32_t dim, int32_t width, const mpmi_weights *W, int64_t p,
                             const mpmi_rows *last, double (*flux)[MPMI_CHUNK], double *restrict stencil) {
  const int32_t edge = MPMI_TILE_EDGE(dim, width), mid = dim >= 2 ? dim - 2 : 0;
  const mpmi_v4 w = mpmi_load4(last->w + 4 * p),
                along = mpmi_scale4(flux[dim - 1][p], mpmi_load4(last->g[0] + 4 * p));
  const mpmi_v4 first = mpmi_scale4(flux[0][p], w), second = mpmi_scale4(flux[mid][p], w);
  MPMI_UNROLL for (int32_t i = 0; i < width; ++i) {
    if (dim < 3 && i > 0) break;
    mpmi_v4 plane = along, slope = second;
    if (dim == 3) {
      plane = mpmi_fma4(mpmi_scale4(W->w[0][i][p], along), W->g[0][i][p], first);
      slope = mpmi_scale4(W->w[0][i][p], second);
    }
    MPMI_UNROLL for (int32_t j = 0; j < width; ++j) {
      if (dim < 2 && j > 0) break;
      double *row = stencil + (i * edge + j) * (dim == 1 ? 0 : edge);
      if (dim == 1)
        add_row(row, plane);
      else
        mpmi_store4(row,
                    mpmi_fma4(mpmi_fma4(mpmi_load4(row), W->w[mid][j][p], plane), W->g[mid][j][p], slope));
    }
  }
}

/* Adds grad w . A grad w. */
MPMI_INLINE void add_diagonal(int32_t dim, int32_t width, const mpmi_weights *W, int64_t p,
                              const mpmi_metric *A, double *stencil) {
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1;
  for (int32_t i = 0; i < (dim < 3 ? 1 : width); ++i)
    for (int32_t j = 0; j < (dim < 2 ? 1 : width); ++j) {
      double *row = stencil + (i * edge + j) * (dim == 1 ? 0 : edge);
      for (int32_t k = 0; k < width; ++k) {
        const int32_t at[3] = {dim == 3 ? i : dim == 2 ? j : k, dim == 3 ? j : k, k};
        double g[3], sum = 0.0;
        for (int32_t a = 0; a < dim; ++a) {
          g[a] = W->g[a][at[a]][p];
          for (int32_t b = 0; b < dim; ++b)
            if (b != a) g[a] *= W->w[b][at[b]][p];
        }
        for (int32_t a = 0; a <= last; ++a)
          for (int32_t b = 0; b <= last; ++b) sum += A->at[a][b][p] * g[a] * g[b];
        row[k] += sum;
      }
    }
}

MPMI_INLINE void conduct_in(int32_t dim, int32_t width, int32_t total, const mpmi_conduction *job,
                            int64_t begin, int64_t n) {
  const mpmi_scalars *at = &job->at;
  mpmi_weights W;
  mpmi_rows rows;
  mpmi_metric A;
  _Alignas(64) double flux[3][MPMI_CHUNK];
  for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_CHUNK) {
    at->weights(at->axis, MPMI_NEED_GRADIENT, &at->points, begin + s, MPMI_CHUNK, &W);
    for (int64_t p = 0; p < MPMI_CHUNK; ++p) sum_outer(dim, width, 1, &W, p, job->field, &rows);
    find_metric(dim, total, job, begin, s, &A);
    find_flux(dim, width, total, job, s, &W, &rows, &A, flux);
    pack_last(dim, width, &W, &rows);
    for (int64_t p = 0; p < MPMI_CHUNK; ++p) {
      double *stencil = job->outflow + W.node[p];
      MPMI_SETTLE(stencil);
      add_outflow(dim, width, &W, p, &rows, flux, stencil);
    }
    for (int64_t p = 0; job->diagonal && p < MPMI_CHUNK; ++p)
      add_diagonal(dim, width, &W, p, &A, job->diagonal + W.node[p]);
  }
}

#define SCALARS(dim, width)                                                                                  \
  void KERNEL(give_values_##dim##_##width)(const mpmi_scalars *at, int64_t begin, int64_t n,                 \
                                           const double *const *value, double *tile);                        \
  void KERNEL(give_values_##dim##_##width)(const mpmi_scalars *at, int64_t begin, int64_t n,                 \
                                           const double *const *value, double *tile) {                       \
    give_values(dim, width, at, begin, n, value, tile);                                                      \
  }                                                                                                          \
  void KERNEL(take_values_##dim##_##width)(const mpmi_scalars *at, int64_t begin, int64_t n,                 \
                                           const double *field, double *to);                                 \
  void KERNEL(take_values_##dim##_##width)(const mpmi_scalars *at, int64_t begin, int64_t n,                 \
                                           const double *field, double *to) {                                \
    take_values(dim, width, at, begin, n, field, to);                                                        \
  }                                                                                                          \
  void KERNEL(conduct_##dim##_##width)(const mpmi_conduction *job, int64_t begin, int64_t n);                \
  void KERNEL(conduct_##dim##_##width)(const mpmi_conduction *job, int64_t begin, int64_t n) {               \
    if (job->F[0])                                                                                           \
      conduct_in(dim, width, 1, job, begin, n);                                                              \
    else                                                                                                     \
      conduct_in(dim, width, 0, job, begin, n);                                                              \
  }
SCALARS(1, 2)
SCALARS(1, 3)
SCALARS(1, 4)
SCALARS(2, 2)
SCALARS(2, 3)
SCALARS(2, 4)
SCALARS(3, 2)
SCALARS(3, 3)
SCALARS(3, 4)
