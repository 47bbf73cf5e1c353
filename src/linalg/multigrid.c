/* The levels of the multigrid, and the cycle over them. */
#include "linalg/multigrid.h"

#include <string.h>

/* A level of COARSEST unknowns or less is factored and not coarsened. Where the next level would have more
 * than the share WORTH of the nodes, so is a level of FACTORED unknowns or less. */
enum { COARSEST = 800, FACTORED = 50 * COARSEST };
static const double WORTH = 0.7;

void mpmi_multigrid_init(mpmi_multigrid *g, mpm_context *context) {
  memset(g, 0, sizeof *g);
  g->context = g->scratch.context = context;
  g->kernels = mpmi_sweeps_of(context->isa);
  for (int32_t l = 0; l < MPMI_MOST_LEVELS; ++l) mpmi_matrix_init(&g->level[l].own, context);
  mpmi_factor_init(&g->coarsest, context);
}

void mpmi_multigrid_free(mpmi_multigrid *g) {
  for (int32_t l = 0; l < MPMI_MOST_LEVELS; ++l) {
    mpmi_level *level = &g->level[l];
    mpmi_matrix_free(&level->own);
    mpmi_smoother_free(&level->smoother, g->context);
    mpmi_free(g->context, level->next.slab, (size_t)level->next.slab_capacity);
  }
  mpmi_factor_free(&g->coarsest);
  MPMI_FREE_ARRAY(g->context, g->rhs, g->coarsest_capacity);
  mpmi_free(g->context, g->scratch.memory, (size_t)g->scratch.capacity);
}

static mpm_status analyse(mpmi_multigrid *g, const mpmi_matrix *A) {
  mpm_status status = MPM_OK;
  g->analysed = g->coarsest.analysed = 0;
  g->level[0].A = A;
  for (g->levels = 1; g->levels < MPMI_MOST_LEVELS; ++g->levels) {
    mpmi_level *level = &g->level[g->levels - 1], *next = level + 1;
    if (mpmi_matrix_unknowns(level->A) <= COARSEST) break;
    if ((status = mpmi_coarsen(&g->scratch, level, next, &level->next))) return status;
    if ((double)next->own.rows > WORTH * (double)level->A->rows && mpmi_matrix_unknowns(level->A) <= FACTORED)
      break;
    if ((status = mpmi_smoother_analyse(&level->smoother, level->A))) return status;
  }
  const mpmi_matrix *last = g->level[g->levels - 1].A;
  const int64_t n = mpmi_matrix_unknowns(last);
  if ((status = mpmi_reserve(g->context, (void **)&g->rhs, &g->coarsest_capacity, 2 * n, sizeof *g->rhs)))
    return status;
  g->x = g->rhs + n;
  if ((status = mpmi_factor_analyse(&g->coarsest, last))) return status;
  g->pattern_id = A->pattern_id;
  g->analysed = 1;
  return MPM_OK;
}

/* The values of a matrix may have any size, and single precision has little room. So the right-hand side
 * of a cycle is divided by its norm and by the largest scale. */
static void measure_scales(mpmi_multigrid *g) {
  const mpmi_smoother *s = &g->level[0].smoother;
  g->largest_scale = 0.0;
  for (int64_t i = 0; g->levels > 1 && i < s->rows * s->block; ++i)
    if (s->scale[i] > g->largest_scale) g->largest_scale = s->scale[i];
}

mpm_status mpmi_multigrid_prepare(mpmi_multigrid *g, const mpmi_matrix *A, int64_t *row) {
  mpm_status status = MPM_OK;
  *row = -1;
  g->level[0].A = A;
  if ((!g->analysed || g->pattern_id != A->pattern_id) && (status = analyse(g, A))) return status;
  for (int32_t l = 0; l + 1 < g->levels; ++l) {
    mpmi_level *level = &g->level[l];
    level[1].own.symmetric = A->symmetric;
    int64_t bad = -1;
    if ((status = mpmi_smoother_numbers(&level->smoother, level->A, &bad)) && !l) *row = bad;
    if (status || (status = mpmi_galerkin(&g->scratch, level, level + 1))) return status;
  }
  measure_scales(g);
  const mpmi_matrix *last = g->level[g->levels - 1].A;
  int64_t bad = -1;
  if ((status = mpmi_factor_analyse(&g->coarsest, last))) return status; /* the symmetry may have changed */
  if ((status = mpmi_factor_numbers(&g->coarsest, last, &bad)) && g->levels == 1) *row = bad;
  if (status) return status;
  return A->symmetric && g->coarsest.negative ? MPM_SINGULAR : MPM_OK;
}

/* ---- the cycle ----------------------------------------------------------------------------------------- */
typedef struct cycle_job {
  mpmi_multigrid *g;
  const mpmi_level *fine;
  const mpmi_level *coarse;
  mpmi_sweep_fn sweep;
  int64_t first; /* the first line of a colour */
  const double *r;
  double *z, by;
  int32_t factored; /* the coarse level is the coarsest */
  mpmi_ranges ranges;
} cycle_job;

static mpm_status run_level(cycle_job *job, int64_t items, const mpmi_matrix *A, mpm_task_fn task) {
  job->ranges = mpmi_ranges_of(items, mpmi_matrix_unknowns(A));
  return mpmi_run_ranges(job->g->context, &job->ranges, task, job);
}

static void sweep_task(void *data, int64_t k) {
  const cycle_job *job = data;
  job->sweep(&job->fine->smoother, job->first + mpmi_range_begin(&job->ranges, k),
             job->first + mpmi_range_begin(&job->ranges, k + 1));
}

/* Sweeps over one colour of lines after the other, forwards or backwards. */
static mpm_status sweep(cycle_job *job, int32_t backwards) {
  const mpmi_lines *lines = &job->fine->smoother.lines;
  job->sweep = job->g->kernels->solve;
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < lines->colours && !status; ++i) {
    const int32_t c = backwards ? lines->colours - 1 - i : i;
    job->first = lines->colour_start[c];
    status = run_level(job, lines->colour_start[c + 1] - job->first, job->fine->A, sweep_task);
  }
  return status;
}

static void load_task(void *data, int64_t k) {
  const cycle_job *job = data;
  const mpmi_smoother *s = &job->fine->smoother;
  const int32_t block = s->block, lanes = MPMI_PADDED(block);
  for (int64_t i = mpmi_range_begin(&job->ranges, k); i < mpmi_range_begin(&job->ranges, k + 1); ++i)
    for (int32_t c = 0; c < block; ++c) {
      s->rhs[i * lanes + c] = (float)(job->by * s->scale[i * block + c] * job->r[i * block + c]);
      s->x[i * lanes + c] = 0.0F;
    }
}

static void store_task(void *data, int64_t k) {
  const cycle_job *job = data;
  const mpmi_smoother *s = &job->fine->smoother;
  const int32_t block = s->block, lanes = MPMI_PADDED(block);
  for (int64_t i = mpmi_range_begin(&job->ranges, k); i < mpmi_range_begin(&job->ranges, k + 1); ++i)
    for (int32_t c = 0; c < block; ++c)
      job->z[i * block + c] = job->by * s->scale[i * block + c] * (double)s->x[i * lanes + c];
}

/* Makes the right-hand side of the coarse level: P^T times what is left on the fine one. */
static void restrict_task(void *data, int64_t k) {
  const cycle_job *job = data;
  const mpmi_coarsening *P = &job->fine->next;
  const mpmi_smoother *s = &job->fine->smoother, *to = &job->coarse->smoother;
  const int32_t block = s->block, lanes = MPMI_PADDED(block);
  for (int64_t I = mpmi_range_begin(&job->ranges, k); I < mpmi_range_begin(&job->ranges, k + 1); ++I) {
    double sum[3] = {0.0, 0.0, 0.0};
    for (int64_t e = P->child_start[I]; e < P->child_start[I + 1]; ++e) {
      const int64_t i = P->child[e];
      const double weight = 1.0 / (double)(P->parent_start[i + 1] - P->parent_start[i]);
      for (int32_t c = 0; c < block; ++c)
        sum[c] += weight * s->unscale[i * block + c] * (double)s->residual[i * lanes + c];
    }
    for (int32_t c = 0; c < block; ++c) {
      if (job->factored) {
        job->g->rhs[I * block + c] = job->coarse->A->held[I * block + c] ? 0.0 : sum[c];
        continue;
      }
      to->rhs[I * lanes + c] = (float)(to->scale[I * block + c] * sum[c]);
      to->x[I * lanes + c] = 0.0F;
    }
  }
}

/* Adds P times the coarse solution to x. */
static void prolong_task(void *data, int64_t k) {
  const cycle_job *job = data;
  const mpmi_coarsening *P = &job->fine->next;
  const mpmi_smoother *s = &job->fine->smoother, *from = &job->coarse->smoother;
  const int32_t block = s->block, lanes = MPMI_PADDED(block);
  for (int64_t i = mpmi_range_begin(&job->ranges, k); i < mpmi_range_begin(&job->ranges, k + 1); ++i) {
    const int64_t begin = P->parent_start[i], end = P->parent_start[i + 1];
    double sum[3] = {0.0, 0.0, 0.0};
    for (int64_t e = begin; e < end; ++e) {
      const int64_t J = P->parent[e];
      for (int32_t c = 0; c < block; ++c)
        sum[c] += job->factored ? job->g->x[J * block + c]
                                : from->scale[J * block + c] * (double)from->x[J * lanes + c];
    }
    for (int32_t c = 0; c < block; ++c)
      s->x[i * lanes + c] += (float)(s->unscale[i * block + c] * sum[c] / (double)(end - begin));
  }
}

static mpm_status cycle(cycle_job job, int32_t l) {
  mpmi_multigrid *g = job.g;
  job.fine = &g->level[l];
  job.coarse = &g->level[l + 1];
  job.factored = l + 2 == g->levels;
  mpm_status status = sweep(&job, 0);
  job.first = 0;
  job.sweep = g->kernels->residual;
  if (!status) status = run_level(&job, job.fine->smoother.lines.count, job.fine->A, sweep_task);
  if (!status) status = run_level(&job, job.coarse->A->rows, job.fine->A, restrict_task);
  if (status) return status;
  if (job.factored)
    mpmi_factor_solve(&g->coarsest, job.coarse->A, g->rhs, g->x);
  else if ((status = cycle(job, l + 1)))
    return status;
  if ((status = run_level(&job, job.fine->A->rows, job.fine->A, prolong_task))) return status;
  return sweep(&job, 1);
}

mpm_status mpmi_multigrid_cycle(mpmi_multigrid *g, const double *r, double *z) {
  const mpmi_matrix *A = g->level[0].A;
  double norm;
  mpm_status status = mpmi_norm(g->context, r, mpmi_matrix_unknowns(A), &norm);
  if (status) return status;
  if (g->levels == 1) {
    mpmi_factor_solve(&g->coarsest, A, r, z);
    return MPM_OK;
  }
  norm *= g->largest_scale;
  cycle_job job = {.g = g, .fine = &g->level[0], .r = r, .z = z, .by = norm > 0.0 ? 1.0 / norm : 0.0};
  if ((status = run_level(&job, A->rows, A, load_task)) || (status = cycle(job, 0))) return status;
  job.by = norm;
  return run_level(&job, A->rows, A, store_task);
}
