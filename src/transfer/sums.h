/* Energies, momenta and rates, summed over particles. */
#ifndef MPMI_SUMS_H
#define MPMI_SUMS_H

#include "simd/flags.h"

/* Sums over a batch: energies, momenta and the largest rate (|v_k| + c) / h_k. A job sums what the law
 * gave, what the motion gives, or both. */
enum { MPMI_SUMS_LAW = 1, MPMI_SUMS_MOTION = 2 };
typedef struct mpmi_sums {
  double kinetic, strain, work, rate, viscous_rate;
  double momentum[3], angular[3];
  double affine; /* kinetic energy of the matrices that transfers carry */
} mpmi_sums;
typedef struct mpmi_sums_job {
  int32_t what;
  int64_t ld; /* of wave_speed ... */
  const double *x[3], *v[3], *mass, *initial_volume;
  const double *wave_speed, *energy; /* [ld] of the batch; a wave_speed below 0 is told of as not finite */
  const double *kinematic_viscosity; /* the same, or NULL: there is none */
  int32_t squared;                   /* 1: wave_speed has the squares of the speeds */
  const double *affine[9];           /* C of APIC for its energy and angular momentum, or NULL */
  const double *force[3];            /* external force beside gravity, or NULL */
  const double *x_old[3];            /* for the work over the step; NULL: there is none */
  double gravity[3], period[3], inverse_period[3];
  double spacing[3], inverse_spacing[3], viscous_factor; /* 2 dim / h_min^2 */
  const double *moment[3];   /* sum w (x_i - x)^2 of each particle along each axis, or NULL: */
  double constant_moment[3]; /* where it is the same for all particles */
  double carried;            /* share of the velocity in the stable rate: 1, or 0 where F is */
  const double *F[9]; /* stored components where C is over reference positions, of a total Lagrangian grid, in
                         which nothing travels but waves; or NULL */
  const double *checked[2]; /* [checked_rows][ld] further values that must be finite */
  int32_t checked_rows[2];
} mpmi_sums_job;
typedef uint32_t (*mpmi_sums_fn)(const mpmi_sums_job *job, int64_t n, mpmi_sums *sums); /* adds to sums */

#endif
