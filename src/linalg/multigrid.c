/* The hierarchies of levels, and the cycle over them. */
#include "linalg/multigrid.h"

#include <string.h>

/* Sweeps before the coarser levels correct, and as many after: one is not enough where matter hardly changes
 * its volume, more than two cost what they save. */
enum { SWEEPS = 2 };
/* Functions that alternate in all three axes are seen by no neighbour where nodes couple with more than these
 * on average. On cubic splines they couple with 343. */
enum { FEW = 200 };

void mpmi_multigrid_init(mpmi_multigrid *g, mpm_context *context) {
  memset(g, 0, sizeof *g);
  g->context = g->scratch.context = context;
  g->kernels = mpmi_sweeps_of(context->isa);
  mpmi_hierarchy_init(&g->smooth, context, 0);
  mpmi_hierarchy_init(&g->alternating, context, 1);
}

void mpmi_multigrid_free(mpmi_multigrid *g) {
  mpmi_hierarchy_free(&g->smooth, g->context);
  mpmi_hierarchy_free(&g->alternating, g->context);
  mpmi_free(g->context, g->scratch.memory, (size_t)g->scratch.capacity);
}

static mpm_status analyse(mpmi_multigrid *g, const mpmi_matrix *A) {
  g->analysed = g->alternating.levels = 0;
  mpm_status status = mpmi_hierarchy_analyse(&g->smooth, &g->scratch, A);
  if (!status && g->smooth.levels > 1 && A->row_start[A->rows] > FEW * A->rows)
    status = mpmi_hierarchy_analyse(&g->alternating, &g->scratch, A);
  if (status) return status;
  g->pattern_id = A->pattern_id;
  g->analysed = 1;
  return MPM_OK;
}

/* The values of a matrix may have any size, and single precision has little room. So the right-hand side
 * of a cycle is divided by its norm and by the largest scale. */
static void measure_scales(mpmi_multigrid *g) {
  const mpmi_smoother *s = &g->smooth.level[0].smoother;
  g->largest_scale = 0.0;
  for (int64_t i = 0; g->smooth.levels > 1 && i < s->rows * s->block; ++i)
    if (s->scale[i] > g->largest_scale) g->largest_scale = s->scale[i];
}

mpm_status mpmi_multigrid_prepare(mpmi_multigrid *g, const mpmi_matrix *A, int64_t *row) {
  mpm_status status = MPM_OK;
  *row = -1;
  if ((!g->analysed || g->pattern_id != A->pattern_id) && (status = analyse(g, A))) return status;
  status = mpmi_hierarchy_prepare(&g->smooth, &g->scratch, A, row);
  if (!status && g->alternating.levels) status = mpmi_hierarchy_prepare(&g->alternating, &g->scratch, A, row);
  measure_scales(g);
  return status;
}

/* ---- the cycle ----------------------------------------------------------------------------------------- */
typedef struct cycle_job {
  mpmi_multigrid *g;
  mpmi_hierarchy *of;
  const mpmi_level *fine, *coarse;
  const mpmi_coarsening *P; /* between the two */
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
  const mpmi_coarsening *P = job->P;
  const mpmi_smoother *s = &job->fine->smoother, *to = &job->coarse->smoother;
  const int32_t block = s->block, lanes = MPMI_PADDED(block);
  for (int64_t I = mpmi_range_begin(&job->ranges, k); I < mpmi_range_begin(&job->ranges, k + 1); ++I) {
    double sum[3] = {0.0, 0.0, 0.0};
    for (int64_t e = P->child_start[I]; e < P->child_start[I + 1]; ++e) {
      const int64_t i = P->child[e];
      const double weight = mpmi_parent_weight(P, job->fine->A, i);
      for (int32_t c = 0; c < block; ++c)
        sum[c] += weight * s->unscale[i * block + c] * (double)s->residual[i * lanes + c];
    }
    for (int32_t c = 0; c < block; ++c) {
      if (job->factored) {
        job->of->rhs[I * block + c] = job->coarse->A->held[I * block + c] ? 0.0 : sum[c];
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
  const mpmi_coarsening *P = job->P;
  const mpmi_smoother *s = &job->fine->smoother, *from = &job->coarse->smoother;
  const int32_t block = s->block, lanes = MPMI_PADDED(block);
  for (int64_t i = mpmi_range_begin(&job->ranges, k); i < mpmi_range_begin(&job->ranges, k + 1); ++i) {
    const double weight = mpmi_parent_weight(P, job->fine->A, i);
    double sum[3] = {0.0, 0.0, 0.0};
    for (int64_t e = P->parent_start[i]; e < P->parent_start[i + 1]; ++e) {
      const int64_t J = P->parent[e];
      for (int32_t c = 0; c < block; ++c)
        sum[c] += job->factored ? job->of->x[J * block + c]
                                : from->scale[J * block + c] * (double)from->x[J * lanes + c];
    }
    for (int32_t c = 0; c < block; ++c)
      s->x[i * lanes + c] += (float)(s->unscale[i * block + c] * weight * sum[c]);
  }
}

static mpm_status cycle(cycle_job job, mpmi_hierarchy *h, int32_t l);

/* What is left of the residual on a level is corrected by the next one. */
static mpm_status correct(cycle_job job, mpmi_hierarchy *h, int32_t l) {
  job.of = h;
  job.P = &h->level[l].next;
  job.coarse = &h->level[l + 1];
  job.factored = l + 2 == h->levels;
  mpm_status status = run_level(&job, job.coarse->A->rows, job.fine->A, restrict_task);
  if (status) return status;
  if (job.factored)
    mpmi_factor_solve(&h->coarsest, job.coarse->A, h->rhs, h->x);
  else if ((status = cycle(job, h, l + 1)))
    return status;
  return run_level(&job, job.fine->A->rows, job.fine->A, prolong_task);
}

/* Functions of both hierarchies hardly overlap, so that their corrections are added. */
static mpm_status cycle(cycle_job job, mpmi_hierarchy *h, int32_t l) {
  mpmi_multigrid *g = job.g;
  mpm_status status = MPM_OK;
  job.fine = &h->level[l];
  for (int32_t i = 0; i < SWEEPS && !status; ++i) status = sweep(&job, 0);
  job.first = 0;
  job.sweep = g->kernels->residual;
  if (!status) status = run_level(&job, job.fine->smoother.lines.count, job.fine->A, sweep_task);
  if (!status) status = correct(job, h, l);
  if (!status && !l && g->alternating.levels) status = correct(job, &g->alternating, l);
  for (int32_t i = 0; i < SWEEPS && !status; ++i) status = sweep(&job, 1);
  return status;
}

mpm_status mpmi_multigrid_cycle(mpmi_multigrid *g, const double *r, double *z) {
  const mpmi_matrix *A = g->smooth.level[0].A;
  double norm;
  mpm_status status = mpmi_norm(g->context, r, mpmi_matrix_unknowns(A), &norm);
  if (status) return status;
  if (g->smooth.levels == 1) {
    mpmi_factor_solve(&g->smooth.coarsest, A, r, z);
    return MPM_OK;
  }
  norm *= g->largest_scale;
  cycle_job job = {.g = g, .fine = &g->smooth.level[0], .r = r, .z = z, .by = norm > 0.0 ? 1.0 / norm : 0.0};
  if ((status = run_level(&job, A->rows, A, load_task)) || (status = cycle(job, &g->smooth, 0)))
    return status;
  job.by = norm;
  return run_level(&job, A->rows, A, store_task);
}
