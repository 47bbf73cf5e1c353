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

/* What the particles of a chunk give as nodes have it: a and the columns, 4 or 8 values for each particle; of
 * two halves the lower one of all particles, and then the upper one. Columns that have nothing but force have
 * the upper half alone. */
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
      const mpmi_node growth = mpmi_node_round(MPMI_LOW, mpmi_node_scale(MPMI_LOW, outer, step[last]));
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

/* What the columns of a form have for momentum: nothing; its growth per node; or its gradient, with weights
 * of their own. */
enum { NO_MOMENT, EVEN_MOMENT, UNEVEN_MOMENT };
MPMI_INLINE int32_t moment_of(int32_t form) {
  switch (form) {
  case MPMI_SCATTER_4_AFFINE:
  case MPMI_SCATTER_8_AFFINE:
  case MPMI_SCATTER_8_AFFINE_HALVES:
  case MPMI_SCATTER_FLAT_AFFINE:
    return EVEN_MOMENT;
  case MPMI_SCATTER_4_UNEVEN:
  case MPMI_SCATTER_8_UNEVEN:
  case MPMI_SCATTER_FLAT_UNEVEN:
    return UNEVEN_MOMENT;
  default:
    return NO_MOMENT;
  }
}
MPMI_INLINE int32_t is_flat(int32_t form) {
  return form >= MPMI_SCATTER_FLAT;
}

MPMI_INLINE int32_t has_halves(int32_t form) {
  return form == MPMI_SCATTER_8_HALVES || form == MPMI_SCATTER_8_AFFINE_HALVES;
}

/* Returns the momentum at node k of an axis, of that at the middle one and its growth per node; force, in the
 * upper half, stays. */
MPMI_INLINE mpmi_node grown(int32_t width, int32_t part, int32_t moment, int32_t k, mpmi_node middle,
                            mpmi_node growth) {
  const int32_t steps = k - MPMI_MIDDLE(width);
  if (moment != EVEN_MOMENT || steps == 0) return middle;
  if (steps < 0) return mpmi_node_subtract_low(part, middle, growth);
  mpmi_node value = mpmi_node_add_low(part, middle, growth);
  return steps == 1 ? value : mpmi_node_add_low(part, value, growth);
}

/* Returns a + second weight * column; with 4 values there is only the momentum's. */
MPMI_INLINE mpmi_node add_second(int32_t dim, int32_t width, int32_t values, int32_t part, mpmi_node a,
                                 int32_t moment, const mpmi_weights *W, const double *inverse_spacing,
                                 int32_t axis, int32_t k, int64_t p, mpmi_node column) {
  if (values == 4) return mpmi_node_fma(part, a, W->u[axis][k][p], column);
  const double g = mpmi_gradient(dim, width, W, inverse_spacing, axis, k, p);
  if (moment == UNEVEN_MOMENT) return mpmi_node_fma_pair(part, a, mpmi_pair_of(W->u[axis][k][p], g), column);
  return mpmi_node_fma_pair(mpmi_high_part(part), a, mpmi_pair_of(moment ? 0.0 : g, g), column);
}

/* The values that nodes have in a form, and the part that the columns give to. */
MPMI_INLINE int32_t all_of(int32_t form) {
  return form < MPMI_SCATTER_8 ? MPMI_LOW : has_halves(form) ? MPMI_HALVES_BOTH : MPMI_BOTH;
}
MPMI_INLINE int32_t part_of(int32_t form) {
  return form < MPMI_SCATTER_8 || moment_of(form) ? all_of(form) : mpmi_high_part(all_of(form));
}

/* Packs four or eight values, or the last four of eight unless `whole`, of as many particles as a register
 * holds, from particle q of the chunk on. */
MPMI_INLINE void pack_values(int32_t form, const mpmi_lanes *value, int32_t whole, int64_t q, double *to) {
  if (form < MPMI_SCATTER_8 || is_flat(form)) {
    mpmi_interleave(value, to + 4 * q);
  } else if (!whole) {
    mpmi_interleave(value + 4, to + 4 * q);
  } else if (has_halves(form)) {
    mpmi_interleave(value, to + 4 * q);
    mpmi_interleave(value + 4, to + 4 * (MPMI_CHUNK + q));
  } else {
    mpmi_interleave8(value, to + 8 * q);
  }
}
/* Returns the same of particle p. */
MPMI_INLINE mpmi_node packed(int32_t form, const double *of, int32_t whole, int64_t p) {
  if (form < MPMI_SCATTER_8) return mpmi_node_load(MPMI_LOW, of + 4 * p);
  if (!whole) return mpmi_node_load_high(part_of(form), of + 4 * p);
  return has_halves(form) ? mpmi_node_load_halves(of + 4 * p, of + 4 * (MPMI_CHUNK + p))
                          : mpmi_node_load(MPMI_BOTH, of + 8 * p);
}

/* Scatters mass, momentum and force, or with 4 values mass and affine momentum. Without an affine part the
 * columns have nothing to give to momentum. */
MPMI_INLINE void scatter_first_order(int32_t dim, int32_t width, int32_t form, const mpmi_weights *W,
                                     const double *inverse_spacing, int64_t p, const mpmi_first_order *of,
                                     double *MPMI_APART stencil) {
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1;
  const int32_t values = form < MPMI_SCATTER_8 ? 4 : 8, moment = moment_of(form);
  const int32_t all = all_of(form), part = part_of(form);
  const mpmi_node a = packed(form, of->a, 1, p);
  mpmi_node column[3];
  for (int32_t k = 0; k < dim; ++k) column[k] = packed(form, of->column[k], moment != NO_MOMENT, p);
  /* sums over the axes before the last: node += w_k value + s_k slope */
  mpmi_node plane = a, plane_1 = column[0], plane_2 = column[last], value = a, slope = column[last];
  MPMI_UNROLL for (int32_t i = 0; i < width; ++i) {
    if (dim < 3 && i > 0) break;
    if (dim == 3) {
      const double w = W->w[0][i][p];
      plane = mpmi_node_scale(all, w, grown(width, part, moment, i, a, column[0]));
      plane = add_second(dim, width, values, part, plane, moment, W, inverse_spacing, 0, i, p, column[0]);
      plane_1 = mpmi_node_scale(part, w, column[1]);
      plane_2 = mpmi_node_scale(part, w, column[2]);
    }
    MPMI_UNROLL for (int32_t j = 0; j < width; ++j) {
      if (dim < 2 && j > 0) break;
      if (dim >= 2) {
        const double w = W->w[dim - 2][j][p];
        value = mpmi_node_scale(all, w, grown(width, part, moment, j, plane, plane_1));
        value =
            add_second(dim, width, values, part, value, moment, W, inverse_spacing, dim - 2, j, p, plane_1);
        slope = mpmi_node_scale(part, w, plane_2);
      }
      double *node = stencil + values * (i * edge + j) * (dim == 1 ? 0 : edge);
      MPMI_UNROLL for (int32_t k = 0; k < width; ++k) {
        mpmi_node q = mpmi_node_load(all, node + values * k);
        q = mpmi_node_fma(all, q, W->w[last][k][p], grown(width, part, moment, k, value, slope));
        mpmi_node_store(
            all, node + values * k,
            add_second(dim, width, values, part, q, moment, W, inverse_spacing, last, k, p, slope));
      }
    }
  }
}

/* Returns a + second weight * column of momentum and force together. */
MPMI_INLINE mpmi_v4 add_flat_second(int32_t dim, int32_t width, mpmi_v4 a, int32_t moment,
                                    const mpmi_weights *W, const double *inverse_spacing, int32_t axis,
                                    int32_t k, int64_t p, mpmi_v4 column) {
  const double g = mpmi_gradient(dim, width, W, inverse_spacing, axis, k, p);
  if (!moment) return mpmi_fma4(a, g, column);
  const int32_t steps = k - MPMI_MIDDLE(width);
  const double u = moment == UNEVEN_MOMENT ? W->u[axis][k][p] : steps ? steps * W->w[axis][k][p] : 0.0;
  return mpmi_fma_pair4(a, u, g, column);
}

/* Scatters momentum and force of 1-D or 2-D to the nodes of a stencil, and mass to theirs, row by row. */
MPMI_INLINE void scatter_flat(int32_t dim, int32_t width, int32_t moment, const mpmi_weights *W,
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
      value = add_flat_second(dim, width, mpmi_scale4(w, a), moment, W, inverse_spacing, 0, j, p, column);
      slope = mpmi_scale4(w, step);
      row_mass = w * mass;
    }
    double *node = stencil + 4 * j * edge, *row = masses + j * edge;
    MPMI_UNROLL for (int32_t k = 0; k < width; ++k) {
      const mpmi_v4 q = mpmi_fma4(mpmi_load4(node + 4 * k), W->w[last][k][p], value);
      mpmi_store4(node + 4 * k,
                  add_flat_second(dim, width, q, moment, W, inverse_spacing, last, k, p, slope));
    }
    mpmi_store4(row, mpmi_fma4(mpmi_load4(row), row_mass, weights));
  }
}

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

/* What as many particles as a register holds give, component by component; matrices are [column][row]. */
typedef struct mpmi_given {
  mpmi_lanes momentum[3], affine[3][3], force[3], stress[3][3];
} mpmi_given;

/* The hoop stress of a ring pulls it inwards: f_r -= V sigma_theta / r; where radius and weights are those of
 * the reference positions, r = F_theta R. */
MPMI_INLINE void give_hoop_force(int32_t total, const mpmi_scatter *job, int64_t s, mpmi_given *to) {
  const mpmi_lanes zero = {0.0}, radius = mpmi_lanes_load(job->points.x[0] + s);
  const mpmi_lanes volume = mpmi_lanes_load(job->volume + s), sigma = mpmi_lanes_load(job->stress[2] + s);
  const mpmi_lanes force = volume * sigma / (total ? mpmi_lanes_load(job->F[4] + s) * radius : radius);
  to->force[0] -= mpmi_lanes_select(radius > 0.0, force, zero);
}

/* Computes -V sigma, or -V sigma F^-T. */
MPMI_INLINE void give_stress(int32_t dim, int32_t total, const mpmi_scatter *job,
                             const mpmi_stress_rows *stress, int64_t s, mpmi_given *to) {
  const mpmi_lanes volume = mpmi_lanes_load(job->volume + s);
  for (int32_t k = 0; k < dim; ++k)
    for (int32_t r = k; r < dim; ++r)
      to->stress[k][r] = to->stress[r][k] = -volume * mpmi_lanes_load(stress->at[k][r] + s);
  if (!total) return;
  mpmi_lanes inverse[3][3], force[3];
  mpmi_inverse_load(dim, job->F, s, inverse);
  for (int32_t r = 0; r < dim; ++r) {
    for (int32_t j = 0; j < dim; ++j) force[j] = to->stress[j][r];
    for (int32_t k = 0; k < dim; ++k) {
      mpmi_lanes sum = {0.0};
      for (int32_t j = 0; j < dim; ++j) sum += force[j] * inverse[k][j];
      to->stress[k][r] = sum;
    }
  }
}

/* Computes the external force. */
MPMI_INLINE void give_force(int32_t dim, int32_t total, const mpmi_scatter *job, int64_t s, mpmi_given *to) {
  const mpmi_lanes zero = {0.0}, mass = mpmi_lanes_load(job->mass + s);
  for (int32_t r = 0; r < dim; ++r) {
    const mpmi_lanes added = job->force[r] ? mpmi_lanes_load(job->force[r] + s) : zero;
    to->force[r] = mass * job->gravity[r] + added;
  }
  if (dim == 2 && job->hoop) give_hoop_force(total, job, s, to);
}

/* Computes momentum, for the particles from s in the set and q in the chunk on. Where nodes are a spacing
 * apart: m (v + C d) at the first node in form 4, at the middle one in others, and m C h per node of each
 * axis; in form 4 the fused force adds dt f_ext to m v and -dt V sigma D^-1 to m C. Elsewhere the columns of
 * m C. */
MPMI_INLINE void give_momentum(int32_t dim, int32_t width, int32_t form, int32_t total,
                               const mpmi_scatter *job, const mpmi_stress_rows *stress, int64_t s, int64_t q,
                               const mpmi_weights *W, mpmi_given *to) {
  const int32_t moment = moment_of(form), fused = form == MPMI_SCATTER_4_AFFINE && job->fused_dt != 0.0;
  const int32_t from = form == MPMI_SCATTER_4_AFFINE ? 0 : MPMI_MIDDLE(width);
  const mpmi_lanes mass = mpmi_lanes_load(job->mass + s), volume = mpmi_lanes_load(job->volume + s);
  for (int32_t r = 0; r < dim; ++r) {
    const double dv = fused ? job->fused_dt * job->gravity[r] : 0.0;
    to->momentum[r] = mass * (mpmi_lanes_load(job->v[r] + s) + dv);
    if (fused && job->force[r]) to->momentum[r] += job->fused_dt * mpmi_lanes_load(job->force[r] + s);
    for (int32_t k = 0; moment && k < dim; ++k) {
      const mpmi_lanes C = mpmi_lanes_load(job->affine[3 * r + k] + s);
      const double h = job->axis[k].spacing;
      const double scale = fused ? -job->fused_dt * MPMI_MLS_INVERSE(width) / h : 0.0;
      if (moment == UNEVEN_MOMENT) {
        to->affine[k][r] = mass * C;
        continue;
      }
      if (form != MPMI_SCATTER_4_AFFINE)
        to->affine[k][r] = mass * C * h;
      else if (total)
        to->affine[k][r] = mass * C * h - scale * to->stress[k][r];
      else
        to->affine[k][r] = mass * C * h + scale * volume * mpmi_lanes_load(stress->at[k][r] + s);
      to->momentum[r] += (mpmi_lanes_load(W->first[k] + q) + from) * to->affine[k][r];
    }
  }
}

/* Packs what was given in the order of a node's values, from particle q of the chunk on. */
MPMI_INLINE void pack(int32_t dim, int32_t form, mpmi_lanes mass, int64_t q, const mpmi_given *given,
                      mpmi_first_order *of) {
  const mpmi_lanes zero = {0.0};
  const int32_t moment = moment_of(form) != NO_MOMENT, flat = is_flat(form);
  mpmi_lanes a[8] = {zero, zero, zero, zero, zero, zero, zero, zero};
  const int32_t force = flat ? 2 : 4;
  for (int32_t r = 0; r < dim; ++r) a[r] = given->momentum[r];
  for (int32_t r = 0; r < dim && form >= MPMI_SCATTER_8; ++r) a[force + r] = given->force[r];
  if (!flat) a[3] = mass;
  pack_values(form, a, 1, q, of->a);
  for (int32_t k = 0; (form >= MPMI_SCATTER_8 || moment) && k < dim; ++k) {
    mpmi_lanes c[8] = {zero, zero, zero, zero, zero, zero, zero, zero};
    for (int32_t r = 0; r < dim && moment; ++r) c[r] = given->affine[k][r];
    for (int32_t r = 0; r < dim && form >= MPMI_SCATTER_8; ++r) c[force + r] = given->stress[k][r];
    pack_values(form, c, moment, q, of->column[k]);
  }
}

/* Computes what the particles of a chunk give, with gradients over reference positions where `total`. */
MPMI_INLINE void give(int32_t dim, int32_t width, int32_t form, int32_t total, const mpmi_scatter *job,
                      const mpmi_stress_rows *stress, int64_t begin, int64_t n, const mpmi_weights *W,
                      mpmi_first_order *of) {
  for (int64_t q = 0; q < mpmi_whole_chunks(n); q += MPMI_LANES) {
    const int64_t s = begin + q;
    mpmi_given given;
    if (total || form >= MPMI_SCATTER_8) give_stress(dim, total, job, stress, s, &given);
    give_momentum(dim, width, form, total, job, stress, s, q, W, &given);
    if (form >= MPMI_SCATTER_8) give_force(dim, total, job, s, &given);
    pack(dim, form, mpmi_lanes_load(job->mass + s), q, &given, of);
  }
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
        scatter_flat(dim, width, moment_of(form), &W, inverse_spacing, p, &of, job->mass[s + p], stencil,
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
