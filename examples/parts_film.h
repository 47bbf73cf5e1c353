/* A film strip in pairs, before and after blocks of the grid were given to other processes: the particles of
 * a slice from all processes, coloured by the process that has them. All processes call these functions
 * alike; the first one draws. */
#ifndef EXAMPLES_PARTS_FILM_H
#define EXAMPLES_PARTS_FILM_H

#include <mpm/mpm_mpi.h>

#include "film.h"

static const char *const parts_field = "in_slice"; /* of the set: 1 in particles that are shown */

typedef struct parts_film {
  film strip;      /* of the first process */
  double *last[2]; /* the frame before and this one: x[2][n], process[n] */
  double t_last;
  int64_t cuts; /* that the frame before knows of */
  int rank, processes;
} parts_film;

/* Marks particles of the set that lie below y, of this edge, as those of the slice. 0 on success. */
static inline int parts_film_open(parts_film *f, mpm_particles *set, double y, double edge) {
  const int64_t n = mpm_particles_count(set);
  long long mine = 0, all = 0;
  double *x = malloc((size_t)(3 * n + 1) * sizeof *x);
  uint8_t *shown = malloc((size_t)n + 1);
  int failed = !x || !shown || mpm_particles_get(set, "position", MPM_F64, 3, n, NULL, x);
  for (int64_t i = 0; i < n && !failed; ++i) mine += shown[i] = x[n + i] < y;
  failed = failed || mpm_particles_add_field(set, parts_field, MPM_U8, 1) ||
           mpm_particles_set(set, parts_field, MPM_U8, 1, n, NULL, shown);
  free(x);
  free(shown);
  MPI_Allreduce(&mine, &all, 1, MPI_LONG_LONG, MPI_SUM, MPI_COMM_WORLD);
  MPI_Comm_rank(MPI_COMM_WORLD, &f->rank);
  MPI_Comm_size(MPI_COMM_WORLD, &f->processes);
  f->strip = film_of(all, edge);
  for (int k = 0; k < 2 && !failed; ++k)
    failed = !(f->last[k] = malloc((size_t)(3 * all + 1) * sizeof(double)));
  return failed ? -1 : 0;
}

/* Puts the two frames at hand into the strip, if there is room. */
static inline int parts_film_keep(parts_film *f, double t) {
  const int64_t n = f->strip.n;
  for (int k = 0; k < 2 && f->strip.count < FILM_MOST; ++k) {
    const int frame = film_frame(&f->strip, k ? t : f->t_last);
    if (frame < 0) return -1;
    for (int64_t i = 0; i < 3 * n; ++i) f->strip.x[frame][i] = f->last[k][i];
  }
  return 0;
}

/* Takes what the processes have at time t. 0 on success. */
static inline int parts_film_shoot(parts_film *f, mpm_particles *set, double t, int64_t cuts) {
  const char *const fields[] = {"position", parts_field};
  const int64_t n = mpm_particles_count(set), all = f->strip.n;
  float *of = malloc((size_t)(4 * n + 1) * sizeof *of),
        *slice = malloc((size_t)(2 * all + 1) * sizeof *slice);
  int *count = calloc(2 * (size_t)f->processes, sizeof *count), *start = count ? count + f->processes : NULL;
  int mine = 0, failed = !of || !slice || !count;
  failed = failed || mpm_particles_get_f32(set, 2, fields, MPM_LIBRARY_ORDER, n, of);
  for (int64_t i = 0; i < n && !failed; ++i)
    if (of[4 * i + 3] > 0.0f) of[mine++] = of[4 * i], of[mine++] = of[4 * i + 2];
  if (failed) MPI_Abort(MPI_COMM_WORLD, 1); /* others wait */
  MPI_Gather(&mine, 1, MPI_INT, count, 1, MPI_INT, 0, MPI_COMM_WORLD);
  for (int p = 1; p < f->processes; ++p) start[p] = start[p - 1] + count[p - 1];
  MPI_Gatherv(of, mine, MPI_FLOAT, slice, count, start, MPI_FLOAT, 0, MPI_COMM_WORLD);
  double *const before = f->last[0];
  f->last[0] = f->last[1];
  f->last[1] = before;
  for (int p = 0; p < f->processes && !f->rank; ++p)
    for (int64_t i = start[p] / 2; i < (start[p] + count[p]) / 2; ++i) {
      f->last[1][i] = (double)slice[2 * i];
      f->last[1][all + i] = (double)slice[2 * i + 1];
      f->last[1][2 * all + i] = p + 0.5;
    }
  /* the first cut gives blocks to processes that had none; pairs are as far apart as shows the flow */
  const int pairs = f->strip.count / 2;
  if (!f->rank && f->cuts > 0 && cuts > f->cuts && (!pairs || t >= f->strip.t[2 * pairs - 1] + 0.15))
    failed = parts_film_keep(f, t);
  f->t_last = t;
  f->cuts = cuts;
  free(of);
  free(slice);
  free(count);
  return failed;
}

/* Writes the picture, on the first process; 0 on success. */
static inline int parts_film_draw(const parts_film *f, const char *path, double length, double height) {
  const film_view view = {.x_max = length,
                          .y_max = height,
                          .columns = 2,
                          .panel = 420.0,
                          .value_max = f->processes,
                          .title = "process"};
  return f->rank || !f->strip.count ? 0 : film_draw(&f->strip, &view, path);
}

static inline void parts_film_close(parts_film *f) {
  film_close(&f->strip);
  free(f->last[0]);
  free(f->last[1]);
}

#endif
