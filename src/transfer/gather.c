/* G2P: nodal velocity, its change and its gradient at the particles of one block, from the block's tile.
 *
 *   v_p  = sum w_ip v_i        dv_p = sum w_ip (v_i - v_i^n)      MPoint theory eqs 34, 35
 *   L_p  = sum v_i (x) grad w_ip                                  MPoint theory eq. 38
 *   C_p  = (sum w_ip v_i (x) (x_i - x_p)) D_p^-1                  APIC: Jiang et al. 2017
 *
 * Summed node by node, row by row, axis by axis. The MLS form takes the moments of C about the middle of the
 * stencil, where distances are small integers, and moves them to the particle at the end; where D can be
 * small the digits lost in moving them would count. Holes have no initial volume and gather zeros. */
#include "simd/pack.h"
#include "transfer/gather.h"

/* Holds, per particle of a chunk: v; dv when nodes have 8 values; gradients; sums of w v (x_i - x_p), or of w
 * v (i - middle) in the MLS form. */
typedef struct mpmi_gathered {
  _Alignas(64) double v[4 * MPMI_CHUNK], dv[4 * MPMI_CHUNK], L[3][4 * MPMI_CHUNK], M[3][4 * MPMI_CHUNK];
} mpmi_gathered;

/* The node of a stencil, counted along an axis, about which moments are taken. */
#define MIDDLE(width) ((width) > 2 ? 1 : 0)

/* sum += w_k v_k; with `moment` also *m += (k - middle) w_k v_k. Called for k = 0, 1 ... in order. */
MPMI_INLINE void add(int32_t part, int32_t moment, int32_t width, int32_t k, double w, mpmi_node v,
                     mpmi_node *sum, mpmi_node *m) {
  const int32_t middle = MIDDLE(width);
  if (!moment || k == middle) {
    *sum = k ? mpmi_node_fma(part, *sum, w, v) : mpmi_node_scale(part, w, v);
    return;
  }
  const mpmi_node term = mpmi_node_scale(part, w, v);
  *sum = k ? mpmi_node_sum(part, *sum, term) : term;
  if (k == middle + 1)
    *m = middle ? mpmi_node_difference(part, term, *m) : term;
  else
    *m = k ? mpmi_node_fma(part, *m, k - middle, term) : term;
}

/* slope += g_k v_k. */
MPMI_INLINE void add_slope(int32_t part, int32_t k, double g, mpmi_node v, mpmi_node *slope) {
  *slope = k ? mpmi_node_fma(part, *slope, g, v) : mpmi_node_scale(part, g, v);
}

MPMI_INLINE void gather_particle(int32_t dim, int32_t width, int32_t form, const mpmi_weights *W, int64_t p,
                                 const double *tile, mpmi_gathered *out) {
  const int32_t values = form >= MPMI_GATHER_8 ? 8 : 4, mls = form == MPMI_GATHER_4_MLS;
  const int32_t affine = form == MPMI_GATHER_4_AFFINE || form == MPMI_GATHER_8_AFFINE;
  const int32_t all = values == 8 ? MPMI_BOTH : MPMI_LOW, part = values == 8 ? MPMI_HALF : MPMI_LOW;
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1, mid = dim >= 2 ? dim - 2 : 0;
  const double *stencil = tile + (int64_t)values * W->node[p];
  const mpmi_node zero = mpmi_node_zero();
  mpmi_node v = zero, L[3] = {zero, zero, zero}, M[3] = {zero, zero, zero};    /* over the whole stencil, */
  mpmi_node pv = zero, pL[3] = {zero, zero, zero}, pM[3] = {zero, zero, zero}; /* over a plane of rows, */
  mpmi_node rv = zero, rL = zero, rM = zero;                                   /* over a row of nodes */
  MPMI_UNROLL for (int32_t i = 0; i < width; ++i) {
    if (dim < 3 && i > 0) break;
    MPMI_UNROLL for (int32_t j = 0; j < width; ++j) {
      if (dim < 2 && j > 0) break;
      const double *node = stencil + (int64_t)values * ((i * edge + j) * (dim == 1 ? 0 : edge));
      MPMI_UNROLL for (int32_t k = 0; k < width; ++k) {
        const mpmi_node vi = mpmi_node_load(all, node + k * values);
        add(all, mls, width, k, W->w[last][k][p], vi, &rv, &rM);
        if (!mls) add_slope(part, k, W->g[last][k][p], vi, &rL);
        if (affine) add_slope(part, k, W->u[last][k][p], vi, &rM);
      }
      if (dim == 1) {
        pv = rv, pL[last] = rL, pM[last] = rM;
        continue;
      }
      const double w = W->w[mid][j][p];
      add(all, mls, width, j, w, rv, &pv, &pM[mid]);
      if (!mls) add_slope(part, j, W->g[mid][j][p], rv, &pL[mid]);
      if (!mls) add_slope(part, j, w, rL, &pL[last]);
      if (affine) add_slope(part, j, W->u[mid][j][p], rv, &pM[mid]);
      if (affine || mls) add_slope(part, j, w, rM, &pM[last]);
    }
    if (dim < 3) {
      v = pv;
      for (int32_t k = 0; k < dim; ++k) L[k] = pL[k], M[k] = pM[k];
      continue;
    }
    const double w = W->w[0][i][p];
    add(all, mls, width, i, w, pv, &v, &M[0]);
    if (!mls) add_slope(part, i, W->g[0][i][p], pv, &L[0]);
    if (affine) add_slope(part, i, W->u[0][i][p], pv, &M[0]);
    for (int32_t k = 1; k < dim; ++k) {
      if (!mls) add_slope(part, i, w, pL[k], &L[k]);
      if (affine || mls) add_slope(part, i, w, pM[k], &M[k]);
    }
  }
  mpmi_store4(out->v + 4 * p, mpmi_node_low(all, v));
  if (values == 8) mpmi_store4(out->dv + 4 * p, mpmi_node_high(v));
  for (int32_t k = 0; k < dim; ++k) {
    if (!mls) mpmi_store4(out->L[k] + 4 * p, mpmi_node_low(part, L[k]));
    if (affine || mls) mpmi_store4(out->M[k] + 4 * p, mpmi_node_low(part, M[k]));
  }
}

/* Column k of C in the MLS form. */
MPMI_INLINE void unpack_mls(int32_t width, double h, int32_t k, int64_t n, const mpmi_weights *W,
                            const mpmi_gathered *in, const double *v, int64_t ld, double *const *C) {
  const double factor = MPMI_MLS_INVERSE(width) / h;
  mpmi_unpack(n, in->M[k], C[0], C[1], C[2]);
  for (int32_t r = 0; r < 3; ++r) {
    const double *vr = v + r * ld;
    double *to = C[r];
    MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) to[p] =
        (to[p] + (W->first[k][p] + MIDDLE(width)) * vr[p]) * factor;
  }
}

MPMI_INLINE void unpack_affine(int32_t k, int64_t n, const mpmi_weights *W, const mpmi_gathered *in,
                               double *const *C) {
  mpmi_unpack(n, in->M[k], C[0], C[1], C[2]);
  for (int32_t r = 0; r < 3; ++r) {
    double *to = C[r];
    MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) to[p] *= W->inverse_moment[k][p];
  }
}

/* Component arrays from what was gathered; components that the grid does not have are zero on nodes too. */
MPMI_INLINE void unpack(int32_t dim, int32_t width, int32_t form, const mpmi_gather *job, int64_t s,
                        int64_t n, const mpmi_weights *W, const mpmi_gathered *in) {
  const int64_t ld = job->ld;
  double *v = job->v + s, *dv = job->dv + s;
  mpmi_unpack(n, in->v, v, v + ld, v + 2 * ld);
  if (form >= MPMI_GATHER_8) mpmi_unpack(n, in->dv, dv, dv + ld, dv + 2 * ld);
  for (int32_t k = 0; k < dim; ++k) {
    double *L[3], *C[3];
    for (int32_t r = 0; r < 3; ++r) {
      L[r] = job->L + (3 * r + k) * ld + s;
      C[r] = job->C + (3 * r + k) * ld + s;
    }
    if (form == MPMI_GATHER_4_MLS)
      unpack_mls(width, job->axis[k].spacing, k, n, W, in, v, ld, L);
    else
      mpmi_unpack(n, in->L[k], L[0], L[1], L[2]);
    if (form == MPMI_GATHER_4_AFFINE || form == MPMI_GATHER_8_AFFINE) unpack_affine(k, n, W, in, C);
  }
}

MPMI_INLINE void gather(int32_t dim, int32_t width, int32_t form, const mpmi_gather *job, int64_t begin,
                        int64_t count) {
  mpmi_weights W;
  mpmi_gathered out;
  for (int64_t s = 0; s < count; s += MPMI_CHUNK) {
    const int64_t n = count - s < MPMI_CHUNK ? count - s : MPMI_CHUNK;
    const double *volume = job->initial_volume + begin + s;
    job->weights(job->axis, job->need, &job->points, begin + s, n, &W);
    for (int32_t k = 0; k < width; ++k) MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
        double live = volume[p] > 0.0 ? 1.0 : 0.0;
        W.w[0][k][p] *= live;
        if (form != MPMI_GATHER_4_MLS) W.g[0][k][p] *= live;
        if (form == MPMI_GATHER_4_AFFINE) W.u[0][k][p] *= live;
      }
    for (int64_t p = 0; p < n; ++p) {
      mpmi_prefetch(&job->streams, begin + s + MPMI_CHUNK, p);
      gather_particle(dim, width, form, &W, p, job->tile, &out);
    }
    unpack(dim, width, form, job, s, n, &W, &out);
  }
}

#define GATHER(dim, width, form, name)                                                                       \
  void KERNEL(name)(const mpmi_gather *job, int64_t begin, int64_t n);                                       \
  void KERNEL(name)(const mpmi_gather *job, int64_t begin, int64_t n) {                                      \
    gather(dim, width, form, job, begin, n);                                                                 \
  }
#include "transfer/instances.h"
