/* Particles to nodes: block by block into a tile, tile by tile into the nodes. Blocks of one colour touch
 * disjoint nodes, and colours follow each other in a fixed order, so that every nodal sum has one order. */
#include "stepper/stepper.h"

#include <string.h>

typedef struct p2g_job {
  mpm_stepper *s;
  int32_t projection, affine, values, form, need, colour;
  double *nodes;
} p2g_job;

/* Blocks of one colour are two apart: their tiles must not meet. */
#define TILE_FITS(dim, width) (2 * MPMI_BLOCK_EDGE(dim) >= MPMI_TILE_EDGE(dim, width))
_Static_assert(TILE_FITS(1, 4) && TILE_FITS(2, 4) && TILE_FITS(3, 4), "tiles of one colour overlap");

static void zero_task(void *data, int64_t k) {
  const p2g_job *job = data;
  const int64_t slots = job->s->blocks.count * job->s->blocks.nodes * job->values, tasks = job->s->tasks;
  const int64_t begin = slots * k / tasks, end = slots * (k + 1) / tasks;
  if (end > begin) memset(job->nodes + begin, 0, (size_t)(end - begin) * sizeof *job->nodes);
}

static void scatter_of(const p2g_job *job, const mpmi_member *member, mpmi_scatter *scatter) {
  const mpm_stepper *s = job->s;
  const mpm_particles *set = member->set;
  const int32_t dim = s->grid->dim, forces = mpmi_projects_forces(job->projection);
  const int32_t copy = job->projection >= MPMI_PROJECT_AGAIN;
  const int32_t field = job->projection == MPMI_PROJECT_ACCELERATION ? MPMI_ACCELERATION : MPMI_VELOCITY;
  const int32_t stress =
      job->projection == MPMI_PROJECT_FORCES && s->desc.scheme == MPM_USF; /* USF has updated it already */
  memset(scatter, 0, sizeof *scatter);
  scatter->weights = s->kernels->weights[s->grid->family][dim];
  scatter->points = mpmi_points_of(set, 0);
  scatter->need = job->need;
  scatter->mass = mpmi_f64(set, MPMI_MASS, 0);
  scatter->volume = mpmi_f64(set, MPMI_VOLUME, 0);
  for (int32_t c = 0; c < mpmi_stress_components(dim); ++c)
    scatter->stress[c] = mpmi_f64(set, MPMI_STRESS, stress) + c * set->ld;
  for (int32_t k = 0; k < dim; ++k) {
    scatter->v[k] = mpmi_f64(set, field, copy) + k * set->ld;
    scatter->force[k] = member->force && forces ? member->force + k * set->ld : NULL;
    scatter->gravity[k] = forces ? s->desc.gravity[k] : 0.0;
  }
  if (job->affine)
    for (int32_t c = 0; c < mpmi_gradient_components(dim); ++c)
      scatter->affine[mpmi_gradient_map(dim)[c]] = mpmi_f64(set, MPMI_L, copy) + c * set->ld;
  mpmi_streams *streams = &scatter->streams;
  for (int32_t k = 0; k < dim; ++k) {
    streams->at[streams->count++] = scatter->points.x[k];
    streams->at[streams->count++] = scatter->v[k];
    if (scatter->force[k]) streams->at[streams->count++] = scatter->force[k];
  }
  streams->at[streams->count++] = scatter->mass;
  if (forces) {
    streams->at[streams->count++] = scatter->volume;
    for (int32_t c = 0; c < mpmi_stress_components(dim); ++c)
      streams->at[streams->count++] = scatter->stress[c];
  }
  if (job->affine)
    for (int32_t c = 0; c < mpmi_gradient_components(dim); ++c)
      streams->at[streams->count++] = scatter->affine[mpmi_gradient_map(dim)[c]];
  scatter->fused_dt = forces && job->values == 4 ? s->velocity_dt : 0.0;
}

/* In as many pieces as the block has neighbours: in front of each, the nodes that the tile shares with one of
 * them are asked for, so that they are near when the tile is added to them. */
static void scatter_block(const p2g_job *job, const mpmi_scatter *scatter, int32_t block, int64_t begin,
                          int64_t end) {
  const mpm_stepper *s = job->s;
  const int32_t pieces = s->blocks.neighbours;
  const mpmi_scatter_fn kernel = s->kernels->scatter[s->grid->dim][s->grid->width][job->form];
  const int64_t chunks = (end - begin + MPMI_CHUNK - 1) / MPMI_CHUNK;
  for (int32_t k = 0; k < pieces; ++k) {
    const int64_t from = begin + chunks * k / pieces * MPMI_CHUNK;
    const int64_t to = begin + chunks * (k + 1) / pieces * MPMI_CHUNK;
    mpmi_tile_fetch(s, block, job->nodes, job->values, k, k + 1);
    if (to > from) kernel(scatter, from, to < end ? to : end);
  }
}

static void p2g_task(void *data, int64_t k) {
  const p2g_job *job = data;
  mpm_stepper *s = job->s;
  const mpm_grid *grid = s->grid;
  const mpmi_cut *cut = &s->colour[job->colour];
  double *tile = s->scratch[k].tile;
  const size_t tile_doubles = (size_t)job->values * (size_t)mpmi_tile_nodes(grid);
  mpmi_scatter scatter;
  memset(tile, 0, tile_doubles * sizeof *tile);
  for (int64_t i = cut->bound[k]; i < cut->bound[k + 1]; ++i) {
    const int32_t block = cut->list[i];
    for (int32_t m = 0; m < s->member_count; ++m) {
      const int64_t *start = s->member[m].now.start;
      if (start[block] == start[block + 1]) continue;
      scatter_of(job, &s->member[m], &scatter);
      mpmi_block_axes(grid, s->blocks.coord[block], scatter.axis);
      scatter.tile = tile;
      scatter_block(job, &scatter, block, start[block], start[block + 1]);
      mpmi_sample_weights(s, &s->scratch[k], scatter.axis, job->need, &scatter.points, start[block],
                          start[block + 1]);
    }
    mpmi_tile_add(s, block, job->nodes, job->values, tile);
  }
}

mpm_status mpmi_stage_p2g(mpm_stepper *s, int32_t projection) {
  const int32_t forces = mpmi_projects_forces(projection);
  const int32_t affine = mpmi_is_affine(s) && projection != MPMI_PROJECT_CORRECT;
  p2g_job job = {.s = s, .projection = projection, .affine = affine};
  job.values = forces ? s->values : 4;
  job.nodes = forces ? s->node : s->again;
  if (job.values == 8) {
    job.form = affine ? MPMI_SCATTER_8_AFFINE : MPMI_SCATTER_8;
    job.need = mpmi_is_mls(s) ? MPMI_NEED_MLS : MPMI_NEED_GRADIENT | (affine ? MPMI_NEED_MOMENT : 0);
  } else if (affine && s->grid->family >= MPMI_FAMILY_OPEN_BSPLINE2) {
    job.form = MPMI_SCATTER_4_UNEVEN;
    job.need = MPMI_NEED_MOMENT;
  } else {
    job.form = affine ? MPMI_SCATTER_4_AFFINE : MPMI_SCATTER_4;
  }
  mpm_status status = mpmi_run_tasks(s, 0, s->tasks, zero_task, &job);
  for (int32_t c = 0; c < MPMI_COLOURS && !status; ++c) {
    job.colour = c;
    if (s->colour[c].count) status = mpmi_run_tasks(s, 0, s->tasks, p2g_task, &job);
  }
  return status;
}
