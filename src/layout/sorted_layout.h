/* The sorted layout: the sets of a stepper with their particles in the order of the blocks, the nodes that
 * are tied together, and how the blocks are shared out among tasks. It changes when particles are sorted or
 * walls are set, never within a step. */
#ifndef MPMI_SORTED_LAYOUT_H
#define MPMI_SORTED_LAYOUT_H

#include "layout/worklist.h"

typedef struct mpmi_layout {
  int32_t member_count, member_capacity;
  mpmi_member *member;
  mpmi_blocks blocks, next_blocks;
  mpmi_constraints constraints, next_constraints;
  mpmi_worklist worklist[MPMI_WORKLISTS]; /* all blocks with particles, then by colour */
  int32_t *list_memory;                   /* of all worklists */
  int64_t list_capacity;
  int64_t *bound_memory;
  int64_t version; /* counts changes of blocks and constraints */
  int64_t sorts;
  int64_t wide_domains; /* of GIMP, at the last sort */
  double mass_cut;      /* a node that is not heavier is at rest */
  int32_t walls_changed;
} mpmi_layout;

static inline int64_t mpmi_slots(const mpmi_layout *layout) {
  return layout->blocks.count * layout->blocks.nodes;
}

mpm_status mpmi_layout_create(mpmi_layout *layout, const mpmi_settings *settings);
void mpmi_layout_free(mpmi_layout *layout, const mpmi_settings *settings);

/* Brings the layout up to date: sorts where particles have left their tiles, finds ties where walls have
 * changed. The old layout stays when that fails. */
mpm_status mpmi_layout_prepare(mpmi_layout *layout, const mpmi_settings *settings);
/* Sorts where particles have left their tiles or are new. */
mpm_status mpmi_layout_sort(mpmi_layout *layout, const mpmi_settings *settings);
/* Makes the layout of the blocks and arrangements that are called next; the last part of a sort, and of
 * loading a sorted state. */
mpm_status mpmi_layout_adopt(mpmi_layout *layout, const mpmi_settings *settings);

#endif
