/* One particle on a path without a grid, by mpm_material_update(), and what holds for every law whose
 * stress is the state. */
#ifndef MPM_TEST_LAW_PATH_H
#define MPM_TEST_LAW_PATH_H

#include "tangent_sample.h"

typedef struct path {
  mpm_material *material;
  double F[9], stress[6], state[8], energy, wave, tangent[81];
  double dt; /* 0: 1 */
} path;
typedef struct invariants {
  double p, q;
} invariants;

path path_of(const char *model, const mpm_param *params, int32_t count);

/* Takes all but the material from another path. */
void path_like(path *s, const path *other);

/* Begins with F = I, a mean stress, and states of 0. */
void start(path *s, double mean);

/* A step by F_inc that may be refused, and then leaves the path as it is. */
mpm_status attempt(path *s, const double *F_inc);

/* A step by F_inc; by principal stretches, as their logarithms; in simple shear. */
void advance(path *s, const double *F_inc);
void stretch(path *s, double x, double y, double z);
void shear(path *s, double by, int32_t steps);

/* Compresses along z, with the stress across held where it is. */
void triaxial(path *s, double axial, int32_t steps);

double jacobian_of(const path *s);
/* Of the Kirchhoff stress. */
invariants invariants_of(const path *s);

/* What plastic flow dissipates in a step of a law of Hencky's elasticity, by volume of the start: the stress
 * of the end on what it has taken of the elastic strain. trial: the same step of a law that does not yield.
 * What has opened as a gap, state 1, gives its tension back when it closes, as a spring does: it is no part
 * of it. digits: what rounding may make of it. */
double dissipated(const path *end, const path *trial, double shear, double bulk, double *digits);

/* Within 1e-9. */
void ck_number(const char *what, double value, double wanted);

/* A random number between two. */
double wide(uint64_t *seed, double low, double high);

/* A step of a random size; returns F_inc. */
void random_increment(uint64_t *seed, double *F_inc);

/* The largest difference of the tangent of a step from differences of fourth order of the Kirchhoff
 * stress, and whether all of these steps are made and end in one regime. */
typedef int32_t (*regime_fn)(const path *from, const path *to);
double tangent_off(const path *from, const double *F_inc, regime_fn regime_of, int32_t *smooth);

/* A frame that turns with the end of the step turns the stress and nothing else. */
void ck_frame(const path *from, const double *F_inc, uint64_t *seed);

/* Plane and uniaxial strain are what space makes of them: 50 steps from random stresses of a size about a
 * mean, some of them with a state. loop: one of LAW_LOOPS, an instruction set and a dimension. */
void ck_dimensions(int32_t loop, const char *model, const mpm_param *params, int32_t count, real mean,
                   real stress, const double *state, uint64_t seed);

/* Draws a random law and a random state of it, and F_inc of a step from there. */
typedef path (*sample_fn)(uint64_t *seed, double *F_inc);
/* 500 of them turn as ck_frame() asks. */
void ck_frames(sample_fn draw, uint64_t seed);

#endif
