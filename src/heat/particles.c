/* Particles and nodes: sums go the way of nodal sums, block by block through tiles, by the kernels of
 * transfer/scalars.c. */
#include "heat/heat.h"
#include "layout/accumulate.h"
#include "layout/reached.h"
#include "layout/tasks.h"
#include "layout/tile.h"
#include "stages/batch.h"
#include "stages/stages.h"

#include <math.h>
#include <string.h>

/* ---- batches ------------------------------------------------------------------------------------------- */
enum { NODE = 4, BATCH = 4 * MPMI_CHUNK };

/* Some of the particles that a set has in a block, as kernels see them. give: the tile that is added to. */
typedef struct heat_batch {
  const mpmi_heat_job *job;
  const mpmi_visit *visit;
  const mpm_particles *set;
  const mpmi_heat_rule *rule;
  const int64_t *id;
  const double *mass, *volume, *temperature;
  int32_t m;
  int64_t begin, n;
  mpmi_scalars at;
  double *give;
} heat_batch;
typedef void (*heat_fn)(heat_batch *b);

static void visit_set(const mpmi_heat_job *job, const mpmi_visit *visit, int32_t m, heat_fn fn,
                      double *give) {
  const mpmi_settings *settings = job->step->settings;
  const mpmi_layout *layout = job->step->layout;
  const mpm_grid *grid = settings->grid;
  const mpm_particles *set = layout->member[m].set;
  const int64_t *start = layout->member[m].now.start, end = start[visit->block + 1];
  heat_batch b = {.job = job, .visit = visit, .set = set, .m = m, .give = give};
  b.rule = &settings->heat.set[m];
  b.at = (mpmi_scalars){.weights = settings->kernels->weights[grid->family][grid->dim],
                        .points = mpmi_points_of(set, 0)};
  mpmi_block_axes(grid, layout->blocks.coord[visit->block], b.at.axis);
  for (b.begin = start[visit->block]; b.begin < end; b.begin += BATCH) {
    b.n = end - b.begin < BATCH ? end - b.begin : BATCH;
    b.id = mpmi_i64(set, MPMI_ID, 0) + b.begin;
    b.mass = mpmi_f64(set, MPMI_MASS, 0) + b.begin;
    b.volume = mpmi_f64(set, MPMI_VOLUME, 0) + b.begin;
    b.temperature = mpmi_f64(set, set->thermal.temperature, 0) + b.begin;
    fn(&b);
  }
}

/* Returns 1 for a set that takes part in a block. */
static int32_t takes_part(const mpmi_heat_job *job, const mpmi_visit *visit, int32_t m) {
  return mpmi_has_heat(job->step, m) &&
         (!mpmi_were_shown(job->step, m) || mpmi_is_in_place(job->step, visit, m));
}

static void visit_block(const mpmi_heat_job *job, const mpmi_visit *visit, heat_fn fn, double *give) {
  for (int32_t m = 0; m < job->step->layout->member_count; ++m)
    if (takes_part(job, visit, m)) visit_set(job, visit, m, fn, give);
}

static const mpmi_kernels *kernels_of(const heat_batch *b) {
  return b->job->step->settings->kernels;
}

static double *row_of(const heat_batch *b, int32_t row) {
  const mpmi_member_rows *rows = &b->job->step->work->rows.of[b->m];
  return rows->heat + row * rows->heat_ld + b->begin;
}

/* Takes note of the first particle of a batch with a value that is not finite, where `bad`, the sum of their
 * differences from themselves, says that there is one. */
static void check_values(const heat_batch *b, const double *value, double bad, const char *what) {
  for (int64_t p = 0; p < b->n && bad != 0.0; ++p)
    if (b->id[p] >= 0 && !isfinite(value[p])) {
      mpmi_failure_take(&b->job->step->work->report[b->visit->task].failure,
                        mpmi_particle_failure(MPM_NONFINITE, b->m, b->id[p], what));
      return;
    }
}

/* ---- tiles of one value -------------------------------------------------------------------------------- */
/* A task has room for some of them. */
enum { FIELD, OUTFLOW, DIAGONAL, TILES };

static int64_t tile_size(const mpmi_settings *settings) {
  return mpmi_tile_nodes(settings->grid) + MPMI_SCALAR_SLACK;
}

int64_t mpmi_heat_tile_size(const mpmi_settings *settings) {
  return TILES * tile_size(settings);
}

static double *tile_of(const mpmi_heat_job *job, const mpmi_visit *visit, int32_t which) {
  const mpmi_settings *settings = job->step->settings;
  return job->heat->tile + visit->task * job->heat->tile_size + which * tile_size(settings);
}

/* Fills the tile with a value of the nodes; beyond what particles meet nothing is known of it. */
static double *load_field(const mpmi_heat_job *job, const mpmi_visit *visit, const mpmi_nodal *from,
                          int32_t value) {
  double *tile = tile_of(job, visit, FIELD);
  mpmi_nodal one = *from;
  one.at += value;
  mpmi_tile_load(job->step->settings->kernels, &job->step->layout->blocks, visit->block, &one,
                 MPMI_TAKE_FIRST, tile);
  return tile;
}

static double *clean_tile(const mpmi_heat_job *job, const mpmi_visit *visit, int32_t which) {
  double *tile = tile_of(job, visit, which);
  memset(tile, 0, (size_t)tile_size(job->step->settings) * sizeof *tile);
  return tile;
}

static void add_tile(const mpmi_heat_job *job, const double *tile, int32_t value, double *to) {
  const int64_t nodes = mpmi_tile_nodes(job->step->settings->grid);
  for (int64_t n = 0; n < nodes; ++n) to[NODE * n + value] += tile[n];
}

/* ---- to the nodes -------------------------------------------------------------------------------------- */
static void give_batch(const heat_batch *b, double (*value)[BATCH]) {
  const mpm_grid *grid = b->set->grid;
  const double *const rows[NODE] = {value[0], value[1], value[2], value[3]};
  kernels_of(b)->give_values[grid->dim][grid->width](&b->at, b->begin, b->n, rows, b->give);
}

static void project_batch(heat_batch *b) {
  const double c = b->rule->desc.specific_heat, dt = b->job->step->dt;
  const double *power = row_of(b, MPMI_ROW_POWER);
  double of[NODE][BATCH], bad = 0.0;
  for (int64_t p = 0; p < b->n; ++p) {
    const double capacity = b->mass[p] * c, heat = capacity * b->temperature[p];
    of[MPMI_HEAT_CAPACITY][p] = capacity;
    of[MPMI_HEAT_TEMPERATURE][p] = b->id[p] < 0 ? 0.0 : heat;
    of[MPMI_HEAT_POWER][p] = 0.0;
    of[MPMI_HEAT_MASS][p] = b->mass[p];
  }
  for (int64_t p = 0; p < b->n; ++p) bad += of[MPMI_HEAT_TEMPERATURE][p] - of[MPMI_HEAT_TEMPERATURE][p];
  for (int64_t p = 0; p < b->n && b->rule->desc.source; ++p) {
    if (b->id[p] < 0) continue;
    of[MPMI_HEAT_POWER][p] = b->volume[p] * power[p];
    b->job->heat->part[b->visit->block].sources += dt * of[MPMI_HEAT_POWER][p];
  }
  give_batch(b, of);
  check_values(b, of[MPMI_HEAT_TEMPERATURE], bad, "the heat that a temperature stands for is not finite");
}

static void project_block(void *user, const mpmi_visit *visit, double *tile) {
  visit_block(user, visit, project_batch, tile);
}

mpm_status mpmi_heat_project(const mpmi_heat_job *job) {
  const mpm_status status = mpmi_accumulate(
      job->step,
      &(mpmi_accumulation){.to = &job->heat->nodes, .give = project_block, .user = (void *)(uintptr_t)job});
  return status ? status : mpmi_step_failure(job->step);
}

static void place_batch(heat_batch *b) {
  double of[NODE][BATCH] = {{0.0}};
  for (int32_t k = 0; k < b->set->grid->dim; ++k) {
    const double *x = mpmi_places(b->set, 0) + k * b->set->ld + b->begin;
    for (int64_t p = 0; p < b->n; ++p) of[k][p] = b->mass[p] * b->rule->desc.specific_heat * x[p];
  }
  give_batch(b, of);
}

static void place_block(void *user, const mpmi_visit *visit, double *tile) {
  visit_block(user, visit, place_batch, tile);
}

mpm_status mpmi_heat_places(const mpmi_heat_job *job) {
  return mpmi_accumulate(
      job->step,
      &(mpmi_accumulation){.to = &job->heat->flow, .give = place_block, .user = (void *)(uintptr_t)job});
}

/* ---- conduction ---------------------------------------------------------------------------------------- */
static void conduct_batch(heat_batch *b) {
  const mpmi_heat_job *job = b->job;
  const mpm_grid *grid = b->set->grid;
  const double k = b->rule->desc.conductivity;
  double conductance[BATCH];
  mpmi_conduction conduction = {.at = b->at,
                                .conductance = conductance,
                                .field = tile_of(job, b->visit, FIELD),
                                .outflow = tile_of(job, b->visit, OUTFLOW),
                                .diagonal =
                                    job->heat->wants_diagonal ? tile_of(job, b->visit, DIAGONAL) : NULL};
  if (!(k > 0.0)) return;
  for (int64_t p = 0; p < b->n; ++p) conductance[p] = b->id[p] < 0 ? 0.0 : k * b->volume[p];
  for (int32_t c = 0; mpmi_is_total_lagrangian(grid) && c < mpmi_tensor_components(grid->dim); ++c)
    conduction.F[c] = mpmi_component_row(b->set, MPMI_F, 0, c);
  kernels_of(b)->conduct[grid->dim][grid->width](&conduction, b->begin, b->n);
}

static void conduct_block(void *user, const mpmi_visit *visit, double *tile) {
  const mpmi_heat_job *job = user;
  load_field(job, visit, &job->heat->nodes, MPMI_HEAT_TEMPERATURE);
  double *outflow = clean_tile(job, visit, OUTFLOW);
  double *diagonal = job->heat->wants_diagonal ? clean_tile(job, visit, DIAGONAL) : NULL;
  visit_block(job, visit, conduct_batch, tile);
  add_tile(job, outflow, MPMI_HEAT_OUTFLOW, tile);
  if (diagonal) add_tile(job, diagonal, MPMI_HEAT_DIAGONAL, tile);
}

mpm_status mpmi_heat_conduct(const mpmi_heat_job *job, int32_t diagonal) {
  job->heat->wants_diagonal = diagonal;
  return mpmi_accumulate(
      job->step,
      &(mpmi_accumulation){.to = &job->heat->flow, .give = conduct_block, .user = (void *)(uintptr_t)job});
}

/* ---- back to the particles ----------------------------------------------------------------------------- */
static void take_batch(const heat_batch *b, double *to) {
  const mpm_grid *grid = b->set->grid;
  kernels_of(b)->take_values[grid->dim][grid->width](&b->at, b->begin, b->n, tile_of(b->job, b->visit, FIELD),
                                                     to);
}

static void gather_batch(heat_batch *b) {
  double *now = row_of(b, MPMI_ROW_TEMPERATURE), rise[BATCH], bad = 0.0,
         gained = b->job->heat->part[b->visit->block].gained;
  take_batch(b, rise);
  for (int64_t p = 0; p < b->n; ++p) {
    rise[p] = b->id[p] < 0 ? 0.0 : rise[p];
    now[p] = b->temperature[p] + rise[p];
  }
  for (int64_t p = 0; p < b->n; ++p) {
    gained += b->mass[p] * b->rule->desc.specific_heat * rise[p];
    bad += now[p] - now[p];
  }
  b->job->heat->part[b->visit->block].gained = gained;
  check_values(b, now, bad, "temperature not finite");
}

/* Explicit conduction takes what films take at the temperature before. With more than the difference to the
 * ambient it would swing, and with more than twice that grow without bound. By Gershgorin's theorem the
 * largest share of a particle bounds those of all fields of temperature. */
static void check_films(heat_batch *b) {
  double share[BATCH];
  take_batch(b, share);
  for (int64_t p = 0; p < b->n; ++p)
    if (b->id[p] >= 0 && share[p] > 1.0 + 1e-9) {
      mpmi_failure_take(&b->job->step->work->report[b->visit->task].failure,
                        mpmi_particle_failure(
                            MPM_CUT_DT, b->m, b->id[p],
                            "explicit conduction in a film that takes more than the difference to ambient"));
      return;
    }
}

static void gather_block(void *user, const mpmi_visit *visit) {
  const mpmi_heat_job *job = user;
  if (job->heat->checks_films) {
    load_field(job, visit, &job->heat->flow, MPMI_HEAT_FILM);
    visit_block(job, visit, check_films, NULL);
  }
  load_field(job, visit, &job->heat->flow, MPMI_HEAT_INCREMENT);
  visit_block(job, visit, gather_batch, NULL);
}

mpm_status mpmi_heat_gather(const mpmi_heat_job *job) {
  const mpm_status status = mpmi_visit_blocks(job->step, 0, gather_block, (void *)(uintptr_t)job);
  return status ? status : mpmi_step_failure(job->step);
}
