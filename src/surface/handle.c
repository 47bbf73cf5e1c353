/* Surfaces are made and destroyed here, and get their loads; all values of the host are checked before. */
#include "surface/surface.h"
#include "context/structs.h"

#include <math.h>

static const mpm_surface_desc defaults = {.struct_size = sizeof(mpm_surface_desc), .penalty = 100.0};

mpm_status mpm_surface_desc_init(mpm_surface_desc *desc, uint32_t struct_size) {
  return mpmi_init_struct("mpm_surface_desc", &defaults, sizeof defaults, desc, struct_size);
}

static mpm_status check_vector(mpm_context *c, const char *name, const double *v) {
  for (int32_t k = 0; k < 3; ++k)
    if (!isfinite(v[k]))
      return mpmi_fail(c, MPM_E_ARG, "mpm_surface_desc: %s[%d] is %g, must be finite", name, (int)k, v[k]);
  return MPM_OK;
}

static mpm_status check_prescription(mpm_context *c, const mpm_surface_desc *desc) {
  if (desc->prescribes < MPM_PRESCRIBES_NOTHING || desc->prescribes > MPM_PRESCRIBES_NORMAL)
    return mpmi_fail(c, MPM_E_ARG, "mpm_surface_desc: prescribes is %d, must be %d ... %d",
                     (int)desc->prescribes, (int)MPM_PRESCRIBES_NOTHING, (int)MPM_PRESCRIBES_NORMAL);
  if (!(desc->penalty > 0.0) || !isfinite(desc->penalty))
    return mpmi_fail(c, MPM_E_ARG, "mpm_surface_desc: penalty is %g, must be finite and > 0", desc->penalty);
  if (!(desc->modulus >= 0.0) || !isfinite(desc->modulus))
    return mpmi_fail(c, MPM_E_ARG, "mpm_surface_desc: modulus is %g, must be finite and >= 0", desc->modulus);
  return check_vector(c, "velocity", desc->velocity);
}

static mpm_status read_desc(mpm_context *c, const mpm_grid *grid, const mpm_surface_desc *desc,
                            mpm_surface_desc *out) {
  mpm_status status = MPM_OK;
  *out = defaults;
  if (desc) status = mpmi_read_struct(c, "mpm_surface_desc", desc, sizeof *out, out);
  if (status) return status;
  if (out->body < 0 || out->body >= MPMI_MAX_BODIES)
    return mpmi_fail(c, MPM_E_ARG, "mpm_surface_desc: body is %d, must be 0 ... %d", (int)out->body,
                     MPMI_MAX_BODIES - 1);
  if (!isfinite(out->pressure))
    return mpmi_fail(c, MPM_E_ARG, "mpm_surface_desc: pressure is %g, must be finite", out->pressure);
  if (!(out->max_spacing >= 0.0) || !isfinite(out->max_spacing))
    return mpmi_fail(c, MPM_E_ARG, "mpm_surface_desc: max_spacing is %g, must be finite and >= 0",
                     out->max_spacing);
  if ((status = check_vector(c, "traction", out->traction)) ||
      (status = check_vector(c, "dead_traction", out->dead_traction)) ||
      (status = check_prescription(c, out)))
    return status;
  for (int32_t k = grid->dim; k < 3; ++k) out->traction[k] = out->dead_traction[k] = out->velocity[k] = 0.0;
  return MPM_OK;
}

mpm_status mpm_surface_create(mpm_context *context, mpm_grid *grid, const mpm_surface_desc *desc,
                              mpm_surface **out) {
  if (out) *out = NULL;
  MPMI_ENTER_CONTEXT(context);
  mpm_surface_desc d;
  if (!out) return mpmi_fail(context, MPM_E_ARG, "out is NULL");
  if (!grid || grid->magic != (uint32_t)MPMI_GRID || grid->context != context)
    return mpmi_fail(context, MPM_E_ARG, "grid is NULL, destroyed or of another context");
  const mpm_status status = read_desc(context, grid, desc, &d);
  if (status) return status;
  mpm_surface *s = mpmi_alloc_zeroed(context, sizeof *s);
  if (!s) return MPM_E_NOMEM;
  s->magic = MPMI_SURFACE;
  s->context = context;
  s->grid = grid;
  s->desc = d;
  ++grid->children;
  ++context->children;
  *out = s;
  return MPM_OK;
}

mpm_status mpm_surface_destroy(mpm_surface *s) {
  if (!s) return MPM_OK;
  MPMI_ENTER(s, MPMI_SURFACE);
  mpm_context *c = s->context;
  if (s->stepper)
    return mpmi_fail(c, MPM_E_STATE, "a stepper holds the surface: call mpm_stepper_remove_surface() first");
  s->magic = 0;
  --s->grid->children;
  --c->children;
  mpmi_markers_free(c, &s->now);
  mpmi_markers_free(c, &s->next);
  MPMI_FREE_ARRAY(c, s->around.slot, s->around.slot_capacity);
  MPMI_FREE_ARRAY(c, s->around.weight, s->around.weight_capacity);
  MPMI_FREE_ARRAY(c, s->aim, s->aim_capacity);
  MPMI_FREE_ARRAY(c, s->site, s->site_capacity);
  MPMI_FREE_ARRAY(c, s->told, s->told_capacity);
  MPMI_FREE_ARRAY(c, s->batch, s->batch_capacity);
  MPMI_FREE_ARRAY(c, s->batch_id, s->id_capacity);
  mpmi_free(c, s, sizeof *s);
  return MPM_OK;
}

mpm_status mpm_surface_configure(mpm_surface *s, const mpm_surface_desc *desc) {
  MPMI_ENTER(s, MPMI_SURFACE);
  mpm_surface_desc d;
  mpm_status status = mpmi_surface_changeable(s);
  if (!status && !desc) status = mpmi_fail(s->context, MPM_E_ARG, "desc is NULL");
  if (!status) status = read_desc(s->context, s->grid, desc, &d);
  if (!status) s->desc = d;
  return status;
}

mpm_status mpm_surface_set_traction(mpm_surface *s, mpm_traction_fn fn, void *user) {
  MPMI_ENTER(s, MPMI_SURFACE);
  const mpm_status status = mpmi_surface_changeable(s);
  if (status) return status;
  s->traction = fn;
  s->traction_user = user;
  return MPM_OK;
}

mpm_status mpm_surface_set_velocity(mpm_surface *s, mpm_marker_velocity_fn fn, void *user) {
  MPMI_ENTER(s, MPMI_SURFACE);
  const mpm_status status = mpmi_surface_changeable(s);
  if (status) return status;
  s->velocity = fn;
  s->velocity_user = user;
  return MPM_OK;
}

int64_t mpm_surface_count(const mpm_surface *s) {
  return s && s->magic == (uint32_t)MPMI_SURFACE ? s->now.count : 0;
}
