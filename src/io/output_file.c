#define _POSIX_C_SOURCE   200809L
#define _FILE_OFFSET_BITS 64
#include "io/output_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { SUFFIX = 48, ATTEMPTS = 100, LONG_GAP = 1 << 20 };

mpm_status mpmi_check_path(mpm_context *context, const char *path) {
  if (!path) return mpmi_fail(context, MPM_E_ARG, "path is NULL");
  return *path ? MPM_OK : mpmi_fail(context, MPM_E_ARG, "path is empty");
}

mpm_status mpmi_io_error(mpm_context *context, const char *verb, const char *path, int error) {
  char text[128];
  if (strerror_r(error, text, sizeof text)) snprintf(text, sizeof text, "error %d", error);
  return mpmi_fail(context, MPM_E_IO, "cannot %s %s: %s", verb, path, text);
}

static void free_name(mpmi_output *out) {
  mpmi_free(out->context, out->temporary, out->temporary_bytes);
  out->temporary = NULL;
}

/* Renaming over a device or a pipe would put a file in its place. */
static mpm_status check_target(mpm_context *context, const char *path) {
  struct stat info;
  if (stat(path, &info) || S_ISREG(info.st_mode)) return MPM_OK;
  return mpmi_fail(context, MPM_E_IO, "cannot write %s: it is not a regular file", path);
}

/* Creates a file under a name that nobody else uses, because other processes and threads may write the
 * same path. */
static int create_temporary(mpmi_output *out) {
  for (int32_t k = 0; k < ATTEMPTS; ++k) {
    snprintf(out->temporary, out->temporary_bytes, "%s.tmp%ld-%d", out->path, (long)getpid(), (int)k);
    const int file = open(out->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0 || errno != EEXIST) return file;
  }
  return -1;
}

mpm_status mpmi_output_open(mpmi_output *out, mpm_context *context, const char *path) {
  mpm_status status = check_target(context, path);
  if (status) return status;
  *out = (mpmi_output){context, NULL, 0, path, NULL, strlen(path) + SUFFIX};
  out->temporary = mpmi_alloc(context, out->temporary_bytes);
  if (!out->temporary) return MPM_E_NOMEM;
  const int file = create_temporary(out);
  if (file >= 0) out->stream = fdopen(file, "wb");
  if (out->stream) return MPM_OK;
  const int error = errno;
  if (file >= 0) {
    close(file);
    unlink(out->temporary);
  }
  free_name(out);
  return mpmi_io_error(context, "write", path, error);
}

/* The new name is on the storage once the directory is. Not every system offers that, so it is no error if
 * it fails. */
static void sync_directory(mpmi_output *out) {
  char *slash = strrchr(out->temporary, '/');
  if (slash) slash[slash == out->temporary] = '\0';
  const int directory = open(slash ? out->temporary : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0) return;
  fsync(directory);
  close(directory);
}

/* Keeps the number of the first error, which those that follow would hide. */
static void note(mpmi_output *out, int failed) {
  if (failed && !out->error) out->error = errno ? errno : EIO;
}

void mpmi_output_write(mpmi_output *out, const void *data, size_t bytes) {
  errno = 0;
  if (!out->error) note(out, fwrite(data, 1, bytes, out->stream) != bytes);
}

void mpmi_output_zeros(mpmi_output *out, int64_t bytes) {
  static const char zero[4096];
  if (out->error) return;
  errno = 0;
  if (bytes >= LONG_GAP) {
    note(out, fseeko(out->stream, bytes, SEEK_CUR));
    if (out->error == EINVAL || out->error == EOVERFLOW) out->error = EFBIG; /* a file cannot be that long */
    return;
  }
  for (; bytes > 0; bytes -= (int64_t)sizeof zero)
    mpmi_output_write(out, zero, bytes < (int64_t)sizeof zero ? (size_t)bytes : sizeof zero);
}

void mpmi_output_rewind(mpmi_output *out) {
  errno = 0;
  if (!out->error) note(out, fseeko(out->stream, 0, SEEK_SET));
}

mpm_status mpmi_output_close(mpmi_output *out, int32_t durable) {
  errno = 0;
  note(out, fflush(out->stream) || ferror(out->stream));
  if (!out->error && durable) note(out, fsync(fileno(out->stream)));
  note(out, fclose(out->stream));
  if (!out->error) note(out, rename(out->temporary, out->path));
  mpm_status status = MPM_OK;
  if (out->error) {
    unlink(out->temporary);
    status = mpmi_io_error(out->context, "write", out->path, out->error);
  } else if (durable) {
    sync_directory(out);
  }
  free_name(out);
  return status;
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
