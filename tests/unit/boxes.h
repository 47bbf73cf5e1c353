/* Boxes of particles, each a body, that move against each other. */
#ifndef BOXES_H
#define BOXES_H

#include "body.h"
#include "io/state.h"

enum { THIRD = 1 << 4, ROUND = 1 << 5 };

/* Boxes of one set each that move against each other along x and slide along the other axes; with THIRD three
 * of them, that all meet; with ROUND through the seam of a periodic axis. */
typedef struct boxes {
  int32_t dim, flags, concurrency, random_order;
  method method;
  mpm_contact_desc contact;
} boxes;

static const double spacing = 0.25, box_speed = 2.0, box_dt = 1e-3;

static inline mpm_contact_desc contact_desc(double friction) {
  mpm_contact_desc d;
  ck_assert_int_eq(mpm_contact_desc_init(&d, sizeof d), MPM_OK);
  d.friction = friction;
  return d;
}

static inline void open_boxes(world *w, const boxes *of) {
  const int32_t dim = of->dim, bodies = of->flags & THIRD ? 3 : 2;
  const double h = spacing, shift = of->flags & ROUND ? 6.0 * h : 0.0, length = 12.0 * h;
  /* the lower corners in cells; the third lies on top of both */
  static const double low[3][3] = {{3, 3, 3}, {6, 3.5, 3.5}, {4, 6, 4}};
  world_desc desc = world_with(&of->method, dim, 12, h);
  desc.context.concurrency = of->concurrency ? of->concurrency : 1;
  desc.random_order = of->random_order;
  desc.grid.periodic[0] = (of->flags & ROUND) != 0;
  desc.sets = 1;
  world_open(w, &desc);
  for (int32_t m = 0; m < bodies; ++m) {
    mpm_particles *set = m ? world_add_set(w, NULL) : w->set[0];
    double lower[3], upper[3], v[3];
    for (int32_t k = 0; k < dim; ++k) {
      lower[k] = h * low[m][k];
      upper[k] = lower[k] + 3.0 * h;
      v[k] = (m == 0 ? 1.0 : m == 1 ? -1.0 : k == 1 ? -1.0 : 0.3) * (k ? 0.5 : 1.0) * box_speed;
    }
    const int64_t n = world_fill(w, set, lower, upper, 2);
    double *x = fetch(w, set, "position", dim);
    for (int64_t i = 0; i < n; ++i) {
      x[i] += shift;
      if (x[i] >= length) x[i] -= length;
    }
    put(w, set, "position", dim, x);
    free(x);
    ck_ok(w, mpm_particles_set_all(set, "velocity", MPM_F64, dim, v));
    ck_ok(w, mpm_stepper_set_body(w->stepper, set, 3 - m));
  }
  ck_ok(w, mpm_stepper_set_contact(w->stepper, MPM_BODY_ANY, MPM_BODY_ANY, &of->contact));
}

static inline mpm_contact_info contact_of(const world *w, int32_t a, int32_t b) {
  mpm_contact_info info = {.struct_size = sizeof info};
  ck_ok(w, mpm_stepper_contact_info(w->stepper, a, b, &info));
  return info;
}

/* Add the cases of contact_reports.c and contact_steps.c. */
void add_contact_reports(Suite *suite);
void add_contact_steps(Suite *suite);

#endif
