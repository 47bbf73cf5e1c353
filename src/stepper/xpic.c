/* XPIC(m) (Hammerquist & Nairn 2017): with S the interpolation to particles and S+ the mass-weighted
 * projection to nodes, the new velocity is  (I - (I - S S+)^m) v_p + dt S a.  Expanded, its first part is S
 * v^ with
 *
 *   v^ = m sum_r (-1)^(r+1) v_r,   v_1 = v_i,   v_r = (m - r + 1) / r S+ S v_r-1
 *
 * PIC has S v_i in its place (m = 1). What is gathered at the end of a step is S (v_i + dt a), so that S (v^
 * - v_i) remains: it is made here. The terms obey the boundary conditions that are linear: walls and images.
 */
#include "stepper/stepper.h"

typedef struct xpic_job {
  mpm_stepper *s;
  double scale, share; /* of the term, and of it in the sum */
} xpic_job;

/* Share of a task in all nodes. */
static void nodes_of_task(const mpm_stepper *s, int64_t k, int64_t *begin, int64_t *end) {
  const int64_t slots = s->blocks.count * s->blocks.nodes;
  *begin = slots * k / s->tasks;
  *end = slots * (k + 1) / s->tasks;
}

/* The first term, the velocities before the forces, and what the sum has of it. */
static void first_term(void *data, int64_t k) {
  const xpic_job *job = data;
  const mpm_stepper *s = job->s;
  int64_t begin, end;
  nodes_of_task(s, k, &begin, &end);
  for (int64_t i = begin; i < end; ++i)
    for (int32_t c = 0; c < 4; ++c) {
      const double *node = s->node + 8 * i;
      const double v = c < 3 ? node[c] - node[4 + c] : node[3];
      s->again[4 * i + c] = v;
      s->extra[4 * i + c] = job->share * v;
    }
}

static void next_term(void *data, int64_t k) {
  const xpic_job *job = data;
  const mpm_stepper *s = job->s;
  int64_t begin, end;
  nodes_of_task(s, k, &begin, &end);
  for (int64_t i = begin; i < end; ++i)
    for (int32_t c = 0; c < 3; ++c) {
      s->again[4 * i + c] *= job->scale;
      s->extra[4 * i + c] += job->share * s->again[4 * i + c];
    }
}

/* How much of a velocity that is added to v_r comes to be in v^: by way of the terms after it too. */
static double share_of(int32_t m, int32_t r) {
  double share = 0.0;
  for (int32_t k = m; k >= r; --k) share = (k % 2 ? m : -m) + (m - k) / (k + 1.0) * share;
  return share;
}

mpm_status mpmi_stage_xpic(mpm_stepper *s) {
  const int32_t m = s->desc.xpic_order;
  xpic_job job = {s, 1.0, m - 1.0};
  mpm_status status = mpmi_run_tasks(s, 0, s->tasks, first_term, &job);
  for (int32_t r = 2; r <= m && !status; ++r) {
    job = (xpic_job){s, (m - r + 1.0) / r, r % 2 ? m : -m};
    status = mpmi_stage_g2p(s, MPMI_G2P_PROBE, s->again, 4, s->dt);
    if (!status) status = mpmi_stage_p2g(s, MPMI_PROJECT_CORRECT);
    if (!status) status = mpmi_stage_nodes(s, MPMI_PROJECT_CORRECT);
    if (!status) status = mpmi_stage_boundary(s, MPMI_PROJECT_CORRECT, s->dt, job.scale * share_of(m, r));
    if (!status) status = mpmi_run_tasks(s, 0, s->tasks, next_term, &job);
  }
  return status ? status : mpmi_stage_g2p(s, MPMI_G2P_PROBE, s->extra, 4, s->dt);
}
