/* Dense granular flow by the mu(I) law (Jop, Forterre, Pouliquen 2006) in the principal frame, in Kirchhoff
 * stresses: the shear stress t = q / sqrt(3) of grains that flow is mu(I) p, with
 *
 *   mu(I) = mu_s + (mu_2 - mu_s) / (1 + I_0 / I),
 *   I = (shear rate of the flow) grain_diameter sqrt(grain_density / p).
 *
 * A step ends there by a quadratic equation (Dunatunga and Kamrin 2015). The volume is elastic: there is
 * no dilatancy and no tension. What has opened is a gap, as in law_drucker_prager.c. */
#include "material/principal_tangent.h"

enum { MU_S = 3, MU_2, I_0, DIAMETER, GRAIN_DENSITY };
static const mpmi_law_param params[] = {
    PARAMS_ELASTIC,
    [MU_S] = {"mu_s", "1", "coefficient of friction at rest", MUST_BE_GIVEN, NOT_NEGATIVE},
    [MU_2] = {"mu_2", "1", "coefficient of friction of fast flow, above mu_s", MUST_BE_GIVEN, POSITIVE},
    [I_0] = {"I_0", "1", "inertial number at which friction is half-way between the two", MUST_BE_GIVEN,
             POSITIVE},
    [DIAMETER] = {"grain_diameter", "length", "diameter of the grains", MUST_BE_GIVEN, POSITIVE},
    [GRAIN_DENSITY] = {"grain_density", "mass/length^3", "density of the grains themselves", MUST_BE_GIVEN,
                       POSITIVE}};

enum { PLASTIC_STRAIN, GAP };
static const mpmi_law_state states[] = {
    [PLASTIC_STRAIN] = {"plastic_strain", "1", "equivalent plastic strain"},
    [GAP] = {"gap", "1", "volume that has opened without stress, as ln J"}};

typedef struct grains_constants {
  mpmi_hencky elastic;
  double mu_s, mu_2;
  double inertia; /* I_0 / (grain_diameter sqrt(grain_density)): shear rate / sqrt(p) at I_0 */
} grains_constants;

static void prepare(const double *value, void *constants) {
  grains_constants *c = constants;
  c->elastic = mpmi_hencky_of(value);
  c->mu_s = value[MU_S];
  c->mu_2 = value[MU_2];
  c->inertia = value[I_0] / (value[DIAMETER] * sqrt(value[GRAIN_DENSITY]));
}

static const char *check(const double *value) {
  return value[MU_2] > value[MU_S] ? NULL : "mu_2 must be larger than mu_s";
}

/* What the law makes of a trial with a volume and the shear stress t: pressure, the share of the deviator
 * that is kept, and the slopes of the shear stress over that of the trial and over p. */
typedef struct grains_return {
  double p, keep, by_shear, by_pressure;
  double plastic, gap;
  double bears; /* 1: the grains touch */
} grains_return;

/* With s0 = mu_s p, s2 = mu_2 p and a = G dt (shear rate at I_0), the shear stress r solves r^2 - B r + H
 * = 0, B = s2 + t + a, H = s2 t + s0 a. The root of B^2 - 4 H = (s2 - t)^2 + a (a + 2 (s2 - s0) + 2 (t -
 * s0)) is taken where t > s0: no term is below 0. */
MPMI_INLINE grains_return come_back(const grains_constants *c, double dt, double volume, double t,
                                    double plastic, double gap) {
  const double bulk = c->elastic.bulk, mu = c->elastic.mu;
  double all = volume + mpmi_max(gap, 0.0), p = mpmi_max(-bulk * all, 0.0);
  grains_return r = {.p = p, .bears = all > 0.0 ? 0.0 : 1.0};
  double s0 = c->mu_s * p, s2 = c->mu_2 * p, a = c->inertia * mu * dt * sqrt(p);
  double over = mpmi_max(t - s0, 0.0), B = s2 + t + a, H = s2 * t + s0 * a;
  double root = sqrt((s2 - t) * (s2 - t) + a * (a + 2.0 * (s2 - s0) + 2.0 * over)) + 1e-300;
  double flow = 2.0 * H / (B + root), yields = over > 0.0 ? r.bears : 0.0;
  double by_p = 0.5 * a / mpmi_max(p, 1e-300); /* da / dp */
  double dB = c->mu_2 + by_p, dH = c->mu_2 * t + c->mu_s * a + s0 * by_p;
  double shear = yields * flow + (1.0 - yields) * r.bears * t;
  r.keep = t > 0.0 ? shear / (t > 0.0 ? t : 1.0) : r.bears;
  r.by_shear = yields * (s2 - flow) / root + (1.0 - yields) * r.bears;
  r.by_pressure = yields * (dH - flow * dB) / root;
  r.plastic = plastic + (t - shear) / (sqrt(3.0) * mu);
  r.gap = mpmi_max(all, 0.0);
  return r;
}

MPMI_INLINE void grains_step(int dim, const grains_constants *constants, const mpm_material_batch *batch) {
  const grains_constants c = *constants;
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const mpmi_frame frame = mpmi_frame_of(&c.elastic, batch);
  const double mu2 = 2.0 * c.elastic.mu, dt = batch->dt, *old = batch->state;
  double *stress = batch->stress_new, *state = batch->state_new;
  for (int64_t begin = 0; begin < n; begin += MPMI_CHUNK) {
    mpmi_trial_rows trial;
    mpmi_find_trials(dim, frame, begin, &trial);
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      const int64_t i = begin + p;
      double mean, inverse = 1.0 / trial.J[p];
      mpmi_sym d = mpmi_deviator(mpmi_load_sym(dim, trial.strain[0], MPMI_CHUNK, p), &mean);
      grains_return r = come_back(&c, dt, 3.0 * mean, mu2 * sqrt(0.5 * mpmi_square(d)), old[i], old[ld + i]);
      mpmi_store_sym(dim, stress, ld, i, mpmi_shifted(mu2 * r.keep * inverse, d, -r.p * inverse));
      state[i] = r.plastic;
      state[ld + i] = r.gap;
    }
  }
}

MPMI_INLINE void mu_i(int dim, const grains_constants *c, const mpm_material_batch *batch) {
  if (!mpmi_keeps_state(dim, 2, batch)) grains_step(dim, c, batch);
  mpmi_frame_outputs(dim, &c->elastic, batch);
}

/* With t = sqrt(2) mu |d| and p = -bulk tr e: the deviator's share along itself changes by by_shear, and
 * by -by_pressure bulk with the volume. */
MPMI_INLINE void grains_chunk(const grains_constants *c, double dt, const double *plastic, const double *gap,
                              mpmi_principal *o) {
  const double mu2 = 2.0 * c->elastic.mu, bulk = c->elastic.bulk;
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    const mpmi_radial trial = mpmi_radial_of(o, p);
    const grains_return r = come_back(c, dt, trial.volume, mu2 * sqrt(0.5) * trial.size, plastic[p], gap[p]);
    mpmi_radial_set(o, p, &trial, -r.p, r.bears * bulk, mu2 * r.keep, mu2 * (r.by_shear - r.keep),
                    -sqrt(2.0) * bulk * r.by_pressure);
  }
}

MPMI_INLINE void mu_i_tangent(int dim, const grains_constants *c, const mpm_material_batch *batch,
                              double *tangent) {
  mpmi_principal o;
  const mpmi_frame frame = mpmi_frame_of(&c->elastic, batch);
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    mpmi_principal_load(dim, &o, frame, i);
    grains_chunk(c, batch->dt, batch->state + i, batch->state + batch->ld + i, &o);
    KERNEL(principal_rows)(dim, &o, tangent + i, batch->ld);
  }
}

MPMI_LAW_KERNELS(grains_constants, mu_i, mu_i_tangent)

const mpmi_law KERNEL(law_mu_i) = {
    .name = "mu_i",
    MPMI_PARAMS(params),
    MPMI_STATES(states),
    .check = check,
    .no_sheets = 1,
    .constants_size = sizeof(grains_constants),
    .prepare = prepare,
    .stress = stress_kernel,
    .tangent = tangent_kernel,
    .is_symmetric = mpmi_unsymmetric,
};
