/* Markers come, go and are split. */
#include "surface/surface.h"

#include <math.h>
#include <string.h>

/* ---- areas --------------------------------------------------------------------------------------------- */
void mpmi_marker_area(const mpmi_marker *m, const mpm_grid *grid, double *area) {
  const int32_t dim = mpmi_strain_dim(grid);
  const double *a = m->edge[0], *b = m->edge[1];
  area[0] = dim == 1 ? a[0] : dim == 2 ? a[1] : a[1] * b[2] - a[2] * b[1];
  area[1] = dim == 1 ? 0.0 : dim == 2 ? -a[0] : a[2] * b[0] - a[0] * b[2];
  area[2] = dim < 3 ? 0.0 : a[0] * b[1] - a[1] * b[0];
}

static double length_of(const double *v) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

double mpmi_marker_size(const mpmi_marker *m, const mpm_grid *grid) {
  double area[3];
  mpmi_marker_area(m, grid, area);
  return length_of(area);
}

/* Finds the edges of a square: one along the axis to which the area vector is most across. */
static void make_square(const double *area, double size, double (*edge)[3]) {
  double n[3], along[3], length = 0.0;
  int32_t k = 0;
  for (int32_t c = 0; c < 3; ++c) n[c] = size > 0.0 ? area[c] / size : 0.0;
  for (int32_t c = 1; c < 3; ++c)
    if (fabs(n[c]) < fabs(n[k])) k = c;
  for (int32_t c = 0; c < 3; ++c) along[c] = (c == k ? 1.0 : 0.0) - n[k] * n[c];
  length = length_of(along);
  for (int32_t c = 0; c < 3; ++c) edge[0][c] = sqrt(size) * along[c] / length;
  for (int32_t c = 0; c < 3; ++c)
    edge[1][c] = n[(c + 1) % 3] * edge[0][(c + 2) % 3] - n[(c + 2) % 3] * edge[0][(c + 1) % 3];
}

void mpmi_marker_set_radius(mpmi_marker *m, const mpm_grid *grid) {
  if (mpmi_is_axisymmetric(grid)) m->edge[1][2] = m->position[0];
}

void mpmi_marker_set_reference(mpmi_marker *m) {
  memcpy(m->reference, m->position, sizeof m->reference);
  memcpy(m->reference_edge, m->edge, sizeof m->reference_edge);
}

void mpmi_marker_set_area(mpmi_marker *m, const mpm_grid *grid, const double *area) {
  const int32_t dim = grid->dim;
  double a[3] = {0.0, 0.0, 0.0};
  for (int32_t c = 0; c < dim; ++c) a[c] = area[c];
  memset(m->edge, 0, sizeof m->edge);
  m->reference_area = length_of(a);
  if (dim == 1) m->edge[0][0] = a[0];
  if (dim == 2) m->edge[0][0] = -a[1], m->edge[0][1] = a[0];
  if (dim == 3) make_square(a, m->reference_area, m->edge);
  mpmi_marker_set_radius(m, grid);
  for (int32_t c = 0; c < 2 && mpmi_is_axisymmetric(grid); ++c)
    m->edge[0][c] = m->position[0] > 0.0 ? m->edge[0][c] / m->position[0] : 0.0;
  mpmi_marker_set_reference(m);
}

mpm_status mpmi_marker_check_area(const mpm_surface *s, int64_t which, double radius, const double *area) {
  const double much = 1e-9; /* more than rounding */
  if (!mpmi_is_axisymmetric(s->grid) || !(fabs(area[0]) + fabs(area[1]) > 0.0)) return MPM_OK;
  if (radius > 0.0 && fabs(area[1]) <= (2.0 + much) * radius * radius) return MPM_OK;
  if (radius > 0.0)
    return mpmi_fail(
        s->context, MPM_E_ARG,
        "marker %lld: area is (%g, %g) at the radius %g, so that its edge is %g wide and reaches "
        "beyond the axis: add several smaller ones",
        (long long)which, area[0], area[1], radius, fabs(area[1]) / radius);
  return mpmi_fail(
      s->context, MPM_E_ARG,
      "marker %lld: area is (%g, %g), but it lies on the axis, where a ring has none: place it at "
      "a radius > 0",
      (long long)which, area[0], area[1]);
}

mpm_status mpmi_surface_changeable(const mpm_surface *s) {
  if (!s->stepper || !s->owner->in_step(s->stepper)) return MPM_OK;
  return mpmi_fail(s->context, MPM_E_STATE, "a staged step is under way: end or abort it first");
}

/* ---- coming -------------------------------------------------------------------------------------------- */
mpm_status mpmi_marker_place(const mpm_surface *s, int64_t which, double *position) {
  const int32_t k = mpmi_grid_place(s->grid, position, 1, NULL, 0);
  if (k < 0) return MPM_OK;
  char must[MPMI_GRID_TEXT];
  return mpmi_fail(s->context, MPM_E_ARG, "marker %lld: position[%d] is %.12g, must be %s", (long long)which,
                   (int)k, position[k], mpmi_grid_demand(s->grid, k, must));
}

mpm_status mpmi_surface_check_count(const mpm_surface *s, const char *what, int64_t n) {
  if (n >= 0 && n <= MPMI_MOST_MARKERS) return MPM_OK;
  return mpmi_fail(s->context, MPM_E_ARG, "%s is %lld, must be >= 0 and at most %d", what, (long long)n,
                   (int)MPMI_MOST_MARKERS);
}

mpm_status mpmi_markers_reserve(mpm_context *c, mpmi_markers *markers, int64_t more) {
  if (more > MPMI_MOST_MARKERS - markers->count)
    return mpmi_fail(c, MPM_E_ARG, "%lld more markers are too many: a surface has at most %d",
                     (long long)more, (int)MPMI_MOST_MARKERS);
  const int64_t wanted = markers->count + more;
  if (wanted <= markers->capacity) return MPM_OK;
  const int64_t capacity = wanted > 2 * markers->capacity ? wanted : 2 * markers->capacity;
  mpmi_marker *at = mpmi_alloc(c, mpmi_bytes(capacity, sizeof *at));
  if (!at) return MPM_E_NOMEM;
  if (markers->count) memcpy(at, markers->at, (size_t)markers->count * sizeof *at);
  MPMI_FREE_ARRAY(c, markers->at, markers->capacity);
  markers->at = at;
  markers->capacity = capacity;
  return MPM_OK;
}

mpmi_marker *mpmi_markers_append(mpmi_markers *markers, const mpmi_marker *marker) {
  mpmi_marker *at = &markers->at[markers->count++];
  *at = *marker;
  at->id = markers->next_id++;
  return at;
}

mpm_status mpmi_markers_copy(mpm_context *c, const mpmi_markers *from, mpmi_markers *to) {
  to->count = 0;
  const mpm_status status = mpmi_markers_reserve(c, to, from->count);
  if (status) return status;
  if (from->count) memcpy(to->at, from->at, (size_t)from->count * sizeof *to->at);
  to->count = from->count;
  to->next_id = from->next_id;
  return MPM_OK;
}

void mpmi_markers_free(mpm_context *c, mpmi_markers *markers) {
  MPMI_FREE_ARRAY(c, markers->at, markers->capacity);
  *markers = (mpmi_markers){.count = 0};
}

mpm_status mpm_surface_add(mpm_surface *s, int64_t n, const double *position, const double *area,
                           int64_t *first_id) {
  MPMI_ENTER(s, MPMI_SURFACE);
  mpm_context *c = s->context;
  const int32_t dim = s->grid->dim;
  const int64_t had = s->now.count, next_id = s->now.next_id;
  mpm_status status = mpmi_surface_changeable(s);
  if (!status) status = mpmi_surface_check_count(s, "n", n);
  if (!status && n && !position) status = mpmi_fail(c, MPM_E_ARG, "position is NULL");
  if (!status) status = mpmi_markers_reserve(c, &s->now, n);
  for (int64_t i = 0; i < n && !status; ++i) {
    mpmi_marker m = {.id = 0};
    double a[3] = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < dim && !status; ++k) {
      m.position[k] = position[k * n + i];
      if (area) a[k] = area[k * n + i];
      if (!isfinite(a[k]))
        status = mpmi_fail(c, MPM_E_ARG, "marker %lld: area[%d] is %g, must be finite", (long long)i, (int)k,
                           a[k]);
    }
    if (!status) status = mpmi_marker_place(s, i, m.position);
    if (!status) status = mpmi_marker_check_area(s, i, m.position[0], a);
    if (status) break;
    mpmi_marker_set_area(&m, s->grid, a);
    if (!isfinite(m.reference_area))
      status = mpmi_fail(c, MPM_E_ARG, "marker %lld: the area is beyond the range of double precision",
                         (long long)i);
    mpmi_markers_append(&s->now, &m);
  }
  if (status)
    s->now.count = had, s->now.next_id = next_id;
  else if (first_id)
    *first_id = next_id;
  return status;
}

/* ---- going --------------------------------------------------------------------------------------------- */
int64_t mpmi_markers_find(const mpmi_markers *markers, int64_t id) {
  int64_t low = 0, high = markers->count;
  while (low < high) {
    const int64_t middle = low + (high - low) / 2;
    if (markers->at[middle].id < id)
      low = middle + 1;
    else
      high = middle;
  }
  return low < markers->count && markers->at[low].id == id ? low : -1;
}

mpm_status mpm_surface_remove(mpm_surface *s, int64_t n, const int64_t *ids) {
  MPMI_ENTER(s, MPMI_SURFACE);
  mpm_context *c = s->context;
  mpmi_markers *now = &s->now;
  mpm_status status = mpmi_surface_changeable(s);
  if (!status && n < 0) status = mpmi_fail(c, MPM_E_ARG, "n is %lld, must be >= 0", (long long)n);
  if (!status && n && !ids) status = mpmi_fail(c, MPM_E_ARG, "ids is NULL");
  if (status) return status;
  const int64_t count = now->count;
  uint8_t *goes = mpmi_alloc_zeroed(c, (size_t)count);
  if (!goes) return MPM_E_NOMEM;
  for (int64_t i = 0; i < n && !status; ++i) {
    const int64_t at = mpmi_markers_find(now, ids[i]);
    if (at < 0)
      status = mpmi_fail(c, MPM_E_NOT_FOUND, "the surface has no marker with id %lld", (long long)ids[i]);
    else if (goes[at])
      status = mpmi_fail(c, MPM_E_ARG, "id %lld is given twice", (long long)ids[i]);
    else
      goes[at] = 1;
  }
  int64_t stay = 0;
  for (int64_t i = 0; i < count && !status; ++i)
    if (!goes[i]) now->at[stay++] = now->at[i];
  if (!status) now->count = stay;
  mpmi_free(c, goes, (size_t)count);
  return status;
}

/* ---- splitting ----------------------------------------------------------------------------------------- */
/* Halves a marker across one of its edges; `half` becomes the far half. */
static void halve(const mpm_grid *grid, mpmi_marker *m, int32_t e, mpmi_marker *half) {
  m->reference_area *= 0.5;
  for (int32_t k = 0; k < 3; ++k) {
    m->edge[e][k] *= 0.5;
    m->reference_edge[e][k] *= 0.5;
    m->force[k] *= 0.5;
    m->reaction[k] *= 0.5;
  }
  *half = *m;
  for (int32_t k = 0; k < grid->dim; ++k) {
    m->position[k] -= 0.5 * m->edge[e][k];
    half->position[k] += 0.5 * m->edge[e][k];
    m->reference[k] -= 0.5 * m->reference_edge[e][k];
    half->reference[k] += 0.5 * m->reference_edge[e][k];
  }
}

/* Brings the half of a split marker, whose edge ended beyond a face, back onto it. */
static void keep_inside(const mpm_grid *grid, mpmi_marker *m) {
  double *x = mpmi_is_total_lagrangian(grid) ? m->reference : m->position;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double low = grid->desc.origin[k], high = grid->upper[k];
    if (grid->desc.periodic[k]) continue;
    x[k] = x[k] < low ? low : x[k] > high ? high : x[k];
  }
  mpmi_grid_place(grid, x, 1, NULL, 0);
  if (mpmi_is_axisymmetric(grid)) {
    const double was = m->edge[1][2];
    m->position[0] = fmax(m->position[0], 0.0);
    m->reference_edge[1][2] = m->reference[0];
    mpmi_marker_set_radius(m, grid);
    m->reference_area *= was > 0.0 ? m->edge[1][2] / was : 1.0;
  }
}

mpm_status mpmi_markers_split(mpm_context *c, const mpm_grid *grid, mpmi_markers *markers, double spacing,
                              int32_t once) {
  const int64_t had = markers->count;
  for (int64_t i = 0; i < (once ? had : markers->count) && grid->dim > 1;) {
    const double first = length_of(markers->at[i].edge[0]);
    const double second = mpmi_is_axisymmetric(grid) ? 0.0 : length_of(markers->at[i].edge[1]);
    const int32_t is_long = first > spacing || second > spacing;
    if (is_long && markers->count >= MPMI_MOST_MARKERS)
      return mpmi_fail(c, MPM_E_ARG, "a spacing of %g makes more than %d markers", spacing,
                       (int)MPMI_MOST_MARKERS);
    if (is_long) {
      const mpm_status status = mpmi_markers_reserve(c, markers, 1);
      if (status) return status;
      mpmi_marker half;
      halve(grid, &markers->at[i], second > first, &half);
      keep_inside(grid, &markers->at[i]);
      keep_inside(grid, mpmi_markers_append(markers, &half));
    }
    if (once || !is_long) ++i;
  }
  return MPM_OK;
}

/* Returns how many markers those of a list come to, or some more than there may be: each of their edges is
 * halved until it is short. */
static double split_count(const mpmi_markers *markers, const mpm_grid *grid, double spacing) {
  double count = 0.0;
  for (int64_t i = 0; i < markers->count; ++i) {
    double of = 1.0;
    for (int32_t e = 0; e < (mpmi_is_axisymmetric(grid) ? 1 : grid->dim - 1); ++e) {
      double parts = length_of(markers->at[i].edge[e]) / spacing;
      for (; parts > 1.0 && of <= (double)MPMI_MOST_MARKERS; parts *= 0.5) of *= 2.0;
    }
    count += of;
  }
  return count;
}

mpm_status mpm_surface_refine(mpm_surface *s, double spacing, int64_t *added) {
  MPMI_ENTER(s, MPMI_SURFACE);
  mpm_context *c = s->context;
  mpm_status status = mpmi_surface_changeable(s);
  if (!status && (!(spacing > 0.0) || !isfinite(spacing)))
    status = mpmi_fail(c, MPM_E_ARG, "spacing is %g, must be positive and finite", spacing);
  const int64_t had = s->now.count;
  const double come = status ? 0.0 : split_count(&s->now, s->grid, spacing);
  if (come > (double)MPMI_MOST_MARKERS)
    status = mpmi_fail(c, MPM_E_ARG, "a spacing of %g makes more than %d markers", spacing,
                       (int)MPMI_MOST_MARKERS);
  if (!status) status = mpmi_markers_copy(c, &s->now, &s->next);
  if (!status) status = mpmi_markers_split(c, s->grid, &s->next, spacing, 0);
  if (status) return status;
  const mpmi_markers old = s->now;
  s->now = s->next;
  s->next = old;
  if (added) *added = s->now.count - had;
  return MPM_OK;
}
