/* Tables of which each part has some rows, and all learn of all. */
#ifndef TABLE_H
#define TABLE_H

#include "processes.h"

#include <stddef.h>

/* Rows with a key and some bytes, those of all parts by ascending key. */
typedef struct row {
  int64_t key;
  const char *bytes;
} row;

typedef struct table {
  int64_t n;
  row *row;
  char *memory[PROCESSES_MOST]; /* of each part: its number of rows, keys and bytes */
} table;

/* The rows of all parts, of which n with `width` bytes each are here. way: NULL where one part is all. A key
 * that two rows have ends the program. */
void gather_rows(const mpm_transport *way, int64_t n, const int64_t *key, const char *bytes, size_t width,
                 table *t);
void sort_rows(table *t);
const row *find_row(const table *t, int64_t key); /* NULL: there is none */
void drop_rows(table *t);

/* What has no way out ends the program. */
void stop(const char *why);
void must(mpm_status status);
void *room_for(int64_t n, size_t each); /* zeros; one more, so that there is always something */

#endif
