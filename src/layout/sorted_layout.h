/* The sorted layout: the sets of a stepper with their particles in the order of the blocks, the nodes that
 * are tied together, and how the blocks are shared out among tasks. It changes when particles are sorted or
 * walls are set, never within a step. */
#ifndef MPMI_SORTED_LAYOUT_H
#define MPMI_SORTED_LAYOUT_H

#include "layout/contact_nodes.h"
#include "layout/settings.h"
#include "parallel/guests.h"
#include "particles/sort.h"

/* A set of particles in a stepper: where its particles lie, and what acts on them. */
typedef struct mpmi_member {
  mpm_particles *set;
  int32_t body;               /* sets of one body share its nodes */
  mpmi_arrangement now, next; /* slots by block, of the last sort and of the one being made */
  mpmi_sorting sorting;
  int32_t prescribed; /* 1: some of its particles are prescribed */
} mpmi_member;

/* Blocks with particles, shared out among tasks: task k works on block[i] with bound[k] <= i < bound[k +
 * 1]. */
typedef struct mpmi_worklist {
  int32_t *block;
  int64_t count;
  int64_t *bound; /* [tasks + 1] */
} mpmi_worklist;

/* There is one list of all blocks with particles, and then one for each colour. */
enum { MPMI_WORKLISTS = 1 + MPMI_COLOURS };

/* A node that has this share of the mass of one beside it, or less, goes with it (boundary/light_nodes.c),
 * in a body of one density. */
#define MPMI_LIGHT_SHARE 0.1

/* The densities of the laws of a body's sets. */
typedef struct mpmi_densities {
  double least, most;
} mpmi_densities;

/* What asks for nodes beyond those of a part's own particles: implicit steps, markers of surfaces, and bodies
 * that may touch. */
enum { MPMI_WIDE_FOR_IMPLICIT = 1, MPMI_WIDE_FOR_MARKERS = 2, MPMI_WIDE_FOR_TOUCHES = 4 };

typedef struct mpmi_layout {
  int32_t member_count, member_capacity;
  mpmi_member *member;
  mpmi_blocks blocks, next_blocks;
  mpmi_constraints constraints, next_constraints;
  int64_t met_count, met_capacity;
  int32_t *met; /* the ties of which stencils meet a node, in order; found with the cover */
  mpmi_worklist worklist[MPMI_WORKLISTS];  /* all blocks with particles, then by colour */
  int32_t *list_memory, *next_list_memory; /* memory of all worklists, and of those that are being made */
  int64_t list_capacity, next_list_capacity;
  int64_t *bound_memory;
  mpmi_block_groups groups, next_groups;
  int64_t version;      /* counts changes of blocks and constraints */
  int64_t covers;       /* counts how often it was found which nodes are met */
  int32_t cover_is_old; /* find it anew (layout/reached.c) before the next step */
  int64_t sorts;
  int64_t wide_domains;      /* domains wider than a cell at the last sort (GIMP) */
  double mass_cut;           /* a node that is not heavier takes no force */
  double light_cut;          /* one that is not heavier may have to go with others: at least the mass cut */
  mpmi_densities *densities; /* [bodies] */
  int64_t densities_capacity;
  int32_t walls_changed;
  uint32_t wide_for; /* MPMI_WIDE_FOR_...: what has asked for more nodes */
  mpmi_parts *parts; /* of several parts of a problem this one, or NULL */
} mpmi_layout;

/* Returns 1 for a set whose pressure is averaged over cells, as its dilation is. */
static inline int32_t mpmi_averages_pressure(const mpmi_settings *settings, const mpm_particles *set) {
  return settings->desc.locking_remedy && mpmi_material_pressure_from_shear(set->material);
}

static inline int64_t mpmi_slots(const mpmi_layout *layout) {
  return layout->blocks.count * layout->blocks.nodes;
}

mpm_status mpmi_layout_create(mpmi_layout *layout, const mpmi_settings *settings);
/* Of several parts each has to know more nodes for what is to come. They find these when they sort, which is
 * before the next step; with one part, too. */
void mpmi_layout_widen(mpmi_layout *layout, uint32_t wide_for);
/* Sets how far around a tile a part is to know nodes then. */
void mpmi_layout_set_margins(mpmi_parts *parts, uint32_t wide_for);
/* Widens, where it counts, once bodies may touch each other, an obstacle or the plane of a friction wall. */
void mpmi_layout_touches(mpmi_layout *layout, const mpmi_settings *settings);
void mpmi_layout_free(mpmi_layout *layout, const mpmi_settings *settings);

/* Particles of a set in a block: those of this part, or in a ghost copies of another part's. Members from
 * member_count on are those of the guests. */
typedef struct mpmi_residents {
  const mpm_particles *set;
  int32_t member;
  int64_t begin, end;
} mpmi_residents;

static inline mpmi_residents mpmi_residents_of(const mpmi_layout *layout, int32_t m, int64_t block) {
  const int32_t ghost = layout->parts ? layout->parts->guest_of[block] : 0;
  const mpmi_member *member = &layout->member[m];
  if (!ghost) return (mpmi_residents){member->set, m, member->now.start[block], member->now.start[block + 1]};
  const mpmi_guest_set *guests = &layout->parts->guests[m];
  return (mpmi_residents){&guests->set, layout->member_count + m, guests->start[2 * ghost - 2],
                          guests->start[2 * ghost - 1]};
}
/* Returns the set of a member of residents, and which of the stepper's sets it is. */
static inline int32_t mpmi_resident_home(const mpmi_layout *layout, int32_t member) {
  return member < layout->member_count ? member : member - layout->member_count;
}
static inline const mpm_particles *mpmi_resident_set(const mpmi_layout *layout, int32_t member) {
  return member < layout->member_count ? layout->member[member].set
                                       : &layout->parts->guests[member - layout->member_count].set;
}

/* Sends the particles of given blocks to other parts, which have them as guests (collective); copy: of the
 * fields that change in a step. */
mpm_status mpmi_layout_exchange_guests(const mpmi_layout *layout, mpm_context *context, int32_t copy);

/* Brings the layout up to date: sorts where particles have left their tiles, finds ties where walls have
 * changed. The old layout stays when that fails. */
mpm_status mpmi_layout_prepare(mpmi_layout *layout, const mpmi_settings *settings);
/* Returns 1 where particles have left their tiles or are new. */
int32_t mpmi_layout_is_moved(const mpmi_layout *layout);
/* Sorts then. */
mpm_status mpmi_layout_sort(mpmi_layout *layout, const mpmi_settings *settings);
/* These turn next_blocks and the next arrangements into the layout: the last part of a sort and of loading a
 * sorted state. The first makes ready for it, which may fail and changes nothing that matters; the second
 * does it. */
mpm_status mpmi_layout_plan(mpmi_layout *layout, const mpmi_settings *settings);
void mpmi_layout_adopt(mpmi_layout *layout, const mpmi_settings *settings);

/* Tells kernels where the particles of a set are and how large; `copy` is that of position and deformation
 * gradient. */
mpmi_points mpmi_points_of(const mpm_particles *set, int32_t copy);

#endif
