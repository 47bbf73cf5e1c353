/* A particle set is written as VTK poly data. */
#include "io/vtk_file.h"
#include "particles/values.h"
#include "stepper/stepper.h"

#include <string.h>

enum { POINTS = -1, NUMBERS = -2, ENDS = -3 }; /* the numbers of fields are not negative */
enum { BUFFER = 4096 };

typedef struct writer {
  const mpm_particles *set;
  mpmi_vtk_file file;
} writer;

/* Vectors are shown with three components, because VTK would not take them for vectors otherwise. */
static int32_t shown_components(const mpmi_field *field, int32_t f, int32_t dim) {
  const int32_t is_vector = f < MPMI_BUILTIN_FIELDS && f != MPMI_STATE && f != MPMI_STRESS && f != MPMI_F &&
                            f != MPMI_L && field->type == MPM_F64 && dim > 1 && field->full_components == dim;
  return is_vector ? 3 : field->full_components;
}

static mpm_status add_named(writer *w, const char *name) {
  const mpm_particles *set = w->set;
  int32_t f = -1;
  mpm_status status = mpmi_require_field(set, name, &f);
  if (!status) status = mpmi_check_exists(set, f);
  if (status) return status;
  const mpmi_field *field = &set->field[f];
  if (field->components == 0)
    return mpmi_fail(set->context, MPM_E_NOT_FOUND, "the law of this set has no state to write");
  return mpmi_vtk_add_named(&w->file, field->name, f, field->type, shown_components(field, f, set->grid->dim),
                            set->count);
}

static mpm_status choose_arrays(writer *w, int32_t count, const char *const *fields) {
  const mpm_particles *set = w->set;
  mpm_status status = mpmi_vtk_check_names(set->context, count, fields);
  if (status) return status;
  mpmi_vtk_add(&w->file, "points", POINTS, MPM_F64, 3, set->count);
  mpmi_vtk_add(&w->file, "connectivity", NUMBERS, MPM_I64, 1, set->count);
  mpmi_vtk_add(&w->file, "offsets", ENDS, MPM_I64, 1, set->count);
  for (int32_t i = 0; i < count && !status; ++i) status = add_named(w, fields[i]);
  for (int32_t f = 0; f < set->field_count && !count; ++f) {
    const mpmi_field *field = &set->field[f];
    if (field->present && f != MPMI_POSITION) /* the points are the positions */
      mpmi_vtk_add(&w->file, field->name, f, field->type, shown_components(field, f, set->grid->dim),
                   set->count);
  }
  return status;
}

static void write_head(writer *w) {
  mpmi_output *out = &w->file.out;
  mpmi_output_print(out,
                    "  <PolyData>\n"
                    "    <Piece NumberOfPoints=\"%lld\" NumberOfVerts=\"%lld\" NumberOfLines=\"0\" "
                    "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
                    "      <Points>\n",
                    (long long)w->set->count, (long long)w->set->count);
  mpmi_vtk_tags(&w->file, 0, 1);
  mpmi_output_print(out, "      </Points>\n      <Verts>\n");
  mpmi_vtk_tags(&w->file, 1, 3);
  mpmi_output_print(out, "      </Verts>\n      <PointData>\n");
  mpmi_vtk_tags(&w->file, 3, w->file.count);
  mpmi_output_print(out, "      </PointData>\n");
}

/* Gathers component c of the particles [begin, begin + n) by ascending id into every `stride`-th element
 * of out. */
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

static void write_array(writer *w, const mpmi_vtk_array *a) {
  const mpm_particles *set = w->set;
  const int64_t chunk = BUFFER / a->components;
  double buffer[BUFFER];
  mpmi_vtk_start_array(&w->file, a);
  for (int64_t begin = 0; begin < set->count && !mpmi_output_failed(&w->file.out); begin += chunk) {
    const int64_t n = set->count - begin < chunk ? set->count - begin : chunk;
    for (int32_t c = 0; c < a->components && a->field >= POINTS; ++c)
      gather(set, a->field == POINTS ? MPMI_POSITION : a->field, c, begin, n, a->components,
             (double *)(void *)((char *)buffer + (size_t)c * mpmi_type_size(a->type)));
    for (int64_t i = 0; i < n && a->field < POINTS; ++i) {
      const int64_t number = begin + i + (a->field == ENDS);
      memcpy(buffer + i, &number, sizeof number);
    }
    mpmi_output_write(&w->file.out, buffer, (size_t)(n * a->components) * mpmi_type_size(a->type));
  }
}

/* Brings up to date what the arrays need before they can be read. */
static mpm_status settle(const writer *w) {
  mpm_particles *set =
      (mpm_particles *)(uintptr_t)w->set; /* the index, and what follows from F, are caches */
  mpm_status status = MPM_OK;
  for (int32_t i = 0; i < w->file.count && !status; ++i) status = mpmi_settle(set, w->file.list[i].field);
  return status ? status : mpmi_index_build(set);
}

static mpm_status write_set(const mpm_particles *set, const mpmi_target *to, int32_t count,
                            const char *const *fields) {
  writer w = {.set = set, .file = {.context = set->context}};
  mpm_status status = choose_arrays(&w, count, fields);
  if (!status) status = settle(&w);
  if (!status) status = mpmi_vtk_open(&w.file, to, "PolyData");
  if (status) return status;
  write_head(&w);
  mpmi_vtk_start_data(&w.file, "PolyData");
  for (int32_t i = 0; i < w.file.count; ++i) write_array(&w, &w.file.list[i]);
  return mpmi_vtk_close(&w.file);
}

mpm_status mpm_write_particles(const mpm_particles *particles, const char *path, int32_t count,
                               const char *const *fields) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  const mpm_status status = mpmi_check_path(particles->context, path);
  return status ? status : write_set(particles, &(mpmi_target){.path = path}, count, fields);
}

mpm_status mpm_write_particles_to(const mpm_particles *particles, mpm_write_fn write, void *user,
                                  int32_t count, const char *const *fields) {
  MPMI_ENTER(particles, MPMI_PARTICLES);
  const mpm_status status = mpmi_check_write(particles->context, write);
  return status ? status : write_set(particles, &(mpmi_target){.write = write, .user = user}, count, fields);
}
