/* Isotropic linear elasticity in objective logarithmic increments: stress' = R stress R^T + C : ln V. */
#include "material/objective_tangent.h"

MPMI_INLINE void linear_elastic(int dim, const double *constants, const mpm_material_batch *batch) {
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const mpmi_increments in = mpmi_increments_of(constants, batch);
  double *stress = batch->stress_new;
  if (batch->dt == 0.0) {
    mpmi_keep_rows(mpmi_stress_rows(dim), batch->stress, stress, batch);
  } else {
    MPMI_IVDEP
    for (int64_t i = 0; i < n; ++i) mpmi_store_sym(dim, stress, ld, i, mpmi_trial_stress(dim, in, i));
  }
  mpmi_elastic_outputs(dim, constants, batch);
}

MPMI_LAW_BY_DIM(law_linear_elastic, linear_elastic)

MPMI_INLINE void linear_elastic_tangent(int dim, const double *constants, const mpm_material_batch *batch,
                                        double *tangent) {
  mpmi_objective o;
  memset(o.bend, 0, sizeof o.bend);
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    mpmi_elastic_chunk(dim, constants, batch, i, &o);
    KERNEL(objective_rows)(dim, 0, &o, tangent + i, batch->ld);
  }
}

MPMI_TANGENT_BY_DIM(tangent_linear_elastic, linear_elastic_tangent)
