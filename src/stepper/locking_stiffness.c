/* What the locking remedy adds to the stiffness. With j' the mean of det F_inc - 1 over a cell, weighted by
 * the old volumes V, and theta = div du of a particle, the law sees L' = L + (theta' - theta) / d I, where
 *
 *   theta' = sum V (1 + j) theta / sum V (1 + j)                          over the cell,
 *
 * and force is divided by a ratio that grows by theta' - theta. With h_ik = c_ikll / d + (2 / d - 1) tau_ik
 * that gives h_ik g_a,k (theta' - theta): the part of theta goes into the tangent of the particle, that of
 * theta' couples all particles of the cell and is one outer product for it. It is not symmetric. */
#include "simd/tensor.h"
#include "stepper/locking.h"
#include "stepper/newton.h"

#include <string.h>

enum { MOST_SPAN = 4, MOST_NODES = MOST_SPAN * MOST_SPAN * MOST_SPAN };
static int32_t nodes_of(const mpm_stepper *s) {
  const int32_t span = mpmi_coupling_span(s);
  return s->grid->dim == 3 ? span * span * span : span * span;
}

/* Of one cell: sum of new volumes, then by node and axis sum h g and sum V (1 + j) g. */
static int64_t cell_values(const mpm_stepper *s) {
  return 1 + 2 * (int64_t)nodes_of(s) * s->grid->dim;
}

mpm_status mpmi_locking_stiffness_begin(mpm_stepper *s) {
  mpmi_newton *w = s->newton;
  const int64_t cells = w->matrix.rows, nodes = nodes_of(s);
  mpm_status status;
  if ((status = mpmi_reserve_roomy(s->context, (void **)&w->cell, &w->cell_capacity, cells * cell_values(s),
                                   sizeof *w->cell)) ||
      (status = mpmi_reserve_roomy(s->context, (void **)&w->cell_node, &w->cell_node_capacity, cells * nodes,
                                   sizeof *w->cell_node)))
    return status;
  memset(w->cell, 0, (size_t)(cells * cell_values(s)) * sizeof *w->cell);
  for (int64_t i = 0; i < cells * nodes; ++i) w->cell_node[i] = -1;
  return MPM_OK;
}

void mpmi_locking_stiffness_local(const mpm_stepper *s, const mpmi_law_batch *law, const double *weight,
                                  const double *volume, double *tangent, double *h) {
  const int32_t dim = s->grid->dim;
  const int64_t ld = law->ld;
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t k = 0; k < dim; ++k) {
      double *to = h + (3 * i + k) * ld;
      for (int64_t p = 0; p < law->batch.n; ++p) {
        /* tau of the dilation that the law sees: volume / weight is its J */
        const double tau =
            weight[p] > 0.0 ? volume[p] / weight[p] * law->stress_new[mpmi_sym_index(i, k) * ld + p] : 0.0;
        to[p] = (2.0 / dim - 1.0) * tau;
        for (int32_t l = 0; l < dim; ++l) to[p] += tangent[(9 * (3 * i + k) + 4 * l) * ld + p] / dim;
      }
    }
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t k = 0; k < dim; ++k)
      for (int32_t l = 0; l < dim; ++l)
        for (int64_t p = 0; p < law->batch.n; ++p)
          tangent[(9 * (3 * i + k) + 4 * l) * ld + p] -= h[(3 * i + k) * ld + p];
}

void mpmi_locking_stiffness_add(mpm_stepper *s, const mpmi_newton_work *work, const mpmi_weights *W,
                                int64_t p, int32_t cell_place, const mpmi_locking_particle *of) {
  mpmi_newton *w = s->newton;
  const mpm_grid *grid = s->grid;
  const int32_t dim = grid->dim, edge = MPMI_TILE_EDGE(dim, grid->width), span = mpmi_coupling_span(s);
  const int32_t corner = work->tile_active[cell_place];
  int32_t base = 0, scale = 1, cell_rest = cell_place, node_rest = W->node[p], in_cell[MPMI_MOST_NODES];
  if (corner < 0) return; /* a lone particle on it: no other is in its cell */
  for (int32_t k = dim - 1; k >= 0; --k) {
    int32_t shift = node_rest % edge - (cell_rest % edge - grid->below);
    if (grid->desc.periodic[k]) { /* cell and stencil may have been placed at different images */
      const int64_t cells = grid->desc.cells[k];
      shift = (int32_t)((shift % cells + cells) % cells);
    }
    base += shift * scale;
    scale *= span;
    node_rest /= edge;
    cell_rest /= edge;
  }
  const int32_t count = mpmi_cube_places(dim, grid->width, span, in_cell);
  const int64_t cell = w->active[corner].row, nodes = nodes_of(s);
  double *sums = w->cell + cell * cell_values(s);
  *sums++ += of->volume;
  for (int32_t a = 0; a < count; ++a) {
    int32_t rest = a, at[3];
    double G[3];
    for (int32_t k = dim - 1; k >= 0; --k) {
      at[k] = rest % grid->width;
      rest /= grid->width;
    }
    for (int32_t k = 0; k < dim; ++k) {
      G[k] = W->g[k][at[k]][p];
      for (int32_t o = 0; o < dim; ++o)
        if (o != k) G[k] *= W->w[o][at[o]][p];
    }
    const int32_t place = base + in_cell[a];
    w->cell_node[cell * nodes + place] = work->tile_active[W->node[p] + w->stencil.in_tile[a]];
    double *to = sums + (int64_t)2 * place * dim;
    for (int32_t i = 0; i < dim; ++i)
      for (int32_t K = 0; K < dim; ++K) {
        to[i] += of->h[3 * i + K] * G[K];
        to[dim + i] += of->volume * of->inverse[3 * K + i] * G[K];
      }
  }
}

/* Entry of two active nodes: by their distance; on a periodic seam they may have been seen from two sides. */
static double *entry_of(mpmi_newton *w, int32_t from, int32_t to, int32_t offset) {
  mpmi_matrix *A = &w->matrix;
  const int64_t values = (int64_t)A->block * A->block;
  const int32_t place = w->place[(int64_t)from * w->offsets + offset];
  if (place >= 0 && A->column[place] == w->active[to].row) return A->value + place * values;
  const int64_t row = w->active[from].row;
  for (int64_t e = A->row_start[row]; e < A->row_start[row + 1]; ++e)
    if (A->column[e] == w->active[to].row) return A->value + e * values;
  return NULL;
}

static void add_cell(mpm_stepper *s, int64_t cell) {
  mpmi_newton *w = s->newton;
  const int32_t dim = s->grid->dim, span = mpmi_coupling_span(s), nodes = nodes_of(s);
  const double *sums = w->cell + cell * cell_values(s), volume = *sums++;
  const int32_t *node = w->cell_node + cell * nodes;
  if (!(volume > 0.0)) return;
  int32_t place[MOST_NODES];
  mpmi_cube_places(dim, span, 2 * span - 1, place);
  for (int32_t a = 0; a < nodes; ++a)
    for (int32_t b = 0; b < nodes && node[a] >= 0; ++b) {
      if (node[b] < 0) continue;
      double *value = entry_of(w, node[a], node[b], w->offsets / 2 + place[b] - place[a]);
      if (!value) continue; /* two nodes of a seam that no stencil joins */
      const double *h = sums + (int64_t)2 * a * dim, *d = sums + (int64_t)2 * b * dim + dim;
      for (int32_t i = 0; i < dim; ++i)
        for (int32_t j = 0; j < dim; ++j)
          value[i * dim + j] +=
              w->active[node[a]].sign[i] * w->active[node[b]].sign[j] * h[i] * d[j] / volume;
    }
}

void mpmi_locking_stiffness_end(mpm_stepper *s) {
  for (int64_t cell = 0; cell < s->newton->matrix.rows; ++cell) add_cell(s, cell);
  s->newton->matrix.symmetric = 0;
}
