#include "table.h"

#include <mpm/mpm.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void stop(const char *why) {
  fprintf(stderr, "parts: %s\n", why);
  exit(3);
}

void must(mpm_status status) {
  if (status) stop(mpm_status_name(status));
}

void *room_for(int64_t n, size_t each) {
  void *memory = calloc((size_t)n + 1, each);
  if (!memory) stop("out of memory");
  return memory;
}

static int compare_rows(const void *a, const void *b) {
  const int64_t x = ((const row *)a)->key, y = ((const row *)b)->key;
  return x < y ? -1 : x > y;
}

static void append(table *t, const char *memory, size_t width) {
  int64_t n;
  memcpy(&n, memory, sizeof n);
  for (int64_t i = 0; i < n; ++i) {
    row *r = &t->row[t->n++];
    memcpy(&r->key, memory + 8 + 8 * i, sizeof r->key);
    r->bytes = memory + 8 + 8 * n + (size_t)i * width;
  }
}

void sort_rows(table *t) {
  qsort(t->row, (size_t)t->n, sizeof *t->row, compare_rows);
  for (int64_t i = 1; i < t->n; ++i)
    if (t->row[i].key == t->row[i - 1].key) stop("a particle or node comes twice");
}

void gather_rows(const mpm_transport *way, int64_t n, const int64_t *key, const char *bytes, size_t width,
                 table *t) {
  const int32_t me = way->part, parts = way->parts;
  const size_t size = 8 + (size_t)n * (8 + width);
  mpm_message out[PROCESSES_MOST];
  const mpm_message *in = NULL;
  int64_t most[PROCESSES_MOST], total = n;
  int32_t count = 0;
  *t = (table){0};
  char *mine = t->memory[me] = room_for((int64_t)size, 1);
  memcpy(mine, &n, sizeof n);
  if (n) {
    memcpy(mine + 8, key, (size_t)n * 8);
    memcpy(mine + 8 + 8 * n, bytes, (size_t)n * width);
  }
  for (int32_t p = 0; p < parts; ++p) {
    if (p == me) continue;
    most[count] = INT64_MAX;
    out[count++] = (mpm_message){.part = p, .bytes = (int64_t)size, .data = mine};
  }
  must(way->reduce(way->user, MPM_REDUCE_SUM, 1, &total));
  must(way->send(way->user, MPM_EXCHANGE_KNOWN, count, out, most));
  must(way->receive(way->user, &count, &in));
  for (int32_t i = 0; i < count; ++i)
    memcpy(t->memory[in[i].part] = room_for(in[i].bytes, 1), in[i].data, (size_t)in[i].bytes);
  t->row = room_for(total, sizeof *t->row);
  for (int32_t p = 0; p < parts; ++p) append(t, t->memory[p], width);
  if (t->n != total) stop("parts differ in what they tell");
  sort_rows(t);
}

void drop_rows(table *t) {
  for (int32_t p = 0; p < PROCESSES_MOST; ++p) free(t->memory[p]);
  free(t->row);
}

const row *find_row(const table *t, int64_t key) {
  const row wanted = {.key = key};
  return bsearch(&wanted, t->row, (size_t)t->n, sizeof *t->row, compare_rows);
}
