/* One problem in several parts, each with the particles of its own blocks of the grid.
 *
 *   cut.c        which part has which blocks: ranges of their Morton keys
 *   migration.c  particles that go to another part, when they are sorted
 *   pattern.c    which blocks of other parts share nodes with one's own, and which of the nodes have all that
 *                particles give them
 *   early.c      which blocks give to nodes while messages are under way
 *   tiles.c      the exchange of what the particles of blocks at the boundary give
 *   accord.c     what parts settle together in the conditions on nodes
 *   guests.c     copies of particles of other parts, around nodes at which bodies meet
 *
 * The particles of all parts, one part after the other, have the order that one part would have; so have
 * the tiles that are added to a node. Hence all bits are those of one part. */
#ifndef MPMI_PARTS_H
#define MPMI_PARTS_H

#include "context/transport.h"
#include "grid/constraints.h"

/* Slots of a message that is sent to a partner, or has come from it. */
typedef struct mpmi_buffer {
  char *at;
  int64_t capacity, used;
} mpmi_buffer;

/* A block with particles beside those of a partner. In the part that has it: the box of its tile that the
 * partner wants. In the partner: the ghost, and the box of its tile that came last. */
typedef struct mpmi_shared_block {
  int64_t block;
  int32_t partner; /* index in the list of partners */
  mpmi_node_box box;
  const double *values; /* of the ghost, in a message; NULL: there were none */
  double *place;        /* in a message, of what is sent; NULL: there is none */
} mpmi_shared_block;

/* A part that shares nodes with this one. */
typedef struct mpmi_partner {
  int32_t part;
  int64_t first_sent, sent;    /* in the list `sent` */
  int64_t first_ghost, ghosts; /* in the list `ghost` */
} mpmi_partner;

/* Flags of a node that a ghost may give to. */
enum {
  MPMI_NODE_GIVEN = 1, /* a ghost's tile has it, or a node that is tied to it */
  MPMI_NODE_WHOLE = 2, /* all that give to it are known here */
  MPMI_NODE_OWN = 4,   /* a tile of this part has it */
  MPMI_NODE_LOWER = 8, /* a tile of a part before this one has it */
  MPMI_NODE_MEETS = 16 /* what bodies do to each other there counts on this part */
};

/* What parts settle together in the conditions on the nodes of a projection, once it is there: the meetings
 * that free obstacles couple, which are gathered, and the contacts of nodes with friction walls, which are
 * swept as often on all parts. */
typedef struct mpmi_accord {
  int64_t after; /* so many exchanges of tiles */
  int32_t phase, gathers, sweeps;
} mpmi_accord;
enum { MPMI_MOST_ACCORDS = 3 };

typedef struct mpmi_parts {
  mpm_context *context;
  const mpm_grid *grid;
  int32_t margin;           /* nodes so far beyond those of a tile are to be whole, too */
  int32_t meeting_margin;   /* at nodes so far beyond those of a tile bodies are to meet, too */
  uint64_t *first;          /* [parts + 1] part r has the keys first[r] <= key < first[r + 1] */
  int32_t is_cut, is_empty; /* empty: no part has particles */
  int32_t is_stale;         /* a sort has not come to its end on all parts */
  int64_t *owner_count;     /* [parts] scratch */
  int32_t body_count;       /* of the sets */
  int64_t body_capacity;
  int32_t *body; /* [body_count] each once */
  int64_t partner_count, partner_capacity;
  mpmi_partner *partner;
  int64_t sent_count, sent_capacity, ghost_count, ghost_capacity;
  mpmi_shared_block *sent, *ghost; /* by partner; each in the order of the sender's blocks */
  uint8_t *flags;                  /* [slots] MPMI_NODE_..., or NULL */
  int64_t flags_capacity;
  int32_t names_owners; /* `lowest` is asked for */
  int32_t *lowest;      /* [slots] of nodes that are given to: the first part with a tile that has it */
  int64_t lowest_capacity, *partial; /* slots of nodes that are given to and not whole */
  int64_t partial_count, partial_capacity;
  int64_t version; /* of the layout that the flags are of */
  /* By block: 1 + its index in `boundary`, or 0; whether it is on the boundary; whether it has particles
   * and is not, and then which of both it is, early or late; whether it has particles, 2 where it may share
   * nodes with a ghost. */
  int32_t *mark;
  uint8_t *is_boundary, *is_inner, *is_early, *is_late, *near;
  int64_t mark_capacity, is_boundary_capacity, is_inner_capacity, is_early_capacity, is_late_capacity;
  int64_t near_capacity;
  int64_t boundary_count, boundary_capacity, *boundary; /* own blocks that are sent, each once */
  double *tile;                                         /* [boundary] their tiles */
  int64_t tile_capacity;
  mpmi_buffer *out; /* [parts] */
  mpmi_buffer gone; /* runs of slots of particles that leave */
  mpm_message *message;
  int64_t *most;
  int64_t exchanges; /* of tiles in the step under way */
  /* What parts settle together between them: how often, how often so far, and how often by the end of the
   * phase; whether of the one under way meetings have been gathered. */
  mpmi_accord accord[MPMI_MOST_ACCORDS];
  int32_t accord_count, accords, accords_due, has_gathered;
  int32_t has_counted; /* the active nodes of the step under way */
  int32_t prescribes;  /* some part may have prescribed particles */
  int32_t asks;        /* some part has a progress callback */
  int32_t guest_count; /* of sets that have had guests (guests.h) */
  struct mpmi_guest_set *guests;
  int32_t *guest_of; /* [blocks] 1 + the index of the ghost that has guests in this step, or 0 */
  int64_t guest_capacity;
  uint8_t *given;     /* [blocks] 1: its particles are guests of other parts in this step */
  int32_t some_given; /* by this part or another */
  int64_t given_capacity;
  int64_t leave_elsewhere;  /* particles that leave the grid on other parts in the step under way */
  int32_t is_echo;          /* the step fails here because it has failed on a partner */
  mpm_balance_desc balance; /* with what 0 stands for, but in limit */
  int64_t steps;            /* since blocks were given to parts */
  int64_t look_again;       /* so many of them until a cut that has not paid is looked for again */
  double refused;           /* the imbalance at which it has not */
  double busy;              /* seconds of steps since blocks were given to parts, without waiting */
  double since; /* when the call under way began, or was last counted in these, by the same clock */
  mpm_parallel_info info;
} mpmi_parts;

/* A description with the defaults in place of 0, but for limit; NULL: all of them. */
mpm_balance_desc mpmi_balance_of(const mpm_balance_desc *desc);
mpm_status mpmi_parts_create(mpm_context *context, const mpm_grid *grid, mpmi_parts **out);
void mpmi_parts_destroy(mpmi_parts *parts);
/* Returns how much further out nodes are to be whole where there are surfaces: those around markers beside a
 * node of a part, and those around the markers beside these. */
static inline int32_t mpmi_marker_margin(const mpm_grid *grid) {
  return 2 * (grid->width - 1);
}
/* Exchanges them; what they have cost is counted on. */
void mpmi_parts_replace(mpmi_parts **present, mpmi_parts **next);
/* Adds the body of a set to those that may meet, unless it is known. */
mpm_status mpmi_parts_note_body(mpmi_parts *parts, int32_t body);
static inline int32_t mpmi_part_count(const mpmi_parts *parts) {
  return parts->context->transport.parts;
}
/* The time that a part takes, which blocks may be weighed by: a call goes on working; so it has until now;
 * from now on it counts anew. Nothing is done without parts. */
void mpmi_time_begin(mpmi_parts *parts);
void mpmi_time_add(mpmi_parts *parts);
void mpmi_time_reset(mpmi_parts *parts);

/* Makes room for more bytes of a message, and returns where they go, or NULL. */
void *mpmi_buffer_take(mpm_context *context, mpmi_buffer *buffer, int64_t bytes);

/* Returns how many threads so many bytes are worth that are copied: to wake one takes as long as to copy
 * 64 KB. */
static inline int64_t mpmi_copy_tasks(const mpm_context *context, int64_t bytes) {
  const int64_t tasks = 1 + bytes / 65536;
  return tasks < context->concurrency ? tasks : context->concurrency;
}

/* Nothing is to be sent to any part. */
static inline void mpmi_messages_clear(const mpmi_parts *parts) {
  for (int32_t r = 0; r < mpmi_part_count(parts); ++r) parts->out[r].used = 0;
}
/* Sends what stands in `out` to the parts that it is for, and takes what comes from those that have something
 * for this one. */
typedef struct mpmi_arrivals {
  int32_t count;
  const mpm_message *message;
} mpmi_arrivals;
mpm_status mpmi_parts_exchange(mpmi_parts *parts, mpmi_arrivals *in);
/* Takes what comes of an exchange that has been started, and counts how long that takes. */
mpm_status mpmi_parts_receive(mpmi_parts *parts, mpmi_arrivals *in);

/* ---- cut.c ------------------------------------------------------------------------------------------- */
/* Weights are integers, so that their sums do not depend on the parts: a particle weighs so much; a block
 * beside its particles as much as so many, unless the host says otherwise: its tile costs that. */
enum { MPMI_PARTICLE_WEIGHT = 256, MPMI_BLOCK_WEIGHT = 60 };
static inline int64_t mpmi_block_weight(const mpmi_parts *parts) {
  return (int64_t)(parts->balance.block_weight * MPMI_PARTICLE_WEIGHT + 0.5);
}
/* Gives the blocks, each with its weight, to the parts (collective), unless they are shared out evenly. */
mpm_status mpmi_cut_blocks(mpmi_parts *parts, const mpmi_blocks *blocks, const int64_t *weight);
/* Returns the part that has a block with this key. */
int32_t mpmi_cut_owner(const mpmi_parts *parts, uint64_t key);

/* ---- pattern.c --------------------------------------------------------------------------------------- */
/* Finds the ghosts of the blocks with particles, which are all that have been inserted, and inserts them
 * (collective). status: what has happened on this part before. */
mpm_status mpmi_pattern_find(mpmi_parts *parts, mpmi_blocks *blocks, mpm_status status);
/* Takes over the numbers that the blocks have now that they are in order, and tells apart those that are
 * sent. */
mpm_status mpmi_pattern_adopt(mpmi_parts *parts, const mpmi_blocks *blocks);
/* Finds the nodes that are whole, and whose they are. */
mpm_status mpmi_pattern_nodes(mpmi_parts *parts, const mpmi_blocks *blocks,
                              const mpmi_constraints *constraints);
/* Returns 1 for the one part that books what happens at a node. */
static inline int32_t mpmi_owns_node(const mpmi_parts *parts, int64_t slot) {
  if (!parts) return 1;
  const int32_t flags = parts->flags[slot];
  return !(flags & MPMI_NODE_GIVEN) || (flags & (MPMI_NODE_OWN | MPMI_NODE_LOWER)) == MPMI_NODE_OWN;
}

/* Returns the part that does so, of a node that is whole, where names_owners is set. */
static inline int32_t mpmi_owner_of_node(const mpmi_parts *parts, int64_t slot) {
  return parts->flags[slot] & MPMI_NODE_GIVEN ? parts->lowest[slot] : parts->context->transport.part;
}
/* Returns 1 for a node to which particles of this part give, or that none of another part's do. */
static inline int32_t mpmi_meets_node(const mpmi_parts *parts, int64_t slot) {
  return !parts || (parts->flags[slot] & (MPMI_NODE_GIVEN | MPMI_NODE_OWN)) != MPMI_NODE_GIVEN;
}
/* Returns 1 for such a node, and for those around it at which this part has to know what bodies do. */
static inline int32_t mpmi_meets_at_node(const mpmi_parts *parts, int64_t slot) {
  return !parts || (parts->flags[slot] & (MPMI_NODE_GIVEN | MPMI_NODE_MEETS)) != MPMI_NODE_GIVEN;
}

/* ---- early.c ----------------------------------------------------------------------------------------- */
/* Tells inner blocks apart, once all are in order and it is known which are inner. Before messages have come
 * early ones can be added, colour by colour, and after that the others with what has come: each node still
 * takes its tiles in the order of their colours. */
mpm_status mpmi_find_early(mpmi_parts *parts, const mpmi_blocks *blocks);

/* ---- accord.c ---------------------------------------------------------------------------------------- */
/* What parts tell each other in one: first, whether one of them has failed. */
enum { MPMI_ACCORD_WORDS = 6 };
/* Meetings have been gathered in the one under way. */
void mpmi_accord_gathered(mpmi_parts *parts);
/* Makes the words the largest of all parts. MPM_E_STATE, and is_echo, where one of them has failed: then it
 * is over. */
mpm_status mpmi_accord_settle(mpmi_parts *parts, int64_t *word);
/* It is over. */
void mpmi_accord_end(mpmi_parts *parts);
/* Takes the next part in it that is due on a part that has failed. */
void mpmi_accord_break(mpmi_parts *parts);

/* ---- tiles.c ----------------------------------------------------------------------------------------- */
/* Makes room for the tiles of the boundary blocks, and empties them. */
mpm_status mpmi_tiles_reserve(mpmi_parts *parts);
/* Returns the tile of a boundary block, with so many values per node. */
double *mpmi_tiles_of(const mpmi_parts *parts, int64_t block, int32_t values);
/* Empties them after a failure. */
void mpmi_tiles_clear(const mpmi_parts *parts, int32_t values);
/* Sends them to the partners; box: of the nodes of each block that have anything, in its tile. With a status
 * that is not MPM_OK partners learn that this part has failed. */
mpm_status mpmi_tiles_send(mpmi_parts *parts, int32_t values, const mpmi_cover *cover, mpm_status status);
/* Waits for those of the partners. MPM_E_STATE, and is_echo, where one of them has failed. */
mpm_status mpmi_tiles_receive(mpmi_parts *parts, int32_t values, mpm_status status);
/* Puts what has come of a ghost into a clean tile, and its box into the cover; returns 0 where it has given
 * nothing. */
int32_t mpmi_tiles_unpack(const mpmi_parts *parts, const mpmi_shared_block *ghost, int32_t values,
                          double *tile, mpmi_cover *cover);

#endif
