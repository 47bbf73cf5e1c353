/* Nodes at which bodies meet each other or a surface, as contact finds them in a step. Nodes of several
 * bodies at one index are a meeting, and so is a node close to an obstacle or a friction wall; each of its
 * bodies is a party, with the nodes that are tied together as one, and so is each surface; each two of its
 * parties that may act on each other are a touch. The particles around a node of a party are a cloud: those
 * that have weight there, and with GIMP and the linear basis those that a cubic spline would give weight.
 *
 * All lists have one order, which follows from blocks, nodes, bodies and slots. */
#ifndef MPMI_CONTACT_NODES_H
#define MPMI_CONTACT_NODES_H

#include "layout/contact_rules.h"
#include "obstacle/obstacle.h"

/* Blocks of several bodies at one place: [first, first + count) of the list of blocks. */
typedef struct mpmi_block_group {
  int32_t first, count;
} mpmi_block_group;
typedef struct mpmi_block_groups {
  int64_t count, capacity;
  mpmi_block_group *group;
} mpmi_block_groups;

/* Blocks at one place where there may be contact: those of several bodies, or some near surfaces. */
typedef struct mpmi_site {
  mpmi_block_group blocks;
  int64_t first_near;
  int32_t near_count;
} mpmi_site;
/* A surface near a site: rows over the nodes of a block, of the distance, infinite where it does not bind the
 * node, the normal and the surface's own velocity. */
enum { MPMI_NEAR_DISTANCE, MPMI_NEAR_NORMAL, MPMI_NEAR_VELOCITY = 4, MPMI_NEAR_ROWS = 7 };
typedef struct mpmi_near {
  int32_t surface, block; /* block: one at the site */
} mpmi_near;

/* A particle around a node. */
typedef struct mpmi_cloud_entry {
  uint32_t slot;
  int32_t member;
  double volume; /* w V at the start of the step, with the weight that makes it part of the cloud */
} mpmi_cloud_entry;

/* The particles around one node of a party: its master, one that follows it, or with the linear basis an
 * image behind a wall. A node on the plane of a wall is its own mirror image, and has the cloud of its
 * particles twice. */
typedef struct mpmi_cloud {
  int64_t slot;
  int64_t party;
  int64_t source;       /* the cloud that has its particles: itself, or that of which it is the image */
  int64_t first, count; /* of the entries */
  int64_t follower;     /* of the constraints; -1: the master, or its image */
  int32_t mirrored;     /* bits: axes on which it is the master's mirror image */
  double gradient[3];   /* sum of V grad w: the surface integral of w n */
} mpmi_cloud;

/* The first and the last cloud to which particles of a block may belong. */
typedef struct mpmi_reached {
  int32_t first, last;
} mpmi_reached;

enum { MPMI_COPIED_PARTY = -2 }; /* in place of a slot: a body at a node of another part */
typedef struct mpmi_party {
  int64_t slot;                              /* of the master; -1 for a surface */
  int32_t body;                              /* or the code of a surface */
  int32_t surface;                           /* -1 for a body */
  int32_t tied;                              /* a closed tie holds it */
  int32_t leads;                             /* light nodes have given to it after contact */
  int32_t stays;                             /* it is one of these */
  double arm[3], normal[3], own_velocity[3]; /* of a surface: from its centre to the node */
  int64_t meeting;
  int64_t first_cloud, cloud_count;
  int32_t site;           /* the last of the surfaces that prescribe its velocity along a direction, or -1 */
  double inverse_mass[3]; /* of all that moves with it; 0 where the component is held */
  double given[3];        /* by how much contact has changed what particles take per mass */
  double pressed[3];      /* and friction walls */
  double copy[3];         /* velocity of a copied one */
} mpmi_party;

/* What happened between two bodies at a node. The normal is that from the first to the second party. */
typedef struct mpmi_touch {
  int64_t party[2];
  const mpm_contact_desc *rule;
  int64_t record; /* of the pair of bodies */
  double direction_sign;
  double friction, friction_static;
  double normal[3];
  double gap;       /* infinite: no contact */
  double gap_after; /* an implicit step: where particles are at its end, if it is asked for */
  double area;      /* length^(dim - 1) */
  double normal_impulse, tangential[3];
  double dissipation, friction_work;
  double work;                            /* of a surface on the material */
  double way[3];                          /* an implicit step: of the second party */
  int32_t asked;                          /* for its gap after the step */
  int32_t open, closed, stuck, ambiguous; /* open: it cannot close in this step */
  int32_t was_closed, was_stuck;          /* before the last round: projections without forces keep to that */
} mpmi_touch;

typedef struct mpmi_meeting {
  int64_t first_party, party_count, first_touch, touch_count;
  int32_t coupled;     /* a free obstacle takes part, and so others depend on it */
  int32_t independent; /* no body takes part in two touches */
  uint64_t key;        /* of the place of its block, and which of that block's nodes it is */
  int32_t place;
  int32_t own; /* particles of this part give to the node */
} mpmi_meeting;

/* What two bodies do to each other in a step, or have done. */
typedef struct mpmi_pair_sums {
  int64_t nodes, closed, stuck, ambiguous;
  double impulse[3], angular_impulse[3], normal_impulse, area, pressure_max, gap, dissipation, friction_work;
} mpmi_pair_sums;

typedef struct mpmi_pair_record {
  int32_t a, b; /* a < b; a may be the code of a surface */
  mpmi_pair_sums last, now;
  double impulse_total[3]; /* of all committed steps */
  int32_t told;            /* the host knows that they overlap */
} mpmi_pair_record;

/* Pairs of bodies that ever were near each other, ordered by (a, b). */
typedef struct mpmi_pair_records {
  int64_t count, capacity;
  mpmi_pair_record *record;
  int32_t grown; /* since parts last told each other theirs */
} mpmi_pair_records;

/* Returns the number of a pair's record, or -1. */
int64_t mpmi_pair_find(const mpmi_pair_records *records, int32_t a, int32_t b);
/* Adds an empty record for a pair that has none. */
mpm_status mpmi_pair_add(mpmi_pair_records *records, mpm_context *context, int32_t a, int32_t b);
/* Drops the records of an obstacle; those of later ones go with their obstacles to the next lower number. */
void mpmi_pairs_drop(mpmi_pair_records *records, int32_t code);

/* What contact works with in a step. */
typedef struct mpmi_contact_nodes {
  int64_t surface_count, site_count, near_count;
  int32_t at_walls; /* a friction wall is near some site */
  int32_t anywhere; /* there are sites, here or on another part */
  int64_t surface_capacity, site_capacity, near_capacity, value_capacity;
  mpmi_rigid_surface *surface; /* obstacles, then friction walls by face */
  mpmi_site *site;
  mpmi_near *near_surface;
  double *near_value; /* [near][MPMI_NEAR_ROWS][nodes of a block] */
  int64_t meeting_count, party_count, touch_count, cloud_count, entry_count;
  int64_t meeting_capacity, party_capacity, touch_capacity, cloud_capacity, entry_capacity;
  mpmi_meeting *meeting;
  mpmi_party *party;
  mpmi_touch *touch;
  mpmi_cloud *cloud;
  mpmi_cloud_entry *entry;
  int32_t *cloud_of;            /* [slots] the cloud of a node, or -1 */
  int64_t map_capacity, mapped; /* mapped: the version of the layout for which cloud_of was made */
  uint8_t *in_reach;            /* [blocks] 1: particles of the block may belong to clouds */
  mpmi_reached *reached;        /* [blocks] and to which, where it is 1 */
  int64_t reach_capacity, reached_capacity;
  int64_t *site_sum; /* [sites][2] meetings and parties, then the numbers of the first ones */
  int64_t sum_capacity;
  int64_t *by_surface; /* [surfaces + 1] then [touches of surfaces]: where those of each begin, and these */
  int64_t by_surface_capacity;
  double *clearance;        /* of the surface that is looked at: [slots of all sets] */
  int64_t *clearance_first; /* [sets] */
  int64_t clearance_capacity, first_capacity;
  double (*place)[3]; /* [slots] where nodes of a total Lagrangian grid are now, or NULL: where they stand */
  int64_t place_capacity;
  int64_t *coupled, *merged; /* the coupled meetings in their order, with copies of other parts' */
  int64_t coupled_count, coupled_capacity, merged_capacity;
  double *work; /* [tasks][work_each] memory to find normals in */
  int64_t work_capacity, work_each;
  int32_t listed; /* near surfaces, meetings and clouds are those of the step */
} mpmi_contact_nodes;

void mpmi_contact_nodes_free(mpmi_contact_nodes *contact, mpm_context *context);

#endif
