/* Damping of nodes in explicit steps (docs/theory.md, 7.2), on folded ties, between the hook after the forces
 * and the first that holds a node. With the projected velocity v and the increment dv = dt f / m of a
 * component,
 *
 *   local (Cundall 1987)   dv' = dv - alpha |dv| sign(v)
 *   by mass                dv' = (dv - a dt v) / (1 + a dt / 2), which is -a (v + v~) / 2 per mass and time
 *
 * one after the other. A component that is held moves as its holder says, and keeps its force whole: damped,
 * it would only spoil the reaction. */
#include "boundary/bound.h"

#include <math.h>

/* Returns the increment that damping leaves of dv. */
static double damped(const mpmi_step *step, double v, double dv) {
  const mpm_stepper_desc *desc = &step->settings->desc;
  const double against = v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0, rate = desc->mass_damping * step->velocity_dt;
  const double gained = dv - desc->local_damping * fabs(dv) * against;
  return (gained - rate * v) / (1.0 + 0.5 * rate);
}

static int32_t is_held(const mpmi_bound *bound, int64_t slot, int32_t c) {
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  const int32_t tie = constraints->tie_of[slot];
  return mpmi_held_by(bound->nodes, slot, c) || (tie >= 0 && constraints->tie[tie].zero[c]);
}

static void damp_node(mpmi_bound *bound, int64_t slot) {
  double *impulse = bound->nodes->damping_impulse[slot];
  impulse[0] = impulse[1] = impulse[2] = 0.0;
  if (!mpmi_moves(bound, slot)) return;
  for (int32_t c = 0; c < bound->dim; ++c) {
    if (is_held(bound, slot, c)) continue;
    const double dv = mpmi_increment(bound->values, slot)[c], v = mpmi_velocity(bound->values, slot)[c] - dv;
    const double change = damped(bound->step, v, dv) - dv;
    impulse[c] = mpmi_moving_mass(bound, slot) * change;
    mpmi_shift_node(bound, slot, c, change, change);
  }
}

static void damp_task(void *data, int64_t k) {
  mpmi_bound *bound = data;
  const mpmi_share share = mpmi_share_of(bound->step->settings, mpmi_slots(bound->step->layout), k);
  for (int64_t slot = share.begin; slot < share.end; ++slot) damp_node(bound, slot);
}

/* Adds up what damping took: its impulse times the mean velocity of the node. */
static void sum_task(void *data, int64_t k) {
  const mpmi_bound *bound = data;
  const mpmi_share share = mpmi_share_of(bound->step->settings, mpmi_slots(bound->step->layout), k);
  for (int64_t slot = share.begin; slot < share.end; ++slot) {
    double taken = 0.0;
    for (int32_t c = 0; c < bound->dim; ++c)
      taken -= bound->nodes->damping_impulse[slot][c] *
               (mpmi_velocity(bound->values, slot)[c] - 0.5 * mpmi_increment(bound->values, slot)[c]);
    if (!mpmi_owns_node(bound->step->layout->parts, slot)) continue;
    mpmi_exact_add(&bound->step->work->report[k].damping, taken);
  }
}

mpm_status mpmi_damp(mpmi_bound *bound) {
  return mpmi_is_damped(bound->step->settings) ? mpmi_run_bound(bound, damp_task) : MPM_OK;
}

mpm_status mpmi_damping_sum(mpmi_bound *bound) {
  return mpmi_is_damped(bound->step->settings) ? mpmi_run_bound(bound, sum_task) : MPM_OK;
}
