/* Motion: velocity and position of particles from what a batch has gathered, by the kernels of
 * transfer/move.c (MPoint theory eqs 34 to 37). */
#include "stages/batch.h"
#include "stages/stages.h"
#include "boundary/prescribed.h"

#include <float.h>
#include <math.h>
#include <string.h>

void mpmi_motion_bind(mpmi_batch *b) {
  const mpmi_settings *settings = b->step->settings;
  const mpm_grid *grid = settings->grid;
  const int32_t blends = b->step->takes == MPMI_TAKES_BLEND && mpmi_is_dynamic(settings);
  const int32_t places = b->pass->places;
  const int32_t free = mpmi_is_total_lagrangian(grid); /* the reference positions are what stays inside */
  const int32_t rule = places                   ? MPMI_MOVE_PLACE
                       : blends                 ? MPMI_MOVE_BLEND
                       : mpmi_corrects(b->step) ? MPMI_MOVE_CORRECT
                                                : MPMI_MOVE_SET;
  const int32_t lags = settings->desc.position_order == 2 && !mpmi_is_implicit(settings) && !places;
  b->move = (mpmi_move){.rule = rule,
                        .stays = mpmi_moves_last(settings) && !places,
                        .dt = b->step->dt,
                        .flip = mpmi_flip_share(b->step),
                        .lag = lags ? 0.5 : 0.0,
                        .ld = b->law.ld,
                        .v_bar = b->v_bar,
                        .dv = b->dv};
  for (int32_t k = 0; k < grid->dim; ++k) {
    const double length = grid->upper[k] - grid->desc.origin[k];
    const int32_t periodic = grid->desc.periodic[k] != 0;
    b->move.low[k] = free ? -(double)INFINITY : grid->desc.origin[k];
    b->move.high[k] = free ? (double)INFINITY : grid->upper[k];
    b->move.period[k] = periodic ? length : 0.0;
    b->move.inverse_period[k] = periodic ? 1.0 / length : 0.0;
  }
  if (mpmi_is_implicit(settings)) return;
  b->gather.move = &b->move;
  b->gather.v = NULL;
}

/* Sets where particles may be before it is found anew where they are. */
void mpmi_motion_enter(mpmi_batch *b) {
  const mpmi_cover *cover = &b->step->layout->blocks.cover[b->block];
  memcpy(b->move.centre, cover->centre, sizeof b->move.centre);
  memcpy(b->move.half, cover->half, sizeof b->move.half);
  for (int32_t k = 0; k < 3 && mpmi_is_total_lagrangian(b->step->settings->grid); ++k)
    b->move.half[k] = DBL_MAX;
  for (int32_t k = 0; k < 3; ++k)
    b->move.within[k] = !(b->move.period[k] > 0.0) && b->move.high[k] - b->move.centre[k] > b->move.half[k] &&
                        b->move.centre[k] - b->move.low[k] > b->move.half[k];
}

/* ---- beyond the faces of the grid --------------------------------------------------------------------- */
/* A particle may cross this many periods in one step: beyond them its position is rounding. */
#define MOST_TURNS 2147483648.0

/* What is no further beyond a wall than this, in cells, stands on it: the rest is rounding. */
#define WALL_ROUNDING 1e-12
/* What is further beyond a friction wall than this comes from a step that was too large. */
#define MOST_OVERLAP 0.5

int32_t mpmi_is_on_wall(const mpmi_settings *settings, int32_t k, double *x) {
  const mpm_grid *grid = settings->grid;
  const int32_t above = *x > grid->upper[k];
  const double face = above ? grid->upper[k] : grid->desc.origin[k];
  const double most = mpmi_is_friction_plane(settings, 2 * k + above) ? MOST_OVERLAP : WALL_ROUNDING;
  if (!mpmi_is_solid(&settings->wall[2 * k + above])) return 0;
  if (!(fabs(*x - face) <= most * grid->desc.spacing[k])) return 0;
  *x = face;
  return 1;
}

/* Contact acts on nodes, and a corner that is sharper than a cell may come through between them. The plane of
 * a friction wall then stops the particle itself, without friction, and takes the momentum that it stops. In
 * quasi-static steps velocities are ways by dt, and there is none. */
static int32_t stop_at_wall(mpmi_batch *b, int64_t slot, int32_t k, double *x) {
  const mpmi_settings *settings = b->step->settings;
  const int32_t above = *x > settings->grid->upper[k];
  const double came = *x;
  if (!mpmi_is_on_wall(settings, k, x)) return 0;
  if (fabs(came - *x) <= WALL_ROUNDING * settings->grid->desc.spacing[k]) return 1;
  if (b->step->layout->member[b->m].prescribed && mpmi_is_prescribed(b->set, slot, k)) return 0;
  double *v = mpmi_component_row(b->set, MPMI_VELOCITY, 1, k) + slot;
  if (above ? *v <= 0.0 : *v >= 0.0) return 1;
  mpmi_stops *stops = &b->step->work->block_stops[b->block];
  const double momentum = settings->desc.quasi_static ? 0.0 : mpmi_f64(b->set, MPMI_MASS, 0)[slot] * *v;
  stops->impulse[2 * k + above] -= momentum;
  stops->energy += 0.5 * momentum * *v;
  *v = 0.0;
  if (mpmi_is_implicit(settings)) mpmi_component_row(b->set, MPMI_ACCELERATION, 1, k)[slot] = 0.0;
  return 1;
}

void mpmi_stops_report(mpmi_step *step) {
  const mpmi_worklist *blocks = &step->layout->worklist[0];
  mpmi_whole_sum *sum = step->work->tally.sum;
  if (!mpmi_has_friction_planes(step->settings)) return;
  for (int64_t i = 0; i < blocks->count; ++i) {
    const mpmi_stops *stops = &step->work->block_stops[blocks->block[i]];
    for (int32_t face = 0; face < 2 * step->settings->grid->dim; ++face)
      mpmi_exact_add(&sum[MPMI_TALLY_FACES + 3 * face + face / 2], stops->impulse[face]);
    mpmi_exact_add(&sum[MPMI_TALLY_CONTACT], stops->energy);
  }
}

/* Moves a position by whole periods into the grid and counts them; 0 where that is beyond counting. */
static int32_t wrap(const mpm_grid *grid, int32_t k, double *x, int64_t *image) {
  const double length = grid->upper[k] - grid->desc.origin[k];
  const double turns = floor((*x - grid->desc.origin[k]) / length);
  if (fabs(turns) >= MOST_TURNS) return 0;
  *x -= turns * length;
  if (*x < grid->desc.origin[k]) *x = grid->desc.origin[k];
  if (*x > grid->upper[k]) *x = grid->upper[k];
  *image += (int64_t)turns;
  return 1;
}

static int32_t is_placed(const mpm_particles *set, int64_t slot) {
  int32_t placed = 1;
  for (int32_t k = 0; k < set->grid->dim; ++k)
    placed &= isfinite(mpmi_component_row(set, MPMI_POSITION, 1, k)[slot]) != 0;
  return placed;
}

/* What is said of a particle that would go through each face. */
static const char *const off_grid[6] = {
    "a particle would leave the grid through MPM_X_MIN", "a particle would leave the grid through MPM_X_MAX",
    "a particle would leave the grid through MPM_Y_MIN", "a particle would leave the grid through MPM_Y_MAX",
    "a particle would leave the grid through MPM_Z_MIN", "a particle would leave the grid through MPM_Z_MAX"};

/* Wraps particles beyond a face, marks them for removal, or ends the step. */
static void look_outside(mpmi_batch *b) {
  const mpmi_settings *settings = b->step->settings;
  const mpm_grid *grid = settings->grid;
  const int64_t *id = mpmi_i64(b->set, MPMI_ID, 0);
  for (int64_t slot = b->begin; slot < b->begin + b->n; ++slot) {
    if (id[slot] < 0 || !is_placed(b->set, slot)) continue; /* the check of values reports it */
    int32_t closed = -1, leaves = 0;                        /* closed: a face that does not let it through */
    for (int32_t k = 0; k < grid->dim; ++k) {
      double *x = mpmi_component_row(b->set, MPMI_POSITION, 1, k) + slot;
      if (*x >= grid->desc.origin[k] && *x <= grid->upper[k]) continue;
      const int32_t face = 2 * k + (*x > grid->upper[k]);
      if (!grid->desc.periodic[k] && mpmi_wall_kind_of(settings->wall[face].kind)->opens)
        leaves = 1;
      else if (grid->desc.periodic[k]
                   ? !wrap(grid, k, x, mpmi_i64(b->set, MPMI_IMAGE, 1) + k * b->set->ld + slot)
                   : !stop_at_wall(b, slot, k, x))
        closed = face;
    }
    if (closed >= 0)
      mpmi_batch_fail(b, MPM_OFF_GRID, slot, off_grid[closed]);
    else if (leaves)
      b->report->removes = 1;
  }
}

/* ---- a batch ------------------------------------------------------------------------------------------ */
/* Turns gathered dt a1 into what Newmark's rule adds to velocities, and keeps a1. Where whole increments were
 * gathered, it keeps their mean over the step. */
static void mean_accelerations(mpmi_batch *b) {
  const mpmi_settings *settings = b->step->settings;
  const int32_t whole = b->step->whole_increments;
  const double dt = b->step->dt, gamma = settings->desc.newmark_gamma;
  for (int32_t k = 0; k < settings->grid->dim; ++k) {
    double *a = mpmi_component_row(b->set, MPMI_ACCELERATION, 1, k) + b->begin;
    double *dv = b->dv + k * b->law.ld;
    for (int64_t p = 0; p < b->n; ++p) {
      const double new = dv[p] / dt;
      dv[p] = whole ? dv[p] : dt * (1.0 - gamma) * a[p] + gamma * dv[p];
      a[p] = new;
    }
  }
}

static void store_accelerations(mpmi_batch *b) {
  for (int32_t k = 0; k < b->set->grid->dim; ++k)
    for (int64_t p = 0; p < b->n; ++p)
      mpmi_component_row(b->set, MPMI_ACCELERATION, 1, k)[b->begin + p] =
          (b->move.v_new[k][p] - b->move.v_old[k][p]) / b->step->velocity_dt;
}

void mpmi_motion_aim(mpmi_batch *b) {
  const int32_t from = b->pass->places; /* the pass that moves has begun the new position */
  for (int32_t k = 0; k < b->set->grid->dim; ++k) {
    b->move.x_old[k] = mpmi_component_row(b->set, MPMI_POSITION, from, k) + b->begin;
    b->move.v_old[k] = mpmi_component_row(b->set, MPMI_VELOCITY, 0, k) + b->begin;
    b->move.x_new[k] = mpmi_component_row(b->set, MPMI_POSITION, 1, k) + b->begin;
    b->move.v_new[k] = mpmi_component_row(b->set, MPMI_VELOCITY, 1, k) + b->begin;
  }
}

static void copy_images(const mpmi_batch *b) {
  const mpm_particles *set = b->set;
  for (int32_t k = 0; set->field[MPMI_IMAGE].present && k < set->grid->dim; ++k)
    memcpy(mpmi_i64(set, MPMI_IMAGE, 1) + k * set->ld + b->begin,
           mpmi_i64(set, MPMI_IMAGE, 0) + k * set->ld + b->begin, (size_t)b->n * sizeof(int64_t));
}

/* Some have left the cover of their block: perhaps its tile as well. */
static void look_astray(mpmi_batch *b) {
  const mpmi_settings *settings = b->step->settings;
  mpmi_move move = b->move;
  b->report->left_cover = 1;
  mpmi_tile_bounds(&b->step->layout->blocks, b->block, move.centre, move.half);
  if (settings->kernels->look[settings->grid->dim](&move, b->n) & MPMI_LEFT_BOUNDS) b->report->left_tile = 1;
}

void mpmi_motion_take(mpmi_batch *b) {
  const mpmi_settings *settings = b->step->settings;
  uint32_t flags = b->taken.moved;
  copy_images(b);
  if (!b->gather.move) {
    mean_accelerations(b);
    flags = settings->kernels->move[settings->grid->dim](&b->move, b->n);
  }
  if (b->step->layout->member[b->m].prescribed)
    flags |= mpmi_prescribed_move(b->step, b->nodes, b->m, b->block, &b->move, b->begin, b->n);
  b->flags |= flags & MPMI_NONFINITE;
  /* with `stays` another pass moves them, and looks at their places then */
  if (flags & MPMI_LEFT_BOUNDS && !b->move.stays) look_astray(b);
  if (flags & MPMI_OUTSIDE && !b->move.stays) look_outside(b);
  if (b->set->field[MPMI_ACCELERATION].present && !mpmi_is_implicit(settings)) store_accelerations(b);
}
