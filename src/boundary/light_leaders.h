/* Who leads light nodes, which light_nodes.c lets follow them. */
#ifndef MPMI_LIGHT_LEADERS_H
#define MPMI_LIGHT_LEADERS_H

#include "boundary/bound.h"

/* Nodes beside a node: along axes first, then across edges of cells, then through corners. */
enum { MPMI_DIRECTIONS = 26 };

/* What holds for all nodes of a projection. */
typedef struct mpmi_light_search {
  const mpmi_bound *bound;
  int32_t ties;                    /* nodes are tied together somewhere */
  int32_t periodic;                /* some axis is */
  int32_t hold_count, hold[6];     /* faces with walls that hold components */
  int32_t first[4];                /* directions along n axes: from first[n - 1] to first[n] */
  int32_t by[MPMI_DIRECTIONS][3];  /* in steps from node to node */
  int64_t stride[MPMI_DIRECTIONS]; /* from slot to slot within a block */
} mpmi_light_search;

mpmi_light_search mpmi_light_search_of(const mpmi_bound *bound);
/* Returns 1 for a node in the plane of a face, where a wall is. */
int32_t mpmi_light_in_plane(const mpmi_bound *bound, int64_t slot, int32_t face);
/* Returns the components of velocity, as bits, that walls hold at a node. */
int32_t mpmi_light_held(const mpmi_light_search *search, int64_t slot);
/* Finds the lines of a node that is light and sets how many leaders they have; none for others. */
void mpmi_light_find_lines(const mpmi_light_search *search, mpmi_light_node *node);
/* Writes the leaders, from node->first on, and how much of a momentum that they get the node goes with. */
void mpmi_light_fill(const mpmi_light_search *search, mpmi_light_node *node, mpmi_leader *leader);

#endif
