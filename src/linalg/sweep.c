#include "linalg/sweep.h"

#include <string.h>

#include "simd/isa.h"

typedef float quad __attribute__((vector_size(16)));

MPMI_INLINE quad load(const float *at) {
  quad q;
  memcpy(&q, at, sizeof q);
  return q;
}

/* Returns the product of an unknown's row with x. Sums beside each other do not wait for one another. */
MPMI_INLINE float times_x(const mpmi_smoother *s, int32_t block, int64_t row, const float *value) {
  const int32_t *column = s->column + s->row_start[row];
  const int64_t count = s->row_start[row + 1] - s->row_start[row];
  const float *x = s->x;
  quad part[4] = {{0.0F}, {0.0F}, {0.0F}, {0.0F}};
  float rest = 0.0F;
  int64_t e = 0;
  for (; block == 3 && e + 3 < count; e += 4) /* the fourth lane of an entry is not summed */
    for (int32_t k = 0; k < 4; ++k)
      part[k] += load(value + 3 * (e + k)) * load(x + 4 * (int64_t)column[e + k]);
  for (; block == 2 && e + 3 < count; e += 4)
    for (int32_t k = 0; k < 4; k += 2) {
      const float *a = x + 2 * (int64_t)column[e + k], *b = x + 2 * (int64_t)column[e + k + 1];
      part[k] += load(value + 2 * (e + k)) * (quad){a[0], a[1], b[0], b[1]};
    }
  for (; e < count; ++e)
    for (int32_t c = 0; c < block; ++c)
      rest += value[block * e + c] * x[(int64_t)column[e] * MPMI_PADDED(block) + c];
  const quad all = (part[0] + part[1]) + (part[2] + part[3]);
  return rest + (all[0] + all[1]) + (block == 2 ? all[2] + all[3] : all[2]);
}

/* The first half of the solution waits in `half`: the next row reads x around, and would wait for a store. */
MPMI_INLINE void solve_line(const mpmi_smoother *s, int32_t block, int32_t band, int64_t line) {
  const mpmi_lines *l = &s->lines;
  const int32_t lanes = MPMI_PADDED(block), width = 2 * band + 1;
  const int64_t begin = l->start[line], count = l->start[line + 1] - begin;
  const int32_t *unknown = l->unknown + begin, component = unknown[0] % block;
  const float *value = s->value + s->value_start[line], *factor = s->factor + s->factor_start[line];
  float *half = s->half + begin, last[MPMI_MOST_BAND + 1] = {0.0F}; /* of the places before, or after */
  for (int64_t q = 0; q < count; ++q) {
    const int64_t row = unknown[q] / block, at = row * lanes + component;
    float sum = s->rhs[at] - times_x(s, block, row, value);
    value += block * (s->row_start[row + 1] - s->row_start[row]);
    s->residual[at] = sum;
    for (int32_t k = 0; k < band; ++k) sum -= factor[q * width + k] * last[k];
    for (int32_t k = 0; k + 1 < band; ++k) last[k] = last[k + 1];
    if (band) last[band - 1] = sum;
    half[q] = sum;
  }
  memset(last, 0, sizeof last);
  for (int64_t q = count - 1; q >= 0; --q) {
    const float *from = factor + q * width + band;
    float sum = half[q] * from[0];
    for (int32_t k = band - 1; k >= 0; --k) sum -= from[1 + k] * last[k];
    for (int32_t k = band - 1; k > 0; --k) last[k] = last[k - 1];
    last[0] = sum;
    s->x[unknown[q] / block * lanes + component] = sum;
  }
}

/* The widths that bases have are compiled by themselves. */
MPMI_INLINE void solve_line_of(const mpmi_smoother *s, int32_t block, int64_t line) {
  const int32_t band = s->lines.band[line];
  if (band == 1)
    solve_line(s, block, 1, line);
  else if (band == 2)
    solve_line(s, block, 2, line);
  else if (band == 3)
    solve_line(s, block, 3, line);
  else
    solve_line(s, block, band, line);
}

MPMI_INLINE void residual_of_line(const mpmi_smoother *s, int32_t block, int64_t line) {
  const mpmi_lines *l = &s->lines;
  const float *value = s->value + s->value_start[line];
  for (int64_t q = l->start[line]; q < l->start[line + 1]; ++q) {
    const int64_t row = l->unknown[q] / block;
    const int64_t at = row * MPMI_PADDED(block) + l->unknown[q] % block;
    s->residual[at] = s->rhs[at] - times_x(s, block, row, value) - s->residual[at];
    value += block * (s->row_start[row + 1] - s->row_start[row]);
  }
}

MPMI_INLINE void over_lines(const mpmi_smoother *s, int32_t block, int32_t solves, int64_t begin,
                            int64_t end) {
  for (int64_t line = begin; line < end; ++line)
    if (solves)
      solve_line_of(s, block, line);
    else
      residual_of_line(s, block, line);
}

MPMI_INLINE void sweep_of(const mpmi_smoother *s, int32_t solves, int64_t begin, int64_t end) {
  if (s->block == 3)
    over_lines(s, 3, solves, begin, end);
  else if (s->block == 2)
    over_lines(s, 2, solves, begin, end);
  else
    over_lines(s, 1, solves, begin, end);
}

static void solve(const mpmi_smoother *s, int64_t begin, int64_t end) {
  sweep_of(s, 1, begin, end);
}
static void residual(const mpmi_smoother *s, int64_t begin, int64_t end) {
  sweep_of(s, 0, begin, end);
}

extern const mpmi_sweeps KERNEL(sweeps);
const mpmi_sweeps KERNEL(sweeps) = {solve, residual};
