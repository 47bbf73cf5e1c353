#include "linalg/sweep.h"

#include <string.h>

#include "simd/isa.h"

enum { BEFORE = 1, AFTER = 2 };

typedef float quad __attribute__((vector_size(16)));

MPMI_INLINE quad load(const float *at) {
  quad q;
  memcpy(&q, at, sizeof q);
  return q;
}

/* Subtracts the product of entries [begin, end) with x from sum. Each column of the blocks has a sum of
 * its own, so that none waits for another. */
MPMI_INLINE void subtract(const mpmi_smoother *s, int32_t block, int64_t begin, int64_t end, float *sum) {
  const float *value = s->value + begin * block * block;
  quad part[3] = {{0.0F}, {0.0F}, {0.0F}};
  for (int64_t e = begin; e < end; ++e, value += block * block) {
    const float *x = s->x + (int64_t)s->column[e] * MPMI_PADDED(block);
    if (block == 3) /* the fourth lane reads what follows the column */
      for (int32_t c = 0; c < 3; ++c) part[c] += load(value + 3 * c) * (quad){x[c], x[c], x[c], x[c]};
    else if (block == 2) /* one load takes both columns */
      part[e & 1] += load(value) * (quad){x[0], x[0], x[1], x[1]};
    else
      sum[0] -= value[0] * x[0];
  }
  if (block == 1) return;
  const quad all = (part[0] + part[1]) + part[2];
  for (int32_t l = 0; l < MPMI_PADDED(block); ++l) sum[l] -= block == 2 ? all[l] + all[l + 2] : all[l];
}

/* Takes from the right-hand side of each row what the nodes before it, after it or both contribute, and
 * solves for x of the row. With AFTER alone there is no right-hand side, and the difference is stored as
 * the residual. */
MPMI_INLINE void sweep(const mpmi_smoother *s, int32_t block, int32_t with, int64_t begin, int64_t end) {
  const int32_t lanes = MPMI_PADDED(block);
  for (int64_t i = begin; i < end; ++i) {
    float sum[4] = {0.0F, 0.0F, 0.0F, 0.0F}, x[4] = {0.0F, 0.0F, 0.0F, 0.0F};
    for (int32_t l = 0; l < lanes && (with & BEFORE); ++l) sum[l] = s->rhs[i * lanes + l];
    subtract(s, block, with & BEFORE ? s->row_start[i] : s->middle[i],
             with & AFTER ? s->row_start[i + 1] : s->middle[i], sum);
    if (!(with & BEFORE)) {
      for (int32_t l = 0; l < lanes; ++l) s->residual[i * lanes + l] = sum[l];
      continue;
    }
    const float *inverse = s->inverse + i * block * block;
    for (int32_t c = 0; c < block; ++c)
      for (int32_t l = 0; l < block; ++l) x[l] += inverse[c * block + l] * sum[c];
    for (int32_t l = 0; l < lanes; ++l) s->x[i * lanes + l] = x[l];
  }
}

MPMI_INLINE void sweep_of(const mpmi_smoother *s, int32_t with, int64_t begin, int64_t end) {
  if (s->block == 3)
    sweep(s, 3, with, begin, end);
  else if (s->block == 2)
    sweep(s, 2, with, begin, end);
  else
    sweep(s, 1, with, begin, end);
}

static void from_zero(const mpmi_smoother *s, int64_t begin, int64_t end) {
  sweep_of(s, BEFORE, begin, end);
}
static void residual(const mpmi_smoother *s, int64_t begin, int64_t end) {
  sweep_of(s, AFTER, begin, end);
}
static void full(const mpmi_smoother *s, int64_t begin, int64_t end) {
  sweep_of(s, BEFORE | AFTER, begin, end);
}

extern const mpmi_sweeps KERNEL(sweeps);
const mpmi_sweeps KERNEL(sweeps) = {from_zero, residual, full};
