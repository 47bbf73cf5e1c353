/* Forces and stiffness of the particles on the nodes, for implicit steps: block by block, and colour by
 * colour so that every sum has one order (p2g.c). Those of stress and tangent come with the pass over the
 * particles (g2p.c), which calls assemble_batch.c. */
#include "stepper/assemble.h"

#include <string.h>

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

static void external_task(void *data, int64_t k) {
  const force_job *job = data;
  mpm_stepper *s = job->s;
  const mpmi_cut *cut = &s->colour[job->colour];
  double *tile = s->newton->work[k].tile;
  const mpmi_force_scatter_fn kernel = s->kernels->force_scatter[s->grid->dim][s->grid->width];
  memset(tile, 0, mpmi_force_tile_bytes(s));
  for (int64_t i = cut->bound[k]; i < cut->bound[k + 1]; ++i) {
    const int32_t block = cut->list[i];
    for (int32_t m = 0; m < s->member_count; ++m) {
      const int64_t *start = s->member[m].now.start;
      if (start[block] == start[block + 1]) continue;
      mpmi_force_scatter scatter = mpmi_force_scatter_of(s, &s->member[m], tile);
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

int32_t mpmi_at_seam(const mpm_stepper *s, int64_t block) {
  const mpm_grid *grid = s->grid;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const int64_t first = (int64_t)s->blocks.coord[block][k] * s->blocks.edge - MPMI_RING - grid->below;
    const int64_t end = first + MPMI_TILE_EDGE(grid->dim, grid->width);
    if (grid->desc.periodic[k] && (first < 0 || end > grid->desc.cells[k])) return 1;
  }
  return 0;
}
