/* Which values fields may hold, and what follows when the host has written them. */
#ifndef MPMI_VALUES_H
#define MPMI_VALUES_H

#include "particles/layout.h"

/* Whom an error text names: `kind` is "id" or "index", or NULL for all particles. */
typedef struct mpmi_who {
  const char *kind;
  int64_t number;
} mpmi_who;

/* Refuses one particle's bad value of an F64 field, full layout, components `stride` apart: MPM_E_ARG. */
mpm_status mpmi_check_value(const mpm_particles *set, int32_t field, const double *value, int64_t stride,
                            mpmi_who who);
/* The same for a field of flags, which others than "prescribed" are not. */
mpm_status mpmi_check_flags(const mpm_particles *set, int32_t field, const uint8_t *value, int64_t stride,
                            mpmi_who who);
/* The same for the stored values of all particles; wraps positions on periodic axes. */
mpm_status mpmi_check_stored(mpm_particles *set, int32_t field);
/* MPM_E_STATE for a field that has neither values nor a default, with what would keep it. */
mpm_status mpmi_check_exists(const mpm_particles *set, int32_t field);
/* Whether the host may write the field: MPM_E_ARG, or MPM_E_UNSUPPORTED with what to do instead. */
mpm_status mpmi_check_writable(const mpm_particles *set, int32_t field);
/* After the host wrote good values: what must be computed anew. */
void mpmi_field_written(mpm_particles *set, int32_t field);
/* Brings a field that follows from others up to date before it is read. */
mpm_status mpmi_settle(mpm_particles *set, int32_t field);

#endif
