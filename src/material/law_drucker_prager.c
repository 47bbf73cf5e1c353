/* Drucker-Prager plasticity of soils in the principal frame, in Kirchhoff stresses: with p = -tr(tau) / 3
 * and q = sqrt(3/2) |dev tau| the yield surface is q = M p + k, k = kappa (cohesion + hardening * plastic
 * strain), and the potential q - M_psi p. Beyond the apex or the cut-off of tension the material opens
 * without stress, and what it has opened must close before it bears pressure again (the volume correction
 * of Tampubolon et al. 2017). With psi = cohesion = 0 and cone 0 it is the sand of Klar et al. 2016. */
#include "material/principal_tangent.h"
#include "simd/elementary.h"

enum { PHI = 3, PSI, COHESION, CONE, CUTOFF, HARDENING, RESIDUAL, CLOSE };
enum { COMPRESSION, EXTENSION, PLANE_STRAIN };
#define ANGLE "degrees"
static const mpmi_law_param params[] = {
    PARAMS_ELASTIC,
    [PHI] = {"phi", ANGLE, "angle of friction", MUST_BE_GIVEN, 0.0, 89.0, "must be 0 to 89", 0},
    [PSI] = {"psi", ANGLE, "angle of dilation, at most phi", 0.0, 0.0, 89.0, "must be 0 to 89", 0},
    [COHESION] = {"cohesion", "stress", "cohesion at the start", 0.0, NOT_NEGATIVE},
    [CONE] = {"cone", "1", "fits Mohr-Coulomb in triaxial compression (0), extension (1), plane strain (2)",
              0.0, 0.0, 2.0, "must be 0, 1 or 2", 1},
    [CUTOFF] = {"tension_cutoff", "stress", "largest mean tension; infinity: that of the apex",
                (double)INFINITY, 0.0, (double)INFINITY, "must be >= 0", 0},
    [HARDENING] = {"hardening", "stress", "slope of the cohesion over the plastic shear strain", 0.0,
                   -DBL_MAX, DBL_MAX, "must be finite", 0},
    [RESIDUAL] = {"cohesion_residual", "stress", "least cohesion after softening, at most cohesion", 0.0,
                  NOT_NEGATIVE},
    [CLOSE] = {"close_gaps", "1", "1: what has opened must close before it bears; 0: it bears at once", 1.0,
               ZERO_OR_ONE}};

enum { PLASTIC_STRAIN, GAP };
static const mpmi_law_state states[] = {
    [PLASTIC_STRAIN] = {"plastic_strain", "1", "plastic shear strain, which hardens or softens"},
    [GAP] = {"gap", "1", "volume that has opened without stress, as ln J"}};

typedef struct drucker_constants {
  mpmi_hencky elastic;
  double slope, dilation; /* M, M_psi */
  double strength;        /* kappa, k over the cohesion */
  double cohesion, hardening, residual;
  double cutoff;            /* largest mean tension that is borne, DBL_MAX without a limit */
  double apex, apex_beyond; /* mean tension at the apex: apex * k + apex_beyond */
  double perfect;           /* 3 mu + bulk M M_psi */
  double hard;              /* kappa * hardening */
  double closes;
} drucker_constants;

/* M and kappa of a cone for an angle. */
static void cone_of(double degrees, double cone, double *slope, double *strength) {
  const double angle = degrees * (3.14159265358979323846 / 180.0);
  const double s = mpmi_sin(angle), c = mpmi_cos(angle), t = s / c;
  const double sign = cone == EXTENSION ? 1.0 : -1.0;
  const double root = sqrt(9.0 + mpmi_rounded(12.0 * mpmi_rounded(t * t)));
  const int32_t plane = cone == PLANE_STRAIN;
  *slope = plane ? 3.0 * sqrt(3.0) * t / root : 6.0 * s / (3.0 + sign * s);
  *strength = plane ? 3.0 * sqrt(3.0) / root : 6.0 * c / (3.0 + sign * s);
}

static void prepare(const double *value, void *constants) {
  drucker_constants *c = constants;
  double unused;
  c->elastic = mpmi_hencky_of(value);
  cone_of(value[PHI], value[CONE], &c->slope, &c->strength);
  cone_of(value[PSI], value[CONE], &c->dilation, &unused);
  c->cohesion = value[COHESION];
  c->hardening = value[HARDENING];
  c->residual = value[RESIDUAL];
  c->cutoff = mpmi_min(value[CUTOFF], DBL_MAX);
  c->apex = c->slope > 0.0 ? 1.0 / c->slope : 0.0;
  c->apex_beyond = c->slope > 0.0 ? 0.0 : DBL_MAX;
  c->perfect = mpmi_rounded(3.0 * c->elastic.mu) + mpmi_rounded(c->elastic.bulk * c->slope * c->dilation);
  c->hard = c->strength * c->hardening;
  c->closes = value[CLOSE];
}

static const char *check(const double *value) {
  drucker_constants c;
  prepare(value, &c);
  if (value[PSI] > value[PHI]) return "psi must not be larger than phi";
  if (value[RESIDUAL] > value[COHESION]) return "cohesion_residual must not be larger than cohesion";
  if (!(c.perfect + c.hard > 0.0))
    return "hardening is so negative that stress falls faster than a particle unloads: it must be above -(3 "
           "mu + "
           "K M M_psi) / kappa";
  return NULL;
}

/* What the law makes of a trial state: mean pressure p, and the share of the deviator that it keeps. */
typedef struct drucker_return {
  double p, q, keep, plastic, gap;
  double over;      /* > 0: beyond the yield surface */
  double fit;       /* < 0: a return to the cone would end beyond the cut-off, which decides in its place */
  double stiffness; /* A of a return to the cone */
} drucker_return;

MPMI_INLINE drucker_return come_back(const drucker_constants *c, double volume, double q, double plastic,
                                     double gap) {
  const double bulk = c->elastic.bulk, mu3 = 3.0 * c->elastic.mu, closes = c->closes;
  double all = volume + closes * mpmi_max(gap, 0.0), p = -bulk * all;
  double soft = c->cohesion + c->hardening * plastic;
  double k = c->strength * mpmi_max(soft, c->residual);
  double tension = mpmi_min(c->cutoff, c->apex * k + c->apex_beyond);
  drucker_return r;
  r.over = q - c->slope * p - k;
  /* a return to the cone: its cohesion is that at the end of the step */
  double hard = soft > c->residual ? c->hard : mpmi_max(c->hard, 0.0), step = r.over / (c->perfect + hard);
  double rest = (q - c->slope * p - c->strength * c->residual) / c->perfect;
  double left = soft + c->hardening * step - c->residual;
  step = left < 0.0 ? rest : step;
  r.stiffness = left < 0.0 ? c->perfect : c->perfect + hard;
  double q_cone = r.over > 0.0 ? q - mu3 * step : q;
  double p_cone = r.over > 0.0 ? p + bulk * c->dilation * step : p;
  /* at the apex there is no room for a deviator, to rounding */
  double room = k - c->slope * tension, q_cut = room > 1e-12 * k ? mpmi_min(q, room) : 0.0;
  r.fit = mpmi_min(q_cone + 1e-12 * q, p_cone + tension); /* q_cone = 0 is rounded where phi and k are 0 */
  double flow = r.over > 0.0 ? step : 0.0, opened = closes * mpmi_max(all - tension / bulk, 0.0);
  r.p = r.fit < 0.0 ? -tension : p_cone;
  r.q = r.fit < 0.0 ? q_cut : mpmi_max(q_cone, 0.0);
  double of_none = r.fit < 0.0 ? (room > 1e-12 * k ? 1.0 : 0.0) : 1.0;
  r.keep = q > 0.0 ? r.q / (q > 0.0 ? q : 1.0) : of_none;
  r.plastic = plastic + (r.fit < 0.0 ? (q - q_cut) / mu3 : flow);
  r.gap = r.fit < 0.0 ? opened : 0.0;
  return r;
}

MPMI_INLINE double trace_of(mpmi_sym s) {
  return s.xx + s.yy + s.zz;
}

MPMI_INLINE void drucker_step(int dim, const drucker_constants *constants, const mpm_material_batch *batch) {
  const drucker_constants c = *constants;
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const mpmi_frame frame = mpmi_frame_of(&c.elastic, batch);
  const double mu2 = 2.0 * c.elastic.mu, *old = batch->state;
  double *stress = batch->stress_new, *state = batch->state_new;
  for (int64_t begin = 0; begin < n; begin += MPMI_CHUNK) {
    mpmi_trial_rows trial;
    mpmi_find_trials(dim, frame, begin, &trial);
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      const int64_t i = begin + p;
      double mean, inverse = 1.0 / trial.J[p];
      mpmi_sym e = mpmi_load_sym(dim, trial.strain[0], MPMI_CHUNK, p), d = mpmi_deviator(e, &mean);
      double q = mu2 * sqrt(1.5 * mpmi_square(d));
      drucker_return r = come_back(&c, trace_of(e), q, old[i], old[ld + i]);
      mpmi_store_sym(dim, stress, ld, i, mpmi_shifted(mu2 * r.keep * inverse, d, -r.p * inverse));
      state[i] = r.plastic;
      state[ld + i] = r.gap;
    }
  }
}

MPMI_INLINE void drucker_prager(int dim, const drucker_constants *c, const mpm_material_batch *batch) {
  if (!mpmi_keeps_state(dim, 2, batch)) drucker_step(dim, c, batch);
  mpmi_frame_outputs(dim, &c->elastic, batch);
}

/* a_AB = bulk d_p + shear Dev + n (...): the derivative of come_back() for the trial strains of the axes. */
MPMI_INLINE void slopes(const drucker_constants *c, const drucker_return *r, const double *n, int p,
                        mpmi_principal *o) {
  const int32_t cone = r->over > 0.0 && !(r->fit < 0.0), elastic = !cone && !(r->fit < 0.0);
  const double bulk = c->elastic.bulk, mu = c->elastic.mu, inverse = cone ? 1.0 / r->stiffness : 0.0;
  const double across = sqrt(6.0) * mu * bulk * inverse;
  double volume = elastic ? bulk : cone ? bulk - bulk * bulk * c->dilation * c->slope * inverse : 0.0;
  double shear = 2.0 * mu * r->keep, cut = r->keep < 1.0 ? -shear : 0.0;
  double along = cone ? 2.0 * mu * (1.0 - 3.0 * mu * inverse - r->keep) : elastic ? 0.0 : cut;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      o->slope[a][b][p] = volume + shear * ((a == b) - 1.0 / 3.0) + along * n[a] * n[b] -
                          across * (c->dilation * n[b] + c->slope * n[a]);
}

MPMI_INLINE void drucker_chunk(const drucker_constants *c, const double *plastic, const double *gap,
                               mpmi_principal *o) {
  const double mu2 = 2.0 * c->elastic.mu;
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    double volume = o->strain[0][p] + o->strain[1][p] + o->strain[2][p], d[3], square = 0.0;
    for (int a = 0; a < 3; ++a) d[a] = o->strain[a][p] - (1.0 / 3.0) * volume, square += d[a] * d[a];
    double size = sqrt(square), unit = size > 0.0 ? 1.0 / size : 0.0;
    drucker_return r = come_back(c, volume, mu2 * sqrt(1.5 * square), plastic[p], gap[p]);
    for (int a = 0; a < 3; ++a) o->tau[a][p] = mu2 * r.keep * d[a] - r.p, d[a] *= unit;
    slopes(c, &r, d, p, o);
  }
}

MPMI_INLINE void drucker_prager_tangent(int dim, const drucker_constants *c, const mpm_material_batch *batch,
                                        double *tangent) {
  mpmi_principal o;
  const mpmi_frame frame = mpmi_frame_of(&c->elastic, batch);
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    mpmi_principal_load(dim, &o, frame, i);
    drucker_chunk(c, batch->state + i, batch->state + batch->ld + i, &o);
    KERNEL(principal_rows)(dim, &o, tangent + i, batch->ld);
  }
}

MPMI_LAW_KERNELS(drucker_constants, drucker_prager, drucker_prager_tangent)

static int32_t is_associated(const void *constants) {
  const drucker_constants *c = constants;
  return c->slope == c->dilation;
}

const mpmi_law KERNEL(law_drucker_prager) = {
    .name = "drucker_prager",
    MPMI_PARAMS(params),
    MPMI_STATES(states),
    .pressure_from_shear = 1,
    .check = check,
    .constants_size = sizeof(drucker_constants),
    .prepare = prepare,
    .stress = stress_kernel,
    .tangent = tangent_kernel,
    .is_symmetric = is_associated,
};
