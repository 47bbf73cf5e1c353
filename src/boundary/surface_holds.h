/* Surfaces that prescribe velocities, in explicit steps (docs/theory.md, 8.7). Around the markers k of one
 * surface, with areas A_k, area vectors a_k and velocities g_k, a node i gets
 *
 *   all components     v_i = sum w_ik A_k g_k / sum w_ik A_k
 *   the normal one     v_i . n = sum w_ik a_k . g_k / |N|,   N = sum w_ik a_k,   n = N / |N|
 *
 * moved along the surface to the node (surface_sites.c), where nothing else holds it. Whole velocities become held components, as those of prescribed particles. A
 * direction is what is left of n beside held components, walls and the directions of surfaces before. */
#ifndef MPMI_SURFACE_HOLDS_H
#define MPMI_SURFACE_HOLDS_H

#include "boundary/bound.h"

/* Returns 1 when surfaces hold nodes in the steps that these settings make. */
static inline int32_t mpmi_surfaces_hold(const mpmi_settings *settings) {
  return !mpmi_is_implicit(settings) && mpmi_surfaces_prescribe(&settings->surfaces);
}

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

/* ---- surface_sites.c --------------------------------------------------------------------------------- */
/* Returns the node that moves for the one in a slot, with the signs by which the latter follows. */
int64_t mpmi_mover_of(const mpmi_bound *bound, int64_t slot, double *sign);
/* Finds the sites of all surfaces, and what these ask for there. */
mpm_status mpmi_surface_sites_find(mpmi_bound *bound);
/* For implicit steps: makes the normals of markers along which material slides those of the nodes around, since
 * between edges that meet at a small angle nothing could slide, finds their curvature, and takes the stiffness
 * of those that do not read the motion of the material exactly. Masses are folded. */
mpm_status mpmi_surface_normals_smooth(mpmi_step *step, mpmi_nodes *nodes);

/* ---- surface_holds.c --------------------------------------------------------------------------------- */
/* Finds the nodes that surfaces hold, once all others have said what they hold. The nodes around markers must
 * be known. */
mpm_status mpmi_surface_holds_find(mpmi_bound *bound);
/* Sets the components along the directions of surfaces along which the material slides. */
void mpmi_surface_holds_slide(mpmi_bound *bound);
/* Tells surfaces and markers what their impulses were, at the end of the step. */
void mpmi_surface_holds_report(mpmi_step *step, const mpmi_nodes *nodes);

#endif
