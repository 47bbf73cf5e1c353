/* Rigid bodies in a step: velocities without contact, what an impulse does to them, and the pose at the end.
 * Contact acts with the inertia at the start of the step. The turn is that of the angular momentum at the
 * end, which so is kept to rounding: the spin is found anew half-way (the midpoint rule on rotations) and at
 * the end. */
#include "obstacle/obstacle.h"
#include "simd/elementary.h"
#include "simd/vector3.h"

#include <math.h>
#include <string.h>

static void apply(double (*A)[3], const double *v, double *out) {
  for (int32_t i = 0; i < 3; ++i) out[i] = mpmi_inner(A[i], v);
}

void mpmi_pose_axes(const double *q, double axis[3][3]) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  const double columns[3][3] = {{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)},
                                {2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)},
                                {2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)}};
  for (int32_t k = 0; k < 3; ++k)
    for (int32_t c = 0; c < 3; ++c) axis[k][c] = columns[k][c];
}

/* ---- inertia ------------------------------------------------------------------------------------------- */
/* In 2-D bodies turn about z alone, in 1-D not at all. */
static void inverse_of(const double *inertia, int32_t dim, double out[3][3]) {
  for (int32_t i = 0; i < 3; ++i)
    for (int32_t j = 0; j < 3; ++j) out[i][j] = 0.0;
  if (dim == 2) out[2][2] = 1.0 / inertia[8];
  if (dim < 3) return;
  double rows[3][3];
  memcpy(rows, inertia, sizeof rows);
  (void)mpmi_invert3(rows, out);
}

/* Turns a tensor from axes of the body into space. */
static void turn_tensor(double (*axis)[3], double (*of_body)[3], double (*out)[3]) {
  for (int32_t i = 0; i < 3; ++i)
    for (int32_t j = 0; j < 3; ++j) {
      out[i][j] = 0.0;
      for (int32_t k = 0; k < 3; ++k)
        for (int32_t l = 0; l < 3; ++l) out[i][j] += axis[k][i] * of_body[k][l] * axis[l][j];
    }
}

static void inverse_in_space(const mpm_obstacle *obstacle, int32_t dim, const double *orientation,
                             double out[3][3]) {
  double axis[3][3], of_body[3][3];
  inverse_of(obstacle->desc.inertia, dim, of_body);
  mpmi_pose_axes(orientation, axis);
  turn_tensor(axis, of_body, out);
}

/* I w; in 2-D the third component alone. */
static void angular_momentum(const mpm_obstacle *obstacle, int32_t dim, const double *spin, double *out) {
  const double *inertia = obstacle->desc.inertia;
  double axis[3][3], of_body[3][3], in_space[3][3];
  for (int32_t i = 0; i < 3; ++i)
    for (int32_t j = 0; j < 3; ++j) of_body[i][j] = dim == 3 ? inertia[3 * i + j] : 0.0;
  if (dim == 2) of_body[2][2] = inertia[8];
  mpmi_pose_axes(obstacle->pose.orientation, axis);
  turn_tensor(axis, of_body, in_space);
  apply(in_space, spin, out);
}

/* ---- a step -------------------------------------------------------------------------------------------- */
void mpmi_rigid_predict(mpmi_rigid_surface *s, const double *gravity, double dt) {
  const mpm_obstacle *obstacle = s->obstacle;
  const int32_t dim = s->grid->dim;
  double more[3];
  s->inverse_mass = 1.0 / obstacle->desc.mass;
  inverse_in_space(obstacle, dim, obstacle->pose.orientation, s->inverse_inertia);
  apply(s->inverse_inertia, obstacle->torque, more);
  for (int32_t k = 0; k < 3; ++k) {
    s->velocity[k] = obstacle->pose.velocity[k];
    if (k < dim) s->velocity[k] += dt * (gravity[k] + s->inverse_mass * obstacle->force[k]);
    s->spin[k] = obstacle->pose.spin[k] + dt * more[k];
  }
}

/* What a torque changes the spin by. */
static void spin_of(const mpmi_rigid_surface *s, const double *torque, double *out) {
  for (int32_t i = 0; i < 3; ++i) out[i] = mpmi_inner(s->inverse_inertia[i], torque);
}

double mpmi_rigid_compliance(const mpmi_rigid_surface *s, const double *arm, const double *along) {
  double about[3], turned[3];
  mpmi_cross(arm, along, about);
  spin_of(s, about, turned);
  return s->inverse_mass * mpmi_inner(along, along) + mpmi_inner(about, turned);
}

void mpmi_rigid_push(mpmi_rigid_surface *s, const double *arm, const double *impulse) {
  double about[3], turned[3];
  mpmi_cross(arm, impulse, about);
  spin_of(s, about, turned);
  for (int32_t k = 0; k < 3; ++k) {
    s->velocity[k] += s->inverse_mass * impulse[k];
    s->spin[k] += turned[k];
  }
}

/* q becomes exp(dt w) q, of length 1. */
static void turn(double *q, const double *spin, double dt) {
  const double rate = sqrt(mpmi_inner(spin, spin)), half = 0.5 * dt * rate;
  if (!(rate > 0.0)) return;
  const double c = mpmi_cos(half), s = mpmi_sin(half) / rate, u[3] = {s * spin[0], s * spin[1], s * spin[2]};
  const double w = q[0], *v = q + 1;
  double across[3], turned[4];
  mpmi_cross(u, v, across);
  turned[0] = c * w - mpmi_inner(u, v);
  for (int32_t k = 0; k < 3; ++k) turned[1 + k] = c * v[k] + w * u[k] + across[k];
  const double length = sqrt(turned[0] * turned[0] + mpmi_inner(turned + 1, turned + 1));
  for (int32_t k = 0; k < 4; ++k) q[k] = turned[k] / length;
}

void mpmi_rigid_move(const mpmi_rigid_surface *s, double dt, mpmi_pose *next) {
  const mpm_obstacle *obstacle = s->obstacle;
  const int32_t dim = s->grid->dim;
  *next = obstacle->pose;
  for (int32_t k = 0; k < 3; ++k) {
    next->centre[k] += dt * s->velocity[k];
    next->velocity[k] = s->velocity[k];
    next->spin[k] = s->spin[k];
  }
  if (mpmi_is_free(s) && dim == 3) {
    double momentum[3], inverse[3][3], spin[3], half[4];
    angular_momentum(obstacle, dim, s->spin, momentum);
    for (int32_t k = 0; k < 4; ++k) half[k] = next->orientation[k];
    turn(half, s->spin, 0.5 * dt);
    inverse_in_space(obstacle, dim, half, inverse);
    apply(inverse, momentum, spin);
    turn(next->orientation, spin, dt);
    inverse_in_space(obstacle, dim, next->orientation, inverse);
    apply(inverse, momentum, next->spin);
  } else {
    turn(next->orientation, s->spin, dt);
  }
}

void mpmi_surface_advance(mpmi_rigid_surface *s, double dt) {
  mpmi_pose next;
  if (!s->obstacle) return;
  mpmi_rigid_move(s, dt, &next);
  for (int32_t k = 0; k < 3; ++k) s->centre[k] = next.centre[k];
  mpmi_pose_axes(next.orientation, s->axis);
}
