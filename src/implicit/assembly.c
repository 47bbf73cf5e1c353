/* Forces and stiffness of the particles on the nodes, for implicit steps. */
#include "implicit/surface_springs.h"
#include "layout/accumulate.h"
#include "layout/tile.h"
#include "layout/tasks.h"
#include "stages/stages.h"

#include <string.h>

/* ---- external forces ---------------------------------------------------------------------------------- */
static void give_external(void *user, const mpmi_visit *visit, double *tile) {
  const mpmi_balance *balance = user;
  const mpm_grid *grid = balance->settings->grid;
  const mpmi_force_scatter_fn kernel = balance->settings->kernels->force_scatter[grid->dim][grid->width];
  for (int32_t m = 0; m < balance->layout->member_count; ++m) {
    const int64_t *start = balance->layout->member[m].now.start + visit->block;
    if (start[0] == start[1]) continue;
    mpmi_force_scatter scatter = mpmi_force_scatter_of(balance, m, tile);
    mpmi_block_axes(grid, balance->layout->blocks.coord[visit->block], scatter.axis);
    kernel(&scatter, start[0], start[1] - start[0]);
  }
}

mpm_status mpmi_external_forces(mpmi_balance *balance) {
  return mpmi_accumulate(
      balance->step,
      &(mpmi_accumulation){.to = &balance->newton->external, .give = give_external, .user = balance});
}

/* ---- strain of given displacements -------------------------------------------------------------------- */
/* Spreads displacements over all nodes that move with a row, as mean velocities of the step. */
typedef struct spread_job {
  mpmi_balance *balance;
  const double *u;
} spread_job;

static void spread_task(void *data, int64_t k) {
  const spread_job *job = data;
  const mpmi_balance *balance = job->balance;
  const mpmi_newton *newton = balance->newton;
  const int32_t dim = balance->settings->grid->dim;
  const mpmi_share share = mpmi_share_of(balance->settings, newton->active_count, k);
  for (int64_t i = share.begin; i < share.end; ++i) {
    const mpmi_active_node *node = &newton->active[i];
    for (int32_t c = 0; c < dim; ++c)
      mpmi_velocity(&balance->nodes->solved, node->slot)[c] =
          node->sign[c] * (job->u[(int64_t)node->row * dim + c] / balance->step->dt);
  }
}

/* Gives the nodes the velocities of u, and averages the dilation that they make. */
static mpm_status begin_strain(mpmi_balance *balance, const double *u) {
  spread_job spread = {balance, u};
  mpmi_failures_clear(balance->step);
  mpm_status status = mpmi_run_tasks(balance->settings, 0, balance->settings->tasks, spread_task, &spread);
  if (!status && balance->settings->desc.locking_remedy) {
    /* the averages weigh with the volumes of the start of the step */
    mpmi_make_volumes(balance->layout, 0);
    status = mpmi_locking_stage(balance->step, balance->nodes, &balance->nodes->solved);
  }
  return status;
}

/* Lets all tasks begin a pass. */
static void begin_pass(mpmi_balance *balance, const mpmi_pass *pass) {
  for (int32_t k = 0; k < balance->settings->tasks; ++k)
    mpmi_pass_begin(&balance->newton->work[k].batch, balance->step, balance->nodes, &balance->nodes->solved,
                    pass, balance, k);
}

/* A pass that deforms the particles, for what it takes of them. */
#define STRAIN_PASS(taken)                                                                                   \
  {                                                                                                          \
    .deforms = 1, .bind = mpmi_strain_bind, .enter = mpmi_strain_enter, .aim = mpmi_strain_aim,              \
    .take = taken                                                                                            \
  }

/* Deforms the particles of a batch; returns 0 when that fails. */
static int32_t deform(mpmi_batch *b) {
  const mpmi_balance *balance = b->user;
  mpmi_gradient_keep(b);
  if (!mpmi_strain_deform(b)) return 0;
  if (mpmi_is_total_lagrangian(b->set->grid))
    mpmi_keep_whole_F(balance, b);
  else if (balance->settings->desc.locking_remedy) /* kept, because the remedy changes what the law sees */
    memcpy(balance->newton->work[b->task].F_inc, b->law.F_inc, (size_t)(9 * b->law.ld) * sizeof(double));
  return 1;
}

/* Computes the stress of a batch; then `add` puts its force or its stiffness on the nodes, where it is not
 * NULL. */
static void take(mpmi_batch *b, void (*add)(mpmi_balance *, mpmi_batch *)) {
  mpmi_balance *balance = b->user;
  if (!deform(b)) return;
  mpmi_strain_law(b);
  if (!b->law_ran) return;
  if (add) add(balance, b);
  mpmi_wave_speed_leave(b);
  mpmi_batch_sums(b, MPMI_SUMS_LAW);
}

static void take_stress(mpmi_batch *b) {
  take(b, NULL);
}

/* Averages pressures over cells where laws want it, by the stress of the nodes' displacements. */
static mpm_status find_pressures(mpmi_balance *balance) {
  static const mpmi_pass pass = STRAIN_PASS(take_stress);
  if (!mpmi_has_nodal_stress(balance->settings, balance->layout)) return MPM_OK;
  const mpm_status status =
      mpmi_pass_run(balance->step, balance->nodes, &balance->nodes->solved, &pass, balance);
  return status ? status : mpmi_cell_pressure_stage(balance->step, balance->nodes, 1);
}

/* ---- internal forces ---------------------------------------------------------------------------------- */
static void take_forces(mpmi_batch *b) {
  take(b, mpmi_add_forces);
}

/* Puts forces of the stress that the particles have already on the nodes. */
static void take_known_forces(mpmi_batch *b, int32_t copy) {
  if (!deform(b)) return;
  mpmi_law_batch_recall(&b->law, b->set, copy, b->begin, b->n);
  mpmi_add_forces(b->user, b);
}

/* The stress is that of the particles: a law would not know how fast they deform at the start. */
static void take_start_forces(mpmi_batch *b) {
  take_known_forces(b, 0);
}

static void take_new_forces(mpmi_batch *b) {
  take_known_forces(b, 1);
}

static void give_internal(void *user, const mpmi_visit *visit, double *tile) {
  mpmi_balance *balance = user;
  balance->newton->work[visit->task].tile = tile;
  mpmi_pass_block(&balance->newton->work[visit->task].batch, visit->block, visit->next);
}

static mpm_status sum_internal(mpmi_balance *balance, const mpmi_pass *pass) {
  begin_pass(balance, pass);
  mpm_status status =
      mpmi_accumulate(balance->step, &(mpmi_accumulation){.to = &balance->newton->force,
                                                          .give = give_internal,
                                                          .user = balance,
                                                          .calls_host = mpmi_has_host_law(balance->layout),
                                                          .gathers = 1});
  if (!status) status = mpmi_step_failure(balance->step);
  if (!status) status = mpmi_surface_loads_add(balance);
  if (status) return status;
  mpmi_unknowns_fold(balance, &balance->newton->force, balance->newton->vector[MPMI_INTERNAL]);
  return MPM_OK;
}

/* Where pressures are averaged, forces need the stress of all particles of a cell: they get a pass of their
 * own, which finds the deformation once more and leaves what the first one has summed up. */
mpm_status mpmi_internal_forces(mpmi_balance *balance, const double *u) {
  static const mpmi_pass at_once = STRAIN_PASS(take_forces);
  static const mpmi_pass again = {
      .bind = mpmi_strain_bind, .enter = mpmi_strain_enter, .aim = mpmi_strain_aim, .take = take_new_forces};
  mpm_status status = begin_strain(balance, u);
  if (!status) status = find_pressures(balance);
  if (!status)
    status =
        sum_internal(balance, mpmi_has_nodal_stress(balance->settings, balance->layout) ? &again : &at_once);
  int64_t exchanges = mpmi_force_exchanges(balance);
  if (mpmi_springs_lack_stiffness(balance)) {
    if ((status = mpmi_vote(balance, status, exchanges))) return status;
    status = mpmi_springs_begin(balance);
    exchanges = 0;
  }
  if (!status) mpmi_springs_pull(balance);
  return mpmi_vote(balance, status, exchanges);
}

mpm_status mpmi_start_forces(mpmi_balance *balance) {
  static const mpmi_pass pass = STRAIN_PASS(take_start_forces);
  double *u = balance->newton->vector[MPMI_U];
  memset(u, 0, (size_t)(balance->newton->matrix.rows * balance->settings->grid->dim) * sizeof *u);
  mpm_status status = begin_strain(balance, u);
  if (!status && mpmi_has_nodal_stress(balance->settings, balance->layout))
    status = mpmi_cell_pressure_stage(balance->step, balance->nodes, 0);
  return status ? status : sum_internal(balance, &pass);
}

/* ---- stiffness ---------------------------------------------------------------------------------------- */
static void take_stiffness(mpmi_batch *b) {
  take(b, mpmi_add_stiffness);
}

static void clear_matrix_task(void *data, int64_t k) {
  const mpmi_balance *balance = data;
  const mpmi_matrix *A = &balance->newton->matrix;
  mpmi_clear_share(balance->settings, A->value, A->row_start[A->rows], (int64_t)A->block * A->block, k);
}

/* Returns 1 when the tile of a block reaches over the end of a periodic axis. */
static int32_t is_at_seam(const mpmi_balance *balance, int64_t block) {
  const mpm_grid *grid = balance->settings->grid;
  const mpmi_blocks *blocks = &balance->layout->blocks;
  for (int32_t k = 0; k < grid->dim; ++k) {
    const int64_t first = (int64_t)blocks->coord[block][k] * blocks->edge - MPMI_RING - grid->below;
    const int64_t end = first + MPMI_TILE_EDGE(grid->dim, grid->width);
    if (grid->desc.periodic[k] && (first < 0 || end > grid->desc.cells[k])) return 1;
  }
  return 0;
}

static void add_block(mpmi_balance *balance, const mpmi_visit *visit) {
  mpmi_newton_work *work = &balance->newton->work[visit->task];
  mpmi_tile_of_unknowns(balance, visit->block, work->tile_active);
  mpmi_pass_block(&work->batch, visit->block, visit->next);
}

static void add_inner(void *user, const mpmi_visit *visit) {
  if (!is_at_seam(user, visit->block)) add_block(user, visit);
}

static void add_at_seam(void *user, const mpmi_visit *visit) {
  if (is_at_seam(user, visit->block)) add_block(user, visit);
}

static mpm_status add_all(mpmi_balance *balance) {
  static const mpmi_pass pass = STRAIN_PASS(take_stiffness);
  begin_pass(balance, &pass);
  const mpm_status status =
      mpmi_visit_colours(balance->step, mpmi_has_host_law(balance->layout), add_inner, balance);
  if (status) return status;
  /* images add to rows of masters in any block: blocks at a seam come one by one */
  mpmi_visit_in_turn(balance->step, add_at_seam, balance);
  return mpmi_step_failure(balance->step);
}

/* ---- with other parts ---------- */
static void take_record(mpmi_batch *b) {
  take(b, mpmi_shared_stiffness_record);
}

static void record_block(void *user, const mpmi_visit *visit) {
  mpmi_balance *balance = user;
  mpmi_pass_block(&balance->newton->work[visit->task].batch, visit->block, visit->next);
}

typedef struct colour_job {
  mpmi_balance *balance;
  int32_t colour;
} colour_job;

/* Adds what is recorded of the blocks of one colour that are at no seam; task k takes its share. */
static void add_recorded_task(void *data, int64_t k) {
  const colour_job *job = data;
  const mpmi_blocks *blocks = &job->balance->layout->blocks;
  const mpmi_share share = mpmi_share_of(job->balance->settings, blocks->count, k);
  for (int64_t i = share.begin; i < share.end; ++i)
    if (mpmi_colour_of(blocks->grid->dim, blocks->coord[i]) == job->colour && !is_at_seam(job->balance, i))
      mpmi_shared_stiffness_add(job->balance, (int32_t)k, i);
}

/* Adds the stiffness of own blocks and ghosts at the seam, in the order of one part. */
static void add_seam_in_turn(mpmi_balance *balance) {
  const mpmi_parts *parts = balance->layout->parts;
  for (int64_t i = 0; i < balance->layout->blocks.count; ++i) {
    if (!is_at_seam(balance, i)) continue;
    if (parts->is_inner[i])
      add_block(balance, &(mpmi_visit){0, i, -1});
    else
      mpmi_shared_stiffness_add(balance, 0, i);
  }
}

/* The particles at the edge come first, whose stiffness the partners get; then all is added in the order of
 * one part. */
static mpm_status add_with_others(mpmi_balance *balance, mpm_status status, int64_t exchanges) {
  static const mpmi_pass record = STRAIN_PASS(take_record), inner = STRAIN_PASS(take_stiffness);
  const mpmi_parts *parts = balance->layout->parts;
  const int32_t calls_host = mpmi_has_host_law(balance->layout), tasks = balance->settings->tasks;
  if (!status) status = mpmi_shared_stiffness_begin(balance);
  if (!status) begin_pass(balance, &record);
  if (!status)
    status = mpmi_visit_marked(balance->step, parts->is_boundary, calls_host, record_block, balance);
  if (!status) status = mpmi_step_failure(balance->step);
  if ((status = mpmi_vote(balance, status, exchanges)) || (status = mpmi_shared_stiffness_exchange(balance)))
    return status;
  begin_pass(balance, &inner);
  for (int32_t c = 0; c < MPMI_COLOURS && !status; ++c) {
    colour_job job = {balance, c};
    status = mpmi_visit_colour(balance->step, parts->is_inner, c, calls_host, add_inner, balance);
    if (!status) status = mpmi_run_tasks(balance->settings, 0, tasks, add_recorded_task, &job);
  }
  if (!status) add_seam_in_turn(balance);
  return status ? status : mpmi_step_failure(balance->step);
}

/* Returns how many exchanges of tiles come before the stiffness is added. */
static int64_t stiffness_exchanges(const mpmi_balance *balance) {
  const int64_t strain = balance->settings->desc.locking_remedy != 0;
  return strain + (mpmi_has_nodal_stress(balance->settings, balance->layout) ? 1 + strain : 0);
}

mpm_status mpmi_stiffness(mpmi_balance *balance, const double *u) {
  mpmi_newton *newton = balance->newton;
  const int32_t tasks = balance->settings->tasks, remedy = balance->settings->desc.locking_remedy;
  mpm_status status = mpmi_run_tasks(balance->settings, 0, tasks, clear_matrix_task, balance);
  if (!status && remedy) status = mpmi_locking_stiffness_begin(balance);
  for (int32_t k = 0; k < tasks; ++k) newton->work[k].symmetric = 1;
  if (!status) status = begin_strain(balance, u);
  if (!status && mpmi_has_nodal_stress(balance->settings, balance->layout)) {
    status = find_pressures(balance);
    if (!status) status = begin_strain(balance, u); /* the sums held pressures meanwhile */
  }
  if (balance->layout->parts)
    status = add_with_others(balance, status, stiffness_exchanges(balance));
  else if (!status)
    status = add_all(balance);
  if ((status = mpmi_vote(balance, status, 0))) return status;
  double unsymmetric = 0.0;
  for (int32_t k = 0; k < tasks; ++k) unsymmetric += !newton->work[k].symmetric;
  if ((status = mpmi_largest_of_parts(balance, 1, &unsymmetric))) return status;
  newton->matrix.symmetric = !(unsymmetric > 0.0);
  if (remedy) mpmi_locking_stiffness_end(balance);
  return mpmi_surface_loads_stiffen(balance);
}
