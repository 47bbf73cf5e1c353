/* Steppers are made and destroyed, take sets in and give them back, and change their description. */
#include "stepper/stepper.h"
#include "implicit/balance.h"
#include "layout/members.h"

#include <math.h>

/* ---- making and destroying ---------------------------------------------------------------------------- */
static void free_parts(mpm_stepper *s) {
  mpm_context *c = s->context;
  for (int32_t i = 0; i < MPMI_NODE_VIEWS; ++i) mpmi_free(c, s->view_memory[i], s->view_bytes[i]);
  MPMI_FREE_ARRAY(c, s->active, s->active_capacity);
  mpmi_contact_rules_free(&s->settings.contact, c);
  mpmi_obstacles_release(s);
  mpmi_surfaces_release(s);
  MPMI_FREE_ARRAY(c, s->settings.motion, s->settings.motion_capacity);
  MPMI_FREE_ARRAY(c, s->history.pairs.record, s->history.pairs.capacity);
  MPMI_FREE_ARRAY(c, s->history.reaction, s->history.reaction_capacity);
  MPMI_FREE_ARRAY(c, s->adaption, s->adaption_capacity);
  MPMI_FREE_ARRAY(c, s->settings.heat.set, s->settings.heat.capacity);
  mpmi_heat_free(s->heat, &s->settings);
  mpmi_newton_free(s->newton, &s->settings);
  mpmi_workspace_free(&s->work, &s->settings);
  mpmi_nodes_free(&s->nodes, c);
  mpmi_layout_free(&s->layout, &s->settings);
  s->magic = 0;
  mpmi_free(c, s, sizeof *s);
}

mpm_status mpm_stepper_create(mpm_context *context, mpm_grid *grid, const mpm_stepper_desc *desc,
                              mpm_stepper **out) {
  if (out) *out = NULL;
  MPMI_ENTER_CONTEXT(context);
  if (!out) return mpmi_fail(context, MPM_E_ARG, "out is NULL");
  if (!grid || grid->magic != (uint32_t)MPMI_GRID || grid->context != context)
    return mpmi_fail(context, MPM_E_ARG, "grid is NULL, destroyed or of another context");
  mpm_stepper_desc d;
  mpm_status status = mpmi_description_read(context, grid, desc, &d);
  if (status) return status;
  mpm_stepper *s = mpmi_alloc_zeroed(context, sizeof *s);
  if (!s) return MPM_E_NOMEM;
  s->context = context;
  s->grid = grid;
  s->settings = (mpmi_settings){.context = context,
                                .grid = grid,
                                .kernels = mpmi_kernels_of(context->isa),
                                .deformation = mpmi_deformation_of(context->isa),
                                .pull_back = mpmi_pull_back_of(context->isa),
                                .dilation = mpmi_dilation_of(context->isa),
                                .tasks = context->concurrency,
                                .desc = d,
                                .transfer = mpmi_transfer_of(d.transfer)};
  for (int32_t face = 0; face < 2 * grid->dim; ++face)
    if (mpmi_is_axis_face(grid, face)) s->settings.wall[face].kind = MPM_WALL_SLIP;
  s->pace = (mpmi_pace){.bound = MPMI_SHORT_STEP, .left = MPMI_SHORT_STEPS, .wait = MPMI_SHORT_STEPS};
  s->history.last.set = -1;
  s->history.last.particle = s->history.last.node = -1;
  s->nodes.shown = -1;
  if ((status = mpmi_layout_create(&s->layout, &s->settings)) ||
      (status = mpmi_workspace_create(&s->work, &s->settings))) {
    free_parts(s);
    return status;
  }
  s->magic = MPMI_STEPPER;
  ++context->children;
  ++grid->children;
  *out = s;
  return MPM_OK;
}

/* Takes a set in behind the others. On failure nothing has changed. */
static mpm_status take_in(mpm_stepper *s, mpm_particles *set) {
  const int32_t m = s->layout.member_count;
  mpm_status status;
  if ((status = MPMI_RESERVE_NEXT(s->context, s->settings.motion, s->settings.motion_capacity, m)) ||
      (status = MPMI_RESERVE_NEXT(s->context, s->history.reaction, s->history.reaction_capacity, m)) ||
      (status = MPMI_RESERVE_NEXT(s->context, s->adaption, s->adaption_capacity, m)) ||
      (status = MPMI_RESERVE_NEXT(s->context, s->settings.heat.set, s->settings.heat.capacity, m)) ||
      (status = mpmi_members_add(&s->layout, &s->settings, set)))
    return status;
  s->settings.motion[m] = (mpmi_motion){.fn = NULL};
  s->history.reaction[m] = (mpmi_reaction){.impulse = {0.0}};
  s->adaption[m] = (mpmi_adaption){.on = 0};
  s->settings.heat.set[m] = (mpmi_heat_rule){.on = 0};
  return MPM_OK;
}

static void take_out(mpm_stepper *s, int32_t m) {
  mpmi_heat_take_off(s, m);
  mpmi_members_remove(&s->layout, &s->settings, m);
  mpmi_adaption_free(&s->adaption[m], s->context);
  for (; m < s->layout.member_count; ++m) {
    s->settings.motion[m] = s->settings.motion[m + 1];
    s->history.reaction[m] = s->history.reaction[m + 1];
    s->adaption[m] = s->adaption[m + 1];
    s->settings.heat.set[m] = s->settings.heat.set[m + 1];
  }
}

mpm_status mpm_stepper_destroy(mpm_stepper *s) {
  if (!s) return MPM_OK;
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (s->mapped)
    return mpmi_fail(s->context, MPM_E_STATE, "%d views of nodal fields are out: release them first",
                     (int)s->mapped);
  if ((status = mpmi_members_unmapped(&s->layout, &s->settings, "first"))) return status;
  while (s->layout.member_count) take_out(s, s->layout.member_count - 1);
  --s->grid->children;
  --s->context->children;
  free_parts(s);
  return MPM_OK;
}

/* ---- sets --------------------------------------------------------------------------------------------- */
mpm_status mpm_stepper_add(mpm_stepper *s, mpm_particles *set) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (!set || set->magic != (uint32_t)MPMI_PARTICLES || set->context != s->context)
    return mpmi_fail(s->context, MPM_E_ARG, "particles is NULL, destroyed or of another context");
  if (set->grid != s->grid)
    return mpmi_fail(s->context, MPM_E_ARG, "the set was made on another grid than the stepper");
  if (set->stepper)
    return mpmi_fail(s->context, MPM_E_STATE, "the set already belongs to %s stepper",
                     set->stepper == s ? "this" : "another");
  if (set->mapped) return mpmi_fail(s->context, MPM_E_STATE, "the set is mapped: release its views first");
  if ((status = mpmi_check_bodies(s, &s->settings.desc, 0)) || (status = take_in(s, set))) return status;
  set->stepper = s;
  set->owner = &mpmi_stepper_owns;
  s->nodes.shown = -1;
  return MPM_OK;
}

mpm_status mpm_stepper_remove(mpm_stepper *s, mpm_particles *set) {
  MPMI_ENTER(s, MPMI_STEPPER);
  int32_t m;
  mpm_status status = mpmi_stepper_idle(s);
  if (!status && !set) status = mpmi_fail(s->context, MPM_E_NOT_FOUND, "the set is not in this stepper");
  if (!status) status = mpmi_members_find(&s->layout, &s->settings, set, &m);
  if (status) return status;
  if (set->mapped) return mpmi_fail(s->context, MPM_E_STATE, "the set is mapped: release its views first");
  take_out(s, m);
  s->history.has_sums = 0;
  s->nodes.shown = -1;
  return MPM_OK;
}

/* ---- another description ------------------------------------------------------------------------------ */
/* Refuses what the host has set and implicit steps do not offer. */
static mpm_status without_explicit_parts(const mpm_stepper *s) {
  if (mpmi_has_hooks(&s->settings))
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "scheme MPM_NEWMARK has no node hooks: unset them, or use an explicit scheme");
  if (s->settings.friction)
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "scheme MPM_NEWMARK has no friction callback: unset it, or use an explicit scheme");
  for (int64_t i = 0; i < s->settings.obstacles.count; ++i)
    if (s->settings.obstacles.obstacle[i]->desc.motion == MPM_MOTION_FREE)
      return mpmi_fail(
          s->context, MPM_E_UNSUPPORTED,
          "scheme MPM_NEWMARK has no free obstacles, and obstacle %lld is one: take it out, or use "
          "an explicit scheme",
          (long long)i);
  for (int32_t f = 0; f < 2 * s->grid->dim; ++f)
    if (mpmi_wall_kind_of(s->settings.wall[f].kind)->rubs == MPMI_RUBS_NODES)
      return mpmi_fail(
          s->context, MPM_E_UNSUPPORTED,
          "scheme MPM_NEWMARK has no walls of the kind MPM_WALL_FRICTION_NODES, and face %d is one: "
          "use MPM_WALL_FRICTION, or an explicit scheme",
          (int)f);
  return MPM_OK;
}

mpm_status mpm_stepper_configure(mpm_stepper *s, const mpm_stepper_desc *desc) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (!desc) return mpmi_fail(s->context, MPM_E_ARG, "desc is NULL");
  mpm_stepper_desc d;
  if ((status = mpmi_description_read(s->context, s->grid, desc, &d)) ||
      (status = d.scheme == MPM_NEWMARK ? without_explicit_parts(s) : MPM_OK) ||
      (status = mpmi_check_bodies(s, &d, -1)) ||
      (status = mpmi_members_unmapped(&s->layout, &s->settings, "first")) ||
      (status = mpmi_members_keep_fields(&s->layout, &s->settings, &d)))
    return status;
  if (!d.staggered || !s->settings.desc.staggered) s->history.previous_dt = 0.0;
  const int32_t becomes_implicit = d.scheme == MPM_NEWMARK && !mpmi_is_implicit(&s->settings);
  s->settings.desc = d;
  if (becomes_implicit) mpmi_layout_widen(&s->layout, MPMI_WIDE_FOR_IMPLICIT);
  s->settings.transfer = mpmi_transfer_of(d.transfer);
  s->history.has_sums = 0; /* the angular momentum depends on the transfer */
  return MPM_OK;
}

mpm_status mpm_stepper_set_time(mpm_stepper *s, double t, int64_t step) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (!isfinite(t)) return mpmi_fail(s->context, MPM_E_ARG, "t is %g: it must be finite", t);
  if (step == INT64_MAX)
    return mpmi_fail(s->context, MPM_E_ARG, "step is %lld: there is none after it", (long long)step);
  if ((status = mpmi_check_count(s->context, "step", step))) return status;
  s->history.t = t;
  s->history.step = step;
  s->history.totals = (mpmi_totals){.external_work = 0.0};
  mpmi_pairs_forget(&s->history.pairs);
  mpmi_surfaces_forget(&s->settings.surfaces);
  s->history.heat.total = (mpmi_heat_sums){.gained = 0.0};
  for (int32_t m = 0; m < s->layout.member_count; ++m) {
    for (int32_t c = 0; c < 3; ++c) s->history.reaction[m].impulse_total[c] = 0.0;
    s->adaption[m].sums = (mpmi_adaption_sums){.splits = 0};
  }
  return MPM_OK;
}
