/* Obstacles: the handle of the host, and the surface that contact sees of an obstacle or of a friction wall.
 *
 *   obstacle.c      the handle: making, pose, motion, load
 *   surface.c       what a step knows of an obstacle, and of a friction wall
 *   shapes.c        signed distances
 *   rigid_motion.c  velocities and poses of a step
 */
#ifndef MPMI_OBSTACLE_SURFACE_H
#define MPMI_OBSTACLE_SURFACE_H

#include "grid/grid.h"
#include "grid/walls.h"
#include "particles/particles.h"

/* Where a body is and how it moves. The orientation turns axes of the body into those of space. */
typedef struct mpmi_pose {
  double centre[3], orientation[4], velocity[3], spin[3];
} mpmi_pose;

struct mpm_obstacle {
  uint32_t magic;
  int32_t number; /* in its stepper */
  mpm_context *context;
  struct mpm_stepper *stepper; /* that has it, or NULL */
  const mpmi_owner *owner;     /* what the stepper says of itself */
  const mpm_grid *grid;        /* of the stepper */
  mpm_obstacle_desc desc;      /* without `contact`, which is the rule */
  mpm_contact_desc rule;
  mpmi_pose pose, next; /* next: at the end of the step under way */
  double force[3], torque[3];
  mpm_motion_fn motion;
  void *motion_user;
  int32_t awaits_motion; /* the callback that the loaded state had: no step is made without an answer */
};

/* Obstacles of a stepper, in the order of adding. */
typedef struct mpmi_obstacles {
  int64_t count, capacity;
  mpm_obstacle **obstacle;
} mpmi_obstacles;

/* Refuses shapes, poses and motions that a grid of this dimension does not have. */
mpm_status mpmi_obstacle_fits(const mpm_obstacle *obstacle, const mpmi_pose *pose, int32_t dim);
/* Returns how many spacings a point of an obstacle in a stepper moves per time at most. */
double mpmi_obstacle_rate(const mpm_obstacle *obstacle);
/* Returns 1 where a pose is finite and turned by a unit quaternion. */
int32_t mpmi_pose_is_sound(const mpmi_pose *pose);

/* The surface of an obstacle or of a friction wall in the step under way. Velocities are those of the step;
 * those of a free one change as contact pushes it. */
typedef struct mpmi_rigid_surface {
  const mpm_grid *grid;
  const mpm_obstacle *obstacle; /* NULL: a wall */
  int32_t shape, face;          /* face: of the wall, or -1 */
  double inside;                /* -1 where the material is inside, else 1 */
  double size[3], centre[3];
  double axis[3][3]; /* axis[k]: axis k of the body in space */
  double velocity[3], spin[3];
  double inverse_mass, inverse_inertia[3][3]; /* in space; 0 unless it is free */
  mpm_contact_desc rule;
  int32_t active; /* 0: far from all material, or without contact */
} mpmi_rigid_surface;

/* In records of what two bodies do to each other, surfaces have numbers below that of any body. */
static inline int32_t mpmi_code_of_face(int32_t face) {
  return -2 - face;
}
static inline int32_t mpmi_code_of_obstacle(int64_t number) {
  return -8 - (int32_t)number;
}
static inline int32_t mpmi_code_of(const mpmi_rigid_surface *surface) {
  return surface->obstacle ? mpmi_code_of_obstacle(surface->obstacle->number)
                           : mpmi_code_of_face(surface->face);
}
static inline int32_t mpmi_is_free(const mpmi_rigid_surface *surface) {
  return surface->obstacle && surface->obstacle->desc.motion == MPM_MOTION_FREE;
}

void mpmi_surface_of_obstacle(mpmi_rigid_surface *surface, const mpm_grid *grid,
                              const mpm_obstacle *obstacle);
void mpmi_surface_of_wall(mpmi_rigid_surface *surface, const mpm_grid *grid, int32_t face,
                          const mpmi_wall *wall);
/* Finds the vector from the centre to a point; on periodic axes that to the nearest image. */
void mpmi_surface_arm(const mpmi_rigid_surface *surface, const double *x, double *arm);
/* Returns 1 when all points of a ball are farther than `beyond` from the surface, as far as that is known
 * without asking the host. */
int32_t mpmi_surface_is_far(const mpmi_rigid_surface *surface, const double *centre, double radius,
                            double beyond);
/* The rigid velocity at the end of an arm. */
void mpmi_surface_velocity(const mpmi_rigid_surface *surface, const double *arm, double *velocity);

/* Points in space, and what a surface is there: rows of `ld`. */
enum { MPMI_DISTANCE_POINTS = 256 };
typedef struct mpmi_distances {
  int64_t n;
  double t;
  int32_t moves; /* 1: velocities are asked for */
  double position[3][MPMI_DISTANCE_POINTS], distance[MPMI_DISTANCE_POINTS], normal[3][MPMI_DISTANCE_POINTS],
      velocity[3][MPMI_DISTANCE_POINTS]; /* beside the rigid motion */
} mpmi_distances;
/* What is wrong with the host's answer. */
typedef struct mpmi_distance_fault {
  mpm_status cause;
  int32_t returned; /* by the callback, 0: it is a value */
  int64_t point;
  const char *what;
} mpmi_distance_fault;
/* Finds distances and normals of points; MPM_OK, or the cause of a fault. */
mpm_status mpmi_surface_distances(const mpmi_rigid_surface *surface, mpmi_distances *points,
                                  mpmi_distance_fault *fault);

/* ---- shapes.c ---------------------------------------------------------------------------------------- */
/* Finds the signed distance of a point in axes of the body, and its gradient. */
double mpmi_shape_distance(int32_t shape, int32_t dim, const double *size, const double *x, double *normal);

/* ---- rigid_motion.c ---------------------------------------------------------------------------------- */
/* axis[k] becomes axis k of the body in space. */
void mpmi_pose_axes(const double *orientation, double axis[3][3]);
/* Sets masses of a free surface, and its velocities to those without contact. */
void mpmi_rigid_predict(mpmi_rigid_surface *surface, const double *gravity, double dt);
/* Returns the change of velocity along a vector at the end of an arm, times its length squared, for a unit
 * impulse along it. */
double mpmi_rigid_compliance(const mpmi_rigid_surface *surface, const double *arm, const double *along);
/* Gives an impulse to a free surface, at the end of an arm. */
void mpmi_rigid_push(mpmi_rigid_surface *surface, const double *arm, const double *impulse);
/* Writes the pose after the step, to which the surface's velocities lead. */
void mpmi_rigid_move(const mpmi_rigid_surface *surface, double dt, mpmi_pose *next);
/* Moves a surface to that pose. */
void mpmi_surface_advance(mpmi_rigid_surface *surface, double dt);

#endif
