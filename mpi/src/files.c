/* fseeko() and strerror_r() of POSIX */
#define _POSIX_C_SOURCE 200809L
#include "files.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LONG_GAP = 1 << 20, LINE = 1024 };

mpm_status mpmx_file_error(mpm_mpi *m, const char *verb, const char *path, int error) {
  char text[128] = "the storage failed";
  if (error && strerror_r(error, text, sizeof text)) snprintf(text, sizeof text, "error %d", error);
  return mpmx_fail(m, MPM_E_IO, "cannot %s %.250s: %s", verb, path, text);
}

mpm_status mpmx_file_open(mpm_mpi *m, mpmx_file *file, const char *path) {
  static const char suffix[] = ".writing";
  const size_t length = strlen(path) + 1;
  *file = (mpmx_file){.bytes = 2 * length + sizeof suffix};
  file->path = mpmx_alloc(m, file->bytes);
  if (!file->path) return mpmx_fail(m, MPM_E_NOMEM, "there is no memory for %zu bytes", file->bytes);
  memcpy(file->path, path, length);
  file->temporary = file->path + length;
  memcpy(file->temporary, path, length - 1);
  memcpy(file->temporary + length - 1, suffix, sizeof suffix);
  file->stream = fopen(file->temporary, "wb");
  if (file->stream) return MPM_OK;
  const int error = errno;
  mpmx_free(m, file->path, file->bytes);
  *file = (mpmx_file){0};
  return mpmx_file_error(m, "write", path, error);
}

static void note(mpmx_file *file, int failed) {
  if (failed && !file->error) file->error = errno ? errno : EIO;
}

void mpmx_file_write(mpmx_file *file, const void *data, size_t bytes) {
  errno = 0;
  if (!file->error) note(file, fwrite(data, 1, bytes, file->stream) != bytes);
  file->place += (int64_t)bytes;
}

void mpmx_file_print(mpmx_file *file, const char *format, ...) {
  char text[LINE];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  mpmx_file_write(file, text, strlen(text));
}

void mpmx_file_zeros(mpmx_file *file, int64_t bytes) {
  static const char zero[4096];
  if (bytes >= LONG_GAP) {
    errno = 0;
    if (!file->error) note(file, fseeko(file->stream, (off_t)bytes, SEEK_CUR));
    file->place += bytes;
    return;
  }
  for (; bytes > 0; bytes -= (int64_t)sizeof zero)
    mpmx_file_write(file, zero, bytes < (int64_t)sizeof zero ? (size_t)bytes : sizeof zero);
}

mpm_status mpmx_file_close(mpm_mpi *m, mpmx_file *file, int32_t drop) {
  if (!file->stream) return MPM_OK;
  errno = 0;
  note(file, fclose(file->stream));
  if (!drop && !file->error) note(file, rename(file->temporary, file->path));
  mpm_status status = MPM_OK;
  if (drop || file->error) unlink(file->temporary);
  if (!drop && file->error) status = mpmx_file_error(m, "write", file->path, file->error);
  mpmx_free(m, file->path, file->bytes);
  *file = (mpmx_file){0};
  return status;
}

/* ---- places */

static void escape(const char *from, size_t length, char *to) {
  for (size_t i = 0; i < length; ++i) {
    const char c = from[i], *as = c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : NULL;
    if (as) {
      memcpy(to, as, strlen(as));
      to += strlen(as);
    } else {
      *to++ = c;
    }
  }
  *to = '\0';
}

static mpm_status make_folder(mpm_mpi *m, const char *path) {
  if (m->part || !mkdir(path, 0777) || errno == EEXIST) return MPM_OK;
  return mpmx_file_error(m, "make the folder", path, errno);
}

static mpm_status name_place(mpm_mpi *m, mpmx_place *place, const char *path, const char *index_suffix,
                             const char *piece_suffix) {
  const size_t length = strlen(path), suffix = strlen(index_suffix), stem = length - suffix;
  const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
  if (length <= suffix + (size_t)(base - path) || strcmp(path + stem, index_suffix))
    return mpmx_fail(m, MPM_E_ARG, "\"%.250s\": the name is to end with %s", path, index_suffix);
  *place = (mpmx_place){.bytes = 2 * length + 40, .name_long = 6 * length + 1};
  place->index = mpmx_alloc(m, place->bytes);
  place->piece = mpmx_alloc(m, place->bytes);
  place->name = mpmx_alloc(m, place->name_long);
  if (!place->index || !place->piece || !place->name)
    return mpmx_fail(m, MPM_E_NOMEM, "there is no memory for names");
  memcpy(place->index, path, length + 1);
  snprintf(place->piece, place->bytes, "%.*s/%.*s_%d%s", (int)stem, path, (int)(path + stem - base), base,
           (int)m->writer, piece_suffix);
  escape(base, (size_t)(path + stem - base), place->name);
  return MPM_OK;
}

mpm_status mpmx_place_make(mpm_mpi *m, mpmx_place *place, const char *path, const char *index_suffix,
                           const char *piece_suffix) {
  *place = (mpmx_place){0};
  mpm_status status = name_place(m, place, path, index_suffix, piece_suffix);
  if (!status) {
    char *last = strrchr(place->piece, '/');
    *last = '\0';
    status = make_folder(m, place->piece);
    *last = '/';
  }
  status = mpmx_agree(m, status);
  if (status) mpmx_place_free(m, place);
  return status;
}

void mpmx_place_free(mpm_mpi *m, mpmx_place *place) {
  mpmx_free(m, place->index, place->bytes);
  mpmx_free(m, place->piece, place->bytes);
  mpmx_free(m, place->name, place->name_long);
  *place = (mpmx_place){0};
}

/* ---- who writes */

static mpm_status check_output(mpm_mpi *m, const mpm_mpi_output *given, mpm_mpi_output *out) {
  *out = (mpm_mpi_output){.struct_size = sizeof *out};
  if (!given) return MPM_OK;
  const uint32_t size = given->struct_size;
  if (size < sizeof *out || size > 1 << 16)
    return mpmx_fail(
        m, MPM_E_ARG,
        size < sizeof *out
            ? "mpm_mpi_output: struct_size is %u, must be at least %zu"
            : "mpm_mpi_output: struct_size is %u, more than any version has, which of this one is %zu",
        (unsigned)size, sizeof *out);
  const unsigned char *byte = (const unsigned char *)given;
  for (uint32_t i = sizeof *out; i < size; ++i)
    if (byte[i])
      return mpmx_fail(m, MPM_E_UNSUPPORTED,
                       "mpm_mpi_output: this version does not know the field at byte %u", (unsigned)i);
  *out = *given;
  if (out->writers < 0 || out->writers > m->parts)
    return mpmx_fail(m, MPM_E_ARG, "writers is %d, must be 0 to %d", (int)out->writers, (int)m->parts);
  if (out->count < 0 || (out->count && !out->fields))
    return mpmx_fail(m, MPM_E_ARG, "count is %d, fields is %s", (int)out->count,
                     out->fields ? "set" : "NULL");
  if (out->reserved)
    return mpmx_fail(m, MPM_E_UNSUPPORTED, "mpm_mpi_output: reserved is %d, must be 0", (int)out->reserved);
  for (int32_t i = 0; i < out->count; ++i)
    if (!out->fields[i]) return mpmx_fail(m, MPM_E_ARG, "fields[%d] is NULL", (int)i);
  return MPM_OK;
}

mpm_status mpmx_check_path(mpm_mpi *m, const char *path) {
  return path && *path ? MPM_OK : mpmx_fail(m, MPM_E_ARG, path ? "path is empty" : "path is NULL");
}

/* Neighbours in order of parts give to one writer, which is the first of them. */
static mpm_status divide(mpm_mpi *m, int32_t writers) {
  if (m->group != MPI_COMM_NULL && m->group_writers == writers) return MPM_OK;
  if (m->group != MPI_COMM_NULL) MPI_Comm_free(&m->group);
  const int colour = writers ? (int)((int64_t)m->part * writers / m->parts) : 0;
  mpm_status status = mpmx_mpi(
      m,
      writers ? MPI_Comm_split(m->comm, colour, m->part, &m->group)
              : MPI_Comm_split_type(m->comm, MPI_COMM_TYPE_SHARED, m->part, MPI_INFO_NULL, &m->group),
      MPM_E_CALLBACK, "MPI_Comm_split");
  if (status) {
    m->group = MPI_COMM_NULL;
    return status;
  }
  int place = 0, before = 0, all = 0;
  MPI_Comm_rank(m->group, &place);
  const int leads = place == 0;
  status =
      mpmx_mpi(m, MPI_Exscan(&leads, &before, 1, MPI_INT, MPI_SUM, m->comm), MPM_E_CALLBACK, "MPI_Exscan");
  if (!m->part) before = 0;
  if (!status)
    status = mpmx_mpi(m, MPI_Allreduce(&leads, &all, 1, MPI_INT, MPI_SUM, m->comm), MPM_E_CALLBACK,
                      "MPI_Allreduce");
  if (!status) status = mpmx_mpi(m, MPI_Bcast(&before, 1, MPI_INT, 0, m->group), MPM_E_CALLBACK, "MPI_Bcast");
  m->writer = before;
  m->writers = all;
  m->group_writers = status ? -1 : writers;
  return status;
}

mpm_status mpmx_output_begin(mpm_mpi *m, mpm_status status, const mpm_mpi_output *given, const char *path,
                             mpm_mpi_output *out) {
  if (!status) status = mpmx_check_path(m, path);
  if (!status) status = check_output(m, given, out);
  uint64_t hash = MPMX_HASH;
  if (!status) {
    hash = mpmx_hash(hash, path, strlen(path));
    hash = mpmx_hash(hash, &out->writers, sizeof out->writers);
    for (int32_t i = 0; i < out->count; ++i) hash = mpmx_hash(hash, out->fields[i], strlen(out->fields[i]));
  }
  status = mpmx_agree_on(m, status, hash, MPM_E_ARG, "path, writers or fields differ between the parts");
  return status ? status : mpmx_agree(m, divide(m, out->writers));
}
