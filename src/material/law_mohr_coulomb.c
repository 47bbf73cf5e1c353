/* Mohr-Coulomb plasticity in the principal frame, with exact edges and apex, in Kirchhoff stresses. With the
 * principal values t1 >= t2 >= t3 the planes are
 *
 *   f_ij = (1 + sin phi) t_i - (1 - sin phi) t_j - 2 c cos phi,  (i, j) = (1, 3), (2, 3), (1, 2),
 *
 * potentials have psi in the place of phi, and c = cohesion + hardening * (2 cos phi times all
 * multipliers). A return ends on the plane (1, 3), on the edge t1 = t2 or t2 = t3, or at the apex; each is
 * a linear equation. The apex, cut-off and gaps are those of law_drucker_prager.c. */
#include "material/principal_tangent.h"
#include "simd/elementary.h"

enum { PHI = 3, PSI, COHESION, CUTOFF, HARDENING, RESIDUAL, CLOSE };
static const mpmi_law_param params[] = {
    PARAMS_ELASTIC,
    [PHI] = {"phi", "degrees", "angle of friction; 0: Tresca", MUST_BE_GIVEN, 0.0, 89.0, "must be 0 to 89",
             0},
    [PSI] = {"psi", "degrees", "angle of dilation, at most phi", 0.0, 0.0, 89.0, "must be 0 to 89", 0},
    [COHESION] = {"cohesion", "stress", "cohesion at the start", 0.0, NOT_NEGATIVE},
    [CUTOFF] = {"tension_cutoff", "stress", "largest mean tension; infinity: that of the apex",
                (double)INFINITY, 0.0, (double)INFINITY, "must be >= 0", 0},
    [HARDENING] = {"hardening", "stress", "slope of the cohesion over the plastic strain", 0.0, -DBL_MAX,
                   DBL_MAX, "must be finite", 0},
    [RESIDUAL] = {"cohesion_residual", "stress", "least cohesion after softening, at most cohesion", 0.0,
                  NOT_NEGATIVE},
    [CLOSE] = {"close_gaps", "1", "1: what has opened must close before it bears; 0: it bears at once", 1.0,
               ZERO_OR_ONE}};

enum { PLASTIC_STRAIN, GAP };
static const mpmi_law_state states[] = {
    [PLASTIC_STRAIN] = {"plastic_strain", "1",
                        "2 cos(phi) times the sum of multipliers, which hardens or softens"},
    [GAP] = {"gap", "1", "volume that has opened without stress, as ln J"}};

/* Where a return may end: a plane, or an edge, whose two planes are added up. */
enum { PLANE, EDGE_12, EDGE_23, PLACES }; /* EDGE_12: t1 = t2 */
typedef struct mohr_place {
  double by[3];   /* f = by . t, for all planes together */
  double flow[3]; /* 2 mu times the deviator of the potentials' gradient, averaged over the planes */
  double planes;  /* how many there are */
  double shear;   /* by . flow */
} mohr_place;

typedef struct mohr_constants {
  mpmi_hencky elastic;
  mohr_place place[PLACES];
  double lift, dilation; /* 2 sin phi, 2 sin psi */
  double bond;           /* 2 cos phi */
  double cohesion, hardening, residual;
  double cutoff;            /* largest mean tension that is borne, DBL_MAX without a limit */
  double apex, apex_beyond; /* mean tension at the apex: apex * c + apex_beyond */
  double by_volume;         /* plastic strain for the volume that opens at the apex; 0 where psi is 0 */
  double closes;
} mohr_constants;

static double radians(double degrees) {
  return degrees * (3.14159265358979323846 / 180.0);
}

/* Adds a plane to a place that has `planes` of them in the end. */
static void add_plane(mohr_place *at, int i, int j, double s, double s_psi, double mu, double planes) {
  double gradient[3] = {0.0};
  gradient[i] = 1.0 + s_psi;
  gradient[j] = -(1.0 - s_psi);
  at->by[i] += 1.0 + s;
  at->by[j] -= 1.0 - s;
  for (int k = 0; k < 3; ++k)
    at->flow[k] += 2.0 * mu * (gradient[k] - mpmi_rounded(2.0 / 3.0 * s_psi)) / planes;
  at->planes = planes;
}

static void prepare(const double *value, void *constants) {
  mohr_constants *c = constants;
  const double s = mpmi_sin(radians(value[PHI])), s_psi = mpmi_sin(radians(value[PSI]));
  const double cosine = mpmi_cos(radians(value[PHI])), zero = 0.0 * s;
  const mohr_place none = {{zero, zero, zero}, {zero, zero, zero}, zero, zero};
  c->elastic = mpmi_hencky_of(value);
  for (int k = 0; k < PLACES; ++k) {
    mohr_place *at = &c->place[k];
    const double mu = c->elastic.mu, planes = k == PLANE ? 1.0 : 2.0;
    *at = none;
    add_plane(at, 0, 2, s, s_psi, mu, planes);
    if (k == EDGE_12) add_plane(at, 1, 2, s, s_psi, mu, planes);
    if (k == EDGE_23) add_plane(at, 0, 1, s, s_psi, mu, planes);
    for (int i = 0; i < 3; ++i) at->shear += mpmi_rounded(at->by[i] * at->flow[i]);
  }
  c->lift = 2.0 * s;
  c->dilation = 2.0 * s_psi;
  c->bond = 2.0 * cosine;
  c->cohesion = value[COHESION];
  c->hardening = value[HARDENING];
  c->residual = value[RESIDUAL];
  c->cutoff = mpmi_min(value[CUTOFF], DBL_MAX);
  c->apex = s > 0.0 ? cosine / s : 0.0;
  c->apex_beyond = s > 0.0 ? 0.0 : DBL_MAX;
  c->by_volume = s_psi > 0.0 ? cosine / s_psi : 0.0;
  c->closes = value[CLOSE];
}

/* How fast the planes of a place fall with the multipliers, without hardening. */
MPMI_INLINE double stiffness_of(const mohr_constants *c, const mohr_place *at, double bulk) {
  return at->shear + at->planes * (bulk * c->lift * c->dilation);
}

static const char *check(const double *value) {
  mohr_constants c;
  prepare(value, &c);
  if (value[PSI] > value[PHI]) return "psi must not be larger than phi";
  if (value[RESIDUAL] > value[COHESION]) return "cohesion_residual must not be larger than cohesion";
  for (int k = 0; k < PLACES; ++k)
    if (!(stiffness_of(&c, &c.place[k], c.elastic.bulk) + c.place[k].planes * c.bond * c.bond * c.hardening >
          0.0))
      return "hardening is so negative that stress falls faster than a particle unloads: 4 cos^2(phi) "
             "hardening "
             "must be above -4 (mu (1 + sin(phi) sin(psi)) + lambda sin(phi) sin(psi))";
  return NULL;
}

/* A trial state, or one that has come back: mean stress, deviator in descending order, cohesion. */
typedef struct mohr_state {
  double mean, s[3];
  double soft, hard; /* cohesion before it is held at its residual; its slope */
} mohr_state;

typedef struct mohr_return {
  mohr_state to;
  double step;      /* sum of multipliers */
  double stiffness; /* with hardening */
  double order;     /* >= 0: the principal values have kept their order */
} mohr_return;

MPMI_INLINE mohr_return come_back_to(const mohr_constants *c, int place, double bulk, mohr_state from) {
  const mohr_place *at = &c->place[place];
  mohr_return r;
  double on = at->by[0] * from.s[0] + at->by[1] * from.s[1] + at->by[2] * from.s[2] +
              at->planes * c->lift * from.mean;
  double perfect = stiffness_of(c, at, bulk), slope = at->planes * c->bond * c->bond * from.hard;
  double over = on - at->planes * c->bond * mpmi_max(from.soft, c->residual);
  double step = over / (perfect + slope), left = from.soft + from.hard * c->bond * step - c->residual;
  /* with the cohesion at its residual */
  double rest = (on - at->planes * c->bond * c->residual) / perfect;
  r.step = left < 0.0 ? rest : step;
  r.stiffness = left < 0.0 ? perfect : perfect + slope;
  r.to = from;
  double first = from.s[0], middle = from.s[1], last = from.s[2];
  first = place == EDGE_12 ? 0.5 * (from.s[0] + from.s[1]) : first;
  last = place == EDGE_23 ? 0.5 * (from.s[1] + from.s[2]) : last;
  middle = place == EDGE_12 ? first : place == EDGE_23 ? last : middle;
  r.to.s[0] = first - r.step * at->flow[0];
  r.to.s[1] = middle - r.step * at->flow[1];
  r.to.s[2] = last - r.step * at->flow[2];
  r.to.mean = from.mean - bulk * c->dilation * r.step;
  r.order = mpmi_min(r.to.s[0] - r.to.s[1], r.to.s[1] - r.to.s[2]);
  return r;
}

/* Choices are weights of 0 or 1, so that lanes need no branches: which * a + (1 - which) * b. */
MPMI_INLINE double either(double which, double a, double b) {
  return which * a + (1.0 - which) * b;
}

/* Which place a return has taken, as weights, and what it has given. */
typedef struct mohr_fit {
  double weight[PLACES];
  double step, inverse_stiffness, order;
  mohr_state to;
} mohr_fit;

MPMI_INLINE mohr_fit fit(const mohr_constants *c, double bulk, mohr_state from) {
  const mohr_return plane = come_back_to(c, PLANE, bulk, from), on_12 = come_back_to(c, EDGE_12, bulk, from);
  const mohr_return on_23 = come_back_to(c, EDGE_23, bulk, from);
  mohr_fit r;
  double yields = plane.step > 0.0 ? 1.0 : 0.0, on_plane = plane.order >= 0.0 ? 1.0 : 0.0;
  double at_12 = plane.to.s[0] < plane.to.s[1] ? 1.0 : 0.0, on_edge = yields * (1.0 - on_plane);
  r.weight[PLANE] = yields * on_plane;
  r.weight[EDGE_12] = on_edge * at_12;
  r.weight[EDGE_23] = on_edge * (1.0 - at_12);
#define PICK(member)                                                                                         \
  (r.weight[PLANE] * plane.member + r.weight[EDGE_12] * on_12.member + r.weight[EDGE_23] * on_23.member)
  r.to = from;
  r.to.mean = (1.0 - yields) * from.mean + PICK(to.mean);
  MPMI_UNROLL for (int k = 0; k < 3; ++k) r.to.s[k] = (1.0 - yields) * from.s[k] + PICK(to.s[k]);
  r.step = PICK(step);
  r.inverse_stiffness = yields / ((1.0 - yields) + PICK(stiffness));
#undef PICK
  r.order = r.to.s[0] - r.to.s[2];
  return r;
}

/* The apex: how much plastic strain goes with what opens there, and the mean tension that it bears then. The
 * volume that opens hardens, or without dilation the deviator that vanishes. */
typedef struct mohr_tip {
  double flow, tension, slope; /* slope: d tension / d (mean stress of the trial) */
} mohr_tip;

MPMI_INLINE mohr_tip tip_of(const mohr_constants *c, mohr_state trial, double mean, double plastic) {
  const double bulk = c->elastic.bulk;
  double dilates = c->by_volume > 0.0 ? 1.0 : 0.0;
  double stiffness = dilates * bulk / (c->by_volume + (1.0 - dilates)) + trial.hard * c->apex;
  double firm = stiffness > 0.0 ? 1.0 : 0.0;
  double open = (mean - c->apex * mpmi_max(trial.soft, c->residual)) / (firm * stiffness + (1.0 - firm));
  double hardens = firm * (trial.soft + trial.hard * open < c->residual ? 0.0 : 1.0);
  /* an apex that hardens stops at the cut-off */
  double rises = mpmi_max(trial.hard, 0.0) * c->apex, rising = rises > 0.0 ? 1.0 : 0.0;
  double room = rising * (c->cutoff - c->apex * trial.soft) / (rises + (1.0 - rising));
  double most = either(rising, room, DBL_MAX), free = open < most ? 1.0 : 0.0;
  double to_residual = c->by_volume * (mean - c->apex * c->residual) / bulk;
  double vanished = c->bond * mpmi_max(trial.s[0], -trial.s[2]) / (2.0 * c->elastic.mu);
  mohr_tip r;
  r.flow = mpmi_max(either(dilates, either(hardens, mpmi_min(open, most), to_residual), vanished), 0.0);
  double soft = mpmi_max(c->cohesion + c->hardening * (plastic + dilates * r.flow), c->residual);
  r.tension = mpmi_min(c->cutoff, c->apex * soft + c->apex_beyond);
  r.slope = dilates * hardens * free *
            (r.flow > 0.0 ? trial.hard * c->apex / (firm * stiffness + (1.0 - firm)) : 0.0);
  return r;
}

/* What the law makes of a trial state whose axes are in descending order. */
typedef struct mohr_result {
  mohr_fit fit;
  double bulk,
      shear;  /* stiffness of the mean stress and of the deviator in the trial, 0 where there is none */
  double tip; /* d mean / d (mean stress of the trial), at the apex */
  double plastic, gap;
} mohr_result;

MPMI_INLINE mohr_result come_back(const mohr_constants *c, const double *e, double plastic, double gap) {
  const double bulk = c->elastic.bulk, mu2 = 2.0 * c->elastic.mu;
  double volume = e[0] + e[1] + e[2], all = volume + c->closes * mpmi_max(gap, 0.0);
  mohr_state trial = {.mean = bulk * all, .soft = c->cohesion + c->hardening * plastic};
  double held = mpmi_max(trial.soft, c->residual);
  trial.hard = trial.soft > c->residual ? c->hardening : mpmi_max(c->hardening, 0.0);
  MPMI_UNROLL for (int k = 0; k < 3; ++k) trial.s[k] = mu2 * (e[k] - (1.0 / 3.0) * volume);
  const mohr_fit on = fit(c, bulk, trial);
  double ordered = on.order + 1e-12 * (trial.s[0] - trial.s[2]);
  double opens = mpmi_min(ordered, c->cutoff - on.to.mean) < 0.0 ? 1.0 : 0.0;

  /* beyond the cut-off of tension the mean stress is held there, and the deviator comes back alone */
  mohr_state cut = trial;
  cut.mean = mpmi_min(c->cutoff, c->apex * held + c->apex_beyond);
  cut.soft = held;
  cut.hard = 0.0;
  const mohr_fit below = fit(c, 0.0, cut);
  const mohr_tip tip = tip_of(c, trial, bulk * volume, plastic);
  double room = c->bond * held - c->lift * cut.mean, below_tip = room > 1e-12 * c->bond * held ? 1.0 : 0.0;
  double tension = either(below_tip, cut.mean, tip.tension);

  mohr_result r = {.bulk = (1.0 - opens) * bulk, .shear = either(opens, below_tip, 1.0) * mu2};
  r.fit.to.mean = opens > 0.0 ? tension : on.to.mean; /* what is not taken may be as large as doubles go */
  MPMI_UNROLL for (int k = 0; k < 3; ++k) {
    r.fit.to.s[k] = either(opens, below_tip * below.to.s[k], on.to.s[k]);
    r.fit.weight[k] = either(opens, below_tip * below.weight[k], on.weight[k]);
  }
  r.fit.inverse_stiffness = either(opens, below_tip * below.inverse_stiffness, on.inverse_stiffness);
  r.tip = opens * (1.0 - below_tip) * tip.slope;
  double flow = either(opens, either(below_tip, c->bond * below.step, tip.flow), c->bond * on.step);
  r.plastic = plastic + flow;
  r.gap = opens * c->closes * mpmi_max(all - tension / bulk, 0.0);
  return r;
}

/* Puts three numbers into descending order, and remembers which have changed places. */
typedef struct mohr_order {
  double first, second, third;
} mohr_order;

MPMI_INLINE void exchange(double which, double *a, double *b) {
  double x = *a, y = *b;
  *a = either(which, y, x);
  *b = either(which, x, y);
}

MPMI_INLINE mohr_order sort(double *e) {
  mohr_order o;
  o.first = e[0] < e[1] ? 1.0 : 0.0;
  exchange(o.first, &e[0], &e[1]);
  o.second = e[1] < e[2] ? 1.0 : 0.0;
  exchange(o.second, &e[1], &e[2]);
  o.third = e[0] < e[1] ? 1.0 : 0.0;
  exchange(o.third, &e[0], &e[1]);
  return o;
}

MPMI_INLINE void undo(mohr_order o, double *a, double *b, double *c) {
  exchange(o.third, a, b);
  exchange(o.second, b, c);
  exchange(o.first, a, b);
}

MPMI_INLINE void mohr_chunk(const mohr_constants *c, const double *plastic, const double *gap,
                            double *plastic_new, double *gap_new, mpmi_principal *o) {
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    double e[3] = {o->strain[0][p], o->strain[1][p], o->strain[2][p]}, tau[3];
    const mohr_order order = sort(e);
    const mohr_result r = come_back(c, e, plastic[p], gap[p]);
    MPMI_UNROLL for (int a = 0; a < 3; ++a) tau[a] = r.fit.to.mean + r.fit.to.s[a];
    undo(order, &tau[0], &tau[1], &tau[2]);
    MPMI_UNROLL for (int a = 0; a < 3; ++a) o->tau[a][p] = tau[a];
    plastic_new[p] = r.plastic;
    gap_new[p] = r.gap;
  }
}

MPMI_INLINE void mohr_coulomb(int dim, const mohr_constants *constants, const mpm_material_batch *batch) {
  const mohr_constants c = *constants;
  const int64_t ld = batch->ld;
  if (!mpmi_keeps_state(dim, 2, batch)) {
    const mpmi_frame frame = mpmi_frame_of(&c.elastic, batch);
    mpmi_principal o;
    for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
      mpmi_principal_load(dim, &o, frame, i);
      mohr_chunk(&c, batch->state + i, batch->state + ld + i, batch->state_new + i, batch->state_new + ld + i,
                 &o);
      mpmi_principal_stress(dim, &o, batch->stress_new + i, ld);
    }
  }
  mpmi_frame_outputs(dim, &c.elastic, batch);
}

/* a_AB in descending order: the derivative of come_back() for the trial strains. */
MPMI_INLINE void slopes(const mohr_constants *c, const mohr_result *r, double (*a)[3]) {
  double by[3] = {0.0}, flow[3] = {0.0}, planes = 0.0, of_step[3];
  MPMI_UNROLL for (int k = 0; k < PLACES; ++k) {
    MPMI_UNROLL for (int i = 0; i < 3; ++i) by[i] += r->fit.weight[k] * c->place[k].by[i];
    MPMI_UNROLL for (int i = 0; i < 3; ++i) flow[i] += r->fit.weight[k] * c->place[k].flow[i];
    planes += r->fit.weight[k] * c->place[k].planes;
  }
  double mean = (1.0 / 3.0) * (by[0] + by[1] + by[2]), lifted = planes * c->lift * r->bulk;
  MPMI_UNROLL for (int i = 0; i < 3; ++i) of_step[i] =
      (r->shear * (by[i] - mean) + lifted) * r->fit.inverse_stiffness;
  double half_12 = 0.5 * r->fit.weight[EDGE_12], half_23 = 0.5 * r->fit.weight[EDGE_23];
  const double kept[3][3] = {{1.0 - half_12, half_12, 0.0},
                             {half_12, 1.0 - half_12 - half_23, half_23},
                             {0.0, half_23, 1.0 - half_23}};
  MPMI_UNROLL for (int i = 0; i < 3; ++i) MPMI_UNROLL for (int j = 0; j < 3; ++j) a[i][j] =
      r->shear * (kept[i][j] - 1.0 / 3.0) + r->bulk * (1.0 - c->dilation * of_step[j]) -
      flow[i] * of_step[j] + r->tip * c->elastic.bulk;
}

MPMI_INLINE void mohr_coulomb_tangent(int dim, const mohr_constants *c, const mpm_material_batch *batch,
                                      double *tangent) {
  const int64_t ld = batch->ld;
  const mpmi_frame frame = mpmi_frame_of(&c->elastic, batch);
  mpmi_principal o;
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    mpmi_principal_load(dim, &o, frame, i);
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      double e[3] = {o.strain[0][p], o.strain[1][p], o.strain[2][p]}, a[3][3], tau[3];
      const mohr_order order = sort(e);
      const mohr_result r = come_back(c, e, batch->state[i + p], batch->state[ld + i + p]);
      slopes(c, &r, a);
      MPMI_UNROLL for (int k = 0; k < 3; ++k) tau[k] = r.fit.to.mean + r.fit.to.s[k];
      undo(order, &tau[0], &tau[1], &tau[2]);
      MPMI_UNROLL for (int k = 0; k < 3; ++k) undo(order, &a[0][k], &a[1][k], &a[2][k]);
      MPMI_UNROLL for (int k = 0; k < 3; ++k) undo(order, &a[k][0], &a[k][1], &a[k][2]);
      MPMI_UNROLL for (int k = 0; k < 3; ++k) {
        o.tau[k][p] = tau[k];
        for (int l = 0; l < 3; ++l) o.slope[k][l][p] = a[k][l];
      }
    }
    KERNEL(principal_rows)(dim, &o, tangent + i, ld);
  }
}

MPMI_LAW_KERNELS(mohr_constants, mohr_coulomb, mohr_coulomb_tangent)

static int32_t is_associated(const void *constants) {
  const mohr_constants *c = constants;
  return c->lift == c->dilation;
}

const mpmi_law KERNEL(law_mohr_coulomb) = {
    .name = "mohr_coulomb",
    MPMI_PARAMS(params),
    MPMI_STATES(states),
    .pressure_from_shear = 1,
    .check = check,
    .constants_size = sizeof(mohr_constants),
    .prepare = prepare,
    .stress = stress_kernel,
    .tangent = tangent_kernel,
    .is_symmetric = is_associated,
};
