/* Solutions with the factor go down the fronts with L, and up again with D and L transposed, or U. */
#include <string.h>

#include "linalg/factor.h"

static void down(const mpmi_factor *f, const mpmi_front *front, double *w) {
  double *y = f->y + front->first;
  const int32_t *row = f->row + front->row;
  memcpy(w, y, (size_t)front->pivots * sizeof *w);
  memset(w + front->pivots, 0, (size_t)front->rows * sizeof *w);
  f->kernels->forward(f->lower + front->panel, front->pivots, front->rows, w);
  for (int32_t p = 0; p < front->pivots; ++p) y[p] = w[p];
  for (int32_t r = 0; r < front->rows; ++r) f->y[row[r]] += w[front->pivots + r];
}

static void up(const mpmi_factor *f, const mpmi_front *front, double *w) {
  double *y = f->y + front->first;
  const int32_t *row = f->row + front->row;
  for (int32_t p = 0; p < front->pivots; ++p) w[p] = y[p] / f->pivot[front->first + p];
  for (int32_t r = 0; r < front->rows; ++r) w[front->pivots + r] = f->y[row[r]];
  f->kernels->backward((f->symmetric ? f->lower : f->upper) + front->panel, front->pivots, front->rows, w);
  memcpy(y, w, (size_t)front->pivots * sizeof *w);
}

void mpmi_factor_solve(mpmi_factor *f, const mpmi_matrix *A, const double *b, double *x) {
  double *w = f->y + f->unknowns;
  int32_t component[3];
  for (int32_t at = 0; at < f->nodes; ++at) {
    const int32_t count = mpmi_free_components(A, f->order[at], component);
    const int64_t u = f->start[at], from = (int64_t)f->order[at] * A->block;
    for (int32_t k = 0; k < count; ++k) f->y[u + k] = b[from + component[k]] * f->scale[u + k];
  }
  for (int32_t i = 0; i < f->fronts; ++i) down(f, &f->front[i], w);
  for (int32_t i = f->fronts - 1; i >= 0; --i) up(f, &f->front[i], w);
  memset(x, 0, (size_t)mpmi_matrix_unknowns(A) * sizeof *x);
  for (int32_t at = 0; at < f->nodes; ++at) {
    const int32_t count = mpmi_free_components(A, f->order[at], component);
    const int64_t u = f->start[at], to = (int64_t)f->order[at] * A->block;
    for (int32_t k = 0; k < count; ++k) x[to + component[k]] = f->y[u + k] * f->scale[u + k];
  }
}
