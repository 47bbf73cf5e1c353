/* The grid's own part of a step, on every node as if it were free: transfer/update.c. */
#include "stepper/stepper.h"

#include <string.h>

typedef struct nodes_job {
  mpm_stepper *s;
  int32_t values, books, asks;
  double *nodes;
} nodes_job;

static void nodes_task(void *data, int64_t k) {
  const nodes_job *job = data;
  const mpm_stepper *s = job->s;
  const int64_t slots = s->blocks.count * s->blocks.nodes, tasks = s->tasks;
  const int64_t begin = slots * k / tasks, end = slots * (k + 1) / tasks;
  s->scratch[k].active = 0;
  if (end == begin) return; /* perhaps there are no nodes at all */
  s->scratch[k].active = s->kernels->update(job->values, job->nodes + begin * job->values, end - begin,
                                            s->mass_cut, s->velocity_dt);
  /* what the boundary stage notes, node by node */
  if (job->books && s->impulses)
    memset(s->impulse + 6 * begin, 0, (size_t)(6 * (end - begin)) * sizeof *s->impulse);
  if (job->asks && s->holds) memset(s->held + 3 * begin, 0, (size_t)(3 * (end - begin)));
}

mpm_status mpmi_stage_nodes(mpm_stepper *s, int32_t projection) {
  const int32_t forces = mpmi_projects_forces(projection), books = projection == MPMI_PROJECT_FORCES;
  nodes_job job = {s, forces ? s->values : 4, books,
                   projection == MPMI_PROJECT_TOUCH || mpmi_asks_host(s, projection),
                   forces ? s->node : s->again};
  const mpm_status status = mpmi_run_tasks(s, 0, s->tasks, nodes_task, &job);
  if (status || !books) return status;
  s->last.active_nodes = 0;
  for (int32_t k = 0; k < s->tasks; ++k) s->last.active_nodes += s->scratch[k].active;
  return MPM_OK;
}
