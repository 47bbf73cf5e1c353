/* A state in one file, by MPI-IO: the pieces of all parts one after another, in their order.
 *
 *   0   8 bytes  "MPMPARTS"
 *   8   u32      number of the format, 1
 *   12  u32      0
 *   16  u64      pieces
 *   24  u64      bytes of the file
 *   32  u64      sum over what stands before it and over the table
 *   40  table    of each piece u64 offset, u64 bytes
 *
 * Numbers have their lowest byte first. Pieces are what mpm_state_save() gives, with a sum of their own, at
 * multiples of 64. */
/* realpath(), fsync() and strerror_r() of POSIX */
#define _XOPEN_SOURCE 700
#include "files.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char magic[8] = {'M', 'P', 'M', 'P', 'A', 'R', 'T', 'S'};
enum { FORMAT = 1, HEADER = 40, ENTRY = 16 };

static void put(unsigned char *to, uint64_t value, int32_t bytes) {
  for (int32_t i = 0; i < bytes; ++i) to[i] = (unsigned char)(value >> 8 * i);
}

static uint64_t get(const unsigned char *from, int32_t bytes) {
  uint64_t value = 0;
  for (int32_t i = bytes; i-- > 0;) value = value << 8 | from[i];
  return value;
}

static uint64_t sum_of(const unsigned char *header, int64_t pieces) {
  return mpmx_hash(mpmx_hash(MPMX_HASH, header, HEADER - 8), header + HEADER, (size_t)pieces * ENTRY);
}

static int64_t aligned(int64_t place) {
  return (place + MPMX_ALIGNMENT - 1) / MPMX_ALIGNMENT * MPMX_ALIGNMENT;
}

/* How often all of them have to write or read, for no count to be more than an int. */
static mpm_status rounds_of(mpm_mpi *m, int64_t bytes, int64_t *rounds) {
  *rounds = (bytes + MPMX_PIECE - 1) / MPMX_PIECE;
  return mpmx_mpi(m, MPI_Allreduce(MPI_IN_PLACE, rounds, 1, MPI_INT64_T, MPI_MAX, m->comm), MPM_E_CALLBACK,
                  "MPI_Allreduce");
}

typedef int (*access_fn)(MPI_File file, MPI_Offset place, void *data, int count, MPI_Datatype type,
                         MPI_Status *status);

static int write_at(MPI_File file, MPI_Offset place, void *data, int count, MPI_Datatype type,
                    MPI_Status *status) {
  return MPI_File_write_at_all(file, place, data, count, type, status);
}

/* Everybody comes to every round, whatever has happened to it. */
static mpm_status in_rounds(mpm_mpi *m, MPI_File file, access_fn access, const char *call,
                            unsigned char *data, int64_t place, int64_t bytes) {
  int64_t rounds;
  mpm_status failed = rounds_of(m, bytes, &rounds);
  for (int64_t i = 0, done = 0; i < rounds; ++i) {
    const int64_t left = bytes - done, n = left < MPMX_PIECE ? left : MPMX_PIECE;
    MPI_Status is;
    int moved = 0;
    mpm_status status =
        mpmx_mpi(m, access(file, place + done, data + done, (int)n, MPI_BYTE, &is), MPM_E_IO, call);
    if (!status) status = mpmx_mpi(m, MPI_Get_count(&is, MPI_BYTE, &moved), MPM_E_IO, "MPI_Get_count");
    if (!status && moved != n)
      status = mpmx_fail(m, MPM_E_IO, "%s: %d of %lld bytes were moved", call, moved, (long long)n);
    if (!failed) failed = status;
    done += n;
  }
  return failed;
}

/* Files that do not open go by the handler of MPI_FILE_NULL, which is the host's: it has its own again
 * afterwards. ROMIO takes what stands before a colon for the name of a file system; "ufs:" is that of any.
 * Collective. */
static mpm_status open_file(mpm_mpi *m, const char *path, int mode, MPI_File *file) {
  MPI_Errhandler of_host;
  const int32_t known = MPI_File_get_errhandler(MPI_FILE_NULL, &of_host) == MPI_SUCCESS;
  MPI_File_set_errhandler(MPI_FILE_NULL, MPI_ERRORS_RETURN);
  int code = MPI_File_open(m->comm, path, mode, MPI_INFO_NULL, file);
  mpm_status status = mpmx_agree(m, mpmx_mpi(m, code, MPM_E_IO, "MPI_File_open"));
  if (status == MPM_E_IO && strchr(path, ':')) {
    char plain[PATH_MAX + 8];
    snprintf(plain, sizeof plain, "ufs:%s", path);
    code = MPI_File_open(m->comm, plain, mode, MPI_INFO_NULL, file);
    status = mpmx_agree(m, mpmx_mpi(m, code, MPM_E_IO, "MPI_File_open"));
  }
  if (known) {
    MPI_File_set_errhandler(MPI_FILE_NULL, of_host);
    MPI_Errhandler_free(&of_host);
  }
  if (!status) MPI_File_set_errhandler(*file, MPI_ERRORS_RETURN);
  return status;
}

/* ---- saving */

typedef struct saving {
  mpm_mpi *m;
  char target[PATH_MAX], temporary[PATH_MAX + 16];
  unsigned char *piece, *header; /* the header is part 0's */
  int64_t bytes, *all;           /* of this piece, and of each */
  size_t header_bytes;
} saving;

/* What a symbolic link leads to is replaced, not the link. */
static mpm_status find_target(saving *s, const char *path) {
  if (!realpath(path, s->target)) {
    if (errno != ENOENT) return mpmx_file_error(s->m, "write", path, errno);
    if (strlen(path) >= sizeof s->target) return mpmx_file_error(s->m, "write", path, ENAMETOOLONG);
    snprintf(s->target, sizeof s->target, "%s", path);
  }
  snprintf(s->temporary, sizeof s->temporary, "%s.writing", s->target);
  return MPM_OK;
}

static mpm_status refuse(mpm_mpi *m, mpm_status status, const char *call) {
  return mpmx_fail(m, status, "%s: %s, %s", call, mpm_status_name(status), mpm_status_text(status));
}

static mpm_status make_room(saving *s, const mpm_stepper *stepper) {
  mpm_mpi *m = s->m;
  const mpm_status status = mpm_state_size(stepper, &s->bytes);
  if (status) return refuse(m, status, "mpm_state_size");
  s->piece = mpmx_alloc(m, (size_t)s->bytes);
  s->all = mpmx_alloc(m, (size_t)m->parts * sizeof *s->all);
  s->header_bytes = HEADER + (size_t)m->parts * ENTRY;
  s->header = m->part ? NULL : mpmx_alloc(m, s->header_bytes);
  if (s->piece && s->all && (s->header || m->part)) return MPM_OK;
  return mpmx_fail(m, MPM_E_NOMEM, "there is no memory for a state of %lld bytes", (long long)s->bytes);
}

/* All parts save together, or none. */
static mpm_status make_piece(saving *s, const mpm_stepper *stepper) {
  mpm_status status = mpmx_agree(s->m, make_room(s, stepper));
  if (status) return status;
  status = mpm_state_save(stepper, s->piece, s->bytes);
  if (status) refuse(s->m, status, "mpm_state_save");
  return mpmx_agree(s->m, status);
}

/* Fills the header and finds where the piece of this part goes, and how long the file is. */
static void lay_out(saving *s, int64_t *place, int64_t *whole) {
  mpm_mpi *m = s->m;
  int64_t next = (int64_t)(HEADER + (size_t)m->parts * ENTRY);
  for (int32_t i = 0; i < m->parts; ++i) {
    next = aligned(next);
    if (i == m->part) *place = next;
    if (s->header) {
      put(s->header + HEADER + (size_t)i * ENTRY, (uint64_t)next, 8);
      put(s->header + HEADER + (size_t)i * ENTRY + 8, (uint64_t)s->all[i], 8);
    }
    next += s->all[i];
  }
  *whole = next;
  if (!s->header) return;
  memcpy(s->header, magic, sizeof magic);
  put(s->header + 8, FORMAT, 4);
  put(s->header + 12, 0, 4);
  put(s->header + 16, (uint64_t)m->parts, 8);
  put(s->header + 24, (uint64_t)next, 8);
  put(s->header + 32, sum_of(s->header, m->parts), 8);
}

static mpm_status write_pieces(saving *s) {
  mpm_mpi *m = s->m;
  MPI_File file;
  int64_t place = 0, whole = 0;
  lay_out(s, &place, &whole);
  mpm_status status = open_file(m, s->temporary, MPI_MODE_CREATE | MPI_MODE_WRONLY, &file);
  if (status) return status;
  /* one of that name may have been left behind, and be longer */
  status = mpmx_mpi(m, MPI_File_set_size(file, whole), MPM_E_IO, "MPI_File_set_size");
  mpm_status next = in_rounds(m, file, write_at, "MPI_File_write_at_all", s->header, 0,
                              s->header ? (int64_t)s->header_bytes : 0);
  if (!status) status = next;
  next = in_rounds(m, file, write_at, "MPI_File_write_at_all", s->piece, place, s->bytes);
  if (!status) status = next;
  next = mpmx_mpi(m, MPI_File_sync(file), MPM_E_IO, "MPI_File_sync");
  if (!status) status = next;
  next = mpmx_mpi(m, MPI_File_close(&file), MPM_E_IO, "MPI_File_close");
  return mpmx_agree(m, status ? status : next);
}

/* The name in the folder has to last as well. Where folders cannot be synchronised that is left to them. */
static void sync_folder(const char *path) {
  char folder[PATH_MAX];
  const char *slash = strrchr(path, '/');
  snprintf(folder, sizeof folder, "%.*s", slash ? (int)(slash - path + 1) : 1, slash ? path : ".");
  const int descriptor = open(folder, O_RDONLY);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

static mpm_status rename_file(saving *s) {
  struct stat old;
  if (!stat(s->target, &old)) chmod(s->temporary, old.st_mode & 07777);
  if (rename(s->temporary, s->target)) {
    const mpm_status status = mpmx_file_error(s->m, "write", s->target, errno);
    unlink(s->temporary);
    return status;
  }
  sync_folder(s->target);
  return MPM_OK;
}

static mpm_status save(saving *s, const mpm_stepper *stepper) {
  mpm_mpi *m = s->m;
  mpm_status status = make_piece(s, stepper);
  if (status) return status;
  status = mpmx_mpi(m, MPI_Allgather(&s->bytes, 1, MPI_INT64_T, s->all, 1, MPI_INT64_T, m->comm),
                    MPM_E_CALLBACK, "MPI_Allgather");
  /* part 0 knows what path leads to */
  if (!status)
    status = mpmx_mpi(m, MPI_Bcast(s->temporary, (int)sizeof s->temporary, MPI_CHAR, 0, m->comm),
                      MPM_E_CALLBACK, "MPI_Bcast");
  status = mpmx_agree(m, status);
  if (!status) status = write_pieces(s);
  if (!status) return mpmx_agree(m, m->part ? MPM_OK : rename_file(s));
  if (!m->part) unlink(s->temporary);
  return status;
}

/* Refuses on all what one refuses, before anything is done. */
static mpm_status begin(mpm_mpi *m, const void *stepper, const char *path) {
  mpm_status status = stepper ? mpmx_check_path(m, path) : mpmx_fail(m, MPM_E_ARG, "stepper is NULL");
  return mpmx_agree_on(m, status, status ? 0 : mpmx_hash(MPMX_HASH, path, strlen(path)), MPM_E_ARG,
                       "path differs between the parts");
}

mpm_status mpm_mpi_save(mpm_mpi *m, const mpm_stepper *stepper, const char *path) {
  if (!m) return MPM_E_ARG;
  mpm_status status = begin(m, stepper, path);
  if (status) return status;
  saving *s = mpmx_alloc(m, sizeof *s);
  if (s) *s = (saving){.m = m};
  status = s ? MPM_OK : mpmx_fail(m, MPM_E_NOMEM, "there is no memory");
  if (!status && !m->part) status = find_target(s, path);
  status = mpmx_agree(m, status);
  if (!status) status = save(s, stepper);
  if (s) {
    mpmx_free(m, s->piece, (size_t)s->bytes);
    mpmx_free(m, s->all, (size_t)m->parts * sizeof *s->all);
    mpmx_free(m, s->header, s->header_bytes);
  }
  mpmx_free(m, s, sizeof *s);
  return status;
}

/* ---- loading */

typedef struct loading {
  mpm_mpi *m;
  int64_t pieces;
  unsigned char *table; /* header and table of the file, on all parts; NULL: the file is one piece */
  size_t table_bytes;
  int64_t file_bytes;
  int64_t begin, end; /* of this part's bytes in the file */
  unsigned char *data;
  const void **piece;
  int64_t *bytes;
  int32_t count; /* of its pieces */
} loading;

static int64_t offset_of(const loading *l, int64_t i) {
  return l->table ? (int64_t)get(l->table + HEADER + i * ENTRY, 8) : 0;
}

static int64_t bytes_of(const loading *l, int64_t i) {
  return l->table ? (int64_t)get(l->table + HEADER + i * ENTRY + 8, 8) : l->file_bytes;
}

/* Pieces lie one behind the other, within the file. */
static mpm_status check_table(const loading *l, const char *path) {
  mpm_mpi *m = l->m;
  int64_t end = HEADER + l->pieces * ENTRY;
  if (get(l->table + 32, 8) != sum_of(l->table, l->pieces))
    return mpmx_fail(m, MPM_E_FORMAT, "%.250s: the table of pieces is damaged", path);
  for (int64_t i = 0; i < l->pieces; ++i) {
    if (offset_of(l, i) < end || offset_of(l, i) % MPMX_ALIGNMENT || bytes_of(l, i) < 0 ||
        bytes_of(l, i) > l->file_bytes || offset_of(l, i) > l->file_bytes - bytes_of(l, i))
      return mpmx_fail(m, MPM_E_FORMAT, "%.250s: piece %lld is not in the file", path, (long long)i);
    end = offset_of(l, i) + bytes_of(l, i);
  }
  return MPM_OK;
}

static mpm_status read_table(loading *l, FILE *in, const char *path) {
  mpm_mpi *m = l->m;
  unsigned char header[HEADER];
  errno = 0;
  if (fseeko(in, 0, SEEK_END)) return mpmx_file_error(m, "read", path, errno);
  l->file_bytes = (int64_t)ftello(in);
  rewind(in);
  l->pieces = 1;
  /* of a state that one part saved there is nothing but the state */
  if (l->file_bytes < HEADER || fread(header, 1, HEADER, in) != HEADER || memcmp(header, magic, sizeof magic))
    return ferror(in) ? mpmx_file_error(m, "read", path, errno) : MPM_OK;
  if (get(header + 8, 4) != FORMAT)
    return mpmx_fail(m, MPM_E_FORMAT, "%.250s: the format is %llu, this version reads %d", path,
                     (unsigned long long)get(header + 8, 4), FORMAT);
  const uint64_t pieces = get(header + 16, 8);
  if (get(header + 24, 8) != (uint64_t)l->file_bytes || !pieces ||
      pieces > ((uint64_t)l->file_bytes - HEADER) / ENTRY || pieces > INT32_MAX)
    return mpmx_fail(m, MPM_E_FORMAT, "%.250s: there are %lld bytes, the header says %llu, with %llu pieces",
                     path, (long long)l->file_bytes, (unsigned long long)get(header + 24, 8),
                     (unsigned long long)pieces);
  l->pieces = (int64_t)pieces;
  l->table_bytes = HEADER + (size_t)pieces * ENTRY;
  l->table = mpmx_alloc(m, l->table_bytes);
  if (!l->table) return mpmx_fail(m, MPM_E_NOMEM, "there is no memory for %zu bytes", l->table_bytes);
  memcpy(l->table, header, HEADER);
  if (fread(l->table + HEADER, 1, l->table_bytes - HEADER, in) != l->table_bytes - HEADER)
    return mpmx_file_error(m, "read", path, errno);
  return check_table(l, path);
}

static mpm_status read_header(loading *l, const char *path) {
  if (l->m->part) return MPM_OK;
  FILE *in = fopen(path, "rb");
  if (!in) return mpmx_file_error(l->m, "read", path, errno);
  const mpm_status status = read_table(l, in, path);
  fclose(in);
  return status;
}

/* What part 0 has read, for all. */
static mpm_status share_table(loading *l) {
  mpm_mpi *m = l->m;
  int64_t shared[3] = {l->pieces, (int64_t)l->table_bytes, l->file_bytes};
  mpm_status status = mpmx_mpi(m, MPI_Bcast(shared, 3, MPI_INT64_T, 0, m->comm), MPM_E_CALLBACK, "MPI_Bcast");
  if (!status && m->part) {
    l->pieces = shared[0];
    l->table_bytes = (size_t)shared[1];
    l->file_bytes = shared[2];
    if (shared[1] && !(l->table = mpmx_alloc(m, l->table_bytes)))
      status = mpmx_fail(m, MPM_E_NOMEM, "there is no memory for %zu bytes", l->table_bytes);
  }
  status = mpmx_agree(m, status);
  for (size_t done = 0, n; done < l->table_bytes && !status; done += n) {
    n = l->table_bytes - done < MPMX_PIECE ? l->table_bytes - done : MPMX_PIECE;
    status =
        mpmx_mpi(m, MPI_Bcast(l->table + done, (int)n, MPI_BYTE, 0, m->comm), MPM_E_CALLBACK, "MPI_Bcast");
  }
  return status;
}

/* Runs of pieces, in order of parts. */
static mpm_status choose_pieces(loading *l) {
  mpm_mpi *m = l->m;
  const int64_t first = l->pieces * m->part / m->parts, last = l->pieces * (m->part + 1) / m->parts;
  l->count = (int32_t)(last - first);
  l->begin = l->count ? offset_of(l, first) : 0;
  l->end = l->count ? offset_of(l, last - 1) + bytes_of(l, last - 1) : 0;
  l->data = mpmx_alloc(m, (size_t)(l->end - l->begin));
  l->piece = mpmx_alloc(m, (size_t)l->count * sizeof *l->piece);
  l->bytes = mpmx_alloc(m, (size_t)l->count * sizeof *l->bytes);
  if (!l->data || !l->piece || !l->bytes)
    return mpmx_fail(m, MPM_E_NOMEM, "there is no memory for %lld bytes", (long long)(l->end - l->begin));
  for (int32_t i = 0; i < l->count; ++i) {
    l->piece[i] = l->data + (offset_of(l, first + i) - l->begin);
    l->bytes[i] = bytes_of(l, first + i);
  }
  return MPM_OK;
}

static mpm_status read_pieces(loading *l, const char *path) {
  mpm_mpi *m = l->m;
  MPI_File file;
  mpm_status status = open_file(m, path, MPI_MODE_RDONLY, &file);
  if (status) return status;
  status =
      in_rounds(m, file, MPI_File_read_at_all, "MPI_File_read_at_all", l->data, l->begin, l->end - l->begin);
  const mpm_status closed = mpmx_mpi(m, MPI_File_close(&file), MPM_E_IO, "MPI_File_close");
  return mpmx_agree(m, status ? status : closed);
}

static mpm_status load(loading *l, mpm_stepper *stepper, const char *path) {
  mpm_mpi *m = l->m;
  mpm_status status = mpmx_agree(m, read_header(l, path));
  if (!status) status = mpmx_agree(m, share_table(l));
  if (!status) status = mpmx_agree(m, choose_pieces(l));
  if (!status) status = read_pieces(l, path);
  if (status) return status;
  status = mpm_state_load_pieces(stepper, l->count, l->piece, l->bytes);
  if (status) refuse(m, status, "mpm_state_load_pieces");
  return mpmx_agree(m, status);
}

mpm_status mpm_mpi_load(mpm_mpi *m, mpm_stepper *stepper, const char *path) {
  if (!m) return MPM_E_ARG;
  loading l = {.m = m};
  mpm_status status = begin(m, stepper, path);
  if (!status) status = load(&l, stepper, path);
  mpmx_free(m, l.table, l.table_bytes);
  mpmx_free(m, l.data, (size_t)(l.end - l.begin));
  mpmx_free(m, l.piece, (size_t)l.count * sizeof *l.piece);
  mpmx_free(m, l.bytes, (size_t)l.count * sizeof *l.bytes);
  return status;
}
