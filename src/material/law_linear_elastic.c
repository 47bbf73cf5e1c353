/* Isotropic linear elasticity in objective logarithmic increments: stress' = R stress R^T + C : ln V. */
#include "material/objective_tangent.h"

static const mpmi_law_param params[] = {PARAMS_ELASTIC};

MPMI_INLINE void linear_elastic(int dim, const mpmi_elastic *c, const mpm_material_batch *batch) {
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const mpmi_increments in = mpmi_increments_of(batch);
  const double lambda = c->lambda, mu = c->mu;
  double *stress = batch->stress_new;
  const int64_t moving = mpmi_keeps_state(dim, 0, batch) ? 0 : n;
  for (int64_t begin = 0; begin < moving; begin += MPMI_CHUNK) {
    mpmi_increment_rows of;
    mpmi_find_increments(dim, in, begin, &of);
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p)
      mpmi_store_sym(dim, stress, ld, begin + p, mpmi_trial_stress(dim, lambda, mu, &of, p));
  }
  mpmi_elastic_outputs(dim, c, batch);
}

MPMI_INLINE void linear_elastic_tangent(int dim, const mpmi_elastic *c, const mpm_material_batch *batch,
                                        double *tangent) {
  mpmi_objective o;
  memset(o.bend, 0, sizeof o.bend);
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    mpmi_elastic_chunk(dim, c, batch, i, &o);
    KERNEL(objective_rows)(dim, 0, &o, tangent + i, batch->ld);
  }
}

MPMI_LAW_KERNELS(mpmi_elastic, linear_elastic, linear_elastic_tangent)

const mpmi_law KERNEL(law_linear_elastic) = {
    .name = "linear_elastic",
    MPMI_PARAMS(params),
    .energy_of_stress = 1,
    .constants_size = sizeof(mpmi_elastic),
    .prepare = mpmi_elastic_prepare,
    .stress = stress_kernel,
    .tangent = tangent_kernel,
    .is_symmetric = mpmi_unsymmetric,
};
