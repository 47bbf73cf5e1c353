/* What the parts of a problem decide together in an implicit step. Whatever they decide by is the same
 * number on all of them: failures that all have heard of, sums and maxima over the rows of all. */
#include "implicit/balance.h"
#include "context/transport.h"
#include "stages/stages.h"

#include <math.h>

mpm_status mpmi_vote(const mpmi_balance *balance, mpm_status status, int64_t exchanges) {
  return balance->layout->parts ? balance->step->vote(balance->step->stepper, status, exchanges) : status;
}

int64_t mpmi_force_exchanges(const mpmi_balance *balance) {
  return 1 + (balance->settings->desc.locking_remedy != 0) +
         mpmi_has_nodal_stress(balance->settings, balance->layout);
}

mpm_status mpmi_largest_of_parts(const mpmi_balance *balance, int32_t count, double *values) {
  enum { MOST = 4 };
  int64_t bits[MOST];
  if (!balance->layout->parts) return MPM_OK;
  for (int32_t i = 0; i < count; ++i) bits[i] = mpmi_ordered_bits(values[i]);
  const mpm_status status = mpmi_reduce_parts(balance->settings->context, MPM_REDUCE_MAX, count, bits);
  for (int32_t i = 0; i < count; ++i) values[i] = mpmi_of_ordered_bits(bits[i]);
  return status;
}

mpm_status mpmi_first_of_parts(const mpmi_balance *balance, int32_t count, int64_t *number,
                               int32_t *is_first) {
  for (int32_t i = 0; i < count && balance->layout->parts; ++i) {
    int64_t best = *is_first ? -number[i] : INT64_MIN;
    const mpm_status status = mpmi_reduce_parts(balance->settings->context, MPM_REDUCE_MAX, 1, &best);
    if (status) return status;
    *is_first &= best == -number[i];
    number[i] = -best;
  }
  return MPM_OK;
}

double mpmi_sum_rows(const mpmi_balance *balance, const double *term) {
  const mpmi_matrix *A = &balance->newton->matrix;
  const int32_t dim = A->block;
  mpmi_whole_sum sum;
  double total;
  mpmi_exact_clear(&sum);
  for (int64_t r = 0; r < A->rows; ++r) {
    double of_row = term[r * dim];
    for (int32_t c = 1; c < dim; ++c) of_row += term[r * dim + c];
    if (mpmi_is_own_row(A, r)) mpmi_exact_add(&sum, of_row);
  }
  return mpmi_total_parts(balance->settings->context, 1, &sum, &total) ? (double)NAN : total;
}

double mpmi_largest_in_rows(const mpmi_balance *balance, const double *term) {
  const mpmi_matrix *A = &balance->newton->matrix;
  double largest = 0.0;
  for (int64_t i = 0; i < A->rows * A->block; ++i)
    if (term[i] > largest && mpmi_is_own_row(A, i / A->block)) largest = term[i];
  return mpmi_largest_of_parts(balance, 1, &largest) ? (double)NAN : largest;
}
