/* Nodes to particles, block by block: velocity, position, deformation gradient, volume, stress. Reads copy 0
 * of the particles' fields and writes copy 1; only volume has one copy, and mpmi_roll_back makes it again. */
#include "stepper/locking.h"
#include "stepper/newton.h"

#include <math.h>
#include <string.h>

typedef struct g2p_job {
  mpm_stepper *s;
  int32_t what, values, form, need;
  int32_t starts_sums; /* of energies: not the pass that completes those of another */
  const mpmi_cut *cut;
  int32_t seam; /* of passes that add stiffness: the blocks at periodic seams, or the others */
  double dt;
  const double *nodes;
} g2p_job;

/* Reading the clock costs as much as the law of a few particles: one batch in so many stands for all. */
enum { TIMED_BATCHES = 16 };

/* Passes that add to nodes: by colours. */
enum { ASSEMBLES = MPMI_G2P_FORCES | MPMI_G2P_STIFFNESS };

/* One batch of one set in one block, with everything that the kernels are given. */
typedef struct batch_job {
  const g2p_job *job;
  mpmi_scratch *scratch;
  mpm_particles *set;
  int32_t m, task;
  mpmi_law_batch law;
  mpmi_gather gather;
  mpmi_move move;
  mpmi_deform deform;
  mpmi_sums_job sums;
  double *v_bar, *dv, *C;
  int64_t batches, block;
  int32_t law_ran; /* on the batch at hand: its stress is that of this step */
} batch_job;

static double *component(const mpm_particles *set, int32_t field, int32_t copy, int32_t c) {
  return mpmi_f64(set, field, copy) + c * set->ld;
}

/* What a batch reads and writes, for prefetching. */
static void add_streams(mpmi_streams *streams, const mpm_particles *set, int32_t field, int32_t copy) {
  const mpmi_field *f = &set->field[field];
  for (int32_t c = 0; f->present && c < f->components && streams->count < MPMI_MAX_STREAMS; ++c)
    streams->at[streams->count++] = component(set, field, copy, c);
}

static void bind_streams(batch_job *b) {
  mpmi_streams *streams = &b->gather.streams;
  streams->count = 0;
  add_streams(streams, b->set, MPMI_POSITION, 0);
  add_streams(streams, b->set, MPMI_INITIAL_VOLUME, 0);
  if (b->job->what & MPMI_G2P_MOVE) {
    add_streams(streams, b->set, MPMI_VELOCITY, 0);
    add_streams(streams, b->set, MPMI_POSITION, 1);
    add_streams(streams, b->set, MPMI_VELOCITY, 1);
    add_streams(streams, b->set, MPMI_L, 1);
  }
  if (b->job->what & MPMI_G2P_DEFORM) {
    add_streams(streams, b->set, MPMI_F, 0);
    add_streams(streams, b->set, MPMI_F, 1);
    add_streams(streams, b->set, MPMI_VOLUME, 0);
    add_streams(streams, b->set, MPMI_MASS, 0);
    add_streams(streams, b->set, MPMI_STRESS, 1);
    if (!mpmi_material_stress_from_F(b->set->material)) add_streams(streams, b->set, MPMI_STRESS, 0);
  }
}

static void bind_set(batch_job *b, int32_t m) {
  const mpm_stepper *s = b->job->s;
  const mpm_grid *grid = s->grid;
  mpm_particles *set = s->member[m].set;
  const int32_t dim = grid->dim;
  b->m = m;
  b->set = set;
  mpmi_law_batch_bind(&b->law, set->material, b->scratch->batch_memory);
  const int64_t ld = b->law.ld;
  b->v_bar = b->scratch->gathered;
  b->dv = b->v_bar + 3 * ld;
  b->C = b->dv + 3 * ld;
  memset(b->scratch->gathered, 0, (size_t)(15 * ld) * sizeof(double));
  b->gather = (mpmi_gather){.weights = s->kernels->weights[grid->family][dim],
                            .points = mpmi_points_of(set, 0),
                            .need = b->job->need,
                            .initial_volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0),
                            .tile = b->scratch->tile,
                            .ld = ld,
                            .v = b->v_bar,
                            .dv = b->dv,
                            .L = b->law.L,
                            .C = b->C};
  bind_streams(b);
  const int32_t blends = mpmi_is_blend(s) && !s->desc.quasi_static;
  b->move = (mpmi_move){.rule = blends             ? MPMI_MOVE_BLEND
                                : mpmi_corrects(s) ? MPMI_MOVE_CORRECT
                                                   : MPMI_MOVE_SET,
                        .dt = b->job->dt,
                        .flip = mpmi_flip_share(s),
                        .lag = s->desc.position_order == 2 && !mpmi_is_implicit(s) ? 0.5 : 0.0,
                        .ld = ld,
                        .v_bar = b->v_bar,
                        .dv = b->dv};
  b->deform = (mpmi_deform){.dt = b->job->dt,
                            .ld = ld,
                            .L = b->law.L,
                            .F = b->law.F,
                            .F_inc = set->material->law && !mpmi_is_implicit(s) ? NULL : b->law.F_inc};
  b->sums = (mpmi_sums_job){.ld = ld,
                            .wave_speed = b->law.wave_speed,
                            .kinematic_viscosity = b->law.viscosity,
                            .energy = b->law.energy,
                            .viscous_factor = 2.0 * dim / (grid->h_min * grid->h_min),
                            .checked = {b->law.stress_new, b->law.state_new},
                            .checked_rows = {mpmi_stress_components(dim), set->material->state_count}};
  for (int32_t k = 0; k < dim; ++k) {
    const double length = grid->upper[k] - grid->desc.origin[k];
    const int32_t periodic = grid->desc.periodic[k] != 0;
    b->move.low[k] = grid->desc.origin[k];
    b->move.high[k] = grid->upper[k];
    b->move.period[k] = b->sums.period[k] = periodic ? length : 0.0;
    b->move.inverse_period[k] = b->sums.inverse_period[k] = periodic ? 1.0 / length : 0.0;
    b->sums.gravity[k] = s->desc.gravity[k];
    b->sums.inverse_spacing[k] = grid->inverse_spacing[k];
  }
}

/* Where the particles of a block may be before they have to be sorted anew, less a hair for rounding. */
static void bind_block(batch_job *b, int64_t block) {
  const mpm_stepper *s = b->job->s;
  const mpm_grid *grid = s->grid;
  const int32_t edge = s->blocks.edge;
  b->block = block;
  mpmi_block_axes(grid, s->blocks.coord[block], b->gather.axis);
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double first = (double)s->blocks.coord[block][k] * edge;
    const double centre = first + 0.5 * (edge - grid->centred);
    b->move.centre[k] = grid->desc.origin[k] + grid->desc.spacing[k] * centre;
    b->move.half[k] = grid->desc.spacing[k] * (0.5 * edge + MPMI_RING) * (1.0 - 1e-9);
  }
}

static void fail(batch_job *b, mpm_status cause, int64_t slot, const char *what) {
  mpmi_failure_take(&b->scratch->failure,
                    &(mpmi_failure){cause, 0, b->m, mpmi_i64(b->set, MPMI_ID, 0)[slot], -1, what});
}

/* Periods that a particle may cross in one step: beyond them its position is rounding. */
#define MOST_TURNS 2147483648.0

/* A particle on a wall stands there but for rounding; this many cells beyond it are that. */
#define WALL_ROUNDING 1e-12

static int32_t is_on_wall(const mpm_stepper *s, int32_t k, double *x) {
  const mpm_grid *grid = s->grid;
  const int32_t above = *x > grid->upper[k];
  const double face = above ? grid->upper[k] : grid->desc.origin[k];
  if (s->wall[2 * k + above].kind < MPM_WALL_FIXED) return 0;
  if (!(fabs(*x - face) <= WALL_ROUNDING * grid->desc.spacing[k])) return 0;
  *x = face;
  return 1;
}

static int32_t is_placed(const mpm_particles *set, int32_t dim, int64_t slot) {
  int32_t placed = 1;
  for (int32_t k = 0; k < dim; ++k) placed &= isfinite(component(set, MPMI_POSITION, 1, k)[slot]) != 0;
  return placed;
}

/* Particles beyond a face: wrapped, marked for removal, or the end of the step. */
static void look_outside(batch_job *b, int64_t begin, int64_t n) {
  const mpm_stepper *s = b->job->s;
  const mpm_grid *grid = s->grid;
  const int64_t *id = mpmi_i64(b->set, MPMI_ID, 0);
  for (int64_t slot = begin; slot < begin + n; ++slot) {
    if (id[slot] < 0 || !is_placed(b->set, grid->dim, slot)) continue; /* look_at_values will say */
    int32_t stays = 0, leaves = 0;
    for (int32_t k = 0; k < grid->dim; ++k) {
      double *x = component(b->set, MPMI_POSITION, 1, k) + slot;
      if (*x >= grid->desc.origin[k] && *x <= grid->upper[k]) continue;
      if (grid->desc.periodic[k]) {
        int64_t *image = mpmi_i64(b->set, MPMI_IMAGE, 1) + k * b->set->ld + slot;
        const double length = grid->upper[k] - grid->desc.origin[k];
        const double turns = floor((*x - grid->desc.origin[k]) / length);
        if (fabs(turns) >= MOST_TURNS) {
          stays = 1;
          continue;
        }
        *x -= turns * length;
        if (*x < grid->desc.origin[k]) *x = grid->desc.origin[k];
        if (*x > grid->upper[k]) *x = grid->upper[k];
        *image += (int64_t)turns;
      } else if (s->wall[2 * k + (*x > grid->upper[k])].kind == MPM_WALL_OPEN) {
        leaves = 1;
      } else if (!is_on_wall(s, k, x)) {
        stays = 1;
      }
    }
    if (stays)
      fail(b, MPM_OFF_GRID, slot, "a particle would leave the grid");
    else if (leaves)
      b->scratch->removes = 1;
  }
}

static int32_t finite_row(const mpm_particles *set, int32_t field, int32_t components, int64_t slot) {
  for (int32_t c = 0; c < components; ++c)
    if (!isfinite(component(set, field, 1, c)[slot])) return 0;
  return 1;
}

/* A hole weighs nothing, but nodes near it that are not finite make it so: it stays what it was. */
static void restore_hole(batch_job *b, int64_t slot) {
  mpm_particles *set = b->set;
  b->scratch->holes_restored = 1;
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

/* Finds the particles behind a flag. */
static void look_at_values(batch_job *b, int64_t begin, int64_t n) {
  const mpm_particles *set = b->set;
  const int32_t dim = b->job->s->grid->dim;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  const int32_t moved = b->job->what & MPMI_G2P_MOVE, deformed = b->job->what & MPMI_G2P_DEFORM;
  for (int64_t slot = begin; slot < begin + n; ++slot) {
    if (id[slot] < 0) {
      restore_hole(b, slot);
      continue;
    }
    const int64_t p = slot - begin;
    if (moved && !(finite_row(set, MPMI_POSITION, dim, slot) && finite_row(set, MPMI_VELOCITY, dim, slot)))
      fail(b, MPM_NONFINITE, slot, "position or velocity not finite");
    else if (deformed && !finite_row(set, MPMI_F, mpmi_tensor_components(dim), slot))
      fail(b, MPM_NONFINITE, slot, "deformation gradient not finite");
    else if (deformed && !(mpmi_f64(set, MPMI_VOLUME, 0)[slot] > 0.0))
      fail(b, MPM_INVERTED, slot, "det F is not positive");
    else if (b->law_ran && !(finite_row(set, MPMI_STRESS, mpmi_stress_components(dim), slot) &&
                             finite_row(set, MPMI_STATE, set->material->state_count, slot) &&
                             isfinite(b->law.wave_speed[p]) && isfinite(b->law.viscosity[p])))
      fail(b, MPM_NONFINITE, slot, "the material's stress, state or wave speed is not finite");
  }
}

/* From gathered dt a1 to what Newmark's rule adds to the velocities. */
static void mean_accelerations(batch_job *b, int64_t begin, int64_t n) {
  const mpm_stepper *s = b->job->s;
  const double dt = b->job->dt, gamma = s->desc.newmark_gamma;
  for (int32_t k = 0; k < s->grid->dim; ++k) {
    double *a = component(b->set, MPMI_ACCELERATION, 1, k) + begin, *dv = b->dv + k * b->law.ld;
    for (int64_t p = 0; p < n; ++p) {
      const double new = dv[p] / dt;
      dv[p] = dt * (1.0 - gamma) * a[p] + gamma * dv[p];
      a[p] = new;
    }
  }
}

static uint32_t move_batch(batch_job *b, int64_t begin, int64_t n) {
  mpm_stepper *s = b->job->s;
  mpm_particles *set = b->set;
  for (int32_t k = 0; k < s->grid->dim; ++k) {
    b->move.x_old[k] = component(set, MPMI_POSITION, 0, k) + begin;
    b->move.v_old[k] = component(set, MPMI_VELOCITY, 0, k) + begin;
    b->move.x_new[k] = component(set, MPMI_POSITION, 1, k) + begin;
    b->move.v_new[k] = component(set, MPMI_VELOCITY, 1, k) + begin;
    if (set->field[MPMI_IMAGE].present)
      memcpy(mpmi_i64(set, MPMI_IMAGE, 1) + k * set->ld + begin,
             mpmi_i64(set, MPMI_IMAGE, 0) + k * set->ld + begin, (size_t)n * sizeof(int64_t));
  }
  if (mpmi_is_implicit(s)) mean_accelerations(b, begin, n);
  uint32_t flags = s->kernels->move[s->grid->dim](&b->move, n);
  if (s->member[b->m].prescribed) flags |= mpmi_prescribed_move(s, b->m, b->block, &b->move, begin, n);
  if (flags & MPMI_LEFT_TILE) b->scratch->left_tile = 1;
  if (flags & MPMI_OUTSIDE) look_outside(b, begin, n);
  if (set->field[MPMI_ACCELERATION].present && !mpmi_is_implicit(s))
    for (int32_t k = 0; k < s->grid->dim; ++k)
      for (int64_t p = 0; p < n; ++p)
        component(set, MPMI_ACCELERATION, 1, k)[begin + p] =
            (b->move.v_new[k][p] - b->move.v_old[k][p]) / s->velocity_dt;
  return flags & MPMI_NONFINITE;
}

/* What an affine transfer carries comes with the velocities; otherwise the velocity gradient of the strain is
 * kept where the host wants it. */
static void store_gradient(batch_job *b, int64_t begin, int64_t n) {
  const mpm_stepper *s = b->job->s;
  const int32_t dim = s->grid->dim;
  if (!b->set->field[MPMI_L].present) return;
  if (!(b->job->what & (mpmi_is_affine(s) ? MPMI_G2P_MOVE : MPMI_G2P_DEFORM))) return;
  const int32_t moment = b->job->form == MPMI_GATHER_4_AFFINE || b->job->form == MPMI_GATHER_8_AFFINE;
  const double *from = moment ? b->C : b->law.L;
  for (int32_t c = 0; c < mpmi_gradient_components(dim); ++c)
    memcpy(component(b->set, MPMI_L, 1, c) + begin, from + mpmi_gradient_map(dim)[c] * b->law.ld,
           (size_t)n * sizeof(double));
}

static uint32_t deform_batch(batch_job *b, int64_t begin, int64_t n) {
  mpm_stepper *s = b->job->s;
  mpm_particles *set = b->set;
  const int32_t dim = s->grid->dim, stored = mpmi_tensor_components(dim);
  const double *F[9];
  for (int32_t c = 0; c < stored; ++c) {
    b->deform.F_old[c] = component(set, MPMI_F, 0, c) + begin;
    b->deform.F_new[c] = component(set, MPMI_F, 1, c) + begin;
    F[c] = b->deform.F_new[c];
  }
  mpmi_law_batch_load(&b->law, set, begin, n, s->t + b->job->dt, b->job->dt);
  s->kernels->deform[mpmi_material_kinematics(set->material)][dim](&b->deform, n);
  uint32_t flags = s->kernels->volume[dim](F, mpmi_f64(set, MPMI_INITIAL_VOLUME, 0) + begin,
                                           mpmi_f64(set, MPMI_VOLUME, 0) + begin, n);
  if (flags) return flags;
  if (s->desc.locking_remedy && (b->job->what & ASSEMBLES))
    memcpy(s->newton->work[b->task].F_inc, b->law.F_inc, (size_t)(9 * b->law.ld) * sizeof(double));
  if (s->desc.locking_remedy)
    mpmi_locking_apply(s, b->scratch->cells, b->gather.axis, set, &b->law, begin, n, b->job->dt);
  const int32_t timed = s->profiled && b->batches++ % TIMED_BATCHES == 0;
  const double started = timed ? mpmi_seconds() : 0.0;
  const mpm_status status = mpmi_law_batch_run(&b->law, set);
  if (timed) b->scratch->law_seconds += TIMED_BATCHES * (mpmi_seconds() - started);
  if (status) {
    mpmi_failure_take(&b->scratch->failure, &(mpmi_failure){mpmi_callback_cause(status), status, b->m, -1, -1,
                                                            "the material callback"});
    return 0;
  }
  mpmi_law_batch_store(&b->law, set, 1, begin, n);
  b->law_ran = 1;
  if (b->job->what & ASSEMBLES)
    mpmi_assemble_batch(s, b->task, b->job->what, b->m, &b->law, b->gather.axis, begin, n);
  return 0;
}

/* Of the law's outputs; of the motion once all of the particle's new values are there. */
static uint32_t sum_batch(batch_job *b, int32_t what, int64_t begin, int64_t n, mpmi_sums *sums) {
  const mpm_stepper *s = b->job->s;
  mpm_particles *set = b->set;
  b->sums.what = what;
  const mpmi_member *member = &s->member[b->m];
  const int32_t dim = s->grid->dim;
  mpmi_sums_job *job = &b->sums;
  job->mass = mpmi_f64(set, MPMI_MASS, 0) + begin;
  job->initial_volume = mpmi_f64(set, MPMI_INITIAL_VOLUME, 0) + begin;
  for (int32_t k = 0; k < dim; ++k) {
    job->x[k] = component(set, MPMI_POSITION, 1, k) + begin;
    job->v[k] = component(set, MPMI_VELOCITY, 1, k) + begin;
    job->x_old[k] = component(set, MPMI_POSITION, 0, k) + begin;
    job->force[k] = member->force ? member->force + k * set->ld + begin : NULL;
  }
  if (mpmi_is_affine(s) && (what & MPMI_SUMS_MOTION)) {
    mpmi_sums_moments(s, set, 1, begin, n, b->law.ld, b->C, job); /* C is stored, its buffer free */
    for (int32_t c = 0; c < mpmi_gradient_components(dim); ++c)
      job->affine[mpmi_gradient_map(dim)[c]] = component(set, MPMI_L, 1, c) + begin;
  }
  return s->kernels->sums[dim](job, n, sums);
}

/* What the nodes hold, as a particle's velocity or acceleration. */
static void take_means(batch_job *b, int32_t field, int64_t begin, int64_t n) {
  for (int32_t k = 0; k < b->job->s->grid->dim; ++k)
    memcpy(component(b->set, field, 1, k) + begin, b->v_bar + k * b->law.ld, (size_t)n * sizeof(double));
}

/* USF and implicit steps ask the law before particles move, and the sums over the motion need the
 * wave speed: it waits where the new position will be. */
static void leave_wave_speed(batch_job *b, int64_t begin, int64_t n) {
  memcpy(component(b->set, MPMI_POSITION, 1, 0) + begin, b->law.wave_speed, (size_t)n * sizeof(double));
}
static void take_wave_speed(batch_job *b, int64_t begin, int64_t n) {
  memcpy(b->law.wave_speed, component(b->set, MPMI_POSITION, 1, 0) + begin, (size_t)n * sizeof(double));
}

static void one_batch(batch_job *b, int64_t begin, int64_t n, mpmi_sums *sums) {
  const mpm_stepper *s = b->job->s;
  const int32_t what = b->job->what;
  uint32_t flags = 0;
  const int32_t first = mpmi_deforms_first(s);
  b->law_ran = 0;
  s->kernels->gather[s->grid->dim][s->grid->width][b->job->form](&b->gather, begin, n);
  /* the kernels write from the start of the batch's buffers */
  if (what & MPMI_G2P_PROBE) take_means(b, MPMI_VELOCITY, begin, n);
  if ((what & MPMI_G2P_ACCELERATION) && (b->set->dirty & MPMI_DIRTY_ACCELERATION))
    take_means(b, MPMI_ACCELERATION, begin, n);
  if (what & MPMI_G2P_DILATION) mpmi_locking_measure(s, b->set, b->law.L, b->law.ld, begin, n, b->job->dt);
  if (!(what & (MPMI_G2P_MOVE | MPMI_G2P_DEFORM))) return;
  if (mpmi_is_mls(s) && b->job->form == MPMI_GATHER_8_AFFINE) /* there C is the gradient too */
    memcpy(b->law.L, b->C, (size_t)(9 * b->law.ld) * sizeof(double));
  if (first && (what & MPMI_G2P_MOVE)) take_wave_speed(b, begin, n);
  if (what & MPMI_G2P_MOVE) flags |= move_batch(b, begin, n);
  store_gradient(b, begin, n);
  if (what & MPMI_G2P_DEFORM) flags |= deform_batch(b, begin, n);
  if (first && b->law_ran) leave_wave_speed(b, begin, n);
  const int32_t moved = first ? what & MPMI_G2P_MOVE : b->law_ran;
  const int32_t summed = (b->law_ran ? MPMI_SUMS_LAW : 0) | (moved ? MPMI_SUMS_MOTION : 0);
  if (summed) flags |= sum_batch(b, summed, begin, n, sums);
  if (flags) look_at_values(b, begin, n);
}

static void g2p_task(void *data, int64_t k) {
  const g2p_job *job = data;
  mpm_stepper *s = job->s;
  const mpmi_cut *cut = job->cut;
  batch_job b = {.job = job, .task = (int32_t)k, .scratch = &s->scratch[k]};
  int32_t bound = -1;
  for (int64_t i = cut->bound[k]; i < cut->bound[k + 1]; ++i) {
    const int32_t block = cut->list[i];
    if ((job->what & MPMI_G2P_STIFFNESS) && mpmi_at_seam(s, block) != job->seam) continue;
    mpmi_sums *sums = &s->block_sums[block];
    if (job->starts_sums) memset(sums, 0, sizeof *sums);
    mpmi_tile_load(s, block, job->nodes, job->values, job->form >= MPMI_GATHER_8 ? 8 : 4, b.scratch->tile);
    if (s->desc.locking_remedy && (job->what & MPMI_G2P_DEFORM))
      mpmi_tile_load(s, block, s->extra, 4, 4, b.scratch->cells);
    if (job->what & ASSEMBLES) mpmi_assemble_begin(s, b.task, job->what, block);
    for (int32_t m = 0; m < s->member_count; ++m) {
      const int64_t *start = s->member[m].now.start;
      if (start[block] == start[block + 1]) continue;
      if (m != bound) bind_set(&b, m);
      bound = m;
      bind_block(&b, block);
      const int64_t slots = start[block + 1] - start[block];
      for (int64_t p = 0; p < slots; p += b.law.ld) {
        const int64_t left = slots - p, n = left < b.law.ld ? left : b.law.ld;
        /* the nodes of the next block, share by share */
        if (m == 0 && i + 1 < cut->bound[k + 1])
          mpmi_tile_fetch(s, cut->list[i + 1], job->nodes, job->values,
                          (int32_t)(s->blocks.neighbours * p / slots),
                          (int32_t)(s->blocks.neighbours * (p + n) / slots));
        one_batch(&b, start[block] + p, n, sums);
      }
      mpmi_sample_weights(s, b.scratch, b.gather.axis, job->need, &b.gather.points, start[block],
                          start[block + 1]);
    }
    if (job->what & ASSEMBLES) mpmi_assemble_end(s, b.task, job->what, block);
  }
}

static int32_t has_host_law(const mpm_stepper *s) {
  for (int32_t m = 0; m < s->member_count; ++m)
    if (!s->member[m].set->material->law) return 1;
  return 0;
}

/* Increments are needed by blends and by second-order positions; C by transfers that carry it. */
static void choose_form(g2p_job *job) {
  const mpm_stepper *s = job->s;
  const int32_t move = job->what & MPMI_G2P_MOVE;
  const int32_t increments = move && (mpmi_is_blend(s) || s->desc.position_order == 2);
  const int32_t matrix = move && mpmi_is_affine(s) && !mpmi_is_taylor(s);
  if (mpmi_is_mls(s) && !increments && !(job->what & MPMI_G2P_PROBE)) {
    job->form = MPMI_GATHER_4_MLS;
    return;
  }
  job->need = MPMI_NEED_GRADIENT | (matrix ? MPMI_NEED_MOMENT : 0);
  if (increments)
    job->form = matrix ? MPMI_GATHER_8_AFFINE : MPMI_GATHER_8;
  else
    job->form = matrix ? MPMI_GATHER_4_AFFINE : MPMI_GATHER_4;
}

mpm_status mpmi_stage_g2p(mpm_stepper *s, int32_t what, const double *nodes, int32_t values, double dt) {
  g2p_job job = {.s = s, .what = what, .dt = dt, .nodes = nodes, .values = values};
  job.starts_sums = (what & (mpmi_deforms_first(s) ? MPMI_G2P_DEFORM : MPMI_G2P_MOVE | MPMI_G2P_DEFORM));
  choose_form(&job);
  /* rows of images are written at their masters', anywhere: these blocks come one by one */
  int64_t whole[] = {0, s->cut.count};
  const mpmi_cut all = {s->cut.list, s->cut.count, whole};
  mpm_status status = MPM_OK;
  for (int32_t c = 0; c < (what & ASSEMBLES ? (int32_t)MPMI_COLOURS : 1) && !status; ++c) {
    job.cut = what & ASSEMBLES ? &s->colour[c] : &s->cut;
    if (job.cut->count) status = mpmi_run_tasks(s, has_host_law(s), s->tasks, g2p_task, &job);
  }
  job.seam = 1;
  job.cut = &all;
  if ((what & MPMI_G2P_STIFFNESS) && !status) status = mpmi_run_tasks(s, has_host_law(s), 1, g2p_task, &job);
  return status ? status : mpmi_stepper_failure(s);
}
