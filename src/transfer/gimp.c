/* GIMP (Steffen et al. 2008 eqs 26-29): the linear basis averaged over the particle's domain of edge l, which
 * is at most a cell. Seen from the nearest node, the domain [f - l/2, f + l/2] reaches into the two cells
 * beside it; the weight of a neighbour is the mean of the part of it on that neighbour's side, and what both
 * leave is the weight of the node. Written so that l -> 0 loses no digits. */
#include "transfer/basis.h"

/* Domains are kept this far from 0, where the gradient has no value at the nodes. */
#define SMALLEST_DOMAIN 1e-9

/* Edges of the domains in cells: size |F_kk| / h, within (0, 1]. */
MPMI_INLINE void domain_edges(const mpmi_axis *a, int64_t n, const mpmi_chunk *at, double *edge) {
  if (!at->size) {
    for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) edge[p] = a->domain;
  } else if (!at->stretch) {
    MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) edge[p] = at->size[p] * a->inverse_spacing;
  } else {
    MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
      double stretch = at->stretch[p] < 0.0 ? -at->stretch[p] : at->stretch[p];
      edge[p] = at->size[p] * a->inverse_spacing * stretch;
    }
  }
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    double l = edge[p] < 1.0 ? edge[p] : 1.0;
    edge[p] = l > SMALLEST_DOMAIN ? l : SMALLEST_DOMAIN;
  }
}

MPMI_INLINE void gimp_axis(const mpmi_axis *a, int64_t n, const mpmi_chunk *at, int32_t gradient,
                           const mpmi_stencils *out) {
  _Alignas(64) double edge[MPMI_CHUNK];
  const double inverse = a->inverse_spacing, corner = a->tile_base + 1.0;
  double(*w)[MPMI_CHUNK] = out->w, (*g)[MPMI_CHUNK] = out->g;
  domain_edges(a, n, at, edge);
  MPMI_IVDEP for (int64_t p = 0; p < mpmi_whole_chunks(n); ++p) {
    double xi = (at->x[p] - a->origin) * inverse;
    double node = mpmi_round(xi), f = xi - node, l = edge[p];
    double upper = 0.5 * l + f, lower = 0.5 * l - f; /* how far the domain reaches beyond the node */
    double below = lower * lower * (0.5 / l), above = upper * upper * (0.5 / l);
    above = lower <= MPMI_LEAST_REACH ? f : above;
    above = upper <= MPMI_LEAST_REACH ? 0.0 : above;
    below = upper <= MPMI_LEAST_REACH ? -f : below;
    below = lower <= MPMI_LEAST_REACH ? 0.0 : below;
    w[0][p] = below;
    w[1][p] = 1.0 - (below + above);
    w[2][p] = above;
    if (gradient) {
      double share = upper * (1.0 / l); /* of the domain above the node */
      share = upper <= MPMI_LEAST_REACH ? 0.0 : share;
      share = lower <= MPMI_LEAST_REACH ? 1.0 : share;
      g[0][p] = (share - 1.0) * inverse;
      g[1][p] = (1.0 - 2.0 * share) * inverse;
      g[2][p] = share * inverse;
    }
    out->first[p] = -1.0 - f;
    out->place[p] = node - corner;
  }
  mpmi_into_tile(a, n, out->place);
}

MPMI_BASIS(gimp, 3, EVEN)
