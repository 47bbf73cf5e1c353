/* Versioned structs: struct_size comes first, fields are only appended, and every appended default is zero.
 */
#include <string.h>

#include "context/context.h"

/* No struct of this interface comes near; more is a size that was never set. */
enum { LARGEST_STRUCT = 1 << 16 };

static uint32_t struct_size_of(const void *versioned) {
  uint32_t size;
  memcpy(&size, versioned, sizeof size);
  return size;
}

mpm_status mpmi_read_struct(mpm_context *context, const char *name, const void *desc, uint32_t known,
                            void *out) {
  if (!desc) return mpmi_fail(context, MPM_E_ARG, "%s is NULL", name);
  uint32_t given = struct_size_of(desc);
  if (given < known || given > LARGEST_STRUCT)
    return mpmi_fail(context, MPM_E_ARG, "%s: struct_size is %u, expected %u (call its _init first)", name,
                     given, known);
  const unsigned char *bytes = desc;
  for (uint32_t i = known; i < given; ++i)
    if (bytes[i])
      return mpmi_fail(context, MPM_E_UNSUPPORTED,
                       "%s sets a field that this version of the library does not know (byte %u of %u)", name,
                       i, given);
  memcpy(out, desc, known);
  memcpy(out, &known, sizeof known);
  return MPM_OK;
}

mpm_status mpmi_check_out_struct(mpm_context *context, const char *name, uint32_t known, const void *out) {
  if (!out) return mpmi_fail(context, MPM_E_ARG, "%s is NULL", name);
  uint32_t given = struct_size_of(out);
  if (given < sizeof given || given > LARGEST_STRUCT)
    return mpmi_fail(context, MPM_E_ARG, "%s: struct_size is %u, expected %u", name, given, known);
  return MPM_OK;
}

mpm_status mpmi_write_struct(mpm_context *context, const char *name, const void *value, uint32_t known,
                             void *out) {
  mpm_status status = mpmi_check_out_struct(context, name, known, out);
  if (status) return status;
  uint32_t given = struct_size_of(out);
  memcpy(out, value, given < known ? given : known);
  memcpy(out, &given, sizeof given);
  return MPM_OK;
}

mpm_status mpmi_init_struct(const void *defaults, uint32_t known, void *out, uint32_t struct_size) {
  if (!out || struct_size < known || struct_size > LARGEST_STRUCT) return MPM_E_ARG;
  memset(out, 0, struct_size);
  memcpy(out, defaults, known);
  memcpy(out, &struct_size, sizeof struct_size);
  return MPM_OK;
}
