/* Flexible GMRES with restarts keeps what the preconditioner made of each vector. So the preconditioner
 * need not be linear to the last digit, and a cycle in single precision is not. Two rounds of classical
 * Gram-Schmidt make the vectors orthogonal, with all sums of a round in one pass. */
#include <math.h>

#include "context/reduce.h"
#include "linalg/methods.h"
#include "simd/elementary.h"

enum { SLOW_CYCLES = 12 }; /* with `impatient`, the most cycles that may still be expected */

typedef struct gmres {
  mpmi_system *system;
  const mpmi_gmres_plan *plan;
  double *basis, *ready, *w;           /* [restart + 1][n]; [restart][n] M^-1 times the basis; [n] */
  double *hessenberg;                  /* [restart][restart + 1], by columns; triangular once rotated */
  double *cosine, *sine, *rest, *part; /* rest: right-hand side of the small system; part: sums by range */
  double scale;
  int32_t last;         /* how many vectors w is made orthogonal to */
  int32_t second_round; /* 0: the first round of Gram-Schmidt, 1: the second */
  mpmi_ranges ranges;
} gmres;

static double *vector(const gmres *g, int32_t j) {
  return g->basis + j * g->system->n;
}

/* Sums the products of w with the vectors. In the second round w first loses what the first round found. */
static void project_task(void *data, int64_t k) {
  const gmres *g = data;
  const int64_t begin = mpmi_range_begin(&g->ranges, k), end = mpmi_range_begin(&g->ranges, k + 1);
  const double *h = g->hessenberg + (g->last - 1) * (g->plan->restart + 1);
  double *part = g->part + k * (g->plan->restart + 1);
  if (g->second_round)
    for (int32_t j = 0; j < g->last; ++j) {
      const double *v = vector(g, j);
      for (int64_t i = begin; i < end; ++i) g->w[i] -= h[j] * v[i];
    }
  for (int32_t j = 0; j < g->last; ++j) {
    const double *v = vector(g, j);
    double sum = 0.0;
    for (int64_t i = begin; i < end; ++i) sum += g->w[i] * v[i];
    part[j] = sum;
  }
}

/* Takes from w what the second round found, which stands in `rest` beyond the vectors, and sums the square
 * of w. */
static void clean_task(void *data, int64_t k) {
  const gmres *g = data;
  const int64_t begin = mpmi_range_begin(&g->ranges, k), end = mpmi_range_begin(&g->ranges, k + 1);
  const double *h = g->rest + g->plan->restart + 1;
  double sum = 0.0;
  for (int32_t j = 0; j < g->last; ++j) {
    const double *v = vector(g, j);
    for (int64_t i = begin; i < end; ++i) g->w[i] -= h[j] * v[i];
  }
  for (int64_t i = begin; i < end; ++i) sum += g->w[i] * g->w[i];
  g->part[k * (g->plan->restart + 1)] = sum;
}

/* Makes the next vector: w times a scale. */
static void next_vector_task(void *data, int64_t k) {
  const gmres *g = data;
  double *v = vector(g, g->last);
  for (int64_t i = mpmi_range_begin(&g->ranges, k); i < mpmi_range_begin(&g->ranges, k + 1); ++i)
    v[i] = g->w[i] * g->scale;
}

/* Adds sum y_j M^-1 v_j to x; y is the second half of `rest`. */
static void combine_task(void *data, int64_t k) {
  const gmres *g = data;
  const int64_t begin = mpmi_range_begin(&g->ranges, k), end = mpmi_range_begin(&g->ranges, k + 1);
  const double *y = g->rest + g->plan->restart + 1;
  double *x = g->system->x;
  for (int32_t j = 0; j < g->last; ++j) {
    const double *z = g->ready + j * g->system->n;
    for (int64_t i = begin; i < end; ++i) x[i] += y[j] * z[i];
  }
}

static mpm_status run_gmres(gmres *g, mpm_task_fn task) {
  return mpmi_run_ranges(g->system->context, &g->ranges, task, g);
}

static double sum_of(const gmres *g, int32_t j) {
  return mpmi_reduce(MPMI_REDUCE_SUM, 0.0, g->part + j, g->plan->restart + 1, NULL, g->ranges.count);
}

/* Makes w = A M^-1 v_j orthogonal to v_0 ... v_j, which gives column j of the Hessenberg matrix. */
static mpm_status extend(gmres *g, int32_t j, double *h) {
  mpmi_system *s = g->system;
  double *correction = g->rest + g->plan->restart + 1;
  double *z = g->ready + j * s->n;
  mpm_status status = g->plan->precondition(g->plan->user, vector(g, j), z);
  if (!status) status = mpmi_matrix_apply(s->A, z, g->w);
  g->last = j + 1;
  g->second_round = 0;
  if (!status) status = run_gmres(g, project_task);
  if (status) return status;
  for (int32_t i = 0; i <= j; ++i) h[i] = sum_of(g, i);
  g->second_round = 1;
  if ((status = run_gmres(g, project_task))) return status;
  for (int32_t i = 0; i <= j; ++i) correction[i] = sum_of(g, i);
  if ((status = run_gmres(g, clean_task))) return status;
  for (int32_t i = 0; i <= j; ++i) h[i] += correction[i];
  h[j + 1] = sqrt(sum_of(g, 0));
  g->scale = h[j + 1] > 0.0 ? 1.0 / h[j + 1] : 0.0;
  return run_gmres(g, next_vector_task);
}

/* Rotates the new column so that the matrix stays triangular. Returns the norm of the residual that is
 * left. */
static double rotate(gmres *g, int32_t j, double *h) {
  for (int32_t i = 0; i < j; ++i) {
    const double upper = h[i];
    h[i] = g->cosine[i] * upper + g->sine[i] * h[i + 1];
    h[i + 1] = g->cosine[i] * h[i + 1] - g->sine[i] * upper;
  }
  const double length = mpmi_hypot(h[j], h[j + 1]);
  g->cosine[j] = length > 0.0 ? h[j] / length : 1.0;
  g->sine[j] = length > 0.0 ? h[j + 1] / length : 0.0;
  h[j] = length;
  g->rest[j + 1] = -g->sine[j] * g->rest[j];
  g->rest[j] *= g->cosine[j];
  return fabs(g->rest[j + 1]);
}

/* Adds to x the combination of `count` vectors M^-1 v that leaves the least residual. */
static mpm_status step(gmres *g, int32_t count) {
  const int32_t ld = g->plan->restart + 1;
  double *y = g->rest + ld;
  for (int32_t i = count - 1; i >= 0; --i) {
    double sum = g->rest[i];
    for (int32_t j = i + 1; j < count; ++j) sum -= g->hessenberg[j * ld + i] * y[j];
    const double pivot = g->hessenberg[i * ld + i];
    y[i] = pivot > 0.0 ? sum / pivot : 0.0; /* 0: the small system is singular in this direction */
  }
  g->last = count;
  return run_gmres(g, combine_task);
}

/* Starts from the residual in w, whose norm is s->reached, and ends when the basis is full or the residual
 * is as wanted. */
static mpm_status fill_basis(gmres *g) {
  mpmi_system *s = g->system;
  const int32_t ld = g->plan->restart + 1;
  g->last = 0;
  g->scale = 1.0 / s->reached;
  g->rest[0] = s->reached;
  mpm_status status = run_gmres(g, next_vector_task);
  int32_t j = 0;
  for (double left = s->reached; !status && left > s->wanted && j < g->plan->restart; ++j) {
    if (s->report->iterations >= g->plan->limit) break;
    double *h = g->hessenberg + j * ld;
    if ((status = extend(g, j, h))) return status;
    if (!isfinite(h[j + 1])) return MPM_NOT_CONVERGED;
    left = h[j + 1] > 0.0 ? rotate(g, j, h) : (rotate(g, j, h), 0.0);
    ++s->report->iterations;
  }
  return status ? status : step(g, j);
}

static mpm_status reserve_basis(gmres *g) {
  const int64_t ld = g->plan->restart + 1, n = g->system->n;
  const mpm_status status = mpmi_system_work(g->system, 2 * ld, ld * ld + 4 * ld + ld * MPMI_MOST_RANGES);
  if (status) return status;
  g->basis = g->system->solver->work;
  g->ready = g->basis + ld * n;
  g->w = g->ready + (ld - 1) * n;
  g->hessenberg = g->w + n;
  g->cosine = g->hessenberg + ld * ld;
  g->sine = g->cosine + ld;
  g->rest = g->sine + ld;
  g->part = g->rest + 2 * ld;
  return MPM_OK;
}

/* Tells whether further cycles are worth their time. */
static int32_t goes_on(const gmres *g, double before) {
  const double share = g->system->reached / before;
  if (!(share < 0.99) || g->system->report->iterations >= g->plan->limit) return 0;
  return !g->plan->impatient ||
         mpmi_ln(g->system->wanted / g->system->reached) / mpmi_ln(share) < (double)SLOW_CYCLES;
}

mpm_status mpmi_gmres(mpmi_system *s, const mpmi_gmres_plan *plan) {
  gmres g = {.system = s, .plan = plan, .ranges = mpmi_ranges_of(s->n, s->n)};
  mpm_status status = reserve_basis(&g);
  for (double before = (double)INFINITY; !status; before = s->reached) {
    int32_t good;
    if ((status = mpmi_matrix_residual(s->A, s->b, s->x, g.w, &s->reached))) break;
    if ((status = mpmi_system_good(s, s->reached, g.basis, &good)) || good) break;
    if (!isfinite(s->reached) || !goes_on(&g, before)) return MPM_NOT_CONVERGED;
    status = fill_basis(&g);
  }
  return status;
}
