/* The deformation of a step at one particle of a batch. */
#ifndef MPMU_INCREMENT_H
#define MPMU_INCREMENT_H

#include <mpm/mpm.h>

#include "tensor.h"

/* F = F_inc F_old, and G = F_inc - I, which keeps the digits of small increments. */
typedef struct mpmu_increment {
  mpmu_mat F, F_old, F_inc, G;
} mpmu_increment;

static inline mpmu_increment mpmu_increment_of(const mpm_material_batch *b, int64_t i) {
  mpmu_increment in = {.F = mpmu_load_mat(b->F, b->ld, i), .G = mpmu_load_mat(b->L, b->ld, i)};
  for (int k = 0; k < 9; ++k) {
    in.G.m[k / 3][k % 3] *= b->dt;
    in.F_inc.m[k / 3][k % 3] = in.G.m[k / 3][k % 3] + (k % 4 ? 0.0 : 1.0);
  }
  const mpmu_mat c = mpmu_cofactors(&in.F_inc), transposed = mpmu_transposed(&c);
  const double by = 1.0 / mpmu_determinant(&in.F_inc);
  in.F_old = mpmu_product(&transposed, &in.F);
  for (int k = 0; k < 9; ++k) in.F_old.m[k / 3][k % 3] *= by;
  return in;
}

#endif
