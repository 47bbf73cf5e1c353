/* Between the material as it is and as it was before it deformed: kernels, and what they do for as many
 * particles as a register holds.
 * Weights of a total Lagrangian grid have gradients G over reference positions; over the present ones they
 * are F^-T G (de Vaucorbeil, Nguyen & Hutchinson 2020, eqs 8 to 14):
 *
 *   dF/dt = sum v (x) G,  L = dF/dt F^-1;  f = -sum V sigma F^-T G = -sum V0 P G */
#ifndef MPMI_PULL_BACK_H
#define MPMI_PULL_BACK_H

#include "material/deformation.h"

/* Inverts the stored components F[c] of the first dim axes. */
MPMI_INLINE void mpmi_inverse_lanes(int32_t dim, const mpmi_lanes *F, mpmi_lanes (*inverse)[3]) {
  if (dim == 1) {
    inverse[0][0] = 1.0 / F[0];
  } else if (dim == 2) {
    const mpmi_lanes by = 1.0 / (F[0] * F[3] - F[1] * F[2]);
    inverse[0][0] = F[3] * by, inverse[0][1] = -F[1] * by;
    inverse[1][0] = -F[2] * by, inverse[1][1] = F[0] * by;
  } else {
    mpmi_lanes cofactor[3][3];
    for (int32_t i = 0; i < 3; ++i)
      for (int32_t j = 0; j < 3; ++j) {
        const int32_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
        cofactor[i][j] = F[3 * a + c] * F[3 * b + d] - F[3 * a + d] * F[3 * b + c];
      }
    const mpmi_lanes by = 1.0 / (F[0] * cofactor[0][0] + F[1] * cofactor[1][0] + F[2] * cofactor[2][0]);
    for (int32_t i = 0; i < 3; ++i)
      for (int32_t j = 0; j < 3; ++j) inverse[i][j] = cofactor[i][j] * by;
  }
}

/* Loads the stored components of n axes from slot s on, and inverts them. */
MPMI_INLINE void mpmi_inverse_load(int32_t dim, const double *const *F, int64_t s, mpmi_lanes (*inverse)[3]) {
  mpmi_lanes stored[9];
  for (int32_t r = 0; r < dim; ++r)
    for (int32_t c = 0; c < dim; ++c)
      stored[mpmi_stored_entry(dim, r, c)] = mpmi_lanes_load(F[mpmi_stored_entry(dim, r, c)] + s);
  mpmi_inverse_lanes(dim, stored, inverse);
}

/* By stored components of F, each at the first particle: the first makes L of a gradient over reference
 * positions, in place. The second turns wave speed c and kinematic viscosity into those with which
 * disturbances cross reference positions, or faster ones: c |F^-1| in a norm that bounds stretches. */
typedef void (*mpmi_spatial_fn)(const double *const *F, int64_t ld, double *L, int64_t n);
typedef void (*mpmi_speeds_fn)(const double *const *F, double *wave_speed, double *viscosity, int64_t n);

typedef struct mpmi_pull_back {
  mpmi_spatial_fn spatial[4]; /* by dim */
  mpmi_speeds_fn speeds[4];
} mpmi_pull_back;

MPMI_DECLARE_TABLES(mpmi_pull_back, mpmi_pull_back);

static inline const mpmi_pull_back *mpmi_pull_back_of(int32_t isa) {
  return MPMI_TABLE_OF(isa, mpmi_pull_back);
}

#endif
