/* Snow of Stomakhin et al. (2013): the elastic stretches stay within bounds, what is beyond them is plastic,
 * and compaction hardens. With the principal stretches S_A of the elastic part, J_E their product and J_P = J
 * / J_E,
 *
 *   t_A = h (2 mu (S_A - 1) S_A + lambda (J_E - 1) J_E),   h = min(exp(hardening (1 - J_P)), hardening_max),
 *   W = h (mu sum (S_A - 1)^2 + lambda/2 (J_E - 1)^2).
 *
 * The state is b - I of the elastic part, pushed forward by F_inc; the stress follows from it and from J. */
#include "material/principal_tangent.h"

enum { HARDENING = 3, COMPRESSION, STRETCH, HARDENING_MAX };
static const mpmi_law_param params[] = {
    PARAMS_ELASTIC,
    [HARDENING] = {"hardening", "1", "growth of the stiffness with compaction: exp(hardening (1 - J_P))",
                   10.0, NOT_NEGATIVE},
    [COMPRESSION] = {"critical_compression", "1", "elastic stretches are at least 1 less this", 0.025,
                     DBL_MIN, 1.0 - DBL_EPSILON / 2, "must be > 0 and < 1", 0},
    [STRETCH] = {"critical_stretch", "1", "elastic stretches are at most 1 and this", 0.0075, NOT_NEGATIVE},
    [HARDENING_MAX] = {"hardening_max", "1", "largest factor of the stiffness", 148.4131591025766,
                       AT_LEAST_ONE}};

static const mpmi_law_state states[] = {{"be_xx", "1", "xx of b - I, b the elastic left Cauchy-Green tensor"},
                                        {"be_yy", "1", "yy of b - I"},
                                        {"be_zz", "1", "zz of b - I"},
                                        {"be_xy", "1", "xy of b - I"},
                                        {"be_yz", "1", "yz of b - I"},
                                        {"be_xz", "1", "xz of b - I"}};
enum { STATE_ROWS = 6 };

typedef struct snow_constants {
  double lambda, mu, density_inverse;
  double hardening, hardening_max;
  double least, most; /* of S - 1 */
} snow_constants;

static void prepare(const double *value, void *constants) {
  snow_constants *c = constants;
  const mpmi_elastic elastic = mpmi_elastic_of(value);
  c->lambda = elastic.lambda;
  c->mu = elastic.mu;
  c->density_inverse = elastic.density_inverse;
  c->hardening = value[HARDENING];
  c->hardening_max = value[HARDENING_MAX];
  c->least = -value[COMPRESSION];
  c->most = value[STRETCH];
}

/* A particle after the return: stretches less 1, and which of them are within the bounds. */
typedef struct snow_point {
  double stretch[3], free[3];
  double J_E_minus_1, J_P, h, grows; /* grows: 1 where h follows J_P */
} snow_point;

MPMI_INLINE snow_point point_of(const snow_constants *c, const mpmi_principal *o, int p) {
  snow_point r;
  MPMI_UNROLL for (int a = 0; a < 3; ++a) {
    double square = mpmi_max(1.0 + o->b[a][p], 0.0), trial = o->b[a][p] / (1.0 + sqrt(square));
    r.stretch[a] = mpmi_min(mpmi_max(trial, c->least), c->most);
    r.free[a] = r.stretch[a] == trial ? 1.0 : 0.0;
  }
  double x = r.stretch[0], y = r.stretch[1], z = r.stretch[2], plane = (x + y) + x * y;
  r.J_E_minus_1 = (plane + z) + plane * z;
  r.J_P = 1.0 / (o->J_inverse[p] * (1.0 + r.J_E_minus_1));
  double h = mpmi_lane_exp(c->hardening * (1.0 - r.J_P));
  r.grows = h < c->hardening_max ? 1.0 : 0.0;
  r.h = mpmi_min(h, c->hardening_max);
  return r;
}

MPMI_INLINE double volumetric_of(const snow_constants *c, const snow_point *r) {
  return c->lambda * r->J_E_minus_1 * (1.0 + r->J_E_minus_1);
}

MPMI_INLINE void set_stress(const snow_constants *c, const snow_point *r, int p, mpmi_principal *o) {
  double volumetric = volumetric_of(c, r);
  for (int a = 0; a < 3; ++a)
    o->tau[a][p] = r->h * (2.0 * c->mu * r->stretch[a] * (1.0 + r->stretch[a]) + volumetric);
}

/* Writes stress, energy and the squared speed of the fastest elastic wave, h (2 mu S^2 + lambda J_E^2) /
 * density for the largest S; leaves b - I after the return in o->tau. */
MPMI_INLINE void snow_chunk(int dim, const snow_constants *c, const mpm_material_batch *batch, int64_t begin,
                            mpmi_principal *o) {
  double *wave_speed_squared = batch->wave_speed + begin, *energy = batch->energy + begin;
  _Alignas(64) double be[3][MPMI_CHUNK];
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    const snow_point r = point_of(c, o, p);
    double x = r.stretch[0], y = r.stretch[1], z = r.stretch[2], J_E = 1.0 + r.J_E_minus_1;
    double most = 1.0 + mpmi_max(mpmi_max(x, y), z);
    set_stress(c, &r, p, o);
    wave_speed_squared[p] = r.h * (2.0 * c->mu * most * most + c->lambda * J_E * J_E) * c->density_inverse;
    energy[p] = r.h * (c->mu * (x * x + y * y + z * z) + 0.5 * c->lambda * r.J_E_minus_1 * r.J_E_minus_1);
    for (int a = 0; a < 3; ++a) be[a][p] = r.stretch[a] * (2.0 + r.stretch[a]);
  }
  mpmi_principal_stress(dim, o, batch->stress_new + begin, batch->ld);
  memcpy(o->tau, be, sizeof be);
}

/* Loads principal values and vectors of b of the trial; with dt = 0 of the state as it is. */
MPMI_INLINE void load_trial(int dim, mpmi_principal *o, const mpm_material_batch *batch, int64_t begin) {
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    const int64_t i = begin + p;
    mpmi_sym b = mpmi_load_sym(dim, batch->state, batch->ld, i);
    mpmi_mat g = mpmi_load_mat(dim, batch->L, batch->ld, i, 0.0, batch->dt);
    mpmi_principal_set(dim, o, p, mpmi_pushed_forward(dim, g, b));
    o->J_inverse[p] = 1.0 / (1.0 + mpmi_J_minus_1(dim, mpmi_load_F_minus_1(dim, batch->F, batch->ld, i)));
  }
}

/* Writes the state: sum of the principal values in `tau` along their directions. */
MPMI_INLINE void store_state(int dim, mpmi_principal *o, double *state, int64_t ld) {
  for (int p = 0; p < MPMI_CHUNK; ++p) o->J_inverse[p] = 1.0;
  mpmi_principal_stress(dim, o, state, ld);
  for (int c = mpmi_stress_components(dim); c < STATE_ROWS; ++c)
    for (int p = 0; p < MPMI_CHUNK; ++p) state[c * ld + p] = 0.0;
}

MPMI_INLINE void snow(int dim, const snow_constants *constants, const mpm_material_batch *batch) {
  const snow_constants c = *constants;
  mpmi_principal o;
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    load_trial(dim, &o, batch, i);
    snow_chunk(dim, &c, batch, i, &o);
    if (batch->dt > 0.0) store_state(dim, &o, batch->state_new + i, batch->ld);
  }
  if (batch->dt == 0.0) mpmi_keep_rows(STATE_ROWS, batch->state, batch->state_new, batch);
}

/* a_AB = t_A (h'/h) + h (2 mu (2 S_A - 1) S_A d_AB + lambda (2 J_E - 1) J_E) f_B, where f_B is 1 for a
 * stretch within the bounds, else 0, and h'/h = -hardening J_P (1 - f_B), 0 at the largest h. */
MPMI_INLINE void set_slopes(const snow_constants *c, const snow_point *r, int p, mpmi_principal *o) {
  double J_E = 1.0 + r->J_E_minus_1, volumetric = c->lambda * (1.0 + 2.0 * r->J_E_minus_1) * J_E;
  double softens = r->grows * c->hardening * r->J_P;
  for (int a = 0; a < 3; ++a) {
    double S = 1.0 + r->stretch[a], own = 2.0 * c->mu * (1.0 + 2.0 * r->stretch[a]) * S;
    for (int b = 0; b < 3; ++b)
      o->slope[a][b][p] = r->h * ((a == b ? own : 0.0) + volumetric) * r->free[b] -
                          o->tau[a][p] * softens * (1.0 - r->free[b]);
  }
}

MPMI_INLINE void snow_tangent(int dim, const snow_constants *c, const mpm_material_batch *batch,
                              double *tangent) {
  mpmi_principal o;
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    load_trial(dim, &o, batch, i);
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      const snow_point r = point_of(c, &o, p);
      set_stress(c, &r, p, &o);
      set_slopes(c, &r, p, &o);
    }
    KERNEL(principal_rows)(dim, &o, tangent + i, batch->ld);
  }
}

MPMI_LAW_KERNELS(snow_constants, snow, snow_tangent)

const mpmi_law KERNEL(law_snow) = {
    .name = "snow",
    MPMI_PARAMS(params),
    MPMI_STATES(states),
    .stress_from_F = 1,
    .rest = MPMI_REST_NONE,
    .no_sheets = 1,
    .constants_size = sizeof(snow_constants),
    .prepare = prepare,
    .stress = stress_kernel,
    .tangent = tangent_kernel,
    .is_symmetric = mpmi_unsymmetric,
};
