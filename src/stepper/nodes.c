/* Nodal velocities: v = p / m, a = f / m, v~ = v + dt a (MPoint theory eqs 30-32), on every node as if it
 * were free. Nodes lighter than the cut stay at rest: dividing by their mass would only make noise. */
#include "stepper/stepper.h"

typedef struct nodes_job {
  mpm_stepper *s;
  int32_t values;
  double dt, *nodes;
} nodes_job;

static void nodes_task(void *data, int64_t k) {
  const nodes_job *job = data;
  const mpm_stepper *s = job->s;
  const int64_t slots = s->blocks.count * s->blocks.nodes, tasks = s->tasks;
  const double cut = s->mass_cut, dt = job->dt;
  for (int64_t i = slots * k / tasks; i < slots * (k + 1) / tasks; ++i) {
    double *node = job->nodes + i * job->values;
    const double mass = node[3], inverse = mass > cut ? 1.0 / mass : 0.0;
    for (int32_t c = 0; c < 3; ++c) node[c] *= inverse;
    if (job->values == 4) continue;
    for (int32_t c = 0; c < 3; ++c) {
      const double dv = dt * node[4 + c] * inverse;
      node[c] += dv;
      node[4 + c] = dv;
    }
  }
}

mpm_status mpmi_stage_nodes(mpm_stepper *s, int32_t what, double dt) {
  nodes_job job = {s, what == MPMI_P2G_AGAIN ? 4 : s->values, dt,
                   what == MPMI_P2G_AGAIN ? s->again : s->node};
  return mpmi_run_tasks(s, 0, s->tasks, nodes_task, &job);
}
