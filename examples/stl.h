/* Meshes of triangles in STL files, of text or binary, as mpm_particles_fill_mesh() takes them. */
#ifndef EXAMPLES_STL_H
#define EXAMPLES_STL_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* position is [3][3 * triangles], corner [triangles][3]: each triangle has points of its
 * own, as in the file. */
typedef struct stl_mesh {
  int64_t triangles;
  double *position;
  int64_t *corner;
} stl_mesh;

static inline void stl_close(stl_mesh *m) {
  free(m->position);
  free(m->corner);
}

/* 0, or -1 when there is no memory. */
static inline int stl_room(stl_mesh *m, int64_t triangles) {
  m->triangles = triangles;
  m->position = malloc(9 * (size_t)triangles * sizeof *m->position);
  m->corner = malloc(3 * (size_t)triangles * sizeof *m->corner);
  if (m->position && m->corner) return 0;
  stl_close(m);
  return -1;
}

static inline void stl_put(stl_mesh *m, int64_t point, const double x[3]) {
  for (int k = 0; k < 3; ++k) m->position[3 * m->triangles * k + point] = x[k];
  m->corner[point] = point;
}

/* Numbers in binary files are of 32 bits and begin with their lowest byte. */
static inline uint32_t stl_word(const unsigned char *at) {
  return at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static inline double stl_number(const unsigned char *at) {
  const uint32_t word = stl_word(at);
  float number;
  memcpy(&number, &word, sizeof number);
  return (double)number;
}

/* Text: what stands after each "vertex". Counts where m is NULL. */
static inline int64_t stl_vertices(const char *text, stl_mesh *m) {
  int64_t n = 0;
  for (const char *at = text; (at = strstr(at, "vertex")); ++n) {
    double x[3] = {0.0, 0.0, 0.0};
    char *end = (char *)at + 6;
    for (int k = 0; k < 3; ++k) {
      const char *from = end;
      x[k] = strtod(from, &end);
      if (end == from) return -1;
    }
    if (m) stl_put(m, n, x);
    at = end;
  }
  return n;
}

static inline int stl_read_memory(stl_mesh *m, const unsigned char *data, int64_t bytes) {
  const int64_t triangles = bytes >= 84 ? (int64_t)stl_word(data + 80) : 0;
  if (triangles > 0 && bytes == 84 + 50 * triangles) { /* so it is no text, which may begin alike */
    if (stl_room(m, triangles)) return -1;
    for (int64_t i = 0; i < 3 * triangles; ++i) {
      const unsigned char *at = data + 84 + 50 * (i / 3) + 12 + 12 * (i % 3);
      const double x[3] = {stl_number(at), stl_number(at + 4), stl_number(at + 8)};
      stl_put(m, i, x);
    }
    return 0;
  }
  const int64_t n = stl_vertices((const char *)data, NULL);
  if (n < 3 || n % 3 || stl_room(m, n / 3)) return -1;
  stl_vertices((const char *)data, m);
  return 0;
}

/* 0, or -1 when the file cannot be read or is no STL file. */
static inline int stl_read(stl_mesh *m, const char *path) {
  FILE *in = fopen(path, "rb");
  if (!in) return -1;
  long bytes = fseek(in, 0, SEEK_END) ? -1 : ftell(in);
  unsigned char *data = bytes > 0 && !fseek(in, 0, SEEK_SET) ? malloc((size_t)bytes + 1) : NULL;
  int status = data && fread(data, 1, (size_t)bytes, in) == (size_t)bytes ? 0 : -1;
  fclose(in);
  if (!status) {
    data[bytes] = 0;
    status = stl_read_memory(m, data, bytes);
  }
  free(data);
  return status;
}

#endif
