/* A time series of output files is a .pvd file. Each new entry overwrites its closing tags. */
#include <errno.h>
#include <math.h>
#include <string.h>

#include "io/output.h"
#include "platform/platform.h"

struct mpm_series {
  uint32_t magic;
  FILE *file;
  mpm_context *context;
  int64_t end; /* bytes before the closing tags */
  size_t path_bytes;
  char *path;
};

static const char head[] = "<?xml version=\"1.0\"?>\n"
                           "<VTKFile type=\"Collection\" version=\"1.0\">\n"
                           "  <Collection>\n";
static const char tail[] = "  </Collection>\n"
                           "</VTKFile>\n";

/* Returns the bytes of the UTF-8 character at c if XML 1.0 can hold it, else 0. */
static size_t character(const unsigned char *c) {
  static const struct {
    unsigned char mask, lead;
    uint32_t least;
  } form[] = {{0x80, 0x00, 0x20}, {0xe0, 0xc0, 0x80}, {0xf0, 0xe0, 0x800}, {0xf8, 0xf0, 0x10000}};
  for (size_t more = 0; more < 4; ++more) {
    if ((c[0] & form[more].mask) != form[more].lead) continue;
    uint32_t code = c[0] & (unsigned char)~form[more].mask;
    for (size_t i = 1; i <= more; ++i) {
      if ((c[i] & 0xc0) != 0x80) return 0;
      code = code << 6 | (c[i] & 0x3fu);
    }
    const int32_t surrogate = code >= 0xd800 && code <= 0xdfff;
    if (code < form[more].least || surrogate || code == 0xfffe || code == 0xffff || code > 0x10ffff) return 0;
    return more + 1;
  }
  return 0;
}

enum { LONGEST_ESCAPE = 6 };

/* Writes the text as the value of an attribute and returns the end of it, or NULL when XML cannot hold it. */
static char *escape(const char *text, char *out) {
  static const char special[] = "&<>\"'";
  static const char *const entity[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&apos;"};
  while (*text) {
    const size_t bytes = character((const unsigned char *)text);
    if (!bytes) return NULL;
    const char *found = strchr(special, *text);
    if (found) {
      const char *name = entity[found - special];
      const size_t length = strlen(name);
      memcpy(out, name, length);
      out += length;
    } else {
      memcpy(out, text, bytes);
      out += bytes;
    }
    text += bytes;
  }
  *out = '\0';
  return out;
}

static void free_series(mpm_series *series) {
  mpm_context *context = series->context;
  series->magic = 0;
  mpmi_free(context, series->path, series->path_bytes);
  mpmi_free(context, series, sizeof *series);
}

/* Creates the file of an empty series. Returns 0 or the number of the error. */
static int create(mpm_series *series) {
  int error = mpmi_file_create(series->path, &series->file);
  if (error) return error;
  error = mpmi_file_write_at(series->file, 0, head, sizeof head - 1);
  if (!error) error = mpmi_file_write_at(series->file, sizeof head - 1, tail, sizeof tail - 1);
  if (error) fclose(series->file);
  return error;
}

mpm_status mpm_series_open(mpm_context *context, const char *path, mpm_series **out) {
  if (out) *out = NULL;
  MPMI_ENTER_CONTEXT(context);
  if (!out) return mpmi_fail(context, MPM_E_ARG, "mpm_series_open: out is NULL");
  mpm_status status = mpmi_check_path(context, path);
  if (status) return status;
  mpm_series *series = mpmi_alloc_zeroed(context, sizeof *series);
  if (!series) return MPM_E_NOMEM;
  series->context = context;
  series->end = sizeof head - 1;
  series->path_bytes = strlen(path) + 1;
  series->path = mpmi_alloc(context, series->path_bytes);
  if (!series->path) {
    free_series(series);
    return MPM_E_NOMEM;
  }
  memcpy(series->path, path, series->path_bytes);
  const int error = create(series);
  if (error) {
    free_series(series);
    return mpmi_io_error(context, "write", path, error);
  }
  series->magic = MPMI_SERIES;
  context->children++;
  *out = series;
  return MPM_OK;
}

/* Writes entry and closing tags over the old ones. After an error the file is what it was. */
static mpm_status add_entry(mpm_series *series, const char *entry, size_t bytes) {
  const int error = mpmi_file_write_at(series->file, series->end, entry, bytes + sizeof tail - 1);
  if (!error) {
    series->end += (int64_t)bytes;
    return MPM_OK;
  }
  mpmi_file_write_at(series->file, series->end, tail, sizeof tail - 1);
  mpmi_file_cut(series->file, series->end + (int64_t)sizeof tail - 1);
  return mpmi_io_error(series->context, "write", series->path, error);
}

mpm_status mpm_series_append(mpm_series *series, double t, const char *file) {
  MPMI_ENTER(series, MPMI_SERIES);
  mpm_context *context = series->context;
  if (!isfinite(t)) return mpmi_fail(context, MPM_E_ARG, "t is %g, must be finite", t);
  if (!file || !*file) return mpmi_fail(context, MPM_E_ARG, "file is %s", file ? "empty" : "NULL");
  char time[MPMI_REAL];
  mpmi_print_real(t, time);
  static const char before[] = "    <DataSet timestep=\"%s\" part=\"0\" file=\"", after[] = "\"/>\n";
  const size_t capacity =
      sizeof before + sizeof time + LONGEST_ESCAPE * strlen(file) + sizeof after + sizeof tail;
  char *entry = mpmi_alloc(context, capacity);
  if (!entry) return MPM_E_NOMEM;
  char *at = escape(file, entry + snprintf(entry, capacity, before, time));
  mpm_status status;
  if (at) {
    memcpy(at, after, sizeof after - 1);
    at += sizeof after - 1;
    memcpy(at, tail, sizeof tail - 1);
    status = add_entry(series, entry, (size_t)(at - entry));
  } else {
    status = mpmi_fail(context, MPM_E_ARG, "file is not UTF-8 text that XML can hold: %s", file);
  }
  mpmi_free(context, entry, capacity);
  return status;
}

mpm_status mpm_series_close(mpm_series *series) {
  if (!series) return MPM_OK;
  MPMI_ENTER(series, MPMI_SERIES);
  mpm_context *context = series->context;
  mpm_status status = MPM_OK;
  errno = 0;
  if (fclose(series->file))
    status = mpmi_io_error(context, "write", series->path, errno ? errno : MPMI_STORAGE_FAILED);
  context->children--;
  free_series(series);
  return status;
}
