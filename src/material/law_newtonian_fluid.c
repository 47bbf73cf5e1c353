/* Weakly compressible Newtonian fluid:
 *   stress = -p I + 2 eta dev(ln V) / dt, p = K/gamma (J^-gamma - 1), F_inc = V R of the step,
 *   energy per initial volume W with dW/dJ = -p and W(1) = 0.
 * Without tension everything but the viscous stress is that of min(J, 1). */
#include <math.h>

#include "material/objective_tangent.h"

enum { DENSITY, BULK, GAMMA, VISCOSITY, TENSION };
static const mpmi_law_param params[] = {
    [DENSITY] = PARAM_DENSITY,
    [BULK] = {"bulk_modulus", "stress", "bulk modulus at the initial volume", MUST_BE_GIVEN, POSITIVE},
    [GAMMA] = {"gamma", "1", "exponent of the volume: pressure = bulk_modulus / gamma (J^-gamma - 1)", 7.0,
               AT_LEAST_ONE},
    [VISCOSITY] = {"viscosity", "stress*time", "dynamic viscosity", 0.0, NOT_NEGATIVE},
    [TENSION] = {"tension", "1", "1: pressure may be negative; 0: it is cut off at 0", 1.0, ZERO_OR_ONE}};

typedef struct fluid_constants {
  double bulk, bulk_by_gamma;
  double gamma_minus_1; /* never 0 */
  double viscosity, density_inverse;
  double largest_J_minus_1; /* above it there is no pressure: 0 without tension */
} fluid_constants;

static void prepare(const double *value, void *constants) {
  fluid_constants *c = constants;
  const double gamma_minus_1 = value[GAMMA] - 1.0;
  c->bulk = value[BULK];
  c->bulk_by_gamma = value[BULK] / value[GAMMA];
  /* (J^(1 - gamma) - 1) / (gamma - 1) is -ln J to the last digit for one so small */
  c->gamma_minus_1 = gamma_minus_1 > 0.0 ? gamma_minus_1 : 1e-100;
  c->viscosity = value[VISCOSITY];
  c->density_inverse = 1.0 / value[DENSITY];
  c->largest_J_minus_1 = value[TENSION] > 0.0 ? DBL_MAX : 0.0;
}

MPMI_INLINE void compression(int dim, const fluid_constants *c, const mpm_material_batch *batch) {
  const double bulk_by_gamma = c->bulk_by_gamma, exponent = c->gamma_minus_1;
  const double exponent_inverse = 1.0 / exponent, most = c->largest_J_minus_1;
  const double density_inverse = c->density_inverse, viscosity = c->viscosity;
  const double c_squared = c->bulk * density_inverse, nu = viscosity * density_inverse;
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

/* Adds the viscous stress: of the step; or, where the law is asked for the state as it is (dt = 0), the
 * deviator of the old stress, which is the viscous stress of the last step. */
MPMI_INLINE void add_shear(int dim, const fluid_constants *c, const mpm_material_batch *batch) {
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const double dt = batch->dt, factor = dt > 0.0 ? 2.0 * c->viscosity / dt : 1.0;
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

MPMI_INLINE void newtonian_fluid(int dim, const fluid_constants *c, const mpm_material_batch *batch) {
  compression(dim, c, batch);
  if (c->viscosity > 0.0) add_shear(dim, c, batch);
}

/* With t = -J p: c_ijkl = J dt/dJ d_ij d_kl - t (d_ik d_jl + d_il d_jk). Where the pressure is about to be
 * cut off, the tangent is that of compression: a fluid at rest is stiff. */
MPMI_INLINE void compression_tangent(int dim, const fluid_constants *c, const mpm_material_batch *batch,
                                     double *tangent) {
  const double bulk_by_gamma = c->bulk_by_gamma, exponent = c->gamma_minus_1;
  const double most = c->largest_J_minus_1;
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    _Alignas(64) double volumetric[MPMI_CHUNK], shear[MPMI_CHUNK];
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      double h = mpmi_J_minus_1(dim, mpmi_load_F_minus_1(dim, batch->F, batch->ld, i + p));
      double power = mpmi_lane_expm1(-exponent * mpmi_lane_log1p(h)); /* J^(1 - gamma) - 1 */
      volumetric[p] = h > most ? 0.0 : bulk_by_gamma * ((1.0 + h) + exponent * (1.0 + power));
      shear[p] = h > most ? 0.0 : bulk_by_gamma * (power - h);
    }
    KERNEL(isotropic_rows)(dim, volumetric, shear, tangent + i, batch->ld);
  }
}

MPMI_INLINE void shear_chunk(int dim, const fluid_constants *c, const mpm_material_batch *batch,
                             int64_t begin, mpmi_objective *o) {
  const double shear = c->viscosity / batch->dt;
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    double mean_log;
    mpmi_objective_load(dim, o, p, batch, begin + p);
    mpmi_sym v = mpmi_deviator(mpmi_load_sym(dim, o->log_v[0], MPMI_CHUNK, p), &mean_log);
    mpmi_store_sym(dim, o->stress[0], MPMI_CHUNK, p, mpmi_shifted(2.0 * shear, v, 0.0));
    o->bulk[p] = 0.0;
    o->shear[p] = shear;
  }
}

MPMI_INLINE void add_shear_tangent(int dim, const fluid_constants *c, const mpm_material_batch *batch,
                                   double *tangent) {
  mpmi_objective o;
  memset(o.bend, 0, sizeof o.bend);
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    shear_chunk(dim, c, batch, i, &o);
    memset(o.turned, 0, sizeof o.turned); /* the viscous stress does not depend on the old stress */
    KERNEL(objective_rows)(dim, 1, &o, tangent + i, batch->ld);
  }
}

MPMI_INLINE void newtonian_fluid_tangent(int dim, const fluid_constants *c, const mpm_material_batch *batch,
                                         double *tangent) {
  compression_tangent(dim, c, batch, tangent);
  if (c->viscosity > 0.0) add_shear_tangent(dim, c, batch, tangent);
}

MPMI_LAW_KERNELS(fluid_constants, newtonian_fluid, newtonian_fluid_tangent)

static int32_t is_inviscid(const void *constants) {
  const fluid_constants *c = constants;
  return c->viscosity == 0.0;
}

const mpmi_law KERNEL(law_newtonian_fluid) = {
    .name = "newtonian_fluid",
    MPMI_PARAMS(params),
    .stress_from_F = 1,
    .kinematics = MPMI_F_DILATES,
    .constants_size = sizeof(fluid_constants),
    .prepare = prepare,
    .stress = stress_kernel,
    .tangent = tangent_kernel,
    .is_symmetric = is_inviscid,
};
