/* P2G: particles to nodes, by the kernels of transfer/scatter.c. */
#include "stages/stages.h"
#include "layout/accumulate.h"
#include "layout/tile.h"

#include <string.h>

typedef struct p2g_job {
  mpmi_step *step;
  const mpmi_projection *projection;
  mpmi_nodal *to;
  int32_t affine, form, need;
  int32_t stress_copy;
} p2g_job;

static void add_streams(mpmi_streams *streams, const double *const *rows, int32_t count) {
  for (int32_t k = 0; k < count; ++k)
    if (rows[k]) streams->at[streams->count++] = rows[k];
}

/* Lists what the next chunk will read, for prefetching. */
static void list_streams(const p2g_job *job, mpmi_scatter *scatter, int32_t dim) {
  mpmi_streams *streams = &scatter->streams;
  for (int32_t k = 0; k < dim; ++k) {
    add_streams(streams, &scatter->points.x[k], 1);
    add_streams(streams, &scatter->v[k], 1);
    add_streams(streams, &scatter->force[k], 1);
    for (int32_t r = 0; r <= k && job->projection->forces; ++r)
      add_streams(streams, &scatter->stress[mpmi_sym_index(k, r)], 1);
  }
  add_streams(streams, &scatter->mass, 1);
  if (job->projection->forces) add_streams(streams, &scatter->volume, 1);
  add_streams(streams, scatter->affine, 9);
  add_streams(streams, scatter->F, 9);
}

static void scatter_of(const p2g_job *job, int32_t m, mpmi_scatter *scatter) {
  const mpmi_settings *settings = job->step->settings;
  const mpmi_projection *projection = job->projection;
  const mpm_particles *set = job->step->layout->member[m].set;
  const mpmi_member_rows *rows = &job->step->work->rows.of[m];
  const int32_t dim = settings->grid->dim, forces = projection->forces;
  memset(scatter, 0, sizeof *scatter);
  scatter->weights = settings->kernels->weights[settings->grid->family][dim];
  scatter->points = mpmi_points_of(set, 0);
  scatter->need = job->need;
  scatter->mass = mpmi_f64(set, MPMI_MASS, 0);
  scatter->volume = mpmi_f64(set, MPMI_VOLUME, 0);
  for (int32_t c = 0; c < mpmi_stress_components(dim); ++c)
    scatter->stress[c] =
        (rows->nodal_stress ? rows->nodal_stress : mpmi_f64(set, MPMI_STRESS, job->stress_copy)) +
        c * set->ld;
  for (int32_t k = 0; k < dim; ++k) {
    scatter->v[k] = mpmi_f64(set, projection->field, projection->copy) + k * set->ld;
    scatter->force[k] = rows->force && forces ? rows->force + k * set->ld : NULL;
    scatter->gravity[k] = forces ? settings->desc.gravity[k] : 0.0;
  }
  for (int32_t c = 0; job->affine && c < mpmi_gradient_components(dim); ++c)
    scatter->affine[mpmi_gradient_map(dim)[c]] =
        mpmi_f64(set, projection->matrix, projection->copy) + c * set->ld;
  if (forces && mpmi_is_total_lagrangian(settings->grid))
    mpmi_point_at(set, MPMI_F, job->stress_copy, 0, scatter->F);
  scatter->hoop = mpmi_is_axisymmetric(settings->grid);
  scatter->fused_dt = forces && !mpmi_has_increments(job->to) ? job->step->velocity_dt : 0.0;
  list_streams(job, scatter, dim);
}

/* Scatters in as many pieces as the block has neighbours; in front of each, the nodes that the tile shares
 * with one of them are fetched, so that they are near when the tile is added to them. */
static void scatter_slots(const p2g_job *job, const mpmi_scatter *scatter, int64_t block, int64_t begin,
                          int64_t end) {
  const mpmi_settings *settings = job->step->settings;
  const mpmi_blocks *blocks = &job->step->layout->blocks;
  const int32_t pieces = blocks->neighbours;
  const mpmi_scatter_fn kernel =
      settings->kernels->scatter[settings->grid->dim][settings->grid->width][job->form];
  const int64_t chunks = (end - begin + MPMI_CHUNK - 1) / MPMI_CHUNK;
  const mpmi_spans spans = mpmi_spans_of(blocks, block);
  for (int32_t k = 0; k < pieces; ++k) {
    const int64_t from = begin + chunks * k / pieces * MPMI_CHUNK;
    const int64_t to = begin + chunks * (k + 1) / pieces * MPMI_CHUNK;
    mpmi_tile_fetch(settings->kernels, blocks, block, &spans, job->to, k, k + 1);
    if (to > from) kernel(scatter, from, to < end ? to : end);
  }
}

static void scatter_block(void *user, const mpmi_visit *visit, double *tile) {
  const p2g_job *job = user;
  const mpmi_layout *layout = job->step->layout;
  mpmi_scatter scatter;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const int64_t begin = layout->member[m].now.start[visit->block];
    const int64_t end = layout->member[m].now.start[visit->block + 1];
    if (begin == end) continue;
    if (mpmi_were_shown(job->step, m) && !mpmi_is_in_place(job->step, visit, m)) continue;
    scatter_of(job, m, &scatter);
    mpmi_block_axes(layout->blocks.grid, layout->blocks.coord[visit->block], scatter.axis);
    scatter.tile = tile;
    scatter.streams.end = end;
    scatter.streams.follow = visit->next < 0 ? end : layout->member[m].now.start[visit->next];
    scatter_slots(job, &scatter, visit->block, begin, end);
    mpmi_sample_weights(job->step, visit->task, scatter.axis, job->need, &scatter.points, begin, end);
  }
}

/* Momentum of affine transfers wants weights of its own where nodes are not a spacing apart. */
static void choose_form(p2g_job *job) {
  const mpmi_settings *settings = job->step->settings;
  const int32_t halves = settings->context->works_by_halves, affine = job->affine;
  const int32_t uneven = affine && settings->grid->family >= MPMI_FAMILY_OPEN_BSPLINE2;
  const int32_t moment = uneven ? MPMI_NEED_MOMENT : 0;
  if (!mpmi_has_increments(job->to)) {
    job->form = uneven ? MPMI_SCATTER_4_UNEVEN : affine ? MPMI_SCATTER_4_AFFINE : MPMI_SCATTER_4;
    job->need = moment;
    return;
  }
  job->need = MPMI_NEED_GRADIENT | (affine ? moment : MPMI_NO_FIRST);
  if (settings->transfer->moments == MPMI_NEED_MLS) job->need = MPMI_NEED_MLS;
  if (settings->grid->dim < 3)
    job->form = uneven ? MPMI_SCATTER_FLAT_UNEVEN : affine ? MPMI_SCATTER_FLAT_AFFINE : MPMI_SCATTER_FLAT;
  else if (affine)
    job->form = uneven   ? MPMI_SCATTER_8_UNEVEN
                : halves ? MPMI_SCATTER_8_AFFINE_HALVES
                         : MPMI_SCATTER_8_AFFINE;
  else
    job->form = halves ? MPMI_SCATTER_8_HALVES : MPMI_SCATTER_8;
}

mpm_status mpmi_p2g_stage(mpmi_step *step, const mpmi_projection *projection, mpmi_nodes *nodes) {
  p2g_job job = {.step = step,
                 .projection = projection,
                 .to = mpmi_projected_nodes(nodes, projection),
                 .affine =
                     (mpmi_is_affine(step->settings) || projection->matrix != MPMI_L) && !projection->plain,
                 /* the main projection comes after USF's strain: the stress is new then */
                 .stress_copy = projection->main && mpmi_deforms_first(step->settings)};
  choose_form(&job);
  mpm_status status = projection->forces && mpmi_has_nodal_stress(step->settings, step->layout)
                          ? mpmi_cell_pressure_stage(step, nodes, job.stress_copy)
                          : MPM_OK;
  if (status) return status;
  status = mpmi_accumulate(
      step, &(mpmi_accumulation){
                .to = job.to, .give = scatter_block, .user = &job, .flat = job.form >= MPMI_SCATTER_FLAT});
  if (!status) status = mpmi_step_failure(step);
  if (!status && projection->forces) status = mpmi_surfaces_give(step, nodes);
  if (!status && !projection->forces && mpmi_asks_host(step->settings, projection) &&
      !mpmi_is_implicit(step->settings) && mpmi_surfaces_prescribe(&step->settings->surfaces))
    status = mpmi_surfaces_find(step, job.to); /* USF: the boundary stage needs the nodes around markers */
  return status;
}
