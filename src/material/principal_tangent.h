/* Tangents of laws in the principal frame (principal_frame.h), for a chunk of particles. With the principal
 * values beta_A of b_trial, its unit vectors n_A, the returned stresses tau_A and a_AB = d tau_A / d e_B
 * (Simo 1998, section 46):
 *
 *   c = sum (a_AB - 2 tau_A d_AB) m_A m_B + sum_A<B g_AB s_AB s_AB,  m_A = n_A n_A, s_AB = n_A n_B + n_B n_A,
 *   g_AB = (tau_A beta_B - tau_B beta_A) / (beta_A - beta_B). */
#ifndef MPMI_PRINCIPAL_TANGENT_H
#define MPMI_PRINCIPAL_TANGENT_H

#include "material/principal_axes.h"
#include "material/principal_frame.h"
#include "simd/chunk.h"

typedef struct mpmi_principal {
  _Alignas(64) double b[3][MPMI_CHUNK]; /* beta_A - 1; of the third axis in 1-D and 2-D, too */
  double strain[3][MPMI_CHUNK];         /* 1/2 ln beta_A: the trial */
  double vector[3][3][MPMI_CHUNK];      /* n_A by A, then component */
  double tau[3][MPMI_CHUNK];            /* set by the law */
  double slope[3][3][MPMI_CHUNK];       /* a_AB, set by the law */
  double J_inverse[MPMI_CHUNK];
} mpmi_principal;

/* Finds principal values and vectors of b - I of particle p of a chunk. */
MPMI_INLINE void mpmi_principal_set(int dim, mpmi_principal *o, int p, mpmi_sym b) {
  mpmi_axes axes = mpmi_principal_axes(dim, b);
  for (int k = 0; k < 3; ++k) {
    o->b[k][p] = axes.value[k];
    for (int i = 0; i < 3; ++i) o->vector[k][i][p] = axes.vector[k][i];
  }
}

/* The same for b_trial, and the trial strain. */
MPMI_INLINE void mpmi_principal_find(int dim, mpmi_principal *o, int p, mpmi_sym b, double J) {
  double held = mpmi_elastic_range(b);
  mpmi_principal_set(dim, o, p, b);
  for (int k = 0; k < 3; ++k) o->strain[k][p] = 0.5 * mpmi_lane_log1p(o->b[k][p]);
  o->strain[0][p] = held > 0.0 ? o->strain[0][p] : (double)NAN;
  o->J_inverse[p] = 1.0 / J;
}

/* Does so for a chunk of a law that is linear in the strain. */
MPMI_INLINE void mpmi_principal_load(int dim, mpmi_principal *o, mpmi_frame frame, int64_t begin) {
  mpmi_trial_rows trial;
  mpmi_start_trials(dim, frame, begin, &trial);
  mpmi_find_b(dim, frame.in, begin, &trial);
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p)
    mpmi_principal_find(dim, o, p, mpmi_load_sym(dim, trial.b[0], MPMI_CHUNK, p), trial.J[p]);
}

/* Writes the stress of a chunk, once the law has set tau; stress points at the first particle in row 0. */
MPMI_INLINE void mpmi_principal_stress(int dim, const mpmi_principal *o, double *stress, int64_t ld) {
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    mpmi_sym s = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    for (int k = 0; k < 3; ++k) {
      double x = o->vector[k][0][p], y = o->vector[k][1][p], z = o->vector[k][2][p];
      double t = o->tau[k][p] * o->J_inverse[p];
      s.xx += t * x * x, s.yy += t * y * y, s.zz += t * z * z;
      s.xy += t * x * y, s.yz += t * y * z, s.xz += t * x * z;
    }
    mpmi_store_sym(dim, stress, ld, p, s);
  }
}

/* What a law that returns radially sees of a particle: the trial strain as volume and deviator. */
typedef struct mpmi_radial {
  double volume, size; /* size: |d| */
  double d[3], n[3];   /* n = d / |d|, or 0 */
} mpmi_radial;

MPMI_INLINE mpmi_radial mpmi_radial_of(const mpmi_principal *o, int p) {
  mpmi_radial r;
  double square = 0.0;
  r.volume = o->strain[0][p] + o->strain[1][p] + o->strain[2][p];
  MPMI_UNROLL for (int a = 0; a < 3; ++a) {
    r.d[a] = o->strain[a][p] - (1.0 / 3.0) * r.volume;
    square += r.d[a] * r.d[a];
  }
  r.size = sqrt(square);
  double inverse = square > 0.0 ? 1.0 / r.size : 0.0;
  MPMI_UNROLL for (int a = 0; a < 3; ++a) r.n[a] = inverse * r.d[a];
  return r;
}

/* tau = mean I + shear d, a_AB = bulk + shear Dev + along n n + across n 1. */
MPMI_INLINE void mpmi_radial_set(mpmi_principal *o, int p, const mpmi_radial *r, double mean, double bulk,
                                 double shear, double along, double across) {
  for (int a = 0; a < 3; ++a) {
    o->tau[a][p] = mean + shear * r->d[a];
    for (int b = 0; b < 3; ++b)
      o->slope[a][b][p] =
          bulk + shear * ((a == b) - 1.0 / 3.0) + (along * r->n[a] * r->n[b] + across * r->n[a]);
  }
}

/* Writes c for a chunk, once the law has set tau and slope; tangent points at the first particle in row 0. */
void KERNEL(principal_rows)(int32_t dim, const mpmi_principal *o, double *tangent, int64_t ld);

#endif
