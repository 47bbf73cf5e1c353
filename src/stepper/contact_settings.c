/* Which sets are a body, and how bodies meet. */
#include "context/structs.h"
#include "implicit/balance.h"
#include "layout/members.h"
#include "obstacle/contact_desc.h"
#include "stepper/stepper.h"

#include <math.h>

/* ---- what is offered ----------------------------------------------------------------------------------- */
static mpm_status check_pair_offered(const mpm_stepper *s, const mpm_stepper_desc *d, int32_t a, int32_t b) {
  const int32_t low = a < b ? a : b, high = a < b ? b : a;
  double sign;
  if (low == high || low < 0) return MPM_OK;
  const mpm_contact_desc *rule = mpmi_contact_rule_of(&s->settings.contact, low, high, &sign);
  if (rule->kind == MPM_CONTACT_NONE) return MPM_OK;
  if (rule->adhesion > 0.0)
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "the contact of bodies %d and %d has adhesion, which MPM_NEWMARK does not offer: use "
                     "MPM_USL, MPM_USF or MPM_MUSL",
                     (int)low, (int)high);
  if (d->linear_solver == MPM_SOLVER_MULTIGRID_CG)
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "MPM_SOLVER_MULTIGRID_CG is for one body, and bodies %d and %d may touch: use "
                     "MPM_SOLVER_LDLT, MPM_SOLVER_CG or MPM_SOLVER_AUTO",
                     (int)low, (int)high);
  return MPM_OK;
}

mpm_status mpmi_check_bodies(const mpm_stepper *s, const mpm_stepper_desc *desc, int32_t with_body) {
  const mpmi_layout *layout = &s->layout;
  mpm_status status = MPM_OK;
  for (int32_t m = 0; m < layout->member_count && desc->scheme == MPM_NEWMARK; ++m)
    for (int32_t n = m + 1; n <= layout->member_count && !status; ++n)
      status = check_pair_offered(s, desc, layout->member[m].body,
                                  n < layout->member_count ? layout->member[n].body : with_body);
  return status;
}

/* ---- bodies -------------------------------------------------------------------------------------------- */
static mpm_status check_body(const mpm_stepper *s, int32_t body) {
  if (body >= 0 && body < MPMI_MAX_BODIES) return MPM_OK;
  return mpmi_fail(s->context, MPM_E_ARG, "body is %d: it must be 0 ... %d", (int)body, MPMI_MAX_BODIES - 1);
}

mpm_status mpm_stepper_set_body(mpm_stepper *s, mpm_particles *particles, int32_t body) {
  MPMI_ENTER(s, MPMI_STEPPER);
  int32_t m;
  mpm_status status = mpmi_stepper_idle(s);
  if (!status) status = mpmi_members_find(&s->layout, &s->settings, particles, &m);
  if (!status) status = check_body(s, body);
  if (status) return status;
  mpmi_member *member = &s->layout.member[m];
  const int32_t was = member->body;
  if (body == was) return MPM_OK;
  if (mpmi_is_total_lagrangian(s->grid))
    return mpmi_fail(
        s->context, MPM_E_UNSUPPORTED,
        "body is %d, and bodies meet in space, where the nodes of a grid with total_lagrangian = 1 "
        "are not: use total_lagrangian = 0, or an obstacle in the place of one body",
        (int)body);
  if (s->mapped)
    return mpmi_fail(s->context, MPM_E_STATE, "%d views of nodal fields are out: release them first",
                     (int)s->mapped);
  member->body = body;
  if ((status = mpmi_check_bodies(s, &s->settings.desc, -1))) {
    member->body = was;
    return status;
  }
  particles->dirty |= MPMI_DIRTY_PLACE;
  mpmi_layout_touches(&s->layout, &s->settings);
  s->nodes.shown = -1;
  return MPM_OK;
}

mpm_status mpm_stepper_body(const mpm_stepper *s, const mpm_particles *particles, int32_t *body) {
  MPMI_ENTER(s, MPMI_STEPPER);
  int32_t m;
  if (!body) return mpmi_fail(s->context, MPM_E_ARG, "body is NULL");
  const mpm_status status = mpmi_members_find(&s->layout, &s->settings, particles, &m);
  if (!status) *body = s->layout.member[m].body;
  return status;
}

/* ---- rules --------------------------------------------------------------------------------------------- */
mpm_status mpmi_contact_desc_check(const mpm_grid *grid, int32_t a, int32_t b, const mpm_contact_desc *d) {
  mpm_context *c = grid->context;
  mpm_status status;
  if ((status = mpmi_contact_desc_check_values(c, d)) ||
      (status = mpmi_check_choice(c, "normal", d->normal, "MPM_NORMAL_LOGISTIC ... MPM_NORMAL_FIXED",
                                  MPM_NORMAL_FIXED)) ||
      (status = mpmi_check_choice(c, "detection", d->detection, "MPM_DETECT_DEFAULT ... MPM_DETECT_VELOCITY",
                                  MPM_DETECT_VELOCITY)))
    return status;
  if (d->adhesion > 0.0 && mpmi_detects_by_velocity(d))
    return mpmi_fail(
        c, MPM_E_UNSUPPORTED,
        "the contact of bodies %d and %d has adhesion, which acts while a gap is closed, but is found by "
        "velocity: use MPM_DETECT_GAP",
        (int)a, (int)b);
  if (d->normal != MPM_NORMAL_FIXED) return MPM_OK;
  const double *n = d->direction, length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (!(fabs(length - 1.0) <= 1e-6))
    return mpmi_fail(c, MPM_E_ARG, "direction of the contact of bodies %d and %d has length %g: it must be 1",
                     (int)a, (int)b, length);
  for (int32_t k = grid->dim; k < 3; ++k)
    if (n[k] < 0.0 || n[k] > 0.0)
      return mpmi_fail(c, MPM_E_ARG, "direction[%d] is %g: a %d-D grid does not have the axis", (int)k, n[k],
                       (int)grid->dim);
  return MPM_OK;
}

static mpm_status check_pair(const mpm_stepper *s, int32_t a, int32_t b) {
  mpm_status status = a == MPM_BODY_ANY ? MPM_OK : check_body(s, a);
  if (!status && b != MPM_BODY_ANY) status = check_body(s, b);
  if (!status && a == b && a != MPM_BODY_ANY)
    status =
        mpmi_fail(s->context, MPM_E_ARG, "a body has no contact with itself: both bodies are %d", (int)a);
  return status;
}

mpm_status mpm_stepper_set_contact(mpm_stepper *s, int32_t body_a, int32_t body_b,
                                   const mpm_contact_desc *desc) {
  MPMI_ENTER(s, MPMI_STEPPER);
  mpm_contact_desc d;
  mpm_status status = mpmi_stepper_idle(s);
  if (!status) status = check_pair(s, body_a, body_b);
  if (!status && desc) status = mpmi_read_struct(s->context, "mpm_contact_desc", desc, sizeof d, &d);
  if (!status && desc) status = mpmi_contact_desc_check(s->grid, body_a, body_b, &d);
  if (status) return status;
  const int32_t low = body_a < body_b ? body_a : body_b, high = body_a < body_b ? body_b : body_a;
  if (desc && d.normal == MPM_NORMAL_FIXED) {
    double *n = d.direction;
    const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), sign = body_a > body_b ? -1.0 : 1.0;
    for (int32_t k = 0; k < 3; ++k) n[k] *= sign / length;
  }
  mpmi_contact_rules *rules = &s->settings.contact;
  const mpm_contact_desc *there = mpmi_contact_rule_at(rules, low, high);
  const int32_t had = there != NULL;
  const mpm_contact_desc was = had ? *there : (mpm_contact_desc){.struct_size = sizeof was};
  if ((status = mpmi_contact_rules_set(rules, s->context, low, high, desc ? &d : NULL))) return status;
  status = mpmi_check_bodies(s, &s->settings.desc, -1);
  if (status) /* there is room for what was there: this cannot fail */
    (void)mpmi_contact_rules_set(rules, s->context, low, high, had ? &was : NULL);
  if (s->newton) s->newton->version = -1; /* other nodes couple */
  return status;
}

mpm_status mpm_stepper_set_friction(mpm_stepper *s, mpm_friction_fn fn, void *user) {
  MPMI_ENTER(s, MPMI_STEPPER);
  const mpm_status status = mpmi_stepper_idle(s);
  if (status) return status;
  if (fn && mpmi_is_implicit(&s->settings))
    return mpmi_fail(
        s->context, MPM_E_UNSUPPORTED,
        "scheme MPM_NEWMARK has no friction callback: set friction in mpm_contact_desc, or use an "
        "explicit scheme");
  s->settings.friction = fn;
  s->settings.friction_user = user;
  return MPM_OK;
}
