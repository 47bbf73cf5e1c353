/* Active nodes lie scattered over the blocks, so views are copies; what was written goes back at release. */
#include "stepper/node_view.h"

#include <math.h>
#include <string.h>

const mpmi_node_field mpmi_node_fields[MPMI_NODE_FIELDS] = {
    [MPMI_NODE_INDEX] = {"index", MPM_I64, 0},
    [MPMI_NODE_POSITION] = {"position", MPM_F64, 0},
    [MPMI_NODE_MASS] = {"mass", MPM_F64, 1},
    [MPMI_NODE_VELOCITY] = {"velocity", MPM_F64, 0},
    [MPMI_NODE_FORCE] = {"force", MPM_F64, 0},
    [MPMI_NODE_ACCELERATION] = {"acceleration", MPM_F64, 0},
    [MPMI_NODE_REACTION] = {"reaction", MPM_F64, 0},
    [MPMI_NODE_CONTACT_FORCE] = {"contact_force", MPM_F64, 0},
    [MPMI_NODE_CONTACT_NORMAL] = {"contact_normal", MPM_F64, 0},
    [MPMI_NODE_CONTACT_GAP] = {"contact_gap", MPM_F64, 1},
    [MPMI_NODE_CONTACT_AREA] = {"contact_area", MPM_F64, 1},
    [MPMI_NODE_TEMPERATURE] = {"temperature", MPM_F64, 1},
    [MPMI_NODE_OWNED] = {"owned", MPM_U8, 1},
};

static int32_t components_of(const mpm_stepper *s, int32_t field) {
  return mpmi_node_fields[field].scalar ? 1 : s->grid->dim;
}

/* Returns the cloud of a node at which bodies met in the step that is shown, or NULL. */
static const mpmi_cloud *cloud_at(const mpm_stepper *s, int64_t slot) {
  const mpmi_contact_nodes *contact = &s->nodes.contact;
  const int32_t known = contact->listed && s->step.phase != MPMI_BEGUN;
  return known && contact->cloud_of[slot] >= 0 ? &contact->cloud[contact->cloud_of[slot]] : NULL;
}

/* Returns by how much contact changed a component of a node's velocity. */
static double contact_change(const mpm_stepper *s, const mpmi_cloud *cloud, int32_t c) {
  const double sign = cloud->follower < 0 ? 1.0 : s->layout.constraints.follower[cloud->follower].sign[c];
  return sign * s->nodes.contact.party[cloud->party].given[c];
}

/* Returns a component of normal, gap or area, towards the body that is nearest; the normal points away
 * from the node's own body. */
static double meeting_value(const mpm_stepper *s, int32_t field, const mpmi_cloud *cloud, int32_t c) {
  const mpmi_contact_nodes *contact = &s->nodes.contact;
  const mpmi_meeting *meeting = &contact->meeting[contact->party[cloud->party].meeting];
  const mpmi_touch *nearest = NULL;
  for (int64_t i = meeting->first_touch; i < meeting->first_touch + meeting->touch_count; ++i) {
    const mpmi_touch *touch = &contact->touch[i];
    if (touch->party[0] != cloud->party && touch->party[1] != cloud->party) continue;
    if (!nearest || touch->gap < nearest->gap) nearest = touch;
  }
  const double sign = (nearest->party[0] == cloud->party) == !(cloud->mirrored >> c & 1) ? 1.0 : -1.0;
  return field == MPMI_NODE_CONTACT_NORMAL ? sign * nearest->normal[c]
         : field == MPMI_NODE_CONTACT_GAP  ? nearest->gap
                                           : nearest->area;
}

/* Returns a component of a field at a node. Nodes hold [p m f 0] until velocities are solved for, then [v m
 * dv 0]; fused nodes have no second half. */
static double value_of(const mpm_stepper *s, int32_t field, int64_t slot, int32_t c) {
  const mpmi_nodal *values = &s->nodes.solved;
  const double mass = *mpmi_mass(values, slot), v = mpmi_velocity(values, slot)[c];
  const double dv = mpmi_has_increments(values) ? mpmi_increment(values, slot)[c] : 0.0;
  const int32_t solved = s->step.phase != MPMI_BEGUN;
  const mpmi_impulse *bound = s->nodes.has_impulses && solved ? &s->nodes.impulse[slot] : NULL;
  const mpmi_cloud *cloud = cloud_at(s, slot);
  const double impulse = bound ? bound->given[c] : 0.0, contact = cloud ? contact_change(s, cloud, c) : 0.0;
  /* of tied nodes the impulse knows all changes */
  const double change =
      (bound ? bound->change[c] : 0.0) + (s->layout.constraints.tie_of[slot] < 0 ? contact : 0.0);
  const double dt = s->step.phase == MPMI_IDLE ? s->nodes.shown_dt : s->step.velocity_dt;
  switch (field) {
  case MPMI_NODE_MASS:
    return mass;
  case MPMI_NODE_VELOCITY:
    return solved ? v : v / mass;
  case MPMI_NODE_FORCE:
    return solved ? mass * (dv - change) / dt : dv;
  case MPMI_NODE_ACCELERATION:
    return solved ? dv / dt : dv / mass;
  case MPMI_NODE_REACTION:
    return impulse / dt;
  case MPMI_NODE_CONTACT_FORCE:
    return mass * contact / dt;
  case MPMI_NODE_TEMPERATURE:
    return mpmi_heat_node(s->heat, slot)[MPMI_HEAT_TEMPERATURE];
  default:
    return cloud                            ? meeting_value(s, field, cloud, c)
           : field == MPMI_NODE_CONTACT_GAP ? (double)INFINITY
                                            : 0.0;
  }
}

void mpmi_node_values(const mpm_stepper *s, int32_t field, const int64_t *slot, int64_t n,
                      int64_t item_stride, int64_t component_stride, void *out) {
  for (int64_t i = 0; i < n; ++i) {
    int64_t index[3];
    mpmi_blocks_index(&s->layout.blocks, slot[i], index);
    for (int32_t c = 0; c < components_of(s, field); ++c) {
      const int64_t at = i * item_stride + c * component_stride;
      if (field == MPMI_NODE_INDEX)
        ((int64_t *)out)[at] = index[c];
      else if (field == MPMI_NODE_POSITION)
        ((double *)out)[at] = mpmi_node_position(s->grid, c, index[c]);
      else if (field == MPMI_NODE_OWNED)
        ((uint8_t *)out)[at] = (uint8_t)mpmi_owns_node(s->layout.parts, slot[i]);
      else
        ((double *)out)[at] = value_of(s, field, slot[i], c);
    }
  }
}

/* Returns the next body after `after` that a set belongs to, or -1. */
static int32_t next_body(const mpm_stepper *s, int32_t after) {
  int32_t next = -1;
  for (int32_t m = 0; m < s->layout.member_count; ++m) {
    const int32_t body = s->layout.member[m].body;
    if (body > after && (next < 0 || body < next)) next = body;
  }
  return next;
}

/* Counts the active nodes of a body, and lists them unless `list` is NULL. */
static int64_t list_body(const mpm_stepper *s, int32_t body, int64_t *list) {
  const mpmi_blocks *b = &s->layout.blocks;
  int64_t count = 0;
  for (int64_t block = 0; block < b->count; ++block) {
    if (b->body[block] != body) continue;
    for (int64_t i = block * b->nodes; i < (block + 1) * b->nodes; ++i) {
      if (!(*mpmi_mass(&s->nodes.solved, i) > s->layout.mass_cut)) continue;
      if (list) list[count] = i;
      ++count;
    }
  }
  return count;
}

static mpm_status list_all(mpm_stepper *s) {
  const int64_t count = mpmi_count_active(&s->layout, &s->nodes.solved);
  if (count > s->active_capacity || !s->active) {
    int64_t *memory = mpmi_alloc(s->context, mpmi_bytes(count, sizeof *memory));
    if (!memory) return MPM_E_NOMEM;
    MPMI_FREE_ARRAY(s->context, s->active, s->active_capacity);
    s->active = memory;
    s->active_capacity = count;
  }
  s->active_count = 0;
  for (int32_t body = next_body(s, -1); body >= 0; body = next_body(s, body))
    s->active_count += list_body(s, body, s->active + s->active_count);
  return MPM_OK;
}

mpm_status mpmi_nodes_list(mpm_stepper *s, int32_t body, int64_t *first, int64_t *count) {
  int32_t exists = body == 0 && !s->layout.member_count;
  for (int32_t m = 0; m < s->layout.member_count; ++m) exists |= s->layout.member[m].body == body;
  if (!exists)
    return mpmi_fail(s->context, MPM_E_NOT_FOUND, "body is %d: no set of the stepper is in it", (int)body);
  const mpm_status status = s->mapped ? MPM_OK : list_all(s);
  if (status) return status;
  *first = 0;
  for (int32_t other = next_body(s, -1); other >= 0 && other < body; other = next_body(s, other))
    *first += list_body(s, other, NULL);
  *count = list_body(s, body, NULL);
  return MPM_OK;
}

mpm_status mpmi_node_require(mpm_context *context, const char *name, int32_t *field) {
  if (!name) return mpmi_fail(context, MPM_E_ARG, "field is NULL");
  const char *names[MPMI_NODE_FIELDS];
  for (int32_t f = 0; f < MPMI_NODE_FIELDS; ++f) {
    *field = f;
    names[f] = mpmi_node_fields[f].name;
    if (strcmp(name, names[f]) == 0) return MPM_OK;
  }
  return mpmi_refuse_name(context, "nodes have no field", name, names, MPMI_NODE_FIELDS);
}

mpm_status mpmi_nodes_ready(const mpm_stepper *s) {
  const int32_t shown = s->nodes.shown == s->layout.version;
  if (s->step.phase == MPMI_IDLE && !shown)
    return mpmi_fail(s->context, MPM_E_STATE, "there are no nodal fields: make a step or begin one first");
  return MPM_OK;
}

int32_t mpmi_node_keeps(const mpm_stepper *s, int32_t field) {
  if (field == MPMI_NODE_TEMPERATURE)
    return s->settings.heat.any && s->heat->version == s->layout.version &&
           s->heat->nodes.capacity >= 4 * mpmi_slots(&s->layout);
  return mpmi_has_increments(&s->nodes.solved) ||
         (field != MPMI_NODE_FORCE && field != MPMI_NODE_ACCELERATION);
}

mpm_status mpmi_node_check_kept(const mpm_stepper *s, int32_t field) {
  if (mpmi_node_keeps(s, field)) return MPM_OK;
  if (field == MPMI_NODE_TEMPERATURE)
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "no set had heat in the step: describe one by mpm_stepper_set_heat, and make a step");
  return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                   "a whole step of MPM_APIC_MLS does not keep \"%s\" apart: use a staged step, or MPM_APIC",
                   mpmi_node_fields[field].name);
}

static mpm_status write_back(mpm_stepper *s, int32_t field, const int64_t *slot, int64_t count,
                             const double *value) {
  for (int64_t i = 0; i < count * s->grid->dim; ++i) {
    if (isfinite(value[i])) continue;
    return mpmi_fail(s->context, MPM_E_ARG, "nodal \"%s\" is %g at node %lld: nothing was written",
                     mpmi_node_fields[field].name, value[i],
                     (long long)mpmi_blocks_number(&s->layout.blocks, slot[i % count]));
  }
  for (int64_t i = 0; i < count; ++i)
    for (int32_t c = 0; c < s->grid->dim; ++c) {
      const double mass = *mpmi_mass(&s->nodes.solved, slot[i]);
      double *v = mpmi_velocity(&s->nodes.solved, slot[i]) + c;
      double *second = mpmi_increment(&s->nodes.solved, slot[i]) + c;
      const double wanted = value[c * count + i];
      if (field == MPMI_NODE_FORCE) {
        *second = wanted;
      } else if (s->step.phase == MPMI_BEGUN) {
        /* untouched values must come back as they were: p / m * m rounds */
        if (wanted != *v / mass) *v = wanted * mass;
      } else {
        *second += wanted - *v;
        *v = wanted;
      }
    }
  return MPM_OK;
}

/* Ends a view: written values go back to the nodes. */
static mpm_status release_view(mpmi_view_record *record, mpm_view *view) {
  mpm_stepper *s = record->lender;
  record->live = 0;
  --s->mapped;
  view->data = view->owner = NULL;
  if (!(record->access & MPM_WRITE)) return MPM_OK;
  return write_back(s, record->field, s->active + record->first, record->items, record->data);
}

static mpm_status check_map(mpm_stepper *s, const char *field, int32_t access, const mpm_view *view,
                            int32_t *which) {
  mpm_context *c = s->context;
  mpm_status status = mpmi_view_check(c, view);
  if (status) return status;
  if (access != MPM_READ && access != MPM_WRITE && access != (MPM_READ | MPM_WRITE))
    return mpmi_fail(c, MPM_E_ARG, "access is %d: it must be MPM_READ, MPM_WRITE or both", (int)access);
  status = mpmi_node_require(c, field, which);
  if (!status) status = mpmi_nodes_ready(s);
  if (status) return status;
  if ((access & MPM_WRITE) && *which != MPMI_NODE_VELOCITY && *which != MPMI_NODE_FORCE)
    return mpmi_fail(c, MPM_E_ARG, "nodal \"%s\" cannot be written: only \"velocity\" and \"force\" can",
                     field);
  if ((access & MPM_WRITE) &&
      (s->step.phase == MPMI_IDLE || (*which == MPMI_NODE_FORCE && s->step.phase != MPMI_BEGUN)))
    return mpmi_fail(c, MPM_E_STATE, "nodal \"%s\" can be written %s only", field,
                     *which == MPMI_NODE_FORCE ? "between mpm_step_begin and mpm_step_grid"
                                               : "during a staged step");
  return mpmi_node_check_kept(s, *which);
}

mpm_status mpm_grid_map(mpm_stepper *s, int32_t body, const char *field, int32_t access, mpm_view *view) {
  MPMI_ENTER(s, MPMI_STEPPER);
  int32_t which, at = 0;
  int64_t first, count;
  mpm_status status = check_map(s, field, access, view, &which);
  if (status) return status;
  while (at < MPMI_NODE_VIEWS && s->view[at].live) ++at;
  if (at == MPMI_NODE_VIEWS)
    return mpmi_fail(s->context, MPM_E_STATE, "%d views of nodal fields are out: release one first",
                     MPMI_NODE_VIEWS);
  if ((status = mpmi_nodes_list(s, body, &first, &count))) return status;
  const int32_t components = components_of(s, which);
  const size_t bytes = mpmi_bytes(count * components, sizeof(double));
  if (bytes > s->view_bytes[at] || !s->view_memory[at]) {
    void *memory = mpmi_alloc(s->context, bytes);
    if (!memory) return MPM_E_NOMEM;
    mpmi_free(s->context, s->view_memory[at], s->view_bytes[at]);
    s->view_memory[at] = memory;
    s->view_bytes[at] = bytes;
  }
  mpmi_node_values(s, which, s->active + first, count, 1, count, s->view_memory[at]);
  s->view[at] = (mpmi_view_record){.live = 1,
                                   .field = which,
                                   .access = access,
                                   .context = s->context,
                                   .data = s->view_memory[at],
                                   .first = first,
                                   .items = count,
                                   .lender = s,
                                   .release = release_view};
  mpmi_view_fill(view, mpmi_node_fields[which].type, components, access, count, count, s->view_memory[at],
                 &s->view[at]);
  ++s->mapped;
  return MPM_OK;
}
