/* What a built-in law is: its description and its kernels for one instruction set. */
#ifndef MPMI_LAW_H
#define MPMI_LAW_H

#include <mpm/mpm.h>
#include <stddef.h>

#include "material/deformation.h"

typedef struct mpmi_law_param {
  const char *name, *unit, *text;
  double value, low, high; /* default (NaN: must be given); inclusive range */
  const char *range;       /* the same in words */
  int32_t whole;           /* 1: whole numbers only */
} mpmi_law_param;

typedef struct mpmi_law_state {
  const char *name, *unit, *text;
} mpmi_law_state;

/* Why a law gives a particle up: it writes MPMI_REFUSED(k) in the place of the square of its wave speed, for
 * the k-th of the refusals that its description lists, and the step or the call ends with that cause and
 * sentence. What it writes of the particle beside that is of no interest. */
typedef struct mpmi_law_refusal {
  mpm_status cause; /* MPM_CUT_DT where a shorter step may do */
  const char *what;
} mpmi_law_refusal;
#define MPMI_REFUSED(k) (-1.0 - (double)(k))

/* Evaluates a law on batch->n particles, whole chunks of them; every array is 64-byte aligned. dim tells
 * which entries of the full tensors can be anything but those of the identity, so that 1-D and 2-D need not
 * pay for 3-D; wave_speed gets the square of the speed, because a step needs the roots of few of them;
 * stress_new has all six rows written for the components that exist in `dim` (xx yy zz; xy in
 * 2-D; yz xz in 3-D), others are left alone. */
typedef void (*mpmi_law_fn)(const void *constants, int32_t dim, const mpm_material_batch *batch);

/* The tangent of a law at a batch whose law has just run, as mpmi_material_tangent() writes it. */
typedef void (*mpmi_tangent_fn)(const void *constants, int32_t dim, const mpm_material_batch *batch,
                                double *tangent);

/* How a law has a stress at rest that is set from outside (particles/geostatic.c). Where the law bears the
 * mean stress by det F alone, what shear it has without moving is the stress that was set. */
enum {
  MPMI_REST_BY_KIND,  /* the stress itself is set; or, where it follows from F, the F that has it is */
  MPMI_REST_PRESSURE, /* the det F is set that has the mean stress */
  MPMI_REST_NONE      /* it has no stress, or takes more than F and the stress to have one */
};

typedef struct mpmi_law {
  const char *name;
  const mpmi_law_param *param; /* every law has a "density" */
  int32_t param_count;
  int32_t state_count;
  const mpmi_law_state *state;                       /* [state_count] */
  void (*start)(const double *value, double *state); /* of a new particle; NULL: zeros */
  const mpmi_law_refusal *refusal;                   /* [refusal_count] */
  int32_t refusal_count;
  int32_t stress_from_F; /* 1: hyperelastic, fluid, rigid; 0: hypoelastic, the host may set the stress */
  int32_t mean_from_F; /* 1, with stress_from_F = 0: the host may set the deviator, the mean follows from F */
  int32_t kinematics;  /* MPMI_F_... */
  int32_t pressure_from_shear; /* 1: shear makes pressure, so that the locking remedy averages both */
  int32_t rest;                /* MPMI_REST_... */
  /* 1: per present volume its strain energy follows from the Cauchy stress alone, which makes it no
   * function of the deformation where the volume changes (stages/dissipation.c) */
  int32_t energy_of_stress;
  int32_t viscous;   /* 1: it writes the kinematic viscosity */
  int32_t no_sheets; /* 1: it is none that a sheet in plane stress can have */
  /* Says what is wrong with the parameters together, or returns NULL where nothing is. NULL: there is no such
   * check. */
  const char *(*check)(const double *value);
  /* The kernels work with constants that `prepare` makes from the values of the parameters: a struct of
   * doubles, all of which must be finite. A law without constants has 0 and NULL here. */
  size_t constants_size;
  void (*prepare)(const double *value, void *constants);
  mpmi_law_fn stress;
  /* Of laws that look at F alone: stress in 2-D where F has the rows that a set stores; or NULL. */
  mpmi_law_fn plane_stored;
  mpmi_tangent_fn tangent;
  /* 1 when the tangent has major symmetry in 2-D and 3-D too. */
  int32_t (*is_symmetric)(const void *constants);
} mpmi_law;

#endif
