/* Which inner blocks give to nodes while messages are under way. A node takes the tiles that reach it in the
 * order of their colours. So a block must wait if one beside it has a lower colour and waits itself, as those
 * on the boundary do. No inner block is beside a ghost, whose owner would want its tile. */
#include "parallel/parts.h"

#include <string.h>

/* Returns 1 for a block beside one of a lower colour that waits. */
static int32_t must_wait(const mpmi_parts *parts, const mpmi_blocks *blocks, int64_t block) {
  const int32_t dim = blocks->grid->dim, colour = mpmi_colour_of(dim, blocks->coord[block]);
  for (int32_t n = 0; n < blocks->neighbours; ++n) {
    const int32_t beside = blocks->neighbour[block][n];
    if (beside != MPMI_NO_BLOCK && parts->is_late[beside] &&
        mpmi_colour_of(dim, blocks->coord[beside]) < colour)
      return 1;
  }
  return 0;
}

mpm_status mpmi_find_early(mpmi_parts *parts, const mpmi_blocks *blocks) {
  mpm_context *c = parts->context;
  const int64_t count = blocks->count;
  mpm_status status = MPMI_RESERVE_MORE(c, parts->is_early, parts->is_early_capacity, count + 1);
  if (!status) status = MPMI_RESERVE_MORE(c, parts->is_late, parts->is_late_capacity, count + 1);
  if (status) return status;
  memset(parts->is_early, 0, (size_t)(count + 1));
  memcpy(parts->is_late, parts->is_boundary, (size_t)(count + 1));
  for (int32_t colour = 0; colour < MPMI_COLOURS; ++colour)
    for (int64_t i = 0; i < count; ++i)
      if (parts->is_inner[i] && mpmi_colour_of(blocks->grid->dim, blocks->coord[i]) == colour)
        parts->is_late[i] = (uint8_t)must_wait(parts, blocks, i);
  for (int64_t i = 0; i < count; ++i) {
    parts->is_late[i] &= parts->is_inner[i];
    parts->is_early[i] = parts->is_inner[i] && !parts->is_late[i];
  }
  return MPM_OK;
}
