/* Signed distances of the built-in shapes, with their gradients, in axes of the body. Where a gradient does
 * not exist, at centres and edges, one of those beside it is taken. */
#include "obstacle/obstacle.h"

#include <math.h>

static double plane(int32_t dim, const double *x, double *n) {
  const int32_t axis = dim == 1 ? 0 : 1;
  n[axis] = 1.0;
  return x[axis];
}

/* Distance from a point at which n stands from the point itself; n becomes the direction. */
static double away(double *n) {
  const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  if (!(length > 0.0)) {
    n[0] = 1.0;
    return 0.0;
  }
  for (int32_t k = 0; k < 3; ++k) n[k] /= length;
  return length;
}

static double sphere(double radius, const double *x, double *n) {
  for (int32_t k = 0; k < 3; ++k) n[k] = x[k];
  return away(n) - radius;
}

static double capsule(const double *size, const double *x, double *n) {
  const double along = fmin(fmax(x[2], -size[1]), size[1]);
  n[0] = x[0];
  n[1] = x[1];
  n[2] = x[2] - along;
  return away(n) - size[0];
}

/* The distance of a point from a box of so many sides, of which it is beyond[k] outside of side k along the
 * unit vector that has the component out[k] there. */
static double from_sides(int32_t sides, const double *beyond, double *share) {
  int32_t nearest = 0;
  double squared = 0.0;
  for (int32_t k = 0; k < sides; ++k) {
    if (beyond[k] > beyond[nearest]) nearest = k;
    if (beyond[k] > 0.0) squared += beyond[k] * beyond[k];
  }
  const double distance = squared > 0.0 ? sqrt(squared) : beyond[nearest];
  for (int32_t k = 0; k < sides; ++k)
    share[k] = squared > 0.0 ? fmax(beyond[k], 0.0) / distance : k == nearest ? 1.0 : 0.0;
  return distance;
}

static double cylinder(const double *size, const double *x, double *n) {
  double radial[3] = {x[0], x[1], 0.0}, share[2];
  const double beyond[2] = {away(radial) - size[0], fabs(x[2]) - size[1]};
  const double distance = from_sides(2, beyond, share);
  n[0] = share[0] * radial[0];
  n[1] = share[0] * radial[1];
  n[2] = x[2] < 0.0 ? -share[1] : share[1];
  return distance;
}

static double box(int32_t dim, const double *size, const double *x, double *n) {
  double beyond[3] = {0.0, 0.0, 0.0}, share[3];
  for (int32_t k = 0; k < dim; ++k) beyond[k] = fabs(x[k]) - size[k];
  const double distance = from_sides(dim, beyond, share);
  for (int32_t k = 0; k < dim; ++k) n[k] = x[k] < 0.0 ? -share[k] : share[k];
  return distance;
}

double mpmi_shape_distance(int32_t shape, int32_t dim, const double *size, const double *x, double *n) {
  n[0] = n[1] = n[2] = 0.0;
  switch (shape) {
  case MPM_SHAPE_PLANE:
    return plane(dim, x, n);
  case MPM_SHAPE_SPHERE:
    return sphere(size[0], x, n);
  case MPM_SHAPE_CYLINDER:
    return cylinder(size, x, n);
  case MPM_SHAPE_CAPSULE:
    return capsule(size, x, n);
  default:
    return box(dim, size, x, n);
  }
}
