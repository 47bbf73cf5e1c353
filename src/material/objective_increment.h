/* Kinematics that linear_elastic, j2 and newtonian_fluid share. With the increment F_inc = V R (polar
 * decomposition) the stress turns with R and the strain increment is ln V: rotations leave no stress behind,
 * whatever the size of the step. G = F_inc - I is taken as dt L, so that small increments keep their digits.
 */
#ifndef MPMI_OBJECTIVE_INCREMENT_H
#define MPMI_OBJECTIVE_INCREMENT_H

#include <math.h>
#include <string.h>

#include "material/elastic_constants.h"
#include "material/isotropic_function.h"
#include "simd/tensor.h"
#include "simd/vector_math.h"

/* Returns ln V in the plane for V V = I + e, with det(V V) and half the trace of ln V. With the eigenvalues
 * m + d and m - d of e, ln V = half_trace I + s (e - m I) with s = 1/(4 d) ln((1 + m + d) / (1 + m - d)). The
 * tiny number keeps d from 0 without changing s. */
MPMI_INLINE mpmi_sym mpmi_log_stretch_2d(mpmi_sym e, double square, double half_trace) {
  double m = 0.5 * (e.xx + e.yy), h = 0.5 * (e.xx - e.yy);
  double d = sqrt((h * h + e.xy * e.xy) + 1e-60);
  double ratio_minus_1 = 2.0 * d * (1.0 + m + d) / square;
  double slope = 0.25 * mpmi_lane_log1p(ratio_minus_1) / d;
  mpmi_sym log_v = {half_trace + slope * h, half_trace - slope * h, 0.0, slope * e.xy, 0.0, 0.0};
  return log_v;
}

/* Does what mpmi_log_increment() does, in 2-D. */
MPMI_INLINE mpmi_sym mpmi_increment_2d(mpmi_mat g, mpmi_sym *stress) {
  /* V is symmetric when R turns by the angle whose cosine and sine are as along and across. Written as a
   * change of the stress, so that no rotation leaves it as it is. */
  double along = 2.0 + (g.xx + g.yy), across = g.yx - g.xy;
  double turn = 2.0 * across / (along * along + across * across);
  double half = 0.5 * (stress->xx - stress->yy), shear = stress->xy;
  double shift = turn * (along * shear + across * half);
  stress->xx -= shift;
  stress->yy += shift;
  stress->xy += turn * (along * half - across * shear);

  double det_minus_1 = mpmi_det_minus_1(2, g), det = 1.0 + det_minus_1;
  return mpmi_log_stretch_2d(mpmi_left_cauchy_green_minus_1(2, g), det * det,
                             0.5 * mpmi_lane_log1p(det_minus_1));
}

/* Returns R S R^T. */
MPMI_INLINE mpmi_sym mpmi_turned(mpmi_mat r, mpmi_sym s) {
  mpmi_mat a = {r.xx * s.xx + r.xy * s.xy + r.xz * s.xz, r.xx * s.xy + r.xy * s.yy + r.xz * s.yz,
                r.xx * s.xz + r.xy * s.yz + r.xz * s.zz, r.yx * s.xx + r.yy * s.xy + r.yz * s.xz,
                r.yx * s.xy + r.yy * s.yy + r.yz * s.yz, r.yx * s.xz + r.yy * s.yz + r.yz * s.zz,
                r.zx * s.xx + r.zy * s.xy + r.zz * s.xz, r.zx * s.xy + r.zy * s.yy + r.zz * s.yz,
                r.zx * s.xz + r.zy * s.yz + r.zz * s.zz};
  mpmi_sym t = {a.xx * r.xx + a.xy * r.xy + a.xz * r.xz, a.yx * r.yx + a.yy * r.yy + a.yz * r.yz,
                a.zx * r.zx + a.zy * r.zy + a.zz * r.zz, a.xx * r.yx + a.xy * r.yy + a.xz * r.yz,
                a.yx * r.zx + a.yy * r.zy + a.yz * r.zz, a.xx * r.zx + a.xy * r.zy + a.xz * r.zz};
  return t;
}

/* Does what mpmi_log_increment() does, in 3-D. */
MPMI_INLINE mpmi_sym mpmi_increment_3d(mpmi_mat g, mpmi_sym *stress) {
  mpmi_sym e = mpmi_left_cauchy_green_minus_1(3, g);
  mpmi_eigenvalue_nodes n = mpmi_eigenvalues(e);
  mpmi_sym q = mpmi_quadratic(e, n), w = mpmi_inverse_stretch(e, q, n);
  /* R = V^-1 F_inc = V^-1 + V^-1 G */
  mpmi_mat r = {
      w.xx + w.xx * g.xx + w.xy * g.yx + w.xz * g.zx, w.xy + w.xx * g.xy + w.xy * g.yy + w.xz * g.zy,
      w.xz + w.xx * g.xz + w.xy * g.yz + w.xz * g.zz, w.xy + w.xy * g.xx + w.yy * g.yx + w.yz * g.zx,
      w.yy + w.xy * g.xy + w.yy * g.yy + w.yz * g.zy, w.yz + w.xy * g.xz + w.yy * g.yz + w.yz * g.zz,
      w.xz + w.xz * g.xx + w.yz * g.yx + w.zz * g.zx, w.yz + w.xz * g.xy + w.yz * g.yy + w.zz * g.zy,
      w.zz + w.xz * g.xz + w.yz * g.yz + w.zz * g.zz};
  *stress = mpmi_turned(r, *stress);
  return mpmi_log_stretch(e, q, n);
}

/* Turns the stress with R and returns ln V; g = F_inc - I. */
MPMI_INLINE mpmi_sym mpmi_log_increment(int dim, mpmi_mat g, mpmi_sym *stress) {
  mpmi_sym v = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  if (dim == 2) return mpmi_increment_2d(g, stress);
  if (dim == 3) return mpmi_increment_3d(g, stress);
  v.xx = mpmi_lane_log1p(g.xx);
  return v;
}

/* Holds what the trial stress needs. It is read before the loop, so that the compiler sees that no store
 * changes it. */
typedef struct mpmi_increments {
  const double *L, *stress;
  int64_t ld;
  double dt, lambda, mu;
} mpmi_increments;

MPMI_INLINE mpmi_increments mpmi_increments_of(const mpmi_elastic *c, const mpm_material_batch *batch) {
  mpmi_increments in = {batch->L, batch->stress, batch->ld, batch->dt, c->lambda, c->mu};
  return in;
}

/* Returns the old stress turned, plus lambda tr(ln V) I + 2 mu ln V. */
MPMI_INLINE mpmi_sym mpmi_trial_stress(int dim, mpmi_increments in, int64_t i) {
  mpmi_sym s = mpmi_load_sym(dim, in.stress, in.ld, i);
  mpmi_sym v = mpmi_log_increment(dim, mpmi_load_mat(dim, in.L, in.ld, i, 0.0, in.dt), &s);
  double pressure = in.lambda * (v.xx + v.yy + v.zz), mu2 = 2.0 * in.mu;
  s.xx += pressure + mu2 * v.xx;
  s.yy += pressure + mu2 * v.yy;
  s.zz += pressure + mu2 * v.zz;
  s.xy += mu2 * v.xy;
  s.yz += mu2 * v.yz;
  s.xz += mu2 * v.xz;
  return s;
}

/* Returns the deviator of s; a third of the trace goes to *mean. */
MPMI_INLINE mpmi_sym mpmi_deviator(mpmi_sym s, double *mean) {
  *mean = (s.xx + s.yy + s.zz) * (1.0 / 3.0);
  mpmi_sym d = {s.xx - *mean, s.yy - *mean, s.zz - *mean, s.xy, s.yz, s.xz};
  return d;
}

MPMI_INLINE double mpmi_square(mpmi_sym s) {
  return 2.0 * (s.xy * s.xy + s.yz * s.yz + s.xz * s.xz) + s.xx * s.xx + s.yy * s.yy + s.zz * s.zz;
}

/* Computes the squared elastic wave speed at the current density, and the energy J/2 stress : S : stress per
 * initial volume. */
MPMI_INLINE void mpmi_elastic_outputs(int dim, const mpmi_elastic *c, const mpm_material_batch *batch) {
  const double p_wave = c->p_wave_squared;
  const double by_mean = c->mean_energy, by_deviator = c->shear_energy;
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const double *deformation = batch->F, *stress = batch->stress_new;
  double *wave_speed_squared = batch->wave_speed, *energy = batch->energy;
  MPMI_IVDEP
  for (int64_t i = 0; i < n; ++i) {
    double j = 1.0 + mpmi_J_minus_1(dim, mpmi_load_F_minus_1(dim, deformation, ld, i)), mean;
    mpmi_sym s = mpmi_deviator(mpmi_load_sym(dim, stress, ld, i), &mean);
    wave_speed_squared[i] = p_wave * j;
    energy[i] = j * (by_mean * mean * mean + by_deviator * mpmi_square(s));
  }
}

/* Gives rows back bit for bit: dt = 0 asks about the state as it is. */
MPMI_INLINE void mpmi_keep_rows(int64_t rows, const double *from, double *to,
                                const mpm_material_batch *batch) {
  for (int64_t c = 0; c < rows; ++c)
    memcpy(to + c * batch->ld, from + c * batch->ld, (size_t)batch->n * sizeof *to);
}

/* Does so for the stress and the state variables where dt = 0, and returns 1 there. */
MPMI_INLINE int mpmi_keeps_state(int dim, int64_t states, const mpm_material_batch *batch) {
  if (batch->dt != 0.0) return 0;
  mpmi_keep_rows(mpmi_stress_components(dim), batch->stress, batch->stress_new, batch);
  mpmi_keep_rows(states, batch->state, batch->state_new, batch);
  return 1;
}

#endif
