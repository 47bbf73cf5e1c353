/* The other half of the locking remedy (locking.c), for laws whose shear makes pressure. With the dilation of
 * the cell in the place of a particle's own, the power of its stress is
 *
 *   sum r V sigma : (L + (theta' - theta) / d I),  theta' = sum V theta / sum V over the cell,
 *
 * r V being the volume that the law sees. The forces that do the same power are those of
 *
 *   sigma' = r dev sigma + pi I,  pi = sum r V tr sigma / d / sum V over the cell,
 *
 * where trace and deviator are those of the axes that the grid has. Where pressure follows from the dilation
 * alone, particles have that of their cell as it is, and keep it. */
#include "layout/accumulate.h"
#include "layout/tasks.h"
#include "layout/tile.h"
#include "simd/tensor.h"
#include "stages/batch.h"
#include "stages/stages.h"
#include "transfer/basis.h"

/* Sums over the particles in a cell, in the place of the four values of a node. */
typedef struct cell_pressure {
  double stress, volume; /* volume that the law sees times mean stress; volume */
  double unused[2];
} cell_pressure;
_Static_assert(sizeof(cell_pressure) == 4 * sizeof(double), "goes through tiles");

/* What the particles of a set have, at slot 0. */
typedef struct particle_rows {
  int32_t dim, components;
  int64_t ld;
  const int64_t *id;
  const double *stress, *ratio, *volume;
} particle_rows;

static particle_rows rows_of(const mpm_particles *set, int32_t copy) {
  return (particle_rows){.dim = set->grid->dim,
                         .components = mpmi_stress_components(set->grid->dim),
                         .ld = set->ld,
                         .id = mpmi_i64(set, MPMI_ID, 0),
                         .stress = mpmi_f64(set, MPMI_STRESS, copy),
                         .ratio = mpmi_f64(set, MPMI_DILATION_RATIO, copy),
                         .volume = mpmi_f64(set, MPMI_VOLUME, 0)};
}

/* Returns the mean stress of a particle over the axes of the grid, by the volume that the law sees. */
static double mean_stress(const particle_rows *of, int64_t slot) {
  double trace = 0.0;
  for (int32_t k = 0; k < of->dim; ++k) trace += of->stress[k * of->ld + slot];
  return of->ratio[slot] * trace / of->dim;
}

static void add_chunk(const particle_rows *of, int64_t begin, int64_t n, const int32_t *place,
                      cell_pressure *tile) {
  for (int64_t p = 0; p < n; ++p) {
    if (of->id[begin + p] < 0) continue;
    tile[place[p]].stress += of->volume[begin + p] * mean_stress(of, begin + p);
    tile[place[p]].volume += of->volume[begin + p];
  }
}

/* Writes the stress in the forces of a chunk; inert slots have no volume, and keep their stress. */
static void write_chunk(const particle_rows *of, int64_t begin, int64_t n, const int32_t *place,
                        const cell_pressure *tile, double *out) {
  for (int64_t p = 0; p < n; ++p) {
    const int64_t slot = begin + p;
    const cell_pressure *cell = &tile[place[p]];
    const double own = mean_stress(of, slot);
    const double shift = of->id[slot] < 0 || !(cell->volume > 0.0) ? 0.0 : cell->stress / cell->volume - own;
    for (int32_t c = 0; c < of->components; ++c)
      out[c * of->ld + slot] = of->ratio[slot] * of->stress[c * of->ld + slot] + (c < of->dim ? shift : 0.0);
  }
}

/* Goes through the particles of a block whose pressure is averaged, chunk by chunk: adds them to the tile, or
 * reads it for them. */
static void go_through(const mpmi_cell_job *job, const mpmi_visit *visit, int32_t adds, cell_pressure *tile) {
  const int64_t block = visit->block;
  const mpmi_layout *layout = job->step->layout;
  const mpm_grid *grid = layout->blocks.grid;
  mpmi_axis axis[3];
  int32_t place[MPMI_CHUNK];
  mpmi_block_axes(grid, layout->blocks.coord[block], axis);
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpmi_member *member = &layout->member[m];
    if (!member->nodal_stress) continue;
    if (adds && mpmi_were_shown(job->step, m) && !mpmi_is_in_place(job->step, visit, m)) continue;
    const mpmi_points points = mpmi_points_of(member->set, 0);
    const particle_rows of = rows_of(member->set, job->copy);
    const int64_t end = member->now.start[block + 1];
    for (int64_t at = member->now.start[block]; at < end; at += MPMI_CHUNK) {
      const int64_t n = end - at < MPMI_CHUNK ? end - at : MPMI_CHUNK;
      mpmi_cell_places(grid, axis, &points, at, n, place);
      if (adds)
        add_chunk(&of, at, n, place, tile);
      else
        write_chunk(&of, at, n, place, tile, member->nodal_stress);
    }
  }
}

static void add_block(void *user, const mpmi_visit *visit, double *tile) {
  go_through(user, visit, 1, (cell_pressure *)tile);
}

static void write_block(void *user, const mpmi_visit *visit) {
  const mpmi_cell_job *job = user;
  double *cells = job->step->work->scratch[visit->task].cells;
  mpmi_tile_load(job->step->settings->kernels, &job->step->layout->blocks, visit->block, job->cells, 4,
                 cells);
  go_through(job, visit, 0, (cell_pressure *)cells);
}

int32_t mpmi_has_nodal_stress(const mpmi_layout *layout) {
  for (int32_t m = 0; m < layout->member_count; ++m)
    if (layout->member[m].nodal_stress) return 1;
  return 0;
}

mpm_status mpmi_cell_pressure_stage(mpmi_step *step, mpmi_nodes *nodes, int32_t copy) {
  mpmi_cell_job job = {step, &nodes->sums, copy};
  mpm_status status = mpmi_accumulate(
      step,
      &(mpmi_accumulation){.to = &nodes->sums, .give = add_block, .fold = mpmi_cells_join, .user = &job});
  if (!status) status = mpmi_step_failure(step);
  return status ? status : mpmi_visit_blocks(step, 0, write_block, &job);
}
