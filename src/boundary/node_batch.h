/* Free nodes of one block with mass, for the host: batches do not depend on the cut of the work. */
#ifndef MPMI_NODE_BATCH_H
#define MPMI_NODE_BATCH_H

#include "boundary/impulses.h"

enum { MPMI_NODE_BATCH = 256 }; /* the most nodes that a block has */
_Static_assert(MPMI_BLOCK_EDGE(1) <= MPMI_NODE_BATCH, "1-D");
_Static_assert(MPMI_BLOCK_EDGE(2) * MPMI_BLOCK_EDGE(2) <= MPMI_NODE_BATCH, "2-D");
_Static_assert(MPMI_BLOCK_EDGE(3) * MPMI_BLOCK_EDGE(3) * MPMI_BLOCK_EDGE(3) <= MPMI_NODE_BATCH, "3-D");

typedef struct mpmi_node_list {
  int64_t n, slot[MPMI_NODE_BATCH], index[3 * MPMI_NODE_BATCH];
  double position[3 * MPMI_NODE_BATCH], mass[MPMI_NODE_BATCH];
  mpm_node_batch batch;
} mpmi_node_list;

/* Masters stand for their ties, with the mass of all of it. Returns how many nodes there are. */
int64_t mpmi_list_nodes(const mpmi_bound *bound, int64_t block, mpmi_node_list *list);
/* A value of the host on node i that is not finite. */
void mpmi_bad_node(const mpmi_bound *bound, const mpmi_node_list *list, int64_t i, const char *what,
                   mpmi_failure *failure);

#endif
