/* Files that several processes write: who writes, under which name, and how a file comes to be there
 * whole. */
#ifndef MPMX_FILES_H
#define MPMX_FILES_H

#include "handle.h"

#include <stdio.h>

/* A file under its temporary name. */
typedef struct mpmx_file {
  FILE *stream; /* NULL: not open */
  char *path, *temporary;
  size_t bytes;  /* of both names */
  int error;     /* number of the first error, or 0 */
  int64_t place; /* bytes written */
} mpmx_file;

mpm_status mpmx_file_open(mpm_mpi *m, mpmx_file *file, const char *path);
void mpmx_file_write(mpmx_file *file, const void *data, size_t bytes);
void mpmx_file_print(mpmx_file *file, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* Long runs take no room on storage that knows holes. More data must follow. */
void mpmx_file_zeros(mpmx_file *file, int64_t bytes);
/* Gives it its name; or, where something failed or `drop` is 1, removes it. One that is not open is fine. */
mpm_status mpmx_file_close(mpm_mpi *m, mpmx_file *file, int32_t drop);
mpm_status mpmx_file_error(mpm_mpi *m, const char *verb, const char *path, int error);

/* Where an output in pieces goes: an index at path, and pieces in a folder of its name. */
typedef struct mpmx_place {
  char *index;      /* path */
  char *piece;      /* path of the piece of this writer */
  char *name;       /* of the folder, as the index has it, escaped for XML */
  size_t name_long; /* bytes of the memory of `name` */
  size_t bytes;     /* bytes of each of the others */
} mpmx_place;

/* Suffixes are those of index and pieces, with their points (collective). */
mpm_status mpmx_place_make(mpm_mpi *m, mpmx_place *place, const char *path, const char *index_suffix,
                           const char *piece_suffix);
void mpmx_place_free(mpm_mpi *m, mpmx_place *place);

mpm_status mpmx_check_path(mpm_mpi *m, const char *path);

/* Reads the struct of the host, checks it and what else must be alike, and divides the processes among the
 * writers (collective): m->group, m->writer, m->writers. */
mpm_status mpmx_output_begin(mpm_mpi *m, mpm_status status, const mpm_mpi_output *given, const char *path,
                             mpm_mpi_output *out);

#endif
