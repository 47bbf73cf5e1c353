/**
 * @file grid.h
 * The background grid: a box of equal cells that bounds the particles, with a basis. Nodal fields belong to
 * the stepper: see mpm_grid_map() in stepper.h.
 */
#ifndef MPM_GRID_H
#define MPM_GRID_H

#include <mpm/types.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Box, cells and basis of a grid. Fill the struct with mpm_grid_desc_init(). Entries of axes beyond dim are
 * ignored. */
typedef struct mpm_grid_desc {
  uint32_t struct_size;   /**< sizeof(mpm_grid_desc) of the caller */
  int32_t dim;            /**< 1 (uniaxial strain), 2 (see geometry) or 3 (default) */
  int32_t basis;          /**< MPM_LINEAR to MPM_CPGIMP; default MPM_BSPLINE2 */
  int32_t boundary_basis; /**< for B-splines: MPM_BOUNDARY_GHOST (default) or MPM_BOUNDARY_OPEN_KNOT */
  int32_t periodic[3];    /**< 1: the axis is periodic; default 0 */
  int32_t geometry;       /**< for dim 2: an MPM_PLANE_STRAIN (default) ... MPM_PLANE_STRESS. Since 0.2.0 */
  int64_t cells[3];       /**< cells along each axis, 1 to 6291456; memory follows the material */
  double origin[3];       /**< lower corner of the box, length; default 0 */
  double spacing[3];      /**< edges of a cell, length, > 0; the upper corner is origin + cells * spacing */
  double smoothing;       /**< for MPM_UGIMP: edge of a particle's domain / spacing, in (0, 1]; default 0.5 */
  /** 1: a total Lagrangian grid (de Vaucorbeil, Nguyen & Hutchinson 2020). Its cells hold the material as it
   * was before it deformed: weights follow from "reference_position" and stay what they are. Nothing is
   * sorted anew, particles do not cross cells, and material that is drawn out does not come apart. "position"
   * may leave the box. Walls, prescribed velocities, node hooks and nodal fields are those of nodes at their
   * places in the box, and so is MPM_WALL_FRICTION_NODES; obstacles and MPM_WALL_FRICTION meet particles
   * where they are now. For solids of one body: fluids, contact between bodies and MPM_WALL_OPEN are refused.
   * 0 (default): weights follow from "position". Since
   * 0.2.0 */
  int32_t total_lagrangian;
  int32_t reserved; /**< 0 */
} mpm_grid_desc;

/** Fills desc with the defaults; cells and spacing are 0, and the host must set them. struct_size is
 * sizeof(mpm_grid_desc) of the caller; no byte beyond is written. MPM_E_ARG: it is smaller than the first
 * released struct. Any thread, any time. */
MPM_API mpm_status mpm_grid_desc_init(mpm_grid_desc *desc, uint32_t struct_size);

/** Makes a grid. desc is copied. Any number of sets and steppers share the grid, which outlives them. *out is
 * NULL unless MPM_OK is returned. MPM_E_ARG: a value is bad, or there are more nodes than 64-bit numbers can
 * name. MPM_E_UNSUPPORTED: open knots are asked for with a basis other than MPM_BSPLINE2 and MPM_BSPLINE3;
 * MPM_AXISYMMETRIC and MPM_PLANE_STRESS with a dim other than 2, the former with a periodic first axis. */
MPM_API mpm_status mpm_grid_create(mpm_context *context, const mpm_grid_desc *desc, mpm_grid **out);

/** Frees the grid. NULL is fine. MPM_E_STATE while sets or steppers on it live. */
MPM_API mpm_status mpm_grid_destroy(mpm_grid *grid);

#ifdef __cplusplus
}
#endif

#endif
