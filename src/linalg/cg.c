/* Conjugate gradients with diagonal scaling: three passes over the vectors per iteration. */
#include <math.h>
#include <string.h>

#include "linalg/system.h"

typedef struct cg {
  mpmi_system *system;
  const double *inverse; /* of the diagonal */
  double *r, *p, *q;     /* residual, direction, A p */
  double alpha, beta;
  mpmi_cut cut;
  double rz[MPMI_MOST_CHUNKS], rr[MPMI_MOST_CHUNKS]; /* by chunk: r . D^-1 r and r . r */
} cg;

/* x += alpha p, r -= alpha q, and the sums of the new r. */
static void advance_task(void *data, int64_t k) {
  cg *c = data;
  double *x = c->system->x, *r = c->r, rz = 0.0, rr = 0.0;
  const double *p = c->p, *q = c->q, *inverse = c->inverse, alpha = c->alpha;
  for (int64_t i = mpmi_cut_begin(&c->cut, k); i < mpmi_cut_begin(&c->cut, k + 1); ++i) {
    x[i] += alpha * p[i];
    r[i] -= alpha * q[i];
    rr += r[i] * r[i];
    rz += r[i] * r[i] * inverse[i];
  }
  c->rz[k] = rz;
  c->rr[k] = rr;
}

/* p = D^-1 r + beta p */
static void turn_task(void *data, int64_t k) {
  const cg *c = data;
  double *p = c->p;
  const double *r = c->r, *inverse = c->inverse, beta = c->beta;
  for (int64_t i = mpmi_cut_begin(&c->cut, k); i < mpmi_cut_begin(&c->cut, k + 1); ++i)
    p[i] = inverse[i] * r[i] + beta * p[i];
}

static mpm_status run(cg *c, mpm_task_fn task) {
  return mpmi_cut_run(c->system->context, &c->cut, task, c);
}

/* r = b - A x with its sums, and the direction that it gives. */
static mpm_status start(cg *c, double *rz) {
  mpmi_system *s = c->system;
  mpm_status status = mpmi_matrix_residual(s->A, s->b, s->x, c->r, &s->reached);
  c->alpha = c->beta = 0.0;
  memset(c->p, 0, (size_t)s->n * sizeof *c->p);
  memset(c->q, 0, (size_t)s->n * sizeof *c->q);
  if (!status) status = run(c, advance_task);
  if (!status) status = run(c, turn_task);
  *rz = mpmi_sum_in_order(c->rz, c->cut.count);
  return status;
}

/* Iterates until the recursion's residual is as wanted or the limit is reached. */
static mpm_status iterate(cg *c, double rz, int64_t limit) {
  mpmi_system *s = c->system;
  double norm = s->reached;
  while (norm > s->wanted && s->report->iterations < limit) {
    double curvature;
    mpm_status status = mpmi_matrix_apply_dot(s->A, c->p, c->q, &curvature);
    if (status) return status;
    if (!isfinite(curvature) || !isfinite(rz)) return MPM_NOT_CONVERGED;
    if (!(curvature > 0.0)) return MPM_SINGULAR;
    c->alpha = rz / curvature;
    if ((status = run(c, advance_task))) return status;
    const double next = mpmi_sum_in_order(c->rz, c->cut.count);
    norm = sqrt(mpmi_sum_in_order(c->rr, c->cut.count));
    c->beta = next / rz;
    rz = next;
    ++s->report->iterations;
    if (norm > s->wanted && (status = run(c, turn_task))) return status;
  }
  return MPM_OK;
}

/* The recursion drifts from the true residual: where that is not as wanted yet, the iteration starts again
 * from it, as long as this helps. */
mpm_status mpmi_cg(mpmi_system *s, int64_t limit) {
  mpm_status status = mpmi_system_work(s, 3, 0);
  if (status) return status;
  cg c = {.system = s, .inverse = s->solver->diagonal, .cut = mpmi_cut_of(s->n, s->n)};
  c.r = s->solver->work;
  c.p = c.r + s->n;
  c.q = c.p + s->n;
  double before = (double)INFINITY;
  for (;;) {
    double rz;
    if ((status = start(&c, &rz))) return status;
    int32_t good;
    if ((status = mpmi_system_good(s, s->reached, c.q, &good)) || good) return status;
    if (!(s->reached < 0.5 * before) || s->report->iterations >= limit) return MPM_NOT_CONVERGED;
    before = s->reached;
    if ((status = iterate(&c, rz, limit))) return status;
  }
}
