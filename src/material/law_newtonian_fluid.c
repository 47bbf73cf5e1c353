/* Weakly compressible Newtonian fluid:
 *   stress = -p I + 2 eta dev(ln V) / dt, p = K/gamma (J^-gamma - 1), F_inc = V R of the step,
 *   energy per initial volume W with dW/dJ = -p and W(1) = 0.
 * Without tension everything but the viscous stress is that of min(J, 1). */
#include <math.h>

#include "material/objective_increment.h"

MPMI_INLINE void compression(int dim, const double *constants, const mpm_material_batch *batch) {
  const double bulk_by_gamma = constants[MPMI_C_BULK_BY_GAMMA], exponent = constants[MPMI_C_GAMMA_MINUS_1];
  const double exponent_inverse = 1.0 / exponent, most = constants[MPMI_C_LARGEST_J_MINUS_1];
  const double density_inverse = constants[MPMI_C_DENSITY_INVERSE], viscosity = constants[MPMI_C_VISCOSITY];
  const double c_squared = constants[MPMI_C_BULK] * density_inverse, nu = viscosity * density_inverse;
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const double *deformation = batch->F;
  double *stress = batch->stress_new, *wave_speed = batch->wave_speed, *energy = batch->energy;
  double *kinematic_viscosity = batch->kinematic_viscosity;
  MPMI_IVDEP
  for (int64_t i = 0; i < n; ++i) {
    double j_minus_1 = mpmi_J_minus_1(dim, mpmi_load_F_minus_1(dim, deformation, ld, i));
    double h = mpmi_min(most, j_minus_1);
    /* J^(1 - gamma) - 1, of which p and W are made without a difference of large numbers */
    double power = mpmi_lane_expm1(-exponent * mpmi_lane_log1p(h));
    double mean = bulk_by_gamma * (h - power) / (1.0 + h);
    mpmi_sym s = {mean, mean, mean, 0.0, 0.0, 0.0};
    mpmi_store_sym(dim, stress, ld, i, s);
    energy[i] = bulk_by_gamma * (power * exponent_inverse + h);
    wave_speed[i] = sqrt(c_squared * (1.0 + power));
    kinematic_viscosity[i] = nu * (1.0 + j_minus_1);
  }
}

/* Of the step; or, asked for the state as it is, that which the old stress has. */
MPMI_INLINE void add_shear(int dim, const double *constants, const mpm_material_batch *batch) {
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const double dt = batch->dt, factor = dt > 0.0 ? 2.0 * constants[MPMI_C_VISCOSITY] / dt : 1.0;
  const double *L = batch->L, *old = batch->stress;
  double *stress = batch->stress_new;
  MPMI_IVDEP
  for (int64_t i = 0; i < n; ++i) {
    mpmi_sym s = mpmi_load_sym(dim, stress, ld, i), v = mpmi_load_sym(dim, old, ld, i);
    double mean;
    if (dt > 0.0) v = mpmi_log_increment(dim, mpmi_load_mat(dim, L, ld, i, 0.0, dt), &v);
    v = mpmi_deviator(v, &mean);
    s.xx += factor * v.xx;
    s.yy += factor * v.yy;
    s.zz += factor * v.zz;
    s.xy += factor * v.xy;
    s.yz += factor * v.yz;
    s.xz += factor * v.xz;
    mpmi_store_sym(dim, stress, ld, i, s);
  }
}

MPMI_INLINE void newtonian_fluid(int dim, const double *constants, const mpm_material_batch *batch) {
  compression(dim, constants, batch);
  if (constants[MPMI_C_VISCOSITY] > 0.0) add_shear(dim, constants, batch);
}

MPMI_LAW_BY_DIM(law_newtonian_fluid, newtonian_fluid)
