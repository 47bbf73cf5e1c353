/* Free nodes of one block with mass, for the host, which sees nodes in batches of one block: so batches do
 * not depend on how tasks share the blocks. */
#include "boundary/bound.h"

int64_t mpmi_list_nodes(const mpmi_bound *bound, int64_t block, mpmi_node_list *list) {
  const mpmi_step *step = bound->step;
  const mpmi_blocks *b = &step->layout->blocks;
  list->n = 0;
  for (int64_t slot = block * b->nodes; slot < (block + 1) * b->nodes; ++slot) {
    if (!mpmi_moves(bound, slot)) continue;
    int64_t index[3];
    mpmi_blocks_index(b, slot, index);
    for (int32_t k = 0; k < bound->dim; ++k) {
      list->index[k * MPMI_NODE_BATCH + list->n] = index[k];
      list->position[k * MPMI_NODE_BATCH + list->n] = mpmi_node_position(b->grid, k, index[k]);
    }
    list->mass[list->n] = mpmi_moving_mass(bound, slot);
    list->owned[list->n] = (uint8_t)mpmi_owns_node(step->layout->parts, slot);
    list->slot[list->n++] = slot;
  }
  list->batch = (mpm_node_batch){.struct_size = sizeof list->batch,
                                 .dim = bound->dim,
                                 .body = b->body[block],
                                 .n = list->n,
                                 .ld = MPMI_NODE_BATCH,
                                 .t = step->t,
                                 .dt = step->dt,
                                 .index = list->index,
                                 .position = list->position,
                                 .mass = list->mass,
                                 .owned = list->owned};
  return list->n;
}

void mpmi_bad_node(const mpmi_bound *bound, const mpmi_node_list *list, int64_t i, const char *what,
                   mpmi_failure *failure) {
  const mpmi_blocks *b = &bound->step->layout->blocks;
  mpmi_failure_take(failure, mpmi_node_failure(MPM_NONFINITE, b, list->slot[i], what));
}
