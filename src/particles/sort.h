/* A set is sorted by blocks, and the sort is stable, so that the order is a function of the state alone. On
 * total Lagrangian grids clusters come first in each block (particles/clusters.h). */
#ifndef MPMI_SORT_H
#define MPMI_SORT_H

#include "grid/blocks.h"
#include "particles/particles.h"

/* An arrangement says where the slots of one set lie: start[b] .. start[b + 1] are the slots of block b. */
typedef struct mpmi_arrangement {
  mpm_context *context;
  int64_t *start; /* [blocks + 1] */
  int64_t start_capacity;
} mpmi_arrangement;

/* A sort of one set hands this from its second part to its last. */
typedef struct mpmi_sorting {
  uint32_t *source; /* [slots] the slot that a particle comes from */
  int64_t source_capacity;
  /* Particles that came from other parts stand in tail_count slots from `tail` on; the first tail_low of them
   * come before the set's own, the others after these. */
  int64_t tail, tail_count, tail_low;
} mpmi_sorting;

void mpmi_arrangement_init(mpmi_arrangement *arrangement, mpm_context *context);
void mpmi_arrangement_free(mpmi_arrangement *arrangement);
void mpmi_sorting_free(mpmi_sorting *sorting, mpm_context *context);
mpm_status mpmi_arrangement_reserve_blocks(mpmi_arrangement *arrangement, int64_t blocks);

/* A sort has three parts. The first two may fail and change nothing that matters; the third cannot fail.
 * mpmi_sort_blocks() inserts the blocks of the set's particles, which are those of a body.
 * mpmi_sort_plan() writes the new arrangement into `to` and makes room in the set. mpmi_sort_apply() moves
 * the particles and clears the set's ORDER and PLACE flags. */
mpm_status mpmi_sort_blocks(mpm_particles *set, int32_t body, mpmi_blocks *blocks);
/* Returns the provisional block of each slot that is not a hole, from then until mpmi_sort_plan(). */
const uint32_t *mpmi_sort_blocks_of_slots(const mpm_particles *set);
mpm_status mpmi_sort_plan(mpm_particles *set, const mpmi_blocks *blocks, mpmi_sorting *sorting,
                          mpmi_arrangement *to);
void mpmi_sort_apply(mpm_particles *set, const mpmi_blocks *blocks, mpmi_sorting *sorting,
                     const mpmi_arrangement *to);
/* Puts what came from parts before this one in front of the set's own particles: a sort has failed, and the
 * slots alone are to tell their order. */
void mpmi_sort_settle(mpm_particles *set, mpmi_sorting *sorting);

#endif
