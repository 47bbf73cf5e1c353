#include "io/output_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "platform/platform.h"

enum { LONG_GAP = 1 << 20 };

mpm_status mpmi_check_path(mpm_context *context, const char *path) {
  if (!path) return mpmi_fail(context, MPM_E_ARG, "path is NULL");
  return *path ? MPM_OK : mpmi_fail(context, MPM_E_ARG, "path is empty");
}

mpm_status mpmi_io_error(mpm_context *context, const char *verb, const char *path, int error) {
  char text[128];
  mpmi_error_text(error, text, sizeof text);
  return mpmi_fail(context, error == MPMI_NO_FILES ? MPM_E_UNSUPPORTED : MPM_E_IO, "cannot %s %s: %s", verb,
                   path, text);
}

mpm_status mpmi_output_open(mpmi_output *out, mpm_context *context, const char *path) {
  *out = (mpmi_output){context, NULL, 0, path, mpmi_alloc(context, sizeof *out->file)};
  if (!out->file) return MPM_E_NOMEM;
  const int error = mpmi_replacement_open(out->file, path);
  out->stream = out->file->stream;
  if (!error) return MPM_OK;
  mpmi_free(context, out->file, sizeof *out->file);
  return mpmi_io_error(context, "write", path, error);
}

/* Keeps the number of the first error, which those that follow would hide. */
static void note(mpmi_output *out, int failed) {
  if (failed && !out->error) out->error = errno ? errno : MPMI_STORAGE_FAILED;
}

void mpmi_output_write(mpmi_output *out, const void *data, size_t bytes) {
  errno = 0;
  if (!out->error) note(out, fwrite(data, 1, bytes, out->stream) != bytes);
}

void mpmi_output_zeros(mpmi_output *out, int64_t bytes) {
  static const char zero[4096];
  if (out->error) return;
  if (bytes >= LONG_GAP) {
    out->error = mpmi_file_skip(out->stream, bytes);
    return;
  }
  for (; bytes > 0; bytes -= (int64_t)sizeof zero)
    mpmi_output_write(out, zero, bytes < (int64_t)sizeof zero ? (size_t)bytes : sizeof zero);
}

void mpmi_output_rewind(mpmi_output *out) {
  errno = 0;
  if (!out->error) note(out, fseek(out->stream, 0, SEEK_SET));
}

mpm_status mpmi_output_close(mpmi_output *out, int32_t durable) {
  errno = 0;
  note(out, fflush(out->stream) || ferror(out->stream));
  const int error = mpmi_replacement_close(out->file, out->error, durable);
  mpmi_free(out->context, out->file, sizeof *out->file);
  return error ? mpmi_io_error(out->context, "write", out->path, error) : MPM_OK;
}

void mpmi_print_real(double value, char *text) {
  char local[MPMI_REAL];
  for (int32_t digits = 15; digits <= 17; ++digits) {
    snprintf(local, sizeof local, "%.*g", (int)digits, value);
    const double back = strtod(local, NULL);
    if (!memcmp(&back, &value, sizeof value)) break;
  }
  size_t n = 0;
  int32_t in_point = 0;
  for (const char *c = local; *c; ++c) {
    const int32_t known = strchr("0123456789+-e", *c) != NULL;
    if (known)
      text[n++] = *c;
    else if (!in_point) /* a decimal point may take several bytes */
      text[n++] = '.';
    in_point = !known;
  }
  text[n] = '\0';
}
