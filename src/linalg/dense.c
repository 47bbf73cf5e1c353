/* The arithmetic of fronts for one instruction set. */
#include "linalg/dense.h"

#include <math.h>
#include <string.h>

#include "simd/lanes.h"

/* A tile of the update has 2 registers of rows and STRIP columns: enough sums to hide the latency of a
 * multiply-add, and few enough for the registers. */
enum {
  SLIVER = 2 * MPMI_LANES,
#if MPMI_WIDTH == 8
  STRIP = 8,
#else
  STRIP = 4,
#endif
  STRIPS_PER_SLIVER = SLIVER / STRIP,
  ROOM = SLIVER * MPMI_PANEL, /* doubles of a sliver */
  AT_ONCE = 4                 /* columns solved for together */
};
#if defined(__clang__)
#define UNROLL MPMI_UNROLL
#else
#define UNROLL _Pragma("GCC unroll 8")
#endif

/* The scratch has four areas: rows of L and of L D, and rows of U transposed and of that times D. */
static double *area(const mpmi_dense_front *f, int32_t which) {
  return f->scratch +
         which * ROOM * (mpmi_dense_pieces(f->pivots, SLIVER) + mpmi_dense_pieces(f->rows, SLIVER));
}
enum { L_ROWS, L_TIMES_D, U_ROWS, U_TIMES_D };

static int32_t is_symmetric(const mpmi_dense_front *f) {
  return f->upper == f->lower;
}

/* A span is the rows of one sliver or strip. Those of the pivots come first, and the last one of a group
 * may be shorter than `size`. */
typedef struct span {
  int64_t first, count;
} span;

static span span_of(const mpmi_dense_front *f, int64_t number, int64_t size) {
  const int64_t next = f->first + f->width, of_pivots = mpmi_dense_pieces(f->pivots - next, size);
  const int64_t first = number < of_pivots ? next + number * size : f->pivots + (number - of_pivots) * size;
  const int64_t end = number < of_pivots ? f->pivots : f->pivots + f->rows;
  return (span){first, end - first < size ? end - first : size};
}

/* ---- the panel's own block ----------------------------------------------------------------------------- */
static void fetch_block(const mpmi_dense_front *f, const double *panel, double *block) {
  const int64_t ld = f->pivots + f->rows;
  for (int64_t c = 0; c < f->width; ++c)
    for (int64_t r = c; r < f->width; ++r)
      block[c * MPMI_PANEL + r] = panel[(f->first + c) * ld + f->first + r];
}

static void store_block(const mpmi_dense_front *f, const double *block, double *panel) {
  const int64_t ld = f->pivots + f->rows;
  for (int64_t c = 0; c < f->width; ++c)
    for (int64_t r = c + 1; r < f->width; ++r)
      panel[(f->first + c) * ld + f->first + r] = block[c * MPMI_PANEL + r];
}

/* Subtracts from the block the scaled column times the row that `times` holds below its diagonal. */
static void take_column(const double *scaled, const double *times, int64_t j, int64_t width, double *block) {
  for (int64_t c = j + 1; c < width; ++c) {
    const double factor = times[c];
    double *column = block + c * MPMI_PANEL;
    for (int64_t r = c; r < width; ++r) column[r] -= scaled[r] * factor;
  }
}

static int64_t factor_block(mpmi_dense_front *f) {
  double *lower = f->lower_block, *upper = f->upper_block, scaled[2][MPMI_PANEL];
  const int32_t symmetric = is_symmetric(f);
  const int64_t width = f->width;
  memset(lower, 0, sizeof f->lower_block); /* solve_sliver() takes what lies beyond the width as zero */
  fetch_block(f, f->lower, lower);
  if (!symmetric) {
    memset(upper, 0, sizeof f->upper_block);
    fetch_block(f, f->upper, upper);
  }
  for (int64_t j = 0; j < width; ++j) {
    double d = lower[j * MPMI_PANEL + j];
    if (!isfinite(d)) return f->first + j;
    if (!(fabs(d) > f->tiny)) d = MPMI_NO_PIVOT;
    f->pivot[f->first + j] = d;
    f->inverse[j] = 1.0 / d;
    double *l = lower + j * MPMI_PANEL, *u = symmetric ? l : upper + j * MPMI_PANEL;
    for (int64_t r = j + 1; r < width; ++r) scaled[0][r] = l[r] * f->inverse[j];
    take_column(scaled[0], u, j, width, lower);
    if (!symmetric) {
      for (int64_t r = j + 1; r < width; ++r) scaled[1][r] = u[r] * f->inverse[j];
      take_column(scaled[1], l, j, width, upper);
      memcpy(u + j + 1, scaled[1] + j + 1, (size_t)(width - j - 1) * sizeof *u);
    }
    memcpy(l + j + 1, scaled[0] + j + 1, (size_t)(width - j - 1) * sizeof *l);
  }
  store_block(f, lower, f->lower);
  if (!symmetric) store_block(f, upper, f->upper);
  return -1;
}

/* ---- the rows below ------------------------------------------------------------------------------------ */
/* Solves for the columns [j, j + AT_ONCE) of a sliver; those before them are solved for already. triangle:
 * [column][row]. */
MPMI_INLINE void solve_columns(const double *triangle, int64_t j, double *w) {
  mpmi_lanes sum[AT_ONCE][2];
  UNROLL for (int32_t c = 0; c < AT_ONCE; ++c) {
    sum[c][0] = mpmi_lanes_load(w + (j + c) * SLIVER);
    sum[c][1] = mpmi_lanes_load(w + (j + c) * SLIVER + MPMI_LANES);
  }
  for (int64_t k = 0; k < j; ++k) {
    const double *t = triangle + k * MPMI_PANEL + j;
    const mpmi_lanes low = mpmi_lanes_load(w + k * SLIVER),
                     high = mpmi_lanes_load(w + k * SLIVER + MPMI_LANES);
    UNROLL for (int32_t c = 0; c < AT_ONCE; ++c) {
      sum[c][0] -= low * t[c];
      sum[c][1] -= high * t[c];
    }
  }
  UNROLL for (int32_t c = 0; c < AT_ONCE; ++c) {
    for (int32_t k = 0; k < c; ++k) {
      const double t = triangle[(j + k) * MPMI_PANEL + j + c];
      sum[c][0] -= sum[k][0] * t;
      sum[c][1] -= sum[k][1] * t;
    }
    mpmi_lanes_store(w + (j + c) * SLIVER, sum[c][0]);
    mpmi_lanes_store(w + (j + c) * SLIVER + MPMI_LANES, sum[c][1]);
  }
}

/* Divides rows of the panel by a unit triangle, which leaves rows times D. The update finds both side by
 * side, with zeros in place of rows that do not exist. */
MPMI_INLINE void solve_sliver(const mpmi_dense_front *f, double *panel, const double *triangle, span rows,
                              double *scaled, double *times_d) {
  const int64_t ld = f->pivots + f->rows, width = f->width;
  _Alignas(64) double w[ROOM];
  memset(w, 0, sizeof w);
  double *at = panel + f->first * ld + rows.first;
  for (int64_t j = 0; j < width; ++j)
    for (int64_t r = 0; r < rows.count; ++r) w[j * SLIVER + r] = at[j * ld + r];
  for (int64_t j = 0; j < width; j += AT_ONCE) solve_columns(triangle, j, w);
  for (int64_t j = 0; j < width; ++j) {
    for (int32_t r = 0; r < SLIVER; ++r) scaled[j * SLIVER + r] = w[j * SLIVER + r] * f->inverse[j];
    for (int64_t r = 0; r < rows.count; ++r) at[j * ld + r] = scaled[j * SLIVER + r];
    for (int32_t s = 0; s < STRIPS_PER_SLIVER; ++s)
      memcpy(times_d + (s * width + j) * STRIP, w + j * SLIVER + s * STRIP, STRIP * sizeof *w);
  }
}

static void solve_slivers(const mpmi_dense_front *f, int64_t begin, int64_t end) {
  const int32_t symmetric = is_symmetric(f);
  for (int64_t s = begin; s < end; ++s) {
    const span rows = span_of(f, s, SLIVER);
    solve_sliver(f, f->lower, symmetric ? f->lower_block : f->upper_block, rows, area(f, L_ROWS) + s * ROOM,
                 area(f, L_TIMES_D) + s * ROOM);
    if (!symmetric)
      solve_sliver(f, f->upper, f->lower_block, rows, area(f, U_ROWS) + s * ROOM,
                   area(f, U_TIMES_D) + s * ROOM);
  }
}

/* ---- the update of the columns to the right ------------------------------------------------------------ */
/* Subtracts a times b transposed, over k pivots, from to[column][row]. */
MPMI_INLINE void update_tile(const double *a, const double *b, int64_t k, double *to, int64_t ld,
                             int64_t rows, int64_t columns) {
  mpmi_lanes sum[STRIP][2];
  UNROLL for (int32_t c = 0; c < STRIP; ++c) sum[c][0] = sum[c][1] = (mpmi_lanes){0.0};
  for (; k > 0; --k, a += SLIVER, b += STRIP) {
    const mpmi_lanes low = mpmi_lanes_load(a), high = mpmi_lanes_load(a + MPMI_LANES);
    UNROLL for (int32_t c = 0; c < STRIP; ++c) {
      sum[c][0] += low * b[c];
      sum[c][1] += high * b[c];
    }
  }
  if (rows == SLIVER && columns == STRIP) {
    UNROLL for (int32_t c = 0; c < STRIP; ++c) {
      double *at = to + c * ld;
      mpmi_lanes_store(at, mpmi_lanes_load(at) - sum[c][0]);
      mpmi_lanes_store(at + MPMI_LANES, mpmi_lanes_load(at + MPMI_LANES) - sum[c][1]);
    }
    return;
  }
  double spill[STRIP][SLIVER];
  for (int32_t c = 0; c < STRIP; ++c) {
    mpmi_lanes_store(spill[c], sum[c][0]);
    mpmi_lanes_store(spill[c] + MPMI_LANES, sum[c][1]);
  }
  for (int64_t c = 0; c < columns; ++c)
    for (int64_t r = 0; r < rows; ++r) to[c * ld + r] -= spill[c][r];
}

/* Updates one strip of columns: at and below the diagonal, or over all rows of the update matrix. */
static void update_strip(const mpmi_dense_front *f, int64_t strip, const double *rows_of,
                         const double *strips_of, double *panel, int32_t all) {
  const span columns = span_of(f, strip, STRIP);
  const int64_t of_pivots = mpmi_dense_pieces(f->pivots - f->first - f->width, STRIP);
  const int32_t inside = strip < of_pivots;
  const int64_t ld = inside ? f->pivots + f->rows : f->rows, base = inside ? 0 : f->pivots;
  const int64_t in_group = inside ? strip : strip - of_pivots, group = inside ? 0 : f->pivot_slivers;
  const int64_t diagonal = group + in_group / STRIPS_PER_SLIVER;
  double *to = (inside ? panel : f->update) + (columns.first - base) * ld - base;
  const double *b = strips_of + diagonal * ROOM + in_group % STRIPS_PER_SLIVER * STRIP * f->width;
  for (int64_t s = all ? group : diagonal; s < f->slivers; ++s) {
    const span rows = span_of(f, s, SLIVER);
    update_tile(rows_of + s * ROOM, b, f->width, to + rows.first, ld, rows.count, columns.count);
  }
}

static void update_strips(const mpmi_dense_front *f, int64_t begin, int64_t end) {
  const int64_t of_pivots = mpmi_dense_pieces(f->pivots - f->first - f->width, STRIP);
  const double *l = area(f, L_ROWS), *ld = area(f, L_TIMES_D);
  if (is_symmetric(f)) {
    for (int64_t s = begin; s < end; ++s) update_strip(f, s, l, ld, f->lower, 0);
    return;
  }
  const double *u = area(f, U_ROWS), *ud = area(f, U_TIMES_D);
  for (int64_t s = begin; s < end; ++s) {
    update_strip(f, s, l, ud, f->lower, s >= of_pivots);
    if (s < of_pivots) update_strip(f, s, u, ld, f->upper, 0);
  }
}

/* ---- triangular solutions ------------------------------------------------------------------------------ */
static void forward(const double *restrict panel, int64_t pivots, int64_t rows, double *restrict y) {
  const int64_t m = pivots + rows;
  int64_t j = 0;
  for (; j + AT_ONCE <= pivots; j += AT_ONCE) {
    const double *l0 = panel + j * m, *l1 = l0 + m, *l2 = l1 + m, *l3 = l2 + m;
    const double y0 = y[j], y1 = y[j + 1] - l0[j + 1] * y0;
    const double y2 = y[j + 2] - l0[j + 2] * y0 - l1[j + 2] * y1;
    const double y3 = y[j + 3] - l0[j + 3] * y0 - l1[j + 3] * y1 - l2[j + 3] * y2;
    y[j + 1] = y1, y[j + 2] = y2, y[j + 3] = y3;
    MPMI_IVDEP for (int64_t r = j + AT_ONCE; r < m; ++r) y[r] -=
        (l0[r] * y0 + l1[r] * y1) + (l2[r] * y2 + l3[r] * y3);
  }
  for (; j < pivots; ++j) {
    const double *l = panel + j * m, yj = y[j];
    MPMI_IVDEP for (int64_t r = j + 1; r < m; ++r) y[r] -= l[r] * yj;
  }
}

MPMI_INLINE double product(const double *a, const double *b, int64_t begin, int64_t end) {
  mpmi_lanes sum[2] = {{0.0}, {0.0}};
  int64_t i = begin;
  for (; i + SLIVER <= end; i += SLIVER) {
    sum[0] += mpmi_lanes_load(a + i) * mpmi_lanes_load(b + i);
    sum[1] += mpmi_lanes_load(a + i + MPMI_LANES) * mpmi_lanes_load(b + i + MPMI_LANES);
  }
  double rest = 0.0;
  for (; i < end; ++i) rest += a[i] * b[i];
  return mpmi_lanes_sum(sum[0] + sum[1]) + rest;
}

static void backward(const double *panel, int64_t pivots, int64_t rows, double *y) {
  const int64_t m = pivots + rows;
  for (int64_t j = pivots - 1; j >= 0; --j) y[j] -= product(panel + j * m, y, j + 1, m);
}

extern const mpmi_dense KERNEL(dense);
const mpmi_dense KERNEL(dense) = {.sliver = SLIVER,
                                  .strip = STRIP,
                                  .factor_block = factor_block,
                                  .solve_slivers = solve_slivers,
                                  .update_strips = update_strips,
                                  .forward = forward,
                                  .backward = backward};
