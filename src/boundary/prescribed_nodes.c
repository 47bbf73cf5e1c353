/* The nodes that prescribed particles hold, and what of the nodes' impulses is theirs: sums go from particles
 * to nodes and back block by block, as P2G and G2P do. */
#include "boundary/bound.h"
#include "boundary/prescribed.h"
#include "layout/accumulate.h"
#include "layout/tile.h"

#include <math.h>
#include <string.h>

/* Holds the nodes that one particle reaches: their places in the tile, and their weights. */
enum { MOST_NODES = MPMI_MAX_WIDTH * MPMI_MAX_WIDTH * MPMI_MAX_WIDTH };
typedef struct stencil {
  int32_t count, at[MOST_NODES];
  double w[MOST_NODES];
} stencil;

/* A particle that reaches a node by no more than this share of a cell, as where the edge of its domain lies
 * on the node, reaches it by rounding, which must not decide who holds the node. Weights begin with a power
 * of that reach, the order of the basis. */
static const double least_reach = 1e-12;

static double least_weight(const mpm_grid *grid) {
  double least = least_reach;
  for (int32_t order = 1; order < grid->width - 1; ++order) least *= least_reach;
  return least;
}

static void find_stencil(const mpm_grid *grid, const mpmi_weights *W, int64_t p, stencil *to) {
  const int32_t edge = MPMI_TILE_EDGE(grid->dim, grid->width), width = grid->width;
  const double least = least_weight(grid);
  to->count = 1;
  to->at[0] = 0;
  to->w[0] = 1.0;
  for (int32_t axis = 0; axis < grid->dim; ++axis) {
    for (int32_t n = to->count - 1; n >= 0; --n)
      for (int32_t k = width - 1; k >= 0; --k) {
        const double w = W->w[axis][k][p];
        to->at[n * width + k] = to->at[n] * edge + k;
        to->w[n * width + k] = to->w[n] * (w > least ? w : 0.0);
      }
    to->count *= width;
  }
  for (int32_t n = 0; n < to->count; ++n) to->at[n] += W->node[p];
}

/* Holds one member's prescribed particles in one block, with the block's tile of sums. */
typedef struct visit {
  mpmi_bound *bound;
  const mpmi_member *member;
  int32_t m; /* its number */
  mpmi_prescribed_sums *tile;
  mpmi_prescribed_part *part;
} visit;
typedef void (*visit_fn)(const visit *v, int64_t slot, const stencil *nodes);

static void visit_chunk(const visit *v, const mpmi_axis *axis, int64_t begin, visit_fn fn) {
  const mpm_particles *set = v->member->set;
  const mpm_grid *grid = set->grid;
  const mpmi_weights_fn weights = v->bound->step->settings->kernels->weights[grid->family][grid->dim];
  const mpmi_points points = mpmi_points_of(set, 0);
  mpmi_weights W;
  stencil nodes;
  int32_t weighed = 0;
  for (int64_t p = 0; p < MPMI_CHUNK; ++p) {
    int32_t any = 0;
    for (int32_t c = 0; c < grid->dim; ++c) any |= mpmi_is_prescribed(set, begin + p, c);
    if (!any) continue;
    if (!weighed) weights(axis, 0, &points, begin, MPMI_CHUNK, &W);
    weighed = 1;
    find_stencil(grid, &W, p, &nodes);
    fn(v, begin + p, &nodes);
  }
}

static void visit_particles(mpmi_bound *bound, int64_t block, double *tile, visit_fn fn) {
  const mpmi_layout *layout = bound->step->layout;
  mpmi_axis axis[3];
  mpmi_block_axes(layout->blocks.grid, layout->blocks.coord[block], axis);
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const visit v = {bound, &layout->member[m], m, (mpmi_prescribed_sums *)tile,
                     mpmi_part_of(layout, bound->nodes, block, m)};
    const int64_t *start = v.member->now.start;
    for (int64_t at = start[block]; at < start[block + 1] && v.member->prescribed; at += MPMI_CHUNK)
      visit_chunk(&v, axis, at, fn);
  }
}
_Static_assert((int)MPMI_PAD % (int)MPMI_CHUNK == 0, "blocks have whole chunks");

/* ---- the nodes that they hold -------------------------------------------------------------------------- */
static void give_momentum(const visit *v, int64_t slot, const stencil *nodes) {
  const mpm_particles *set = v->member->set;
  const double mass = mpmi_f64(set, MPMI_MASS, 0)[slot], *mean = mpmi_mean_velocity(v->bound->step, v->m);
  for (int32_t c = 0; c < v->bound->dim; ++c) {
    if (!mpmi_is_prescribed(set, slot, c)) continue;
    const double momentum = mass * mean[c * set->ld + slot];
    for (int32_t n = 0; n < nodes->count; ++n) {
      mpmi_prescribed_sums *sums = v->tile + nodes->at[n];
      sums->momentum[c] += nodes->w[n] * momentum;
      sums->mass[c] += nodes->w[n] * mass;
    }
  }
}

static void give_block(void *user, const mpmi_visit *at, double *tile) {
  visit_particles(user, at->block, tile, give_momentum);
}

static mpmi_prescribed_sums *sums_at(const mpmi_nodes *nodes, int64_t slot) {
  return nodes->prescription.sums + slot;
}

static mpmi_nodal sums_of(const mpmi_nodes *nodes) {
  return (mpmi_nodal){.at = (double *)nodes->prescription.sums, .values = 8};
}

static int32_t is_touched(mpmi_bound *bound, int64_t slot) {
  return mpmi_block_is(bound->nodes, slot / bound->step->layout->blocks.nodes, MPMI_TOUCHED);
}

/* Runs over the slots of the blocks that are touched. */
typedef void (*slots_fn)(mpmi_bound *bound, int64_t begin, int64_t end, mpmi_failure *failure);
typedef struct slots_job {
  mpmi_bound *bound;
  slots_fn fn;
} slots_job;

static void slots_task(void *data, int64_t k) {
  const slots_job *job = data;
  const mpmi_step *step = job->bound->step;
  const mpmi_blocks *blocks = &step->layout->blocks;
  const mpmi_share share = mpmi_share_of(step->settings, blocks->count, k);
  for (int64_t b = share.begin; b < share.end; ++b)
    if (mpmi_block_is(job->bound->nodes, b, MPMI_TOUCHED))
      job->fn(job->bound, b * blocks->nodes, (b + 1) * blocks->nodes, &step->work->report[k].failure);
}

static mpm_status over_slots(mpmi_bound *bound, slots_fn fn) {
  slots_job job = {bound, fn};
  return mpmi_run_tasks(bound->step->settings, 0, bound->step->settings->tasks, slots_task, &job);
}

/* Adds the sums of followers to those of their master: a tie moves as one, component by component with its
 * sign. */
static void fold_task(void *data, int64_t k) {
  mpmi_bound *bound = data;
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  const mpmi_share share = mpmi_share_of(bound->step->settings, constraints->tie_count, k);
  for (int64_t i = share.begin; i < share.end; ++i) {
    const mpmi_tie *tie = &constraints->tie[i];
    mpmi_prescribed_sums *master = sums_at(bound->nodes, tie->master);
    for (int64_t d = tie->first; d < tie->first + tie->count; ++d) {
      const mpmi_follower *follower = &constraints->follower[d];
      if (!is_touched(bound, follower->slot) || !is_touched(bound, tie->master)) continue;
      const mpmi_prescribed_sums *sums = sums_at(bound->nodes, follower->slot);
      for (int32_t c = 0; c < bound->dim; ++c) {
        master->momentum[c] += follower->sign[c] * sums->momentum[c];
        master->mass[c] += sums->mass[c];
      }
    }
  }
}

/* Holds nodes that the host has not held: the host comes first. Across a wall on whose plane a node lies
 * particles and their images have the mean 0. */
static void hold_slots(mpmi_bound *bound, int64_t begin, int64_t end, mpmi_failure *failure) {
  const mpmi_blocks *blocks = &bound->step->layout->blocks;
  for (int64_t slot = begin; slot < end; ++slot)
    for (int32_t c = 0; c < bound->dim && mpmi_moves(bound, slot); ++c) {
      const mpmi_prescribed_sums *sums = sums_at(bound->nodes, slot);
      if (bound->nodes->held[slot][c] || !(sums->mass[c] > bound->step->layout->mass_cut)) continue;
      const double value =
          mpmi_is_own_image(mpmi_constraints_of(bound), slot, c) ? 0.0 : sums->momentum[c] / sums->mass[c];
      if (!isfinite(value))
        mpmi_failure_take(failure, mpmi_node_failure(MPM_NONFINITE, blocks, slot,
                                                     "velocity by prescribed particles not finite"));
      bound->nodes->held[slot][c] = MPMI_HELD_BY_PARTICLES;
      bound->nodes->held_value[slot][c] = value;
    }
}

mpm_status mpmi_prescribed_hold(mpmi_bound *bound) {
  mpmi_nodal sums = sums_of(bound->nodes);
  mpm_status status =
      mpmi_accumulate(bound->step, &(mpmi_accumulation){.to = &sums,
                                                        .give = give_block,
                                                        .fold = fold_task,
                                                        .user = bound,
                                                        .flags = bound->nodes->prescription.block,
                                                        .giving = MPMI_WITH_PRESCRIBED,
                                                        .receiving = MPMI_TOUCHED});
  if (!status) status = over_slots(bound, hold_slots);
  return status ? status : mpmi_step_failure(bound->step);
}

/* ---- their share of the impulses ---------------------------------------------------------------------- */
/* Replaces momentum by impulse over prescribed mass: here on nodes without ties; on the others
 * divide_of_tie() does it. */
static void divide_impulses(mpmi_bound *bound, int64_t begin, int64_t end, mpmi_failure *failure) {
  (void)failure;
  for (int64_t slot = begin; slot < end; ++slot)
    for (int32_t c = 0; c < bound->dim; ++c) {
      mpmi_prescribed_sums *sums = sums_at(bound->nodes, slot);
      const int32_t theirs = mpmi_constraints_of(bound)->tie_of[slot] < 0 &&
                             mpmi_held_by(bound->nodes, slot, c) == MPMI_HELD_BY_PARTICLES;
      sums->momentum[c] = theirs ? bound->nodes->impulse[slot].given[c] / sums->mass[c] : 0.0;
    }
}

static void divide_of_tie(mpmi_bound *bound, const mpmi_tie *tie, int32_t c) {
  const mpmi_follower *follower = tie->count ? mpmi_constraints_of(bound)->follower + tie->first : NULL;
  double total = bound->nodes->impulse[tie->master].given[c];
  for (int64_t d = 0; d < tie->count; ++d) total += bound->nodes->impulse[follower[d].slot].given[c];
  const double by_mass = total / sums_at(bound->nodes, tie->master)->mass[c];
  sums_at(bound->nodes, tie->master)->momentum[c] = by_mass;
  for (int64_t d = 0; d < tie->count; ++d)
    if (is_touched(bound, follower[d].slot)) sums_at(bound->nodes, follower[d].slot)->momentum[c] = by_mass;
}

static void ties_task(void *data, int64_t k) {
  mpmi_bound *bound = data;
  const mpmi_constraints *constraints = mpmi_constraints_of(bound);
  const mpmi_share share = mpmi_share_of(bound->step->settings, constraints->tie_count, k);
  for (int64_t i = share.begin; i < share.end; ++i)
    for (int32_t c = 0; c < bound->dim; ++c)
      if (mpmi_held_by(bound->nodes, constraints->tie[i].master, c) == MPMI_HELD_BY_PARTICLES)
        divide_of_tie(bound, &constraints->tie[i], c);
}

static void take_share(const visit *v, int64_t slot, const stencil *nodes) {
  const mpm_particles *set = v->member->set;
  const mpmi_step *step = v->bound->step;
  const double mass = mpmi_f64(set, MPMI_MASS, 0)[slot], *applied = step->work->rows.of[v->m].force;
  for (int32_t c = 0; c < v->bound->dim; ++c) {
    if (!mpmi_is_prescribed(set, slot, c)) continue;
    double force = mass * step->settings->desc.gravity[c], impulse = 0.0;
    if (applied) force += applied[c * set->ld + slot];
    for (int32_t n = 0; n < nodes->count; ++n) impulse += nodes->w[n] * v->tile[nodes->at[n]].momentum[c];
    v->part->impulse[c] += mass * impulse + step->velocity_dt * force;
  }
}

static void share_block(void *user, const mpmi_visit *at) {
  mpmi_bound *bound = user;
  const mpmi_step *step = bound->step;
  const mpmi_nodal sums = sums_of(bound->nodes);
  double *tile = step->work->scratch[at->task].tile;
  if (!mpmi_block_is(bound->nodes, at->block, MPMI_WITH_PRESCRIBED)) return;
  memset(mpmi_part_of(step->layout, bound->nodes, at->block, 0), 0,
         (size_t)step->layout->member_count * sizeof(mpmi_prescribed_part));
  mpmi_tile_use(step->settings->grid, tile, 8);
  mpmi_tile_load(step->settings->kernels, &step->layout->blocks, at->block, &sums, MPMI_TAKE_ALL, tile);
  visit_particles(bound, at->block, tile, take_share);
}

mpm_status mpmi_prescribed_share(mpmi_bound *bound) {
  const mpmi_settings *settings = bound->step->settings;
  void *user = bound;
  mpm_status status = over_slots(bound, divide_impulses);
  if (!status) status = mpmi_run_tasks(settings, 0, settings->tasks, ties_task, user);
  if (!status) status = mpmi_visit_blocks(bound->step, 0, share_block, user);
  return status;
}
