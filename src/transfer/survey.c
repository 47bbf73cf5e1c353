/* Energies, momenta and the stable rate of a batch, and a look at what the law returned. */
#include "transfer/kernel_common.h"

/* Second moment D of the basis at x, for the affine part of the angular momentum. */
MPMI_INLINE double second_moment(int32_t order, double xi, double spacing) {
  double f = xi - mpmi_floor(xi);
  return (order == 1 ? f * (1.0 - f) : 0.25) * spacing * spacing;
}

/* m (x x v + sum_k D_k e_k x C e_k): component r of the angular momentum, with a, b the two other axes. */
MPMI_INLINE void angular(int32_t dim, const mpmi_survey *job, int64_t s, int32_t r, mpmi_lanes *sum) {
  const int32_t a = (r + 1) % 3, b = (r + 2) % 3;
  if (a >= dim || b >= dim) return;
  const double *m = job->mass + s, *xa = job->x[a] + s, *xb = job->x[b] + s, *va = job->v[a] + s,
               *vb = job->v[b] + s;
  MPMI_IVDEP for (int32_t i = 0; i < MPMI_GROUP; ++i) sum->at[i] += m[i] * (xa[i] * vb[i] - xb[i] * va[i]);
  if (!job->affine[0]) return;
  const double *Cba = job->affine[3 * b + a] + s, *Cab = job->affine[3 * a + b] + s;
  MPMI_IVDEP for (int32_t i = 0; i < MPMI_GROUP; ++i) {
    double da =
        second_moment(job->order, (xa[i] - job->origin[a]) * job->inverse_spacing[a], job->spacing[a]);
    double db =
        second_moment(job->order, (xb[i] - job->origin[b]) * job->inverse_spacing[b], job->spacing[b]);
    sum->at[i] += m[i] * (da * Cba[i] - db * Cab[i]);
  }
}

MPMI_INLINE uint32_t survey(int32_t dim, const mpmi_survey *job, int64_t n, mpmi_sums *sums) {
  mpmi_lanes kinetic = {{0.0}}, strain = {{0.0}}, work = {{0.0}}, rate = {{0.0}}, viscous = {{0.0}},
             bad = {{0.0}};
  mpmi_lanes momentum[3] = {{{0.0}}}, moment[3] = {{{0.0}}};
  for (int64_t s = 0; s < mpmi_groups(n); s += MPMI_GROUP) {
    const double *m = job->mass + s, *v0 = job->initial_volume + s, *c = job->wave_speed + s;
    const double *nu = job->kinematic_viscosity + s, *energy = job->energy + s;
    MPMI_IVDEP for (int32_t i = 0; i < MPMI_GROUP; ++i) {
      double live = v0[i] > 0.0 ? 1.0 : 0.0;
      double e = live > 0.0 ? energy[i] : 0.0;
      strain.at[i] += v0[i] * e;
      bad.at[i] += live * ((c[i] - c[i]) + (nu[i] - nu[i]));
      double slow = live * nu[i] * job->viscous_factor;
      viscous.at[i] = slow > viscous.at[i] ? slow : viscous.at[i];
    }
    for (int32_t k = 0; k < dim; ++k) {
      const double *v = job->v[k] + s;
      MPMI_IVDEP for (int32_t i = 0; i < MPMI_GROUP; ++i) {
        double p = m[i] * v[i];
        momentum[k].at[i] += p;
        kinetic.at[i] += 0.5 * p * v[i];
        double live = v0[i] > 0.0 ? 1.0 : 0.0;
        double speed = v[i] < 0.0 ? -v[i] : v[i];
        double fast = live * (speed + c[i]) * job->inverse_spacing[k];
        rate.at[i] = fast > rate.at[i] ? fast : rate.at[i];
      }
      if (job->x_old[0]) {
        const double *x = job->x[k] + s, *x_old = job->x_old[k] + s;
        if (job->gravity[k] != 0.0) MPMI_IVDEP for (int32_t i = 0; i < MPMI_GROUP; ++i) {
            double d = x[i] - x_old[i];
            d -= job->period[k] * mpmi_round(d * job->inverse_period[k]);
            work.at[i] += m[i] * job->gravity[k] * d;
          }
        if (job->force[0]) {
          const double *f = job->force[k] + s;
          MPMI_IVDEP for (int32_t i = 0; i < MPMI_GROUP; ++i) {
            double d = x[i] - x_old[i];
            d -= job->period[k] * mpmi_round(d * job->inverse_period[k]);
            work.at[i] += f[i] * d;
          }
        }
      }
    }
    for (int32_t a = 0; a < 2; ++a)
      for (int32_t r = 0; r < job->checked_rows[a]; ++r) {
        const double *value = job->checked[a] + r * job->ld + s;
        MPMI_IVDEP for (int32_t i = 0; i < MPMI_GROUP; ++i) bad.at[i] += value[i] - value[i];
      }
    for (int32_t r = 0; r < 3; ++r) angular(dim, job, s, r, &moment[r]);
  }
  sums->kinetic += mpmi_lane_sum(&kinetic);
  sums->strain += mpmi_lane_sum(&strain);
  sums->work += mpmi_lane_sum(&work);
  for (int32_t k = 0; k < 3; ++k) {
    sums->momentum[k] += mpmi_lane_sum(&momentum[k]);
    sums->angular[k] += mpmi_lane_sum(&moment[k]);
  }
  const double fast = mpmi_lane_max(&rate), slow = mpmi_lane_max(&viscous);
  if (fast > sums->rate) sums->rate = fast;
  if (slow > sums->viscous_rate) sums->viscous_rate = slow;
  return mpmi_lane_sum(&bad) == 0.0 ? 0u : (uint32_t)MPMI_NONFINITE;
}

#define SURVEY(dim)                                                                                          \
  uint32_t KERNEL(survey_##dim)(const mpmi_survey *job, int64_t n, mpmi_sums *sums);                         \
  uint32_t KERNEL(survey_##dim)(const mpmi_survey *job, int64_t n, mpmi_sums *sums) {                        \
    return survey(dim, job, n, sums);                                                                        \
  }
SURVEY(1)
SURVEY(2)
SURVEY(3)
