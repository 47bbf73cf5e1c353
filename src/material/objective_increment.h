/* Kinematics that linear_elastic, j2 and newtonian_fluid share. With the increment F_inc = V R (polar
 * decomposition) the strain increment is ln V, and the stress of solids turns with R: rotations leave no
 * stress behind, whatever the size of the step. G = F_inc - I is taken as dt L, so that small increments keep
 * their digits. */
#ifndef MPMI_OBJECTIVE_INCREMENT_H
#define MPMI_OBJECTIVE_INCREMENT_H

#include <math.h>
#include <string.h>

#include "material/elastic_constants.h"
#include "material/isotropic_function.h"
#include "material/isotropic_series.h"
#include "simd/lanes.h"
#include "simd/tensor.h"
#include "simd/vector_math.h"

/* ---- one increment ------------------------------------------------------------------------------------ */
/* What is known of V V = I + e in the plane: e has the eigenvalues mean + d and mean - d, d^2 = half^2 +
 * shear^2. */
typedef struct mpmi_plane_stretch {
  double mean, half, shear, half_trace; /* half of tr(ln V) */
  double square;                        /* det(V V) */
} mpmi_plane_stretch;

MPMI_INLINE mpmi_plane_stretch mpmi_plane_stretch_of(mpmi_sym e, double square, double half_trace) {
  mpmi_plane_stretch s = {0.5 * (e.xx + e.yy), 0.5 * (e.xx - e.yy), e.xy, half_trace, square};
  return s;
}

MPMI_INLINE mpmi_plane_stretch mpmi_plane_stretch_by(mpmi_mat g) {
  double det_minus_1 = mpmi_det_minus_1(2, g), det = 1.0 + det_minus_1;
  return mpmi_plane_stretch_of(mpmi_left_cauchy_green_minus_1(2, g), det * det,
                               0.5 * mpmi_lane_log1p(det_minus_1));
}

/* Returns (d / (1 + mean))^2. */
MPMI_INLINE double mpmi_plane_ratio_squared(mpmi_plane_stretch s) {
  double inverse = 1.0 / (1.0 + s.mean);
  return (s.half * s.half + s.shear * s.shear) * inverse * inverse;
}

/* ln V = half_trace I + slope (e - mean I), with slope = 1/(4 d) ln((1 + mean + d) / (1 + mean - d)). */
MPMI_INLINE mpmi_sym mpmi_plane_log_stretch(mpmi_plane_stretch s, double slope) {
  mpmi_sym v = {s.half_trace + slope * s.half, s.half_trace - slope * s.half, 0.0, slope * s.shear, 0.0, 0.0};
  return v;
}

/* The tiny number keeps d from 0 without changing the slope. */
MPMI_INLINE double mpmi_plane_slope(mpmi_plane_stretch s) {
  double d = sqrt((s.half * s.half + s.shear * s.shear) + 1e-60);
  double ratio_minus_1 = 2.0 * d * (1.0 + s.mean + d) / s.square;
  return 0.25 * mpmi_lane_log1p(ratio_minus_1) / d;
}

/* The same where z = (d / (1 + mean))^2 is small: artanh(sqrt z) / sqrt z by its series. */
MPMI_INLINE double mpmi_small_plane_slope(mpmi_plane_stretch s, double z) {
  return (0.5 + 0.25 * mpmi_log_series(z)) / (1.0 + s.mean);
}

/* Returns R S R^T in the plane. V is symmetric when R turns by the angle whose cosine and sine are as along
 * and across. Written as a change of the stress, so that no rotation leaves it as it is. */
MPMI_INLINE mpmi_sym mpmi_turned_in_plane(mpmi_mat g, mpmi_sym stress) {
  double along = 2.0 + (g.xx + g.yy), across = g.yx - g.xy;
  double turn = 2.0 * across / (along * along + across * across);
  double half = 0.5 * (stress.xx - stress.yy), shear = stress.xy;
  double shift = turn * (along * shear + across * half);
  stress.xx -= shift;
  stress.yy += shift;
  stress.xy += turn * (along * half - across * shear);
  return stress;
}

/* Returns R = V^-1 F_inc = W + W G. */
MPMI_INLINE mpmi_mat mpmi_turn_of(mpmi_sym w, mpmi_mat g) {
  mpmi_mat r = {
      w.xx + w.xx * g.xx + w.xy * g.yx + w.xz * g.zx, w.xy + w.xx * g.xy + w.xy * g.yy + w.xz * g.zy,
      w.xz + w.xx * g.xz + w.xy * g.yz + w.xz * g.zz, w.xy + w.xy * g.xx + w.yy * g.yx + w.yz * g.zx,
      w.yy + w.xy * g.xy + w.yy * g.yy + w.yz * g.zy, w.yz + w.xy * g.xz + w.yy * g.yz + w.yz * g.zz,
      w.xz + w.xz * g.xx + w.yz * g.yx + w.zz * g.zx, w.yz + w.xz * g.xy + w.yz * g.yy + w.zz * g.zy,
      w.zz + w.xz * g.xz + w.yz * g.yz + w.zz * g.zz};
  return r;
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

/* What an increment is: ln V, and the stress turned with R. */
typedef struct mpmi_log_increment {
  mpmi_sym log_v, turned;
} mpmi_log_increment;

/* Returns the increment of G if it is small: where *size is at most MPMI_SMALL_INCREMENT(dim). In 1-D all
 * are. */
#define MPMI_SMALL_INCREMENT(dim) ((dim) == 3 ? MPMI_SMALL_SQUARE : MPMI_LOG_SERIES_END)
MPMI_INLINE mpmi_log_increment mpmi_small_increment(int dim, mpmi_mat g, mpmi_sym stress, double *size) {
  mpmi_log_increment o = {{0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, stress};
  if (dim == 3) {
    mpmi_sym e = mpmi_left_cauchy_green_minus_1(3, g);
    mpmi_powers of = mpmi_powers_of(e);
    *size = of.square.xx + of.square.yy + of.square.zz;
    o.log_v = mpmi_small_log_stretch(e, &of);
    o.turned = mpmi_turned(mpmi_turn_of(mpmi_small_inverse_stretch(e, &of), g), stress);
  } else if (dim == 2) {
    mpmi_plane_stretch s = mpmi_plane_stretch_by(g);
    *size = mpmi_plane_ratio_squared(s);
    o.log_v = mpmi_plane_log_stretch(s, mpmi_small_plane_slope(s, *size));
    o.turned = mpmi_turned_in_plane(g, stress);
  } else {
    *size = 0.0;
    o.log_v.xx = mpmi_lane_log1p(g.xx);
  }
  return o;
}

/* Returns it whatever its size; in 2-D and 3-D alone. */
MPMI_INLINE mpmi_log_increment mpmi_any_increment(int dim, mpmi_mat g, mpmi_sym stress) {
  mpmi_log_increment o;
  if (dim == 3) {
    mpmi_sym e = mpmi_left_cauchy_green_minus_1(3, g);
    mpmi_eigenvalue_nodes n = mpmi_eigenvalues(e);
    mpmi_sym q = mpmi_quadratic(e, n);
    o.log_v = mpmi_log_stretch(e, q, n);
    o.turned = mpmi_turned(mpmi_turn_of(mpmi_inverse_stretch(e, q, n), g), stress);
  } else {
    mpmi_plane_stretch s = mpmi_plane_stretch_by(g);
    o.log_v = mpmi_plane_log_stretch(s, mpmi_plane_slope(s));
    o.turned = mpmi_turned_in_plane(g, stress);
  }
  return o;
}

/* ---- the increments of a chunk ------------------------------------------------------------------------ */
/* What they are made of. It is read before the loops, so that the compiler sees that no store changes it. The
 * stress is turned where that is asked for. */
typedef struct mpmi_increments {
  const double *L, *stress;
  int64_t ld;
  double dt;
  int turns;
} mpmi_increments;

MPMI_INLINE mpmi_increments mpmi_increments_of(const mpm_material_batch *batch) {
  mpmi_increments in = {batch->L, batch->stress, batch->ld, batch->dt, 1};
  return in;
}

/* Returns the stress that particle i brings to its increment. */
MPMI_INLINE mpmi_sym mpmi_stress_before(int dim, mpmi_increments in, int64_t i) {
  mpmi_sym none = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  return in.turns ? mpmi_load_sym(dim, in.stress, in.ld, i) : none;
}

typedef struct mpmi_increment_rows {
  _Alignas(64) double log_v[6][MPMI_CHUNK], turned[6][MPMI_CHUNK];
} mpmi_increment_rows;

MPMI_INLINE mpmi_sym mpmi_selected(int32_t first, mpmi_sym a, mpmi_sym b) {
  mpmi_sym s = {first ? a.xx : b.xx, first ? a.yy : b.yy, first ? a.zz : b.zz,
                first ? a.xy : b.xy, first ? a.yz : b.yz, first ? a.xz : b.xz};
  return s;
}

/* Tells whether a size of a chunk is above a bound, or not a number. */
MPMI_INLINE int32_t mpmi_has_larger(const double *size, double bound) {
  uint32_t larger = 0;
  for (int p = 0; p < MPMI_CHUNK; p += MPMI_LANES)
    larger |= mpmi_lanes_any(~(mpmi_lanes_load(size + p) <= bound), 1);
  return larger != 0;
}

/* Finds the increments of the chunk from particle `begin` on. Those of a step are mostly small; where one is
 * not, all are found both ways and each is taken by its own size, so that it does not depend on others. */
MPMI_INLINE void mpmi_find_increments(int dim, mpmi_increments in, int64_t begin, mpmi_increment_rows *out) {
  const double small = MPMI_SMALL_INCREMENT(dim);
  _Alignas(64) double size[MPMI_CHUNK];
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    mpmi_mat g = mpmi_load_mat(dim, in.L, in.ld, begin + p, 0.0, in.dt);
    mpmi_log_increment o = mpmi_small_increment(dim, g, mpmi_stress_before(dim, in, begin + p), &size[p]);
    mpmi_store_sym(dim, out->log_v[0], MPMI_CHUNK, p, o.log_v);
    if (in.turns) mpmi_store_sym(dim, out->turned[0], MPMI_CHUNK, p, o.turned);
  }
  if (dim == 1 || !mpmi_has_larger(size, small)) return;
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    mpmi_mat g = mpmi_load_mat(dim, in.L, in.ld, begin + p, 0.0, in.dt);
    mpmi_log_increment o = mpmi_any_increment(dim, g, mpmi_stress_before(dim, in, begin + p));
    mpmi_sym v = mpmi_load_sym(dim, out->log_v[0], MPMI_CHUNK, p);
    mpmi_store_sym(dim, out->log_v[0], MPMI_CHUNK, p, mpmi_selected(size[p] <= small, v, o.log_v));
    if (!in.turns) continue;
    mpmi_sym s = mpmi_load_sym(dim, out->turned[0], MPMI_CHUNK, p);
    mpmi_store_sym(dim, out->turned[0], MPMI_CHUNK, p, mpmi_selected(size[p] <= small, s, o.turned));
  }
}

/* Returns the old stress turned, plus lambda tr(ln V) I + 2 mu ln V, of particle p of the chunk. */
MPMI_INLINE mpmi_sym mpmi_trial_stress(int dim, double lambda, double mu, const mpmi_increment_rows *of,
                                       int p) {
  mpmi_sym s = mpmi_load_sym(dim, of->turned[0], MPMI_CHUNK, p);
  mpmi_sym v = mpmi_load_sym(dim, of->log_v[0], MPMI_CHUNK, p);
  double pressure = lambda * (v.xx + v.yy + v.zz), mu2 = 2.0 * mu;
  s.xx += pressure + mu2 * v.xx;
  s.yy += pressure + mu2 * v.yy;
  s.zz += pressure + mu2 * v.zz;
  s.xy += mu2 * v.xy;
  s.yz += mu2 * v.yz;
  s.xz += mu2 * v.xz;
  return s;
}

/* ---- stress and energy -------------------------------------------------------------------------------- */
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
