/* The forces of touches in an implicit step, and what closed ones add to its linear system. */
#include "implicit/active_set.h"

#include <math.h>
#include <string.h>

/* The stiffness of a closed touch, in those of its nodes. */
static const double stiffening = 1e3;
/* Touches whose nodes have less than this share of the largest stiffness of nodes that touch: the edge of a
 * domain on a row of nodes gives them a weight by rounding. */
static const double light_share = 1e-12;

void mpmi_active_set_fold(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  double *to = newton->vector[MPMI_CONTACT];
  memset(to, 0, (size_t)(newton->matrix.rows * dim) * sizeof *to);
  for (int64_t k = 0; k < newton->constraint_count; ++k) {
    const mpmi_constraint *of = &newton->constraint[k];
    for (int32_t i = 0; i < 2 && of->closed; ++i)
      for (int32_t c = 0; c < dim && of->row[i] >= 0; ++c)
        to[(int64_t)of->row[i] * dim + c] += (i ? 1.0 : -1.0) * of->force[c];
  }
}

/* The force of the augmented Lagrangian at the displacements as they are, and how it falls with the relative
 * displacement. */
typedef struct response {
  double force[3], stiffness[3][3];
} response;

static void add_product(double factor, const double *a, const double *b, double (*to)[3]) {
  for (int32_t r = 0; r < 3; ++r)
    for (int32_t c = 0; c < 3; ++c) to[r][c] += factor * a[r] * b[c];
}

static void add_identity(double factor, double (*to)[3]) {
  for (int32_t c = 0; c < 3; ++c) to[c][c] += factor;
}

/* What slides takes the friction of the normal force, against the way that it has slid. */
static void respond_sliding(const mpmi_balance *balance, const mpmi_constraint *of, double pushes,
                            const double *across, response *to) {
  const mpmi_touch *touch = mpmi_touch_of(balance, of);
  const double size = sqrt(mpmi_inner(across, across)), *n = touch->normal;
  if (!(size > 0.0) || !(pushes > 0.0)) return;
  const double against[3] = {across[0] / size, across[1] / size, across[2] / size};
  const double turning = touch->friction * pushes * of->stiffness / size;
  for (int32_t c = 0; c < 3; ++c) to->force[c] += touch->friction * pushes * against[c];
  add_product(touch->friction * of->stiffness, against, n, to->stiffness);
  add_identity(turning, to->stiffness);
  add_product(-turning, n, n, to->stiffness);
  add_product(-turning, against, against, to->stiffness);
}

static response respond(const mpmi_balance *balance, const mpmi_constraint *of) {
  const double *n = mpmi_touch_of(balance, of)->normal, k = of->stiffness;
  response to = {{0.0, 0.0, 0.0}, {{0.0}}};
  double move[3], along, slip[3], pushes, across[3];
  mpmi_relative(balance, of, balance->newton->vector[MPMI_U], move);
  if (mpmi_is_tie(balance, of)) mpmi_stoppable(of, move);
  mpmi_split(move, n, &along, slip);
  if (of->stuck) mpmi_stoppable(of, slip);
  mpmi_split(of->force, n, &pushes, across);
  for (int32_t c = 0; c < 3; ++c) across[c] -= k * slip[c];
  pushes -= k * (of->allowed + along);
  for (int32_t c = 0; c < 3; ++c) to.force[c] = pushes * n[c];
  if (mpmi_is_tie(balance, of) || of->stuck) {
    for (int32_t c = 0; c < 3; ++c) to.force[c] += across[c];
    add_identity(k, to.stiffness);
    return to;
  }
  add_product(k, n, n, to.stiffness);
  if (mpmi_slides(balance, of)) respond_sliding(balance, of, pushes, across, &to);
  return to;
}

/* ---- the linear system --------------------------------------------------------------------------------- */
/* Returns the stiffness of a row along a direction, or 0 where it is held. */
static double row_stiffness(const mpmi_balance *balance, int32_t row, const double *n) {
  const mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  const double *size = newton->vector[MPMI_DIAGONAL] + (int64_t)row * dim;
  double sum = 0.0;
  for (int32_t c = 0; c < dim; ++c)
    if (!mpmi_is_held(newton->matrix.held[(int64_t)row * dim + c])) sum += n[c] * n[c] * size[c];
  return sum;
}

/* That of both one after the other, so that the softer one is not overwhelmed. */
static double stiffness_of(const mpmi_balance *balance, const mpmi_constraint *of) {
  const double *n = mpmi_touch_of(balance, of)->normal;
  double inverse = 0.0, k;
  for (int32_t i = 0; i < 2; ++i)
    if (of->row[i] >= 0 && (k = row_stiffness(balance, of->row[i], n)) > 0.0) inverse += 1.0 / k;
  return inverse > 0.0 ? 1.0 / inverse : 0.0;
}

static void add_block(mpmi_matrix *A, int64_t entry, double sign, const double (*stiffness)[3]) {
  double *block = A->value + entry * A->block * A->block;
  for (int32_t r = 0; r < A->block; ++r)
    for (int32_t c = 0; c < A->block; ++c) block[r * A->block + c] += sign * stiffness[r][c];
}

/* Stiffnesses stay as they are at the first matrix of a step. */
static mpm_status set_stiffnesses(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  double most = 0.0;
  mpm_status status = MPM_OK;
  if (newton->shared) status = mpmi_rows_complete(newton->shared, newton->vector[MPMI_DIAGONAL]);
  for (int64_t k = 0; k < newton->constraint_count; ++k) {
    mpmi_constraint *of = &newton->constraint[k];
    of->nodal_stiffness = stiffness_of(balance, of);
    of->stiffness = stiffening * of->nodal_stiffness;
    most = fmax(most, of->nodal_stiffness);
  }
  if (!status) status = mpmi_largest_of_parts(balance, 1, &most);
  for (int64_t k = 0; k < newton->constraint_count; ++k)
    newton->constraint[k].light = newton->constraint[k].nodal_stiffness <= light_share * most;
  newton->knows_stiffness = !status;
  return status;
}

mpm_status mpmi_active_set_stiffen(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  mpm_status status = MPM_OK;
  double unsymmetric = 0.0;
  if (!newton->touches || (!newton->knows_stiffness && (status = set_stiffnesses(balance)))) return status;
  for (int64_t k = 0; k < newton->constraint_count; ++k) {
    const mpmi_constraint *of = &newton->constraint[k];
    if (!of->closed) continue;
    const response at = respond(balance, of);
    unsymmetric = fmax(unsymmetric, mpmi_slides(balance, of));
    for (int32_t i = 0; i < 2; ++i) {
      if (of->row[i] >= 0) add_block(&newton->matrix, newton->diagonal[of->row[i]], 1.0, at.stiffness);
      if (of->coupling[i] >= 0) add_block(&newton->matrix, of->coupling[i], -1.0, at.stiffness);
    }
  }
  status = mpmi_largest_of_parts(balance, 1, &unsymmetric);
  newton->matrix.symmetric &= !(unsymmetric > 0.0);
  return status;
}

void mpmi_active_set_load(const mpmi_balance *balance, double *rhs) {
  const mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  for (int64_t k = 0; k < newton->constraint_count; ++k) {
    const mpmi_constraint *of = &newton->constraint[k];
    if (!of->closed) continue;
    const response at = respond(balance, of);
    for (int32_t i = 0; i < 2; ++i)
      for (int32_t c = 0; c < dim && of->row[i] >= 0; ++c)
        if (!mpmi_is_held(newton->matrix.held[(int64_t)of->row[i] * dim + c]))
          rhs[(int64_t)of->row[i] * dim + c] += (i ? 1.0 : -1.0) * (at.force[c] - of->force[c]);
  }
}

/* ---- increments ---------------------------------------------------------------------------------------- */
void mpmi_active_set_aim(mpmi_balance *balance, const double *du) {
  mpmi_newton *newton = balance->newton;
  for (int64_t k = 0; k < newton->constraint_count; ++k) {
    mpmi_constraint *of = &newton->constraint[k];
    double still[3] = {0.0, 0.0, 0.0}, move[3];
    memcpy(of->start, of->force, sizeof of->start);
    memcpy(of->target, of->force, sizeof of->target);
    if (!of->closed) continue;
    const response at = respond(balance, of);
    mpmi_relative(balance, of, du, move);
    for (int32_t c = 0; c < 3; ++c) still[c] = move[c] - of->moves[c];
    for (int32_t c = 0; c < 3; ++c) of->target[c] = at.force[c] - mpmi_inner(at.stiffness[c], still);
  }
}

void mpmi_active_set_move(mpmi_balance *balance, double share) {
  mpmi_newton *newton = balance->newton;
  if (!newton->constraint_count) return;
  for (int64_t k = 0; k < newton->constraint_count; ++k) {
    mpmi_constraint *of = &newton->constraint[k];
    for (int32_t c = 0; c < 3; ++c) of->force[c] = of->start[c] + share * (of->target[c] - of->start[c]);
  }
  mpmi_active_set_fold(balance);
}
