/* How the sets of a stepper adapt: the host's descriptions, what steps and calls do, and reports. */
#include "context/structs.h"
#include "layout/members.h"
#include "stepper/together.h"
#include "parallel/migration.h"

#include <math.h>

static mpm_adaption_desc default_desc(void) {
  return (mpm_adaption_desc){.struct_size = sizeof(mpm_adaption_desc),
                             .every = 10,
                             .least_edge = 0.125,
                             .merge_distance = 0.25,
                             .merge_tolerance = 0.02};
}

mpm_status mpm_adaption_desc_init(mpm_adaption_desc *desc, uint32_t struct_size) {
  const mpm_adaption_desc defaults = default_desc();
  return mpmi_init_struct("mpm_adaption_desc", &defaults, sizeof defaults, desc, struct_size);
}

/* ---- descriptions ------------------------------------------------------------------------------------- */
static mpm_status check_positive(mpm_context *c, const char *name, double value) {
  if (value > 0.0 && isfinite(value)) return MPM_OK;
  return mpmi_fail(c, MPM_E_ARG, "%s is %g: it must be finite and > 0", name, value);
}

static mpm_status check_desc(mpm_context *c, const mpm_adaption_desc *d) {
  mpm_status status;
  if ((status = mpmi_check_count(c, "every", d->every)) ||
      (status = mpmi_check_count(c, "most_particles", d->most_particles)) ||
      (status = mpmi_check_magnitude(c, "split_edge", d->split_edge)) ||
      (status = check_positive(c, "least_edge", d->least_edge)) ||
      (status = check_positive(c, "merge_distance", d->merge_distance)) ||
      (status = mpmi_check_magnitude(c, "merge_tolerance", d->merge_tolerance)))
    return status;
  if (d->split_edge > 0.0 && d->split_edge < 2.0 * d->least_edge)
    return mpmi_fail(c, MPM_E_ARG,
                     "split_edge is %g and least_edge %g: it must be 0, or at least twice as long",
                     d->split_edge, d->least_edge);
  if (d->min_per_cell < 0 || d->max_per_cell < 0)
    return mpmi_fail(c, MPM_E_ARG, "min_per_cell is %d and max_per_cell %d: they must be >= 0",
                     (int)d->min_per_cell, (int)d->max_per_cell);
  if (d->max_per_cell > 0 && d->max_per_cell / 2 < d->min_per_cell)
    return mpmi_fail(c, MPM_E_ARG,
                     "max_per_cell is %d and min_per_cell %d: it must be 0, or at least twice as many",
                     (int)d->max_per_cell, (int)d->min_per_cell);
  return MPM_OK;
}

static mpm_status check_set(mpm_particles *set) {
  if (mpmi_is_total_lagrangian(set->grid))
    return mpmi_fail(
        set->context, MPM_E_UNSUPPORTED,
        "sets do not adapt where total_lagrangian is 1, because material does not come apart there: "
        "use them as they are");
  if (mpmi_material_kinematics(set->material) == MPMI_F_STAYS)
    return mpmi_fail(set->context, MPM_E_UNSUPPORTED,
                     "a rigid set does not adapt: fill it as densely as the grid needs");
  return mpmi_particles_changeable(set);
}

mpm_status mpm_stepper_set_adaption(mpm_stepper *s, mpm_particles *particles, const mpm_adaption_desc *desc) {
  MPMI_ENTER(s, MPMI_STEPPER);
  int32_t m;
  mpm_adaption_desc d = default_desc();
  mpm_status status = mpmi_stepper_idle(s);
  if (!status) status = mpmi_members_find(&s->layout, &s->settings, particles, &m);
  if (!status && desc) status = mpmi_read_struct(s->context, "mpm_adaption_desc", desc, sizeof d, &d);
  if (!status && desc) status = check_desc(s->context, &d);
  if (!status && desc) status = check_set(particles);
  if (!status && desc) status = mpmi_field_make_present(particles, MPMI_SIZE);
  if (status) return status;
  s->adaption[m].on = desc != NULL;
  s->adaption[m].desc = d;
  return MPM_OK;
}

/* ---- steps -------------------------------------------------------------------------------------------- */
static mpm_status plan(mpm_stepper *s, int32_t m, int32_t copy, double t) {
  const mpmi_adapting of = {.a = &s->adaption[m],
                            .set = s->layout.member[m].set,
                            .parts = s->layout.parts,
                            .settings = &s->settings,
                            .step = copy ? &s->step : NULL,
                            .m = m,
                            .copy = copy,
                            .t = t};
  const mpm_status status = mpmi_adaption_plan(&of);
  s->adaption[m].planned = !status && (s->adaption[m].split_total || s->adaption[m].pair_total);
  return status;
}

static void add_lost(mpmi_adaption *a, const double *lost) {
  a->sums.splits += a->split_total;
  a->sums.added += a->added;
  a->sums.merges += a->pair_total;
  a->sums.kinetic += lost[MPMI_LOST_KINETIC];
  a->sums.affine += lost[MPMI_LOST_AFFINE];
  a->sums.strain += lost[MPMI_LOST_STRAIN];
  for (int32_t c = 0; c < 3; ++c) a->sums.angular[c] += lost[MPMI_LOST_ANGULAR + c];
}

static void carry_out(mpm_stepper *s, int32_t m) {
  mpmi_adaption *a = &s->adaption[m];
  mpm_particles *set = s->layout.member[m].set;
  double lost[MPMI_LOST] = {0.0};
  if (!a->planned) return;
  for (int32_t i = 0; i < MPMI_LOST; ++i) mpmi_exact_clear(&a->lost[i]);
  mpmi_adaption_merge(a, &s->settings, set);
  mpmi_adaption_split(a, &s->settings, set);
  set->next_id += a->added;
  mpmi_particles_make_volumes(set, 0);
  mpmi_index_drop(set);
  set->dirty |= MPMI_DIRTY_PLACE | MPMI_DIRTY_SUMS | MPMI_DIRTY_ACCELERATION;
  if (a->added) set->dirty |= MPMI_DIRTY_IDS; /* whichever part they have come on */
  a->splits = a->pairs = a->planned = 0;
  if (mpmi_total_parts(s->context, MPMI_LOST, a->lost, lost))
    mpmi_forget(s->context); /* the other parts are lost, as the next call will say */
  add_lost(a, lost);
}

static int32_t is_due(const mpmi_adaption *a, int64_t step) {
  return a->on && a->desc.every > 0 && step % a->desc.every == 0;
}

/* Particles go to other parts with all their fields, which a host may have made on one alone. */
static mpm_status align_fields(mpm_stepper *s, int32_t m) {
  mpmi_moving_set set = {.set = s->layout.member[m].set};
  return s->layout.parts ? mpmi_move_align_fields(s->layout.parts, &set, 1) : MPM_OK;
}

mpm_status mpmi_adaption_begin(mpm_stepper *s) {
  mpm_status status = MPM_OK;
  for (int32_t m = 0; m < s->layout.member_count && !status; ++m)
    if (is_due(&s->adaption[m], s->history.step + 1)) status = align_fields(s, m);
  return status;
}

mpm_status mpmi_adaption_prepare(mpm_stepper *s) {
  mpm_status status = MPM_OK;
  for (int32_t m = 0; m < s->layout.member_count; ++m) s->adaption[m].planned = 0;
  for (int32_t m = 0; m < s->layout.member_count && !status; ++m)
    if (is_due(&s->adaption[m], s->history.step + 1)) status = plan(s, m, 1, s->step.t + s->step.dt);
  return status;
}

void mpmi_adaption_carry_out(mpm_stepper *s) {
  for (int32_t m = 0; m < s->layout.member_count; ++m) carry_out(s, m);
}

mpm_status mpm_stepper_adapt(mpm_stepper *s) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_status status = mpmi_stepper_idle(s);
  if (!status) status = mpmi_members_unmapped(&s->layout, &s->settings, "before they adapt");
  if (!status) status = mpmi_check_sets(s, MPM_READ | MPM_WRITE);
  if ((status = mpmi_together_begin(s, status, 0, NULL, NULL))) return status;
  for (int32_t m = 0; m < s->layout.member_count; ++m) s->adaption[m].planned = 0;
  for (int32_t m = 0; m < s->layout.member_count && !status; ++m) {
    if (!s->adaption[m].on) continue;
    status = mpmi_together(s, mpmi_particles_refresh(s->layout.member[m].set));
    if (!status) status = align_fields(s, m);
    if (!status) status = plan(s, m, 0, s->history.t);
  }
  if (!status) mpmi_adaption_carry_out(s);
  return status;
}

/* ---- reports ------------------------------------------------------------------------------------------ */
mpm_status mpm_stepper_adaption_info(const mpm_stepper *s, const mpm_particles *particles,
                                     mpm_adaption_info *info) {
  MPMI_ENTER(s, MPMI_STEPPER);
  int32_t m;
  const mpm_status status = mpmi_members_find(&s->layout, &s->settings, particles, &m);
  if (status) return status;
  const mpmi_adaption_sums *sums = &s->adaption[m].sums;
  const mpm_adaption_info now = {
      .struct_size = sizeof now,
      .splits = sums->splits,
      .added = sums->added,
      .merges = sums->merges,
      .kinetic_loss = sums->kinetic,
      .affine_loss = sums->affine,
      .strain_loss = sums->strain,
      .angular_momentum_loss = {sums->angular[0], sums->angular[1], sums->angular[2]}};
  return mpmi_write_struct(s->context, "mpm_adaption_info", &now, sizeof now, info);
}
