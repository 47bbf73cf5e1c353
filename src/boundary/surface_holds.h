/* Surfaces that prescribe velocities, in explicit steps (docs/theory.md, 8.7). Around the markers k of one
 * surface, with areas A_k, area vectors a_k and velocities g_k, a node i gets
 *
 *   all components     v_i = sum w_ik A_k g_k / sum w_ik A_k
 *   the normal one     v_i . n = sum w_ik a_k . g_k / |N|,   N = sum w_ik a_k,   n = N / |N|
 *
 * moved along the surface to the node (surface_sites.c), where nothing else holds it. Whole velocities become
 * held components, as those of prescribed particles. A direction is what is left of n beside held components,
 * walls and the directions of surfaces before. */
#ifndef MPMI_SURFACE_HOLDS_H
#define MPMI_SURFACE_HOLDS_H

#include "boundary/surface_sites.h"
#include "simd/vector3.h"

/* Returns 1 when surfaces hold nodes in the steps that these settings make. */
static inline int32_t mpmi_surfaces_hold(const mpmi_settings *settings) {
  return !mpmi_is_implicit(settings) && mpmi_surfaces_prescribe(&settings->surfaces);
}

/* Finds the nodes that surfaces hold, once all others have said what they hold. The nodes around markers must
 * be known. */
mpm_status mpmi_surface_holds_find(mpmi_bound *bound);
/* Returns the last site at a node where some surface sets the velocity along a direction, or -1. */
int32_t mpmi_surface_direction_at(const mpmi_bound *bound, int64_t slot);
/* Takes out of an impulse what the surfaces of such a site, or of those before it, take of it. */
static inline void mpmi_surface_take_out(const mpmi_surface_site *site, int32_t at, double *impulse) {
  for (; at >= 0; at = site[at].before) {
    if (!site[at].slides) continue;
    const double along = mpmi_inner(site[at].vector, impulse);
    for (int32_t c = 0; c < 3; ++c) impulse[c] -= along * site[at].vector[c];
  }
}
/* Sets the components along the directions of surfaces along which the material slides. */
void mpmi_surface_holds_slide(mpmi_bound *bound);
/* Tells surfaces and markers what their impulses were, at the end of the step. */
void mpmi_surface_holds_report(mpmi_step *step, const mpmi_nodes *nodes);

#endif
