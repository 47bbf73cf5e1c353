/* Fields may hold certain values only, and things follow when the host has written them. */
#ifndef MPMI_VALUES_H
#define MPMI_VALUES_H

#include "particles/builtin_fields.h"

/* An error text names a particle: `kind` is "id" or "index", or NULL for all particles. */
typedef struct mpmi_who {
  const char *kind;
  int64_t number;
} mpmi_who;

/* Refuses one particle's bad value of an F64 field, full layout, components `stride` apart: MPM_E_ARG. */
mpm_status mpmi_check_value(const mpm_particles *set, int32_t field, const double *value, int64_t stride,
                            mpmi_who who);
/* Does the same for a field of flags; "prescribed" is the only one with limits. */
mpm_status mpmi_check_flags(const mpm_particles *set, int32_t field, const uint8_t *value, int64_t stride,
                            mpmi_who who);
/* Does the same for the stored values of all particles, and wraps positions on periodic axes. */
mpm_status mpmi_check_stored(mpm_particles *set, int32_t field);
/* Refuses a field that has neither values nor a default, and says what would keep it: MPM_E_STATE. */
mpm_status mpmi_check_exists(const mpm_particles *set, int32_t field);
/* Refuses a field that the host may not write: MPM_E_ARG, or MPM_E_UNSUPPORTED with what to do instead. */
mpm_status mpmi_check_writable(const mpm_particles *set, int32_t field);
/* Notes what must be computed anew after the host has written good values. */
void mpmi_field_written(mpm_particles *set, int32_t field);
/* Finds the largest and the smallest mass anew. */
void mpmi_find_masses(mpm_particles *set);
/* Returns 1 for a particle that a copy of its position puts outside the grid. */
int32_t mpmi_is_beyond(const mpm_particles *set, int32_t copy, int64_t slot);
/* Brings a field that follows from others up to date before it is read. */
mpm_status mpmi_settle(mpm_particles *set, int32_t field);

/* Which particles a call is about, in which order (access.c): those with ids[n], or all by ascending id. With
 * `uniform` it is all slots in library order. */
typedef struct mpmi_selection {
  int64_t n;
  const int64_t *ids;
  int32_t uniform;
} mpmi_selection;
/* Checks what is selected and builds the index that it needs. */
mpm_status mpmi_check_selection(const mpm_particles *set, const mpmi_selection *of);
/* Lists the slots of the items [begin, begin + MPMI_SELECTED) of a selection whose ids are known to exist.
 * Returns how many there are. */
enum { MPMI_SELECTED = 256 };
int64_t mpmi_selected_slots(const mpm_particles *set, const mpmi_selection *of, int64_t begin, int64_t *slot);

#endif
