/* The frame of isotropic laws whose elasticity is one in the logarithmic strain and whose stress is the
 * state: the return of Simo (1992) in principal directions. With tau = J stress and F_inc of the step,
 *
 *   tau_old -> e = elastic strain of tau_old -> b = exp(2 e) -> b_trial = F_inc b F_inc^T -> 1/2 ln b_trial,
 *
 * from which the law returns to its yield surface. All of it is in terms of b - I and F_inc - I, so that
 * small steps keep their digits. Most laws are linear in e (Hencky); one that is not finds e of
 * mpmi_old_state() by itself, and goes on with mpmi_find_b(). */
#ifndef MPMI_PRINCIPAL_FRAME_H
#define MPMI_PRINCIPAL_FRAME_H

#include "material/objective_increment.h"

typedef struct mpmi_hencky {
  double bulk, mu, density_inverse;
  double by_mean, by_deviator; /* 1 / (3 bulk), 1 / (2 mu): strain of a mean stress, of a deviator */
  double p_wave;               /* bulk + 4/3 mu */
} mpmi_hencky;

/* For a law that has PARAMS_ELASTIC first. */
static inline mpmi_hencky mpmi_hencky_of(const double *value) {
  const double E = value[0], nu = value[1], density = value[2];
  const double mu = E / (2.0 * (1.0 + nu)), bulk = E / (3.0 * (1.0 - 2.0 * nu));
  mpmi_hencky c = {.bulk = bulk,
                   .mu = mu,
                   .density_inverse = 1.0 / density,
                   .by_mean = 1.0 / (3.0 * bulk),
                   .by_deviator = 1.0 / (2.0 * mu),
                   .p_wave = bulk + mpmi_rounded(4.0 / 3.0 * mu)};
  return c;
}

/* ---- functions of a symmetric tensor ------------------------------------------------------------------- */
/* Returns exp(2 e) - I. */
MPMI_INLINE mpmi_sym mpmi_exp_twice_3d(mpmi_sym e) {
  mpmi_eigenvalue_nodes n = mpmi_eigenvalues(e);
  mpmi_sym q = mpmi_quadratic(e, n);
  double f1 = mpmi_lane_expm1(2.0 * n.l1);
  double f12 = mpmi_lane_exp(2.0 * n.l2) * (mpmi_lane_expm1(2.0 * n.d12) / n.d12);
  double f23 = mpmi_lane_exp(2.0 * n.l3) * (mpmi_lane_expm1(2.0 * n.d23) / n.d23);
  return mpmi_interpolated(e, q, n.l1, f1, f12, (f12 - f23) / n.d13);
}

/* With the eigenvalues m + d and m - d of 2 e in the plane: exp(m) (cosh d I + sinh d / d (2 e - m I)). */
MPMI_INLINE mpmi_sym mpmi_exp_twice_2d(mpmi_sym e) {
  double m = e.xx + e.yy, h = e.xx - e.yy, shear = 2.0 * e.xy;
  double d = sqrt((h * h + shear * shear) + 1e-60), of_m = mpmi_lane_expm1(m), of_d = mpmi_lane_expm1(d);
  double exp_m = 1.0 + of_m, inverse = 1.0 / (1.0 + of_d);
  double cosh_minus_1 = 0.5 * of_d * of_d * inverse, sinh = 0.5 * (of_d + of_d * inverse);
  double mean = of_m + exp_m * cosh_minus_1, slope = exp_m * (sinh / d);
  mpmi_sym b = {mean + slope * h, mean - slope * h, mpmi_lane_expm1(2.0 * e.zz), slope * shear, 0.0, 0.0};
  return b;
}

MPMI_INLINE mpmi_sym mpmi_exp_twice(int dim, mpmi_sym e) {
  if (dim == 3) return mpmi_exp_twice_3d(e);
  if (dim == 2) return mpmi_exp_twice_2d(e);
  mpmi_sym b = {
      mpmi_lane_expm1(2.0 * e.xx), mpmi_lane_expm1(2.0 * e.yy), mpmi_lane_expm1(2.0 * e.zz), 0.0, 0.0, 0.0};
  return b;
}

/* Returns 1/2 ln(I + b). */
MPMI_INLINE mpmi_sym mpmi_half_log(int dim, mpmi_sym b) {
  mpmi_sym e = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  if (dim == 3) {
    mpmi_eigenvalue_nodes n = mpmi_eigenvalues(b);
    return mpmi_log_stretch(b, mpmi_quadratic(b, n), n);
  }
  if (dim == 2) {
    double square_minus_1 = (b.xx + b.yy) + (b.xx * b.yy - b.xy * b.xy);
    mpmi_plane_stretch s =
        mpmi_plane_stretch_of(b, 1.0 + square_minus_1, 0.25 * mpmi_lane_log1p(square_minus_1));
    e = mpmi_plane_log_stretch(s, mpmi_plane_slope(s));
    e.zz = 0.5 * mpmi_lane_log1p(b.zz);
    return e;
  }
  e.xx = 0.5 * mpmi_lane_log1p(b.xx);
  e.yy = 0.5 * mpmi_lane_log1p(b.yy);
  e.zz = 0.5 * mpmi_lane_log1p(b.zz);
  return e;
}

/* Returns F (I + b) F^T - I with F = I + g. */
MPMI_INLINE mpmi_sym mpmi_pushed_forward(int dim, mpmi_mat g, mpmi_sym b) {
  mpmi_sym e = mpmi_left_cauchy_green_minus_1(dim, g), c;
  mpmi_mat f = {1.0 + g.xx, g.xy, g.xz, g.yx, 1.0 + g.yy, g.yz, g.zx, g.zy, 1.0 + g.zz};
  if (dim == 3) {
    c = mpmi_turned(f, b);
    mpmi_sym sum = {e.xx + c.xx, e.yy + c.yy, e.zz + c.zz, e.xy + c.xy, e.yz + c.yz, e.xz + c.xz};
    return sum;
  }
  c = b;
  c.xx = f.xx * f.xx * b.xx + e.xx;
  if (dim == 1) return c;
  double x = f.xx * b.xx + f.xy * b.xy, y = f.xx * b.xy + f.xy * b.yy;
  double z = f.yx * b.xx + f.yy * b.xy, w = f.yx * b.xy + f.yy * b.yy;
  c.xx = (x * f.xx + y * f.xy) + e.xx;
  c.yy = (z * f.yx + w * f.yy) + e.yy;
  c.xy = (x * f.yx + y * f.yy) + e.xy;
  return c;
}

/* ---- before the step ----------------------------------------------------------------------------------- */
/* Holds what the trial state needs. It is read before the loop, so that the compiler sees that no store
 * changes it. */
typedef struct mpmi_trial {
  const double *F, *L, *stress;
  int64_t ld;
  double dt;
} mpmi_trial;

MPMI_INLINE mpmi_trial mpmi_trial_of(const mpm_material_batch *batch) {
  mpmi_trial in = {batch->F, batch->L, batch->stress, batch->ld, batch->dt};
  return in;
}

MPMI_INLINE double mpmi_trial_J(int dim, mpmi_trial in, int64_t i) {
  return 1.0 + mpmi_J_minus_1(dim, mpmi_load_F_minus_1(dim, in.F, in.ld, i));
}

/* A particle before the step, and F_inc - I of the step. */
typedef struct mpmi_old {
  mpmi_mat g;
  double J, mean; /* mean and deviator are those of the stress itself */
  mpmi_sym deviator;
} mpmi_old;

/* J is det F at the end of the step. */
MPMI_INLINE mpmi_old mpmi_old_state(int dim, mpmi_trial in, int64_t i, double J) {
  mpmi_old old;
  old.g = mpmi_load_mat(dim, in.L, in.ld, i, 0.0, in.dt);
  old.J = J / (1.0 + mpmi_det_minus_1(dim, old.g));
  old.deviator = mpmi_deviator(mpmi_load_sym(dim, in.stress, in.ld, i), &old.mean);
  return old;
}

/* > 0 where b - I can hold the elastic strain: stretches of 1e-5 to 1e4. A host's stress can leave that. */
MPMI_INLINE double mpmi_elastic_range(mpmi_sym b) {
  double least = mpmi_min(mpmi_min(b.xx, b.yy), b.zz), most = mpmi_max(mpmi_max(b.xx, b.yy), b.zz);
  return mpmi_min(1e8 - most, least - (1e-10 - 1.0));
}

/* ---- the trials of a chunk ----------------------------------------------------------------------------- */
/* The elastic strain before the step is volume * I + shape * deviator of the stress. J is det F at the end of
 * the step, b the trial's b - I, strain its strain. */
typedef struct mpmi_trial_rows {
  _Alignas(64) double J[MPMI_CHUNK], volume[MPMI_CHUNK], shape[MPMI_CHUNK];
  double b[6][MPMI_CHUNK], strain[6][MPMI_CHUNK];
} mpmi_trial_rows;

/* The frame of a law that is linear in e. */
typedef struct mpmi_frame {
  mpmi_hencky c;
  mpmi_trial in;
} mpmi_frame;

MPMI_INLINE mpmi_frame mpmi_frame_of(const mpmi_hencky *c, const mpm_material_batch *batch) {
  mpmi_frame frame = {*c, mpmi_trial_of(batch)};
  return frame;
}

/* Sets what is before the step for such a law. */
MPMI_INLINE void mpmi_start_trials(int dim, mpmi_frame frame, int64_t begin, mpmi_trial_rows *out) {
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    double J = mpmi_trial_J(dim, frame.in, begin + p);
    mpmi_old old = mpmi_old_state(dim, frame.in, begin + p, J);
    out->J[p] = J;
    out->volume[p] = old.J * frame.c.by_mean * old.mean;
    out->shape[p] = old.J * frame.c.by_deviator;
  }
}

/* Finds b of the trials. Elastic strains are mostly moderate; where one is not, all are found both ways and
 * each is taken by its own size, so that it does not depend on others. */
MPMI_INLINE void mpmi_find_b(int dim, mpmi_trial in, int64_t begin, mpmi_trial_rows *out) {
  _Alignas(64) double size[MPMI_CHUNK];
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    mpmi_old old = mpmi_old_state(dim, in, begin + p, out->J[p]);
    mpmi_sym twice = mpmi_shifted(2.0 * out->shape[p], old.deviator, 2.0 * out->volume[p]);
    mpmi_powers of = mpmi_powers_of(twice);
    size[p] = of.square.xx + of.square.yy + of.square.zz;
    mpmi_sym b = mpmi_pushed_forward(dim, old.g, mpmi_moderate_exp_minus_1(twice, &of));
    mpmi_store_sym(dim, out->b[0], MPMI_CHUNK, p, b);
  }
  if (!mpmi_has_larger(size, MPMI_MODERATE_SQUARE)) return;
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    mpmi_old old = mpmi_old_state(dim, in, begin + p, out->J[p]);
    mpmi_sym e = mpmi_shifted(out->shape[p], old.deviator, out->volume[p]);
    mpmi_sym any = mpmi_pushed_forward(dim, old.g, mpmi_exp_twice(dim, e));
    mpmi_sym b = mpmi_load_sym(dim, out->b[0], MPMI_CHUNK, p);
    mpmi_store_sym(dim, out->b[0], MPMI_CHUNK, p, mpmi_selected(size[p] <= MPMI_MODERATE_SQUARE, b, any));
  }
}

/* Finds the strains of the trials from their b likewise; they are no numbers where b is out of range. */
MPMI_INLINE void mpmi_find_strains(int dim, mpmi_trial_rows *out) {
  _Alignas(64) double size[MPMI_CHUNK];
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    mpmi_sym b = mpmi_load_sym(dim, out->b[0], MPMI_CHUNK, p);
    mpmi_powers of = mpmi_powers_of(b);
    size[p] = of.square.xx + of.square.yy + of.square.zz;
    mpmi_store_sym(dim, out->strain[0], MPMI_CHUNK, p, mpmi_moderate_log_stretch(b, &of));
  }
  if (!mpmi_has_larger(size, MPMI_MODERATE_SQUARE)) return;
  MPMI_IVDEP
  for (int p = 0; p < MPMI_CHUNK; ++p) {
    mpmi_sym b = mpmi_load_sym(dim, out->b[0], MPMI_CHUNK, p), any = mpmi_half_log(dim, b);
    mpmi_sym e = mpmi_load_sym(dim, out->strain[0], MPMI_CHUNK, p);
    any.xx = mpmi_elastic_range(b) > 0.0 ? any.xx : (double)NAN;
    mpmi_store_sym(dim, out->strain[0], MPMI_CHUNK, p,
                   mpmi_selected(size[p] <= MPMI_MODERATE_SQUARE, e, any));
  }
}

/* Does all that for a law that is linear in e. */
MPMI_INLINE void mpmi_find_trials(int dim, mpmi_frame frame, int64_t begin, mpmi_trial_rows *out) {
  mpmi_start_trials(dim, frame, begin, out);
  mpmi_find_b(dim, frame.in, begin, out);
  mpmi_find_strains(dim, out);
}

/* ---- outputs ------------------------------------------------------------------------------------------- */
/* Computes the squared speed of the fastest elastic wave, whose stiffness is bulk + 4/3 mu less the smallest
 * principal stress, which is at least -p - 2/3 q; and the energy of the elastic strain that belongs to
 * the stress. */
MPMI_INLINE void mpmi_frame_outputs(int dim, const mpmi_hencky *c, const mpm_material_batch *batch) {
  const double p_wave = c->p_wave, density_inverse = c->density_inverse;
  const double by_mean = 1.5 * c->by_mean, by_deviator = 0.5 * c->by_deviator;
  const int64_t n = mpmi_batch_items(batch), ld = batch->ld;
  const double *deformation = batch->F, *stress = batch->stress_new;
  double *wave_speed_squared = batch->wave_speed, *energy = batch->energy;
  MPMI_IVDEP
  for (int64_t i = 0; i < n; ++i) {
    double J = 1.0 + mpmi_J_minus_1(dim, mpmi_load_F_minus_1(dim, deformation, ld, i)), mean;
    double square = mpmi_square(mpmi_deviator(mpmi_load_sym(dim, stress, ld, i), &mean));
    double pressed = J * (sqrt((2.0 / 3.0) * square) - mean);
    wave_speed_squared[i] = (p_wave + mpmi_max(pressed, 0.0)) * density_inverse;
    energy[i] = J * J * (by_mean * mean * mean + by_deviator * square);
  }
}

#endif
