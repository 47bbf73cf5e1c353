/* What contact sees of obstacles and friction walls: distances, normals and velocities in space. */
#include "obstacle/obstacle.h"

#include <math.h>

void mpmi_surface_of_obstacle(mpmi_rigid_surface *s, const mpm_grid *grid, const mpm_obstacle *obstacle) {
  const mpm_obstacle_desc *d = &obstacle->desc;
  *s = (mpmi_rigid_surface){.grid = grid,
                            .obstacle = obstacle,
                            .shape = d->shape,
                            .face = -1,
                            .inside = d->inside ? -1.0 : 1.0,
                            .rule = obstacle->rule};
  for (int32_t k = 0; k < 3; ++k) {
    s->size[k] = d->size[k];
    s->centre[k] = obstacle->pose.centre[k];
    s->velocity[k] = obstacle->pose.velocity[k];
    s->spin[k] = obstacle->pose.spin[k];
  }
  s->rule.normal = MPM_NORMAL_LOGISTIC; /* these do not count */
  s->rule.detection = MPM_DETECT_GAP;
  mpmi_pose_axes(obstacle->pose.orientation, s->axis);
}

/* A wall is the fixed plane of its face, whose normal is into the grid. */
void mpmi_surface_of_wall(mpmi_rigid_surface *s, const mpm_grid *grid, int32_t face, const mpmi_wall *wall) {
  const int32_t axis = face / 2, normal = grid->dim == 1 ? 0 : 1;
  *s = (mpmi_rigid_surface){.grid = grid, .shape = MPM_SHAPE_PLANE, .face = face, .inside = 1.0};
  s->rule.kind = MPM_CONTACT_UNILATERAL;
  s->rule.friction = wall->friction;
  s->centre[axis] = face % 2 ? grid->upper[axis] : grid->desc.origin[axis];
  for (int32_t k = 0; k < 3; ++k)
    s->axis[(normal + k) % 3][(axis + k) % 3] = face % 2 ? -1.0 : 1.0; /* only that of the normal counts */
}

void mpmi_surface_arm(const mpmi_rigid_surface *s, const double *x, double *arm) {
  const mpm_grid *grid = s->grid;
  for (int32_t k = 0; k < 3; ++k) {
    arm[k] = k < grid->dim ? x[k] - s->centre[k] : 0.0;
    if (k >= grid->dim || !grid->desc.periodic[k]) continue;
    const double period = grid->upper[k] - grid->desc.origin[k];
    arm[k] -= period * rint(arm[k] / period);
  }
}

static void into_body(const mpmi_rigid_surface *s, const double *arm, double *x) {
  for (int32_t k = 0; k < 3; ++k)
    x[k] = s->axis[k][0] * arm[0] + s->axis[k][1] * arm[1] + s->axis[k][2] * arm[2];
}

static void into_space(const mpmi_rigid_surface *s, const double *x, double *out) {
  for (int32_t k = 0; k < 3; ++k) out[k] = s->axis[0][k] * x[0] + s->axis[1][k] * x[1] + s->axis[2][k] * x[2];
}

int32_t mpmi_surface_is_far(const mpmi_rigid_surface *s, const double *centre, double radius, double beyond) {
  double arm[3], x[3], unused[3];
  const int32_t dim = s->grid->dim;
  mpmi_surface_arm(s, centre, arm);
  for (int32_t k = 0; k < dim; ++k) /* where the nearest image changes, distances may jump */
    if (s->grid->desc.periodic[k] &&
        fabs(arm[k]) + radius > 0.5 * (s->grid->upper[k] - s->grid->desc.origin[k]))
      return 0;
  into_body(s, arm, x);
  if (s->shape != MPM_SHAPE_DISTANCE) {
    const double distance = mpmi_shape_distance(s->shape, dim, s->size, x, unused);
    return s->inside * distance - s->rule.offset > radius + beyond;
  }
  const mpm_obstacle_desc *d = &s->obstacle->desc;
  double half[3], from[3];
  int32_t anywhere = 1;
  for (int32_t k = 0; k < dim; ++k) {
    half[k] = 0.5 * (d->upper[k] - d->lower[k]);
    from[k] = x[k] - 0.5 * (d->upper[k] + d->lower[k]);
    anywhere &= !(half[k] > 0.0);
  }
  return !anywhere &&
         mpmi_shape_distance(MPM_SHAPE_BOX, dim, half, from, unused) > radius + fmax(0.0, s->rule.offset);
}

void mpmi_surface_velocity(const mpmi_rigid_surface *s, const double *arm, double *velocity) {
  for (int32_t k = 0; k < 3; ++k)
    velocity[k] =
        s->velocity[k] + s->spin[(k + 1) % 3] * arm[(k + 2) % 3] - s->spin[(k + 2) % 3] * arm[(k + 1) % 3];
}

/* How far a surface that turns reaches from its centre; of a half-space and of a shape of the host without
 * bounds that is not known, and counts as 0. */
static double extent_of(const mpm_obstacle_desc *d, int32_t dim) {
  const int32_t axes = d->shape == MPM_SHAPE_BOX || d->shape == MPM_SHAPE_DISTANCE ? dim : 3;
  double squared = 0.0;
  if (d->shape == MPM_SHAPE_CAPSULE) return d->size[0] + d->size[1];
  for (int32_t k = 0; k < axes; ++k) {
    const double low = fabs(d->lower[k]), high = fabs(d->upper[k]);
    const double far = d->shape == MPM_SHAPE_DISTANCE ? fmax(low, high) : d->size[k];
    squared += far * far;
  }
  return sqrt(squared);
}

double mpmi_obstacle_rate(const mpm_obstacle *o) {
  const double *spin = o->pose.spin;
  const double turning =
      extent_of(&o->desc, o->grid->dim) * sqrt(spin[0] * spin[0] + spin[1] * spin[1] + spin[2] * spin[2]);
  double rate = 0.0;
  for (int32_t k = 0; k < o->grid->dim && o->rule.kind != MPM_CONTACT_NONE; ++k)
    rate = fmax(rate, (fabs(o->pose.velocity[k]) + turning) * o->grid->inverse_spacing[k]);
  return rate;
}

/* ---- distances ----------------------------------------------------------------------------------------- */
static int32_t is_finite(double x) {
  return x - x == 0.0;
}

/* Checks an answer of the host, whose normal is already a vector of three components. */
static mpm_status check_answer(double distance, const double *n, const double *velocity, const char **what) {
  const double squared = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  *what = "the distance of the callback of an obstacle is not finite";
  if (!is_finite(distance)) return MPM_NONFINITE;
  *what = "the normal of the distance callback of an obstacle is not finite";
  if (!is_finite(squared)) return MPM_NONFINITE;
  *what = "the velocity of the distance callback of an obstacle is not finite";
  if (!is_finite(velocity[0] + velocity[1] + velocity[2])) return MPM_NONFINITE;
  *what = "the normal of the distance callback of an obstacle has not the length 1";
  return fabs(squared - 1.0) <= 2e-6 ? MPM_OK : MPM_E_CALLBACK;
}

static mpm_status ask_host(const mpmi_rigid_surface *s, mpmi_distances *points, mpmi_distance_fault *fault) {
  const mpm_obstacle_desc *d = &s->obstacle->desc;
  const int32_t dim = s->grid->dim;
  double x[3][MPMI_DISTANCE_POINTS];
  for (int64_t i = 0; i < points->n; ++i) {
    double arm[3], local[3];
    const double at[3] = {points->position[0][i], points->position[1][i], points->position[2][i]};
    mpmi_surface_arm(s, at, arm);
    into_body(s, arm, local);
    points->distance[i] = (double)NAN;
    for (int32_t k = 0; k < 3; ++k) {
      x[k][i] = local[k];
      points->normal[k][i] = k < dim ? (double)NAN : 0.0;
      points->velocity[k][i] = 0.0;
    }
  }
  const mpm_distance_batch batch = {.struct_size = sizeof batch,
                                    .dim = dim,
                                    .n = points->n,
                                    .ld = MPMI_DISTANCE_POINTS,
                                    .t = points->t,
                                    .position = x[0],
                                    .distance = points->distance,
                                    .normal = points->normal[0],
                                    .velocity = points->moves ? points->velocity[0] : NULL};
  *fault = (mpmi_distance_fault){.what = "the distance callback of an obstacle", .point = -1};
  fault->returned = mpmi_from_host(d->distance(d->user, &batch));
  if (fault->returned) return fault->cause = fault->returned > 0 ? MPM_CUT_DT : MPM_E_CALLBACK;
  for (int64_t i = 0; i < points->n; ++i) {
    double n[3] = {0.0, 0.0, 0.0}, v[3] = {0.0, 0.0, 0.0}, in_space[3];
    for (int32_t k = 0; k < dim; ++k) n[k] = points->normal[k][i], v[k] = points->velocity[k][i];
    fault->cause = check_answer(points->distance[i], n, v, &fault->what);
    fault->point = i;
    if (fault->cause) return fault->cause;
    into_space(s, n, in_space);
    for (int32_t k = 0; k < 3; ++k) points->normal[k][i] = in_space[k];
    into_space(s, v, in_space);
    for (int32_t k = 0; k < 3; ++k) points->velocity[k][i] = in_space[k];
  }
  return MPM_OK;
}

static void ask_shape(const mpmi_rigid_surface *s, mpmi_distances *points) {
  for (int64_t i = 0; i < points->n; ++i) {
    double arm[3], x[3], n[3], in_space[3];
    const double at[3] = {points->position[0][i], points->position[1][i], points->position[2][i]};
    mpmi_surface_arm(s, at, arm);
    into_body(s, arm, x);
    points->distance[i] = mpmi_shape_distance(s->shape, s->grid->dim, s->size, x, n);
    into_space(s, n, in_space);
    for (int32_t k = 0; k < 3; ++k) points->normal[k][i] = in_space[k], points->velocity[k][i] = 0.0;
  }
}

mpm_status mpmi_surface_distances(const mpmi_rigid_surface *s, mpmi_distances *points,
                                  mpmi_distance_fault *fault) {
  mpm_status status = MPM_OK;
  if (s->shape == MPM_SHAPE_DISTANCE)
    status = ask_host(s, points, fault);
  else
    ask_shape(s, points);
  for (int64_t i = 0; i < points->n && !status; ++i) {
    points->distance[i] = s->inside * points->distance[i] - s->rule.offset;
    for (int32_t k = 0; k < 3; ++k) points->normal[k][i] *= s->inside;
  }
  return status;
}
