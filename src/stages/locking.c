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
#include "stages/batch.h"
#include "transfer/basis.h"

#include <math.h>

/* Sums over the particles in a cell, in the place of the four values of a node: volume times j, and volume.
 * Those whose pressure is averaged as well are among `all`, and take the mean of their own kind: dilation and
 * pressure then belong together, whatever else is in the cell. */
typedef struct cell_mean {
  double dilation, volume;
} cell_mean;
typedef struct cell_sums {
  cell_mean all, paired;
} cell_sums;
_Static_assert(sizeof(cell_sums) == 4 * sizeof(double), "goes through tiles");

/* Finds the place of each particle's cell in the tile, of whole chunks. On a periodic axis any image that
 * lies in the tile will do. */
void mpmi_cell_places(const mpm_grid *grid, const mpmi_axis *axis, const mpmi_points *points, int64_t begin,
                      int64_t n, int32_t *place) {
  const double edge = MPMI_TILE_EDGE(grid->dim, grid->width);
  for (int64_t p = 0; p < n; p += MPMI_LANES) {
    mpmi_lanes at = {0.0};
    for (int32_t k = 0; k < grid->dim; ++k) {
      const mpmi_axis *a = axis + k;
      const mpmi_lanes xi = (mpmi_lanes_load(points->x[k] + begin + p) - a->origin) * a->inverse_spacing;
      mpmi_lanes along = mpmi_lanes_cell(a, xi) - a->tile_base;
      if (a->period > 0.0) along -= a->period * mpmi_lanes_round((along - a->middle) * a->inverse_period);
      at = at * edge + along;
    }
    mpmi_lanes_store_int32(place + p, at);
  }
}

/* Measures det F_inc - 1 of each particle of a batch, into the second copy of its dilation ratio. Where it is
 * not finite the step will fail at this particle, and not at its neighbours. */
static void measure(mpmi_batch *b) {
  b->step->settings->dilation->measure[b->set->grid->dim](
      b->law.L, b->law.ld, b->step->dt, b->n, mpmi_f64(b->set, MPMI_DILATION_RATIO, 1) + b->begin);
}

/* Adds volume times j, and volume, of a chunk to the cells of its particles. */
static void add_chunk(const mpm_particles *set, int32_t paired, int64_t begin, int64_t n,
                      const int32_t *place, cell_sums *tile) {
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0) + begin;
  const double *j = mpmi_f64(set, MPMI_DILATION_RATIO, 1) + begin;
  const double *volume = mpmi_f64(set, MPMI_VOLUME, 0) + begin;
  for (int64_t p = 0; p < n; ++p) {
    if (id[p] < 0) continue;
    cell_sums *cell = &tile[place[p]];
    cell->all.dilation += volume[p] * j[p];
    cell->all.volume += volume[p];
    if (!paired) continue;
    cell->paired.dilation += volume[p] * j[p];
    cell->paired.volume += volume[p];
  }
}

static void add_block(void *user, const mpmi_visit *visit, double *tile) {
  const mpmi_cell_job *job = user;
  const mpmi_layout *layout = job->step->layout;
  const mpm_grid *grid = layout->blocks.grid;
  mpmi_axis axis[3];
  int32_t place[MPMI_CHUNK];
  mpmi_block_axes(grid, layout->blocks.coord[visit->block], axis);
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpm_particles *set = layout->member[m].set;
    if (mpmi_material_kinematics(set->material) == MPMI_F_STAYS) continue; /* rigid: nothing to average */
    const mpmi_points points = mpmi_points_of(set, 0);
    const int32_t paired = mpmi_averages_pressure(job->step->settings, set);
    const int64_t end = layout->member[m].now.start[visit->block + 1];
    for (int64_t at = layout->member[m].now.start[visit->block]; at < end; at += MPMI_CHUNK) {
      const int64_t n = end - at < MPMI_CHUNK ? end - at : MPMI_CHUNK;
      mpmi_cell_places(grid, axis, &points, at, n, place);
      add_chunk(set, paired, at, n, place, (cell_sums *)tile);
    }
  }
}

void mpmi_cells_join(void *data, int64_t k) {
  const mpmi_cell_job *job = data;
  const mpmi_constraints *c = &job->step->layout->constraints;
  const mpmi_share share = mpmi_share_of(job->step->settings, c->tie_count, k);
  for (int64_t i = share.begin; i < share.end; ++i) {
    double *master = mpmi_nodal_at(job->cells, c->tie[i].master);
    const int64_t first = c->tie[i].first, end = first + c->tie[i].count;
    for (int64_t d = first; d < end; ++d)
      for (int32_t v = 0; v < 4; ++v) master[v] += mpmi_nodal_at(job->cells, c->follower[d].slot)[v];
    for (int64_t d = first; d < end; ++d)
      for (int32_t v = 0; v < 4; ++v) mpmi_nodal_at(job->cells, c->follower[d].slot)[v] = master[v];
  }
}

mpm_status mpmi_locking_stage(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from) {
  static const mpmi_pass dilation = {.take = measure};
  mpmi_cell_job job = {step, &nodes->sums, 0};
  const mpm_status status = mpmi_pass_run(step, nodes, from, &dilation, NULL);
  if (status) return status;
  return mpmi_accumulate(
      step,
      &(mpmi_accumulation){.to = &nodes->sums, .give = add_block, .fold = mpmi_cells_join, .user = &job});
}

/* Finds the mean of the cell of each particle of a chunk; none for rigid ones and for holes. */
static void find_means(const cell_sums *cells, const int32_t *place, const mpm_particles *set, int32_t paired,
                       int64_t begin, int64_t n, double *mean) {
  const int32_t rigid = mpmi_material_kinematics(set->material) == MPMI_F_STAYS;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0) + begin;
  for (int64_t p = 0; p < n; ++p) {
    const cell_mean *cell = paired ? &cells[place[p]].paired : &cells[place[p]].all;
    mean[p] = rigid || id[p] < 0 || !(cell->volume > 0.0) ? (double)NAN : cell->dilation / cell->volume;
  }
}

void mpmi_locking_apply(const mpmi_settings *settings, const double *cells, const mpmi_axis *axis,
                        mpm_particles *set, mpmi_law_batch *b, int64_t begin, int64_t n, double dt) {
  const int32_t dim = settings->grid->dim;
  const mpmi_points points = mpmi_points_of(set, 0);
  const int32_t paired = mpmi_averages_pressure(settings, set);
  double *ratio = mpmi_f64(set, MPMI_DILATION_RATIO, 1) + begin;
  for (int64_t p = 0; p < n; p += MPMI_CHUNK) {
    double mean[MPMI_CHUNK];
    int32_t place[MPMI_CHUNK];
    mpmi_cell_places(settings->grid, axis, &points, begin + p, MPMI_CHUNK, place);
    find_means((const cell_sums *)cells, place, set, paired, begin + p, MPMI_CHUNK, mean);
    settings->dilation->exchange[dim](
        &(mpmi_exchange){.dt = dt,
                         .ld = b->ld,
                         .L = b->L + p,
                         .F_inc = b->F_inc + p,
                         .mean = mean,
                         .old_ratio = mpmi_f64(set, MPMI_DILATION_RATIO, 0) + begin + p,
                         .ratio = ratio + p},
        MPMI_CHUNK);
  }
  settings->dilation->scale[dim](b->F, b->ld, ratio, n);
}
