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
static double term_of(const mpmi_row_terms *of, int64_t at) {
  return of->a[at] * (of->scale ? of->scale[at] * of->b[at] : of->b[at]);
}

/* Sends the terms that other parts add up, of all sums at once, and takes theirs. */
static mpm_status exchange_terms(const mpmi_rows *rows, int32_t count, const mpmi_row_terms *terms,
                                 const mpm_message **in) {
  const mpmi_row_link *link = &rows->sums;
  const int64_t block = rows->block, out = link->partners ? link->out_start[link->partners] : 0;
  for (int64_t i = 0; i < out; ++i)
    for (int32_t s = 0; s < count; ++s)
      for (int64_t c = 0; c < block; ++c)
        link->packed[(i * count + s) * block + c] = term_of(&terms[s], link->out[i] * block + c);
  return exchange(rows->context, link, count * block, in);
}

/* Puts the terms of one of the sums into their order, own ones and those that have come. */
static void place_terms(const mpmi_rows *rows, int32_t count, int32_t which, const mpmi_row_terms *of,
                        const mpm_message *in) {
  const mpmi_row_link *link = &rows->sums;
  const int64_t block = rows->block;
  for (int64_t r = 0; r < rows->count; ++r) {
    if (!rows->own[r] || rows->number[r] < rows->first || rows->number[r] >= rows->end) continue;
    for (int64_t c = 0; c < block; ++c)
      rows->term[(rows->number[r] - rows->first) * block + c] = term_of(of, r * block + c);
  }
  for (int32_t k = 0; k < link->partners; ++k) {
    const double *from = (const double *)in[k].data + which * block;
    for (int64_t i = link->in_start[k]; i < link->in_start[k + 1]; ++i, from += count * block)
      memcpy(rows->term + link->in[i] * block, from, (size_t)block * sizeof *from);
  }
}

/* Adds up a range as apply.c, cg.c and gmres.c do, or as mpmi_dot(). */
static double add_range(const double *term, int64_t count, int32_t by_fours) {
  double sum[4] = {0.0, 0.0, 0.0, 0.0};
  int64_t i = 0;
  for (; i + 4 <= count && by_fours; i += 4)
    for (int32_t l = 0; l < 4; ++l) sum[l] += term[i + l];
  for (; i < count; ++i) sum[0] += term[i];
  return by_fours ? (sum[0] + sum[1]) + (sum[2] + sum[3]) : sum[0];
}

/* Adds up the ranges that begin in the share of this part, of the sum whose terms are in their places; others
 * get what is less than any number. */
static void add_ranges(const mpmi_rows *rows, int32_t by, const mpmi_ranges *ranges, int64_t *part) {
  const int64_t unit = by == MPMI_BY_ROWS ? rows->block : 1; /* unknowns in an item of a range */
  const int64_t from = rows->added_from * rows->block / unit, to = rows->added_to * rows->block / unit;
  for (int64_t k = 0; k < ranges->count; ++k) {
    const int64_t begin = mpmi_range_begin(ranges, k), end = mpmi_range_begin(ranges, k + 1);
    part[k] = INT64_MIN;
    if (begin < from || begin >= to) continue;
    const double added = add_range(rows->term + begin * unit - rows->first * rows->block,
                                   (end - begin) * unit, by == MPMI_BY_FOURS);
    memcpy(&part[k], &added, sizeof added);
  }
}

mpm_status mpmi_rows_sum(const mpmi_rows *rows, int32_t by, int32_t count, const mpmi_row_terms *terms,
                         double *sum, mpm_status status) {
  const int64_t unknowns = rows->all * rows->block;
  const mpmi_ranges ranges = mpmi_ranges_of(by == MPMI_BY_ROWS ? rows->all : unknowns, unknowns);
  const mpm_message *in = NULL;
  int64_t part[MPMI_ROW_SUMS * MPMI_MOST_RANGES + 1];
  memset(sum, 0, (size_t)count * sizeof *sum);
  mpm_status lost = ranges.count ? exchange_terms(rows, count, terms, &in) : MPM_OK;
  for (int32_t s = 0; s < count && !lost; ++s) {
    if (ranges.count) place_terms(rows, count, s, &terms[s], in);
    add_ranges(rows, by, &ranges, part + s * ranges.count);
  }
  int64_t *any = &part[count * ranges.count];
  *any = status != MPM_OK;
  if (!lost) lost = mpmi_reduce_parts(rows->context, MPM_REDUCE_MAX, count * ranges.count + 1, part);
  if (lost) return lost;
  if (*any) return mpmi_agree(rows->context, status);
  for (int32_t s = 0; s < count; ++s) {
    double of_range[MPMI_MOST_RANGES];
    memcpy(of_range, part + s * ranges.count, (size_t)ranges.count * sizeof *of_range);
    sum[s] = mpmi_reduce(MPMI_REDUCE_SUM, 0.0, of_range, 1, NULL, ranges.count);
  }
  return MPM_OK;
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
