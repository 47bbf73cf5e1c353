/* Rows of a matrix of which several parts of a problem have some each. A part has the rows of its nodes,
 * those that it owns and others beside them; a row is owned by one part, which alone computes with it and
 * gives its values to those who have it, too.
 *
 * Rows have the numbers that they would have in one part. Sums over them are made in that order, range by
 * range (vectors.h), so that all bits are those of one part: whoever owns a row sends its term to the part
 * that adds up the range, and all parts learn what the ranges have come to. */
#ifndef MPMI_ROWS_H
#define MPMI_ROWS_H

#include "context/context.h"

/* Which rows go to other parts, and which come from them; by part. */
typedef struct mpmi_row_link {
  int32_t partners;
  int32_t *part;                 /* [partners] ascending */
  int64_t *out_start, *in_start; /* [partners + 1] */
  int64_t *out, *in;             /* rows that are sent, and where they go */
  double *packed;                /* what is sent: numbers of each row, for so many vectors */
  int32_t vectors;
  mpm_message *message; /* [partners] */
  int64_t *most;        /* [partners] */
  int32_t partner_capacity;
  int64_t out_count, in_count; /* capacities */
} mpmi_row_link;

typedef struct mpmi_rows {
  mpm_context *context;
  int32_t block;
  int64_t count, all; /* rows here, and of all parts */
  uint8_t *own;       /* [count] 1: this part owns it */
  int64_t *number;    /* [count] of own rows: among all */
  int64_t own_capacity, number_capacity;
  mpmi_row_link halo, sums;     /* values of rows; terms of sums */
  int64_t first, end;           /* rows whose terms come here, by number */
  int64_t added_from, added_to; /* ranges are added up here that begin at these rows, by number */
  double *term;                 /* [end - first][block] of one sum */
  int64_t term_capacity;
} mpmi_rows;

/* What parts tell of their rows; all arrays are [count], rows ascend by (key, place). */
typedef struct mpmi_rows_desc {
  int64_t count;
  const uint64_t *key;   /* of the block of nodes */
  const int32_t *place;  /* in it */
  const int32_t *owner;  /* the part that owns the row */
  const int32_t *home;   /* a part that is the same for all rows with this key, and ascends with keys */
  const uint8_t *wanted; /* 1: this part wants the values of the row where it does not own it */
} mpmi_rows_desc;

mpm_status mpmi_rows_create(mpm_context *context, int32_t block, mpmi_rows **out);
void mpmi_rows_destroy(mpmi_rows *rows); /* NULL is fine */
/* Numbers the rows, and finds who needs what (collective). status: what has happened before. */
mpm_status mpmi_rows_share(mpmi_rows *rows, const mpmi_rows_desc *desc, mpm_status status);

/* Takes the values of wanted rows from those who own them (collective). Fails only where the parts have lost
 * each other. */
mpm_status mpmi_rows_complete(const mpmi_rows *rows, double *x);

/* Sums of a . b, or with `scale` of a . (scale b), over the unknowns of own rows of all parts (collective);
 * `by` says into which ranges they are cut: of rows, of unknowns, or as mpmi_dot() adds. There are at most
 * MPMI_ROW_SUMS of them. status: what has happened on this part before; whoever has failed takes part, and
 * all parts have the status of the first one. */
enum { MPMI_BY_ROWS, MPMI_BY_UNKNOWNS, MPMI_BY_FOURS };
enum { MPMI_ROW_SUMS = 16 };
typedef struct mpmi_row_terms {
  const double *a, *b, *scale;
} mpmi_row_terms;
mpm_status mpmi_rows_sum(const mpmi_rows *rows, int32_t by, int32_t count, const mpmi_row_terms *terms,
                         double *sum, mpm_status status);

/* Returns the part whose own row comes first by number among all that have one, or -1 (collective); row: -1
 * for none. */
mpm_status mpmi_rows_first(const mpmi_rows *rows, int64_t row, int32_t *part);

#endif
