/* Contact in implicit steps: an active set inside Newton's method, by an augmented Lagrangian
 * (docs/theory.md, 9.4). Normals and gaps are those of the start of the step, and each touch that may close
 * is a constraint between two rows, or between a row and what is moved from outside:
 *
 *   G = max(0, gap) + n . (u_b - u_a) >= 0,   force >= 0,   G force = 0.
 *
 * Closed touches add a stiffness to the matrix; after each increment their forces grow by that stiffness
 * times what is left of G, until nothing is left. What sticks is held across the normal as well; what slides
 * has the friction of its normal force, which makes the matrix unsymmetric. */
#ifndef MPMI_ACTIVE_SET_H
#define MPMI_ACTIVE_SET_H

#include "contact/contact.h"
#include "implicit/balance.h"
#include "simd/vector3.h"

/* Constraints hold to this, in spacings. */
#define MPMI_CONTACT_HOLDS_TO 1e-8

/* Returns how much more of a contact force the balance has: mass_damping acts on the velocity at the end of
 * the step, which that force changes by (2 beta - gamma) dt / m beyond Newmark's rule. With 2 beta >= gamma
 * displacements make up for that (mpmi_damping_excess). */
static inline double mpmi_contact_in_balance(const mpmi_balance *balance) {
  const mpm_stepper_desc *desc = &balance->settings->desc;
  const double below = desc->newmark_gamma - 2.0 * desc->newmark_beta;
  return below > 0.0 ? 1.0 + desc->mass_damping * balance->step->dt * below : 1.0;
}

/* Returns the share of a contact force in the balance that bodies get as momentum. The balance is that of
 * displacements; the force of contact acts wholly at the end of the step (Kane, Repetto, Ortiz & Marsden
 * 1999), with dt^2 / 2 on displacements and dt on velocities. */
static inline double mpmi_contact_share(const mpmi_balance *balance) {
  return mpmi_is_dynamic(balance->settings)
             ? 2.0 * mpmi_damped_beta(balance) / mpmi_contact_in_balance(balance)
             : 1.0;
}

/* ---- small parts --------------------------------------------------------------------------------------- */
/* Splits a vector into its length along n and the rest. */
static inline void mpmi_split(const double *v, const double *n, double *along, double *across) {
  *along = mpmi_inner(v, n);
  for (int32_t c = 0; c < 3; ++c) across[c] = v[c] - *along * n[c];
}

static inline const mpmi_touch *mpmi_touch_of(const mpmi_balance *balance, const mpmi_constraint *of) {
  return &balance->nodes->contact.touch[of->touch];
}

static inline int32_t mpmi_is_tie(const mpmi_balance *balance, const mpmi_constraint *of) {
  return mpmi_touch_of(balance, of)->rule->kind == MPM_CONTACT_TIED;
}

/* Returns 1 when friction acts on what slides. */
static inline int32_t mpmi_slides(const mpmi_balance *balance, const mpmi_constraint *of) {
  return !mpmi_is_tie(balance, of) && !of->stuck && !of->smooth && mpmi_touch_of(balance, of)->friction > 0.0;
}

/* Finds the displacement of the second party relative to the first. */
static inline void mpmi_relative(const mpmi_balance *balance, const mpmi_constraint *of, const double *u,
                                 double *to) {
  const int32_t dim = balance->settings->grid->dim;
  for (int32_t c = 0; c < 3; ++c) to[c] = of->moves[c];
  for (int32_t c = 0; c < dim; ++c)
    for (int32_t i = 0; i < 2; ++i)
      if (of->row[i] >= 0) to[c] += (i ? 1.0 : -1.0) * u[(int64_t)of->row[i] * dim + c];
}

/* Returns how far what holds a component of a node takes it. */
static inline double mpmi_held_way(const mpmi_balance *balance, int64_t slot, int32_t c) {
  return mpmi_held_by(balance->nodes, slot, c) ? balance->step->dt * balance->nodes->held_value[slot][c]
                                               : 0.0;
}

/* Takes out what friction and ties cannot stop, because nothing moves there by itself. */
static inline void mpmi_stoppable(const mpmi_constraint *of, double *move) {
  for (int32_t c = 0; c < 3; ++c) move[c] = of->free[c] ? move[c] : 0.0;
}

/* ---- the step ------------------------------------------------------------------------------------------ */
/* Of several parts each has the touches of the nodes that it meets, as in explicit steps, and does the same
 * with those that others have, too. What all of them decide together is marked (collective).
 *
 * Finds the touches that may close in the step, from the velocities of its start, and guesses which do
 * (collective). */
mpm_status mpmi_active_set_find(mpmi_balance *balance);
/* Closes what is open yet within a part of a cell, so that it may hold a body that nothing else holds; tells
 * whether that is any touch (collective). */
mpm_status mpmi_active_set_hold(mpmi_balance *balance, int32_t *any);
/* Adds the stiffness of closed touches to the matrix (collective), and to the right-hand side what they still
 * lack. */
mpm_status mpmi_active_set_stiffen(mpmi_balance *balance);
void mpmi_active_set_load(const mpmi_balance *balance, double *rhs);
/* Puts the forces as they are on the rows. */
void mpmi_active_set_fold(mpmi_balance *balance);
/* Finds the forces after a whole increment of the displacements; then takes a share of their change. */
void mpmi_active_set_aim(mpmi_balance *balance, const double *du);
void mpmi_active_set_move(mpmi_balance *balance, double share);
/* Closes and opens touches by the displacements and forces as they are, and bounds friction; tells whether
 * any has changed (collective). */
mpm_status mpmi_active_set_update(mpmi_balance *balance, int32_t *changed);
/* Makes closed touches stiffer that come closer slowly where all else is in balance. */
void mpmi_active_set_harden(mpmi_balance *balance);
/* Returns by how much closed touches miss, as a multiple of what they may (collective; not a number where the
 * other parts are lost). */
double mpmi_active_set_error(const mpmi_balance *balance);
/* Tells touches and reports what contact did (collective). MPM_CUT_DT: bodies slid too far for one step. */
mpm_status mpmi_active_set_finish(mpmi_balance *balance);
/* Asks the touches that mean something how far they have slid (collective). MPM_CUT_DT: too far. */
mpm_status mpmi_active_set_check_slips(mpmi_balance *balance);
/* Measures the gaps of closed touches where particles have come to (collective). MPM_CUT_DT: bodies have come
 * to overlap too far. */
mpm_status mpmi_active_set_look_back(mpmi_balance *balance);

#endif
