/* What holds nodes in an implicit step: the residual of their balance is the force of the constraint. It is
 * recorded as the boundary stage does: to the host and to prescribed particles what acts on the components
 * that they hold, the rest of a tie to the wall that binds it. */
#include "implicit/active_set.h"
#include "implicit/extension.h"
#include "boundary/bound.h"

#include <string.h>

/* Returns the inertia per mass that constraints of a row balance. Where particles take whole increments, what
 * holds a component gives it what they take: its acceleration at the end has the whole change in it. */
static double inertia_on(const mpmi_balance *balance, int64_t at) {
  if (!balance->step->whole_increments || !mpmi_is_held(balance->newton->matrix.held[at]))
    return mpmi_newmark_inertia(balance, at);
  return mpmi_mean_acceleration(balance, at);
}

/* Returns the force of constraints on a node; the node's own inertia is among what they balance. */
static double reaction_on(const mpmi_balance *balance, const mpmi_active_node *node, int32_t c) {
  const mpmi_newton *newton = balance->newton;
  const int64_t at = (int64_t)node->row * balance->settings->grid->dim + c;
  double force =
      mpmi_momentum(&newton->force, node->slot)[c] - mpmi_momentum(&newton->external, node->slot)[c];
  if (mpmi_is_dynamic(balance->settings))
    force += *mpmi_mass(&balance->nodes->solved, node->slot) * node->sign[c] * inertia_on(balance, at);
  return force;
}

/* Returns the force of contact and of springs on a row. Where the component is held, the holder and contact
 * each keep their own, and springs what they give as momentum. */
static double contact_on(const mpmi_balance *balance, int64_t row, int32_t c) {
  const mpmi_newton *newton = balance->newton;
  const int64_t at = row * balance->settings->grid->dim + c;
  if (!(newton->mass[row] > 0.0)) return 0.0;
  if (mpmi_is_held(newton->matrix.held[at]))
    return mpmi_contact_share(balance) * newton->vector[MPMI_SPRINGS][at];
  return newton->vector[MPMI_CONTACT][at] + newton->vector[MPMI_SPRINGS][at];
}

/* Returns the force by which outer and inner rows hold each other: what nothing else balances on the row. */
static double extension_on(const mpmi_balance *balance, int64_t row, int32_t c) {
  const mpmi_newton *newton = balance->newton;
  double force = -contact_on(balance, row, c);
  if (!mpmi_is_extended(newton, row) ||
      mpmi_is_held(newton->matrix.held[row * balance->settings->grid->dim + c]))
    return 0.0;
  for (int64_t m = newton->members_start[row]; m < newton->members_start[row + 1]; ++m) {
    const mpmi_active_node *node = &newton->active[newton->members[m]];
    force += node->sign[c] * reaction_on(balance, node, c);
  }
  return force;
}

/* Lets a slip wall have what it gives to an outer row by one of the inner ones: all of the share where the
 * wall holds that one, and twice as much where it mirrors it, for the other half of the body has the rest. */
static void record_mirror(mpmi_balance *balance, const mpmi_outer *outer, const mpmi_outer_term *term,
                          int32_t c) {
  const mpmi_newton *newton = balance->newton;
  const mpmi_constraints *constraints = &balance->layout->constraints;
  const int64_t inner = newton->master[term->row];
  const int32_t held = mpmi_is_held(newton->matrix.held[(int64_t)term->row * newton->matrix.block + c]);
  if (!held && term->face[c] < 0) return;
  const int32_t face = held ? constraints->tie[constraints->tie_of[inner]].face[c] : term->face[c];
  const double share = term->face[c] < 0 ? term->share[c] : -term->share[c];
  const double impulse =
      balance->step->dt * (held ? share : 2.0 * share) * extension_on(balance, outer->row, c);
  balance->nodes->impulse[held ? inner : newton->master[outer->row]].given[c] += impulse;
  if (mpmi_is_own_row(&newton->matrix, outer->row))
    mpmi_exact_add(&balance->step->work->tally.sum[MPMI_TALLY_FACES + 3 * face + c], impulse);
}

static void record_mirrors(mpmi_balance *balance) {
  const mpmi_newton *newton = balance->newton;
  const int32_t dim = newton->matrix.block;
  for (int64_t i = 0; i < newton->outer_count; ++i)
    for (int64_t t = mpmi_first_term(newton, i); t < newton->outer[i].end; ++t)
      for (int32_t c = 0; c < dim; ++c)
        if (newton->matrix.held[(int64_t)newton->outer[i].row * dim + c] == MPMI_ROW_OUTER)
          record_mirror(balance, &newton->outer[i], &newton->term[t], c);
}

/* Friction walls are surfaces. What they push has no other holder on the components that can move; along
 * those that cannot the holder's force has theirs in it. */
static void record_friction_walls(mpmi_balance *balance) {
  const mpmi_contact_nodes *contact = &balance->nodes->contact;
  for (int64_t i = 0; i < contact->touch_count; ++i) {
    const mpmi_touch *touch = &contact->touch[i];
    const mpmi_party *wall = &contact->party[touch->party[0]], *body = &contact->party[touch->party[1]];
    if (!touch->closed || wall->surface < 0 || contact->surface[wall->surface].face < 0) continue;
    for (int32_t c = 0; c < balance->settings->grid->dim; ++c) {
      if (!(body->inverse_mass[c] > 0.0)) continue;
      const double impulse = touch->normal_impulse * touch->normal[c] + touch->tangential[c];
      balance->nodes->impulse[body->slot].given[c] += impulse;
      balance->nodes->impulse[body->slot].change[c] += impulse * body->inverse_mass[c];
    }
  }
}

/* Books what holds a component of a node that moves by itself, and of its images: its impulse, and the same
 * along the motion of that node. */
static void book(mpmi_balance *balance, int64_t master, int32_t c, double total, double along) {
  const mpmi_constraints *constraints = &balance->layout->constraints;
  mpmi_whole_sum *tally = balance->step->work->tally.sum;
  if (mpmi_held_by(balance->nodes, master, c)) {
    mpmi_exact_add(&tally[MPMI_TALLY_WORK], along * balance->nodes->held_value[master][c]);
  } else {
    const mpmi_tie *tie = &constraints->tie[constraints->tie_of[master]];
    mpmi_exact_add(&tally[MPMI_TALLY_FACES + 3 * tie->face[c] + c], total);
  }
}

/* Records one component of one row, on the nodes that move with it. Each has its share of contact and of the
 * extension by mass. Of the force of contact in the balance bodies get a share as momentum, and so much of it
 * a wall undoes; where the row is held contact_on() returns that share. */
static void record_row(mpmi_balance *balance, int64_t row, int32_t c) {
  const mpmi_newton *newton = balance->newton;
  const mpmi_constraints *constraints = &balance->layout->constraints;
  const int32_t held = mpmi_is_held(newton->matrix.held[row * balance->settings->grid->dim + c]);
  const double dt = balance->step->dt, contact = contact_on(balance, row, c),
               beyond = held ? 0.0 : (1.0 - mpmi_contact_share(balance)) * contact,
               given = contact + extension_on(balance, row, c), as_momentum = given - beyond;
  const int32_t own = mpmi_is_own_row(&newton->matrix, row); /* one part books what happens there */
  double total = 0.0, along = 0.0, on_nodes = 0.0;
  for (int64_t m = newton->members_start[row]; m < newton->members_start[row + 1]; ++m) {
    const mpmi_active_node *node = &newton->active[newton->members[m]];
    const double mass = *mpmi_mass(&balance->nodes->solved, node->slot), all = reaction_on(balance, node, c);
    const double part = mass > 0.0 ? node->sign[c] * mass / newton->mass[row] : 0.0;
    const double impulse = dt * (all - part * given);
    balance->nodes->impulse[node->slot].given[c] = impulse;
    if (mass > 0.0)
      balance->nodes->impulse[node->slot].change[c] =
          dt * (all - part * (given - contact) - part * beyond) / mass;
    total += impulse;
    along += node->sign[c] * impulse;
    on_nodes += part * as_momentum;
  }
  const int64_t slot = newton->active[newton->members[newton->members_start[row]]].slot;
  const int32_t tie = constraints->tie_of[slot];
  const int64_t master = tie < 0 ? slot : constraints->tie[tie].master;
  if (mpmi_held_by(balance->nodes, master, c)) {
    if (own) book(balance, master, c, total, along);
  } else if (tie < 0) { /* nothing holds it: this is what the iterations have left */
    balance->nodes->impulse[slot].given[c] = balance->nodes->impulse[slot].change[c] = 0.0;
  } else if (constraints->tie[tie].face[c] >= 0) {
    /* a mirror image undoes a part of what its master is given: the wall has that */
    const double undone = dt * (on_nodes - as_momentum);
    balance->nodes->impulse[master].given[c] += undone;
    if (own) book(balance, master, c, total + undone, along);
  }
}

/* Records on a node without an unknown what carries the external force on it; returns its impulse. */
static double carry(mpmi_balance *balance, int64_t slot, int32_t c) {
  const double impulse = -balance->step->dt * mpmi_momentum(&balance->newton->external, slot)[c];
  const double mass = *mpmi_mass(&balance->nodes->solved, slot);
  balance->nodes->impulse[slot].given[c] = impulse;
  if (mass > 0.0) balance->nodes->impulse[slot].change[c] = impulse / mass;
  return impulse;
}

/* Records one component of a held node that has no unknown, for it has no stiffness, and of its images. */
static void record_carried(mpmi_balance *balance, int64_t master, int32_t c) {
  const mpmi_constraints *constraints = &balance->layout->constraints;
  const int32_t at = constraints->tie_of[master];
  const mpmi_tie *tie = at < 0 ? NULL : &constraints->tie[at];
  if (mpmi_holder_of(balance, master, c) == MPMI_ROW_FREE) return;
  double total = carry(balance, master, c), along = total;
  for (int64_t d = 0; tie && d < tie->count; ++d) {
    const mpmi_follower *follower = &constraints->follower[tie->first + d];
    const double impulse = carry(balance, follower->slot, c);
    total += impulse;
    along += follower->sign[c] * impulse;
  }
  if (mpmi_owns_node(balance->layout->parts, master)) book(balance, master, c, total, along);
}

mpm_status mpmi_record_reactions(mpmi_balance *balance) {
  if (!balance->nodes->has_impulses) return MPM_OK;
  const int64_t slots = mpmi_slots(balance->layout);
  if (slots) memset(balance->nodes->impulse, 0, (size_t)slots * sizeof *balance->nodes->impulse);
  for (int64_t r = 0; r < balance->newton->matrix.rows; ++r)
    for (int32_t c = 0; c < balance->settings->grid->dim; ++c) record_row(balance, r, c);
  record_mirrors(balance);
  for (int64_t i = 0; i < slots && balance->newton->carries_loads; ++i)
    for (int32_t c = 0; c < balance->settings->grid->dim; ++c)
      if (balance->newton->active_of[i] < 0 && mpmi_master_of(balance, i) == i) record_carried(balance, i, c);
  record_friction_walls(balance);
  if (!balance->nodes->prescription.any) return MPM_OK;
  mpmi_bound bound = {.step = balance->step,
                      .nodes = balance->nodes,
                      .values = &balance->nodes->solved,
                      .dim = balance->settings->grid->dim};
  return mpmi_prescribed_share(&bound);
}
