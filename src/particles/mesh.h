/* A closed mesh as patches of patches, so that it can be told how often the mesh winds round a point. */
#ifndef MPMI_MESH_H
#define MPMI_MESH_H

#include "particles/particles.h"

/* A part of the boundary of a patch: in 3-D the edge from < to, in 2-D the point `from`. times counts how
 * often it is passed in this direction, less how often in the other. */
typedef struct mpmi_side {
  int32_t from, to, times;
} mpmi_side;

/* The elements [begin, end) and the box around them. Its two halves are the next patch and `second`, or it
 * has none: second is then 0. Its boundary is sides [side, side + sides), or not kept: sides is then -1. */
typedef struct mpmi_patch {
  double lower[3], upper[3];
  int64_t side, sides;
  int32_t begin, end, second;
} mpmi_patch;

/* Lengths are scaled by a power of two, so that the mesh is about 1 large. Points with the same coordinates
 * are one point. */
typedef struct mpmi_mesh {
  mpm_context *context;
  int32_t dim;
  double scale, lower[3], upper[3];
  int64_t given, points, elements, patches, sides, side_capacity;
  double *point;     /* [points][dim], with room for all `given` points */
  int32_t *corner;   /* [elements][dim], neighbours next to each other */
  mpmi_patch *patch; /* patch[0] is the whole */
  mpmi_side *side;
} mpmi_mesh;

/* Checks and copies a mesh: positions [dim][points], corners [elements][dim]. On failure there is nothing to
 * close. */
mpm_status mpmi_mesh_open(mpm_context *context, int32_t dim, int64_t points, const double *position,
                          int64_t elements, const int64_t *corner, mpmi_mesh *out);
void mpmi_mesh_close(mpmi_mesh *mesh);
/* Divides the mesh into patches: for mpmi_mesh_open(). */
mpm_status mpmi_mesh_divide(mpmi_mesh *mesh);

/* The generalised winding number of the mesh round x, which is scaled: 1 inside a closed mesh whose elements
 * look outwards and 0 outside, and between the two near a hole. */
double mpmi_mesh_winding(const mpmi_mesh *mesh, const double *x);
/* The part of it that the fan over the holes makes up: the mesh less that fan is closed, so that the rest
 * is a whole number. 0 for a mesh with many holes. */
double mpmi_mesh_holes(const mpmi_mesh *mesh, const double *x);
/* Tells whether that whole number surely is the same at x and at y: no element and no part of the fan lies
 * between the two. The answer is no, too, where a mesh has too many holes to look at. */
int32_t mpmi_mesh_same_side(const mpmi_mesh *mesh, const double *x, const double *y);

#endif
