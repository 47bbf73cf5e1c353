/* Parts of test_stepper.c. */
#ifndef STEPPER_PARTS_H
#define STEPPER_PARTS_H

#include "run_support.h"

TCase *stepper_description_case(void);
TCase *stepper_arguments_case(void);
TCase *stepper_staged_case(void);
TCase *stepper_nodes_case(void);
TCase *stepper_advance_case(void);
TCase *stepper_callbacks_case(void);
TCase *stepper_boundary_case(void);
TCase *stepper_material_case(void);

/* Particles do not feel each other: only what a test adds acts. */
static inline mpm_stepper_desc parts_desc(const run *r) {
  mpm_stepper_desc d;
  ck_assert_int_eq(mpm_stepper_desc_init(&d, sizeof d), MPM_OK);
  if (r->options.scheme) d.scheme = r->options.scheme;
  if (r->options.transfer) d.transfer = r->options.transfer;
  return d;
}

/* No gravity, no callbacks, no walls: whatever acts is the test's own doing. */
static inline void parts_calm(run *r) {
  const mpm_stepper_desc d = parts_desc(r);
  run_ok(r, mpm_stepper_configure(r->stepper, &d));
  run_ok(r, mpm_stepper_set_force(r->stepper, NULL, NULL));
  run_ok(r, mpm_stepper_set_acceleration(r->stepper, NULL, NULL));
  run_ok(r, mpm_stepper_set_velocity_bc(r->stepper, NULL, NULL));
  for (int32_t face = r->options.periodic ? 2 : 0; face < 2 * r->options.dim; ++face)
    run_ok(r, mpm_stepper_set_wall(r->stepper, face, MPM_WALL_NONE, 0.0));
}

/* For inner loops: Check's own macros tell the parent process of every pass. */
#define parts_holds(condition)                                                                               \
  do {                                                                                                       \
    if (!(condition)) ck_abort_msg("not true: " #condition);                                                 \
  } while (0)

static inline void parts_close(double value, double wanted, double tolerance, const char *what) {
  if (!(fabs(value - wanted) <= tolerance))
    ck_abort_msg("%s is %.17g, wanted %.17g within %g", what, value, wanted, tolerance);
}

/* A field of both runs within a relative tolerance of its largest value. */
static inline void parts_agree(const run *a, const run *b, const char *field, int32_t components,
                               double tolerance) {
  for (int32_t m = 0; m < 2; ++m) {
    const int64_t n = mpm_particles_count(a->set[m]) * components;
    ck_assert_int_eq(mpm_particles_count(a->set[m]), mpm_particles_count(b->set[m]));
    double *x = run_get(a, m, field, components), *y = run_get(b, m, field, components);
    double largest = 0.0, apart = 0.0;
    for (int64_t i = 0; i < n; ++i) {
      largest = fmax(largest, fabs(x[i]));
      apart = fmax(apart, fabs(x[i] - y[i]));
    }
    ck_assert_msg(apart <= tolerance * largest, "%s of set %d: %g apart of %g", field, (int)m, apart,
                  largest);
    free(x);
    free(y);
  }
}

#endif
