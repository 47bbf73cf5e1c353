/* Implicit steps in which bodies in contact slide or come to overlap too far (docs/theory.md, 9.4, long
 * steps): what touches was found at the start, and is looked at again when the step is solved. */
#include "implicit/active_set.h"
#include "implicit/beside.h"
#include "implicit/trouble.h"
#include "boundary/bound.h"

#include <math.h>

/* Touches that push less than this share of the hardest, and rows with less than this share of the mass of
 * the heaviest beside them, may slide as they like: nodes at the rim of a body move far and mean little. */
static const double pushes_at_all = 1e-2, weighs_at_all = 5e-2;

/* ---- what is too much ---------------------------------------------------------------------------------- */
/* Returns 1 for a touch that this part looks after, and that is closed and means something. */
static int32_t counts(const mpmi_balance *balance, const mpmi_constraint *of, double most_force) {
  const mpmi_touch *touch = mpmi_touch_of(balance, of);
  if (!mpmi_owns_node(balance->layout->parts, balance->nodes->contact.party[touch->party[1]].slot)) return 0;
  int32_t light = mpmi_inner(of->force, touch->normal) <= pushes_at_all * most_force;
  for (int32_t i = 0; i < 2; ++i) {
    const double beside = of->row[i] < 0 ? 0.0 : mpmi_heaviest_beside(balance, of->row[i], -1);
    light |= beside > 0.0 && mpmi_whole_mass(balance, of->row[i]) <= weighs_at_all * beside;
  }
  return !light && of->closed && !mpmi_is_tie(balance, of);
}

/* Returns the way of a touch along its plane, in cells. */
static double slip_of(const mpmi_balance *balance, const mpmi_constraint *of) {
  double move[3], along, across[3];
  mpmi_relative(balance, of, balance->newton->vector[MPMI_U], move);
  mpmi_split(move, mpmi_touch_of(balance, of)->normal, &along, across);
  return sqrt(mpmi_inner(across, across)) / balance->settings->grid->h_min;
}

/* Returns how far a touch has slid where that misleads: normals and gaps are those of the start, and on
 * curved surfaces others where it has come to. */
static double slipped(const mpmi_balance *balance, const mpmi_constraint *of) {
  const mpmi_contact_nodes *contact = &balance->nodes->contact;
  const mpmi_touch *touch = mpmi_touch_of(balance, of);
  const mpmi_party *first = &contact->party[touch->party[0]];
  const int32_t is_plane = first->surface >= 0 && contact->surface[first->surface].shape == MPM_SHAPE_PLANE;
  return touch->rule->normal == MPM_NORMAL_FIXED || is_plane ? 0.0 : slip_of(balance, of);
}

/* Returns by how much bodies overlap after the step beyond what they did before, in cells along the
 * normal. */
static double overlapped(const mpmi_balance *balance, const mpmi_constraint *of) {
  const mpmi_touch *touch = mpmi_touch_of(balance, of);
  const mpm_grid *grid = balance->settings->grid;
  double squared = 0.0;
  for (int32_t k = 0; k < grid->dim; ++k)
    squared += touch->normal[k] * touch->normal[k] * grid->inverse_spacing[k] * grid->inverse_spacing[k];
  return (fmin(0.0, touch->gap) - touch->gap_after) * sqrt(squared);
}

typedef struct too_much {
  double (*of)(const mpmi_balance *balance, const mpmi_constraint *of); /* in cells */
  double most;
  const char *verb, *bound;
} too_much;
static const too_much slip = {slipped, 0.5, "slide", "half a cell"};
static const too_much overlap = {overlapped, 0.25, "come to overlap", "a quarter of one"};

/* Of several asked touches the one at the node with the smallest number is told. */
static mpm_status check_here(const mpmi_balance *balance, const too_much *what) {
  const mpmi_newton *newton = balance->newton;
  double told = 0.0;
  int64_t node = -1;
  for (int64_t k = 0; k < newton->constraint_count; ++k) {
    const mpmi_constraint *of = &newton->constraint[k];
    const mpmi_touch *touch = mpmi_touch_of(balance, of);
    const double measured = touch->asked ? what->of(balance, of) : 0.0;
    const int64_t slot = balance->nodes->contact.party[touch->party[1]].slot,
                  number = measured > what->most ? mpmi_blocks_number(&balance->layout->blocks, slot) : -1;
    if (!(measured > what->most) || (node >= 0 && number >= node)) continue;
    told = measured;
    node = number;
  }
  if (node < 0) return MPM_OK;
  balance->step->failure.node = node;
  return mpmi_fail(
      balance->settings->context, MPM_CUT_DT,
      "bodies in contact %s by %g cells at node %lld in the step from t = %g with dt = %g, more than %s: %s",
      what->verb, told, (long long)node, balance->step->t, balance->step->dt, what->bound,
      mpmi_smaller_steps(balance));
}

mpm_status mpmi_active_set_check_slips(mpmi_balance *balance) {
  const mpmi_newton *newton = balance->newton;
  mpmi_contact_nodes *contact = &balance->nodes->contact;
  double most = 0.0;
  for (int64_t k = 0; k < newton->constraint_count; ++k)
    most = fmax(most, mpmi_inner(newton->constraint[k].force,
                                 mpmi_touch_of(balance, &newton->constraint[k])->normal));
  mpm_status status = mpmi_largest_of_parts(balance, 1, &most);
  for (int64_t t = 0; t < contact->touch_count; ++t) contact->touch[t].asked = 0;
  for (int64_t k = 0; k < newton->constraint_count && !status; ++k)
    contact->touch[newton->constraint[k].touch].asked = counts(balance, &newton->constraint[k], most);
  if (!status) status = check_here(balance, &slip);
  return mpmi_vote(balance, status, 0);
}

/* ---- the gaps after the step --------------------------------------------------------------------------- */
/* Bodies that have slid by less than this, in cells, are not asked for their gap: where they are rough it
 * jumps with the particles that come near the line on which it is measured, in the shortest step, too. */
static const double slid_at_all = 0.125;

static int32_t has_gap_after(const mpmi_balance *balance, const mpmi_constraint *of) {
  const mpmi_touch *touch = mpmi_touch_of(balance, of);
  return !mpmi_detects_by_velocity(touch->rule) &&
         (mpmi_is_of_surface(&balance->nodes->contact, touch) || slip_of(balance, of) >= slid_at_all);
}

/* Finds how the second party has moved. */
static void find_way(const mpmi_balance *balance, const mpmi_constraint *of, double *way) {
  const int64_t slot = balance->nodes->contact.party[mpmi_touch_of(balance, of)->party[1]].slot;
  const int32_t dim = balance->settings->grid->dim;
  const double *u = balance->newton->vector[MPMI_U];
  for (int32_t c = 0; c < dim; ++c)
    way[c] = of->row[1] >= 0 ? u[(int64_t)of->row[1] * dim + c] : mpmi_held_way(balance, slot, c);
}

/* Returns how many cells nodes have moved at most here, rounded up: particles have moved no farther. */
static double cells_moved(const mpmi_balance *balance) {
  const int64_t count = balance->newton->matrix.rows * balance->settings->grid->dim;
  double most = 0.0;
  for (int64_t i = 0; i < count; ++i) most = fmax(most, fabs(balance->newton->vector[MPMI_U][i]));
  return ceil(most / balance->settings->grid->h_min);
}

/* Asks those touches of the ones that count for their gap that have one; tells whether there are any, and how
 * far nodes have moved (collective). */
static mpm_status ask(const mpmi_balance *balance, double *any, double *moved) {
  const mpmi_newton *newton = balance->newton;
  mpmi_contact_nodes *contact = &balance->nodes->contact;
  double most[] = {0.0, cells_moved(balance)};
  for (int64_t k = 0; k < newton->constraint_count; ++k) {
    mpmi_touch *touch = &contact->touch[newton->constraint[k].touch];
    touch->asked = touch->asked && has_gap_after(balance, &newton->constraint[k]);
    if (touch->asked) find_way(balance, &newton->constraint[k], touch->way);
    most[0] = fmax(most[0], touch->asked);
  }
  const mpm_status status = mpmi_largest_of_parts(balance, 2, most);
  *any = most[0];
  *moved = most[1];
  return status;
}

mpm_status mpmi_active_set_look_back(mpmi_balance *balance) {
  const mpmi_parts *parts = balance->layout->parts;
  mpmi_bound bound = {.step = balance->step,
                      .nodes = balance->nodes,
                      .values = &balance->nodes->solved,
                      .dim = balance->settings->grid->dim};
  double any, moved;
  mpm_status status = ask(balance, &any, &moved);
  if (status || !(any > 0.0)) return status;
  if (parts && parts->some_given)
    status = mpmi_layout_exchange_guests(balance->layout, balance->settings->context, 1);
  if (!status) status = mpmi_body_contacts_find_after(&bound, moved);
  if (!status) status = check_here(balance, &overlap);
  return mpmi_vote(balance, status, 0);
}
