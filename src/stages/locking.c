/* Remedy against volumetric locking (MPoint theory eqs 47-53, carried to the deformation gradient). The law
 * sees
 *
 *   F_inc' = f F_inc,  f^d = (1 + j') / (1 + j),  j = det F_inc - 1,  j' = sum V j / sum V over the cell
 *
 * and F' = r^(1/d) F, where the ratio r grows by f^d in each step; d is the number of axes along which
 * material stretches: in plane strain those of the plane alone are scaled. F, volume and positions are those
 * without the remedy. */
#include "stages/batch.h"
#include "stages/stages.h"

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

/* Measures det F_inc - 1 of each particle of a batch, into the second copy of its dilation ratio. Where it is
 * not finite the step will fail at this particle, and not at its neighbours. */
static void measure(mpmi_batch *b) {
  if (mpmi_is_total_lagrangian(b->set->grid)) mpmi_gradient_present(b);
  b->step->settings->dilation->measure[mpmi_strain_dim(b->set->grid)](
      b->law.L, b->law.ld, b->step->dt, b->n, mpmi_f64(b->set, MPMI_DILATION_RATIO, 1) + b->begin);
}

/* Of rigid particles there is nothing to average. */
static int32_t deforms(const mpmi_cell_job *job, const mpmi_visit *visit, int32_t m) {
  (void)visit;
  return mpmi_material_kinematics(job->step->layout->member[m].set->material) != MPMI_F_STAYS;
}

/* Adds volume times j, and volume, of a chunk to the cells of its particles. */
static void add_chunk(const mpmi_cell_job *job, int32_t m, int64_t begin, int64_t n, const int32_t *place,
                      double *tile) {
  const mpm_particles *set = job->step->layout->member[m].set;
  const int32_t paired = mpmi_averages_pressure(job->step->settings, set);
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0) + begin;
  const double *j = mpmi_f64(set, MPMI_DILATION_RATIO, 1) + begin;
  const double *volume = mpmi_f64(set, MPMI_VOLUME, 0) + begin;
  for (int64_t p = 0; p < n; ++p) {
    if (id[p] < 0) continue;
    cell_sums *cell = (cell_sums *)tile + place[p];
    cell->all.dilation += volume[p] * j[p];
    cell->all.volume += volume[p];
    if (!paired) continue;
    cell->paired.dilation += volume[p] * j[p];
    cell->paired.volume += volume[p];
  }
}

mpm_status mpmi_locking_stage(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from) {
  static const mpmi_pass dilation = {.take = measure};
  static const mpmi_cell_work add = {deforms, add_chunk};
  const mpm_status status = mpmi_pass_run(step, nodes, from, &dilation, NULL);
  return status ? status : mpmi_cells_sum(&(mpmi_cell_job){.step = step, .cells = &nodes->sums, .sum = &add});
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
  const int32_t dim = mpmi_strain_dim(settings->grid);
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
