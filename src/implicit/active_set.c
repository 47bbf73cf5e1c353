/* Which touches may close in an implicit step, and which are closed, stick or slide. */
#include "implicit/active_set.h"
#include "boundary/bound.h"

#include <math.h>
#include <string.h>

/* Touches no wider than this, in spacings, are closed at first where nothing else tells, and wider ones where
 * these leave a body unheld. */
static const double close_by = 0.05, still_close_by = 0.25;
/* Those that slide by more than this, in spacings, go on sliding at first. */
static const double slides_by = 1e-3;
/* One that has changed so often stays closed where it has no way to go, or has no friction in this step:
 * neither can give energy. */
enum { MOST_CHANGES = 3, MOST_STALLS = 4 };
/* What a closed touch misses falls by the ratio of the stiffnesses, to a thousandth. Where it is more than
 * this share, the node is held by other touches too, and resists by more than its own stiffness. */
static const double slowly = 0.1, harder = 10.0;

/* ---- finding constraints ------------------------------------------------------------------------------- */
/* Finds the row of a party, or how it moves without one. */
static void place(const mpmi_balance *balance, const mpmi_party *party, int32_t which, mpmi_constraint *of) {
  const mpmi_newton *newton = balance->newton;
  const double dt = balance->step->dt, sign = which ? 1.0 : -1.0;
  of->row[which] = -1;
  if (party->surface >= 0) {
    double v[3];
    mpmi_surface_velocity(&balance->nodes->contact.surface[party->surface], party->arm, v);
    for (int32_t c = 0; c < balance->settings->grid->dim; ++c)
      of->moves[c] += sign * dt * (v[c] + party->own_velocity[c]);
  } else if (newton->active_of[party->slot] >= 0) {
    of->row[which] = newton->active[newton->active_of[party->slot]].row;
  } else {
    for (int32_t c = 0; c < balance->settings->grid->dim; ++c)
      of->moves[c] += sign * mpmi_held_way(balance, party->slot, c);
  }
}

/* Guesses whether a touch closes and sticks, from the velocities of the start of the step. */
static void guess(const mpmi_balance *balance, mpmi_constraint *of, const double *predicted) {
  const mpmi_touch *touch = mpmi_touch_of(balance, of);
  const double h = balance->settings->grid->h_min,
               near = mpmi_is_dynamic(balance->settings) ? 1e-6 : close_by;
  double move[3], along, across[3];
  mpmi_relative(balance, of, predicted, move);
  mpmi_split(move, touch->normal, &along, across);
  of->closed = mpmi_is_tie(balance, of) || of->allowed + along <= near * h;
  of->stuck = touch->friction_static > 0.0 && sqrt(mpmi_inner(across, across)) <= slides_by * h;
}

/* Returns 1 when the touch can close, and its gap is known. Nodes that are too light for a row of their own
 * have no part in contact; what is held across the normal but for a hair would be thrown aside. */
static int32_t is_possible(const mpmi_balance *balance, mpmi_touch *touch) {
  const mpmi_contact_nodes *contact = &balance->nodes->contact;
  const int32_t tied = touch->rule->kind == MPM_CONTACT_TIED;
  double along = 0.0, most = 0.0;
  for (int32_t i = 0; i < 2; ++i) {
    const mpmi_party *party = &contact->party[touch->party[i]];
    const double *inverse = party->inverse_mass;
    const int32_t has_row = party->surface < 0 && balance->newton->active_of[party->slot] >= 0;
    for (int32_t c = 0; c < 3; ++c) {
      if (inverse[c] > 0.0 && !has_row) return 0;
      along += (tied ? 1.0 : touch->normal[c] * touch->normal[c]) * inverse[c];
      most = fmax(most, inverse[c]);
    }
  }
  touch->ambiguous = !(along > MPMI_NEARLY_HELD * most);
  return !touch->ambiguous &&
         (tied || mpmi_detects_by_velocity(touch->rule) || touch->gap < (double)INFINITY);
}

static mpm_status check_offered(const mpmi_balance *balance) {
  const mpmi_contact_nodes *contact = &balance->nodes->contact;
  for (int64_t i = 0; i < contact->touch_count; ++i)
    if (contact->touch[i].rule->adhesion > 0.0)
      return mpmi_fail(
          balance->settings->context, MPM_E_UNSUPPORTED,
          "scheme MPM_NEWMARK has no adhesion, and an obstacle has one of %g: set it to 0, or use "
          "an explicit scheme",
          contact->touch[i].rule->adhesion);
  return MPM_OK;
}

static mpm_status list_constraints(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  mpmi_contact_nodes *contact = &balance->nodes->contact;
  const int32_t dim = balance->settings->grid->dim;
  double *predicted = newton->vector[MPMI_TERMS];
  mpm_status status = check_offered(balance);
  if (!status)
    status = MPMI_RESERVE_MORE(balance->settings->context, newton->constraint, newton->constraint_capacity,
                               contact->touch_count);
  if (status) return status;
  const double coasts = mpmi_is_dynamic(balance->settings) ? balance->step->dt : 0.0;
  for (int64_t i = 0; i < newton->matrix.rows * dim; ++i)
    predicted[i] = mpmi_is_held(newton->matrix.held[i]) ? newton->vector[MPMI_TARGET][i]
                                                        : coasts * newton->vector[MPMI_V0][i];
  for (int64_t t = 0; t < contact->touch_count; ++t) {
    mpmi_touch *touch = &contact->touch[t];
    touch->closed = touch->stuck = 0;
    if (touch->ambiguous || !is_possible(balance, touch)) continue;
    mpmi_constraint *of = &newton->constraint[newton->constraint_count++];
    *of = (mpmi_constraint){.touch = t, .coupling = {-1, -1}};
    for (int32_t i = 0; i < 2; ++i) {
      const mpmi_party *party = &contact->party[touch->party[i]];
      place(balance, party, i, of);
      for (int32_t c = 0; c < 3; ++c) of->free[c] |= party->inverse_mass[c] > 0.0;
    }
    if (!mpmi_detects_by_velocity(touch->rule) && touch->gap > 0.0 && !mpmi_is_tie(balance, of))
      of->allowed = touch->gap;
    guess(balance, of, predicted);
    for (int32_t i = 0; i < 2 && of->row[0] >= 0 && of->row[1] >= 0; ++i)
      if (mpmi_is_kept(newton, of->row[i]))
        of->coupling[i] = mpmi_matrix_entry(&newton->matrix, of->row[i], of->row[1 - i]);
  }
  return MPM_OK;
}

/* Finds those that this part has. */
static mpm_status find_here(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  if (!balance->nodes->contact.site_count) return MPM_OK;
  /* contact looks at the velocities of nodes */
  for (int64_t i = 0; i < newton->active_count; ++i) {
    const mpmi_active_node *node = &newton->active[i];
    for (int32_t c = 0; c < dim; ++c)
      mpmi_velocity(&balance->nodes->solved, node->slot)[c] =
          node->sign[c] * newton->vector[MPMI_V0][(int64_t)node->row * dim + c];
  }
  mpmi_bound bound = {
      .step = balance->step, .nodes = balance->nodes, .values = &balance->nodes->solved, .dim = dim};
  const mpm_status status = mpmi_body_contacts_find(&bound);
  return status ? status : list_constraints(balance);
}

mpm_status mpmi_active_set_find(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  newton->constraint_count = 0;
  newton->touches = newton->several_fields = newton->knows_stiffness = 0;
  memset(newton->vector[MPMI_CONTACT], 0,
         (size_t)(newton->matrix.rows * balance->settings->grid->dim) * sizeof(double));
  if (!balance->nodes->contact.anywhere) return MPM_OK;
  mpm_status status = mpmi_vote(balance, find_here(balance), 0);
  if (status) return status;
  double any[] = {newton->constraint_count > 0, newton->couples_bodies};
  status = mpmi_largest_of_parts(balance, 2, any);
  newton->touches = any[0] > 0.0;
  newton->several_fields = any[1] > 0.0;
  return status;
}

mpm_status mpmi_active_set_hold(mpmi_balance *balance, int32_t *any) {
  mpmi_newton *newton = balance->newton;
  double closed = 0.0;
  for (int64_t k = 0; k < newton->constraint_count; ++k) {
    mpmi_constraint *of = &newton->constraint[k];
    if (of->closed || of->changes || of->allowed > still_close_by * balance->settings->grid->h_min) continue;
    of->closed = 1;
    closed = 1.0;
  }
  const mpm_status status = mpmi_largest_of_parts(balance, 1, &closed);
  *any = closed > 0.0;
  return status;
}

/* ---- the set ------------------------------------------------------------------------------------------- */
/* Returns by how much a closed touch misses: of a tie all of the relative displacement, else G, and the
 * slip of what sticks. */
static double misses(const mpmi_balance *balance, const mpmi_constraint *of) {
  double move[3], along, across[3];
  mpmi_relative(balance, of, balance->newton->vector[MPMI_U], move);
  if (mpmi_is_tie(balance, of)) {
    mpmi_stoppable(of, move);
    return sqrt(mpmi_inner(move, move));
  }
  mpmi_split(move, mpmi_touch_of(balance, of)->normal, &along, across);
  const double apart = of->allowed + along;
  mpmi_stoppable(of, across);
  return sqrt(apart * apart + (of->stuck ? mpmi_inner(across, across) : 0.0));
}

double mpmi_active_set_error(const mpmi_balance *balance) {
  const mpmi_newton *newton = balance->newton;
  double most = 0.0;
  for (int64_t k = 0; k < newton->constraint_count; ++k)
    if (newton->constraint[k].closed && !newton->constraint[k].light)
      most = fmax(most, misses(balance, &newton->constraint[k]));
  if (newton->touches && mpmi_largest_of_parts(balance, 1, &most)) return (double)NAN;
  return most / (MPMI_CONTACT_HOLDS_TO * balance->settings->grid->h_min);
}

/* Tells whether what slides along with its friction, which cannot be, sticks; else it turns its force round,
 * but once only. */
static int32_t stops(const mpmi_balance *balance, mpmi_constraint *of, double most, const double *before,
                     const double *after, const double *slip) {
  const double force = sqrt(mpmi_inner(before, before)),
               hair = MPMI_CONTACT_HOLDS_TO * balance->settings->grid->h_min;
  if (!(force > 0.0) || mpmi_inner(slip, before) <= hair * force) return 0;
  if (sqrt(mpmi_inner(after, after)) <= most || of->turned) return 1;
  of->turned = 1;
  return 0;
}

/* Bounds friction by Coulomb's law. What sticks slides when its force is too large; what slides has its force
 * against the slip. */
static int32_t bound_friction(const mpmi_balance *balance, mpmi_constraint *of, double pushes, double *across,
                              const double *slip) {
  const mpmi_touch *touch = mpmi_touch_of(balance, of);
  const double most = touch->friction * pushes, before[3] = {across[0], across[1], across[2]};
  const int32_t stuck = of->stuck;
  if (stuck) {
    of->stuck = sqrt(mpmi_inner(across, across)) <= touch->friction_static * pushes;
  } else {
    for (int32_t c = 0; c < 3; ++c) across[c] -= of->nodal_stiffness * slip[c];
    of->stuck = stops(balance, of, most, before, across, slip);
    if (of->stuck) memcpy(across, before, sizeof before);
  }
  if (of->stuck != stuck && ++of->slips > MOST_CHANGES) {
    of->smooth = 1;
    of->stuck = 0;
    across[0] = across[1] = across[2] = 0.0;
  }
  const double size = sqrt(mpmi_inner(across, across));
  for (int32_t c = 0; c < 3 && !of->stuck && size > 0.0; ++c) across[c] *= most / size;
  return of->stuck != stuck;
}

static int32_t update_touch(const mpmi_balance *balance, mpmi_constraint *of) {
  const mpmi_touch *touch = mpmi_touch_of(balance, of);
  const double hair = 1e-2 * MPMI_CONTACT_HOLDS_TO * balance->settings->grid->h_min;
  double move[3], along, slip[3], pushes, across[3];
  mpmi_relative(balance, of, balance->newton->vector[MPMI_U], move);
  mpmi_split(move, touch->normal, &along, slip);
  mpmi_split(of->force, touch->normal, &pushes, across);
  const int32_t keeps = of->changes >= MOST_CHANGES && !(of->allowed > 0.0);
  const int32_t closed = of->closed ? pushes >= 0.0 || keeps : of->allowed + along < -hair;
  const int32_t changed = closed != of->closed;
  of->closed = closed;
  of->changes += changed;
  if (changed) {
    for (int32_t c = 0; c < 3; ++c) of->force[c] = 0.0;
    of->smooth |= of->changes >= MOST_CHANGES; /* friction may pull it open again and again */
    of->stuck &= !of->smooth;
    return 1;
  }
  if (!closed || of->smooth || !(touch->friction_static > 0.0)) return 0;
  const int32_t slips = bound_friction(balance, of, fmax(0.0, pushes), across, slip);
  for (int32_t c = 0; c < 3; ++c) of->force[c] = pushes * touch->normal[c] + across[c];
  return slips;
}

/* Counts the iterations in which a closed touch has hardly come closer. */
static void look_after(const mpmi_balance *balance, mpmi_constraint *of) {
  const double now = of->closed ? misses(balance, of) : 0.0;
  const int32_t yet = now > MPMI_CONTACT_HOLDS_TO * balance->settings->grid->h_min && of->missed > 0.0;
  of->stalls = yet && now > 0.5 * of->missed ? of->stalls + 1 : 0;
  of->slow = yet && now > slowly * of->missed;
  of->missed = now;
}

void mpmi_active_set_harden(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  for (int64_t k = 0; k < newton->constraint_count; ++k)
    if (newton->constraint[k].slow) newton->constraint[k].stiffness *= harder;
}

/* Returns the first touch that misses so much and has come no closer for a while, or NULL. */
static mpmi_constraint *find_stalled(const mpmi_newton *newton, double missed) {
  for (int64_t k = 0; k < newton->constraint_count; ++k) {
    mpmi_constraint *of = &newton->constraint[k];
    if (of->stalls >= MOST_STALLS && of->missed >= missed) return of;
  }
  return NULL;
}

/* Where surfaces squeeze one node from two sides nothing can close both: the touch that misses most among
 * those that have come no closer for a while stays open in this step, of equals the first. */
static mpm_status give_way(mpmi_balance *balance, double missed) {
  mpmi_newton *newton = balance->newton;
  const mpmi_blocks *b = &balance->layout->blocks;
  mpmi_constraint *worst = find_stalled(newton, missed);
  int32_t is_first = worst != NULL;
  int64_t place[3] = {0, 0, 0};
  if (worst) {
    const int64_t slot = balance->nodes->contact.party[mpmi_touch_of(balance, worst)->party[1]].slot;
    const uint64_t key = b->key[slot / b->nodes];
    place[0] = (int64_t)(key >> 32);
    place[1] = (int64_t)(key & UINT32_MAX);
    place[2] = slot % b->nodes;
  }
  const mpm_status status = mpmi_first_of_parts(balance, 3, place, &is_first);
  for (int64_t k = 0; k < newton->constraint_count; ++k) newton->constraint[k].stalls = 0;
  if (status || !is_first) return status;
  worst->closed = 0;
  worst->gives_way = 1;
  for (int32_t c = 0; c < 3; ++c) worst->force[c] = 0.0;
  return MPM_OK;
}

mpm_status mpmi_active_set_update(mpmi_balance *balance, int32_t *changed) {
  mpmi_newton *newton = balance->newton;
  double any[] = {0.0, 0.0}; /* changes; the most that a stalled touch misses */
  for (int64_t k = 0; k < newton->constraint_count; ++k) {
    mpmi_constraint *of = &newton->constraint[k];
    if (of->gives_way) continue;
    const int32_t changes = mpmi_is_tie(balance, of) ? 0 : update_touch(balance, of);
    if (of->light) continue;
    any[0] = fmax(any[0], changes);
    look_after(balance, of);
    if (of->stalls >= MOST_STALLS) any[1] = fmax(any[1], of->missed);
  }
  const mpm_status status = mpmi_largest_of_parts(balance, 2, any);
  *changed = any[0] > 0.0 || any[1] > 0.0;
  return status || !(any[1] > 0.0) ? status : give_way(balance, any[1]);
}
