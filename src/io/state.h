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
 * Any change of this raises MPMI_STATE_FORMAT. The structs below are written as they are, with numbers in
 * little-endian order: their members have 8 bytes but for those that begin the header and the step info, and
 * there are no gaps. */
#ifndef MPMI_STATE_H
#define MPMI_STATE_H

#include "io/archive.h"
#include "stepper/stepper.h"

#include <stddef.h>

#define MPMI_STATE_MAGIC      "MPMSTATE"
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
} mpmi_state_set_numbers;

typedef struct mpmi_state_field {
  char name[MPMI_NAME];
  int64_t type, components, present;
} mpmi_state_field;

/* This is one set while a state is loaded. */
typedef struct mpmi_state_set {
  mpmi_state_set_numbers numbers;
  int32_t field_count;
  int32_t field[MPMI_MAX_FIELDS]; /* the index in the set of each field of the state */
  mpm_particles fresh;            /* the set as it will be, with new storage for its fields */
} mpmi_state_set;

/* Writes the setup, or compares it (state_setup.c). `set` receives the fields of the state, and is NULL
 * when writing. */
void mpmi_state_setup(mpmi_archive *a, const mpm_stepper *s, uint32_t format, mpmi_state_set *set);
/* Parts of it: a law with its parameters; the name, type and presence of a field. A field that is read is
 * found in the set; where it may be absent, its presence is taken from the archive. found: bits of the
 * fields so far. */
void mpmi_state_archive_law(mpmi_archive *a, const mpm_material *material);
void mpmi_state_write_field(mpmi_archive *a, const mpmi_field *field);
void mpmi_state_read_field(mpmi_archive *a, mpmi_state_set *to, uint64_t *found);
mpm_status mpmi_state_refuse_field(mpmi_archive *a, const char *name, const char *what);
/* Returns 1 for built-in fields that a set on this grid has only when something uses them. */
int32_t mpmi_state_may_lack(const mpm_grid *grid, int32_t field);

/* Returns 1 when the next step will keep the present order of the slots (state_blocks.c). */
int32_t mpmi_state_is_sorted(const mpm_stepper *s);
int64_t mpmi_state_count_blocks(const mpm_stepper *s); /* counts blocks with slots */
void mpmi_state_write_blocks(mpmi_archive *a, const mpm_stepper *s);
/* Reads into next_blocks and the next arrangements; count: blocks with slots. */
mpm_status mpmi_state_read_blocks(mpmi_archive *a, mpm_stepper *s, uint32_t format, int64_t count,
                                  const mpmi_state_set *set);

/* Rules of contact, and what pairs of bodies did to each other (state_contact.c). They are read into new
 * lists, which the caller frees after a failure as well. */
void mpmi_state_write_contact(mpmi_archive *a, const mpm_stepper *s);
mpm_status mpmi_state_read_contact(mpmi_archive *a, const mpm_stepper *s, mpmi_contact_rules *rules,
                                   mpmi_pair_records *pairs);

/* Obstacles (state_obstacles.c): how they move, read into an array with one item for each, and taken over. */
typedef struct mpmi_state_obstacle {
  mpmi_pose pose;
  double force[3], torque[3];
} mpmi_state_obstacle;
_Static_assert(sizeof(mpmi_state_obstacle) == 19 * 8, "part of the format");
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
void mpmi_state_check_set(mpmi_archive *a, mpm_particles *fresh, const mpmi_blocks *blocks,
                          const int64_t *start);

/* Refuses problems in several parts: MPM_E_UNSUPPORTED. */
mpm_status mpmi_state_is_whole(const mpm_stepper *stepper);
/* Brings what follows from the fields up to date, and refuses a state that cannot be saved now
 * (state_save.c). */
mpm_status mpmi_state_settle(const mpm_stepper *s);
/* The same for one set, which texts call `name`; before: what has to be done first. */
mpm_status mpmi_state_settle_set(mpm_particles *set, const char *name, const char *before);
/* Numbers of the time loop and of a set as a format has them, and one component of a field. */
void mpmi_state_archive_numbers(mpmi_archive *a, uint32_t format, mpmi_state_numbers *n);
void mpmi_state_archive_set_numbers(mpmi_archive *a, uint32_t format, mpmi_state_set_numbers *n);
void mpmi_state_archive_row(mpmi_archive *a, int32_t type, void *row, int64_t bytes);
/* A header from the machine's byte order to that of states, or back. */
mpmi_state_header mpmi_state_turn_header(mpmi_state_header header);
/* The first writes everything after the header, the second makes the header of what was written. */
void mpmi_state_write(mpmi_archive *a, const mpm_stepper *s);
mpmi_state_header mpmi_state_header_of(const mpmi_archive *a);

/* Refuses what cannot be the first bytes of a state that has so many bytes in all: MPM_E_FORMAT
 * (state_load.c). */
mpm_status mpmi_state_check_header(mpm_context *context, const mpmi_state_header *header, int64_t bytes);
/* Refuses what follows a header where its checksum is another: MPM_E_FORMAT. name: for the text. */
mpm_status mpmi_state_check_sum(mpm_context *context, const char *name, const mpmi_state_header *header,
                                const void *body);
/* Starts with a copy of the set that has no storage. */
void mpmi_state_start_set(mpmi_state_set *to, const mpm_particles *set);
/* Returns how many bytes a particle takes in the fields that are present. */
int64_t mpmi_state_bytes_per_slot(const mpm_particles *set);
mpm_status mpmi_state_load(mpm_stepper *s, const void *buffer, int64_t bytes);

#endif
