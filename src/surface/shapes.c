/* Markers along lines and on triangles. */
#include "surface/surface.h"

#include <math.h>

/* Pieces along an edge at most: the markers of one call are countable. */
enum { MOST_PIECES = 1 << 20 };

static mpm_status check_spacing(const mpm_surface *s, double spacing) {
  if (spacing > 0.0 && isfinite(spacing)) return MPM_OK;
  return mpmi_fail(s->context, MPM_E_ARG, "spacing is %g, must be positive and finite", spacing);
}

static mpm_status check_points(const mpm_surface *s, int64_t n, const double *position) {
  mpm_context *c = s->context;
  const mpm_status status = mpmi_surface_check_count(s, "n", n);
  if (status) return status;
  if (n && !position) return mpmi_fail(c, MPM_E_ARG, "position is NULL");
  for (int64_t i = 0; i < n; ++i)
    for (int32_t k = 0; k < s->grid->dim; ++k)
      if (!isfinite(position[k * n + i]))
        return mpmi_fail(c, MPM_E_ARG, "point %lld: position[%d] is %g, must be finite", (long long)i, (int)k,
                         position[k * n + i]);
  return MPM_OK;
}

/* Finds into how many pieces of a spacing a length is divided. */
static mpm_status count_pieces(const mpm_surface *s, double length, double spacing, int64_t *pieces) {
  const double wanted = ceil(length / spacing * (1.0 - 1e-12));
  if (!(wanted <= MOST_PIECES))
    return mpmi_fail(s->context, MPM_E_ARG, "a spacing of %g divides an edge of length %g into more than %d",
                     spacing, length, (int)MOST_PIECES);
  *pieces = wanted < 1.0 ? 1 : (int64_t)wanted;
  return MPM_OK;
}

/* What was added by a call is taken back when it fails. */
static mpm_status end_adding(mpm_surface *s, mpm_status status, const mpmi_markers *before, int64_t *first_id,
                             int64_t *count) {
  if (status) {
    s->now.count = before->count;
    s->now.next_id = before->next_id;
    return status;
  }
  if (first_id) *first_id = before->next_id;
  if (count) *count = s->now.count - before->count;
  return MPM_OK;
}

/* Adds a marker whose edges are known; it must be in the grid. */
static mpm_status add_patch(mpm_surface *s, mpmi_marker *m) {
  mpm_status status = mpmi_marker_place(s, s->now.count, m->position);
  if (!status) status = mpmi_markers_reserve(s->context, &s->now, 1);
  if (status) return status;
  mpmi_marker_set_radius(m, s->grid);
  m->reference_area = mpmi_marker_size(m, s->grid);
  mpmi_marker_set_reference(m);
  mpmi_markers_append(&s->now, m);
  return MPM_OK;
}

/* ---- lines --------------------------------------------------------------------------------------------- */
static mpm_status add_edge(mpm_surface *s, const double *from, const double *to, double spacing) {
  const double along[2] = {to[0] - from[0], to[1] - from[1]};
  int64_t pieces = 0;
  mpm_status status = count_pieces(s, sqrt(along[0] * along[0] + along[1] * along[1]), spacing, &pieces);
  for (int64_t i = 0; i < pieces && !status; ++i) {
    mpmi_marker m = {.id = 0};
    for (int32_t k = 0; k < 2; ++k) {
      m.position[k] = from[k] + ((double)i + 0.5) / (double)pieces * along[k];
      m.edge[0][k] = along[k] / (double)pieces;
    }
    status = add_patch(s, &m);
  }
  return status;
}

mpm_status mpm_surface_add_polyline(mpm_surface *s, int64_t n, const double *position, int32_t closed,
                                    double spacing, int64_t *first_id, int64_t *count) {
  MPMI_ENTER(s, MPMI_SURFACE);
  mpm_context *c = s->context;
  const mpmi_markers before = s->now;
  mpm_status status = mpmi_surface_changeable(s);
  if (!status && s->grid->dim != 2)
    status =
        mpmi_fail(c, MPM_E_UNSUPPORTED, "the grid is %d-D: lines bound bodies in 2-D; use %s",
                  (int)s->grid->dim, s->grid->dim == 3 ? "mpm_surface_add_triangles()" : "mpm_surface_add()");
  if (!status && closed != 0 && closed != 1)
    status = mpmi_fail(c, MPM_E_ARG, "closed is %d, must be 0 or 1", (int)closed);
  if (!status) status = check_spacing(s, spacing);
  if (!status) status = check_points(s, n, position);
  if (!status && closed && n > 0 && n < 3)
    status = mpmi_fail(c, MPM_E_ARG,
                       "a closed line of %lld %s has no inside: give closed = 0 or at least three points",
                       (long long)n, n == 1 ? "point" : "points");
  for (int64_t i = 0; i < n && !status; ++i) {
    const int64_t j = i + 1 < n ? i + 1 : 0;
    const double from[2] = {position[i], position[n + i]}, to[2] = {position[j], position[n + j]};
    if (j || closed) status = add_edge(s, from, to, spacing);
  }
  return end_adding(s, status, &before, first_id, count);
}

/* ---- triangles ----------------------------------------------------------------------------------------- */
/* A parallelogram in the place of a triangle between the edges u and v: of the same centre and area, and
 * about as far across in each direction. */
static void take_edges(mpmi_marker *m, const double *u, const double *v) {
  for (int32_t k = 0; k < 3; ++k) {
    m->edge[0][k] = 0.375 * (u[k] + v[k]);
    m->edge[1][k] = 2.0 / 3.0 * (v[k] - u[k]);
  }
}

/* Divides a triangle into k rows of upright parts and of those that stand on their heads between them. */
static mpm_status add_triangle(mpm_surface *s, const double corner[3][3], double spacing) {
  double u[3], v[3], longest = 0.0;
  for (int32_t i = 0; i < 3; ++i) {
    double square = 0.0;
    for (int32_t k = 0; k < 3; ++k) {
      const double d = corner[(i + 1) % 3][k] - corner[i][k];
      square += d * d;
    }
    longest = square > longest ? square : longest;
  }
  int64_t pieces = 0;
  mpm_status status = count_pieces(s, sqrt(longest), spacing, &pieces);
  for (int32_t k = 0; k < 3; ++k) {
    u[k] = (corner[1][k] - corner[0][k]) / (double)pieces;
    v[k] = (corner[2][k] - corner[0][k]) / (double)pieces;
  }
  for (int64_t i = 0; i < pieces && !status; ++i)
    for (int64_t j = 0; j < pieces - i && !status; ++j)
      for (int32_t head = 0; head < 2 && !status; ++head) {
        const double share = head ? 2.0 / 3.0 : 1.0 / 3.0;
        mpmi_marker m = {.id = 0};
        if (head && i + j == pieces - 1) break; /* the last of a row has no neighbour */
        for (int32_t k = 0; k < 3; ++k)
          m.position[k] = corner[0][k] + ((double)i + share) * u[k] + ((double)j + share) * v[k];
        take_edges(&m, u, v);
        status = add_patch(s, &m);
      }
  return status;
}

static mpm_status read_triangle(const mpm_surface *s, int64_t n, const double *position, int64_t i,
                                const int64_t *corner, double out[3][3]) {
  for (int32_t j = 0; j < 3; ++j) {
    const int64_t p = corner[3 * i + j];
    if (p < 0 || p >= n)
      return mpmi_fail(s->context, MPM_E_ARG, "triangle %lld: corner %lld does not exist, there are %lld",
                       (long long)i, (long long)p, (long long)n);
    for (int32_t k = 0; k < 3; ++k) out[j][k] = position[k * n + p];
  }
  return MPM_OK;
}

mpm_status mpm_surface_add_triangles(mpm_surface *s, int64_t n, const double *position, int64_t triangles,
                                     const int64_t *corner, double spacing, int64_t *first_id,
                                     int64_t *count) {
  MPMI_ENTER(s, MPMI_SURFACE);
  mpm_context *c = s->context;
  const mpmi_markers before = s->now;
  mpm_status status = mpmi_surface_changeable(s);
  if (!status && s->grid->dim != 3)
    status =
        mpmi_fail(c, MPM_E_UNSUPPORTED, "the grid is %d-D: triangles bound bodies in 3-D; use %s",
                  (int)s->grid->dim, s->grid->dim == 2 ? "mpm_surface_add_polyline()" : "mpm_surface_add()");
  if (!status) status = mpmi_surface_check_count(s, "triangles", triangles);
  if (!status && triangles && !corner) status = mpmi_fail(c, MPM_E_ARG, "corner is NULL");
  if (!status) status = check_spacing(s, spacing);
  if (!status) status = check_points(s, n, position);
  for (int64_t i = 0; i < triangles && !status; ++i) {
    double at[3][3];
    status = read_triangle(s, n, position, i, corner, at);
    if (!status) status = add_triangle(s, (const double(*)[3])at, spacing);
  }
  return end_adding(s, status, &before, first_id, count);
}
