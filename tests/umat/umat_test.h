/* What the tests of libmpm-umat share. They are a host program: nothing of the library but what is public. */
#ifndef MPM_UMAT_TEST_H
#define MPM_UMAT_TEST_H

#include <check.h>
#include <math.h>
#include <mpm/mpm_umat.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern mpm_umat_subroutine umat_elastic_, umat_j2_, umat_kinematic_, umat_drucker_prager_, umat_common_,
    umat_moody_;
extern mpm_vumat_subroutine vumat_j2_, vumat_neo_hookean_;

#define ck_ok(context, call)                                                                                 \
  do {                                                                                                       \
    const mpm_status status_ = (call);                                                                       \
    if (status_) ck_abort_msg("%s: %s", mpm_status_name(status_), mpm_last_error(context));                  \
  } while (0)
#define ck_near(value, wanted, off)                                                                          \
  do {                                                                                                       \
    const double value_ = (value), wanted_ = (wanted), off_ = (off);                                         \
    if (!(fabs(value_ - wanted_) <= off_))                                                                   \
      ck_abort_msg(#value " is %.17g, wanted %.17g: off by %g, more than %g", value_, wanted_,               \
                   value_ - wanted_, off_);                                                                  \
  } while (0)

mpm_context *context_of(int32_t threads);
mpm_umat_desc umat_desc(double density, int32_t nprops, const double *props, int32_t nstatv);

/* One particle on a path without a grid. */
typedef struct point {
  const mpm_material *material;
  int32_t state_count;
  double F[9], stress[6], state[64], tangent[81], wave_speed, t;
  int32_t symmetric;
} point;
point point_of(const mpm_material *material, int32_t state_count);
/* A step of size 1; `tangent`: with it. */
mpm_status try_step(mpm_context *context, point *p, const double *F_inc, int tangent);
void step(mpm_context *context, point *p, const double *F_inc);

/* Matrices by rows. */
void multiply(const double *a, const double *b, double *c);
void transpose(const double *a, double *t);
/* The rotation by an angle about the axis (x, y, z), of any length. */
void rotation(double x, double y, double z, double angle, double *r);
/* Q diag(a, b, c) Q^T */
void stretched(const double *q, double a, double b, double c, double *s);
double uniform(uint64_t *seed, double low, double high);
/* I + random entries of that size. */
void random_increment(uint64_t *seed, double size, double *F_inc);

TCase *element_case(void);
TCase *runs_case(void);
TCase *failures_case(void);
TCase *vumat_case(void);

#endif
