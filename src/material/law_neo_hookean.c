/* Compressible neo-Hookean law, Steffen et al. 2008, eq. 46:
 *   stress = (lambda ln J / J) I + (mu / J) (F F^T - I),
 *   energy per initial volume W = lambda/2 ln^2 J - mu ln J + mu/2 (tr F F^T - 3). */
#include <math.h>

#include "material/elastic_constants.h"
#include "material/stretch_bounds.h"
#include "material/tangent_rows.h"
#include "simd/vector_math.h"

static const mpmi_law_param params[] = {PARAMS_ELASTIC};

MPMI_INLINE void neo_hookean(int dim, int stored, const mpmi_elastic *c, const mpm_material_batch *batch) {
  const double lambda = c->lambda, mu = c->mu;
  const double density_inverse = c->density_inverse;
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const double *deformation = batch->F;
  double *stress = batch->stress_new, *wave_speed_squared = batch->wave_speed, *energy = batch->energy;
  MPMI_IVDEP
  for (int64_t i = 0; i < n; ++i) {
    /* In terms of H = F - I, so that small strains keep their digits. */
    mpmi_mat h = stored ? mpmi_load_stored_F_minus_1(deformation, ld, i)
                        : mpmi_load_F_minus_1(dim, deformation, ld, i);
    mpmi_sym e = mpmi_left_cauchy_green_minus_1(dim, h);
    double j_minus_1 = mpmi_J_minus_1(dim, h), j_inverse = 1.0 / (1.0 + j_minus_1);
    double log_j = mpmi_lane_log1p(j_minus_1);

    double mu_j = mu * j_inverse, pressure = lambda * log_j * j_inverse;
    mpmi_store_sym(dim, stress, ld, i, mpmi_shifted(mu_j, e, pressure));
    energy[i] = 0.5 * lambda * log_j * log_j + mu * (0.5 * (e.xx + e.yy + e.zz) - log_j);

    /* The acoustic tensor (J c_ijkl n_j n_l + tau_jl n_j n_l delta_ik) / density has the eigenvalues
     * mu b_nn (transverse) and lambda + mu - lambda ln J + mu b_nn (along n), over the initial density. */
    double along = mpmi_max(lambda + mu - lambda * log_j, 0.0) + mu * mpmi_largest_stretch_squared(dim, e);
    wave_speed_squared[i] = mpmi_max(along, mu) * density_inverse;
  }
}

/* c_ijkl = lambda d_ij d_kl + (mu - lambda ln J) (d_ik d_jl + d_il d_jk) */
MPMI_INLINE void neo_hookean_tangent(int dim, const mpmi_elastic *c, const mpm_material_batch *batch,
                                     double *tangent) {
  const double lambda = c->lambda, mu = c->mu;
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    _Alignas(64) double volumetric[MPMI_CHUNK], shear[MPMI_CHUNK];
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      double j_minus_1 = mpmi_J_minus_1(dim, mpmi_load_F_minus_1(dim, batch->F, batch->ld, i + p));
      volumetric[p] = lambda;
      shear[p] = mu - lambda * mpmi_lane_log1p(j_minus_1);
    }
    KERNEL(isotropic_rows)(dim, volumetric, shear, tangent + i, batch->ld);
  }
}

MPMI_LAW_KERNELS_OF_F(mpmi_elastic, neo_hookean, neo_hookean_tangent)

const mpmi_law KERNEL(law_neo_hookean) = {
    .name = "neo_hookean",
    MPMI_PARAMS(params),
    .stress_from_F = 1,
    .constants_size = sizeof(mpmi_elastic),
    .prepare = mpmi_elastic_prepare,
    .stress = stress_kernel,
    .plane_stored = plane_kernel,
    .tangent = tangent_kernel,
    .is_symmetric = mpmi_symmetric,
};
