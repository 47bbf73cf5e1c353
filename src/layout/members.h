/* The sets of a stepper: coming and going, the fields that they keep for it, and their buffers. */
#ifndef MPMI_MEMBERS_H
#define MPMI_MEMBERS_H

#include "layout/sorted_layout.h"

/* Adds a set, which belongs to nobody, at the end. On failure nothing has changed. */
mpm_status mpmi_members_add(mpmi_layout *layout, const mpmi_settings *settings, mpm_particles *set);
/* Takes a set out and gives its memory back; the fields that were kept for the stepper go. */
void mpmi_members_remove(mpmi_layout *layout, const mpmi_settings *settings, int32_t m);
/* Finds the number of a set, or returns MPM_E_NOT_FOUND. */
mpm_status mpmi_members_find(const mpmi_layout *layout, const mpmi_settings *settings,
                             const mpm_particles *set, int32_t *m);
/* Makes the fields that a stepper so described keeps, and drops those that it does not; on failure the fields
 * are those of the present description. */
mpm_status mpmi_members_keep_fields(mpmi_layout *layout, const mpmi_settings *settings,
                                    const mpm_stepper_desc *desc);
/* Returns MPM_E_STATE, with the number of the first set whose views the host holds, or MPM_OK; `before` ends
 * the sentence. */
mpm_status mpmi_members_unmapped(const mpmi_layout *layout, const mpmi_settings *settings,
                                 const char *before);

/* Brings the sets' fields up to date for a step; MPM_E_STATE where the host holds or has spoilt them. */
mpm_status mpmi_members_refresh(mpmi_layout *layout, const mpmi_settings *settings);

#endif
