/* Backward Euler: (C + dt K) dT = dt (Q - K T) for the increments of the free nodes, by conjugate gradients
 * that are scaled with the diagonal. K is never stored: particles conduct once for each iteration, so that
 * nodes that come and go cost nothing.
 *
 * Of several parts each has the rows of all nodes that it has, with the same bits, and counts those that it
 * owns. Products are exact sums of their terms, so that neither tasks nor parts make a difference. */
#include "heat/heat.h"
#include "context/transport.h"
#include "layout/tasks.h"
#include "parallel/parts.h"

#include <math.h>
#include <string.h>

/* Vectors of the rows. */
enum { X, R, P, Q, CAPACITY, SCALE, VECTORS };

static double *vector(const mpmi_heat *heat, int32_t which) {
  return heat->vector + which * heat->rows;
}

static const mpmi_tie *tie_at(const mpmi_heat *heat, int64_t slot) {
  const int32_t tie = heat->ties.tie_of[slot];
  return tie < 0 ? NULL : &heat->ties.tie[tie];
}

/* Returns the sum over the nodes of a row of a value of the nodes or of the flow; turns: with their signs. */
static double fold(const mpmi_heat *heat, int64_t row, const mpmi_nodal *from, int32_t value, int32_t turns) {
  const mpmi_tie *tie = tie_at(heat, heat->row[row]);
  double sum = mpmi_nodal_at(from, heat->row[row])[value];
  for (int64_t i = tie ? tie->first : 0; tie && i < tie->first + tie->count; ++i) {
    const mpmi_follower *f = &heat->ties.follower[i];
    sum += (turns ? mpmi_heat_sign(f) : 1.0) * mpmi_nodal_at(from, f->slot)[value];
  }
  return sum;
}

/* Returns 1 where this part counts a row. */
static int32_t owns(const mpmi_heat_job *job, int64_t row) {
  return mpmi_owns_node(job->step->layout->parts, job->heat->row[row]);
}

/* All parts learn whether all have come so far; who only knows of it from a partner has nothing to tell. */
static mpm_status agree(const mpmi_heat_job *job, mpm_status status) {
  const mpmi_parts *parts = job->step->layout->parts;
  return parts ? mpmi_agree(parts->context, parts->is_echo ? MPM_OK : status) : status;
}

static mpm_status list_rows(const mpmi_heat_job *job) {
  mpmi_heat *heat = job->heat;
  mpm_context *c = job->step->settings->context;
  const int64_t slots = mpmi_slots(job->step->layout);
  mpm_status status;
  if ((status = MPMI_RESERVE_MORE(c, heat->row, heat->row_capacity, slots)) ||
      (status = MPMI_RESERVE_MORE(c, heat->start, heat->start_capacity, slots)) ||
      (status = MPMI_RESERVE_MORE(c, heat->product, heat->product_capacity, job->step->settings->tasks)))
    return status;
  heat->rows = 0;
  for (int64_t slot = 0; slot < slots; ++slot) {
    const mpmi_tie *tie = tie_at(heat, slot);
    heat->start[slot] = mpmi_heat_node(heat, slot)[MPMI_HEAT_TEMPERATURE];
    if (tie && (tie->master != slot || mpmi_heat_face(job, tie) >= 0)) continue;
    heat->row[heat->rows] = slot;
    if (fold(heat, heat->rows, &heat->nodes, MPMI_HEAT_CAPACITY, 0) > 0.0) ++heat->rows;
  }
  /* Vectors have a place in memory also where faces hold all nodes and no row is left. */
  return MPMI_RESERVE_MORE(c, heat->vector, heat->vector_capacity, VECTORS * (heat->rows + 1));
}

/* Puts values by row on a value of the nodes or of the flow, and 0 on all other nodes. */
static void spread(const mpmi_heat_job *job, const double *value, const mpmi_nodal *to, int32_t which) {
  const mpmi_heat *heat = job->heat;
  const int64_t slots = mpmi_slots(job->step->layout);
  for (int64_t slot = 0; slot < slots; ++slot) mpmi_nodal_at(to, slot)[which] = 0.0;
  for (int64_t row = 0; row < heat->rows; ++row) {
    const mpmi_tie *tie = tie_at(heat, heat->row[row]);
    mpmi_nodal_at(to, heat->row[row])[which] = value[row];
    for (int64_t i = tie ? tie->first : 0; tie && i < tie->first + tie->count; ++i) {
      const mpmi_follower *f = &heat->ties.follower[i];
      mpmi_nodal_at(to, f->slot)[which] = mpmi_heat_sign(f) * value[row];
    }
  }
}

/* ---- products ------------------------------------------------------------------------------------------ */
typedef struct dot_job {
  const mpmi_heat_job *of;
  const double *a, *b;
} dot_job;

static void dot_task(void *data, int64_t task) {
  const dot_job *job = data;
  const mpmi_share share = mpmi_share_of(job->of->step->settings, job->of->heat->rows, task);
  mpmi_whole_sum *sum = &job->of->heat->product[task];
  mpmi_exact_clear(sum);
  for (int64_t row = share.begin; row < share.end; ++row)
    if (owns(job->of, row)) mpmi_exact_add(sum, job->a[row] * job->b[row]);
}

static mpm_status dot(const mpmi_heat_job *job, int32_t a, int32_t b, double *out) {
  const mpmi_settings *settings = job->step->settings;
  dot_job products = {job, vector(job->heat, a), vector(job->heat, b)};
  mpmi_whole_sum sum;
  mpmi_exact_clear(&sum);
  mpmi_parallel_for_sure(settings->context, settings->tasks, dot_task, &products);
  for (int32_t k = 0; k < settings->tasks; ++k) mpmi_exact_join(&sum, &job->heat->product[k]);
  return mpmi_total_parts(settings->context, 1, &sum, out);
}

/* Counts the rows of all parts. */
static mpm_status count_rows(const mpmi_heat_job *job, int64_t *rows) {
  *rows = 0;
  for (int64_t row = 0; row < job->heat->rows; ++row) *rows += owns(job, row);
  return mpmi_reduce_parts(job->step->settings->context, MPM_REDUCE_SUM, 1, rows);
}

/* ---- the method ---------------------------------------------------------------------------------------- */
/* Sets q = (C + dt K) p. */
static mpm_status apply(const mpmi_heat_job *job) {
  const mpmi_heat *heat = job->heat;
  const double *p = vector(heat, P), *capacity = vector(heat, CAPACITY);
  double *q = vector(heat, Q);
  spread(job, p, &heat->nodes, MPMI_HEAT_TEMPERATURE);
  mpm_status status = agree(job, mpmi_heat_conduct(job, 0));
  if (!status) status = mpmi_heat_films(job);
  if (status) return status;
  for (int64_t row = 0; row < heat->rows; ++row)
    q[row] = capacity[row] * p[row] + job->step->dt * fold(heat, row, &heat->flow, MPMI_HEAT_OUTFLOW, 1);
  return MPM_OK;
}

/* Starts from no increment, with what flows now. */
static void begin(const mpmi_heat_job *job) {
  const mpmi_heat *heat = job->heat;
  const double dt = job->step->dt;
  for (int64_t row = 0; row < heat->rows; ++row) {
    const double capacity = fold(heat, row, &heat->nodes, MPMI_HEAT_CAPACITY, 0);
    vector(heat, X)[row] = 0.0;
    vector(heat, CAPACITY)[row] = capacity;
    vector(heat, SCALE)[row] = 1.0 / (capacity + dt * fold(heat, row, &heat->flow, MPMI_HEAT_DIAGONAL, 0));
    vector(heat, R)[row] = dt * (fold(heat, row, &heat->nodes, MPMI_HEAT_POWER, 1) -
                                 fold(heat, row, &heat->flow, MPMI_HEAT_OUTFLOW, 1));
    vector(heat, P)[row] = 0.0;
  }
}

/* Sets p = r / diagonal + beta p. */
static void turn(const mpmi_heat *heat, double beta) {
  double *p = vector(heat, P);
  for (int64_t row = 0; row < heat->rows; ++row)
    p[row] = vector(heat, SCALE)[row] * vector(heat, R)[row] + beta * p[row];
}

/* Finds r . r / diagonal, with q as scratch. */
static mpm_status weigh(const mpmi_heat_job *job, double *rz) {
  const mpmi_heat *heat = job->heat;
  double *q = vector(heat, Q);
  for (int64_t row = 0; row < heat->rows; ++row) q[row] = vector(heat, SCALE)[row] * vector(heat, R)[row];
  return dot(job, R, Q, rz);
}

static mpm_status iterate(const mpmi_heat_job *job) {
  mpmi_heat *heat = job->heat;
  mpm_context *c = job->step->settings->context;
  const double tolerance = job->step->settings->heat.tolerance;
  int64_t rows;
  double rz, first, curvature, next;
  mpm_status status = count_rows(job, &rows);
  if (!status) status = weigh(job, &rz);
  if (!status && !isfinite(rz))
    return mpmi_fail(c, MPM_NONFINITE,
                     "what flows between nodes is not finite in the step from t = %g with dt = %g: "
                     "temperatures are too large",
                     job->step->t, job->step->dt);
  first = rz;
  turn(heat, 0.0);
  while (!status && rz > tolerance * tolerance * first) {
    if ((status = apply(job)) || (status = dot(job, P, Q, &curvature))) return status;
    if (!(curvature > 0.0) || heat->iterations > 10 * rows + 100)
      return mpmi_fail(
          c, MPM_NOT_CONVERGED,
          "implicit conduction did not converge in %lld iterations in the step from t = %g with dt = "
          "%g: take a larger tolerance, or a shorter step",
          (long long)heat->iterations, job->step->t, job->step->dt);
    const double alpha = rz / curvature;
    for (int64_t row = 0; row < heat->rows; ++row) {
      vector(heat, X)[row] += alpha * vector(heat, P)[row];
      vector(heat, R)[row] -= alpha * vector(heat, Q)[row];
    }
    if ((status = weigh(job, &next))) return status;
    turn(heat, next / rz);
    rz = next;
    ++heat->iterations;
  }
  return status;
}

mpm_status mpmi_heat_solve(const mpmi_heat_job *job) {
  mpmi_heat *heat = job->heat;
  const int64_t slots = mpmi_slots(job->step->layout);
  mpm_status status = agree(job, list_rows(job));
  if (status) return status;
  begin(job);
  if ((status = iterate(job))) return status;
  spread(job, vector(heat, X), &heat->nodes, MPMI_HEAT_TEMPERATURE);
  for (int64_t slot = 0; slot < slots; ++slot)
    mpmi_heat_node(heat, slot)[MPMI_HEAT_TEMPERATURE] += heat->start[slot];
  if ((status = agree(job, mpmi_heat_conduct(job, 0))) || (status = mpmi_heat_films(job))) return status;
  spread(job, vector(heat, X), &heat->flow, MPMI_HEAT_INCREMENT);
  return MPM_OK;
}
