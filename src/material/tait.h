/* Tait's equation between pressure and volume, for weakly compressible fluids:
 *   p = K/gamma (J^-gamma - 1), energy per initial volume W with dW/dJ = -p and W(1) = 0.
 * Without tension all of it is that of min(J, 1). */
#ifndef MPMI_TAIT_H
#define MPMI_TAIT_H

#include "material/law_file.h"
#include "simd/vector_math.h"

/* Parameters of a law that uses mpmi_tait_of(). */
#define PARAM_BULK                                                                                           \
  { "bulk_modulus", "stress", "bulk modulus at the initial volume", MUST_BE_GIVEN, POSITIVE }
#define PARAM_GAMMA                                                                                          \
  {                                                                                                          \
    "gamma", "1", "exponent of the volume: pressure = bulk_modulus / gamma (J^-gamma - 1)", 7.0,             \
        AT_LEAST_ONE                                                                                         \
  }
#define PARAM_TENSION                                                                                        \
  { "tension", "1", "1: pressure may be negative; 0: it is cut off at 0", 1.0, ZERO_OR_ONE }

typedef struct mpmi_tait {
  double bulk_by_gamma;
  double gamma_minus_1;     /* never 0 */
  double largest_J_minus_1; /* above it there is no pressure: 0 without tension */
} mpmi_tait;

static inline mpmi_tait mpmi_tait_of(double bulk, double gamma, double tension) {
  const double gamma_minus_1 = gamma - 1.0;
  /* (J^(1 - gamma) - 1) / (gamma - 1) is -ln J to the last digit for one so small */
  mpmi_tait c = {.bulk_by_gamma = bulk / gamma,
                 .gamma_minus_1 = gamma_minus_1 > 0.0 ? gamma_minus_1 : 1e-100,
                 .largest_J_minus_1 = tension > 0.0 ? DBL_MAX : 0.0};
  return c;
}

typedef struct mpmi_tait_state {
  double mean, energy; /* mean stress, -p */
  double stiffening;   /* initial density times the square of the speed of sound, over K */
} mpmi_tait_state;

/* J^(1 - gamma) - 1, of which p and W are made without a difference of large numbers. */
MPMI_INLINE double mpmi_tait_power(const mpmi_tait *c, double j_minus_1) {
  return mpmi_lane_expm1(-c->gamma_minus_1 * mpmi_lane_log1p(j_minus_1));
}

MPMI_INLINE mpmi_tait_state mpmi_tait_at(const mpmi_tait *c, double j_minus_1) {
  double h = mpmi_min(c->largest_J_minus_1, j_minus_1), power = mpmi_tait_power(c, h);
  mpmi_tait_state s = {c->bulk_by_gamma * (h - power) / (1.0 + h),
                       c->bulk_by_gamma * (power * (1.0 / c->gamma_minus_1) + h), 1.0 + power};
  return s;
}

/* With t = -J p of the tangent: dt / d(ln J), and -t. Where the pressure is about to be cut off they are
 * those of compression: a fluid at rest is stiff. */
typedef struct mpmi_tait_slope {
  double volumetric, pressure;
} mpmi_tait_slope;

MPMI_INLINE mpmi_tait_slope mpmi_tait_slope_at(const mpmi_tait *c, double h) {
  double power = mpmi_tait_power(c, h), most = c->largest_J_minus_1;
  mpmi_tait_slope s = {h > most ? 0.0 : c->bulk_by_gamma * ((1.0 + h) + c->gamma_minus_1 * (1.0 + power)),
                       h > most ? 0.0 : c->bulk_by_gamma * (power - h)};
  return s;
}

#endif
