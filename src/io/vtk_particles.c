/* A particle set as VTK poly data: an XML head that says where each array begins, then the arrays as they
 * are. */
#include "io/output_file.h"
#include "particles/values.h"
#include "stepper/stepper.h"

#include <string.h>

enum { POINTS = -1, NUMBERS = -2, ENDS = -3, MAX_ARRAYS = MPMI_MAX_FIELDS + 3, BUFFER = 4096 };

/* One array of the file: a field, or the points or vertices. */
typedef struct array {
  const char *name;
  int32_t field; /* of the set, or one of the above */
  int32_t type, components;
} array;

typedef struct writer {
  const mpm_particles *set;
  mpmi_output out;
  array list[MAX_ARRAYS];
  int32_t count;
} writer;

/* Vectors have three components for VTK, which would not take them for vectors otherwise. */
static int32_t shown_components(const mpmi_field *field, int32_t f, int32_t dim) {
  const int32_t is_vector = f < MPMI_BUILTIN_FIELDS && f != MPMI_STATE && f != MPMI_STRESS && f != MPMI_F &&
                            f != MPMI_L && field->type == MPM_F64 && dim > 1 && field->full_components == dim;
  return is_vector ? 3 : field->full_components;
}

static void append(writer *w, const char *name, int32_t field, int32_t type, int32_t components) {
  w->list[w->count++] = (array){name, field, type, components};
}

static void append_field(writer *w, int32_t f) {
  const mpmi_field *field = &w->set->field[f];
  append(w, field->name, f, field->type, shown_components(field, f, w->set->grid->dim));
}

static mpm_status append_named(writer *w, const char *name) {
  int32_t f = -1;
  mpm_status status = mpmi_require_field(w->set, name, &f);
  if (!status) status = mpmi_check_exists(w->set, f);
  if (status) return status;
  if (w->set->field[f].components == 0)
    return mpmi_fail(w->set->context, MPM_E_NOT_FOUND, "the law of this set has no state to write");
  for (int32_t i = 0; i < w->count; ++i)
    if (w->list[i].field == f)
      return mpmi_fail(w->set->context, MPM_E_ARG, "field \"%s\" is named twice", name);
  append_field(w, f);
  return MPM_OK;
}

static mpm_status choose_arrays(writer *w, int32_t count, const char *const *fields) {
  const mpm_particles *set = w->set;
  if (count < 0) return mpmi_fail(set->context, MPM_E_ARG, "count is %d, must be >= 0", (int)count);
  if (count && !fields)
    return mpmi_fail(set->context, MPM_E_ARG, "fields is NULL, but count is %d", (int)count);
  append(w, "points", POINTS, MPM_F64, 3);
  append(w, "connectivity", NUMBERS, MPM_I64, 1);
  append(w, "offsets", ENDS, MPM_I64, 1);
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < count && !status; ++i) status = append_named(w, fields[i]);
  for (int32_t f = 0; f < set->field_count && !count; ++f)
    if (set->field[f].present && f != MPMI_POSITION) append_field(w, f); /* the points are the positions */
  return status;
}

static int64_t bytes_of(const writer *w, const array *a) {
  return w->set->count * a->components * (int64_t)mpmi_type_size(a->type);
}

static void write_tag(writer *w, int32_t i, int64_t *offset) {
  static const char *const type_name[] = {"", "Float64", "Int64", "UInt8"};
  const array *a = &w->list[i];
  fprintf(w->out.stream,
          "        <DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"appended\" "
          "offset=\"%lld\"/>\n",
          type_name[a->type], a->name, (int)a->components, (long long)*offset);
  *offset += (int64_t)sizeof(uint64_t) + bytes_of(w, a);
}

static void write_head(writer *w) {
  const uint16_t one = 1;
  uint8_t first_byte;
  memcpy(&first_byte, &one, 1);
  int64_t offset = 0;
  fprintf(
      w->out.stream,
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"%s\" header_type=\"UInt64\">\n"
      "  <PolyData>\n"
      "    <Piece NumberOfPoints=\"%lld\" NumberOfVerts=\"%lld\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n"
      "      <Points>\n",
      first_byte ? "LittleEndian" : "BigEndian", (long long)w->set->count, (long long)w->set->count);
  write_tag(w, 0, &offset);
  fputs("      </Points>\n      <Verts>\n", w->out.stream);
  write_tag(w, 1, &offset);
  write_tag(w, 2, &offset);
  fputs("      </Verts>\n      <PointData>\n", w->out.stream);
  for (int32_t i = 3; i < w->count; ++i) write_tag(w, i, &offset);
  fputs("      </PointData>\n    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_",
        w->out.stream);
}

/* Component c of the particles [begin, begin + n) by ascending id, to every `stride`-th element of out. */
static void gather(const mpm_particles *set, int32_t f, int32_t c, int64_t begin, int64_t n, int32_t stride,
                   double *out) {
  const mpmi_field *field = &set->field[f];
  const int32_t stored = mpmi_stored_component(set, f, c);
  const size_t size = mpmi_type_size(field->type);
  const char *row =
      field->present && stored >= 0 ? (const char *)field->data[0] + (size_t)(stored * set->ld) * size : NULL;
  for (int64_t i = 0; i < n; ++i) {
    const int64_t slot = set->index[begin + i].slot;
    char *to = (char *)out + (size_t)(i * stride) * size;
    if (row)
      memcpy(to, row + (size_t)slot * size, size);
    else if (field->type != MPM_F64)
      memset(to, 0, size);
    else
      *(double *)(void *)to = stored < 0 ? mpmi_unstored_value(f, c) : mpmi_absent_value(set, f, c, slot);
  }
}

static void write_array(writer *w, const array *a) {
  const mpm_particles *set = w->set;
  const uint64_t bytes = (uint64_t)bytes_of(w, a);
  const int64_t chunk = BUFFER / a->components;
  double buffer[BUFFER];
  mpmi_output_write(&w->out, &bytes, sizeof bytes);
  for (int64_t begin = 0; begin < set->count; begin += chunk) {
    const int64_t n = set->count - begin < chunk ? set->count - begin : chunk;
    for (int32_t c = 0; c < a->components && a->field >= POINTS; ++c)
      gather(set, a->field == POINTS ? MPMI_POSITION : a->field, c, begin, n, a->components,
             (double *)(void *)((char *)buffer + (size_t)c * mpmi_type_size(a->type)));
    for (int64_t i = 0; i < n && a->field < POINTS; ++i) {
      const int64_t number = begin + i + (a->field == ENDS);
      memcpy(buffer + i, &number, sizeof number);
    }
    mpmi_output_write(&w->out, buffer, (size_t)(n * a->components) * mpmi_type_size(a->type));
  }
}

/* What the arrays need before they can be read. */
static mpm_status settle(const writer *w) {
  mpm_particles *set =
      (mpm_particles *)(uintptr_t)w->set; /* what follows from F, and the index, are caches */
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < w->count && !status; ++i) status = mpmi_settle(set, w->list[i].field);
  return status ? status : mpmi_index_build(set);
}

mpm_status mpm_write_particles(const mpm_particles *particles, const char *path, int32_t count,
                               const char *const *fields) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  mpm_context *context = particles->context;
  if (particles->stepper && particles->stepper->phase == MPMI_RUNNING)
    return mpmi_fail(context, MPM_E_STATE, "mpm_write_particles() must not be called from a callback");
  writer w = {.set = particles};
  mpm_status status = mpmi_check_path(context, path);
  if (!status) status = choose_arrays(&w, count, fields);
  if (!status) status = settle(&w);
  if (!status) status = mpmi_output_open(&w.out, context, path);
  if (status) return status;
  write_head(&w);
  for (int32_t i = 0; i < w.count; ++i) write_array(&w, &w.list[i]);
  fputs("\n  </AppendedData>\n</VTKFile>\n", w.out.stream);
  return mpmi_output_close(&w.out, 0);
}
