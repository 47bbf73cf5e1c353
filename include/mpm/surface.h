/**
 * @file surface.h
 * Surfaces: markers without mass that carry loads on the boundary of the material and move with it, or that
 * prescribe how it moves, wherever the grid lies.
 *
 * A marker is a small patch of a surface: a position and an area vector, the area times the normal that
 * points out of the material. The material carries it along and stretches it. Pressure, tractions and the
 * host's callback load it, and its force goes to the nodes around it, whole: what of it a node without mass
 * would take goes to the others, so that force and moment are kept; the force alone where the nodes with
 * mass around a marker are too few: on the linear basis and with GIMP in a cell at the rim, with quadratic
 * and cubic splines about a cell from the nearest particle. Nothing depends on how many particles lie under
 * a face, and the load acts on the face, not at the particles' centres behind it.
 *
 * Vectors have as many components as the grid has dimensions. Areas are per thickness in 2-D (of sheets that
 * at the start), and in 1-D numbers with a sign, which points out of the material. Forces and areas are
 * counted likewise. On a grid that is MPM_AXISYMMETRIC markers are rings, and areas and forces those of one
 * radian: length times radius. On the axis they have none. With total_lagrangian = 1 a marker keeps to the
 * material where it was added, by position and area before that deformed: add it before the body moves.
 *
 * A surface may also prescribe the velocity of the material, or the component of it along the area vectors:
 * mpm_surface_desc.prescribes. Its markers then move as they prescribe, whatever the material does, and keep
 * their area vectors: with MPM_PRESCRIBES_NORMAL material slides along the surface, past its markers.
 * It pushes and pulls. Markers with no material around them do nothing.
 *
 * - Implicit steps: springs between marker and material, of the stiffness beta A with beta = penalty times
 *   modulus over h, A the area of the marker and h the least spacing. They are part of the balance, and stay
 *   stretched from step to step: field "gap". Under a traction t the material is off by t / beta. With
 *   inertia a spring acts wholly at the end of the step, as contact does.
 * - Explicit steps: nodes with mass around markers get the mean of what these prescribe, weighted by area and
 *   shape function and moved along the surface to the node. So the surface is smeared over the nodes of a
 *   marker; the stable step stays as it is. What the host, prescribed particles, walls, surfaces that
 *   prescribe all components and those that were added before prescribe of a node comes first.
 *
 * Normals are smoothed over a cell and a half: smooth faces that meet at an edge are surfaces of their own.
 *
 * @par Sources
 * Penalty: Chandra, Singer, Teschemacher, Wuechner & Larese, Acta Geotech. 16, 2021. Area vectors: Nanson's
 * relation, in Holzapfel, Nonlinear Solid Mechanics, 2000, section 2.4. Weights next to nodes without mass:
 * the reproducing kernels of Liu, Jun and Zhang, Int. J. Numer. Meth. Fluids 20, 1995.
 * docs/theory.md has the equations.
 */
#ifndef MPM_SURFACE_H
#define MPM_SURFACE_H

#include <mpm/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Markers of a surface. It belongs to a grid, and may be in one stepper at a time. */
typedef struct mpm_surface mpm_surface;

/** Loads of all markers of a surface, and what it prescribes. What markers carry by themselves ("pressure",
 * "traction", "dead_traction", "prescribed_velocity") and what the callbacks give comes on top. Fill it
 * with mpm_surface_desc_init(). */
typedef struct mpm_surface_desc {
  uint32_t struct_size; /**< sizeof(mpm_surface_desc) of the caller */
  int32_t body;       /**< velocity field that it loads and moves with (mpm_stepper_set_body()); default 0 */
  double pressure;    /**< force/area against the normal, on the present area: it follows the surface */
  double traction[3]; /**< force per present area, in a fixed direction */
  double dead_traction[3]; /**< force per area at the time when the marker was added: a dead load */
  /** Length > 0: markers with a longer edge are split in two at the end of a step, so that a surface that
   * stretches has no dents. Half a spacing is right. 0 (default): they are not. */
  double max_spacing;
  /** MPM_PRESCRIBES_...: what of the motion of the material the markers prescribe. Markers without area
   * prescribe nothing. Default MPM_PRESCRIBES_NOTHING. */
  int32_t prescribes;
  int32_t reserved;   /**< 0 */
  double velocity[3]; /**< length/time: how the markers of a surface that prescribes move */
  double penalty;     /**< implicit steps: stiffness of the springs in modulus / spacing, > 0; default 100 */
  /** Implicit steps, force/area >= 0: the modulus of the springs. 0 (default): in each step the largest of
   * density times wave speed squared among the particles of the body, which is lambda + 2 mu. */
  double modulus;
} mpm_surface_desc;

/** Markers for which tractions are wanted. Arrays are [components][ld], belong to the library and are valid
 * during the call. */
typedef struct mpm_marker_batch {
  uint32_t struct_size; /**< sizeof(mpm_marker_batch) of the library; see mpm.h */
  int32_t dim;          /**< dimension of the grid */
  int64_t n;            /**< number of markers */
  int64_t ld;           /**< distance from component c to c + 1, in elements; >= n */
  double t;  /**< time for which the value is wanted: the start of the step, or the end of an implicit one */
  double dt; /**< size of the step */
  const int64_t *id;            /**< [ld] ids, ascending */
  const double *position;       /**< [dim][ld] */
  const double *area;           /**< [dim][ld] area vectors */
  const double *reference_area; /**< [ld] area when the marker was added */
  const double *displacement;   /**< [dim][ld] since the marker was added */
  const double *velocity;       /**< [dim][ld] of the material there, in the last step */
} mpm_marker_batch;

/** Gives tractions: the callback does add[c * ld + i] += force per present area of marker i, c < dim. It runs
 * on the thread of the call, once per step. Returns as mpm_particle_fn does. A value that is not finite ends
 * the step: MPM_NONFINITE. */
typedef mpm_status (*mpm_traction_fn)(void *user, const mpm_marker_batch *batch, double *add);

/** Gives velocities: the callback does add[c * ld + i] += mean velocity of marker i over the step that
 * begins at batch->t, c < dim. It runs on the thread of the call, once per step, for surfaces that
 * prescribe. Returns as mpm_particle_fn does. A value that is not finite ends the step: MPM_NONFINITE. */
typedef mpm_status (*mpm_marker_velocity_fn)(void *user, const mpm_marker_batch *batch, double *add);

/** Fills desc with the defaults. struct_size is sizeof(mpm_surface_desc) of the caller; no byte beyond is
 * written. MPM_E_ARG: it is smaller than the first released struct. Any thread, any time. */
MPM_API mpm_status mpm_surface_desc_init(mpm_surface_desc *desc, uint32_t struct_size);

/** Makes a surface without markers on a grid, which outlives it. desc is copied and may be NULL for the
 * defaults. *out is NULL unless MPM_OK is returned. MPM_E_ARG: a value is bad, or the grid is of another
 * context. */
MPM_API mpm_status mpm_surface_create(mpm_context *context, mpm_grid *grid, const mpm_surface_desc *desc,
                                      mpm_surface **out);

/** Frees a surface; NULL is let pass. MPM_E_STATE: a stepper holds it. */
MPM_API mpm_status mpm_surface_destroy(mpm_surface *surface);

/** Replaces loads and options between steps. Errors are those of mpm_surface_create(), and MPM_E_STATE during
 * a staged step. */
MPM_API mpm_status mpm_surface_configure(mpm_surface *surface, const mpm_surface_desc *desc);

/** Sets the callback that adds tractions. NULL takes it away. The host sets it again after it has loaded a
 * state. MPM_E_STATE during a staged step. */
MPM_API mpm_status mpm_surface_set_traction(mpm_surface *surface, mpm_traction_fn fn, void *user);

/** Sets the callback that adds to the velocities with which a surface that prescribes moves. NULL takes it
 * away. The host sets it again after it has loaded a state. MPM_E_STATE during a staged step. */
MPM_API mpm_status mpm_surface_set_velocity(mpm_surface *surface, mpm_marker_velocity_fn fn, void *user);

/**
 * Adds n markers.
 *
 * - position: [dim][n], in the grid; on periodic axes it is wrapped.
 * - area: [dim][n] area vectors, out of the material; NULL for markers without area, which follow the
 *   material and carry nothing.
 * - first_id: ids go up by one from the largest so far; the first is written to it. May be NULL.
 *
 * In 3-D a marker counts as a square when it is split. MPM_E_ARG: a value is not finite, a position is
 * outside the grid, the surface would have more than 2^28 markers, or the edge of a ring, which is its area
 * over its radius, would reach beyond the axis; nothing is added. MPM_E_STATE during a staged step.
 */
MPM_API mpm_status mpm_surface_add(mpm_surface *surface, int64_t n, const double *position,
                                   const double *area, int64_t *first_id);

/** Adds markers along the line through n points, position[2][n]; closed 1: back to the first. The material
 * lies on the left of the line, so that the outline of a body goes round counter-clockwise. Each edge is
 * divided into equal parts no longer than spacing > 0, with a marker in the middle of each: half a spacing of
 * the grid is right. *first_id and *count, which may be NULL, tell of the markers. MPM_E_UNSUPPORTED: the
 * grid is not 2-D. MPM_E_ARG: a closed line has one or two points, and so no inside. Else as
 * mpm_surface_add(). */
MPM_API mpm_status mpm_surface_add_polyline(mpm_surface *surface, int64_t n, const double *position,
                                            int32_t closed, double spacing, int64_t *first_id,
                                            int64_t *count);

/** Adds markers on triangles: position[3][n] of their corners, and corner[3 * i], corner[3 * i + 1], corner[3
 * * i + 2] the numbers of those of triangle i, counter-clockwise as seen from outside the material. Each
 * triangle is divided into k^2 equal ones with edges no longer than spacing, with a marker in the middle of
 * each. MPM_E_UNSUPPORTED: the grid is not 3-D. MPM_E_ARG: there is no such corner. Else as
 * mpm_surface_add_polyline(). */
MPM_API mpm_status mpm_surface_add_triangles(mpm_surface *surface, int64_t n, const double *position,
                                             int64_t triangles, const int64_t *corner, double spacing,
                                             int64_t *first_id, int64_t *count);

/** Removes the n markers with the given ids: all or none. MPM_E_NOT_FOUND: an id is not in the surface.
 * MPM_E_ARG: an id is given twice. MPM_E_STATE during a staged step. */
MPM_API mpm_status mpm_surface_remove(mpm_surface *surface, int64_t n, const int64_t *ids);

/** Splits markers until no edge is longer than spacing > 0: total area, its moment and the loads are kept,
 * but for the moment where a half would lie beyond a face of the grid: it is put onto the face. One half
 * keeps the id, the other gets a new one. *added, which may be NULL, tells how many came. MPM_E_ARG: spacing
 * is bad, or more than 2^28 markers would come of it. MPM_E_STATE during a staged step. */
MPM_API mpm_status mpm_surface_refine(mpm_surface *surface, double spacing, int64_t *added);

/** The number of markers; 0 for NULL. */
MPM_API int64_t mpm_surface_count(const mpm_surface *surface);

/**
 * Copies a field of n markers into out, [components][n]. ids are [n], or NULL for all markers by ascending
 * id, where n is mpm_surface_count(). type and components must match the field.
 *
 * | field             | type | components | what it is                                              | set |
 * |-------------------|------|------------|---------------------------------------------------------|-----|
 * | "id"              | I64  | 1          |                                                         |     |
 * | "position"        | F64  | dim        | length                                                  | yes |
 * | "area"            | F64  | dim        | area vector, out of the material                        | yes |
 * | "reference_area"  | F64  | 1          | area when it was added or set                           |     |
 * | "displacement"    | F64  | dim        | since it was added, across periodic axes too            | yes |
 * | "velocity"        | F64  | dim        | of the material there, in the last step                 |     |
 * | "force"           | F64  | dim        | on the material, in the last step                       |     |
 * | "pressure"        | F64  | 1          | of this marker, beside mpm_surface_desc.pressure        | yes |
 * | "traction"        | F64  | dim        | likewise                                                | yes |
 * | "dead_traction"   | F64  | dim        | likewise                                                | yes |
 * | "prescribed_velocity" | F64 | dim     | of this marker, beside mpm_surface_desc.velocity        | yes |
 * | "reaction"        | F64  | dim        | force of what is prescribed on the material, last step  |     |
 * | "gap"             | F64  | dim        | implicit steps: way of the material off what it should  |     |
 *
 * MPM_E_NOT_FOUND: there is no such field or id. MPM_E_ARG: type, components or n do not match.
 */
MPM_API mpm_status mpm_surface_get(const mpm_surface *surface, const char *field, int32_t type,
                                   int32_t components, int64_t n, const int64_t *ids, void *out);

/** Copies values into a field, laid out as in mpm_surface_get(): all or none. Setting "area" makes it the
 * reference. Errors are those of mpm_surface_get(), and MPM_E_ARG: a value is not finite, a position is
 * outside the grid, or the field cannot be set. MPM_E_STATE during a staged step.
 * MPM_E_UNSUPPORTED: "position" or "area" with total_lagrangian = 1, whose weights keep to the markers that
 * were added: add others. */
MPM_API mpm_status mpm_surface_set(mpm_surface *surface, const char *field, int32_t type, int32_t components,
                                   int64_t n, const int64_t *ids, const void *values);

/**
 * Puts a surface into a stepper. In each step its markers load the nodes of mpm_surface_desc.body and move
 * with them, or as they prescribe; the work is part of mpm_step_info.external_work. Markers that go through
 * MPM_WALL_OPEN are removed. Steps end with
 *
 * - MPM_OFF_GRID: a marker would leave through a face that does not let it;
 * - MPM_NONFINITE: its load, what it prescribes or its new position is not finite;
 * - MPM_E_STATE: a marker with a load has no material around it.
 *
 * The text names marker and surface, the number of which counts the surfaces of the stepper from 0.
 * MPM_E_STATE: it is in a stepper already, or a step is under way. MPM_E_ARG: it is on another grid.
 *
 * In implicit steps forces are those at the end of the step, on the areas that surfaces then have. Pressure
 * and traction make the stiffness unsymmetric, so that the solvers for symmetric matrices are not offered;
 * what is prescribed, and loads of markers that prescribe, keep it symmetric.
 */
MPM_API mpm_status mpm_stepper_add_surface(mpm_stepper *stepper, mpm_surface *surface);

/** Takes a surface out; it keeps its markers. MPM_E_NOT_FOUND: it is not in this stepper. */
MPM_API mpm_status mpm_stepper_remove_surface(mpm_stepper *stepper, mpm_surface *surface);

/** Gives the force[dim] by which what a surface prescribes acts on the material: the mean over the last step,
 * the sum of "reaction" over the markers; 0 for a surface that prescribes nothing. Loads are no part of it.
 * MPM_E_NOT_FOUND: it is not in this stepper. MPM_E_STATE before the first step. */
MPM_API mpm_status mpm_stepper_surface_reaction(const mpm_stepper *stepper, const mpm_surface *surface,
                                                double *force);

/** Gives the impulse[dim] of it on the material, mass * length/time: the sum of
 * mpm_stepper_surface_reaction() times the time over which it acted, over all committed steps since the
 * surface was added or mpm_stepper_set_time() was called. A saved state holds it. MPM_E_NOT_FOUND: the
 * surface is not in this stepper. */
MPM_API mpm_status mpm_stepper_surface_impulse(const mpm_stepper *stepper, const mpm_surface *surface,
                                               double *impulse);

#ifdef __cplusplus
}
#endif

#endif
