/* The smoother of a level keeps a scaled copy of its matrix by lines, and the factors of the lines. */
#include <math.h>
#include <string.h>

#include "context/arena.h"
#include "linalg/sweep.h"
#include "linalg/vectors.h"
#include "simd/isa.h"

MPMI_DECLARE_TABLES(mpmi_sweeps, mpmi_sweeps);

const mpmi_sweeps *mpmi_sweeps_of(int32_t isa) {
  return MPMI_TABLE_OF(isa, mpmi_sweeps);
}

/* A pivot that is smaller than this, beside a diagonal of 1, is lost in rounding. */
static const double no_pivot = 1e-7;

static mpm_status reserve_numbers(mpmi_smoother *s, const mpmi_matrix *A, int64_t values, int64_t factors) {
  const int64_t rows = A->rows, lanes = MPMI_PADDED(A->block);
  mpmi_arena from = {NULL, 0};
  for (;;) {
    s->value_start = mpmi_arena_take(&from, s->lines.count, sizeof *s->value_start);
    s->factor_start = mpmi_arena_take(&from, s->lines.count, sizeof *s->factor_start);
    s->value = mpmi_arena_take(&from, values + 1, sizeof *s->value); /* lanes read one more */
    s->factor = mpmi_arena_take(&from, factors, sizeof *s->factor);
    s->half = mpmi_arena_take(&from, s->lines.unknowns, sizeof *s->half);
    s->scale = mpmi_arena_take(&from, rows * A->block, sizeof *s->scale);
    s->unscale = mpmi_arena_take(&from, rows * A->block, sizeof *s->unscale);
    s->rhs = mpmi_arena_take(&from, rows * lanes, sizeof *s->rhs);
    s->x = mpmi_arena_take(&from, rows * lanes, sizeof *s->x);
    s->residual = mpmi_arena_take(&from, rows * lanes, sizeof *s->residual);
    if (from.memory) return MPM_OK;
    const mpm_status status =
        mpmi_reserve(A->context, (void **)&s->slab, &s->slab_capacity, (int64_t)from.used, 1);
    if (status) return status;
    from = (mpmi_arena){s->slab, 0};
  }
}

void mpmi_smoother_free(mpmi_smoother *s, mpm_context *context) {
  mpmi_free(context, s->slab, (size_t)s->slab_capacity);
  mpmi_free(context, s->lines_slab, (size_t)s->lines_capacity);
  memset(s, 0, sizeof *s);
}

static int64_t values_of(const mpmi_matrix *A, int64_t unknown) {
  const int64_t row = unknown / A->block;
  return A->block * (A->row_start[row + 1] - A->row_start[row]);
}

static int64_t factors_of(const mpmi_lines *l, int64_t line) {
  return (2 * l->band[line] + 1) * (l->start[line + 1] - l->start[line]);
}

mpm_status mpmi_smoother_analyse(mpmi_smoother *s, const mpmi_matrix *A) {
  s->rows = A->rows;
  s->block = A->block;
  mpm_status status = mpmi_lines_find(s, A);
  if (status) return status;
  const mpmi_lines *l = &s->lines;
  int64_t values = 0, factors = 0;
  for (int64_t q = 0; q < l->unknowns; ++q) values += values_of(A, l->unknown[q]);
  for (int64_t line = 0; line < l->count; ++line) factors += factors_of(l, line);
  if ((status = reserve_numbers(s, A, values, factors))) return status;
  values = factors = 0;
  for (int64_t line = 0; line < l->count; ++line) {
    s->value_start[line] = values;
    s->factor_start[line] = factors;
    for (int64_t q = l->start[line]; q < l->start[line + 1]; ++q) values += values_of(A, l->unknown[q]);
    factors += factors_of(l, line);
  }
  return MPM_OK;
}

/* ---- numbers ------------------------------------------------------------------------------------------- */
typedef struct smoother_job {
  mpmi_smoother *s;
  const mpmi_matrix *A;
  mpmi_ranges ranges;
  mpmi_range_failures bad; /* rows with a bad diagonal */
} smoother_job;

static mpm_status scale_row(mpmi_smoother *s, const mpmi_matrix *A, int64_t i) {
  const int32_t block = s->block;
  const double *value = A->value + mpmi_matrix_entry(A, i, i) * block * block;
  for (int32_t c = 0; c < block; ++c) {
    const double diagonal = value[c * block + c];
    if (!isfinite(diagonal)) return MPM_NONFINITE;
    if (A->symmetric && !(diagonal > 0.0)) return MPM_SINGULAR;
    const double size = fabs(diagonal) > 0.0 ? sqrt(fabs(diagonal)) : 1.0;
    const int32_t held = A->held[i * block + c];
    s->scale[i * block + c] = held ? 0.0 : 1.0 / size;
    s->unscale[i * block + c] = held ? 0.0 : size;
  }
  return MPM_OK;
}

static void scales_task(void *data, int64_t k) {
  smoother_job *job = data;
  const int64_t end = mpmi_range_begin(&job->ranges, k + 1);
  job->bad.status[k] = MPM_OK;
  for (int64_t i = mpmi_range_begin(&job->ranges, k); i < end && !job->bad.status[k]; ++i) {
    job->bad.status[k] = scale_row(job->s, job->A, i);
    job->bad.item[k] = i;
  }
}

enum { WIDTH = 2 * MPMI_MOST_BAND + 1 };

/* Writes the scaled row of an unknown without the entries of its line, and these apart: those of the places
 * around, the diagonal in the middle. */
static float *write_row(const mpmi_smoother *s, const mpmi_matrix *A, int64_t line, int64_t q, float *to,
                        double *within) {
  const mpmi_lines *l = &s->lines;
  const int32_t block = s->block;
  const int64_t row = l->unknown[q] / block, component = l->unknown[q] % block;
  memset(within, 0, WIDTH * sizeof *within);
  for (int64_t e = A->row_start[row]; e < A->row_start[row + 1]; ++e)
    for (int32_t c = 0; c < block; ++c) {
      const int64_t other = (int64_t)A->column[e] * block + c, place = l->place[other];
      const double value =
          s->scale[l->unknown[q]] * A->value[(e * block + component) * block + c] * s->scale[other];
      const int32_t on_line = place >= l->start[line] && place < l->start[line + 1];
      if (on_line) within[MPMI_MOST_BAND + place - q] = value;
      *to++ = on_line ? 0.0F : (float)value;
    }
  return to;
}

/* Factors a line without pivoting, row by row; the last `band` rows of U are enough for the next one. */
static void factor_line(const mpmi_smoother *s, const mpmi_matrix *A, int64_t line) {
  const mpmi_lines *l = &s->lines;
  const int32_t band = l->band[line], rows = band + 1;
  float *value = s->value + s->value_start[line], *to = s->factor + s->factor_start[line];
  double upper[MPMI_MOST_BAND + 1][MPMI_MOST_BAND + 1]; /* by row modulo `rows`: the pivot, then over it */
  for (int64_t q = 0; q < l->start[line + 1] - l->start[line]; ++q) {
    double row[WIDTH], *a = row + MPMI_MOST_BAND;
    value = write_row(s, A, line, l->start[line] + q, value, row);
    for (int32_t k = -band; k < 0; ++k) {
      const double *u = upper[(q + k + rows) % rows];
      const double by = q + k < 0 ? 0.0 : a[k] / u[0];
      for (int32_t j = 1; j <= band && q + k >= 0; ++j) a[k + j] -= by * u[0] * u[j];
      *to++ = (float)by;
    }
    if (!(fabs(a[0]) > no_pivot)) a[0] = 1.0;
    double *u = upper[q % rows];
    u[0] = a[0];
    *to++ = (float)(1.0 / a[0]);
    for (int32_t j = 1; j <= band; ++j) *to++ = (float)(u[j] = a[j] / a[0]);
  }
}

static void lines_task(void *data, int64_t k) {
  const smoother_job *job = data;
  for (int64_t line = mpmi_range_begin(&job->ranges, k); line < mpmi_range_begin(&job->ranges, k + 1); ++line)
    factor_line(job->s, job->A, line);
}

mpm_status mpmi_smoother_numbers(mpmi_smoother *s, const mpmi_matrix *A, int64_t *row) {
  const int64_t unknowns = mpmi_matrix_unknowns(A);
  smoother_job job = {.s = s, .A = A, .ranges = mpmi_ranges_of(A->rows, unknowns)};
  const size_t bytes = (size_t)(s->rows * MPMI_PADDED(s->block)) * sizeof *s->x;
  memset(s->rhs, 0, bytes);
  memset(s->x, 0, bytes);
  memset(s->residual, 0, bytes);
  s->row_start = A->row_start;
  s->column = A->column;
  mpm_status status = mpmi_run_ranges(A->context, &job.ranges, scales_task, &job);
  if (!status) status = mpmi_first_failure(&job.bad, job.ranges.count, row);
  job.ranges = mpmi_ranges_of(s->lines.count, unknowns);
  return status ? status : mpmi_run_ranges(A->context, &job.ranges, lines_task, &job);
}
