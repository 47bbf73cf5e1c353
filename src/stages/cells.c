/* Sums over the particles in a cell. A cell is known by the node of its lower corner, so that they go the way
 * of nodal sums (layout/accumulate.h): each cell has four values in the place of those of a node. */
#include "layout/accumulate.h"
#include "layout/tasks.h"
#include "layout/tile.h"
#include "stages/stages.h"
#include "transfer/basis.h"

/* On a periodic axis any image that lies in the tile will do. */
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

void mpmi_cells_visit(const mpmi_cell_job *job, const mpmi_visit *visit, const mpmi_cell_work *work,
                      double *tile) {
  const mpmi_layout *layout = job->step->layout;
  const mpm_grid *grid = layout->blocks.grid;
  mpmi_axis axis[3];
  int32_t place[MPMI_CHUNK];
  mpmi_block_axes(grid, layout->blocks.coord[visit->block], axis);
  for (int32_t m = 0; m < layout->member_count; ++m) {
    if (!work->takes(job, visit, m)) continue;
    const mpmi_points points = mpmi_points_of(layout->member[m].set, 0);
    const int64_t *start = layout->member[m].now.start, end = start[visit->block + 1];
    for (int64_t at = start[visit->block]; at < end; at += MPMI_CHUNK) {
      const int64_t n = end - at < MPMI_CHUNK ? end - at : MPMI_CHUNK;
      mpmi_cell_places(grid, axis, &points, at, n, place);
      work->chunk(job, m, at, n, place, tile);
    }
  }
}

/* Joins the two halves of cells at a periodic seam, which have been added up on both sides of it. Ghosts of
 * walls hold no cell. */
static void join_images(void *data, int64_t k) {
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

static void give(void *user, const mpmi_visit *visit, double *tile) {
  const mpmi_cell_job *job = user;
  mpmi_cells_visit(job, visit, job->sum, tile);
}

mpm_status mpmi_cells_sum(mpmi_cell_job *job) {
  return mpmi_accumulate(
      job->step, &(mpmi_accumulation){.to = job->cells, .give = give, .fold = join_images, .user = job});
}
