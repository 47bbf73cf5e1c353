/* The host's solver sees the linear system without held unknowns. Of several parts each lends the rows that
 * it owns, which are complete; the rows of others that these name in their columns stand behind them,
 * empty. */
#ifndef MPMI_OPERATOR_H
#define MPMI_OPERATOR_H

#include "linalg/matrix.h"

struct mpm_operator {
  uint32_t magic;
  int32_t open;          /* 1: the solve callback is running */
  _Atomic uint32_t busy; /* a call on the system is under way */
  mpm_context *context;
  const mpmi_matrix *A;
  int32_t positive_definite;
  int64_t rows, nonzeros;
  int64_t own, first, all; /* rows that are owned here, of them the first's number, rows of all parts */
  int64_t *unknown;        /* [rows] place in vectors of the matrix */
  int32_t *row;       /* [unknowns of the matrix] the other way, -1 where held, or of no use to owned rows */
  int64_t *number;    /* [rows] over all parts */
  int64_t *node;      /* [rows] */
  int32_t *component; /* [rows] */
  double *position;   /* [3][rows] */
  double *x, *y;      /* [unknowns of the matrix] */
  /* Compressed rows are made when the host asks for them. */
  int32_t has_rows;
  int64_t *row_start;
  int32_t *column;
  double *value;
  int64_t numbered;   /* the matrix' pattern that numbers are of, -1: of none */
  int64_t pattern_id; /* what the host is told */
  int64_t *rows_of;   /* of several parts: rows of each */
  char *slab;
  int64_t slab_capacity, row_start_capacity, column_capacity, value_capacity, rows_of_capacity;
};

void mpmi_operator_init(mpm_operator *op, mpm_context *context);
void mpmi_operator_free(mpm_operator *op);
/* Lends the matrix until mpmi_operator_close(); of several parts all do both together. */
mpm_status mpmi_operator_open(mpm_operator *op, const mpmi_matrix *A, int32_t positive_definite);
void mpmi_operator_close(mpm_operator *op);

/* These convert between vectors of the matrix and those of the host, which have owned rows and no held
 * unknowns; expanding writes zeros there. */
void mpmi_operator_compress(const mpm_operator *op, const double *full, double *rows);
void mpmi_operator_expand(const mpm_operator *op, const double *rows, double *full);

#endif
