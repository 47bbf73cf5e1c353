/* A set of particles that is a body of its own: copies of its fields, how it moves, how it is drawn. 2-D. */
#ifndef EXAMPLES_BODY_H
#define EXAMPLES_BODY_H

#include <mpm/mpm.h>

#include <stdlib.h>

#include "svg.h"

/* Arrays are [components][n], by ascending id. */
typedef struct body {
  mpm_particles *set;
  int64_t n;
  double *x, *v, *F, *stress, *mass, *edge; /* edge: for drawing */
  int *colour;                              /* for svg_rows(); at first 0 */
  double row[2]; /* direction of rows of particles; at first y, as fills make them */
} body;

/* 0, or -1 when there is no memory. The number of particles must not change from here on. */
static inline int body_open(body *b, mpm_particles *set) {
  const int64_t n = b->n = mpm_particles_count(set);
  b->set = set;
  b->row[0] = 0.0;
  b->row[1] = 1.0;
  b->x = malloc((2 + 2 + 9 + 6 + 1 + 2) * (size_t)n * sizeof *b->x);
  b->colour = calloc((size_t)n, sizeof *b->colour);
  if (!b->x || !b->colour) return -1;
  b->v = b->x + 2 * n;
  b->F = b->v + 2 * n;
  b->stress = b->F + 9 * n;
  b->mass = b->stress + 6 * n;
  b->edge = b->mass + n;
  return 0;
}

static inline void body_close(body *b) {
  free(b->x);
  free(b->colour);
}

static inline mpm_status body_read(body *b) {
  mpm_status status;
  if ((status = mpm_particles_get(b->set, "position", MPM_F64, 2, b->n, NULL, b->x)) ||
      (status = mpm_particles_get(b->set, "velocity", MPM_F64, 2, b->n, NULL, b->v)) ||
      (status = mpm_particles_get(b->set, "deformation_gradient", MPM_F64, 9, b->n, NULL, b->F)) ||
      (status = mpm_particles_get(b->set, "stress", MPM_F64, 6, b->n, NULL, b->stress)))
    return status;
  return mpm_particles_get(b->set, "mass", MPM_F64, 1, b->n, NULL, b->mass);
}

/* Mean by mass of value[2][n]. */
static inline void body_mean(const body *b, const double *value, double mean[2]) {
  double mass = 0.0;
  mean[0] = mean[1] = 0.0;
  for (int64_t i = 0; i < b->n; ++i) {
    mass += b->mass[i];
    for (int c = 0; c < 2; ++c) mean[c] += b->mass[i] * value[c * b->n + i];
  }
  for (int c = 0; c < 2; ++c) mean[c] /= mass;
}

/* Angular momentum over moment of inertia, about the centre of mass. */
static inline double body_spin(const body *b) {
  double centre[2], momentum = 0.0, inertia = 0.0;
  body_mean(b, b->x, centre);
  for (int64_t i = 0; i < b->n; ++i) {
    const double x = b->x[i] - centre[0], y = b->x[b->n + i] - centre[1];
    momentum += b->mass[i] * (x * b->v[b->n + i] - y * b->v[i]);
    inertia += b->mass[i] * (x * x + y * y);
  }
  return momentum / inertia;
}

/* Draws a body whose particles were squares of that width. */
static inline void body_draw(FILE *out, const svg_frame *f, body *b, double width, int colours,
                             int (*rgb)[3]) {
  const int64_t n = b->n;
  for (int c = 0; c < 2; ++c)
    for (int64_t i = 0; i < n; ++i)
      b->edge[c * n + i] =
          0.5 * width * (b->F[3 * c * n + i] * b->row[0] + b->F[(3 * c + 1) * n + i] * b->row[1]);
  svg_rows(out, f, n, b->x, b->edge, width, b->colour, colours, rgb);
}

#endif
