/* The host's solver borrows the linear system as an operator. */
#include "context/mix.h"
#include "context/structs.h"
#include "context/transport.h"
#include "linalg/operator.h"

#include <stddef.h>
#include <string.h>

void mpmi_operator_init(mpm_operator *op, mpm_context *context) {
  memset(op, 0, sizeof *op);
  op->magic = MPMI_OPERATOR;
  op->context = context;
  op->numbered = -1;
}

void mpmi_operator_free(mpm_operator *op) {
  mpm_context *context = op->context;
  mpmi_free(context, op->slab, (size_t)op->slab_capacity);
  MPMI_FREE_ARRAY(context, op->row_start, op->row_start_capacity);
  MPMI_FREE_ARRAY(context, op->column, op->column_capacity);
  MPMI_FREE_ARRAY(context, op->value, op->value_capacity);
  MPMI_FREE_ARRAY(context, op->rows_of, op->rows_of_capacity);
  memset(op, 0, sizeof *op);
}

/* All lists of one element per unknown of the matrix share one piece of memory. */
static mpm_status divide_slab(mpm_operator *op, int64_t unknowns) {
  const uint64_t bytes =
      mpmi_bytes(unknowns + 1, 3 * sizeof(int64_t) + 2 * sizeof(int32_t) + 5 * sizeof(double));
  const mpm_status status = mpmi_reserve(op->context, (void **)&op->slab, &op->slab_capacity,
                                         bytes < INT64_MAX ? (int64_t)bytes : INT64_MAX, 1);
  if (status) return status;
  const int64_t n = unknowns + 1;
  op->position = (double *)(void *)op->slab;
  op->x = op->position + 3 * n;
  op->y = op->x + n;
  op->unknown = (int64_t *)(op->y + n);
  op->node = op->unknown + n;
  op->number = op->node + n;
  op->row = (int32_t *)(op->number + n);
  op->component = op->row + n;
  return MPM_OK;
}

static void list_row(mpm_operator *op, int64_t u) {
  const mpmi_matrix *A = op->A;
  op->row[u] = (int32_t)op->rows;
  op->unknown[op->rows] = u;
  op->node[op->rows] = A->number[u / A->block];
  op->component[op->rows++] = (int32_t)(u % A->block);
}

static int32_t is_own_unknown(const mpmi_matrix *A, int64_t u) {
  return !A->held[u] && mpmi_is_own_row(A, u / A->block);
}

/* Marks the unknowns of other parts which the owned rows of a node couple with. */
static void mark_others(mpm_operator *op, int64_t node) {
  enum { WANTED = -2 };
  const mpmi_matrix *A = op->A;
  int32_t any = 0;
  for (int64_t c = 0; c < A->block; ++c) any |= !A->held[node * A->block + c];
  for (int64_t e = A->row_start[node]; any && e < A->row_start[node + 1]; ++e)
    for (int64_t u = (int64_t)A->column[e] * A->block; u < ((int64_t)A->column[e] + 1) * A->block; ++u)
      if (!A->held[u] && op->row[u] == -1) op->row[u] = WANTED;
}

/* Owned rows come first; then those of other parts, without entries. */
static void list_rows(mpm_operator *op) {
  const mpmi_matrix *A = op->A;
  const int64_t unknowns = mpmi_matrix_unknowns(A);
  op->rows = 0;
  for (int64_t u = 0; u < unknowns; ++u) {
    op->row[u] = -1;
    if (is_own_unknown(A, u)) list_row(op, u);
  }
  op->own = op->rows;
  for (int64_t i = 0; i < A->rows && A->shared; ++i)
    if (mpmi_is_own_row(A, i)) mark_others(op, i);
  for (int64_t u = 0; u < unknowns && A->shared; ++u)
    if (op->row[u] < -1) list_row(op, u);
  for (int64_t r = 0; r < op->rows; ++r)
    for (int32_t k = 0; k < 3; ++k)
      op->position[k * op->rows + r] = A->position[3 * (op->unknown[r] / A->block) + k];
}

static int64_t count_nonzeros(const mpm_operator *op) {
  const mpmi_matrix *A = op->A;
  int64_t count = 0;
  for (int64_t i = 0; i < A->rows; ++i) {
    int64_t wide = 0, high = 0;
    if (!mpmi_is_own_row(A, i)) continue;
    for (int32_t c = 0; c < A->block; ++c) high += !A->held[i * A->block + c];
    for (int64_t e = A->row_start[i]; high && e < A->row_start[i + 1]; ++e)
      for (int32_t c = 0; c < A->block; ++c) wide += !A->held[(int64_t)A->column[e] * A->block + c];
    count += high * wide;
  }
  return count;
}

static mpm_status open_here(mpm_operator *op, const mpmi_matrix *A) {
  const int64_t unknowns = mpmi_matrix_unknowns(A), parts = op->context->transport.parts;
  if (unknowns > INT32_MAX)
    return mpmi_fail(op->context, MPM_E_UNSUPPORTED, "%lld unknowns are more than columns can be numbered",
                     (long long)unknowns);
  mpm_status status = divide_slab(op, unknowns);
  if (!status && A->shared) status = MPMI_RESERVE_MORE(op->context, op->rows_of, op->rows_of_capacity, parts);
  if (status) return status;
  op->A = A;
  op->has_rows = 0;
  list_rows(op);
  op->nonzeros = count_nonzeros(op);
  return MPM_OK;
}

/* ---- the pattern's number ------------------------------------------------------------------------------ */
/* Unknowns of a node have the same columns. */
static uint64_t hash_columns(const mpm_operator *op, int64_t node) {
  const mpmi_matrix *A = op->A;
  uint64_t h = MPMI_MIX_C;
  for (int64_t e = A->row_start[node]; e < A->row_start[node + 1]; ++e)
    for (int64_t c = 0; c < A->block; ++c) {
      const int32_t column = op->row[A->column[e] * A->block + c];
      if (column >= 0) h = mpmi_absorb(h, (uint64_t)op->number[column]);
    }
  return h;
}

/* A host knows by this number what it has made of a pattern, and may give its solver to another stepper: so
 * it is a hash of what the host is lent. It is a sum over rows, which parts add up, and a double holds it. */
static mpm_status take_pattern_id(mpm_operator *op) {
  const mpmi_matrix *A = op->A;
  uint64_t columns = 0, sum = 0;
  for (int64_t r = 0; r < op->own; ++r) {
    const int64_t node = op->unknown[r] / A->block;
    if (!r || op->unknown[r - 1] / A->block != node) columns = hash_columns(op, node);
    const uint64_t row = mpmi_absorb(mpmi_absorb(columns, (uint64_t)op->node[r]), (uint64_t)op->component[r]);
    sum += mpmi_avalanche(mpmi_absorb(row, (uint64_t)op->number[r]));
  }
  int64_t all = (int64_t)sum;
  if (A->shared) {
    const mpm_status status = mpmi_reduce_parts(op->context, MPM_REDUCE_SUM, 1, &all);
    if (status) return status;
  }
  op->pattern_id = (int64_t)(mpmi_avalanche(mpmi_absorb((uint64_t)all, (uint64_t)A->block)) >> 11);
  op->numbered = A->pattern_id;
  return MPM_OK;
}

/* ---- with other parts ---------------------------------------------------------------------------------- */
/* Takes the numbers of all rows, which the owners tell. */
static mpm_status take_numbers(mpm_operator *op) {
  const mpmi_matrix *A = op->A;
  mpm_context *c = op->context;
  for (int64_t u = 0; u < mpmi_matrix_unknowns(A); ++u)
    op->x[u] = is_own_unknown(A, u) ? (double)(op->first + op->row[u]) : -1.0;
  mpm_status status = mpmi_rows_complete(A->shared, op->x);
  if (status) return status;
  for (int64_t r = 0; r < op->rows; ++r) {
    op->number[r] = (int64_t)op->x[op->unknown[r]];
    if (op->number[r] < 0 && !status)
      status =
          mpmi_fail(c, MPM_E_INTERNAL, "part %d has an unknown at node %lld that its owner does not have",
                    (int)c->transport.part, (long long)op->node[r]);
  }
  return mpmi_agree(c, status);
}

/* Numbers the rows of all parts, part by part, where the pattern has changed on any of them. */
static mpm_status number_rows(mpm_operator *op, mpm_status status) {
  mpm_context *c = op->context;
  int64_t is_new = status || op->numbered != op->A->pattern_id;
  if (status) op->numbered = -1; /* the memory of the numbers may be another one */
  if ((status = mpmi_agree(c, status)) || (status = mpmi_reduce_parts(c, MPM_REDUCE_MAX, 1, &is_new)) ||
      !is_new)
    return status;
  op->numbered = -1;
  if ((status = mpmi_gather_parts(c, op->own, op->rows_of))) return status;
  op->first = op->all = 0;
  for (int32_t r = 0; r < c->transport.parts; ++r) {
    if (r < c->transport.part) op->first += op->rows_of[r];
    op->all += op->rows_of[r];
  }
  if ((status = take_numbers(op))) return status;
  return take_pattern_id(op);
}

/* Parts meet for a product, or where their solver has returned (collective). A product is made when all want
 * it and none is refused; else it fails on those who want it. *any: somebody wants one. */
static mpm_status meet_at_product(mpm_operator *op, int32_t wants, mpm_status status, int32_t *any) {
  mpm_context *c = op->context;
  int64_t word[] = {wants, !wants || status};
  const mpm_status lost = mpmi_reduce_parts(c, MPM_REDUCE_MAX, 2, word);
  *any = !lost && word[0];
  if (lost || !word[0] || !word[1]) return lost;
  if (!wants)
    status = mpmi_fail(c, MPM_E_STATE,
                       "the linear solver has returned here, and applies the matrix on another part");
  return mpmi_agree(c, status);
}

mpm_status mpmi_operator_open(mpm_operator *op, const mpmi_matrix *A, int32_t positive_definite) {
  mpm_status status = open_here(op, A);
  if (A->shared) {
    op->A = A;
    status = number_rows(op, status);
  }
  if (status) return status;
  if (!A->shared) {
    for (int64_t r = 0; r < op->rows; ++r) op->number[r] = r;
    op->all = op->rows;
    op->first = 0;
    if (op->numbered != A->pattern_id) status = take_pattern_id(op);
    if (status) return status;
  }
  op->positive_definite = positive_definite;
  op->open = 1;
  return MPM_OK;
}

void mpmi_operator_close(mpm_operator *op) {
  int32_t any = op->A->shared != NULL;
  op->open = 0;
  while (any) meet_at_product(op, 0, MPM_OK, &any);
}

void mpmi_operator_compress(const mpm_operator *op, const double *full, double *rows) {
  for (int64_t r = 0; r < op->own; ++r) rows[r] = full[op->unknown[r]];
}

void mpmi_operator_expand(const mpm_operator *op, const double *rows, double *full) {
  for (int64_t u = 0; u < mpmi_matrix_unknowns(op->A); ++u)
    full[u] = op->row[u] < 0 || op->row[u] >= op->own ? 0.0 : rows[op->row[u]];
}

/* ---- rows of the matrix -------------------------------------------------------------------------------- */
/* Writes the entries of a row whose columns are of rows from `first` up to `end`. */
static void write_columns(mpm_operator *op, int64_t r, int64_t first, int64_t end, int64_t *count) {
  const mpmi_matrix *A = op->A;
  const int64_t block = A->block, node = op->unknown[r] / block, component = op->unknown[r] % block;
  for (int64_t e = A->row_start[node]; e < A->row_start[node + 1]; ++e)
    for (int64_t c = 0; c < block; ++c) {
      const int32_t column = op->row[A->column[e] * block + c];
      if (column < first || column >= end) continue;
      op->column[*count] = column;
      op->value[(*count)++] = A->value[(e * block + component) * block + c];
    }
}

static mpm_status make_rows(mpm_operator *op) {
  mpm_context *context = op->context;
  mpm_status status = mpmi_reserve(context, (void **)&op->row_start, &op->row_start_capacity, op->rows + 1,
                                   sizeof *op->row_start);
  /* one more, so that the arrays exist without entries */
  if (!status)
    status = mpmi_reserve(context, (void **)&op->column, &op->column_capacity, op->nonzeros + 1,
                          sizeof *op->column);
  if (!status)
    status =
        mpmi_reserve(context, (void **)&op->value, &op->value_capacity, op->nonzeros + 1, sizeof *op->value);
  if (status) return status;
  int64_t count = 0;
  for (int64_t r = 0; r < op->own; ++r) {
    op->row_start[r] = count;
    write_columns(op, r, 0, op->own, &count);
    if (op->own < op->rows) write_columns(op, r, op->own, op->rows, &count);
  }
  for (int64_t r = op->own; r <= op->rows; ++r) op->row_start[r] = count;
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
  status = mpmi_check_out_struct(matrix->context, "mpm_operator_info", (uint32_t)sizeof *info, info);
  if (status) return status;
  const uint32_t needed = (uint32_t)(offsetof(mpm_operator_info, number) + sizeof info->number);
  if (matrix->A->shared && info->struct_size < needed)
    return mpmi_fail(matrix->context, MPM_E_UNSUPPORTED,
                     "mpm_operator_info: struct_size is %u: with several parts a host needs the numbers of "
                     "rows, which stand in %u bytes",
                     info->struct_size, needed);
  const mpm_operator_info known = {.struct_size = sizeof known,
                                   .block = matrix->A->block,
                                   .symmetric = matrix->A->symmetric,
                                   .positive_definite = matrix->positive_definite,
                                   .rows = matrix->rows,
                                   .nonzeros = matrix->nonzeros,
                                   .pattern_id = matrix->pattern_id,
                                   .ld = matrix->rows,
                                   .node = matrix->node,
                                   .component = matrix->component,
                                   .position = matrix->position,
                                   .first_row = matrix->first,
                                   .owned_rows = matrix->own,
                                   .all_rows = matrix->all,
                                   .number = matrix->number};
  return mpmi_write_struct(matrix->context, "mpm_operator_info", &known, sizeof known, info);
}

mpm_status mpm_operator_apply(const mpm_operator *matrix, const double *x, double *y) {
  ENTER(matrix);
  mpm_status status = check_open(matrix);
  if (status) return status;
  if (!x || !y) status = mpmi_fail(matrix->context, MPM_E_ARG, "%s is NULL", x ? "y" : "x");
  int32_t any;
  if (matrix->A->shared) status = meet_at_product((mpm_operator *)(uintptr_t)matrix, 1, status, &any);
  if (status) return status;
  mpmi_operator_expand(matrix, x, matrix->x);
  if (matrix->A->shared) status = mpmi_rows_complete(matrix->A->shared, matrix->x);
  if (!status) status = mpmi_matrix_apply(matrix->A, matrix->x, matrix->y);
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
