/* Prescribed particles: which they are, their velocities, their motion, what they report. */
#include "boundary/prescribed.h"
#include "layout/particle_batch.h"

#include <math.h>
#include <string.h>

static int32_t any_in(const mpm_particles *set, int64_t begin, int64_t end) {
  const uint8_t *flags = set->field[MPMI_PRESCRIBED].data[0];
  uint8_t any = 0;
  for (int32_t c = 0; c < set->grid->dim; ++c)
    for (int64_t p = begin; p < end; ++p) any |= flags[c * set->ld + p];
  return any != 0;
}

static void touch_around(const mpmi_blocks *b, uint8_t *flag, int64_t block, uint8_t has) {
  flag[block] |= has;
  for (int32_t n = 0; n < b->neighbours; ++n)
    if (b->neighbour[block][n] != MPMI_NO_BLOCK) flag[b->neighbour[block][n]] |= MPMI_TOUCHED;
}

/* Marks the blocks of masters as well, which take what their followers are given, wherever they lie. */
static void touch_masters(const mpmi_constraints *constraints, int32_t block_nodes, uint8_t *flag) {
  for (int64_t i = 0; i < constraints->tie_count; ++i) {
    const mpmi_tie *tie = &constraints->tie[i];
    int32_t touched = 0;
    for (int64_t d = tie->first; d < tie->first + tie->count; ++d)
      touched |= flag[constraints->follower[d].slot / block_nodes];
    if (touched & MPMI_TOUCHED) flag[tie->master / block_nodes] |= MPMI_TOUCHED;
  }
}

static void find_blocks(const mpmi_layout *layout, uint8_t *flag) {
  const mpmi_blocks *b = &layout->blocks;
  if (!b->count) return;
  memset(flag, 0, (size_t)b->count);
  for (int32_t m = 0; m < layout->member_count; ++m) {
    const mpmi_member *member = &layout->member[m];
    for (int64_t block = 0; block < b->count && member->prescribed; ++block)
      if (any_in(member->set, member->now.start[block], member->now.start[block + 1]))
        touch_around(b, flag, block, MPMI_WITH_PRESCRIBED);
  }
  for (int64_t i = 0; layout->parts && i < layout->parts->ghost_count; ++i)
    touch_around(b, flag, layout->parts->ghost[i].block, 0);
  touch_masters(&layout->constraints, b->nodes, flag);
}

mpm_status mpmi_prescribed_prepare(mpmi_layout *layout, mpmi_nodes *nodes, const mpmi_settings *settings) {
  mpmi_prescription *p = &nodes->prescription;
  mpm_context *c = settings->context;
  mpm_status status;
  p->any = 0;
  for (int32_t m = 0; m < layout->member_count; ++m) {
    mpmi_member *member = &layout->member[m];
    member->prescribed =
        member->set->field[MPMI_PRESCRIBED].present && any_in(member->set, 0, member->set->slots);
    p->any |= member->prescribed;
  }
  p->any |= layout->parts && layout->parts->prescribes;
  if (!p->any) return MPM_OK;
  const int64_t blocks = layout->blocks.count;
  if ((status = MPMI_RESERVE_MORE(c, p->sums, p->sums_capacity, mpmi_slots(layout))) ||
      (status = MPMI_RESERVE_MORE(c, p->part, p->part_capacity, blocks * layout->member_count)) ||
      (status = MPMI_RESERVE_MORE(c, p->block, p->block_capacity, blocks)))
    return status;
  find_blocks(layout, p->block);
  return MPM_OK;
}

/* ---- mean velocities of the coming step --------------------------------------------------------------- */
static void ask_batch(void *user, int32_t m, const mpm_particle_batch *batch, int64_t begin,
                      mpmi_failure *failure) {
  const mpmi_step *step = user;
  const mpmi_member *member = &step->layout->member[m];
  double *mean = step->work->rows.of[m].mean + begin;
  for (int32_t c = 0; c < batch->dim; ++c) memset(mean + c * batch->ld, 0, (size_t)batch->n * sizeof *mean);
  const mpmi_motion *motion = &step->settings->motion[m];
  if (mpmi_call_particle_fn(motion->fn, motion->user, "the motion callback", m, batch, mean, failure)) return;
  for (int32_t c = 0; c < batch->dim; ++c)
    for (int64_t p = 0; p < batch->n; ++p)
      if (mpmi_is_prescribed(member->set, begin + p, c) && !isfinite(mean[c * batch->ld + p]))
        mpmi_failure_take(
            failure, mpmi_particle_failure(MPM_NONFINITE, m, batch->id[p], "prescribed velocity not finite"));
}

mpm_status mpmi_prescribed_stage(mpmi_step *step) {
  for (int32_t m = 0; m < step->layout->member_count; ++m) {
    if (!step->layout->member[m].prescribed || !step->settings->motion[m].fn) continue;
    const mpm_status status = mpmi_particle_batches(step, m, step->t, 1, ask_batch, step);
    if (status) return status;
  }
  return mpmi_step_failure(step);
}

/* ---- motion ------------------------------------------------------------------------------------------- */
static uint32_t flags_of(const mpmi_move *move, int32_t c, double x) {
  double away = x - move->centre[c];
  away -= move->period[c] * nearbyint(away * move->inverse_period[c]);
  return (x < move->low[c] || x > move->high[c] ? (uint32_t)MPMI_OUTSIDE : 0u) |
         (fabs(away) > move->half[c] ? (uint32_t)MPMI_LEFT_BOUNDS : 0u);
}

uint32_t mpmi_prescribed_move(const mpmi_step *step, mpmi_nodes *nodes, int32_t m, int64_t block,
                              const mpmi_move *move, int64_t begin, int64_t n) {
  const mpmi_settings *settings = step->settings;
  const mpmi_member *member = &step->layout->member[m];
  const mpm_particles *set = member->set;
  const double *mean = mpmi_mean_velocity(step, m), *mass = mpmi_f64(set, MPMI_MASS, 0);
  mpmi_prescribed_part *part = mpmi_part_of(step->layout, nodes, block, m);
  uint32_t flags = 0;
  if (!mpmi_block_is(nodes, block, MPMI_WITH_PRESCRIBED)) return 0;
  for (int32_t c = 0; c < settings->grid->dim; ++c)
    for (int64_t p = 0; p < n; ++p) {
      if (!mpmi_is_prescribed(set, begin + p, c)) continue;
      const double u = mean[c * set->ld + begin + p], moved = move->v_new[c][p];
      if (mpmi_is_dynamic(settings) && move->rule != MPMI_MOVE_PLACE) {
        /* an implicit step balances the nodes at its end: the gain is that of the new acceleration */
        const double gained = mpmi_is_implicit(settings)
                                  ? move->dt * (mpmi_f64(set, MPMI_ACCELERATION, 1) + c * set->ld)[begin + p]
                                  : moved - move->v_old[c][p];
        part->impulse[c] -= mass[begin + p] * gained;
        part->work += mass[begin + p] * (u - move->v_old[c][p] - gained) * u;
      }
      move->v_new[c][p] = u;
      move->x_new[c][p] = (mpmi_f64(set, MPMI_POSITION, 0) + c * set->ld)[begin + p] + move->dt * u;
      flags |= flags_of(move, c, move->x_new[c][p]);
    }
  return flags;
}

/* ---- reports ------------------------------------------------------------------------------------------ */
void mpmi_prescribed_report(const mpmi_step *step, const mpmi_nodes *nodes, int32_t m) {
  const mpmi_layout *layout = step->layout;
  for (int64_t b = 0; b < layout->blocks.count && layout->member[m].prescribed; ++b) {
    if (!mpmi_block_is(nodes, b, MPMI_WITH_PRESCRIBED)) continue;
    const mpmi_prescribed_part *part = mpmi_part_of(layout, nodes, b, m);
    for (int32_t c = 0; c < step->settings->grid->dim; ++c)
      mpmi_exact_add(&step->work->tally.sum[MPMI_TALLY_REACTIONS + 3 * m + c], part->impulse[c]);
    mpmi_exact_add(&step->work->tally.sum[MPMI_TALLY_WORK], part->work);
  }
}
