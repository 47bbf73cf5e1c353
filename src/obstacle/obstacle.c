/* Obstacles are made and destroyed, moved and loaded here; all values of the host are checked before. */
#include "obstacle/obstacle.h"
#include "context/structs.h"
#include "obstacle/contact_desc.h"

#include <math.h>
#include <string.h>

static const mpm_obstacle_desc defaults = {.struct_size = sizeof(mpm_obstacle_desc),
                                           .orientation = {1.0, 0.0, 0.0, 0.0}};

mpm_status mpm_obstacle_desc_init(mpm_obstacle_desc *desc, uint32_t struct_size) {
  return mpmi_init_struct("mpm_obstacle_desc", &defaults, sizeof defaults, desc, struct_size);
}

/* ---- checks of values ---------------------------------------------------------------------------------- */
static double length_of(const double *q) {
  return sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
}

static mpm_status check_orientation(mpm_context *c, const double *q) {
  const mpm_status status = mpmi_check_vector(c, "orientation", q, 4);
  if (status) return status;
  if (fabs(length_of(q) - 1.0) <= 1e-6) return MPM_OK;
  return mpmi_fail(c, MPM_E_ARG, "orientation has length %g: it must be a unit quaternion", length_of(q));
}

static void take_orientation(const double *q, double *out) {
  const double length = length_of(q);
  for (int32_t k = 0; k < 4; ++k) out[k] = q[k] / length;
}

static int32_t is_zero(const double *v) {
  return !(v[0] < 0.0 || v[0] > 0.0 || v[1] < 0.0 || v[1] > 0.0 || v[2] < 0.0 || v[2] > 0.0);
}

/* Checks a pose; of a NULL member there is nothing to check. */
static mpm_status check_pose(mpm_context *c, int32_t motion, const double *position,
                             const double *orientation, const double *velocity, const double *spin) {
  mpm_status status = position ? mpmi_check_vector(c, "position", position, 3) : MPM_OK;
  if (!status && orientation) status = check_orientation(c, orientation);
  if (!status && velocity) status = mpmi_check_vector(c, "velocity", velocity, 3);
  if (!status && spin) status = mpmi_check_vector(c, "angular_velocity", spin, 3);
  if (status || motion != MPM_MOTION_FIXED) return status;
  if ((velocity && !is_zero(velocity)) || (spin && !is_zero(spin)))
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "an obstacle of MPM_MOTION_FIXED has no velocities: use MPM_MOTION_PRESCRIBED");
  return MPM_OK;
}

/* How many sizes a shape has, or -1 where there is no such shape. */
static int32_t sizes_of(int32_t shape) {
  switch (shape) {
  case MPM_SHAPE_PLANE:
  case MPM_SHAPE_DISTANCE:
    return 0;
  case MPM_SHAPE_SPHERE:
    return 1;
  case MPM_SHAPE_CYLINDER:
  case MPM_SHAPE_CAPSULE:
    return 2;
  case MPM_SHAPE_BOX:
    return 3;
  default:
    return -1;
  }
}

static mpm_status check_shape(mpm_context *c, const mpm_obstacle_desc *d) {
  if (sizes_of(d->shape) < 0)
    return mpmi_fail(c, MPM_E_ARG,
                     "shape is %d: it must be an MPM_SHAPE_PLANE ... MPM_SHAPE_BOX or MPM_SHAPE_DISTANCE",
                     (int)d->shape);
  const mpm_status status = mpmi_check_switch(c, "inside", d->inside);
  if (status) return status;
  /* the third size of a box is not used in 2-D: it may be 0 here, and is checked again with the grid */
  for (int32_t k = 0; k < sizes_of(d->shape); ++k)
    if (!(d->size[k] > 0.0 || (k == 2 && d->size[k] >= 0.0)) || !isfinite(d->size[k]))
      return mpmi_fail(c, MPM_E_ARG, "size[%d] is %g: it must be positive and finite", (int)k, d->size[k]);
  if (d->shape != MPM_SHAPE_DISTANCE) return MPM_OK;
  if (!d->distance)
    return mpmi_fail(c, MPM_E_ARG, "distance is NULL: an obstacle of MPM_SHAPE_DISTANCE needs the callback");
  for (int32_t k = 0; k < 3; ++k) {
    if (!(d->lower[k] <= d->upper[k]) || !isfinite(d->lower[k]) || !isfinite(d->upper[k]))
      return mpmi_fail(c, MPM_E_ARG, "lower[%d] is %g and upper[%d] is %g: they must be finite and in order",
                       (int)k, d->lower[k], (int)k, d->upper[k]);
    if (d->inside && d->lower[k] < d->upper[k])
      return mpmi_fail(
          c, MPM_E_UNSUPPORTED,
          "an obstacle that the material is inside of has no bounds: leave lower and upper equal");
  }
  return MPM_OK;
}

/* Checks the inertia as a grid of this dimension sees it. */
static mpm_status check_inertia(mpm_context *c, const double *I, int32_t dim) {
  static const double least = 1e-90, most = 1e90; /* products of three stay in range */
  for (int32_t k = 0; k < 3 && dim == 3; ++k)
    if (fabs(I[4 * k]) > most || (I[4 * k] > 0.0 && I[4 * k] < least))
      return mpmi_fail(c, MPM_E_ARG, "inertia[%d] of a free obstacle is %g: it must lie between %g and %g",
                       (int)(4 * k), I[4 * k], least, most);
  for (int32_t i = 0; i < 3; ++i)
    for (int32_t j = 0; j < i && dim == 3; ++j)
      if (I[3 * i + j] < I[3 * j + i] || I[3 * i + j] > I[3 * j + i])
        return mpmi_fail(c, MPM_E_ARG, "inertia[%d] is %g and inertia[%d] is %g: it must be symmetric",
                         (int)(3 * i + j), I[3 * i + j], (int)(3 * j + i), I[3 * j + i]);
  const double second = I[0] * I[4] - I[1] * I[1];
  const double third =
      I[8] * second - I[5] * (I[0] * I[5] - I[1] * I[2]) + I[2] * (I[1] * I[5] - I[4] * I[2]);
  const int32_t definite = dim == 1 || (dim == 2 ? I[8] > 0.0 : I[0] > 0.0 && second > 0.0 && third > 0.0);
  if (definite) return MPM_OK;
  return mpmi_fail(c, MPM_E_ARG,
                   dim == 2 ? "inertia[8] of a free obstacle is %g: it must be positive"
                            : "inertia of a free obstacle is not positive definite (inertia[8] "
                              "is %g)",
                   I[8]);
}

static mpm_status check_mass(mpm_context *c, const mpm_obstacle_desc *d) {
  if (d->motion < MPM_MOTION_FIXED || d->motion > MPM_MOTION_FREE)
    return mpmi_fail(c, MPM_E_ARG, "motion is %d: it must be an MPM_MOTION_FIXED ... MPM_MOTION_FREE",
                     (int)d->motion);
  if (d->motion != MPM_MOTION_FREE) return MPM_OK;
  if (!(d->mass > 0.0) || !isfinite(d->mass) || !isfinite(1.0 / d->mass))
    return mpmi_fail(c, MPM_E_ARG, "mass of a free obstacle is %g: it must be positive", d->mass);
  return mpmi_check_vector(c, "inertia", d->inertia, 9);
}

int32_t mpmi_pose_is_sound(const mpmi_pose *pose) {
  int32_t sound = fabs(length_of(pose->orientation) - 1.0) <= 1e-6;
  for (int32_t k = 0; k < 3; ++k)
    sound &= isfinite(pose->centre[k]) && isfinite(pose->velocity[k]) && isfinite(pose->spin[k]);
  return sound;
}

static int32_t has_bounds(const mpm_obstacle_desc *d) {
  int32_t bounds = 0;
  for (int32_t k = 0; k < 3; ++k) bounds |= d->shape == MPM_SHAPE_DISTANCE && d->lower[k] < d->upper[k];
  return bounds;
}

mpm_status mpmi_obstacle_fits(const mpm_obstacle *o, const mpmi_pose *pose, int32_t dim) {
  const int32_t shape = o->desc.shape;
  mpm_context *c = o->context;
  if (dim == 1 && shape != MPM_SHAPE_PLANE && shape != MPM_SHAPE_DISTANCE)
    return mpmi_fail(c, MPM_E_UNSUPPORTED, "a 1-D grid has no such shape as %d: use MPM_SHAPE_PLANE",
                     (int)shape);
  if (dim == 2 && (shape == MPM_SHAPE_CYLINDER || shape == MPM_SHAPE_CAPSULE))
    return mpmi_fail(c, MPM_E_UNSUPPORTED,
                     "a 2-D grid has no such shape as %d: use MPM_SHAPE_SPHERE or MPM_SHAPE_BOX", (int)shape);
  if (dim == 3 && shape == MPM_SHAPE_BOX && !(o->desc.size[2] > 0.0))
    return mpmi_fail(c, MPM_E_ARG, "size[2] is %g: it must be positive in a 3-D grid", o->desc.size[2]);
  for (int32_t k = 0; k < dim && has_bounds(&o->desc); ++k)
    if (!(o->desc.lower[k] < o->desc.upper[k]))
      return mpmi_fail(c, MPM_E_ARG, "lower[%d] and upper[%d] are both %g: bounds have a length on each axis",
                       (int)k, (int)k, o->desc.lower[k]);
  for (int32_t k = 0; k < 3 && dim < 3; ++k) {
    const double turned = k < 2 || dim == 1 ? pose->orientation[1 + k] : 0.0;
    const double spin = k < 2 || dim == 1 ? pose->spin[k] : 0.0,
                 velocity = k >= dim ? pose->velocity[k] : 0.0;
    if (turned < 0.0 || turned > 0.0 || spin < 0.0 || spin > 0.0 || velocity < 0.0 || velocity > 0.0)
      return mpmi_fail(c, MPM_E_ARG,
                       "the obstacle does not stay in a %d-D grid: orientation[%d] is %g, "
                       "angular_velocity[%d] is %g, velocity[%d] is %g",
                       (int)dim, (int)k + 1, turned, (int)k, spin, (int)k, velocity);
  }
  return o->desc.motion == MPM_MOTION_FREE ? check_inertia(c, o->desc.inertia, dim) : MPM_OK;
}

/* ---- the handle ---------------------------------------------------------------------------------------- */
/* Reads how an obstacle meets the material; NULL: as by default. */
static mpm_status read_rule(mpm_context *c, const mpm_contact_desc *contact, mpm_contact_desc *rule) {
  mpm_status status = mpm_contact_desc_init(rule, sizeof *rule);
  if (!status && contact) status = mpmi_read_struct(c, "mpm_contact_desc", contact, sizeof *rule, rule);
  return status ? status : mpmi_contact_desc_check_values(c, rule);
}

mpm_status mpm_obstacle_create(mpm_context *context, const mpm_obstacle_desc *desc, mpm_obstacle **out) {
  if (out) *out = NULL;
  MPMI_ENTER_CONTEXT(context);
  mpm_obstacle_desc d;
  mpm_contact_desc rule;
  mpm_status status;
  if (!out) return mpmi_fail(context, MPM_E_ARG, "out is NULL");
  if ((status = mpmi_read_struct(context, "mpm_obstacle_desc", desc, sizeof d, &d)) ||
      (status = check_shape(context, &d)) || (status = check_mass(context, &d)) ||
      (status = check_pose(context, d.motion, d.position, d.orientation, d.velocity, d.angular_velocity)) ||
      (status = read_rule(context, d.contact, &rule)))
    return status;
  mpm_obstacle *o = mpmi_alloc_zeroed(context, sizeof *o);
  if (!o) return MPM_E_NOMEM;
  o->magic = MPMI_OBSTACLE;
  o->context = context;
  o->desc = d;
  o->desc.contact = NULL;
  for (int32_t k = sizes_of(d.shape); k < 3; ++k) o->desc.size[k] = 0.0; /* no size of the shape */
  o->rule = rule;
  memcpy(o->pose.centre, d.position, sizeof o->pose.centre);
  memcpy(o->pose.velocity, d.velocity, sizeof o->pose.velocity);
  memcpy(o->pose.spin, d.angular_velocity, sizeof o->pose.spin);
  take_orientation(d.orientation, o->pose.orientation);
  ++context->children;
  *out = o;
  return MPM_OK;
}

mpm_status mpm_obstacle_destroy(mpm_obstacle *o) {
  if (!o) return MPM_OK;
  MPMI_ENTER(o, MPMI_OBSTACLE);
  if (o->stepper)
    return mpmi_fail(o->context, MPM_E_STATE,
                     "a stepper holds the obstacle: call mpm_stepper_remove_obstacle() first");
  o->magic = 0;
  --o->context->children;
  mpmi_free(o->context, o, sizeof *o);
  return MPM_OK;
}

/* ---- what the host changes ----------------------------------------------------------------------------- */
static mpm_status changeable(const mpm_obstacle *o) {
  if (!o->stepper || !o->owner->in_step(o->stepper)) return MPM_OK;
  return mpmi_fail(o->context, MPM_E_STATE, "a staged step is under way: end or abort it first");
}

mpm_status mpm_obstacle_set_motion(mpm_obstacle *o, mpm_motion_fn fn, void *user) {
  MPMI_ENTER(o, MPMI_OBSTACLE);
  const mpm_status status = changeable(o);
  if (status) return status;
  if (o->desc.motion != MPM_MOTION_PRESCRIBED)
    return mpmi_fail(o->context, MPM_E_UNSUPPORTED,
                     "the motion of the obstacle is %d: only MPM_MOTION_PRESCRIBED has a callback",
                     (int)o->desc.motion);
  o->motion = fn;
  o->motion_user = user;
  o->awaits_motion = 0;
  return MPM_OK;
}

mpm_status mpm_obstacle_set_contact(mpm_obstacle *o, const mpm_contact_desc *contact) {
  MPMI_ENTER(o, MPMI_OBSTACLE);
  mpm_contact_desc rule;
  mpm_status status = changeable(o);
  if (!status) status = read_rule(o->context, contact, &rule);
  if (!status) o->rule = rule;
  return status;
}

mpm_status mpm_obstacle_set_pose(mpm_obstacle *o, const double *position, const double *orientation,
                                 const double *velocity, const double *angular_velocity) {
  MPMI_ENTER(o, MPMI_OBSTACLE);
  mpm_status status = changeable(o);
  if (!status)
    status = check_pose(o->context, o->desc.motion, position, orientation, velocity, angular_velocity);
  if (status) return status;
  mpmi_pose pose = o->pose;
  if (position) memcpy(pose.centre, position, sizeof pose.centre);
  if (orientation) take_orientation(orientation, pose.orientation);
  if (velocity) memcpy(pose.velocity, velocity, sizeof pose.velocity);
  if (angular_velocity) memcpy(pose.spin, angular_velocity, sizeof pose.spin);
  if (o->stepper) status = mpmi_obstacle_fits(o, &pose, o->grid->dim);
  if (!status) o->pose = pose;
  return status;
}

mpm_status mpm_obstacle_get_pose(const mpm_obstacle *o, double *position, double *orientation,
                                 double *velocity, double *angular_velocity) {
  MPMI_ENTER(o, MPMI_OBSTACLE);
  if (position) memcpy(position, o->pose.centre, sizeof o->pose.centre);
  if (orientation) memcpy(orientation, o->pose.orientation, sizeof o->pose.orientation);
  if (velocity) memcpy(velocity, o->pose.velocity, sizeof o->pose.velocity);
  if (angular_velocity) memcpy(angular_velocity, o->pose.spin, sizeof o->pose.spin);
  return MPM_OK;
}

mpm_status mpm_obstacle_set_load(mpm_obstacle *o, const double *force, const double *torque) {
  MPMI_ENTER(o, MPMI_OBSTACLE);
  mpm_status status = changeable(o);
  if (!status && o->desc.motion != MPM_MOTION_FREE)
    status =
        mpmi_fail(o->context, MPM_E_UNSUPPORTED,
                  "the motion of the obstacle is %d: only MPM_MOTION_FREE takes a load", (int)o->desc.motion);
  if (!status && force) status = mpmi_check_vector(o->context, "force", force, 3);
  if (!status && torque) status = mpmi_check_vector(o->context, "torque", torque, 3);
  if (status) return status;
  if (force) memcpy(o->force, force, sizeof o->force);
  if (torque) memcpy(o->torque, torque, sizeof o->torque);
  return MPM_OK;
}
