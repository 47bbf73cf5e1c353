/* Forces and stiffness of the particles on the nodes, for implicit steps: block by block, and colour by
 * colour so that every sum has one order (p2g.c). Stress and tangent come with the pass over the particles,
 * g2p.c. */
#include "stepper/locking.h"
#include "stepper/newton.h"

#include <string.h>

static size_t tile_bytes(const mpm_stepper *s) {
  size_t bytes = 4 * sizeof(double);
  for (int32_t k = 0; k < s->grid->dim; ++k) bytes *= (size_t)MPMI_TILE_EDGE(s->grid->dim, s->grid->width);
  return bytes;
}

typedef struct force_job {
  mpm_stepper *s;
  double *to;
  int32_t colour;
} force_job;

static void clear_task(void *data, int64_t k) {
  const force_job *job = data;
  const mpm_stepper *s = job->s;
  const int64_t values = 4 * s->blocks.count * s->blocks.nodes;
  const int64_t begin = values * k / s->tasks, end = values * (k + 1) / s->tasks;
  if (end > begin) memset(job->to + begin, 0, (size_t)(end - begin) * sizeof(double));
}

static mpmi_force_scatter scatter_of(const mpm_stepper *s, const mpmi_member *member, double *tile) {
  const mpm_particles *set = member->set;
  mpmi_force_scatter job = {.weights = s->kernels->weights[s->grid->family][s->grid->dim],
                            .points = mpmi_points_of(set, 0),
                            .mass = mpmi_f64(set, MPMI_MASS, 0),
                            .initial_volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0),
                            .deforms = mpmi_material_kinematics(set->material) != MPMI_F_STAYS,
                            .tile = tile};
  for (int32_t k = 0; k < s->grid->dim; ++k) {
    job.gravity[k] = s->desc.gravity[k];
    job.force[k] = member->force ? member->force + k * set->ld : NULL;
  }
  return job;
}

static void external_task(void *data, int64_t k) {
  const force_job *job = data;
  mpm_stepper *s = job->s;
  const mpmi_cut *cut = &s->colour[job->colour];
  double *tile = s->newton->work[k].tile;
  const mpmi_force_scatter_fn kernel = s->kernels->force_scatter[s->grid->dim][s->grid->width];
  memset(tile, 0, tile_bytes(s));
  for (int64_t i = cut->bound[k]; i < cut->bound[k + 1]; ++i) {
    const int32_t block = cut->list[i];
    for (int32_t m = 0; m < s->member_count; ++m) {
      const int64_t *start = s->member[m].now.start;
      if (start[block] == start[block + 1]) continue;
      mpmi_force_scatter scatter = scatter_of(s, &s->member[m], tile);
      mpmi_block_axes(s->grid, s->blocks.coord[block], scatter.axis);
      kernel(&scatter, start[block], start[block + 1] - start[block]);
    }
    mpmi_tile_add(s, block, job->to, 4, tile);
  }
}

mpm_status mpmi_external_forces(mpm_stepper *s) {
  force_job job = {s, s->newton->external, 0};
  mpm_status status = mpmi_run_tasks(s, 0, s->tasks, clear_task, &job);
  for (; job.colour < MPMI_COLOURS && !status; ++job.colour)
    if (s->colour[job.colour].count) status = mpmi_run_tasks(s, 0, s->tasks, external_task, &job);
  return status;
}

/* Displacements as mean velocities of the step, on all nodes that move with a row. */
typedef struct spread_job {
  mpm_stepper *s;
  const double *u;
  double dt;
} spread_job;

static void spread_task(void *data, int64_t k) {
  const spread_job *job = data;
  const mpm_stepper *s = job->s;
  const mpmi_newton *w = s->newton;
  const int32_t dim = s->grid->dim;
  for (int64_t i = w->active_count * k / s->tasks; i < w->active_count * (k + 1) / s->tasks; ++i) {
    const mpmi_active_node *node = &w->active[i];
    for (int32_t c = 0; c < dim; ++c)
      s->node[8 * node->slot + c] = node->sign[c] * (job->u[(int64_t)node->row * dim + c] / job->dt);
  }
}

static void clear_failures(mpm_stepper *s) {
  mpmi_failure_clear(&s->failure);
  for (int32_t k = 0; k < s->tasks; ++k) mpmi_failure_clear(&s->scratch[k].failure);
}

static void clear_matrix_task(void *data, int64_t k) {
  const mpm_stepper *s = data;
  const mpmi_matrix *A = &s->newton->matrix;
  const int64_t values = A->row_start[A->rows] * A->block * A->block;
  const int64_t begin = values * k / s->tasks, end = values * (k + 1) / s->tasks;
  if (end > begin) memset(A->value + begin, 0, (size_t)(end - begin) * sizeof(double));
}

/* Strain of the displacements u, and then what is asked for on the nodes. */
static mpm_status strain(mpm_stepper *s, const double *u, double dt, int32_t what) {
  spread_job spread = {s, u, dt};
  clear_failures(s);
  mpm_status status = mpmi_run_tasks(s, 0, s->tasks, spread_task, &spread);
  if (!status && s->desc.locking_remedy) {
    mpmi_make_volumes(s, 0); /* the averages weigh with those of the start of the step */
    status = mpmi_stage_locking(s, s->node, s->values, dt);
  }
  return status ? status : mpmi_stage_g2p(s, MPMI_G2P_DEFORM | what, s->node, s->values, dt);
}

mpm_status mpmi_internal_forces(mpm_stepper *s, const double *u, double dt) {
  mpmi_newton *w = s->newton;
  force_job clear = {s, w->force, 0};
  mpm_status status = mpmi_run_tasks(s, 0, s->tasks, clear_task, &clear);
  if (!status) status = strain(s, u, dt, MPMI_G2P_FORCES);
  if (!status) mpmi_unknowns_fold(s, w->force, w->vector[MPMI_INTERNAL]);
  return status;
}

mpm_status mpmi_stiffness(mpm_stepper *s, const double *u, double dt) {
  mpmi_newton *w = s->newton;
  mpm_status status = mpmi_run_tasks(s, 0, s->tasks, clear_matrix_task, s);
  if (!status && s->desc.locking_remedy) status = mpmi_locking_stiffness_begin(s);
  for (int32_t k = 0; k < s->tasks; ++k) w->work[k].symmetric = 1;
  if (!status) status = strain(s, u, dt, MPMI_G2P_STIFFNESS);
  if (status) return status;
  w->matrix.symmetric = 1;
  for (int32_t k = 0; k < s->tasks; ++k) w->matrix.symmetric &= w->work[k].symmetric;
  if (s->desc.locking_remedy) mpmi_locking_stiffness_end(s);
  return MPM_OK;
}

/* Active node at each place of the tile of a block. */
static void map_tile(const mpm_stepper *s, int64_t block, int32_t *to) {
  const mpm_grid *grid = s->grid;
  const mpmi_blocks *b = &s->blocks;
  const int32_t edge = MPMI_TILE_EDGE(grid->dim, grid->width), low = MPMI_RING + grid->below;
  int32_t count = 1;
  for (int32_t k = 0; k < grid->dim; ++k) count *= edge;
  for (int32_t i = 0; i < count; ++i) {
    int32_t rest = i, at[3], n = 0, place = 0;
    for (int32_t k = grid->dim - 1; k >= 0; --k) {
      at[k] = rest % edge - low;
      rest /= edge;
    }
    for (int32_t k = 0; k < grid->dim; ++k) {
      const int32_t side = at[k] < 0 ? 0 : at[k] >= b->edge ? 2 : 1;
      n = 3 * n + side;
      place = place * b->edge + at[k] - (side - 1) * b->edge;
    }
    const int32_t other = b->neighbour[block][n];
    to[i] = other == MPMI_NO_BLOCK ? -1 : s->newton->active_of[(int64_t)other * b->nodes + place];
  }
}

int32_t mpmi_at_seam(const mpm_stepper *s, int64_t block) {
  const mpm_grid *grid = s->grid;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const int64_t first = (int64_t)s->blocks.coord[block][k] * s->blocks.edge - MPMI_RING - grid->below;
    const int64_t end = first + MPMI_TILE_EDGE(grid->dim, grid->width);
    if (grid->desc.periodic[k] && (first < 0 || end > grid->desc.cells[k])) return 1;
  }
  return 0;
}

void mpmi_assemble_begin(mpm_stepper *s, int32_t task, int32_t what, int64_t block) {
  mpmi_newton_work *work = &s->newton->work[task];
  if (what & MPMI_G2P_FORCES) memset(work->tile, 0, tile_bytes(s));
  if (what & MPMI_G2P_STIFFNESS) map_tile(s, block, work->tile_active);
}

void mpmi_assemble_end(mpm_stepper *s, int32_t task, int32_t what, int64_t block) {
  if (what & MPMI_G2P_FORCES) mpmi_tile_add(s, block, s->newton->force, 4, s->newton->work[task].tile);
}

/* The nodes of a stencil along rows of `edge`. */
static int32_t stencil_places(const mpm_grid *grid, int32_t edge, int32_t *place) {
  int32_t count = 1;
  for (int32_t k = 0; k < grid->dim; ++k) count *= grid->width;
  for (int32_t a = 0; a < count; ++a) {
    int32_t rest = a, at[3];
    for (int32_t k = grid->dim - 1; k >= 0; --k) {
      at[k] = rest % grid->width;
      rest /= grid->width;
    }
    place[a] = 0;
    for (int32_t k = 0; k < grid->dim; ++k) place[a] = place[a] * edge + at[k];
  }
  return count;
}

void mpmi_stencil_find(const mpm_stepper *s, mpmi_stencil *to) {
  const mpm_grid *grid = s->grid;
  const int32_t span = grid->width + (s->desc.locking_remedy ? grid->centred : 0);
  to->count = stencil_places(grid, MPMI_TILE_EDGE(grid->dim, grid->width), to->in_tile);
  stencil_places(grid, 2 * span - 1, to->offset);
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

MPMI_INLINE void add_stencil_in(int32_t dim, mpmi_newton *w, const mpmi_newton_work *work, int32_t nodes,
                                int32_t first) {
  const mpmi_stencil *stencil = &w->stencil;
  int32_t active[MPMI_MOST_NODES];
  for (int32_t a = 0; a < stencil->count; ++a) active[a] = work->tile_active[first + stencil->in_tile[a]];
  for (int32_t a = 0; a < stencil->count; ++a) {
    if (active[a] < 0) continue;
    const int32_t *place = w->place + (int64_t)active[a] * w->offsets + w->offsets / 2 - stencil->offset[a];
    for (int32_t b = 0; b < stencil->count; ++b)
      if (active[b] >= 0)
        add_block(dim, nodes, work->K + (int64_t)a * dim * nodes + b, &w->active[active[a]],
                  &w->active[active[b]], w->matrix.value + (int64_t)place[stencil->offset[b]] * dim * dim);
  }
}

/* Adds the dense stiffness of the stencil whose first node lies at `first` of the tile, and clears it. */
static void add_stencil(mpm_stepper *s, mpmi_newton_work *work, int32_t first) {
  const int32_t dim = s->grid->dim, nodes = MPMI_STENCIL_NODES(dim, s->grid->width), row = dim * nodes;
  if (dim == 3)
    add_stencil_in(3, s->newton, work, nodes, first);
  else if (dim == 2)
    add_stencil_in(2, s->newton, work, nodes, first);
  else
    add_stencil_in(1, s->newton, work, nodes, first);
  memset(work->K, 0, (size_t)(row * row) * sizeof *work->K);
}

/* The share of one particle in what couples those of its cell. */
static void add_to_cell(mpm_stepper *s, const mpmi_newton_work *work, const mpm_particles *set,
                        const mpmi_weights *W, int64_t p, int32_t cell, int64_t slot, int64_t q, int64_t ld) {
  const int32_t dim = s->grid->dim;
  mpmi_locking_particle of = {.volume = mpmi_f64(set, MPMI_VOLUME, 0)[slot]};
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t K = 0; K < dim; ++K) {
      of.inverse[3 * K + i] = work->inverse[(3 * K + i) * ld + q];
      for (int32_t k = 0; k < dim; ++k)
        of.h[3 * i + K] +=
            work->weight[q] * work->h[(3 * i + k) * ld + q] * work->inverse[(3 * K + k) * ld + q];
    }
  mpmi_locking_stiffness_add(s, work, W, p, cell, &of);
}

/* Particles with the same stencil follow each other for the most part: their stiffness is added up first. */
static void add_stiffness(mpm_stepper *s, mpmi_newton_work *work, const mpm_particles *set,
                          const mpmi_axis *axis, int64_t begin, int64_t n, int64_t ld) {
  const mpm_grid *grid = s->grid;
  const mpmi_points points = mpmi_points_of(set, 0);
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0) + begin;
  mpmi_weights W;
  int32_t first = -1, cell[MPMI_CHUNK];
  for (int64_t at = 0; at < n; at += MPMI_CHUNK) {
    s->kernels->weights[grid->family][grid->dim](axis, MPMI_NEED_GRADIENT, &points, begin + at, MPMI_CHUNK,
                                                 &W);
    if (s->desc.locking_remedy) mpmi_cell_places(grid, axis, &points, begin + at, MPMI_CHUNK, cell);
    for (int64_t p = 0; p < MPMI_CHUNK; ++p) {
      if (id[at + p] < 0) continue;
      if (s->desc.locking_remedy) add_to_cell(s, work, set, &W, p, cell[p], begin + at + p, at + p, ld);
      if (first >= 0 && W.node[p] != first) add_stencil(s, work, first);
      first = W.node[p];
      s->kernels->stiffness[grid->dim](grid->width, &W, p, work->stiffness + at + p, ld, work->K);
    }
  }
  if (first >= 0) add_stencil(s, work, first);
}

/* V0 of the tangent: the law saw a dilation of `ratio` more than the volume has. */
static void find_weights(const mpm_stepper *s, const mpm_particles *set, int64_t begin, int64_t n,
                         double *weight) {
  const double *volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0) + begin;
  memcpy(weight, volume, (size_t)n * sizeof *weight);
  if (!s->desc.locking_remedy) return;
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

static int32_t find_tangent(mpm_stepper *s, mpmi_newton_work *work, mpmi_failure *failure, int32_t m,
                            const mpmi_law_batch *law, int64_t begin, int64_t n) {
  const mpm_particles *set = s->member[m].set;
  const int32_t dim = s->grid->dim;
  const mpm_status status = mpmi_material_tangent(set->material, s->context->isa, dim, &law->batch,
                                                  work->tangent_scratch, work->tangent, &work->symmetric);
  if (status) {
    mpmi_failure_take(
        failure, &(mpmi_failure){mpmi_callback_cause(status), status, m, -1, -1, "the tangent callback"});
    return 0;
  }
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0) + begin;
  for (int64_t p = 0; p < n; ++p)
    for (int32_t e = 0; e < 81 && id[p] < 0; ++e) work->tangent[e * law->ld + p] = 0.0;
  int64_t bad;
  if (is_finite(work->tangent, dim, law->ld, n, &bad)) return 1;
  mpmi_failure_take(
      failure, &(mpmi_failure){MPM_NONFINITE, 0, m, id[bad], -1, "the material's tangent is not finite"});
  return 0;
}

void mpmi_assemble_batch(mpm_stepper *s, int32_t task, int32_t what, int32_t m, const mpmi_law_batch *law,
                         const mpmi_axis *axis, int64_t begin, int64_t n) {
  const mpm_particles *set = s->member[m].set;
  const mpm_grid *grid = s->grid;
  mpmi_newton_work *work = &s->newton->work[task];
  if (mpmi_material_kinematics(set->material) == MPMI_F_STAYS) return;
  if ((what & MPMI_G2P_STIFFNESS) && !find_tangent(s, work, &s->scratch[task].failure, m, law, begin, n))
    return;
  find_weights(s, set, begin, n, work->weight);
  const double *volume = mpmi_f64(set, MPMI_VOLUME, 0) + begin;
  if ((what & MPMI_G2P_STIFFNESS) && s->desc.locking_remedy)
    mpmi_locking_stiffness_local(s, law, work->weight, volume, work->tangent, work->h);
  const mpmi_push push = {.ld = law->ld,
                          .F_inc = s->desc.locking_remedy ? work->F_inc : law->F_inc,
                          .stress = law->stress_new,
                          .volume = volume,
                          .weight = work->weight,
                          .tangent = what & MPMI_G2P_STIFFNESS ? work->tangent : NULL,
                          .inverse = work->inverse,
                          .nominal = work->nominal,
                          .stiffness = work->stiffness};
  s->kernels->push[grid->dim](&push, n);
  if (what & MPMI_G2P_FORCES) {
    mpmi_force_scatter scatter = scatter_of(s, &s->member[m], work->tile);
    memcpy(scatter.axis, axis, sizeof scatter.axis);
    scatter.ld = law->ld;
    scatter.nominal = work->nominal;
    s->kernels->force_scatter[grid->dim][grid->width](&scatter, begin, n);
  }
  if (what & MPMI_G2P_STIFFNESS) add_stiffness(s, work, set, axis, begin, n, law->ld);
}
