/* What the locking remedy adds to the stiffness. With j' the mean of det F_inc - 1 over a cell, weighted by
 * the old volumes V, and theta = div du of a particle, the law sees L' = L + (theta' - theta) / d I, where
 *
 *   theta' = sum V (1 + j) theta / sum V (1 + j)                          over the cell,
 *
 * and force is divided by a ratio that grows by theta' - theta. With h_ik = c_ikll / d + (2 / d - 1) tau_ik
 * that gives h_ik g_a,k (theta' - theta): the part of theta goes into the tangent of the particle, that of
 * theta' couples all particles of the cell and is one outer product for it. It is not symmetric.
 *
 * Where pressures are averaged as well (stages/cell_pressure.c) force is the derivative of the work of tau on
 * L', and no ratio divides it. With h_ik = c_ikll / d + 2 tau_ik / d, k_jl = c_iijl / d + 2 tau_jl / d and q
 * = tr h / d the law gives
 *
 *   h_ik g_a,k (theta' - theta) + (theta'_a - theta_a) (k_jl L_jl + q (theta' - theta)),
 *
 * and what carries theta_a and theta'_a along gives, with the mean stress pi of the cell and V0 pi_tau of the
 * particle, (V0 pi_tau - V pi) tr(L_a L) + V pi theta_a theta and for the cell - sum V pi theta'_a theta'. Of
 * the cell there are two outer products, and it is as symmetric as c. */
#include "implicit/balance.h"
#include "simd/tensor.h"
#include "stages/stages.h"

#include <string.h>

enum { MOST_SPAN = 4, MOST_NODES = MOST_SPAN * MOST_SPAN * MOST_SPAN };
static int32_t nodes_of(const mpmi_balance *balance) {
  const int32_t span = mpmi_coupling_span(balance->settings);
  return balance->settings->grid->dim == 3 ? span * span * span : span * span;
}

/* Returns how many values a cell has for its particles with their own pressure: the sum of new volumes, then
 * by node and axis sum h g and sum V (1 + j) g. The latter and the volumes are those of all particles. */
static int64_t own_values(const mpmi_balance *balance) {
  return 1 + 2 * (int64_t)nodes_of(balance) * balance->settings->grid->dim;
}

/* Returns how many values it has in all: then come, of those whose pressure is averaged, the sum of new
 * volumes, sum V0 (q - pi_tau), and by node and axis sum h g, sum V (1 + j) g and sum k g. */
static int64_t cell_values(const mpmi_balance *balance) {
  const int64_t paired = 2 + 3 * (int64_t)nodes_of(balance) * balance->settings->grid->dim;
  return own_values(balance) + (mpmi_has_nodal_stress(balance->settings, balance->layout) ? paired : 0);
}

mpm_status mpmi_locking_stiffness_begin(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  const int64_t cells = newton->matrix.rows, nodes = nodes_of(balance);
  mpm_status status;
  /* one number more, so that the array exists without cells */
  if ((status = MPMI_RESERVE_MORE(balance->settings->context, newton->cell, newton->cell_capacity,
                                  cells * cell_values(balance) + 1)) ||
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

/* The local part of one particle: c is its tangent. */
static void add_paired(int32_t dim, const mpmi_paired_local *of, int64_t p) {
  const int64_t ld = of->ld;
  double h[3][3], k[3][3], tau[3][3], q = 0.0, mean = 0.0, pi = 0.0;
  const int32_t there = of->initial_volume[p] > 0.0;
  const double J = there ? of->volume[p] / of->initial_volume[p] : 0.0;
#define C_(i, j, k, l) of->tangent[(9 * (3 * (i) + (j)) + 3 * (k) + (l)) * ld + p]
  for (int32_t c = 0; c < 6; ++c) of->stress[c * ld + p] *= of->ratio[p];
  for (int32_t i = 0; i < dim; ++i) {
    for (int32_t j = 0; j < dim; ++j) tau[i][j] = J * of->stress[mpmi_sym_index(i, j) * ld + p];
    mean += tau[i][i] / dim;
    pi += J * of->nodal_stress[i * of->nodal_ld + p] / dim;
  }
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t j = 0; j < dim; ++j) {
      h[i][j] = k[i][j] = 2.0 / dim * tau[i][j];
      for (int32_t l = 0; l < dim; ++l) h[i][j] += C_(i, j, l, l) / dim, k[i][j] += C_(l, l, i, j) / dim;
    }
  for (int32_t i = 0; i < dim; ++i) q += h[i][i] / dim;
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t j = 0; j < dim; ++j) {
      for (int32_t l = 0; l < dim; ++l) C_(i, j, l, l) -= h[i][j], C_(l, l, i, j) -= k[i][j];
      C_(i, i, j, j) += q + pi;
      C_(i, j, j, i) += mean - pi;
      of->h[(3 * i + j) * ld + p] = h[i][j] - (i == j ? q : 0.0);
      of->k[(3 * i + j) * ld + p] = k[i][j] - (i == j ? q : 0.0);
    }
  of->q[p] = q - mean;
#undef C_
}

void mpmi_paired_stiffness_local(int32_t dim, const mpmi_paired_local *of) {
  for (int64_t p = 0; p < of->n; ++p) add_paired(dim, of, p);
}

/* What a cell sums up for one of its nodes, by axis: of particles with their own pressure h g and
 * V (1 + j) g; of paired ones, beside those, k g. */
typedef struct node_sums {
  double *own, *paired; /* paired: NULL for a particle that is not */
} node_sums;

/* Adds what the gradient g of a node, which its component i makes, has to do with an entry of h and k, and
 * with one of the inverse. */
static void add_gradient(const mpmi_locking_particle *of, int32_t dim, const node_sums *to, int32_t i,
                         int32_t entry, int32_t inverse, double g) {
  const double dilation = of->volume * of->inverse[inverse] * g;
  to->own[dim + i] += dilation;
  if (!to->paired) {
    to->own[i] += of->h[entry] * g;
    return;
  }
  to->paired[i] += of->h[entry] * g;
  to->paired[dim + i] += dilation;
  to->paired[2 * dim + i] += of->k[entry] * g;
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
  double *sums = newton->cell + cell * cell_values(balance), *paired = sums + own_values(balance);
  *sums++ += of->volume;
  if (of->paired) *paired++ += of->volume, *paired++ += of->q;
  for (int32_t a = 0; a < count; ++a) {
    int32_t rest = a, at[3];
    double G[3], w = 1.0;
    for (int32_t k = dim - 1; k >= 0; --k) {
      at[k] = rest % grid->width;
      rest /= grid->width;
    }
    for (int32_t k = 0; k < dim; ++k) {
      G[k] = W->g[k][at[k]][p];
      for (int32_t o = 0; o < dim; ++o)
        if (o != k) G[k] *= W->w[o][at[o]][p];
      w *= W->w[k][at[k]][p];
    }
    const int32_t place = base + in_cell[a];
    newton->cell_node[cell * nodes + place] = work->tile_active[W->node[p] + newton->stencil.in_tile[a]];
    const node_sums to = {sums + (int64_t)2 * place * dim,
                          of->paired ? paired + (int64_t)3 * place * dim : NULL};
    for (int32_t i = 0; i < dim; ++i)
      for (int32_t K = 0; K < dim; ++K) add_gradient(of, dim, &to, i, 3 * i + K, 3 * K + i, G[K]);
    /* the hoop of a ring is stretched by u_r alone */
    if (mpmi_is_axisymmetric(grid)) add_gradient(of, dim, &to, 0, 8, 8, of->hoop * w);
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

/* The block that couples two nodes of a cell by its particles with their own pressure. */
static void find_own_block(const double *sums, int32_t dim, int32_t a, int32_t b, double block[3][3]) {
  const double volume = *sums++, *h = sums + (int64_t)2 * a * dim, *d = sums + (int64_t)2 * b * dim + dim;
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t j = 0; j < dim; ++j) block[i][j] = volume > 0.0 ? h[i] * d[j] / volume : 0.0;
}

/* Adds what those do whose pressure is averaged. */
static void add_paired_block(const double *sums, int32_t dim, int32_t a, int32_t b, double block[3][3]) {
  const double volume = sums[0], q = sums[1] / volume;
  if (!(volume > 0.0)) return;
  const double *A = sums + 2 + (int64_t)3 * a * dim, *B = sums + 2 + (int64_t)3 * b * dim;
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t j = 0; j < dim; ++j)
      block[i][j] += (A[i] * B[dim + j] + A[dim + i] * (B[2 * dim + j] + q * B[dim + j])) / volume;
}

static void add_cell(mpmi_balance *balance, int64_t cell) {
  mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim, span = mpmi_coupling_span(balance->settings),
                nodes = nodes_of(balance), paired = mpmi_has_nodal_stress(balance->settings, balance->layout);
  const double *sums = newton->cell + cell * cell_values(balance);
  const int32_t *node = newton->cell_node + cell * nodes;
  if (!(sums[0] > 0.0)) return;
  int32_t place[MOST_NODES];
  mpmi_cube_places(dim, span, 2 * span - 1, place);
  for (int32_t a = 0; a < nodes; ++a)
    for (int32_t b = 0; b < nodes && node[a] >= 0; ++b) {
      if (node[b] < 0) continue;
      double *value = entry_of(newton, node[a], node[b], newton->offsets / 2 + place[b] - place[a]);
      if (!value) continue; /* two nodes of a seam that no stencil joins */
      double block[3][3];
      find_own_block(sums, dim, a, b, block);
      if (paired) add_paired_block(sums + own_values(balance), dim, a, b, block);
      for (int32_t i = 0; i < dim; ++i)
        for (int32_t j = 0; j < dim; ++j)
          value[i * dim + j] +=
              newton->active[node[a]].sign[i] * newton->active[node[b]].sign[j] * block[i][j];
    }
}

/* Tells whether some set that deforms has its own pressure in the forces. */
static int32_t any_own_pressure(const mpmi_settings *settings, const mpmi_layout *layout) {
  for (int32_t m = 0; m < layout->member_count; ++m)
    if (!mpmi_averages_pressure(settings, layout->member[m].set) &&
        mpmi_material_kinematics(layout->member[m].set->material) != MPMI_F_STAYS)
      return 1;
  return 0;
}

void mpmi_locking_stiffness_end(mpmi_balance *balance) {
  for (int64_t cell = 0; cell < balance->newton->matrix.rows; ++cell) add_cell(balance, cell);
  if (any_own_pressure(balance->settings, balance->layout)) balance->newton->matrix.symmetric = 0;
}
