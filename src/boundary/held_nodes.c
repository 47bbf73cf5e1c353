/* Components of nodes that the host, prescribed particles or surfaces hold. */
#include "boundary/bound.h"
#include "boundary/surface_holds.h"
#include "layout/tasks.h"

/* Sets a component that the host prescribes; its increment is that of eq. 30, or 0 by option. */
static void prescribe(mpmi_bound *bound, int64_t slot, int32_t c, double value) {
  double *v = mpmi_velocity(bound->values, slot);
  if (mpmi_has_increments(bound->values)) {
    double *dv = mpmi_increment(bound->values, slot);
    dv[c] = bound->step->settings->desc.boundary_zero_acceleration ? 0.0 : dv[c] + value - v[c];
  }
  v[c] = value;
}

static void set_block(mpmi_bound *bound, int64_t block, mpmi_whole_sum *sum) {
  const mpmi_nodes *nodes = bound->nodes;
  const int64_t first = block * bound->step->layout->blocks.nodes;
  for (int64_t slot = first; slot < first + bound->step->layout->blocks.nodes; ++slot)
    for (int32_t c = 0; c < bound->dim; ++c) {
      if (!nodes->held[slot][c]) continue;
      const double value = nodes->held_value[slot][c];
      const mpmi_component before = mpmi_component_of(bound, slot, c);
      prescribe(bound, slot, c, value);
      mpmi_record(bound, slot, c, before);
      if (bound->records && mpmi_owns_node(bound->step->layout->parts, slot))
        mpmi_exact_add(sum, bound->share * mpmi_work_done(bound, slot, c, before, value));
    }
}

static void set_task(void *data, int64_t k) {
  mpmi_bound *bound = data;
  const mpmi_share share = mpmi_share_of(bound->step->settings, bound->step->layout->blocks.count, k);
  for (int64_t b = share.begin; b < share.end; ++b)
    set_block(bound, b, &bound->step->work->report[k].host_work);
}

mpm_status mpmi_held_set(mpmi_bound *bound) {
  if (!bound->nodes->has_holders) return MPM_OK;
  const mpmi_settings *settings = bound->step->settings;
  return mpmi_run_tasks(settings, 0, settings->tasks, set_task, bound);
}

mpm_status mpmi_held_find(mpmi_bound *bound) {
  mpm_status status = bound->step->settings->velocity_bc ? mpmi_ask_velocities(bound) : MPM_OK;
  if (!status && bound->nodes->prescription.any) status = mpmi_prescribed_hold(bound);
  return status || !mpmi_surfaces_hold(bound->step->settings) ? status : mpmi_surface_holds_find(bound);
}
