/* The method of conjugate gradients scales with the diagonal, or takes the preconditioner of the caller. */
#include <math.h>
#include <string.h>

#include "context/reduce.h"
#include "linalg/methods.h"

typedef struct cg {
  mpmi_system *system;
  mpmi_precondition_fn precondition; /* NULL: the passes over the vectors scale with the diagonal */
  void *user;
  const double *inverse; /* of the diagonal */
  double *r, *p, *q;     /* residual, direction, A p */
  double *z;             /* M^-1 r of a preconditioner */
  double alpha, beta;
  mpmi_ranges ranges;
  mpm_status status; /* of the passes since the last sum, where all parts learn of it */
  double rz[MPMI_MOST_RANGES], rr[MPMI_MOST_RANGES]; /* by range: r . D^-1 r and r . r */
  double norm;                                       /* of r */
} cg;

/* With several parts a product needs the values of rows that others own. */
static mpm_status complete(const cg *c, double *x) {
  const mpmi_rows *shared = c->system->A->shared;
  return shared ? mpmi_rows_complete(shared, x) : MPM_OK;
}

/* Sets x += alpha p and r -= alpha q, and sums over the new r. */
static void advance_task(void *data, int64_t k) {
  cg *c = data;
  double *x = c->system->x, *r = c->r, rz = 0.0, rr = 0.0;
  const double *p = c->p, *q = c->q, *inverse = c->inverse, alpha = c->alpha;
  for (int64_t i = mpmi_range_begin(&c->ranges, k); i < mpmi_range_begin(&c->ranges, k + 1); ++i) {
    x[i] += alpha * p[i];
    r[i] -= alpha * q[i];
    rr += r[i] * r[i];
    if (inverse) rz += r[i] * (inverse[i] * r[i]);
  }
  c->rz[k] = rz;
  c->rr[k] = rr;
}

/* Sets p = M^-1 r + beta p. */
static void turn_task(void *data, int64_t k) {
  const cg *c = data;
  double *p = c->p;
  const double *r = c->r, *z = c->z, *inverse = c->inverse, beta = c->beta;
  for (int64_t i = mpmi_range_begin(&c->ranges, k); i < mpmi_range_begin(&c->ranges, k + 1); ++i)
    p[i] = (inverse ? inverse[i] * r[i] : z[i]) + beta * p[i];
}

/* A pass that fails on one part ends none of the exchanges that the others wait for. */
static void run_cg(cg *c, mpm_task_fn task) {
  if (!c->status) c->status = mpmi_run_ranges(c->system->context, &c->ranges, task, c);
}

/* Makes r . D^-1 r, and the norm of r; returns how the passes before have gone, on all parts. */
static mpm_status sum_up(cg *c, double *rz) {
  const mpmi_rows *shared = c->system->A->shared;
  double sum[2];
  if (shared) {
    const mpmi_row_terms terms[2] = {{c->r, c->r, c->inverse}, {c->r, c->r, NULL}};
    const mpm_status status = mpmi_rows_sum(shared, MPMI_BY_UNKNOWNS, 2, terms, sum, c->status);
    if (status) return status;
  } else {
    if (c->status) return c->status;
    sum[0] = mpmi_reduce(MPMI_REDUCE_SUM, 0.0, c->rz, 1, NULL, c->ranges.count);
    sum[1] = mpmi_reduce(MPMI_REDUCE_SUM, 0.0, c->rr, 1, NULL, c->ranges.count);
  }
  *rz = sum[0];
  c->norm = sqrt(sum[1]);
  return MPM_OK;
}

/* Advances x and r, and then forms z = M^-1 r and r . z. */
static mpm_status advance(cg *c, double *rz) {
  run_cg(c, advance_task);
  mpm_status status = sum_up(c, rz);
  if (status) return status;
  if (!c->precondition) return MPM_OK;
  status = c->precondition(c->user, c->r, c->z);
  return status ? status : mpmi_dot(c->system->context, c->r, c->z, c->system->n, rz);
}

/* Starts from r = b - A x, with its sums and the direction that it gives. */
static mpm_status start(cg *c, double *rz) {
  mpmi_system *s = c->system;
  mpm_status status = complete(c, s->x);
  if (s->A->shared) memset(c->r, 0, (size_t)s->n * sizeof *c->r); /* only own rows are written */
  if (!status) status = mpmi_matrix_residual(s->A, s->b, s->x, c->r, &s->reached);
  c->alpha = c->beta = 0.0;
  memset(c->p, 0, (size_t)s->n * sizeof *c->p);
  memset(c->q, 0, (size_t)s->n * sizeof *c->q);
  if (!status) status = advance(c, rz);
  if (!status) run_cg(c, turn_task);
  return status;
}

/* Iterates until the recursion's residual is as wanted or the limit is reached. */
static mpm_status iterate(cg *c, double rz, int64_t limit) {
  mpmi_system *s = c->system;
  double norm = s->reached;
  while (norm > s->wanted && s->report->iterations < limit) {
    double curvature;
    mpm_status status = complete(c, c->p);
    if (!status) status = mpmi_matrix_apply_dot(s->A, c->p, c->q, &curvature, c->status);
    if (status) return status;
    if (!isfinite(curvature) || !isfinite(rz)) return MPM_NOT_CONVERGED;
    if (!(curvature > 0.0) || !(rz > 0.0)) return MPM_SINGULAR;
    c->alpha = rz / curvature;
    double next;
    if ((status = advance(c, &next))) return status;
    norm = c->norm;
    c->beta = next / rz;
    rz = next;
    ++s->report->iterations;
    if (norm > s->wanted) run_cg(c, turn_task);
  }
  return MPM_OK;
}

/* The residual of the recursion drifts away from the true one. Where the true one is not as wanted yet,
 * the iteration starts again from it, as long as this helps. */
mpm_status mpmi_cg(mpmi_system *s, mpmi_precondition_fn precondition, void *user, int64_t limit) {
  /* one number more, so that the vectors exist without rows */
  mpm_status status = s->room ? MPM_OK : mpmi_system_work(s, precondition ? 4 : 3, 1);
  if ((status = mpmi_system_together(s, status))) return status;
  cg c = {.system = s, .precondition = precondition, .user = user, .ranges = mpmi_ranges_of(s->n, s->n)};
  c.inverse = precondition ? NULL : s->solver->diagonal;
  c.r = s->room ? s->room : s->solver->work;
  c.p = c.r + s->n;
  c.q = c.p + s->n;
  c.z = precondition ? c.q + s->n : NULL;
  double before = (double)INFINITY;
  for (;;) {
    double rz;
    if ((status = start(&c, &rz))) return status;
    int32_t good;
    if ((status = mpmi_system_good(s, s->reached, c.q, &good)) ||
        (status = mpmi_system_together(s, c.status)) || good)
      return status;
    if (!(s->reached < 0.5 * before) || s->report->iterations >= limit) return MPM_NOT_CONVERGED;
    before = s->reached;
    if ((status = iterate(&c, rz, limit))) return status;
  }
}
