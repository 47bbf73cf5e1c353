/* G2P: nodal velocity, its change and its gradient at the particles of one block, from the block's tile.
 *
 *   v_p  = sum w_ip v_i        dv_p = sum w_ip (v_i - v_i^n)      MPoint theory eqs 34, 35
 *   L_p  = sum v_i (x) grad w_ip                                  MPoint theory eq. 38
 *   C_p  = (sum w_ip v_i (x) (x_i - x_p)) D_p^-1                  APIC: Jiang et al. 2017
 *
 * Summed node by node, row by row, axis by axis. Holes have no initial volume and gather zeros. */
#include "transfer/kernel_common.h"

/* Below this share of h^2 an axis has no usable second moment and carries no affine part. */
#define MOMENT_CUT 1e-8

typedef struct mpmi_gathered {
  mpmi_v4 v[MPMI_CHUNK], dv[MPMI_CHUNK], L[3][MPMI_CHUNK], C[3][MPMI_CHUNK];
} mpmi_gathered;

MPMI_INLINE void gather_particle(int32_t dim, int32_t width, int32_t form, const mpmi_weights *W, int64_t p,
                                 const double *tile, mpmi_gathered *out) {
  const int32_t values = form == MPMI_GATHER_8 ? 8 : 4, affine = form == MPMI_GATHER_4_AFFINE;
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1;
  const mpmi_v4 zero = mpmi_zero4();
  const double *stencil = tile + (int64_t)values * W->node[p];
  mpmi_v4 v = zero, dv = zero, L[3] = {zero, zero, zero}, C[3] = {zero, zero, zero};
  MPMI_UNROLL for (int32_t i = 0; i < width; ++i) {
    if (dim < 3 && i > 0) break;
    mpmi_v4 pv = zero, pdv = zero, pL1 = zero, pL2 = zero, pC1 = zero,
            pC2 = zero; /* sums over a plane of rows */
    MPMI_UNROLL for (int32_t j = 0; j < width; ++j) {
      if (dim < 2 && j > 0) break;
      mpmi_v4 rv = zero, rdv = zero, rg = zero, ru = zero; /* sums over a row of nodes */
      const double *node = stencil + (int64_t)values * ((i * edge + j) * (dim == 1 ? 0 : edge));
      MPMI_UNROLL for (int32_t k = 0; k < width; ++k) {
        const mpmi_v4 vi = mpmi_load4(node + k * values);
        rv = mpmi_add4(rv, W->w[last][k][p], vi);
        rg = mpmi_add4(rg, W->g[last][k][p], vi);
        if (affine) ru = mpmi_add4(ru, W->u[last][k][p], vi);
        if (values == 8) rdv = mpmi_add4(rdv, W->w[last][k][p], mpmi_load4(node + k * values + 4));
      }
      if (dim == 1) {
        v = rv, dv = rdv, L[0] = rg, C[0] = ru;
      } else {
        const int32_t mid = dim - 2;
        const double wj = W->w[mid][j][p], gj = W->g[mid][j][p];
        pv = mpmi_add4(pv, wj, rv);
        pL1 = mpmi_add4(pL1, gj, rv);
        pL2 = mpmi_add4(pL2, wj, rg);
        if (values == 8) pdv = mpmi_add4(pdv, wj, rdv);
        if (affine) {
          pC1 = mpmi_add4(pC1, W->u[mid][j][p], rv);
          pC2 = mpmi_add4(pC2, wj, ru);
        }
      }
    }
    if (dim == 2) v = pv, dv = pdv, L[0] = pL1, L[1] = pL2, C[0] = pC1, C[1] = pC2;
    if (dim == 3) {
      const double wi = W->w[0][i][p], gi = W->g[0][i][p];
      v = mpmi_add4(v, wi, pv);
      L[0] = mpmi_add4(L[0], gi, pv);
      L[1] = mpmi_add4(L[1], wi, pL1);
      L[2] = mpmi_add4(L[2], wi, pL2);
      if (values == 8) dv = mpmi_add4(dv, wi, pdv);
      if (affine) {
        C[0] = mpmi_add4(C[0], W->u[0][i][p], pv);
        C[1] = mpmi_add4(C[1], wi, pC1);
        C[2] = mpmi_add4(C[2], wi, pC2);
      }
    }
  }
  out->v[p] = v;
  if (values == 8) out->dv[p] = dv;
  for (int32_t k = 0; k < dim; ++k) {
    out->L[k][p] = L[k];
    if (affine) out->C[k][p] = C[k];
  }
}

/* One vector per particle to component arrays out[r * stride], r < dim, times a factor per particle. */
MPMI_INLINE void unpack_scaled(int32_t dim, int64_t n, const mpmi_v4 *in, const double *factor, double *out,
                               int64_t stride) {
  _Alignas(64) double lane[3][MPMI_CHUNK];
  mpmi_unpack3(n, in, lane[0], lane[1], lane[2]);
  for (int32_t r = 0; r < dim; ++r) {
    double *to = out + r * stride;
    MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) to[p] = lane[r][p] * factor[p];
  }
}

MPMI_INLINE void gather(int32_t dim, int32_t width, int32_t form, const mpmi_gather *job, int64_t begin,
                        int64_t count) {
  mpmi_weights W;
  mpmi_gathered out;
  _Alignas(64) double live[MPMI_CHUNK], inverse_moment[MPMI_CHUNK];
  for (int64_t s = 0; s < count; s += MPMI_CHUNK) {
    const int64_t n = count - s < MPMI_CHUNK ? count - s : MPMI_CHUNK;
    const double *x[3];
    for (int32_t k = 0; k < dim; ++k) x[k] = job->x[k] + begin + s;
    KERNEL(weights)(dim, width, job->axis, job->axis_weights, job->need, n, x, &W);
    for (int64_t p = 0; p < n; ++p) {
      mpmi_prefetch(&job->streams, begin + s + MPMI_CHUNK, p);
      gather_particle(dim, width, form, &W, p, job->tile, &out);
    }
    const double *volume = job->initial_volume + begin + s;
    MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) live[p] = volume[p] > 0.0 ? 1.0 : 0.0;
    unpack_scaled(dim, n, out.v, live, job->v + s, job->ld);
    if (form == MPMI_GATHER_8) unpack_scaled(dim, n, out.dv, live, job->dv + s, job->ld);
    for (int32_t k = 0; k < dim; ++k) {
      unpack_scaled(dim, n, out.L[k], live, job->L + k * job->ld + s, 3 * job->ld);
      if (form != MPMI_GATHER_4_AFFINE) continue;
      const double cut = MOMENT_CUT * job->axis[k].spacing * job->axis[k].spacing;
      MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) {
        double moment = W.moment[k][p];
        inverse_moment[p] = moment > cut ? live[p] / moment : 0.0;
      }
      unpack_scaled(dim, n, out.C[k], inverse_moment, job->C + k * job->ld + s, 3 * job->ld);
    }
  }
}

#define GATHER(dim, width, form, name)                                                                       \
  void KERNEL(name)(const mpmi_gather *job, int64_t begin, int64_t n);                                       \
  void KERNEL(name)(const mpmi_gather *job, int64_t begin, int64_t n) {                                      \
    gather(dim, width, form, job, begin, n);                                                                 \
  }
#include "transfer/instances.h"
