/* Neo-Hookean law with volume and shape apart, Guilkey & Weiss 2003, eq. 20:
 *   J stress = kappa ln J I + mu dev(b_bar), b_bar = J^(-2/3) F F^T,
 *   energy per initial volume W = kappa/2 ln^2 J + mu/2 (tr b_bar - 3). */
#include <math.h>

#include "material/law_file.h"
#include "material/stretch_bounds.h"
#include "material/tangent_rows.h"
#include "simd/vector_math.h"

enum { MU, KAPPA, DENSITY };
static const mpmi_law_param params[] = {
    [MU] = {"mu", "stress", "shear modulus", MUST_BE_GIVEN, POSITIVE},
    [KAPPA] = {"kappa", "stress", "bulk modulus", MUST_BE_GIVEN, POSITIVE},
    [DENSITY] = PARAM_DENSITY};

typedef struct decoupled_constants {
  double mu, kappa, density_inverse;
} decoupled_constants;

static void prepare(const double *value, void *constants) {
  decoupled_constants *c = constants;
  c->mu = value[MU];
  c->kappa = value[KAPPA];
  c->density_inverse = 1.0 / value[DENSITY];
}

/* The acoustic tensor for a direction n, times J, has in the frame of n the entries
 *   kappa (1 - ln J) + 5/3 mean - 1/3 b_nn along n, b_nn across it, and -2/3 |t| between n and t,
 * where b is mu b_bar, mean = tr(b) / 3 and t what b n has across n: at most half the spread of b. Its
 * largest eigenvalue grows with each of them. */
MPMI_INLINE double stiffest(double volumetric, double mean, double low, double high) {
  double along = mpmi_max(volumetric, 0.0) + (5.0 / 3.0) * mean - (1.0 / 3.0) * low;
  double between = (1.0 / 3.0) * (high - low), half = 0.5 * (along - high);
  return 0.5 * (along + high) + sqrt(half * half + between * between);
}

MPMI_INLINE void neo_hookean_decoupled(int dim, int stored, const decoupled_constants *c,
                                       const mpm_material_batch *batch) {
  const double kappa = c->kappa, mu = c->mu;
  const double density_inverse = c->density_inverse;
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const double *deformation = batch->F;
  double *stress = batch->stress_new, *wave_speed_squared = batch->wave_speed, *energy = batch->energy;
  MPMI_IVDEP
  for (int64_t i = 0; i < n; ++i) {
    /* In terms of H = F - I and e = F F^T - I, so that small strains keep their digits. */
    mpmi_mat h = stored ? mpmi_load_stored_F_minus_1(deformation, ld, i)
                        : mpmi_load_F_minus_1(dim, deformation, ld, i);
    mpmi_sym e = mpmi_left_cauchy_green_minus_1(dim, h);
    double j_minus_1 = mpmi_J_minus_1(dim, h), j_inverse = 1.0 / (1.0 + j_minus_1);
    double log_j = mpmi_lane_log1p(j_minus_1);
    double shape_minus_1 = mpmi_lane_expm1((-2.0 / 3.0) * log_j), trace = e.xx + e.yy + e.zz;
    double mu_bar = mu + mu * shape_minus_1; /* mu J^(-2/3) */

    double mu_j = mu_bar * j_inverse;
    double isotropic = kappa * log_j * j_inverse - (1.0 / 3.0) * mu_j * trace;
    mpmi_store_sym(dim, stress, ld, i, mpmi_shifted(mu_j, e, isotropic));
    energy[i] = 0.5 * kappa * log_j * log_j + 0.5 * (mu_bar * trace + 3.0 * mu * shape_minus_1);

    double stiffness = stiffest(kappa - kappa * log_j, mu_bar * (1.0 + (1.0 / 3.0) * trace),
                                mu_bar * mpmi_smallest_stretch_squared(dim, e),
                                mu_bar * mpmi_largest_stretch_squared(dim, e));
    wave_speed_squared[i] = stiffness * density_inverse;
  }
}

/* With s = mu dev(b_bar) and m = mu tr(b_bar) / 3,
 *   c_ijkl = (kappa - 2/3 m) d_ij d_kl + (m - kappa ln J) (d_ik d_jl + d_il d_jk) - 2/3 (s_ij d_kl + d_ij
 * s_kl). */
MPMI_INLINE void neo_hookean_decoupled_tangent(int dim, const decoupled_constants *c,
                                               const mpm_material_batch *batch, double *tangent) {
  const double kappa = c->kappa, mu = c->mu;
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    _Alignas(64) double volumetric[MPMI_CHUNK], shear[MPMI_CHUNK], mixed[6][MPMI_CHUNK];
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      mpmi_mat h = mpmi_load_F_minus_1(dim, batch->F, batch->ld, i + p);
      mpmi_sym e = mpmi_left_cauchy_green_minus_1(dim, h);
      double log_j = mpmi_lane_log1p(mpmi_J_minus_1(dim, h)), third = (1.0 / 3.0) * (e.xx + e.yy + e.zz);
      double mu_bar = mu + mu * mpmi_lane_expm1((-2.0 / 3.0) * log_j), f = (-2.0 / 3.0) * mu_bar;
      mpmi_sym s = {f * (e.xx - third), f * (e.yy - third), f * (e.zz - third), f * e.xy, f * e.yz, f * e.xz};
      mpmi_store_sym(dim, mixed[0], MPMI_CHUNK, p, s);
      volumetric[p] = kappa + f * (1.0 + third);
      shear[p] = mu_bar * (1.0 + third) - kappa * log_j;
    }
    KERNEL(isotropic_rows)(dim, volumetric, shear, tangent + i, batch->ld);
    KERNEL(add_mixed_rows)(dim, (const double(*)[MPMI_CHUNK])mixed, tangent + i, batch->ld);
  }
}

MPMI_LAW_KERNELS_OF_F(decoupled_constants, neo_hookean_decoupled, neo_hookean_decoupled_tangent)

const mpmi_law KERNEL(law_neo_hookean_decoupled) = {
    .name = "neo_hookean_decoupled",
    MPMI_PARAMS(params),
    .stress_from_F = 1,
    .constants_size = sizeof(decoupled_constants),
    .prepare = prepare,
    .stress = stress_kernel,
    .plane_stored = plane_kernel,
    .tangent = tangent_kernel,
    .is_symmetric = mpmi_symmetric,
};
