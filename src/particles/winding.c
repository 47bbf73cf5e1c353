/* The generalised winding number (Jacobson, Kavan & Sorkine-Hornung 2013, ACM Trans. Graph. 32(4), 33): the
 * sum of the angles, in 3-D solid angles, under which the elements of a mesh are seen. Far away a patch is
 * seen as any other patch with the same boundary would be, and a fan over the boundary has fewer elements. */
#include <math.h>

#include "particles/mesh.h"
#include "simd/vector3.h"

enum { DEEPEST = 64, MOST_IN_HOLES = 256 };
static const double pi = 3.14159265358979323846;

/* The angle of the vector (x, y), from -pi to pi; 0 for the zero vector. Halving the angle twice brings the
 * tangent below 1/5, where twelve terms of the series are enough. */
static double angle_of(double y, double x) {
  enum { TERMS = 12 };
  const double long_side = fmax(fabs(x), fabs(y)), short_side = fmin(fabs(x), fabs(y));
  if (long_side == 0.0) return 0.0;
  double t = short_side / long_side, sum = 0.0;
  for (int32_t i = 0; i < 2; ++i) t /= 1.0 + sqrt(1.0 + t * t);
  for (int32_t k = TERMS - 1; k >= 0; --k) sum = 1.0 / (2 * k + 1) - t * t * sum;
  double angle = 4.0 * t * sum;
  if (fabs(y) > fabs(x)) angle = 0.5 * pi - angle;
  if (x < 0.0) angle = pi - angle;
  return copysign(angle, y);
}

static double volume_of(const double *a, const double *b, const double *c) {
  double across[3];
  mpmi_cross(b, c, across);
  return mpmi_inner(a, across);
}

static void from_point(int32_t dim, const double *x, const double *p, double *out) {
  for (int32_t k = 0; k < dim; ++k) out[k] = p[k] - x[k];
}

/* Tells on which side of an element's plane or line a point is: the sign of this, which is also a volume. */
static double side_of(int32_t dim, const double *x, const double *const *corner) {
  double d[3][3];
  for (int32_t j = 0; j < dim; ++j) from_point(dim, x, corner[j], d[j]);
  return dim == 3 ? volume_of(d[0], d[1], d[2]) : d[0][0] * d[1][1] - d[0][1] * d[1][0];
}

/* The solid angle of a triangle (Van Oosterom & Strackee 1983, IEEE Trans. Biomed. Eng. 30, 125) over 4 pi,
 * or the angle of an edge over 2 pi. A point in the plane of the element sees none of it. */
static double share_of(int32_t dim, const double *x, const double *const *corner) {
  double d[3][3];
  for (int32_t j = 0; j < dim; ++j) from_point(dim, x, corner[j], d[j]);
  const double *a = d[0], *b = d[1], *c = d[2];
  if (dim == 2) {
    const double area = a[0] * b[1] - a[1] * b[0];
    return area == 0.0 ? 0.0 : angle_of(area, a[0] * b[0] + a[1] * b[1]) / (2.0 * pi);
  }
  const double volume = volume_of(a, b, c);
  if (volume == 0.0) return 0.0;
  const double A = sqrt(mpmi_inner(a, a)), B = sqrt(mpmi_inner(b, b)), C = sqrt(mpmi_inner(c, c));
  return angle_of(volume, A * B * C + mpmi_inner(a, b) * C + mpmi_inner(b, c) * A + mpmi_inner(c, a) * B) /
         (2.0 * pi);
}

static void element_of(const mpmi_mesh *mesh, int32_t element, const double **corner) {
  for (int32_t j = 0; j < mesh->dim; ++j)
    corner[j] = mesh->point + (int64_t)mesh->dim * mesh->corner[(int64_t)element * mesh->dim + j];
}

/* The fan joins the boundary of a patch to one of its points. */
static void fan_of(const mpmi_mesh *mesh, const mpmi_patch *patch, int64_t i, const double **corner) {
  const mpmi_side *side = mesh->side + patch->side;
  corner[0] = mesh->point + (int64_t)mesh->dim * side->from;
  corner[1] = mesh->point + (int64_t)mesh->dim * side[i].from;
  corner[2] = mesh->point + (int64_t)mesh->dim * side[i].to;
}

static double elements_share(const mpmi_mesh *mesh, const mpmi_patch *of, const double *x) {
  const double *corner[3];
  double sum = 0.0;
  for (int32_t e = of->begin; e < of->end; ++e) {
    element_of(mesh, e, corner);
    sum += share_of(mesh->dim, x, corner);
  }
  return sum;
}

static double fan_share(const mpmi_mesh *mesh, const mpmi_patch *of, const double *x) {
  const double *corner[3];
  double sum = 0.0;
  for (int64_t i = 0; i < of->sides; ++i) {
    fan_of(mesh, of, i, corner);
    sum += mesh->side[of->side + i].times * share_of(mesh->dim, x, corner);
  }
  return sum;
}

static int32_t is_outside(const mpmi_mesh *mesh, const mpmi_patch *patch, const double *x) {
  for (int32_t k = 0; k < mesh->dim; ++k)
    if (x[k] < patch->lower[k] || x[k] > patch->upper[k]) return 1;
  return 0;
}

double mpmi_mesh_winding(const mpmi_mesh *mesh, const double *x) {
  int32_t waiting[DEEPEST] = {0}, n = 1;
  double sum = 0.0;
  while (n > 0) {
    const int32_t at = waiting[--n];
    const mpmi_patch *patch = &mesh->patch[at];
    if (patch->sides >= 0 && is_outside(mesh, patch, x)) {
      sum += fan_share(mesh, patch, x);
    } else if (!patch->second) {
      sum += elements_share(mesh, patch, x);
    } else {
      waiting[n++] = patch->second;
      waiting[n++] = at + 1;
    }
  }
  return sum;
}

static int32_t has_few_holes(const mpmi_mesh *mesh) {
  return mesh->patch->sides >= 0 && mesh->patch->sides <= MOST_IN_HOLES;
}

double mpmi_mesh_holes(const mpmi_mesh *mesh, const double *x) {
  return has_few_holes(mesh) ? fan_share(mesh, mesh->patch, x) : 0.0;
}

/* Tells whether an element may lie between two points: its box meets theirs, and so does its plane. */
static int32_t is_between(int32_t dim, const double *const *corner, const double *x, const double *y) {
  for (int32_t k = 0; k < dim; ++k) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int32_t j = 0; j < dim; ++j) {
      low = fmin(low, corner[j][k]);
      high = fmax(high, corner[j][k]);
    }
    if (low > fmax(x[k], y[k]) || high < fmin(x[k], y[k])) return 0;
  }
  return !(side_of(dim, x, corner) * side_of(dim, y, corner) > 0.0);
}

static int32_t patch_is_between(const mpmi_mesh *mesh, const mpmi_patch *patch, const double *x,
                                const double *y) {
  for (int32_t k = 0; k < mesh->dim; ++k)
    if (patch->lower[k] > fmax(x[k], y[k]) || patch->upper[k] < fmin(x[k], y[k])) return 0;
  return 1;
}

int32_t mpmi_mesh_same_side(const mpmi_mesh *mesh, const double *x, const double *y) {
  const mpmi_patch *whole = mesh->patch;
  const double *corner[3];
  if (!has_few_holes(mesh)) return 0;
  for (int64_t i = 0; i < whole->sides; ++i) {
    fan_of(mesh, whole, i, corner);
    if (is_between(mesh->dim, corner, x, y)) return 0;
  }
  int32_t waiting[DEEPEST] = {0}, n = 1;
  while (n > 0) {
    const int32_t at = waiting[--n];
    const mpmi_patch *patch = &mesh->patch[at];
    if (!patch_is_between(mesh, patch, x, y)) continue;
    if (patch->second) {
      waiting[n++] = patch->second;
      waiting[n++] = at + 1;
      continue;
    }
    for (int32_t e = patch->begin; e < patch->end; ++e) {
      element_of(mesh, e, corner);
      if (is_between(mesh->dim, corner, x, y)) return 0;
    }
  }
  return 1;
}
