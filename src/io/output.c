#include "io/output.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "platform/platform.h"

enum { LONG_GAP = 1 << 20, PIECE = 1 << 16, LINE = 1024 };

mpm_status mpmi_check_path(mpm_context *context, const char *path) {
  if (!path) return mpmi_fail(context, MPM_E_ARG, "path is NULL");
  return *path ? MPM_OK : mpmi_fail(context, MPM_E_ARG, "path is empty");
}

mpm_status mpmi_check_write(mpm_context *context, mpm_write_fn write) {
  return write ? MPM_OK : mpmi_fail(context, MPM_E_ARG, "write is NULL");
}

mpm_status mpmi_io_error(mpm_context *context, const char *verb, const char *path, int error) {
  char text[128];
  mpmi_error_text(error, text, sizeof text);
  return mpmi_fail(context, error == MPMI_NO_FILES ? MPM_E_UNSUPPORTED : MPM_E_IO, "cannot %s %s: %s", verb,
                   path, text);
}

mpm_status mpmi_output_open(mpmi_output *out, mpm_context *context, const mpmi_target *to) {
  *out = (mpmi_output){.context = context, .to = *to};
  if (!to->path) {
    out->piece = mpmi_alloc(context, PIECE);
    return out->piece ? MPM_OK : MPM_E_NOMEM;
  }
  out->file = mpmi_alloc(context, sizeof *out->file);
  if (!out->file) return MPM_E_NOMEM;
  const int error = mpmi_replacement_open(out->file, to->path);
  if (!error) return MPM_OK;
  mpmi_free(context, out->file, sizeof *out->file);
  return mpmi_io_error(context, "write", to->path, error);
}

/* Keeps the number of the first error, which those that follow would hide. */
static void note(mpmi_output *out, int failed) {
  if (failed && !out->error) out->error = errno ? errno : MPMI_STORAGE_FAILED;
}

static void give_piece(mpmi_output *out) {
  if (!out->held) return;
  out->returned = mpmi_from_host(out->to.write(out->to.user, out->piece, (int64_t)out->held));
  if (!out->returned) out->given += (int64_t)out->held;
  out->held = 0;
}

static void give(mpmi_output *out, const unsigned char *data, size_t bytes) {
  while (bytes > 0 && !out->returned) {
    const size_t room = PIECE - out->held, n = bytes < room ? bytes : room;
    memcpy(out->piece + out->held, data, n);
    out->held += n;
    data += n;
    bytes -= n;
    if (out->held == PIECE) give_piece(out);
  }
}

void mpmi_output_write(mpmi_output *out, const void *data, size_t bytes) {
  if (!out->file) {
    give(out, data, bytes);
    return;
  }
  errno = 0;
  if (!out->error) note(out, fwrite(data, 1, bytes, out->file->stream) != bytes);
}

void mpmi_output_print(mpmi_output *out, const char *format, ...) {
  char text[LINE];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  mpmi_output_write(out, text, strlen(text));
}

void mpmi_output_zeros(mpmi_output *out, int64_t bytes) {
  static const char zero[4096];
  if (bytes >= LONG_GAP && out->file) {
    if (!out->error) out->error = mpmi_file_skip(out->file->stream, bytes);
    return;
  }
  for (; bytes > 0 && !mpmi_output_failed(out); bytes -= (int64_t)sizeof zero)
    mpmi_output_write(out, zero, bytes < (int64_t)sizeof zero ? (size_t)bytes : sizeof zero);
}

void mpmi_output_rewind(mpmi_output *out) {
  errno = 0;
  if (!out->error) note(out, fseek(out->file->stream, 0, SEEK_SET));
}

static mpm_status close_callback(mpmi_output *out) {
  give_piece(out);
  mpmi_free(out->context, out->piece, PIECE);
  if (!out->returned) return MPM_OK;
  return mpmi_fail(out->context, MPM_E_CALLBACK,
                   "the function that takes the output returned %d after %lld bytes", (int)out->returned,
                   (long long)out->given);
}

void mpmi_output_drop(mpmi_output *out) {
  if (!out->file) {
    mpmi_free(out->context, out->piece, PIECE);
    return;
  }
  mpmi_replacement_close(out->file, MPMI_STORAGE_FAILED, 0);
  mpmi_free(out->context, out->file, sizeof *out->file);
}

mpm_status mpmi_output_close(mpmi_output *out, int32_t durable) {
  if (!out->file) return close_callback(out);
  errno = 0;
  note(out, fflush(out->file->stream));
  const int error = mpmi_replacement_close(out->file, out->error, durable);
  mpmi_free(out->context, out->file, sizeof *out->file);
  return error ? mpmi_io_error(out->context, "write", out->to.path, error) : MPM_OK;
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
