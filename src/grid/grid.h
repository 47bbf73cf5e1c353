/* The background grid is a description only. Nodes are stored sparsely (grid/blocks.h); their values belong
 * to steppers.
 *
 * Basis functions ("nodes") have integer indices along each axis. A particle has an anchor, which is the
 * nearest node or the lower node of its cell as the basis says; its stencil is `width` nodes from anchor -
 * below on. Node i lies at origin + i * spacing, except with open knots, where it stands at its Greville
 * point. */
#ifndef MPMI_GRID_H
#define MPMI_GRID_H

#include "context/context.h"

enum {
  MPMI_FAMILY_BSPLINE1,
  MPMI_FAMILY_BSPLINE2,
  MPMI_FAMILY_BSPLINE3,
  MPMI_FAMILY_GIMP,
  MPMI_FAMILY_OPEN_BSPLINE2, /* knots lie at the nodes and are repeated at the faces */
  MPMI_FAMILY_OPEN_BSPLINE3,
  MPMI_FAMILIES
};

/* Which domains particles have in the eyes of the basis. */
enum {
  MPMI_DOMAINS_NONE,     /* they are points */
  MPMI_DOMAINS_ALIKE,    /* all have the edges smoothing * spacing */
  MPMI_DOMAINS_OWN,      /* each has edges of its field "size" */
  MPMI_DOMAINS_STRETCHED /* which F stretches */
};

struct mpm_grid {
  uint32_t magic;
  int32_t children; /* sets and steppers on this grid */
  mpm_context *context;
  mpm_grid_desc desc;
  int32_t dim;
  int32_t family;  /* MPMI_FAMILY_...: the functions that make the weights */
  int32_t domains; /* MPMI_DOMAINS_... */
  int32_t width;   /* nodes of the stencil per axis */
  int32_t below;   /* how many of these lie below the anchor */
  int32_t centred; /* 1: the anchor is the nearest node; 0: the lower node of the cell */
  int32_t ghosts;  /* 1: there are nodes beyond the faces, -1 and cells + 1 */
  double moment;   /* sum w (x_i - x_p)^2 / h^2 where that is the same everywhere, else 0 */
  double upper[3], inverse_spacing[3];
  double h_min; /* smallest spacing */
};

/* Returns 1 when the functions of an axis are those of an open knot vector. Periodic axes have no ends. */
static inline int32_t mpmi_is_open(const mpm_grid *grid, int32_t axis) {
  return grid->family >= MPMI_FAMILY_OPEN_BSPLINE2 && !grid->desc.periodic[axis];
}
/* Returns 1 when the weight of a particle depends on the size of its domain. */
static inline int32_t mpmi_has_domains(const mpm_grid *grid) {
  return grid->domains >= MPMI_DOMAINS_OWN;
}
static inline int32_t mpmi_is_axisymmetric(const mpm_grid *grid) {
  return grid->desc.geometry == MPM_AXISYMMETRIC;
}
static inline int32_t mpmi_is_plane_stress(const mpm_grid *grid) {
  return grid->desc.geometry == MPM_PLANE_STRESS;
}
/* Returns 1 when the grid holds the material as it was before it deformed, by its reference positions. */
static inline int32_t mpmi_is_total_lagrangian(const mpm_grid *grid) {
  return grid->desc.total_lagrangian != 0;
}
/* Returns 1 when every set has the field "size": for its domains, or for the sections of its rings. */
static inline int32_t mpmi_has_sizes(const mpm_grid *grid) {
  return mpmi_has_domains(grid) || mpmi_is_axisymmetric(grid);
}
/* Returns the axes along which material stretches: rings stretch along the hoop as well. */
static inline int32_t mpmi_strain_dim(const mpm_grid *grid) {
  return mpmi_is_axisymmetric(grid) ? 3 : grid->dim;
}
/* Returns 1 for a face that is the axis of revolution. */
static inline int32_t mpmi_is_axis_face(const mpm_grid *grid, int32_t face) {
  return mpmi_is_axisymmetric(grid) && face == MPM_X_MIN && grid->desc.origin[0] == 0.0;
}
/* Returns the index of the node on a face: the one whose velocity is that of the material at the face, or
 * about whose plane the ghosts mirror. */
int64_t mpmi_face_node(const mpm_grid *grid, int32_t face);
/* Returns where a node stands on an axis. */
double mpmi_node_position(const mpm_grid *grid, int32_t axis, int64_t index);
/* Returns the number of a node that mpm_step_info.node reports. */
int64_t mpmi_node_number(const mpm_grid *grid, const int64_t *index);
/* Returns 1 where particles in the grid can have a node, and 0 beyond. On periodic axes all are images. */
int32_t mpmi_node_exists(const mpm_grid *grid, const int64_t *index);

/* Writes what a position must be along an axis, for messages; returns the text. */
enum { MPMI_GRID_TEXT = 128 };
const char *mpmi_grid_demand(const mpm_grid *grid, int32_t axis, char *text);
/* Tests a position (strided by `stride`) against the bounds and wraps it on periodic axes, adding the
 * periods crossed to image[] (may be NULL). Returns the first axis on which the position is not finite or
 * lies outside the bounds, or -1. A position on a bound is inside. */
int32_t mpmi_grid_place(const mpm_grid *grid, double *position, int64_t stride, int64_t *image,
                        int64_t image_stride);

#endif
