/* Particles and nodes: sums go the way of nodal sums, block by block through tiles. */
#include "heat/heat.h"
#include "context/reduce.h"
#include "layout/accumulate.h"
#include "layout/reached.h"
#include "layout/tasks.h"
#include "layout/tile.h"
#include "simd/vector3.h"
#include "stages/stages.h"

#include <math.h>

/* ---- stencils ------------------------------------------------------------------------------------------ */
enum { MOST_NODES = 64, NODE = 4 };

/* The nodes of one particle: places in a tile of NODE values, weights and gradients. */
typedef struct heat_stencil {
  int32_t count;
  int64_t at[MOST_NODES];
  double w[MOST_NODES], g[MOST_NODES][3];
} heat_stencil;

/* Each axis makes a row of nodes of every node, from the last one on. slopes: with gradients. */
static void list_nodes(const mpm_grid *grid, const mpmi_weights *W, int64_t p, int32_t slopes,
                       heat_stencil *to) {
  const int32_t dim = grid->dim, width = grid->width, edge = MPMI_TILE_EDGE(dim, width);
  int64_t stride = dim == 3 ? (int64_t)NODE * edge * edge : dim == 2 ? (int64_t)NODE * edge : NODE;
  to->count = 1;
  to->at[0] = NODE * (int64_t)W->node[p];
  to->w[0] = 1.0;
  for (int32_t k = 0; k < dim; ++k) to->g[0][k] = 1.0;
  for (int32_t axis = 0; axis < dim; ++axis, stride /= edge) {
    for (int32_t n = to->count - 1; n >= 0; --n)
      for (int32_t i = width - 1; i >= 0; --i) {
        const int32_t at = n * width + i;
        to->at[at] = to->at[n] + i * stride;
        for (int32_t k = 0; k < dim && slopes; ++k)
          to->g[at][k] = to->g[n][k] * (k == axis ? W->g : W->w)[axis][i][p];
        to->w[at] = to->w[n] * W->w[axis][i][p];
      }
    to->count *= width;
  }
}

/* ---- particles ----------------------------------------------------------------------------------------- */
typedef struct heat_particle {
  int64_t slot;
  int32_t m;
  heat_stencil near;
} heat_particle;

/* What is done with a particle: gather points to the tile that is read, give to the one that is added to. */
typedef void (*heat_fn)(const mpmi_heat_job *job, const mpmi_visit *visit, const heat_particle *particle,
                        const double *gather, double *give);

static double *temperature_row(const mpmi_heat_job *job, int32_t m) {
  return job->step->work->rows.of[m].heat;
}
static const double *temperature_field(const mpmi_heat_job *job, int32_t m) {
  const mpm_particles *set = job->step->layout->member[m].set;
  return mpmi_f64(set, set->thermal.temperature, 0);
}
static const double *power_row(const mpmi_heat_job *job, int32_t m) {
  const mpmi_member_rows *rows = &job->step->work->rows.of[m];
  return rows->heat + MPMI_ROW_POWER * rows->heat_ld;
}

static void visit_set(const mpmi_heat_job *job, const mpmi_visit *visit, int32_t m, int32_t slopes,
                      heat_fn fn, const double *gather, double *give) {
  const mpmi_settings *settings = job->step->settings;
  const mpmi_layout *layout = job->step->layout;
  const mpm_grid *grid = settings->grid;
  const mpm_particles *set = layout->member[m].set;
  const mpmi_points points = mpmi_points_of(set, 0);
  const mpmi_weights_fn weights = settings->kernels->weights[grid->family][grid->dim];
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  const int64_t end = layout->member[m].now.start[visit->block + 1];
  mpmi_axis axis[3];
  mpmi_weights W;
  heat_particle particle = {.m = m};
  mpmi_block_axes(grid, layout->blocks.coord[visit->block], axis);
  for (int64_t at = layout->member[m].now.start[visit->block]; at < end; at += MPMI_CHUNK) {
    const int64_t n = end - at < MPMI_CHUNK ? end - at : MPMI_CHUNK;
    weights(axis, slopes ? MPMI_NEED_GRADIENT : 0, &points, at, n, &W);
    for (int64_t p = 0; p < n; ++p) {
      if (id[at + p] < 0) continue;
      particle.slot = at + p;
      list_nodes(grid, &W, p, slopes, &particle.near);
      fn(job, visit, &particle, gather, give);
    }
  }
}

/* Returns 1 for a set that takes part in a block. */
static int32_t takes_part(const mpmi_heat_job *job, const mpmi_visit *visit, int32_t m) {
  return mpmi_has_heat(job->step, m) &&
         (!mpmi_were_shown(job->step, m) || mpmi_is_in_place(job->step, visit, m));
}

static void visit_block(const mpmi_heat_job *job, const mpmi_visit *visit, int32_t slopes, heat_fn fn,
                        const double *gather, double *give) {
  for (int32_t m = 0; m < job->step->layout->member_count; ++m)
    if (takes_part(job, visit, m)) visit_set(job, visit, m, slopes, fn, gather, give);
}

static double *load_tile(const mpmi_heat_job *job, const mpmi_visit *visit, const mpmi_nodal *from) {
  double *tile = job->heat->tile + visit->task * job->heat->tile_size;
  mpmi_tile_load(job->step->settings->kernels, &job->step->layout->blocks, visit->block, from, NODE, tile);
  return tile;
}

static double sum_of_parts(const mpmi_heat_job *job, const double *first) {
  return mpmi_reduce(MPMI_REDUCE_SUM, 0.0, first, sizeof(mpmi_heat_part) / sizeof(double), NULL,
                     job->step->layout->blocks.count);
}

/* ---- to the nodes -------------------------------------------------------------------------------------- */
static void project_particle(const mpmi_heat_job *job, const mpmi_visit *visit, const heat_particle *of,
                             const double *gather, double *give) {
  const mpmi_heat_rule *rule = &job->step->settings->heat.set[of->m];
  const mpm_particles *set = job->step->layout->member[of->m].set;
  const double mass = mpmi_f64(set, MPMI_MASS, 0)[of->slot], capacity = mass * rule->desc.specific_heat;
  const double heat = capacity * temperature_field(job, of->m)[of->slot];
  const double power =
      rule->desc.source ? mpmi_f64(set, MPMI_VOLUME, 0)[of->slot] * power_row(job, of->m)[of->slot] : 0.0;
  (void)gather;
  for (int32_t n = 0; n < of->near.count; ++n) {
    double *node = give + of->near.at[n];
    node[MPMI_HEAT_CAPACITY] += of->near.w[n] * capacity;
    node[MPMI_HEAT_TEMPERATURE] += of->near.w[n] * heat;
    node[MPMI_HEAT_POWER] += of->near.w[n] * power;
    node[MPMI_HEAT_MASS] += of->near.w[n] * mass;
  }
  job->heat->part[visit->block].sources += job->step->dt * power;
  if (isfinite(heat)) return;
  mpmi_failure_take(&job->step->work->report[visit->task].failure,
                    mpmi_particle_failure(MPM_NONFINITE, of->m, mpmi_i64(set, MPMI_ID, 0)[of->slot],
                                          "the heat that a temperature stands for is not finite"));
}

static void project_block(void *user, const mpmi_visit *visit, double *tile) {
  visit_block(user, visit, 0, project_particle, NULL, tile);
}

mpm_status mpmi_heat_project(const mpmi_heat_job *job) {
  mpm_status status = mpmi_accumulate(
      job->step,
      &(mpmi_accumulation){.to = &job->heat->nodes, .give = project_block, .user = (void *)(uintptr_t)job});
  if (!status) status = mpmi_step_failure(job->step);
  job->heat->sums.sources = sum_of_parts(job, &job->heat->part->sources);
  return status;
}

static void place_particle(const mpmi_heat_job *job, const mpmi_visit *visit, const heat_particle *of,
                           const double *gather, double *give) {
  const mpm_particles *set = job->step->layout->member[of->m].set;
  const double capacity =
      mpmi_f64(set, MPMI_MASS, 0)[of->slot] * job->step->settings->heat.set[of->m].desc.specific_heat;
  (void)gather;
  (void)visit;
  for (int32_t n = 0; n < of->near.count; ++n)
    for (int32_t k = 0; k < set->grid->dim; ++k)
      give[of->near.at[n] + k] += of->near.w[n] * capacity * mpmi_places(set, 0)[k * set->ld + of->slot];
}

static void place_block(void *user, const mpmi_visit *visit, double *tile) {
  visit_block(user, visit, 0, place_particle, NULL, tile);
}

mpm_status mpmi_heat_places(const mpmi_heat_job *job) {
  return mpmi_accumulate(
      job->step,
      &(mpmi_accumulation){.to = &job->heat->flow, .give = place_block, .user = (void *)(uintptr_t)job});
}

/* ---- conduction ---------------------------------------------------------------------------------------- */
/* Finds A so that heat flows along -k A grad T: of a total Lagrangian grid, which has gradients over
 * reference positions, F^-1 F^-T. Returns 0 where it is the identity. */
static int32_t find_metric(const mpm_particles *set, int64_t slot, double A[3][3]) {
  double F[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}, inverse[3][3];
  const int32_t dim = set->grid->dim, *map = mpmi_tensor_map(dim);
  if (!mpmi_is_total_lagrangian(set->grid)) return 0;
  for (int32_t c = 0; c < mpmi_tensor_components(dim); ++c)
    F[map[c] / 3][map[c] % 3] = mpmi_f64(set, MPMI_F, 0)[c * set->ld + slot];
  mpmi_invert3(F, inverse);
  for (int32_t i = 0; i < 3; ++i)
    for (int32_t j = 0; j < 3; ++j) A[i][j] = mpmi_inner(inverse[i], inverse[j]);
  return 1;
}

static void turn(int32_t dim, double A[3][3], double *v) {
  const double old[3] = {v[0], dim > 1 ? v[1] : 0.0, dim > 2 ? v[2] : 0.0};
  for (int32_t k = 0; k < dim; ++k) v[k] = mpmi_inner(A[k], old);
}

static void conduct_particle(const mpmi_heat_job *job, const mpmi_visit *visit, const heat_particle *of,
                             const double *gather, double *give) {
  const mpm_particles *set = job->step->layout->member[of->m].set;
  const int32_t dim = set->grid->dim;
  const double k_V =
      job->step->settings->heat.set[of->m].desc.conductivity * mpmi_f64(set, MPMI_VOLUME, 0)[of->slot];
  double slope[3] = {0.0, 0.0, 0.0}, A[3][3];
  (void)visit;
  if (!(k_V > 0.0)) return;
  for (int32_t n = 0; n < of->near.count; ++n)
    for (int32_t k = 0; k < dim; ++k)
      slope[k] += of->near.g[n][k] * gather[of->near.at[n] + MPMI_HEAT_TEMPERATURE];
  const int32_t turns = find_metric(set, of->slot, A);
  if (turns) turn(dim, A, slope);
  for (int32_t n = 0; n < of->near.count; ++n) {
    double *node = give + of->near.at[n], g[3] = {0.0, 0.0, 0.0};
    for (int32_t k = 0; k < dim; ++k) g[k] = of->near.g[n][k];
    const double outflow = mpmi_inner(g, slope);
    const double first[3] = {g[0], g[1], g[2]};
    if (turns) turn(dim, A, g);
    node[MPMI_HEAT_OUTFLOW] += k_V * outflow;
    node[MPMI_HEAT_DIAGONAL] += k_V * mpmi_inner(first, g);
  }
}

static void conduct_block(void *user, const mpmi_visit *visit, double *tile) {
  const mpmi_heat_job *job = user;
  visit_block(job, visit, 1, conduct_particle, load_tile(job, visit, &job->heat->nodes), tile);
}

mpm_status mpmi_heat_conduct(const mpmi_heat_job *job) {
  return mpmi_accumulate(
      job->step,
      &(mpmi_accumulation){.to = &job->heat->flow, .give = conduct_block, .user = (void *)(uintptr_t)job});
}

/* ---- back to the particles ----------------------------------------------------------------------------- */
/* Explicit conduction takes what films take at the temperature before. With more than the difference to the
 * ambient it would swing, and with more than twice that grow without bound. By Gershgorin's theorem the
 * largest share of a particle bounds those of all fields of temperature. */
static void check_films(const mpmi_heat_job *job, const mpmi_visit *visit, const heat_particle *of,
                        const double *gather) {
  double share = 0.0;
  for (int32_t n = 0; n < of->near.count; ++n)
    share += of->near.w[n] * gather[of->near.at[n] + MPMI_HEAT_FILM];
  if (!(share > 1.0 + 1e-9)) return;
  const int64_t id = mpmi_i64(job->step->layout->member[of->m].set, MPMI_ID, 0)[of->slot];
  mpmi_failure_take(
      &job->step->work->report[visit->task].failure,
      mpmi_particle_failure(MPM_CUT_DT, of->m, id,
                            "explicit conduction in a film that takes more than the difference to ambient"));
}

static void gather_particle(const mpmi_heat_job *job, const mpmi_visit *visit, const heat_particle *of,
                            const double *gather, double *give) {
  const mpm_particles *set = job->step->layout->member[of->m].set;
  const double capacity =
      mpmi_f64(set, MPMI_MASS, 0)[of->slot] * job->step->settings->heat.set[of->m].desc.specific_heat;
  const double before = temperature_field(job, of->m)[of->slot];
  double rise = 0.0;
  (void)give;
  for (int32_t n = 0; n < of->near.count; ++n)
    rise += of->near.w[n] * gather[of->near.at[n] + MPMI_HEAT_INCREMENT];
  temperature_row(job, of->m)[of->slot] = before + rise;
  job->heat->part[visit->block].gained += capacity * rise;
  if (job->heat->checks_films) check_films(job, visit, of, gather);
  if (isfinite(before + rise)) return;
  mpmi_failure_take(&job->step->work->report[visit->task].failure,
                    mpmi_particle_failure(MPM_NONFINITE, of->m, mpmi_i64(set, MPMI_ID, 0)[of->slot],
                                          "temperature not finite"));
}

static void gather_block(void *user, const mpmi_visit *visit) {
  const mpmi_heat_job *job = user;
  visit_block(job, visit, 0, gather_particle, load_tile(job, visit, &job->heat->flow), NULL);
}

mpm_status mpmi_heat_gather(const mpmi_heat_job *job) {
  mpm_status status = mpmi_visit_blocks(job->step, 0, gather_block, (void *)(uintptr_t)job);
  if (!status) status = mpmi_step_failure(job->step);
  job->heat->sums.gained = sum_of_parts(job, &job->heat->part->gained);
  return status;
}

/* ---- the stable step ----------------------------------------------------------------------------------- */
/* Returns the rate of one particle: 2 / dt for its diffusivity and the spacing. */
static double rate_of(const mpm_particles *set, double conductance, int64_t slot) {
  const mpm_grid *grid = set->grid;
  double A[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}, sum = 0.0;
  find_metric(set, slot, A);
  for (int32_t i = 0; i < grid->dim; ++i)
    for (int32_t j = 0; j < grid->dim; ++j)
      sum += fabs(A[i][j]) * grid->inverse_spacing[i] * grid->inverse_spacing[j];
  return 2.0 * sum * conductance * mpmi_f64(set, MPMI_VOLUME, 0)[slot] / mpmi_f64(set, MPMI_MASS, 0)[slot];
}

double mpmi_heat_rate(const mpmi_settings *settings, const mpmi_layout *layout) {
  double rate = 0.0;
  if (!settings->heat.any || settings->heat.conduction != MPM_CONDUCTION_EXPLICIT) return 0.0;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpm_heat_desc *desc = &settings->heat.set[m].desc;
    const mpm_particles *set = layout->member[m].set;
    if (!settings->heat.set[m].on || !(desc->conductivity > 0.0)) continue;
    const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
    for (int64_t slot = 0; slot < set->slots; ++slot) {
      if (id[slot] < 0) continue;
      const double of = rate_of(set, desc->conductivity / desc->specific_heat, slot);
      rate = of > rate ? of : rate;
    }
  }
  return rate;
}
