/* A saved state has a header, the setup, the numbers of the time loop, then sets, blocks and fields:
 *
 *   header    magic, byte order, format, bytes in all, checksum of everything that follows
 *
 *   setup     grid, scheme, laws and fields, which are compared when a state is loaded
 *
 *   numbers   mpmi_state_numbers, then one mpmi_state_set_numbers for each set
 *
 *   obstacles from format 3 on: how many there are; what each is, which is compared, then mpmi_state_obstacle
 *
 *   contact   from format 3 on: how many rules there are and how many pairs of bodies, and these
 *
 *   surfaces  from format 3 on: how many there are; of each its body, which is compared, how many markers it
 *             has, the next id, its impulses, and the markers
 *
 *   blocks    if the state is sorted: coordinates and, from format 3 on, body of the blocks with slots, by
 *             Morton key and body; then for each set the first slot in each of these blocks, and the number
 *             of slots
 *
 *   fields    for each set those that are present, component by component, over all slots
 *
 * A problem in several parts has as many pieces, which have magic of their own. A piece is what a state is,
 * with the particles of its part, and the blocks that these are in:
 *
 *   header, setup, numbers, obstacles, contact, surfaces, blocks, fields
 *
 *   end       mpmi_state_end: which of the pieces it is, and the mark that all of them have
 *
 * Slots and blocks of all pieces, one piece after the other, are in the order of one part. Where some piece
 * is not sorted the state is not. What is not of a set or of blocks is the same in all pieces.
 *
 * Any change of this raises MPMI_STATE_FORMAT. The structs below are written as they are, with numbers in
 * little-endian order: their members have 8 bytes but for those that begin the header and the step info, and
 * there are no gaps. */
#ifndef MPMI_STATE_H
#define MPMI_STATE_H

#include "io/archive.h"
#include "stepper/stepper.h"

#include <stddef.h>

#define MPMI_STATE_MAGIC      "MPMSTATE"
#define MPMI_PIECE_MAGIC      "MPMPIECE"
#define MPMI_STATE_BYTE_ORDER 0x01020304u
/* Format 2 is that of 0.1.0: it has no sums over steps, no energy of the affine part and no bodies, and the
 * info is as long as it was then. */
enum { MPMI_STATE_FORMAT = 3, MPMI_STATE_FIRST_FORMAT = 2 };

typedef struct mpmi_state_header {
  char magic[8];
  uint32_t byte_order, format;
  int64_t bytes;
  uint64_t checksum;
} mpmi_state_header;

typedef struct mpmi_state_numbers {
  double t, previous_dt, controller_dt, mass_cut, reaction_dt;
  int64_t step, resorts, removed, energies_valid, has_reactions;
  int64_t blocks; /* how many have slots; -1: the state is not sorted, the next step sorts it */
  double impulse_by_face[6][3];
  mpmi_sums sums;
  mpm_step_info last;
  mpmi_totals totals;     /* from format 3 on */
  mpmi_heat_history heat; /* the same */
} mpmi_state_numbers;
_Static_assert(offsetof(mpmi_state_numbers, last) == 11 * 8 + 18 * 8 + 12 * 8, "part of the format");
_Static_assert(offsetof(mpm_step_info, external_work_total) == 192, "part of the format");
_Static_assert(sizeof(mpmi_totals) == 20 * 8, "part of the format");
_Static_assert(sizeof(mpmi_heat_history) == 33 * 8, "part of the format");

typedef struct mpmi_state_set_numbers {
  int64_t count, slots, next_id, dirty;
  double mass_max, reaction[3];
  double impulse_total[3];     /* from format 3 on */
  int64_t body;                /* the same; before it all sets were in body 0 */
  mpmi_adaption_sums adaption; /* the same */
  int64_t has_motion;          /* the same; 1: a callback says how its prescribed particles move */
} mpmi_state_set_numbers;
_Static_assert(offsetof(mpmi_state_set_numbers, has_motion) + 8 == sizeof(mpmi_state_set_numbers),
               "part of the format");

typedef struct mpmi_state_field {
  char name[MPMI_NAME];
  int64_t type, components, present;
} mpmi_state_field;

typedef struct mpmi_state_end {
  int64_t number, of; /* of the pieces this one, from 0, and how many there are */
  uint64_t mark;      /* sum of what all pieces sum up to before their ends */
} mpmi_state_end;
_Static_assert(sizeof(mpmi_state_end) == 3 * 8, "part of the format");

/* This is one set of a state that is being loaded. */
typedef struct mpmi_state_set {
  mpmi_state_set_numbers numbers;
  int32_t field_count;
  int32_t field[MPMI_MAX_FIELDS]; /* the index in the set of each field of the state */
  uint64_t present;               /* a bit for each field of the set */
} mpmi_state_set;

/* What stands before the blocks of a state, beside obstacles, contact and surfaces. */
typedef struct mpmi_state_head {
  mpmi_state_numbers numbers;
  mpmi_state_set *set; /* [sets] */
} mpmi_state_head;

/* Writes the setup, or compares it (state_setup.c). `set` receives the fields of the state, and is NULL
 * when writing. */
void mpmi_state_setup(mpmi_archive *a, const mpm_stepper *s, uint32_t format, mpmi_state_set *set);
/* Parts of it: a law with its parameters; the name, type and presence of a field. A field that is read is
 * found in the set; where it may be absent, the list takes its presence from the archive. found: bits of the
 * fields so far. */
void mpmi_state_archive_law(mpmi_archive *a, const mpm_material *material);
void mpmi_state_write_field(mpmi_archive *a, const mpmi_field *field);
void mpmi_state_read_field(mpmi_archive *a, const mpm_particles *set, mpmi_state_set *to, uint64_t *found);
mpm_status mpmi_state_refuse_field(mpmi_archive *a, const char *name, const char *what);
/* Returns 1 for built-in fields that a set on this grid has only when something uses them. */
int32_t mpmi_state_may_lack(const mpm_grid *grid, int32_t field);

/* Returns 1 when the next step will keep the present order of the slots (state_blocks.c). */
int32_t mpmi_state_is_sorted(const mpm_stepper *s);
int64_t mpmi_state_count_blocks(const mpm_stepper *s); /* counts blocks with slots */
void mpmi_state_write_blocks(mpmi_archive *a, const mpm_stepper *s);
/* Blocks with slots, in the order of the state. */
typedef struct mpmi_state_blocks {
  int64_t count;
  int64_t (*place)[4]; /* [count] coordinates and body */
  int64_t *start; /* [sets][count + 1] the first slot of the set in each block; the number of its slots */
} mpmi_state_blocks;
static inline int64_t *mpmi_state_starts(const mpmi_state_blocks *blocks, int32_t m) {
  return blocks->start + m * (blocks->count + 1);
}
/* The caller frees them after a failure as well. */
mpm_status mpmi_state_blocks_make(mpm_context *context, int32_t sets, int64_t count,
                                  mpmi_state_blocks *blocks);
void mpmi_state_blocks_free(mpm_context *context, int32_t sets, mpmi_state_blocks *blocks);
/* Reads the blocks of a piece with this head behind the first so many, and slots[m] of each set m. Without
 * `to` it passes them over. */
mpm_status mpmi_state_read_blocks(mpmi_archive *a, const mpm_stepper *s, uint32_t format,
                                  const mpmi_state_head *head, mpmi_state_blocks *to, int64_t first,
                                  const int64_t *slots);
/* Inserts them into next_blocks, as provisional blocks with their numbers: MPM_E_FORMAT where they are not
 * in order. Once those are ordered, finds the next arrangements. */
mpm_status mpmi_state_insert_blocks(mpm_stepper *s, const mpmi_state_blocks *blocks);
mpm_status mpmi_state_arrange(mpm_stepper *s, const mpmi_state_blocks *blocks, const mpmi_state_set *set);

/* Rules of contact, and what pairs of bodies did to each other (state_contact.c). They are read into new
 * lists, which the caller frees after a failure as well. */
void mpmi_state_write_contact(mpmi_archive *a, const mpm_stepper *s);
mpm_status mpmi_state_read_contact(mpmi_archive *a, const mpm_stepper *s, mpmi_contact_rules *rules,
                                   mpmi_pair_records *pairs);

/* Obstacles (state_obstacles.c): how they move, read into an array with one item for each, and taken over. */
typedef struct mpmi_state_obstacle {
  mpmi_pose pose;
  double force[3], torque[3];
  int64_t has_motion; /* 1: a callback says how it moves */
} mpmi_state_obstacle;
_Static_assert(sizeof(mpmi_state_obstacle) == 20 * 8, "part of the format");
void mpmi_state_write_obstacles(mpmi_archive *a, const mpm_stepper *s);
mpm_status mpmi_state_read_obstacles(mpmi_archive *a, const mpm_stepper *s, mpmi_state_obstacle *saved);
void mpmi_state_take_obstacles(const mpm_stepper *s, const mpmi_state_obstacle *saved);

/* Surfaces (state_surfaces.c): markers are read into an array with one item for each surface, and taken over
 * in exchange for those that were there. The caller frees what the array has. */
_Static_assert(sizeof(mpmi_marker) == 45 * 8, "part of the format");
typedef struct mpmi_state_surface {
  mpmi_markers markers;
  mpmi_surface_impulses impulses;
} mpmi_state_surface;
void mpmi_state_write_surfaces(mpmi_archive *a, const mpm_stepper *s);
mpm_status mpmi_state_read_surfaces(mpmi_archive *a, const mpm_stepper *s, mpmi_state_surface *saved);
void mpmi_state_take_surfaces(const mpm_stepper *s, mpmi_state_surface *saved);

/* Refuses values with which a step could not work safely (state_check.c). blocks: those of the state, or
 * NULL when it is not sorted; start: where the set's slots lie in them. */
void mpmi_state_check_set(mpmi_archive *a, mpm_particles *fresh, const mpmi_state_blocks *blocks,
                          const int64_t *start);

/* ---- saving (state_save.c) --------------------------------------------------------------------------- */
/* Brings what follows from the fields up to date, and refuses a state that cannot be saved now (collective).
 * status: what has happened before. */
mpm_status mpmi_state_settle(const mpm_stepper *s, mpm_status status);
/* The same for one set, of this part alone; texts call it `name`. before: what has to be done first. */
mpm_status mpmi_state_settle_set(mpm_particles *set, const char *name, const char *before);
/* Numbers of the time loop and of a set as a format has them, and one component of a field. */
void mpmi_state_archive_numbers(mpmi_archive *a, uint32_t format, mpmi_state_numbers *n);
void mpmi_state_archive_set_numbers(mpmi_archive *a, uint32_t format, mpmi_state_set_numbers *n);
void mpmi_state_archive_row(mpmi_archive *a, int32_t type, void *row, int64_t bytes);
/* A header from the machine's byte order to that of states, or back. */
mpmi_state_header mpmi_state_turn_header(mpmi_state_header header);
/* The first writes everything between header and end. Of that, the second makes the mark of all pieces
 * (collective). The third writes the end of a piece with it, and the last makes the header. */
void mpmi_state_write(mpmi_archive *a, const mpm_stepper *s);
mpm_status mpmi_state_mark(const mpmi_archive *a, uint64_t *mark);
void mpmi_state_write_end(mpmi_archive *a, uint64_t mark);
mpmi_state_header mpmi_state_header_of(const mpmi_archive *a);

/* ---- loading (state_load.c) -------------------------------------------------------------------------- */
/* A state or a piece of one, behind its header. */
typedef struct mpmi_state_piece {
  const unsigned char *body;
  int64_t bytes; /* without the end */
  uint32_t format;
  mpmi_state_end end;
} mpmi_state_piece;

/* A state that is being loaded, of which this part has some pieces. */
typedef struct mpmi_state_loading {
  mpm_stepper *stepper;
  int32_t count;
  const mpmi_state_piece *piece;
  int32_t tells;        /* texts name the piece */
  mpmi_state_head here; /* of the piece that is being read */
  mpmi_state_head all;  /* of the state; numbers of the sets are those of all pieces of this part */
  uint32_t format;      /* of the first piece */
  int64_t head_bytes;   /* of the first piece, where this part has it */
  int64_t block_count;  /* of all pieces of this part */
  int32_t is_unsorted;  /* some piece is */
  int32_t lacks_sums;   /* the same */
  mpmi_contact_rules rules;
  mpmi_pair_records pairs;
  mpmi_state_obstacle *obstacle; /* [obstacles] */
  mpmi_state_surface *surface;   /* [surfaces] */
  int64_t *slots;                /* [sets] that have been read */
  mpm_particles *fresh;          /* [sets] as they will be, with new storage for their fields */
  mpmi_state_blocks blocks;      /* of a sorted state */
  mpmi_parts *parts;             /* how it is shared out, where there are several parts */
} mpmi_state_loading;

/* The caller ends it after a failure as well. */
mpm_status mpmi_state_load_begin(mpmi_state_loading *l);
void mpmi_state_load_end(mpmi_state_loading *l);
/* Reads the heads of all pieces, and adds up what they have. */
mpm_status mpmi_state_measure(mpmi_state_loading *l);
/* Reads the head of the first piece, which gives all that is not of sets or blocks. */
mpm_status mpmi_state_read_all(mpmi_state_loading *l, const mpmi_state_piece *first);
/* Starts with a copy of the set that has no storage, and no fields but those that the state will have. */
void mpmi_state_start_set(mpm_particles *fresh, const mpm_particles *set);
static inline int32_t mpmi_state_has_field(const mpmi_state_set *of, int32_t field) {
  return (of->present >> field & 1) != 0;
}
/* Reads the fields of a list for the slots [first, first + slots), one field after the other. */
void mpmi_state_read_rows(mpmi_archive *a, const mpmi_state_set *of, mpm_particles *fresh, int64_t first,
                          int64_t slots);
/* Reads what follows the heads into new storage, and checks it. */
mpm_status mpmi_state_read_pieces(mpmi_state_loading *l);
/* Frees storage and keeps which fields there are. */
void mpmi_state_drop_storage(mpm_particles *fresh);
/* Refuses bodies of the state that this stepper does not offer, with its rules. */
mpm_status mpmi_state_check_bodies(mpmi_state_loading *l);
/* Returns for what the layout is wide with the bodies of the state, MPMI_WIDE_FOR_.... */
uint32_t mpmi_state_wide_for(const mpmi_state_loading *l);
/* Takes everything over, which cannot fail. */
void mpmi_state_take_over(mpmi_state_loading *l);

/* ---- state_share.c ----------------------------------------------------------------------------------- */
/* Gives the blocks of a sorted state, with their slots, to the parts that will have them (collective). */
mpm_status mpmi_state_share(mpmi_state_loading *l);

/* ---- state_pieces.c ---------------------------------------------------------------------------------- */
/* Refuses what cannot be the first bytes of a state that has so many bytes in all: MPM_E_FORMAT. of_piece: a
 * piece of several is welcome. */
mpm_status mpmi_state_check_header(mpm_context *context, const mpmi_state_header *header, int64_t bytes,
                                   int32_t of_piece);
/* Refuses what follows a header where its checksum is another: MPM_E_FORMAT. name: for the text. */
mpm_status mpmi_state_check_sum(mpm_context *context, const char *name, const mpmi_state_header *header,
                                const void *body);
/* Loads a state that is one piece, by one part. */
mpm_status mpmi_state_load(mpm_stepper *s, const void *buffer, int64_t bytes);

#endif
