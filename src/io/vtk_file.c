#include "io/vtk_file.h"

#include <string.h>

mpm_status mpmi_vtk_check_names(mpm_context *context, int32_t count, const char *const *fields) {
  if (count < 0) return mpmi_fail(context, MPM_E_ARG, "count is %d, must be >= 0", (int)count);
  if (count && !fields) return mpmi_fail(context, MPM_E_ARG, "fields is NULL, but count is %d", (int)count);
  return MPM_OK;
}

void mpmi_vtk_add(mpmi_vtk_file *file, const char *name, int32_t field, int32_t type, int32_t components,
                  int64_t tuples) {
  file->list[file->count++] = (mpmi_vtk_array){name, field, type, components, tuples};
}

mpm_status mpmi_vtk_add_named(mpmi_vtk_file *file, const char *name, int32_t field, int32_t type,
                              int32_t components, int64_t tuples) {
  for (int32_t i = 0; i < file->count; ++i)
    if (file->list[i].field == field)
      return mpmi_fail(file->context, MPM_E_ARG, "field \"%s\" is named twice", name);
  mpmi_vtk_add(file, name, field, type, components, tuples);
  return MPM_OK;
}

/* Adds the bytes of an array and of the number that stands before it. Returns 0 when the sum overflows. */
static int32_t add_bytes(const mpmi_vtk_array *a, int64_t *sum) {
  int64_t bytes;
  return !__builtin_mul_overflow(a->tuples, a->components * (int64_t)mpmi_type_size(a->type), &bytes) &&
         !__builtin_add_overflow(bytes, (int64_t)sizeof(uint64_t), &bytes) &&
         !__builtin_add_overflow(*sum, bytes, sum);
}

int32_t mpmi_vtk_fits(const mpmi_vtk_file *file) {
  int64_t sum = 1 << 20; /* more than the head takes */
  for (int32_t i = 0; i < file->count; ++i)
    if (!add_bytes(&file->list[i], &sum)) return 0;
  return 1;
}

mpm_status mpmi_vtk_open(mpmi_vtk_file *file, const mpmi_target *to, const char *kind) {
  mpm_status status = mpmi_output_open(&file->out, file->context, to);
  if (status) return status;
  const uint16_t one = 1;
  uint8_t first_byte;
  memcpy(&first_byte, &one, 1);
  file->offset = 0;
  mpmi_output_print(&file->out,
                    "<?xml version=\"1.0\"?>\n"
                    "<VTKFile type=\"%s\" version=\"1.0\" byte_order=\"%s\" header_type=\"UInt64\">\n",
                    kind, first_byte ? "LittleEndian" : "BigEndian");
  return MPM_OK;
}

void mpmi_vtk_tags(mpmi_vtk_file *file, int32_t begin, int32_t end) {
  static const char *const type_name[] = {"", "Float64", "Int64", "UInt8"};
  for (int32_t i = begin; i < end; ++i) {
    const mpmi_vtk_array *a = &file->list[i];
    mpmi_output_print(
        &file->out,
        "        <DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"appended\" "
        "offset=\"%lld\"/>\n",
        type_name[a->type], a->name, (int)a->components, (long long)file->offset);
    add_bytes(a, &file->offset);
  }
}

void mpmi_vtk_start_data(mpmi_vtk_file *file, const char *kind) {
  mpmi_output_print(&file->out, "    </Piece>\n  </%s>\n  <AppendedData encoding=\"raw\">\n_", kind);
}

void mpmi_vtk_start_array(mpmi_vtk_file *file, const mpmi_vtk_array *a) {
  const uint64_t bytes = (uint64_t)a->tuples * (uint64_t)a->components * mpmi_type_size(a->type);
  mpmi_output_write(&file->out, &bytes, sizeof bytes);
}

mpm_status mpmi_vtk_close(mpmi_vtk_file *file) {
  mpmi_output_print(&file->out, "\n  </AppendedData>\n</VTKFile>\n");
  return mpmi_output_close(&file->out, 0);
}
