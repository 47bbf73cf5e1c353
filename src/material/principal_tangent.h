/* Tangents of laws in the principal frame (principal_frame.h), for a chunk of particles. With the principal
 * values beta_A of b_trial, its unit vectors n_A, the returned stresses tau_A and a_AB = d tau_A / d e_B
 * (Simo 1998, section 46):
 *
 *   c = sum (a_AB - 2 tau_A d_AB) m_A m_B + sum_A<B g_AB s_AB s_AB,  m_A = n_A n_A, s_AB = n_A n_B + n_B n_A,
 *   g_AB = (tau_A beta_B - tau_B beta_A) / (beta_A - beta_B). */
#ifndef MPMI_PRINCIPAL_TANGENT_H
#define MPMI_PRINCIPAL_TANGENT_H

#include "material/principal_frame.h"
#include "simd/chunk.h"

typedef struct mpmi_principal {
  _Alignas(64) double b[3][MPMI_CHUNK]; /* beta_A - 1; of the third axis in 1-D and 2-D, too */
  double strain[3][MPMI_CHUNK];         /* 1/2 ln beta_A: the trial */
  double vector[3][3][MPMI_CHUNK];      /* n_A by A, then component */
  double tau[3][MPMI_CHUNK];            /* set by the law */
  double slope[3][3][MPMI_CHUNK];       /* a_AB, set by the law */
} mpmi_principal;

/* Turns two axes so that b has no shear between them: Jacobi's rotation. */
MPMI_INLINE void mpmi_turn_axes(mpmi_principal *o, double (*shear)[MPMI_CHUNK], int p, int one, int two) {
  const int third = 3 - one - two;
  double *of_third_one = shear[two], *of_third_two = shear[one]; /* shear[A] is that of the other two axes */
  double between = shear[third][p], apart = o->b[two][p] - o->b[one][p];
  double t = 2.0 * between / (fabs(apart) + sqrt(apart * apart + 4.0 * between * between + 1e-300));
  t = apart < 0.0 ? -t : t;
  double c = 1.0 / sqrt(1.0 + t * t), s = t * c;
  o->b[one][p] -= t * between;
  o->b[two][p] += t * between;
  shear[third][p] = 0.0;
  double x = of_third_one[p], y = of_third_two[p];
  of_third_one[p] = c * x - s * y;
  of_third_two[p] = s * x + c * y;
  for (int k = 0; k < 3; ++k) {
    double u = o->vector[one][k][p], v = o->vector[two][k][p];
    o->vector[one][k][p] = c * u - s * v;
    o->vector[two][k][p] = s * u + c * v;
  }
}

/* Finds principal values and vectors of b_trial of a chunk, by rounds of rotations, and the trial strain. */
MPMI_INLINE void mpmi_principal_load(int dim, mpmi_principal *o, mpmi_frame in, int64_t begin) {
  enum { ROUNDS = 6 }; /* the shear is squared with each: 1e-16 is reached in 5 */
  _Alignas(64) double shear[3][MPMI_CHUNK];
  memset(o->vector, 0, sizeof o->vector);
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    mpmi_sym b = mpmi_trial_b(dim, in, begin + p, mpmi_frame_J(dim, in, begin + p));
    o->b[0][p] = b.xx, o->b[1][p] = b.yy, o->b[2][p] = b.zz;
    shear[0][p] = b.yz, shear[1][p] = b.xz, shear[2][p] = b.xy;
    for (int k = 0; k < 3; ++k) o->vector[k][k][p] = 1.0;
  }
  for (int round = 0; round < (dim == 3 ? ROUNDS : dim == 2); ++round)
    for (int pair = dim == 3 ? 0 : 2; pair < 3; ++pair) {
      MPMI_IVDEP
      for (int p = 0; p < MPMI_CHUNK; ++p) mpmi_turn_axes(o, shear, p, pair == 0, pair == 2 ? 1 : 2);
    }
  for (int k = 0; k < 3; ++k) {
    MPMI_IVDEP
    for (int p = 0; p < MPMI_CHUNK; ++p) o->strain[k][p] = 0.5 * mpmi_lane_log1p(o->b[k][p]);
  }
}

/* Writes c for a chunk, once the law has set tau and slope; tangent points at the first particle in row 0. */
void KERNEL(principal_rows)(int32_t dim, const mpmi_principal *o, double *tangent, int64_t ld);

#endif
