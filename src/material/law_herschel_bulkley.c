/* Herschel-Bulkley fluid, of which Bingham's is n = 1: elastic in shear up to an exact yield stress, beyond
 * which it flows, in Kirchhoff stresses t = J stress:
 *
 *   t = -J p I + 2 G dev(e), |dev t| / sqrt(2) = yield_shear + consistency (shear rate of the flow)^n.
 *
 * The deviator of the stress is the state, and the elastic strain follows from it (principal_frame.h); the
 * pressure is that of the volume alone (tait.h). The return is implicit in time, so that no viscosity
 * bounds the step. */
#include "material/principal_tangent.h"
#include "material/tait.h"
#include "simd/elementary.h"

enum { DENSITY, BULK, GAMMA, SHEAR, YIELD, CONSISTENCY, EXPONENT, TENSION };
static const mpmi_law_param params[] = {
    [DENSITY] = PARAM_DENSITY,
    [BULK] = PARAM_BULK,
    [GAMMA] = PARAM_GAMMA,
    [SHEAR] = {"shear_modulus", "stress", "elastic shear modulus below yield", MUST_BE_GIVEN, POSITIVE},
    [YIELD] = {"yield_shear", "stress", "yield stress in shear", MUST_BE_GIVEN, NOT_NEGATIVE},
    [CONSISTENCY] = {"consistency", "stress*time^n", "stress beyond yield at a shear rate of 1",
                     MUST_BE_GIVEN, NOT_NEGATIVE},
    [EXPONENT] = {"n", "1", "exponent of the shear rate; 1: Bingham", 1.0, 0.1, 2.0, "must be 0.1 to 2", 0},
    [TENSION] = PARAM_TENSION};

typedef struct flow_constants {
  mpmi_tait volume;
  mpmi_hencky elastic; /* of the deviator: strains of the mean stress are left out */
  double bulk;
  double yield, consistency, exponent;
  double log_consistency; /* used where n is not 1 and it is not 0 */
} flow_constants;

static void prepare(const double *value, void *constants) {
  flow_constants *c = constants;
  const double mu = value[SHEAR];
  c->volume = mpmi_tait_of(value[BULK], value[GAMMA], value[TENSION]);
  c->elastic = (mpmi_hencky){.bulk = 0.0,
                             .mu = mu,
                             .density_inverse = 1.0 / value[DENSITY],
                             .by_mean = 0.0,
                             .by_deviator = 1.0 / (2.0 * mu),
                             .p_wave = mpmi_rounded(4.0 / 3.0 * mu)};
  c->bulk = value[BULK];
  c->yield = value[YIELD];
  c->consistency = value[CONSISTENCY];
  c->exponent = value[EXPONENT];
  c->log_consistency = value[CONSISTENCY] > 0.0 ? mpmi_ln(value[CONSISTENCY]) : 0.0;
}

/* 1: the stress beyond yield is a multiple of the shear rate, or nothing. */
MPMI_INLINE int32_t is_linear(const flow_constants *c) {
  return c->exponent == 1.0 || c->consistency == 0.0;
}

/* What flow a step has for a shear stress that is `over` the yield stress in the trial: the share of it that
 * relaxes, y, and the slope of the shear stress that is left over that of the trial. With a = G dt and the
 * shear rate x of the flow, a x + consistency x^n = over, so that y = a x / over solves y + kappa y^n = 1
 * with kappa = consistency over^(n-1) / a^n.
 *
 * In u = ln y this is H(u) = u + ln(1 + kappa exp((n - 1) u)) = 0, where H is convex, grows with a slope
 * between 1 and n, and is at most ln 2 at the start u = min(0, -ln(kappa) / n) above the root. Three steps
 * of Halley's method from there leave y off by 3e-16 for all n from 0.1 to 2 and all kappa from 1e-300 to
 * 1e300. 2 H'^2 > H H'' everywhere on the way: nothing is divided by 0. */
typedef struct flow_share {
  double relaxes, slope;
} flow_share;

/* ln(1 + e^w) with w = ln(kappa) + (n - 1) u, and the shares of y and of kappa y^n in their sum. */
typedef struct flow_point {
  double log_sum, light, heavy;
} flow_point;

MPMI_INLINE flow_point point_of(double n, double log_kappa, double u) {
  double w = log_kappa + (n - 1.0) * u, small = mpmi_lane_exp(-fabs(w)), inverse = 1.0 / (1.0 + small);
  double lesser = small * inverse;
  return (flow_point){mpmi_max(w, 0.0) + mpmi_lane_log1p(small), w > 0.0 ? lesser : inverse,
                      w > 0.0 ? inverse : lesser};
}

MPMI_INLINE flow_share flow_of(int32_t linear, const flow_constants *c, double a, double log_a, double over) {
  if (linear) {
    double relaxes = a / (a + c->consistency);
    return (flow_share){relaxes, 1.0 - relaxes};
  }
  const double n = c->exponent;
  double log_kappa = c->log_consistency + (n - 1.0) * mpmi_lane_log(mpmi_max(over, 1e-300)) - n * log_a;
  double u = mpmi_min(0.0, -log_kappa / n);
  MPMI_UNROLL for (int k = 0; k < 3; ++k) {
    const flow_point at = point_of(n, log_kappa, u);
    double H = u + at.log_sum, slope = at.light + n * at.heavy;
    double bend = (1.0 - n) * (1.0 - n) * at.light * at.heavy;
    u = mpmi_min(0.0, u - 2.0 * H * slope / (2.0 * slope * slope - H * bend));
  }
  const flow_point root = point_of(n, log_kappa, u);
  return (flow_share){mpmi_lane_exp(u), n * root.heavy / (root.light + n * root.heavy)};
}

/* What becomes of a trial deviator with the shear stress `trial`: the share of it that is kept, and the
 * slope of the shear stress over the trial. */
typedef struct flow_return {
  double keep, slope;
} flow_return;

MPMI_INLINE flow_return come_back(int32_t linear, const flow_constants *c, double a, double log_a,
                                  double trial) {
  double over = trial - c->yield, yields = over > 0.0 ? 1.0 : 0.0;
  flow_share flow = flow_of(linear, c, a, log_a, over);
  flow_return r = {1.0 - yields * over * flow.relaxes / (yields * trial + (1.0 - yields)),
                   1.0 - yields * (1.0 - flow.slope)};
  return r;
}

/* Writes the deviator of the stress. */
MPMI_INLINE void flow_step(int dim, int32_t linear, const flow_constants *constants,
                           const mpm_material_batch *batch) {
  const flow_constants c = *constants;
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const mpmi_frame frame = mpmi_frame_of(&c.elastic, batch);
  const double mu = c.elastic.mu, a = mpmi_max(mu * batch->dt, 1e-300), log_a = mpmi_lane_log(a);
  double *stress = batch->stress_new;
  for (int64_t begin = 0; begin < n; begin += MPMI_CHUNK) {
    mpmi_trial_rows trial;
    mpmi_find_trials(dim, frame, begin, &trial);
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      double mean;
      mpmi_sym d = mpmi_deviator(mpmi_load_sym(dim, trial.strain[0], MPMI_CHUNK, p), &mean);
      flow_return r = come_back(linear, &c, a, log_a, mu * sqrt(2.0 * mpmi_square(d)));
      mpmi_store_sym(dim, stress, ld, begin + p, mpmi_shifted(2.0 * mu * r.keep / trial.J[p], d, 0.0));
    }
  }
}

/* Adds the pressure to the deviator in stress_new, and computes speeds and energy. */
MPMI_INLINE void add_pressure(int dim, const flow_constants *constants, const mpm_material_batch *batch) {
  const flow_constants c = *constants;
  const double shear_energy = 0.5 * c.elastic.by_deviator;
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const double *deformation = batch->F;
  double *stress = batch->stress_new, *wave_speed_squared = batch->wave_speed, *energy = batch->energy;
  MPMI_IVDEP
  for (int64_t i = 0; i < n; ++i) {
    double j_minus_1 = mpmi_J_minus_1(dim, mpmi_load_F_minus_1(dim, deformation, ld, i)), J = 1.0 + j_minus_1;
    mpmi_tait_state at = mpmi_tait_at(&c.volume, j_minus_1);
    mpmi_sym s = mpmi_load_sym(dim, stress, ld, i);
    double square = J * J * mpmi_square(s);
    mpmi_store_sym(dim, stress, ld, i, mpmi_shifted(1.0, s, at.mean));
    energy[i] = at.energy + shear_energy * square;
    wave_speed_squared[i] =
        (c.bulk * at.stiffening + c.elastic.p_wave + sqrt((2.0 / 3.0) * square)) * c.elastic.density_inverse;
  }
}

/* dt = 0 asks for the state as it is: the deviator that is stored with the pressure of F. */
MPMI_INLINE void keep_deviator(int dim, const mpm_material_batch *batch) {
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const double *old = batch->stress;
  double *stress = batch->stress_new;
  MPMI_IVDEP
  for (int64_t i = 0; i < n; ++i) {
    double mean;
    mpmi_store_sym(dim, stress, ld, i, mpmi_deviator(mpmi_load_sym(dim, old, ld, i), &mean));
  }
}

MPMI_INLINE void herschel_bulkley(int dim, const flow_constants *c, const mpm_material_batch *batch) {
  if (batch->dt == 0.0)
    keep_deviator(dim, batch);
  else if (is_linear(c))
    flow_step(dim, 1, c, batch);
  else
    flow_step(dim, 0, c, batch);
  add_pressure(dim, c, batch);
}

MPMI_INLINE void flow_chunk(int dim, int32_t linear, const flow_constants *c, const mpm_material_batch *batch,
                            int64_t begin, mpmi_principal *o) {
  const double mu = c->elastic.mu, a = mpmi_max(mu * batch->dt, 1e-300), log_a = mpmi_lane_log(a);
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    const mpmi_radial trial = mpmi_radial_of(o, p);
    const flow_return r = come_back(linear, c, a, log_a, sqrt(2.0) * mu * trial.size);
    double h = mpmi_J_minus_1(dim, mpmi_load_F_minus_1(dim, batch->F, batch->ld, begin + p));
    const mpmi_tait_slope slope = mpmi_tait_slope_at(&c->volume, h);
    mpmi_radial_set(o, p, &trial, -slope.pressure, slope.volumetric, 2.0 * mu * r.keep,
                    2.0 * mu * (r.slope - r.keep), 0.0);
  }
}

MPMI_INLINE void herschel_bulkley_tangent(int dim, const flow_constants *c, const mpm_material_batch *batch,
                                          double *tangent) {
  mpmi_principal o;
  const mpmi_frame frame = mpmi_frame_of(&c->elastic, batch);
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    mpmi_principal_load(dim, &o, frame, i);
    if (is_linear(c))
      flow_chunk(dim, 1, c, batch, i, &o);
    else
      flow_chunk(dim, 0, c, batch, i, &o);
    KERNEL(principal_rows)(dim, &o, tangent + i, batch->ld);
  }
}

MPMI_LAW_KERNELS(flow_constants, herschel_bulkley, herschel_bulkley_tangent)

const mpmi_law KERNEL(law_herschel_bulkley) = {
    .name = "herschel_bulkley",
    MPMI_PARAMS(params),
    .mean_from_F = 1,
    .kinematics = MPMI_F_DILATES,
    .rest = MPMI_REST_PRESSURE,
    .no_sheets = 1,
    .constants_size = sizeof(flow_constants),
    .prepare = prepare,
    .stress = stress_kernel,
    .tangent = tangent_kernel,
    .is_symmetric = mpmi_symmetric,
};
