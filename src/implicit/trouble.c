/* What a step that Newton's method does not bring to an end tells: where the balance is worst, which particle
 * is beside, and what helps in such a case. */
#include "implicit/trouble.h"
#include "stages/batch.h"

#include <math.h>

/* Falling by more than this, over the last iterations, the residual only needs more of them; falling each
 * time, but by less, it lacks the right tangent. */
static const double soon = 0.2, hardly = 0.9;
enum { LAST = 3 };

/* Notes the particle that is nearest to a node, the first of equals. */
static void find_particle(mpmi_balance *balance, const double *node) {
  const mpm_grid *grid = balance->settings->grid;
  mpmi_failure *failure = &balance->step->failure;
  double nearest = HUGE_VAL;
  for (int32_t m = 0; m < balance->layout->member_count; ++m) {
    const mpm_particles *set = balance->layout->member[m].set;
    const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
    for (int64_t slot = 0; slot < set->slots; ++slot) {
      double square = 0.0;
      if (id[slot] < 0) continue;
      for (int32_t k = 0; k < grid->dim; ++k) {
        double away = mpmi_places(set, 0)[k * set->ld + slot] - node[k];
        const double period = grid->upper[k] - grid->desc.origin[k];
        if (grid->desc.periodic[k]) away -= period * floor(away / period + 0.5);
        square += away * away;
      }
      if (!(square < nearest || (square <= nearest && failure->set == m && id[slot] < failure->particle)))
        continue;
      nearest = square;
      failure->set = m;
      failure->particle = id[slot];
    }
  }
}

/* Returns the row with the largest share of the residual of unknowns, or -1. */
static int64_t worst_row(const mpmi_newton *newton, double *share) {
  const int32_t dim = newton->matrix.block;
  double most = 0.0, all = 0.0;
  int64_t worst = -1;
  for (int64_t r = 0; r < newton->matrix.rows; ++r) {
    double square = 0.0;
    for (int32_t c = 0; c < dim; ++c)
      if (!newton->matrix.held[r * dim + c]) square += pow(newton->vector[MPMI_RESIDUAL][r * dim + c], 2);
    all += square;
    if (!(square > most)) continue;
    most = square;
    worst = r;
  }
  *share = all > 0.0 ? most / all : 0.0;
  return worst;
}

const char *mpmi_smaller_steps(const mpmi_balance *balance) {
  return balance->step->is_cut ? "smaller steps were tried" : "use a smaller dt, or mpm_advance";
}

static int32_t falls(const mpmi_newton *newton, double by) {
  int32_t all = newton->history_count > LAST;
  for (int32_t k = newton->history_count - LAST; k < newton->history_count && all; ++k)
    all = newton->history[k] <= by * newton->history[k - 1];
  return all;
}

/* Returns what helps: of steps that fail so, what got them through when it was tried. */
static const char *advice(const mpmi_balance *balance, int32_t touches_change) {
  const mpmi_newton *newton = balance->newton;
  if (touches_change)
    return balance->step->is_cut ? "bodies go on to part and touch again: use less friction"
                                 : "bodies go on to part and touch again: use mpm_advance, or less friction";
  if (falls(newton, soon)) return "it falls fast: raise newton_max_iterations";
  if (falls(newton, hardly) && mpmi_has_host_law(balance->layout))
    return "it falls slowly, as with a tangent callback that is not the derivative of the stress";
  return mpmi_smaller_steps(balance);
}

mpm_status mpmi_tell_not_converged(mpmi_balance *balance, int32_t touches_change) {
  const mpmi_newton *newton = balance->newton;
  mpmi_failure *failure = &balance->step->failure;
  double share;
  const int64_t row = worst_row(newton, &share);
  if (row >= 0) {
    failure->node = newton->matrix.number[row];
    find_particle(balance, newton->matrix.position + 3 * row);
  }
  return mpmi_fail(
      balance->settings->context, MPM_NOT_CONVERGED,
      "Newton's method has a relative residual of %g after %d iterations in the step from t = %g "
      "with dt = %g; %.0f %% of it at node %lld beside particle %lld of set %d: %s",
      balance->step->info.residual, (int)balance->iterations, balance->step->t, balance->step->dt,
      100.0 * sqrt(share), (long long)failure->node, (long long)failure->particle, (int)failure->set,
      advice(balance, touches_change));
}

mpm_status mpmi_tell_unsolved(mpmi_balance *balance, mpm_status status, int64_t node) {
  const mpmi_newton *newton = balance->newton;
  const mpmi_failure *failure = &balance->step->failure;
  balance->step->failure.node = node;
  for (int64_t r = 0; r < newton->matrix.rows && node >= 0; ++r)
    if (newton->matrix.number[r] == node) {
      find_particle(balance, newton->matrix.position + 3 * r);
      break;
    }
  if (status != MPM_SINGULAR || failure->particle < 0) return status;
  return mpmi_fail(balance->settings->context, status, "%s, beside particle %lld of set %d%s",
                   mpm_last_error(balance->settings->context), (long long)failure->particle,
                   (int)failure->set,
                   mpmi_is_dynamic(balance->settings)
                       ? ""
                       : ": hold the body in every direction, see whether it has torn, or set "
                         "quasi_static = 0");
}
