/**
 * @file obstacle.h
 * Obstacles: rigid bodies without particles, with which the material is in contact.
 *
 * An obstacle is a shape with a pose. Material meets it by the law of contact.h: gaps are measured from the
 * particles, an impulse at the nodes closes them and never more, with Coulomb friction; normals are those of
 * the shape, which are exact. It may be fixed, move as the host says, or be free: then the material pushes it
 * about as a rigid body with mass and inertia. Obstacles do not meet each other, nor the walls of the grid.
 *
 * Vectors have three components whatever the dimension of the grid: a 2-D grid uses the first two, and turns
 * about the third axis; a 1-D grid uses the first.
 *
 * @par Sources
 * As for contact.h. Free obstacles: the semi-implicit rule of Moreau, in Nonsmooth Mechanics and
 * Applications, 1988. docs/theory.md has the equations.
 */
#ifndef MPM_OBSTACLE_H
#define MPM_OBSTACLE_H

#include <mpm/contact.h>

#ifdef __cplusplus
extern "C" {
#endif

/** A rigid body without particles. It belongs to a context, and may be in one stepper at a time. */
typedef struct mpm_obstacle mpm_obstacle;

/** Shapes: mpm_obstacle_desc.shape. Lengths are mpm_obstacle_desc.size; axes are those of the body. */
enum mpm_shape_value {
  MPM_SHAPE_PLANE = 1,    /**< a half-space; outward normal: axis y, in 1-D x. No size */
  MPM_SHAPE_SPHERE = 2,   /**< size[0]: radius; in 2-D a disc. Not in 1-D */
  MPM_SHAPE_CYLINDER = 3, /**< around axis z; size[0]: radius, size[1]: half length. 3-D only */
  MPM_SHAPE_CAPSULE = 4,  /**< around axis z; size[0]: radius, size[1]: half length without caps. 3-D only */
  MPM_SHAPE_BOX = 5,      /**< size: half edges; in 2-D a rectangle. Not in 1-D */
  MPM_SHAPE_DISTANCE = 64 /**< what mpm_obstacle_desc.distance says */
};
/** How an obstacle moves: mpm_obstacle_desc.motion. */
enum mpm_motion_value {
  MPM_MOTION_FIXED = 0,      /**< not at all (default) */
  MPM_MOTION_PRESCRIBED = 1, /**< by its velocities, which the host may change from step to step */
  MPM_MOTION_FREE = 2        /**< as a rigid body under contact, gravity and the host's load */
};

/** Points whose distance from an obstacle is asked for. All is in the axes of the body, from its centre; in
 * space these are the same until it moves. Arrays belong to the library. */
typedef struct mpm_distance_batch {
  uint32_t struct_size;   /**< sizeof(mpm_distance_batch) of the library; see mpm.h */
  int32_t dim;            /**< dimension of the grid */
  int64_t n;              /**< number of points */
  int64_t ld;             /**< distance from component c to c + 1, in elements; >= n */
  double t;               /**< time at the start of the step; in implicit steps with contact a second time
                               that at its end, for particles and the pose of that time */
  const double *position; /**< [dim][ld] */
  double *distance;       /**< [ld] to be set: signed distance, > 0 outside. It must be right up to two
                               spacings, and the offset of the obstacle's rule, off the surface;
                               farther out it may be smaller than it is, but not than that */
  double *normal;         /**< [dim][ld] to be set: unit gradient of the distance */
  double *velocity;       /**< [dim][ld] preset to 0: of the surface there, beside the rigid motion. NULL for
                               points at which it is not asked for */
} mpm_distance_batch;

/** Gives distances of points (mt). Points are particles, and nodes of blocks that are near the obstacle, also
 * those without material: nodes lie in the grid or up to one spacing beyond its faces, and of a grid with
 * total_lagrangian = 1 where the material has taken them. On periodic axes a point is the image nearest to
 * the centre. Returns as mpm_particle_fn does. A value that is not finite, or a normal whose length is not 1
 * to 1e-6, ends the step: MPM_NONFINITE, MPM_E_CALLBACK. */
typedef mpm_status (*mpm_distance_fn)(void *user, const mpm_distance_batch *batch);

/** Gives the mean velocity[3] and angular velocity[3] of the step from t over dt; both are preset to the
 * present ones. It is called once per step, on the thread of the call. Returns as mpm_particle_fn does. */
typedef mpm_status (*mpm_motion_fn)(void *user, double t, double dt, double *velocity,
                                    double *angular_velocity);

/** An obstacle. Fill it with mpm_obstacle_desc_init(). */
typedef struct mpm_obstacle_desc {
  uint32_t struct_size;       /**< sizeof(mpm_obstacle_desc) of the caller */
  int32_t shape;              /**< an MPM_SHAPE_...; no default */
  int32_t motion;             /**< an MPM_MOTION_...; default MPM_MOTION_FIXED */
  int32_t inside;             /**< 1: the material is inside (drum, container); default 0 */
  double size[3];             /**< see MPM_SHAPE_PLANE ..., length */
  double position[3];         /**< of the centre, which of a free one is that of mass */
  double orientation[4];      /**< unit quaternion w, x, y, z that turns axes of the body into those of space;
                                   default 1, 0, 0, 0 */
  double velocity[3];         /**< of the centre; default 0 */
  double angular_velocity[3]; /**< in space, 1/time; in 2-D component 2; default 0 */
  double mass;                /**< of a free one, > 0; in 2-D per depth, in 1-D per area */
  double inertia[9];          /**< of a free one: tensor about the centre in axes of the body, row by row,
                                   symmetric and positive definite; in 2-D component 8 alone; not in 1-D */
  /** kind, friction, friction_static, adhesion and offset count: how it meets the material. Copied. NULL
   * (default): those of mpm_contact_desc_init(). */
  const mpm_contact_desc *contact;
  mpm_distance_fn distance; /**< of MPM_SHAPE_DISTANCE */
  void *user;               /**< its first argument */
  double lower[3]; /**< of MPM_SHAPE_DISTANCE, in axes of the body from its centre: the obstacle and all */
  double upper[3]; /**< within two spacings of it lie in this box. Equal (default): it may be anywhere */
} mpm_obstacle_desc;

/** Fills desc with the defaults. struct_size is sizeof(mpm_obstacle_desc) of the caller; no byte beyond is
 * written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any time. */
MPM_API mpm_status mpm_obstacle_desc_init(mpm_obstacle_desc *desc, uint32_t struct_size);

/** Makes an obstacle. The desc is copied. *out becomes NULL on failure. MPM_E_ARG: a value is bad.
 * MPM_E_UNSUPPORTED: velocities of a fixed one, bounds of one that the material is inside of. */
MPM_API mpm_status mpm_obstacle_create(mpm_context *context, const mpm_obstacle_desc *desc,
                                       mpm_obstacle **out);

/** Frees an obstacle; NULL is let pass. MPM_E_STATE: a stepper holds it. */
MPM_API mpm_status mpm_obstacle_destroy(mpm_obstacle *obstacle);

/** Puts an obstacle into a stepper, with those that are there in the order of adding. MPM_E_STATE: it is in a
 * stepper already, or a step is under way. MPM_E_UNSUPPORTED: the shape does not exist in the dimension of
 * the grid; it is free, and the grid MPM_AXISYMMETRIC or the scheme MPM_NEWMARK, which refuses the adhesion
 * of an obstacle in the step. MPM_E_ARG: it is turned out of a 2-D or 1-D grid, or moves out of
 * it. */
MPM_API mpm_status mpm_stepper_add_obstacle(mpm_stepper *stepper, mpm_obstacle *obstacle);

/** Takes an obstacle out, and what it has reported. MPM_E_NOT_FOUND: it is not in this stepper. */
MPM_API mpm_status mpm_stepper_remove_obstacle(mpm_stepper *stepper, mpm_obstacle *obstacle);

/** Sets how an obstacle moves in each step, for MPM_MOTION_PRESCRIBED (MPM_E_UNSUPPORTED with others). NULL:
 * it keeps its velocities. A state does not hold it: after one has been loaded that had it, no step is made
 * (MPM_E_STATE) until it has been set, before loading or after, or answered by NULL after it. MPM_E_STATE
 * during a staged step. */
MPM_API mpm_status mpm_obstacle_set_motion(mpm_obstacle *obstacle, mpm_motion_fn fn, void *user);

/** Sets how an obstacle meets the material, as mpm_obstacle_desc.contact does. MPM_E_ARG: a value is bad;
 * nothing is changed. MPM_E_STATE during a staged step. */
MPM_API mpm_status mpm_obstacle_set_contact(mpm_obstacle *obstacle, const mpm_contact_desc *contact);

/** Puts an obstacle somewhere: position[3], orientation[4], velocity[3] and angular_velocity[3] as in
 * mpm_obstacle_desc, each NULL to keep it. MPM_E_ARG: a value is bad; nothing is changed. MPM_E_UNSUPPORTED:
 * a velocity other than 0 of a fixed one. MPM_E_STATE during a staged step. */
MPM_API mpm_status mpm_obstacle_set_pose(mpm_obstacle *obstacle, const double *position,
                                         const double *orientation, const double *velocity,
                                         const double *angular_velocity);

/** Gives where an obstacle is and how it moves; each may be NULL. */
MPM_API mpm_status mpm_obstacle_get_pose(const mpm_obstacle *obstacle, double *position, double *orientation,
                                         double *velocity, double *angular_velocity);

/** Sets the force[3] and the torque[3] about its centre that act on a free obstacle beside gravity and
 * contact, until they are set anew; each NULL to keep it. MPM_E_UNSUPPORTED: it is not free. MPM_E_STATE
 * during a staged step. */
MPM_API mpm_status mpm_obstacle_set_load(mpm_obstacle *obstacle, const double *force, const double *torque);

/** Gives what a body and an obstacle did to each other in the last step; body MPM_BODY_ANY: all of them.
 * force and impulse are on the material, -force is on the obstacle; torque is that on the obstacle, about its
 * centre; nodes are those that could be constrained. MPM_E_STATE: it is in no stepper, or that has made no
 * step yet. */
MPM_API mpm_status mpm_obstacle_contact_info(const mpm_obstacle *obstacle, int32_t body,
                                             mpm_contact_info *info);

#ifdef __cplusplus
}
#endif

#endif
