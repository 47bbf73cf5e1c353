/* Isotropic elasticity with E and nu: parameters and constants that several laws share. */
#ifndef MPMI_ELASTIC_CONSTANTS_H
#define MPMI_ELASTIC_CONSTANTS_H

#include "material/law_file.h"

/* A law that uses mpmi_elastic_of() has these parameters first, in this order. */
#define PARAMS_ELASTIC                                                                                       \
  {"E", "stress", "Young's modulus", MUST_BE_GIVEN, POSITIVE},                                               \
      {"nu",                                                                                                 \
       "1",                                                                                                  \
       "Poisson's ratio",                                                                                    \
       MUST_BE_GIVEN,                                                                                        \
       -1.0 + DBL_EPSILON / 2,                                                                               \
       0.5 - DBL_EPSILON / 4,                                                                                \
       "must be > -1 and < 0.5",                                                                             \
       0},                                                                                                   \
      PARAM_DENSITY

typedef struct mpmi_elastic {
  double lambda, mu, density_inverse;
  double p_wave_squared;            /* (lambda + 2 mu) / density */
  double mean_energy, shear_energy; /* 1 / (2 K), 1 / (4 mu): of the mean stress, of the deviator */
} mpmi_elastic;

static inline mpmi_elastic mpmi_elastic_of(const double *value) {
  const double E = value[0], nu = value[1], density = value[2];
  const double mu = E / (2.0 * (1.0 + nu)), bulk = E / (3.0 * (1.0 - 2.0 * nu));
  mpmi_elastic c = {.lambda = 2.0 * mu * nu / (1.0 - 2.0 * nu),
                    .mu = mu,
                    .density_inverse = 1.0 / density,
                    .p_wave_squared = (bulk + mpmi_rounded(4.0 / 3.0 * mu)) / density,
                    .mean_energy = 1.0 / (2.0 * bulk),
                    .shear_energy = 1.0 / (4.0 * mu)};
  return c;
}

/* For a law whose constants are these alone. */
static inline void mpmi_elastic_prepare(const double *value, void *constants) {
  *(mpmi_elastic *)constants = mpmi_elastic_of(value);
}

#endif
