#include "layout/nodes.h"

mpm_status mpmi_nodal_reserve(mpm_context *c, mpmi_nodal *nodes, int64_t slots, int32_t values) {
  const int64_t had = nodes->capacity;
  const mpm_status status = MPMI_RESERVE_MORE(c, nodes->at, nodes->capacity, slots * values);
  if (nodes->values != values || nodes->capacity != had) nodes->zero_elsewhere = -1;
  nodes->values = values;
  return status;
}

void mpmi_nodal_free(mpm_context *c, mpmi_nodal *nodes) {
  MPMI_FREE_ARRAY(c, nodes->at, nodes->capacity);
}

static mpm_status reserve_held(mpm_context *c, mpmi_nodes *nodes, int64_t slots) {
  int64_t capacity = nodes->held_capacity;
  const mpm_status status = MPMI_RESERVE_MORE(c, nodes->held_value, capacity, slots);
  if (status || capacity == nodes->held_capacity) return status;
  MPMI_FREE_ARRAY(c, nodes->held, nodes->held_capacity);
  nodes->held_capacity = capacity;
  nodes->held = mpmi_alloc(c, mpmi_bytes(capacity, sizeof *nodes->held));
  if (nodes->held) return MPM_OK;
  MPMI_FREE_ARRAY(c, nodes->held_value, capacity);
  nodes->held_value = NULL;
  nodes->held_capacity = 0;
  return MPM_E_NOMEM;
}

static mpm_status reserve_ties(mpm_context *c, mpmi_nodes *nodes, int64_t ties) {
  const int64_t had = nodes->tie_capacity;
  const mpm_status status = MPMI_RESERVE_MORE(c, nodes->tie_state, nodes->tie_capacity, ties);
  if (nodes->tie_capacity != had) nodes->tie_states_of = -1;
  return status;
}

/* A whole step of a fused transfer needs no forces apart from the momentum. */
static int32_t values_of_step(const mpmi_settings *settings, int32_t staged) {
  const int32_t fused =
      settings->transfer->fused && !staged && !mpmi_has_hooks(settings) && !mpmi_is_damped(settings);
  return fused && settings->desc.position_order == 1 ? 4 : 8;
}

mpm_status mpmi_nodes_prepare(mpmi_nodes *nodes, const mpmi_settings *settings, const mpmi_layout *layout,
                              int32_t staged) {
  mpm_context *c = settings->context;
  const int64_t slots = mpmi_slots(layout), ties = layout->constraints.tie_count,
                contacts = layout->constraints.contact_count;
  /* light ones are few, and more of them take room when they come */
  const int64_t light = layout->light_cut > layout->mass_cut ? slots / 32 + 64 : 0;
  const int32_t remedy = settings->desc.locking_remedy != MPM_LOCKING_NONE;
  const int32_t corrected = mpmi_is_corrected(settings);
  const int32_t places = mpmi_places_nodes(settings, nodes);
  const int32_t projects =
      settings->desc.scheme == MPM_MUSL || mpmi_deforms_first(settings) || corrected || places;
  mpm_status status;
  const int32_t surfaces = mpmi_surfaces_prescribe(&settings->surfaces);
  nodes->has_holders =
      settings->velocity_bc || nodes->prescription.any || (surfaces && !mpmi_is_implicit(settings));
  nodes->has_impulses = nodes->has_holders || ties || contacts || nodes->contact.at_walls;
  nodes->contact.listed = 0;
  nodes->surface_sites.count = 0; /* those of the step before are no use */
  if ((status = mpmi_nodal_reserve(c, &nodes->solved, slots, values_of_step(settings, staged))) ||
      (status = projects ? mpmi_nodal_reserve(c, &nodes->projected, slots, 4) : MPM_OK) ||
      (status = corrected || remedy ? mpmi_nodal_reserve(c, &nodes->sums, slots, 4) : MPM_OK) ||
      (status = places ? MPMI_RESERVE_MORE(c, nodes->contact.place, nodes->contact.place_capacity, slots)
                       : MPM_OK) ||
      (status = surfaces ? MPMI_RESERVE_MORE(c, nodes->surface_sites.last, nodes->surface_sites.last_capacity,
                                             slots)
                         : MPM_OK) ||
      (status = MPMI_RESERVE_MORE(c, nodes->light, nodes->light_capacity, light)) ||
      (status = MPMI_RESERVE_MORE(c, nodes->leader, nodes->leader_capacity, 4 * light)) ||
      (status = reserve_ties(c, nodes, ties)) ||
      (status = MPMI_RESERVE_MORE(c, nodes->contact_state, nodes->contact_capacity, contacts)))
    return status;
  if (nodes->has_impulses && (status = MPMI_RESERVE_MORE(c, nodes->impulse, nodes->impulse_capacity, slots)))
    return status;
  if (mpmi_has_hooks(settings) &&
      (status = MPMI_RESERVE_MORE(c, nodes->hook_impulse, nodes->hook_capacity, slots)))
    return status;
  if (mpmi_is_damped(settings) && !mpmi_is_implicit(settings) &&
      (status = MPMI_RESERVE_MORE(c, nodes->damping_impulse, nodes->damping_capacity, slots)))
    return status;
  return nodes->has_holders ? reserve_held(c, nodes, slots) : MPM_OK;
}

int32_t mpmi_leaves_ties(const mpmi_layout *layout, const mpmi_settings *settings) {
  int32_t gives = mpmi_gives_anywhere(settings) || settings->surfaces.count > 0 || layout->parts;
  for (int32_t m = 0; m < layout->member_count; ++m) gives |= layout->member[m].prescribed;
  return !gives;
}

void mpmi_nodes_free(mpmi_nodes *nodes, mpm_context *c) {
  mpmi_nodal_free(c, &nodes->solved);
  mpmi_nodal_free(c, &nodes->projected);
  mpmi_nodal_free(c, &nodes->sums);
  mpmi_contact_nodes_free(&nodes->contact, c);
  MPMI_FREE_ARRAY(c, nodes->light, nodes->light_capacity);
  MPMI_FREE_ARRAY(c, nodes->leader, nodes->leader_capacity);
  MPMI_FREE_ARRAY(c, nodes->impulse, nodes->impulse_capacity);
  MPMI_FREE_ARRAY(c, nodes->held, nodes->held_capacity);
  MPMI_FREE_ARRAY(c, nodes->held_value, nodes->held_capacity);
  MPMI_FREE_ARRAY(c, nodes->hook_impulse, nodes->hook_capacity);
  MPMI_FREE_ARRAY(c, nodes->damping_impulse, nodes->damping_capacity);
  MPMI_FREE_ARRAY(c, nodes->contact_state, nodes->contact_capacity);
  MPMI_FREE_ARRAY(c, nodes->tie_state, nodes->tie_capacity);
  MPMI_FREE_ARRAY(c, nodes->surface_sites.site, nodes->surface_sites.capacity);
  MPMI_FREE_ARRAY(c, nodes->surface_sites.last, nodes->surface_sites.last_capacity);
  mpmi_prescription *p = &nodes->prescription;
  MPMI_FREE_ARRAY(c, p->sums, p->sums_capacity);
  MPMI_FREE_ARRAY(c, p->part, p->part_capacity);
  MPMI_FREE_ARRAY(c, p->block, p->block_capacity);
}

static int64_t count_heavy(const mpmi_layout *layout, const mpmi_nodal *nodes, const mpmi_parts *parts) {
  const int64_t slots = mpmi_slots(layout);
  int64_t active = 0;
  for (int64_t i = 0; i < slots; ++i)
    active += *mpmi_mass(nodes, i) > layout->mass_cut && mpmi_owns_node(parts, i);
  return active;
}

int64_t mpmi_count_active(const mpmi_layout *layout, const mpmi_nodal *nodes) {
  return count_heavy(layout, nodes, NULL);
}

int64_t mpmi_count_owned(const mpmi_layout *layout, const mpmi_nodal *nodes) {
  return count_heavy(layout, nodes, layout->parts);
}
