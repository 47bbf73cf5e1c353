/* Weakly compressible Newtonian fluid:
 *   stress = -p I + 2 eta dev(ln V) / dt, p = K/gamma (J^-gamma - 1), F_inc = V R of the step,
 *   energy per initial volume W with dW/dJ = -p and W(1) = 0.
 * Without tension everything but the viscous stress is that of min(J, 1). */
#include "material/objective_tangent.h"
#include "material/tait.h"

enum { DENSITY, BULK, GAMMA, VISCOSITY, TENSION };
static const mpmi_law_param params[] = {
    [DENSITY] = PARAM_DENSITY,
    [BULK] = PARAM_BULK,
    [GAMMA] = PARAM_GAMMA,
    [VISCOSITY] = {"viscosity", "stress*time", "dynamic viscosity", 0.0, NOT_NEGATIVE},
    [TENSION] = PARAM_TENSION};

typedef struct fluid_constants {
  mpmi_tait volume;
  double bulk, viscosity, density_inverse;
} fluid_constants;

static void prepare(const double *value, void *constants) {
  fluid_constants *c = constants;
  c->volume = mpmi_tait_of(value[BULK], value[GAMMA], value[TENSION]);
  c->bulk = value[BULK];
  c->viscosity = value[VISCOSITY];
  c->density_inverse = 1.0 / value[DENSITY];
}

MPMI_INLINE void compression(int dim, const fluid_constants *c, const mpm_material_batch *batch) {
  const mpmi_tait volume = c->volume;
  const double density_inverse = c->density_inverse, nu = c->viscosity * density_inverse;
  const double c_squared = c->bulk * density_inverse;
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const double *deformation = batch->F;
  double *stress = batch->stress_new, *wave_speed_squared = batch->wave_speed, *energy = batch->energy;
  double *kinematic_viscosity = batch->kinematic_viscosity;
  MPMI_IVDEP
  for (int64_t i = 0; i < n; ++i) {
    double j_minus_1 = mpmi_J_minus_1(dim, mpmi_load_F_minus_1(dim, deformation, ld, i));
    mpmi_tait_state at = mpmi_tait_at(&volume, j_minus_1);
    mpmi_sym s = {at.mean, at.mean, at.mean, 0.0, 0.0, 0.0};
    mpmi_store_sym(dim, stress, ld, i, s);
    energy[i] = at.energy;
    wave_speed_squared[i] = c_squared * at.stiffening;
    kinematic_viscosity[i] = nu * (1.0 + j_minus_1);
  }
}

MPMI_INLINE void add_deviator(int dim, double factor, mpmi_sym of, double *stress, int64_t ld, int64_t i) {
  double mean;
  mpmi_sym s = mpmi_load_sym(dim, stress, ld, i), v = mpmi_deviator(of, &mean);
  s.xx += factor * v.xx;
  s.yy += factor * v.yy;
  s.zz += factor * v.zz;
  s.xy += factor * v.xy;
  s.yz += factor * v.yz;
  s.xz += factor * v.xz;
  mpmi_store_sym(dim, stress, ld, i, s);
}

/* The viscous stress does not depend on the old one. */
MPMI_INLINE mpmi_increments strain_increments(const mpm_material_batch *batch) {
  mpmi_increments in = mpmi_increments_of(batch);
  in.turns = 0;
  return in;
}

/* Adds the viscous stress of the step. */
MPMI_INLINE void add_shear(int dim, const fluid_constants *c, const mpm_material_batch *batch) {
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const double factor = 2.0 * c->viscosity / batch->dt;
  const mpmi_increments in = strain_increments(batch);
  double *stress = batch->stress_new;
  for (int64_t begin = 0; begin < n; begin += MPMI_CHUNK) {
    mpmi_increment_rows of;
    mpmi_find_increments(dim, in, begin, &of);
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p)
      add_deviator(dim, factor, mpmi_load_sym(dim, of.log_v[0], MPMI_CHUNK, p), stress, ld, begin + p);
  }
}

/* Adds that of the step before, which is the deviator of the old stress: dt = 0 asks about the state as it
 * is. */
MPMI_INLINE void add_old_shear(int dim, const mpm_material_batch *batch) {
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const double *old = batch->stress;
  double *stress = batch->stress_new;
  MPMI_IVDEP
  for (int64_t i = 0; i < n; ++i) add_deviator(dim, 1.0, mpmi_load_sym(dim, old, ld, i), stress, ld, i);
}

MPMI_INLINE void newtonian_fluid(int dim, const fluid_constants *c, const mpm_material_batch *batch) {
  compression(dim, c, batch);
  if (!(c->viscosity > 0.0)) return;
  if (batch->dt > 0.0)
    add_shear(dim, c, batch);
  else
    add_old_shear(dim, batch);
}

/* With t = -J p: c_ijkl = J dt/dJ d_ij d_kl - t (d_ik d_jl + d_il d_jk). */
MPMI_INLINE void compression_tangent(int dim, const fluid_constants *c, const mpm_material_batch *batch,
                                     double *tangent) {
  const mpmi_tait volume = c->volume;
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    _Alignas(64) double volumetric[MPMI_CHUNK], shear[MPMI_CHUNK];
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      double h = mpmi_J_minus_1(dim, mpmi_load_F_minus_1(dim, batch->F, batch->ld, i + p));
      mpmi_tait_slope slope = mpmi_tait_slope_at(&volume, h);
      volumetric[p] = slope.volumetric;
      shear[p] = slope.pressure;
    }
    KERNEL(isotropic_rows)(dim, volumetric, shear, tangent + i, batch->ld);
  }
}

MPMI_INLINE void shear_chunk(int dim, const fluid_constants *c, const mpm_material_batch *batch,
                             int64_t begin, mpmi_objective *o) {
  const double shear = c->viscosity / batch->dt;
  mpmi_objective_load(dim, o, batch, strain_increments(batch), begin);
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    double mean_log;
    mpmi_sym v = mpmi_deviator(mpmi_load_sym(dim, o->of.log_v[0], MPMI_CHUNK, p), &mean_log);
    mpmi_store_sym(dim, o->stress[0], MPMI_CHUNK, p, mpmi_shifted(2.0 * shear, v, 0.0));
    o->bulk[p] = 0.0;
    o->shear[p] = shear;
  }
}

MPMI_INLINE void add_shear_tangent(int dim, const fluid_constants *c, const mpm_material_batch *batch,
                                   double *tangent) {
  mpmi_objective o;
  memset(o.bend, 0, sizeof o.bend);
  memset(o.of.turned, 0, sizeof o.of.turned);
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    shear_chunk(dim, c, batch, i, &o);
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
    .viscous = 1,
    .kinematics = MPMI_F_DILATES,
    .rest = MPMI_REST_PRESSURE,
    .no_sheets = 1,
    .constants_size = sizeof(fluid_constants),
    .prepare = prepare,
    .stress = stress_kernel,
    .tangent = tangent_kernel,
    .is_symmetric = is_inviscid,
};
