/* Implicit steps: internal forces and stiffness of particles on the nodes of their stencils (Guilkey & Weiss
 * 2003, section 3). Gradients G are those at the start of the step; g = F_inc^-T G are pushed forward.
 *
 *   f_a  = sum V sigma g_a                                   = sum (V sigma F_inc^-T) G_a
 *   K_ab = sum V0 g_a,k (c_ikjl + delta_ij tau_kl) g_b,l     = sum G_a,K A_iKjL G_b,L
 *
 * The push-forward goes into what the gradients are multiplied by, so that the loops over nodes see G alone.
 *
 * Rings have one gradient more: the displacement u_r of a node stretches the hoop by w_a u_r / r, so that G_a
 * of the radial component has the entry w_a / r in place (theta, theta), and nothing else has one there. */
#include "simd/tensor.h"
#include "transfer/stiffness.h"

/* Computes F_inc^-1 of particle p, component 3 * k + i. */
MPMI_INLINE void invert(int32_t dim, const double *F, int64_t ld, int64_t p, double *out) {
#define F_(r, c) F[(3 * (r) + (c)) * ld + p]
  if (dim == 1) {
    out[0] = 1.0 / F_(0, 0);
    return;
  }
  if (dim == 2) {
    const double by = 1.0 / (F_(0, 0) * F_(1, 1) - F_(0, 1) * F_(1, 0));
    out[0] = F_(1, 1) * by, out[1] = -F_(0, 1) * by, out[3] = -F_(1, 0) * by, out[4] = F_(0, 0) * by;
    return;
  }
  const double a = F_(1, 1) * F_(2, 2) - F_(1, 2) * F_(2, 1), b = F_(1, 2) * F_(2, 0) - F_(1, 0) * F_(2, 2);
  const double c = F_(1, 0) * F_(2, 1) - F_(1, 1) * F_(2, 0);
  const double by = 1.0 / (F_(0, 0) * a + F_(0, 1) * b + F_(0, 2) * c);
  out[0] = a * by, out[3] = b * by, out[6] = c * by;
  out[1] = (F_(0, 2) * F_(2, 1) - F_(0, 1) * F_(2, 2)) * by;
  out[4] = (F_(0, 0) * F_(2, 2) - F_(0, 2) * F_(2, 0)) * by;
  out[7] = (F_(0, 1) * F_(2, 0) - F_(0, 0) * F_(2, 1)) * by;
  out[2] = (F_(0, 1) * F_(1, 2) - F_(0, 2) * F_(1, 1)) * by;
  out[5] = (F_(0, 2) * F_(1, 0) - F_(0, 0) * F_(1, 2)) * by;
  out[8] = (F_(0, 0) * F_(1, 1) - F_(0, 1) * F_(1, 0)) * by;
#undef F_
}

/* A = inverse . (weight c + V delta sigma) . inverse^T in the second and fourth index. */
MPMI_INLINE void push_stiffness(int32_t dim, const mpmi_push *job, const double (*inverse)[MPMI_CHUNK],
                                int64_t s) {
  const int64_t ld = job->ld;
  double half[3][3][MPMI_CHUNK];
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t j = 0; j < dim; ++j) {
      /* half_kL = sum_l a_ikjl inverse_Ll */
      for (int32_t k = 0; k < dim; ++k)
        for (int32_t L = 0; L < dim; ++L) MPMI_IVDEP for (int64_t p = 0; p < MPMI_CHUNK; ++p) {
            double sum = 0.0;
            for (int32_t l = 0; l < dim; ++l) {
              double a = job->weight[s + p] * job->tangent[(9 * (3 * i + k) + 3 * j + l) * ld + s + p];
              if (i == j) a += job->volume[s + p] * job->stress[mpmi_sym_index(k, l) * ld + s + p];
              sum += a * inverse[3 * L + l][p];
            }
            half[k][L][p] = sum;
          }
      for (int32_t K = 0; K < dim; ++K)
        for (int32_t L = 0; L < dim; ++L) {
          double *A = job->stiffness + (9 * (3 * i + K) + 3 * j + L) * ld + s;
          MPMI_IVDEP for (int64_t p = 0; p < MPMI_CHUNK; ++p) {
            double sum = 0.0;
            for (int32_t k = 0; k < dim; ++k) sum += inverse[3 * K + k][p] * half[k][L][p];
            A[p] = sum;
          }
        }
    }
}

MPMI_INLINE void push(int32_t dim, const mpmi_push *job, int64_t n) {
  const int64_t ld = job->ld;
  double inverse[9][MPMI_CHUNK];
  for (int64_t s = 0; s < mpmi_whole_chunks(n); s += MPMI_CHUNK) {
    MPMI_IVDEP for (int64_t p = 0; p < MPMI_CHUNK; ++p) {
      double one[9];
      invert(dim, job->F_inc, ld, s + p, one);
      for (int32_t e = 0; e < 9; ++e)
        if (e / 3 < dim && e % 3 < dim) inverse[e][p] = job->inverse[e * ld + s + p] = one[e];
    }
    for (int32_t i = 0; i < dim; ++i)
      for (int32_t K = 0; K < dim; ++K) {
        double *P = job->nominal + (3 * i + K) * ld + s;
        MPMI_IVDEP for (int64_t p = 0; p < MPMI_CHUNK; ++p) {
          double sum = 0.0;
          for (int32_t k = 0; k < dim; ++k)
            sum += job->stress[mpmi_sym_index(i, k) * ld + s + p] * inverse[3 * K + k][p];
          P[p] = job->volume[s + p] * sum;
        }
      }
    if (job->tangent) push_stiffness(dim, job, (const double(*)[MPMI_CHUNK])inverse, s);
  }
}

/* Weight and gradient of the node (i, j, k) of particle p's stencil; axes that the grid does not have give
 * nothing. */
MPMI_INLINE double node_weight(int32_t dim, const mpmi_weights *W, int64_t p, const int32_t *at,
                               double *gradient) {
  double w = 1.0;
  for (int32_t a = 0; a < dim; ++a) w *= W->w[a][at[a]][p];
  for (int32_t k = 0; k < dim; ++k) {
    double g = W->g[k][at[k]][p];
    for (int32_t a = 0; a < dim; ++a)
      if (a != k) g *= W->w[a][at[a]][p];
    gradient[k] = g;
  }
  return w;
}

/* Place of node a of a stencil along each axis, the last one fastest. */
MPMI_INLINE void node_place(int32_t dim, int32_t width, int32_t a, int32_t *at) {
  for (int32_t k = dim - 1; k >= 0; --k) {
    at[k] = a % width;
    a /= width;
  }
}

MPMI_INLINE int32_t stencil_count(int32_t dim, int32_t width) {
  return dim > 2 ? width * width * width : dim > 1 ? width * width : width;
}

MPMI_INLINE void scatter_particle(int32_t dim, int32_t width, const mpmi_force_scatter *job,
                                  const mpmi_weights *W, int64_t p, int64_t slot, int64_t q) {
  const int32_t edge = MPMI_TILE_EDGE(dim, width);
  double P[3][3] = {{0.0}}, f[3] = {0.0, 0.0, 0.0};
  for (int32_t i = 0; i < dim; ++i) {
    for (int32_t K = 0; K < dim && job->nominal; ++K) P[i][K] = job->nominal[(3 * i + K) * job->ld + q];
    if (!job->nominal) f[i] = job->mass[slot] * job->gravity[i] + (job->force[i] ? job->force[i][slot] : 0.0);
  }
  const double volume = job->nominal || !job->deforms ? 0.0 : job->initial_volume[slot];
  const double radius = dim == 2 && job->hoop && job->nominal ? job->points.x[0][slot] : 0.0;
  const double hoop = radius > 0.0 ? job->nominal[8 * job->ld + q] / radius : 0.0;
  for (int32_t a = 0; a < stencil_count(dim, width); ++a) {
    int32_t at[3], place = 0;
    double G[3], norm = 0.0;
    node_place(dim, width, a, at);
    const double w = node_weight(dim, W, p, at, G);
    for (int32_t k = 0; k < dim; ++k) {
      place = place * edge + at[k];
      norm += G[k] * G[k];
    }
    double *node = job->tile + 4 * (int64_t)(W->node[p] + place);
    for (int32_t i = 0; i < dim; ++i) {
      double sum = w * f[i];
      for (int32_t K = 0; K < dim; ++K) sum += P[i][K] * G[K];
      node[i] += sum;
    }
    if (dim == 2 && job->hoop) node[0] += w * hoop;
    node[3] += volume * norm;
  }
}

MPMI_INLINE void force_scatter(int32_t dim, int32_t width, const mpmi_force_scatter *job, int64_t begin,
                               int64_t count) {
  mpmi_weights W;
  for (int64_t s = 0; s < count; s += MPMI_CHUNK) {
    const int64_t n = count - s < MPMI_CHUNK ? count - s : MPMI_CHUNK;
    job->weights(job->axis, MPMI_NEED_GRADIENT, &job->points, begin + s, n, &W);
    for (int64_t p = 0; p < n; ++p)
      if (job->initial_volume[begin + s + p] > 0.0)
        scatter_particle(dim, width, job, &W, p, begin + s + p, s + p);
  }
}

#define MOST_STENCIL_NODES MPMI_STENCIL_NODES(3, MPMI_MAX_WIDTH)

/* Adds what the hoop of a ring of radius 1 / `by` has to do with the plane and with itself: the entries
 * (theta, theta) of A G, and of G^T A beside the plane. */
MPMI_INLINE void hoop_stiffness(int32_t nodes, int32_t count, const double *w,
                                double (*G)[MOST_STENCIL_NODES], double by, const double *A, int64_t ld,
                                double *K) {
  for (int32_t j = 0; j < 2; ++j) {
    double B[MOST_STENCIL_NODES],
        other[MOST_STENCIL_NODES]; /* (theta, theta) by node b; node b's component j by (theta, theta) */
    for (int32_t b = 0; b < nodes; ++b) {
      B[b] = A[(72 + 3 * j) * ld] * G[0][b] + A[(72 + 3 * j + 1) * ld] * G[1][b];
      other[b] = A[(27 * j + 8) * ld] * G[0][b] + A[(27 * j + 9 + 8) * ld] * G[1][b];
      if (j == 0) B[b] += A[80 * ld] * by * w[b];
    }
    for (int32_t a = 0; a < count; ++a)
      for (int32_t b = 0; b < count; ++b) {
        K[(int64_t)a * 2 * nodes + j * nodes + b] += by * w[a] * B[b];
        K[(int64_t)(j * nodes + a) * 2 * nodes + b] += by * w[b] * other[a];
      }
  }
}

/* K += G^T A G, rows and columns by component and node: first A G, then one outer product per component. */
MPMI_INLINE void stiffness(int32_t dim, int32_t width, const mpmi_weights *W, int64_t p,
                           const double *stiffness, int64_t ld, double hoop, double *K) {
  const int32_t count = stencil_count(dim, width), nodes = MPMI_STENCIL_NODES(dim, width), row = dim * nodes;
  double G[3][MOST_STENCIL_NODES], AG[3][3 * MOST_STENCIL_NODES], w[MOST_STENCIL_NODES];
  for (int32_t a = count; a < nodes; ++a)
    for (int32_t k = 0; k < dim; ++k) G[k][a] = 0.0;
  for (int32_t a = 0; a < count; ++a) {
    int32_t at[3];
    double gradient[3];
    node_place(dim, width, a, at);
    w[a] = node_weight(dim, W, p, at, gradient);
    for (int32_t k = 0; k < dim; ++k) G[k][a] = gradient[k];
  }
  for (int32_t i = 0; i < dim; ++i) {
    for (int32_t k = 0; k < dim; ++k)
      for (int32_t j = 0; j < dim; ++j) {
        double A[3];
        for (int32_t l = 0; l < dim; ++l) A[l] = stiffness[(9 * (3 * i + k) + 3 * j + l) * ld];
        double *to = AG[k] + j * nodes;
        MPMI_IVDEP for (int32_t b = 0; b < nodes; ++b) {
          double sum = A[0] * G[0][b];
          for (int32_t l = 1; l < dim; ++l) sum += A[l] * G[l][b];
          to[b] = sum;
        }
      }
    for (int32_t a = 0; a < count; ++a) {
      double *to = K + (int64_t)(i * nodes + a) * row, g[3];
      for (int32_t k = 0; k < dim; ++k) g[k] = G[k][a];
      MPMI_IVDEP for (int32_t c = 0; c < row; ++c) {
        double sum = to[c];
        for (int32_t k = 0; k < dim; ++k) sum += g[k] * AG[k][c];
        to[c] = sum;
      }
    }
  }
  if (dim == 2 && hoop > 0.0) hoop_stiffness(nodes, count, w, G, hoop, stiffness, ld, K);
}

#define FORCE_SCATTER(dim, width)                                                                            \
  void KERNEL(force_scatter_##dim##_##width)(const mpmi_force_scatter *job, int64_t begin, int64_t n);       \
  void KERNEL(force_scatter_##dim##_##width)(const mpmi_force_scatter *job, int64_t begin, int64_t n) {      \
    force_scatter(dim, width, job, begin, n);                                                                \
  }
#define STIFFNESS(dim)                                                                                       \
  void KERNEL(push_##dim)(const mpmi_push *job, int64_t n);                                                  \
  void KERNEL(push_##dim)(const mpmi_push *job, int64_t n) {                                                 \
    push(dim, job, n);                                                                                       \
  }                                                                                                          \
  FORCE_SCATTER(dim, 2)                                                                                      \
  FORCE_SCATTER(dim, 3)                                                                                      \
  FORCE_SCATTER(dim, 4)                                                                                      \
  void KERNEL(stiffness_##dim)(int32_t width, const mpmi_weights *W, int64_t p, const double *A, int64_t ld, \
                               double hoop, double *K);                                                      \
  void KERNEL(stiffness_##dim)(int32_t width, const mpmi_weights *W, int64_t p, const double *A, int64_t ld, \
                               double hoop, double *K) {                                                     \
    if (width == 2)                                                                                          \
      stiffness(dim, 2, W, p, A, ld, hoop, K);                                                               \
    else if (width == 3)                                                                                     \
      stiffness(dim, 3, W, p, A, ld, hoop, K);                                                               \
    else                                                                                                     \
      stiffness(dim, 4, W, p, A, ld, hoop, K);                                                               \
  }
STIFFNESS(1)
STIFFNESS(2)
STIFFNESS(3)
