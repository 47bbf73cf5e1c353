/* The host's solver borrows the linear system as an operator. */
#include "context/structs.h"
#include "linalg/operator.h"

#include <string.h>

void mpmi_operator_init(mpm_operator *op, mpm_context *context) {
  memset(op, 0, sizeof *op);
  op->magic = MPMI_OPERATOR;
  op->context = context;
}

void mpmi_operator_free(mpm_operator *op) {
  mpm_context *context = op->context;
  mpmi_free(context, op->slab, (size_t)op->slab_capacity);
  MPMI_FREE_ARRAY(context, op->row_start, op->row_start_capacity);
  MPMI_FREE_ARRAY(context, op->column, op->column_capacity);
  MPMI_FREE_ARRAY(context, op->value, op->value_capacity);
  memset(op, 0, sizeof *op);
}

/* All lists of one element per unknown of the matrix share one piece of memory. */
static mpm_status divide_slab(mpm_operator *op, int64_t unknowns) {
  const uint64_t bytes =
      mpmi_bytes(unknowns + 1, 2 * sizeof(int64_t) + 2 * sizeof(int32_t) + 5 * sizeof(double));
  const mpm_status status = mpmi_reserve(op->context, (void **)&op->slab, &op->slab_capacity,
                                         bytes < INT64_MAX ? (int64_t)bytes : INT64_MAX, 1);
  if (status) return status;
  const int64_t n = unknowns + 1;
  op->position = (double *)(void *)op->slab;
  op->x = op->position + 3 * n;
  op->y = op->x + n;
  op->unknown = (int64_t *)(op->y + n);
  op->node = op->unknown + n;
  op->row = (int32_t *)(op->node + n);
  op->component = op->row + n;
  return MPM_OK;
}

static void list_rows(mpm_operator *op) {
  const mpmi_matrix *A = op->A;
  op->rows = 0;
  for (int64_t u = 0; u < mpmi_matrix_unknowns(A); ++u) {
    op->row[u] = -1;
    if (A->held[u]) continue;
    op->row[u] = (int32_t)op->rows;
    op->unknown[op->rows] = u;
    op->node[op->rows] = A->number[u / A->block];
    op->component[op->rows++] = (int32_t)(u % A->block);
  }
  for (int64_t r = 0; r < op->rows; ++r)
    for (int32_t k = 0; k < 3; ++k)
      op->position[k * op->rows + r] = A->position[3 * (op->unknown[r] / A->block) + k];
}

static int64_t count_nonzeros(const mpm_operator *op) {
  const mpmi_matrix *A = op->A;
  int64_t count = 0;
  for (int64_t i = 0; i < A->rows; ++i) {
    int64_t wide = 0, high = 0;
    for (int32_t c = 0; c < A->block; ++c) high += !A->held[i * A->block + c];
    for (int64_t e = A->row_start[i]; high && e < A->row_start[i + 1]; ++e)
      for (int32_t c = 0; c < A->block; ++c) wide += !A->held[(int64_t)A->column[e] * A->block + c];
    count += high * wide;
  }
  return count;
}

mpm_status mpmi_operator_open(mpm_operator *op, const mpmi_matrix *A, int32_t positive_definite) {
  const int64_t unknowns = mpmi_matrix_unknowns(A);
  if (unknowns > INT32_MAX)
    return mpmi_fail(op->context, MPM_E_UNSUPPORTED, "%lld unknowns are more than columns can be numbered",
                     (long long)unknowns);
  const mpm_status status = divide_slab(op, unknowns);
  if (status) return status;
  op->A = A;
  op->positive_definite = positive_definite;
  op->has_rows = 0;
  list_rows(op);
  op->nonzeros = count_nonzeros(op);
  op->open = 1;
  return MPM_OK;
}

void mpmi_operator_close(mpm_operator *op) {
  op->open = 0;
}

void mpmi_operator_compress(const mpm_operator *op, const double *full, double *rows) {
  for (int64_t r = 0; r < op->rows; ++r) rows[r] = full[op->unknown[r]];
}

void mpmi_operator_expand(const mpm_operator *op, const double *rows, double *full) {
  for (int64_t u = 0; u < mpmi_matrix_unknowns(op->A); ++u) full[u] = op->row[u] < 0 ? 0.0 : rows[op->row[u]];
}

static void write_row(mpm_operator *op, int64_t r, int64_t *count) {
  const mpmi_matrix *A = op->A;
  const int64_t block = A->block, node = op->unknown[r] / block, component = op->unknown[r] % block;
  for (int64_t e = A->row_start[node]; e < A->row_start[node + 1]; ++e)
    for (int64_t c = 0; c < block; ++c) {
      const int32_t column = op->row[A->column[e] * block + c];
      if (column < 0) continue;
      op->column[*count] = column;
      op->value[(*count)++] = A->value[(e * block + component) * block + c];
    }
}

static mpm_status make_rows(mpm_operator *op) {
  mpm_context *context = op->context;
  mpm_status status = mpmi_reserve(context, (void **)&op->row_start, &op->row_start_capacity, op->rows + 1,
                                   sizeof *op->row_start);
  if (!status)
    status =
        mpmi_reserve(context, (void **)&op->column, &op->column_capacity, op->nonzeros, sizeof *op->column);
  if (!status)
    status = mpmi_reserve(context, (void **)&op->value, &op->value_capacity, op->nonzeros, sizeof *op->value);
  if (status) return status;
  int64_t count = 0;
  for (int64_t r = 0; r < op->rows; ++r) {
    op->row_start[r] = count;
    write_row(op, r, &count);
  }
  op->row_start[op->rows] = count;
  op->has_rows = 1;
  return MPM_OK;
}

/* ---- public -------------------------------------------------------------------------------------------- */
/* The context is busy with the solve callback, in which these calls are made: the system has a mark of its
 * own. */
#define ENTER(matrix)                                                                                        \
  if (!(matrix) || (matrix)->magic != (uint32_t)MPMI_OPERATOR) return MPM_E_ARG;                             \
  __attribute__((cleanup(mpmi_leave))) mpmi_entry entry_;                                                    \
  if (mpmi_enter_lent(&entry_, (matrix)->context, &((mpm_operator *)(uintptr_t)(matrix))->busy))             \
  return MPM_E_STATE

static mpm_status check_open(const mpm_operator *op) {
  if (op->open) return MPM_OK;
  return mpmi_fail(op->context, MPM_E_STATE, "the linear system is lent during the solve callback only");
}

mpm_status mpm_operator_get_info(const mpm_operator *matrix, mpm_operator_info *info) {
  ENTER(matrix);
  mpm_status status = check_open(matrix);
  if (status) return status;
  if (!info) return mpmi_fail(matrix->context, MPM_E_ARG, "info is NULL");
  const mpm_operator_info known = {.struct_size = sizeof known,
                                   .block = matrix->A->block,
                                   .symmetric = matrix->A->symmetric,
                                   .positive_definite = matrix->positive_definite,
                                   .rows = matrix->rows,
                                   .nonzeros = matrix->nonzeros,
                                   .pattern_id = matrix->A->pattern_id,
                                   .ld = matrix->rows,
                                   .node = matrix->node,
                                   .component = matrix->component,
                                   .position = matrix->position};
  return mpmi_write_struct(matrix->context, "mpm_operator_info", &known, sizeof known, info);
}

mpm_status mpm_operator_apply(const mpm_operator *matrix, const double *x, double *y) {
  ENTER(matrix);
  mpm_status status = check_open(matrix);
  if (status) return status;
  if (!x || !y) return mpmi_fail(matrix->context, MPM_E_ARG, "%s is NULL", x ? "y" : "x");
  mpmi_operator_expand(matrix, x, matrix->x);
  status = mpmi_matrix_apply(matrix->A, matrix->x, matrix->y);
  if (!status) mpmi_operator_compress(matrix, matrix->y, y);
  return status;
}

/* Making the rows changes nothing that the host sees of the system. */
mpm_status mpm_operator_csr(const mpm_operator *matrix, const int64_t **row_start, const int32_t **column,
                            const double **value) {
  ENTER(matrix);
  mpm_status status = check_open(matrix);
  if (status) return status;
  if (!row_start || !column || !value)
    return mpmi_fail(matrix->context, MPM_E_ARG, "row_start, column or value is NULL");
  if (!matrix->has_rows && (status = make_rows((mpm_operator *)matrix))) return status;
  *row_start = matrix->row_start;
  *column = matrix->column;
  *value = matrix->value;
  return MPM_OK;
}
