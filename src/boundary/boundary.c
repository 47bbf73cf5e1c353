/* The boundary stage: in which order conditions act on the nodes of a projection. */
#include "boundary/boundary.h"
#include "boundary/bound.h"
#include "boundary/surface_holds.h"

/* Contacts between bodies and with friction walls share nodes where bodies meet on a wall: there they act in
 * turn until what is left is this share of the first round. */
static const double settled = 1e-13;
enum { ROUNDS = 30 };

static mpm_status settle(mpmi_bound *bound, int32_t keeps) {
  double first = 0.0;
  mpm_status status = keeps ? MPM_OK : mpmi_body_contacts_find(bound);
  const int32_t rubs = mpmi_has_friction_nodes(bound->step->settings);
  for (int32_t i = 0; i < ROUNDS && !status; ++i) {
    mpmi_contact_round round = {.touches = mpmi_bodies_touch(bound)};
    status = mpmi_body_contacts_act(bound, keeps, i ? MPMI_NEXT_ROUND : MPMI_FIRST_ROUND, &round.most);
    if (!status && rubs) status = mpmi_friction_walls(bound, keeps, !i, &round);
    if (!i) first = round.most;
    if (!rubs || !round.touches || !(round.most > settled * first)) break;
  }
  if (!status && rubs && bound->step->layout->parts) mpmi_accord_end(bound->step->layout->parts);
  return status;
}

/* Light nodes go with their leaders once contact has acted on these, and on them. Where particles take the
 * velocities, what they give to their leaders is not to close gaps. */
static mpm_status act_in_contact(mpmi_bound *bound, int32_t keeps, int32_t is_main) {
  double most;
  mpm_status status = settle(bound, keeps);
  if (!status) status = mpmi_light_nodes_lead_again(bound);
  if (!status && is_main && bound->nodes->light_count)
    status = mpmi_body_contacts_act(bound, keeps, MPMI_LAST_ROUND, &most);
  return status;
}

/* Lets all that acts on folded nodes act, in order: conditions, with the host's hooks between them. */
static mpm_status act(mpmi_bound *bound, const mpmi_projection *projection) {
  mpm_status status;
  if ((status = mpmi_hooks_begin(bound)) || (status = mpmi_hooks_run(bound, MPM_AFTER_P2G)) ||
      (status = mpmi_hooks_run(bound, MPM_AFTER_FORCES)) ||
      (status = mpmi_asks_host(bound->step->settings, projection) ? mpmi_held_find(bound) : MPM_OK) ||
      (status = mpmi_damp(bound)) || (status = mpmi_held_set(bound)))
    return status;
  if ((status = mpmi_ties_hold_walls(bound))) return status;
  mpmi_surface_holds_slide(bound);
  if ((status = act_in_contact(bound, 0, projection->main))) return status;
  mpmi_surface_holds_slide(bound); /* they have the last word where contact pushes off them */
  if (projection->main) mpmi_body_contacts_sum(bound);
  return mpmi_hooks_run(bound, MPM_AFTER_VELOCITY);
}

/* Acts in projections other than the main one, which have no hooks. The projection of USF comes first and
 * asks who holds nodes; that of MUSL keeps these answers; the terms of XPIC obey walls and images only, which
 * are linear, and those of FMPM also what is held.
 *
 * Only a projection with forces can tell which contacts are closed. Without them a body that expands against
 * a wall seems to leave it, and USF would strain it less in the rebound than in the approach, which makes
 * energy. */
static mpm_status act_on_velocities(mpmi_bound *bound, const mpmi_projection *projection) {
  mpm_status status = MPM_OK;
  if (mpmi_asks_host(bound->step->settings, projection)) status = mpmi_held_find(bound);
  if (!status && projection->forces) status = mpmi_damp(bound);
  if (!status && projection->held) status = mpmi_held_set(bound);
  if (!status) status = mpmi_ties_hold_walls(bound);
  if (!status && projection->held) mpmi_surface_holds_slide(bound);
  if (!status && projection->contact != MPMI_CONTACT_NONE)
    status = act_in_contact(bound, projection->contact == MPMI_CONTACT_KEEPS, 0);
  if (!status && projection->held) mpmi_surface_holds_slide(bound);
  return status;
}

mpm_status mpmi_boundary_hold(mpmi_step *step, mpmi_nodes *nodes) {
  mpmi_bound bound = {
      .step = step, .nodes = nodes, .values = &nodes->solved, .dim = step->settings->grid->dim};
  const mpm_status status = mpmi_ties_fold(&bound);
  return status ? status : mpmi_held_find(&bound);
}

mpm_status mpmi_boundary_stage(mpmi_step *step, const mpmi_projection *projection, mpmi_nodes *nodes,
                               double share) {
  const mpmi_settings *settings = step->settings;
  const int32_t both = mpmi_has_increments(&nodes->solved);
  mpmi_bound bound = {.step = step,
                      .nodes = nodes,
                      .values = mpmi_projected_nodes(nodes, projection),
                      .flip = both ? mpmi_flip_share(step) : 0.0,
                      .share = share,
                      .dim = settings->grid->dim,
                      .records = projection->recorded && nodes->has_impulses,
                      .loads = projection->forces && settings->surfaces.count > 0};
  mpm_status status = mpmi_ties_fold(&bound);
  if (!status && projection->contact != MPMI_CONTACT_NONE) status = mpmi_light_nodes_lead(&bound);
  if (!status) status = projection->main ? act(&bound, projection) : act_on_velocities(&bound, projection);
  if (!status) status = mpmi_ties_unfold(&bound);
  if (status) return status;
  const int32_t tells = bound.records && share != 0.0; /* what holders gave counts */
  if (tells && nodes->prescription.any && (status = mpmi_prescribed_share(&bound))) return status;
  if (!projection->main) return MPM_OK;
  if ((status = mpmi_damping_sum(&bound))) return status;
  return mpmi_hooks_end(&bound);
}
