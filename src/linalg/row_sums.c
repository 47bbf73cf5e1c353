/* Values and sums of the rows of several parts. */
#include <string.h>

#include "context/reduce.h"
#include "context/transport.h"
#include "linalg/rows.h"
#include "linalg/vectors.h"

/* Exchanges what is packed, so many numbers for each row. */
static mpm_status exchange(mpm_context *c, const mpmi_row_link *link, int64_t each, const mpm_message **in) {
  int32_t count = 0;
  for (int32_t k = 0; k < link->partners; ++k) {
    const int64_t bytes = each * (int64_t)sizeof(double);
    link->message[k] = (mpm_message){.part = link->part[k],
                                     .bytes = bytes * (link->out_start[k + 1] - link->out_start[k]),
                                     .data = link->packed + each * link->out_start[k]};
    link->most[k] = bytes * (link->in_start[k + 1] - link->in_start[k]);
  }
  mpm_status status = mpmi_send(c, MPM_EXCHANGE_KNOWN, link->partners, link->message, link->most);
  if (!status) status = mpmi_receive(c, &count, in);
  if (status) return status;
  for (int32_t k = 0; k < link->partners; ++k)
    if (count != link->partners || (*in)[k].part != link->part[k] || (*in)[k].bytes != link->most[k])
      return mpmi_fail(c, MPM_E_CALLBACK, "the transport has not brought the rows of part %d",
                       (int)link->part[k]);
  return MPM_OK;
}

mpm_status mpmi_rows_complete(const mpmi_rows *rows, double *x) {
  const mpmi_row_link *link = &rows->halo;
  const int64_t block = rows->block, out = link->partners ? link->out_start[link->partners] : 0;
  const mpm_message *in = NULL;
  for (int64_t i = 0; i < out; ++i)
    memcpy(link->packed + i * block, x + link->out[i] * block, (size_t)block * sizeof *x);
  const mpm_status status = exchange(rows->context, link, block, &in);
  for (int32_t k = 0; k < link->partners && !status; ++k) {
    const double *from = in[k].data;
    for (int64_t i = link->in_start[k]; i < link->in_start[k + 1]; ++i, from += block)
      memcpy(x + link->in[i] * block, from, (size_t)block * sizeof *x);
  }
  return status;
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
enum { MOST_SUMS = 2 };

static double term_of(const mpmi_row_terms *of, int64_t at) {
  return of->a[at] * (of->scale ? of->scale[at] * of->b[at] : of->b[at]);
}

static double *place_of(const mpmi_rows *rows, int32_t sum, int64_t row) {
  return rows->term + (sum * (rows->end - rows->first) + row) * rows->block;
}

/* Brings the terms to where they are added up. */
static mpm_status bring_terms(const mpmi_rows *rows, int32_t count, const mpmi_row_terms *terms) {
  const mpmi_row_link *link = &rows->sums;
  const int64_t block = rows->block, out = link->partners ? link->out_start[link->partners] : 0;
  const mpm_message *in = NULL;
  for (int64_t i = 0; i < out; ++i)
    for (int32_t s = 0; s < count; ++s)
      for (int64_t c = 0; c < block; ++c)
        link->packed[(i * count + s) * block + c] = term_of(&terms[s], link->out[i] * block + c);
  for (int64_t r = 0; r < rows->count; ++r) {
    if (!rows->own[r] || rows->number[r] < rows->first || rows->number[r] >= rows->end) continue;
    for (int32_t s = 0; s < count; ++s)
      for (int64_t c = 0; c < block; ++c)
        place_of(rows, s, rows->number[r] - rows->first)[c] = term_of(&terms[s], r * block + c);
  }
  const mpm_status status = exchange(rows->context, link, count * block, &in);
  for (int32_t k = 0; k < link->partners && !status; ++k) {
    const double *from = in[k].data;
    for (int64_t i = link->in_start[k]; i < link->in_start[k + 1]; ++i)
      for (int32_t s = 0; s < count; ++s, from += block)
        memcpy(place_of(rows, s, link->in[i]), from, (size_t)block * sizeof *from);
  }
  return status;
}

/* Adds up a range as apply.c and cg.c do, or as mpmi_dot(). */
static double add_range(const double *term, int64_t count, int32_t by_fours) {
  double sum[4] = {0.0, 0.0, 0.0, 0.0};
  int64_t i = 0;
  for (; i + 4 <= count && by_fours; i += 4)
    for (int32_t l = 0; l < 4; ++l) sum[l] += term[i + l];
  for (; i < count; ++i) sum[0] += term[i];
  return by_fours ? (sum[0] + sum[1]) + (sum[2] + sum[3]) : sum[0];
}

mpm_status mpmi_rows_sum(const mpmi_rows *rows, int32_t by, int32_t count, const mpmi_row_terms *terms,
                         double *sum) {
  const int64_t unit = by == MPMI_BY_ROWS ? rows->block : 1; /* unknowns in an item of a range */
  const int64_t items = rows->all * rows->block / unit;
  const mpmi_ranges ranges = mpmi_ranges_of(items, rows->all * rows->block);
  int64_t part[MOST_SUMS * MPMI_MOST_RANGES];
  memset(sum, 0, (size_t)count * sizeof *sum);
  mpm_status status = ranges.count ? bring_terms(rows, count, terms) : MPM_OK;
  if (status || !ranges.count) return status;
  const int64_t from = rows->added_from * rows->block / unit, to = rows->added_to * rows->block / unit;
  for (int64_t i = 0; i < count * ranges.count; ++i) {
    const int64_t s = i / ranges.count, k = i % ranges.count;
    const int64_t begin = mpmi_range_begin(&ranges, k), end = mpmi_range_begin(&ranges, k + 1);
    part[i] = INT64_MIN;
    if (begin < from || begin >= to) continue;
    const double *term = place_of(rows, (int32_t)s, 0) + begin * unit - rows->first * rows->block;
    const double added = add_range(term, (end - begin) * unit, by == MPMI_BY_FOURS);
    memcpy(&part[i], &added, sizeof added);
  }
  status = mpmi_reduce_parts(rows->context, MPM_REDUCE_MAX, count * ranges.count, part);
  for (int32_t s = 0; s < count; ++s) {
    double of_range[MPMI_MOST_RANGES];
    memcpy(of_range, part + s * ranges.count, (size_t)ranges.count * sizeof *of_range);
    sum[s] = status ? 0.0 : mpmi_reduce(MPMI_REDUCE_SUM, 0.0, of_range, 1, NULL, ranges.count);
  }
  return status;
}

mpm_status mpmi_rows_first(const mpmi_rows *rows, int64_t row, int32_t *part) {
  const int64_t mine = row < 0 ? INT64_MIN : -rows->number[row];
  int64_t first = mine;
  *part = -1;
  mpm_status status = mpmi_reduce_parts(rows->context, MPM_REDUCE_MAX, 1, &first);
  if (status || first == INT64_MIN) return status;
  int64_t whose = mine == first ? rows->context->transport.part : -1;
  status = mpmi_reduce_parts(rows->context, MPM_REDUCE_MAX, 1, &whose);
  *part = (int32_t)whose;
  return status;
}
