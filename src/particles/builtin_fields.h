/* The built-in fields by dimension and law, and where full tensors keep their entries. */
#ifndef MPMI_BUILTIN_FIELDS_H
#define MPMI_BUILTIN_FIELDS_H

#include "particles/particles.h"

/* Sorts number slots with 32 bits; the last number stands for none. */
#define MPMI_MAX_SLOTS INT64_C(0xfffffffe)

enum { MPMI_MAX_COMPONENTS = 64 }; /* the most that a field of the host may have */

/* Describes the built-in fields of a set whose grid and material are known; allocates nothing. */
void mpmi_fields_builtin(mpm_particles *set);
/* Returns the stored component that holds component c of the full layout, or -1. */
int32_t mpmi_stored_component(const mpm_particles *set, int32_t field, int32_t c);
/* Returns the value of a component of the full layout that is not stored: that of the identity for F, else
 * 0. */
double mpmi_unstored_value(int32_t field, int32_t c);
/* Finds the index of the field that the host names: MPM_E_ARG for NULL, MPM_E_NOT_FOUND with the nearest
 * names. */
mpm_status mpmi_require_field(const mpm_particles *set, const char *name, int32_t *field);

/* Refuses in the middle of a staged step: MPM_E_STATE. */
mpm_status mpmi_between_steps(const mpm_particles *set);
/* Wraps what a field of positions has in a slot on periodic axes, and counts images where they are kept. */
void mpmi_wrap_slot(mpm_particles *set, int32_t field, int64_t slot);
/* Rewrites the inert slots of one field after the host had write access to all of it. */
void mpmi_restore_holes(mpm_particles *set, int32_t field);

#endif
