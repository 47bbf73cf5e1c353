/* Remedy against volumetric locking (MPoint theory eqs 47-53, carried to the deformation gradient). The law
 * sees
 *
 *   F_inc' = f F_inc,  f^d = (1 + j') / (1 + j),  j = det F_inc - 1,  j' = sum V j / sum V over the cell
 *
 * and F' = r^(1/d) F, where the ratio r grows by f^d in each step; in plane strain only the axes of the plane
 * are scaled. F, the volume and the positions are those without the remedy. The cell of a particle is known
 * by the node of its lower corner: sums over cells go the way of nodal sums, through tiles and by colours. */
#include "stepper/locking.h"

#include <math.h>
#include <string.h>

/* Place of each particle's cell in the tile. On a periodic axis any image that lies in the tile will do. */
void mpmi_cell_places(const mpm_grid *grid, const mpmi_axis *axis, const mpmi_points *points, int64_t begin,
                      int64_t n, int32_t *place) {
  const int32_t edge = MPMI_TILE_EDGE(grid->dim, grid->width);
  for (int64_t p = 0; p < n; ++p) {
    place[p] = 0;
    for (int32_t k = 0; k < grid->dim; ++k) {
      const mpmi_axis *a = axis + k;
      double cell = floor((points->x[k][begin + p] - a->origin) * a->inverse_spacing);
      if (cell > a->last_cell) cell = a->last_cell;
      double at = cell - a->tile_base;
      if (a->period > 0.0) at -= a->period * rint((at - a->middle) * a->inverse_period);
      place[p] = place[p] * edge + (int32_t)at;
    }
  }
}

/* det(I + dt L) - 1, expanded so that a small dt L keeps its digits. */
static double det_minus_1(int32_t dim, const double *L, int64_t ld, double dt) {
#define G(r, c) (dt * L[(3 * (r) + (c)) * ld])
  const double plane = (G(0, 0) + G(1, 1)) + G(0, 0) * G(1, 1) - G(0, 1) * G(1, 0);
  if (dim == 2) return plane;
  const double x = G(1, 0) * G(2, 1) - G(2, 0) * (1.0 + G(1, 1));
  const double y = (1.0 + G(0, 0)) * G(2, 1) - G(2, 0) * G(0, 1);
  return plane + G(2, 2) * (1.0 + plane) + G(0, 2) * x - G(1, 2) * y;
#undef G
}

void mpmi_locking_measure(const mpm_stepper *s, mpm_particles *set, const double *L, int64_t ld,
                          int64_t begin, int64_t n, double dt) {
  double *j = mpmi_f64(set, MPMI_DILATION_RATIO, 1) + begin;
  for (int64_t p = 0; p < n; ++p) {
    j[p] = det_minus_1(s->grid->dim, L + p, ld, dt);
    if (!isfinite(j[p])) j[p] = 0.0; /* the step will fail at this particle and not at its neighbours */
  }
}

typedef struct locking_job {
  mpm_stepper *s;
  int32_t colour;
} locking_job;

static void clear_task(void *data, int64_t k) {
  mpm_stepper *s = ((const locking_job *)data)->s;
  const int64_t values = 4 * s->blocks.count * s->blocks.nodes;
  const int64_t begin = values * k / s->tasks, end = values * (k + 1) / s->tasks;
  if (end > begin) memset(s->extra + begin, 0, (size_t)(end - begin) * sizeof *s->extra);
}

static void add_task(void *data, int64_t k) {
  const locking_job *job = data;
  mpm_stepper *s = job->s;
  const mpmi_cut *cut = &s->colour[job->colour];
  double *tile = s->scratch[k].cells;
  mpmi_axis axis[3];
  int32_t place[MPMI_CHUNK];
  memset(tile, 0, s->scratch[k].cells_bytes);
  for (int64_t i = cut->bound[k]; i < cut->bound[k + 1]; ++i) {
    const int32_t block = cut->list[i];
    mpmi_block_axes(s->grid, s->blocks.coord[block], axis);
    for (int32_t m = 0; m < s->member_count; ++m) {
      mpm_particles *set = s->member[m].set;
      if (mpmi_material_kinematics(set->material) == MPMI_F_STAYS) continue; /* rigid: nothing to average */
      const int64_t *start = s->member[m].now.start, *id = mpmi_i64(set, MPMI_ID, 0);
      const mpmi_points points = mpmi_points_of(set, 0);
      const double *j = mpmi_f64(set, MPMI_DILATION_RATIO, 1), *volume = mpmi_f64(set, MPMI_VOLUME, 0);
      for (int64_t at = start[block]; at < start[block + 1]; at += MPMI_CHUNK) {
        const int64_t left = start[block + 1] - at, n = left < MPMI_CHUNK ? left : MPMI_CHUNK;
        mpmi_cell_places(s->grid, axis, &points, at, n, place);
        for (int64_t p = 0; p < n; ++p) {
          if (id[at + p] < 0) continue;
          tile[4 * place[p]] += volume[at + p] * j[at + p];
          tile[4 * place[p] + 1] += volume[at + p];
        }
      }
    }
    mpmi_tile_add(s, block, s->extra, 4, tile);
  }
}

/* Cells at a periodic seam have been added up on both sides of it. Ghosts of walls hold no cell. */
static void join_images(mpm_stepper *s) {
  const mpmi_constraints *c = &s->constraints;
  for (int64_t i = 0; i < c->tie_count; ++i) {
    double *master = s->extra + 4 * c->tie[i].master;
    const int64_t first = c->tie[i].first, end = first + c->tie[i].count;
    for (int64_t d = first; d < end; ++d)
      for (int32_t v = 0; v < 2; ++v) master[v] += s->extra[4 * c->follower[d].slot + v];
    for (int64_t d = first; d < end; ++d)
      for (int32_t v = 0; v < 2; ++v) s->extra[4 * c->follower[d].slot + v] = master[v];
  }
}

mpm_status mpmi_stage_locking(mpm_stepper *s, const double *nodes, int32_t values, double dt) {
  mpm_status status = mpmi_stage_g2p(s, MPMI_G2P_DILATION, nodes, values, dt);
  locking_job job = {s, 0};
  if (!status) status = mpmi_run_tasks(s, 0, s->tasks, clear_task, &job);
  for (; job.colour < MPMI_COLOURS && !status; ++job.colour)
    if (s->colour[job.colour].count) status = mpmi_run_tasks(s, 0, s->tasks, add_task, &job);
  if (!status) join_images(s);
  return status;
}

void mpmi_locking_apply(const mpm_stepper *s, const double *cells, const mpmi_axis *axis, mpm_particles *set,
                        mpmi_law_batch *b, int64_t begin, int64_t n, double dt) {
  const int32_t dim = s->grid->dim;
  const mpmi_points points = mpmi_points_of(set, 0);
  const double *old = mpmi_f64(set, MPMI_DILATION_RATIO, 0) + begin;
  double *ratio = mpmi_f64(set, MPMI_DILATION_RATIO, 1) + begin;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0) + begin;
  const int32_t rigid = mpmi_material_kinematics(set->material) == MPMI_F_STAYS;
  int32_t place[MPMI_CHUNK];
  for (int64_t p = 0; p < n; ++p) {
    ratio[p] = old[p];
    if (p % MPMI_CHUNK == 0)
      mpmi_cell_places(s->grid, axis, &points, begin + p, n - p < MPMI_CHUNK ? n - p : MPMI_CHUNK, place);
    if (rigid || id[p] < 0) continue;
    const double *cell = cells + 4 * place[p % MPMI_CHUNK];
    const double j = det_minus_1(dim, b->L + p, b->ld, dt);
    const double mean = cell[1] > 0.0 ? cell[0] / cell[1] : j;
    /* an inverted increment ends the step elsewhere */
    const double growth = j > -1.0 && mean > -1.0 ? log1p(mean) - log1p(j) : 0.0;
    const double f_minus_1 = expm1(growth / dim);
    ratio[p] = old[p] * exp(growth);
    for (int32_t r = 0; r < dim; ++r)
      for (int32_t c = 0; c < dim; ++c) {
        double *L = b->L + (3 * r + c) * b->ld + p;
        *L += f_minus_1 * (*L + (r == c ? 1.0 / dt : 0.0));
        b->F_inc[(3 * r + c) * b->ld + p] = (r == c ? 1.0 : 0.0) + dt * *L;
      }
  }
  mpmi_law_batch_scale_F(b, dim, ratio, n);
}
