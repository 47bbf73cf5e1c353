/* The head of a VTK file that libmpm writes: what stands before the arrays, which follow as they are. */
#ifndef MPMX_HEAD_H
#define MPMX_HEAD_H

#include "files.h"

enum { MPMX_NAME = 256 };

/* Text that grows while it comes in pieces. Ends with a zero. */
typedef struct mpmx_head {
  char *text;
  size_t used, room;
  int32_t whole; /* 1: all of it is here */
} mpmx_head;

/* One array of it. */
typedef struct mpmx_array {
  char type[16], name[MPMX_NAME];
  int32_t components, size; /* bytes of a component */
  int64_t offset;           /* in the data that follow */
} mpmx_array;

/* Takes what belongs to the head: *taken bytes of these. */
mpm_status mpmx_head_take(mpm_mpi *m, mpmx_head *head, const void *data, int64_t bytes, int64_t *taken);
void mpmx_head_free(mpm_mpi *m, mpmx_head *head);

/* The next array behind *at, which moves on; 0 if there is none before `end`, which may be NULL. */
int32_t mpmx_head_next(const char **at, const char *end, mpmx_array *out);
/* The value of an attribute of the element that begins at `element`, cut to fit. 0: it has none. */
int32_t mpmx_attribute(const char *element, const char *name, char *value, size_t bytes);
/* Of names, types and components of all arrays. */
uint64_t mpmx_head_hash(const mpmx_head *head);
/* Bytes that follow, if each array has so many tuples. */
int64_t mpmx_head_data(const mpmx_head *head, int64_t tuples);
/* Prints the arrays of the section, such as PointData, as the index has them. */
void mpmx_head_index(const mpmx_head *head, const char *section, mpmx_file *file);

/* First line of a file of that kind. */
void mpmx_print_start(mpmx_file *file, const char *kind);
/* Of an element of the index: where the piece of that writer is, and the end of the element. */
void mpmx_print_source(mpmx_file *file, const mpmx_place *place, int32_t writer, const char *suffix);
#define MPMX_DATA_FOLLOW "  <AppendedData encoding=\"raw\">\n_"
#define MPMX_DATA_END    "\n  </AppendedData>\n</VTKFile>\n"

#endif
