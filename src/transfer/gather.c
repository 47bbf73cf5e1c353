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
#include "transfer/cluster.h"

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

/* What a form takes of nodes: how many values, which parts of them for v and for the rest, and whether L. */
typedef struct mpmi_taking {
  int32_t values, all, part, slopes, moment;
} mpmi_taking;
MPMI_INLINE mpmi_taking taking_of(int32_t dim, int32_t form) {
  const int32_t values = mpmi_taken_values(mpmi_gather_takes(dim, form));
  return (mpmi_taking){values, values == 8 ? MPMI_BOTH : MPMI_LOW, values == 8 ? MPMI_HALF : MPMI_LOW,
                       mpmi_gathers_L(form), moment_of(form)};
}

/* What is taken over some axes: v and its change, and by axis L and the moments of C. */
typedef struct mpmi_partial {
  mpmi_node v, L[3], M[3];
} mpmi_partial;

/* sum += node k of an axis, or what was taken there over the axes behind it, by the weights of particle p. */
MPMI_INLINE void add_partial(int32_t dim, int32_t width, mpmi_taking t, const mpmi_weights *W,
                             const double *inverse_spacing, int32_t axis, int32_t k, int64_t p,
                             const mpmi_partial *in, mpmi_partial *sum) {
  const double w = W->w[axis][k][p];
  add(t.all, t.part, t.moment == EVEN_MOMENT, width, k, w, in->v, &sum->v, &sum->M[axis]);
  if (t.slopes)
    add_slope(t.part, k, mpmi_gradient(dim, width, W, inverse_spacing, axis, k, p), in->v, &sum->L[axis]);
  if (t.moment == VARIED_MOMENT) add_slope(t.part, k, W->u[axis][k][p], in->v, &sum->M[axis]);
  for (int32_t a = axis + 1; a < dim; ++a) {
    if (t.slopes) add_slope(t.part, k, w, in->L[a], &sum->L[a]);
    if (t.moment) add_slope(t.part, k, w, in->M[a], &sum->M[a]);
  }
}

MPMI_INLINE void keep_partial(int32_t dim, mpmi_taking t, const mpmi_partial *of, int64_t p,
                              mpmi_gathered *out) {
  mpmi_store4(out->v + 4 * p, mpmi_node_low(t.all, of->v));
  if (t.values == 8) mpmi_store4(out->dv + 4 * p, mpmi_node_high(of->v));
  if (t.slopes) store_columns(dim, t.part, of->L, p, out->L);
  if (t.moment) store_columns(dim, t.part, of->M, p, out->M);
}

/* Gathers from a layer of nodes, which have one place along the first axis, what is common to the particles
 * that differ along that axis alone; there are `ends` of them along each other one. */
MPMI_INLINE void gather_layer(int32_t dim, int32_t width, mpmi_taking t, int32_t ends, const mpmi_weights *W,
                              const double *inverse_spacing, int64_t p, const double *corner,
                              mpmi_partial *layer) {
  const int32_t edge = MPMI_TILE_EDGE(dim, width), last = dim - 1;
  if (dim == 1) layer->v = mpmi_node_load(t.all, corner);
  MPMI_UNROLL for (int32_t j = 0; j < width; ++j) {
    if (dim == 1 || (dim == 2 && j > 0)) break;
    const double *node = corner + (int64_t)t.values * j * edge;
    mpmi_partial row[2], *const sum = dim == 2 ? layer : row;
    MPMI_UNROLL for (int32_t k = 0; k < width; ++k) {
      const mpmi_partial at = {.v = mpmi_node_load(t.all, node + k * t.values)};
      for (int32_t z = 0; z < ends; ++z)
        add_partial(dim, width, t, W, inverse_spacing, last, k, p + MPMI_CLUSTER_END(dim, last, z), &at,
                    &sum[z]);
    }
    for (int32_t y = 0; dim == 3 && y < ends; ++y)
      for (int32_t z = 0; z < ends; ++z)
        add_partial(dim, width, t, W, inverse_spacing, 1, j, p + MPMI_CLUSTER_END(dim, 1, y), &row[z],
                    &layer[2 * y + z]);
  }
}

/* Returns the distance between layers of a tile, in doubles. */
MPMI_INLINE int64_t layer_stride(int32_t dim, int32_t width, mpmi_taking t) {
  const int64_t edge = MPMI_TILE_EDGE(dim, width);
  return t.values * (dim == 3 ? edge * edge : dim == 2 ? edge : 1);
}

/* Gathers for particle p. */
MPMI_INLINE void gather_stencil(int32_t dim, int32_t width, int32_t form, const mpmi_weights *W,
                                const double *inverse_spacing, int64_t p, const double *tile,
                                mpmi_gathered *out) {
  const mpmi_taking t = taking_of(dim, form);
  const double *stencil = tile + (int64_t)t.values * W->node[p];
  MPMI_SETTLE(stencil);
  mpmi_partial whole, layer;
  MPMI_UNROLL for (int32_t i = 0; i < width; ++i) {
    gather_layer(dim, width, t, 1, W, inverse_spacing, p, stencil + i * layer_stride(dim, width, t), &layer);
    add_partial(dim, width, t, W, inverse_spacing, 0, i, p, &layer, &whole);
  }
  keep_partial(dim, t, &whole, p, out);
}

/* A layer that waits for the others: parts of it in memory. */
typedef struct mpmi_kept_layer {
  _Alignas(64) double v[4][8], L[2][4][8], M[2][4][8];
} mpmi_kept_layer;

MPMI_INLINE void keep_layer(int32_t dim, mpmi_taking t, const mpmi_partial *layer, mpmi_kept_layer *to) {
  for (int32_t yz = 0; yz < MPMI_CLUSTER(dim) / 2; ++yz) {
    mpmi_node_store(t.all, to->v[yz], layer[yz].v);
    for (int32_t a = 0; a < dim - 1 && t.slopes; ++a)
      mpmi_node_store(t.part, to->L[a][yz], layer[yz].L[a + 1]);
    for (int32_t a = 0; a < dim - 1 && t.moment; ++a)
      mpmi_node_store(t.part, to->M[a][yz], layer[yz].M[a + 1]);
  }
}
MPMI_INLINE mpmi_partial kept_layer(int32_t dim, mpmi_taking t, const mpmi_kept_layer *of, int32_t yz) {
  mpmi_partial in = {.v = mpmi_node_load(t.all, of->v[yz])};
  for (int32_t a = 0; a < dim - 1; ++a) {
    if (t.slopes) in.L[a + 1] = mpmi_node_load(t.part, of->L[a][yz]);
    if (t.moment) in.M[a + 1] = mpmi_node_load(t.part, of->M[a][yz]);
  }
  return in;
}

/* Gathers for the cluster that begins with particle p, two along each axis: its layers one after the other,
 * because there are too few registers for the sums of all of its particles. */
MPMI_INLINE void gather_cluster(int32_t dim, int32_t width, int32_t form, const mpmi_weights *W,
                                const double *inverse_spacing, int64_t p, const double *tile,
                                mpmi_gathered *out) {
  const mpmi_taking t = taking_of(dim, form);
  const double *stencil = tile + (int64_t)t.values * W->node[p];
  mpmi_kept_layer kept[MPMI_MAX_WIDTH];
  for (int32_t i = 0; i < width; ++i) {
    mpmi_partial layer[4];
    gather_layer(dim, width, t, 2, W, inverse_spacing, p, stencil + i * layer_stride(dim, width, t), layer);
    keep_layer(dim, t, layer, &kept[i]);
  }
  for (int32_t yz = 0; yz < MPMI_CLUSTER(dim) / 2; ++yz)
    for (int32_t x = 0; x < 2; ++x) {
      const int64_t first = p + MPMI_CLUSTER_END(dim, 0, x);
      mpmi_partial whole;
      MPMI_UNROLL for (int32_t i = 0; i < width; ++i) {
        const mpmi_partial layer = kept_layer(dim, t, &kept[i], yz);
        add_partial(dim, width, t, W, inverse_spacing, 0, i, first, &layer, &whole);
      }
      keep_partial(dim, t, &whole, first + yz, out);
    }
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

/* Gathers for the clusters that a chunk begins with; returns the first particle that is in none. */
MPMI_INLINE int64_t gather_clusters(int32_t dim, int32_t width, int32_t form, const mpmi_gather *job,
                                    int64_t s, const mpmi_weights *W, const double *inverse_spacing,
                                    mpmi_gathered *out) {
  const int64_t ahead = mpmi_ahead(&job->streams, s);
  int64_t p = 0;
  while (p < MPMI_CHUNK && mpmi_is_cluster(dim, &job->points, W, s + p, p)) {
    gather_cluster(dim, width, form, W, inverse_spacing, p, job->tile, out);
    for (const int64_t end = p + MPMI_CLUSTER(dim); p < end; ++p) mpmi_prefetch(&job->streams, ahead, p);
  }
  return p;
}
typedef int64_t (*gather_clusters_fn)(const mpmi_gather *job, int64_t s, const mpmi_weights *W,
                                      const double *inverse_spacing, mpmi_gathered *out);

MPMI_INLINE mpmi_taken gather(int32_t dim, int32_t width, int32_t form, gather_clusters_fn clusters,
                              const mpmi_gather *job, int64_t begin, int64_t count) {
  mpmi_weights W;
  mpmi_gathered out;
  double inverse_spacing[3] = {0.0, 0.0, 0.0};
  for (int32_t k = 0; k < dim; ++k) inverse_spacing[k] = job->axis[k].inverse_spacing;
  mpmi_made made = {mpmi_nothing_moved(), mpmi_nothing_deformed()};
  for (int64_t s = 0; s < count; s += MPMI_CHUNK) {
    const int64_t n = count - s < MPMI_CHUNK ? count - s : MPMI_CHUNK;
    job->weights(job->axis, job->need, &job->points, begin + s, n, &W);
    const int32_t hole = has_hole(job->initial_volume + begin + s, n);
    if (hole) mask_holes(dim, width, form, job->initial_volume + begin + s, n, &W);
    const int64_t first =
        job->axis[0].still && !hole ? clusters(job, begin + s, &W, inverse_spacing, &out) : 0;
    const int64_t ahead = mpmi_ahead(&job->streams, begin + s);
    for (int64_t p = first; p < n; ++p) {
      mpmi_prefetch(&job->streams, ahead, p);
      gather_stencil(dim, width, form, &W, inverse_spacing, p, job->tile, &out);
    }
    for (int64_t q = 0; q < mpmi_whole_chunks(n); q += MPMI_LANES)
      hand_on(dim, width, form, job, q, s + q, &W, &out, &made);
  }
  return (mpmi_taken){mpmi_move_flags(&made.moved), mpmi_deform_flags(&made.deformed)};
}

/* Clusters have a function of their own: within the loop they would take registers from other particles. */
#define GATHER(dim, width, form, name)                                                                       \
  static __attribute__((noinline)) int64_t KERNEL(name##_clusters)(                                          \
      const mpmi_gather *job, int64_t s, const mpmi_weights *W, const double *inverse, mpmi_gathered *out) { \
    return gather_clusters(dim, width, form, job, s, W, inverse, out);                                       \
  }                                                                                                          \
  mpmi_taken KERNEL(name)(const mpmi_gather *job, int64_t begin, int64_t n);                                 \
  mpmi_taken KERNEL(name)(const mpmi_gather *job, int64_t begin, int64_t n) {                                \
    return gather(dim, width, form, KERNEL(name##_clusters), job, begin, n);                                 \
  }
#include "transfer/instances.h"
