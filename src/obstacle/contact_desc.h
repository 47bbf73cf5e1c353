/* How two bodies, or a body and an obstacle, meet: the host's description and its values. */
#ifndef MPMI_CONTACT_DESC_H
#define MPMI_CONTACT_DESC_H

#include "context/checks.h"

extern const mpm_contact_desc mpmi_contact_defaults;

/* Checks what counts for any contact: kind, friction, adhesion, offset. */
mpm_status mpmi_contact_desc_check_values(mpm_context *context, const mpm_contact_desc *desc);

#endif
