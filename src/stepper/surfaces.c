/* The surfaces of a stepper: coming and going, and what a step begins and ends with. */
#include "stepper/stepper.h"
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
  surface->number = (int32_t)list->count;
  surface->stepper = s;
  surface->owner = &mpmi_stepper_owns;
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
  if (!status) status = MPMI_RESERVE_MORE(c, around->weight, around->weight_capacity, n * nodes * (1 + dim));
  if (!status && s->traction) status = MPMI_RESERVE_MORE(c, s->batch_id, s->id_capacity, n);
  if (!status && s->traction) status = MPMI_RESERVE_MORE(c, s->batch, s->batch_capacity, (5 * dim + 1) * n);
  around->nodes = (int32_t)nodes;
  around->gradient = around->weight + n * nodes;
  return status;
}

mpm_status mpmi_surfaces_prepare(const mpmi_settings *settings) {
  mpm_status status = MPM_OK;
  for (int64_t i = 0; i < settings->surfaces.count && !status; ++i) {
    mpm_surface *surface = settings->surfaces.surface[i];
    status = mpmi_markers_copy(settings->context, &surface->now, &surface->next);
    if (!status && surface->next.count) status = reserve(surface);
  }
  return status;
}

void mpmi_surfaces_commit(const mpmi_surfaces *list) {
  for (int64_t i = 0; i < list->count; ++i) {
    mpm_surface *surface = list->surface[i];
    const mpmi_markers old = surface->now;
    surface->now = surface->next;
    surface->next = old;
  }
}
