/* What a step that Newton's method does not bring to an end tells: where the balance is worst, which particle
 * is beside, and what helps in such a case. */
#include "implicit/trouble.h"
#include "context/transport.h"
#include "stages/batch.h"

#include <math.h>
#include <string.h>

/* Falling by more than this in the last two iterations, the residual only needs more of them; falling in the
 * last three, but by less, it lacks the right tangent. */
static const double soon = 0.2, hardly = 0.9;
enum { LAST_FAST = 2, LAST_SLOW = 3 };

/* Of several parts all take the particle that is nearest, of equals the first. */
static mpm_status take_nearest(mpmi_balance *balance, double nearest) {
  mpmi_failure *failure = &balance->step->failure;
  int64_t number[] = {mpmi_ordered_bits(nearest), failure->set, failure->particle};
  int32_t is_first = 1;
  const mpm_status status = mpmi_first_of_parts(balance, 3, number, &is_first);
  failure->set = (int32_t)number[1];
  failure->particle = number[2];
  return status;
}

/* Notes the particle that is nearest to a node, the first of equals. */
static mpm_status find_particle(mpmi_balance *balance, const double *node) {
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
  return take_nearest(balance, nearest);
}

/* A node behind a row; of several parts it is known to all, whoever has the row. */
typedef struct row_node {
  int64_t number;
  double position[3];
} row_node;

/* Finds the node of a row of this part, or with row -1 that of another one's; *any: somebody has one. */
static mpm_status find_node(const mpmi_balance *balance, int64_t row, row_node *to, int32_t *any) {
  const mpmi_matrix *A = &balance->newton->matrix;
  int64_t word[5] = {row >= 0, INT64_MIN, INT64_MIN, INT64_MIN, INT64_MIN};
  if (row >= 0) {
    word[1] = A->number[row];
    memcpy(&word[2], A->position + 3 * row, sizeof to->position);
  }
  const mpm_status status = mpmi_reduce_parts(balance->settings->context, MPM_REDUCE_MAX, 5, word);
  *any = word[0] > 0;
  to->number = word[1];
  memcpy(to->position, &word[2], sizeof to->position);
  return status;
}

/* Finds the row with the largest share of the residual of unknowns, or -1: none, or one of another part. */
static mpm_status worst_row(const mpmi_balance *balance, int64_t *worst, double *share) {
  const mpmi_newton *newton = balance->newton;
  const int32_t dim = newton->matrix.block;
  double most = 0.0, *term = newton->vector[MPMI_TERMS];
  int32_t part = 0;
  *worst = -1;
  for (int64_t r = 0; r < newton->matrix.rows; ++r) {
    double square = 0.0;
    for (int32_t c = 0; c < dim; ++c) {
      const double residual = newton->vector[MPMI_RESIDUAL][r * dim + c];
      term[r * dim + c] = newton->matrix.held[r * dim + c] ? 0.0 : residual * residual;
      square += term[r * dim + c];
    }
    if (!(square > most) || !mpmi_is_own_row(&newton->matrix, r)) continue;
    most = square;
    *worst = r;
  }
  const double mine = most, all = mpmi_sum_rows(balance, term);
  mpm_status status = mpmi_largest_of_parts(balance, 1, &most);
  if (most > mine) *worst = -1;
  if (!status && newton->shared) status = mpmi_rows_first(newton->shared, *worst, &part);
  if (newton->shared && part != balance->settings->context->transport.part) *worst = -1;
  *share = all > 0.0 ? most / all : 0.0;
  return status;
}

/* On updated grids with the linear basis bodies sink further with each step, and short ones stop earlier. */
static int32_t sinks_by_steps(const mpmi_settings *settings) {
  return settings->desc.quasi_static && settings->grid->desc.basis == MPM_LINEAR &&
         !mpmi_is_total_lagrangian(settings->grid);
}

const char *mpmi_smaller_steps(const mpmi_balance *balance) {
  const int32_t sinks = sinks_by_steps(balance->settings);
  if (balance->step->is_cut)
    return sinks ? "smaller steps were tried: take total_lagrangian = 1, or a smooth basis"
                 : "smaller steps were tried";
  return sinks ? "use mpm_advance, or where steps are short total_lagrangian = 1 or a smooth basis"
               : "use a smaller dt, or mpm_advance";
}

static int32_t falls(const mpmi_newton *newton, int32_t last, double by) {
  int32_t all = newton->history_count > last;
  for (int32_t k = newton->history_count - last; k < newton->history_count && all; ++k)
    all = newton->history[k] <= by * newton->history[k - 1];
  return all;
}

/* Returns what helps: of steps that fail so, what got them through when it was tried. */
static const char *advice(const mpmi_balance *balance, int32_t touches_change) {
  const mpmi_newton *newton = balance->newton;
  if (touches_change)
    return balance->step->is_cut ? "bodies go on to part and touch again: use less friction"
                                 : "bodies go on to part and touch again: use mpm_advance, or less friction";
  if (falls(newton, LAST_FAST, soon)) return "it falls fast: raise newton_max_iterations";
  if (falls(newton, LAST_SLOW, hardly) && mpmi_has_host_law(balance->layout))
    return "it falls slowly, as with a tangent callback that is not the derivative of the stress";
  return mpmi_smaller_steps(balance);
}

/* Notes the node with the largest share of the residual, and the particle beside it. */
static mpm_status find_worst(mpmi_balance *balance, double *share) {
  int64_t row;
  row_node node;
  int32_t any;
  mpm_status status = worst_row(balance, &row, share);
  if (!status) status = find_node(balance, row, &node, &any);
  if (status || !any) return status;
  balance->step->failure.node = node.number;
  return find_particle(balance, node.position);
}

mpm_status mpmi_tell_not_converged(mpmi_balance *balance, int32_t touches_change) {
  const mpmi_failure *failure = &balance->step->failure;
  double share;
  const mpm_status status = find_worst(balance, &share);
  if (status) return status;
  return mpmi_fail(
      balance->settings->context, MPM_NOT_CONVERGED,
      "Newton's method has a relative residual of %g after %d iterations in the step from t = %g "
      "with dt = %g; %.0f %% of it at node %lld beside particle %lld of set %d: %s",
      balance->step->info.residual, (int)balance->iterations, balance->step->t, balance->step->dt,
      100.0 * sqrt(share), (long long)failure->node, (long long)failure->particle, (int)failure->set,
      advice(balance, touches_change));
}

/* Iterations of the linear solver that the host has chosen may end early; of a choice of its own the library
 * has said already what helps. */
static const char *advice_on_solver(const mpmi_balance *balance) {
  switch (balance->settings->desc.linear_solver) {
  case MPM_SOLVER_CG:
  case MPM_SOLVER_GMRES:
  case MPM_SOLVER_MULTIGRID_CG:
    return ": raise linear_max_iterations, or take MPM_SOLVER_AUTO, which ends with a factor where there is "
           "room for one";
  default:
    return "";
  }
}

/* The linear solver names no place where it has failed: it is told where the balance is worst. */
static mpm_status tell_not_solved(mpmi_balance *balance, mpm_status status) {
  const mpmi_failure *failure = &balance->step->failure;
  double share;
  const mpm_status lost = find_worst(balance, &share);
  if (lost) return lost;
  if (failure->node < 0) return status;
  return mpmi_fail(balance->settings->context, status,
                   "%s; %.0f %% of what is out of balance is at node %lld beside particle %lld of set %d%s",
                   mpm_last_error(balance->settings->context), 100.0 * sqrt(share), (long long)failure->node,
                   (long long)failure->particle, (int)failure->set,
                   status == MPM_NOT_CONVERGED ? advice_on_solver(balance) : "");
}

mpm_status mpmi_tell_unsolved(mpmi_balance *balance, mpm_status status, int64_t node) {
  const mpmi_matrix *A = &balance->newton->matrix;
  const mpmi_failure *failure = &balance->step->failure;
  if (node < 0 && (status == MPM_NOT_CONVERGED || status == MPM_SINGULAR))
    return tell_not_solved(balance, status);
  balance->step->failure.node = node;
  if (node >= 0) {
    int64_t row = 0;
    row_node of;
    int32_t any;
    while (row < A->rows && (A->number[row] != node || !mpmi_is_own_row(A, row))) ++row;
    mpm_status lost = find_node(balance, row < A->rows ? row : -1, &of, &any);
    if (!lost && any) lost = find_particle(balance, of.position);
    if (lost) return lost;
  }
  if (status != MPM_SINGULAR || failure->particle < 0) return status;
  return mpmi_fail(balance->settings->context, status, "%s, beside particle %lld of set %d: %s",
                   mpm_last_error(balance->settings->context), (long long)failure->particle,
                   (int)failure->set,
                   mpmi_is_dynamic(balance->settings)
                       ? mpmi_smaller_steps(balance)
                       : "hold the body in every direction, see whether it has torn, or set "
                         "quasi_static = 0");
}
