/* The nodes that prescribed particles hold, and what of the nodes' impulses is theirs: sums go from particles
 * to nodes and back block by block, as P2G and G2P do. */
#include "stepper/prescribed.h"

#include <math.h>
#include <string.h>

/* Nodes of the stencil of one particle: places in the tile, weights. */
enum { MOST_NODES = MPMI_MAX_WIDTH * MPMI_MAX_WIDTH * MPMI_MAX_WIDTH };
typedef struct stencil {
  int32_t count, at[MOST_NODES];
  double w[MOST_NODES];
} stencil;

static void find_stencil(const mpm_grid *grid, const mpmi_weights *W, int64_t p, stencil *to) {
  const int32_t edge = MPMI_TILE_EDGE(grid->dim, grid->width), width = grid->width;
  to->count = 1;
  to->at[0] = 0;
  to->w[0] = 1.0;
  for (int32_t axis = 0; axis < grid->dim; ++axis) {
    for (int32_t n = to->count - 1; n >= 0; --n)
      for (int32_t k = width - 1; k >= 0; --k) {
        to->at[n * width + k] = to->at[n] * edge + k;
        to->w[n * width + k] = to->w[n] * W->w[axis][k][p];
      }
    to->count *= width;
  }
  for (int32_t n = 0; n < to->count; ++n) to->at[n] += W->node[p];
}

/* One member's prescribed particles in one block, with the block's tile of sums. */
typedef struct visit {
  const mpmi_boundary *f;
  const mpmi_member *member;
  double *tile;
  mpmi_prescribed_part *part;
} visit;
typedef void (*visit_fn)(const visit *v, int64_t slot, const stencil *nodes);

static void visit_chunk(const visit *v, const mpmi_axis *axis, int64_t begin, visit_fn fn) {
  const mpm_stepper *s = v->f->s;
  const mpm_particles *set = v->member->set;
  const mpm_grid *grid = s->grid;
  const mpmi_points points = mpmi_points_of(set, 0);
  mpmi_weights W;
  stencil nodes;
  int32_t weighed = 0;
  for (int64_t p = 0; p < MPMI_CHUNK; ++p) {
    int32_t any = 0;
    for (int32_t c = 0; c < grid->dim; ++c) any |= mpmi_is_prescribed(set, begin + p, c);
    if (!any) continue;
    if (!weighed) s->kernels->weights[grid->family][grid->dim](axis, 0, &points, begin, MPMI_CHUNK, &W);
    weighed = 1;
    find_stencil(grid, &W, p, &nodes);
    fn(v, begin + p, &nodes);
  }
}

static void visit_block(const mpmi_boundary *f, int64_t block, double *tile, visit_fn fn) {
  const mpm_stepper *s = f->s;
  mpmi_axis axis[3];
  mpmi_block_axes(s->grid, s->blocks.coord[block], axis);
  for (int32_t m = 0; m < s->member_count; ++m) {
    const visit v = {f, &s->member[m], tile, mpmi_part_of(s, block, m)};
    const int64_t *start = s->member[m].now.start;
    for (int64_t at = start[block]; at < start[block + 1] && v.member->prescribed; at += MPMI_CHUNK)
      visit_chunk(&v, axis, at, fn);
  }
}
_Static_assert((int)MPMI_PAD % (int)MPMI_CHUNK == 0, "blocks have whole chunks");

/* ---- the nodes that they hold ----------------------------------------------------------------------------
 */
static void give_momentum(const visit *v, int64_t slot, const stencil *nodes) {
  const mpm_particles *set = v->member->set;
  const double mass = mpmi_f64(set, MPMI_MASS, 0)[slot], *mean = mpmi_mean_velocity(v->member);
  for (int32_t c = 0; c < v->f->dim; ++c) {
    if (!mpmi_is_prescribed(set, slot, c)) continue;
    const double momentum = mass * mean[c * set->ld + slot];
    for (int32_t n = 0; n < nodes->count; ++n) {
      double *sums = v->tile + 8 * (int64_t)nodes->at[n];
      sums[c] += nodes->w[n] * momentum;
      sums[3 + c] += nodes->w[n] * mass;
    }
  }
}

typedef struct sum_job {
  const mpmi_boundary *f;
  int32_t colour;
} sum_job;

static void sum_task(void *data, int64_t k) {
  const sum_job *job = data;
  mpm_stepper *s = job->f->s;
  const mpmi_cut *cut = &s->colour[job->colour];
  double *tile = s->scratch[k].tile;
  memset(tile, 0, 8 * (size_t)mpmi_tile_nodes(s->grid) * sizeof *tile);
  for (int64_t i = cut->bound[k]; i < cut->bound[k + 1]; ++i) {
    if (!mpmi_block_is(s, cut->list[i], MPMI_WITH_PRESCRIBED)) continue;
    visit_block(job->f, cut->list[i], tile, give_momentum);
    mpmi_tile_add(s, cut->list[i], s->prescription.sums, 8, tile);
  }
}

static double *sums_at(const mpm_stepper *s, int64_t slot) {
  return s->prescription.sums + 8 * slot;
}

static int32_t is_touched(const mpm_stepper *s, int64_t slot) {
  return mpmi_block_is(s, slot / s->blocks.nodes, MPMI_TOUCHED);
}

/* Runs over the slots of the blocks that are touched. */
typedef void (*slots_fn)(const mpmi_boundary *f, int64_t begin, int64_t end, mpmi_failure *failure);
typedef struct slots_job {
  const mpmi_boundary *f;
  slots_fn fn;
} slots_job;

static void slots_task(void *data, int64_t k) {
  const slots_job *job = data;
  mpm_stepper *s = job->f->s;
  for (int64_t b = mpmi_first_block(s, k); b < mpmi_first_block(s, k + 1); ++b)
    if (mpmi_block_is(s, b, MPMI_TOUCHED))
      job->fn(job->f, b * s->blocks.nodes, (b + 1) * s->blocks.nodes, &s->scratch[k].failure);
}

static mpm_status over_slots(const mpmi_boundary *f, slots_fn fn) {
  slots_job job = {f, fn};
  return mpmi_run_tasks(f->s, 0, f->s->tasks, slots_task, &job);
}

static void clear_sums(const mpmi_boundary *f, int64_t begin, int64_t end, mpmi_failure *failure) {
  (void)failure;
  memset(sums_at(f->s, begin), 0, (size_t)(8 * (end - begin)) * sizeof(double));
}

/* A tie moves as one, component by component with its sign. */
static void fold_task(void *data, int64_t k) {
  const mpmi_boundary *f = data;
  const mpm_stepper *s = f->s;
  const mpmi_constraints *constraints = &s->constraints;
  const int64_t ties = constraints->tie_count;
  for (int64_t i = ties * k / s->tasks; i < ties * (k + 1) / s->tasks; ++i) {
    const mpmi_tie *tie = &constraints->tie[i];
    double *master = sums_at(s, tie->master);
    for (int64_t d = tie->first; d < tie->first + tie->count; ++d) {
      const mpmi_follower *follower = &constraints->follower[d];
      if (!is_touched(s, follower->slot) || !is_touched(s, tie->master)) continue;
      const double *sums = sums_at(s, follower->slot);
      for (int32_t c = 0; c < f->dim; ++c) {
        master[c] += follower->sign[c] * sums[c];
        master[3 + c] += sums[3 + c];
      }
    }
  }
}

/* After the host: it comes first. */
static void hold_slots(const mpmi_boundary *f, int64_t begin, int64_t end, mpmi_failure *failure) {
  mpm_stepper *s = f->s;
  for (int64_t slot = begin; slot < end; ++slot)
    for (int32_t c = 0; c < f->dim && mpmi_moves(f, slot); ++c) {
      const double *sums = sums_at(s, slot);
      if (s->held[3 * slot + c] || !(sums[3 + c] > s->mass_cut)) continue;
      const double value = sums[c] / sums[3 + c];
      if (!isfinite(value)) {
        int64_t index[3];
        mpmi_blocks_index(&s->blocks, slot, index);
        mpmi_failure_take(failure, &(mpmi_failure){MPM_NONFINITE, 0, -1, -1, mpmi_node_number(s->grid, index),
                                                   "velocity by prescribed particles not finite"});
      }
      s->held[3 * slot + c] = MPMI_HELD_BY_PARTICLES;
      s->held_value[3 * slot + c] = value;
    }
}

mpm_status mpmi_prescribed_hold(const mpmi_boundary *f) {
  mpm_stepper *s = f->s;
  sum_job job = {.f = f};
  mpm_status status = over_slots(f, clear_sums);
  for (job.colour = 0; job.colour < MPMI_COLOURS && !status; ++job.colour)
    if (s->colour[job.colour].count) status = mpmi_run_tasks(s, 0, s->tasks, sum_task, &job);
  if (!status) status = mpmi_run_tasks(s, 0, s->tasks, fold_task, (void *)(uintptr_t)f);
  if (!status) status = over_slots(f, hold_slots);
  return status ? status : mpmi_stepper_failure(s);
}

/* ---- their share of the impulses -------------------------------------------------------------------------
 */
/* The sums become impulse by prescribed mass: of free nodes here, of ties below. */
static void divide_impulses(const mpmi_boundary *f, int64_t begin, int64_t end, mpmi_failure *failure) {
  const mpm_stepper *s = f->s;
  (void)failure;
  for (int64_t slot = begin; slot < end; ++slot)
    for (int32_t c = 0; c < f->dim; ++c) {
      double *sums = sums_at(s, slot);
      const int32_t theirs =
          s->constraints.tie_of[slot] < 0 && mpmi_held_by(f, slot, c) == MPMI_HELD_BY_PARTICLES;
      sums[c] = theirs ? s->impulse[6 * slot + c] / sums[3 + c] : 0.0;
    }
}

static void divide_of_tie(const mpmi_boundary *f, const mpmi_tie *tie, int32_t c) {
  const mpm_stepper *s = f->s;
  const mpmi_follower *follower = tie->count ? s->constraints.follower + tie->first : NULL;
  double total = s->impulse[6 * tie->master + c];
  for (int64_t d = 0; d < tie->count; ++d) total += s->impulse[6 * follower[d].slot + c];
  const double by_mass = total / sums_at(s, tie->master)[3 + c];
  sums_at(s, tie->master)[c] = by_mass;
  for (int64_t d = 0; d < tie->count; ++d)
    if (is_touched(s, follower[d].slot)) sums_at(s, follower[d].slot)[c] = by_mass;
}

static void ties_task(void *data, int64_t k) {
  const mpmi_boundary *f = data;
  const mpm_stepper *s = f->s;
  const int64_t ties = s->constraints.tie_count;
  for (int64_t i = ties * k / s->tasks; i < ties * (k + 1) / s->tasks; ++i) {
    const mpmi_tie *tie = &s->constraints.tie[i];
    for (int32_t c = 0; c < f->dim; ++c)
      if (mpmi_held_by(f, tie->master, c) == MPMI_HELD_BY_PARTICLES) divide_of_tie(f, tie, c);
  }
}

static void take_share(const visit *v, int64_t slot, const stencil *nodes) {
  const mpm_particles *set = v->member->set;
  const double mass = mpmi_f64(set, MPMI_MASS, 0)[slot];
  for (int32_t c = 0; c < v->f->dim; ++c) {
    if (!mpmi_is_prescribed(set, slot, c)) continue;
    double force = mass * v->f->s->desc.gravity[c], impulse = 0.0;
    if (v->member->force) force += v->member->force[c * set->ld + slot];
    for (int32_t n = 0; n < nodes->count; ++n)
      impulse += nodes->w[n] * v->tile[8 * (int64_t)nodes->at[n] + c];
    v->part->impulse[c] += mass * impulse + v->f->s->velocity_dt * force;
  }
}

static void share_task(void *data, int64_t k) {
  const mpmi_boundary *f = data;
  mpm_stepper *s = f->s;
  for (int64_t i = s->cut.bound[k]; i < s->cut.bound[k + 1]; ++i) {
    const int64_t block = s->cut.list[i];
    if (!mpmi_block_is(s, block, MPMI_WITH_PRESCRIBED)) continue;
    memset(mpmi_part_of(s, block, 0), 0, (size_t)s->member_count * sizeof *s->prescription.part);
    mpmi_tile_load(s, block, s->prescription.sums, 8, 8, s->scratch[k].tile);
    visit_block(f, block, s->scratch[k].tile, take_share);
  }
}

mpm_status mpmi_prescribed_share(const mpmi_boundary *f) {
  mpm_stepper *s = f->s;
  mpm_status status = over_slots(f, divide_impulses);
  if (!status) status = mpmi_run_tasks(s, 0, s->tasks, ties_task, (void *)(uintptr_t)f);
  if (!status) status = mpmi_run_tasks(s, 0, s->tasks, share_task, (void *)(uintptr_t)f);
  return status;
}
