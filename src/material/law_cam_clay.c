/* Modified Cam-clay at finite strain in the principal frame, in Kirchhoff stresses, with the elasticity of
 * Borja and Tamagnini (1998). With p = -tr(tau) / 3, q = sqrt(3/2) |dev tau|, the elastic compression v =
 * -tr(e), the elastic shear strain e_s = sqrt(2/3) |dev e| and X = p_ref exp(v / kappa):
 *
 *   energy  kappa X + 3/2 (mu0 + alpha X) e_s^2,
 *   p = X (1 + 3 alpha e_s^2 / (2 kappa)),  q = 3 (mu0 + alpha X) e_s,
 *   yield   q^2 / M^2 + p (p - pc) = 0, which is the potential too,
 *   pc = pc_old exp((v_trial - v) / (lambda - kappa)).
 *
 * The return is Newton's method for v, e_s and the multiplier; where that fails and alpha = 0, an equation
 * for v alone that has a bracket. v does not fall below the value where X = p_min: what the material opens
 * beyond that is the gap, and must close before pressure rises again. */
#include "material/principal_tangent.h"

enum { DENSITY, KAPPA, LAMBDA, SLOPE, MU, ALPHA, P_REF, PC_START, P_MIN };
static const mpmi_law_param params[] = {
    [DENSITY] = PARAM_DENSITY,
    [KAPPA] = {"kappa", "1", "slope of ln J over ln p on unloading, below lambda", MUST_BE_GIVEN, DBL_MIN,
               1.0, "must be above 0 and below lambda", 0},
    [LAMBDA] = {"lambda", "1", "slope of ln J over ln p on the normal compression line", MUST_BE_GIVEN,
                DBL_MIN, 1.0 - DBL_EPSILON / 2.0, "must be above 0 and below 1", 0},
    [SLOPE] = {"M", "1", "slope of the critical state line, q = M p", MUST_BE_GIVEN, DBL_MIN,
               3.0 - 2.0 * DBL_EPSILON, "must be above 0 and below 3", 0},
    [MU] = {"mu0", "stress", "shear modulus at no pressure", MUST_BE_GIVEN, NOT_NEGATIVE},
    [ALPHA] = {"alpha", "1", "what the shear modulus gains by pressure", 0.0, NOT_NEGATIVE},
    [P_REF] = {"p_ref", "stress", "pressure where the elastic compression is 0", MUST_BE_GIVEN, POSITIVE},
    [PC_START] = {"pc0", "stress",
                  "preconsolidation pressure of new particles; 0: the host sets the state pc", 0.0,
                  NOT_NEGATIVE},
    [P_MIN] = {"p_min", "stress", "least pressure, at most pc/2; 0: 1e-3 pc0, or 1e-3 pc without a pc0", 0.0,
               NOT_NEGATIVE}};

enum { PC, GAP };
static const mpmi_law_state states[] = {
    [PC] = {"pc", "stress", "preconsolidation pressure, per initial volume"},
    [GAP] = {"gap", "1", "volume that has opened without stress, as ln J"}};

enum { NO_STRESS, NO_PC, UNBEARABLE, NOT_RETURNED, TOO_SHEARED };
static const mpmi_law_refusal refusals[] = {
    [NO_STRESS] = {MPM_E_STATE, "cam_clay needs an initial stress: the mean pressure must be above 0"},
    [NO_PC] = {MPM_E_STATE,
               "cam_clay needs a preconsolidation pressure: the state pc or the parameter pc0 must be "
               "above 0"},
    [UNBEARABLE] = {MPM_E_STATE,
                    "cam_clay bears no such shear stress elastically: mu0 or alpha must be larger"},
    [NOT_RETURNED] = {MPM_CUT_DT, "cam_clay has not come back to its yield surface"},
    [TOO_SHEARED] = {MPM_CUT_DT,
                     "cam_clay is sheared beyond the range of its elasticity, alpha e_s^2 <= 2/3 kappa,"}};

enum { MOST_INVERSE = 12, MOST_UNCOUPLED = 12, MOST_COUPLED = 30, MOST_SCALAR = 100 };

typedef struct clay_constants {
  double density_inverse;
  double kappa, kappa_inverse;
  double harden;  /* 1 / (lambda - kappa) */
  double flatten; /* 1 / M^2 */
  double mu, alpha, p_ref, pc;
  double couples;            /* 3 alpha / (2 kappa) */
  double reach;              /* e_s where the energy ceases to be convex at any mu0; DBL_MAX without alpha */
  double least, least_share; /* p_min: least + least_share * pc */
} clay_constants;

static void prepare(const double *value, void *constants) {
  clay_constants *c = constants;
  c->density_inverse = 1.0 / value[DENSITY];
  c->kappa = value[KAPPA];
  c->kappa_inverse = 1.0 / value[KAPPA];
  c->harden = 1.0 / mpmi_max(value[LAMBDA] - value[KAPPA], DBL_MIN);
  c->flatten = 1.0 / (value[SLOPE] * value[SLOPE]);
  c->mu = value[MU];
  c->alpha = value[ALPHA];
  c->p_ref = value[P_REF];
  c->pc = value[PC_START];
  c->couples = 1.5 * value[ALPHA] / value[KAPPA];
  c->reach = c->couples > 0.0 ? mpmi_min(sqrt(1.0 / c->couples), DBL_MAX) : DBL_MAX;
  c->least = value[P_MIN] > 0.0 ? value[P_MIN] : 1e-3 * value[PC_START];
  c->least_share = c->least > 0.0 ? 0.0 : 1e-3;
}

static const char *check(const double *value) {
  if (!(value[KAPPA] < value[LAMBDA])) return "kappa must be smaller than lambda";
  if (!(value[MU] + value[ALPHA] > 0.0)) return "mu0 and alpha must not both be 0";
  if (value[PC_START] > 0.0 && value[P_MIN] > 0.5 * value[PC_START])
    return "p_min must not be larger than pc0 / 2";
  return NULL;
}

static void start(const double *value, double *state) {
  state[PC] = value[PC_START];
  state[GAP] = 0.0;
}

/* ---- elasticity ---------------------------------------------------------------------------------------- */
/* The stress of elastic strains, and its derivatives: dp / dv, dp / de_s = dq / dv, dq / de_s. */
typedef struct clay_stress {
  double p, q, bulk, mixed, shear;
} clay_stress;

MPMI_INLINE clay_stress stress_of(const clay_constants *c, double v, double e_s) {
  double X = c->p_ref * mpmi_lane_exp(v * c->kappa_inverse), shear = 3.0 * (c->mu + c->alpha * X);
  double p = X * (1.0 + c->couples * (e_s * e_s));
  clay_stress s = {p, shear * e_s, p * c->kappa_inverse, 2.0 * c->couples * (X * e_s), shear};
  return s;
}

/* p and q of a chunk, X, and whether the elasticity bears them (1): as far as 3 alpha e_s^2 / (2 kappa) <=
 * 1 each stress has one strain, whose X is the largest solution. */
typedef struct clay_inverse {
  _Alignas(64) double p[MPMI_CHUNK], q[MPMI_CHUNK], X[MPMI_CHUNK], bears[MPMI_CHUNK];
} clay_inverse;

/* Solves X + alpha q^2 X / (6 kappa (mu0 + alpha X)^2) = p from X = p by Newton's method. */
MPMI_INLINE void invert(const clay_constants *c, clay_inverse *o) {
  for (int p = 0; p < MPMI_CHUNK; ++p) o->X[p] = o->p[p], o->bears[p] = 1.0;
  for (int step = 0; c->alpha > 0.0 && step < MOST_INVERSE; ++step) {
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      double X = o->X[p], mu = 1.0 / (c->mu + c->alpha * X), e_s = (1.0 / 3.0) * o->q[p] * mu;
      double z = c->couples * (e_s * e_s), off = X * (1.0 + z) - o->p[p];
      double slope = 1.0 + z * (c->mu - c->alpha * X) * mu;
      o->bears[p] = mpmi_min(1.0 - z, 1e-12 * o->p[p] - fabs(off)) > 0.0 ? 1.0 : 0.0;
      o->X[p] = X - off / slope;
    }
  }
}

/* ---- the return of a chunk ----------------------------------------------------------------------------- */
typedef struct clay {
  _Alignas(64) double v_trial[MPMI_CHUNK], e_trial[MPMI_CHUNK]; /* elastic strains; v where the gap is full */
  double pc[MPMI_CHUNK];                                        /* before the step */
  double gap[MPMI_CHUNK], pc_new[MPMI_CHUNK];
  double has[MPMI_CHUNK];              /* 0: stress or pc are missing */
  double v[MPMI_CHUNK], e[MPMI_CHUNK]; /* returned */
  double flow[MPMI_CHUNK];             /* multiplier of the potential's gradient, times pc */
  double yields[MPMI_CHUNK];           /* 1: the trial is beyond the yield surface */
  double left[MPMI_CHUNK];             /* 1: the return has not got there */
} clay;

/* The residuals of v, e_s and yield, in units of pc, and the derivatives that they have:
 *   v - v_trial + flow along = 0,  e_s - e_trial + flow across = 0,  f / pc^2 = 0. */
typedef struct clay_system {
  clay_stress s;
  double along, across; /* of the potential's gradient */
  double off_v, off_e, f;
  double size;                    /* of what f is the sum of */
  double vv, ve, ev, ee, inverse; /* of the first two by v and e_s, and 1 / their determinant */
  double f_v, f_e;
  double hard; /* harden pc_new / pc */
} clay_system;

MPMI_INLINE clay_system system_of(const clay_constants *c, const clay *o, int p) {
  clay_system y;
  double v = o->v[p], e = o->e[p], flow = o->flow[p], unit = 1.0 / o->pc[p];
  double grown = mpmi_lane_exp((o->v_trial[p] - v) * c->harden);
  y.s = stress_of(c, v, e);
  double pressure = y.s.p * unit, q = y.s.q * unit, bulk = y.s.bulk * unit, mixed = y.s.mixed * unit;
  double shear = y.s.shear * unit;
  y.hard = c->harden * grown;
  y.along = 2.0 * pressure - grown;
  y.across = 2.0 * c->flatten * q;
  y.off_v = (v - o->v_trial[p]) + flow * y.along;
  y.off_e = (e - o->e_trial[p]) + flow * y.across;
  y.f = 0.5 * y.across * q + pressure * (pressure - grown);
  y.size = 0.5 * y.across * q + pressure * (pressure + grown);
  y.vv = 1.0 + flow * (2.0 * bulk + y.hard);
  y.ve = flow * (2.0 * mixed);
  y.ev = flow * (2.0 * c->flatten * mixed);
  y.ee = 1.0 + flow * (2.0 * c->flatten * shear);
  y.inverse = 1.0 / (y.vv * y.ee - y.ve * y.ev);
  y.f_v = y.along * bulk + y.across * mixed + pressure * y.hard;
  y.f_e = y.along * mixed + y.across * shear;
  return y;
}

/* Solves for what v, e_s and flow change by, for right-hand sides of the three equations. */
typedef struct clay_change {
  double v, e, flow;
} clay_change;

MPMI_INLINE clay_change solve(const clay_system *y, double v, double e, double f) {
  double by_v = (y->ee * v - y->ve * e) * y->inverse, by_e = (y->vv * e - y->ev * v) * y->inverse;
  double of_v = (y->ee * y->along - y->ve * y->across) * y->inverse;
  double of_e = (y->vv * y->across - y->ev * y->along) * y->inverse;
  double over =
      y->f_v * of_v + y->f_e * of_e; /* 0 in the middle of the yield surface, where nothing yields */
  double flow = (y->f_v * by_v + y->f_e * by_e - f) / (over == 0.0 ? 1.0 : over);
  clay_change d = {by_v - of_v * flow, by_e - of_e * flow, flow};
  return d;
}

MPMI_INLINE void begin(const clay_constants *c, clay *o) {
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    o->v[p] = o->v_trial[p];
    o->e[p] = o->e_trial[p];
    o->flow[p] = 0.0;
    const clay_system y = system_of(c, o, p);
    o->yields[p] = y.f > 1e-12 * y.size ? 1.0 : 0.0;
    o->left[p] = o->yields[p];
    /* with alpha a start far beyond the range of the elasticity leads nowhere */
    o->e[p] = o->yields[p] > 0.0 ? mpmi_min(o->e[p], c->reach) : o->e[p];
  }
}

static int32_t some_left(const clay *o) {
  for (int p = 0; p < MPMI_CHUNK; ++p)
    if (o->left[p] > 0.0) return 1;
  return 0;
}

/* Newton's method. Each particle stops at the same step whatever stands beside it. */
MPMI_INLINE void iterate(const clay_constants *c, clay *o) {
  const int32_t most = c->alpha > 0.0 ? MOST_COUPLED : MOST_UNCOUPLED;
  for (int32_t step = 0; step < most && some_left(o); ++step) {
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      const clay_system y = system_of(c, o, p);
      const clay_change d = solve(&y, -y.off_v, -y.off_e, -y.f);
      double left = o->left[p];
      double size = fabs(d.v) * c->kappa_inverse + fabs(d.e) * y.s.shear / (y.s.p + y.s.q);
      o->v[p] = left > 0.0 ? o->v[p] + d.v : o->v[p];
      o->e[p] = left > 0.0 ? o->e[p] + d.e : o->e[p];
      o->flow[p] = left > 0.0 ? o->flow[p] + d.flow : o->flow[p];
      o->left[p] = size <= 1e-9 ? 0.0 : left; /* the error that is left is about the square of this */
    }
  }
}

/* Looks whether what has been found is a return. */
MPMI_INLINE void judge(const clay_constants *c, clay *o) {
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    const clay_system y = system_of(c, o, p);
    double fits = mpmi_min(mpmi_min(o->flow[p], o->e[p]), 1e-10 * y.size - fabs(y.f));
    double there = fits >= 0.0 ? 1.0 - o->left[p] : 0.0;
    o->left[p] = o->yields[p] * (1.0 - there);
    o->pc_new[p] = o->yields[p] > 0.0 ? o->pc[p] * (y.hard / c->harden) : o->pc[p];
  }
}

/* ---- the return of one particle for alpha = 0 ---------------------------------------------------------- */
/* With d = v - v_critical, where 2 p = pc, in units of the pressure there: q = q_trial / (1 + 6 mu0 flow /
 * M^2) and flow = (d_trial - d) / (2 p - pc) make of the yield surface one equation for d,
 *   F = (q_trial (2 p - pc))^2 / M^2 - p (pc - p) (2 p - pc + 6 mu0 / M^2 (d_trial - d))^2 = 0,
 * with F > 0 at d_trial, F < 0 at 0. */
typedef struct clay_bracket {
  double d_trial, q_trial, soft; /* soft: 6 mu0 / M^2 */
  double at_critical, pressure;  /* v and p there */
} clay_bracket;

typedef struct clay_point {
  double F, slope, p, pc, along;
} clay_point;

static clay_point point_of(const clay_constants *c, const clay_bracket *b, double d) {
  const double up = mpmi_lane_expm1(d * c->kappa_inverse), down = mpmi_lane_expm1(-d * c->harden);
  clay_point at = {.p = 1.0 + up, .pc = 2.0 * (1.0 + down), .along = 2.0 * (up - down)};
  const double dp = at.p * c->kappa_inverse, dpc = -at.pc * c->harden, dalong = 2.0 * dp - dpc;
  const double w = at.along + b->soft * (b->d_trial - d), dw = dalong - b->soft;
  const double room = at.p * (at.pc - at.p), droom = dp * (at.pc - at.p) + at.p * (dpc - dp);
  const double q = b->q_trial * b->q_trial * c->flatten * at.along;
  at.F = q * at.along - room * w * w;
  at.slope = 2.0 * q * dalong - (droom * w + 2.0 * room * dw) * w;
  return at;
}

/* Newton's method, or half of what is left where that leads out of it or is slower. */
static int32_t search(const clay_constants *c, const clay_bracket *b, double *d, clay_point *at) {
  double beyond = b->d_trial, within = 0.0, before = fabs(b->d_trial);
  *d = 0.5 * b->d_trial;
  for (int32_t step = 0; step < MOST_SCALAR; ++step) {
    *at = point_of(c, b, *d);
    *(at->F > 0.0 ? &beyond : &within) = *d;
    double next = *d - at->F / at->slope, low = mpmi_min(beyond, within), high = mpmi_max(beyond, within);
    if (!(next > low && next < high && fabs(next - *d) < 0.5 * before)) next = 0.5 * (low + high);
    before = fabs(next - *d);
    *d = next;
    if (before <= 4.0 * DBL_EPSILON * fabs(next)) {
      *at = point_of(c, b, next);
      return 1;
    }
  }
  return 0;
}

static void find_within(const clay_constants *c, clay *o, int p) {
  const double soft = 6.0 * c->mu * c->flatten, share = 1.0 / (c->kappa_inverse + c->harden);
  const double v = share * (mpmi_lane_log(0.5 * o->pc[p] / c->p_ref) + o->v_trial[p] * c->harden);
  const double pressure = c->p_ref * mpmi_lane_exp(v * c->kappa_inverse);
  const clay_bracket b = {.d_trial = o->v_trial[p] - v,
                          .q_trial = 3.0 * c->mu * o->e_trial[p] / pressure,
                          .soft = soft / pressure,
                          .at_critical = v,
                          .pressure = pressure};
  clay_point at;
  double d;
  if (!search(c, &b, &d, &at)) return;
  const double q = sqrt(mpmi_max(at.p * (at.pc - at.p), 0.0) / c->flatten);
  const double flow = fabs(at.along) > 1e-3 ? (b.d_trial - d) / at.along : (b.q_trial / q - 1.0) / b.soft;
  o->v[p] = v + d;
  o->e[p] = q * pressure / (3.0 * c->mu);
  o->flow[p] = flow * o->pc[p] / pressure;
  o->left[p] = 0.0;
}

MPMI_INLINE void come_back(const clay_constants *c, clay *o) {
  begin(c, o);
  iterate(c, o);
  judge(c, o);
  if (c->alpha > 0.0 || !some_left(o)) return;
  for (int p = 0; p < MPMI_CHUNK; ++p)
    if (o->left[p] > 0.0) find_within(c, o, p);
  judge(c, o);
}

/* ---- the law ------------------------------------------------------------------------------------------- */
MPMI_INLINE double pc_of(const clay_constants *c, double state) {
  return state > 0.0 ? state : c->pc;
}

/* Finds p and q before the step and the state. Where one is missing, the particle will be refused: then
 * p_ref is harmless. */
MPMI_INLINE void load(int dim, const clay_constants *c, mpmi_trial in, const double *state, int64_t begin,
                      clay *o, clay_inverse *old) {
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    mpmi_old before = mpmi_old_state(dim, in, begin + p, mpmi_trial_J(dim, in, begin + p));
    double pressure = -before.J * before.mean, pc = pc_of(c, state[begin + p]);
    double has = mpmi_min(pressure, pc) <= 0.0 ? 0.0 : 1.0;
    o->has[p] = has;
    o->pc[p] = has > 0.0 ? pc : c->p_ref;
    old->p[p] = has > 0.0 ? pressure : c->p_ref;
    old->q[p] = has > 0.0 ? before.J * sqrt(1.5 * mpmi_square(before.deviator)) : 0.0;
  }
  invert(c, old);
}

/* Finds b of the trials, with X of the pressures before the step. */
MPMI_INLINE void find_b(int dim, const clay_constants *c, mpmi_trial in, int64_t begin, const double *X,
                        mpmi_trial_rows *out) {
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    double J = mpmi_trial_J(dim, in, begin + p), mu = c->mu + c->alpha * X[p];
    out->J[p] = J;
    out->volume[p] = (-1.0 / 3.0) * (c->kappa * mpmi_lane_log(X[p] / c->p_ref));
    out->shape[p] = 0.5 * mpmi_old_state(dim, in, begin + p, J).J / mu;
  }
  mpmi_find_b(dim, in, begin, out);
}

/* Sets the trial from the volume strain and the size of the deviator. */
MPMI_INLINE void set_trial(const clay_constants *c, clay *o, int p, double volume, double square,
                           double gap) {
  double least = mpmi_min(c->least + c->least_share * o->pc[p], 0.5 * o->pc[p]);
  double lowest = c->kappa * mpmi_lane_log(least / c->p_ref), v = -volume - mpmi_max(gap, 0.0);
  o->gap[p] = mpmi_max(lowest - v, 0.0);
  o->v_trial[p] = v < lowest ? lowest : v;
  o->e_trial[p] = sqrt((2.0 / 3.0) * square);
}

/* The shear stress by that of the trial's strain: 2 mu where nothing yields. */
MPMI_INLINE double shape_of(const clay_constants *c, const clay *o, int p, double shear) {
  return (2.0 / 3.0) * shear / (1.0 + o->flow[p] * (2.0 * c->flatten * shear / o->pc[p]));
}

/* A particle that lacks something stays as it is. */
static void stay(int dim, const mpm_material_batch *batch, int64_t i) {
  for (int64_t r = 0; r < mpmi_stress_components(dim); ++r)
    batch->stress_new[r * batch->ld + i] = batch->stress[r * batch->ld + i];
  for (int64_t r = 0; r < 2; ++r) batch->state_new[r * batch->ld + i] = batch->state[r * batch->ld + i];
}

MPMI_INLINE void clay_step(int dim, const clay_constants *c, const mpm_material_batch *batch) {
  const int64_t ld = batch->ld;
  const mpmi_trial in = mpmi_trial_of(batch);
  double *stress = batch->stress_new, *state = batch->state_new, *wave_speed_squared = batch->wave_speed;
  _Alignas(64) double d[6][MPMI_CHUNK];
  clay_inverse old;
  clay o;
  mpmi_trial_rows trial;
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    load(dim, c, in, batch->state, i, &o, &old);
    find_b(dim, c, in, i, old.X, &trial);
    mpmi_find_strains(dim, &trial);
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      double mean;
      mpmi_sym e = mpmi_deviator(mpmi_load_sym(dim, trial.strain[0], MPMI_CHUNK, p), &mean);
      mpmi_store_sym(dim, d[0], MPMI_CHUNK, p, e);
      set_trial(c, &o, p, 3.0 * mean, mpmi_square(e), batch->state[ld + i + p]);
    }
    come_back(c, &o);
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      const clay_stress t = stress_of(c, o.v[p], o.e[p]);
      double inverse = 1.0 / trial.J[p], pressure = inverse * t.p;
      double shape = inverse * shape_of(c, &o, p, t.shear);
      mpmi_sym s = mpmi_load_sym(dim, d[0], MPMI_CHUNK, p);
      mpmi_store_sym(dim, stress, ld, i + p, mpmi_shifted(shape, s, -pressure));
      state[i + p] = o.pc_new[p];
      state[ld + i + p] = o.gap[p];
      double bears = o.e[p] * o.e[p] * c->couples, end = bears > 1.0 ? MPMI_REFUSED(TOO_SHEARED) : 0.0;
      end = o.left[p] > 0.0 ? MPMI_REFUSED(NOT_RETURNED) : end;
      /* by strains far beyond kappa squares of stresses leave the range of doubles */
      end = t.p + t.q + o.pc_new[p] <= 1e150 ? end : MPMI_REFUSED(NOT_RETURNED);
      wave_speed_squared[i + p] = old.bears[p] > 0.0 ? end : MPMI_REFUSED(UNBEARABLE);
    }
    for (int p = 0; p < MPMI_CHUNK; ++p)
      if (!(o.has[p] > 0.0)) stay(dim, batch, i + p);
  }
}

/* Computes squared wave speed and energy from stress and state, and refuses those that have none. The
 * stiffness of the fastest wave is at most that of compression and shear, what couples them, and the largest
 * pressure. */
MPMI_INLINE void clay_outputs(int dim, const clay_constants *c, const mpm_material_batch *batch) {
  const int64_t ld = batch->ld;
  const double *deformation = batch->F, *stress = batch->stress_new, *state = batch->state_new;
  const double unborne = batch->dt > 0.0 ? MPMI_REFUSED(TOO_SHEARED) : MPMI_REFUSED(UNBEARABLE);
  double *wave_speed_squared = batch->wave_speed, *energy = batch->energy;
  double missing[MPMI_CHUNK];
  clay_inverse o;
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      double J = 1.0 + mpmi_J_minus_1(dim, mpmi_load_F_minus_1(dim, deformation, ld, i + p)), mean;
      double square = mpmi_square(mpmi_deviator(mpmi_load_sym(dim, stress, ld, i + p), &mean));
      double pressure = -J * mean, without = pc_of(c, state[i + p]) <= 0.0 ? MPMI_REFUSED(NO_PC) : 0.0;
      missing[p] = pressure <= 0.0 ? MPMI_REFUSED(NO_STRESS) : without;
      o.p[p] = missing[p] < 0.0 ? c->p_ref : pressure;
      o.q[p] = missing[p] < 0.0 ? 0.0 : J * sqrt(1.5 * square);
    }
    invert(c, &o);
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      double X = o.X[p], mu = c->mu + c->alpha * X, e_s = (1.0 / 3.0) * o.q[p] / mu;
      double stiffness = o.p[p] * c->kappa_inverse + (4.0 / 3.0) * (c->mu + c->alpha * o.p[p]) +
                         (8.0 / 3.0) * c->couples * (X * e_s) + (o.p[p] + (2.0 / 3.0) * o.q[p]);
      double refused = wave_speed_squared[i + p] < 0.0 ? wave_speed_squared[i + p] : missing[p];
      double speed_squared = o.bears[p] > 0.0 ? stiffness * c->density_inverse : unborne;
      wave_speed_squared[i + p] = refused < 0.0 ? refused : speed_squared;
      energy[i + p] = c->kappa * X + 1.5 * mu * (e_s * e_s);
    }
  }
}

MPMI_INLINE void cam_clay(int dim, const clay_constants *constants, const mpm_material_batch *batch) {
  const clay_constants c = *constants;
  if (mpmi_keeps_state(dim, 2, batch)) {
    for (int64_t i = 0; i < mpmi_batch_items(batch); ++i) batch->wave_speed[i] = 0.0;
  } else {
    clay_step(dim, &c, batch);
  }
  clay_outputs(dim, &c, batch);
}

/* ---- the tangent --------------------------------------------------------------------------------------- */
/* Sets a_AB from the derivatives of p and q by the trial's v and e_s; n: the unit deviator of its strain. */
MPMI_INLINE void slopes(const clay_constants *c, const clay *o, const double *n, int p, mpmi_principal *to) {
  const clay_system y = system_of(c, o, p);
  double yields = o->yields[p], flow = o->flow[p], closed = o->gap[p] > 0.0 ? 0.0 : 1.0;
  double grown = y.hard * (y.s.p / o->pc[p]);
  clay_change by_v = solve(&y, 1.0 + flow * y.hard, 0.0, grown), by_e = solve(&y, 0.0, 1.0, 0.0);
  by_v.v = closed * (yields > 0.0 ? by_v.v : 1.0), by_v.e = closed * (yields > 0.0 ? by_v.e : 0.0);
  by_e.v = yields > 0.0 ? by_e.v : 0.0, by_e.e = yields > 0.0 ? by_e.e : 1.0;
  double p_v = y.s.bulk * by_v.v + y.s.mixed * by_v.e, p_e = y.s.bulk * by_e.v + y.s.mixed * by_e.e;
  double q_v = y.s.mixed * by_v.v + y.s.shear * by_v.e, q_e = y.s.mixed * by_e.v + y.s.shear * by_e.e;
  double shape = shape_of(c, o, p, y.s.shear), root = sqrt(2.0 / 3.0);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      to->slope[a][b][p] = (p_v - root * p_e * n[b]) + root * n[a] * (root * q_e * n[b] - q_v) +
                           shape * ((a == b) - 1.0 / 3.0 - n[a] * n[b]);
}

MPMI_INLINE void cam_clay_tangent(int dim, const clay_constants *c, const mpm_material_batch *batch,
                                  double *tangent) {
  const int64_t ld = batch->ld;
  const mpmi_trial in = mpmi_trial_of(batch);
  double n[3][MPMI_CHUNK], size[MPMI_CHUNK];
  mpmi_principal to;
  clay_inverse old;
  clay o;
  mpmi_trial_rows trial;
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    load(dim, c, in, batch->state, i, &o, &old);
    find_b(dim, c, in, i, old.X, &trial);
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      double square = 0.0;
      mpmi_principal_find(dim, &to, p, mpmi_load_sym(dim, trial.b[0], MPMI_CHUNK, p), trial.J[p]);
      double volume = to.strain[0][p] + to.strain[1][p] + to.strain[2][p];
      for (int a = 0; a < 3; ++a) {
        n[a][p] = to.strain[a][p] - (1.0 / 3.0) * volume;
        square += n[a][p] * n[a][p];
      }
      size[p] = sqrt(square);
      set_trial(c, &o, p, volume, square, batch->state[ld + i + p]);
    }
    come_back(c, &o);
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      const clay_stress t = stress_of(c, o.v[p], o.e[p]);
      double shape = shape_of(c, &o, p, t.shear), unit = size[p] > 0.0 ? 1.0 / size[p] : 0.0;
      double at[3] = {unit * n[0][p], unit * n[1][p], unit * n[2][p]};
      for (int a = 0; a < 3; ++a) to.tau[a][p] = shape * n[a][p] - t.p;
      slopes(c, &o, at, p, &to);
    }
    KERNEL(principal_rows)(dim, &to, tangent + i, ld);
  }
}

MPMI_LAW_KERNELS(clay_constants, cam_clay, cam_clay_tangent)

const mpmi_law KERNEL(law_cam_clay) = {
    .name = "cam_clay",
    MPMI_PARAMS(params),
    MPMI_STATES(states),
    .start = start,
    MPMI_REFUSALS(refusals),
    .pressure_from_shear = 1,
    .check = check,
    .no_sheets = 1,
    .constants_size = sizeof(clay_constants),
    .prepare = prepare,
    .stress = stress_kernel,
    .tangent = tangent_kernel,
    .is_symmetric = mpmi_unsymmetric,
};
