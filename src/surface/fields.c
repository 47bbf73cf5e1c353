/* The fields of markers, by name. */
#include "surface/surface.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

enum { AREA = -1 }; /* is not stored as it is */

typedef struct field {
  const char *name;
  int32_t type, vector, writable, at; /* at: bytes from the beginning of a marker */
} field;

static const field fields[] = {
    {"id", MPM_I64, 0, 0, offsetof(mpmi_marker, id)},
    {"position", MPM_F64, 1, 1, offsetof(mpmi_marker, position)},
    {"area", MPM_F64, 1, 1, AREA},
    {"reference_area", MPM_F64, 0, 0, offsetof(mpmi_marker, reference_area)},
    {"displacement", MPM_F64, 1, 1, offsetof(mpmi_marker, displacement)},
    {"velocity", MPM_F64, 1, 0, offsetof(mpmi_marker, velocity)},
    {"force", MPM_F64, 1, 0, offsetof(mpmi_marker, force)},
    {"pressure", MPM_F64, 0, 1, offsetof(mpmi_marker, pressure)},
    {"traction", MPM_F64, 1, 1, offsetof(mpmi_marker, traction)},
    {"dead_traction", MPM_F64, 1, 1, offsetof(mpmi_marker, dead_traction)},
    {"prescribed_velocity", MPM_F64, 1, 1, offsetof(mpmi_marker, prescribed_velocity)},
    {"reaction", MPM_F64, 1, 0, offsetof(mpmi_marker, reaction)},
    {"gap", MPM_F64, 1, 0, offsetof(mpmi_marker, gap)}};
enum { FIELDS = sizeof fields / sizeof *fields };

static mpm_status find_field(mpm_context *c, const char *name, const field **out) {
  const char *names[FIELDS];
  *out = NULL;
  if (!name) return mpmi_fail(c, MPM_E_ARG, "field is NULL");
  for (int32_t i = 0; i < FIELDS; ++i) {
    names[i] = fields[i].name;
    if (strcmp(name, names[i]) == 0) *out = &fields[i];
  }
  return *out ? MPM_OK : mpmi_refuse_name(c, "a surface has no field", name, names, FIELDS);
}

/* Finds the field, and checks all that the host says of it and of the markers. */
static mpm_status select_field(const mpm_surface *s, const char *name, int32_t type, int32_t components,
                               int64_t n, const int64_t *ids, const field **out) {
  mpm_context *c = s->context;
  const mpm_status status = find_field(c, name, out);
  if (status) return status;
  const int32_t has = (*out)->vector ? s->grid->dim : 1;
  if (type != (*out)->type || components != has)
    return mpmi_fail(c, MPM_E_ARG, "%s is %s with %d components, not type %d with %d", name,
                     (*out)->type == MPM_I64 ? "MPM_I64" : "MPM_F64", (int)has, (int)type, (int)components);
  if (n < 0) return mpmi_fail(c, MPM_E_ARG, "n is %lld, must be >= 0", (long long)n);
  if (!ids && n != s->now.count)
    return mpmi_fail(c, MPM_E_ARG, "n is %lld, but the surface has %lld markers and ids is NULL",
                     (long long)n, (long long)s->now.count);
  for (int64_t i = 0; i < n && ids; ++i)
    if (mpmi_markers_find(&s->now, ids[i]) < 0)
      return mpmi_fail(c, MPM_E_NOT_FOUND, "the surface has no marker with id %lld", (long long)ids[i]);
  return MPM_OK;
}

static int64_t place_of(const mpm_surface *s, const int64_t *ids, int64_t i) {
  return ids ? mpmi_markers_find(&s->now, ids[i]) : i;
}

mpm_status mpm_surface_get(const mpm_surface *s, const char *name, int32_t type, int32_t components,
                           int64_t n, const int64_t *ids, void *out) {
  MPMI_ENTER(s, MPMI_SURFACE);
  const field *f;
  mpm_status status = select_field(s, name, type, components, n, ids, &f);
  if (!status && n && !out) status = mpmi_fail(s->context, MPM_E_ARG, "out is NULL");
  for (int64_t i = 0; i < n && !status; ++i) {
    const mpmi_marker *m = &s->now.at[place_of(s, ids, i)];
    double area[3];
    mpmi_marker_area(m, s->grid, area);
    const char *from = f->at == AREA ? (const char *)area : (const char *)m + f->at;
    for (int32_t k = 0; k < components; ++k)
      memcpy((char *)out + (size_t)(k * n + i) * sizeof(double), from + (size_t)k * sizeof(double),
             sizeof(double));
  }
  return status;
}

/* Takes the value of one marker; without `write` it is only checked. */
static mpm_status take_value(const mpm_surface *s, const field *f, const double *values, int64_t n, int64_t i,
                             int32_t write, mpmi_marker *marker) {
  const int64_t id = marker->id;
  const int32_t count = f->vector ? s->grid->dim : 1;
  double v[3] = {0.0, 0.0, 0.0}, square = 0.0;
  for (int32_t k = 0; k < count; ++k) {
    v[k] = values[k * n + i];
    square += v[k] * v[k];
    if (!isfinite(v[k]))
      return mpmi_fail(s->context, MPM_E_ARG, "marker %lld: %s[%d] is %g, must be finite", (long long)id,
                       f->name, (int)k, v[k]);
  }
  if (f->at == AREA && !isfinite(square))
    return mpmi_fail(s->context, MPM_E_ARG, "marker %lld: the area is beyond the range of double precision",
                     (long long)id);
  if (strcmp(f->name, "position") == 0) {
    const mpm_status status = mpmi_marker_place(s, id, v);
    if (status) return status;
  }
  if (f->at == AREA) {
    const mpm_status status = mpmi_marker_check_area(s, id, marker->position[0], v);
    if (status) return status;
  }
  if ((f->at == AREA || strcmp(f->name, "position") == 0) && mpmi_is_total_lagrangian(s->grid))
    return mpmi_fail(s->context, MPM_E_UNSUPPORTED,
                     "%s of a marker follows from where it was added, on a grid with total_lagrangian = 1: "
                     "remove it and add another",
                     f->name);
  if (write && f->at == AREA) {
    mpmi_marker_set_area(marker, s->grid, v);
  } else if (write) {
    memcpy((char *)marker + f->at, v, (size_t)count * sizeof *v);
    mpmi_marker_set_radius(marker, s->grid);
    if (strcmp(f->name, "position") == 0) mpmi_marker_set_reference(marker);
  }
  return MPM_OK;
}

mpm_status mpm_surface_set(mpm_surface *s, const char *name, int32_t type, int32_t components, int64_t n,
                           const int64_t *ids, const void *values) {
  MPMI_ENTER(s, MPMI_SURFACE);
  const field *f;
  mpm_status status = mpmi_surface_changeable(s);
  if (!status) status = select_field(s, name, type, components, n, ids, &f);
  if (!status && !f->writable) status = mpmi_fail(s->context, MPM_E_ARG, "%s cannot be set", name);
  if (!status && n && !values) status = mpmi_fail(s->context, MPM_E_ARG, "values is NULL");
  for (int32_t write = 0; write < 2; ++write)
    for (int64_t i = 0; i < n && !status; ++i) {
      mpmi_marker *m = &s->now.at[place_of(s, ids, i)];
      status = take_value(s, f, values, n, i, write, m);
    }
  return status;
}
