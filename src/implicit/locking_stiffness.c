/* What the locking remedy adds to the stiffness. With j' the mean of det F_inc - 1 over a cell, weighted by
 * the old volumes V, and theta = div du of a particle, the law sees L' = L + (theta' - theta) / d I, where
 *
 *   theta' = sum V (1 + j) theta / sum V (1 + j)                          over the cell,
 *
 * and force is divided by a ratio that grows by theta' - theta. With h_ik = c_ikll / d + (2 / d - 1) tau_ik
 * that gives h_ik g_a,k (theta' - theta): the part of theta goes into the tangent of the particle, that of
 * theta' couples all particles of the cell and is one outer product for it. It is not symmetric. */
#include "implicit/balance.h"
#include "simd/tensor.h"

#include <string.h>

enum { MOST_SPAN = 4, MOST_NODES = MOST_SPAN * MOST_SPAN * MOST_SPAN };
static int32_t nodes_of(const mpmi_balance *balance) {
  const int32_t span = mpmi_coupling_span(balance->settings);
  return balance->settings->grid->dim == 3 ? span * span * span : span * span;
}

/* Returns how many values a cell has: the sum of new volumes, then by node and axis sum h g and sum V (1 + j)
 * g. */
static int64_t cell_values(const mpmi_balance *balance) {
  return 1 + 2 * (int64_t)nodes_of(balance) * balance->settings->grid->dim;
}

mpm_status mpmi_locking_stiffness_begin(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  const int64_t cells = newton->matrix.rows, nodes = nodes_of(balance);
  mpm_status status;
  if ((status = MPMI_RESERVE_MORE(balance->settings->context, newton->cell, newton->cell_capacity,
                                  cells * cell_values(balance))) ||
      (status = MPMI_RESERVE_MORE(balance->settings->context, newton->cell_node, newton->cell_node_capacity,
                                  cells * nodes)))
    return status;
  memset(newton->cell, 0, (size_t)(cells * cell_values(balance)) * sizeof *newton->cell);
  for (int64_t i = 0; i < cells * nodes; ++i) newton->cell_node[i] = -1;
  return MPM_OK;
}

void mpmi_locking_stiffness_local(int32_t dim, const mpmi_law_batch *law, const double *weight,
                                  const double *volume, double *tangent, double *h) {
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

void mpmi_locking_stiffness_add(mpmi_balance *balance, const mpmi_newton_work *work, const mpmi_weights *W,
                                int64_t p, int32_t cell_place, const mpmi_locking_particle *of) {
  mpmi_newton *newton = balance->newton;
  const mpm_grid *grid = balance->settings->grid;
  const int32_t dim = grid->dim, edge = MPMI_TILE_EDGE(dim, grid->width),
                span = mpmi_coupling_span(balance->settings);
  const int32_t corner = work->tile_active[cell_place];
  int32_t base = 0, scale = 1, cell_rest = cell_place, node_rest = W->node[p], in_cell[MPMI_MOST_NODES];
  if (corner < 0) return; /* the corner node is not active: the particle lies on it, alone in its cell */
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
  const int64_t cell = newton->active[corner].row, nodes = nodes_of(balance);
  double *sums = newton->cell + cell * cell_values(balance);
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
    newton->cell_node[cell * nodes + place] = work->tile_active[W->node[p] + newton->stencil.in_tile[a]];
    double *to = sums + (int64_t)2 * place * dim;
    for (int32_t i = 0; i < dim; ++i)
      for (int32_t K = 0; K < dim; ++K) {
        to[i] += of->h[3 * i + K] * G[K];
        to[dim + i] += of->volume * of->inverse[3 * K + i] * G[K];
      }
  }
}

/* Finds the entry of two active nodes by their offset, or by search where a seam makes that ambiguous. */
static double *entry_of(mpmi_newton *newton, int32_t from, int32_t to, int32_t offset) {
  mpmi_matrix *A = &newton->matrix;
  const int64_t values = (int64_t)A->block * A->block;
  const int32_t place = newton->place[(int64_t)from * newton->offsets + offset];
  if (place >= 0 && A->column[place] == newton->active[to].row) return A->value + place * values;
  const int64_t row = newton->active[from].row;
  for (int64_t e = A->row_start[row]; e < A->row_start[row + 1]; ++e)
    if (A->column[e] == newton->active[to].row) return A->value + e * values;
  return NULL;
}

static void add_cell(mpmi_balance *balance, int64_t cell) {
  mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim, span = mpmi_coupling_span(balance->settings),
                nodes = nodes_of(balance);
  const double *sums = newton->cell + cell * cell_values(balance), volume = *sums++;
  const int32_t *node = newton->cell_node + cell * nodes;
  if (!(volume > 0.0)) return;
  int32_t place[MOST_NODES];
  mpmi_cube_places(dim, span, 2 * span - 1, place);
  for (int32_t a = 0; a < nodes; ++a)
    for (int32_t b = 0; b < nodes && node[a] >= 0; ++b) {
      if (node[b] < 0) continue;
      double *value = entry_of(newton, node[a], node[b], newton->offsets / 2 + place[b] - place[a]);
      if (!value) continue; /* two nodes of a seam that no stencil joins */
      const double *h = sums + (int64_t)2 * a * dim, *d = sums + (int64_t)2 * b * dim + dim;
      for (int32_t i = 0; i < dim; ++i)
        for (int32_t j = 0; j < dim; ++j)
          value[i * dim + j] +=
              newton->active[node[a]].sign[i] * newton->active[node[b]].sign[j] * h[i] * d[j] / volume;
    }
}

void mpmi_locking_stiffness_end(mpmi_balance *balance) {
  for (int64_t cell = 0; cell < balance->newton->matrix.rows; ++cell) add_cell(balance, cell);
  balance->newton->matrix.symmetric = 0;
}
