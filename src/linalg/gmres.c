/* Flexible GMRES with restarts keeps what the preconditioner made of each vector. So the preconditioner
 * need not be linear to the last digit, and a cycle in single precision is not. Two rounds of classical
 * Gram-Schmidt make the vectors orthogonal, with all sums of a round in one pass. */
#include <math.h>
#include <string.h>

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
  mpm_status status;    /* of the passes since the last sum, where all parts learn of it */
  int32_t last;         /* how many vectors w is made orthogonal to */
  int32_t second_round; /* 0: the first round of Gram-Schmidt, 1: the second */
  mpmi_ranges ranges;
} gmres;

static double *vector(const gmres *g, int32_t j) {
  return g->basis + j * g->system->n;
}

/* Sums the products of w with the vectors. In the second round w first loses what the first round found. Of
 * several parts the sums come later (take_sums). */
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
  for (int32_t j = 0; j < g->last && !g->system->A->shared; ++j) {
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

/* A pass that fails on one part ends none of the exchanges that the others wait for. */
static void run_gmres(gmres *g, mpm_task_fn task) {
  if (!g->status) g->status = mpmi_run_ranges(g->system->context, &g->ranges, task, g);
}

static double sum_of(const gmres *g, int32_t j) {
  return mpmi_reduce(MPMI_REDUCE_SUM, 0.0, g->part + j, g->plan->restart + 1, NULL, g->ranges.count);
}

/* Makes the first `count` sums of a pass: the products of w with the vectors, or the square of w. Returns how
 * the passes before have gone, on all parts. */
static mpm_status take_sums(gmres *g, int32_t count, int32_t square, double *to) {
  const mpmi_rows *shared = g->system->A->shared;
  mpm_status status = shared ? MPM_OK : g->status;
  for (int32_t i = 0; i < count && !shared && !status; ++i) to[i] = sum_of(g, i);
  for (int32_t first = 0; first < count && shared && !status; first += MPMI_ROW_SUMS) {
    const int32_t more = count - first, n = more < MPMI_ROW_SUMS ? more : MPMI_ROW_SUMS;
    mpmi_row_terms terms[MPMI_ROW_SUMS];
    for (int32_t i = 0; i < n; ++i)
      terms[i] = (mpmi_row_terms){g->w, square ? g->w : vector(g, first + i), NULL};
    status = mpmi_rows_sum(shared, MPMI_BY_UNKNOWNS, n, terms, to + first, g->status);
  }
  return status;
}

/* Makes z = M^-1 v and w = A z. With several parts the product needs the values of rows that others own. */
static mpm_status multiply(gmres *g, const double *v, double *z) {
  const mpmi_matrix *A = g->system->A;
  if (g->plan->together) g->status = mpmi_system_together(g->system, g->status);
  if (!g->status) g->status = g->plan->precondition(g->plan->user, v, z);
  const mpm_status lost = A->shared ? mpmi_rows_complete(A->shared, z) : MPM_OK;
  if (!g->status && !lost) g->status = mpmi_matrix_apply(A, z, g->w);
  return lost;
}

/* Makes w = A M^-1 v_j orthogonal to v_0 ... v_j, which gives column j of the Hessenberg matrix. */
static mpm_status extend(gmres *g, int32_t j, double *h) {
  double *correction = g->rest + g->plan->restart + 1;
  mpm_status status = multiply(g, vector(g, j), g->ready + j * g->system->n);
  g->last = j + 1;
  g->second_round = 0;
  run_gmres(g, project_task);
  if (status || (status = take_sums(g, j + 1, 0, h))) return status;
  g->second_round = 1;
  run_gmres(g, project_task);
  if ((status = take_sums(g, j + 1, 0, correction))) return status;
  run_gmres(g, clean_task);
  for (int32_t i = 0; i <= j; ++i) h[i] += correction[i];
  if ((status = take_sums(g, 1, 1, &h[j + 1]))) return status;
  h[j + 1] = sqrt(h[j + 1]);
  g->scale = h[j + 1] > 0.0 ? 1.0 / h[j + 1] : 0.0;
  run_gmres(g, next_vector_task);
  return MPM_OK;
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
static void step(gmres *g, int32_t count) {
  const int32_t ld = g->plan->restart + 1;
  double *y = g->rest + ld;
  for (int32_t i = count - 1; i >= 0; --i) {
    double sum = g->rest[i];
    for (int32_t j = i + 1; j < count; ++j) sum -= g->hessenberg[j * ld + i] * y[j];
    const double pivot = g->hessenberg[i * ld + i];
    y[i] = pivot > 0.0 ? sum / pivot : 0.0; /* 0: the small system is singular in this direction */
  }
  g->last = count;
  run_gmres(g, combine_task);
}

/* Starts from the residual in w, whose norm is s->reached, and ends when the basis is full or the residual
 * is as wanted. */
static mpm_status fill_basis(gmres *g) {
  mpmi_system *s = g->system;
  const int32_t ld = g->plan->restart + 1;
  g->last = 0;
  g->scale = 1.0 / s->reached;
  g->rest[0] = s->reached;
  run_gmres(g, next_vector_task);
  int32_t j = 0;
  for (double left = s->reached; left > s->wanted && j < g->plan->restart; ++j) {
    if (s->report->iterations >= g->plan->limit) break;
    double *h = g->hessenberg + j * ld;
    const mpm_status status = extend(g, j, h);
    if (status) return status;
    if (!isfinite(h[j + 1])) return MPM_NOT_CONVERGED;
    left = h[j + 1] > 0.0 ? rotate(g, j, h) : (rotate(g, j, h), 0.0);
    ++s->report->iterations;
  }
  step(g, j);
  return mpmi_system_together(s, g->status);
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

/* Finds the residual of x as it is. With several parts only own rows of w are written, and all of it is
 * scaled. */
static mpm_status take_residual(gmres *g) {
  mpmi_system *s = g->system;
  mpm_status status = MPM_OK;
  if (s->A->shared) {
    status = mpmi_rows_complete(s->A->shared, s->x);
    memset(g->w, 0, (size_t)s->n * sizeof *g->w);
  }
  return status ? status : mpmi_matrix_residual(s->A, s->b, s->x, g->w, &s->reached);
}

mpm_status mpmi_gmres(mpmi_system *s, const mpmi_gmres_plan *plan) {
  gmres g = {.system = s, .plan = plan, .ranges = mpmi_ranges_of(s->n, s->n)};
  mpm_status status = mpmi_system_together(s, reserve_basis(&g));
  for (double before = (double)INFINITY; !status; before = s->reached) {
    int32_t good;
    if ((status = take_residual(&g))) break;
    if ((status = mpmi_system_good(s, s->reached, g.basis, &good)) || good) break;
    if (!isfinite(s->reached) || !goes_on(&g, before)) return MPM_NOT_CONVERGED;
    status = fill_basis(&g);
  }
  return status;
}
