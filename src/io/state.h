/* Saved states: header, setup, numbers of the time loop, sets, blocks, fields.
 *
 *   header   magic, byte order, format, bytes in all, checksum of everything that follows
 *   setup    grid, scheme, laws and fields: compared when a state is loaded
 *   numbers  mpmi_state_numbers, then one mpmi_state_set_numbers for each set
 *   blocks   of a sorted state: coordinates of the blocks with slots, by Morton key; of each set the first
 * slot in each block, and the number of slots fields   of each set, those present, component by component,
 * all slots
 *
 * Raise MPMI_STATE_FORMAT with any change of this. Structs below are written as they are: members of 8 bytes,
 * no gaps. */
#ifndef MPMI_STATE_H
#define MPMI_STATE_H

#include "io/archive.h"
#include "particles/layout.h"
#include "stepper/stepper.h"

#define MPMI_STATE_MAGIC      "MPMSTATE"
#define MPMI_STATE_BYTE_ORDER 0x01020304u
enum { MPMI_STATE_FORMAT = 2 };

typedef struct mpmi_state_header {
  char magic[8];
  uint32_t byte_order, format;
  int64_t bytes;
  uint64_t checksum;
} mpmi_state_header;

typedef struct mpmi_state_numbers {
  double t, previous_dt, controller_dt, mass_cut, reaction_dt;
  int64_t step, resorts, removed, energies_valid, has_reactions;
  int64_t blocks; /* with slots; -1: not sorted, the next step does that */
  double impulse_by_face[6][3];
  mpmi_sums sums;
  mpm_step_info last;
} mpmi_state_numbers;
_Static_assert(sizeof(mpmi_state_numbers) == 11 * 8 + 18 * 8 + 11 * 8 + 192, "part of the format");

typedef struct mpmi_state_set_numbers {
  int64_t count, slots, next_id, dirty;
  double mass_max;
} mpmi_state_set_numbers;

typedef struct mpmi_state_field {
  char name[MPMI_NAME];
  int64_t type, components, present;
} mpmi_state_field;

/* One set while a state is loaded. */
typedef struct mpmi_state_set {
  mpmi_state_set_numbers numbers;
  int32_t field_count;
  int32_t field[MPMI_MAX_FIELDS]; /* the set's own index of each field in the state */
  mpm_particles fresh;            /* the set as it will be: its fields are new storage */
} mpmi_state_set;

/* state_setup.c: writes the setup, or compares it; `set` receives the fields of the state, and is NULL when
 * writing. */
void mpmi_state_setup(mpmi_archive *a, const mpm_stepper *s, mpmi_state_set *set);

/* state_blocks.c. Does the next step go on with the present order of the slots? */
int32_t mpmi_state_is_sorted(const mpm_stepper *s);
int64_t mpmi_state_count_blocks(const mpm_stepper *s); /* with slots */
void mpmi_state_write_blocks(mpmi_archive *a, const mpm_stepper *s);
/* Into next_blocks and the next arrangements; count: blocks with slots. */
mpm_status mpmi_state_read_blocks(mpmi_archive *a, mpm_stepper *s, int64_t count, const mpmi_state_set *set);

/* state_check.c: refuses values with which a step could not work safely. blocks: those of the state, or NULL
 * when it is not sorted; start: where the set's slots lie in them. */
void mpmi_state_check_set(mpmi_archive *a, mpm_particles *fresh, const mpmi_blocks *blocks,
                          const int64_t *start);

/* state_save.c. Can the state be saved now? Brings what follows from the fields up to date. */
mpm_status mpmi_state_settle(const mpm_stepper *s);
/* Everything after the header, and the header of what was written. */
void mpmi_state_write(mpmi_archive *a, const mpm_stepper *s);
mpmi_state_header mpmi_state_header_of(const mpmi_archive *a);

/* state_load.c. Refuses what cannot be the first bytes of a state of so many bytes in all: MPM_E_FORMAT. */
mpm_status mpmi_state_check_header(mpm_context *context, const mpmi_state_header *header, int64_t bytes);
mpm_status mpmi_state_load(mpm_stepper *s, const void *buffer, int64_t bytes);

#endif
