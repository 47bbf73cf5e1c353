/* Remedy against volumetric locking (MPoint theory eqs 47-53, carried to the deformation gradient). The law
 * sees
 *
 *   F_inc' = f F_inc,  f^d = (1 + j') / (1 + j),  j = det F_inc - 1,  j' = sum V j / sum V over the cell
 *
 * and F' = r^(1/d) F, where the ratio r grows by f^d in each step; in plane strain only the axes of the plane
 * are scaled. F, the volume and the positions are those without the remedy. The cell of a particle is known
 * by the node of its lower corner: sums over cells go the way of nodal sums (layout/accumulate.h). */
#include "stages/stages.h"
#include "layout/accumulate.h"
#include "layout/tile.h"
#include "layout/tasks.h"
#include "simd/elementary.h"
#include "stages/batch.h"

#include <math.h>

/* Sums over the particles in a cell, in the place of the four values of a node. */
typedef struct cell_sums {
  double dilation, volume; /* volume times j; volume */
  double unused[2];
} cell_sums;
_Static_assert(sizeof(cell_sums) == 4 * sizeof(double), "goes through tiles");

/* Finds the place of each particle's cell in the tile. On a periodic axis any image that lies in the tile
 * will do. */
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

/* Returns det(I + dt L) - 1, expanded so that a small dt L keeps its digits. */
static double det_minus_1(int32_t dim, const double *L, int64_t ld, double dt) {
#define G(r, c) (dt * L[(3 * (r) + (c)) * ld])
  const double plane = (G(0, 0) + G(1, 1)) + G(0, 0) * G(1, 1) - G(0, 1) * G(1, 0);
  if (dim == 2) return plane;
  const double x = G(1, 0) * G(2, 1) - G(2, 0) * (1.0 + G(1, 1));
  const double y = (1.0 + G(0, 0)) * G(2, 1) - G(2, 0) * G(0, 1);
  return plane + G(2, 2) * (1.0 + plane) + G(0, 2) * x - G(1, 2) * y;
#undef G
}

/* Measures det F_inc - 1 of each particle of a batch, into the second copy of its dilation ratio. */
static void measure(mpmi_batch *b) {
  double *j = mpmi_f64(b->set, MPMI_DILATION_RATIO, 1) + b->begin;
  for (int64_t p = 0; p < b->n; ++p) {
    j[p] = det_minus_1(b->set->grid->dim, b->law.L + p, b->law.ld, b->step->dt);
    if (!isfinite(j[p])) j[p] = 0.0; /* the step will fail at this particle and not at its neighbours */
  }
}

typedef struct locking_job {
  mpmi_step *step;
  const mpmi_nodal *cells;
} locking_job;

/* Adds volume times j, and volume, of a chunk to the cells of its particles. */
static void add_chunk(const mpm_particles *set, int64_t begin, int64_t n, const int32_t *place,
                      cell_sums *tile) {
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0) + begin;
  const double *j = mpmi_f64(set, MPMI_DILATION_RATIO, 1) + begin;
  const double *volume = mpmi_f64(set, MPMI_VOLUME, 0) + begin;
  for (int64_t p = 0; p < n; ++p) {
    if (id[p] < 0) continue;
    tile[place[p]].dilation += volume[p] * j[p];
    tile[place[p]].volume += volume[p];
  }
}

static void add_block(void *user, const mpmi_visit *visit, double *tile) {
  const locking_job *job = user;
  const mpmi_layout *layout = job->step->layout;
  const mpm_grid *grid = layout->blocks.grid;
  mpmi_axis axis[3];
  int32_t place[MPMI_CHUNK];
  mpmi_block_axes(grid, layout->blocks.coord[visit->block], axis);
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpm_particles *set = layout->member[m].set;
    if (mpmi_material_kinematics(set->material) == MPMI_F_STAYS) continue; /* rigid: nothing to average */
    const mpmi_points points = mpmi_points_of(set, 0);
    const int64_t end = layout->member[m].now.start[visit->block + 1];
    for (int64_t at = layout->member[m].now.start[visit->block]; at < end; at += MPMI_CHUNK) {
      const int64_t n = end - at < MPMI_CHUNK ? end - at : MPMI_CHUNK;
      mpmi_cell_places(grid, axis, &points, at, n, place);
      add_chunk(set, at, n, place, (cell_sums *)tile);
    }
  }
}

/* Joins the two halves of cells at a periodic seam, which have been added up on both sides of it. Ghosts of
 * walls hold no cell. */
static void join_images(void *data, int64_t k) {
  const locking_job *job = data;
  const mpmi_constraints *c = &job->step->layout->constraints;
  const mpmi_share share = mpmi_share_of(job->step->settings, c->tie_count, k);
  for (int64_t i = share.begin; i < share.end; ++i) {
    double *master = mpmi_nodal_at(job->cells, c->tie[i].master);
    const int64_t first = c->tie[i].first, end = first + c->tie[i].count;
    for (int64_t d = first; d < end; ++d)
      for (int32_t v = 0; v < 2; ++v) master[v] += mpmi_nodal_at(job->cells, c->follower[d].slot)[v];
    for (int64_t d = first; d < end; ++d)
      for (int32_t v = 0; v < 2; ++v) mpmi_nodal_at(job->cells, c->follower[d].slot)[v] = master[v];
  }
}

mpm_status mpmi_locking_stage(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from) {
  static const mpmi_pass dilation = {.take = measure};
  locking_job job = {step, &nodes->sums};
  const mpm_status status = mpmi_pass_run(step, nodes, from, &dilation, NULL);
  if (status) return status;
  return mpmi_accumulate(
      step, &(mpmi_accumulation){.to = &nodes->sums, .give = add_block, .fold = join_images, .user = &job});
}

void mpmi_locking_apply(const mpm_grid *grid, const double *cells, const mpmi_axis *axis, mpm_particles *set,
                        mpmi_law_batch *b, int64_t begin, int64_t n, double dt) {
  const int32_t dim = grid->dim;
  const mpmi_points points = mpmi_points_of(set, 0);
  const double *old = mpmi_f64(set, MPMI_DILATION_RATIO, 0) + begin;
  double *ratio = mpmi_f64(set, MPMI_DILATION_RATIO, 1) + begin;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0) + begin;
  const int32_t rigid = mpmi_material_kinematics(set->material) == MPMI_F_STAYS;
  int32_t place[MPMI_CHUNK];
  for (int64_t p = 0; p < n; ++p) {
    ratio[p] = old[p];
    if (p % MPMI_CHUNK == 0)
      mpmi_cell_places(grid, axis, &points, begin + p, n - p < MPMI_CHUNK ? n - p : MPMI_CHUNK, place);
    if (rigid || id[p] < 0) continue;
    const cell_sums *cell = (const cell_sums *)cells + place[p % MPMI_CHUNK];
    const double j = det_minus_1(dim, b->L + p, b->ld, dt);
    const double mean = cell->volume > 0.0 ? cell->dilation / cell->volume : j;
    /* an inverted increment ends the step elsewhere */
    const double growth = j > -1.0 && mean > -1.0 ? (mean - j) / (1.0 + j) : 0.0;
    const double f_minus_1 = mpmi_expm1(mpmi_log1p(growth) / dim);
    ratio[p] = old[p] * (1.0 + growth);
    for (int32_t r = 0; r < dim; ++r)
      for (int32_t c = 0; c < dim; ++c) {
        double *L = b->L + (3 * r + c) * b->ld + p;
        *L += f_minus_1 * (*L + (r == c ? 1.0 / dt : 0.0));
        b->F_inc[(3 * r + c) * b->ld + p] = (r == c ? 1.0 : 0.0) + dt * *L;
      }
  }
  mpmi_law_batch_scale_F(b, dim, ratio, n);
}
