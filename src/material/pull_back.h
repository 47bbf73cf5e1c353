/* Between the material as it is and as it was before it deformed: kernels, and what they do for as many
 * particles as a register holds.
 * Weights of a total Lagrangian grid have gradients G over reference positions; over the present ones they
 * are F^-T G (de Vaucorbeil, Nguyen & Hutchinson 2020, eqs 8 to 14):
 *
 *   dF/dt = sum v (x) G,  L = dF/dt F^-1;  f = -sum V sigma F^-T G = -sum V0 P G */
#ifndef MPMI_PULL_BACK_H
#define MPMI_PULL_BACK_H

#include "material/deformation.h"

/* Makes the adjugate, J F^-1, of the stored components F[c] of the first dim axes; returns J. */
MPMI_INLINE mpmi_lanes mpmi_adjugate_lanes(int32_t dim, const mpmi_lanes *F, mpmi_lanes (*adjugate)[3]) {
  const mpmi_lanes zero = {0.0};
  if (dim == 1) {
    adjugate[0][0] = zero + 1.0;
    return F[0];
  }
  if (dim == 2) {
    adjugate[0][0] = F[3], adjugate[0][1] = -F[1];
    adjugate[1][0] = -F[2], adjugate[1][1] = F[0];
    return F[0] * F[3] - F[1] * F[2];
  }
  for (int32_t i = 0; i < 3; ++i)
    for (int32_t j = 0; j < 3; ++j) {
      const int32_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      adjugate[i][j] = F[3 * a + c] * F[3 * b + d] - F[3 * a + d] * F[3 * b + c];
    }
  return F[0] * adjugate[0][0] + F[1] * adjugate[1][0] + F[2] * adjugate[2][0];
}

/* Loads the stored components of n axes from slot s on and makes the adjugate; returns J. */
MPMI_INLINE mpmi_lanes mpmi_adjugate_load(int32_t dim, const double *const *F, int64_t s,
                                          mpmi_lanes (*adjugate)[3]) {
  mpmi_lanes stored[9];
  for (int32_t r = 0; r < dim; ++r)
    for (int32_t c = 0; c < dim; ++c)
      stored[mpmi_stored_entry(dim, r, c)] = mpmi_lanes_load(F[mpmi_stored_entry(dim, r, c)] + s);
  return mpmi_adjugate_lanes(dim, stored, adjugate);
}

/* Does that and inverts them. */
MPMI_INLINE void mpmi_inverse_load(int32_t dim, const double *const *F, int64_t s, mpmi_lanes (*inverse)[3]) {
  const mpmi_lanes by = 1.0 / mpmi_adjugate_load(dim, F, s, inverse);
  for (int32_t i = 0; i < dim; ++i)
    for (int32_t j = 0; j < dim; ++j) inverse[i][j] *= by;
}

/* By stored components of F, each at the first particle: the first makes L of a gradient over reference
 * positions, in place. The second turns wave speeds c, or their squares, and kinematic viscosities, unless
 * there are none, into those with which disturbances cross reference positions, or faster ones: c |F^-1| in
 * a norm that bounds stretches. */
typedef void (*mpmi_spatial_fn)(const double *const *F, int64_t ld, double *L, int64_t n);
typedef void (*mpmi_speeds_fn)(const double *const *F, int32_t squared, double *wave_speed, double *viscosity,
                               int64_t n);

typedef struct mpmi_pull_back {
  mpmi_spatial_fn spatial[4]; /* by dim */
  mpmi_speeds_fn speeds[4];
} mpmi_pull_back;

MPMI_DECLARE_TABLES(mpmi_pull_back, mpmi_pull_back);

static inline const mpmi_pull_back *mpmi_pull_back_of(int32_t isa) {
  return MPMI_TABLE_OF(isa, mpmi_pull_back);
}

#endif
