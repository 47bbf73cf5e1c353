/* The other half of the locking remedy (locking.c), for laws whose shear makes pressure. With the dilation of
 * the cell in the place of a particle's own, the power of its stress is
 *
 *   sum r V sigma : (L + (theta' - theta) / d I),  theta' = sum V theta / sum V over the cell,
 *
 * r V being the volume that the law sees. The forces that do the same power are those of
 *
 *   sigma' = r dev sigma + pi I,  pi = sum r V tr sigma / d / sum V over the cell,
 *
 * where trace and deviator are those of the axes along which material stretches. Where pressure follows from
 * the dilation alone, particles have that of their cell as it is, and keep it. */
#include "layout/tile.h"
#include "simd/tensor.h"
#include "stages/stages.h"

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
  return (particle_rows){.dim = mpmi_strain_dim(set->grid),
                         .components = mpmi_stress_components(set->grid->dim),
                         .ld = set->ld,
                         .id = mpmi_i64(set, MPMI_ID, 0),
                         .stress = mpmi_f64(set, MPMI_STRESS, copy),
                         .ratio = mpmi_f64(set, MPMI_DILATION_RATIO, copy),
                         .volume = mpmi_f64(set, MPMI_VOLUME, 0)};
}

/* Returns the mean stress of a particle over these axes, by the volume that the law sees. */
static double mean_stress(const particle_rows *of, int64_t slot) {
  double trace = 0.0;
  for (int32_t k = 0; k < of->dim; ++k) trace += of->stress[k * of->ld + slot];
  return of->ratio[slot] * trace / of->dim;
}

static void add_chunk(const mpmi_cell_job *job, int32_t m, int64_t begin, int64_t n, const int32_t *place,
                      double *tile) {
  const particle_rows of = rows_of(job->step->layout->member[m].set, job->copy);
  for (int64_t p = 0; p < n; ++p) {
    if (of.id[begin + p] < 0) continue;
    cell_pressure *cell = (cell_pressure *)tile + place[p];
    cell->stress += of.volume[begin + p] * mean_stress(&of, begin + p);
    cell->volume += of.volume[begin + p];
  }
}

/* Writes the stress in the forces of a chunk; inert slots have no volume, and keep their stress. */
static void write_chunk(const mpmi_cell_job *job, int32_t m, int64_t begin, int64_t n, const int32_t *place,
                        double *tile) {
  const particle_rows of = rows_of(job->step->layout->member[m].set, job->copy);
  double *nodal_stress = job->step->work->rows.of[m].nodal_stress;
  for (int64_t p = 0; p < n; ++p) {
    const int64_t slot = begin + p;
    const cell_pressure *cell = (cell_pressure *)tile + place[p];
    const double own = mean_stress(&of, slot);
    const double shift = of.id[slot] < 0 || !(cell->volume > 0.0) ? 0.0 : cell->stress / cell->volume - own;
    for (int32_t c = 0; c < of.components; ++c)
      nodal_stress[c * of.ld + slot] =
          of.ratio[slot] * of.stress[c * of.ld + slot] + (c < of.dim ? shift : 0.0);
  }
}

static int32_t is_averaged(const mpmi_cell_job *job, const mpmi_visit *visit, int32_t m) {
  (void)visit;
  return job->step->work->rows.of[m].nodal_stress != NULL;
}

/* Particles that are not where they were may lie outside the tile: then the set takes no part, and the step
 * fails. */
static int32_t is_averaged_in_place(const mpmi_cell_job *job, const mpmi_visit *visit, int32_t m) {
  return is_averaged(job, visit, m) &&
         (!mpmi_were_shown(job->step, m) || mpmi_is_in_place(job->step, visit, m));
}

static void write_block(void *user, const mpmi_visit *visit) {
  static const mpmi_cell_work write = {is_averaged, write_chunk};
  const mpmi_cell_job *job = user;
  double *cells = job->step->work->scratch[visit->task].cells;
  mpmi_tile_load(job->step->settings->kernels, &job->step->layout->blocks, visit->block, job->cells,
                 MPMI_TAKE_HALF, cells);
  mpmi_cells_visit(job, visit, &write, cells);
}

int32_t mpmi_has_nodal_stress(const mpmi_settings *settings, const mpmi_layout *layout) {
  for (int32_t m = 0; m < layout->member_count; ++m)
    if (mpmi_averages_pressure(settings, layout->member[m].set)) return 1;
  return 0;
}

mpm_status mpmi_cell_pressure_stage(mpmi_step *step, mpmi_nodes *nodes, int32_t copy) {
  static const mpmi_cell_work add = {is_averaged_in_place, add_chunk};
  mpmi_cell_job job = {.step = step, .cells = &nodes->sums, .sum = &add, .copy = copy};
  mpm_status status = mpmi_cells_sum(&job);
  if (!status) status = mpmi_step_failure(step);
  return status ? status : mpmi_visit_blocks(step, 0, write_block, &job);
}
