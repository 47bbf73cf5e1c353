/* What contact did in an implicit step, as the sweeps of explicit steps tell it. */
#include "implicit/active_set.h"
#include "boundary/bound.h"

#include <math.h>

/* Tells a touch what was done to it. */
static void tell(mpmi_balance *balance, const mpmi_constraint *of) {
  mpmi_contact_nodes *contact = &balance->nodes->contact;
  mpmi_touch *touch = &contact->touch[of->touch];
  const double dt = balance->step->dt, seconds = dt * mpmi_contact_share(balance);
  double move[3], impulse[3], along, across[3];
  for (int32_t c = 0; c < 3; ++c) impulse[c] = of->closed ? seconds * of->force[c] : 0.0;
  mpmi_split(impulse, touch->normal, &touch->normal_impulse, touch->tangential);
  mpmi_relative(balance, of, balance->newton->vector[MPMI_U], move);
  mpmi_split(move, touch->normal, &along, across);
  touch->closed = of->closed && (mpmi_inner(impulse, impulse) > 0.0 || mpmi_is_tie(balance, of));
  touch->ambiguous |= of->gives_way;
  touch->stuck = touch->closed && (mpmi_is_tie(balance, of) || of->stuck);
  /* force times way, of which constraints that hold have but the gap that they close */
  touch->friction_work =
      touch->closed && !touch->stuck ? fmax(0.0, -mpmi_inner(touch->tangential, across) / dt) : 0.0;
  touch->dissipation = touch->friction_work;
  if (touch->closed && !mpmi_is_tie(balance, of))
    touch->dissipation += touch->normal_impulse * of->allowed / dt;
  touch->work = 0.0;
  const mpmi_party *first = &contact->party[touch->party[0]];
  if (first->surface >= 0) touch->work = -mpmi_inner(impulse, of->moves) / dt;
  for (int32_t i = 0; i < 2; ++i) {
    mpmi_party *party = &contact->party[touch->party[i]];
    for (int32_t c = 0; c < 3 && (first->surface < 0 || contact->surface[first->surface].face < 0); ++c)
      party->given[c] += (i ? impulse[c] : -impulse[c]) * party->inverse_mass[c];
  }
}

mpm_status mpmi_active_set_finish(mpmi_balance *balance) {
  const mpmi_newton *newton = balance->newton;
  const mpm_status status = newton->touches ? mpmi_active_set_check_slips(balance) : MPM_OK;
  if (status) return status;
  for (int64_t k = 0; k < newton->constraint_count; ++k) tell(balance, &newton->constraint[k]);
  mpmi_bound bound = {.step = balance->step,
                      .nodes = balance->nodes,
                      .values = &balance->nodes->solved,
                      .dim = balance->settings->grid->dim};
  mpmi_body_contacts_sum(&bound);
  return MPM_OK;
}
