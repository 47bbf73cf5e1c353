#include "boundary/held_nodes.h"
#include "boundary/prescribed_nodes.h"
#include "boundary/velocity_callback.h"
#include "layout/tasks.h"

/* Sets a component that the host prescribes; its increment is that of eq. 30, or 0 by option. */
static void prescribe(const mpmi_bound *f, int64_t slot, int32_t c, double value) {
  double *v = mpmi_velocity(f->values, slot);
  if (mpmi_has_increments(f->values)) {
    double *dv = mpmi_increment(f->values, slot);
    dv[c] = f->step->settings->desc.boundary_zero_acceleration ? 0.0 : dv[c] + value - v[c];
  }
  v[c] = value;
}

/* The work is the impulse times the velocity that the step has. */
static void set_block(const mpmi_bound *f, int64_t block) {
  const mpmi_nodes *nodes = f->nodes;
  const int64_t first = block * f->step->layout->blocks.nodes;
  double work = 0.0;
  for (int64_t slot = first; slot < first + f->step->layout->blocks.nodes; ++slot)
    for (int32_t c = 0; c < f->dim; ++c) {
      if (!nodes->held[slot][c]) continue;
      const double value = nodes->held_value[slot][c];
      const mpmi_component before = mpmi_component_of(f, slot, c);
      prescribe(f, slot, c, value);
      work += mpmi_record(f, slot, c, before) * value;
    }
  if (f->records) f->step->work->block_work[block] = work;
}

static void set_task(void *data, int64_t k) {
  const mpmi_bound *f = data;
  const mpmi_share share = mpmi_share_of(f->step->settings, f->step->layout->blocks.count, k);
  for (int64_t b = share.begin; b < share.end; ++b) set_block(f, b);
}

mpm_status mpmi_held_set(const mpmi_bound *f) {
  if (!f->nodes->has_holders) return MPM_OK;
  const mpmi_settings *settings = f->step->settings;
  const mpm_status status = mpmi_run_tasks(settings, 0, settings->tasks, set_task, (void *)(uintptr_t)f);
  if (!status && f->records) mpmi_add_block_work(f->step);
  return status;
}

mpm_status mpmi_held_find(const mpmi_bound *f) {
  const mpm_status status = f->step->settings->velocity_bc ? mpmi_ask_velocities(f) : MPM_OK;
  return status || !f->nodes->prescription.any ? status : mpmi_prescribed_hold(f);
}
