/* The smoother of a level orders its nodes by colour and keeps a scaled copy of its matrix, for the kernels
 * of sweep.c. */
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

/* Gives each node the first colour that none of its neighbours has. taken: [rows], by colour the last node
 * that saw it at a neighbour. */
static int32_t colour_nodes(const mpmi_matrix *A, int32_t *colour, int32_t *taken) {
  int32_t colours = 0;
  memset(colour, 0xff, (size_t)A->rows * sizeof *colour);
  memset(taken, 0xff, (size_t)A->rows * sizeof *taken);
  for (int64_t i = 0; i < A->rows; ++i) {
    for (int64_t e = A->row_start[i]; e < A->row_start[i + 1]; ++e)
      if (colour[A->column[e]] >= 0) taken[colour[A->column[e]]] = (int32_t)i;
    int32_t c = 0;
    while (c < colours && taken[c] == i) ++c;
    colour[i] = c;
    if (c == colours) ++colours;
  }
  return colours;
}

static mpm_status reserve_lists(mpmi_smoother *s, const mpmi_matrix *A) {
  const int64_t rows = A->rows, entries = A->row_start[rows] - rows, lanes = MPMI_PADDED(A->block);
  const int64_t area = A->block * A->block;
  mpmi_arena from = {NULL, 0};
  for (;;) {
    s->colour_start = mpmi_arena_take(&from, s->colours + 1, sizeof *s->colour_start);
    s->row_start = mpmi_arena_take(&from, rows + 1, sizeof *s->row_start);
    s->middle = mpmi_arena_take(&from, rows, sizeof *s->middle);
    s->order = mpmi_arena_take(&from, rows, sizeof *s->order);
    s->place = mpmi_arena_take(&from, rows, sizeof *s->place);
    s->column = mpmi_arena_take(&from, entries, sizeof *s->column);
    s->value = mpmi_arena_take(&from, entries * area + 1, sizeof *s->value); /* lanes read one more */
    s->inverse = mpmi_arena_take(&from, rows * area, sizeof *s->inverse);
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
  memset(s, 0, sizeof *s);
}

/* Orders the places colour by colour, and within a colour in the order of the rows. */
static void order_by_colour(mpmi_smoother *s, const int32_t *colour) {
  memset(s->colour_start, 0, (size_t)(s->colours + 1) * sizeof *s->colour_start);
  for (int64_t i = 0; i < s->rows; ++i) ++s->colour_start[colour[i] + 1];
  for (int32_t c = 0; c < s->colours; ++c) s->colour_start[c + 1] += s->colour_start[c];
  for (int64_t i = 0; i < s->rows; ++i) {
    s->place[i] = (int32_t)s->colour_start[colour[i]]++;
    s->order[s->place[i]] = (int32_t)i;
  }
  for (int32_t c = s->colours; c > 0; --c) s->colour_start[c] = s->colour_start[c - 1];
  s->colour_start[0] = 0;
}

typedef struct smoother_job {
  mpmi_smoother *s;
  const mpmi_matrix *A;
  mpmi_ranges ranges;
  mpmi_range_failures bad; /* rows with a bad diagonal */
} smoother_job;

static void columns_task(void *data, int64_t k) {
  const smoother_job *job = data;
  mpmi_smoother *s = job->s;
  const mpmi_matrix *A = job->A;
  for (int64_t p = mpmi_range_begin(&job->ranges, k); p < mpmi_range_begin(&job->ranges, k + 1); ++p) {
    const int64_t i = s->order[p];
    int64_t before = s->row_start[p], after = before;
    for (int64_t e = A->row_start[i]; e < A->row_start[i + 1]; ++e) after += s->place[A->column[e]] < p;
    s->middle[p] = after;
    for (int64_t e = A->row_start[i]; e < A->row_start[i + 1]; ++e) {
      const int32_t place = s->place[A->column[e]];
      if (place != p) s->column[place < p ? before++ : after++] = place;
    }
  }
}

mpm_status mpmi_smoother_analyse(mpmi_smoother *s, const mpmi_matrix *A, int32_t *scratch) {
  s->rows = A->rows;
  s->block = A->block;
  s->colours = colour_nodes(A, scratch, scratch + A->rows);
  mpm_status status = reserve_lists(s, A);
  if (status) return status;
  order_by_colour(s, scratch);
  s->row_start[0] = 0;
  for (int64_t p = 0; p < s->rows; ++p) {
    const int64_t i = s->order[p];
    s->row_start[p + 1] = s->row_start[p] + A->row_start[i + 1] - A->row_start[i] - 1;
  }
  smoother_job job = {.s = s, .A = A, .ranges = mpmi_ranges_of(A->rows, mpmi_matrix_unknowns(A))};
  return mpmi_run_ranges(A->context, &job.ranges, columns_task, &job);
}

/* ---- numbers ------------------------------------------------------------------------------------------- */
/* Scales and inverts the diagonal block of a row, and stores it by columns. */
static void invert_diagonal(mpmi_smoother *s, const double *value, int64_t p) {
  const int32_t block = s->block;
  float *to = s->inverse + p * block * block;
  double a[3][3];
  for (int32_t r = 0; r < block; ++r)
    for (int32_t c = 0; c < block; ++c) {
      const double scale = s->scale[p * block + r] * s->scale[p * block + c];
      a[r][c] = scale > 0.0 ? scale * value[r * block + c] : r == c ? 1.0 : 0.0;
    }
  const int32_t regular = mpmi_invert_block(block, a);
  for (int32_t c = 0; c < block; ++c)
    for (int32_t r = 0; r < block; ++r) to[c * block + r] = regular ? (float)a[r][c] : r == c ? 1.0F : 0.0F;
}

static mpm_status scale_row(mpmi_smoother *s, const mpmi_matrix *A, int64_t p) {
  const int64_t i = s->order[p];
  const int32_t block = s->block;
  int64_t e = A->row_start[i];
  while (A->column[e] != i) ++e;
  const double *value = A->value + e * block * block;
  for (int32_t c = 0; c < block; ++c) {
    const double diagonal = value[c * block + c];
    if (!isfinite(diagonal)) return MPM_NONFINITE;
    if (A->symmetric && !(diagonal > 0.0)) return MPM_SINGULAR;
    const double size = fabs(diagonal) > 0.0 ? sqrt(fabs(diagonal)) : 1.0;
    const int32_t held = A->held[i * block + c];
    s->scale[p * block + c] = held ? 0.0 : 1.0 / size;
    s->unscale[p * block + c] = held ? 0.0 : size;
  }
  invert_diagonal(s, value, p);
  return MPM_OK;
}

static void scales_task(void *data, int64_t k) {
  smoother_job *job = data;
  const int64_t end = mpmi_range_begin(&job->ranges, k + 1);
  job->bad.status[k] = MPM_OK;
  for (int64_t p = mpmi_range_begin(&job->ranges, k); p < end && !job->bad.status[k]; ++p) {
    job->bad.status[k] = scale_row(job->s, job->A, p);
    job->bad.item[k] = job->s->order[p];
  }
}

static void values_task(void *data, int64_t k) {
  const smoother_job *job = data;
  mpmi_smoother *s = job->s;
  const mpmi_matrix *A = job->A;
  const int32_t block = s->block;
  for (int64_t p = mpmi_range_begin(&job->ranges, k); p < mpmi_range_begin(&job->ranges, k + 1); ++p) {
    int64_t before = s->row_start[p], after = s->middle[p];
    for (int64_t e = A->row_start[s->order[p]]; e < A->row_start[s->order[p] + 1]; ++e) {
      const int64_t other = s->place[A->column[e]];
      if (other == p) continue;
      const double *from = A->value + e * block * block;
      float *to = s->value + (other < p ? before++ : after++) * block * block;
      for (int32_t c = 0; c < block; ++c)
        for (int32_t r = 0; r < block; ++r)
          to[c * block + r] =
              (float)(s->scale[p * block + r] * from[r * block + c] * s->scale[other * block + c]);
    }
  }
}

mpm_status mpmi_smoother_numbers(mpmi_smoother *s, const mpmi_matrix *A, int64_t *row) {
  smoother_job job = {.s = s, .A = A, .ranges = mpmi_ranges_of(A->rows, mpmi_matrix_unknowns(A))};
  const size_t bytes = (size_t)(s->rows * MPMI_PADDED(s->block)) * sizeof *s->x;
  memset(s->rhs, 0, bytes);
  memset(s->x, 0, bytes);
  mpm_status status = mpmi_run_ranges(A->context, &job.ranges, scales_task, &job);
  if (!status) status = mpmi_first_failure(&job.bad, job.ranges.count, row);
  return status ? status : mpmi_run_ranges(A->context, &job.ranges, values_task, &job);
}
