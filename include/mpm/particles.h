/**
 * @file particles.h
 * Sets of particles: how they are made, filled and emptied; their fields by name, as copies by id or as views
 * of the library's memory.
 *
 * | field                                | type | stored in 1-D / 2-D / 3-D                  | full | write |
 * |--------------------------------------|------|--------------------------------------------|------|-------|
 * | "id"                                 | I64  | 1                                          | 1    | no    |
 * | "position" "velocity" "acceleration" | F64  | dim                                        | dim  | yes   |
 * | "reference_position" "size"          | F64  | dim                                        | dim  | yes   |
 * | "applied_force"                      | F64  | dim                                        | dim  | yes   |
 * | "mass" "initial_volume"              | F64  | 1                                          | 1    | yes   |
 * | "volume"                             | F64  | 1                                          | 1    | no    |
 * | "deformation_gradient"               | F64  | xx / xx xy yx yy zz / 9                    | 9    | yes   |
 * | "velocity_gradient"                  | F64  | xx / xx xy yx yy / 9                       | 9    | yes   |
 * | "stress"                             | F64  | xx yy zz / xx yy zz xy / xx yy zz xy yz xz | 6    | law   |
 * | "state"                              | F64  | as the law says                            | same | yes   |
 * | "prescribed"                         | U8   | dim                                        | dim  | yes   |
 * | "image"                              | I64  | dim                                        | dim  | no    |
 * | "dilation_ratio"                     | F64  | 1                                          | 1    | yes   |
 * | the host's own                       | any  | as made                                    | same | yes   |
 *
 * Views show the stored components; copies and callbacks have the full ones. Where "write" says law, the host
 * may write the field if the law computes it from rates.
 *
 * - position: a length, inside the grid; with total_lagrangian = 1 anywhere, and not wrapped.
 * - velocity: length/time.
 * - acceleration: (v_new - v_old) / dt of the last step, once the host has set or mapped it; with staggered
 *   velocities over the mean of its dt and the one before. With MPM_NEWMARK the one at the end of the step.
 * - mass, initial_volume: > 0; a new particle has mass = density * initial_volume. Of MPM_AXISYMMETRIC the
 *   volume is that of one radian, the area in the plane times the radius; fills take care of that.
 * - volume: det F * initial_volume (MPoint theory, eq. 40).
 * - size: full initial edge lengths of the particle's domain, for MPM_GIMP and MPM_CPGIMP; edges beyond a
 *   cell count as one cell. Until set or given it is that of a cube (2-D: square) of the initial volume, of
 *   MPM_AXISYMMETRIC of the initial volume over the radius. There all sets have it, for contact.
 * - applied_force: a force on the particle that stays until changed (f^app of MPoint theory, eq. 21).
 * - deformation_gradient: det F > 0. Of MPM_PLANE_STRESS F33 > 0 is only where the search for it begins.
 * - velocity_gradient: the matrix that the transfer carries, 1/time: the affine one (MPM_APIC, MPM_APIC_MLS,
 *   MPM_AFLIP) or the gradient of the updated nodal velocities (MPM_TPIC, MPM_TFLIP); 0 in new particles.
 *   With MPM_FLIP, MPM_XPIC and MPM_FMPM it is kept only once the host has set or mapped it, and then is the
 *   L that deformed the particle in the last step. With total_lagrangian = 1 the matrix and L are those over
 *   reference positions: L is dF/dt.
 * - stress: Cauchy stress; writable where it is part of the law's state (linear_elastic, j2, drucker_prager,
 *   mohr_coulomb, cam_clay, mu_i, a law of the host; of herschel_bulkley the deviator), else computed from F,
 *   for snow from F and state.
 * - state: state variables of the law.
 * - reference_position: exists while a stepper with reference_positions holds the set, and starts as the
 *   unwrapped position at mpm_stepper_add(). With total_lagrangian = 1 all sets have it, from the time when
 *   particles are added: it says where they are in the grid, and must lie inside.
 * - prescribed: 0 or 1 (default 0; 1 on all axes in new particles of the law "rigid"). 1 on an axis imposes
 *   the particle's velocity there on the nodes that it touches: see mpm_stepper_set_motion().
 * - dilation_ratio: J'/J > 0, by which the volume that the law sees differs from that of
 *   deformation_gradient; exists while a stepper with locking_remedy holds the set, and starts as 1. The law
 *   sees (J'/J)^(1/dim) F, in plane strain in the plane only; of MPM_AXISYMMETRIC the third root on all axes.
 * - image: periods crossed on each periodic axis; position + image * period is the unwrapped position. Not
 *   with total_lagrangian = 1.
 *
 * size, acceleration, velocity_gradient, applied_force and prescribed take memory only when used; until then
 * all of these but size read as zeros.
 *
 * Fields are independent of each other, with one exception: once deformation_gradient, dilation_ratio or
 * initial_volume is set, volume, and the stress of laws that compute it from F, are brought up to date before
 * anything reads them (get, map, callbacks, mpm_stable_dt(), mpm_step()). So is the stress of snow once state
 * is set, and the mean of that of herschel_bulkley once stress is.
 *
 * Everything that changes a set returns MPM_E_STATE while a view of it is out or a staged step is under way.
 */
#ifndef MPM_PARTICLES_H
#define MPM_PARTICLES_H

#include <mpm/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Makes an empty set on a grid, of one material; both outlive it. *out is NULL unless MPM_OK is returned.
 * MPM_E_ARG: grid or material are of another context. MPM_E_UNSUPPORTED: a fluid on an MPM_CPGIMP
 * grid; a fluid, snow, clay or mu_i on an MPM_PLANE_STRESS grid; a fluid where total_lagrangian = 1. */
MPM_API mpm_status mpm_particles_create(mpm_context *context, mpm_grid *grid, mpm_material *material,
                                        mpm_particles **out);

/** Frees the set. NULL is fine. MPM_E_STATE while a stepper holds it or a view of it is out. */
MPM_API mpm_status mpm_particles_destroy(mpm_particles *particles);

/**
 * Adds n particles with F = I, zero stress and the law's initial state: all or none. The arrays are copied;
 * position, velocity and size are [dim][n] with ld = n.
 *
 * - position: a length, inside the grid; on a periodic axis one outside is wrapped, and its images are
 *   counted. With total_lagrangian = 1 the wrapped place is that in the grid, "reference_position" and
 *   "position" alike.
 * - velocity: length/time; NULL for zeros.
 * - volume: [n] initial volume, of the undeformed material, > 0; mass = density * volume.
 * - size: full initial edge lengths of the domain, > 0; NULL for a cube (2-D: square) of that volume.
 *   MPM_GIMP and MPM_CPGIMP use it; on other grids it is kept as given.
 * - ids: [n] the host's own ids, >= 0 and unique in the set; NULL to number on from the largest so far.
 *   A set holds fewer than 2^32 particles.
 * - first_id: the first of the ids is written to it; may be NULL.
 *
 * MPM_E_ARG: a value is not finite, a position is outside the grid, a volume or size is <= 0, or an id is
 * negative or in use.
 */
MPM_API mpm_status mpm_particles_add(mpm_particles *particles, int64_t n, const double *position,
                                     const double *velocity, const double *volume, const double *size,
                                     const int64_t *ids, int64_t *first_id);

/**
 * Fills the box from lower[dim] to upper[dim] with particles at rest on a lattice aligned with the cells,
 * with per_cell[dim] particles along each axis of a cell, wherever the centre is inside. Each has the volume
 * and the size of one lattice cell, so that domains of GIMP fill the body. The ids of the new particles are
 * *first_id to *first_id + *count - 1; both pointers may be NULL.
 *
 * What a shape has beyond the grid is left out, on periodic axes too, as symmetry planes want it: *count
 * tells how many particles there are. That holds for all fills. per_cell is 1 to 64, and a box has at
 * most 2^32 lattice points, in the shape or not.
 *
 * MPM_E_ARG: a bound is not finite, lower >= upper on an axis, the box does not meet the grid, or a limit is
 * exceeded.
 */
MPM_API mpm_status mpm_particles_fill_box(mpm_particles *particles, const double *lower, const double *upper,
                                          const int32_t *per_cell, int64_t *first_id, int64_t *count);

/** Fills a ball (2-D: disc, 1-D: interval) around centre[dim] of a radius > 0, as mpm_particles_fill_box()
 * fills a box. The centre lies in the grid. */
MPM_API mpm_status mpm_particles_fill_ball(mpm_particles *particles, const double *centre, double radius,
                                           const int32_t *per_cell, int64_t *first_id, int64_t *count);

/** Tells which of n points are inside a body: the callback writes inside[i] = 1 or 0 for the point with the
 * coordinates position[c * ld + i], c < dim. It runs on the calling thread. A return other than 0 ends the
 * fill with MPM_E_CALLBACK; nothing is then added. */
typedef mpm_status (*mpm_inside_fn)(void *user, int32_t dim, int64_t n, int64_t ld, const double *position,
                                    uint8_t *inside);

/** Fills that part of a box which the callback accepts, as mpm_particles_fill_box() fills the whole. */
MPM_API mpm_status mpm_particles_fill(mpm_particles *particles, const double *lower, const double *upper,
                                      const int32_t *per_cell, mpm_inside_fn inside, void *user,
                                      int64_t *first_id, int64_t *count);

/**
 * Fills what a mesh encloses, as mpm_particles_fill_box() fills a box: triangles in 3-D, edges in 2-D.
 *
 * - position: [dim][n] of the points; n is 1 to 2^31 - 1.
 * - corner: corner[dim * i + j] is the number of corner j of element i, of `elements`, 1 to 2^31 - 1. In 3-D
 *   the corners go counter-clockwise as seen from outside, in 2-D the outline goes counter-clockwise round
 *   the body. A mesh that is turned inside out encloses the same. Shells within that are turned the other way
 *   bound cavities.
 * - Points with the same coordinates are one point, so that triangles as files hold them need no sorting out.
 *
 * A particle comes wherever the generalised winding number is above 1/2 or below -1/2 (Jacobson, Kavan &
 * Sorkine-Hornung 2013, Robust inside-outside segmentation using generalized winding numbers, ACM Trans.
 * Graph. 32(4), 33). Bodies that overlap are filled once. Holes do no harm as long as they are small beside
 * the body, but a mesh without any costs far less time. A lattice point on the mesh itself may be in or out.
 * The mesh is read during the call only.
 *
 * MPM_E_ARG: a position is not finite, a corner does not exist, the mesh is flat or does not meet the grid,
 * or a limit is exceeded. MPM_E_UNSUPPORTED: the grid is 1-D. Nothing is then added.
 */
MPM_API mpm_status mpm_particles_fill_mesh(mpm_particles *particles, int64_t n, const double *position,
                                           int64_t elements, const int64_t *corner, const int32_t *per_cell,
                                           int64_t *first_id, int64_t *count);

/** Removes the n particles with the given ids: all or none. MPM_E_NOT_FOUND: an id is not in the set.
 * MPM_E_ARG: an id is given twice. */
MPM_API mpm_status mpm_particles_remove(mpm_particles *particles, int64_t n, const int64_t *ids);

/** The number of particles, inert slots not counted; 0 for NULL. */
MPM_API int64_t mpm_particles_count(const mpm_particles *particles);

/** Describes the field with number index (from 0): its name, its type (MPM_F64, MPM_I64 or MPM_U8), the
 * components of copies, and whether the host may write it. The name belongs to the library and is valid while
 * the set lives; output pointers may be NULL. MPM_E_NOT_FOUND: index is past the last field. */
MPM_API mpm_status mpm_particles_field_info(const mpm_particles *particles, int32_t index, const char **field,
                                            int32_t *type, int32_t *components, int32_t *writable);

/** Adds a field of the host, zero in every particle. It travels with the particles, is saved with them, and
 * reaches callbacks through mpm_batch_field(). The name has 1 to 47 characters of a-z, 0-9 and _; type is
 * MPM_F64, MPM_I64 or MPM_U8; components are 1 to 64. A set has at most 64 fields, the 17 of the table
 * included. MPM_E_ARG: the name is bad or taken, or a value is. MPM_E_STATE: there is no room for one
 * more. */
MPM_API mpm_status mpm_particles_add_field(mpm_particles *particles, const char *field, int32_t type,
                                           int32_t components);

/** Says of a field of the host that its values are amounts, as mass is, and not densities: particles that are
 * split share them, and merged ones have the sum. Of other fields they have the same value, and merged ones
 * the mean by initial volume. The field is of type MPM_F64; values of other types are those of the heavier
 * particle. extensive is 0 (as added) or 1. MPM_E_NOT_FOUND: there is no such field. MPM_E_ARG: the field is
 * not the host's, or of another type. MPM_E_STATE: as for all that changes a set. */
MPM_API mpm_status mpm_particles_set_extensive(mpm_particles *particles, const char *field,
                                               int32_t extensive);

/**
 * Lends a field in library order, with its stored components and with inert slots (id < 0); a map of "id"
 * tells which is which. access is MPM_READ, MPM_WRITE or both. The caller sets the view's struct_size. Until
 * mpm_view_release() steps return MPM_E_STATE. Of a set at most 64 views are out at once. A view without
 * MPM_WRITE is for reading: see mpm_view_release() for what becomes of changes. MPM_E_NOT_FOUND: there is no
 * such field. MPM_E_ARG: MPM_WRITE is asked for on a field that is not writable. MPM_E_STATE: 64 views are
 * out.
 */
MPM_API mpm_status mpm_particles_map(mpm_particles *particles, const char *field, int32_t access,
                                     mpm_view *view);

/**
 * Copies a field of n particles into out, [components][n] with ld = n; tensors are full. ids are [n], or NULL
 * for all particles by ascending id, where n is mpm_particles_count(). type and components must match the
 * full field, to guard the host's buffer. MPM_E_NOT_FOUND: there is no such field or id. MPM_E_ARG: type,
 * components or n do not match.
 */
MPM_API mpm_status mpm_particles_get(const mpm_particles *particles, const char *field, int32_t type,
                                     int32_t components, int64_t n, const int64_t *ids, void *out);

/**
 * Copies count named fields of all particles into floats for renderers: particles one after the other,
 * without inert slots, of each the components of the first field, then those of the second, and so on.
 * Components are those of mpm_particles_get(), with full tensors and dim components per vector, and out has n
 * times the sum of them.
 *
 * - order: MPM_BY_ID, or MPM_LIBRARY_ORDER, which is faster: it reads memory from front to back and needs no
 *   index of the ids. In it a particle may have another place after each step; the field "id" tells them
 *   apart.
 * - n: mpm_particles_count(), to guard the host's buffer.
 *
 * Values are rounded to the nearest float. Those that no float can hold become infinities with their sign
 * (from about 3.4e38 on), those below the smallest float (1.4e-45) become 0. Integers are exact up to 2^24 =
 * 16777216.
 *
 * MPM_E_NOT_FOUND: there is no such field. MPM_E_ARG: count is < 1, a field is named twice, or order or n is
 * none of these. Else as mpm_particles_get(); views may be out. Since 0.2.0.
 */
MPM_API mpm_status mpm_particles_get_f32(const mpm_particles *particles, int32_t count,
                                         const char *const *fields, int32_t order, int64_t n, float *out);

/** Copies values into a field, laid out as in mpm_particles_get(): all or none. Errors are those of
 * mpm_particles_get(), and MPM_E_ARG: a value is not finite or gives det F <= 0, a position is outside the
 * grid, or the field is not writable. */
MPM_API mpm_status mpm_particles_set(mpm_particles *particles, const char *field, int32_t type,
                                     int32_t components, int64_t n, const int64_t *ids, const void *values);

/** Sets a field to one value[components] in every particle of the set. Errors are those of
 * mpm_particles_set(). */
MPM_API mpm_status mpm_particles_set_all(mpm_particles *particles, const char *field, int32_t type,
                                         int32_t components, const void *value);

/**
 * Gives all particles the stress of ground at rest below a level surface: along `axis` the pressure of the
 * weight above, surcharge + density * |gravity| * depth with the material's density, and K0 times that across
 * it; no shear. Each layer is a set, whose surface is its top and whose surcharge the weight of what lies on
 * it.
 *
 * - gravity: acceleration along the axis, length/time^2, with its sign, as in mpm_stepper_desc: with a
 *   negative one the ground lies below the surface in the sense of falling coordinates. Not 0.
 * - surface: coordinate of the surface on the axis, a length. No particle may lie above it.
 * - K0: horizontal over vertical stress, >= 0: nu / (1 - nu) is what an elastic column has that was never
 *   strained across, 1 - sin(phi) what sand has. One that a law cannot bear is no error: its first step
 *   returns the stress to the yield surface.
 * - surcharge: pressure on the surface, a stress >= 0. It must also be applied, or the ground heaves.
 *
 * Positions, velocities, masses, state variables and present volumes stay. Where stress is the state of the
 * law, deformation_gradient becomes I and initial_volume the present volume. Where stress follows from
 * deformation_gradient, that becomes the diagonal one that has the stress, up to rounding, and initial_volume
 * the present volume over its determinant; in 1-D, where nothing is stored across, the stress across is then
 * that of the law, whatever K0 is. herschel_bulkley gets the mean of the stress so, and its deviator as it is
 * given. dilation_ratio becomes 1, and with MPM_CPGIMP the field "size" what keeps
 * the domains as they are.
 *
 * The set is unchanged on failure. MPM_E_ARG: a value is bad or not finite, the axis is periodic, a particle
 * lies above the surface, or no deformation has the stress; the particle is named. MPM_E_UNSUPPORTED: the law
 * is "rigid", or "snow", whose stress takes more than a deformation; it is "newtonian_fluid" and K0 is not 1;
 * or, of the host's laws, one that asked with dt = 0 does not answer with the stress that it has; the grid is
 * MPM_PLANE_STRESS, or axis the radius of MPM_AXISYMMETRIC; total_lagrangian = 1 and the stress follows from
 * deformation_gradient, or the ground has already deformed.
 * MPM_E_CALLBACK: that law failed. MPM_E_STATE: as for all that changes a set. Since 0.2.0.
 */
MPM_API mpm_status mpm_particles_set_geostatic(mpm_particles *particles, int32_t axis, double gravity,
                                               double surface, double K0, double surcharge);

/**
 * Makes the present state the one from which all deformation counts: deformation_gradient becomes I,
 * initial_volume the present volume, dilation_ratio 1, and reference_position, where there is one, the
 * present (unwrapped) position. With MPM_CPGIMP and of MPM_AXISYMMETRIC edges in "size" become the present
 * ones. Of MPM_PLANE_STRESS F33 stays. Mass, velocity, Cauchy stress and state variables stay. With
 * total_lagrangian = 1 particles are then in the grid where they are now, and velocity_gradient is over these
 * positions.
 *
 * Laws that store Cauchy stress and work with tau = J stress (drucker_prager, mohr_coulomb, mu_i, cam_clay)
 * find J = 1 from then on: elastic strain, energy per initial volume and cohesion count by the present
 * volume, which differ by the factor J from before; a stress on the yield surface may lie off it by as much,
 * and the next step returns it.
 *
 * The set is unchanged on failure. MPM_E_ARG: total_lagrangian = 1 and a particle is outside the box.
 * MPM_E_UNSUPPORTED: the stress of the law, or its mean, follows from
 * deformation_gradient, which must stay; or a law of the host, asked with dt = 0, does not answer with the
 * stress that it has. MPM_E_CALLBACK: that law failed. MPM_E_STATE: as for all that changes a set, and with
 * total_lagrangian = 1 while a surface of its stepper has markers, whose places count from the old reference.
 * Since 0.2.0.
 */
MPM_API mpm_status mpm_particles_reset_reference(mpm_particles *particles);

#ifdef __cplusplus
}
#endif

#endif
