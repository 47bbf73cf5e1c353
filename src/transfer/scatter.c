/* P2G: mass, momentum and force of the particles of one block onto its tile.
 *
 *   p_i += w_ip m_p (v_p + C_p (x_i - x_p))                    MPoint theory eq. 29; APIC: Jiang et al. 2017
 *   f_i += w_ip f_ext,p - V_p sigma_p grad w_ip                Steffen et al. 2008 eqs 4, 16
 *   f_r,i -= w_ip V_p sigma_theta,p / r_p                      of rings: Nairn & Guilkey 2015
 *   sigma F^-T in the place of sigma                           total Lagrangian: de Vaucorbeil et al. 2020
 *
 * Both are first-order forms  w a + sum_k column_k (w with axis k replaced by its second weight),  summed
 * hierarchically: axis by axis, row by row, node by node. Affine momentum alone is simpler: what a node
 * receives is w_ip times a linear function of its place. The MLS form puts the force into that function. */
#include "material/pull_back.h"
#include "simd/pack.h"
#include "simd/tensor.h"
#include "transfer/plain.h"
#include "transfer/scatter.h"

/* The stencil's nodes are apart from the weights, which may then stay in registers from row to row; with 16
 * registers the forces need them for other things. */
#if defined(__AVX512F__) || defined(__aarch64__)
#define MPMI_APART restrict
#else
#define MPMI_APART
#endif

/* What the particles of a chunk give as nodes have it: a and the columns, 4 or 8 values each; 4 where columns
 * have nothing but force. */
typedef struct mpmi_first_order {
  _Alignas(64) double a[8 * MPMI_CHUNK], column[3][8 * MPMI_CHUNK];
} mpmi_first_order;

/* Scatters mass and affine momentum: a is the function at the first node, column[k] its growth per node of
 * axis k. */
MPMI_INLINE void scatter_linear(int32_t dim, int32_t width, const mpmi_weights *W, int64_t p,
                                const mpmi_first_order *of, double *restrict stencil) {
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1;
  mpmi_node plane = mpmi_node_load(MPMI_LOW, of->a + 4 * p), step[3];
  for (int32_t k = 0; k < dim; ++k) step[k] = mpmi_node_load(MPMI_LOW, of->column[k] + 4 * p);
  MPMI_UNROLL for (int32_t i = 0; i < width; ++i) {
    if (dim < 3 && i > 0) break;
    mpmi_node row = plane;
    MPMI_UNROLL for (int32_t j = 0; j < width; ++j) {
      if (dim < 2 && j > 0) break;
      double outer = dim == 3 ? W->w[0][i][p] * W->w[1][j][p] : dim == 2 ? W->w[0][j][p] : 1.0;
      mpmi_node value = mpmi_node_scale(MPMI_LOW, outer, row);
      const mpmi_node growth = mpmi_node_scale(MPMI_LOW, outer, step[last]);
      double *node = stencil + 4 * (i * edge + j) * (dim == 1 ? 0 : edge);
      MPMI_UNROLL for (int32_t k = 0; k < width; ++k) {
        mpmi_node q = mpmi_node_load(MPMI_LOW, node + 4 * k);
        mpmi_node_store(MPMI_LOW, node + 4 * k, mpmi_node_fma(MPMI_LOW, q, W->w[last][k][p], value));
        value = mpmi_node_sum(MPMI_LOW, value, growth);
      }
      if (dim >= 2) row = mpmi_node_sum(MPMI_LOW, row, step[dim - 2]);
    }
    if (dim == 3) plane = mpmi_node_sum(MPMI_LOW, plane, step[0]);
  }
}

/* Returns the second weights of node k of an axis: that of the momentum and that of the force. */
MPMI_INLINE mpmi_pair second(int32_t dim, int32_t width, int32_t affine, const mpmi_weights *W,
                             const double *slope, int32_t axis, int32_t k, int64_t p) {
  const double g = mpmi_gradient(dim, width, W, slope, axis, k, p);
  return mpmi_pair_of(affine ? W->u[axis][k][p] : g, g);
}

/* Returns a + second weight * column; with 4 values there is only the momentum's. */
MPMI_INLINE mpmi_node add_second(int32_t dim, int32_t width, int32_t values, int32_t part, mpmi_node a,
                                 int32_t affine, const mpmi_weights *W, const double *inverse_spacing,
                                 int32_t axis, int32_t k, int64_t p, mpmi_node column) {
  if (values == 4) return mpmi_node_fma(part, a, W->u[axis][k][p], column);
  return mpmi_node_fma_pair(part, a, second(dim, width, affine, W, inverse_spacing, axis, k, p), column);
}

MPMI_INLINE int32_t is_affine(int32_t form) {
  return form == MPMI_SCATTER_4_AFFINE || form == MPMI_SCATTER_4_UNEVEN || form == MPMI_SCATTER_8_AFFINE ||
         form == MPMI_SCATTER_FLAT_AFFINE;
}
MPMI_INLINE int32_t is_flat(int32_t form) {
  return form >= MPMI_SCATTER_FLAT;
}

/* The values that nodes have in a form, and the part that the columns give to. */
MPMI_INLINE int32_t all_of(int32_t form) {
  return form < MPMI_SCATTER_8 ? MPMI_LOW : form == MPMI_SCATTER_8_HALVES ? MPMI_HALVES_BOTH : MPMI_BOTH;
}
MPMI_INLINE int32_t part_of(int32_t form) {
  return form < MPMI_SCATTER_8           ? MPMI_LOW
         : form == MPMI_SCATTER_8_AFFINE ? MPMI_BOTH
         : form == MPMI_SCATTER_8_HALVES ? MPMI_HALVES_HIGH
                                         : MPMI_HIGH;
}

/* Scatters mass, momentum and force, or with 4 values mass and affine momentum. Without an affine part the
 * columns have nothing to give to momentum. */
MPMI_INLINE void scatter_first_order(int32_t dim, int32_t width, int32_t form, const mpmi_weights *W,
                                     const double *inverse_spacing, int64_t p, const mpmi_first_order *of,
                                     double *MPMI_APART stencil) {
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1;
  const int32_t values = form < MPMI_SCATTER_8 ? 4 : 8, affine = is_affine(form);
  const int32_t all = all_of(form), part = part_of(form);
  const mpmi_node a = mpmi_node_load(all, of->a + values * p);
  mpmi_node column[3];
  for (int32_t k = 0; k < dim; ++k)
    column[k] = values == 8 && !affine ? mpmi_node_load_high(part, of->column[k] + 4 * p)
                                       : mpmi_node_load(part, of->column[k] + values * p);
  /* sums over the axes before the last: node += w_k value + s_k slope */
  mpmi_node plane = a, plane_1 = column[0], plane_2 = column[last], value = a, slope = column[last];
  MPMI_UNROLL for (int32_t i = 0; i < width; ++i) {
    if (dim < 3 && i > 0) break;
    if (dim == 3) {
      const double w = W->w[0][i][p];
      plane = add_second(dim, width, values, part, mpmi_node_scale(all, w, a), affine, W, inverse_spacing, 0,
                         i, p, column[0]);
      plane_1 = mpmi_node_scale(part, w, column[1]);
      plane_2 = mpmi_node_scale(part, w, column[2]);
    }
    MPMI_UNROLL for (int32_t j = 0; j < width; ++j) {
      if (dim < 2 && j > 0) break;
      if (dim >= 2) {
        const double w = W->w[dim - 2][j][p];
        value = add_second(dim, width, values, part, mpmi_node_scale(all, w, plane), affine, W,
                           inverse_spacing, dim - 2, j, p, plane_1);
        slope = mpmi_node_scale(part, w, plane_2);
      }
      double *node = stencil + values * (i * edge + j) * (dim == 1 ? 0 : edge);
      MPMI_UNROLL for (int32_t k = 0; k < width; ++k) {
        mpmi_node q = mpmi_node_load(all, node + values * k);
        q = mpmi_node_fma(all, q, W->w[last][k][p], value);
        mpmi_node_store(
            all, node + values * k,
            add_second(dim, width, values, part, q, affine, W, inverse_spacing, last, k, p, slope));
      }
    }
  }
}

/* Returns a + second weight * column of momentum and force together. */
MPMI_INLINE mpmi_v4 add_flat_second(int32_t dim, int32_t width, mpmi_v4 a, int32_t affine,
                                    const mpmi_weights *W, const double *inverse_spacing, int32_t axis,
                                    int32_t k, int64_t p, mpmi_v4 column) {
  const double g = mpmi_gradient(dim, width, W, inverse_spacing, axis, k, p);
  return affine ? mpmi_fma_pair4(a, W->u[axis][k][p], g, column) : mpmi_fma4(a, g, column);
}

/* Scatters momentum and force of 1-D or 2-D to the nodes of a stencil, and mass to theirs, row by row. */
MPMI_INLINE void scatter_flat(int32_t dim, int32_t width, int32_t affine, const mpmi_weights *W,
                              const double *inverse_spacing, int64_t p, const mpmi_first_order *of,
                              double mass, double *MPMI_APART stencil, double *MPMI_APART masses) {
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1;
  const mpmi_v4 a = mpmi_load4(of->a + 4 * p), column = mpmi_load4(of->column[0] + 4 * p);
  mpmi_v4 value = a, slope = mpmi_load4(of->column[last] + 4 * p);
  const mpmi_v4 step = slope,
                weights = mpmi_set4(W->w[last][0][p], W->w[last][1][p], width > 2 ? W->w[last][2][p] : 0.0,
                                    width > 3 ? W->w[last][3][p] : 0.0);
  double row_mass = mass;
  MPMI_UNROLL for (int32_t j = 0; j < width; ++j) {
    if (dim < 2 && j > 0) break;
    if (dim == 2) {
      const double w = W->w[0][j][p];
      value = add_flat_second(dim, width, mpmi_scale4(w, a), affine, W, inverse_spacing, 0, j, p, column);
      slope = mpmi_scale4(w, step);
      row_mass = w * mass;
    }
    double *node = stencil + 4 * j * edge, *row = masses + j * edge;
    MPMI_UNROLL for (int32_t k = 0; k < width; ++k) {
      const mpmi_v4 q = mpmi_fma4(mpmi_load4(node + 4 * k), W->w[last][k][p], value);
      mpmi_store4(node + 4 * k,
                  add_flat_second(dim, width, q, affine, W, inverse_spacing, last, k, p, slope));
    }
    mpmi_store4(row, mpmi_fma4(mpmi_load4(row), row_mass, weights));
  }
}

_Alignas(64) static const double zero[MPMI_CHUNK] = {0.0};

/* The component arrays of the stress, by column and row. */
typedef struct mpmi_stress_rows {
  const double *at[3][3];
} mpmi_stress_rows;

MPMI_INLINE mpmi_stress_rows stress_rows(int32_t dim, const mpmi_scatter *job) {
  mpmi_stress_rows rows;
  for (int32_t k = 0; k < dim; ++k)
    for (int32_t r = 0; r < dim; ++r) rows.at[k][r] = job->stress[mpmi_sym_index(k, r)];
  return rows;
}

/* What the particles of a chunk give, component by component. */
typedef struct mpmi_given {
  _Alignas(64) double momentum[3][MPMI_CHUNK], affine[3][3][MPMI_CHUNK]; /* affine, stress: [column][row] */
  double force[3][MPMI_CHUNK], stress[3][3][MPMI_CHUNK];
} mpmi_given;

/* The hoop stress of a ring pulls it inwards: f_r -= V sigma_theta / r. */
MPMI_INLINE void give_hoop_force(const mpmi_scatter *job, int64_t s, int64_t n, double *to) {
  const double *volume = job->volume + s, *sigma = job->stress[2] + s, *radius = job->points.x[0] + s;
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    const double force = volume[p] * sigma[p] / radius[p];
    to[p] -= radius[p] > 0.0 ? force : 0.0;
  }
}

/* The same where radius and weights are those of the reference positions: f_r -= V sigma_theta / (F_theta
 * R). */
MPMI_INLINE void give_nominal_hoop_force(const mpmi_scatter *job, int64_t s, int64_t n, double *to) {
  const double *volume = job->volume + s, *sigma = job->stress[2] + s, *radius = job->points.x[0] + s;
  const double *stretch = job->F[4] + s;
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    const double force = volume[p] * sigma[p] / (stretch[p] * radius[p]);
    to[p] -= radius[p] > 0.0 ? force : 0.0;
  }
}

/* Computes -V sigma F^-T. */
MPMI_INLINE void give_nominal(int32_t dim, const mpmi_scatter *job, const mpmi_stress_rows *stress, int64_t s,
                              int64_t n, mpmi_given *to) {
  for (int64_t q = 0; q < mpmi_whole_chunks(n); q += MPMI_LANES) {
    mpmi_lanes inverse[3][3];
    const mpmi_lanes volume = mpmi_lanes_load(job->volume + s + q);
    mpmi_inverse_load(dim, job->F, s + q, inverse);
    for (int32_t r = 0; r < dim; ++r) {
      mpmi_lanes force[3];
      for (int32_t j = 0; j < dim; ++j) force[j] = -volume * mpmi_lanes_load(stress->at[j][r] + s + q);
      for (int32_t k = 0; k < dim; ++k) {
        mpmi_lanes sum = {0.0};
        for (int32_t j = 0; j < dim; ++j) sum += force[j] * inverse[k][j];
        mpmi_lanes_store(to->stress[k][r] + q, sum);
      }
    }
  }
}

/* Computes -V sigma, of which the lower triangle is filled, and the external force. */
MPMI_INLINE void give_force(int32_t dim, int32_t total, const mpmi_scatter *job,
                            const mpmi_stress_rows *stress, int64_t s, int64_t n, mpmi_given *to) {
  const double *volume = job->volume + s, *mass = job->mass + s;
  for (int32_t r = 0; r < dim; ++r) {
    const double g = job->gravity[r];
    if (job->force[r]) {
      const double *added = job->force[r] + s;
      MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) to->force[r][p] = mass[p] * g + added[p];
    } else {
      MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) to->force[r][p] = mass[p] * g;
    }
    for (int32_t k = 0; k <= r && !total; ++k) {
      const double *sigma = stress->at[k][r] + s;
      MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) to->stress[k][r][p] =
          -volume[p] * sigma[p];
    }
  }
  if (dim == 2 && job->hoop && total)
    give_nominal_hoop_force(job, s, n, to->force[0]);
  else if (dim == 2 && job->hoop)
    give_hoop_force(job, s, n, to->force[0]);
}

/* Computes momentum. Affine with 4 values: m (v + C d) at the first node and m C h per node of each axis;
 * there the fused force adds dt f_ext to m v and -dt V sigma D^-1 to m C. Other affine forms: the columns of
 * m C. */
MPMI_INLINE void give_momentum(int32_t dim, int32_t width, int32_t form, int32_t total,
                               const mpmi_scatter *job, const mpmi_stress_rows *stress, int64_t s, int64_t n,
                               const mpmi_weights *W, mpmi_given *to) {
  const int32_t linear = form == MPMI_SCATTER_4_AFFINE, affine = is_affine(form);
  const int32_t fused = linear && job->fused_dt != 0.0;
  const double *mass = job->mass + s, *volume = job->volume + s;
  for (int32_t r = 0; r < dim; ++r) {
    const double *v = job->v[r] + s;
    const double dv = fused ? job->fused_dt * job->gravity[r] : 0.0;
    MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) to->momentum[r][p] = mass[p] * (v[p] + dv);
    if (fused && job->force[r]) {
      const double *added = job->force[r] + s;
      MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) to->momentum[r][p] +=
          job->fused_dt * added[p];
    }
    for (int32_t k = 0; affine && k < dim; ++k) {
      const double *C = job->affine[3 * r + k] + s, *sigma = stress->at[k][r] + s;
      const double h = job->axis[k].spacing;
      const double scale = fused ? -job->fused_dt * MPMI_MLS_INVERSE(width) / h : 0.0;
      if (!linear) {
        MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) to->affine[k][r][p] = mass[p] * C[p];
      } else if (total && fused) {
        const double *nominal = to->stress[k][r];
        MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
          double growth = mass[p] * C[p] * h - scale * nominal[p];
          to->affine[k][r][p] = growth;
          to->momentum[r][p] += W->first[k][p] * growth;
        }
      } else {
        MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
          double growth = mass[p] * C[p] * h + scale * volume[p] * sigma[p];
          to->affine[k][r][p] = growth;
          to->momentum[r][p] += W->first[k][p] * growth;
        }
      }
    }
  }
}

/* Packs momentum and force of 1-D or 2-D, four values together. */
MPMI_INLINE void pack_flat(int32_t dim, int32_t affine, int64_t n, int32_t symmetric, const mpmi_given *given,
                           mpmi_first_order *of) {
  const int32_t y = dim > 1;
  mpmi_pack(n, given->momentum[0], y ? given->momentum[1] : zero, given->force[0], y ? given->force[1] : zero,
            of->a, 4);
  for (int32_t k = 0; k < dim; ++k)
    mpmi_pack(n, affine ? given->affine[k][0] : zero, affine && y ? given->affine[k][1] : zero,
              k && symmetric ? given->stress[0][k] : given->stress[k][0], y ? given->stress[k][1] : zero,
              of->column[k], 4);
}

/* Packs what was given in the order of a node's values. Components that the grid does not have are zero. Of a
 * symmetric stress the lower triangle is there. */
MPMI_INLINE void pack(int32_t dim, int32_t form, const double *mass, int64_t n, int32_t symmetric,
                      const mpmi_given *given, mpmi_first_order *of) {
  const int32_t eight = form >= MPMI_SCATTER_8, affine = is_affine(form);
  const double *a[8] = {zero, zero, zero, mass, zero, zero, zero, zero};
  for (int32_t r = 0; r < dim; ++r) a[r] = given->momentum[r], a[4 + r] = given->force[r];
  if (eight)
    mpmi_pack8(n, a, of->a);
  else
    mpmi_pack(n, a[0], a[1], a[2], a[3], of->a, 4);
  for (int32_t k = 0; (eight || affine) && k < dim; ++k) {
    const double *c[8] = {zero, zero, zero, zero, zero, zero, zero, zero};
    for (int32_t r = 0; r < dim; ++r)
      c[r] = given->affine[k][r], c[4 + r] = r < k && symmetric ? given->stress[r][k] : given->stress[k][r];
    if (eight && affine)
      mpmi_pack8(n, c, of->column[k]);
    else
      mpmi_pack(n, c[4 * eight], c[4 * eight + 1], c[4 * eight + 2], zero, of->column[k], 4);
  }
}

/* Computes what the particles of a chunk give, with gradients over reference positions where `total`. */
MPMI_INLINE void give(int32_t dim, int32_t width, int32_t form, int32_t total, const mpmi_scatter *job,
                      const mpmi_stress_rows *stress, int64_t s, int64_t n, const mpmi_weights *W,
                      mpmi_first_order *of) {
  mpmi_given given;
  if (total) give_nominal(dim, job, stress, s, n, &given);
  give_momentum(dim, width, form, total, job, stress, s, n, W, &given);
  if (form >= MPMI_SCATTER_8) give_force(dim, total, job, stress, s, n, &given);
  if (is_flat(form))
    pack_flat(dim, is_affine(form), n, !total, &given, of);
  else
    pack(dim, form, job->mass + s, n, !total, &given, of);
}

MPMI_INLINE void scatter(int32_t dim, int32_t width, int32_t form, const mpmi_scatter *job, int64_t begin,
                         int64_t end) {
  const int64_t values = form >= MPMI_SCATTER_8 && !is_flat(form) ? 8 : 4;
  double *masses = mpmi_flat_masses(dim, width, job->tile);
  const mpmi_stress_rows stress = stress_rows(dim, job);
  mpmi_weights W;
  mpmi_first_order of;
  double inverse_spacing[3] = {0.0, 0.0, 0.0};
  for (int32_t k = 0; k < dim; ++k) inverse_spacing[k] = job->axis[k].inverse_spacing;
  for (int64_t s = begin; s < end; s += MPMI_CHUNK) {
    const int64_t n = end - s < MPMI_CHUNK ? end - s : MPMI_CHUNK;
    job->weights(job->axis, job->need, &job->points, s, n, &W);
    if (job->F[0])
      give(dim, width, form, 1, job, &stress, s, n, &W, &of);
    else
      give(dim, width, form, 0, job, &stress, s, n, &W, &of);
    const int64_t ahead = mpmi_ahead(&job->streams, s);
    for (int64_t p = 0; p < n; ++p) {
      double *stencil = job->tile + values * W.node[p];
      MPMI_SETTLE(stencil);
      mpmi_prefetch(&job->streams, ahead, p);
      if (form == MPMI_SCATTER_4)
        mpmi_scatter_plain(dim, width, &W, p, of.a + 4 * p, stencil);
      else if (form == MPMI_SCATTER_4_AFFINE)
        scatter_linear(dim, width, &W, p, &of, stencil);
      else if (is_flat(form))
        scatter_flat(dim, width, is_affine(form), &W, inverse_spacing, p, &of, job->mass[s + p], stencil,
                     masses + W.node[p]);
      else
        scatter_first_order(dim, width, form, &W, inverse_spacing, p, &of, stencil);
    }
  }
}

#define SCATTER(dim, width, form, name)                                                                      \
  void KERNEL(name)(const mpmi_scatter *job, int64_t begin, int64_t end);                                    \
  void KERNEL(name)(const mpmi_scatter *job, int64_t begin, int64_t end) {                                   \
    scatter(dim, width, form, job, begin, end);                                                              \
  }
#include "transfer/instances.h"
