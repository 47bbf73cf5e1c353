/* G2P: nodal velocity, its change and its gradient at the particles of one block, from the block's tile.
 *
 *   v_p  = sum w_ip v_i        dv_p = sum w_ip (v_i - v_i^n)      MPoint theory eqs 34, 35
 *   L_p  = sum v_i (x) grad w_ip                                  MPoint theory eq. 38
 *   C_p  = (sum w_ip v_i (x) (x_i - x_p)) D_p^-1                  APIC: Jiang et al. 2017
 *
 * Summed node by node, row by row, axis by axis. Where D is the same for all particles the moments of C are
 * those about the middle of the stencil, where distances are small integers, moved to the particle at the
 * end; where D can be small the digits lost in moving them would count. Holes have no initial volume and
 * gather zeros. */
#include "simd/pack.h"
#include "transfer/gather.h"

/* Holds, per particle of a chunk: v; dv; gradients; sums of w v (x_i - x_p), or of w v (i - middle) where D
 * is the same for all. Below three axes two of these share four values: v and dv, and the columns of a
 * matrix. */
typedef struct mpmi_gathered {
  _Alignas(64) double v[4 * MPMI_CHUNK], dv[4 * MPMI_CHUNK], L[3][4 * MPMI_CHUNK], M[3][4 * MPMI_CHUNK];
} mpmi_gathered;

/* sum += w_k v_k; with `moment` also *m += (k - middle) w_k v_k of the velocity, which is the part of v that
 * comes first. Called for k = 0, 1 ... in order. */
MPMI_INLINE void add(int32_t all, int32_t part, int32_t moment, int32_t width, int32_t k, double w,
                     mpmi_node v, mpmi_node *sum, mpmi_node *m) {
  const int32_t middle = MPMI_MIDDLE(width);
  if (!moment || k == middle) {
    *sum = k ? mpmi_node_fma(all, *sum, w, v) : mpmi_node_scale(all, w, v);
    return;
  }
  const mpmi_node term = mpmi_node_round(all, mpmi_node_scale(all, w, v));
  *sum = k ? mpmi_node_sum(all, *sum, term) : term;
  if (k == middle + 1)
    *m = middle ? mpmi_node_difference(part, term, *m) : term;
  else
    *m = k ? mpmi_node_fma(part, *m, k - middle, term) : term;
}

/* slope += g_k v_k. */
MPMI_INLINE void add_slope(int32_t part, int32_t k, double g, mpmi_node v, mpmi_node *slope) {
  *slope = k ? mpmi_node_fma(part, *slope, g, v) : mpmi_node_scale(part, g, v);
}

/* How a form finds C: not at all, by moments about the middle of the stencil, or by weights of its own. */
enum { NO_MOMENT, EVEN_MOMENT, VARIED_MOMENT };
MPMI_INLINE int32_t moment_of(int32_t form) {
  if (form == MPMI_GATHER_MLS || form == MPMI_GATHER_AFFINE || form == MPMI_GATHER_BOTH_AFFINE)
    return EVEN_MOMENT;
  return mpmi_gathers_C(form) ? VARIED_MOMENT : NO_MOMENT;
}

MPMI_INLINE void store_columns(int32_t dim, int32_t part, const mpmi_node *column, int64_t p,
                               double (*to)[4 * MPMI_CHUNK]) {
  if (dim == 2) {
    mpmi_store4(to[0] + 4 * p, mpmi_pair4(mpmi_node_low(part, column[0]), mpmi_node_low(part, column[1])));
    return;
  }
  for (int32_t k = 0; k < dim; ++k) mpmi_store4(to[k] + 4 * p, mpmi_node_low(part, column[k]));
}

MPMI_INLINE void gather_particle(int32_t dim, int32_t width, int32_t form, const mpmi_weights *W,
                                 const double *inverse_spacing, int64_t p, const double *tile,
                                 mpmi_gathered *out) {
  const int32_t values = mpmi_taken_values(mpmi_gather_takes(dim, form)), slopes = mpmi_gathers_L(form);
  const int32_t moment = moment_of(form), even = moment == EVEN_MOMENT, varied = moment == VARIED_MOMENT;
  const int32_t all = values == 8 ? MPMI_BOTH : MPMI_LOW, part = values == 8 ? MPMI_HALF : MPMI_LOW;
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1, mid = dim >= 2 ? dim - 2 : 0;
  const double *stencil = tile + (int64_t)values * W->node[p];
  MPMI_SETTLE(stencil);
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
        add(all, part, even, width, k, W->w[last][k][p], vi, &rv, &rM);
        if (slopes) add_slope(part, k, mpmi_gradient(dim, width, W, inverse_spacing, last, k, p), vi, &rL);
        if (varied) add_slope(part, k, W->u[last][k][p], vi, &rM);
      }
      if (dim == 1) {
        pv = rv, pL[last] = rL, pM[last] = rM;
        continue;
      }
      const double w = W->w[mid][j][p];
      add(all, part, even, width, j, w, rv, &pv, &pM[mid]);
      if (slopes) add_slope(part, j, mpmi_gradient(dim, width, W, inverse_spacing, mid, j, p), rv, &pL[mid]);
      if (slopes) add_slope(part, j, w, rL, &pL[last]);
      if (varied) add_slope(part, j, W->u[mid][j][p], rv, &pM[mid]);
      if (moment) add_slope(part, j, w, rM, &pM[last]);
    }
    if (dim < 3) {
      v = pv;
      for (int32_t k = 0; k < dim; ++k) L[k] = pL[k], M[k] = pM[k];
      continue;
    }
    const double w = W->w[0][i][p];
    add(all, part, even, width, i, w, pv, &v, &M[0]);
    if (slopes) add_slope(part, i, mpmi_gradient(dim, width, W, inverse_spacing, 0, i, p), pv, &L[0]);
    if (varied) add_slope(part, i, W->u[0][i][p], pv, &M[0]);
    for (int32_t k = 1; k < dim; ++k) {
      if (slopes) add_slope(part, i, w, pL[k], &L[k]);
      if (moment) add_slope(part, i, w, pM[k], &M[k]);
    }
  }
  mpmi_store4(out->v + 4 * p, mpmi_node_low(all, v));
  if (values == 8) mpmi_store4(out->dv + 4 * p, mpmi_node_high(v));
  if (slopes) store_columns(dim, part, L, p, out->L);
  if (moment) store_columns(dim, part, M, p, out->M);
}

/* Column k of C from its moments about the middle of the stencil. */
MPMI_INLINE void even_column(int32_t width, double h, int32_t dim, mpmi_lanes first, const mpmi_lanes *v,
                             mpmi_lanes *column) {
  const double factor = MPMI_MLS_INVERSE(width) / h;
  for (int32_t r = 0; r < dim; ++r) column[r] = (column[r] + (first + MPMI_MIDDLE(width)) * v[r]) * factor;
}

/* Takes the columns of a matrix for as many particles as a register holds, from q on. */
MPMI_INLINE void take_columns(int32_t dim, const double (*from)[4 * MPMI_CHUNK], int64_t q,
                              mpmi_lanes (*column)[4]) {
  for (int32_t k = 0; k < (dim == 2 ? 1 : dim); ++k) mpmi_separate(from[k] + 4 * q, column[k]);
  if (dim == 2) column[1][0] = column[0][2], column[1][1] = column[0][3];
}

/* What the particles of a batch are made of, by the kernels of others, while it is in registers. */
typedef struct mpmi_made {
  mpmi_moved moved;
  mpmi_deformed deformed;
} mpmi_made;

MPMI_INLINE void store_matrix(int32_t dim, double *const *to, int64_t s, mpmi_lanes (*matrix)[3]) {
  for (int32_t r = 0; r < dim; ++r)
    for (int32_t k = 0; k < dim; ++k) mpmi_lanes_store(to[3 * r + k] + s, matrix[r][k]);
}

/* Hands on what was gathered for as many particles as a register holds, from q in the chunk and s in the
 * batch on. */
MPMI_INLINE void hand_on(int32_t dim, int32_t width, int32_t form, const mpmi_gather *job, int64_t q,
                         int64_t s, const mpmi_weights *W, const mpmi_gathered *in, mpmi_made *made) {
  const int32_t mls = form == MPMI_GATHER_MLS, both = mpmi_gathers_change(form);
  const int32_t gradient = mls || mpmi_gathers_L(form);
  mpmi_lanes v[4], change[4] = {{0.0}}, L[3][3], column[3][4];
  const mpmi_lanes *const dv = both && dim < 3 ? v + 2 : change;
  mpmi_separate(in->v + 4 * q, v);
  if (both && dim == 3) mpmi_separate(in->dv + 4 * q, change);
  if (gradient) take_columns(dim, mls ? in->M : in->L, q, column);
  for (int32_t k = 0; k < dim && gradient; ++k) {
    if (mls) even_column(width, job->axis[k].spacing, dim, mpmi_lanes_load(W->first[k] + q), v, column[k]);
    for (int32_t r = 0; r < dim; ++r) L[r][k] = column[k][r];
  }
  if (job->v)
    for (int32_t k = 0; k < dim; ++k) {
      mpmi_lanes_store(job->v + k * job->ld + s, v[k]);
      if (both) mpmi_lanes_store(job->dv + k * job->ld + s, dv[k]);
    }
  if (gradient && job->L[0]) store_matrix(dim, job->L, s, L);
  if (job->move) mpmi_move_lanes(dim, job->move, s, v, dv, &made->moved);
  if (gradient && job->deform) mpmi_deform_lanes(dim, job->deform, s, L, &made->deformed);
  if (!mpmi_gathers_C(form)) return;
  take_columns(dim, in->M, q, column);
  for (int32_t k = 0; k < dim; ++k) {
    if (moment_of(form) == EVEN_MOMENT)
      even_column(width, job->axis[k].spacing, dim, mpmi_lanes_load(W->first[k] + q), v, column[k]);
    for (int32_t r = 0; r < dim; ++r)
      L[r][k] = moment_of(form) == EVEN_MOMENT ? column[k][r]
                                               : column[k][r] * mpmi_lanes_load(W->inverse_moment[k] + q);
  }
  store_matrix(dim, job->C, s, L);
}

MPMI_INLINE int32_t has_hole(const double *volume, int64_t n) {
  mpmi_lanes smallest = mpmi_lanes_load(volume);
  for (int64_t p = MPMI_LANES; p < mpmi_whole_chunks(n); p += MPMI_LANES)
    smallest = mpmi_lanes_min(smallest, mpmi_lanes_load(volume + p));
  return !(mpmi_lanes_smallest(smallest) > 0.0);
}

/* Takes the weight from holes, of whose nodes nothing is known: along one axis, or along all where gradients
 * are alike and stay. */
MPMI_INLINE void mask_holes(int32_t dim, int32_t width, int32_t form, const double *volume, int64_t n,
                            mpmi_weights *W) {
  for (int32_t k = 0; k < width; ++k) MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
      const double live = volume[p] > 0.0 ? 1.0 : 0.0;
      for (int32_t a = 0; a < (mpmi_gradients_alike(dim, width) ? dim : 1); ++a) W->w[a][k][p] *= live;
      if (!mpmi_gradients_alike(dim, width) && mpmi_gathers_L(form)) W->g[0][k][p] *= live;
      if (moment_of(form) == VARIED_MOMENT) W->u[0][k][p] *= live;
    }
}

MPMI_INLINE mpmi_taken gather(int32_t dim, int32_t width, int32_t form, const mpmi_gather *job, int64_t begin,
                              int64_t count) {
  mpmi_weights W;
  mpmi_gathered out;
  double inverse_spacing[3] = {0.0, 0.0, 0.0};
  for (int32_t k = 0; k < dim; ++k) inverse_spacing[k] = job->axis[k].inverse_spacing;
  mpmi_made made = {mpmi_nothing_moved(), mpmi_nothing_deformed()};
  for (int64_t s = 0; s < count; s += MPMI_CHUNK) {
    const int64_t n = count - s < MPMI_CHUNK ? count - s : MPMI_CHUNK;
    job->weights(job->axis, job->need, &job->points, begin + s, n, &W);
    if (has_hole(job->initial_volume + begin + s, n))
      mask_holes(dim, width, form, job->initial_volume + begin + s, n, &W);
    const int64_t ahead = mpmi_ahead(&job->streams, begin + s);
    for (int64_t p = 0; p < n; ++p) {
      mpmi_prefetch(&job->streams, ahead, p);
      gather_particle(dim, width, form, &W, inverse_spacing, p, job->tile, &out);
    }
    for (int64_t q = 0; q < mpmi_whole_chunks(n); q += MPMI_LANES)
      hand_on(dim, width, form, job, q, s + q, &W, &out, &made);
  }
  return (mpmi_taken){mpmi_move_flags(&made.moved), mpmi_deform_flags(&made.deformed)};
}

#define GATHER(dim, width, form, name)                                                                       \
  mpmi_taken KERNEL(name)(const mpmi_gather *job, int64_t begin, int64_t n);                                 \
  mpmi_taken KERNEL(name)(const mpmi_gather *job, int64_t begin, int64_t n) {                                \
    return gather(dim, width, form, job, begin, n);                                                          \
  }
#include "transfer/instances.h"
