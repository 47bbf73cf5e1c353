/* What the exact and verification suites share: a world of one context, grid, law and stepper with up to two
 * sets; every combination of basis, scheme and transfer; fields as arrays that the test frees. */
#ifndef SUPPORT_H
#define SUPPORT_H

#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <mpm/mpm.h>

#define PI 3.14159265358979323846

typedef struct world_desc {
  mpm_grid_desc grid;
  mpm_stepper_desc stepper;
  const char *model; /* default "neo_hookean" */
  double E, nu, density, yield_stress, hardening;
  const mpm_param *params;          /* in place of these, for other models */
  int32_t param_count, concurrency; /* 0: the library's default */
} world_desc;

typedef struct world {
  mpm_context *context;
  mpm_grid *grid;
  mpm_material *material;
  mpm_stepper *stepper;
  mpm_particles *set[2];
  int32_t sets, dim;
} world;

/* Combinations that have to behave alike. */
typedef struct method {
  int32_t basis, scheme, transfer;
  double flip;
  const char *name;
} method;
enum { METHODS = 18 };
extern const method methods[METHODS];

/* The call does what it should, or the test ends with the library's sentence. */
#define ck_ok(world_, call)                                                                                  \
  do {                                                                                                       \
    const mpm_status status_ = (call);                                                                       \
    if (status_) ck_abort_msg("%s: %s", mpm_status_name(status_), mpm_last_error((world_)->context));        \
  } while (0)

/* Measured numbers, for those who set MPM_SHOW in the environment. */
#define show(...)                                                                                            \
  do {                                                                                                       \
    if (getenv("MPM_SHOW")) printf(__VA_ARGS__), fflush(stdout);                                             \
  } while (0)

/* |value - wanted| <= tolerance; NaN fails. */
#define ck_within(name, value, wanted, tolerance)                                                            \
  do {                                                                                                       \
    const double value_ = (value), wanted_ = (wanted), tolerance_ = (tolerance);                             \
    if (!(fabs(value_ - wanted_) <= tolerance_))                                                             \
      ck_abort_msg("%s: " #value " = %.17g, wanted %.17g within %g", name, value_, wanted_, tolerance_);     \
  } while (0)

/* low <= value <= high; NaN fails. */
#define ck_between(name, value, low, high)                                                                   \
  do {                                                                                                       \
    const double value_ = (value), low_ = (low), high_ = (high);                                             \
    if (!(value_ >= low_ && value_ <= high_))                                                                \
      ck_abort_msg("%s: " #value " = %.17g, wanted in [%g, %g]", name, value_, low_, high_);                 \
  } while (0)

/* A cubic grid of `cells` cells of edge h at the origin; E = 1e5, nu = 0.3, density = 1e3. */
world_desc world_default(int32_t dim, int64_t cells, double h);
void world_use(world_desc *desc, const method *how);
void world_open(world *w, const world_desc *desc);
mpm_particles *world_add_set(world *w); /* an empty one, in the stepper */
void world_close(world *w);

mpm_step_info world_info(const world *w);
mpm_step_info world_step(world *w, double dt);
double world_stable_dt(world *w);

/* All of a field by ascending id, [components][count]; to be freed. */
double *fetch(const world *w, const mpm_particles *set, const char *field, int32_t components);
void put(const world *w, mpm_particles *set, const char *field, int32_t components, const double *values);
/* A field of the active nodes, [components][*n]; to be freed. */
double *fetch_nodes(world *w, const char *field, int64_t *n);
int64_t *fetch_node_indices(world *w, int64_t *n);

/* sum m a_c */
double weighted_sum(int64_t n, const double *mass, const double *a);
double largest(int64_t n, const double *a); /* of |a| */

/* Uniform in [low, high), the same in every run. */
typedef struct dice {
  uint64_t state;
} dice;
double throw_between(dice *d, double low, double high);

/* n particles at random places of the box low ... high on every axis, with random velocities up to `speed`,
 * volumes and small random deformations. Places are odd multiples of h / 32, so that no node is so light that
 * it is cut. */
void add_cloud(const world *w, mpm_particles *set, dice *d, int64_t n, double h, double low, double high,
               double speed);
/* Sets random affine matrices with entries up to `rate`. */
void add_affine(const world *w, mpm_particles *set, dice *d, double rate);

#endif
