/* The surfaces of a stepper: coming and going, what a step begins and ends with, reports. */
#include "stepper/together.h"
#include "transfer/weights.h"

/* ---- coming and going ---------------------------------------------------------------------------------- */
mpm_status mpm_stepper_add_surface(mpm_stepper *s, mpm_surface *surface) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_context *c = s->context;
  mpmi_surfaces *list = &s->settings.surfaces;
  mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (!surface || surface->magic != (uint32_t)MPMI_SURFACE || surface->context != c)
    return mpmi_fail(c, MPM_E_ARG, "surface is NULL, destroyed or of another context");
  if (surface->grid != s->grid)
    return mpmi_fail(c, MPM_E_ARG, "the surface was made on another grid than the stepper");
  if (surface->stepper)
    return mpmi_fail(c, MPM_E_STATE, "the surface already belongs to %s stepper",
                     surface->stepper == s ? "this" : "another");
  if ((status = MPMI_RESERVE_NEXT(c, list->surface, list->capacity, list->count))) return status;
  /* nodes around a marker beside a node of a part, and around the markers beside these, are whole then */
  if (!list->count) mpmi_layout_widen(&s->layout, MPMI_WIDE_FOR_MARKERS);
  surface->number = (int32_t)list->count;
  surface->stepper = s;
  surface->owner = &mpmi_stepper_owns;
  surface->impulses = (mpmi_surface_impulses){{0.0}, {0.0}};
  list->surface[list->count++] = surface;
  return MPM_OK;
}

static void let_go(mpm_surface *surface) {
  surface->stepper = NULL;
  surface->owner = NULL;
}

mpm_status mpm_stepper_remove_surface(mpm_stepper *s, mpm_surface *surface) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpmi_surfaces *list = &s->settings.surfaces;
  const mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  int64_t at = 0;
  while (at < list->count && list->surface[at] != surface) ++at;
  if (at == list->count) return mpmi_fail(s->context, MPM_E_NOT_FOUND, "the surface is not in this stepper");
  let_go(surface);
  for (--list->count; at < list->count; ++at) {
    list->surface[at] = list->surface[at + 1];
    list->surface[at]->number = (int32_t)at;
  }
  return MPM_OK;
}

void mpmi_surfaces_release(mpm_stepper *s) {
  mpmi_surfaces *list = &s->settings.surfaces;
  for (int64_t i = 0; i < list->count; ++i) let_go(list->surface[i]);
  MPMI_FREE_ARRAY(s->context, list->surface, list->capacity);
  *list = (mpmi_surfaces){0, 0, NULL};
}

/* ---- steps --------------------------------------------------------------------------------------------- */
/* Makes room for the nodes around the markers and for what a callback sees. */
static mpm_status reserve(mpm_surface *s) {
  const int32_t dim = s->grid->dim;
  const int64_t n = s->next.count;
  mpm_context *c = s->context;
  mpmi_marker_nodes *around = &s->around;
  int64_t nodes = 1;
  for (int32_t k = 0; k < dim; ++k) nodes *= s->grid->width;
  mpm_status status = MPMI_RESERVE_MORE(c, around->slot, around->slot_capacity, n * nodes);
  const int32_t prescribes = mpmi_surface_prescribes(s);
  const int64_t each = nodes * (1 + dim + prescribes);
  if (!status) status = MPMI_RESERVE_MORE(c, around->weight, around->weight_capacity, n * each);
  const int32_t asks = s->traction || (s->velocity && prescribes);
  if (!status && asks) status = MPMI_RESERVE_MORE(c, s->batch_id, s->id_capacity, n);
  if (!status && asks) status = MPMI_RESERVE_MORE(c, s->batch, s->batch_capacity, (5 * dim + 1) * n);
  if (!status && prescribes) status = MPMI_RESERVE_MORE(c, s->aim, s->aim_capacity, n);
  if (!status && prescribes) status = MPMI_RESERVE_MORE(c, s->site, s->site_capacity, n * nodes);
  around->nodes = (int32_t)nodes;
  if (!status && !mpmi_is_whole(c))
    status = MPMI_RESERVE_MORE(c, s->told, s->told_capacity, mpmi_surface_told_words(s));
  around->gradient = around->weight + n * nodes;
  around->plain = prescribes ? around->gradient + n * nodes * dim : NULL;
  return status;
}

mpm_status mpmi_surfaces_prepare(const mpmi_settings *settings) {
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < settings->surfaces.count && !status; ++i) {
    mpm_surface *surface = settings->surfaces.surface[i];
    status = mpmi_markers_copy(settings->context, &surface->now, &surface->next);
    if (!status && surface->next.count) status = reserve(surface);
    surface->impulse[0] = surface->impulse[1] = surface->impulse[2] = 0.0;
  }
  return status;
}

void mpmi_surfaces_commit(const mpmi_surfaces *list) {
  for (int64_t i = 0; i < list->count; ++i) {
    mpm_surface *surface = list->surface[i];
    const mpmi_markers old = surface->now;
    surface->now = surface->next;
    surface->next = old;
    for (int32_t c = 0; c < 3; ++c) {
      surface->impulses.last[c] = surface->impulse[c];
      surface->impulses.total[c] += surface->impulse[c];
    }
  }
}

/* ---- reports ------------------------------------------------------------------------------------------- */
void mpmi_surfaces_forget(const mpmi_surfaces *list) {
  for (int64_t i = 0; i < list->count; ++i)
    for (int32_t c = 0; c < 3; ++c) list->surface[i]->impulses.total[c] = 0.0;
}

static mpm_status check_member(const mpm_stepper *s, const mpm_surface *surface, const double *out,
                               const char *name) {
  mpm_context *c = s->context;
  if (!out) return mpmi_fail(c, MPM_E_ARG, "%s is NULL", name);
  if (!surface || surface->magic != (uint32_t)MPMI_SURFACE || surface->context != c)
    return mpmi_fail(c, MPM_E_ARG, "surface is NULL, destroyed or of another context");
  if (surface->stepper == s) return MPM_OK;
  return mpmi_fail(c, MPM_E_NOT_FOUND, "the surface is not in this stepper");
}

mpm_status mpm_stepper_surface_reaction(const mpm_stepper *s, const mpm_surface *surface, double *force) {
  MPMI_ENTER(s, MPMI_STEPPER);
  const mpm_status status = check_member(s, surface, force, "force");
  if (status) return status;
  if (!s->history.has_reactions) return mpmi_fail(s->context, MPM_E_STATE, "no step has been made yet");
  for (int32_t c = 0; c < s->grid->dim; ++c) force[c] = surface->impulses.last[c] / s->history.reaction_dt;
  return MPM_OK;
}

mpm_status mpm_stepper_surface_impulse(const mpm_stepper *s, const mpm_surface *surface, double *impulse) {
  MPMI_ENTER(s, MPMI_STEPPER);
  const mpm_status status = check_member(s, surface, impulse, "impulse");
  if (status) return status;
  for (int32_t c = 0; c < s->grid->dim; ++c) impulse[c] = surface->impulses.total[c];
  return MPM_OK;
}
