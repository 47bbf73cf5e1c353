/* The end of a step: the second copies become the state, or are dropped. */
#include "stepper/stepper.h"
#include "boundary/prescribed.h"
#include "stages/batch.h"

#include <string.h>

static int32_t written_by_step(int32_t field) {
  switch (field) {
  case MPMI_POSITION:
  case MPMI_VELOCITY:
  case MPMI_ACCELERATION:
  case MPMI_F:
  case MPMI_L:
  case MPMI_STRESS:
  case MPMI_STATE:
  case MPMI_DILATION_RATIO:
  case MPMI_IMAGE:
    return 1;
  default:
    return 0;
  }
}

/* Makes holes of particles that went through an open wall. The hole stays where the particle was before the
 * step, inside the cover of its block. */
static void remove_outside(mpm_stepper *s, mpm_particles *set) {
  const mpm_grid *grid = s->grid;
  const int64_t *id = mpmi_i64(set, MPMI_ID, 0);
  for (int64_t slot = 0; slot < set->slots; ++slot) {
    int32_t outside = 0;
    for (int32_t k = 0; id[slot] >= 0 && k < grid->dim; ++k) {
      const double x = mpmi_f64(set, MPMI_POSITION, 0)[k * set->ld + slot];
      outside |= x < grid->desc.origin[k] || x > grid->upper[k];
    }
    if (!outside) continue;
    for (int32_t k = 0; k < grid->dim; ++k)
      mpmi_f64(set, MPMI_POSITION, 0)[k * set->ld + slot] =
          mpmi_f64(set, MPMI_POSITION, 1)[k * set->ld + slot];
    mpmi_make_hole(set, slot);
    --set->count;
    ++s->history.removed;
    s->history.has_sums = 0;
    mpmi_index_drop(set);
  }
}

/* Makes the new copies the state. */
static void swap_copies(const mpm_stepper *s, mpm_particles *set, int32_t left_tile) {
  for (int32_t f = 0; f < set->field_count; ++f) {
    mpmi_field *field = &set->field[f];
    if (!field->present || !written_by_step(f)) continue;
    void *swap = field->data[0];
    field->data[0] = field->data[1];
    field->data[1] = swap;
  }
  if (!set->mapped) set->lent = 0;
  if (left_tile) set->dirty |= MPMI_DIRTY_PLACE;
  set->dirty &= ~(uint32_t)(MPMI_DIRTY_SUMS | MPMI_DIRTY_ACCELERATION);
  /* with contact they are means over the step, and the next step needs those at its start */
  if (!mpmi_is_implicit(&s->settings) || s->settings.desc.quasi_static || s->step.whole_increments)
    set->dirty |= MPMI_DIRTY_ACCELERATION;
}

static void add_to_totals(mpm_stepper *s, double work) {
  mpmi_totals *totals = &s->history.totals;
  totals->external_work += work;
  totals->damping_dissipation += s->step.info.damping_dissipation;
  for (int32_t face = 0; face < 6; ++face)
    for (int32_t c = 0; c < 3; ++c) totals->impulse_by_face[face][c] += s->step.impulse_by_face[face][c];
  for (int32_t m = 0; m < s->layout.member_count; ++m) {
    mpmi_reaction *reaction = &s->history.reaction[m];
    for (int32_t c = 0; c < 3; ++c) {
      reaction->impulse[c] = s->work.tally.total[MPMI_TALLY_REACTIONS + 3 * m + c];
      reaction->impulse_total[c] += reaction->impulse[c];
    }
  }
}

/* Makes the totals of the step: those of blocks and tasks, and what walls, hosts and dampers did beside what
 * the step has of it already. Returns the energies, momenta and rates of the new state. */
static mpmi_sums close_tally(mpmi_step *step) {
  mpmi_tally *tally = &step->work->tally;
  const mpmi_worklist *blocks = &step->layout->worklist[0];
  mpmi_sums sums = {0};
  for (int64_t i = 0; i < blocks->count; ++i)
    mpmi_tally_block(tally->sum, &step->work->block_sums[blocks->block[i]], &sums);
  for (int32_t k = 0; k < step->settings->tasks; ++k) {
    mpmi_exact_join(&tally->sum[MPMI_TALLY_WORK], &step->work->report[k].host_work);
    mpmi_exact_join(&tally->sum[MPMI_TALLY_DAMPING], &step->work->report[k].damping);
  }
  for (int64_t i = 0; i < tally->count; ++i) tally->total[i] = mpmi_exact_total(&tally->sum[i]);
  mpmi_tally_read(tally->total, &sums);
  for (int32_t i = 0; i < 18; ++i) step->impulse_by_face[i / 3][i % 3] += tally->total[MPMI_TALLY_FACES + i];
  step->host_work += tally->total[MPMI_TALLY_WORK];
  step->info.damping_dissipation += tally->total[MPMI_TALLY_DAMPING];
  return sums;
}

static void commit_history(mpm_stepper *s) {
  mpmi_step *step = &s->step;
  mpmi_history *history = &s->history;
  const mpmi_sums before = history->sums;
  history->sums = close_tally(step);
  history->has_sums = 1;
  history->t += step->dt;
  ++history->step;
  const mpmi_sums *after = &history->sums;
  const double work = after->work + step->host_work;
  step->info.external_work = work;
  step->info.dissipation = before.kinetic + before.strain + work - after->kinetic - after->strain;
  memcpy(history->impulse_by_face, step->impulse_by_face, sizeof history->impulse_by_face);
  add_to_totals(s, work);
  mpmi_pairs_commit(&history->pairs);
  mpmi_obstacles_commit(&s->settings.obstacles);
  mpmi_surfaces_commit(&s->settings.surfaces);
  history->reaction_dt = step->velocity_dt;
  history->previous_dt = s->settings.desc.staggered ? step->dt : 0.0;
  history->has_reactions = 1;
}

void mpmi_commit(mpm_stepper *s) {
  int32_t left = 0, removes = 0, restored = 0, old = 0;
  for (int32_t k = 0; k < s->settings.tasks; ++k) {
    left |= s->work.report[k].left_tile;
    old |= s->work.report[k].left_cover;
    removes |= s->work.report[k].removes;
    restored |= s->work.report[k].holes_restored;
  }
  for (int32_t m = 0; m < s->layout.member_count; ++m) mpmi_prescribed_report(&s->step, &s->nodes, m);
  commit_history(s);
  mpmi_heat_commit(&s->step, s->heat, &s->history.heat);
  for (int32_t m = 0; m < s->layout.member_count; ++m) swap_copies(s, s->layout.member[m].set, left);
  if (old) s->layout.cover_is_old = 1;
  if (restored) s->history.has_sums = 0;
  for (int32_t m = 0; m < s->layout.member_count && removes; ++m) remove_outside(s, s->layout.member[m].set);
}

void mpmi_roll_back(mpm_stepper *s) {
  mpmi_heat_forget(&s->layout);
  mpmi_make_volumes(&s->layout, 0);
}
