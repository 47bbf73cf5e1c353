/* The sites of surfaces that prescribe: what they ask for at the nodes around their markers. */
#ifndef MPMI_SURFACE_SITES_H
#define MPMI_SURFACE_SITES_H

#include "boundary/bound.h"

/* Returns 1 for the site of a surface that prescribes the normal component alone. */
static inline int32_t mpmi_site_slides(const mpmi_bound *bound, const mpmi_surface_site *site) {
  return bound->step->settings->surfaces.surface[site->surface]->desc.prescribes == MPM_PRESCRIBES_NORMAL;
}

/* A node is left alone when no shape function of a marker is larger there: hardly any of the surface is lost,
 * and where its foot on the surface lies could not be told. */
#define MPMI_LEAST_SHAPE 0.03
static inline int32_t mpmi_site_is_far(const mpmi_surface_site *site) {
  return !(site->largest > MPMI_LEAST_SHAPE);
}

/* Finds the sites of all surfaces, and what these ask for there. */
mpm_status mpmi_surface_sites_find(mpmi_bound *bound);
/* For implicit steps: makes the normals of markers along which material slides those of the nodes around,
 * since between edges that meet at a small angle nothing could slide, finds their curvature, and takes the
 * stiffness of those that do not read the motion of the material exactly. Masses are folded. */
mpm_status mpmi_surface_normals_smooth(mpmi_step *step, mpmi_nodes *nodes);

#endif
