/* Who meets whom, and where: what contact finds out from particles and nodal masses before impulses act.
 *
 *   meetings.c   nodes at which several bodies have mass
 *   clouds.c     the particles around these nodes
 *   gaps.c       normal, gap and area of each touch
 */
#ifndef MPMI_CONTACT_FINDING_H
#define MPMI_CONTACT_FINDING_H

#include "layout/nodes.h"
#include "layout/step.h"

/* What is asked about nodes in one projection. */
typedef struct mpmi_contact_search {
  mpmi_step *step;
  mpmi_nodes *nodes;
  const mpmi_nodal *values; /* of the projection, with ties folded */
  mpmi_contact_nodes *contact;
} mpmi_contact_search;

/* Lists meetings, parties, touches and the clouds that they need, without particles. */
mpm_status mpmi_meetings_find(mpmi_contact_search *search);
/* Fills the clouds. */
mpm_status mpmi_clouds_fill(mpmi_contact_search *search);
/* Finds normal, gap and area of each touch for the present velocities. */
mpm_status mpmi_gaps_find(mpmi_contact_search *search);

/* Makes records for the pairs of bodies that are near each other. */
mpm_status mpmi_contact_prepare(const mpmi_layout *layout, const mpmi_settings *settings,
                                mpmi_pair_records *records);

#endif
