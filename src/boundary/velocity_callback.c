/* The host's callback that prescribes velocities of nodes. */
#include "boundary/bound.h"

#include <math.h>

static void ask_host(mpmi_bound *bound, int64_t block, mpmi_node_list *list, mpmi_failure *failure) {
  const mpmi_settings *settings = bound->step->settings;
  uint8_t prescribed[3 * MPMI_NODE_BATCH] = {0};
  double velocity[3 * MPMI_NODE_BATCH] = {0.0};
  if (!mpmi_list_nodes(bound, block, list)) return;
  const mpm_status status =
      mpmi_from_host(settings->velocity_bc(settings->velocity_bc_user, &list->batch, prescribed, velocity));
  if (status) {
    mpmi_failure_take(failure, mpmi_callback_failure(status, -1, "the velocity callback"));
    return;
  }
  for (int64_t i = 0; i < list->n; ++i)
    for (int32_t c = 0; c < bound->dim; ++c) {
      if (!prescribed[c * MPMI_NODE_BATCH + i]) continue;
      const double value = velocity[c * MPMI_NODE_BATCH + i];
      if (!isfinite(value)) {
        mpmi_bad_node(bound, list, i, "prescribed velocity not finite", failure);
        return;
      }
      bound->nodes->held[list->slot[i]][c] = MPMI_HELD_BY_HOST;
      bound->nodes->held_value[list->slot[i]][c] = value;
    }
}

static void ask_task(void *data, int64_t k) {
  mpmi_bound *bound = data;
  const mpmi_share share = mpmi_share_of(bound->step->settings, bound->step->layout->blocks.count, k);
  mpmi_node_list list;
  for (int64_t b = share.begin; b < share.end; ++b)
    ask_host(bound, b, &list, &bound->step->work->report[k].failure);
}

mpm_status mpmi_ask_velocities(mpmi_bound *bound) {
  const mpmi_settings *settings = bound->step->settings;
  const mpm_status status = mpmi_run_tasks(settings, 1, settings->tasks, ask_task, bound);
  return status ? status : mpmi_step_failure(bound->step);
}
