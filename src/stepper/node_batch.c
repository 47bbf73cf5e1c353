/* Nodes as the host sees them, and the callback that prescribes velocities. */
#include "stepper/node_batch.h"

#include <math.h>
#include <string.h>

int64_t mpmi_list_nodes(const mpmi_boundary *f, int64_t block, mpmi_node_list *list) {
  const mpm_stepper *s = f->s;
  const mpmi_blocks *b = &s->blocks;
  list->n = 0;
  for (int64_t slot = block * b->nodes; slot < (block + 1) * b->nodes; ++slot) {
    if (!mpmi_moves(f, slot)) continue;
    int64_t index[3];
    mpmi_blocks_index(b, slot, index);
    for (int32_t k = 0; k < f->dim; ++k) {
      list->index[k * MPMI_NODE_BATCH + list->n] = index[k];
      list->position[k * MPMI_NODE_BATCH + list->n] = mpmi_node_position(s->grid, k, index[k]);
    }
    list->mass[list->n] = mpmi_moving_mass(f, slot);
    list->slot[list->n++] = slot;
  }
  list->batch = (mpm_node_batch){.struct_size = sizeof list->batch,
                                 .dim = f->dim,
                                 .n = list->n,
                                 .ld = MPMI_NODE_BATCH,
                                 .t = s->t,
                                 .dt = f->dt,
                                 .index = list->index,
                                 .position = list->position,
                                 .mass = list->mass};
  return list->n;
}

void mpmi_bad_node(const mpmi_boundary *f, const mpmi_node_list *list, int64_t i, const char *what,
                   mpmi_failure *failure) {
  int64_t index[3];
  mpmi_blocks_index(&f->s->blocks, list->slot[i], index);
  mpmi_failure_take(failure,
                    &(mpmi_failure){MPM_NONFINITE, 0, -1, -1, mpmi_node_number(f->s->grid, index), what});
}

static void ask_host(const mpmi_boundary *f, int64_t block, mpmi_node_list *list, mpmi_failure *failure) {
  mpm_stepper *s = f->s;
  uint8_t prescribed[3 * MPMI_NODE_BATCH] = {0};
  double velocity[3 * MPMI_NODE_BATCH] = {0.0};
  if (!mpmi_list_nodes(f, block, list)) return;
  const mpm_status status = s->velocity_bc(s->velocity_bc_user, &list->batch, prescribed, velocity);
  if (status) {
    mpmi_failure_take(
        failure, &(mpmi_failure){mpmi_callback_cause(status), status, -1, -1, -1, "the velocity callback"});
    return;
  }
  for (int64_t i = 0; i < list->n; ++i)
    for (int32_t c = 0; c < f->dim; ++c) {
      if (!prescribed[c * MPMI_NODE_BATCH + i]) continue;
      const double value = velocity[c * MPMI_NODE_BATCH + i];
      if (!isfinite(value)) {
        mpmi_bad_node(f, list, i, "prescribed velocity not finite", failure);
        return;
      }
      s->held[3 * list->slot[i] + c] = MPMI_HELD_BY_HOST;
      s->held_value[3 * list->slot[i] + c] = value;
    }
}

static void ask_task(void *data, int64_t k) {
  const mpmi_boundary *f = data;
  mpmi_node_list list;
  for (int64_t b = mpmi_first_block(f->s, k); b < mpmi_first_block(f->s, k + 1); ++b)
    ask_host(f, b, &list, &f->s->scratch[k].failure);
}

mpm_status mpmi_ask_velocities(const mpmi_boundary *f) {
  mpm_stepper *s = f->s;
  const mpm_status status = mpmi_run_tasks(s, 1, s->tasks, ask_task, (void *)(uintptr_t)f);
  return status ? status : mpmi_stepper_failure(s);
}
