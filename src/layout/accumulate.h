/* Sums over particles on nodes: the one way in which particles give to nodes.
 *
 * The nodes are cleared; block by block what the particles give is added up in a tile, and tile by tile,
 * colour by colour, in the nodes; then nodes that are tied together may be folded. Every nodal sum has one
 * order, which no number of tasks changes. */
#ifndef MPMI_ACCUMULATE_H
#define MPMI_ACCUMULATE_H

#include "layout/nodes.h"
#include "layout/visit.h"

typedef struct mpmi_accumulation {
  mpmi_nodal *to;
  /* Adds what the particles of a block give to a clean tile, with as many values per node as `to` has, or
   * flat (transfer/scatter.h). */
  void (*give)(void *user, const mpmi_visit *visit, double *tile);
  mpm_task_fn fold; /* run by all tasks once the sums are there, or NULL */
  void *user;       /* of give and fold */
  int32_t flat;     /* 1: give makes flat tiles */
  int32_t calls_host;
  int32_t gathers; /* 1: give gathers into `tile` meanwhile, so the sums are made in `sum_tile` */
  /* Flags of blocks, or NULL: those with `giving` give, those with `receiving` have nodes to be cleared. */
  const uint8_t *flags;
  uint8_t giving, receiving;
} mpmi_accumulation;

/* Makes the sums that `sum` describes. */
mpm_status mpmi_accumulate(mpmi_step *step, const mpmi_accumulation *sum);

#endif
