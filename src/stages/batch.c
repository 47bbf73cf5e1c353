/* Batches of particles in a pass: gathered from the nodes of a block by the kernels of transfer/gather.c,
 * handed on, and looked at where a value has gone wrong. */
#include "stages/batch.h"
#include "layout/tile.h"
#include "layout/visit.h"

#include <math.h>
#include <string.h>

/* ---- the set, the block ------------------------------------------------------------------------------- */
static void add_streams(mpmi_streams *streams, const mpm_particles *set, int32_t field, int32_t copy) {
  const mpmi_field *f = &set->field[field];
  for (int32_t c = 0; f->present && c < f->components && streams->count < MPMI_MAX_STREAMS; ++c)
    streams->at[streams->count++] = mpmi_component_row(set, field, copy, c);
}

/* Lists what a batch reads and writes, for prefetching. */
static void list_streams(mpmi_batch *b) {
  mpmi_streams *streams = &b->gather.streams;
  streams->count = 0;
  streams->end = INT64_MAX; /* one block after the other */
  add_streams(streams, b->set, mpmi_place_field(b->set->grid), 0);
  add_streams(streams, b->set, MPMI_INITIAL_VOLUME, 0);
  if (b->pass->moves) {
    if (b->step->takes == MPMI_TAKES_BLEND) add_streams(streams, b->set, MPMI_VELOCITY, 0);
    if (mpmi_is_total_lagrangian(b->set->grid)) add_streams(streams, b->set, MPMI_POSITION, 0);
    add_streams(streams, b->set, MPMI_POSITION, 1);
    add_streams(streams, b->set, MPMI_VELOCITY, 1);
    add_streams(streams, b->set, MPMI_L, 1);
  }
  if (b->pass->places) add_streams(streams, b->set, MPMI_POSITION, 1);
  if (b->pass->deforms) {
    add_streams(streams, b->set, MPMI_F, 0);
    add_streams(streams, b->set, MPMI_F, 1);
    add_streams(streams, b->set, MPMI_VOLUME, 0);
    add_streams(streams, b->set, MPMI_MASS, 0);
    add_streams(streams, b->set, MPMI_STRESS, 1);
    if (!mpmi_material_stress_from_F(b->set->material)) add_streams(streams, b->set, MPMI_STRESS, 0);
  }
}

static void bind_set(mpmi_batch *b, int32_t m) {
  const mpmi_settings *settings = b->step->settings;
  const mpm_grid *grid = settings->grid;
  mpm_particles *set = b->step->layout->member[m].set;
  b->m = m;
  b->set = set;
  mpmi_law_batch_bind(&b->law, set->material, b->scratch->batch_memory);
  const int64_t ld = b->law.ld;
  b->v_bar = b->scratch->gathered;
  b->dv = b->v_bar + 3 * ld;
  b->C = b->dv + 3 * ld;
  memset(b->scratch->gathered, 0, (size_t)(15 * ld) * sizeof(double));
  b->gather = (mpmi_gather){.weights = settings->kernels->weights[grid->family][grid->dim],
                            .points = mpmi_points_of(set, 0),
                            .need = b->need,
                            .initial_volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0),
                            .tile = b->scratch->tile,
                            .ld = ld,
                            .v = b->pass->plain || b->pass->moves ? b->v_bar : NULL,
                            .dv = b->dv};
  for (int32_t e = 0; e < 9; ++e) {
    b->gather.L[e] = b->pass->plain ? NULL : b->law.L + e * ld;
    b->gather.C[e] = b->C + e * ld;
  }
  list_streams(b);
  if (b->pass->bind) b->pass->bind(b);
  b->rings = mpmi_is_axisymmetric(grid) && !b->pass->plain;
  if (b->rings) b->gather.v = b->v_bar;
}

/* Completes the gradient at rings: L_theta = v_r / r, which is the radial one where r vanishes. */
static void find_hoop_rate(mpmi_batch *b) {
  const double *radius = mpmi_places(b->set, 0) + b->begin;
  const double *radial = b->law.L;
  double *hoop = b->law.L + 8 * b->law.ld;
  for (int64_t p = 0; p < b->n; ++p) hoop[p] = radius[p] > 0.0 ? b->v_bar[p] / radius[p] : radial[p];
}

/* Rings have nine entries of F, of which four are no fields of the set. */
static const double no_entry[MPMI_BATCH_HOST];

void mpmi_gradient_present(mpmi_batch *b) {
  const mpm_grid *grid = b->set->grid;
  const double *F[9];
  for (int32_t e = 0; e < 9; ++e) F[e] = no_entry;
  for (int32_t c = 0; c < mpmi_tensor_components(grid->dim); ++c)
    F[mpmi_is_axisymmetric(grid) ? mpmi_tensor_map(2)[c] : c] =
        mpmi_component_row(b->set, MPMI_F, 0, c) + b->begin;
  b->step->settings->pull_back->spatial[mpmi_strain_dim(grid)](F, b->law.ld, b->law.L, b->n);
}

/* Chooses the form of the gather: increments are needed by blends and by second-order positions, C by
 * transfers that carry it, and L by all passes but those that only move particles which do not carry it. */
static void choose_form(mpmi_batch *b) {
  const mpmi_settings *settings = b->step->settings;
  const mpmi_transfer *transfer = settings->transfer;
  const int32_t moves = b->pass->moves;
  const int32_t increments =
      moves && (b->step->takes == MPMI_TAKES_BLEND || settings->desc.position_order == 2);
  const int32_t matrix = moves && transfer->carries == MPMI_CARRIES_MATRIX;
  if (transfer->moments == MPMI_NEED_MLS && !increments && !b->pass->plain) {
    b->form = MPMI_GATHER_MLS;
    b->need = 0;
    return;
  }
  if (b->pass->plain || (moves && !b->pass->deforms && transfer->carries == MPMI_CARRIES_NOTHING)) {
    b->form = increments ? MPMI_GATHER_CHANGE : MPMI_GATHER_MEAN;
    b->need = 0;
    return;
  }
  const int32_t varied = matrix && !(settings->grid->moment > 0.0);
  b->need = MPMI_NEED_GRADIENT | (varied ? MPMI_NEED_MOMENT : matrix ? 0 : MPMI_NO_FIRST);
  if (increments)
    b->form = varied ? MPMI_GATHER_BOTH_AFFINE_VARIED : matrix ? MPMI_GATHER_BOTH_AFFINE : MPMI_GATHER_BOTH;
  else
    b->form = varied ? MPMI_GATHER_AFFINE_VARIED : matrix ? MPMI_GATHER_AFFINE : MPMI_GATHER_PLAIN;
}

/* ---- what has gone wrong ------------------------------------------------------------------------------ */
void mpmi_batch_fail(mpmi_batch *b, mpm_status cause, int64_t slot, const char *what) {
  mpmi_failure_take(&b->report->failure,
                    mpmi_particle_failure(cause, b->m, mpmi_i64(b->set, MPMI_ID, 0)[slot], what));
}

static int32_t finite_row(const mpm_particles *set, int32_t field, int32_t components, int64_t slot) {
  for (int32_t c = 0; c < components; ++c)
    if (!isfinite(mpmi_component_row(set, field, 1, c)[slot])) return 0;
  return 1;
}

/* Gives a hole its old values back, which nodes near it that are not finite have spoilt. */
static void restore_hole(mpmi_batch *b, int64_t slot) {
  mpm_particles *set = b->set;
  b->report->holes_restored = 1;
  mpmi_f64(set, MPMI_VOLUME, 0)[slot] = 0.0;
  for (int32_t f = 0; f < set->field_count; ++f) {
    const mpmi_field *field = &set->field[f];
    if (!field->present || !field->two_copies) continue;
    const size_t size = mpmi_type_size(field->type);
    for (int32_t c = 0; c < field->components; ++c) {
      const size_t at = (size_t)(c * set->ld + slot) * size;
      memcpy((char *)field->data[1] + at, (const char *)field->data[0] + at, size);
    }
  }
}

/* A law may have given the square of a wave speed, which is negative where there are no waves. */
static int32_t law_is_finite(const mpmi_batch *b, int64_t slot) {
  const mpm_particles *set = b->set;
  const int64_t p = slot - b->begin;
  return finite_row(set, MPMI_STRESS, mpmi_stress_components(set->grid->dim), slot) &&
         finite_row(set, MPMI_STATE, set->material->state_count, slot) && isfinite(b->law.wave_speed[p]) &&
         b->law.wave_speed[p] >= 0.0 && isfinite(b->law.viscosity[p]);
}

/* Finds the particles behind the flags of the batch. */
static void check_batch(mpmi_batch *b) {
  const mpm_particles *set = b->set;
  const int32_t dim = set->grid->dim;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  const int32_t moved = b->pass->moves || b->pass->places, deformed = b->pass->deforms;
  for (int64_t slot = b->begin; slot < b->begin + b->n; ++slot) {
    if (id[slot] < 0)
      restore_hole(b, slot);
    else if (moved &&
             !(finite_row(set, MPMI_POSITION, dim, slot) && finite_row(set, MPMI_VELOCITY, dim, slot)))
      mpmi_batch_fail(b, MPM_NONFINITE, slot, "position or velocity not finite");
    else if (deformed && !finite_row(set, MPMI_F, mpmi_tensor_components(dim), slot))
      mpmi_batch_fail(b, MPM_NONFINITE, slot, "deformation gradient not finite");
    else if (deformed && !(mpmi_f64(set, MPMI_VOLUME, 0)[slot] > 0.0))
      mpmi_batch_fail(b, MPM_INVERTED, slot, "det F is not positive");
    else if (b->law_ran && !law_is_finite(b, slot))
      mpmi_batch_fail(b, MPM_NONFINITE, slot, "the material's stress, state or wave speed is not finite");
  }
}

/* ---- the walk ----------------------------------------------------------------------------------------- */
void mpmi_pass_begin(mpmi_batch *b, mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from,
                     const mpmi_pass *pass, void *user, int32_t task) {
  b->step = step;
  b->nodes = nodes;
  b->from = from;
  b->pass = pass;
  b->user = user;
  b->task = task;
  b->scratch = &step->work->scratch[task];
  b->report = &step->work->report[task];
  b->m = -1;
  b->batches = 0;
  b->largest_rate = 0.0;
  choose_form(b);
}

static void take_batch(mpmi_batch *b, int64_t begin, int64_t n) {
  const mpmi_settings *settings = b->step->settings;
  b->begin = begin;
  b->n = n;
  b->flags = 0;
  b->law_ran = 0;
  if (b->pass->aim) b->pass->aim(b);
  b->taken =
      settings->kernels->gather[settings->grid->dim][settings->grid->width][b->form](&b->gather, begin, n);
  if (b->rings) find_hoop_rate(b);
  b->pass->take(b);
  if (b->flags) check_batch(b);
}

/* Fetches a share of the nodes of the block that comes next, while the particles of this one are at work. */
static void fetch_next(mpmi_batch *b, int64_t next, int64_t done, int64_t n, int64_t slots) {
  const mpmi_blocks *blocks = &b->step->layout->blocks;
  mpmi_tile_fetch(b->step->settings->kernels, blocks, next, &b->next, b->from,
                  (int32_t)(blocks->neighbours * done / slots),
                  (int32_t)(blocks->neighbours * (done + n) / slots));
}

/* Returns 1 for the pass that starts the sums: one that deforms, or one that moves where that is first. */
static int32_t starts_sums(const mpmi_batch *b) {
  return b->pass->deforms || (b->pass->moves && !mpmi_deforms_first(b->step->settings));
}

void mpmi_pass_block(mpmi_batch *b, int64_t block, int64_t next) {
  const mpmi_layout *layout = b->step->layout;
  const mpmi_blocks *blocks = &layout->blocks;
  b->block = block;
  b->sums = &b->step->work->block_sums[block];
  if (starts_sums(b)) memset(b->sums, 0, sizeof *b->sums);
  const int32_t what = mpmi_gather_takes(blocks->grid->dim, b->form);
  if (next >= 0) b->next = mpmi_spans_of(blocks, next);
  mpmi_tile_use(blocks->grid, b->scratch->tile, mpmi_taken_values(what));
  mpmi_tile_load(b->step->settings->kernels, blocks, block, b->from, what, b->scratch->tile);
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const int64_t begin = layout->member[m].now.start[block], end = layout->member[m].now.start[block + 1];
    if (begin == end) continue;
    if (m != b->m) bind_set(b, m);
    mpmi_block_axes(blocks->grid, blocks->coord[block], b->gather.axis);
    if (b->pass->enter) b->pass->enter(b);
    for (int64_t p = begin; p < end; p += b->law.ld) {
      const int64_t n = end - p < b->law.ld ? end - p : b->law.ld;
      if (m == 0 && next >= 0) fetch_next(b, next, p - begin, n, end - begin);
      take_batch(b, p, n);
    }
    mpmi_sample_weights(b->step, b->task, b->gather.axis, b->need, &b->gather.points, begin, end);
  }
}

typedef struct pass_job {
  mpmi_step *step;
  mpmi_nodes *nodes;
  const mpmi_nodal *from;
  const mpmi_pass *pass;
  void *user;
} pass_job;

static void take_range(void *data, int32_t task, const int32_t *block, int64_t count) {
  const pass_job *job = data;
  mpmi_batch b;
  mpmi_pass_begin(&b, job->step, job->nodes, job->from, job->pass, job->user, task);
  for (int64_t i = 0; i < count; ++i) mpmi_pass_block(&b, block[i], i + 1 < count ? block[i + 1] : -1);
}

int32_t mpmi_has_host_law(const mpmi_layout *layout) {
  for (int32_t m = 0; m < layout->member_count; ++m)
    if (!layout->member[m].set->material->law) return 1;
  return 0;
}

mpm_status mpmi_pass_run(mpmi_step *step, mpmi_nodes *nodes, const mpmi_nodal *from, const mpmi_pass *pass,
                         void *user) {
  pass_job job = {step, nodes, from, pass, user};
  const mpm_status status = mpmi_visit_ranges(step, mpmi_has_host_law(step->layout), take_range, &job);
  return status ? status : mpmi_step_failure(step);
}
