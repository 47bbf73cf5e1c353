/* This file chooses the kernels for an instruction set, and cuts a front into panels, slivers and strips. */
#include "linalg/dense.h"

#include <mpm/types.h>

MPMI_DECLARE_TABLES(mpmi_dense, mpmi_dense);

const mpmi_dense *mpmi_dense_of(int32_t isa) {
  return MPMI_TABLE_OF(isa, mpmi_dense);
}

int64_t mpmi_dense_scratch(const mpmi_dense *kernels, int64_t pivots, int64_t rows, int32_t symmetric) {
  const int64_t slivers =
      mpmi_dense_pieces(pivots, kernels->sliver) + mpmi_dense_pieces(rows, kernels->sliver);
  return (symmetric ? 2 : 4) * slivers * kernels->sliver * MPMI_PANEL;
}

void mpmi_dense_panel(const mpmi_dense *kernels, mpmi_dense_front *front, int64_t first) {
  const int64_t left = front->pivots - first;
  front->first = first;
  front->width = left < MPMI_PANEL ? left : MPMI_PANEL;
  front->pivot_slivers = mpmi_dense_pieces(left - front->width, kernels->sliver);
  front->slivers = front->pivot_slivers + mpmi_dense_pieces(front->rows, kernels->sliver);
}

int64_t mpmi_dense_strips(const mpmi_dense *kernels, const mpmi_dense_front *front) {
  return mpmi_dense_pieces(front->pivots - front->first - front->width, kernels->strip) +
         mpmi_dense_pieces(front->rows, kernels->strip);
}
