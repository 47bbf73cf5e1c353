/* Von Mises plasticity with linear isotropic hardening: the increments of linear_elastic, then a radial
 * return (Simo & Hughes 1998, box 3.1). One state variable, the equivalent plastic strain. */
#include "material/objective_tangent.h"

enum { YIELD_STRESS = 3, HARDENING };
static const mpmi_law_param params[] = {
    PARAMS_ELASTIC,
    [YIELD_STRESS] = {"yield_stress", "stress", "initial yield stress in tension", MUST_BE_GIVEN, POSITIVE},
    [HARDENING] = {"hardening", "stress", "slope of the yield stress over the equivalent plastic strain", 0.0,
                   NOT_NEGATIVE}};

static const mpmi_law_state states[] = {{"plastic_strain", "1", "equivalent plastic strain"}};

typedef struct j2_constants {
  mpmi_elastic elastic;
  double yield_initial, hardening; /* yield stress = yield_initial + hardening * plastic strain */
  double return_inverse;           /* 1 / (3 mu + hardening) */
} j2_constants;

static void prepare(const double *value, void *constants) {
  j2_constants *c = constants;
  c->elastic = mpmi_elastic_of(value);
  c->yield_initial = value[YIELD_STRESS];
  c->hardening = value[HARDENING];
  c->return_inverse = 1.0 / (mpmi_rounded(3.0 * c->elastic.mu) + c->hardening);
}

MPMI_INLINE void j2(int dim, const j2_constants *c, const mpm_material_batch *batch) {
  const double yield_initial = c->yield_initial, hardening = c->hardening;
  const double return_inverse = c->return_inverse, mu3 = 3.0 * c->elastic.mu;
  const double lambda = c->elastic.lambda, mu = c->elastic.mu;
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const mpmi_increments in = mpmi_increments_of(batch);
  const double *plastic_old = batch->state;
  double *stress = batch->stress_new, *plastic_new = batch->state_new;
  const int64_t moving = mpmi_keeps_state(dim, 1, batch) ? 0 : n;
  for (int64_t begin = 0; begin < moving; begin += MPMI_CHUNK) {
    mpmi_increment_rows of;
    mpmi_find_increments(dim, in, begin, &of);
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) {
      const int64_t i = begin + p;
      double mean, plastic = plastic_old[i];
      mpmi_sym d = mpmi_deviator(mpmi_trial_stress(dim, lambda, mu, &of, p), &mean);
      double mises = sqrt(1.5 * mpmi_square(d)), yield = yield_initial + hardening * plastic;
      double increment = mpmi_max(mises - yield, 0.0) * return_inverse;
      /* Where there is an increment, mises > yield > 0: the maximum is mises, and never 0. */
      double keep = 1.0 - mu3 * increment / mpmi_max(mises, yield);
      mpmi_store_sym(dim, stress, ld, i, mpmi_shifted(keep, d, mean));
      plastic_new[i] = plastic + increment;
    }
  }
  mpmi_elastic_outputs(dim, &c->elastic, batch);
}

/* With the trial deviator d, its von Mises stress m and the yield stress y, the factor of d that the law
 * keeps, 1 - 3 mu / (3 mu + hardening) (1 - y / m), changes by -3 mu / (3 mu + hardening) y / m 3/2 d :
 * (change of d) / m^2. */
MPMI_INLINE void j2_chunk(int dim, const j2_constants *c, const double *plastic, mpmi_objective *o) {
  const double yield_initial = c->yield_initial, hardening = c->hardening;
  const double return_inverse = c->return_inverse, mu = c->elastic.mu, mu3 = 3.0 * mu;
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    mpmi_sym s = mpmi_load_sym(dim, o->of.turned[0], MPMI_CHUNK, p);
    mpmi_sym v = mpmi_load_sym(dim, o->of.log_v[0], MPMI_CHUNK, p);
    mpmi_sym trial = {s.xx + 2.0 * mu * v.xx, s.yy + 2.0 * mu * v.yy, s.zz + 2.0 * mu * v.zz,
                      s.xy + 2.0 * mu * v.xy, s.yz + 2.0 * mu * v.yz, s.xz + 2.0 * mu * v.xz};
    double mean;
    mpmi_sym d = mpmi_deviator(trial, &mean);
    double mises = sqrt(1.5 * mpmi_square(d)), yield = yield_initial + hardening * plastic[p];
    double over = mpmi_max(mises - yield, 0.0), inverse = 1.0 / mpmi_max(mises, yield);
    double drop = over > 0.0 ? 1.5 * mu3 * return_inverse * yield * inverse : 0.0;
    o->keep[p] = 1.0 - mu3 * return_inverse * over * inverse;
    mpmi_store_sym(dim, o->bend[0], MPMI_CHUNK, p, mpmi_shifted(sqrt(drop) * inverse, d, 0.0));
  }
}

MPMI_INLINE void j2_tangent(int dim, const j2_constants *c, const mpm_material_batch *batch,
                            double *tangent) {
  mpmi_objective o;
  for (int64_t i = 0; i < mpmi_batch_items(batch); i += MPMI_CHUNK) {
    mpmi_elastic_chunk(dim, &c->elastic, batch, i, &o);
    j2_chunk(dim, c, batch->state + i, &o);
    KERNEL(objective_rows)(dim, 0, &o, tangent + i, batch->ld);
  }
}

MPMI_LAW_KERNELS(j2_constants, j2, j2_tangent)

const mpmi_law KERNEL(law_j2) = {
    .name = "j2",
    MPMI_PARAMS(params),
    MPMI_STATES(states),
    .energy_of_stress = 1,
    .constants_size = sizeof(j2_constants),
    .prepare = prepare,
    .stress = stress_kernel,
    .tangent = tangent_kernel,
    .is_symmetric = mpmi_unsymmetric,
};
