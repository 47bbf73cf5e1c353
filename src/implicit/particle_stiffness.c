/* What one batch of particles adds to forces and stiffness of the nodes: its law has run, its nominal stress
 * and its tangent are pushed forward (transfer/stiffness.c) and spread over the nodes of their stencils. */
#include "implicit/balance.h"
#include "layout/tile.h"
#include "stages/stages.h"

#include <string.h>

mpmi_force_scatter mpmi_force_scatter_of(const mpmi_balance *balance, int32_t m, double *tile) {
  const mpmi_settings *settings = balance->settings;
  const mpm_particles *set = balance->layout->member[m].set;
  const double *force = balance->step->work->rows.of[m].force;
  const mpm_grid *grid = settings->grid;
  mpmi_force_scatter job = {.weights = settings->kernels->weights[grid->family][grid->dim],
                            .points = mpmi_points_of(set, 0),
                            .mass = mpmi_f64(set, MPMI_MASS, 0),
                            .initial_volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0),
                            .hoop = mpmi_is_axisymmetric(grid),
                            .deforms = mpmi_material_kinematics(set->material) != MPMI_F_STAYS,
                            .tile = tile};
  for (int32_t k = 0; k < grid->dim; ++k) {
    job.gravity[k] = settings->desc.gravity[k];
    job.force[k] = force ? force + k * set->ld : NULL;
  }
  return job;
}

void mpmi_tile_of_unknowns(const mpmi_balance *balance, int64_t block, int32_t *to) {
  const mpm_grid *grid = balance->settings->grid;
  const int32_t edge = MPMI_TILE_EDGE(grid->dim, grid->width), low = MPMI_RING + grid->below;
  const int32_t count = mpmi_tile_nodes(grid);
  for (int32_t i = 0; i < count; ++i) {
    int32_t rest = i, at[3];
    for (int32_t k = grid->dim - 1; k >= 0; --k) {
      at[k] = rest % edge - low;
      rest /= edge;
    }
    const int64_t slot = mpmi_blocks_near(&balance->layout->blocks, block, at);
    to[i] = slot < 0 ? -1 : balance->newton->active_of[slot];
  }
}

MPMI_INLINE void add_block(int32_t dim, int32_t nodes, const double *K, const mpmi_active_node *A,
                           const mpmi_active_node *B, double *value) {
  const int32_t plain = A->plain && B->plain;
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t j = 0; j < dim; ++j) {
      const double entry = K[(i * dim * nodes + j) * nodes];
      value[i * dim + j] += plain ? entry : A->sign[i] * B->sign[j] * entry;
    }
}

MPMI_INLINE void add_stencil_in(int32_t dim, mpmi_newton *newton, const mpmi_newton_work *work, int32_t nodes,
                                int32_t first) {
  const mpmi_stencil *stencil = &newton->stencil;
  int32_t active[MPMI_MOST_NODES];
  for (int32_t a = 0; a < stencil->count; ++a) active[a] = work->tile_active[first + stencil->in_tile[a]];
  for (int32_t a = 0; a < stencil->count; ++a) {
    if (active[a] < 0 || !mpmi_is_kept(newton, newton->active[active[a]].row)) continue;
    const int32_t *place =
        newton->place + (int64_t)active[a] * newton->offsets + newton->offsets / 2 - stencil->offset[a];
    for (int32_t b = 0; b < stencil->count; ++b)
      if (active[b] >= 0)
        add_block(dim, nodes, work->K + (int64_t)a * dim * nodes + b, &newton->active[active[a]],
                  &newton->active[active[b]],
                  newton->matrix.value + (int64_t)place[stencil->offset[b]] * dim * dim);
  }
}

/* Adds the dense stiffness of the stencil whose first node lies at `first` of the tile, and clears it. */
static void add_stencil(mpmi_balance *balance, mpmi_newton_work *work, int32_t first) {
  const int32_t dim = balance->settings->grid->dim,
                nodes = MPMI_STENCIL_NODES(dim, balance->settings->grid->width), row = dim * nodes;
  if (dim == 3)
    add_stencil_in(3, balance->newton, work, nodes, first);
  else if (dim == 2)
    add_stencil_in(2, balance->newton, work, nodes, first);
  else
    add_stencil_in(1, balance->newton, work, nodes, first);
  memset(work->K, 0, (size_t)(row * row) * sizeof *work->K);
}

/* Returns 1 / r of a ring, and 0 in a plane. */
static double hoop_of(const mpm_grid *grid, const mpmi_points *points, int64_t slot) {
  const double radius = points->x[0][slot];
  return mpmi_is_axisymmetric(grid) && radius > 0.0 ? 1.0 / radius : 0.0;
}

mpmi_locking_particle mpmi_locking_particle_of(const mpmi_balance *balance, const mpmi_newton_work *work,
                                               const mpmi_batch *b, int64_t q) {
  const mpm_particles *set = b->set;
  const mpmi_points points = mpmi_points_of(set, 0);
  const int32_t dim = mpmi_strain_dim(set->grid), paired = mpmi_averages_pressure(balance->settings, set);
  const int64_t ld = b->law.ld, slot = b->begin + q;
  mpmi_locking_particle of = {.volume = mpmi_f64(set, MPMI_VOLUME, 0)[slot],
                              .hoop = hoop_of(set->grid, &points, slot),
                              .paired = paired};
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t K = 0; K < dim; ++K) {
      of.inverse[3 * K + i] = work->inverse[(3 * K + i) * ld + q];
      for (int32_t k = 0; k < dim; ++k) {
        const double by = work->inverse[(3 * K + k) * ld + q];
        of.h[3 * i + K] += work->weight[q] * work->h[(3 * i + k) * ld + q] * by;
        if (paired) of.k[3 * i + K] += work->weight[q] * work->k[(3 * i + k) * ld + q] * by;
      }
    }
  if (paired) of.q = work->weight[q] * work->q[q];
  return of;
}

/* Particles with the same stencil follow each other for the most part: their stiffness is added up first. */
void mpmi_add_stencils(mpmi_balance *balance, mpmi_newton_work *work, const mpmi_stiff_particles *of) {
  const mpm_grid *grid = balance->settings->grid;
  const int32_t remedy = balance->settings->desc.locking_remedy;
  mpmi_weights W;
  int32_t first = -1, cell[MPMI_CHUNK];
  for (int64_t at = 0; at < of->n; at += MPMI_CHUNK) {
    balance->settings->kernels->weights[grid->family][grid->dim](of->axis, MPMI_NEED_GRADIENT, &of->points,
                                                                 of->begin + at, MPMI_CHUNK, &W);
    if (remedy) mpmi_cell_places(grid, of->axis, &of->points, of->begin + at, MPMI_CHUNK, cell);
    for (int64_t p = 0; p < MPMI_CHUNK; ++p) {
      if (of->id[of->begin + at + p] < 0) continue;
      if (remedy) {
        const mpmi_locking_particle in_cell = of->in_cell(of, balance, work, at + p);
        mpmi_locking_stiffness_add(balance, work, &W, p, cell[p], &in_cell);
      }
      if (first >= 0 && W.node[p] != first) add_stencil(balance, work, first);
      first = W.node[p];
      balance->settings->kernels->stiffness[grid->dim](grid->width, &W, p, work->stiffness + at + p, of->ld,
                                                       hoop_of(grid, &of->points, of->begin + at + p),
                                                       work->K);
    }
  }
  if (first >= 0) add_stencil(balance, work, first);
}

/* Finds V0 of the tangent; where the forces take the volume without the dilation that the law saw beside it
 * (`ratio`), less that. */
static void find_weights(const mpmi_balance *balance, const mpm_particles *set, int64_t begin, int64_t n,
                         double *weight) {
  const double *volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0) + begin;
  memcpy(weight, volume, (size_t)n * sizeof *weight);
  if (!balance->settings->desc.locking_remedy || mpmi_averages_pressure(balance->settings, set)) return;
  const double *ratio = mpmi_f64(set, MPMI_DILATION_RATIO, 1) + begin;
  for (int64_t p = 0; p < n; ++p) weight[p] /= ratio[p];
}

static int32_t is_finite(const double *value, int32_t dim, int64_t ld, int64_t n, int64_t *bad) {
  for (int32_t e = 0; e < 81; ++e) {
    if (e / 27 >= dim || e / 9 % 3 >= dim || e / 3 % 3 >= dim || e % 3 >= dim) continue;
    for (*bad = 0; *bad < n; ++*bad)
      if (value[e * ld + *bad] - value[e * ld + *bad] != 0.0) return 0;
  }
  return 1;
}

static int32_t find_tangent(mpmi_newton_work *work, mpmi_batch *b) {
  const mpm_particles *set = b->set;
  const int32_t sheets = mpmi_is_plane_stress(set->grid),
                dim = sheets || set->thermal.expansion != 0.0 ? 3 : mpmi_strain_dim(set->grid);
  const int64_t ld = b->law.ld, *id = mpmi_i64(set, MPMI_ID, 0) + b->begin;
  const mpm_status status = mpmi_material_tangent(set->material, dim, &b->law.batch, work->tangent_scratch,
                                                  work->tangent, &work->symmetric);
  if (status) {
    mpmi_failure_take(&b->report->failure, mpmi_callback_failure(status, b->m, "the tangent callback"));
    return 0;
  }
  for (int64_t p = 0; p < b->n; ++p)
    for (int32_t e = 0; e < 81 && id[p] < 0; ++e) work->tangent[e * ld + p] = 0.0;
  if (sheets) mpmi_condense_tangent(work->tangent, ld, b->n);
  int64_t bad;
  if (is_finite(work->tangent, dim, ld, b->n, &bad)) return 1;
  mpmi_batch_fail(b, MPM_NONFINITE, b->begin + bad, "the material's tangent is not finite");
  return 0;
}

void mpmi_keep_whole_F(const mpmi_balance *balance, const mpmi_batch *b) {
  double *to = balance->newton->work[b->task].F_inc;
  const int32_t dim = b->set->grid->dim;
  for (int32_t c = 0; c < mpmi_tensor_components(dim); ++c)
    memcpy(to + mpmi_tensor_map(dim)[c] * b->law.ld, mpmi_component_row(b->set, MPMI_F, 1, c) + b->begin,
           (size_t)b->n * sizeof *to);
}

/* Turns stress and tangent (or with NULL stress alone) into what the nodes' gradients are multiplied by. */
static void push_forward(mpmi_balance *balance, mpmi_newton_work *work, const mpmi_batch *b,
                         const double *tangent) {
  const int32_t kept =
      balance->settings->desc.locking_remedy || mpmi_is_total_lagrangian(balance->settings->grid);
  const mpmi_push push = {.ld = b->law.ld,
                          .F_inc = kept ? work->F_inc : b->law.F_inc,
                          .stress = b->law.stress_new,
                          .volume = mpmi_f64(b->set, MPMI_VOLUME, 0) + b->begin,
                          .weight = work->weight,
                          .tangent = tangent,
                          .inverse = work->inverse,
                          .nominal = work->nominal,
                          .stiffness = work->stiffness};
  balance->settings->kernels->push[mpmi_strain_dim(b->set->grid)](&push, b->n);
}

static int32_t is_rigid(const mpmi_batch *b) {
  return mpmi_material_kinematics(b->set->material) == MPMI_F_STAYS;
}

/* Exchanges the stress of a batch for that in the forces, where it is another one. */
static void take_nodal_stress(mpmi_batch *b) {
  const double *from = b->step->work->rows.of[b->m].nodal_stress;
  for (int32_t c = 0; from && c < mpmi_stress_components(b->set->grid->dim); ++c)
    memcpy(b->law.stress_new + c * b->law.ld, from + c * b->set->ld + b->begin, (size_t)b->n * sizeof *from);
}

/* Puts the share that the remedy's local part has into the tangent, and what couples a cell into h, k, q. */
static void add_local_part(mpmi_newton_work *work, mpmi_batch *b) {
  const double *volume = mpmi_f64(b->set, MPMI_VOLUME, 0) + b->begin;
  const double *nodal_stress = b->step->work->rows.of[b->m].nodal_stress;
  const int32_t dim = mpmi_strain_dim(b->set->grid);
  if (!nodal_stress) {
    mpmi_locking_stiffness_local(dim, &b->law, work->weight, volume, work->tangent, work->h);
    return;
  }
  mpmi_paired_stiffness_local(
      dim, &(mpmi_paired_local){.ld = b->law.ld,
                                .n = b->n,
                                .volume = volume,
                                .initial_volume = work->weight,
                                .ratio = mpmi_f64(b->set, MPMI_DILATION_RATIO, 1) + b->begin,
                                .nodal_stress = nodal_stress + b->begin,
                                .nodal_ld = b->set->ld,
                                .stress = b->law.stress_new,
                                .tangent = work->tangent,
                                .h = work->h,
                                .k = work->k,
                                .q = work->q});
}

void mpmi_add_forces(mpmi_balance *balance, mpmi_batch *b) {
  const mpm_grid *grid = balance->settings->grid;
  mpmi_newton_work *work = &balance->newton->work[b->task];
  if (is_rigid(b)) return;
  take_nodal_stress(b);
  push_forward(balance, work, b, NULL);
  mpmi_force_scatter scatter = mpmi_force_scatter_of(balance, b->m, work->tile);
  memcpy(scatter.axis, b->gather.axis, sizeof scatter.axis);
  scatter.ld = b->law.ld;
  scatter.nominal = work->nominal;
  balance->settings->kernels->force_scatter[grid->dim][grid->width](&scatter, b->begin, b->n);
}

int32_t mpmi_find_stiffness(mpmi_balance *balance, mpmi_batch *b) {
  mpmi_newton_work *work = &balance->newton->work[b->task];
  if (is_rigid(b) || !find_tangent(work, b)) return 0;
  find_weights(balance, b->set, b->begin, b->n, work->weight);
  if (balance->settings->desc.locking_remedy) add_local_part(work, b);
  push_forward(balance, work, b, work->tangent);
  return 1;
}

static mpmi_locking_particle in_cell(const mpmi_stiff_particles *of, const mpmi_balance *balance,
                                     const mpmi_newton_work *work, int64_t q) {
  return mpmi_locking_particle_of(balance, work, of->batch, q);
}

void mpmi_add_stiffness(mpmi_balance *balance, mpmi_batch *b) {
  if (!mpmi_find_stiffness(balance, b)) return;
  mpmi_add_stencils(balance, &balance->newton->work[b->task],
                    &(mpmi_stiff_particles){.axis = b->gather.axis,
                                            .points = mpmi_points_of(b->set, 0),
                                            .id = mpmi_i64(b->set, MPMI_ID, 0),
                                            .begin = b->begin,
                                            .n = b->n,
                                            .ld = b->law.ld,
                                            .in_cell = in_cell,
                                            .batch = b});
}
