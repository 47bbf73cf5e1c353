/* P2G: mass, momentum and force of the particles of one block onto its tile.
 *
 *   p_i += w_ip m_p (v_p + C_p (x_i - x_p))                    MPoint theory eq. 29; APIC: Jiang et al. 2017
 *   f_i += w_ip f_ext,p - V_p sigma_p grad w_ip                Steffen et al. 2008 eqs 4, 16
 *
 * Both are first-order forms  w (a + sum_k B_k d_k)  in which the second weight of axis k stands for w d_k;
 * they are summed hierarchically: axis by axis, row by row, node by node. The MLS form puts force and
 * momentum into one. */
#include "transfer/kernel_common.h"

/* One particle's contribution: a w + sum_k column[k] (w with axis k replaced by its second weight). */
typedef struct mpmi_first_order {
  mpmi_v4 a[MPMI_CHUNK], column[3][MPMI_CHUNK];
} mpmi_first_order;

/* Sums of a first-order form over the axes before the last: node += row[0] * w_last + row[1] * g_last. */
MPMI_INLINE void row_of(int32_t dim, const mpmi_first_order *form, const mpmi_weights *W,
                        const double (*second)[MPMI_MAX_WIDTH][MPMI_CHUNK], int64_t p, int32_t i, int32_t j,
                        mpmi_v4 *row) {
  const mpmi_v4 a = form->a[p], c0 = form->column[0][p];
  if (dim == 1) {
    row[0] = a;
    row[1] = c0;
    return;
  }
  const mpmi_v4 c1 = form->column[1][p];
  const double wi = W->w[0][i][p], si = second[0][i][p];
  if (dim == 2) {
    row[0] = mpmi_add4(mpmi_scale4(wi, a), si, c0);
    row[1] = mpmi_scale4(wi, c1);
    return;
  }
  const mpmi_v4 c2 = form->column[2][p];
  const double wj = W->w[1][j][p], sj = second[1][j][p];
  row[0] = mpmi_add4(mpmi_scale4(wj, mpmi_add4(mpmi_scale4(wi, a), si, c0)), sj, mpmi_scale4(wi, c1));
  row[1] = mpmi_scale4(wj, mpmi_scale4(wi, c2));
}

MPMI_INLINE void scatter_particle(int32_t dim, int32_t width, int32_t form, const mpmi_weights *W, int64_t p,
                                  const mpmi_first_order *momentum, const mpmi_first_order *force,
                                  double *tile) {
  const int32_t values = form >= MPMI_SCATTER_8 ? 8 : 4;
  const int32_t affine = form == MPMI_SCATTER_4_AFFINE || form == MPMI_SCATTER_8_AFFINE;
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1;
  /* in the 4-value form the fused matrix uses u; with forces apart the affine part uses u and the stress g */
  const double(*wl)[MPMI_CHUNK] = W->w[last];
  double *stencil = tile + (int64_t)values * W->node[p];
  MPMI_UNROLL for (int32_t i = 0; i < width; ++i) {
    if (dim < 3 && i > 0) break;
    MPMI_UNROLL for (int32_t j = 0; j < width; ++j) {
      if (dim < 2 && j > 0) break;
      const int32_t first = dim == 3 ? i : j;
      mpmi_v4 m[2], f[2];
      if (affine) {
        row_of(dim, momentum, W, W->u, p, first, j, m);
      } else {
        double outer = dim == 1 ? 1.0 : W->w[0][first][p];
        if (dim == 3) outer *= W->w[1][j][p];
        m[0] = mpmi_scale4(outer, momentum->a[p]);
      }
      if (values == 8) row_of(dim, force, W, W->g, p, first, j, f);
      double *node = stencil + (int64_t)values * ((i * edge + j) * (dim == 1 ? 0 : edge));
      MPMI_UNROLL for (int32_t k = 0; k < width; ++k) {
        mpmi_v4 q = mpmi_add4(mpmi_load4(node + k * values), wl[k][p], m[0]);
        if (affine) q = mpmi_add4(q, W->u[last][k][p], m[1]);
        mpmi_store4(node + k * values, q);
        if (values == 8) {
          q = mpmi_add4(mpmi_load4(node + k * values + 4), wl[k][p], f[0]);
          q = mpmi_add4(q, W->g[last][k][p], f[1]);
          mpmi_store4(node + k * values + 4, q);
        }
      }
    }
  }
}

/* Column k of a symmetric tensor stored xx yy zz xy yz xz: rows of that column. */
static const int32_t stress_of[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};

/* -V sigma, column by column, and the external force. */
MPMI_INLINE void pack_force(int32_t dim, const mpmi_scatter *job, int64_t s, int64_t n,
                            mpmi_first_order *force) {
  _Alignas(64) double column[3][3][MPMI_CHUNK], ext[3][MPMI_CHUNK];
  _Alignas(64) static const double zero[MPMI_CHUNK] = {0.0};
  const double *volume = job->volume + s, *mass = job->mass + s;
  for (int32_t r = 0; r < dim; ++r) {
    const double g = job->gravity[r];
    if (job->force[r]) {
      const double *added = job->force[r] + s;
      MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) ext[r][p] = mass[p] * g + added[p];
    } else {
      MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) ext[r][p] = mass[p] * g;
    }
    for (int32_t k = 0; k < dim; ++k) {
      const double *sigma = job->stress[stress_of[k][r]] + s;
      MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) column[k][r][p] = -volume[p] * sigma[p];
    }
  }
#define LANE(array, r) ((r) < dim ? (array)[r] : zero)
  mpmi_pack(n, LANE(ext, 0), LANE(ext, 1), LANE(ext, 2), zero, force->a);
  for (int32_t k = 0; k < dim; ++k)
    mpmi_pack(n, LANE(column[k], 0), LANE(column[k], 1), LANE(column[k], 2), zero, force->column[k]);
}

/* Momentum and mass; with `affine` the columns of m C; with a fused force also dt (f_ext; -V D^-1 sigma). */
MPMI_INLINE void pack_momentum(int32_t dim, int32_t form, const mpmi_scatter *job, int64_t s, int64_t n,
                               mpmi_first_order *momentum) {
  const int32_t affine = form == MPMI_SCATTER_4_AFFINE || form == MPMI_SCATTER_8_AFFINE;
  const int32_t fused = form == MPMI_SCATTER_4_AFFINE && job->fused_dt != 0.0;
  _Alignas(64) double p_[3][MPMI_CHUNK], column[3][3][MPMI_CHUNK];
  _Alignas(64) static const double zero[MPMI_CHUNK] = {0.0};
  const double *mass = job->mass + s, *volume = job->volume + s;
  for (int32_t r = 0; r < dim; ++r) {
    const double *v = job->v[r] + s;
    const double dv = fused ? job->fused_dt * job->gravity[r] : 0.0;
    MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) p_[r][p] = mass[p] * (v[p] + dv);
    if (fused && job->force[r]) {
      const double *added = job->force[r] + s;
      MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) p_[r][p] += job->fused_dt * added[p];
    }
    if (!affine) continue;
    for (int32_t k = 0; k < dim; ++k) {
      const double *C = job->affine[3 * r + k] + s;
      if (fused) {
        /* quadratic B-spline: D = h^2 / 4 on every axis */
        const double scale =
            -job->fused_dt * 4.0 * job->axis[k].inverse_spacing * job->axis[k].inverse_spacing;
        const double *sigma = job->stress[stress_of[k][r]] + s;
        MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) column[k][r][p] =
            mass[p] * C[p] + scale * volume[p] * sigma[p];
      } else {
        MPMI_IVDEP for (int64_t p = 0; p < mpmi_groups(n); ++p) column[k][r][p] = mass[p] * C[p];
      }
    }
  }
  mpmi_pack(n, LANE(p_, 0), LANE(p_, 1), LANE(p_, 2), mass, momentum->a);
  if (affine)
    for (int32_t k = 0; k < dim; ++k)
      mpmi_pack(n, LANE(column[k], 0), LANE(column[k], 1), LANE(column[k], 2), zero, momentum->column[k]);
#undef LANE
}

MPMI_INLINE void scatter(int32_t dim, int32_t width, int32_t form, const mpmi_scatter *job, int64_t begin,
                         int64_t end) {
  mpmi_weights W;
  mpmi_first_order momentum, force;
  for (int64_t s = begin; s < end; s += MPMI_CHUNK) {
    const int64_t n = end - s < MPMI_CHUNK ? end - s : MPMI_CHUNK;
    const double *x[3];
    for (int32_t k = 0; k < dim; ++k) x[k] = job->x[k] + s;
    KERNEL(weights)(dim, width, job->axis, job->axis_weights, job->need, n, x, &W);
    pack_momentum(dim, form, job, s, n, &momentum);
    if (form >= MPMI_SCATTER_8) pack_force(dim, job, s, n, &force);
    for (int64_t p = 0; p < n; ++p) {
      mpmi_prefetch(&job->streams, s + MPMI_CHUNK, p);
      scatter_particle(dim, width, form, &W, p, &momentum, &force, job->tile);
    }
  }
}

#define SCATTER(dim, width, form, name)                                                                      \
  void KERNEL(name)(const mpmi_scatter *job, int64_t begin, int64_t end);                                    \
  void KERNEL(name)(const mpmi_scatter *job, int64_t begin, int64_t end) {                                   \
    scatter(dim, width, form, job, begin, end);                                                              \
  }
#include "transfer/instances.h"
