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
#include "transfer/cluster.h"
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

/* Returns the node of an axis that momentum of a form is taken at. */
MPMI_INLINE int32_t base_of(int32_t width, int32_t form) {
  return form == MPMI_SCATTER_4_AFFINE ? 0 : MPMI_MIDDLE(width);
}

/* Returns the momentum so many nodes of an axis away, of that at the base and its growth per node; force, in
 * the upper half, stays. */
MPMI_INLINE mpmi_node grown(int32_t part, int32_t moment, int32_t steps, mpmi_node base, mpmi_node growth) {
  if (moment != EVEN_MOMENT || steps == 0) return base;
  if (steps < 0) return mpmi_node_subtract_low(part, base, growth);
  mpmi_node value = mpmi_node_add_low(part, base, growth);
  if (steps > 1) value = mpmi_node_add_low(part, value, growth);
  return steps > 2 ? mpmi_node_add_low(part, value, growth) : value;
}

/* Returns a + second weight * column; with 4 values there is only the momentum's, where nodes are uneven. */
MPMI_INLINE mpmi_node add_second(int32_t dim, int32_t width, int32_t values, int32_t part, mpmi_node a,
                                 int32_t moment, const mpmi_weights *W, const double *inverse_spacing,
                                 int32_t axis, int32_t k, int64_t p, mpmi_node column) {
  if (values == 4 && moment != UNEVEN_MOMENT) return a;
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

/* What a particle gives, or what has become of it over some axes: a value, and by axis a column. */
typedef struct mpmi_giving {
  mpmi_node value, column[3];
} mpmi_giving;

MPMI_INLINE mpmi_giving given_by(int32_t dim, int32_t form, const mpmi_first_order *of, int64_t p) {
  const mpmi_node zero = mpmi_node_zero();
  mpmi_giving in = {packed(form, of->a, 1, p), {zero, zero, zero}};
  for (int32_t k = 0; k < dim && form != MPMI_SCATTER_4; ++k)
    in.column[k] = packed(form, of->column[k], moment_of(form) != NO_MOMENT, p);
  return in;
}

/* sum += what is given to node k of an axis by the weights of particle p; sum = that where it comes first. */
MPMI_INLINE void add_given(int32_t dim, int32_t width, int32_t form, int32_t is_first, const mpmi_weights *W,
                           const double *inverse_spacing, int32_t axis, int32_t k, int64_t p,
                           const mpmi_giving *in, mpmi_giving *sum) {
  const int32_t values = form < MPMI_SCATTER_8 ? 4 : 8, moment = moment_of(form);
  const int32_t all = all_of(form), part = part_of(form);
  const double w = W->w[axis][k][p];
  const mpmi_node value = grown(part, moment, k - base_of(width, form), in->value, in->column[axis]);
  sum->value = is_first ? mpmi_node_scale(all, w, value) : mpmi_node_fma(all, sum->value, w, value);
  sum->value = add_second(dim, width, values, part, sum->value, moment, W, inverse_spacing, axis, k, p,
                          in->column[axis]);
  for (int32_t a = axis + 1; a < dim && form != MPMI_SCATTER_4; ++a)
    sum->column[a] = is_first ? mpmi_node_scale(part, w, in->column[a])
                              : mpmi_node_fma(part, sum->column[a], w, in->column[a]);
}

/* Scatters to planes of nodes of 3-D, or in 2-D and 1-D to all nodes, what particle p gives, or the cluster
 * that begins with it: `ends` is the number of particles along an axis. Mass, momentum and force, or with 4
 * values mass and momentum. Without an affine part the columns have nothing to give to momentum. */
MPMI_INLINE void scatter_planes(int32_t dim, int32_t width, int32_t form, int32_t ends, int32_t begin,
                                int32_t end, const mpmi_weights *W, const double *inverse_spacing, int64_t p,
                                const mpmi_first_order *of, double *MPMI_APART stencil) {
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1, mid = dim >= 2 ? dim - 2 : 0;
  const int32_t values = form < MPMI_SCATTER_8 ? 4 : 8, all = all_of(form);
  const mpmi_giving of_p = given_by(dim, form, of, p);
  mpmi_giving plane[4], row[2]; /* sums over the first axis, and over the one but last */
  MPMI_UNROLL for (int32_t i = begin; i < end; ++i) {
    for (int32_t y = 0; y < (dim == 1 ? 1 : ends); ++y)
      for (int32_t z = 0; z < ends; ++z)
        for (int32_t x = 0; x < (dim == 3 ? ends : 1); ++x) {
          const int64_t first = p + (dim == 3 ? MPMI_CLUSTER_END(dim, 0, x) : 0);
          const mpmi_giving in = ends == 1 ? of_p : given_by(dim, form, of, first + 2 * y + z);
          if (dim < 3)
            plane[2 * y + z] = in;
          else
            add_given(dim, width, form, x == 0, W, inverse_spacing, 0, i, first, &in, &plane[2 * y + z]);
        }
    MPMI_UNROLL for (int32_t j = 0; j < width; ++j) {
      if (dim < 2 && j > 0) break;
      for (int32_t z = 0; z < ends; ++z)
        for (int32_t y = 0; y < (dim == 1 ? 1 : ends); ++y)
          if (dim == 1)
            row[z] = plane[z];
          else
            add_given(dim, width, form, y == 0, W, inverse_spacing, mid, j, p + MPMI_CLUSTER_END(dim, mid, y),
                      &plane[2 * y + z], &row[z]);
      double *node = stencil + values * (i * edge + j) * (dim == 1 ? 0 : edge);
      MPMI_UNROLL for (int32_t k = 0; k < width; ++k) {
        mpmi_giving sum = {.value = mpmi_node_load(all, node + values * k)};
        for (int32_t z = 0; z < ends; ++z)
          add_given(dim, width, form, 0, W, inverse_spacing, last, k, p + MPMI_CLUSTER_END(dim, last, z),
                    &row[z], &sum);
        mpmi_node_store(all, node + values * k, sum.value);
      }
    }
  }
}

/* Scatters to the whole stencil. Clusters of 3-D go plane by plane in a loop, which costs no time and makes
 * their code two fifths smaller. */
MPMI_INLINE void scatter_stencil(int32_t dim, int32_t width, int32_t form, int32_t ends,
                                 const mpmi_weights *W, const double *inverse_spacing, int64_t p,
                                 const mpmi_first_order *of, double *stencil) {
  if (dim == 3 && ends > 1)
    for (int32_t i = 0; i < width; ++i)
      scatter_planes(dim, width, form, ends, i, i + 1, W, inverse_spacing, p, of, stencil);
  else
    scatter_planes(dim, width, form, ends, 0, dim == 3 ? width : 1, W, inverse_spacing, p, of, stencil);
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

/* What a particle of 1-D or 2-D gives, or what has become of it over an axis: momentum and force, mass, and
 * by axis a column. */
typedef struct mpmi_flat_giving {
  mpmi_v4 value, column[2];
  double mass;
} mpmi_flat_giving;

MPMI_INLINE mpmi_flat_giving flat_given_by(int32_t dim, const mpmi_first_order *of, const double *mass,
                                           int64_t p) {
  const mpmi_v4 first = mpmi_load4(of->column[0] + 4 * p);
  return (mpmi_flat_giving){
      mpmi_load4(of->a + 4 * p), {first, dim == 2 ? mpmi_load4(of->column[1] + 4 * p) : first}, mass[p]};
}

/* Scatters momentum and force of 1-D or 2-D to the nodes of a stencil, and mass to theirs, row by row: those
 * of particle p, or of the cluster that begins with it, `ends` along an axis. */
MPMI_INLINE void scatter_flat(int32_t dim, int32_t width, int32_t moment, int32_t ends, const mpmi_weights *W,
                              const double *inverse_spacing, int64_t p, const mpmi_first_order *of,
                              const double *mass, double *MPMI_APART stencil, double *MPMI_APART masses) {
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1;
  const mpmi_flat_giving of_p = flat_given_by(dim, of, mass, p);
  mpmi_v4 weights[2];
  for (int32_t z = 0; z < ends; ++z)
    weights[z] = mpmi_set4(W->w[last][0][p + z], W->w[last][1][p + z], width > 2 ? W->w[last][2][p + z] : 0.0,
                           width > 3 ? W->w[last][3][p + z] : 0.0);
  MPMI_UNROLL for (int32_t j = 0; j < width; ++j) {
    if (dim < 2 && j > 0) break;
    double *node = stencil + 4 * j * edge, *row = masses + j * edge;
    mpmi_flat_giving given[2];
    for (int32_t z = 0; z < ends; ++z)
      for (int32_t y = 0; y < (dim == 2 ? ends : 1); ++y) {
        const int64_t at = p + (dim == 2 ? MPMI_CLUSTER_END(2, 0, y) : 0) + z;
        const mpmi_flat_giving in = ends == 1 ? of_p : flat_given_by(dim, of, mass, at);
        if (dim == 1) {
          given[z] = in;
          continue;
        }
        const double w = W->w[0][j][at];
        const mpmi_v4 value = y ? mpmi_fma4(given[z].value, w, in.value) : mpmi_scale4(w, in.value);
        given[z].value =
            add_flat_second(dim, width, value, moment, W, inverse_spacing, 0, j, at, in.column[0]);
        given[z].column[1] =
            y ? mpmi_fma4(given[z].column[1], w, in.column[1]) : mpmi_scale4(w, in.column[1]);
        given[z].mass = y ? given[z].mass + w * in.mass : w * in.mass;
      }
    MPMI_UNROLL for (int32_t k = 0; k < width; ++k) {
      mpmi_v4 q = mpmi_load4(node + 4 * k);
      for (int32_t z = 0; z < ends; ++z) {
        q = mpmi_fma4(q, W->w[last][k][p + z], given[z].value);
        q = add_flat_second(dim, width, q, moment, W, inverse_spacing, last, k, p + z, given[z].column[last]);
      }
      mpmi_store4(node + 4 * k, q);
    }
    mpmi_v4 sum = mpmi_load4(row);
    for (int32_t z = 0; z < ends; ++z) sum = mpmi_fma4(sum, given[z].mass, weights[z]);
    mpmi_store4(row, sum);
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

/* Computes -V sigma, or -V sigma F^-T = -V / J sigma (J F^-1)^T. */
MPMI_INLINE void give_stress(int32_t dim, int32_t total, const mpmi_scatter *job,
                             const mpmi_stress_rows *stress, int64_t s, mpmi_given *to) {
  mpmi_lanes scale = -mpmi_lanes_load(job->volume + s), adjugate[3][3], force[3];
  if (total) scale = scale / mpmi_adjugate_load(dim, job->F, s, adjugate);
  for (int32_t k = 0; k < dim; ++k)
    for (int32_t r = k; r < dim; ++r)
      to->stress[k][r] = to->stress[r][k] = scale * mpmi_lanes_load(stress->at[k][r] + s);
  for (int32_t r = 0; total && r < dim; ++r) {
    for (int32_t j = 0; j < dim; ++j) force[j] = to->stress[j][r];
    for (int32_t k = 0; k < dim; ++k) {
      mpmi_lanes sum = {0.0};
      for (int32_t j = 0; j < dim; ++j) sum += force[j] * adjugate[k][j];
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

/* Returns the first node of the stencil of particle p. */
MPMI_INLINE double *first_node_of(int32_t form, const mpmi_scatter *job, const mpmi_weights *W, int64_t p) {
  double *stencil = job->tile + (form >= MPMI_SCATTER_8 && !is_flat(form) ? 8 : 4) * (int64_t)W->node[p];
  MPMI_SETTLE(stencil);
  return stencil;
}

/* Adds to the tile what particle p of the chunk from slot s on gives, or the cluster that begins with it. */
MPMI_INLINE void scatter_given(int32_t dim, int32_t width, int32_t form, int32_t ends,
                               const mpmi_scatter *job, const mpmi_weights *W, const double *inverse_spacing,
                               int64_t s, int64_t p, const mpmi_first_order *of, double *stencil) {
  if (is_flat(form))
    scatter_flat(dim, width, moment_of(form), ends, W, inverse_spacing, p, of, job->mass + s, stencil,
                 mpmi_flat_masses(dim, width, job->tile) + W->node[p]);
  else if (form == MPMI_SCATTER_4 && ends == 1)
    mpmi_scatter_plain(dim, width, W, p, of->a + 4 * p, stencil);
  else if (form == MPMI_SCATTER_4_AFFINE && ends == 1)
    scatter_linear(dim, width, W, p, of, stencil);
  else
    scatter_stencil(dim, width, form, ends, W, inverse_spacing, p, of, stencil);
}

/* Scatters what the clusters give that a chunk begins with; returns the first particle that is in none. */
MPMI_INLINE int64_t scatter_clusters(int32_t dim, int32_t width, int32_t form, const mpmi_scatter *job,
                                     int64_t s, const mpmi_weights *W, const double *inverse_spacing,
                                     const mpmi_first_order *of) {
  const int64_t ahead = mpmi_ahead(&job->streams, s);
  int64_t p = 0;
  while (p < MPMI_CHUNK && mpmi_is_cluster(dim, &job->points, W, s + p, p)) {
    scatter_given(dim, width, form, 2, job, W, inverse_spacing, s, p, of, first_node_of(form, job, W, p));
    for (const int64_t end = p + MPMI_CLUSTER(dim); p < end; ++p) mpmi_prefetch(&job->streams, ahead, p);
  }
  return p;
}
typedef int64_t (*scatter_clusters_fn)(const mpmi_scatter *job, int64_t s, const mpmi_weights *W,
                                       const double *inverse_spacing, const mpmi_first_order *of);

MPMI_INLINE void scatter(int32_t dim, int32_t width, int32_t form, scatter_clusters_fn clusters,
                         const mpmi_scatter *job, int64_t begin, int64_t end) {
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
    const int64_t first = job->axis[0].still ? clusters(job, s, &W, inverse_spacing, &of) : 0;
    const int64_t ahead = mpmi_ahead(&job->streams, s);
    for (int64_t p = first; p < n; ++p) {
      double *stencil = first_node_of(form, job, &W, p);
      mpmi_prefetch(&job->streams, ahead, p);
      scatter_given(dim, width, form, 1, job, &W, inverse_spacing, s, p, &of, stencil);
    }
  }
}

/* Clusters have a function of their own: within the loop they would take registers from other particles. */
#define SCATTER(dim, width, form, name)                                                                      \
  static __attribute__((noinline)) int64_t KERNEL(name##_clusters)(                                          \
      const mpmi_scatter *job, int64_t s, const mpmi_weights *W, const double *inverse,                      \
      const mpmi_first_order *of) {                                                                          \
    return scatter_clusters(dim, width, form, job, s, W, inverse, of);                                       \
  }                                                                                                          \
  void KERNEL(name)(const mpmi_scatter *job, int64_t begin, int64_t end);                                    \
  void KERNEL(name)(const mpmi_scatter *job, int64_t begin, int64_t end) {                                   \
    scatter(dim, width, form, KERNEL(name##_clusters), job, begin, end);                                     \
  }
#include "transfer/instances.h"
