#include "layout/accumulate.h"
#include "layout/reached.h"
#include "layout/tasks.h"
#include "layout/tile.h"

#include <string.h>

typedef struct sum_job {
  mpmi_step *step;
  const mpmi_accumulation *sum;
  int32_t colour; /* of what is shared with other parts */
} sum_job;

static double *tile_of(const sum_job *job, int64_t task) {
  const mpmi_scratch *scratch = &job->step->work->scratch[task];
  return job->sum->gathers ? scratch->sum_tile : scratch->tile;
}

static void clear_run(void *user, int64_t slot, int64_t count) {
  const mpmi_nodal *to = user;
  memset(mpmi_nodal_at(to, slot), 0, (size_t)(count * to->values) * sizeof(double));
}

static void clear_task(void *data, int64_t k) {
  const sum_job *job = data;
  const mpmi_accumulation *sum = job->sum;
  const mpmi_settings *settings = job->step->settings;
  const mpmi_blocks *b = &job->step->layout->blocks;
  const int64_t each = (int64_t)b->nodes * sum->to->values;
  /* tiles of other parts, which are never flat, are unpacked into the same memory */
  const int32_t values = sum->flat && !job->step->layout->parts ? MPMI_FLAT_VALUES : sum->to->values;
  if (!sum->gathers) mpmi_tile_use(settings->grid, tile_of(job, k), values);
  memset(tile_of(job, k), 0, (size_t)(values * mpmi_tile_nodes(settings->grid)) * sizeof(double));
  const mpmi_share share = mpmi_share_of(settings, b->count, k);
  if (!sum->flags && mpmi_zero_elsewhere(job->step->layout, sum->to)) {
    mpmi_reached_runs(b, share.begin, share.end, clear_run, sum->to);
    return;
  }
  if (!sum->flags) {
    mpmi_clear_share(settings, sum->to->at, b->count * b->nodes, sum->to->values, k);
    return;
  }
  for (int64_t block = share.begin; block < share.end; ++block)
    if (sum->flags[block] & sum->receiving)
      memset(sum->to->at + block * each, 0, (size_t)each * sizeof(double));
}

static void add_block(void *user, const mpmi_visit *visit) {
  const sum_job *job = user;
  const mpmi_accumulation *sum = job->sum;
  if (sum->flags && !(sum->flags[visit->block] & sum->giving)) return;
  double *tile = tile_of(job, visit->task);
  sum->give(sum->user, visit, tile);
  mpmi_tile_add(job->step->settings->kernels, &job->step->layout->blocks, visit->block, sum->to, sum->flat,
                tile);
}

static int32_t stays_zero_elsewhere(const mpmi_step *step, const mpmi_accumulation *sum) {
  return !sum->flags && !mpmi_gives_anywhere(step->settings);
}

/* ---- with other parts ---------------------------------------------------------------------------------- */
static void give_boundary(void *user, const mpmi_visit *visit) {
  const sum_job *job = user;
  const mpmi_accumulation *sum = job->sum;
  if (sum->flags && !(sum->flags[visit->block] & sum->giving)) return;
  double *tile = mpmi_tiles_of(job->step->layout->parts, visit->block, sum->to->values);
  sum->give(sum->user, visit, sum->flat ? tile_of(job, visit->task) : tile);
  if (sum->flat) mpmi_tile_raise(job->step->settings->grid, tile_of(job, visit->task), tile);
}

static int32_t has_colour(const mpmi_blocks *b, int64_t block, int32_t colour) {
  return mpmi_colour_of(b->grid->dim, b->coord[block]) == colour;
}

/* Adds the tiles of one colour that are shared: those of boundary blocks and of ghosts. */
static void add_shared_task(void *data, int64_t k) {
  const sum_job *job = data;
  const mpmi_layout *layout = job->step->layout;
  const mpmi_parts *parts = layout->parts;
  const mpmi_blocks *b = &layout->blocks;
  const mpmi_kernels *kernels = job->step->settings->kernels;
  const mpmi_share share = mpmi_share_of(job->step->settings, parts->boundary_count + parts->ghost_count, k);
  for (int64_t i = share.begin; i < share.end; ++i) {
    const mpmi_shared_block *ghost =
        i < parts->boundary_count ? NULL : &parts->ghost[i - parts->boundary_count];
    const int64_t block = ghost ? ghost->block : parts->boundary[i];
    double *tile = ghost ? tile_of(job, k) : mpmi_tiles_of(parts, block, job->sum->to->values);
    if (!has_colour(b, block, job->colour)) continue;
    if (ghost && !mpmi_tiles_unpack(parts, ghost, job->sum->to->values, tile, &b->cover[block])) continue;
    mpmi_tile_add(kernels, b, block, job->sum->to, 0, tile);
  }
}

static mpm_status add_colour(sum_job *job, int32_t colour) {
  const mpmi_parts *parts = job->step->layout->parts;
  const mpmi_settings *settings = job->step->settings;
  job->colour = colour;
  if (!(parts->boundary_count + parts->ghost_count)) return MPM_OK;
  return mpmi_run_tasks(settings, 0, settings->tasks, add_shared_task, job);
}

/* Returns the first failure among all blocks of this part, or what has come from a partner where there is
 * none. */
static mpm_status own_failure(mpmi_step *step, mpmi_parts *parts, mpm_status status) {
  const mpm_status own = mpmi_step_failure(step);
  if (own) parts->is_echo = 0;
  return own ? own : status;
}

/* Tiles of boundary blocks are made first and sent. While they are under way early blocks give, and then
 * those that are left, each colour with what is shared of it, so that every node has the sum of one part. All
 * blocks give, also where something has failed: one part would know of all particles that do. */
static mpm_status add_with_others(sum_job *job, mpm_status given) {
  const mpmi_accumulation *sum = job->sum;
  mpmi_parts *parts = job->step->layout->parts;
  const int32_t values = sum->to->values;
  if (!given) given = mpmi_visit_marked(job->step, parts->is_boundary, sum->calls_host, give_boundary, job);
  mpm_status status = given ? given : mpmi_step_failure(job->step);
  status = mpmi_tiles_send(parts, values, job->step->layout->blocks.cover, status);
  for (int32_t c = 0; c < MPMI_COLOURS && !given; ++c) {
    given = mpmi_visit_colour(job->step, parts->is_early, c, sum->calls_host, add_block, job);
    mpmi_poll(job->step->settings->context);
  }
  status = mpmi_tiles_receive(parts, values, status ? status : given);
  for (int32_t c = 0; c < MPMI_COLOURS; ++c) {
    if (!given) given = mpmi_visit_colour(job->step, parts->is_late, c, sum->calls_host, add_block, job);
    if (!status) status = given;
    if (!status) status = add_colour(job, c);
  }
  if (status) mpmi_tiles_clear(parts, values);
  if (status) status = own_failure(job->step, parts, status);
  for (int64_t i = 0; i < parts->partial_count && !status; ++i)
    memset(mpmi_nodal_at(sum->to, parts->partial[i]), 0, (size_t)values * sizeof(double));
  return status;
}

mpm_status mpmi_accumulate(mpmi_step *step, const mpmi_accumulation *sum) {
  const mpmi_settings *settings = step->settings;
  sum_job job = {step, sum, 0};
  mpm_status status = mpmi_run_tasks(settings, 0, settings->tasks, clear_task, &job);
  sum->to->zero_elsewhere = !status && stays_zero_elsewhere(step, sum) ? step->layout->covers : -1;
  if (step->layout->parts)
    status = add_with_others(&job, status);
  else if (!status)
    status = mpmi_visit_colours(step, sum->calls_host, add_block, &job);
  if (!status && sum->fold) status = mpmi_run_tasks(settings, 0, settings->tasks, sum->fold, sum->user);
  return status;
}
