/* Ground at rest: the stress of the weight above each particle, and K0 times it across. Where the stress of a
 * law follows from F, the F that has it is found by Newton's method on the law itself. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "context/checks.h"
#include "particles/builtin_fields.h"
#include "particles/law_batch.h"
#include "particles/reference.h"
#include "simd/elementary.h"
#include "particles/thermal.h"

typedef struct ground {
  int32_t axis;
  double gravity, surface, K0, surcharge;
} ground;

/* ---- what is asked for --------------------------------------------------------------------------------- */
static mpm_status check_ground(const mpm_particles *set, const ground *g) {
  mpm_context *c = set->context;
  const int32_t dim = set->grid->dim;
  if (g->axis < 0 || g->axis >= dim)
    return mpmi_fail(c, MPM_E_ARG, "axis is %d: a %d-D grid has 0 ... %d", (int)g->axis, (int)dim,
                     (int)dim - 1);
  if (mpmi_is_plane_stress(set->grid))
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "the grid is MPM_PLANE_STRESS, and ground bears a stress across the plane: use "
                     "MPM_PLANE_STRAIN");
  if (mpmi_is_axisymmetric(set->grid) && g->axis == 0)
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "axis is 0, which is the radius of an MPM_AXISYMMETRIC grid: weight acts along axis 1");
  if (set->grid->desc.periodic[g->axis])
    return mpmi_fail(c, MPM_E_ARG, "axis %d is periodic: there is no surface on it", (int)g->axis);
  if (!isfinite(g->gravity) || g->gravity == 0.0)
    return mpmi_fail(c, MPM_E_ARG, "gravity is %g: it must be finite and not 0", g->gravity);
  if (!isfinite(g->surface)) return mpmi_fail(c, MPM_E_ARG, "surface is %g: it must be finite", g->surface);
  const mpm_status status = mpmi_check_magnitude(c, "K0", g->K0);
  return status ? status : mpmi_check_magnitude(c, "surcharge", g->surcharge);
}

static int32_t rest_of(const mpm_particles *set) {
  return set->material->law ? set->material->law->rest : MPMI_REST_BY_KIND;
}

static int32_t is_deformed(const mpm_particles *set) {
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  int32_t is = 0;
  for (int32_t c = 0; c < set->field[MPMI_F].components; ++c) {
    const double unit = mpmi_unstored_value(MPMI_F, mpmi_tensor_map(set->grid->dim)[c]);
    const double *F = mpmi_f64(set, MPMI_F, 0) + c * set->ld;
    for (int64_t s = 0; s < set->slots; ++s) is |= id[s] >= 0 && (F[s] < unit || F[s] > unit);
  }
  return is;
}

static mpm_status check_law(const mpm_particles *set, const ground *g) {
  const mpmi_law *law = set->material->law;
  if (mpmi_expands(set))
    return mpmi_fail(
        set->context, MPM_E_UNSUPPORTED,
        "the set expands with its temperature: give it the stress before mpm_stepper_set_heat gives it "
        "an expansion");
  if (mpmi_is_total_lagrangian(set->grid) && law && law->stress_from_F)
    return mpmi_fail(
        set->context, MPM_E_UNSUPPORTED,
        "the stress of %s follows from deformation_gradient, which a grid with total_lagrangian = 1 "
        "wants to be that of its positions: use total_lagrangian = 0, or a law whose stress is its "
        "state",
        law->name);
  if (mpmi_is_total_lagrangian(set->grid) && is_deformed(set))
    return mpmi_fail(
        set->context, MPM_E_UNSUPPORTED,
        "the set has deformed, and total_lagrangian is 1: call mpm_particles_reset_reference first");
  if (rest_of(set) == MPMI_REST_NONE)
    return mpmi_fail(set->context, MPM_E_UNSUPPORTED, "%s has no stress of a given weight: %s", law->name,
                     law->state_count ? "set its deformation_gradient and state" : "leave the set as it is");
  if (rest_of(set) == MPMI_REST_PRESSURE && law->stress_from_F && g->K0 != 1.0)
    return mpmi_fail(set->context, MPM_E_UNSUPPORTED,
                     "K0 is %g: %s at rest bears the same pressure along all axes, so use K0 = 1", g->K0,
                     law->name);
  return MPM_OK;
}

/* Writes the stress of the weight into the second copy. */
static mpm_status find_stress(mpm_particles *set, const ground *g) {
  const double *x = mpmi_f64(set, MPMI_POSITION, 0) + g->axis * set->ld;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  const double down = g->gravity > 0.0 ? 1.0 : -1.0, weight = set->material->density * fabs(g->gravity);
  for (int64_t s = 0; s < set->slots; ++s) {
    const double depth = id[s] < 0 ? 0.0 : down * (x[s] - g->surface);
    const double along = id[s] < 0 ? 0.0 : -(g->surcharge + weight * depth), across = g->K0 * along;
    if (depth < 0.0)
      return mpmi_fail(set->context, MPM_E_ARG,
                       "the particle with id %lld lies %g above the surface at %.12g", (long long)id[s],
                       -depth, g->surface);
    if (!isfinite(along) || !isfinite(across))
      return mpmi_fail(set->context, MPM_E_ARG,
                       "the weight on the particle with id %lld is beyond the range of double precision",
                       (long long)id[s]);
    for (int32_t c = 0; c < mpmi_stress_components(set->grid->dim); ++c)
      mpmi_f64(set, MPMI_STRESS, 1)[c * set->ld + s] = c > 2 ? 0.0 : c == g->axis ? along : across;
  }
  return MPM_OK;
}

/* ---- F from the stress --------------------------------------------------------------------------------- */
enum { FULL = 3, TANGENT_ROWS = 81, MOST_ITERATIONS = 60 };

/* The largest change of a logarithmic strain in one iteration. */
static const double most_strain = 0.25;

/* Particles of one batch on the way to their F = diag(exp(strain)). */
typedef struct search {
  mpm_particles *set;
  mpmi_law_batch law;
  double *tangent; /* [81][law.ld] */
  int64_t begin, n;
  double strain[FULL][MPMI_BATCH_OWN];
  uint8_t found[MPMI_BATCH_OWN];
} search;

static double wanted(const search *s, int64_t p, int32_t axis) {
  return mpmi_f64(s->set, MPMI_STRESS, 1)[axis * s->set->ld + s->begin + p];
}

/* As fmax(), but what is not a number is the largest. */
static double larger(double a, double b) {
  return isnan(a) || b <= a ? a : b;
}

/* Finds how Cauchy stresses follow logarithmic strains on the axes: with tau = J sigma and the tangent c,
 * d tau_a / d strain_b = c_aabb + 2 tau_a d_ab. Returns the largest entry. */
static double find_stiffness(const search *s, int64_t p, double stiffness[FULL][FULL]) {
  const int64_t ld = s->law.ld;
  const double J = mpmi_exp(s->strain[0][p] + s->strain[1][p] + s->strain[2][p]);
  double largest = 0.0;
  for (int32_t a = 0; a < FULL; ++a)
    for (int32_t b = 0; b < FULL; ++b) {
      const double sigma = s->law.stress_new[a * ld + p];
      stiffness[a][b] = s->tangent[(36 * a + 4 * b) * ld + p] / J - sigma + (a == b ? 2.0 * sigma : 0.0);
      largest = larger(largest, fabs(stiffness[a][b]));
    }
  return largest;
}

/* Solves for three strains by Cramer's rule. */
static void solve(double a[FULL][FULL], const double *rhs, double *x) {
  double cofactor[FULL][FULL];
  for (int32_t i = 0; i < FULL; ++i)
    for (int32_t j = 0; j < FULL; ++j) {
      const int32_t i1 = (i + 1) % FULL, i2 = (i + 2) % FULL, j1 = (j + 1) % FULL, j2 = (j + 2) % FULL;
      cofactor[i][j] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
    }
  const double determinant = a[0][0] * cofactor[0][0] + a[0][1] * cofactor[0][1] + a[0][2] * cofactor[0][2];
  for (int32_t j = 0; j < FULL; ++j)
    x[j] = (cofactor[0][j] * rhs[0] + cofactor[1][j] * rhs[1] + cofactor[2][j] * rhs[2]) / determinant;
}

/* Improves the strain of a particle, unless its stress is right up to rounding. In 1-D there is but one
 * strain, and what the law has across goes with it; a pressure has one strain, too. */
static void improve(search *s, int64_t p) {
  const int32_t dim = s->set->grid->dim, pressure = rest_of(s->set) == MPMI_REST_PRESSURE;
  double stiffness[FULL][FULL], lacks[FULL], by[FULL] = {0.0, 0.0, 0.0}, largest = 0.0, error = 0.0;
  const double stiffest = find_stiffness(s, p, stiffness);
  for (int32_t a = 0; a < FULL; ++a) {
    lacks[a] = wanted(s, p, a) - s->law.stress_new[a * s->law.ld + p];
    largest = fmax(largest, fabs(wanted(s, p, a)));
  }
  const double mean = (lacks[0] + lacks[1] + lacks[2]) / 3.0;
  for (int32_t a = 0; a < (dim == 1 ? 1 : FULL); ++a) error = larger(error, fabs(pressure ? mean : lacks[a]));
  for (int32_t c = FULL; c < 6; ++c) error = larger(error, fabs(s->law.stress_new[c * s->law.ld + p]));
  s->found[p] = isfinite(stiffest) && error <= 1e-13 * largest + 8.0 * DBL_EPSILON * stiffest;
  if (s->found[p]) return;
  if (pressure) {
    const int32_t moved = dim == 1 ? 1 : FULL;
    double slope = 0.0;
    for (int32_t a = 0; a < FULL; ++a)
      for (int32_t b = 0; b < moved; ++b) slope += stiffness[a][b] / 3.0;
    for (int32_t b = 0; b < moved; ++b) by[b] = mean / slope;
  } else if (dim == 1) {
    by[0] = lacks[0] / stiffness[0][0];
  } else {
    solve(stiffness, lacks, by);
  }
  const double length = fmax(fabs(by[0]), fmax(fabs(by[1]), fabs(by[2])));
  const double share = length > most_strain ? most_strain / length : 1.0;
  for (int32_t b = 0; b < FULL; ++b) s->strain[b][p] += share * by[b];
}

static void set_F(search *s) {
  for (int32_t a = 0; a < FULL; ++a)
    for (int64_t p = 0; p < s->n; ++p) s->law.F[4 * a * s->law.ld + p] = mpmi_exp(s->strain[a][p]);
}

/* The law is asked for a step in which nothing moves: what is viscous is silent then. */
static mpm_status iterate(search *s) {
  const mpm_material *material = s->set->material;
  int64_t left = 1;
  for (int32_t i = 0; left && i < MOST_ITERATIONS; ++i) {
    int32_t symmetric = 1;
    set_F(s);
    mpm_status status = mpmi_law_batch_run(&s->law, material, FULL);
    if (!status) status = mpmi_material_tangent(material, FULL, &s->law.batch, NULL, s->tangent, &symmetric);
    if (status)
      return mpmi_fail(s->set->context, MPM_E_UNSUPPORTED, "%s returned %d when asked for its stress at rest",
                       material->law->name, (int)status);
    left = 0;
    for (int64_t p = 0; p < s->n; ++p) {
      if (!s->found[p]) improve(s, p);
      left += !s->found[p];
    }
  }
  return MPM_OK;
}

static mpm_status search_batch(search *s) {
  mpm_particles *set = s->set;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0) + s->begin;
  memset(s->strain, 0, sizeof s->strain);
  mpmi_law_batch_load(&s->law, set, s->begin, s->n, 0.0, 1.0);
  for (int32_t c = 0; c < mpmi_stress_components(set->grid->dim); ++c)
    memcpy(s->law.stress + c * s->law.ld, mpmi_f64(set, MPMI_STRESS, 1) + c * set->ld + s->begin,
           (size_t)s->n * sizeof(double));
  for (int64_t p = 0; p < s->n; ++p) s->found[p] = id[p] < 0;
  const mpm_status status = iterate(s);
  if (status) return status;
  for (int64_t p = 0; p < s->n; ++p)
    if (!s->found[p])
      return mpmi_fail(set->context, MPM_E_ARG,
                       "no stretch along the axes gives %s the stresses %g, %g, %g that the weight on the "
                       "particle with id %lld asks for",
                       set->material->law->name, wanted(s, p, 0), wanted(s, p, 1), wanted(s, p, 2),
                       (long long)id[p]);
  for (int32_t a = 0; a < FULL; ++a) {
    const int32_t stored = mpmi_stored_component(set, MPMI_F, 4 * a);
    for (int64_t p = 0; p < s->n && stored >= 0; ++p)
      mpmi_f64(set, MPMI_F, 1)[stored * set->ld + s->begin + p] = s->law.F[4 * a * s->law.ld + p];
  }
  return MPM_OK;
}

/* Writes the F that has the stress of the second copy into the second copy of F. */
static mpm_status find_F(mpm_particles *set) {
  const size_t batch = mpmi_law_batch_bytes(set->material);
  const size_t bytes = batch + mpmi_bytes(TANGENT_ROWS * MPMI_BATCH_OWN, sizeof(double));
  char *memory = mpmi_alloc(set->context, bytes);
  if (!memory) return MPM_E_NOMEM;
  search s = {.set = set, .tangent = (double *)(void *)(memory + batch)};
  mpmi_law_batch_bind(&s.law, set->material, memory);
  mpm_status status = MPM_OK;
  for (; s.begin < set->slots && !status; s.begin += s.law.ld) {
    s.n = set->slots - s.begin < s.law.ld ? set->slots - s.begin : s.law.ld;
    status = search_batch(&s);
  }
  mpmi_free(set->context, memory, bytes);
  return status;
}

/* ---- the call ------------------------------------------------------------------------------------------ */
static void take(mpm_particles *set) {
  mpmi_reference_take(set);
  for (int32_t c = 0; c < mpmi_stress_components(set->grid->dim); ++c)
    memcpy(mpmi_f64(set, MPMI_STRESS, 0) + c * set->ld, mpmi_f64(set, MPMI_STRESS, 1) + c * set->ld,
           (size_t)set->slots * sizeof(double));
  set->dirty |= MPMI_DIRTY_ACCELERATION;
}

mpm_status mpm_particles_set_geostatic(mpm_particles *particles, int32_t axis, double gravity, double surface,
                                       double K0, double surcharge) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  const ground g = {axis, gravity, surface, K0, surcharge};
  mpm_status status = mpmi_particles_changeable(particles);
  if (!status) status = check_ground(particles, &g);
  if (!status) status = check_law(particles, &g);
  if (!status) status = mpmi_particles_check_suspects(particles);
  if (!status) status = mpmi_particles_refresh(particles);
  if (status || !particles->slots) return status;
  const int32_t keeps = !mpmi_material_stress_from_F(particles->material);
  mpmi_reference_begin(particles);
  if ((status = find_stress(particles, &g))) return status;
  status = keeps && rest_of(particles) == MPMI_REST_BY_KIND ? mpmi_reference_fits_host(particles)
                                                            : find_F(particles);
  if (!status) take(particles);
  return status;
}
