/* Takes outer rows out of the system of an implicit step: what acts on them acts on the inner rows that they
 * move with, by the same shares. */
#include "implicit/extension.h"

#include <string.h>

/* Marks the outer rows of touches. Of several parts the owners of rows know what touches there. */
static mpm_status mark_touching(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  const int64_t rows = newton->matrix.rows, dim = newton->matrix.block;
  double *touches = newton->vector[MPMI_TERMS];
  memset(touches, 0, (size_t)(rows * dim) * sizeof *touches);
  for (int64_t i = 0; i < newton->constraint_count; ++i)
    for (int32_t k = 0; k < 2; ++k)
      if (newton->constraint[i].row[k] >= 0) touches[newton->constraint[i].row[k] * dim] = 1.0;
  const mpm_status status = newton->shared ? mpmi_rows_complete(newton->shared, touches) : MPM_OK;
  for (int64_t i = 0; i < newton->outer_count; ++i)
    newton->outer[i].in_contact = touches[newton->outer[i].row * dim] > 0.0;
  return status;
}

mpm_status mpmi_condense_mark(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  mpmi_matrix *A = &newton->matrix;
  int32_t changed = 0;
  for (int64_t i = 0; i < newton->outer_count; ++i) newton->outer[i].in_contact = 0;
  const mpm_status status = newton->touches ? mark_touching(balance) : MPM_OK;
  if (status) return status;
  for (int64_t i = 0; i < newton->outer_count; ++i)
    for (int32_t c = 0; c < A->block; ++c) {
      uint8_t *held = &A->held[(int64_t)newton->outer[i].row * A->block + c];
      if (mpmi_is_held(*held)) continue;
      const uint8_t now = newton->outer[i].in_contact ? MPMI_ROW_FREE : MPMI_ROW_OUTER;
      changed |= *held != now;
      *held = now;
    }
  A->pattern_id += changed;
  return MPM_OK;
}

/* Returns 1 when a component of an outer row moves with the inner ones. */
static int32_t moves_with(const mpmi_newton *newton, const mpmi_outer *outer, int32_t c) {
  return newton->matrix.held[(int64_t)outer->row * newton->matrix.block + c] == MPMI_ROW_OUTER;
}

void mpmi_condense_forces(const mpmi_balance *balance, double *vector) {
  const mpmi_newton *newton = balance->newton;
  const int32_t dim = newton->matrix.block;
  for (int64_t i = 0; i < newton->outer_count; ++i)
    for (int32_t c = 0; c < dim; ++c) {
      double *from = &vector[(int64_t)newton->outer[i].row * dim + c];
      if (!moves_with(newton, &newton->outer[i], c)) continue;
      for (int64_t t = mpmi_first_term(newton, i); t < newton->outer[i].end; ++t)
        vector[(int64_t)newton->term[t].row * dim + c] += newton->term[t].share[c] * *from;
      *from = 0.0;
    }
}

void mpmi_condense_extend(const mpmi_balance *balance, double *vector) {
  const mpmi_newton *newton = balance->newton;
  const int32_t dim = newton->matrix.block;
  for (int64_t i = 0; i < newton->outer_count; ++i)
    for (int32_t c = 0; c < dim; ++c) {
      if (!moves_with(newton, &newton->outer[i], c)) continue;
      double sum = 0.0;
      for (int64_t t = mpmi_first_term(newton, i); t < newton->outer[i].end; ++t)
        sum += newton->term[t].share[c] * vector[(int64_t)newton->term[t].row * dim + c];
      vector[(int64_t)newton->outer[i].row * dim + c] = sum;
    }
}

/* Adds an outer row to an inner one. */
static void add_row(mpmi_newton *newton, const mpmi_outer *outer, const mpmi_outer_term *term) {
  mpmi_matrix *A = &newton->matrix;
  const int32_t dim = A->block;
  for (int64_t e = A->row_start[outer->row]; e < A->row_start[outer->row + 1]; ++e) {
    const double *from = A->value + e * dim * dim;
    double *to = A->value + mpmi_matrix_entry(A, term->row, A->column[e]) * dim * dim;
    for (int32_t c = 0; c < dim; ++c)
      for (int32_t k = 0; k < dim && moves_with(newton, outer, c); ++k)
        to[c * dim + k] += term->share[c] * from[c * dim + k];
  }
}

/* Adds the column of an outer row to those of its inner ones, in each row that has it. The pattern is
 * symmetric. */
static void add_columns(mpmi_newton *newton, int64_t i) {
  mpmi_matrix *A = &newton->matrix;
  const mpmi_outer *outer = &newton->outer[i];
  const int32_t dim = A->block;
  for (int64_t e = A->row_start[outer->row]; e < A->row_start[outer->row + 1]; ++e) {
    const int64_t row = A->column[e];
    const double *from = A->value + mpmi_matrix_entry(A, row, outer->row) * dim * dim;
    for (int64_t t = mpmi_first_term(newton, i); t < outer->end; ++t) {
      double *to = A->value + mpmi_matrix_entry(A, row, newton->term[t].row) * dim * dim;
      for (int32_t c = 0; c < dim; ++c)
        for (int32_t k = 0; k < dim && moves_with(newton, outer, c); ++k)
          to[k * dim + c] += newton->term[t].share[c] * from[k * dim + c];
    }
  }
}

void mpmi_condense_matrix(mpmi_balance *balance) {
  mpmi_newton *newton = balance->newton;
  for (int64_t i = 0; i < newton->outer_count; ++i)
    for (int64_t t = mpmi_first_term(newton, i); t < newton->outer[i].end && !newton->outer[i].in_contact;
         ++t)
      add_row(newton, &newton->outer[i], &newton->term[t]);
  for (int64_t i = 0; i < newton->outer_count; ++i)
    if (!newton->outer[i].in_contact) add_columns(newton, i);
}
