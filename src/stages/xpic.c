/* XPIC(m) (Hammerquist & Nairn 2017): with S the interpolation to particles and S+ the mass-weighted
 * projection to nodes, the new velocity is  (I - (I - S S+)^m) v_p + dt S a.  Expanded, its first part is S
 * v^ with
 *
 *   v^ = m sum_r (-1)^(r+1) v_r,   v_1 = v_i,   v_r = (m - r + 1) / r S+ S v_r-1
 *
 * PIC has S v_i in its place (m = 1). What is gathered at the end of a step is S (v_i + dt a), so that S (v^
 * - v_i) remains: it is made here. The terms obey the boundary conditions that are linear: walls and images.
 */
#include "stages/stages.h"
#include "boundary/boundary.h"
#include "layout/tasks.h"

typedef struct xpic_job {
  const mpmi_step *step;
  const mpmi_nodes *nodes;
  double scale, share; /* scale of the term; its share of the sum */
} xpic_job;

/* Makes the first term, the velocities before the forces, and what the sum has of it. */
static void first_term(void *data, int64_t k) {
  const xpic_job *job = data;
  const mpmi_nodes *nodes = job->nodes;
  const mpmi_share share = mpmi_share_of(job->step->settings, mpmi_slots(job->step->layout), k);
  for (int64_t i = share.begin; i < share.end; ++i) {
    const double mass = *mpmi_mass(&nodes->solved, i);
    *mpmi_mass(&nodes->projected, i) = mass;
    *mpmi_mass(&nodes->sums, i) = job->share * mass;
    for (int32_t c = 0; c < 3; ++c) {
      const double v = mpmi_velocity(&nodes->solved, i)[c] - mpmi_increment(&nodes->solved, i)[c];
      mpmi_velocity(&nodes->projected, i)[c] = v;
      mpmi_velocity(&nodes->sums, i)[c] = job->share * v;
    }
  }
}

/* Scales the term that was projected, and adds what the sum has of it. */
static void next_term(void *data, int64_t k) {
  const xpic_job *job = data;
  const mpmi_nodes *nodes = job->nodes;
  const mpmi_share share = mpmi_share_of(job->step->settings, mpmi_slots(job->step->layout), k);
  for (int64_t i = share.begin; i < share.end; ++i) {
    double *term = mpmi_velocity(&nodes->projected, i), *sum = mpmi_velocity(&nodes->sums, i);
    for (int32_t c = 0; c < 3; ++c) {
      term[c] *= job->scale;
      sum[c] += job->share * term[c];
    }
  }
}

/* Returns the weight with which a velocity added to v_r enters v^: directly, and through the later terms that
 * are made from v_r. */
static double share_of(int32_t m, int32_t r) {
  double share = 0.0;
  for (int32_t k = m; k >= r; --k) share = (k % 2 ? m : -m) + (m - k) / (k + 1.0) * share;
  return share;
}

mpm_status mpmi_xpic_stage(mpmi_step *step, mpmi_nodes *nodes) {
  const mpmi_settings *settings = step->settings;
  const mpmi_projection *correction = &mpmi_projections[MPMI_PROJECT_CORRECTION];
  const int32_t m = settings->desc.xpic_order;
  xpic_job job = {step, nodes, 1.0, m - 1.0};
  mpm_status status = mpmi_run_tasks(settings, 0, settings->tasks, first_term, &job);
  for (int32_t r = 2; r <= m && !status; ++r) {
    job = (xpic_job){step, nodes, (m - r + 1.0) / r, r % 2 ? m : -m};
    status = mpmi_g2p_velocities(step, nodes, &nodes->projected);
    if (!status) status = mpmi_p2g_stage(step, correction, nodes);
    if (!status) status = mpmi_node_update_stage(step, correction, nodes);
    if (!status) status = mpmi_boundary_stage(step, correction, nodes, job.scale * share_of(m, r));
    if (!status) status = mpmi_run_tasks(settings, 0, settings->tasks, next_term, &job);
  }
  return status ? status : mpmi_g2p_velocities(step, nodes, &nodes->sums);
}
